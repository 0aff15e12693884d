//! Limits on the step length: no step takes a point through the surface, and impacts are resolved.

use super::history;
use super::kinematics::Contacts;
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3};

/// Rotations of the surface at the start of a step and at its instant of equilibrium.
struct Frames {
    start: Mat3,
    now: Mat3,
    /// Bound of |R₁ − R₀|: a chord of the angle, twice that of its half.
    turn: f64,
}

/// True where a step from `start` to `now` must be shorter: see [`super::PairBlock::misses`].
pub(super) fn misses(contacts: &Contacts, start: &[Node], now: &Configuration) -> bool {
    let (a, b) = (&start[contacts.carrier], &now.nodes[contacts.carrier]);
    let turn = 2.0 * (b.rotation - a.rotation).norm().min((b.rotation + a.rotation).norm());
    let frames = Frames { start: a.R(), now: b.R(), turn };
    (0..contacts.points.len()).any(|e| is_missed(contacts, e, start, now, &frames))
}

/// True where a step from `start` to `now` takes a point through the surface, or into an impact that the step does not
/// resolve.
fn is_missed(contacts: &Contacts, e: usize, start: &[Node], now: &Configuration, frames: &Frames) -> bool {
    let point = &contacts.points[e];
    let old = || history::of(contacts, e, now.history);
    let [from, to] = [start, now.nodes].map(|nodes| point.relative_position(&nodes[contacts.carrier], nodes));
    let far = from.norm();
    if far - contacts.reach() - point.radius > (to - from).norm() + frames.turn * far {
        return false;
    }
    let (p0, p1) = (frames.start.tr_mul(&from), frames.now.tr_mul(&to));
    let (way, gap) = (p1 - p0, |p: &Vec3| contacts.surface.distance(p) - point.radius);
    let (length, first, last) = (way.norm(), gap(&p0), gap(&p1));
    if first > length {
        return false;
    }
    if last < 0.0 && now.dt < old().safe_time() {
        return true;
    }
    let normal = |p: &Vec3| contacts.surface.closest_point(p).n;
    // Nothing is nearer than the distance, so the search advances along the path by it, from either end, until the
    // surface is reached.
    let reached = |at: &dyn Fn(f64) -> Vec3| {
        let mut t = 0.0;
        while t < 1.0 {
            let g = gap(&at(t));
            if g < 1e-3 * length {
                return Some(t);
            }
            t += g / length;
        }
        None
    };
    let Some(t0) = (if first > 0.0 { reached(&|t| p0 + t * way) } else { Some(0.0) }) else { return false };
    let entry = normal(&(p0 + t0 * way));
    // The point left by the other side; or by another side from far inside, and not just round an edge.
    let strayed = |n: &Vec3, depth: f64, length: f64| {
        let along = entry.dot(n);
        along < -0.5 && depth < 0.0 || along < 0.5 && depth < first.min(0.0) - 0.02 * length
    };
    if last < 0.0 {
        let depth = last.min(gap(&(p0 + 0.5 * (1.0 + t0) * way)));
        let fast = 3.0 * contacts.law.floor;
        let landing =
            first > 0.0 && (!old().is_known() || old().rate() > fast || -depth > fast * 2.0 * contacts.law.resolution);
        return strayed(&normal(&p1), depth, length) || landing && now.dt > contacts.law.resolution;
    }
    // The point went in at one place and out at another; a shallow pass along one side is left alone.
    let Some(t1) = reached(&|t| p1 - t * way).map(|t| 1.0 - t) else { return false };
    let (depth, chord) = (gap(&(p0 + 0.5 * (t0 + t1) * way)), (t1 - t0) * length);
    first > 0.0 && depth < -0.02 * chord || strayed(&normal(&(p0 + t1 * way)), depth, chord)
}
