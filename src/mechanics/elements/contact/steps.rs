//! Limits on the step length: no point passes through the surface in a step, and impacts are resolved.

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

/// Where on a way of this `length`, from 0 to 1, a gap first is next to nothing. No way is shorter than the gap, so the search goes on by that.
pub(super) fn first_reached(length: f64, gap: impl Fn(f64) -> f64) -> Option<f64> {
    let mut t = 0.0;
    while t < 1.0 {
        let at = gap(t);
        if at < 1e-3 * length {
            return Some(t);
        }
        t += at / length;
    }
    None
}

/// True where a point passes through the surface in a step from `start` to `now`, or lands in an unresolved impact.
fn is_missed(contacts: &Contacts, e: usize, start: &[Node], now: &Configuration, frames: &Frames) -> bool {
    let point = &contacts.points[e];
    let old = || contacts.memory(e, now.history);
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
    let entry = if first > 0.0 { first_reached(length, |t| gap(&(p0 + t * way))) } else { Some(0.0) };
    let Some(t0) = entry else { return false };
    let entry = normal(&(p0 + t0 * way));
    // The point left by the other side; or by another side from far inside, and not just round an edge.
    let strayed = |n: &Vec3, depth: f64, length: f64| {
        let along = entry.dot(n);
        along < -0.5 && depth < 0.0 || along < 0.5 && depth < first.min(0.0) - 0.02 * length
    };
    if last < 0.0 {
        let depth = last.min(gap(&(p0 + 0.5 * (1.0 + t0) * way)));
        return strayed(&normal(&p1), depth, length)
            || first > 0.0 && contacts.law.lands_unresolved(old(), -depth, now.dt);
    }
    // The point went in at one place and out at another; a shallow pass along one side is left alone.
    let Some(t1) = first_reached(length, |t| gap(&(p1 - t * way))).map(|t| 1.0 - t) else { return false };
    let (depth, chord) = (gap(&(p0 + 0.5 * (t0 + t1) * way)), (t1 - t0) * length);
    first > 0.0 && depth < -0.02 * chord || strayed(&normal(&(p0 + t1 * way)), depth, chord)
}
