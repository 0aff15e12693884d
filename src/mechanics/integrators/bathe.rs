//! Bathe's composite scheme: the trapezoidal rule to t + γΔt, from there backward differences through three points. A step removes
//! unresolved motion, with less damping of low modes than any one-stage scheme that does so; second order, unconditionally stable, twice
//! the work a step. With γ = 2 − √2 one matrix serves both stages (TR-BDF2). K. J. Bathe, M. M. I. Baig, Comput. Struct. 83 (2005); R. E.
//! Bank et al., IEEE Trans. CAD 4 (1985).

use std::sync::Arc;

use super::alpha_family::AlphaFamily;
use super::coefficients::Coefficients;
use super::scheme::{Backward, MakeScheme, Scheme, SchemeKind, Stepping, TwoStages};
use base::math::rotation::RotationUpdate;
use base::names::short;
use base::words::kinds::{Form, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "bathe",
    aliases: &["tr-bdf2"],
    guesses: &[],
    about: "The trapezoidal rule, then backward differences: two stages. Implicit, second order, unconditionally stable; it damps the modes that \
            the step does not resolve.",
    keys: &[Key {
        name: "split",
        form: Form::Number,
        about: "Part of the step that the first stage covers, 0.05 to 0.95. Default: 2 - sqrt(2) = 0.585786437626905, with which \
                both stages have the same matrix.",
    }],
    make: MakeScheme {
        scheme: |given, rotation| {
            let split = given.between("split", [0.05, 0.95], 2.0 - 2.0_f64.sqrt());
            Arc::new(Bathe { split, rotation })
        },
        rotation_update: true,
    },
};

/// Bathe's composite scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct Bathe {
    /// γ: the part of the step that the trapezoidal rule covers.
    pub split: f64,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl Scheme for Bathe {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} split at {}", KIND.word, short(self.split))
    }

    fn stepping(&self) -> Stepping<'_> {
        Stepping::Composite(self)
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        AlphaFamily::trapezoidal(self.rotation).coefficients(self.split * dt)
    }
}

impl TwoStages for Bathe {
    fn split(&self) -> f64 {
        self.split
    }

    fn backward(&self, dt: f64) -> Backward {
        let (h1, h2) = (self.split * dt, (1.0 - self.split) * dt);
        Backward { start: h2 / (h1 * dt), between: -dt / (h1 * h2), end: (h1 + 2.0 * h2) / (h2 * dt) }
    }

    fn second(&self, dt: f64) -> Coefficients {
        let b = self.backward(dt).end;
        let h2 = (1.0 - self.split) * dt;
        // q̇ = b q − b₀ q₀ (q is counted from between the stages), q̈ = b q̇ + b₀ v₀ + b₁ v
        Coefficients {
            instant: 1.0,
            rate: [b, -1.0, 0.0],
            acceleration: [b * b, -b, 1.0, 0.0],
            prediction: [h2, 0.5 * h2 * h2, h2 * h2 * h2 / 6.0],
            end: [[1.0, 0.0, 0.0, 0.0], [b, -1.0, 0.0, 0.0], [b * b, -b, 1.0, 0.0]],
            // The derivative of the parabola through three points errs by ⅙ Δt h₂ of the third one.
            turning: Some(dt / 6.0),
            rotation: self.rotation,
        }
    }
}
