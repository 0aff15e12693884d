//! Implicit steps whose length follows an estimate of their error.
//!
//! Schemes of second order have the error c Δt³|q‴| in smooth motion; for Newmark see O. C. Zienkiewicz & Y. M. Xie, Earthquake Eng.
//! Struct. Dyn. 20 (1991). Schemes of third order damp by c Δt⁴ q⁗, and their error of phase is d Δt⁵ q⁽⁵⁾. For ESDIRK3 both are equal
//! at 13.8 steps a period, and with their weights at 6.9; the difference of q⁗ in two steps gives q⁽⁵⁾. Lengths follow the sum of both
//! with the cube of Δt, although the error of phase grows with Δt⁴. Unresolved modes have large accelerations and hardly move. The matrix
//! of the step filters the estimate e, (K + wM)⁻¹wM e, which keeps resolved modes (L. F. Shampine & L. S. Baca, J. Comput. Appl. Math. 11
//! (1984)).
//!
//! Errors of steps add up: each step may use the share of the tolerance that its length has of the run; their lasting
//! part decides (see [`LastingError`]).

use super::adaptive::StepController;
use super::error_measure::ErrorMeasure;
use super::lasting_error::LastingError;
use super::tolerance::{EventLimit, FollowTolerance};
use crate::context::Context;
use crate::failure::Failure;
use crate::jumps;
use crate::report::StepReport;
use crate::step::implicit::Implicit;
use crate::step::size::Size;
use crate::step::tangent::IterationMatrix;
use crate::step::trial::Stage;
use crate::system::kinks::has_kinks;
use crate::tolerances::error_controlled::{
    FEWEST, FILTERS, MEAN, MEAN_OF_STAGES, RESOLVED, SAFETY, SLIGHT, SPAN, TOO_MUCH, TRIALS, WEIGHT, WORTH,
};
use crate::workspace::Workspace;
use base::math::{Vec3, Vec6, stack};
use base::snapshot::keep;
use mechanics::integrators::spectrum::{error_constant, phase_constant};
use mechanics::integrators::{AlphaFamily, RotationUpdate};
use mechanics::state::State;

/// Leads an implicit scheme by the error of its steps. It is allocated once.
pub struct ErrorController<'a> {
    stepper: Box<Implicit<'a>>,
    /// Error of displacements allowed for the whole run, relative to the largest displacement.
    tolerance: f64,
    /// Value in the deck.
    asked: f64,
    /// The error constant c of the scheme.
    constant: f64,
    /// The constant d of the error of phase; 0 for schemes of second order.
    of_phase: f64,
    /// The order p of the scheme.
    order: i32,
    /// Length of the next step, and the longest allowed.
    length: f64,
    longest: f64,
    /// Length of the first step of a run.
    first: f64,
    /// The longest step at the tolerance of the deck.
    most: f64,
    /// Error of a step relative to its allowance and to the square of its length: means over the last steps, of the
    /// lasting errors and of all.
    lasting_intensity: Option<f64>,
    intensity: Option<f64>,
    /// The time that these means cover.
    covered: f64,
    /// The fourth derivatives q⁗ by node, in the last step that stands and in the one to judge.
    fourth: [Vec<Vec6>; 2],
    /// The length of the last step that stands; `None` if none came before.
    last: Option<f64>,
    /// Largest displacement of a node and largest rotation of a body so far.
    motion: Size,
    measure: ErrorMeasure,
    /// State at the start of the step, for a refused step.
    start: State,
    /// The state at a time inside the step.
    inside: State,
    /// The errors of a step by node, and the same after more filters.
    errors: [Vec<Vec6>; 2],
    lasting: LastingError,
    events: EventLimit,
    /// True if forces may have kinks.
    has_events: bool,
}

keep!(ErrorController<'_> {
    stepper, tolerance, length, longest, lasting_intensity, intensity, covered, fourth, last, motion, measure, start, inside, errors,
    lasting, events,
 } without { asked, constant, of_phase, order, first, most, has_events });

/// An estimated error relative to the largest motion.
struct Estimate {
    error: f64,
    /// Largest motion, including that at the end of the step.
    motion: Size,
}

