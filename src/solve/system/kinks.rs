//! Kinks of the forces of a scene, which no order of a scheme resolves in a step that passes one.

use super::equations::System;
use super::group::Group;
use mechanics::state::{Configuration, State};

/// Elements of which each by itself bends the forces of the scene: of more, each has a small share, and kinks come one after the other.
const FEW: usize = 8;
/// Points of a contact, likewise: more than the corners of the bodies that touch.
const FEW_POINTS: usize = 64;

/// True where forces have kinks that a motion may pass.
pub fn has_kinks(system: &System) -> bool {
    system.groups.iter().any(bends)
}

/// True where material yields in so few elements that the forces of the scene have a kink there.
pub fn yields_at_once(system: &System) -> bool {
    let yields = system.groups.iter().filter(|group| group.kind.is_deformable() && !group.history.is_empty());
    (1..=FEW).contains(&yields.map(|group| group.block.len()).sum())
}

/// A number of the branches on which a state is; it changes where something opens, closes or comes to a stop.
pub fn branches(system: &System, state: &State) -> usize {
    let groups = system.groups.iter().filter(|group| bends(group));
    groups.fold(0, |sum: usize, group| sum.wrapping_add(branches_of(group, state)))
}

/// True where the forces of a group have kinks.
fn bends(group: &Group) -> bool {
    let yields = group.kind.is_deformable() && !group.history.is_empty();
    yields || group.kind.is_unilateral() || group.block.has_kinks() || group.block.can_fail()
}

fn branches_of(group: &Group, state: &State) -> usize {
    let history = &state.history[group.history.clone()];
    let now = Configuration { nodes: &state.nodes, history, dt: 0.0, lead: None };
    let block = &group.block;
    let of_contact = || {
        let points = if block.len() > FEW_POINTS { 0 } else { block.len() };
        let open = (0..points).filter(|&e| block.is_inactive(e, &now)).count();
        open + usize::from(block.energy(&now) > 0.0)
    };
    block.branches(&now).wrapping_add(if group.kind.is_unilateral() { of_contact() } else { 0 })
}
