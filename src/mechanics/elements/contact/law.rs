//! The numbers of a contact law.

use super::restitution::Loss;
use base::math::Vec3;

/// The parameters of a contact law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// Penalty stiffness, normal and tangential: force per depth.
    pub stiffness: f64,
    /// Energy loss in impacts.
    pub loss: Loss,
    /// Coulomb's coefficient while the contact sticks.
    pub friction: f64,
    /// Coulomb's coefficient at a high slip speed.
    pub kinetic: f64,
    /// Time per length, the rate at which the coefficient falls with the slip speed; infinite where it falls at once.
    pub decay: f64,
    /// Approach speed from which a landing counts as an impact that the steps resolve.
    pub floor: f64,
    /// Longest time ahead at which equilibrium may be written in an impact.
    pub resolution: f64,
    /// Longest time that an impact may last.
    pub duration: f64,
    /// Distance below which points are looked at in every iteration.
    pub near: f64,
    /// Gap up to which what lies still counts as touching: in statics what rounding leaves between parts drawn face to face, else 0.
    pub touching: f64,
    /// How deep, and how far along the surface while it sticks, a point may be at the end of a load step where multipliers take the
    /// place of springs; `None`: springs alone.
    pub tolerance: Option<f64>,
    /// True where the analysis has velocities, so that a far point stays far for a while.
    pub dynamic: bool,
}

impl ContactLaw {
    /// Coulomb's coefficient at a slip speed, 0 of a contact that sticks.
    #[inline]
    pub fn friction_at(&self, slip_speed: f64) -> f64 {
        if slip_speed <= 0.0 || self.kinetic == self.friction {
            return self.friction;
        }
        self.kinetic + (self.friction - self.kinetic) * (-self.decay * slip_speed).exp()
    }

    /// The friction with which a pair begins of which nothing is known, under a normal force, and its slip speed: what slides at t = 0 has been
    /// sliding, and its spring is stretched. Not what slides no faster than its weight makes it.
    pub(super) fn begun(&self, force: f64, slip: &Vec3) -> (Vec3, f64) {
        let speed = slip.norm();
        match speed > self.floor {
            true => (self.friction_at(speed) * force * (slip / speed), speed),
            false => (Vec3::zeros(), 0.0),
        }
    }

    /// True where the spring of the normal force may begin at a depth of its own, which is remembered.
    pub fn keeps_inset(&self) -> bool {
        self.dynamic && matches!(self.loss, Loss::Whole { .. })
    }
}
