//! Steps whose length follows an estimate of their error.
//!
//! In a step a scheme of second order puts a smooth motion wrong by c Δt³ |q‴|; for Newmark's that is the estimate of
//! O. C. Zienkiewicz & Y. M. Xie, Earthquake Eng. Struct. Dyn. 20 (1991). Modes that the step does not resolve have large
//! accelerations and hardly move, so the estimate e is passed through the matrix of the step, (K + w M)⁻¹ w M e, which
//! leaves what is resolved as it is (L. F. Shampine & L. S. Baca, J. Comput. Appl. Math. 11 (1984)). Errors of steps add up: each
//! step may take the part of the allowance that its length is of the run.

use super::failure::Failure;
use super::march::{Run, Step};
use super::stations::Stretch;
use super::step::{Size, Stepper};
use super::{Observer, Outcome};
use crate::integrators::spectrum::error_constant;
use crate::integrators::{RotationUpdate, newmark};
use crate::math::{Vec6, bottom, top};
use crate::model::Model;
use crate::state::State;
use crate::system::assembly::NONE;
use std::sync::atomic::Ordering;

/// Of what a step may err, where it is taken back.
const TOO_MUCH: f64 = 4.0;
/// Of a length that would just do: for the next step to be no more than that.
const SAFETY: f64 = 0.9;
/// A new length costs a new matrix: steps grow once they may by as much, by no more than twice.
const WORTH: f64 = 1.4;
/// Of a run: errors swing with the motion, and it is their sum that counts, so lengths follow a mean over this time, ...
const SPAN: f64 = 0.05;
/// ... in which the last step has this weight at least.
const WEIGHT: f64 = 0.002;
/// What remains of the sum of all errors: steady growth to 1 has a root mean square of 1/√3 over a run, and an oscillation one of
/// 1/√2; a little less, since errors partly cancel, as the scenes B1, C4 and X1 show.
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
    /// What a step would err, over what it may, and over its length squared: a mean of the last steps.
    intensity: Option<f64>,
    /// Largest displacement of a node and turn of a body so far.
    motion: Size,
    /// The same of the trial, and when that was.
    ahead: Size,
    begun: Option<f64>,
    /// Of the scene: what displacements and turns are compared by.
    extent: f64,
    /// Nodes of bodies: the errors of their rotations count.
    bodies: Vec<usize>,
    /// To go back to.
    start: State,
    /// Errors per node.
    errors: Vec<Vec6>,
}

/// An estimated error relative to the largest motion.
struct Estimate {
    /// As it is, and after one and two passages through the matrix. What is not resolved comes out of the first with about its
    /// amplitude.
    passed: [f64; 3],
    /// All of it that is more than a step may err: motion that the step does not resolve.
    unresolved: bool,
    /// With the motion at the end of the step.
    motion: Size,
}

impl Pace {
    pub fn new(model: &Model, tolerance: f64, extent: f64, state: &State) -> Self {
        Pace {
            tolerance,
            constant: MEAN * error_constant(&model.scheme),
            length: model.analysis.time_step,
            longest: model.analysis.end_time / FEWEST,
            intensity: None,
            motion: Size::default(),
            ahead: Size::default(),
            begun: None,
            extent,
            bodies: model.bodies.iter().map(|body| body.node).collect(),
            start: state.clone(),
            errors: vec![Vec6::zeros(); state.nodes.len()],
        }
    }

    /// After a step, which was a `part` of the run: whether it stands. The length of the next follows.
    fn judge(&mut self, dt: f64, part: f64, estimate: &Estimate) -> bool {
        let [_, amplitude, error] = estimate.passed;
        let ratio = error / (self.tolerance * part);
        if estimate.unresolved && amplitude < SLIGHT * self.tolerance {
            self.motion = estimate.motion;
            return true;
        }
        let now = ratio / (dt * dt);
        if ratio > TOO_MUCH || !ratio.is_finite() {
            self.length = dt * if ratio.is_finite() { (SAFETY / ratio).sqrt().max(0.1) } else { 0.1 };
            self.intensity = Some(now).filter(|now| now.is_finite());
            return false;
        }
        // Errors so far are the less for what the motion has grown by.
        let whole = |motion: Size| motion.translation.max(motion.rotation * self.extent);
        let (before, after) = (whole(self.motion), whole(estimate.motion));
        let grown = if before > 0.0 { after / before } else { 1.0 };
        self.motion = estimate.motion;
        let weight = (part / SPAN).clamp(WEIGHT, 1.0);
        let mean = self.intensity.map_or(now, |mean| mean / grown + weight * (now - mean / grown));
        self.intensity = Some(mean);
        let allowed = 1.0 / mean.sqrt();
        if allowed < SAFETY * dt {
            self.length = SAFETY * allowed;
        } else if allowed > WORTH * dt {
            // A step may be short because of where it ends.
            self.length = (SAFETY * allowed).min(2.0 * dt.max(self.length)).min(self.longest);
        }
        true
    }

