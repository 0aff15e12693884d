//! Hysteresis of links, and of joints along their coordinate: deterioration and pinching.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

/// Capping and deterioration of a backbone, after Ibarra, Medina and Krawinkler. A capacity times the yield force, or moment, is an energy. At
/// each half cycle a value loses the part (E/E_left)^exponent: E is the dissipation of the half cycle, E_left the rest of the capacity.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deterioration {
    /// Elongation from yielding to the largest force, above 0; of a hinge, radians. `post_yield_stiffness` leads there.
    #[schemars(required)]
    pub capping: Maybe<f64>,
    /// Elongation from the largest force down to no force, above 0.
    #[schemars(required)]
    pub post_capping: Maybe<f64>,
    /// Force that remains, as a part of the yield force, 0 to below 1. Default: 0.
    pub residual: Maybe<f64>,
    /// Elongation, of either sign, at which it breaks, above 0. Default: it does not.
    pub ultimate: Maybe<f64>,
    /// Capacity for the yield force and the slope beyond, an elongation above 0. Default: no loss.
    pub strength: Maybe<f64>,
    /// Capacity for the line beyond the cap. Default: no loss.
    pub softening: Maybe<f64>,
    /// Capacity for the slope of unloading, which falls at reversals. Default: no loss.
    pub unloading: Maybe<f64>,
    /// Exponent of the losses, 0.5 to 2. Default: 1.
    pub exponent: Maybe<f64>,
}

/// Reloading towards the largest elongation so far, in two lines, after Filippou.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pinching {
    /// Force at which the two lines meet, over the force aimed at: above 0 to 1. Default: 1, no pinching.
    pub force: Maybe<f64>,
    /// Elongation at which they meet: 0 at the place without force, 1 on the line of unloading from the target; above 0 to 1. Default: 1.
    pub elongation: Maybe<f64>,
    /// Growth of the elongation aimed at, at each reversal, by the largest elongation over that of first yield, less 1. 0 or more. Default: 0.
    pub ductility: Maybe<f64>,
    /// Growth by the energy dissipated so far over the area below both backbones. 0 or more. Default: 0.
    pub energy: Maybe<f64>,
    /// Exponent b of the slope of unloading: the first slope times (largest elongation over that of first yield)^-b. 0 or more. Default: 0.
    pub unloading: Maybe<f64>,
}
