//! The history of a point at the end of a step, and the energy dissipated in it.

use super::force::{ContactForce, contact_force};
use super::history::{PairMemory, PairMemoryMut};
use super::kinematics::{ContactKinematics, Contacts};
use super::normal_motion::{
    NormalMotion, damping_power, let_go, pass_over, slip_begin, update_normal, update_slip, way,
};
use super::point::ContactPoint;
use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::Vec3;
use base::math::rotation::{self, renormalise};

/// Writes the history of point `e` after `part` of the way from the last state to `now`; returns the dissipation.
pub(super) fn update_point(
    contacts: &Contacts,
    e: usize,
    now: &Configuration,
    part: f64,
    new: &mut PairMemoryMut,
) -> Dissipation {
    let (law, point, old) = (&contacts.law, &contacts.points[e], contacts.memory(e, now.history));
    let (d, w) = contacts.relative(point, now.nodes);
    let speed = w.norm();
    let distance = contacts.least_distance(&d, now.nodes) - point.radius;
    if let Some(spent) = pass_over(law, (distance, speed), now, old, new) {
        return spent;
    }
    let mut at = contacts.kinematics(point, now.nodes);
    at.gap += contacts.inset(old);
    let touches = at.gap - old.lift(law) <= law.touching && !contacts.is_idle(old);
    let acting = touches.then(|| contact_force(contacts, point, &at, old, now.nodes));
    let force = acting.as_ref().map_or(0.0, |acting| acting.normal.force);
    let power = if touches { damping_power(law, at.gap, at.rate(), force) } else { 0.0 };
    let motion = NormalMotion { gap: at.gap, inset: contacts.inset(old), rate: at.rate(), power, speed };
    let (impact, inset) = update_normal(law, &motion, now, part, old, new);
    let mut spent = Dissipation { impact, ..Dissipation::default() };
    if contacts.is_idle(old) {
        // The node goes in without a force, and so without losses.
        spent.impact = 0.0;
        new.set_damping_power(0.0);
    }
    contacts.remember_inset(&at, inset, now, old, new);
    // The multiplier stays that of the equilibrium, in which it gives the force at the present gap; the next step starts from it.
    new.set_lift(law, old.lift(law));
    if law.friction > 0.0 {
        spent.friction = update_friction(contacts, point, (&at, acting.as_ref()), now, way(old, part), old, new);
    }
    spent
}

/// Writes the anchor, its force and the reference rotations for rolling; returns the dissipation of slip.
fn update_friction(
    contacts: &Contacts,
    point: &ContactPoint,
    (at, acting): (&ContactKinematics, Option<&ContactForce>),
    now: &Configuration,
    part: f64,
    old: PairMemory,
    new: &mut PairMemoryMut,
) -> f64 {
    let law = &contacts.law;
    let (p, n, held) = (&at.p, &at.closest.n, old.anchor());
    let mut anchor = held;
    let friction = acting.and_then(|acting| acting.friction.as_ref());
    let spent = match friction {
        Some(friction) => {
            anchor += part * friction.slip + part * n.dot(&(p - held)) * n;
            let slipped = [friction.T.norm(), friction.slip.norm(), slip_begin(law, old)];
            update_slip(slipped, (now.dt, part), old, new)
        }
        // The point is free: the anchor moves with it, and the friction spring is released.
        None => {
            let force = acting.map_or(0.0, |acting| acting.normal.force);
            let starts = !old.is_known() && now.dt <= 0.0 && force != 0.0;
            let slip = if starts { slip_rate(contacts, point, at, now) } else { Vec3::zeros() };
            let (pull, speed) = law.begun(force, &slip);
            new.set_friction_force(pull.norm());
            new.set_slip_speed(speed);
            anchor += part * (p - held) - pull / law.stiffness;
            let_go(law, old)
        }
    };
    if contacts.rolls {
        let rolled = friction.is_some().then_some((n, &mut anchor));
        update_rotations(contacts, point, rolled, now, part, old, new);
    }
    new.set_anchor(&anchor);
    spent
}

/// Writes the reference rotations for rolling. Where friction acts, the way rolled so far moves from the rotations to the anchor: `rolled`
/// are the normal and the anchor.
fn update_rotations(
    contacts: &Contacts,
    point: &ContactPoint,
    mut rolled: Option<(&Vec3, &mut Vec3)>,
    now: &Configuration,
    part: f64,
    old: PairMemory,
    new: &mut PairMemoryMut,
) {
    for k in 0..contacts.count {
        let present = contacts.relative_rotation(point.nodes[k], now.nodes);
        if !old.is_known() {
            new.set_rotation(k, &present);
            continue;
        }
        let phi = contacts.rotation_since(point, k, old, now.nodes);
        if let Some((n, anchor)) = &mut rolled {
            **anchor += part * point.weights[k] * point.rolling_radius * phi.cross(n);
        }
        new.set_rotation(k, &renormalise(&(rotation::exp(&(part * phi)) * old.rotation(k))));
    }
}

/// The velocity of the slip, in the frame of the surface.
fn slip_rate(contacts: &Contacts, point: &ContactPoint, at: &ContactKinematics, now: &Configuration) -> Vec3 {
    let n = &at.closest.n;
    let spin: Vec3 = point.parts().map(|(node, weight)| weight * now.nodes[node].omega).sum();
    let spin = at.R.tr_mul(&(spin - now.nodes[contacts.carrier].omega));
    let w = at.R.tr_mul(&at.w);
    w - n.dot(&w) * n - point.rolling_radius * spin.cross(n)
}
