//! Initial velocities from the deck, as functions of the place; a stage evaluates them at the current positions of nodes.

use base::math::Vec3;
use mechanics::amplitude::Amplitude;
use std::sync::Arc;

/// A factor on a velocity that depends on the place.
#[derive(Debug, Clone)]
pub struct PlaceFactor {
    /// The factor over the place along `direction`, or over the angle about `axis`.
    pub amplitude: Amplitude,
    /// The origin for measuring places, global components.
    pub center: Vec3,
    /// The unit vector along which places are measured. With an axis it lies across that, and angles are measured from it.
    pub direction: Vec3,
    /// The unit vector about which angles are measured.
    pub axis: Option<Vec3>,
}

impl PlaceFactor {
    /// The factor at a place.
    pub fn at(&self, x: &Vec3) -> f64 {
        let arm = x - self.center;
        let along = arm.dot(&self.direction);
        self.amplitude.value(match self.axis {
            None => along,
            Some(axis) => arm.dot(&axis.cross(&self.direction)).atan2(along),
        })
    }
}

/// The motion that a table gives to nodes.
#[derive(Debug, Clone, Default)]
pub struct InitialMotion {
    /// Velocity, global components.
    pub v: Vec3,
    /// Angular velocity, global components.
    pub omega: Vec3,
    /// The centre of a rigid rotation, global components; `None` where each node only has its angular velocity.
    pub about: Option<Vec3>,
    /// Velocity along the normals of shells, instead of `v`.
    pub normal_speed: Option<f64>,
    /// Factors on the velocities.
    pub factors: Vec<PlaceFactor>,
}

/// A velocity, or an angular velocity, that the deck gives a node.
#[derive(Debug, Clone)]
pub struct GivenVelocity {
    /// The motion of the table that gives it.
    pub motion: Arc<InitialMotion>,
    /// The unit normal of shells at the node at t = 0; zero where no normal matters.
    pub normal: Vec3,
}

impl GivenVelocity {
    /// The velocity of a node at a place, where its shells have this normal.
    pub fn velocity(&self, x: &Vec3, normal: &Vec3) -> Vec3 {
        let InitialMotion { v, omega, about, normal_speed, .. } = &*self.motion;
        let v = match (about, normal_speed) {
            (Some(about), _) => v + omega.cross(&(x - about)),
            (None, Some(speed)) => *speed * normal,
            (None, None) => *v,
        };
        self.factor(x) * v
    }

    /// The angular velocity of a node at a place.
    pub fn angular_velocity(&self, x: &Vec3) -> Vec3 {
        self.factor(x) * self.motion.omega
    }

    fn factor(&self, x: &Vec3) -> f64 {
        self.motion.factors.iter().map(|factor| factor.at(x)).product()
    }
}
