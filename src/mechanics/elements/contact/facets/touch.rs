//! The facets that a point touches: the nearest facet of each smooth part of the surface, found from the facets near the point alone.
//!
//! A facet counts where the distance has a minimum on it. It does not count if its nearest point lies on its rim and a neighbour is nearer.
//! Among facets in nearly one direction the nearest counts, so that a surface of many facets pushes as one. Facets across a sharp fold, and
//! layers on either side, count separately.

use super::balls;
use super::facet::Facet;
use super::facing::Facing;
use super::found::{FacetTouch, TouchQuery};
use super::scene::{FacetScene, end_at};
use crate::state::Node;
use base::math::Vec3;

/// Directions whose cosine is larger than this are one.
const ONE_DIRECTION: f64 = 0.7;
/// Least cosine between the normals of neighbouring facets for a point to carry its memory from one to the other.
const NEIGHBOURS: f64 = 0.5;

/// Finds the facets near a point, the nearest first. `history` is that of the point.
pub(super) fn find(
    of: &FacetScene,
    near: &[u32],
    query: TouchQuery,
    nodes: &[Node],
    history: &[f64],
    found: &mut Vec<FacetTouch>,
) {
    find_within(of, near, query, nodes, found);
    let stand_alone = of.is_of_balls || of.is_of_lines;
    if !stand_alone {
        if query.stays && !of.law.dynamic {
            go_on_in_plane(of, query.e, nodes, history, found);
        }
        if of.is_inner {
            mark_slides(&of.facets, found);
        }
        face_from_rims(&of.facets, found);
        keep_minima(&of.facets, found);
    }
    found.sort_unstable_by(|a, b| a.gap.total_cmp(&b.gap).then(a.facet.cmp(&b.facet)));
    if query.stays && !stand_alone {
        prefer_known(of, history, found);
    }
    let mut kept = 0;
    for k in 0..found.len() {
        let touch = found[k];
        let is_new =
            || stand_alone || found[..kept].iter().all(|other| other.toward.dot(&touch.toward) < ONE_DIRECTION);
        if kept < of.slots && touch.counts && is_new() {
            found[kept] = touch;
            kept += 1;
        }
    }
    found.truncate(kept);
    match_memory(of, query.e, nodes, history, found);
    if found.iter().any(|touch| touch.inset > 0.0) {
        // A point moving between facets in contact keeps the depth of its force.
        let memories = (0..of.slots).map(|slot| of.memory(history, slot));
        let pressed = memories.filter(|motion| motion.is_known()).map(|motion| -motion.gap()).fold(0.0, f64::max);
        found.iter_mut().for_each(|touch| touch.inset = (touch.inset - pressed).max(0.0));
    }
}

/// The least gap of a point over the minima of its distance from near facets; infinite without a minimum.
pub(super) fn least_minimum(
    of: &FacetScene,
    near: &[u32],
    e: usize,
    nodes: &[Node],
    found: &mut Vec<FacetTouch>,
) -> f64 {
    find_within(of, near, TouchQuery { e, limit: f64::INFINITY, stays: false }, nodes, found);
    if !of.is_of_lines {
        keep_minima(&of.facets, found);
    }
    found.iter().filter(|touch| touch.counts).map(|touch| touch.gap).fold(f64::INFINITY, f64::min)
}

/// Where a point lies from its first node.
fn seen<'a>(of: &FacetScene, e: usize, nodes: &'a [Node]) -> (Vec3, &'a Node) {
    let point = &of.points[e];
    let origin = &nodes[point.nodes[0]];
    (point.relative_position(origin, nodes), origin)
}

