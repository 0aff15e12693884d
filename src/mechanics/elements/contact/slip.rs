//! Slip of points and of pairs of solids in a step, from their histories at its two ends.

use super::convex::ConvexPairs;
use super::history;
use super::kinematics::Contacts;
use crate::elements::slip::{Sliding, Slip};
use base::math::Vec3;

impl Sliding for Contacts {
    /// Balls roll, and multipliers hold: neither has a known slip.
    fn has_friction(&self, _e: usize) -> bool {
        self.law.friction > 0.0 && !self.rolls && self.law.tolerance.is_none()
    }

    fn slip(&self, e: usize, histories: [&[f64]; 2], _dt: f64) -> Slip {
        let [old, new] = histories.map(|of| history::of(self, e, of));
        let slips = new.is_known() && new.slip_speed() > 0.0;
        let way = if slips && old.is_known() { new.anchor() - old.anchor() } else { Vec3::zeros() };
        let touches = new.is_known() && new.gap() <= 0.0;
        Slip { way, pull: if touches { new.friction_force() } else { 0.0 }, stiffness: self.law.stiffness, touches }
    }
}

impl Sliding for ConvexPairs {
    fn has_friction(&self, _e: usize) -> bool {
        self.law.friction > 0.0
    }

    fn slip(&self, e: usize, [_, new]: [&[f64]; 2], dt: f64) -> Slip {
        let (new, memory) = self.friction_of(e, new);
        let touches = new.is_known() && new.gap() <= 0.0;
        // Friction acts along the slip.
        let along = memory.stretch.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let pull = if touches { new.friction_force() } else { 0.0 };
        Slip { way: memory.slip_speed * dt * along, pull, stiffness: self.law.stiffness, touches }
    }
}
