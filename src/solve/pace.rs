//! Steps whose length follows an estimate of their error.
//!
//! In a step a scheme of second order puts a smooth motion wrong by c Δt³ |q‴|; for Newmark's that is the estimate of
//! O. C. Zienkiewicz & Y. M. Xie, Earthquake Eng. Struct. Dyn. 20 (1991). Modes that the step does not resolve have large
//! accelerations and hardly move, so the estimate e is passed through the matrix of the step, (K + w M)⁻¹ w M e, which
//! leaves what is resolved as it is (L. F. Shampine & L. S. Baca, J. Comput. Appl. Math. 11 (1984)).
//!
//! Errors of steps add up: each step may take the part of the allowance that its length is of the run. A vibration of amplitude A
//! goes out of phase, wrong by φ A with φ = c ω³ Δt² T at the end of a run of length T, but never by much more than A. Butterworth's
//! filter of third order over the time, with its corner at φ = 1, makes that φ A/√(1 + φ²): what is long out of phase counts by its
//! amplitude.

use super::correction::Size;
use super::failure::Failure;
use super::own_length::OwnLength;
use super::step::{Stepper, Taken};
use crate::integrators::spectrum::error_constant;
use crate::integrators::{Newmark, RotationUpdate, Scheme};
use crate::math::{Vec3, Vec6, bottom, join, top};
use crate::model::Model;
use crate::state::State;

/// Of what a step may err, and of what steps have erred lately, where it is taken back: something has happened.
const TOO_MUCH: f64 = 4.0;
/// Of a length that would just do: for the next step to be no more than that.
const SAFETY: f64 = 0.9;
/// A new length costs a new matrix: steps grow once they may by as much, by no more than twice.
const WORTH: f64 = 1.4;
/// Of a run: errors swing with the motion, and it is their sum that counts, so lengths follow a mean over this time, ...
const SPAN: f64 = 0.05;
/// ... in which the last step has this weight at least.
const WEIGHT: f64 = 0.002;
/// What remains of the sum of all errors: steady growth to 1 of an oscillation has a root mean square of 1/√6 over a run; a
/// little less, since errors partly cancel, as the scenes B1, C4 and X1 show.
const MEAN: f64 = 0.3;
/// Steps of a run at least.
const FEWEST: f64 = 50.0;
/// Of a run: steps that are tried when things begin to move, to see how far they will; the first are short, for the sake of
/// blows. Their lengths have no common measure, lest all of them end where a vibration passes through its middle.
const TRIALS: [f64; 6] = [1.7e-4, 7.1e-4, 2.9e-3, 0.011, 0.037, 0.053];
/// Of a run: after that the motion speaks for itself.
const AHEAD: f64 = 0.2;
/// Of the other kind of motion, over the model's length: less is rounding.
const TRACE: f64 = 1e-6;
/// An estimate of which two filters leave less is one of motion that the step does not resolve, a period of four steps or less;
/// unless there is motion beside it of which a third leaves more than their root.
const RESOLVED: f64 = 0.3;
/// Passages that leave nothing of such motion, and most of what has ten steps a period.
const PASSAGES: usize = 8;
/// Of the tolerance: such motion is left to the damping of the scheme while its amplitude is less: shorter steps would only draw
/// it out.
const SLIGHT: f64 = 2.0;

/// The length of steps. Allocated once.
pub struct Pace {
    /// Error of the displacements that the whole run is allowed, relative to the largest.
    tolerance: f64,
    /// c.
    constant: f64,
    /// Of the next step, and of the longest.
    length: f64,
    longest: f64,
    /// What a step would err, over what it may, and over its length squared: means of the last steps, of what lasts and of all.
    intensity: Option<f64>,
    usual: Option<f64>,
    /// Largest displacement of a node and turn of a body so far.
    motion: Size,
    measure: Measure,
    /// To go back to.
    start: State,
    /// Errors of a step per node, and room for one more passage.
    errors: [Vec<Vec6>; 2],
    lasting: Lasting,
}

/// What errors are compared with.
struct Measure {
    /// Largest motion of the trial, and when that was.
    ahead: Size,
    begun: Option<f64>,
    /// Of the scene: what displacements and turns are compared by.
    extent: f64,
    /// Nodes of bodies: the errors of their rotations count.
    bodies: Vec<usize>,
}

/// What lasts of the errors of steps, per node and over c Δt³: through a filter of one time constant and one of second order.
struct Lasting {
    first: Vec<Vec6>,
    value: Vec<Vec6>,
    /// Of the value, times the time constant.
    rate: Vec<Vec6>,
    /// The time constant of the last step; `None` before the first.
    tau: Option<f64>,
}

