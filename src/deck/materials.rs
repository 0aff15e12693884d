//! `[materials.x]`: one flat table for all models; which keys a model takes is checked when the model is built.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Numbers, Table};
use crate::diagnostic::At;

/// A material.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    #[schemars(required)]
    pub model: Maybe<Model>,
    /// Force per area.
    #[schemars(required)]
    pub youngs_modulus: Maybe<f64>,
    /// Above -1, at most 0.5. Needed by beams.
    pub poisson_ratio: Maybe<f64>,
    /// Mass per volume. Needed by everything that has mass.
    pub density: Maybe<f64>,
    /// Stress at which it begins to yield, in tension: elastic-plastic, elastic-viscoplastic.
    pub yield_stress: Maybe<f64>,
    /// Slope of the yield stress over the plastic strain. Default: 0, perfectly plastic.
    pub hardening_modulus: Maybe<f64>,
    /// [[plastic strain, yield stress], ...], straight lines from plastic strain 0 on; instead of yield_stress and
    /// hardening_modulus.
    pub hardening: Maybe<Vec<At<Numbers<2>>>>,
    /// Share of the hardening that shifts the yield surface instead of widening it, 0 to 1. Default: 0.
    pub kinematic_share: Maybe<f64>,
    /// How the overstress grows with the rate of plastic strain: elastic-viscoplastic.
    pub viscosity: Maybe<Table<Viscosity>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    Elastic,
    /// J2 plasticity, rate independent.
    ElasticPlastic,
    /// J2 plasticity with an overstress (Perzyna).
    ElasticViscoplastic,
}

/// Perzyna: rate of plastic strain = rate * phi(stress / yield stress - 1).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscosity {
    #[schemars(required)]
    pub law: Maybe<Overstress>,
    /// 1/time. With the power law: Cowper-Symonds' D.
    #[schemars(required)]
    pub rate: Maybe<f64>,
    /// Of the power law, 1 or more: Cowper-Symonds' q.
    pub exponent: Maybe<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Overstress {
    /// x^exponent.
    Power,
    /// x.
    Linear,
    /// exp(x) - 1.
    Exponential,
}
