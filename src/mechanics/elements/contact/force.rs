//! The forces on a point in contact: normal and friction force.

use super::friction::{FrictionForce, friction_force};
use super::history::PairMemory;
use super::kinematics::{ContactKinematics, Contacts};
use super::point::ContactPoint;
use super::restitution::NormalForce;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// The forces on a point, in the frame of the surface.
pub(super) struct ContactForce {
    /// The normal force with its derivatives.
    pub normal: NormalForce,
    /// `None`: there is no friction, or the point was not looked at in the last state.
    pub friction: Option<FrictionForce>,
    /// Force on the point.
    pub F: Vec3,
    /// Moment on the point.
    pub M: Vec3,
}

/// The force on a point that lies at `at`.
pub(super) fn contact_force(
    contacts: &Contacts,
    point: &ContactPoint,
    at: &ContactKinematics,
    old: PairMemory,
    nodes: &[Node],
) -> ContactForce {
    let (law, n) = (&contacts.law, &at.closest.n);
    let normal = law.press((old.lift(law) - at.gap).max(0.0), contacts.inset(old), at.rate(), old);
    if law.friction == 0.0 || !old.is_known() {
        return ContactForce { normal, friction: None, F: normal.force * n, M: Vec3::zeros() };
    }
    let mut phi = Vec3::zeros();
    if point.rolling_radius > 0.0 {
        for k in 0..contacts.count {
            phi += point.weights[k] * contacts.rotation_since(point, k, old, nodes);
        }
    }
    let from_anchor = at.p - old.anchor();
    let friction = friction_force(
        law.stiffness,
        law.friction_at(old.slip_speed()),
        normal.force,
        &at.closest,
        &from_anchor,
        point.rolling_radius,
        &phi,
    );
    ContactForce {
        normal,
        F: normal.force * n - friction.T,
        M: point.rolling_radius * n.cross(&friction.T),
        friction: Some(friction),
    }
}

/// The kinematics of point `e` and the forces on it; `None` where it is not in contact or known to be far.
#[inline]
pub(super) fn touch(contacts: &Contacts, e: usize, now: &Configuration) -> Option<(ContactKinematics, ContactForce)> {
    let old = contacts.memory(e, now.history);
    if now.dt < old.safe_time() {
        return None;
    }
    let mut at = contacts.kinematics(&contacts.points[e], now.nodes);
    if contacts.is_idle(old) {
        return None;
    }
    at.gap += contacts.inset(old);
    // At zero gap there is no force yet, but stiffness.
    if at.gap - old.lift(&contacts.law) > contacts.law.touching {
        return None;
    }
    let force = contact_force(contacts, &contacts.points[e], &at, old, now.nodes);
    Some((at, force))
}
