//! Generalized-α: inertia is taken at t + (1 − α_m)Δt, all other forces at t + (1 − α_f)Δt, both on straight lines over the step, and
//! displacements follow Newmark's formulas. With the parameters of one spectral radius ρ∞ it damps what the step does not
//! resolve by ρ∞ a step and of all schemes with that damping the low modes least; second order, unconditionally stable.
//! J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993). Newmark's scheme and HHT-α are members of the family.

use super::{Coefficients, RotationUpdate};

#[derive(Debug, Clone, PartialEq)]
pub struct GeneralizedAlpha {
    pub alpha_m: f64,
    pub alpha_f: f64,
    pub gamma: f64,
    pub beta: f64,
    pub rotation: RotationUpdate,
}

impl GeneralizedAlpha {
    /// `radius`: ρ∞, from 0 (what is not resolved is gone after a step) to 1 (nothing is damped).
    pub fn new(radius: f64, rotation: RotationUpdate) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        let beta = 0.25 * (1.0 - alpha_m + alpha_f).powi(2);
        GeneralizedAlpha { alpha_m, alpha_f, gamma, beta, rotation }
    }

    pub fn coefficients(&self, dt: f64) -> Coefficients {
        let GeneralizedAlpha { alpha_m, alpha_f, gamma, beta, rotation } = *self;
        // q at the instant is s times that at the end.
        let s = 1.0 - alpha_f;
        // a₁ = q/(s β Δt²) − v/(β Δt) − (1/2β − 1) a, v₁ = v + Δt ((1 − γ) a + γ a₁)
        let old = 0.5 / beta - 1.0;
        let m = 1.0 - alpha_m;
        // (a₁ from a and q̈ at the instant)
        let (keep, new) = (-alpha_m / m, 1.0 / m);
        Coefficients {
            instant: s,
            rate: [gamma / (beta * dt), 1.0 - s * gamma / beta, s * dt * (1.0 - 0.5 * gamma / beta)],
            acceleration: [m / (s * beta * dt * dt), -m / (beta * dt), alpha_m - m * old],
            prediction: [s * dt, 0.5 * s * dt * dt, s * dt * dt * dt / 6.0],
            end: [
                [0.0, dt, dt * dt * (0.5 - beta + beta * keep), dt * dt * beta * new],
                [0.0, 1.0, dt * (1.0 - gamma + gamma * keep), dt * gamma * new],
                [0.0, 0.0, keep, new],
            ],
            rotation,
        }
    }
}