    /// Largest displacements and turns so far, with those of a state.
    fn with(&self, largest: Size, model: &Model, state: &State) -> Size {
        let moved = state.nodes.iter().zip(&model.nodes).map(|(node, spec)| node.moved(&spec.x).norm());
        let turned = self.bodies.iter().map(|&body| 2.0 * state.nodes[body].q.imag().norm());
        Size {
            translation: moved.fold(largest.translation, f64::max),
            rotation: turned.fold(largest.rotation, f64::max),
        }
    }

    /// The errors at hand, relative to the largest motion.
    fn relative(&self, motion: Size, time: f64, end: f64) -> f64 {
        let early = self.begun.is_some_and(|begun| time < begun + AHEAD * end);
        let ahead = if early { self.ahead } else { Size::default() };
        let (translation, rotation) = (motion.translation.max(ahead.translation), motion.rotation.max(ahead.rotation));
        let error = self.errors.iter().map(|e| top(e).norm()).fold(0.0, f64::max);
        let turn = self.bodies.iter().map(|&body| bottom(&self.errors[body]).norm()).fold(0.0, f64::max);
        // Nothing moves, nothing is wrong.
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        part(error, translation.max(TRACE * rotation * self.extent))
            .max(part(turn, rotation.max(translation / self.extent)))
    }
}

impl Run<'_> {
    /// Through a stretch in steps of equal length as long as nothing asks for another.
    pub(super) fn follow_error(
        &mut self,
        state: &mut State,
        stretch: &Stretch,
        pace: &mut Pace,
        observer: &mut dyn Observer,
        balance: Option<f64>,
    ) -> Result<(), Outcome> {
        let model = self.stepper.model;
        let (end, least) = (model.analysis.end_time, model.analysis.least_step);
        let mut cuts = 0;
        while state.time < stretch.to {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Outcome::Stopped { time: state.time });
            }
            let left = stretch.to - state.time;
            let pieces = (left / pace.length * (1.0 - 1e-9)).ceil().max(1.0);
            let target = if pieces == 1.0 { stretch.to } else { state.time + left / pieces };
            let dt = target - state.time;
            pace.start.copy_from(state);
            match self.stepper.step(state, target) {
                Ok(taken) => {
                    let estimate = self.stepper.estimate(state, dt, pace);
                    if pace.begun.is_none() && estimate.motion != Size::default() {
                        state.copy_from(&pace.start);
                        self.stepper.look_ahead(state, pace);
                        continue;
                    }
                    if !pace.judge(dt, dt / end, &estimate) {
                        state.copy_from(&pace.start);
                        if dt <= least {
                            let failure = Failure::Inaccurate { dt };
                            return Err(Outcome::Failed { time: state.time, failure });
                        }
                        cuts += 1;
                        self.counts.cuts += 1;
                        continue;
                    }
                    let at_end = state.time >= stretch.to;
                    let last = at_end && stretch.to >= end * (1.0 - 1e-9);
                    let step = Step { dt, taken: &taken, cuts, due: at_end && stretch.due, last, passed: &[] };
                    self.show(state, observer, balance, &step)?;
                    cuts = 0;
                }
                Err(failure) => {
                    if dt <= least {
                        return Err(Outcome::Failed { time: state.time, failure });
                    }
                    pace.length = 0.5 * dt;
                    cuts += 1;
                    self.counts.cuts += 1;
                }
            }
        }
        Ok(())
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
            let scheme = newmark(0.5, 0.25, RotationUpdate::Exponential).coefficients(dt);
            match self.stage(state, &scheme, state.time + dt) {
                Ok(_) => pace.ahead = pace.with(pace.ahead, self.model, state),
                Err(_) => run *= 0.1,
            }
        }
        state.copy_from(&pace.start);
        self.refresh.rejected();
        (self.drift, self.violation) = (drift, violation);
        pace.begun = Some(state.time);
    }

    /// Of a step of length `dt` to `state`.
    fn estimate(&mut self, state: &State, dt: f64, pace: &mut Pace) -> Estimate {
        let motion = pace.with(pace.motion, self.model, state);
        let (time, end) = (state.time, self.model.analysis.end_time);
        pace.errors.fill(Vec6::zeros());
        let factor = pace.constant * dt.powi(3);
        for &node in &self.movers {
            let rows = &self.plan.rows[node];
            let entry = |i: usize| if rows[i] == NONE { 0.0 } else { factor * state.jerk[node][i] };
            pace.errors[node] = Vec6::from_fn(|i, _| entry(i));
        }
        self.system.carry(&state.nodes, &mut pace.errors);
        let mut passed = [pace.relative(motion, time, end); 3];
        for error in &mut passed[1..] {
            self.filter(state, &mut pace.errors);
            *error = pace.relative(motion, time, end);
        }
        let [raw, _, error] = passed;
        let mut unresolved = error > pace.tolerance * dt / end && error < RESOLVED * raw;
        if unresolved {
            self.filter(state, &mut pace.errors);
            unresolved = pace.relative(motion, time, end) < RESOLVED.sqrt() * error;
        }
        Estimate { passed, unresolved, motion }
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
            let rows = &self.plan.rows[node];
            errors[node] = Vec6::from_fn(|i, _| if rows[i] == NONE { 0.0 } else { self.r[rows[i] as usize] });
        }
        self.system.carry(&state.nodes, errors);
    }
}
