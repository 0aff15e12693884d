//! The motion of a step: what is prescribed, the first guess, the trial motion from the increments, and where they end.

use super::context::Context;
use super::workspace::Workspace;
use crate::integrators::Coefficients;
use crate::math::{Vec6, stack};
use crate::state::{Increment, Node, State};
use crate::system::{Prescribed, Side, between};

/// How a stage of a step relates displacements, velocities and accelerations.
#[derive(Clone, Copy)]
pub struct Stage<'s> {
    pub scheme: &'s Coefficients,
    /// What the scheme takes in place of the velocity and the acceleration at the start, by node: where a second stage looks back
    /// beyond it.
    pub start_rates: Option<&'s [[Vec6; 2]]>,
}

impl<'s> From<&'s Coefficients> for Stage<'s> {
    /// A stage that starts from the state alone.
    fn from(scheme: &'s Coefficients) -> Stage<'s> {
        Stage { scheme, start_rates: None }
    }
}

impl Stage<'_> {
    /// What stands in place of a node's own velocity and acceleration at the start of the step.
    #[inline]
    pub fn start_rates(&self, cx: &Context, state: &State, node: usize, own: [Vec6; 2]) -> [Vec6; 2] {
        if let Some(rates) = self.start_rates {
            rates[node]
        } else if cx.algorithmic_acceleration.is_some() {
            [own[0], state.algorithmic_accelerations[node]]
        } else {
            own
        }
    }
}

/// Velocity and acceleration of a node, translations first.
#[inline]
pub fn rates_of(node: &Node) -> [Vec6; 2] {
    [stack(&node.v, &node.omega), stack(&node.a, &node.alpha)]
}

/// Evaluates loads and prescribed motion at the ends of the step and, extrapolated from them, at the instant of equilibrium.
pub fn excite(cx: &Context, ws: &mut Workspace, from: f64, to: f64, instant: f64) {
    let loads = &mut ws.loads;
    cx.excitation.loading(from, Side::After, &mut loads.start);
    cx.excitation.loading(to, Side::Before, &mut loads.end);
    between(&loads.start, &loads.end, instant, &mut loads.instant);
    let prescribed = &mut ws.prescribed;
    cx.excitation.prescribed(from, &mut prescribed.start);
    cx.excitation.prescribed(to, &mut prescribed.end);
    prescribed.instant.clear();
    prescribed.instant.extend(prescribed.start.iter().zip(&prescribed.end).map(|(a, b)| Prescribed {
        u: instant * (b.u - a.u),
        v: a.v + instant * (b.v - a.v),
        a: a.a + instant * (b.a - a.a),
    }));
    if instant > 1.0 {
        // What joints tie to a prescribed motion takes its acceleration from positions: they must belong to one another. Past the
        // end of the step a straight line of positions would leave six sevenths of it out.
        let tau = instant * (to - from);
        for &i in &cx.driving {
            let (start, now) = (&prescribed.start[i], &mut prescribed.instant[i]);
            now.u = tau * start.v + tau * tau / 6.0 * (2.0 * start.a + now.a);
        }
    }
}

/// Writes the first guess of the increments and of the multipliers.
pub fn predict(cx: &Context, ws: &mut Workspace, state: &State, scheme: &Coefficients) {
    for &node in &cx.independent_nodes {
        let [v, a] = rates_of(&state.nodes[node]);
        ws.increments[node].q = scheme.predict(&v, &a, &state.jerk[node]);
    }
    measure_reach(cx, ws, state);
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
}

pub fn measure_reach(cx: &Context, ws: &mut Workspace, state: &State) {
    let farthest = |reach: f64, &node: &usize| reach.max((state.nodes[node].x - cx.origin).amax());
    ws.reach = cx.independent_nodes.iter().fold(cx.length, farthest);
}

/// Writes the rates of the increments by the scheme.
pub fn differentiate(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    for &node in &cx.independent_nodes {
        let [own_v, own_a] = rates_of(&state.nodes[node]);
        let [v, a] = stage.start_rates(cx, state, node, [own_v, own_a]);
        stage.scheme.differentiate(&mut ws.increments[node], &v, &a, &own_a);
    }
}

/// Writes the trial motion from the increments: rates by the scheme, prescribed directions as given, dependent nodes after their
/// masters.
pub fn move_trial(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    differentiate(cx, ws, state, stage);
    for (held, given) in cx.model.constraints.restraints.iter().zip(&ws.prescribed.instant) {
        prescribe(&mut ws.increments[held.node], held.dof, given);
    }
    for &node in &cx.independent_nodes {
        let drift = ws.trial[node].advance(&state.nodes[node], &ws.increments[node], stage.scheme.rotation);
        ws.rotation_drift = ws.rotation_drift.max(drift);
    }
    update_dependent_nodes(cx, ws, &state.nodes);
}

/// Writes the trial motion from the increments at the end of the step: prescribed directions as given, dependent nodes after
/// their masters.
pub fn move_to_step_end(cx: &Context, ws: &mut Workspace, state: &State, scheme: &Coefficients) {
    for (i, held) in cx.model.constraints.restraints.iter().enumerate() {
        let (from, to) = (&ws.prescribed.start[i], &ws.prescribed.end[i]);
        prescribe(&mut ws.increments[held.node], held.dof, &Prescribed { u: to.u - from.u, ..*to });
    }
    for &node in &cx.independent_nodes {
        ws.trial[node].advance(&state.nodes[node], &ws.increments[node], scheme.rotation);
    }
    update_dependent_nodes(cx, ws, &state.nodes);
}

/// Moves dependent nodes after their masters, from where they were at `start`.
pub fn update_dependent_nodes(cx: &Context, ws: &mut Workspace, start: &[Node]) {
    for dependent in &cx.system.rigid_links {
        dependent.follow(&mut ws.trial, &mut ws.increments, &start[dependent.node]);
    }
}

#[inline]
fn prescribe(increment: &mut Increment, dof: usize, given: &Prescribed) {
    increment.q[dof] = given.u;
    increment.d[dof] = given.v;
    increment.dd[dof] = given.a;
}
