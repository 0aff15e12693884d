//! The history variables of a point: a typed view of its numbers in [`crate::state::State::history`]. All points of a
//! block have the same count of them: those of the normal force, then those of friction where there is any, then the
//! rotations of the point's nodes where friction turns them, then the multiplier where there is one, or the inset.

use super::kinematics::Contacts;
use super::law::ContactLaw;
use super::point::ContactPoint;
use crate::state::Node;
use base::math::Vec3;
use base::math::rotation::{log, renormalise};
use nalgebra::Quaternion;

const SAFE_TIME: usize = 0;
const IS_KNOWN: usize = 1;
const GAP: usize = 2;
const RATE: usize = 3;
const IMPACT_SPEED: usize = 4;
const AGE: usize = 5;
const DAMPING_POWER: usize = 6;
/// Here friction begins.
pub(super) const FRICTION_FORCE: usize = 7;
const ANCHOR: usize = 8;
const SLIP_SPEED: usize = 11;
/// Here the rotations of nodes begin, four numbers each.
const ROTATIONS: usize = 12;

/// The history of one point.
#[derive(Clone, Copy)]
pub struct PointHistory<'a>(&'a [f64]);

impl<'a> PointHistory<'a> {
    /// A view of a range of the history.
    pub fn new(numbers: &'a [f64]) -> Self {
        PointHistory(numbers)
    }

    /// All of its numbers.
    pub fn numbers(self) -> &'a [f64] {
        self.0
    }

    /// Time after the last state before which the point cannot reach the surface and is not looked at.
    #[inline]
    pub fn safe_time(self) -> f64 {
        self.0[SAFE_TIME]
    }

    /// False where the last state did not look at the point: then only the safe time means anything.
    #[inline]
    pub fn is_known(self) -> bool {
        self.0[IS_KNOWN] > 0.0
    }

    /// Gap, negative inside.
    #[inline]
    pub fn gap(self) -> f64 {
        self.0[GAP]
    }

    /// Approach speed δ̇.
    #[inline]
    pub fn rate(self) -> f64 {
        self.0[RATE]
    }

    /// Approach speed at which the impact began; 0 again some time after separation.
    #[inline]
    pub fn impact_speed(self) -> f64 {
        self.0[IMPACT_SPEED]
    }

    /// Time since the point came into contact or separated.
    #[inline]
    pub fn age(self) -> f64 {
        self.0[AGE]
    }

    /// Power that the damping of the impact takes.
    #[inline]
    pub fn damping_power(self) -> f64 {
        self.0[DAMPING_POWER]
    }

    /// |T|. With friction alone.
    #[inline]
    pub fn friction_force(self) -> f64 {
        self.0[FRICTION_FORCE]
    }

    /// Position of the anchor of the friction spring, in the frame of the surface; with friction alone.
    #[inline]
    pub fn anchor(self) -> Vec3 {
        Vec3::from_column_slice(&self.0[ANCHOR..SLIP_SPEED])
    }

    /// The slip speed of the step before the last state; with friction alone.
    #[inline]
    pub fn slip_speed(self) -> f64 {
        self.0[SLIP_SPEED]
    }

    /// Depth by which the spring of the normal force is pressed in at zero gap: its multiplier over the stiffness. 0 under springs alone.
    #[inline]
    pub fn lift(self, law: &ContactLaw) -> f64 {
        match law.tolerance {
            Some(_) => self.0[self.0.len() - 1],
            None => 0.0,
        }
    }

    /// The depth at which the spring of the normal force begins, where that is remembered; negative where nothing presses whatever the depth.
    #[inline]
    pub fn inset(self, keeps: bool) -> f64 {
        if keeps { self.0[self.0.len() - 1] } else { 0.0 }
    }

    /// Rotation of the k-th node relative to the surface. Where friction turns nodes.
    #[inline]
    pub fn rotation(self, k: usize) -> Quaternion<f64> {
        let q = &self.0[ROTATIONS + 4 * k..];
        Quaternion::new(q[0], q[1], q[2], q[3])
    }
}

/// The history of one point, to be written.
pub(super) struct PointHistoryMut<'a>(&'a mut [f64]);

impl<'a> PointHistoryMut<'a> {
    /// A view of a point's range of the history.
    pub fn new(numbers: &'a mut [f64]) -> Self {
        PointHistoryMut(numbers)
    }

