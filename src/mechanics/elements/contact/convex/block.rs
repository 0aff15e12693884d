//! Pairs of convex solids as a block of elements.

use super::pair::width;
use super::pairs::ConvexPairs;
use super::tangent::{spread, tangent};
use super::update::update_pair;
use crate::elements::block::{ElementBlock, Force, Moduli};
use crate::materials::Dissipation;
use crate::state::Configuration;

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
        if now.history.is_empty() {
            return;
        }
        for e in 0..self.count() {
            let pair = self.pair(e);
            if let Some((at, acting)) = pair.touch(self.history(e, now.history), now) {
                spread(&pair, &at, &acting, F);
            }
        }
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
        if now.history.is_empty() {
            return 0.0;
        }
        let stored = |e: usize| {
            let pair = self.pair(e);
            Some(pair.energy(&pair.touch(self.history(e, now.history), now)?.1))
        };
        (0..self.count()).filter_map(stored).sum()
    }

    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        now.history.is_empty()
            || now.dt < self.history(e, now.history).safe_time()
            || self.pair(e).kinematics(now.nodes).pose.least_axis().gap > self.law.touching
    }

    fn rubs(&self) -> bool {
        self.law.friction > 0.0
    }

    fn as_any(&self) -> Option<&dyn std::any::Any> {
        Some(self)
    }
}
