//! Detects load steps that leave the path of equilibria. Newton's method finds any equilibrium, not necessarily the one on the loading
//! path. A long step may turn a structure inside out, and beyond a limit point the next equilibrium is far away. Such steps are cut, or end
//! the run.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::{Guard, Iterate};
use crate::step::trial::{Step, TrialMotion};
use crate::system::{Scale, law_of};
use crate::tolerances::jump::{ACCURACY, CURVED, DOUBTFUL, LARGEST_TURN, LARGEST_TWIST, LEVER, NOTHING, STILL};
use crate::workspace::Workspace;
use base::math::{Vec3, angular, linear};
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, State};
use model::DIRECTIONS;

/// Refuses load steps off the path of equilibria and load steps with too large rotations.
pub struct JumpGuard;

impl Guard for JumpGuard {
    fn at_iterate(&mut self, cx: &Context, ws: &Workspace, step: &Step, iterate: &Iterate) -> Result<(), Failure> {
        if iterate.converged { check_turns(cx, &ws.trial, step) } else { Ok(()) }
    }

    fn at_end(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        dissipated: &Dissipation,
    ) -> Result<(), Failure> {
        // The work of rounding is none.
        let exempt = cx.model.analysis.step_length.is_arc_length() || ws.load_steps.peak.unstressed;
        if exempt || step.dt() <= 0.0 {
            return Ok(());
        }
        check_work(cx, ws, step.state, dissipated, step.to)
    }
}

/// Refuses a step of a motion that turns a node of a shell against its element.
pub struct TwistGuard;

impl Guard for TwistGuard {
    fn at_iterate(&mut self, cx: &Context, ws: &Workspace, _step: &Step, iterate: &Iterate) -> Result<(), Failure> {
        if iterate.converged { check_shells(cx, &ws.trial) } else { Ok(()) }
    }
}

/// Refuses a load step that turns a node too far or an element over.
fn check_turns(cx: &Context, trial: &TrialMotion, step: &Step) -> Result<(), Failure> {
    for &node in &cx.independent_nodes {
        let turn = angular(&cx.plan.dofs.of(node).mask(&trial.increments[node].q)).norm();
        if turn > LARGEST_TURN && step.to > step.state.time {
            return Err(Failure::LoadStepTurns { label: cx.model.nodes[node].label.clone(), angle: turn });
        }
    }
    for group in &cx.system.groups {
        let over = |&e: &usize| group.block.is_turned_over(e, &step.state.nodes, &trial.nodes);
        if let Some(e) = (0..group.block.len()).find(over) {
            return Err(Failure::TurnedOver { name: group.part_of(e, cx.model).name().to_owned() });
        }
    }
    Ok(())
}

/// Refuses a step that turns a node of a shell too far against the mean of its element. Drilling rotations have almost no inertia, and
/// their resistance decreases with the angle. An iteration may therefore converge with a node turned about the normal by a right angle.
fn check_shells(cx: &Context, trial: &TrialMotion) -> Result<(), Failure> {
    let shells = || cx.system.groups.iter().filter(|group| group.kind.is_surface());
    let turn = |node: usize| angular(&cx.plan.dofs.of(node).mask(&trial.increments[node].q));
    if !cx.independent_nodes.iter().any(|&node| turn(node).norm() > LARGEST_TWIST) {
        return Ok(());
    }
    for group in shells() {
        for e in 0..group.block.len() {
            let own = || group.block.nodes(e).iter().filter(|node| cx.independent_nodes.binary_search(node).is_ok());
            let mean = own().map(|&node| turn(node)).sum::<Vec3>() / own().count().max(1) as f64;
            let against = |node: usize| (turn(node) - mean).norm();
            if let Some(&node) = own().find(|node| against(**node) > LARGEST_TWIST) {
                return Err(Failure::NodeTurns { label: cx.model.nodes[node].label.clone(), angle: against(node) });
            }
        }
    }
    Ok(())
}