impl<'a> ErrorController<'a> {
    /// A controller with this tolerance and first step.
    pub fn new(cx: &Context, stepper: Box<Implicit<'a>>, tolerance: f64, first: f64) -> Self {
        let (nodes, scheme) = (cx.model.nodes.len(), &*cx.model.solution.scheme);
        let [mean, of_phase] = match stepper.stages() {
            Some(_) => [MEAN_OF_STAGES, MEAN * phase_constant(scheme)],
            None => [MEAN, 0.0],
        };
        let measure = ErrorMeasure::new(cx.model, cx.size(), tolerance);
        ErrorController {
            stepper,
            tolerance,
            asked: tolerance,
            constant: mean * error_constant(scheme),
            of_phase,
            order: scheme.order() as i32,
            length: first,
            longest: cx.model.analysis.duration() / FEWEST,
            first,
            most: cx.model.analysis.duration() / FEWEST,
            lasting_intensity: None,
            intensity: None,
            covered: 0.0,
            fourth: [vec![Vec6::zeros(); nodes], vec![Vec6::zeros(); nodes]],
            last: None,
            motion: measure.at_rest(),
            measure,
            start: State::default(),
            inside: State::default(),
            errors: [vec![Vec6::zeros(); nodes], vec![Vec6::zeros(); nodes]],
            lasting: LastingError::new(nodes),
            events: EventLimit::default(),
            has_events: has_kinks(cx.system),
        }
    }

    /// Ends the iteration as for this tolerance of the steps.
    pub fn iterate_to(&mut self, tolerance: f64) {
        self.stepper.solver.newton.tolerance.follow(tolerance);
    }

    /// True where the motion is known inside steps.
    pub fn looks_inside(&self) -> bool {
        self.stepper.stages().is_some()
    }

    /// Decides whether a step of `dt` to `time` stands, and chooses the next length. Returns the lasting error of a step that stands, as a
    /// length.
    fn judge(&mut self, dt: f64, time: f64, end_time: f64, estimate: &Estimate) -> Option<f64> {
        let part = dt / end_time;
        let ratio = estimate.error / (self.tolerance * part);
        let all = ratio / dt.powi(self.order);
        let sudden = self.intensity.is_none_or(|usual| all > TOO_MUCH * usual);
        if ratio > TOO_MUCH && sudden || !ratio.is_finite() {
            self.length =
                dt * if ratio.is_finite() { (SAFETY / ratio).powf(1.0 / f64::from(self.order)).max(0.1) } else { 0.1 };
            self.lasting_intensity = Some(all).filter(|all| all.is_finite());
            self.last = None;
            // Errors of an event count on for a while.
            if !self.has_events {
                self.covered = 0.0;
            }
            return None;
        }
        // Earlier errors count less by the growth of the motion.
        let (before, after) = (self.measure.whole(self.motion), self.measure.whole(estimate.motion));
        let grown = if before > 0.0 { after / before } else { 1.0 };
        self.motion = estimate.motion;
        let factor = self.constant * dt.powi(self.order + 1);
        let corner =
            |constant: f64, order: i32| (constant * dt.powi(order) * end_time).powf(1.0 / f64::from(order + 1));
        let tau = corner(self.constant, self.order).max(corner(self.of_phase, self.order + 1));
        self.lasting.update(&self.errors[0], factor, dt, tau);
        let error = factor * self.measure.relative(self.lasting.value(), self.motion, time);
        let lasting = error / (self.tolerance * part) / dt.powi(self.order);
        // The first step is short, so it counts little. Schemes of second order follow small vibrations where it counts so.
        self.covered += dt;
        let span = if self.of_phase > 0.0 { self.covered.min(SPAN * end_time) } else { SPAN * end_time };
        let weight = (dt / span).clamp(WEIGHT, 1.0);
        let update =
            |mean: Option<f64>, now: f64| mean.map_or(now, |mean| mean / grown + weight * (now - mean / grown));
        let mean = update(self.lasting_intensity, lasting);
        self.lasting_intensity = Some(mean);
        self.intensity = Some(update(self.intensity, all));
        self.last = Some(dt);
        self.fourth.swap(0, 1);
        self.choose_length(dt, mean.powf(-1.0 / f64::from(self.order)));
        Some(error * self.measure.whole(self.measure.reference(self.motion, time)))
    }

    /// Returns to the start of the step.
    fn go_back(&mut self, state: &mut State) {
        state.copy_from(&self.start);
        self.stepper.solver.newton.forget_iterates();
    }

