//! J2 plasticity with an overstress that depends on the rate of plastic strain, after Perzyna.

use super::kind::{MaterialKind, MaterialModel, PLASTICITY, plasticity};

/// The model's word, keys and law.
pub static KIND: MaterialKind = MaterialKind {
    word: "elastic-viscoplastic",
    aliases: &[],
    guesses: &["perzyna", "viscoplastic", "rate-dependent", "cowper-symonds"],
    about: "J2 plasticity with an overstress that depends on the rate of plastic strain (Perzyna).",
    keys: &PLASTICITY,
    make: MaterialModel { noun: "an elastic-viscoplastic material", law: Some(plasticity), is_viscous: true },
};
