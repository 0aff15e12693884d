//! The history of pairs at the end of a step, and the energy dissipated in it.

use super::balls;
use super::found::{FacetTouch, TouchQuery};
use super::line_friction;
use super::pair::{FacetPair, PairForceOnPoint, PairPlace, Rub, rotation_of};
use super::surface::FacetContacts;
use super::touch;
use crate::elements::contact::history::{PairMemory, PairMemoryMut};
use crate::elements::contact::normal_motion::{
    NormalMotion, damping_power, let_go, lost, slip_begin, update_normal, update_slip, way,
};
use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::rotation::{exp, matrix, renormalise};
use base::math::{Mat3, Vec3};
use nalgebra::Quaternion;

/// Writes the history of all points after `part` of the way from the last state to `now`.
pub(super) fn update(of: &FacetContacts, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
    let mut spent = Dissipation::default();
    let mut nearby = of.nearby(now.nodes);
    let mut found = std::mem::take(&mut nearby.touches);
    let width = of.slots * of.width;
    for e in 0..of.points.len() {
        let old = of.of_point(e, now.history);
        let near = nearby.of(e);
        found.clear();
        if !near.is_empty() && !nearby.is_clear(e, of.margin) {
            touch::find(of, near, TouchQuery { e, limit: of.margin, stays: false }, now.nodes, old, &mut found);
            touch::take_over(of, e, now.nodes, now.history, &mut found);
        }
        if of.is_of_balls {
            spent += update_balls(of, e, now, part, &mut found, new);
            continue;
        }
        let new = &mut new[e * width..(e + 1) * width];
        spent += forget(of, part * now.dt, &found, old);
        new.fill(0.0);
        let is_taken = |slot: usize| of.memory(old, slot).is_known();
        for k in 0..found.len() {
            let slot = found[k].slot.or_else(|| touch::free_slot(of.slots, &found, is_taken));
            let Some(slot) = slot else { continue };
            let pair = of.pair(e, &found[k], now.history);
            if let Some((line, from)) = found[k].from {
                // The neighbour, which forgets it, counts it as lost.
                let lost = lost(&of.law, of.memory(of.of_point(line, now.history), from), part * now.dt);
                spent.friction -= lost.friction;
                spent.impact -= lost.impact;
            }
            // Only now, for the pair would take what another left there for its own.
            found[k].slot = Some(slot);
            let numbers = &mut new[slot * of.width..(slot + 1) * of.width];
            spent += update_pair(of, &pair, &found[k], now, part, &mut PairMemoryMut(numbers));
        }
    }
    nearby.touches = found;
    spent
}

/// Writes the history of a ball among balls.
fn update_balls(
    of: &FacetContacts,
    e: usize,
    now: &Configuration,
    part: f64,
    found: &mut Vec<FacetTouch>,
    new: &mut [f64],
) -> Dissipation {
    let old = of.of_point(e, now.history);
    let motion = |touch: &FacetTouch| touch.slot.map(|slot| of.memory(old, slot));
    found.retain(|touch| balls::is_memorable(of, e, touch, now, motion(touch)));
    let mut spent = forget(of, part * now.dt, found, old);
    balls::clear(of, e, new);
    for (slot, touch) in found.iter().enumerate() {
        let (pair, place) = (of.pair(e, touch, now.history), balls::place(of, e, slot));
        spent += update_pair(of, &pair, touch, now, part, &mut PairMemoryMut(&mut new[place]));
    }
    spent
}

/// Energy lost by forgotten pairs.
fn forget(of: &FacetContacts, way: f64, found: &[FacetTouch], old: &[f64]) -> Dissipation {
    let mut spent = Dissipation::default();
    for slot in 0..of.slots {
        let memory = of.memory(old, slot);
        match memory.is_known() {
            true if found.iter().all(|touch| touch.slot != Some(slot)) => spent += lost(&of.law, memory, way),
            false if of.is_of_balls => break,
            _ => {}
        }
    }
    spent
}

fn update_pair(
    of: &FacetContacts,
    pair: &FacetPair,
    touch: &FacetTouch,
    now: &Configuration,
    part: f64,
    new: &mut PairMemoryMut,
) -> Dissipation {
    let place = pair.place(now.nodes);
    let old = pair.memory.unwrap_or(PairMemory::NOTHING);
    let acting = (place.gap() <= of.law.touching).then(|| pair.force(&place, now.nodes));
    let force = acting.as_ref().map_or(0.0, |acting| acting.normal.force);
    let (gap, rate) = (place.gap(), place.rate());
    let less = acting.as_ref().and_then(|acting| acting.less.as_ref()).map_or(0.0, |end| end.power);
    let power = damping_power(&of.law, gap, rate, force) - less;
    let motion = NormalMotion { gap, inset: place.inset_left(), rate, power, speed: place.w.norm() };
    let (impact, inset) = update_normal(&of.law, &motion, now, part, old, new);
    let mut spent = Dissipation { impact, ..Dissipation::default() };
    new.set_facet(touch.facet, place.side);
    new.set_inset(&of.law, inset);
    if of.law.friction > 0.0 {
        spent.friction = update_friction(of, pair, (&place, acting.as_ref()), now, part, new);
    }
    spent
}

