//! Drives beyond the reach of their linkage, as the cause of a step that fails however short it is.
//!
//! Links that come to lie in one line can follow their drive no farther. The force of the drive then grows without bound over the forces that it
//! moves, by one over the sine of the angle to that line. In load steps without a force across that line the drive has none to grow.

use super::context::Context;
use super::failure::Failure;
use crate::system::{Forces, Loading, Side};
use crate::tolerances::out_of_reach::MOST;
use base::math::{Vec6, angular, linear, stack};
use mechanics::constraints::joint::MOST_ENDS;
use mechanics::state::State;

/// Room for forces and loads.
type ForceRoom<'r> = (&'r mut Forces, &'r mut Loading);

/// The failure of a step from this state, by a drive beyond its reach if there is one.
pub fn explained(cx: &Context, room: ForceRoom, state: &State, failure: Failure) -> Failure {
    match failure {
        Failure::NotConverged { .. }
        | Failure::ConstraintsViolated { .. }
        | Failure::TooManySubsteps { .. }
        | Failure::ErrorTooLarge { .. }
        | Failure::LoadStepTurns { .. } => farthest_drive(cx, room, state).unwrap_or(failure),
        failure => failure,
    }
}

/// The prescribed drive whose force is largest over the other forces on nodes, where it is beyond all reason.
fn farthest_drive(cx: &Context, room: ForceRoom, state: &State) -> Option<Failure> {
    let is_prescribed = |number: usize| cx.system.joints[number].drive.as_ref().is_some_and(|drive| !drive.is_free);
    if !(0..cx.system.joints.len()).any(is_prescribed) {
        return None;
    }
    let others = forces_besides_joints(cx, room, state);
    // Without other forces, all forces of joints are rounding.
    if others == 0.0 {
        return None;
    }
    let mut room = [Vec6::zeros(); MOST_ENDS];
    let mut worst: Option<(usize, f64)> = None;
    for (number, (joint, first)) in cx.system.numbered().enumerate().filter(|(number, _)| is_prescribed(*number)) {
        let last = joint.equations.len() - 1;
        let pulls = joint.gradient(last, &state.nodes, &mut room).iter().map(|G| state.multipliers[first + last] * G);
        let times = pulls.map(|pull| size(cx, &pull)).fold(0.0, f64::max) / others;
        if times > worst.map_or(MOST, |(_, most)| most) {
            worst = Some((number, times));
        }
    }
    let (number, times) = worst?;
    let drive = cx.system.joints[number].drive.as_ref()?;
    let name = cx.model.constraints.joints.get(number)?.name.clone();
    Some(Failure::OutOfReach { name, position: drive.coordinate(&state.nodes), times })
}

/// The largest force on a node by loads, elements and inertia.
fn forces_besides_joints(cx: &Context, (forces, loading): ForceRoom, state: &State) -> f64 {
    forces.multipliers.values.fill(0.0);
    cx.excitation.loading(state.time, Side::Before, loading);
    cx.system.residual(&state.configuration(), loading, forces);
    let largest = |forces: &Forces| forces.on_nodes.iter().map(|f| size(cx, &Vec6::from(*f))).fold(0.0, f64::max);
    let acting = largest(forces);
    if !cx.is_dynamic() {
        return acting;
    }
    let mut accelerations: Vec<Vec6> = state.nodes.iter().map(|node| stack(&node.a, &node.alpha)).collect();
    cx.system.apply_mass(&state.nodes, &mut accelerations, forces);
    acting.max(largest(forces))
}

/// The size of a force and a moment as one force.
fn size(cx: &Context, force: &Vec6) -> f64 {
    linear(force).norm().max(angular(force).norm() / cx.length)
}
