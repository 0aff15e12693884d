//! The memory of a pair: a typed view of its numbers in [`crate::state::State::history`]. All pairs of a block have equally many: the
//! normal motion, then friction if any, with the numbers specific to the kind of pair last.

use super::law::ContactLaw;
use base::math::Vec3;
use nalgebra::Quaternion;

const SAFE_TIME: usize = 0;
const IS_KNOWN: usize = 1;
const GAP: usize = 2;
const RATE: usize = 3;
const IMPACT_SPEED: usize = 4;
const AGE: usize = 5;
const DAMPING_POWER: usize = 6;
/// The inset, or the lift where there are multipliers.
const SHIFT: usize = 7;
const KEY: usize = 8;
/// First index of friction.
pub(super) const FRICTION_FORCE: usize = 9;
const SLIP_SPEED: usize = 10;
/// First index of the numbers of friction specific to the kind of pair.
pub(super) const OWN: usize = 11;
/// First index of the rotations of a point's nodes (four numbers each), after its anchor.
const ROTATIONS: usize = OWN + 3;

/// Number of history variables of a pair; `own` of them are specific to its kind.
pub(super) fn width(law: &ContactLaw, own: usize) -> usize {
    if law.friction > 0.0 { OWN + own } else { FRICTION_FORCE }
}

/// Number of history variables specific to the friction of a point, with `rotations` stored rotations.
pub(super) fn of_points(rotations: usize) -> usize {
    ROTATIONS - OWN + 4 * rotations
}

/// The memory of one pair.
#[derive(Clone, Copy)]
pub struct PairMemory<'a>(pub(super) &'a [f64]);

/// The memory of one pair, to be written.
pub(super) struct PairMemoryMut<'a>(pub &'a mut [f64]);

/// Makes the reading and the writing of each number.
macro_rules! numbers {
    ($($(#[$about:meta])* $at:ident: $get:ident, $set:ident;)+) => {
        impl PairMemory<'_> {
            $($(#[$about])* #[inline] pub fn $get(self) -> f64 { self.0[$at] })+
        }

        impl PairMemoryMut<'_> {
            $($(#[$about])* pub fn $set(&mut self, number: f64) { self.0[$at] = number; })+
        }
    };
}

numbers! {
    /// Time after the last state before which the two cannot meet and are not looked at.
    SAFE_TIME: safe_time, set_safe_time;
    /// Gap, negative inside.
    GAP: gap, set_gap;
    /// Approach speed δ̇.
    RATE: rate, set_rate;
    /// Approach speed at the start of the impact; 0 again some time after separation.
    IMPACT_SPEED: impact_speed, set_impact_speed;
    /// Time since the two came into contact or separated.
    AGE: age, set_age;
    /// Power dissipated by the damping of the impact.
    DAMPING_POWER: damping_power, set_damping_power;
    /// Key of the touched body or facet, where it changes.
    KEY: key, set_key;
    /// |T|. With friction alone.
    FRICTION_FORCE: friction_force, set_friction_force;
    /// The slip speed of the step before the last state; with friction alone.
    SLIP_SPEED: slip_speed, set_slip_speed;
}

impl PairMemory<'_> {
    /// The memory of an unknown pair.
    pub(super) const NOTHING: PairMemory<'static> = PairMemory(&[0.0; 64]);

    /// False where the last state did not look at the pair: then only the safe time means anything.
    #[inline]
    pub fn is_known(self) -> bool {
        self.0[IS_KNOWN] > 0.0
    }

    /// Depth of the normal spring at zero gap: the multiplier over the stiffness. 0 without multipliers.
    #[inline]
    pub fn lift(self, law: &ContactLaw) -> f64 {
        if law.tolerance.is_some() { self.0[SHIFT] } else { 0.0 }
    }

    /// The starting depth of the normal spring; negative for a pair without force at any depth.
    #[inline]
    pub fn inset(self, law: &ContactLaw) -> f64 {
        if law.tolerance.is_some() { 0.0 } else { self.0[SHIFT] }
    }

    /// Position of the anchor of a point's friction spring, in its storage frame.
    #[inline]
    pub fn anchor(self) -> Vec3 {
        Vec3::from_column_slice(&self.0[OWN..ROTATIONS])
    }

    /// Rotation of the k-th node of a point relative to that frame. Where friction turns nodes.
    #[inline]
    pub fn rotation(self, k: usize) -> Quaternion<f64> {
        let q = &self.0[ROTATIONS + 4 * k..];
        Quaternion::new(q[0], q[1], q[2], q[3])
    }
}

impl PairMemoryMut<'_> {
    /// A read-only view.
    pub fn read(&self) -> PairMemory<'_> {
        PairMemory(self.0)
    }

    /// Forgets everything except that the two are far for a while.
    pub fn set_far(&mut self, safe_time: f64) {
        self.0.fill(0.0);
        self.0[SAFE_TIME] = safe_time;
    }

    /// The motion along the normal, which is then known.
    pub fn set_motion(&mut self, gap: f64, rate: f64, safe_time: f64) {
        self.0[IS_KNOWN] = 1.0;
        self.set_gap(gap);
        self.set_rate(rate);
        self.set_safe_time(safe_time);
    }

    /// Sets the depth of the normal spring at zero gap, if there are multipliers.
    pub fn set_lift(&mut self, law: &ContactLaw, lift: f64) {
        if law.tolerance.is_some() {
            self.0[SHIFT] = lift;
        }
    }

    /// Sets the starting depth of the normal spring, without multipliers.
    pub fn set_inset(&mut self, law: &ContactLaw, inset: f64) {
        if law.tolerance.is_none() {
            self.0[SHIFT] = inset;
        }
    }

    /// Sets the anchor of a point.
    pub fn set_anchor(&mut self, anchor: &Vec3) {
        self.0[OWN..ROTATIONS].copy_from_slice(anchor.as_slice());
    }

    /// Sets the rotation of the k-th node of a point.
    pub fn set_rotation(&mut self, k: usize, q: &Quaternion<f64>) {
        self.0[ROTATIONS + 4 * k..ROTATIONS + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
}
