//! Slip of all springs of friction in a step: points and pairs of solids in contact, and joints with friction.

use super::equations::System;
use mechanics::elements::slip::Slip;

/// One spring of friction: an element of a group.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FrictionPlace {
    /// The number of the group.
    pub group: usize,
    /// The number of the element in it.
    pub element: usize,
}

/// All springs of friction with known slip. Balls, facets and bodies among themselves have none.
pub fn friction_places(system: &System) -> Vec<FrictionPlace> {
    let mut found = Vec::new();
    for (number, group) in system.groups.iter().enumerate() {
        let Some(sliding) = group.block.sliding() else { continue };
        let rubs = (0..group.block.len()).filter(|&e| sliding.has_friction(e));
        found.extend(rubs.map(|element| FrictionPlace { group: number, element }));
    }
    found
}

/// The slip of a spring of friction in a step of length `dt` between two histories of the scene.
pub fn slip(system: &System, at: FrictionPlace, histories: [&[f64]; 2], dt: f64) -> Slip {
    let group = &system.groups[at.group];
    let own = histories.map(|history| &history[group.history.clone()]);
    group.block.sliding().map_or_else(Slip::default, |sliding| sliding.slip(at.element, own, dt))
}
