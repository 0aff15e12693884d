//! Newmark: equilibrium at t + Δt; q = Δt v + Δt² ((½ − β) a + β a₁), v₁ = v + Δt ((1 − γ) a + γ a₁). With γ = ½ and β = ¼ the trapezoidal
//! rule: second order, no damping at all. With γ > ½ it damps, and is of first order. Unconditionally stable for 2β ≥ γ ≥ ½. N. M. Newmark,
//! J. Eng. Mech. Div. ASCE 85 (1959).

use std::sync::Arc;

use super::alpha_family::AlphaFamily;
use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind};
use base::math::rotation::RotationUpdate;
use base::words::kinds::{Form, Given, Key};

/// The scheme's word, keys and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "newmark",
    aliases: &[],
    guesses: &["trapezoidal", "average-acceleration", "constant-average-acceleration"],
    about: "Newmark's family; by default the trapezoidal rule, which damps nothing. Implicit; second order with gamma = 0.5, \
            else first.",
    keys: &[
        Key {
            name: "gamma",
            form: Form::Number,
            about: "Weight of the new acceleration in the velocity, 0.5 or more; above 0.5 the scheme damps and is of first \
                    order. Default: 0.5.",
        },
        Key {
            name: "beta",
            form: Form::Number,
            about: "Weight of the new acceleration in the displacement, above 0; unconditionally stable from gamma / 2 on. Default: \
                    (gamma + 0.5)^2 / 4.",
        },
    ],
    make: MakeScheme {
        scheme: |given, rotation| {
            let gamma = given.number("gamma").unwrap_or(0.5);
            let beta = given.number("beta").unwrap_or(0.25 * (gamma + 0.5).powi(2));
            check(given, gamma, beta);
            Arc::new(Newmark { gamma, beta, rotation })
        },
        rotation_update: true,
    },
};

/// Warns of parameters without second order or unconditional stability.
fn check(given: &mut Given, gamma: f64, beta: f64) {
    if gamma < 0.5 {
        given.error_with::<()>("gamma", "`gamma` must be at least 0.5", "below, every motion grows; give 0.5");
    } else if gamma > 0.5 {
        let text = format!("Newmark with gamma = {gamma} is of first order");
        given.warn(
            "gamma",
            text,
            "give `gamma` = 0.5, or `scheme` = \"generalized-alpha\", which damps and is of second order",
        );
    }
    if !given.has("beta") {
        return;
    }
    if beta <= 0.0 {
        given.error_with::<()>("beta", "`beta` must be above zero", "at zero the scheme is explicit");
    } else if 2.0 * beta < gamma {
        let text = format!("Newmark with beta = {beta} is not unconditionally stable");
        given.warn("beta", text, format!("give `beta` = {}: below, long steps may grow without bound", 0.5 * gamma));
    }
}

/// Newmark's scheme.
#[derive(Debug, Clone, PartialEq)]
pub struct Newmark {
    /// γ ≥ ½; ½ gives second order without damping.
    pub gamma: f64,
    /// β; unconditionally stable for 2β ≥ γ.
    pub beta: f64,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl Scheme for Newmark {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        format!("{} with gamma = {}, beta = {}", KIND.word, self.gamma, self.beta)
    }

    fn note(&self) -> Option<&'static str> {
        Some(match self.order() {
            2 => {
                "the trapezoidal rule damps nothing: modes that the time step does not resolve keep ringing in velocities, \
                 accelerations and reactions"
            }
            _ => "with gamma above 0.5 the scheme is of first order and damps low modes too",
        })
    }

    fn order(&self) -> usize {
        if self.gamma == 0.5 { 2 } else { 1 }
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        AlphaFamily::newmark(self.gamma, self.beta, self.rotation).coefficients(dt)
    }
}
