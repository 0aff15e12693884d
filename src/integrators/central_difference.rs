//! Central differences, as velocity Verlet: positions at t + Δt from the motion at t alone, accelerations there from equilibrium
//! with the mass alone, velocities by the mean of the accelerations. Nothing is solved for but M a = r. Second order, no damping,
//! periods shortened; stable while the step resolves the fastest mode of the scene: ω Δt ≤ 2. Momenta of what moves freely are kept.
//! A rotation by Δt ω + ½ Δt² α is not the same from its end backwards: a body that spins under moments gains or loses energy
//! steadily, by the third power of the step.
//!
//! Forces that depend on velocities meet the predicted ones, v + Δt a, which costs no order; the limit becomes
//! ¼ (ω Δt)² + 2 ξ ω Δt ≤ 1.
//! L. Verlet, Phys. Rev. 159 (1967); T. Belytschko, T. J. R. Hughes (eds.), Computational Methods for Transient Analysis (1983).

use std::sync::Arc;

use super::coefficients::Coefficients;
use super::scheme::{Make, Scheme, SchemeKind, Stepping};
use crate::math::rotation::RotationUpdate;

pub static KIND: SchemeKind = SchemeKind {
    word: "central-difference",
    aliases: &[],
    guesses: &["verlet", "leapfrog", "leap-frog", "explicit"],
    about: "Explicit, of second order: no matrix but the masses; steps must be shorter than the highest mode allows (omega dt <= 2). \
            time_step = \"auto\" takes 0.8 of the critical time step, 0.5 where contacts or links may stiffen.",
    keys: &[],
    make: Make { scheme: |_, rotation| Arc::new(CentralDifference { rotation }), rotation_update: true },
};

#[derive(Debug, Clone, PartialEq)]
pub struct CentralDifference {
    pub rotation: RotationUpdate,
}

impl Scheme for CentralDifference {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        KIND.word.to_owned()
    }

    fn note(&self) -> Option<&'static str> {
        Some("explicit: steps that are too long for the fastest mode are cut, whatever the motion that counts")
    }

    fn stepping(&self) -> Stepping<'_> {
        Stepping::Verlet
    }

    /// q is as predicted; at the instant of equilibrium q̇ is predicted too, and q̈ the unknown.
    fn coefficients(&self, dt: f64) -> Coefficients {
        Coefficients {
            instant: 1.0,
            rate: [0.0, 1.0, dt],
            acceleration: [0.0; 4],
            prediction: [dt, 0.5 * dt * dt, 0.0],
            end: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.5 * dt, 0.5 * dt], [0.0, 0.0, 0.0, 1.0]],
            rotation: self.rotation,
        }
    }
}

/// How much of its limit a step Δt takes in a mode with φᵀKφ/φᵀMφ = `stiffness` and φᵀCφ/φᵀMφ = `damping`: above 1 it grows.
pub fn load_of_limit(dt: f64, stiffness: f64, damping: f64) -> f64 {
    dt * (0.25 * dt * stiffness + damping)
}

/// The longest step that such a mode bears: ¼ κ Δt² + γ Δt = 1.
pub fn longest_step(stiffness: f64, damping: f64) -> f64 {
    2.0 / (damping + (damping * damping + stiffness).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// Of the step of ẍ + γ ẋ + κ x = 0 with Δt = 1, on (x, v, a).
    fn largest_eigenvalue(stiffness: f64, damping: f64) -> f64 {
        let unit = |j: usize| std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
        let columns = [0, 1, 2].map(|j| {
            let [x, v, a]: [f64; 3] = unit(j);
            let c = CentralDifference { rotation: RotationUpdate::Exponential }.coefficients(1.0);
            let of = |[q, v1, a1, dd]: [f64; 4], at: [f64; 4]| q * at[0] + v1 * at[1] + a1 * at[2] + dd * at[3];
            let q = c.prediction[0] * v + c.prediction[1] * a;
            let rate = c.rate[0] * q + c.rate[1] * v + c.rate[2] * a;
            let dd = -stiffness * (x + q) - damping * rate;
            [x + of(c.end[0], [q, v, a, dd]), of(c.end[1], [q, v, a, dd]), of(c.end[2], [q, v, a, dd])]
        });
        let A = Matrix3::from_fn(|i, j| columns[j][i]);
        A.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max)
    }

    /// Just below the limit nothing grows, just above it does, for any damping; without, the limit is ω Δt = 2.
    #[test]
    fn the_limit_is_where_motion_begins_to_grow() {
        assert_eq!(longest_step(4.0, 0.0), 1.0);
        for ratio in [0.0, 0.01, 0.1, 0.5, 1.0, 5.0] {
            // κ = ω², γ = 2 ξ ω at Δt = 1 and ω such that the limit is met.
            let omega = longest_step(1.0, 2.0 * ratio);
            for (part, grows) in [(0.1, false), (0.999, false), (1.001, true)] {
                let omega = part * omega;
                let radius = largest_eigenvalue(omega * omega, 2.0 * ratio * omega);
                // An undamped mode neither grows nor dies: rounding of its eigenvalues, which are nearly double at the limit.
                assert_eq!(radius > 1.0 + 1e-7, grows, "ξ = {ratio}, {part} of the limit: {radius}");
                assert_eq!(load_of_limit(1.0, omega * omega, 2.0 * ratio * omega) > 1.0, grows);
            }
        }
    }
}
