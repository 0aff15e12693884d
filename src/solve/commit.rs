//! The end of a step: multipliers and reactions carried there, work accounted for, the state written once.

use super::context::Context;
use super::projection::ConstraintProjection;
use super::workspace::Workspace;
use crate::integrators::Coefficients;
use crate::materials::Dissipation;
use crate::math::rotation::rates;
use crate::math::{angular, linear, stack};
use crate::state::State;

/// What the end of a step leaves for the account of work.
#[derive(Default)]
pub struct Account {
    /// The work taken by material points.
    pub dissipated: Dissipation,
    /// The power of dampers at the instant of equilibrium; `None` where work is accounted for by the caller.
    pub damping_power: Option<f64>,
}

/// The trial motion becomes the state at `to`.
pub fn commit(
    cx: &Context,
    ws: &mut Workspace,
    projection: Option<&mut ConstraintProjection>,
    state: &mut State,
    (scheme, to): (&Coefficients, f64),
    account: Account,
) {
    let dt = to - state.time;
    if cx.is_dynamic() {
        for &node in &cx.independent_nodes {
            let (start, end) = (&state.nodes[node], &ws.trial[node]);
            state.jerk[node] = stack(&(end.a - start.a), &(end.alpha - start.alpha)) / dt;
        }
    }
    update_algorithmic_accelerations(cx, ws, state);
    state.work.material += account.dissipated;
    for (old, value) in state.multipliers.iter_mut().zip(&ws.forces.multipliers.values) {
        *old += (value - *old) / scheme.instant;
    }
    if let Some(projection) = projection {
        projection.share_multipliers(cx, ws, state);
    }
    if let Some(damping_power) = account.damping_power.filter(|_| cx.wants_forces) {
        update_reactions_and_work(cx, ws, state, scheme, dt, damping_power);
    }
    if cx.system.history > 0 {
        std::mem::swap(&mut state.history, &mut ws.history);
    }
    std::mem::swap(&mut state.nodes, &mut ws.trial);
    state.time = to;
}

/// Where a scheme runs on accelerations other than those of equilibrium, they follow these.
fn update_algorithmic_accelerations(cx: &Context, ws: &Workspace, state: &mut State) {
    let Some([of_a, of_start, of_end]) = cx.algorithmic_acceleration else { return };
    for &node in &cx.independent_nodes {
        let (start, increment) = (&state.nodes[node], &ws.increments[node]);
        let before = stack(&start.a, &start.alpha);
        // In the rotation vector of the step, then as a spatial vector like every other.
        let a = state.algorithmic_accelerations[node] * of_a + before * of_start + increment.dd * of_end;
        let (_, turn) = rates(&angular(&increment.q), &angular(&increment.d), &angular(&a));
        state.algorithmic_accelerations[node] = stack(&linear(&a), &turn);
    }
}

/// Reactions and dissipation are taken where equilibrium is written and carried to the end of the step on a straight line (at the
/// end itself stiff parts are not at rest); the work follows.
fn update_reactions_and_work(
    cx: &Context,
    ws: &Workspace,
    state: &mut State,
    scheme: &Coefficients,
    dt: f64,
    damping_power: f64,
) {
    let carry = |old: f64, at_instant: f64| old + (at_instant - old) / scheme.instant;
    for (i, held) in cx.model.constraints.restraints.iter().enumerate() {
        let old = state.reactions[i];
        let new = carry(old, -ws.forces.on_nodes[held.node][held.dof]);
        let moved = ws.prescribed.end[i].u - ws.prescribed.start[i].u;
        state.work.external += 0.5 * (old + new) * moved;
        state.reactions[i] = new;
    }
    state.work.external += cx.system.external_work((&state.nodes, &ws.loads.start), (&ws.trial, &ws.loads.end));
    let old = state.work.damping_power;
    let new = carry(old, damping_power);
    state.work.damping += 0.5 * dt * (old + new);
    state.work.damping_power = new;
}
