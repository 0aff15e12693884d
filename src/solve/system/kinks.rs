//! Kinks of the forces of a model: a step across a kink has the same low order with every scheme.

use super::equations::System;
use super::group::Group;
use mechanics::state::{Configuration, State};

/// Largest number of elements whose single kinks matter; among more elements each has a small share, and kinks come one after the other.
const FEW: usize = 8;
/// Points of a contact, likewise: more than the corners of the bodies that touch.
const FEW_POINTS: usize = 64;

/// True if forces may have kinks along the motion.
pub fn has_kinks(system: &System) -> bool {
    system.groups.iter().any(bends)
}

/// True if yielding is limited to so few elements that the forces of the model have a kink at yield.
pub fn yields_at_once(system: &System) -> bool {
    let yields = system.groups.iter().filter(|group| group.kind.is_deformable() && !group.history.is_empty());
    (1..=FEW).contains(&yields.map(|group| group.block.len()).sum())
}

/// A number for the branches of a state; it changes if a part opens, closes or reaches a stop.
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
    let now = Configuration { nodes: &state.nodes, history, dt: 0.0, previous: None };
    let block = &group.block;
    let of_contact = || {
        let points = if block.len() > FEW_POINTS { 0 } else { block.len() };
        let open = (0..points).filter(|&e| block.is_inactive(e, &now)).count();
        open + usize::from(block.energy(&now) > 0.0)
    };
    block.branches(&now).wrapping_add(if group.kind.is_unilateral() { of_contact() } else { 0 })
}
