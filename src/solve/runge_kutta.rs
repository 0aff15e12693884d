//! A step by an explicit Runge-Kutta scheme, of given length or with its own error under control.

use super::correction::Size;
use super::explicit::Explicit;
use super::failure::Failure;
use super::step::{Stepper, Taken};
use crate::integrators::Stepping;
use crate::integrators::tableau::{Tableau, Weights};
use crate::materials::Dissipation;
use crate::math::rotation::{exp, inverse_tangent, renormalise};
use crate::math::{Vec6, bottom, join, top};
use crate::model::Model;
use crate::state::{Configuration, State};
use crate::system::Side;

/// The square of the longest rotation vector: T⁻¹ is singular at a whole turn.
const FARTHEST: f64 = 9.0;

/// Of a length that would just do.
const SAFETY: f64 = 0.9;
/// A step is at most so many times the one before it, and at least so much of it.
const GROWTH: [f64; 2] = [0.2, 5.0];
/// Motion at the largest velocity for this part of the run counts as displacement: at the start there is none.
const GLANCE: f64 = 1e-3;

/// Length of steps by their error.
#[derive(Debug, Clone, Copy)]
pub struct Control {
    /// Error of the displacements that the whole run is allowed, relative to the largest.
    tolerance: f64,
    end_time: f64,
    /// Of the next step; with central differences the most that it may be.
    pub next: f64,
    /// Largest displacement and rotation so far.
    motion: Size,
}

impl Control {
    pub fn new(tolerance: f64, model: &Model) -> Self {
        let (end_time, time_step) = (model.analysis.end_time, model.analysis.nominal_step());
        let controls = matches!(model.scheme.stepping(), Stepping::RungeKutta(_));
        let next = if controls { time_step } else { f64::INFINITY };
        Control { tolerance, end_time, next, motion: Size::default() }
    }
}

