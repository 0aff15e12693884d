//! `[materials.x]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

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
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    Elastic,
}
