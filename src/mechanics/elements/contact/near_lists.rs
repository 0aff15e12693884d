//! Lists of the neighbours of each touching body. They hold while no node has moved by more than their slack, tested at each use. Omitted
//! bodies are beyond any query, so results do not depend on the time of listing.

use super::grid::{BoxGrid, GridBox};
use crate::state::Node;
use base::math::Vec3;

/// The neighbours of each touching body, by number.
#[derive(Default)]
pub(super) struct NearLists {
    /// Places of all nodes that take part when the lists were made; empty before.
    pub places: Vec<Vec3>,
    /// By how much gaps may have become smaller since.
    pub closed: f64,
    /// The start of the list of each, and the end of the last.
    starts: Vec<usize>,
    lists: Vec<u32>,
    grid: BoxGrid,
    /// Working memory for the boxes on the way of one body.
    wide: Vec<u32>,
}

impl NearLists {
    /// True where the lists have to be made anew, for gaps may have become smaller by more than their `slack`: then from these places.
    pub fn are_outdated(&mut self, involved: &[usize], nodes: &[Node], slack: f64) -> bool {
        if !self.places.is_empty() {
            self.closed = 2.0 * farthest(involved, nodes, |k, _| self.places[k]);
            if self.closed <= slack || self.closed.is_nan() {
                return false;
            }
        }
        self.places.clear();
        self.places.extend(involved.iter().map(|&node| nodes[node].x));
        self.closed = 0.0;
        true
    }

    /// Lists for each `touching` box the `touched` boxes that meet it and pass `may_touch`.
    pub fn rebuild(
        &mut self,
        cell: f64,
        touched: impl Iterator<Item = GridBox>,
        touching: impl Iterator<Item = GridBox>,
        may_touch: impl Fn(usize, u32) -> bool,
    ) {
        self.grid.rebuild(cell, touched);
        self.lists.clear();
        self.starts.clear();
        self.starts.push(0);
        for (e, extent) in touching.enumerate() {
            let from = self.lists.len();
            self.grid.query(&extent, &mut self.lists);
            let mut kept = from;
            for k in from..self.lists.len() {
                if may_touch(e, self.lists[k]) {
                    self.lists[kept] = self.lists[k];
                    kept += 1;
                }
            }
            self.lists.truncate(kept);
            self.starts.push(kept);
        }
    }

    /// The neighbours of one body, in ascending order.
    pub fn of(&self, e: usize) -> &[u32] {
        &self.lists[self.starts[e]..self.starts[e + 1]]
    }

    /// The numbers that met a box at the time of listing and pass `may_touch`.
    pub fn around(&mut self, extent: &GridBox, may_touch: impl Fn(u32) -> bool) -> &[u32] {
        self.wide.clear();
        self.grid.query(extent, &mut self.wide);
        self.wide.retain(|&other| may_touch(other));
        &self.wide
    }
}

/// The farthest way of a node from `from` to its place among `nodes`, apart from the mean of all ways.
pub(super) fn farthest(involved: &[usize], nodes: &[Node], from: impl Fn(usize, usize) -> Vec3) -> f64 {
    let ways = || involved.iter().enumerate().map(|(k, &node)| nodes[node].x - from(k, node));
    let mean: Vec3 = ways().sum::<Vec3>() / involved.len() as f64;
    let square = ways()
        .map(|way| (way - mean).norm_squared())
        .fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most });
    square.sqrt()
}