    /// Chooses the length of the step after one of `dt`, where `allowed` would just meet the tolerance.
    fn choose_length(&mut self, dt: f64, allowed: f64) {
        if allowed < SAFETY * dt {
            self.length = SAFETY * allowed;
        } else if allowed > WORTH * dt {
            // A step may be short because of where it ends.
            self.length = (SAFETY * allowed).min(2.0 * dt.max(self.length)).min(self.longest);
        }
    }

    /// Measures the motion ahead in a few long steps: errors at the start are small against it, whatever they are
    /// against the motion so far. The trapezoidal rule is used, which does not overshoot. The state returns to the
    /// start of the step.
    ///
    /// # Errors
    /// [`Failure::Stopped`] where a signal has ended one of them.
    fn look_ahead(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) -> Result<(), Failure> {
        state.copy_from(&self.start);
        let (drift, violation) = (ws.rotation_drift, ws.joint_violation);
        let mut run = cx.model.analysis.duration();
        for part in TRIALS {
            let dt = part * run;
            let scheme = AlphaFamily::trapezoidal(RotationUpdate::Exponential).coefficients(dt);
            let to = state.time + dt;
            match self.stepper.solver.stage(cx, ws, state, &Stage::from(&scheme), to) {
                Ok(_) => self.measure.look_ahead(cx.model, state),
                Err(Failure::Stopped) => {
                    state.copy_from(&self.start);
                    return Err(Failure::Stopped);
                }
                Err(_) => run *= 0.1,
            }
        }
        state.copy_from(&self.start);
        self.stepper.solver.newton.discard_matrix();
        (ws.rotation_drift, ws.joint_violation) = (drift, violation);
        self.measure.begin(state.time);
        Ok(())
    }

    /// Estimates the error of the step of length `dt` that led to `state`.
    fn estimate(&mut self, cx: &Context, ws: &mut Workspace, state: &State, dt: f64) -> Estimate {
        let motion = self.measure.with(self.motion, cx.model, state);
        self.write_errors(cx, state, dt);
        let matrix = &mut self.stepper.solver.newton.matrix;
        let [errors, again] = &mut self.errors;
        let relative = |errors: &[Vec6]| self.measure.relative(errors, motion, state.time);
        let mut passed = [relative(errors); 3];
        for error in &mut passed[1..] {
            filter(cx, ws, state, matrix, errors);
            *error = relative(errors);
        }
        // Unresolved motion passes the first filter with about its amplitude.
        let [raw, amplitude, mut error] = passed;
        let allowed = self.tolerance * dt / cx.model.analysis.duration();
        if amplitude < SLIGHT * self.tolerance && error > allowed && error < RESOLVED * raw {
            again.copy_from_slice(errors);
            filter(cx, ws, state, matrix, again);
            if relative(again) < RESOLVED.sqrt() * error {
                // Unresolved motion is left alone; other motion has to show.
                for _ in 0..FILTERS {
                    filter(cx, ws, state, matrix, again);
                }
                error = relative(again);
                std::mem::swap(errors, again);
            }
        }
        Estimate { error, motion }
    }

    /// Writes c Δtᵖ⁺¹ q⁽ᵖ⁺¹⁾ and the error of phase of the step of length `dt` that led to `state`, by node.
    fn write_errors(&mut self, cx: &Context, state: &State, dt: f64) {
        let errors = &mut self.errors[0];
        errors.fill(Vec6::zeros());
        let of_phase = self.last.map_or(0.0, |last| self.of_phase * dt.powi(5) / (0.5 * (last + dt)));
        let [before, now] = &mut self.fourth;
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let error = match self.stepper.stages() {
                Some(stages) => {
                    now[node] = stages.fourth_derivative(cx, k) / (dt * dt);
                    now[node] * (self.constant * dt.powi(4)) + (now[node] - before[node]) * of_phase
                }
                None => third_derivative(&self.start, state, node) * (self.constant * dt.powi(3)),
            };
            errors[node] = cx.plan.dofs.of(node).mask(&error);
        }
        cx.system.carry_all(&state.nodes, errors);
    }
}

/// The third derivative of the increment of a node in a step from `start` to `end`.
fn third_derivative(start: &State, end: &State, node: usize) -> Vec6 {
    let (first, last) = (&start.nodes[node], &end.nodes[node]);
    // The rotation vector of a step has Θ‴ = α̇ − ½ ω×α: a spinning body turns α without changing it.
    let across = 0.25 * (first.omega.cross(&first.alpha) + last.omega.cross(&last.alpha));
    end.jerk[node] - stack(&Vec3::zeros(), &across)
}

