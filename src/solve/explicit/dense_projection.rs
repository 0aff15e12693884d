//! Projection onto the constraints between rigid bodies at the end of an explicit step, by a small dense system:
//! positions, then velocities.

use super::accelerations::Accelerations;
use crate::context::Context;
use crate::failure::Failure;
use crate::guards::joints::constraints_violated;
use crate::system::constraint_schur::ConstraintSchur;
use crate::system::masses::Masses;
use crate::tolerances::joints::{MOST_CORRECTIONS, ROUNDING};
use crate::workspace::Workspace;
use base::math::rotation::{exp, inverse_tangent, renormalise};
use base::math::{Vec6, angular, linear, stack};
use mechanics::state::{Node, State};

/// Projects positions and velocities of the trial motion onto the constraints by the least change in the norm of the masses. Increments and
/// their rates q̇ are updated too.
///
/// # Errors
/// [`Failure::ConstraintsViolated`] where the joints cannot be closed from there.
pub fn project_onto_constraints(
    cx: &Context,
    ws: &mut Workspace,
    accelerations: &mut Accelerations,
    state: &State,
    dt: f64,
) -> Result<(), Failure> {
    let Accelerations { masses: Some(masses), schur: Some(schur), missing: change, .. } = accelerations else {
        return Ok(());
    };
    project_positions(cx, ws, masses, schur, change, state)?;
    project_velocities(cx, ws, masses, schur, change, state, dt)
}

fn project_positions(
    cx: &Context,
    ws: &mut Workspace,
    masses: &Masses,
    schur: &mut ConstraintSchur,
    change: &mut [Vec6],
    state: &State,
) -> Result<(), Failure> {
    let mut last = f64::INFINITY;
    for round in 0.. {
        cx.system.gaps(&ws.trial.nodes, 0, &mut schur.x);
        let gap = cx.system.largest_gap(&schur.x, ws.reach);
        if gap <= ROUNDING || (gap >= 0.5 * last && gap <= 1e3 * ROUNDING) {
            break;
        }
        if round == MOST_CORRECTIONS || !schur.form(cx.system, masses, &ws.trial.nodes) || gap.is_nan() {
            cx.system.gaps(&ws.trial.nodes, 0, &mut ws.forces.multipliers.gaps);
            return Err(constraints_violated(cx, &ws.forces.multipliers.gaps));
        }
        last = gap;
        least_change(schur, masses, change);
        for block in &masses.blocks {
            let (change, increment) = (change[block.node], &mut ws.trial.increments[block.node]);
            let node = &mut ws.trial.nodes[block.node];
            let Node { x, low, .. } = *node;
            node.place(&x, &low, &linear(&change));
            node.rotation = renormalise(&(exp(&angular(&change)) * node.rotation));
            let turn = inverse_tangent(&angular(&increment.q), &angular(&change));
            increment.q += stack(&linear(&change), &turn);
            increment.d = stack(&node.v, &inverse_tangent(&angular(&increment.q), &node.omega));
        }
        ws.trial.update_dependent_nodes(cx, &state.nodes);
    }
    Ok(())
}

fn project_velocities(
    cx: &Context,
    ws: &mut Workspace,
    masses: &Masses,
    schur: &mut ConstraintSchur,
    change: &mut [Vec6],
    state: &State,
    dt: f64,
) -> Result<(), Failure> {
    let mut last = f64::INFINITY;
    loop {
        cx.system.gaps(&ws.trial.nodes, 1, &mut schur.x);
        let gap = cx.system.largest_gap(&schur.x, ws.reach);
        if gap * dt <= ROUNDING || gap >= 0.1 * last || gap.is_nan() {
            return Ok(());
        }
        if last == f64::INFINITY && !schur.form(cx.system, masses, &ws.trial.nodes) {
            return Err(constraints_violated(cx, &ws.forces.multipliers.gaps));
        }
        last = gap;
        least_change(schur, masses, change);
        for block in &masses.blocks {
            let (change, increment) = (change[block.node], &mut ws.trial.increments[block.node]);
            let node = &mut ws.trial.nodes[block.node];
            node.v += linear(&change);
            node.omega += angular(&change);
            increment.d = stack(&node.v, &inverse_tangent(&angular(&increment.q), &node.omega));
        }
        ws.trial.update_dependent_nodes(cx, &state.nodes);
    }
}

/// Writes the least change of motion that closes the current gaps, by node.
fn least_change(schur: &mut ConstraintSchur, masses: &Masses, change: &mut [Vec6]) {
    schur.solve();
    masses.blocks.iter().for_each(|block| change[block.node] = Vec6::zeros());
    schur.subtract_response(change);
}
