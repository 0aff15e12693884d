//! Points against a surface of facets, with the lists of what is near.

use super::facet::Facet;
use super::facing::Facing;
use super::found::{FacetTouch, TouchQuery};
use super::memory::PairMemory;
use super::nearby::NearbyFacets;
use super::pair::FacetPair;
use super::scene::{FacetScene, FacetTouchers};
use super::touch;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::nearest_corner::NearestCorner;
use crate::elements::contact::point::ContactPoint;
use crate::state::{Configuration, Node};
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

    /// The facets near the points, where the nodes lie thus. Threads take turns: what is found does not depend on them.
    pub(super) fn nearby(&self, nodes: &[Node]) -> MutexGuard<'_, NearbyFacets> {
        let mut nearby = self.nearby.lock().unwrap_or_else(PoisonError::into_inner);
        nearby.update(self, nodes);
        nearby
    }

    /// A point and a facet with what they remember, `history` being that of the block.
    pub(super) fn pair<'a>(&'a self, e: usize, touch: &FacetTouch, history: &'a [f64]) -> FacetPair<'a> {
        let place = touch.slot.map(|slot| (e, slot)).or(touch.from);
        let memory = place.map(|(e, slot)| self.memory(self.of_point(e, history), slot));
        let ends = &self.points[place.map_or(e, |(e, _)| e)].nodes;
        let facet = &self.facets[touch.facet];
        let kept = memory.map_or(facet, |memory| &self.facets[memory.facet()]);
        let inset = memory.map_or(touch.inset, PairMemory::inset);
        let (point, facing) = (self.point_at(e, touch.share), touch.facing);
        FacetPair {
            law: &self.law,
            point,
            facet,
            facing,
            memory,
            inset,
            kept,
            kept_line: [ends[0], ends[1]],
            sticks: false,
        }
    }

    /// A point and the facet that it remembers in this slot.
    pub(super) fn pair_of<'a>(&'a self, e: usize, slot: usize, history: &'a [f64]) -> FacetPair<'a> {
        let memory = self.memory(history, slot);
        let facet = &self.facets[memory.facet()];
        let point = self.point_at(e, None);
        let (memory, inset, kept_line) = (Some(memory), memory.inset(), [point.nodes[0], point.nodes[1]]);
        FacetPair {
            law: &self.law,
            point,
            facet,
            facing: Facing::Normal,
            memory,
            inset,
            kept: facet,
            kept_line,
            sticks: false,
        }
    }

    /// True where two lines touch that are parallel within some degrees, and not end to end.
    pub(super) fn is_side_by_side(&self, now: &Configuration) -> bool {
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

    /// Calls with each pair that touches, `history` being that of the block.
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
