//! Limits on the step length: no convex solid passes through another, and impacts are resolved.

use super::pair::ConvexPair;
use super::pose::{ConvexPose, LeastAxis};
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::steps::first_reached;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3};

/// True where a step from `start` to `now` must be shorter: one solid is through the other, or more than half way, or an impact is not
/// resolved.
pub(super) fn is_missed(pair: &ConvexPair, old: PairMemory, start: &[Node], now: &Configuration) -> bool {
    if pair.balls_miss(start, now.nodes) {
        return false;
    }
    let [from, to] = [start, now.nodes].map(|nodes| pair.kinematics(nodes).pose);
    let length = (to.y - from.y).norm() + (to.Q - from.Q).norm() * from.own.reach();
    if from.apart() > length {
        return false;
    }
    let first = from.least_axis_within(length);
    if first.gap > length {
        return false;
    }
    let last = to.least_axis();
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
        let way = Way { from: &from, to: &to };
        way.entry(length).map(|t| way.least_axis(t).axis)
    } else {
        Some(first.axis)
    };
    if entry.is_some_and(|entry| is_opposite(&entry, &last.axis)) {
        return true;
    }
    first.gap > 0.0 && pair.law.lands_unresolved(old, depth, now.dt)
}

/// True where the contact axis has turned to the opposite side; axes of neighbouring sides are at right angles.
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
        // Boxes need axes at right angles.
        let [x, toward] = [0, 1].map(|k| from.Q.column(k) + t * (to.Q.column(k) - from.Q.column(k)));
        let (x, z) = (x.normalize(), x.cross(&toward).normalize());
        let Q = Mat3::from_columns(&[x, z.cross(&x), z]);
        ConvexPose { y: from.y + t * (to.y - from.y), Q, ..**from }.least_axis()
    }

    /// Where the two meet first on a way of this `length`.
    fn entry(&self, length: f64) -> Option<f64> {
        first_reached(length, |t| self.least_axis(t).gap)
    }
}

/// True where two solids are apart before and after the step but meet within it.
fn passes(from: &ConvexPose, to: &ConvexPose, length: f64) -> bool {
    let (Some(t0), Some(back)) = (Way { from, to }.entry(length), Way { from: to, to: from }.entry(length)) else {
        return false;
    };
    let t1 = 1.0 - back;
    Way { from, to }.least_axis(0.5 * (t0 + t1)).gap < -0.02 * (t1 - t0) * length
}
