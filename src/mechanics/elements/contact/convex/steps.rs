//! Limits on the step length: no convex solid passes through another, and impacts are resolved.

use super::pair::ConvexPair;
use super::pose::{ConvexPose, LeastAxis};
use crate::elements::contact::history::PointHistory;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// True where a step from `start` to `now` must be shorter: one would pass through the other, or be more than half way through, or
/// come into an impact that the step does not resolve.
pub(super) fn is_missed(pair: &ConvexPair, old: PointHistory, start: &[Node], now: &Configuration) -> bool {
    let law = pair.law;
    let [from, to] = [start, now.nodes].map(|nodes| pair.kinematics(nodes).pose);
    let length = (to.y - from.y).norm() + (to.Q - from.Q).norm() * from.own.reach();
    if from.apart() > length {
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
    let half = 0.5 * from.own.least().min(from.other.least());
    if now.dt < old.safe_time() || depth > half && depth > -first.gap {
        return true;
    }
    // Thin ones may overlap already where the one is about to leave by the other side.
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

/// True where the side on which the one lies has changed for the other: the axes of neighbouring sides are at right angles.
fn is_opposite(a: &Vec3, b: &Vec3) -> bool {
    a.dot(b) < -0.5
}

/// The motion of a pair in a step, from 0 to 1.
struct Way<'a> {
    from: &'a ConvexPose<'a>,
    to: &'a ConvexPose<'a>,
}

impl Way<'_> {
    fn least_axis(&self, t: f64) -> LeastAxis {
        let Way { from, to } = self;
        let (y, Q) = (from.y + t * (to.y - from.y), from.Q + t * (to.Q - from.Q));
        ConvexPose { y, Q, ..**from }.least_axis()
    }

    /// Where the two meet first on a way of this `length`, and the axis that held them apart until then. No way is shorter than
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

/// True where two that are apart before and after have met on the way.
fn passes(from: &ConvexPose, to: &ConvexPose, length: f64) -> bool {
    let (Some((t0, _)), Some((back, _))) = (Way { from, to }.entry(length), Way { from: to, to: from }.entry(length))
    else {
        return false;
    };
    let t1 = 1.0 - back;
    Way { from, to }.least_axis(0.5 * (t0 + t1)).gap < -0.02 * (t1 - t0) * length
}
