//! The end of a step: reactions and plastic strains carried there, work accounted for, the state written once.

use super::failure::Failure;
use super::step::Stepper;
use crate::integrators::Coefficients;
use crate::materials::Dissipation;
use crate::math::rotation::rates;
use crate::math::{bottom, join, top};
use crate::model::AnalysisKind;
use crate::state::{Configuration, State};

impl Stepper<'_> {
    /// State at the end of the step, written once.
    ///
    /// # Errors
    /// As for [`Stepper::close_joints`]; `state` is untouched.
    pub(super) fn accept(&mut self, state: &mut State, scheme: &Coefficients, to: f64) -> Result<(), Failure> {
        let dt = to - state.time;
        let (mut damping_power, mut spent) = (0.0, Dissipation::default());
        let remembers = self.system.history > 0;
        let dynamic = self.model.analysis.kind == AnalysisKind::Dynamic;
        if self.wants_forces || remembers {
            self.move_trial(state, scheme);
        } else {
            self.differentiate(state, scheme);
        }
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: scheme.instant * dt };
        if self.wants_forces {
            self.system.residual(&now, &self.given[2], &mut self.forces);
            if self.system.is_damped() && dynamic {
                damping_power = self.system.damping_power(&now, self.plan.threads);
            }
        }
        if remembers {
            // Like reactions, plastic strains are taken where equilibrium is written and carried to the end of the step on a
            // straight line: at the end itself stiff parts are not at rest, and would yield from step to step.
            spent = self.system.update_history(&now, 1.0 / scheme.instant, &mut self.history, self.plan.threads);
        }
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            let [v, a] = self.bases(state, node, [v, a]);
            self.increments[node] = scheme.finish(&self.increments[node], &v, &a);
        }
        self.arrive(state, scheme);
        self.close_joints(state, scheme, dt)?;
        if scheme.instant != 1.0 && self.system.has_contacts() {
            self.check_contacts(state, dt)?;
        }
        self.check_joints()?;
        self.commit(state, scheme, to, spent, Some(damping_power));
        Ok(())
    }

    /// The trial motion becomes the state; `spent` by material points; `damping_power` there, where work is accounted for here.
    pub(super) fn commit(
        &mut self,
        state: &mut State,
        scheme: &Coefficients,
        to: f64,
        spent: Dissipation,
        damping_power: Option<f64>,
    ) {
        let dt = to - state.time;
        let dynamic = self.model.analysis.kind == AnalysisKind::Dynamic;
        if dynamic {
            for &node in &self.movers {
                let (start, end) = (&state.nodes[node], &self.trial[node]);
                state.jerk[node] = join(&(end.a - start.a), &(end.alpha - start.alpha)) / dt;
            }
        }
        if let Some([of_a, of_start, of_end]) = self.follower {
            for &node in &self.movers {
                let (start, increment) = (&state.nodes[node], &self.increments[node]);
                let before = join(&start.a, &start.alpha);
                // In the rotation vector of the step, then as a spatial vector like every other.
                let a = state.followers[node] * of_a + before * of_start + increment.dd * of_end;
                let (_, turn) = rates(&bottom(&increment.q), &bottom(&increment.d), &bottom(&a));
                state.followers[node] = join(&top(&a), &turn);
            }
        }
        state.work.material += spent;
        for (old, value) in state.multipliers.iter_mut().zip(&self.forces.multipliers.values) {
            *old += (value - *old) / scheme.instant;
        }
        self.share_out(state);
        if let Some(damping_power) = damping_power.filter(|_| self.wants_forces) {
            self.account(state, scheme, dt, damping_power);
        }
        if self.system.history > 0 {
            std::mem::swap(&mut state.history, &mut self.history);
        }
        std::mem::swap(&mut state.nodes, &mut self.trial);
        state.time = to;
    }

    /// Reactions and dissipation, taken where equilibrium is written and carried to the end of the step on a straight line
    /// (at the end itself stiff parts are not at rest), and the work done.
    pub(super) fn account(&mut self, state: &mut State, scheme: &Coefficients, dt: f64, damping_power: f64) {
        let carry = |old: f64, at_instant: f64| old + (at_instant - old) / scheme.instant;
        for (i, held) in self.model.held.iter().enumerate() {
            let old = state.reactions[i];
            let new = carry(old, -self.forces.on_nodes[held.node][held.dof]);
            let moved = self.held[1][i].u - self.held[0][i].u;
            state.work.external += 0.5 * (old + new) * moved;
            state.reactions[i] = new;
        }
        state.work.external += self.system.external_work((&state.nodes, &self.given[0]), (&self.trial, &self.given[1]));
        let old = state.work.damping_power;
        let new = carry(old, damping_power);
        state.work.damping += 0.5 * dt * (old + new);
        state.work.damping_power = new;
    }
}