    /// The same numbers, to be read.
    pub fn read(&self) -> PointHistory<'_> {
        PointHistory(self.0)
    }

    /// Forgets everything except that the point is far for a while.
    pub fn set_far(&mut self, safe_time: f64) {
        self.0.fill(0.0);
        self.0[SAFE_TIME] = safe_time;
    }

    /// The motion normal to the surface, which is then known.
    pub fn set_motion(&mut self, gap: f64, rate: f64, safe_time: f64) {
        self.0[IS_KNOWN] = 1.0;
        self.0[GAP] = gap;
        self.0[RATE] = rate;
        self.0[SAFE_TIME] = safe_time;
    }

    /// Sets the impact speed and the age.
    pub fn set_impact(&mut self, (impact_speed, age): (f64, f64)) {
        self.0[IMPACT_SPEED] = impact_speed;
        self.0[AGE] = age;
    }

    /// Sets the power of the damping of the impact.
    pub fn set_damping_power(&mut self, power: f64) {
        self.0[DAMPING_POWER] = power;
    }

    /// Sets the depth by which the spring of the normal force is pressed in at zero gap, where there are multipliers.
    pub fn set_lift(&mut self, law: &ContactLaw, lift: f64) {
        if let (Some(_), Some(last)) = (law.tolerance, self.0.last_mut()) {
            *last = lift;
        }
    }

    /// Sets the depth at which the spring of the normal force begins, where that is remembered.
    pub fn set_inset(&mut self, keeps: bool, inset: f64) {
        if let (true, Some(last)) = (keeps, self.0.last_mut()) {
            *last = inset;
        }
    }

    /// Sets the gap, of what the motion is known of.
    pub fn set_gap(&mut self, gap: f64) {
        self.0[GAP] = gap;
    }

    /// Sets the time after the last state before which the point cannot reach the surface.
    pub fn set_safe_time(&mut self, safe_time: f64) {
        self.0[SAFE_TIME] = safe_time;
    }

    /// Sets |T|.
    pub fn set_friction_force(&mut self, force: f64) {
        self.0[FRICTION_FORCE] = force;
    }

    /// All of its numbers.
    pub fn numbers(&mut self) -> &mut [f64] {
        self.0
    }

    /// Sets the anchor, in the frame of the surface.
    pub fn set_anchor(&mut self, anchor: &Vec3) {
        self.0[ANCHOR..SLIP_SPEED].copy_from_slice(anchor.as_slice());
    }

    /// Sets the slip speed.
    pub fn set_slip_speed(&mut self, slip_speed: f64) {
        self.0[SLIP_SPEED] = slip_speed;
    }

    /// Sets the rotation of the k-th node relative to the surface.
    pub fn set_rotation(&mut self, k: usize, q: &Quaternion<f64>) {
        self.0[ROTATIONS + 4 * k..ROTATIONS + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
}

/// Number of history variables of a point.
pub(super) fn width(contacts: &Contacts) -> usize {
    let of_springs = match (contacts.law.friction > 0.0, contacts.rolls) {
        (false, _) => FRICTION_FORCE,
        (true, false) => ROTATIONS,
        (true, true) => ROTATIONS + 4 * contacts.count,
    };
    of_springs + usize::from(contacts.law.tolerance.is_some() || contacts.keeps_inset())
}

/// The history of point `e` in that of its block, which must not be empty.
#[inline]
pub(super) fn of<'a>(contacts: &Contacts, e: usize, history: &'a [f64]) -> PointHistory<'a> {
    let width = width(contacts);
    PointHistory(&history[e * width..(e + 1) * width])
}

/// The histories of all points in that of their block.
pub(super) fn each<'a>(contacts: &Contacts, history: &'a [f64]) -> impl Iterator<Item = PointHistory<'a>> {
    history.chunks_exact(width(contacts)).map(PointHistory)
}

/// Rotation vector of the k-th node of a point relative to the surface, from the remembered rotation to the present one.
pub(super) fn rotation_since(
    contacts: &Contacts,
    point: &ContactPoint,
    k: usize,
    old: PointHistory,
    nodes: &[Node],
) -> Vec3 {
    log(&renormalise(&(contacts.relative_rotation(point.nodes[k], nodes) * old.rotation(k).conjugate())))
}
