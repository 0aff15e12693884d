//! Contacts of a scene: whether a step passes or fails to resolve an impact, and the resultants for output.

use super::equations::System;
use super::group::Group;
use crate::elements::contact::{self, Contacts};
use crate::math::Vec3;
use crate::model::{Contact, Model, PartType};
use crate::state::{Configuration, Node, State};

/// The state of a contact at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// Number of points in contact.
    pub touching: usize,
    /// Smallest gap of all points; negative where they penetrate.
    pub gap: f64,
    /// Force on the surface, global components.
    pub f: Vec3,
    /// Its moment about the centre of the body that carries the surface, or about the reference point of a ground
    /// surface.
    pub m: Vec3,
}

impl System {
    /// True where the scene has contacts.
    pub fn has_contacts(&self) -> bool {
        self.contacts < self.groups.len()
    }

    /// True where any material has history variables.
    pub fn yields(&self) -> bool {
        self.groups.iter().any(|group| group.kind.is_deformable() && !group.history.is_empty())
    }

    fn contact_groups(&self) -> impl Iterator<Item = (&Group, &Contacts)> {
        self.groups[self.contacts..]
            .iter()
            .filter_map(|group| Some((group, group.block.as_any()?.downcast_ref::<Contacts>()?)))
    }

    /// The contact, by its index in [`Model::parts`], with an impact after `state` that is not resolved by a step whose
    /// equilibrium is written the time `ahead` later.
    pub fn unresolved_impact(&self, state: &State, ahead: f64) -> Option<usize> {
        let unresolved = |(group, block): &(&Group, &Contacts)| {
            ahead > contact::longest_step(block, &state.history[group.history.clone()]) * (1.0 + 1e-9)
        };
        self.contact_groups().find(unresolved).map(|(group, _)| group.part)
    }

    /// The contact, by its index in [`Model::parts`], whose surface a point would pass through in a step from `start`
    /// to `now`, or whose impact the step would not resolve.
    pub fn missed_contact(&self, start: &[Node], now: &Configuration) -> Option<usize> {
        self.contact_groups()
            .find(|(group, block)| contact::misses(block, start, &group.configuration(now)))
            .map(|(group, _)| group.part)
    }

    /// Writes the states of all contacts into `out`, in deck order.
    pub fn contact_states(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactState>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (place, contact) in contacts {
            let gap = contact::least_gap(&contact.surface, contact.node, &contact.points, now.nodes);
            let mut state = ContactState { touching: 0, gap, f: Vec3::zeros(), m: Vec3::zeros() };
            for (group, block) in self.contact_groups().filter(|(group, _)| group.part == place) {
                let sum = contact::resultant(block, &group.configuration(now));
                state.touching += sum.touching;
                state.f += sum.f;
                state.m += sum.m;
            }
            out.push(state);
        }
    }
}
