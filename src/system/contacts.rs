//! Contacts of a scene: whether a step passes or fails to resolve an impact, and the resultants for output.

use super::equations::System;
use super::group::Group;
use crate::elements::contact::{self, BoxPairs, Contacts, Resultant};
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

/// What touches in a group of contacts.
enum ContactBlock<'a> {
    Points(&'a Contacts),
    Boxes(&'a BoxPairs),
}

impl ContactBlock<'_> {
    fn longest_step(&self, history: &[f64]) -> f64 {
        match self {
            ContactBlock::Points(block) => contact::longest_step(block, history),
            ContactBlock::Boxes(block) => contact::boxes::longest_pair_step(block, history),
        }
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        match self {
            ContactBlock::Points(block) => contact::misses(block, start, now),
            ContactBlock::Boxes(block) => contact::boxes::misses_pair(block, start, now),
        }
    }

    fn last_gap(&self, history: &[f64]) -> f64 {
        match self {
            ContactBlock::Points(block) => contact::last_gap(block, history),
            ContactBlock::Boxes(block) => contact::last_pair_gap(block, history),
        }
    }

    fn resultant(&self, now: &Configuration) -> Resultant {
        match self {
            ContactBlock::Points(block) => contact::resultant(block, now),
            ContactBlock::Boxes(block) => contact::pair_resultant(block, now),
        }
    }
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

    fn contact_groups(&self) -> impl Iterator<Item = (&Group, ContactBlock<'_>)> {
        self.groups[self.contacts..].iter().filter_map(|group| {
            let any = group.block.as_any()?;
            let points = any.downcast_ref().map(ContactBlock::Points);
            Some((group, points.or_else(|| any.downcast_ref().map(ContactBlock::Boxes))?))
        })
    }

    /// The contact, by its index in [`Model::parts`], with an impact after `state` that is not resolved by a step whose
    /// equilibrium is written the time `ahead` later.
    pub fn unresolved_impact(&self, state: &State, ahead: f64) -> Option<usize> {
        let unresolved = |(group, block): &(&Group, ContactBlock)| {
            ahead > block.longest_step(&state.history[group.history.clone()]) * (1.0 + 1e-9)
        };
        self.contact_groups().find(unresolved).map(|(group, _)| group.part)
    }

    /// The contact, by its index in [`Model::parts`], whose surface a point would pass through in a step from `start`
    /// to `now`, or whose impact the step would not resolve.
    pub fn missed_contact(&self, start: &[Node], now: &Configuration) -> Option<usize> {
        self.contact_groups()
            .find(|(group, block)| block.misses(start, &group.configuration(now)))
            .map(|(group, _)| group.part)
    }

    /// Each block of contacts, by the index of its contact in [`Model::parts`], with the least gap of all that is near; from the
    /// history alone, which costs next to nothing.
    pub fn last_gaps<'a>(&'a self, state: &'a State) -> impl Iterator<Item = (usize, f64)> + 'a {
        let gap = |(group, block): (&Group, ContactBlock)| {
            (group.part, block.last_gap(&state.history[group.history.clone()]))
        };
        self.contact_groups().map(gap)
    }

    /// Writes the states of all contacts into `out`, in deck order.
    pub fn contact_states(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactState>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (place, contact) in contacts {
            let of_points = contact::least_gap(&contact.surface, contact.node, &contact.points, now.nodes);
            let gap = of_points.min(contact::pair_gap(&contact.surface, contact.node, &contact.boxes, now.nodes));
            let mut state = ContactState { touching: 0, gap, f: Vec3::zeros(), m: Vec3::zeros() };
            for (group, block) in self.contact_groups().filter(|(group, _)| group.part == place) {
                let sum = block.resultant(&group.configuration(now));
                state.touching += sum.touching;
                state.f += sum.f;
                state.m += sum.m;
            }
            out.push(state);
        }
    }
}
