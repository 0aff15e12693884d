//! J2 plasticity, rate independent.

use super::kind::{MaterialKind, MaterialModel, PLASTICITY, plasticity};

/// The model's word, keys and law.
pub static KIND: MaterialKind = MaterialKind {
    word: "elastic-plastic",
    aliases: &[],
    guesses: &["plastic", "j2", "von-mises", "bilinear", "elastoplastic", "perfectly-plastic", "Steel01"],
    about: "J2 (von Mises) plasticity with isotropic and kinematic hardening, rate independent.",
    keys: &PLASTICITY,
    make: MaterialModel { noun: "an elastic-plastic material", law: Some(plasticity), is_viscous: false },
};
