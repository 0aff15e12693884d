//! Contacts of a scene: how far a step may go, and what they come to.

use super::equations::System;
use super::group::Group;
use crate::elements::contact::{self, Contacts};
use crate::math::Vec3;
use crate::model::{Contact, Model, PartType};
use crate::state::{Configuration, Node, State};

/// A contact at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// Points that touch.
    pub touching: usize,
    /// Least distance of all points; negative inside.
    pub gap: f64,
    /// On the surface, and its moment about the centre of the body that carries it, or about the ground surface's own point.
    pub f: Vec3,
    pub m: Vec3,
}

impl System {
    /// True where anything may touch.
    pub fn has_contacts(&self) -> bool {
        self.contacts < self.groups.len()
    }

    /// True where material remembers.
    pub fn yields(&self) -> bool {
        self.groups[..self.contacts].iter().any(|group| !group.history.is_empty())
    }

    fn contact_groups(&self) -> impl Iterator<Item = (&Group, &Contacts)> {
        self.groups[self.contacts..]
            .iter()
            .filter_map(|group| Some((group, group.block.as_any()?.downcast_ref::<Contacts>()?)))
    }

    /// The contact, by its place in [`Model::parts`], with an impact after `state` that a step which writes equilibrium `ahead`
    /// ahead would not resolve.
    pub fn unresolved_impact(&self, state: &State, ahead: f64) -> Option<usize> {
        let unresolved = |(group, block): &(&Group, &Contacts)| {
            ahead > contact::longest_step(block, &state.history[group.history.clone()]) * (1.0 + 1e-9)
        };
        self.contact_groups().find(unresolved).map(|(group, _)| group.part)
    }

    /// The contact, by its place in [`Model::parts`], through whose surface a step from `start` to `now` would go, or into
    /// whose impact without resolving it.
    pub fn missed_contact(&self, start: &[Node], now: &Configuration) -> Option<usize> {
        self.contact_groups()
            .find(|(group, block)| contact::misses(block, start, &group.share(now)))
            .map(|(group, _)| group.part)
    }

    /// States of all contacts in deck order.
    pub fn contact_states(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactState>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (place, contact) in contacts {
            let gap = contact::least_gap(&contact.surface, contact.node, &contact.points, now.nodes);
            let mut state = ContactState { touching: 0, gap, f: Vec3::zeros(), m: Vec3::zeros() };
            for (group, block) in self.contact_groups().filter(|(group, _)| group.part == place) {
                let sum = contact::resultant(block, &group.share(now));
                state.touching += sum.touching;
                state.f += sum.f;
                state.m += sum.m;
            }
            out.push(state);
        }
    }
}
