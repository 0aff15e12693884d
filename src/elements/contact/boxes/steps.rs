//! Limits on the step length: no box passes through another, and impacts are resolved.

use super::pair::BoxPairs;
use super::pose::BoxPose;
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
        let through = first.gap <= 0.0 && first.axis.dot(&last.axis) < -0.5;
        return through || first.gap > 0.0 && passes(&from, &to, length);
    }
    let depth = -last.gap;
    let half = from.own.min().min(from.other.min());
    if now.dt < old.safe_time() || depth > half && depth > -first.gap {
        return true;
    }
    let fast = 3.0 * law.floor;
    let landing = first.gap > 0.0 && (!old.is_known() || old.rate() > fast || depth > fast * 2.0 * law.resolution);
    landing && now.dt > law.resolution
}

/// True where boxes that are apart before and after have met on the way. No way is shorter than the gap, so the search goes on by
/// that from either end.
fn passes(from: &BoxPose, to: &BoxPose, length: f64) -> bool {
    let gap = |t: f64| {
        let (y, Q) = (from.y + t * (to.y - from.y), from.Q + t * (to.Q - from.Q));
        BoxPose { y, Q, ..*from }.least_axis().gap
    };
    let reached = |at: &dyn Fn(f64) -> f64| {
        let mut t = 0.0;
        while t < 1.0 {
            let g = gap(at(t));
            if g < 1e-3 * length {
                return Some(t);
            }
            t += g / length;
        }
        None
    };
    let (Some(t0), Some(t1)) = (reached(&|t| t), reached(&|t| 1.0 - t).map(|t| 1.0 - t)) else { return false };
    gap(0.5 * (t0 + t1)) < -0.02 * (t1 - t0) * length
}
