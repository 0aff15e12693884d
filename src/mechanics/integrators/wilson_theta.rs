//! Wilson-θ: the acceleration is linear over τ = θΔt, equilibrium holds at t + τ, and the state at t + Δt lies on the same line.
//! Unconditionally stable for θ ≥ 1.366; second order. It damps high modes, lengthens periods about twice as much as the trapezoidal rule,
//! overshoots, and does not satisfy equilibrium at t + Δt. E. L. Wilson, I. Farhoomand, K. J. Bathe, Earthquake Eng. Struct. Dyn. 1 (1973).

use std::sync::Arc;

use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind};
use base::math::rotation::RotationUpdate;
use base::words::kinds::{Form, Key};

/// Below this the scheme is only conditionally stable.
const STABLE_THETA: f64 = 1.366;

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "wilson-theta",
    aliases: &["wilson"],
    guesses: &[],
    about: "Linear acceleration over theta steps, with equilibrium at the end of these. Implicit, of second order; damps high modes.",
    keys: &[Key {
        name: "theta",
        form: Form::Number,
        about: "Equilibrium is written at t + theta * time_step; 1 or more, unconditionally stable from 1.366 on. Default: 1.4.",
    }],
    make: MakeScheme {
        scheme: |given, rotation| {
            let theta = given.number("theta").unwrap_or(1.4);
            if theta < 1.0 {
                given.error::<()>("theta", "`theta` must be at least 1");
            } else if theta < STABLE_THETA {
                let limit = format!("give `theta` = 1.4: below {STABLE_THETA} long steps may grow without bound");
                let message = format!("Wilson-theta with theta = {theta} is not unconditionally stable");
                given.warn("theta", message, limit);
            }
            Arc::new(WilsonTheta { theta, rotation })
        },
        rotation_update: true,
    },
};

/// The Wilson-θ scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct WilsonTheta {
    /// Equilibrium is written at t + θΔt.
    pub theta: f64,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl Scheme for WilsonTheta {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} with theta = {}", KIND.word, self.theta)
    }

    fn note(&self) -> Option<&'static str> {
        Some(
            "Wilson-theta damps modes with periods below about 10 steps and overshoots their accelerations and velocities in the first steps; \
             equilibrium and reactions are those at t + theta dt",
        )
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        let theta = self.theta;
        let tau = theta * dt;
        // q = τ v + τ²/6 (2 a + a_τ) and q̇_τ = v + τ/2 (a + a_τ), solved for a_τ. At the end: a₁ = a + (a_τ − a)/θ, q̇₁ = v + Δt/2 (a +
        // a₁), q₁ = Δt v + Δt²/6 (2 a + a₁).
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
            // The linear acceleration is exact to third order.
            turning: Some(0.0),
            rotation: self.rotation,
        }
    }
}
