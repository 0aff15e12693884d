//! The sums for the stability checks of a central-difference step, over separate bodies in one pass.

use crate::system::masses::MassBlock;
use base::math::{Vec6, angular, linear, stack};
use mechanics::state::Node;
use std::ops::AddAssign;

/// Sums over nodes for the stability checks; M is mass and mean moment of inertia, except in `aMa`.
#[derive(Default)]
pub struct StepSums {
    /// The sum of all accelerations and positions, which is finite only if all of them are.
    pub all: f64,
    /// −Δaᵀ M q and qᵀ M q of the step's motion.
    pub resistance: [f64; 2],
    /// aᵀ M a of the accelerations found, as [`super::inner_product::aMa_of_trial`] has it.
    pub aMa: f64,
    /// −(a₁ − 2 a₀ + a₋₁)ᵀ M a₀, a₀ᵀ M a₀ and a₁ᵀ M a₁.
    pub growth: [f64; 3],
}

impl AddAssign for StepSums {
    fn add_assign(&mut self, more: StepSums) {
        let StepSums { all, resistance, aMa, growth } = more;
        self.all += all;
        self.aMa += aMa;
        self.resistance.iter_mut().zip(resistance).for_each(|(sum, more)| *sum += more);
        self.growth.iter_mut().zip(growth).for_each(|(sum, more)| *sum += more);
    }
}

impl StepSums {
    /// Adds a node that moves by `q` from `start` to the trial motion `now`. Its accelerations are those of `now` plus `missing`; `jerk_dt`
    /// is the change of acceleration expected from the last step.
    #[inline]
    pub fn add(&mut self, block: &MassBlock, [start, now]: [&Node; 2], q: &Vec6, missing: &Vec6, jerk_dt: &Vec6) {
        let [mass, inertia] = block.mean_mass();
        let times = |a: &Vec6, b: &Vec6| mass * linear(a).dot(&linear(b)) + inertia * angular(a).dot(&angular(b));
        let before = stack(&start.a, &start.alpha);
        let change = stack(&(now.a - start.a), &(now.alpha - start.alpha)) + missing;
        self.resistance[0] -= times(&change, q);
        self.resistance[1] += mass * linear(q).norm_squared() + inertia * angular(q).norm_squared();
        let a = stack(&now.a, &now.alpha) + missing;
        self.aMa += block.push_product(now, &block.of_unknowns(&a));
        let (second, after) = (change - jerk_dt, change + before);
        self.growth[2] += mass * linear(&after).norm_squared() + inertia * angular(&after).norm_squared();
        self.growth[0] -= times(&second, &before);
        self.growth[1] += mass * start.a.norm_squared() + inertia * start.alpha.norm_squared();
    }
}
