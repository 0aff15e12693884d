//! The motion of a step: prescribed motion, prediction, the trial motion from the increments, and the motion at the end
//! of the step.

use crate::context::Context;
use crate::system::{Prescribed, Side, TurningBody, between};
use crate::workspace::Workspace;
use base::math::{Vec3, Vec6, angular, stack};
use mechanics::integrators::Coefficients;
use mechanics::state::{Increment, Node, State};

/// The relation between displacements, velocities and accelerations in a stage of a step.
#[derive(Clone, Copy)]
pub struct Stage<'s> {
    /// Coefficients of the scheme.
    pub scheme: &'s Coefficients,
    /// Velocities and accelerations by node that stand in place of those at the start of the step, where a second stage
    /// looks back beyond it.
    pub start_rates: Option<&'s [[Vec6; 2]]>,
    /// What stands in place of accelerations of turning bodies there: of the angular momentum, and of the angular velocity in body axes.
    pub turning: Option<&'s [[Vec3; 2]]>,
    /// Predicted increments by node that stand in place of those of the scheme.
    pub prediction: Option<&'s [Vec6]>,
}

impl<'s> From<&'s Coefficients> for Stage<'s> {
    /// A stage with the rates of the state alone.
    fn from(scheme: &'s Coefficients) -> Stage<'s> {
        Stage { scheme, start_rates: None, turning: None, prediction: None }
    }
}

impl Stage<'_> {
    /// The velocity and the acceleration of a node at the start of the step as the scheme uses them; `own` are those of
    /// the state.
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

/// The velocity and the acceleration of a node, translations first.
#[inline]
pub fn rates_of(node: &Node) -> [Vec6; 2] {
    [stack(&node.v, &node.omega), stack(&node.a, &node.alpha)]
}

/// Evaluates loads and prescribed motion at the ends of the step, and at the instant of equilibrium by interpolation or
/// extrapolation from the ends.
pub fn excite(cx: &Context, ws: &mut Workspace, from: f64, to: f64, instant: f64) {
    let loads = &mut ws.loads;
    cx.excitation.loading(from, Side::After, &mut loads.start);
    cx.excitation.loading(to, Side::Before, &mut loads.end);
    if let Some(sudden) = &ws.load_steps.sudden {
        sudden.bring_on(from, &mut loads.start);
        sudden.bring_on(to, &mut loads.end);
    }
    between(&loads.start, &loads.end, instant, &mut loads.instant);
    let prescribed = &mut ws.prescribed;
    cx.excitation.prescribed(from, Side::After, &mut prescribed.start);
    cx.excitation.prescribed(to, Side::Before, &mut prescribed.end);
    cx.excitation.moved(&prescribed.start, &prescribed.end, &mut prescribed.moved);
    prescribed.instant.clear();
    prescribed.instant.extend(prescribed.start.iter().zip(&prescribed.moved).map(|(a, b)| Prescribed {
        u: instant * b.u,
        v: a.v + instant * (b.v - a.v),
        a: a.a + instant * (b.a - a.a),
    }));
    if instant > 1.0 {
        // Joints take accelerations of what they tie to a prescribed motion from its positions, so positions and
        // accelerations must be consistent. Past the end of the step, linear extrapolation of positions would leave six
        // sevenths of the acceleration out.
        let tau = instant * (to - from);
        for &i in &cx.driving {
            let (start, now) = (&prescribed.start[i], &mut prescribed.instant[i]);
            now.u = tau * start.v + tau * tau / 6.0 * (2.0 * start.a + now.a);
        }
    }
}

/// Writes the predicted increments, what rotations of bodies start from, and the multipliers of the last step as a first guess.
pub fn predict(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    for &node in &cx.independent_nodes {
        ws.increments[node].q = match stage.prediction {
            Some(prediction) => prediction[node],
            None => {
                let [v, a] = rates_of(&state.nodes[node]);
                stage.scheme.predict(&v, &a, &state.jerk[node])
            }
        };
    }
    start_turning(cx, ws, state, stage);
    measure_reach(cx, ws, state);
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
}

