//! Contacts of a scene: whether a step passes or fails to resolve an impact, and the resultants for output.

use super::equations::System;
use super::group::Group;
use base::math::Vec3;
use mechanics::elements::contact::{self, ContactLaw, PairBlock};
use mechanics::elements::{Partners, Wandering};
use mechanics::state::{Configuration, Node, State};
use model::{CarriedSurface, Contact, Model, PartType, TouchedSurface};

/// The state of a contact at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// Number of points in contact.
    pub touching: usize,
    /// Number of those whose friction is at its limit.
    pub slipping: usize,
    /// Smallest gap of all points; negative where they penetrate.
    pub gap: f64,
    /// Force on the surface, global components.
    pub f: Vec3,
    /// Its moment about the centre of the body that carries the surface, or about the reference point of a ground
    /// surface.
    pub m: Vec3,
}

/// The action of one touch on the surface of its contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactTouch {
    /// The number of the contact among all.
    pub contact: usize,
    /// A node of the touched part and a node of the touching part.
    pub nodes: [usize; 2],
    /// Force on the touched part, global components.
    pub f: Vec3,
    /// Its moment about the origin.
    pub m: Vec3,
}

/// Numbers of touches and of those that slip; force and moment of all on the surface, in the conventions of [`ContactState`].
fn resultant(block: &dyn PairBlock, contact: &Contact, now: &Configuration) -> ([usize; 2], [Vec3; 2]) {
    let has_sides = match &contact.surface {
        TouchedSurface::Shape(_) => true,
        TouchedSurface::Facets(faces) => faces.has_sides(),
    };
    let (mut count, mut slipping, mut f, mut m) = (0, 0, Vec3::zeros(), Vec3::zeros());
    block.each_action(now, &mut |action| {
        count += 1;
        slipping += usize::from(action.slips());
        if has_sides {
            let [force, moment] = action.on_touched();
            f += force;
            m += moment;
        }
    });
    if let (Some(node), true) = (block.carrier(), count > 0 && contact.has_facets()) {
        // About the centre of the body so far, and about the origin as that on the facets.
        (f, m) = (-f, -(m + now.nodes[node].x.cross(&f)));
    }
    ([count, slipping], [f, m])
}

/// The name and the law of the contact that a group is of; `None` for other groups, and for monitors.
pub fn law_of<'m>(model: &'m Model, group: &Group) -> Option<(&'m str, ContactLaw)> {
    let contact = Contact::of(&model.parts[group.part])?;
    Some((&contact.name, contact.law?))
}

/// The least gap of a contact at the start of a step, by its history, where all of it is open; `None` for other groups.
pub fn open_gap(group: &Group, history: &[f64]) -> Option<f64> {
    let block = group.block.pairs().filter(|block| !block.pushes(history))?;
    let gap = block.last_gap(history);
    (gap > 0.0 && gap.is_finite()).then_some(gap)
}

