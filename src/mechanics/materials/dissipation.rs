//! Dissipated energy by cause, and the plastic energy stored.

use base::snapshot::keep;
use std::ops::{AddAssign, Mul};

/// Energy dissipated and stored by plastic flow and at contacts, per volume or of a whole.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dissipation {
    /// Dissipated by yielding, ∫ i dε̄ᵖ: exact where hardening is linear over the step.
    pub plastic: f64,
    /// Dissipated by viscosity, ∫ i v dε̄ᵖ, to second order in the step.
    pub viscous: f64,
    /// Kept by kinematic hardening, ∫ X dεᵖ: energy that comes back, so its sign is free.
    pub stored: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated in impacts.
    pub impact: f64,
    /// Energy stored in failed points and removed with them.
    pub eroded: f64,
}

keep!(Dissipation { plastic, viscous, stored, friction, impact, eroded });

impl AddAssign for Dissipation {
    fn add_assign(&mut self, more: Dissipation) {
        self.plastic += more.plastic;
        self.viscous += more.viscous;
        self.stored += more.stored;
        self.friction += more.friction;
        self.impact += more.impact;
        self.eroded += more.eroded;
    }
}

impl Mul<f64> for Dissipation {
    type Output = Dissipation;

    fn mul(self, by: f64) -> Dissipation {
        Dissipation {
            plastic: self.plastic * by,
            viscous: self.viscous * by,
            stored: self.stored * by,
            friction: self.friction * by,
            impact: self.impact * by,
            eroded: self.eroded * by,
        }
    }
}