/// Refuses a load step whose work is neither stored nor dissipated.
fn check_work(
    cx: &Context,
    ws: &mut Workspace,
    state: &State,
    dissipated: &Dissipation,
    to: f64,
) -> Result<(), Failure> {
    let end = Configuration { nodes: &ws.end.nodes, history: &ws.history, dt: 0.0, previous: None };
    let before = match ws.load_steps.stored {
        Some((time, energy)) if time == state.time => energy,
        _ => cx.system.stored_energy(&state.configuration(), cx.plan.threads),
    };
    let after = cx.system.stored_energy(&end, cx.plan.threads);
    let Dissipation { plastic, viscous, stored, friction, impact, eroded } = *dissipated;
    let books = [before, after, plastic, viscous, stored, friction, impact, eroded];
    let loads = cx.system.load_work((&state.nodes, &ws.loads.start), (&ws.end.nodes, &ws.loads.end));
    if loads[1] == 0.0 && books == [0.0; 8] {
        // Without loads, energies and losses there is nowhere to jump to; drives of a linkage work against rounding then.
        return Ok(());
    }
    let taken = after - before + plastic + viscous + stored + friction + impact + eroded;
    let ([of_loads, of_supports], gross, spread) = work_of_step(cx, ws, state, loads);
    let work = of_loads + of_supports;
    let Scale { force, moment } = ws.load_steps.peak.forces;
    let rounding = ACCURACY * (gross + before.abs().min(after.abs()) * f64::EPSILON.sqrt())
        + NOTHING * (force * cx.length + moment);
    let missed = (work - taken).abs();
    if missed > rounding {
        // Loads that act at once, at t = 0 or at a jump, do work before they are in equilibrium.
        let sudden = unbalanced_work(cx, ws, state);
        let smooth = 0.5 * (to - state.time) < cx.model.analysis.least_step
            || ws
                .load_steps
                .doubtful
                .is_some_and(|(time, missed_before)| time == state.time && missed <= 0.5 * missed_before);
        let part = if smooth { CURVED } else { DOUBTFUL };
        if missed > part * spread + rounding + sudden {
            let (size, place) = largest_motion(cx, ws);
            if size > STILL * cx.length {
                ws.load_steps.doubtful = Some((state.time, missed));
                return Err(failure(cx, place, work, taken));
            }
        }
        ws.load_steps.works.sudden += sudden;
    }
    ws.load_steps.works.add([of_loads, of_supports], gross);
    ws.load_steps.stored = Some((to, after));
    Ok(())
}

/// The works of loads and supports in a step by the mean forces of its ends, the sum of their terms without signs, and `½ Σ |Δf| |Δq|`. The
/// array holds these values for the loads.
fn work_of_step(
    cx: &Context,
    ws: &Workspace,
    state: &State,
    [of_loads, mut gross, mut spread]: [f64; 3],
) -> ([f64; 2], f64, f64) {
    let mut of_supports = 0.0;
    for (i, restraint) in cx.model.constraints.restraints.iter().enumerate() {
        let (old, new) = (state.reactions[i], -ws.forces.on_nodes[restraint.node][restraint.dof]);
        let moved = ws.prescribed.moved[i].u;
        of_supports += 0.5 * (old + new) * moved;
        gross += 0.5 * (old.abs() + new.abs()) * moved.abs();
        spread += 0.5 * (new - old).abs() * moved.abs();
    }
    ([of_loads, of_supports], gross, spread)
}

/// Work that the unbalanced forces at the start of the step would do in its motion.
fn unbalanced_work(cx: &Context, ws: &mut Workspace, state: &State) -> f64 {
    // The step ends by its own forces, which are kept.
    let mut forces = ws.forces.clone();
    forces.multipliers.values.copy_from_slice(&state.multipliers);
    cx.system.residual(&state.configuration(), &ws.loads.start, &mut forces);
    let work = |&node: &usize| {
        let q = cx.plan.dofs.of(node).mask(&ws.end.increments[node].q);
        (0..6).map(|i| (forces.on_nodes[node][i] * q[i]).abs()).sum::<f64>()
    };
    cx.independent_nodes.iter().map(work).sum()
}

/// The largest motion of the step, with its node and degree of freedom. Rotations count times a thousandth of the model's length, so they
/// decide only if translations are negligible.
fn largest_motion(cx: &Context, ws: &Workspace) -> (f64, (usize, usize)) {
    let (mut largest, mut place) = (0.0, (0, 0));
    for &node in &cx.independent_nodes {
        let q = cx.plan.dofs.of(node).mask(&ws.end.increments[node].q);
        let turn = angular(&q) * (LEVER * cx.length);
        for (dof, size) in linear(&q).iter().chain(turn.iter()).map(|q| q.abs()).enumerate() {
            if size > largest {
                (largest, place) = (size, (node, dof));
            }
        }
    }
    (largest, place)
}

fn failure(cx: &Context, (node, dof): (usize, usize), work: f64, stored: f64) -> Failure {
    let label = cx.model.nodes.get(node).map_or_else(String::new, |node| node.label.clone());
    let laws = cx.system.groups.iter().filter_map(|group| law_of(cx.model, group));
    let smooth = laws.filter(|(_, law)| law.friction == 0.0).map(|(name, _)| name.to_owned()).next();
    Failure::EquilibriumJumps { label, direction: DIRECTIONS[dof], work, stored, smooth }
}
