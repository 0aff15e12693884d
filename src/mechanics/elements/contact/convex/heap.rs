//! A heap of convex solids in mutual contact: neighbours and their pair histories.

use super::pair::{CarriedConvex, ConvexBody, ConvexPair, law_of_faces, width};
use crate::elements::contact::grid::GridBox;
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::near_lists::NearLists;
use crate::state::Node;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Number of pairs that a solid remembers with others at least as large: the 26 around a cube in a lattice, and some overhang.
pub(super) const SLOTS: usize = 32;

/// Convex solids, each able to touch every other.
pub struct ConvexHeap {
    /// The law for a whole face; `near` is infinite, because the lists exclude distant pairs.
    pub(super) law: ContactLaw,
    /// All of them.
    pub(super) solids: Vec<ConvexBody>,
    /// The solids in their role as the touched ones.
    others: Vec<CarriedConvex>,
    /// The pairs that do not touch, in ascending order.
    joined: Vec<[usize; 2]>,
    /// The nodes of the solids.
    pub(super) involved: Vec<usize>,
    /// No pair farther apart than this is remembered; lists hold while nothing has moved by more.
    pub(super) margin: f64,
    /// The size of the cells for the search of neighbours.
    cell: f64,
    /// Number of history variables of a pair, whose key is the number of the other plus one, 0 for none.
    pub(super) width: usize,
    nearby: Mutex<NearLists>,
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
        let involved = solids.iter().map(|one| one.node).collect();
        let (margin, cell, width) = (0.1 * usual, 3.0 * usual, width(&law));
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

    /// The other solids in a solid's history with the memory of each pair. They fill the first slots, and the rest is zero.
    pub(super) fn slots<'a>(&self, history: &'a [f64]) -> impl Iterator<Item = (usize, PairMemory<'a>)> + use<'a> {
        let taken = history.chunks_exact(self.width).map(PairMemory).take_while(|memory| memory.key() > 0.0);
        taken.map(|memory| (memory.key() as usize - 1, memory))
    }

    /// The memory of a pair; empty if it has no slot.
    pub(super) fn memory<'a>(&self, history: &'a [f64], e: usize, other: usize) -> PairMemory<'a> {
        let slot = self.slots(self.of_solid(e, history)).find(|slot| slot.0 == other);
        slot.map_or(PairMemory::NOTHING, |(_, memory)| memory)
    }

    /// For each solid the larger ones near it, at these positions of the nodes. Threads lock the lists in turn; the result does not depend
    /// on their order.
    pub(super) fn nearby(&self, nodes: &[Node]) -> MutexGuard<'_, NearLists> {
        let mut nearby = self.nearby.lock().unwrap_or_else(PoisonError::into_inner);
        // Queries reach up to twice the margin from touching; both solids may have moved by the margin.
        if nearby.are_outdated(&self.involved, nodes, 2.0 * self.margin) {
            let extent = |one: &ConvexBody, more: f64| {
                GridBox::around([nodes[one.node].x].into_iter()).wider(one.shape.reach() + more)
            };
            let touched = self.solids.iter().map(|one| extent(one, 4.0 * self.margin));
            let touching = self.solids.iter().map(|one| extent(one, 0.0));
            nearby.rebuild(self.cell, touched, touching, |e, other| self.is_of(e, other));
        }
        nearby
    }

    /// A lower bound of the distance of two.
    fn apart(&self, e: usize, other: usize, nodes: &[Node]) -> f64 {
        let (one, other) = (&self.solids[e], &self.solids[other]);
        let d = nodes[one.node].relative_position(&nodes[other.node]);
        d.norm() - one.shape.reach() - other.shape.reach()
    }

    /// Gap limit for remembering a pair, by its smaller solid: at most a tenth of its reach, which few others are within.
    pub(super) fn memorable(&self, e: usize) -> f64 {
        self.margin.min(0.1 * self.solids[e].shape.reach())
    }

    /// Calls `act` with each pair whose bounding balls are nearer than `limit`, at most twice the margin.
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

    /// True if `is` holds for a pair of solid `e` that may meet in a step with no motion beyond `way` relative to the mean.
    pub(super) fn on_the_way(
        &self,
        e: usize,
        way: f64,
        nearby: &mut NearLists,
        mut is: impl FnMut(usize) -> bool,
    ) -> bool {
        if 2.0 * way <= self.margin {
            return nearby.of(e).iter().any(|&other| is(other as usize));
        }
        // The grid knows the places when it was made.
        let extent = GridBox::around([nearby.places[e]].into_iter());
        let extent = extent.wider(self.solids[e].shape.reach() + self.margin + 2.0 * way);
        nearby.around(&extent, |other| self.is_of(e, other)).iter().any(|&other| is(other as usize))
    }

    /// True where `e` is the smaller solid of a pair in possible contact; the smaller one holds the memory.
    fn is_of(&self, e: usize, other: u32) -> bool {
        let other = other as usize;
        let reach = |k: usize| self.solids[k].shape.reach();
        let is_smaller = reach(e) < reach(other) || reach(e) == reach(other) && e < other;
        is_smaller && self.joined.binary_search(&[e.min(other), e.max(other)]).is_err()
    }
}
