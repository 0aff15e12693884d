//! Limits on the step length: no box passes through another, and impacts are resolved.

use super::pair::BoxPairs;
use super::pose::{BoxPose, LeastAxis};
use crate::math::Vec3;
use crate::state::{Configuration, Node};

/// True where a step from `start` to `now` must be shorter: a box would pass through the other, or be more than half way through, or
/// come into an impact that the step does not resolve.
pub fn misses_pair(pairs: &BoxPairs, start: &[Node], now: &Configuration) -> bool {
    (0..pairs.boxes.len()).any(|e| is_missed(pairs, e, start, now))
}

/// Longest time ahead at which equilibrium may be written next, given the history of the block.
pub fn longest_pair_step(pairs: &BoxPairs, history: &[f64]) -> f64 {
    let law = &pairs.law;
    let in_impact = |e: usize| {
        let old = pairs.history(e, history);
        old.is_known() && old.impact_speed() > 3.0 * law.floor && old.age() < law.duration
    };
    let any = law.resolution < f64::INFINITY && (0..pairs.boxes.len()).any(in_impact);
    if any { law.resolution } else { f64::INFINITY }
}

fn is_missed(pairs: &BoxPairs, e: usize, start: &[Node], now: &Configuration) -> bool {
    let (law, old) = (&pairs.law, pairs.history(e, now.history));
    let [from, to] = [start, now.nodes].map(|nodes| pairs.kinematics(e, nodes).pose);
    let length = (to.y - from.y).norm() + (to.Q - from.Q).norm() * from.own.norm();
    if from.y.norm() - from.size() > length {
        return false;
    }
    let (first, last) = (from.least_axis(), to.least_axis());
    if first.gap > length {
        return false;
    }
    if last.gap >= 0.0 {
        let through = first.gap <= 0.0 && is_opposite(&first.axis, &last.axis);
        return through || first.gap > 0.0 && passes(&from, &to, length);
    }
    let depth = -last.gap;
    let half = from.own.min().min(from.other.min());
    if now.dt < old.safe_time() || depth > half && depth > -first.gap {
        return true;
    }
    // Thin boxes may overlap already where the one is about to leave by the other side.
    let entry = if first.gap > 0.0 {
        Way { from: &from, to: &to }.entry(length).map(|(_, axis)| axis)
    } else {
        Some(first.axis)
    };
    if entry.is_some_and(|entry| is_opposite(&entry, &last.axis)) {
        return true;
    }
    let fast = 3.0 * law.floor;
    let landing = first.gap > 0.0 && (!old.is_known() || old.rate() > fast || depth > fast * 2.0 * law.resolution);
    landing && now.dt > law.resolution
}

/// True where the side on which boxes lie has changed for the other: the axes of neighbouring sides are at right angles.
fn is_opposite(a: &Vec3, b: &Vec3) -> bool {
    a.dot(b) < -0.5
}

/// The motion of a pair in a step, from 0 to 1.
struct Way<'a> {
    from: &'a BoxPose,
    to: &'a BoxPose,
}

impl Way<'_> {
    fn least_axis(&self, t: f64) -> LeastAxis {
        let Way { from, to } = self;
        let (y, Q) = (from.y + t * (to.y - from.y), from.Q + t * (to.Q - from.Q));
        BoxPose { y, Q, ..**from }.least_axis()
    }

    /// Where the boxes meet first on a way of this `length`, and the axis that held them apart until then. No way is shorter than
    /// the gap, so the search goes on by that.
    fn entry(&self, length: f64) -> Option<(f64, Vec3)> {
        let mut t = 0.0;
        while t < 1.0 {
            let at = self.least_axis(t);
            if at.gap < 1e-3 * length {
                return Some((t, at.axis));
            }
            t += at.gap / length;
        }
        None
    }
}

/// True where boxes that are apart before and after have met on the way.
fn passes(from: &BoxPose, to: &BoxPose, length: f64) -> bool {
    let (Some((t0, _)), Some((back, _))) = (Way { from, to }.entry(length), Way { from: to, to: from }.entry(length))
    else {
        return false;
    };
    let t1 = 1.0 - back;
    Way { from, to }.least_axis(0.5 * (t0 + t1)).gap < -0.02 * (t1 - t0) * length
}