/// Writes the largest coordinate of a node, by which rounding is measured.
pub fn measure_reach(cx: &Context, ws: &mut Workspace, state: &State) {
    let farthest = |reach: f64, &node: &usize| reach.max((state.nodes[node].x - cx.origin).amax());
    let placed = cx.independent_nodes.iter().filter(|node| !cx.numbers.contains(node));
    ws.reach = placed.fold(cx.length, farthest);
}

/// Writes the rates of the increments by the scheme.
pub fn differentiate(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    for &node in &cx.independent_nodes {
        let [own_v, own_a] = rates_of(&state.nodes[node]);
        let [v, a] = stage.start_rates(cx, state, node, [own_v, own_a]);
        stage.scheme.differentiate(&mut ws.increments[node], &v, &a, &own_a);
    }
    if stage.scheme.turning.is_some() {
        for (body, start) in cx.system.turning_bodies().iter().zip(&ws.turning) {
            body.differentiate(start, &mut ws.increments[body.node], stage.scheme);
        }
    }
}

/// Writes the increments at the end of the step in place of those at the instant of equilibrium.
pub fn finish(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    let bodies: &[TurningBody] = if stage.scheme.turning.is_some() { cx.system.turning_bodies() } else { &[] };
    let mut bodies = bodies.iter().peekable();
    for &node in &cx.independent_nodes {
        let start = &state.nodes[node];
        let [v, a] = stage.start_rates(cx, state, node, rates_of(start));
        let at_instant = ws.increments[node];
        let end = &mut ws.increments[node];
        *end = stage.scheme.finish(&at_instant, &v, &a);
        if let Some(body) = TurningBody::next_at(&mut bodies, node) {
            body.finish(start, &at_instant, end, stage.scheme);
        }
    }
}

/// Writes what the rotations of bodies start from in a stage, as the scheme uses it.
fn start_turning(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    if stage.scheme.turning.is_none() {
        return;
    }
    ws.turning.clear();
    ws.turning.extend(cx.system.turning_bodies().iter().enumerate().map(|(index, body)| {
        let node = &state.nodes[body.node];
        let [v, a] = stage.start_rates(cx, state, body.node, rates_of(node)).map(|rates| angular(&rates));
        match stage.turning {
            Some(rates) => body.start_of_stage(node, &v, rates[index], stage.scheme),
            None => body.start(node, &a, stage.scheme),
        }
    }));
}

/// Writes the trial motion at the instant of equilibrium from the increments: rates by the scheme, then prescribed
/// degrees of freedom, then dependent nodes.
pub fn move_trial(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
    differentiate(cx, ws, state, stage);
    for (restraint, given) in cx.model.constraints.restraints.iter().zip(&ws.prescribed.instant) {
        prescribe(&mut ws.increments[restraint.node], restraint.dof, given);
    }
    for &node in &cx.independent_nodes {
        let drift = ws.trial[node].advance(&state.nodes[node], &ws.increments[node], stage.scheme.rotation);
        ws.rotation_drift = ws.rotation_drift.max(drift);
    }
    update_dependent_nodes(cx, ws, &state.nodes);
}

/// Writes the trial motion at the end of the step from the increments, with prescribed degrees of freedom and dependent
/// nodes.
pub fn move_to_step_end(cx: &Context, ws: &mut Workspace, state: &State, scheme: &Coefficients) {
    for (restraint, moved) in cx.model.constraints.restraints.iter().zip(&ws.prescribed.moved) {
        prescribe(&mut ws.increments[restraint.node], restraint.dof, moved);
    }
    for &node in &cx.independent_nodes {
        ws.trial[node].advance(&state.nodes[node], &ws.increments[node], scheme.rotation);
    }
    update_dependent_nodes(cx, ws, &state.nodes);
}

/// Moves dependent nodes with their masters; `start` are the nodes at the start of the step.
pub fn update_dependent_nodes(cx: &Context, ws: &mut Workspace, start: &[Node]) {
    for dependent in &cx.system.rigid_links {
        dependent.move_with_master(&mut ws.trial, &mut ws.increments, &start[dependent.node]);
    }
}

/// Writes a prescribed degree of freedom of an increment.
#[inline]
pub fn prescribe(increment: &mut Increment, dof: usize, given: &Prescribed) {
    increment.q[dof] = given.u;
    increment.d[dof] = given.v;
    increment.dd[dof] = given.a;
}
