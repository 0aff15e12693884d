//! The state after a jump of the loads or of prescribed velocities, or after a failure of a part.

use super::context::Context;
use super::failure::Failure;
use super::start::{add_accelerations, factor_mass, project_velocities, update_rates_of_dependent_nodes};
use super::workspace::Workspace;
use crate::system::Side;
use crate::system::energy::kinetic_energy;
use base::math::Vec3;
use mechanics::elements::Force;
use mechanics::state::{Configuration, Node, State};
use model::Restraint;

/// Takes the state over a jump of the loads or of prescribed velocities. Other velocities are continuous; accelerations jump by M Δa = Δf,
/// and reactions with them. With the old acceleration the scheme would lose an order in the next step.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn jump(cx: &Context, ws: &mut Workspace, state: &mut State) -> Result<(), Failure> {
    if !cx.is_dynamic() {
        return Ok(());
    }
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.excitation.loading(state.time, Side::Before, &mut ws.loads.instant);
    cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
    let before = ws.forces.on_nodes.clone();
    jump_velocities(cx, ws, state)?;
    jump_from(cx, ws, state, &before, Side::After)
}

/// Like [`jump`], at the beginning of a stage that continues a motion. The loads have jumped at the end of the previous stage, but the
/// velocities of supports have not.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn kick(cx: &Context, ws: &mut Workspace, state: &mut State) -> Result<(), Failure> {
    cx.excitation.prescribed(state.time, Side::Before, &mut ws.prescribed.end);
    cx.excitation.prescribed(state.time, Side::After, &mut ws.prescribed.start);
    if ws.prescribed.start == ws.prescribed.end {
        return Ok(());
    }
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.excitation.loading(state.time, Side::After, &mut ws.loads.instant);
    cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
    let before = ws.forces.on_nodes.clone();
    jump_velocities(cx, ws, state)?;
    jump_from(cx, ws, state, &before, Side::After)
}

/// Sets the velocities of prescribed degrees of freedom after the jump, and the velocities that follow through joints and masses. The
/// change of kinetic energy is work of the supports.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn jump_velocities(cx: &Context, ws: &mut Workspace, state: &mut State) -> Result<(), Failure> {
    cx.excitation.prescribed(state.time, Side::Before, &mut ws.prescribed.end);
    cx.excitation.prescribed(state.time, Side::After, &mut ws.prescribed.start);
    if ws.prescribed.start == ws.prescribed.end {
        return Ok(());
    }
    let (nodes, energy) = (state.nodes.clone(), kinetic_energy(cx.system, &state.nodes));
    let restraints = cx.model.constraints.restraints.iter().enumerate().zip(&ws.prescribed.start);
    let moves = |(i, restraint): (usize, &Restraint)| restraint.motion.is_some() || cx.excitation.is_turned(i);
    for ((_, restraint), given) in restraints.filter(|(of, _)| moves(*of)) {
        let node = &mut state.nodes[restraint.node];
        let (v, a) = if restraint.dof < 3 { (&mut node.v, &mut node.a) } else { (&mut node.omega, &mut node.alpha) };
        (v[restraint.dof % 3], a[restraint.dof % 3]) = (given.v, given.a);
    }
    update_rates_of_dependent_nodes(cx, ws, &mut state.nodes);
    let massless = factor_mass(cx, ws, &state.configuration())?;
    let impulse = impulse(cx, ws, state, (&nodes, &massless));
    if !cx.system.joints.is_empty() || !impulse.is_empty() {
        project_velocities(cx, ws, &mut state.nodes, &impulse);
    }
    state.work.external += kinetic_energy(cx.system, &state.nodes) - energy;
    state.work.damping_power = cx.system.damping_power(&state.configuration(), cx.plan.threads);
    Ok(())
}

/// Updates the state after the failure of material points or links in the last step of length `dt`, whose initial history is still
/// available. Their forces vanish, and accelerations and reactions jump as at a jump of the loads.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn release(cx: &Context, ws: &mut Workspace, state: &mut State, dt: f64) -> Result<(), Failure> {
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.excitation.loading(state.time, Side::Before, &mut ws.loads.instant);
    let unbroken = Configuration { nodes: &state.nodes, history: &ws.history, dt, previous: None };
    cx.system.residual(&unbroken, &ws.loads.instant, &mut ws.forces);
    let before = ws.forces.on_nodes.clone();
    jump_from(cx, ws, state, &before, Side::Before)
}

/// As [`jump`], from the forces out of balance on all nodes `before` it; `side`: the loads that act then.
///
/// # Errors
/// [`Failure::Singular`] where a mass matrix cannot be inverted.
pub fn jump_from(
    cx: &Context,
    ws: &mut Workspace,
    state: &mut State,
    before: &[Force],
    side: Side,
) -> Result<(), Failure> {
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.excitation.loading(state.time, side, &mut ws.loads.instant);
    cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
    for (after, before) in ws.forces.on_nodes.iter_mut().zip(before) {
        after.iter_mut().zip(before).for_each(|(after, before)| *after -= before);
    }
    if cx.is_dynamic() {
        let massless = factor_mass(cx, ws, &state.configuration())?;
        add_accelerations(cx, ws, state, &massless);
    }
    if cx.wants_forces {
        // Reactions jump by the new loads less the inertia forces of the new accelerations.
        cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
        for (reaction, restraint) in state.reactions.iter_mut().zip(&cx.model.constraints.restraints) {
            *reaction -= ws.forces.on_nodes[restraint.node][restraint.dof] - before[restraint.node][restraint.dof];
        }
    }
    Ok(())
}

/// The impulse −M Δv on the unknowns of nodes, with Δv the jump of supported velocities from `before`. It acts through mass coupled to the
/// restrained directions. Empty where velocities are those before.
pub fn impulse(cx: &Context, ws: &mut Workspace, state: &State, (before, massless): (&[Node], &[usize])) -> Vec<f64> {
    let zero = Vec3::zeros();
    let at_rest = |node: &Node| Node { v: zero, omega: zero, a: zero, alpha: zero, ..*node };
    let mut nodes: Vec<Node> = state.nodes.iter().map(at_rest).collect();
    let mut forces = |nodes: &mut Vec<Node>| -> Vec<f64> {
        update_rates_of_dependent_nodes(cx, ws, nodes);
        let now = Configuration { nodes, ..state.configuration() };
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        cx.plan.dofs.nodal_dofs().iter().map(|&(node, dof)| ws.forces.on_nodes[node][dof]).collect()
    };
    let without = forces(&mut nodes);
    let mut jumps = false;
    for restraint in &cx.model.constraints.restraints {
        let (node, now, before) = (&mut nodes[restraint.node], &state.nodes[restraint.node], &before[restraint.node]);
        let k = restraint.dof % 3;
        let (a, jump) = match restraint.dof {
            0..3 => (&mut node.a, now.v[k] - before.v[k]),
            _ => (&mut node.alpha, now.omega[k] - before.omega[k]),
        };
        a[k] = jump;
        jumps |= jump != 0.0;
    }
    if !jumps {
        return Vec::new();
    }
    let mut impulse = forces(&mut nodes);
    impulse.iter_mut().zip(without).for_each(|(with, without)| *with -= without);
    massless.iter().for_each(|&row| impulse[row] = 0.0);
    impulse
}