/// All facets within the gap asked for.
pub(super) fn find_within(
    of: &FacetScene,
    near: &[u32],
    query: TouchQuery,
    nodes: &[Node],
    found: &mut Vec<FacetTouch>,
) {
    found.clear();
    if of.is_of_balls {
        return balls::find_within(of, near, query, nodes, found);
    }
    let TouchQuery { e, limit, .. } = query;
    let (x, origin) = seen(of, e, nodes);
    let radius = of.points[e].radius;
    for &number in near {
        let facet = &of.facets[number as usize];
        let share = of.share(e, facet, nodes);
        let nearest = share.map(|_| of.point_at(e, share).relative_position(origin, nodes));
        let p = facet.seen_from(nearest.as_ref().unwrap_or(&x), origin, nodes);
        let reach = facet.half + radius;
        // Most facets are excluded by the box of their corners.
        let least = (0..3).map(|i| {
            let side = p[..facet.corners].iter().map(|p| p[i]);
            let (low, high) = side.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            low.max(-high).max(0.0)
        });
        if least.fold(0.0, f64::max) > reach + limit {
            continue;
        }
        let at = facet.closest(&p);
        let distance = at.g.norm();
        if distance - reach > limit {
            continue;
        }
        let normal = facet.facing(&at, &p);
        let toward = if distance > 1e-9 * reach { at.g / distance } else { normal };
        let rim = if facet.is_ball() { [None; 2] } else { facet.rim(&at) };
        let counts = match share {
            Some(share) => of.is_nearest(e, (number as usize, at.N[1]), share, &at.g, nodes),
            None => !of.is_near_along(e, number),
        };
        found.push(FacetTouch {
            facet: number as usize,
            gap: distance - reach,
            toward,
            rim,
            normal,
            facing: Facing::Normal,
            counts,
            inset: 0.0,
            goes_on: false,
            slot: None,
            share,
            from: None,
        });
    }
}

/// The remembered depth of a point in a facet; `None` for a facet that it does not remember.
fn known_depth(of: &FacetScene, history: &[f64], facet: usize) -> Option<f64> {
    let memories = (0..of.slots).map(|slot| of.memory(history, slot));
    memories.filter(|memory| memory.is_known() && memory.facet() == facet).map(|memory| -memory.gap()).next()
}

/// Lets the plane of a remembered facet go on beyond its rim until the end of a load step, if a neighbour in nearly the same plane is as
/// near. The force of a point that slides over a shallow fold has no kink within the step, so the iteration converges. At the end of the step
/// the contact energy jumps by force times angle times the way past the rim; in dynamics the facet changes at once.
///
/// The depth at the last step limits the distance between plane and surface. This distance does not change with the depth in this step, so the
/// iteration cannot alternate between both.
fn go_on_in_plane(of: &FacetScene, e: usize, nodes: &[Node], history: &[f64], found: &mut [FacetTouch]) {
    /// Largest square of the angle over the ratio of depth to reach. The reach rounds the edge of a ridge, which may lie above the plane by a
    /// twentieth of the depth.
    const ROUNDED: f64 = 0.1;
    /// Largest square of the sine of the angle.
    const STEEPEST: f64 = 0.02;
    /// The same distance up to rounding, relative to the reach.
    const AS_NEAR: f64 = 1e-9;
    /// The largest distance between the plane and the surface, as a part of the remembered depth.
    const OFF: f64 = 0.5;
    let (x, origin) = seen(of, e, nodes);
    for k in 0..found.len() {
        let touch = found[k];
        let [Some(a), b] = touch.rim else { continue };
        let facet = &of.facets[touch.facet];
        let Some(depth) = known_depth(of, history, touch.facet).filter(|_| touch.counts && facet.has_sides()) else {
            continue;
        };
        let reach = facet.half + of.points[e].radius;
        let shallow = (ROUNDED * depth / reach).min(STEEPEST);
        let is_level = |other: &&FacetTouch| {
            let is_shallow = other.normal.cross(&touch.normal).norm_squared() <= shallow;
            other.facet != touch.facet && other.counts && other.normal.dot(&touch.normal) > 0.0 && is_shallow
        };
        let takes_over = |other: &FacetTouch| {
            let has = |corner: usize| of.facets[other.facet].names.contains(&corner);
            has(a) && b.is_none_or(has) && other.gap <= touch.gap + AS_NEAR * reach
        };
        if !found.iter().filter(is_level).any(takes_over) {
            continue;
        }
        let nearest = found.iter().filter(is_level).map(|other| other.gap).fold(f64::INFINITY, f64::min);
        let p = facet.seen_from(&x, origin, nodes);
        let foot = facet.foot(&p);
        let gap = foot.g.norm() - reach;
        if !facet.is_free(&facet.closest(&p)) && (gap - nearest).abs() <= OFF * depth {
            let toward = foot.g.try_normalize(AS_NEAR * reach).unwrap_or(touch.normal);
            found[k] = FacetTouch { gap, toward, rim: [None; 2], goes_on: true, ..touch };
        }
    }
}

