//! A step by central differences.

use super::explicit::Explicit;
use super::failure::Failure;
use super::step::{Stepper, Taken};
use crate::integrators::Coefficients;
use crate::materials::Dissipation;
use crate::math::{Vec6, bottom, join, top};
use crate::state::{Configuration, State, Work};
use crate::system::masses::{CORRECTIONS, Motion};

impl Stepper<'_> {
    /// Takes `state` from its time to `to`. On failure `state` is untouched.
    pub(super) fn central_difference(&mut self, state: &mut State, to: f64) -> Result<Taken, Failure> {
        let Some(mut explicit) = self.explicit.take() else { return Err(self.not_finite()) };
        let counts = explicit.stable.counts();
        let result = self.leap(&mut explicit, state, to, &self.model.scheme.coefficients(to - state.time));
        if result.is_err() {
            explicit.stable.refused(counts);
        }
        self.explicit = Some(explicit);
        result
    }

    fn leap(
        &mut self,
        explicit: &mut Explicit,
        state: &mut State,
        to: f64,
        scheme: &Coefficients,
    ) -> Result<Taken, Failure> {
        let dt = to - state.time;
        if self.system.has_contacts() {
            self.check_length(state, dt)?;
        }
        self.check_stable(explicit, state, dt)?;
        let mut evaluations = self.find_accelerations(explicit, state, to, scheme)?;
        let stiffened = self.resistance(explicit, state, dt) > explicit.stable.known();
        let mut accelerations = self.weigh_accelerations(explicit, None);
        if stiffened || explicit.stable.is_struck(accelerations) || self.is_growing(explicit, state, dt) {
            for &node in &self.movers {
                explicit.stable.hints[node] = self.change(explicit, state, node);
            }
            self.look_at_limit(explicit, state, dt, true)?;
            match explicit.stable.longest {
                Some(longest) if dt > longest => {
                    return Err(Failure::Unstable { dt, longest, automatic: explicit.control.is_some() });
                }
                _ => {}
            }
            // It only looked so, and looking closer has left nothing of what was found.
            evaluations += self.find_accelerations(explicit, state, to, scheme)?;
            accelerations = self.weigh_accelerations(explicit, None);
        }
        // Bodies take their angular momentum from all that acts on them.
        if let Some(ties) = &explicit.ties {
            ties.pull(&mut self.forces.on_nodes);
        }
        for k in 0..self.movers.len() {
            let node = self.movers[k];
            let (start, now) = (&state.nodes[node], &self.trial[node]);
            let motion = match explicit.masses.as_ref().and_then(|masses| masses.of(node)) {
                Some(block) => block.verlet(start, now, &self.forces.on_nodes[node], dt),
                None => mean(start, now, &explicit.push[node], dt),
            };
            self.set_rates_of(node, &motion);
        }
        let mut damping_power = 0.0;
        if self.wants_forces {
            self.settle_forces(explicit, state, dt);
            if self.system.is_damped() {
                let now = Configuration { nodes: &self.trial, history: &state.history, dt: dt };
                damping_power = self.system.damping_power(&now, self.plan.threads);
            }
        }
        let mut spent = Dissipation::default();
        if self.system.history > 0 {
            let now = Configuration { nodes: &self.trial, history: &state.history, dt: dt };
            spent = self.system.update_history(&now, 1.0, &mut self.history, self.plan.threads);
        }
        self.arrive(state, scheme);
        if explicit.closes() {
            self.close_joints(state, scheme, dt)?;
        } else if explicit.ties.is_some() {
            self.close_ties(explicit, state, dt)?;
        }
        if self.system.has_contacts() {
            self.check_contacts(state, dt)?;
        }
        self.check_joints()?;
        self.commit(state, scheme, to, spent, Some(damping_power));
        explicit.stable.took(accelerations);
        let Work { swing, accelerations: before, step, .. } = &mut state.work;
        // ⅛ Δt² aᵀMa at both ends, each with the step before it: what a change of the step makes or takes does not swing.
        let last = if *step > 0.0 { *step } else { dt };
        *swing += 0.125 * (dt * dt * accelerations - last * last * *before);
        (*before, *step) = (accelerations, dt);
        Ok(Taken { iterations: evaluations, refactorizations: 0, residual: 0.0, to })
    }

    /// The trial motion at the end of the step, with predicted velocities, and what is missing of its accelerations; returns how
    /// many residuals that took.
    fn find_accelerations(
        &mut self,
        explicit: &mut Explicit,
        state: &State,
        to: f64,
        scheme: &Coefficients,
    ) -> Result<usize, Failure> {
        let dt = to - state.time;
        self.give(state.time, to, 1.0);
        self.predict(state, scheme);
        if explicit.ties.is_some() {
            self.forces.multipliers.values.fill(0.0);
        }
        self.move_trial(state, scheme);
        let mut evaluations = 0;
        // Where masses belong together: gyroscopic moments of bodies would feed the motion if they met the predicted velocities alone.
        let corrections = if explicit.closes() { CORRECTIONS } else { 0 };
        loop {
            let now = Configuration { nodes: &self.trial, history: &state.history, dt: dt };
            self.system.residual(&now, &self.given[2], &mut self.forces);
            evaluations += 1;
            self.answer(explicit, state, true)?;
            if evaluations > corrections {
                break;
            }
            for k in 0..self.movers.len() {
                let node = self.movers[k];
                let Motion { v, omega, .. } = mean(&state.nodes[node], &self.trial[node], &explicit.push[node], dt);
                let (a, alpha) = (self.trial[node].a, self.trial[node].alpha);
                self.set_rates_of(node, &Motion { v, omega, a, alpha });
            }
            self.arrive(state, scheme);
        }
        if self.is_finite(explicit) { Ok(evaluations) } else { Err(self.not_finite()) }
    }

    fn set_rates_of(&mut self, node: usize, motion: &Motion) {
        self.set_rates(node, [motion.v, motion.omega, motion.a, motion.alpha]);
    }

    /// ω² of the mode as which the scene has resisted over the step, −Δaᵀ M q/qᵀ M q: of its modes a mean. More than that of the
    /// fastest there was tells that it has stiffened, as where something is struck. Zero where the step is short for it anyway.
    fn resistance(&mut self, explicit: &mut Explicit, state: &State, dt: f64) -> f64 {
        // Of the limit, by inertias about: below, nothing is looked at closer.
        const QUICK: f64 = 0.05;
        let Some(masses) = &explicit.masses else {
            self.weigh_together(&mut explicit.room, None, |stepper, node| stepper.increments[node].q);
            let size = self.times_weighed(|node| self.increments[node].q);
            let force = -self.times_weighed(|node| self.change(explicit, state, node));
            return if size > 0.0 { force / size } else { 0.0 };
        };
        let (mut force, mut size) = (0.0, 0.0);
        for block in &masses.blocks {
            let [mass, inertia] = block.about();
            let (da, q) = (self.change(explicit, state, block.node), &self.increments[block.node].q);
            force -= mass * top(&da).dot(&top(q)) + inertia * bottom(&da).dot(&bottom(q));
            size += mass * top(q).norm_squared() + inertia * bottom(q).norm_squared();
        }
        if force <= QUICK * 4.0 / (dt * dt) * size {
            return 0.0;
        }
        (force, size) = (0.0, 0.0);
        for block in &masses.blocks {
            let (da, q) = (self.change(explicit, state, block.node), &self.increments[block.node].q);
            let node = &self.trial[block.node];
            force -= block.weigh(node, &da, q);
            size += block.weigh(node, q, q);
        }
        force / size
    }

    /// Of a node's accelerations over the step.
    fn change(&self, explicit: &Explicit, state: &State, node: usize) -> Vec6 {
        let (start, now) = (&state.nodes[node], &self.trial[node]);
        join(&(now.a - start.a), &(now.alpha - start.alpha)) + explicit.push[node]
    }

    /// A quick look at whether a mode grows: without loads and dampers, −(a₁ − 2 a₀ + a₋₁)ᵀM a₀/a₀ᵀM a₀ is (ω Δt)², of all modes a
    /// mean, which the motion of the whole does not hide; what dies out is no matter.
    fn is_growing(&mut self, explicit: &mut Explicit, state: &State, dt: f64) -> bool {
        // A little beyond what a mode at the limit shows.
        const LIMIT: f64 = 4.1;
        let before = |node: usize| join(&state.nodes[node].a, &state.nodes[node].alpha);
        let Some(masses) = &explicit.masses else {
            self.weigh_together(&mut explicit.room, None, |_, node| before(node));
            let size = self.times_weighed(before);
            let second = |node: usize| self.change(explicit, state, node) - state.jerk[node] * dt;
            if -self.times_weighed(second) <= LIMIT * size {
                return false;
            }
            let mut room = std::mem::take(&mut explicit.room);
            let now = |stepper: &Self, node: usize| before(node) + stepper.change(explicit, state, node);
            self.weigh_together(&mut room, None, now);
            let next = self.times_weighed(|node| now(self, node));
            explicit.room = room;
            return next > size;
        };
        let (mut change, mut size, mut next) = (0.0, 0.0, 0.0);
        for block in &masses.blocks {
            let start = &state.nodes[block.node];
            let [mass, inertia] = block.about();
            let first = self.change(explicit, state, block.node);
            let second = first - state.jerk[block.node] * dt;
            let now = first + join(&start.a, &start.alpha);
            next += mass * top(&now).norm_squared() + inertia * bottom(&now).norm_squared();
            change -= mass * top(&second).dot(&start.a) + inertia * bottom(&second).dot(&start.alpha);
            size += mass * start.a.norm_squared() + inertia * start.alpha.norm_squared();
        }
        change > LIMIT * size && next > size
    }
}

/// Rates at the end of a step by the mean of the accelerations.
fn mean(start: &crate::state::Node, now: &crate::state::Node, push: &Vec6, dt: f64) -> Motion {
    let (a, alpha) = (now.a + top(push), now.alpha + bottom(push));
    let old = join(&start.a, &start.alpha);
    let both = (old + join(&a, &alpha)) * (0.5 * dt);
    Motion { v: start.v + top(&both), omega: start.omega + bottom(&both), a, alpha }
}