/// Filters the errors by node, e ← (K + wM)⁻¹wM e, with the weight w of the mass in the current matrix.
fn filter(cx: &Context, ws: &mut Workspace, state: &State, matrix: &mut IterationMatrix, errors: &mut [Vec6]) {
    cx.system.apply_mass(&state.nodes, errors, &mut ws.forces);
    ws.residual.write(cx, &ws.forces, matrix.mass_weight);
    matrix.solve_at(ws, &state.nodes);
    for &node in &cx.independent_nodes {
        errors[node] = ws.correction.of(cx.plan.dofs.of(node));
    }
    cx.system.carry_all(&state.nodes, errors);
}

impl FollowTolerance for ErrorController<'_> {
    /// The motion of earlier runs stays known: errors at the start are small against it, whatever they are against the motion so far.
    fn follow(&mut self, cx: &Context, tolerance: f64, longest: Option<f64>) {
        self.tolerance = tolerance;
        self.stepper.begin_run(cx);
        self.stepper.solver.newton.tolerance.follow(tolerance);
        // A trial has a longer first step too, otherwise both runs would share its effects.
        self.length = self.first * (tolerance / self.asked).powf(1.0 / f64::from(self.order)).clamp(1.0, 2.0);
        self.longest = longest.unwrap_or(self.most);
        (self.lasting_intensity, self.intensity) = (None, None);
        (self.covered, self.last) = (0.0, None);
        self.lasting.forget();
        self.events = EventLimit::default();
    }
}

impl StepController for ErrorController<'_> {
    fn restart(&mut self, _: &Context, _: &mut Workspace, state: &mut State) {
        self.stepper.restart(state);
        self.last = None;
        self.start.clone_from(state);
        if self.looks_inside() {
            self.inside.clone_from(state);
        }
    }

    fn release(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State, dt: f64) -> Result<(), Failure> {
        jumps::release(cx, ws, state, dt)?;
        self.restart(cx, ws, state);
        Ok(())
    }

    fn propose(&mut self, _: &Context, _: &mut Workspace, _: &State, _: f64) -> Result<f64, Failure> {
        Ok(self.length)
    }

    fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
        _: f64,
    ) -> Result<Option<StepReport>, Failure> {
        let dt = to - state.time;
        self.start.copy_from(state);
        let (drift, violation) = (ws.rotation_drift, ws.joint_violation);
        let report = self.stepper.step(cx, ws, state, to)?;
        if self.events.is_passed(cx, [&self.start, state], self.tolerance) {
            self.go_back(state);
            (ws.rotation_drift, ws.joint_violation) = (drift, violation);
            self.length = 0.5 * dt;
            return Err(Failure::ErrorTooLarge { dt });
        }
        let estimate = self.estimate(cx, ws, state, dt);
        if self.measure.begins_with(estimate.motion) {
            self.look_ahead(cx, ws, state)?;
            return Ok(None);
        }
        if let Some(error) = self.judge(dt, state.time, cx.model.analysis.duration(), &estimate) {
            self.events.accept([&self.start, state]);
            return Ok(Some(StepReport { error, ..report }));
        }
        self.go_back(state);
        (ws.rotation_drift, ws.joint_violation) = (drift, violation);
        Err(Failure::ErrorTooLarge { dt })
    }

    fn cut_back(&mut self, dt: f64) {
        self.length = 0.5 * dt;
    }

    fn go_on_with(&mut self, tolerance: f64) {
        let change = self.tolerance / tolerance;
        self.tolerance = tolerance;
        self.stepper.solver.newton.tolerance.follow(tolerance);
        for intensity in [&mut self.lasting_intensity, &mut self.intensity] {
            *intensity = intensity.map(|intensity| intensity * change);
        }
    }

    fn look_inside(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        end: &State,
        time: f64,
    ) -> Result<Option<(&State, StepReport)>, Failure> {
        let report = self.stepper.look_inside(cx, ws, (&self.start, end.time), (&mut self.inside, time))?;
        Ok(report.map(|report| (&self.inside, report)))
    }

    fn take_back(&mut self, state: &mut State) {
        // The step that replaces it covers the same time, and its own q⁗ would overlap.
        self.covered -= self.last.take().unwrap_or(0.0);
        self.go_back(state);
    }
}
