//! Steps whose length follows an estimate of their error.
//!
//! In a step a scheme of second order puts a smooth motion wrong by c Δt³ |q‴|; for Newmark's that is the estimate of
//! O. C. Zienkiewicz & Y. M. Xie, Earthquake Eng. Struct. Dyn. 20 (1991). Modes that the step does not resolve have large
//! accelerations and hardly move, so the estimate e is passed through the matrix of the step, (K + w M)⁻¹ w M e, which
//! leaves what is resolved as it is (L. F. Shampine & L. S. Baca, J. Comput. Appl. Math. 11 (1984)). Errors of steps add up: each
//! step may take the part of the allowance that its length is of the run.

use super::march::{Run, Step};
use super::stations::Stretch;
use super::step::{Size, Stepper};
use super::{Observer, Outcome};
use crate::integrators::spectrum::error_constant;
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
/// What the step in hand weighs against those before it: errors swing with the motion, and it is their sum that counts.
const WEIGHT: f64 = 0.2;
/// Motion at the largest velocity for this part of the run counts as displacement: at the start there is none.
const GLANCE: f64 = 1e-3;

/// The length of steps. Allocated once.
pub struct Pace {
    /// Error of the displacements that the whole run is allowed, relative to the largest.
    tolerance: f64,
    /// c.
    constant: f64,
    /// Of the next step.
    length: f64,
    /// What a step would err, over what it may, and over its length squared: a mean of the last steps.
    intensity: Option<f64>,
    /// Largest so far.
    motion: Size,
    /// To go back to.
    start: State,
    /// Errors per node.
    errors: Vec<Vec6>,
}

impl Pace {
    pub fn new(model: &Model, tolerance: f64, state: &State) -> Self {
        Pace {
            tolerance,
            constant: error_constant(&model.scheme),
            length: model.analysis.time_step,
            intensity: None,
            motion: Size::default(),
            start: state.clone(),
            errors: vec![Vec6::zeros(); state.nodes.len()],
        }
    }

    /// After a step of this length, with its error over what it may be: whether it stands.
    fn judge(&mut self, dt: f64, ratio: f64, least: f64) -> bool {
        let now = ratio / (dt * dt);
        if (ratio > TOO_MUCH || ratio.is_nan()) && dt > least {
            let shorter = if ratio.is_finite() { (SAFETY / ratio).sqrt().max(0.1) } else { 0.1 };
            self.length = dt * shorter;
            self.intensity = Some(now).filter(|now| now.is_finite());
            return false;
        }
        let mean = self.intensity.map_or(now, |mean| mean + WEIGHT * (now - mean));
        self.intensity = Some(mean);
        let allowed = 1.0 / mean.sqrt();
        self.length = if allowed < SAFETY * dt {
            SAFETY * allowed
        } else if allowed > WORTH * dt {
            (SAFETY * allowed).min(2.0 * dt)
        } else {
            dt
        };
        true
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
        let analysis = &self.stepper.model.analysis;
        let least = analysis.least_step;
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
                    let ratio = self.stepper.error(state, dt, pace) * analysis.end_time / dt;
                    if !pace.judge(dt, ratio, least) {
                        state.copy_from(&pace.start);
                        cuts += 1;
                        self.counts.cuts += 1;
                        continue;
                    }
                    let at_end = state.time >= stretch.to;
                    let last = at_end && stretch.to >= analysis.end_time * (1.0 - 1e-9);
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
    /// Of a step of length `dt` to `state`: its error over what the whole run may err.
    fn error(&mut self, state: &State, dt: f64, pace: &mut Pace) -> f64 {
        let Pace { motion, errors, .. } = pace;
        let (mut speed, mut spin) = (0.0f64, 0.0f64);
        for (node, spec) in state.nodes.iter().zip(&self.model.nodes) {
            motion.translation = motion.translation.max((node.x - spec.x).norm());
            motion.rotation = motion.rotation.max(2.0 * node.q.imag().norm());
            speed = speed.max(node.v.norm());
            spin = spin.max(node.omega.norm());
        }
        let ahead = GLANCE * self.model.analysis.end_time;
        let translation = motion.translation.max(ahead * speed);
        let rotation = motion.rotation.max(ahead * spin).max(translation / self.length);
        self.estimate(state, pace.constant * dt.powi(3), errors);
        let mut size = Size::default();
        for e in errors.iter() {
            size.translation = size.translation.max(top(e).norm());
            size.rotation = size.rotation.max(bottom(e).norm());
        }
        // Nothing moves, nothing is wrong.
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        part(size.translation, translation).max(part(size.rotation, rotation)) / pace.tolerance
    }

    /// (K + w M)⁻¹ w M e with e = `factor` q‴, per node.
    fn estimate(&mut self, state: &State, factor: f64, errors: &mut [Vec6]) {
        errors.fill(Vec6::zeros());
        for &node in &self.movers {
            let rows = &self.plan.rows[node];
            errors[node] = Vec6::from_fn(|i, _| if rows[i] == NONE { 0.0 } else { factor * state.jerk[node][i] });
        }
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