impl Stepper<'_> {
    /// Takes `state` from its time to `to`. On failure `state` is untouched.
    pub(super) fn runge_kutta(
        &mut self,
        state: &mut State,
        to: f64,
        tableau: &'static Tableau,
    ) -> Result<Taken, Failure> {
        let Some(mut explicit) = self.explicit.take() else { return Err(self.not_finite()) };
        let before = explicit.control;
        let result = self.take(&mut explicit, state, to, tableau);
        if let (Err(_), Some(before), Some(control)) = (&result, before, &mut explicit.control) {
            // What contacts or joints refuse has not moved: errors are not to be judged by it.
            control.motion = before.motion;
        }
        self.explicit = Some(explicit);
        result
    }

    fn take(
        &mut self,
        explicit: &mut Explicit,
        state: &mut State,
        to: f64,
        tableau: &Tableau,
    ) -> Result<Taken, Failure> {
        let dt = to - state.time;
        if self.system.has_contacts() {
            self.check_length(state, dt)?;
        }
        self.give(state.time, to, 1.0);
        if !self.system.joints.is_empty() {
            self.measure_reach(state);
            self.forces.multipliers.values.copy_from_slice(&state.multipliers);
        }
        explicit.work = [0.0; 2];
        for (k, &node) in self.movers.iter().enumerate() {
            let start = &state.nodes[node];
            explicit.stages[k] = [join(&start.v, &start.omega), join(&start.a, &start.alpha)];
        }
        if self.wants_energy {
            self.begin_work(explicit, state, dt * weight_of(tableau.b, 0));
        }
        let inner = tableau.a.iter().zip(tableau.c).enumerate();
        for (stage, (weights, c)) in inner.map(|(i, of)| (i + 1, of)) {
            self.stage_at(explicit, state, (stage, weights, *c), to)?;
            self.evaluate(explicit, state, stage, c * dt)?;
            if self.wants_energy {
                self.add_work(explicit, state, dt * weight_of(tableau.b, stage), c * dt);
            }
        }
        let end = tableau.stages() - 1;
        self.stage_at(explicit, state, (end, tableau.b, 1.0), to)?;
        if explicit.ties.is_some() {
            self.close_ties(explicit, state, dt)?;
        }
        self.evaluate(explicit, state, end, dt)?;
        if !self.is_finite(explicit) {
            return Err(self.not_finite());
        }
        self.judge(explicit, tableau, dt)?;
        if self.wants_forces {
            self.settle_forces(explicit, state, dt);
        }
        for k in 0..self.movers.len() {
            let node = self.movers[k];
            let [_, rate] = explicit.stages[end * self.movers.len() + k];
            let trial = &self.trial[node];
            self.set_rates(node, [trial.v, trial.omega, top(&rate), bottom(&rate)]);
            (self.trial[node].a, self.trial[node].alpha) = (top(&rate), bottom(&rate));
        }
        self.carry_riders(&state.nodes);
        if explicit.closes() {
            let scheme = self.coefficients(dt);
            self.close_joints(state, &scheme, dt)?;
        }
        let mut spent = Dissipation::default();
        if self.system.history > 0 {
            let now = Configuration { nodes: &self.trial, history: &state.history, dt: dt };
            spent = self.system.update_history(&now, 1.0, &mut self.history, self.plan.threads);
        }
        if self.system.has_contacts() {
            self.check_contacts(state, dt)?;
        }
        self.check_joints()?;
        let scheme = self.coefficients(dt);
        self.commit(state, &scheme, to, spent, None);
        if self.wants_forces {
            for (reaction, held) in state.reactions.iter_mut().zip(&self.model.held) {
                *reaction = -self.forces.on_nodes[held.node][held.dof];
            }
            state.work.external += explicit.work[0];
            state.work.damping += explicit.work[1];
        }
        Ok(Taken { iterations: end, refactorizations: 0, residual: 0.0, to })
    }

    /// The trial motion of a stage `c` of the way, from the rates of those before it.
    fn stage_at(
        &mut self,
        explicit: &mut Explicit,
        state: &State,
        (stage, weights, c): (usize, Weights, f64),
        to: f64,
    ) -> Result<(), Failure> {
        let dt = to - state.time;
        let movers = self.movers.len();
        for (k, &node) in self.movers.iter().enumerate() {
            let start = &state.nodes[node];
            let [mut q, mut v] = [Vec6::zeros(); 2];
            for &(of, weight) in weights {
                let [dq, dv] = &explicit.stages[of * movers + k];
                q += dq * weight;
                v += dv * weight;
            }
            let increment = &mut self.increments[node];
            increment.q = q * dt;
            increment.d = join(&start.v, &start.omega) + v * dt;
            increment.dd = Vec6::zeros();
        }
        if explicit.driven {
            self.drive_stage(state.time + c * dt, c);
        }
        let mut farthest = 0.0f64;
        for (k, &node) in self.movers.iter().enumerate() {
            let start = &state.nodes[node];
            let increment = &mut self.increments[node];
            let (theta, omega) = (bottom(&increment.q), bottom(&increment.d));
            let trial = &mut self.trial[node];
            trial.place(&start.x, &start.low, &top(&increment.q));
            trial.v = top(&increment.d);
            trial.omega = omega;
            (trial.a, trial.alpha) = (top(&increment.dd), bottom(&increment.dd));
            let angle = theta.norm_squared();
            if angle > 0.0 {
                farthest = farthest.max(angle);
                trial.q = renormalise(&(exp(&theta) * start.q));
                let turn = inverse_tangent(&theta, &omega);
                increment.d = join(&trial.v, &turn);
            } else {
                trial.q = start.q;
            }
            explicit.stages[stage * movers + k][0] = increment.d;
        }
        if farthest > FARTHEST || farthest.is_nan() {
            return Err(Failure::Turned { dt });
        }
        self.carry_riders(&state.nodes);
        if explicit.varying && c < 1.0 {
            self.drive.loading(state.time + c * dt, Side::Before, &mut self.given[2]);
        } else if explicit.varying {
            self.drive.loading(to, Side::Before, &mut self.given[2]);
        }
        Ok(())
    }

    /// Held directions that move, at a time within the step.
    fn drive_stage(&mut self, time: f64, c: f64) {
        // What is given at the end is at hand.
        if c < 1.0 {
            self.drive.held(time, &mut self.held[2]);
        } else {
            let [_, end, at] = &mut self.held;
            at.copy_from_slice(end);
        }
        for (i, held) in self.model.held.iter().enumerate().filter(|(_, held)| held.motion.is_some()) {
            let (from, now) = (&self.held[0][i], &self.held[2][i]);
            let increment = &mut self.increments[held.node];
            // A rotation that goes with others which are free is that of its rate alone.
            let alone = held.dof < 3 || (3..6).all(|dof| !self.plan.is_unknown(held.node, dof));
            if alone {
                increment.q[held.dof] = now.u - from.u;
            }
            increment.d[held.dof] = now.v;
            increment.dd[held.dof] = now.a;
        }
    }

    /// Accelerations of the trial motion, as rates of a stage.
    fn evaluate(&mut self, explicit: &mut Explicit, state: &State, stage: usize, since: f64) -> Result<(), Failure> {
        if explicit.ties.is_some() {
            self.forces.multipliers.values.fill(0.0);
        }
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
        self.system.residual(&now, &self.given[2], &mut self.forces);
        self.answer(explicit, state, true)?;
        let movers = self.movers.len();
        for (k, &node) in self.movers.iter().enumerate() {
            let trial = &self.trial[node];
            explicit.stages[stage * movers + k][1] = join(&trial.a, &trial.alpha) + explicit.push[node];
        }
        Ok(())
    }

    /// With an error to be kept: notes how long the next step may be.
    ///
    /// # Errors
    /// [`Failure::Inaccurate`] where this one was too long.
    fn judge(&mut self, explicit: &mut Explicit, tableau: &Tableau, dt: f64) -> Result<(), Failure> {
        let Some(mut control) = explicit.control else { return Ok(()) };
        let motion = &mut control.motion;
        let (mut speed, mut spin) = (0.0f64, 0.0f64);
        for &node in &self.movers {
            let (now, first) = (&self.trial[node], &self.model.nodes[node]);
            motion.translation = motion.translation.max((now.x - first.x).norm());
            motion.rotation = motion.rotation.max(2.0 * now.q.imag().norm());
            speed = speed.max(now.v.norm());
            spin = spin.max(now.omega.norm());
        }
        let ahead = GLANCE * control.end_time;
        let translation = motion.translation.max(ahead * speed);
        let rotation = motion.rotation.max(ahead * spin).max(translation / self.length);
        let error = self.error_of(explicit, tableau, dt);
        let part = |error: f64, of: f64| if error == 0.0 { 0.0 } else { error / of };
        let error = part(error.translation, translation).max(part(error.rotation, rotation));
        // Errors of steps add up: each may take the part of the allowance that its length is of the run.
        let ratio = error * control.end_time / (dt * control.tolerance);
        let [least, most] = GROWTH;
        let factor = (SAFETY * ratio.powf(-1.0 / (tableau.error_order - 1.0))).clamp(least, most);
        control.next = dt * if factor.is_nan() { least } else { factor };
        if ratio > 1.0 || ratio.is_nan() {
            if let Some(kept) = &mut explicit.control {
                kept.next = control.next.min(SAFETY * dt);
            }
            return Err(Failure::Inaccurate { dt });
        }
        explicit.control = Some(control);
        Ok(())
    }

    /// Of a step that has been evaluated to its end: the largest errors of translations and rotations.
    fn error_of(&self, explicit: &Explicit, tableau: &Tableau, dt: f64) -> Size {
        let movers = self.movers.len();
        let mut largest = [Size::default(); 2];
        for k in 0..movers {
            for (largest, weights) in largest.iter_mut().zip(tableau.errors) {
                let sum = |sum: Vec6, &(of, weight): &(usize, f64)| sum + explicit.stages[of * movers + k][0] * weight;
                let error = weights.iter().fold(Vec6::zeros(), sum);
                largest.translation = largest.translation.max(top(&error).norm());
                largest.rotation = largest.rotation.max(bottom(&error).norm());
            }
        }
        let [first, second] = largest;
        let mixed = |e: f64, other: f64| {
            if tableau.errors.len() == 1 || e == 0.0 {
                dt * e
            } else {
                dt * e * e / (e * e + 0.01 * other * other).sqrt()
            }
        };
        Size {
            translation: mixed(first.translation, second.translation),
            rotation: mixed(first.rotation, second.rotation),
        }
    }

    /// Work over a step is a quadrature with the weights of the scheme; the share of its start.
    fn begin_work(&mut self, explicit: &mut Explicit, state: &State, weight: f64) {
        let system = self.system;
        system.external(&state.nodes, &self.given[0], &mut self.forces);
        explicit.work[0] += weight * (self.external_power(&state.nodes) + self.driving_power(&state.reactions, 0));
        if system.is_damped() {
            explicit.work[1] += weight * system.damping_power(&state.configuration(), self.plan.threads);
        }
    }

    /// The share of a stage that has been evaluated.
    fn add_work(&mut self, explicit: &mut Explicit, state: &State, weight: f64, since: f64) {
        if weight == 0.0 {
            return;
        }
        let system = self.system;
        if explicit.driven {
            self.settle_forces(explicit, state, since);
            let power = self.held_power();
            explicit.work[0] += weight * power;
        }
        if system.is_damped() {
            let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
            explicit.work[1] += weight * system.damping_power(&now, self.plan.threads);
        }
        system.external(&self.trial, &self.given[2], &mut self.forces);
        explicit.work[0] += weight * self.external_power(&self.trial);
    }

    /// Of the forces at hand on nodes that move so.
    fn external_power(&self, nodes: &[crate::state::Node]) -> f64 {
        let power = |(F, node): (&[f64; 6], &crate::state::Node)| -> f64 {
            F.iter().zip(node.v.iter().chain(&node.omega)).map(|(f, v)| f * v).sum()
        };
        self.forces.on_nodes.iter().zip(nodes).map(power).sum()
    }

    fn driving_power(&self, reactions: &[f64], at: usize) -> f64 {
        reactions.iter().zip(&self.held[at]).map(|(reaction, given)| reaction * given.v).sum()
    }

    /// Of the forces at hand on directions that are driven.
    fn held_power(&self) -> f64 {
        let held = self.model.held.iter().zip(&self.held[2]);
        held.map(|(held, given)| -self.forces.on_nodes[held.node][held.dof] * given.v).sum()
    }
}

/// Of a stage in a sum.
fn weight_of(weights: Weights, stage: usize) -> f64 {
    weights.iter().find(|(of, _)| *of == stage).map_or(0.0, |(_, weight)| *weight)
}
