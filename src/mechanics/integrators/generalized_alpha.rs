//! Generalized-α in the form of Arnold & Brüls: equilibrium holds at t + Δt with the acceleration q̈₁. Newmark's formulas use another
//! acceleration a with (1 − α_m) a₁ + α_m a = (1 − α_f) q̈₁ + α_f q̈. For linear systems this is the scheme of Chung & Hulbert with forces
//! at t + (1 − α_f)Δt. Joints, contacts and yielding material are evaluated at the end of the step. One spectral radius ρ∞ defines the
//! parameters. Unresolved motion decreases by ρ∞ a step, with the least damping of low modes of all such schemes; second order,
//! unconditionally stable. J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993); M. Arnold, O. Brüls, Multibody Syst. Dyn. 18 (2007).

use std::sync::Arc;

use super::alpha_family::AlphaFamily;
use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind};
use base::math::rotation::RotationUpdate;
use base::names::short;
use base::words::kinds::{Form, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "generalized-alpha",
    aliases: &[],
    guesses: &["chung-hulbert", "generalised-alpha", "gen-alpha"],
    about: "Chung and Hulbert: of all one-stage schemes with a given damping of high modes the one that damps low modes least. \
            Implicit, of second order, unconditionally stable.",
    keys: &[Key {
        name: "spectral_radius",
        form: Form::Number,
        about: "Part of unresolved motion that remains after a step, from 0 (nothing) to 1 (all: no damping). Default: 0.8.",
    }],
    make: MakeScheme {
        scheme: |given, rotation| {
            let radius = given.between("spectral_radius", [0.0, 1.0], 0.8);
            Arc::new(GeneralizedAlpha::new(radius, rotation))
        },
        rotation_update: true,
    },
};

/// The generalized-α scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralizedAlpha {
    /// Its parameters.
    pub family: AlphaFamily,
}

impl GeneralizedAlpha {
    /// `radius`: ρ∞, from 0 (a step removes unresolved motion) to 1 (no damping).
    pub fn new(radius: f64, rotation: RotationUpdate) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        let beta = 0.25 * (1.0 - alpha_m + alpha_f).powi(2);
        GeneralizedAlpha { family: AlphaFamily { alpha_m, alpha_f, gamma, beta, rotation } }
    }
}

impl Scheme for GeneralizedAlpha {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} with a spectral radius of {}", KIND.word, short(self.family.alpha_f / (1.0 - self.family.alpha_f)))
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        self.family.coefficients(dt)
    }

    fn algorithmic_acceleration(&self) -> Option<[f64; 3]> {
        self.family.algorithmic_acceleration()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    /// Newmark's formulas hold between the ends of a step with the acceleration that follows.
    #[test]
    fn the_follower_is_newmarks_acceleration() {
        let scheme = GeneralizedAlpha::new(0.6, RotationUpdate::Exponential);
        let (dt, v, a, b, q) = (0.1, 0.7, -2.0, -1.5, 0.05);
        let c = scheme.coefficients(dt);
        let rate = c.rate[0] * q + c.rate[1] * v + c.rate[2] * a;
        let [c1, c2, c3, c4] = c.acceleration;
        let acceleration = c1 * q + c2 * v + c3 * a + c4 * b;
        let [of_a, of_start, of_end] = scheme.algorithmic_acceleration().expect("it is not equilibrium's");
        let a1 = of_a * a + of_start * b + of_end * acceleration;
        let (beta, gamma) = (scheme.family.beta, scheme.family.gamma);
        assert!((dt * v + dt * dt * ((0.5 - beta) * a + beta * a1) - q).abs() < 1e-15);
        assert!((v + dt * ((1.0 - gamma) * a + gamma * a1) - rate).abs() < 1e-14);
    }
}
