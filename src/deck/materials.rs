//! `[materials.x]`: one flat table for all models; which keys a model takes is checked when the model is built.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Numbers, Table};
use crate::diagnostic::At;

/// A material.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// The constitutive model.
    #[schemars(required)]
    pub model: Maybe<Model>,
    /// Young's modulus, force per area, above 0. Alias: `E`.
    #[schemars(required)]
    pub youngs_modulus: Maybe<f64>,
    /// Poisson's ratio, above -1, at most 0.5. Needed by beams and shells. Alias: `nu`.
    pub poisson_ratio: Maybe<f64>,
    /// Mass per volume, above 0. Needed by everything that has mass. Alias: `rho`.
    pub density: Maybe<f64>,
    /// Initial yield stress in tension, above 0. (elastic-plastic, elastic-viscoplastic)
    pub yield_stress: Maybe<f64>,
    /// Slope of the yield stress over the plastic strain, 0 or more. Default: 0, perfectly plastic. (elastic-
    /// plastic, elastic-viscoplastic)
    pub hardening_modulus: Maybe<f64>,
    /// [[plastic strain, yield stress], ...], straight lines from plastic strain 0 on, constant after the last,
    /// instead of `yield_stress` and `hardening_modulus`. (elastic-plastic, elastic-viscoplastic)
    pub hardening: Maybe<Vec<At<Numbers<2>>>>,
    /// Mixed-hardening ratio: the part of the hardening that is kinematic, 0 (isotropic) to 1. Default: 0.
    /// (elastic-plastic, elastic-viscoplastic)
    pub kinematic_share: Maybe<f64>,
    /// How the overstress grows with the rate of plastic strain. (elastic-viscoplastic)
    pub viscosity: Maybe<Table<Viscosity>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// Linear elasticity.
    Elastic,
    /// J2 (von Mises) plasticity with isotropic and kinematic hardening, rate independent.
    ElasticPlastic,
    /// J2 plasticity with an overstress that depends on the rate of plastic strain (Perzyna).
    ElasticViscoplastic,
}

/// Perzyna: rate of plastic strain = rate * phi(stress / yield stress - 1).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscosity {
    /// The overstress function phi.
    #[schemars(required)]
    pub law: Maybe<Overstress>,
    /// Fluidity, per unit of time, above 0. With the power law: Cowper-Symonds' D.
    #[schemars(required)]
    pub rate: Maybe<f64>,
    /// Exponent of the power law, 1 to 100: Cowper-Symonds' q.
    pub exponent: Maybe<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Overstress {
    /// phi(x) = x^exponent; with rate = D and exponent = q the law of Cowper and Symonds.
    Power,
    /// phi(x) = x.
    Linear,
    /// phi(x) = exp(x) - 1.
    Exponential,
}
