//! The facets near each point. The lists hold while nothing has moved by more than their slack, which is looked at each time; what
//! they leave out is farther than anything that is asked for, so results do not depend on when they were made.

use super::facet::Facet;
use super::found::{FacetTouch, TouchQuery};
use super::scene::FacetScene;
use super::span::FacetSpan;
use super::touch;
use crate::elements::contact::grid::{BoxGrid, GridBox};
use crate::state::Node;
use base::math::Vec3;

/// The facets near each point.
#[derive(Default)]
pub(super) struct NearbyFacets {
    /// Places of all nodes that take part when the lists were made; empty before.
    places: Vec<Vec3>,
    /// The start of the list of each point, and the end of the last.
    starts: Vec<usize>,
    lists: Vec<u32>,
    /// For each point a lower bound of its gap when the lists were made, from the facets that it can come to touch.
    gaps: Vec<f64>,
    /// By how much gaps may have become smaller since.
    closed: f64,
    grid: BoxGrid,
    /// What touches a point: room for one after the other.
    pub touches: Vec<FacetTouch>,
    /// Room for facets in the order of a coordinate.
    pub spans: Vec<FacetSpan>,
    /// Facets on the way of a point: room likewise.
    wide: Vec<u32>,
}

impl NearbyFacets {
    /// Makes the lists anew where something has moved too far.
    pub fn update(&mut self, of: &FacetScene, nodes: &[Node]) {
        if !self.places.is_empty() {
            self.closed = 2.0 * farthest(of, nodes, |k, _| self.places[k]);
        }
        if self.places.is_empty() || self.closed > of.margin {
            self.rebuild(of, nodes);
        }
    }

    /// True where a point is surely farther than this from all that it can come to touch.
    pub fn is_clear(&self, point: usize, limit: f64) -> bool {
        self.gaps[point] - self.closed > limit
    }

    /// The facets near a point.
    pub fn of(&self, point: usize) -> &[u32] {
        &self.lists[self.starts[point]..self.starts[point + 1]]
    }

    fn rebuild(&mut self, of: &FacetScene, nodes: &[Node]) {
        self.places.clear();
        self.places.extend(of.involved.iter().map(|&node| nodes[node].x));
        // What is asked for lies within the margin of touching; the slack is as much again.
        let apart = 2.0 * of.margin;
        let extents = of.facets.iter().map(|facet| extent(facet, nodes, apart));
        self.grid.rebuild(of.cell, extents);
        self.lists.clear();
        self.starts.clear();
        self.starts.push(0);
        for e in 0..of.points.len() {
            let from = self.lists.len();
            let extent = of.extent(e, |node| nodes[node].x);
            self.grid.query(&extent.wider(of.points[e].radius), &mut self.lists);
            let mut kept = from;
            for k in from..self.lists.len() {
                if of.may_touch(e, self.lists[k]) {
                    self.lists[kept] = self.lists[k];
                    kept += 1;
                }
            }
            self.lists.truncate(kept);
            self.starts.push(kept);
        }
        self.closed = 0.0;
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

    /// The facets that a point may meet in a step in which nothing moves farther than `way` against the mean.
    pub fn on_the_way(&mut self, of: &FacetScene, e: usize, way: f64) -> &[u32] {
        if 2.0 * way <= of.margin {
            return self.of(e);
        }
        // The grid knows the places when it was made.
        let extent = of.extent(e, |node| self.places[of.place_of(node)]);
        self.wide.clear();
        self.grid.query(&extent.wider(of.points[e].radius + of.margin + 2.0 * way), &mut self.wide);
        self.wide.retain(|&facet| of.may_touch(e, facet));
        &self.wide
    }
}

fn extent(facet: &Facet, nodes: &[Node], apart: f64) -> GridBox {
    GridBox::around(facet.nodes().iter().map(|&node| nodes[node].x)).wider(facet.half + apart)
}

/// The farthest way of a node from `from` to its place among `nodes`, apart from the mean of all ways.
pub(super) fn farthest(of: &FacetScene, nodes: &[Node], from: impl Fn(usize, usize) -> Vec3) -> f64 {
    let ways = || of.involved.iter().enumerate().map(|(k, &node)| nodes[node].x - from(k, node));
    let mean: Vec3 = ways().sum::<Vec3>() / of.involved.len() as f64;
    let square = ways()
        .map(|way| (way - mean).norm_squared())
        .fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most });
    square.sqrt()
}
