//! Points against a surface of facets, with the lists of near facets.

use super::facet::Facet;
use super::facing::Facing;
use super::found::{FacetTouch, TouchQuery};
use super::nearby::NearbyFacets;
use super::pair::FacetPair;
use super::scene::{FacetScene, FacetTouchers};
use super::touch;
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::nearest_corner::NearestCorner;
use crate::elements::contact::point::ContactPoint;
use crate::state::Node;
use base::math::Vec3;
use std::ops::Deref;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Points with equally many nodes against a surface of facets.
pub struct FacetContacts {
    scene: FacetScene,
    nearby: Mutex<NearbyFacets>,
}

impl Deref for FacetContacts {
    type Target = FacetScene;

    fn deref(&self) -> &FacetScene {
        &self.scene
    }
}

impl FacetContacts {
    /// `points` have equally many nodes, one or more; `x` are the places of all nodes at t = 0.
    pub fn new(
        law: ContactLaw,
        touchers: FacetTouchers,
        points: Vec<ContactPoint>,
        facets: Vec<Facet>,
        x: &[Vec3],
    ) -> FacetContacts {
        FacetContacts { scene: FacetScene::new(law, touchers, points, facets, x), nearby: Mutex::default() }
    }

    /// The facets near the points, where the nodes lie thus. Threads lock the lists in turn; the result does not depend on their order.
    pub(super) fn nearby(&self, nodes: &[Node]) -> MutexGuard<'_, NearbyFacets> {
        let mut nearby = self.nearby.lock().unwrap_or_else(PoisonError::into_inner);
        nearby.update(self, nodes);
        nearby
    }

    /// A point and a facet with their memory; `history` is that of the block.
    pub(super) fn pair<'a>(&'a self, e: usize, touch: &FacetTouch, history: &'a [f64]) -> FacetPair<'a> {
        let place = touch.slot.map(|slot| (e, slot)).or(touch.from);
        let memory = place.map(|(e, slot)| self.memory(self.of_point(e, history), slot));
        let ends = &self.points[place.map_or(e, |(e, _)| e)].nodes;
        FacetPair {
            facing: touch.facing,
            goes_on: touch.goes_on,
            memory,
            inset: memory.map_or(touch.inset, |memory| memory.inset(&self.law)),
            kept: &self.facets[memory.map_or(touch.facet, PairMemory::facet)],
            kept_line: [ends[0], ends[1]],
            ..self.new_pair(e, touch.facet, touch.share)
        }
    }

    /// A point and the facet that it remembers in this slot.
    pub(super) fn pair_of<'a>(&'a self, e: usize, slot: usize, history: &'a [f64]) -> FacetPair<'a> {
        let memory = self.memory(history, slot);
        let inset = memory.inset(&self.law);
        FacetPair { memory: Some(memory), inset, ..self.new_pair(e, memory.facet(), None) }
    }

    /// A point (of a line, at this share) and a facet, without memory.
    fn new_pair(&self, e: usize, facet: usize, share: Option<f64>) -> FacetPair<'_> {
        let (point, ends, facet) = (self.point_at(e, share), &self.points[e].nodes, &self.facets[facet]);
        FacetPair {
            law: &self.law,
            point,
            facet,
            facing: Facing::Normal,
            memory: None,
            inset: 0.0,
            kept: facet,
            kept_line: [ends[0], ends[1]],
            goes_on: false,
            sticks: false,
        }
    }

    /// Calls `act` with each touching pair; `history` is that of the block.
    pub(super) fn each_touch<'a>(
        &'a self,
        nodes: &[Node],
        history: &'a [f64],
        mut act: impl FnMut(usize, &FacetTouch, FacetPair<'a>),
    ) {
        if history.is_empty() {
            return;
        }
        let mut nearby = self.nearby(nodes);
        let mut found = std::mem::take(&mut nearby.touches);
        for e in 0..self.points.len() {
            let near = nearby.of(e);
            if near.is_empty() || nearby.is_clear(e, self.law.touching) {
                continue;
            }
            let own = self.of_point(e, history);
            touch::find(self, near, TouchQuery { e, limit: self.law.touching, stays: true }, nodes, own, &mut found);
            touch::take_over(self, e, nodes, history, &mut found);
            for touch in &found {
                act(e, touch, self.pair(e, touch, history));
            }
        }
        nearby.touches = found;
    }
}

impl NearestCorner for FacetContacts {
    fn margin(&self) -> f64 {
        self.scene.margin
    }

    fn least_gap_toward(&self, direction: &Vec3, cosine: f64, nodes: &[Node]) -> f64 {
        let mut nearby = self.nearby(nodes);
        let (mut found, mut least) = (std::mem::take(&mut nearby.touches), f64::INFINITY);
        for e in 0..self.points.len() {
            let query = TouchQuery { e, limit: self.scene.margin, stays: false };
            touch::find_within(self, nearby.of(e), query, nodes, &mut found);
            let along = found.iter().filter(|touch| touch.toward.dot(direction) > cosine);
            least = along.map(|touch| touch.gap).fold(least, f64::min);
        }
        nearby.touches = found;
        least
    }
}
