//! Limits on the step length: nothing passes through the middle of a surface of facets unseen, and impacts are resolved.

use super::balls;
use super::facet::{Facet, Region};
use super::found::{FacetTouch, TouchQuery};
use super::surface::FacetContacts;
use super::touch;
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::near_lists::farthest;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// Fraction of the reach that a point known to be on one side of a facet may have come through its middle.
const THROUGH: f64 = 0.9;

/// True where a step from `start` to `now` must be shorter: a point passes a facet, an impact is not resolved, or sliding loses the memory
/// of friction.
pub(super) fn misses_facet(of: &FacetContacts, start: &[Node], now: &Configuration) -> bool {
    let way = farthest(&of.involved, now.nodes, |_, node| start[node].x);
    !way.is_finite() || passes_any(of, way, start, now) || 2.0 * way > of.margin && forgets(of, now)
}

/// True where a point passes the middle of a facet without a known side, comes through it by nearly all of its reach, or lands in an
/// unresolved impact. Balls do not pass the middle of each other.
fn passes_any(of: &FacetContacts, way: f64, start: &[Node], now: &Configuration) -> bool {
    let mut nearby = of.nearby(now.nodes);
    let mut found = std::mem::take(&mut nearby.touches);
    let is_missed = (0..of.points.len()).any(|e| {
        let old = of.of_point(e, now.history);
        let near = nearby.of(e);
        if 2.0 * way <= of.margin && nearby.is_clear(e, 2.0 * way) {
            return false;
        }
        if !near.is_empty() {
            touch::find(of, near, TouchQuery { e, limit: of.law.touching, stays: true }, now.nodes, old, &mut found);
            touch::take_over(of, e, now.nodes, now.history, &mut found);
            let too_far = |touch: &FacetTouch| {
                let pair = of.pair(e, touch, now.history);
                let place = pair.place(now.nodes);
                let is_through = place.d < -THROUGH * place.reach;
                let old = pair.memory.unwrap_or(PairMemory::NOTHING);
                let was_apart = !old.is_known() || old.gap() > 0.0;
                is_through || was_apart && of.law.lands_unresolved(old, -place.gap(), now.dt)
            };
            if found.iter().any(too_far) {
                return true;
            }
        }
        let known = |facet: usize, normal: &dyn Fn(&Facet) -> Vec3| {
            let is_same = |slot: usize| {
                let memory = of.memory(old, slot);
                let other = memory.facet();
                memory.is_known()
                    && (other == facet || normal(&of.facets[other]).dot(&normal(&of.facets[facet])).abs() > 0.5)
            };
            (0..of.slots).any(is_same)
        };
        if !of.is_of_balls && (0..of.slots).any(|slot| has_come_through(of, e, slot, now)) {
            return true;
        }
        let ahead = nearby.on_the_way(of, e, way);
        ahead.iter().any(|&number| {
            if of.is_of_balls && !balls::may_have_passed(of, e, number, way, now.nodes) {
                return false;
            }
            let facet = &of.facets[number as usize];
            let Some(beyond) = passes(of, e, facet, [start, now.nodes]) else { return false };
            let stays = || {
                facet.has_sides()
                    && beyond <= THROUGH * (facet.half + of.points[e].radius)
                    && known(number as usize, &|facet| facet.frame(now.nodes).column(2).into_owned())
            };
            !of.is_near_along(e, number) && !stays()
        })
    });
    nearby.touches = found;
    is_missed
}

