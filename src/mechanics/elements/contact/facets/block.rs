//! Points against facets as a block of elements, one for each point, and as pairs for the matrix.

use super::gap::least_facet_gap;
use super::pair::MOST_OF_PAIR;
use super::steps::misses_facet;
use super::surface::FacetContacts;
use super::tangent::add_tangent;
use super::update::update;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::pair_block::{PairAction, PairBlock, energy, subtract_forces};
use crate::elements::wandering::{Partners, Wandering};
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};

impl Elements for FacetContacts {
    fn len(&self) -> usize {
        self.points.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        self.points[e].nodes()
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, e: usize, _: usize) -> bool {
        self.law.friction > 0.0 && self.points[e].rolling_radius > 0.0
    }
}

impl Mechanics for FacetContacts {
    fn history(&self) -> usize {
        self.slots * self.width * self.points.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        subtract_forces(self, now, F);
    }

    /// Pairs have tangents, and not points: see [`Wandering::pair_tangents`].
    fn tangent(&self, _: usize, _: &Configuration, _: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        update(self, now, part, history)
    }
}

impl Results for FacetContacts {
    fn energy(&self, now: &Configuration) -> f64 {
        energy(self, now)
    }
}

impl Branches for FacetContacts {
    fn is_inactive(&self, _: usize, _: &Configuration) -> bool {
        true
    }
}

impl PairBlock for FacetContacts {
    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction)) {
        self.each_touch(now.nodes, now.history, |_, _, pair| {
            let place = pair.place(now.nodes);
            act(&pair.action(&place, &pair.force(&place, now.nodes), now.nodes));
        });
    }

    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PairMemory) -> bool) -> bool {
        self.known_memories(history).any(is)
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        misses_facet(self, start, now)
    }

    fn wandering(&self) -> Option<&dyn Wandering> {
        Some(self)
    }

    fn least_gap(&self, nodes: &[Node]) -> f64 {
        least_facet_gap(self, nodes)
    }

    fn is_side_by_side(&self, now: &Configuration) -> bool {
        /// The square of the cosine of six degrees.
        const ALONG: f64 = 0.989;
        if !self.is_of_lines || self.is_of_edges {
            return false;
        }
        let mut found = false;
        self.each_touch(now.nodes, now.history, |_, touch, pair| {
            let along = |ends: &[usize]| now.nodes[ends[1]].relative_position(&now.nodes[ends[0]]);
            let (u, v) = (along(pair.point.nodes()), along(pair.facet.nodes()));
            let is_parallel = u.dot(&v).powi(2) > ALONG * u.norm_squared() * v.norm_squared();
            // End to end they touch along themselves.
            let is_beside = u.dot(&touch.toward).powi(2) < 0.5 * u.norm_squared();
            found |= is_parallel && is_beside;
        });
        found
    }
}

impl Wandering for FacetContacts {
    fn further_nodes(&self) -> [&[usize]; 2] {
        [&self.involved, &self.turned]
    }

    fn partners(&self, nodes: &[Node]) -> Partners {
        let mut partners = Partners::default();
        let nearby = self.nearby(nodes);
        for e in 0..self.points.len() {
            for &facet in nearby.of(e).iter().filter(|&&facet| !self.is_near_along(e, facet)) {
                let of_facet = self.facets[facet as usize].nodes();
                let all = self.points[e].nodes().iter().chain(of_facet).copied();
                partners.push([e, facet as usize], all);
            }
        }
        partners
    }

    fn has_room(&self, partners: &Partners, now: &Configuration) -> bool {
        let mut has = true;
        self.each_touch(now.nodes, now.history, |e, touch, _| has &= partners.place([e, touch.facet]).is_some());
        has
    }

    fn pair_tangents(
        &self,
        partners: &Partners,
        now: &Configuration,
        rate_weight: f64,
        K: &mut [f64],
        add: &mut dyn FnMut(usize, &mut [f64]),
    ) {
        self.each_touch(now.nodes, now.history, |e, touch, pair| {
            let Some(place) = partners.place([e, touch.facet]) else { return };
            let count = pair.point.count + pair.facet.corners;
            debug_assert!(count <= MOST_OF_PAIR);
            let K = &mut K[..36 * count * count];
            K.fill(0.0);
            add_tangent(&pair, &pair.place(now.nodes), now.nodes, rate_weight, K);
            add(place, K);
        });
    }
}