/// Puts remembered facets before the others, if they count and are at least half as deep as the deepest in their direction.
fn prefer_known(of: &FacetScene, history: &[f64], found: &mut [FacetTouch]) {
    /// The least part of the depth of the deepest.
    const AS_DEEP: f64 = 0.5;
    let mut first = 0;
    for k in 0..found.len() {
        let touch = found[k];
        let is_deepest = |other: &FacetTouch| {
            !other.counts || other.toward.dot(&touch.toward) < ONE_DIRECTION || touch.gap < AS_DEEP * other.gap
        };
        let stays = touch.counts && touch.gap < 0.0 && known_depth(of, history, touch.facet).is_some();
        if stays && (touch.goes_on || found.iter().all(is_deepest)) {
            found[first..=k].rotate_right(1);
            first += 1;
        }
    }
}

/// Marks facets with the point inside, beside a facet that it cannot touch and is inside too: the surface folds more sharply there than its
/// thickness allows.
fn mark_slides(facets: &[Facet], found: &mut [FacetTouch]) {
    for k in 0..found.len() {
        let touch = found[k];
        let is_beside = |other: &FacetTouch| {
            let names = &facets[other.facet].names;
            !other.counts && other.gap < 0.0 && facets[touch.facet].names.iter().any(|name| names.contains(name))
        };
        let slides_in = touch.counts && touch.gap < 0.0 && found.iter().any(is_beside);
        found[k].inset = if slides_in { -touch.gap } else { 0.0 };
    }
}

/// For a nearest point on a rim, sums the normals of the facets that meet there.
fn face_from_rims(facets: &[Facet], found: &mut [FacetTouch]) {
    /// Cosine below which the sum of normals is rounding: the normals of joined sheets cancel.
    const TELLS: f64 = 1e-4;
    for k in 0..found.len() {
        let touch = found[k];
        let [Some(a), b] = touch.rim else { continue };
        let distance = |touch: &FacetTouch| touch.gap + facets[touch.facet].half;
        let own = distance(&touch);
        let meets = |other: &&FacetTouch| {
            let has = |corner: usize| facets[other.facet].names.contains(&corner);
            has(a) && b.is_none_or(has) && (distance(other) - own).abs() <= 1e-9 * own.abs()
        };
        let count = found.iter().filter(meets).count();
        let facing: Vec3 = found.iter().filter(meets).map(|other| other.normal).sum();
        let tells = touch.toward.dot(&facing).abs() > TELLS * facing.norm();
        let is_joint = b.is_some() && count > 2;
        found[k].facing = if tells && !is_joint { Facing::Rim(facing) } else { Facing::Nothing };
    }
}

/// Marks facets with a neighbour that is nearer at the same place of the rim.
fn keep_minima(facets: &[Facet], found: &mut [FacetTouch]) {
    for k in 0..found.len() {
        let [Some(a), b] = found[k].rim else { continue };
        let reach = |touch: &FacetTouch| touch.gap + facets[touch.facet].half;
        let (own, own_reach) = (found[k].facet, reach(&found[k]));
        let has = |facet: &Facet, corner: usize| facet.names.contains(&corner);
        let is_nearer = |other: &FacetTouch| {
            let facet = &facets[other.facet];
            other.facet != own
                && has(facet, a)
                && b.is_none_or(|b| has(facet, b))
                && reach(other) < own_reach - 1e-12 * own_reach.abs()
        };
        if found.iter().any(is_nearer) {
            found[k].counts = false;
        }
    }
}

