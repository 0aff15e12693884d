//! The state at the beginning of a stage: the final state of the previous stage, with accelerations and reactions under the new loads and
//! constraints.

use super::context::Context;
use super::failure::Failure;
use super::handover::Handover;
use super::jumps::{impulse, jump_from, jump_velocities, kick};
use super::start::{add_accelerations, factor_mass, project_velocities, speed, update_rates_of_dependent_nodes};
use super::warning::Warning;
use super::workspace::Workspace;
use crate::guards::contacts;
use crate::guards::joints;
use crate::system::Side;
use crate::tolerances::start::DIGITS;
use base::math::{Vec6, stack};
use mechanics::elements::Force;
use mechanics::state::{Node, State};

/// Finds the state at the beginning of a stage. If a motion continues unchanged, only the velocities of supports may jump.
///
/// # Errors
/// As for [`super::start::start`].
pub fn start_stage(cx: &Context, ws: &mut Workspace, handover: &Handover) -> Result<State, Failure> {
    let mut state = handover.state.clone();
    cx.excitation.loading(state.time, Side::After, &mut ws.loads.instant);
    cx.excitation.prescribed(state.time, Side::After, &mut ws.prescribed.start);
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    if let Some(load_steps) = &handover.load_steps {
        ws.load_steps = load_steps.clone();
    }
    state.algorithmic_accelerations.truncate(if cx.algorithmic_acceleration.is_some() { usize::MAX } else { 0 });
    if cx.algorithmic_acceleration.is_some() && state.algorithmic_accelerations.is_empty() {
        state.algorithmic_accelerations = state.nodes.iter().map(|node| stack(&node.a, &node.alpha)).collect();
    }
    if let Some(before) = &handover.out_of_balance {
        jump_velocities(cx, ws, &mut state)?;
        jump_from(cx, ws, &mut state, before, Side::After)?;
    } else if cx.model.analysis.goes_on() {
        kick(cx, ws, &mut state)?;
    } else {
        balance(cx, ws, handover, &mut state)?;
    }
    ws.place(&state.nodes);
    Ok(state)
}

/// Applies the supports, then finds accelerations and reactions.
fn balance(cx: &Context, ws: &mut Workspace, handover: &Handover, state: &mut State) -> Result<(), Failure> {
    let before = state.nodes.clone();
    give_rates(cx, ws, state);
    update_rates_of_dependent_nodes(cx, ws, &mut state.nodes);
    take_up_history(cx, ws, handover, state);
    contacts::warn_of_closed(cx, ws, state, &handover.fresh);
    if cx.is_dynamic() {
        let massless = factor_mass(cx, ws, &state.configuration())?;
        let impulse = impulse(cx, ws, state, (&before, &massless));
        if !cx.system.joints.is_empty() || !impulse.is_empty() {
            ws.place(&state.nodes);
            if !cx.system.joints.is_empty() {
                joints::note(cx, ws)?;
            }
            let change = project_velocities(cx, ws, &mut state.nodes, &impulse);
            if change > DIGITS && given_velocities_change(cx, ws, &state.nodes) {
                ws.warnings.add(Warning::InitialVelocities { change });
            }
        }
        // Impulses and projections have overwritten the residual, without forces from velocities.
        balance_forces(cx, ws, state);
        subtract(&mut ws.forces.on_nodes, &handover.left_by_scheme);
        let algorithmic = state.algorithmic_accelerations.clone();
        add_accelerations(cx, ws, state, &massless);
        if !handover.left_by_scheme.is_empty() {
            go_on_algorithmic(state, (&before, &algorithmic));
        }
        state.work.damping_power = cx.system.damping_power(&state.configuration(), cx.plan.threads);
    }
    balance_forces(cx, ws, state);
    for (reaction, restraint) in state.reactions.iter_mut().zip(&cx.model.constraints.restraints) {
        *reaction = -ws.forces.on_nodes[restraint.node][restraint.dof];
    }
    Ok(())
}

/// Writes the residual forces of a state with its own multipliers and velocities.
fn balance_forces(cx: &Context, ws: &mut Workspace, state: &State) {
    ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.system.residual(&state.configuration(), &ws.loads.instant, &mut ws.forces);
}

/// Takes forces from those on the nodes; nothing where there are none.
fn subtract(from: &mut [Force], forces: &[Force]) {
    for (from, force) in from.iter_mut().zip(forces) {
        from.iter_mut().zip(force).for_each(|(from, force)| *from -= force);
    }
}

/// Adds the jump of accelerations to algorithmic accelerations, from nodes `before`: these belong to another instant.
fn go_on_algorithmic(state: &mut State, (before, algorithmic): (&[Node], &[Vec6])) {
    let jumps = state.nodes.iter().zip(before).map(|(now, then)| stack(&(now.a - then.a), &(now.alpha - then.alpha)));
    let all = state.algorithmic_accelerations.iter_mut().zip(algorithmic);
    all.zip(jumps).for_each(|((now, then), jump)| *now = then + jump);
}

/// True if joints have changed velocities that the deck gives in this stage, from `trial` to `nodes`. Joints may stop motion of the
/// previous stage without a warning.
fn given_velocities_change(cx: &Context, ws: &Workspace, nodes: &[Node]) -> bool {
    let largest = nodes.iter().map(|node| speed(cx, &node.v, &node.omega)).fold(0.0, f64::max);
    let given = cx.model.nodes.iter().zip(ws.trial.nodes.iter().zip(nodes));
    let given = given.filter(|(spec, _)| spec.given.iter().any(Option::is_some));
    let change = |before: &Node, after: &Node| speed(cx, &(after.v - before.v), &(after.omega - before.omega));
    given.map(|(_, (before, after))| change(before, after)).any(|change| change > DIGITS * largest)
}

/// Sets the velocities of the deck and of supports, and zero for restrained degrees of freedom; accelerations follow.
fn give_rates(cx: &Context, ws: &Workspace, state: &mut State) {
    for (node, spec) in state.nodes.iter_mut().zip(&cx.model.nodes) {
        (node.a, node.alpha) = Default::default();
        if cx.is_dynamic() && spec.given[0].is_some() {
            node.v = spec.v;
        }
        if cx.is_dynamic() && spec.given[1].is_some() {
            node.omega = spec.omega;
        }
    }
    for (restraint, given) in cx.model.constraints.restraints.iter().zip(&ws.prescribed.start) {
        let node = &mut state.nodes[restraint.node];
        let (v, a) = if restraint.dof < 3 { (&mut node.v, &mut node.a) } else { (&mut node.omega, &mut node.alpha) };
        (v[restraint.dof % 3], a[restraint.dof % 3]) = (given.v, given.a);
    }
}

/// Initializes the history of new parts, such as points in contact, at the beginning of the stage; other parts keep their history.
fn take_up_history(cx: &Context, ws: &mut Workspace, handover: &Handover, state: &mut State) {
    if handover.fresh.is_empty() {
        return;
    }
    cx.system.update_history(&state.configuration(), 1.0, &mut ws.history, cx.plan.threads);
    for range in &handover.fresh {
        state.history[range.clone()].copy_from_slice(&ws.history[range.clone()]);
    }
}
