//! Slip of points and of pairs of solids in a step, from their histories at its two ends.

use super::convex::ConvexPairs;
use super::history::PairMemory;
use super::kinematics::Contacts;
use crate::elements::slip::{Sliding, Slip};
use base::math::Vec3;

impl Sliding for Contacts {
    /// Balls roll, and multipliers hold: neither has a known slip.
    fn has_friction(&self, _e: usize) -> bool {
        self.law.friction > 0.0 && !self.rolls && self.law.tolerance.is_none()
    }

    fn slip(&self, e: usize, histories: [&[f64]; 2], _dt: f64) -> Slip {
        let [old, new] = histories.map(|history| self.memory(e, history));
        let moved = if new.is_known() && old.is_known() { new.anchor() - old.anchor() } else { Vec3::zeros() };
        let way = if new.slip_speed() > 0.0 { moved } else { Vec3::zeros() };
        slip([old, new], self.law.stiffness, [way, moved])
    }
}

impl Sliding for ConvexPairs {
    fn has_friction(&self, _e: usize) -> bool {
        self.law.friction > 0.0
    }

    fn slip(&self, e: usize, histories: [&[f64]; 2], dt: f64) -> Slip {
        let [(old, before), (new, memory)] = histories.map(|history| self.friction_of(e, history));
        // Friction acts along the slip.
        let along = memory.stretch.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let moved = if new.is_known() && old.is_known() { memory.y - before.y } else { Vec3::zeros() };
        slip([old, new], self.law.stiffness, [new.slip_speed() * dt * along, moved])
    }
}

/// The slip in a step between two histories: `way` in contact, the motion `moved` without.
fn slip([old, new]: [PairMemory; 2], stiffness: f64, [way, moved]: [Vec3; 2]) -> Slip {
    let rate = |at: PairMemory| if at.is_known() { at.rate() } else { f64::INFINITY };
    let approach = [rate(old), rate(new)];
    if new.is_known() && new.gap() <= 0.0 {
        return Slip { way, pull: new.friction_force(), stiffness, touches: true, apart: 0.0, approach };
    }
    let rise = new.gap() - old.gap();
    let apart = (moved.norm_squared() - rise * rise).max(0.0).sqrt();
    Slip { way: Vec3::zeros(), pull: 0.0, stiffness, touches: false, apart, approach }
}
