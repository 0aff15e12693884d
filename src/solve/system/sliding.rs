//! Slip of all springs of friction in a step: points and pairs of solids in contact, and joints with friction.

use super::equations::System;
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
    /// All springs of friction with known slip. Balls, facets and bodies among themselves have none.
    pub fn rubbing(&self) -> Vec<Rubbing> {
        let mut found = Vec::new();
        for (number, group) in self.groups.iter().enumerate() {
            let Some(sliding) = group.block.sliding() else { continue };
            let rubs = (0..group.block.len()).filter(|&e| sliding.has_friction(e));
            found.extend(rubs.map(|element| Rubbing { group: number, element }));
        }
        found
    }

    /// The slip of a spring of friction in a step of length `dt` between two histories of the scene.
    pub fn slip(&self, at: Rubbing, histories: [&[f64]; 2], dt: f64) -> Slip {
        let group = &self.groups[at.group];
        let own = histories.map(|history| &history[group.history.clone()]);
        group.block.sliding().map_or_else(Slip::default, |sliding| sliding.slip(at.element, own, dt))
    }
}
