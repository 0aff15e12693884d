//! Convex solids among themselves: who is near whom, and what they remember of each other.

use super::pair::{CarriedConvex, ConvexBody, ConvexPair, law_of_faces, width};
use crate::elements::contact::grid::{BoxGrid, GridBox};
use crate::elements::contact::history::PointHistory;
use crate::elements::contact::law::ContactLaw;
use crate::state::Node;
use base::math::Vec3;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Solids at least as large that one remembers at once: the 26 that surround a cube in a lattice, and what hangs over.
pub(super) const SLOTS: usize = 32;

/// Convex solids of which each may touch each.
pub struct ConvexHeap {
    /// The law, for the whole of a face; what is far is known to be far by the lists.
    pub(super) law: ContactLaw,
    /// All of them.
    pub(super) solids: Vec<ConvexBody>,
    /// The same, as what is touched.
    others: Vec<CarriedConvex>,
    /// The pairs that do not touch, in ascending order.
    joined: Vec<[usize; 2]>,
    /// Their nodes.
    pub(super) involved: Vec<usize>,
    /// No pair farther apart than this is remembered; lists hold while nothing has moved by more.
    pub(super) margin: f64,
    /// The size of the cells in which neighbours are looked for.
    cell: f64,
    /// Number of history variables of a pair: the number of the other plus one, 0 for none, then those of the pair.
    pub(super) width: usize,
    nearby: Mutex<NearbySolids>,
}

/// Those near each, of which it is the smaller.
#[derive(Default)]
pub(super) struct NearbySolids {
    /// Places of all when the lists were made; empty before.
    places: Vec<Vec3>,
    /// The start of the list of each, and the end of the last.
    starts: Vec<usize>,
    lists: Vec<u32>,
    grid: BoxGrid,
    /// Those on the way of one: room for them.
    wide: Vec<u32>,
}

impl ConvexHeap {
    /// The stiffness and damping of `law` are those of a corner; `joined` are pairs that do not touch, in ascending order.
    pub fn new(law: ContactLaw, solids: Vec<ConvexBody>, joined: Vec<[usize; 2]>) -> Self {
        let law = ContactLaw { near: f64::INFINITY, ..law_of_faces(law) };
        let others = solids.iter().map(CarriedConvex::of_body).collect();
        // The usual size: a floor among many stones does not count.
        let mut sizes: Vec<f64> = solids.iter().map(|one| one.shape.reach()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(1.0);
        let mut involved: Vec<usize> = solids.iter().map(|one| one.node).collect();
        involved.sort_unstable();
        let (margin, cell, width) = (0.1 * usual, 3.0 * usual, 1 + width(&law));
        ConvexHeap { law, solids, others, joined, involved, margin, cell, width, nearby: Mutex::default() }
    }

    /// One of the pairs.
    pub(super) fn pair(&self, e: usize, other: usize) -> ConvexPair<'_> {
        ConvexPair { law: &self.law, one: &self.solids[e], other: &self.others[other] }
    }