/// Writes the anchor, its force and the reference rotations for rolling; returns the dissipation of slip.
fn update_friction(
    of: &FacetContacts,
    pair: &FacetPair,
    (place, acting): (&PairPlace, Option<&PairForceOnPoint>),
    now: &Configuration,
    part: f64,
    new: &mut PairMemoryMut,
) -> f64 {
    if pair.is_of_lines() {
        return update_friction_of_lines(of, pair, (place, acting), now, part, new);
    }
    let (q, n) = (rotation_of(pair.facet, now.nodes), &place.n);
    // The point and the anchor stand in global axes from the first node of the facet on which the point is now.
    let x = pair.seen_from(pair.facet, &place.x, now.nodes);
    let Some(memory) = pair.memory else {
        let pull = begin(of, pair, place, acting, now, new);
        new.set_anchor(&pair.facet.components(&(x - pull / of.law.stiffness), now.nodes));
        for i in 0..rotations(of, pair) {
            new.set_rotation(i, &(q.conjugate() * now.nodes[pair.point.nodes[i]].rotation));
        }
        return 0.0;
    };
    let part = way(memory, part);
    let old_q = rotation_of(pair.kept, now.nodes);
    let old_R = matrix(&old_q);
    let friction = acting.and_then(|acting| acting.friction.as_ref());
    let moved = now.nodes[pair.kept.nodes[0]].relative_position(&now.nodes[pair.facet.nodes[0]]);
    let mut anchor = moved + pair.kept.base(now.nodes) * memory.anchor();
    // The anchor of a point that is free goes along.
    anchor += part * friction.map_or(x - anchor, |friction| friction.slip + n.dot(&(x - anchor)) * n);
    let spent = rubbed(of, friction, memory, (now.dt, part), new);
    for i in 0..rotations(of, pair) {
        let phi = pair.turned(i, memory, (&old_q, &old_R), now.nodes);
        if friction.is_some() {
            anchor += part * pair.point.weights[i] * pair.point.rolling_radius * phi.cross(n);
        }
        let kept = kept_rotation((&old_q, &old_R), &q, part * phi, &memory.rotation(i));
        new.set_rotation(i, &kept);
    }
    new.set_anchor(&pair.facet.components(&anchor, now.nodes));
    spent
}

/// Writes the friction force and the slip speed; returns what slip dissipated. If the two are apart, the friction spring is released.
fn rubbed(
    of: &FacetContacts,
    friction: Option<&Rub>,
    memory: PairMemory,
    step: (f64, f64),
    new: &mut PairMemoryMut,
) -> f64 {
    let Some(friction) = friction else { return let_go(&of.law, memory) };
    let slipped = [friction.T.norm(), friction.slip.norm(), slip_begin(&of.law, memory)];
    update_slip(slipped, step, memory, new)
}

/// Writes the friction of two lines.
fn update_friction_of_lines(
    of: &FacetContacts,
    pair: &FacetPair,
    (place, acting): (&PairPlace, Option<&PairForceOnPoint>),
    now: &Configuration,
    part: f64,
    new: &mut PairMemoryMut,
) -> f64 {
    let friction = acting.and_then(|acting| acting.friction.as_ref());
    line_friction::remember(pair, now, part, new);
    // The friction spring of two lines apart is released at once.
    let (pull, way, spent) = match (pair.memory, friction) {
        (None, _) => (begin(of, pair, place, acting, now, new), 1.0, 0.0),
        (Some(memory), friction) => {
            let spent = rubbed(of, friction, memory, (now.dt, part), new);
            friction.map_or((Vec3::zeros(), 1.0, spent), |friction| (friction.T, part, spent))
        }
    };
    line_friction::remember_stretch(pair, place, (&(pull / of.law.stiffness), way), now.nodes, new);
    spent
}

/// Writes the initial friction of a pair without memory: see [`ContactLaw::begun`]. Returns its force.
fn begin(
    of: &FacetContacts,
    pair: &FacetPair,
    place: &PairPlace,
    acting: Option<&PairForceOnPoint>,
    now: &Configuration,
    new: &mut PairMemoryMut,
) -> Vec3 {
    let force = acting.map_or(0.0, PairForceOnPoint::pressed);
    if now.dt > 0.0 || force <= 0.0 {
        return Vec3::zeros();
    }
    let (pull, slip_speed) = of.law.begun(force, &slip_rate(pair, place, now));
    new.set_friction_force(pull.norm());
    new.set_slip_speed(slip_speed);
    pull
}

/// Number of rotations that are kept.
fn rotations(of: &FacetContacts, pair: &FacetPair) -> usize {
    if of.rolls { pair.point.count } else { 0 }
}

/// A rotation relative to the frame of one facet, turned on by `phi` (global), relative to that of another.
fn kept_rotation(
    (old_q, old_R): (&Quaternion<f64>, &Mat3),
    q: &Quaternion<f64>,
    phi: Vec3,
    kept: &Quaternion<f64>,
) -> Quaternion<f64> {
    let on = exp(&old_R.tr_mul(&phi)) * kept;
    renormalise(&(q.conjugate() * old_q * on))
}

/// The velocity of the slip.
fn slip_rate(pair: &FacetPair, place: &PairPlace, now: &Configuration) -> Vec3 {
    let (n, r) = (&place.n, pair.point.rolling_radius);
    let spin: Vec3 = pair.point.parts().map(|(node, w)| w * now.nodes[node].omega).sum();
    let of_facet = match pair.facet.has_sides() {
        true => Vec3::zeros(),
        false => pair.facet.nodes().iter().zip(place.W).map(|(&node, w)| w * now.nodes[node].omega).sum(),
    };
    let w = place.w - of_facet.cross(&(place.d * n));
    w - n.dot(&w) * n - r * (spin - of_facet).cross(n)
}
