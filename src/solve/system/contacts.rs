//! Contacts of a scene: whether a step passes or fails to resolve an impact, and the resultants for output.

use super::equations::System;
use super::group::Group;
use base::math::Vec3;
use mechanics::elements::contact::{self, ContactAction, Contacts, ConvexHeap, ConvexPairs, FacetContacts};
use mechanics::elements::{Partners, Wandering};
use mechanics::state::{Configuration, Node, State};
use model::{CarriedSurface, Contact, Model, PartType, TouchedSurface};

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

/// What one touch does to the surface of its contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactTouch {
    /// The number of the contact among all.
    pub contact: usize,
    /// A node of what is touched and one of what touches.
    pub nodes: [usize; 2],
    /// Force on what is touched, global components.
    pub f: Vec3,
    /// Its moment about the origin.
    pub m: Vec3,
}

/// What touches in a group of contacts.
enum ContactBlock<'a> {
    Points(&'a Contacts),
    Pairs(&'a ConvexPairs),
    Heap(&'a ConvexHeap),
    Facets(&'a FacetContacts),
}

impl<'a> ContactBlock<'a> {
    /// What a group of contacts is; `None` for all others.
    fn of(group: &'a Group) -> Option<ContactBlock<'a>> {
        let any = group.block.as_any()?;
        let points = any.downcast_ref().map(ContactBlock::Points);
        let convex = || any.downcast_ref().map(ContactBlock::Pairs);
        let heap = || any.downcast_ref().map(ContactBlock::Heap);
        let facets = || any.downcast_ref().map(ContactBlock::Facets);
        points.or_else(convex).or_else(heap).or_else(facets)
    }

    fn longest_step(&self, history: &[f64]) -> f64 {
        match self {
            ContactBlock::Points(block) => contact::longest_step(block, history),
            ContactBlock::Pairs(block) => contact::convex::longest_pair_step(block, history),
            ContactBlock::Heap(block) => contact::convex::longest_heap_step(block, history),
            ContactBlock::Facets(block) => contact::facets::longest_facet_step(block, history),
        }
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        match self {
            ContactBlock::Points(block) => contact::misses(block, start, now),
            ContactBlock::Pairs(block) => contact::convex::misses_pair(block, start, now),
            ContactBlock::Heap(block) => contact::convex::misses_heap(block, start, now),
            ContactBlock::Facets(block) => contact::facets::misses_facet(block, start, now),
        }
    }

    fn last_gap(&self, history: &[f64]) -> f64 {
        match self {
            ContactBlock::Points(block) => contact::last_gap(block, history),
            ContactBlock::Pairs(block) => contact::last_pair_gap(block, history),
            ContactBlock::Heap(block) => contact::convex::last_heap_gap(block, history),
            ContactBlock::Facets(block) => contact::facets::last_facet_gap(block, history),
        }
    }

    /// Calls with what each touch does to the surface.
    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(ContactAction)) {
        match self {
            ContactBlock::Points(block) => contact::each_touch(block, now, act),
            ContactBlock::Pairs(block) => contact::each_pair_touch(block, now, act),
            ContactBlock::Heap(block) => contact::convex::each_heap_touch(block, now, act),
            ContactBlock::Facets(block) => contact::facets::each_facet_touch(block, now, act),
        }
    }

    /// True for nodes of facets that touch a body, to which the facets are what touches.
    fn is_turned_round(&self, contact: &Contact) -> bool {
        matches!(self, ContactBlock::Points(_)) && contact.has_facets()
    }

    /// What all touches together do to the surface: their number, the force and the moment, as [`ContactState`] has them.
    fn resultant(&self, contact: &Contact, now: &Configuration) -> (usize, [Vec3; 2]) {
        let has_sides = match &contact.surface {
            TouchedSurface::Shape(_) => true,
            TouchedSurface::Facets(faces) => faces.has_sides(),
        };
        let (mut count, mut f, mut m, mut on) = (0, Vec3::zeros(), Vec3::zeros(), None);
        self.each_action(now, &mut |action| {
            (count, on) = (count + 1, Some(action.on));
            if has_sides {
                f += action.f;
                m += action.m;
            }
        });
        if let (Some(node), true) = (on, self.is_turned_round(contact)) {
            // About the centre of the body so far, and about the origin as that on the facets.
            (f, m) = (-f, -(m + now.nodes[node].x.cross(&f)));
        }
        (count, [f, m])
    }
}

/// The least gap of a contact at the start of a step, by its history, where all of it is open; `None` for other groups.
pub fn open_gap(group: &Group, history: &[f64]) -> Option<f64> {
    let block = ContactBlock::of(group)?;
    let gap = match block {
        ContactBlock::Points(points) if contact::pushes(points, history) => return None,
        _ => block.last_gap(history),
    };
    (gap > 0.0 && gap.is_finite()).then_some(gap)
}

impl System {
    /// True where the scene has contacts.
    pub fn has_contacts(&self) -> bool {
        self.contacts < self.groups.len()
    }

    /// The groups whose elements wander, with their numbers.
    pub fn wandering_groups(&self) -> impl Iterator<Item = (usize, &Group, &dyn Wandering)> {
        let contacts = self.groups.iter().enumerate().skip(self.contacts);
        contacts.filter_map(|(number, group)| Some((number, group, group.block.wandering()?)))
    }

    /// The pairs of elements that may act soon where the nodes lie thus, by their groups.
    pub fn partners(&self, nodes: &[Node]) -> Vec<(usize, Partners)> {
        self.wandering_groups().map(|(number, _, block)| (number, block.partners(nodes))).collect()
    }

    /// True where friction may make the tangent unsymmetric.
    pub fn rubs(&self) -> bool {
        self.groups.iter().any(|group| group.block.rubs())
    }

    /// True where any material has history variables.
    pub fn yields(&self) -> bool {
        self.groups.iter().any(|group| group.kind.is_deformable() && !group.history.is_empty())
    }

    fn contact_groups(&self) -> impl Iterator<Item = (&Group, ContactBlock<'_>)> {
        self.groups[self.contacts..].iter().filter_map(|group| Some((group, ContactBlock::of(group)?)))
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

    /// True where a contact has multipliers.
    pub fn has_contact_multipliers(&self) -> bool {
        let has = |block| matches!(block, ContactBlock::Points(points) if points.has_multipliers());
        self.contact_groups().any(|(_, block)| has(block))
    }

    /// Writes into `history`, that of the start of a step, multipliers of contacts by the forces in the equilibrium `now`; `start` are the
    /// nodes at the start of the step. Returns the largest length by which one was out, over its tolerance, and the contact by its index
    /// in [`Model::parts`].
    pub fn augment_contacts(&self, start: &[Node], now: &Configuration, history: &mut [f64]) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (group, block) in self.contact_groups() {
            let ContactBlock::Points(block) = block else { continue };
            let out = contact::augment(block, start, &group.configuration(now), &mut history[group.history.clone()]);
            if out > worst.0 {
                worst = (out, group.part);
            }
        }
        worst
    }

    /// Each block of contacts, with the least gap of all that is near; from the history alone, which costs next to nothing.
    pub fn last_gaps<'a>(&'a self, state: &'a State) -> impl Iterator<Item = (&'a Group, f64)> + 'a {
        let gap =
            |(group, block): (&'a Group, ContactBlock)| (group, block.last_gap(&state.history[group.history.clone()]));
        self.contact_groups().map(gap)
    }

    /// The contact, by its index in [`Model::parts`], in which beams press each other side by side.
    pub fn side_by_side(&self, state: &State) -> Option<usize> {
        let now = state.configuration();
        let is_so = |(group, block): &(&Group, ContactBlock)| match block {
            ContactBlock::Facets(block) => block.is_side_by_side(&group.configuration(&now)),
            ContactBlock::Points(_) | ContactBlock::Pairs(_) | ContactBlock::Heap(_) => false,
        };
        self.contact_groups().find(is_so).map(|(group, _)| group.part)
    }

    /// The contact, by its index in [`Model::parts`], in which a body touches more others than it remembers.
    pub fn crowded(&self, state: &State) -> Option<usize> {
        let now = state.configuration();
        let is_so = |(group, block): &(&Group, ContactBlock)| match block {
            ContactBlock::Heap(block) => block.is_crowded(&group.configuration(&now)),
            ContactBlock::Points(_) | ContactBlock::Pairs(_) | ContactBlock::Facets(_) => false,
        };
        self.contact_groups().find(is_so).map(|(group, _)| group.part)
    }

    /// Writes the states of all contacts into `out`, in deck order.
    pub fn contact_states(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactState>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (place, contact) in contacts {
            let own = || self.contact_groups().filter(move |(group, _)| group.part == place);
            let gap = least_gap(contact, own().map(|(_, block)| block), now.nodes);
            let mut state = ContactState { touching: 0, gap, f: Vec3::zeros(), m: Vec3::zeros() };
            for (group, block) in own() {
                let (touching, [f, m]) = block.resultant(contact, &group.configuration(now));
                state.touching += touching;
                state.f += f;
                state.m += m;
            }
            out.push(state);
        }
    }

    /// Writes into `out` what each touch of each contact that acts does, contact by contact in deck order.
    pub fn contact_touches(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactTouch>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (number, (place, contact)) in contacts.enumerate() {
            for (group, block) in self.contact_groups().filter(|(group, _)| group.part == place) {
                let is_turned_round = block.is_turned_round(contact);
                let is_about_node = matches!(block, ContactBlock::Points(_) | ContactBlock::Pairs(_));
                block.each_action(&group.configuration(now), &mut |action| {
                    let ContactAction { on, by, f, mut m } = action;
                    if is_about_node {
                        m += now.nodes[on].x.cross(&f);
                    }
                    out.push(match is_turned_round {
                        true => ContactTouch { contact: number, nodes: [by, on], f: -f, m: -m },
                        false => ContactTouch { contact: number, nodes: [on, by], f, m },
                    });
                });
            }
        }
    }
}

/// Least gap of all that touches in a contact, `blocks` being its own.
fn least_gap<'a>(contact: &Contact, blocks: impl Iterator<Item = ContactBlock<'a>>, nodes: &[Node]) -> f64 {
    let points = &contact.points;
    match &contact.surface {
        TouchedSurface::Shape(carried) => {
            let of_points = contact::least_gap(&carried.surface, carried.node, points, nodes);
            of_points.min(contact::pair_gap(&carried.surface, carried.node, &contact.convex, nodes))
        }
        TouchedSurface::Facets(faces) => {
            let of = |block: ContactBlock| match block {
                ContactBlock::Facets(block) => contact::facets::least_facet_gap(block, nodes),
                ContactBlock::Points(_) | ContactBlock::Pairs(_) | ContactBlock::Heap(_) => f64::INFINITY,
            };
            let gap = match contact.law {
                Some(_) => blocks.map(of).fold(f64::INFINITY, f64::min),
                None => {
                    let may_touch = |e: usize, facet: usize| !contact::facets::is_own(&points[e], &faces.facets[facet]);
                    contact::facets::facet_gap(&faces.facets, points, &may_touch, nodes, &mut Vec::new())
                }
            };
            let of_box =
                |carried: &CarriedSurface| contact::least_gap(&carried.surface, carried.node, &faces.back, nodes);
            let of_heap = contact::convex::heap_gap(&contact.convex, &contact.joined, nodes);
            faces.solids.iter().map(of_box).fold(gap.min(of_heap), f64::min)
        }
    }
}
