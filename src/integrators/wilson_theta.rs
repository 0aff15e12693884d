//! Wilson-θ: the acceleration is linear over τ = θΔt, equilibrium is written at t + τ, and the state at t + Δt is read off
//! the same line. Unconditionally stable for θ ≥ 1.366; second order. It damps high modes, lengthens periods about twice
//! as much as the trapezoidal rule, overshoots, and leaves equilibrium unsatisfied at t + Δt.
//! E. L. Wilson, I. Farhoomand, K. J. Bathe, Earthquake Eng. Struct. Dyn. 1 (1973).

use super::{Coefficients, RotationUpdate};

/// Below this the scheme is only conditionally stable.
pub const STABLE_THETA: f64 = 1.366;

#[derive(Debug, Clone, PartialEq)]
pub struct WilsonTheta {
    /// Equilibrium is written at t + θΔt.
    pub theta: f64,
    pub rotation: RotationUpdate,
}

impl WilsonTheta {
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        let theta = self.theta;
        let tau = theta * dt;
        // q = τ v + τ²/6 (2 a + a_τ), q̇_τ = v + τ/2 (a + a_τ), solved for a_τ.
        // At the end: a₁ = a + (a_τ − a)/θ, q̇₁ = v + Δt/2 (a + a₁), q₁ = Δt v + Δt²/6 (2 a + a₁).
        let (new, old) = (1.0 / theta, 1.0 - 1.0 / theta);
        Coefficients {
            instant: theta,
            rate: [3.0 / tau, -2.0, -0.5 * tau],
            acceleration: [6.0 / (tau * tau), -6.0 / tau, -2.0, 0.0],
            prediction: [tau, 0.5 * tau * tau, tau * tau * tau / 6.0],
            end: [
                [0.0, dt, dt * dt / 6.0 * (2.0 + old), dt * dt / 6.0 * new],
                [0.0, 1.0, 0.5 * dt * (1.0 + old), 0.5 * dt * new],
                [0.0, 0.0, old, new],
            ],
            rotation: self.rotation,
        }
    }
}