impl System {
    /// The shortest critical step of central differences by contacts: 2/ω = T/π with the period T.
    pub fn critical_step_of_contacts(model: &Model) -> f64 {
        let laws = model.each::<Contact>().filter_map(|contact| contact.law);
        laws.map(|law| law.duration / std::f64::consts::PI).filter(|&step| step > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// True where the scene has contacts.
    pub fn has_contacts(&self) -> bool {
        self.contacts < self.groups.len()
    }

    /// The groups of elements with changing partners, with their numbers.
    pub fn wandering_groups(&self) -> impl Iterator<Item = (usize, &Group, &dyn Wandering)> {
        let contacts = self.groups.iter().enumerate().skip(self.contacts);
        contacts.filter_map(|(number, group)| Some((number, group, group.wandering()?)))
    }

    /// The pairs of elements that may soon act at these positions of the nodes, by their groups.
    pub fn partners(&self, nodes: &[Node]) -> Vec<(usize, Partners)> {
        self.wandering_groups().map(|(number, _, block)| (number, block.partners(nodes))).collect()
    }

    /// True where friction may make the tangent unsymmetric.
    pub fn rubs(&self) -> bool {
        self.contact_groups().any(|(_, block)| block.rubs()) || self.has_sliders()
    }

    /// True where sliders rub on their dishes.
    pub fn has_sliders(&self) -> bool {
        self.groups.iter().any(|group| group.block.slips_by_load())
    }

    /// True where any material has history variables.
    pub fn yields(&self) -> bool {
        self.groups.iter().any(|group| group.kind.is_deformable() && !group.history.is_empty())
    }

    pub(super) fn contact_groups(&self) -> impl Iterator<Item = (&Group, &dyn PairBlock)> {
        self.groups[self.contacts..].iter().filter_map(|group| Some((group, group.block.pairs()?)))
    }

    /// The first contact that satisfies a condition, by its index in [`Model::parts`].
    fn contact_where(&self, mut is: impl FnMut(&Group, &dyn PairBlock) -> bool) -> Option<usize> {
        self.contact_groups().find(|(group, block)| is(group, *block)).map(|(group, _)| group.part)
    }

    /// The contact, by its index in [`Model::parts`], with an impact after `state` that is too short for a step with equilibrium `ahead`
    /// later.
    pub fn unresolved_impact(&self, state: &State, ahead: f64) -> Option<usize> {
        self.contact_where(|group, block| {
            ahead > block.longest_step(&state.history[group.history.clone()]) * (1.0 + 1e-9)
        })
    }

    /// The contact, by its index in [`Model::parts`], with an unresolved impact or a point that passes through the surface in a step from
    /// `start` to `now`.
    pub fn missed_contact(&self, start: &[Node], now: &Configuration) -> Option<usize> {
        self.contact_where(|group, block| block.misses(start, &group.configuration(now)))
    }

    /// True where a contact has multipliers.
    pub fn has_contact_multipliers(&self) -> bool {
        self.contact_groups().any(|(_, block)| block.has_multipliers())
    }

    /// Writes the contact forces of the equilibrium `now` as multipliers into `history`, which belongs to the start of the step like the
    /// nodes `start`. Returns the largest penetration or slip error over its tolerance, and its contact by the index in [`Model::parts`].
    pub fn augment_contacts(&self, start: &[Node], now: &Configuration, history: &mut [f64]) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (group, block) in self.contact_groups() {
            let out = block.augment(start, &group.configuration(now), &mut history[group.history.clone()]);
            if out > worst.0 {
                worst = (out, group.part);
            }
        }
        worst
    }

    /// Each block of contacts with its least gap, which is read from the history at almost no cost.
    pub fn last_gaps<'a>(&'a self, state: &'a State) -> impl Iterator<Item = (&'a Group, f64)> + 'a {
        self.contact_groups().map(|(group, block)| (group, block.last_gap(&state.history[group.history.clone()])))
    }

    /// The contacts with a force, by their indices in [`Model::parts`].
    pub fn contact_parts(&self) -> Vec<usize> {
        let mut parts: Vec<usize> = self.contact_groups().map(|(group, _)| group.part).collect();
        parts.dedup();
        parts
    }

    /// Adds the contacts that touch at the end of a step, or have within it, by their indices in [`Model::parts`].
    pub fn note_touched(&self, state: &State, touched: &mut Vec<usize>) {
        for (group, block) in self.contact_groups() {
            let history = &state.history[group.history.clone()];
            let meets = || {
                block.pushes(history)
                    || block.any_memory(history, &mut |pair| pair.gap() <= 0.0 || pair.impact_speed() > 0.0)
            };
            if !touched.contains(&group.part) && meets() {
                touched.push(group.part);
            }
        }
    }

    /// The contact, by its index in [`Model::parts`], with beams that press each other side by side.
    pub fn side_by_side(&self, state: &State) -> Option<usize> {
        self.contact_where(|group, block| block.is_side_by_side(&group.configuration(&state.configuration())))
    }

    /// The contact, by its index in [`Model::parts`], with a body that touches more others than the history can hold.
    pub fn crowded(&self, state: &State) -> Option<usize> {
        self.contact_where(|group, block| block.is_crowded(&group.configuration(&state.configuration())))
    }

    /// Writes the states of all contacts into `out`, in deck order.
    pub fn contact_states(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactState>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (place, contact) in contacts {
            let own = || self.contact_groups().filter(move |(group, _)| group.part == place);
            let gap = least_gap(contact, own().map(|(_, block)| block), now.nodes);
            let mut state = ContactState { touching: 0, slipping: 0, gap, f: Vec3::zeros(), m: Vec3::zeros() };
            for (group, block) in own() {
                let ([touching, slipping], [f, m]) = resultant(block, contact, &group.configuration(now));
                state.touching += touching;
                state.slipping += slipping;
                state.f += f;
                state.m += m;
            }
            out.push(state);
        }
    }

    /// Writes the action of each touch into `out`, contact by contact in deck order.
    pub fn contact_touches(&self, model: &Model, now: &Configuration, out: &mut Vec<ContactTouch>) {
        out.clear();
        let contacts = model.parts.iter().enumerate().filter_map(|(place, part)| Some((place, Contact::of(part)?)));
        for (number, (place, contact)) in contacts.enumerate() {
            for (group, block) in self.contact_groups().filter(|(group, _)| group.part == place) {
                // In these blocks nodes of facets touch a body, so the facets are the touching part.
                let is_turned_round = block.carrier().is_some() && contact.has_facets();
                block.each_action(&group.configuration(now), &mut |action| {
                    let (nodes, [f, mut m]) = (action.nodes(), action.on_touched());
                    if block.carrier().is_some() {
                        m += now.nodes[nodes[0]].x.cross(&f);
                    }
                    out.push(match is_turned_round {
                        true => ContactTouch { contact: number, nodes: [nodes[1], nodes[0]], f: -f, m: -m },
                        false => ContactTouch { contact: number, nodes, f, m },
                    });
                });
            }
        }
    }
}

/// Least gap of all that touches in a contact, `blocks` being its own.
fn least_gap<'a>(contact: &Contact, blocks: impl Iterator<Item = &'a dyn PairBlock>, nodes: &[Node]) -> f64 {
    let points = &contact.points;
    match &contact.surface {
        TouchedSurface::Shape(carried) => {
            let of_points = contact::least_gap(&carried.surface, carried.node, points, nodes);
            of_points.min(contact::pair_gap(&carried.surface, carried.node, &contact.convex, nodes))
        }
        TouchedSurface::Facets(faces) => {
            let gap = match contact.law {
                Some(_) => blocks.map(|block| block.least_gap(nodes)).fold(f64::INFINITY, f64::min),
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
