//! Perzyna's viscosity: how fast plastic strain grows when the stress lies above the hardened yield stress.

use base::math::number::Number;
use base::words::kinds::{Form, Given, Key, Kind};

/// An overstress law of the deck; its keys make an [`Overstress`], or `None` where one is wrong.
pub type OverstressKind = Kind<fn(&mut Given) -> Option<Overstress>>;

/// All laws of the overstress.
pub static OVERSTRESSES: &[&OverstressKind] = &[&POWER, &LINEAR, &EXPONENTIAL];

static POWER: OverstressKind = OverstressKind {
    word: "power",
    aliases: &[],
    guesses: &["cowper-symonds"],
    about: "phi(x) = x^exponent; with rate = D and exponent = q the law of Cowper and Symonds.",
    keys: &[Key {
        name: "exponent",
        form: Form::Number,
        about: "Exponent of the power law, 1 to 100: Cowper-Symonds' q.",
    }],
    make: |given| match *given.require("exponent")? {
        // Cowper-Symonds exponents lie between 1 and 10; far beyond, the overstress is a step.
        [exponent] if (1.0..=100.0).contains(&exponent) => Some(Overstress::Power { exponent }),
        _ => given.error("exponent", "`exponent` must lie between 1 and 100"),
    },
};

static LINEAR: OverstressKind = OverstressKind {
    word: "linear",
    aliases: &[],
    guesses: &[],
    about: "phi(x) = x.",
    keys: &[],
    make: |_| Some(Overstress::Linear),
};

static EXPONENTIAL: OverstressKind = OverstressKind {
    word: "exponential",
    aliases: &[],
    guesses: &[],
    about: "phi(x) = exp(x) - 1.",
    keys: &[],
    make: |_| Some(Overstress::Exponential),
};

/// ε̄̇ᵖ = γ φ(v) (17), v = ρ/i − 1 the relative overstress over the hardened yield stress i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// γ, per time.
    pub fluidity: f64,
    /// The law φ of the overstress.
    pub overstress: Overstress,
}

/// φ(v), rising from φ(0) = 0 (18).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overstress {
    /// vⁿ; with γ = D and n = q the law of Cowper and Symonds.
    Power {
        /// n.
        exponent: f64,
    },
    /// v.
    Linear,
    /// eᵛ − 1.
    Exponential,
}

impl Overstress {
    /// φ and v φ′, which unlike φ′ stays finite at v = 0 for any exponent.
    #[inline]
    pub fn phi<T: Number>(&self, v: T) -> (T, T) {
        v.map_two(|v| match self {
            Overstress::Power { exponent } => {
                // Most exponents are integers, and `powi` costs a sixth of the time of `powf`.
                let whole = *exponent as i32;
                let phi = if f64::from(whole) == *exponent { v.powi(whole) } else { v.powf(*exponent) };
                (phi, exponent * phi)
            }
            Overstress::Linear => (v, v),
            Overstress::Exponential => {
                let phi = v.exp_m1();
                (phi, v * (phi + 1.0))
            }
        })
    }

    /// The relative overstress v with φ(v) = `phi`.
    #[inline]
    pub fn inverse<T: Number>(&self, phi: T) -> T {
        phi.map(|phi| match self {
            Overstress::Power { exponent } => phi.powf(exponent.recip()),
            Overstress::Linear => phi,
            Overstress::Exponential => phi.ln_1p(),
        })
    }
}
