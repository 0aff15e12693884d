//! The history of a point at the end of a step, and what was dissipated on the way.

use super::force::{ContactForce, contact_force};
use super::history::{self, PointHistory, PointHistoryMut};
use super::kinematics::{ContactKinematics, Contacts};
use super::point::ContactPoint;
use crate::materials::Dissipation;
use crate::math::Vec3;
use crate::math::rotation::{self, renormalise};
use crate::state::Configuration;

/// Writes the history of point `e` after `part` of the way from the last state to `now`; returns what was dissipated.
pub(super) fn update_point(
    contacts: &Contacts,
    e: usize,
    now: &Configuration,
    part: f64,
    new: &mut PointHistoryMut,
) -> Dissipation {
    let (law, point, old) = (&contacts.law, &contacts.points[e], history::of(contacts, e, now.history));
    let mut spent = Dissipation::default();
    let dt = part * now.dt;
    let (d, w) = contacts.relative(point, now.nodes);
    let speed = w.norm();
    // The point could reach the surface in this time at twice its speed.
    let safe = |gap: f64| if law.dynamic && gap > law.near { 0.5 * gap / speed } else { 0.0 };
    let far = safe(d.norm() - contacts.reach() - point.radius);
    if far > 4.0 * now.dt && now.dt > 0.0 && old.impact_speed() == 0.0 {
        new.set_far(far);
        let pull = if law.friction > 0.0 { old.friction_force() } else { 0.0 };
        spent.friction = 0.5 * pull * pull / law.stiffness;
        return spent;
    }
    let known = old.is_known();
    // A point that is not known has no last state to come from.
    let beyond = (part - 1.0) * now.dt;
    let part = if known { part } else { 1.0 };
    let toward = |old: f64, now: f64| old + part * (now - old);
    let at = contacts.kinematics(point, now.nodes);
    let (gap, rate) = (at.gap, at.rate());
    let acting = (gap <= 0.0).then(|| contact_force(contacts, point, &at, old, now.nodes));
    let force = acting.as_ref().map_or(0.0, |acting| acting.normal.force);
    let end_gap = if known { toward(old.gap(), gap) } else { gap - rate * beyond };
    new.set_motion(end_gap, toward(old.rate(), rate), safe(end_gap));
    new.set_impact(impact(law.duration, (gap, rate), dt, old, new.read()));
    let power = if gap < 0.0 { (force + law.stiffness * gap) * rate } else { 0.0 };
    new.set_damping_power(toward(old.damping_power(), power));
    spent.impact = 0.5 * dt * (old.damping_power() + new.read().damping_power());
    if law.friction > 0.0 {
        spent.friction = update_friction(contacts, point, (&at, acting.as_ref()), now, part, old, new);
    }
    spent
}

/// The impact speed and the age to come. `gap` and `rate` are those at the instant of equilibrium; `new` has those at the end
/// of the step.
pub(super) fn impact(
    duration: f64,
    (gap, rate): (f64, f64),
    dt: f64,
    old: PointHistory,
    new: PointHistory,
) -> (f64, f64) {
    let known = old.is_known();
    let touches = new.gap() <= 0.0;
    let touched = known && old.gap() <= 0.0;
    match (touches, touched) {
        // The speed is that of the approach where the gap closed, on a straight line.
        (true, false) if known => {
            let closed = old.gap() / (old.gap() - gap);
            ((old.rate() + closed * (rate - old.rate())).max(0.0), 0.0)
        }
        (true, false) => (rate.max(0.0), 0.0),
        // The point is faster than at the landing where something presses.
        (true, true) => (old.impact_speed().max(new.rate()), old.age() + dt),
        (false, true) => (old.impact_speed(), 0.0),
        // The point touched at the instant of equilibrium: the acceleration of that is carried on.
        (false, false) if gap <= 0.0 => (old.rate().max(rate).max(0.0), 0.0),
        // The impact is over for good once the acceleration it leaves to the scheme is gone.
        (false, false) if old.age() + dt < duration => (old.impact_speed(), old.age() + dt),
        (false, false) => (0.0, 0.0),
    }
}

/// Writes the anchor, the force on it and the rotations from which the nodes roll; returns what slip dissipated.
fn update_friction(
    contacts: &Contacts,
    point: &ContactPoint,
    (at, acting): (&ContactKinematics, Option<&ContactForce>),
    now: &Configuration,
    part: f64,
    old: PointHistory,
    new: &mut PointHistoryMut,
) -> f64 {
    let law = &contacts.law;
    let force = acting.map_or(0.0, |acting| acting.normal.force);
    let friction = acting.and_then(|acting| acting.friction.as_ref());
    let (p, n) = (&at.p, &at.closest.n);
    let (pull, held) = (old.friction_force(), old.anchor());
    // A point that slides at t = 0 has been sliding: its spring is stretched.
    let starts = !old.is_known() && now.dt <= 0.0 && force != 0.0;
    let begun = if starts { sliding_direction(contacts, point, at, now) } else { Vec3::zeros() };
    let stretch = law.friction * force;
    let (shift, spent) = match friction {
        Some(friction) => {
            let end = pull + part * (friction.T.norm() - pull);
            new.set_friction_force(end);
            (friction.slip, 0.5 * part * friction.slip.norm() * (pull + end))
        }
        // The point is free: the anchor goes along, and what was stretched lets go.
        None => {
            new.set_friction_force(stretch * begun.norm());
            (p - held, 0.5 * pull * (pull / law.stiffness))
        }
    };
    let mut anchor = held + part * shift - stretch / law.stiffness * begun;
    if friction.is_some() {
        anchor += part * n.dot(&(p - held)) * n;
    }
    if contacts.rolls {
        let rolled = friction.is_some().then_some((n, &mut anchor));
        update_rotations(contacts, point, rolled, now, part, old, new);
    }
    new.set_anchor(&anchor);
    spent
}

/// Writes the rotations from which the nodes roll. Where friction acts, the way rolled so far moves from the rotations to the
/// anchor: `rolled` are the normal and the anchor.
fn update_rotations(
    contacts: &Contacts,
    point: &ContactPoint,
    mut rolled: Option<(&Vec3, &mut Vec3)>,
    now: &Configuration,
    part: f64,
    old: PointHistory,
    new: &mut PointHistoryMut,
) {
    for k in 0..contacts.count {
        let present = contacts.relative_rotation(point.nodes[k], now.nodes);
        if !old.is_known() {
            new.set_rotation(k, &present);
            continue;
        }
        let phi = history::rotation_since(contacts, point, k, old, now.nodes);
        if let Some((n, anchor)) = &mut rolled {
            **anchor += part * point.weights[k] * point.rolling_radius * phi.cross(n);
        }
        new.set_rotation(k, &renormalise(&(rotation::exp(&(part * phi)) * old.rotation(k))));
    }
}

/// Unit vector along the slip, in the frame of the surface; zero for what does not slip faster than its weight makes it.
fn sliding_direction(contacts: &Contacts, point: &ContactPoint, at: &ContactKinematics, now: &Configuration) -> Vec3 {
    let n = &at.closest.n;
    let spin: Vec3 = point.parts().map(|(node, weight)| weight * now.nodes[node].omega).sum();
    let spin = at.R.tr_mul(&(spin - now.nodes[contacts.carrier].omega));
    let w = at.R.tr_mul(&at.w);
    let slip = w - n.dot(&w) * n - point.rolling_radius * spin.cross(n);
    let speed = slip.norm();
    if speed > contacts.law.floor { slip / speed } else { Vec3::zeros() }
}