/// Gives each facet found the slot of its memory, or of the neighbour with the point's last contact.
fn match_memory(of: &FacetScene, e: usize, nodes: &[Node], history: &[f64], found: &mut [FacetTouch]) {
    for slot in 0..of.slots {
        let memory = of.memory(history, slot);
        match memory.is_known() {
            false if of.is_of_balls => break,
            false => continue,
            true => {}
        }
        if let Some(touch) = found.iter_mut().find(|touch| touch.facet == memory.facet()) {
            touch.slot = Some(slot);
        }
    }
    if of.is_of_balls || found.iter().all(|touch| touch.slot.is_some()) {
        return;
    }
    let (x, origin) = seen(of, e, nodes);
    for slot in 0..of.slots {
        let memory = of.memory(history, slot);
        if !memory.is_known() || found.iter().any(|touch| touch.slot == Some(slot)) {
            continue;
        }
        let facet = &of.facets[memory.facet()];
        let share = of.share(e, facet, nodes);
        let nearest = share.map(|_| of.point_at(e, share).relative_position(origin, nodes));
        let p = facet.seen_from(nearest.as_ref().unwrap_or(&x), origin, nodes);
        let at = facet.closest(&p);
        let normal = match of.is_of_lines {
            // Beyond its end the way to the nearest point leads along the line too.
            true => facet.across(&at.g, &p),
            false => facet.facing(&at, &p),
        };
        let likeness = |touch: &FacetTouch| touch.normal.dot(&normal);
        // Only the same side continues: a point between two parallel layers is above one and below the other. If the point has come through
        // nearly to the middle, rounding decides the side on the next facet.
        let is_deep = memory.gap() < -0.5 * (facet.half + of.points[e].radius);
        let same_side = |touch: &FacetTouch| !facet.has_sides() || is_deep || memory.side() * touch.height() >= 0.0;
        let goes_on = |touch: &&mut FacetTouch| {
            touch.slot.is_none() && likeness(touch) > NEIGHBOURS && same_side(touch) && is_close(of, e, touch, &at.g)
        };
        let best = found.iter_mut().filter(goes_on).max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
        if let Some(touch) = best {
            touch.slot = Some(slot);
        }
    }
}

/// Gives each line contact without a memory the memory of a neighbouring line, if the nearest point has passed their common node. `history`
/// is that of the block.
pub(super) fn take_over(of: &FacetScene, e: usize, nodes: &[Node], history: &[f64], found: &mut [FacetTouch]) {
    // Where edges end nothing of them presses any more.
    if !of.is_of_lines || of.is_of_edges {
        return;
    }
    for touch in found.iter_mut().filter(|touch| touch.slot.is_none()) {
        let facet = &of.facets[touch.facet];
        let remembers = |(line, slot): &(usize, usize)| {
            let memory = of.memory(of.of_point(*line, history), *slot);
            let meets = || facet.nodes().iter().any(|node| of.facets[memory.facet()].nodes().contains(node));
            memory.is_known() && (memory.facet() == touch.facet || meets())
        };
        let ends = of.points[e].nodes().iter().copied();
        let left = ends.flat_map(|node| of.lines_at(node).map(move |line| (line, node))).filter(|&(line, node)| {
            let end = usize::from(of.points[line].nodes[1] == node);
            line != e && of.share(line, facet, nodes).and_then(end_at) == Some(end)
        });
        let mut places = left.flat_map(|(line, _)| (0..of.slots).map(move |slot| (line, slot))).filter(remembers);
        let first = places.next();
        let is_same =
            |(line, slot): &(usize, usize)| of.memory(of.of_point(*line, history), *slot).facet() == touch.facet;
        touch.from = match first {
            Some(place) if !is_same(&place) => places.find(is_same).or(first),
            _ => first,
        };
    }
}

/// True where the point, at `g` from the middle of its last facet, is within about one facet size of it.
fn is_close(of: &FacetScene, e: usize, touch: &FacetTouch, g: &Vec3) -> bool {
    let reach = of.facets[touch.facet].half + of.points[e].radius;
    g.norm() < touch.gap.abs() + 2.0 * reach + 4.0 * of.margin
}

/// The first place of memory that no touch has.
pub(super) fn free_slot(slots: usize, found: &[FacetTouch], history: impl Fn(usize) -> bool) -> Option<usize> {
    let is_free = |slot: &usize| found.iter().all(|touch| touch.slot != Some(*slot));
    (0..slots).filter(is_free).find(|&slot| !history(slot)).or_else(|| (0..slots).find(is_free))
}
