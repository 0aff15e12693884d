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
    /// Slope of the fall of the coefficient with the slip speed, time per length; infinite for an immediate drop.
    pub decay: f64,
    /// Approach speed above which the steps resolve a landing as an impact.
    pub floor: f64,
    /// Longest time from the last state to the instant of equilibrium in an impact.
    pub resolution: f64,
    /// Longest time that an impact may last.
    pub duration: f64,
    /// Distance below which points are looked at in every iteration.
    pub near: f64,
    /// Gap up to which bodies count as touching: in statics the rounding between parts drawn face to face, else 0.
    pub touching: f64,
    /// Largest depth, and largest displacement while sticking, of a point at the end of a load step with multipliers. `None`: springs
    /// alone.
    pub tolerance: Option<f64>,
    /// True for analyses with velocities: a distant point then stays distant for some time.
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

    /// The initial friction and slip speed of an unknown pair under a normal force: a body sliding at t = 0 has a stretched spring. Slip
    /// speeds up to `floor` count as sticking.
    pub(super) fn begun(&self, force: f64, slip: &Vec3) -> (Vec3, f64) {
        let speed = slip.norm();
        match speed > self.floor {
            true => (self.friction_at(speed) * force * (slip / speed), speed),
            false => (Vec3::zeros(), 0.0),
        }
    }

    /// True where the start of the normal spring may move; its depth is then stored.
    pub fn keeps_inset(&self) -> bool {
        self.dynamic && matches!(self.loss, Loss::Whole { .. })
    }
}
