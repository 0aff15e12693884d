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
            acceleration: [6.0 / (tau * tau), -6.0 / tau, -2.0],
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Period elongation and damping of the free oscillator with Δt/T = 0.05, 0.1, 0.2: the amplification matrix's
    /// eigenvalues as tabulated for Wilson-θ from its definition (θ = 1.4; the last one 1.37), to the digits given.
    #[test]
    fn spectrum_of_the_free_oscillator() {
        let cases = [
            (1.4, 0.05, 1.71063, 0.0023165),
            (1.4, 0.1, 6.14622, 0.0139794),
            (1.4, 0.2, 19.36534, 0.0558601),
            (1.37, 0.1, 5.75237, 0.0125216),
        ];
        for (theta, dt, elongation, damping) in cases {
            let c = WilsonTheta { theta, rotation: RotationUpdate::Exponential }.coefficients(dt);
            let omega2 = (2.0 * std::f64::consts::PI).powi(2);
            // One step of q̈ = −ω² u from (u, v, a), equilibrium at the instant: c_a q + … = −ω² (u + q).
            let step = |[u, v, a]: [f64; 3]| {
                let [k, cv, ca] = c.acceleration;
                let q = -(omega2 * u + cv * v + ca * a) / (k + omega2);
                let at = k * q + cv * v + ca * a;
                let end = |[c1, c2, c3, c4]: [f64; 4]| c1 * q + c2 * v + c3 * a + c4 * at;
                [u + end(c.end[0]), end(c.end[1]), end(c.end[2])]
            };
            let columns = [step([1.0, 0.0, 0.0]), step([0.0, 1.0, 0.0]), step([0.0, 0.0, 1.0])];
            let A = nalgebra::Matrix3::from_fn(|i, j| columns[j][i]);
            let principal = A
                .complex_eigenvalues()
                .iter()
                .copied()
                .max_by(|x, y| x.im.total_cmp(&y.im))
                .expect("three eigenvalues");
            let phase = principal.im.atan2(principal.re);
            let period = 2.0 * std::f64::consts::PI * dt / phase;
            let log = -principal.norm().ln();
            let xi = log / phase.hypot(log);
            assert!((100.0 * (period - 1.0) - elongation).abs() < 1e-5, "elongation {}", 100.0 * (period - 1.0));
            assert!((xi - damping).abs() < 1e-7, "damping {xi}");
        }
    }
}
