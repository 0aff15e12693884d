//! The models of material that the deck can name. A further model is one file and one entry of [`MATERIALS`].

pub mod concrete;
pub mod elastic;
pub mod elastic_plastic;
pub mod elastic_viscoplastic;
pub mod kind;
pub mod menegotto_pinto;

pub use kind::{MaterialKind, MaterialModel};

/// All models, in the order of the reference.
pub static MATERIALS: &[&MaterialKind] =
    &[&elastic::KIND, &elastic_plastic::KIND, &elastic_viscoplastic::KIND, &concrete::KIND, &menegotto_pinto::KIND];
