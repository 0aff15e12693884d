//! Convex solids among themselves as a block of elements, one for each, and as pairs for the matrix.

use super::heap::{ConvexHeap, SLOTS};
use super::pair::{ConvexPair, PairForce, PairKinematics};
use super::steps::is_missed;
use super::tangent::tangent;
use super::update::update_near;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::contact::history::{PairMemory, PairMemoryMut};
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::near_lists::farthest;
use crate::elements::contact::normal_motion::lost;
use crate::elements::contact::pair_block::{PairAction, PairBlock, energy, subtract_action, subtract_forces};
use crate::elements::wandering::{Partners, Wandering};
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};

/// A touching pair with the numbers of its solids and its memory.
pub(super) struct HeapTouch<'a> {
    pub pair: ConvexPair<'a>,
    pub at: PairKinematics<'a>,
    pub acting: PairForce,
    old: PairMemory<'a>,
    numbers: [usize; 2],
}

impl ConvexHeap {
    /// Calls with each pair that touches.
    pub(super) fn each_touch<'a>(&'a self, now: &Configuration<'a>, mut act: impl FnMut(HeapTouch<'a>)) {
        if now.history.is_empty() {
            return;
        }
        self.each_near(now.nodes, self.law.touching, |e, other| {
            let (pair, old) = (self.pair(e, other), self.memory(now.history, e, other));
            if let Some((at, acting)) = pair.touch(old, now) {
                act(HeapTouch { pair, at, acting, old, numbers: [e, other] });
            }
        });
    }

    /// Writes the history of all pairs, and calls with each pair that touches.
    fn advance_pairs(
        &self,
        now: &Configuration,
        part: f64,
        history: &mut [f64],
        mut press: impl FnMut(&ConvexPair, &PairKinematics, &PairForce),
    ) -> Dissipation {
        let mut spent = Dissipation::default();
        let width = SLOTS * self.width;
        for own in history.chunks_exact_mut(width) {
            let taken = self.slots(own).count();
            own[..taken * self.width].fill(0.0);
        }
        let mut kept: usize = 0;
        let mut last = usize::MAX;
        self.each_near(now.nodes, self.margin, |e, other| {
            let pair = self.pair(e, other);
            let at = pair.kinematics(now.nodes);
            let memorable = self.memorable(e);
            let least = at.pose.least_axis_within(memorable);
            if least.gap > memorable {
                return;
            }
            let old = self.memory(now.history, e, other);
            let acting = pair.force_along(&least, &at, old);
            if let Some(acting) = &acting {
                press(&pair, &at, acting);
            }
            if e != last {
                (kept, last) = (0, e);
            }
            let own = &mut history[e * width..(e + 1) * width];
            // With all slots taken, a touching pair replaces one that does not touch.
            let free = || self.slots(own).position(|(_, memory)| memory.gap() > 0.0).filter(|_| least.gap <= 0.0);
            let Some(slot) = Some(kept).filter(|&kept| kept < SLOTS).or_else(free) else { return };
            let new = &mut own[slot * self.width..(slot + 1) * self.width];
            new.fill(0.0);
            spent += update_near((&self.law, &at, &least), acting.as_ref(), old, now, part, new);
            PairMemoryMut(new).set_key((other + 1) as f64);
            kept += 1;
        });
        spent += self.let_go(now, part, history);
        spent
    }
}

impl Elements for ConvexHeap {
    fn len(&self) -> usize {
        self.solids.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        std::slice::from_ref(&self.solids[e].node)
    }

    fn dofs(&self) -> usize {
        6
    }
}

impl Mechanics for ConvexHeap {
    fn history(&self) -> usize {
        SLOTS * self.width * self.solids.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        subtract_forces(self, now, F);
    }

    /// Pairs have tangents, and not solids: see [`Wandering::pair_tangents`].
    fn tangent(&self, _: usize, _: &Configuration, _: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        self.advance_pairs(now, part, history, |_, _, _| ())
    }

    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        self.advance_pairs(now, 1.0, new, |pair, at, acting| subtract_action(&pair.action(at, acting), F))
    }
}

impl Results for ConvexHeap {
    fn energy(&self, now: &Configuration) -> f64 {
        energy(self, now)
    }
}

impl Branches for ConvexHeap {
    fn is_inactive(&self, _: usize, _: &Configuration) -> bool {
        true
    }
}

impl PairBlock for ConvexHeap {
    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction)) {
        self.each_touch(now, |touch| {
            let arm = now.nodes[touch.pair.other.node].x;
            act(&PairAction { arm, ..touch.pair.action(&touch.at, &touch.acting) });
        });
    }

    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PairMemory) -> bool) -> bool {
        let mut slots = history.chunks_exact(SLOTS * self.width).flat_map(|own| self.slots(own));
        slots.any(|(_, old)| old.is_known() && is(old))
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        let way = farthest(&self.involved, now.nodes, |_, node| start[node].x);
        if !way.is_finite() {
            return true;
        }
        let mut nearby = self.nearby(now.nodes);
        (0..self.solids.len()).any(|e| {
            self.on_the_way(e, way, &mut nearby, |other| {
                is_missed(&self.pair(e, other), self.memory(now.history, e, other), start, now)
            })
        })
    }

    fn wandering(&self) -> Option<&dyn Wandering> {
        Some(self)
    }

    fn is_crowded(&self, now: &Configuration) -> bool {
        let is_full = |e: usize| self.slots(self.of_solid(e, now.history)).count() == SLOTS;
        if now.history.is_empty() || !(0..self.solids.len()).any(is_full) {
            return false;
        }
        let (mut last, mut count, mut most) = (usize::MAX, 0, 0);
        self.each_touch(now, |touch| {
            count = if touch.numbers[0] == last { count + 1 } else { 1 };
            (last, most) = (touch.numbers[0], most.max(count));
        });
        most > SLOTS
    }
}

impl ConvexHeap {
    /// Energy lost by forgotten pairs: the friction spring is released, and damping ends.
    fn let_go(&self, now: &Configuration, part: f64, new: &[f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for e in 0..self.solids.len() {
            let (old, new) = (self.of_solid(e, now.history), self.of_solid(e, new));
            for (other, motion) in self.slots(old) {
                if motion.is_known() && self.slots(new).all(|(kept, _)| kept != other) {
                    spent += lost(&self.law, motion, part * now.dt);
                }
            }
        }
        spent
    }
}

impl Wandering for ConvexHeap {
    fn further_nodes(&self) -> [&[usize]; 2] {
        [&self.involved, &self.involved]
    }

    fn partners(&self, nodes: &[Node]) -> Partners {
        let mut partners = Partners::default();
        self.each_near(nodes, 2.0 * self.margin, |e, other| {
            partners.push([e, other], [e, other].into_iter().map(|k| self.solids[k].node));
        });
        partners
    }

    fn has_room(&self, partners: &Partners, now: &Configuration) -> bool {
        let mut has = true;
        self.each_touch(now, |touch| has &= partners.place(touch.numbers).is_some());
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
        self.each_touch(now, |touch| {
            let Some(place) = partners.place(touch.numbers) else { return };
            let K = &mut K[..144];
            K.fill(0.0);
            tangent(&touch.pair, touch.old, now, rate_weight, K);
            add(place, K);
        });
    }
}
