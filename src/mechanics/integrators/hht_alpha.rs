//! HHT-α: inertia at t + Δt, and for linear systems all other forces at t + (1 + α)Δt, −1/3 ≤ α ≤ 0. It is generalized-α with α_m = 0. H.
//! M. Hilber, T. J. R. Hughes, R. L. Taylor, Earthquake Eng. Struct. Dyn. 5 (1977).

use std::sync::Arc;

use super::alpha_family::AlphaFamily;
use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind};
use base::math::rotation::RotationUpdate;
use base::words::kinds::{Form, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "hht-alpha",
    aliases: &["hht"],
    guesses: &["hilber-hughes-taylor", "HHT"],
    about: "Hilber, Hughes and Taylor: damps high modes and is of second order. Implicit, unconditionally stable.",
    keys: &[Key {
        name: "alpha",
        form: Form::Number,
        about: "From -1/3, the most damping, to 0, none. Default: -0.05.",
    }],
    make: MakeScheme {
        scheme: |given, rotation| {
            let alpha = given.between("alpha", [-1.0 / 3.0, 0.0], -0.05);
            Arc::new(HhtAlpha { alpha, rotation })
        },
        rotation_update: true,
    },
};

/// HHT-α, of second order and unconditionally stable for α from −1/3 to 0.
#[derive(Debug, Clone, PartialEq)]
pub struct HhtAlpha {
    /// α, from −1/3 to 0.
    pub alpha: f64,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl HhtAlpha {
    fn family(&self) -> AlphaFamily {
        let (gamma, beta) = (0.5 - self.alpha, 0.25 * (1.0 - self.alpha).powi(2));
        AlphaFamily { alpha_m: 0.0, alpha_f: -self.alpha, gamma, beta, rotation: self.rotation }
    }
}

impl Scheme for HhtAlpha {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} with alpha = {}", KIND.word, self.alpha)
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        self.family().coefficients(dt)
    }

    fn algorithmic_acceleration(&self) -> Option<[f64; 3]> {
        self.family().algorithmic_acceleration()
    }
}