    /// The history of one, of that of the block.
    pub(super) fn of_solid<'a>(&self, e: usize, history: &'a [f64]) -> &'a [f64] {
        let width = SLOTS * self.width;
        &history[e * width..(e + 1) * width]
    }

    /// Who stands in a slot of the history of one, and what is remembered of it.
    pub(super) fn slot<'a>(&self, history: &'a [f64], slot: usize) -> (Option<usize>, PointHistory<'a>) {
        let numbers = &history[slot * self.width..(slot + 1) * self.width];
        let other = (numbers[0] > 0.0).then(|| numbers[0] as usize - 1);
        (other, PointHistory::new(&numbers[1..]))
    }

    /// The slot of a pair in the history of one.
    pub(super) fn slot_of(&self, history: &[f64], other: usize) -> Option<usize> {
        (0..SLOTS).find(|&slot| self.slot(history, slot).0 == Some(other))
    }

    /// The history of a pair that has none.
    pub(super) fn nothing() -> PointHistory<'static> {
        /// As many numbers as any pair has.
        static NOTHING: [f64; super::memory::WIDTH] = [0.0; super::memory::WIDTH];
        PointHistory::new(&NOTHING)
    }

    /// What a pair remembers; nothing where it has no slot.
    pub(super) fn memory<'a>(&self, history: &'a [f64], e: usize, other: usize) -> PointHistory<'a> {
        let own = self.of_solid(e, history);
        match self.slot_of(own, other) {
            Some(slot) => self.slot(own, slot).1,
            None => ConvexHeap::nothing(),
        }
    }

    /// The histories of all pairs that are remembered.
    pub(super) fn memories<'a>(&self, history: &'a [f64]) -> impl Iterator<Item = PointHistory<'a>> {
        let taken = history.chunks_exact(self.width).filter(|numbers| numbers[0] > 0.0);
        taken.map(|numbers| PointHistory::new(&numbers[1..]))
    }

    /// Those near each, where the nodes lie thus. Threads take turns: what is found does not depend on them.
    pub(super) fn nearby(&self, nodes: &[Node]) -> MutexGuard<'_, NearbySolids> {
        let mut nearby = self.nearby.lock().unwrap_or_else(PoisonError::into_inner);
        let moved = |place: &Vec3, one: &ConvexBody| (nodes[one.node].x - place).norm();
        // What is not a number is far.
        let holds = nearby.places.iter().zip(&self.solids).all(|(place, one)| moved(place, one) <= self.margin);
        if nearby.places.is_empty() || !holds {
            nearby.rebuild(self, nodes);
        }
        nearby
    }

    /// A lower bound of the distance of two.
    fn apart(&self, e: usize, other: usize, nodes: &[Node]) -> f64 {
        let (one, other) = (&self.solids[e], &self.solids[other]);
        let d = nodes[one.node].relative_position(&nodes[other.node]);
        d.norm() - one.shape.reach() - other.shape.reach()
    }

    /// The gap below which a pair is remembered, of which this is the smaller: however large the others, few are so near.
    pub(super) fn memorable(&self, e: usize) -> f64 {
        self.margin.min(0.1 * self.solids[e].shape.reach())
    }

    /// Calls with each pair whose balls are nearer than a limit, which is no larger than twice the margin.
    pub(super) fn each_near(&self, nodes: &[Node], limit: f64, mut act: impl FnMut(usize, usize)) {
        let nearby = self.nearby(nodes);
        for e in 0..self.solids.len() {
            for &other in nearby.of(e) {
                if self.apart(e, other as usize, nodes) <= limit {
                    act(e, other as usize);
                }
            }
        }
    }

    /// True for any of the pairs of one that may meet in a step in which nothing moves farther than `way`.
    pub(super) fn on_the_way(
        &self,
        e: usize,
        way: f64,
        nearby: &mut NearbySolids,
        mut is: impl FnMut(usize) -> bool,
    ) -> bool {
        if 2.0 * way <= self.margin {
            return nearby.of(e).iter().any(|&other| is(other as usize));
        }
        // The grid knows the places when it was made.
        let extent = GridBox { low: nearby.places[e], high: nearby.places[e] };
        nearby.wide.clear();
        nearby.grid.query(&extent.wider(self.solids[e].shape.reach() + self.margin + 2.0 * way), &mut nearby.wide);
        nearby.wide.iter().any(|&other| self.is_of(e, other) && is(other as usize))
    }

    /// True for the smaller of a pair that may touch, which remembers it.
    fn is_of(&self, e: usize, other: u32) -> bool {
        let other = other as usize;
        let reach = |k: usize| self.solids[k].shape.reach();
        let is_smaller = reach(e) < reach(other) || reach(e) == reach(other) && e < other;
        is_smaller && self.joined.binary_search(&[e.min(other), e.max(other)]).is_err()
    }
}

impl NearbySolids {
    /// Those near one, of which it is the smaller, in ascending order.
    pub fn of(&self, e: usize) -> &[u32] {
        &self.lists[self.starts[e]..self.starts[e + 1]]
    }

    fn rebuild(&mut self, of: &ConvexHeap, nodes: &[Node]) {
        self.places.clear();
        self.places.extend(of.solids.iter().map(|one| nodes[one.node].x));
        // What is asked for lies within twice the margin of touching; both may have moved by the margin.
        let apart = 4.0 * of.margin;
        let extents = of
            .solids
            .iter()
            .zip(&self.places)
            .map(|(one, place)| GridBox { low: *place, high: *place }.wider(one.shape.reach() + apart));
        self.grid.rebuild(of.cell, extents);
        self.lists.clear();
        self.starts.clear();
        self.starts.push(0);
        for (e, place) in self.places.iter().enumerate() {
            let from = self.lists.len();
            let extent = GridBox { low: *place, high: *place };
            self.grid.query(&extent.wider(of.solids[e].shape.reach()), &mut self.lists);
            let mut kept = from;
            for k in from..self.lists.len() {
                if of.is_of(e, self.lists[k]) {
                    self.lists[kept] = self.lists[k];
                    kept += 1;
                }
            }
            self.lists.truncate(kept);
            self.starts.push(kept);
        }
    }
}
