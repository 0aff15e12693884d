//! The motion of a step: what is given, the first guess, the trial motion from the increments, and where they end.

use super::step::Stepper;
use crate::integrators::Coefficients;
use crate::math::{Vec3, Vec6, join};
use crate::state::{Increment, Node, State};
use crate::system::{Prescribed, Side, between};

impl Stepper<'_> {
    /// What stands in place of a node's velocity and acceleration at the start of a step.
    #[inline]
    pub(super) fn bases(&self, state: &State, node: usize, own: [Vec6; 2]) -> [Vec6; 2] {
        if let Some(bases) = &self.bases {
            bases[node]
        } else if self.follower.is_some() {
            [own[0], state.followers[node]]
        } else {
            own
        }
    }

    /// Loads and held motion at the ends of the step and, extrapolated from them, at the instant of equilibrium.
    pub(super) fn give(&mut self, from: f64, to: f64, instant: f64) {
        let [start, end, at] = &mut self.given;
        self.drive.loading(from, Side::After, start);
        self.drive.loading(to, Side::Before, end);
        between(start, end, instant, at);
        let [start, end, at] = &mut self.held;
        self.drive.held(from, start);
        self.drive.held(to, end);
        at.clear();
        at.extend(start.iter().zip(end.iter()).map(|(a, b)| Prescribed {
            u: instant * (b.u - a.u),
            v: a.v + instant * (b.v - a.v),
            a: a.a + instant * (b.a - a.a),
        }));
        if instant > 1.0 {
            // What joints tie to a given motion takes its acceleration from positions: they must belong to one another. Past the
            // end of the step a straight line of positions would leave six sevenths of it out.
            let tau = instant * (to - from);
            for &i in &self.leading {
                let (start, now) = (&start[i], &mut at[i]);
                now.u = tau * start.v + tau * tau / 6.0 * (2.0 * start.a + now.a);
            }
        }
    }

    pub(super) fn predict(&mut self, state: &State, scheme: &Coefficients) {
        self.forget_corrections();
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            self.increments[node].q = scheme.predict(&v, &a, &state.jerk[node]);
        }
        self.measure_reach(state);
        self.forces.multipliers.values.copy_from_slice(&state.multipliers);
    }

    pub(super) fn measure_reach(&mut self, state: &State) {
        let farthest = |reach: f64, &node: &usize| reach.max((state.nodes[node].x - self.origin).amax());
        self.reach = self.movers.iter().fold(self.length, farthest);
    }

    /// Rates of the increments, by the scheme.
    pub(super) fn differentiate(&mut self, state: &State, scheme: &Coefficients) {
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            let start_a = a;
            let [v, a] = self.bases(state, node, [v, a]);
            scheme.differentiate(&mut self.increments[node], &v, &a, &start_a);
        }
    }

    /// The trial motion from the increments: rates by the scheme, held directions as given, riders after their masters.
    pub(super) fn move_trial(&mut self, state: &State, scheme: &Coefficients) {
        self.differentiate(state, scheme);
        for (held, given) in self.model.held.iter().zip(&self.held[2]) {
            set(&mut self.increments[held.node], held.dof, given);
        }
        for &node in &self.movers {
            let drift = self.trial[node].advance(&state.nodes[node], &self.increments[node], scheme.rotation);
            self.drift = self.drift.max(drift);
        }
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &state.nodes[rider.node]);
        }
    }

    /// The trial motion from the increments at the end of the step: held directions as given, riders after their masters.
    pub(super) fn arrive(&mut self, state: &State, scheme: &Coefficients) {
        for (i, held) in self.model.held.iter().enumerate() {
            let (from, to) = (&self.held[0][i], &self.held[1][i]);
            set(&mut self.increments[held.node], held.dof, &Prescribed { u: to.u - from.u, ..*to });
        }
        for &node in &self.movers {
            let start = &state.nodes[node];
            let end = &mut self.trial[node];
            end.advance(start, &self.increments[node], scheme.rotation);
        }
        self.carry_riders(&state.nodes);
    }

    pub(super) fn carry_riders(&mut self, start: &[Node]) {
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &start[rider.node]);
        }
    }
}

#[inline]
fn set(increment: &mut Increment, dof: usize, given: &Prescribed) {
    increment.q[dof] = given.u;
    increment.d[dof] = given.v;
    increment.dd[dof] = given.a;
}

/// Largest distance of a node from the first, or 1 for a single point.
pub fn extent(nodes: &[Node]) -> f64 {
    let first = nodes.first().map_or(Vec3::zeros(), |n| n.x);
    let extent = nodes.iter().map(|n| (n.x - first).norm()).fold(0.0, f64::max);
    if extent > 0.0 { extent } else { 1.0 }
}