/// True where contacts slide over more than a facet in one step, so that friction would restart from zero.
fn forgets(of: &FacetContacts, now: &Configuration) -> bool {
    if of.law.friction == 0.0 || of.is_of_balls {
        return false;
    }
    let rubs = |e: usize, slot: usize| {
        let motion = of.memory(of.of_point(e, now.history), slot);
        motion.is_known() && motion.gap() <= 0.0 && motion.friction_force() > 0.0
    };
    let all = |e: usize| (0..of.slots).filter(|&slot| rubs(e, slot)).count();
    // For each point: the contacts with friction, those among them that still touch, and new ones. Lines hand on to each other.
    let (mut e, mut known, mut begun) = (usize::MAX, 0, 0);
    let mut on_all = [0, 0];
    let mut is_lost = false;
    of.each_touch(now.nodes, now.history, |point, touch, _| {
        if point != e {
            is_lost |= e != usize::MAX && begun > 0 && known < all(e);
            (e, known, begun) = (point, 0, 0);
        }
        match touch.slot.map(|slot| (point, slot)).or(touch.from) {
            Some((from, slot)) if rubs(from, slot) => (known, on_all[0]) = (known + 1, on_all[0] + 1),
            Some(_) => {}
            None if touch.gap < 0.0 => (begun, on_all[1]) = (begun + 1, on_all[1] + 1),
            None => {}
        }
    });
    match of.is_of_lines {
        true => on_all[1] > 0 && on_all[0] < (0..of.points.len()).map(all).sum::<usize>(),
        false => is_lost || e != usize::MAX && begun > 0 && known < all(e),
    }
}

/// True where a point has come through its remembered facet by nearly all of its reach.
fn has_come_through(of: &FacetContacts, e: usize, slot: usize, now: &Configuration) -> bool {
    let old = of.of_point(e, now.history);
    let memory = of.memory(old, slot);
    if !memory.is_known() || memory.gap() > 0.0 || !of.facets[memory.facet()].has_sides() {
        return false;
    }
    let place = of.pair_of(e, slot, old).place(now.nodes);
    place.at.region == Region::Interior && place.d < -THROUGH * place.reach
}

/// By how far a point has come through a facet between two motions, on straight lines; `None` where it has not.
fn passes(of: &FacetContacts, e: usize, facet: &Facet, at: [&[Node]; 2]) -> Option<f64> {
    let seen = at.map(|nodes| {
        let point = of.point_at(e, of.share(e, facet, nodes));
        let origin = &nodes[point.nodes[0]];
        facet.seen_from(&point.relative_position(origin, nodes), origin, nodes)
    });
    let reach = facet.half + of.points[e].radius;
    if facet.is_ball() {
        return swaps_sides(seen[0][0], seen[1][0], reach).then_some(0.0);
    }
    if facet.is_line() {
        let [from, to] = [0, 1].map(|i| facet.closest(&seen[i]).g);
        return swaps_sides(from, to, reach).then_some(0.0);
    }
    let is_passed = |k: &usize| {
        let k = *k;
        let [from, to] = [0, 1].map(|i| facet.triangle(k, &seen[i]));
        let side = |[a, b, c]: &[Vec3; 3]| a.dot(&(b - a).cross(&(c - a)));
        let (s, t) = (side(&from), side(&to));
        if s == 0.0 || s.signum() == t.signum() {
            return false;
        }
        let part = s / (s - t);
        let [a, b, c] = [0, 1, 2].map(|i| from[i] + part * (to[i] - from[i]));
        let n = (b - a).cross(&(c - a));
        // Inside where the point, the origin, is to the left of all edges; a little beyond counts too.
        let inside = |p: &Vec3, q: &Vec3| p.cross(q).dot(&n) >= -1e-6 * n.norm_squared();
        inside(&a, &b) && inside(&b, &c) && inside(&c, &a)
    };
    let passed = (0..facet.triangles()).map(|k| facet.piece.unwrap_or(k)).find(is_passed)?;
    let [a, b, c] = facet.triangle(passed, &seen[1]);
    let n = (b - a).cross(&(c - a));
    Some(a.dot(&n).abs() / n.norm())
}

/// True where two balls, with the relative positions `from` and `to`, pass through each other's centre; likewise for a ball and a line
/// between their nearest points.
fn swaps_sides(from: Vec3, to: Vec3, reach: f64) -> bool {
    let way = to - from;
    let square = way.norm_squared();
    if square == 0.0 {
        return false;
    }
    let part = (-from.dot(&way) / square).clamp(0.0, 1.0);
    (from + part * way).norm() < 0.3 * reach && from.dot(&to) < 0.3 * from.norm() * to.norm()
}
