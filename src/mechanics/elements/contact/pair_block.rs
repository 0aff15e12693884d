//! The interface of a block of pairs, for any method of search: forces, energy, gaps and results follow from the action in each pair.

use super::history::PairMemory;
use super::law::ContactLaw;
use crate::elements::block::{ElementBlock, Force, subtract};
use crate::elements::wandering::Wandering;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// The nodes of one of two that touch, with the share of each in its motion.
#[derive(Clone, Copy)]
pub struct PairSide<'a> {
    pub(super) nodes: &'a [usize],
    pub(super) shares: &'a [f64],
}

impl<'a> PairSide<'a> {
    /// A side carried by one node.
    pub(super) fn of_node(node: &'a usize) -> Self {
        PairSide { nodes: std::slice::from_ref(node), shares: &[1.0] }
    }

    fn parts(self) -> impl Iterator<Item = (usize, f64)> {
        self.nodes.iter().copied().zip(self.shares.iter().copied())
    }
}

/// The forces of a pair in contact; global components.
pub struct PairAction<'a> {
    /// The touching and the touched side.
    pub(super) sides: [PairSide<'a>; 2],
    /// Force on the touching side; the force on the other is opposite.
    pub(super) F: Vec3,
    /// Moments on the two.
    pub(super) M: [Vec3; 2],
    /// Point of action of the force on the touched side and its moment, from [`PairBlock::carrier`] or else from the origin.
    pub(super) arm: Vec3,
    /// A force to subtract: signed shares of the nodes of both sides, the force, and its arm.
    pub(super) less: Option<([PairSide<'a>; 2], Vec3, Vec3)>,
    /// Energy of the springs.
    pub(super) stored: f64,
    /// True where friction is at its limit.
    pub(super) slips: bool,
}

impl PairAction<'_> {
    /// A node of the touched side and one of the touching side.
    pub fn nodes(&self) -> [usize; 2] {
        [self.sides[1].nodes[0], self.sides[0].nodes[0]]
    }

    /// True where friction is at its limit.
    pub fn slips(&self) -> bool {
        self.slips
    }

    /// Force on the touched side and its moment about [`PairBlock::carrier`], or else about the origin.
    pub fn on_touched(&self) -> [Vec3; 2] {
        let [f, m] = [-self.F, self.M[1] - self.arm.cross(&self.F)];
        self.less.as_ref().map_or([f, m], |(_, less, arm)| [f + less, m + arm.cross(less)])
    }

    /// Calls with the force and the moment on each node.
    pub(super) fn spread(&self, mut add: impl FnMut(usize, Vec3, Vec3)) {
        let [one, other] = self.sides;
        one.parts().for_each(|(node, share)| add(node, share * self.F, share * self.M[0]));
        other.parts().for_each(|(node, share)| add(node, -share * self.F, share * self.M[1]));
        if let Some((sides, F, _)) = &self.less {
            let parts = sides.iter().flat_map(|side| side.parts());
            parts.for_each(|(node, share)| add(node, -share * F, Vec3::zeros()));
        }
    }
}

/// A block of pairs that may touch.
pub trait PairBlock: ElementBlock {
    /// The law between the two of a pair.
    fn law(&self) -> &ContactLaw;

    /// Calls `act` with the action in each touching pair.
    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction));

    /// True where `is` holds for the memory of a pair near at the end of the last step; `history` belongs to the block.
    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PairMemory) -> bool) -> bool;

    /// True where a step from `start` to `now` must be shorter: a body passes through another, or an impact is not resolved (see
    /// [`ContactLaw::resolution`]).
    fn misses(&self, start: &[Node], now: &Configuration) -> bool;

    /// The node carrying the touched surface; `None` if facets or bodies of the same kind are touched.
    fn carrier(&self) -> Option<usize> {
        None
    }

    /// The pairs for the matrix, where they change; `None` where each element is one fixed pair.
    fn wandering(&self) -> Option<&dyn Wandering> {
        None
    }

    /// Least gap of all pairs at these positions; infinite if it is computed without the block.
    fn least_gap(&self, _nodes: &[Node]) -> f64 {
        f64::INFINITY
    }

    /// True where load steps end without depth, by multipliers.
    fn has_multipliers(&self) -> bool {
        false
    }

    /// Writes the multipliers from the equilibrium `now` into `new`, a copy of the block's history at the start of a step; `start` are the
    /// nodes there. Returns the largest error of a depth or displacement over the tolerance.
    fn augment(&self, _start: &[Node], _now: &Configuration, _new: &mut [f64]) -> f64 {
        0.0
    }

    /// True where two lines touch side by side: parallel within six degrees, and not end to end.
    fn is_side_by_side(&self, _now: &Configuration) -> bool {
        false
    }

    /// True where a body touches more others at least as large than it remembers. The forgotten ones press without friction, with
    /// restitution by the current speed.
    fn is_crowded(&self, _now: &Configuration) -> bool {
        false
    }

    /// True where friction may make tangents unsymmetric.
    fn rubs(&self) -> bool {
        self.law().friction > 0.0
    }

    /// Least gap at the end of the last step, by the history of the block; infinite where nothing is near.
    fn last_gap(&self, history: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        self.any_memory(history, &mut |old| {
            least = least.min(old.gap());
            false
        });
        least
    }

    /// True where a multiplier pushes at the end of the last step; the gap may then be positive by the remaining error.
    fn pushes(&self, history: &[f64]) -> bool {
        self.has_multipliers() && self.any_memory(history, &mut |old| old.lift(self.law()) > 0.0)
    }

    /// Longest time from the last state to the next instant of equilibrium, by the history of the block.
    fn longest_step(&self, history: &[f64]) -> f64 {
        let law = self.law();
        let mut in_impact = |old: PairMemory| old.impact_speed() > 3.0 * law.floor && old.age() < law.duration;
        let any = law.resolution < f64::INFINITY && self.any_memory(history, &mut in_impact);
        if any { law.resolution } else { f64::INFINITY }
    }
}

/// Subtracts the internal forces of all pairs from `F`, which is indexed by node.
pub(super) fn subtract_forces(block: &impl PairBlock, now: &Configuration, F: &mut [Force]) {
    block.each_action(now, &mut |action| subtract_action(action, F));
}

/// Subtracts the internal forces of a pair.
pub(super) fn subtract_action(action: &PairAction, F: &mut [Force]) {
    // Internal forces are opposite to the acting forces.
    action.spread(|node, f, m| {
        subtract(&mut F[node], 0, &-f);
        subtract(&mut F[node], 3, &-m);
    });
}

/// The energy of the springs of all pairs.
pub(super) fn energy(block: &impl PairBlock, now: &Configuration) -> f64 {
    let mut stored = 0.0;
    block.each_action(now, &mut |action| stored += action.stored);
    stored
}
