//! `[materials.x]`: the constants that all models share, and the keys of each model.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;
use super::words::kinds::{Given, Kinds, OneOf};
use mechanics::materials::models::{MATERIALS, MaterialKind, MaterialModel};
use mechanics::materials::overstress::{OVERSTRESSES, Overstress, OverstressKind};

/// A material.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus, force per area, above 0. Alias: `E`.
    #[schemars(required)]
    pub youngs_modulus: Maybe<f64>,
    /// Poisson's ratio, above -1, at most 0.5. Needed by beams and shells. Alias: `nu`.
    pub poisson_ratio: Maybe<f64>,
    /// Mass per volume, above 0. Needed by everything that has mass. Alias: `rho`.
    pub density: Maybe<f64>,
    /// Coefficient of thermal expansion, strain per unit of temperature. Needed where a load heats a part. Default: none.
    pub expansion: Maybe<f64>,
    /// How the overstress grows with the rate of plastic strain. (elastic-viscoplastic)
    pub viscosity: Maybe<OneOf<Viscosity>>,
}

impl Kinds for Material {
    const CHOOSER: &'static str = "model";
    const ABOUT: &'static str = "The constitutive model.";
    const REQUIRED: bool = true;
    type Make = MaterialModel;

    fn list() -> &'static [&'static MaterialKind] {
        MATERIALS
    }
}

/// Perzyna: rate of plastic strain = rate * phi(stress / yield stress - 1).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscosity {
    /// Fluidity, per unit of time, above 0. With the power law: Cowper-Symonds' D.
    #[schemars(required)]
    pub rate: Maybe<f64>,
}

impl Kinds for Viscosity {
    const CHOOSER: &'static str = "law";
    const ABOUT: &'static str = "The overstress function phi.";
    const REQUIRED: bool = true;
    type Make = fn(&mut Given) -> Option<Overstress>;

    fn list() -> &'static [&'static OverstressKind] {
        OVERSTRESSES
    }
}
