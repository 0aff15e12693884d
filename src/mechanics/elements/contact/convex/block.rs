//! Pairs of convex solids as a block of elements.

use super::pair::width;
use super::pairs::ConvexPairs;
use super::steps::is_missed;
use super::tangent::tangent;
use super::update::update_pair;
use crate::elements::block::{ElementBlock, Force, Moduli};
use crate::elements::contact::history::PointHistory;
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::pair_block::{PairAction, PairBlock, energy, subtract_forces};
use crate::elements::slip::Sliding;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};

impl ElementBlock for ConvexPairs {
    fn len(&self) -> usize {
        self.count()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn history(&self) -> usize {
        width(&self.law) * self.count()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        subtract_forces(self, now, F);
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if !now.history.is_empty() {
            tangent(&self.pair(e), self.history(e, now.history), now, rate_weight, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(width(&self.law)).enumerate() {
            spent += update_pair(&self.pair(e), self.history(e, now.history), now, part, new);
        }
        spent
    }

    fn energy(&self, now: &Configuration) -> f64 {
        energy(self, now)
    }

    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        now.history.is_empty()
            || now.dt < self.history(e, now.history).safe_time()
            || self.pair(e).kinematics(now.nodes).pose.least_axis().gap > self.law.touching
    }

    fn pairs(&self) -> Option<&dyn PairBlock> {
        Some(self)
    }

    fn sliding(&self) -> Option<&dyn Sliding> {
        Some(self)
    }
}

impl PairBlock for ConvexPairs {
    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn carrier(&self) -> Option<usize> {
        Some(self.other.node)
    }

    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction)) {
        if now.history.is_empty() {
            return;
        }
        for e in 0..self.count() {
            let pair = self.pair(e);
            if let Some((at, acting)) = pair.touch(self.history(e, now.history), now) {
                act(&pair.action(&at, &acting));
            }
        }
    }

    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PointHistory) -> bool) -> bool {
        (0..self.count()).map(|e| self.history(e, history)).any(|old| old.is_known() && is(old))
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        (0..self.count()).any(|e| is_missed(&self.pair(e), self.history(e, now.history), start, now))
    }
}
