//! The numbers of a contact law.

use super::restitution::Loss;

/// What acts where a point touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// Force per depth, normal and tangential.
    pub stiffness: f64,
    /// What an impact loses.
    pub loss: Loss,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Approach speed from which a landing is an impact, whose motion the steps resolve.
    pub floor: f64,
    /// Longest time ahead at which equilibrium may be written in an impact, and how long an impact may last.
    pub resolution: f64,
    pub duration: f64,
    /// Points nearer than this are looked at in every iteration.
    pub near: f64,
    /// The analysis has velocities, so that a point that is far stays far for a while.
    pub dynamic: bool,
}