impl Lasting {
    /// Takes in the errors of a step of length `dt`, `per` c Δt³; implicit Euler for
    /// τ y₁' + y₁ = e and τ² y'' + τ y' + y = y₁.
    fn take(&mut self, errors: &[Vec6], per: f64, dt: f64, tau: f64) {
        let (s, stretched) = (dt / tau, self.tau.map(|before| tau / before));
        self.tau = Some(tau);
        for (i, error) in errors.iter().enumerate() {
            let error = error / per;
            let Some(stretched) = stretched else {
                (self.first[i], self.value[i]) = (error, error);
                continue;
            };
            let (first, value, rate) = (&mut self.first[i], &mut self.value[i], &mut self.rate[i]);
            *first += (error - *first) * (s / (1.0 + s));
            *rate = (*rate * stretched + (*first - *value) * s) / (1.0 + s + s * s);
            *value += *rate * s;
        }
    }
}

/// An estimated error relative to the largest motion.
struct Estimate {
    error: f64,
    /// With the motion at the end of the step.
    motion: Size,
}

impl Pace {
    pub fn new(model: &Model, tolerance: f64, extent: f64, state: &State) -> Self {
        let zeros = vec![Vec6::zeros(); state.nodes.len()];
        Pace {
            tolerance,
            constant: MEAN * error_constant(&*model.scheme),
            length: model.analysis.nominal_step(),
            longest: model.analysis.end_time / FEWEST,
            intensity: None,
            usual: None,
            motion: Size::default(),
            measure: Measure {
                ahead: Size::default(),
                begun: None,
                extent,
                bodies: model.bodies.iter().map(|body| body.node).collect(),
            },
            start: state.clone(),
            errors: [zeros.clone(), zeros.clone()],
            lasting: Lasting { first: zeros.clone(), value: zeros.clone(), rate: zeros, tau: None },
        }
    }

    /// After a step, which was a `part` of the run: whether it stands. The length of the next follows.
    fn judge(&mut self, dt: f64, time: f64, end: f64, estimate: &Estimate) -> bool {
        let part = dt / end;
        let ratio = estimate.error / (self.tolerance * part);
        let all = ratio / (dt * dt);
        let sudden = self.usual.is_none_or(|usual| all > TOO_MUCH * usual);
        if ratio > TOO_MUCH && sudden || !ratio.is_finite() {
            self.length = dt * if ratio.is_finite() { (SAFETY / ratio).sqrt().max(0.1) } else { 0.1 };
            self.intensity = Some(all).filter(|all| all.is_finite());
            return false;
        }
        // Errors so far are the less for what the motion has grown by.
        let whole = |motion: Size| motion.translation.max(motion.rotation * self.measure.extent);
        let (before, after) = (whole(self.motion), whole(estimate.motion));
        let grown = if before > 0.0 { after / before } else { 1.0 };
        self.motion = estimate.motion;
        let factor = self.constant * dt.powi(3);
        let tau = (self.constant * dt * dt * end).cbrt();
        self.lasting.take(&self.errors[0], factor, dt, tau);
        let lasting = factor * self.measure.relative(&self.lasting.value, self.motion, time, end);
        let lasting = lasting / (self.tolerance * part) / (dt * dt);
        let weight = (part / SPAN).clamp(WEIGHT, 1.0);
        let update =
            |mean: Option<f64>, now: f64| mean.map_or(now, |mean| mean / grown + weight * (now - mean / grown));
        let mean = update(self.intensity, lasting);
        self.intensity = Some(mean);
        self.usual = Some(update(self.usual, all));
        let allowed = 1.0 / mean.sqrt();
        if allowed < SAFETY * dt {
            self.length = SAFETY * allowed;
        } else if allowed > WORTH * dt {
            // A step may be short because of where it ends.
            self.length = (SAFETY * allowed).min(2.0 * dt.max(self.length)).min(self.longest);
        }
        true
    }
}

impl Measure {
    /// Largest displacements and turns so far, with those of a state.
    fn with(&self, largest: Size, model: &Model, state: &State) -> Size {
        let moved = state.nodes.iter().zip(&model.nodes).map(|(node, spec)| node.moved(&spec.x).norm());
        let turned = self.bodies.iter().map(|&body| 2.0 * state.nodes[body].q.imag().norm());
        Size {
            translation: moved.fold(largest.translation, f64::max),
            rotation: turned.fold(largest.rotation, f64::max),
        }
    }

    /// Errors per node, relative to the largest motion.
    fn relative(&self, errors: &[Vec6], motion: Size, time: f64, end: f64) -> f64 {
        let early = self.begun.is_some_and(|begun| time < begun + AHEAD * end);
        let ahead = if early { self.ahead } else { Size::default() };
        let (translation, rotation) = (motion.translation.max(ahead.translation), motion.rotation.max(ahead.rotation));
        // What is not a number must not vanish among those that are.
        let worst = |most: f64, e: f64| if e > most || e.is_nan() { e } else { most };
        let error = errors.iter().map(|e| top(e).norm()).fold(0.0, worst);
        let turn = self.bodies.iter().map(|&body| bottom(&errors[body]).norm()).fold(0.0, worst);
        // Nothing moves, nothing is wrong.
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        part(error, translation.max(TRACE * rotation * self.extent))
            .max(part(turn, rotation.max(translation / self.extent)))
    }
}

