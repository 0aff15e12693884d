//! The facets near each point, and how far each point is from all of them.

use super::facet::Facet;
use super::found::{FacetTouch, TouchQuery};
use super::scene::FacetScene;
use super::span::FacetSpan;
use super::touch;
use crate::elements::contact::grid::GridBox;
use crate::elements::contact::near_lists::NearLists;
use crate::state::Node;

/// The facets near each point.
#[derive(Default)]
pub(super) struct NearbyFacets {
    near: NearLists,
    /// For each point a lower bound of its gap when the lists were made, from the facets that it can come to touch.
    gaps: Vec<f64>,
    /// Working memory for the touches of one point at a time.
    pub touches: Vec<FacetTouch>,
    /// Room for facets in the order of a coordinate.
    pub spans: Vec<FacetSpan>,
}

impl NearbyFacets {
    /// Makes the lists anew where something has moved too far.
    pub fn update(&mut self, of: &FacetScene, nodes: &[Node]) {
        if self.near.are_outdated(&of.involved, nodes, of.margin) {
            self.rebuild(of, nodes);
        }
    }

    /// True where the gap of a point surely exceeds `limit` for every facet it may touch.
    pub fn is_clear(&self, point: usize, limit: f64) -> bool {
        self.gaps[point] - self.near.closed > limit
    }

    /// The facets near a point.
    pub fn of(&self, point: usize) -> &[u32] {
        self.near.of(point)
    }

    fn rebuild(&mut self, of: &FacetScene, nodes: &[Node]) {
        // Queries reach up to the margin from touching; the slack is another margin.
        let apart = 2.0 * of.margin;
        let facets = of.facets.iter().map(|facet| extent(facet, nodes, apart));
        let points = (0..of.points.len()).map(|e| of.extent(e, |node| nodes[node].x).wider(of.points[e].radius));
        self.near.rebuild(of.cell, facets, points, |e, facet| of.may_touch(e, facet));
        self.gaps.clear();
        let mut found = std::mem::take(&mut self.touches);
        for e in 0..of.points.len() {
            touch::find_within(of, self.of(e), TouchQuery { e, limit: f64::INFINITY, stays: false }, nodes, &mut found);
            let can_touch = found.iter().filter(|touch| !of.is_near_along(e, touch.facet as u32));
            // Beyond the lists everything is farther than this.
            self.gaps.push(can_touch.map(|touch| touch.gap).fold(apart, f64::min));
        }
        self.touches = found;
    }

    /// The facets that a point may meet in a step with no motion beyond `way` relative to the mean.
    pub fn on_the_way(&mut self, of: &FacetScene, e: usize, way: f64) -> &[u32] {
        if 2.0 * way <= of.margin {
            return self.of(e);
        }
        // The grid knows the places when it was made.
        let extent = of.extent(e, |node| self.near.places[of.place_of(node)]);
        let extent = extent.wider(of.points[e].radius + of.margin + 2.0 * way);
        self.near.around(&extent, |facet| of.may_touch(e, facet))
    }
}

fn extent(facet: &Facet, nodes: &[Node], apart: f64) -> GridBox {
    GridBox::around(facet.nodes().iter().map(|&node| nodes[node].x)).wider(facet.half + apart)
}
