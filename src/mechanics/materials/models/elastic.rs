//! Linear elasticity.

use super::kind::{MaterialKind, MaterialModel};

/// The model's word, keys and law.
pub static KIND: MaterialKind = MaterialKind {
    word: "elastic",
    aliases: &[],
    guesses: &["linear-elastic", "isotropic", "linear"],
    about: "Linear elasticity.",
    keys: &[],
    make: MaterialModel { noun: "an elastic material", law: None, is_viscous: false },
};