impl OwnLength for Pace {
    fn propose(&mut self, _: &mut Stepper, _: &State, _: f64) -> Result<f64, Failure> {
        Ok(self.length)
    }

    fn take(&mut self, stepper: &mut Stepper, state: &mut State, to: f64, _: f64) -> Result<Option<Taken>, Failure> {
        let dt = to - state.time;
        self.start.copy_from(state);
        let (drift, violation) = (stepper.drift, stepper.violation);
        let taken = stepper.step(state, to)?;
        let estimate = stepper.estimate(state, dt, self);
        if self.measure.begun.is_none() && estimate.motion != Size::default() {
            state.copy_from(&self.start);
            stepper.look_ahead(state, self);
            return Ok(None);
        }
        if self.judge(dt, state.time, stepper.model.analysis.end_time, &estimate) {
            return Ok(Some(taken));
        }
        state.copy_from(&self.start);
        (stepper.drift, stepper.violation) = (drift, violation);
        Err(Failure::Inaccurate { dt })
    }

    fn went_wrong(&mut self, _: &mut Stepper, dt: f64) {
        self.length = 0.5 * dt;
    }
}

impl Stepper<'_> {
    /// How far things move in a few long steps: errors at the start are small against that, whatever they are against the
    /// motion so far. By the trapezoidal rule, which does not overshoot.
    fn look_ahead(&mut self, state: &mut State, pace: &mut Pace) {
        let (drift, violation) = (self.drift, self.violation);
        let mut run = self.model.analysis.end_time;
        for part in TRIALS {
            let dt = part * run;
            let scheme = Newmark { gamma: 0.5, beta: 0.25, rotation: RotationUpdate::Exponential }.coefficients(dt);
            match self.stage(state, &scheme, state.time + dt) {
                Ok(_) => pace.measure.ahead = pace.measure.with(pace.measure.ahead, self.model, state),
                Err(_) => run *= 0.1,
            }
        }
        state.copy_from(&pace.start);
        self.refresh.rejected();
        (self.drift, self.violation) = (drift, violation);
        pace.measure.begun = Some(state.time);
    }

    /// Of a step of length `dt` to `state`.
    fn estimate(&mut self, state: &State, dt: f64, pace: &mut Pace) -> Estimate {
        let motion = pace.measure.with(pace.motion, self.model, state);
        let (time, end) = (state.time, self.model.analysis.end_time);
        let [errors, again] = &mut pace.errors;
        errors.fill(Vec6::zeros());
        let factor = pace.constant * dt.powi(3);
        for &node in &self.movers {
            let rows = self.plan.dofs.of(node);
            let (start, end) = (&pace.start.nodes[node], &state.nodes[node]);
            // Of the rotation vector of a step Θ‴ = α̇ − ½ ω×α: a body that spins turns α without changing it.
            let across = 0.25 * (start.omega.cross(&start.alpha) + end.omega.cross(&end.alpha));
            let third = state.jerk[node] - join(&Vec3::zeros(), &across);
            errors[node] = Vec6::from_fn(|i, _| if rows.has(i) { factor * third[i] } else { 0.0 });
        }
        self.system.carry(&state.nodes, errors);
        let mut passed = [pace.measure.relative(errors, motion, time, end); 3];
        for error in &mut passed[1..] {
            self.filter(state, errors);
            *error = pace.measure.relative(errors, motion, time, end);
        }
        // What is not resolved comes out of the first passage with about its amplitude.
        let [raw, amplitude, mut error] = passed;
        if amplitude < SLIGHT * pace.tolerance && error > pace.tolerance * dt / end && error < RESOLVED * raw {
            again.copy_from_slice(errors);
            self.filter(state, again);
            let left = pace.measure.relative(again, motion, time, end);
            if left < RESOLVED.sqrt() * error {
                // It is left alone; what else there is has to show.
                for _ in 0..PASSAGES {
                    self.filter(state, again);
                }
                error = pace.measure.relative(again, motion, time, end);
                std::mem::swap(errors, again);
            }
        }
        Estimate { error, motion }
    }

    /// e ← (K + w M)⁻¹ w M e, per node.
    fn filter(&mut self, state: &State, errors: &mut [Vec6]) {
        self.system.weigh(&state.nodes, errors, &mut self.forces);
        for (r, &(node, dof)) in self.r.iter_mut().zip(&self.plan.directions) {
            *r = self.mass_weight * self.forces.on_nodes[node][dof];
        }
        self.r[self.plan.directions.len()..].fill(0.0);
        self.solver.solve(&mut self.r);
        self.solves += 1;
        for &node in &self.movers {
            let rows = self.plan.dofs.of(node);
            errors[node] = rows.gather(&self.r);
        }
        self.system.carry(&state.nodes, errors);
    }
}
