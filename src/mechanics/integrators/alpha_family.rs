//! Common part of generalized-α, HHT-α and Newmark: equilibrium at t + Δt with q̈₁, Newmark's formulas with γ, β and an acceleration a, and
//! (1 − α_m) a₁ + α_m a = (1 − α_f) q̈₁ + α_f q̈.

use super::coefficients::Coefficients;
use base::math::rotation::RotationUpdate;

/// The parameters of one member of the family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlphaFamily {
    /// Weight α_m of the acceleration at the start.
    pub alpha_m: f64,
    /// Weight α_f of the forces at the start.
    pub alpha_f: f64,
    /// Newmark's γ.
    pub gamma: f64,
    /// Newmark's β.
    pub beta: f64,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl AlphaFamily {
    /// Newmark's scheme: a is q̈.
    pub fn newmark(gamma: f64, beta: f64, rotation: RotationUpdate) -> AlphaFamily {
        AlphaFamily { alpha_m: 0.0, alpha_f: 0.0, gamma, beta, rotation }
    }

    /// The trapezoidal rule: γ = ½, β = ¼.
    pub fn trapezoidal(rotation: RotationUpdate) -> AlphaFamily {
        AlphaFamily::newmark(0.5, 0.25, rotation)
    }

    /// Coefficients of (q, v, a, q̈ at the start).
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        let AlphaFamily { alpha_m, alpha_f, gamma, beta, rotation } = *self;
        let (m, f) = ((1.0 - alpha_m) / (1.0 - alpha_f), 1.0 - alpha_f);
        // a₁ = q/(β Δt²) − v/(β Δt) − (1/2β − 1) a, v₁ = v + Δt ((1 − γ) a + γ a₁)
        let old = 0.5 / beta - 1.0;
        // a runs ahead of q̈ by this part of a step.
        let ahead = alpha_m - alpha_f;
        let rate = [gamma / (beta * dt), 1.0 - gamma / beta, dt * (1.0 - 0.5 * gamma / beta)];
        Coefficients {
            instant: 1.0,
            rate,
            acceleration: [m / (beta * dt * dt), -m / (beta * dt), alpha_m / f - m * old, -alpha_f / f],
            prediction: [dt, 0.5 * dt * dt, dt * dt * dt / 6.0],
            end: [[1.0, 0.0, 0.0, 0.0], [rate[0], rate[1], rate[2], 0.0], [0.0, 0.0, 0.0, 1.0]],
            // The exact q̇ contains ½ Δt² of the third derivative; q contributes ⅙ Δt³, and a its own part.
            turning: Some(0.5 * dt - rate[0] * dt * dt / 6.0 - rate[2] * ahead),
            rotation,
        }
    }

    /// The weights of (a, q̈ at the start, q̈ at the end of the step) in a at the end; `None` where a₁ is q̈₁.
    pub fn algorithmic_acceleration(&self) -> Option<[f64; 3]> {
        let m = 1.0 - self.alpha_m;
        let follows = self.alpha_m != 0.0 || self.alpha_f != 0.0;
        follows.then(|| [-self.alpha_m / m, self.alpha_f / m, (1.0 - self.alpha_f) / m])
    }
}
