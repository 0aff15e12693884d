//! The slip of points and of pairs of solids in a step, from what they remember at its two ends.

use super::convex::ConvexPairs;
use super::history;
use super::kinematics::Contacts;
use crate::elements::slip::Slip;
use base::math::Vec3;

/// The number of springs of friction of a block of points whose slip is known: none of balls, which roll, nor where multipliers hold.
pub fn rubbing_points(block: &Contacts) -> usize {
    let known = block.law.friction > 0.0 && !block.rolls && block.law.tolerance.is_none();
    if known { block.points.len() } else { 0 }
}

/// The slip of a point in a step between two histories of its block.
pub fn slip_of_point(block: &Contacts, e: usize, [old, new]: [&[f64]; 2]) -> Slip {
    let [old, new] = [old, new].map(|history| history::of(block, e, history));
    let slips = new.is_known() && new.slip_speed() > 0.0;
    let way = if slips && old.is_known() { new.anchor() - old.anchor() } else { Vec3::zeros() };
    let touches = new.is_known() && new.gap() <= 0.0;
    Slip { way, pull: if touches { new.friction_force() } else { 0.0 }, stiffness: block.law.stiffness, touches }
}

/// The slip of a pair in a step of length `dt` between two histories of its block.
pub fn slip_of_pair(block: &ConvexPairs, e: usize, [_, new]: [&[f64]; 2], dt: f64) -> Slip {
    let (new, memory) = block.friction_of(e, new);
    let touches = new.is_known() && new.gap() <= 0.0;
    // What slips pulls along its slip.
    let along = memory.stretch.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let pull = if touches { new.friction_force() } else { 0.0 };
    Slip { way: memory.slip_speed * dt * along, pull, stiffness: block.law.stiffness, touches }
}
