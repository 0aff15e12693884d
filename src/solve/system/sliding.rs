//! What rubs in a scene, and how far it slips in a step: points and pairs of solids in contact, and joints with friction.

use super::equations::System;
use super::group::Group;
use super::parts::coordinate_springs::CoordinateSprings;
use mechanics::elements::contact::{Contacts, ConvexPairs, rubbing_points, slip_of_pair, slip_of_point};
use mechanics::elements::slip::Slip;

/// One spring of friction: an element of a group.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rubbing {
    /// The number of the group.
    pub group: usize,
    /// The number of the element in it.
    pub element: usize,
}

impl System {
    /// All springs of friction whose slip is known: none of balls and of facets, nor of bodies among themselves.
    pub fn rubbing(&self) -> Vec<Rubbing> {
        let rubs = |group: &Group, e: usize| springs(group).is_none_or(|springs| springs.rubs(e));
        let of = |(group, at): (usize, &Group)| -> Vec<Rubbing> {
            (0..count(at)).filter(|&e| rubs(at, e)).map(|element| Rubbing { group, element }).collect()
        };
        self.groups.iter().enumerate().flat_map(of).collect()
    }

    /// The slip of a spring of friction in a step of length `dt` between two histories of the scene.
    pub fn slip(&self, at: Rubbing, histories: [&[f64]; 2], dt: f64) -> Slip {
        let group = &self.groups[at.group];
        let own = histories.map(|history| &history[group.history.clone()]);
        let Some(any) = group.block.as_any() else { return Slip::default() };
        if let Some(points) = any.downcast_ref::<Contacts>() {
            return slip_of_point(points, at.element, own);
        }
        if let Some(pairs) = any.downcast_ref::<ConvexPairs>() {
            return slip_of_pair(pairs, at.element, own, dt);
        }
        springs(group).map_or_else(Slip::default, |springs| springs.slip(at.element, own))
    }
}

/// The joints of a group, where it is one of joints.
fn springs(group: &Group) -> Option<&CoordinateSprings> {
    group.block.as_any()?.downcast_ref()
}

/// The number of elements of a group that may rub.
fn count(group: &Group) -> usize {
    let Some(any) = group.block.as_any() else { return 0 };
    match (any.downcast_ref::<Contacts>(), any.is::<ConvexPairs>(), any.is::<CoordinateSprings>()) {
        (Some(points), ..) => rubbing_points(points),
        (_, true, _) if group.block.rubs() => group.block.len(),
        (_, _, true) => group.block.len(),
        _ => 0,
    }
}
