//! `damping` of single parts, links and joints.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

/// Rayleigh damping of one part: each key replaces that of `[damping]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartDamping {
    /// Rayleigh's alpha on the mass of the part, per unit of time, 0 or more. Default: that of `[damping]`.
    pub alpha: Maybe<f64>,
    /// Rayleigh's beta on the elastic stiffness of the part, a time, 0 or more. Default: that of `[damping]`.
    pub beta: Maybe<f64>,
}

/// Damping of one link, or along the coordinate of one joint.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringDamping {
    /// Not for links and joints, which have no mass.
    pub alpha: Maybe<f64>,
    /// Rayleigh's beta on the elastic stiffness of the spring, a time, 0 or more. Default: that of `[damping]`.
    pub beta: Maybe<f64>,
    /// Force per rate, or moment per angular velocity, of a damper beside the spring, 0 or more; a bushing has
    /// `bushing_damping`. Default: 0.
    pub viscous: Maybe<f64>,
    /// Exponent a of the force viscous·|v|^a of a damper along the line of a link, above 0 to 4; `viscous` is the force at the rate 1.
    /// Default: 1.
    pub exponent: Maybe<f64>,
    /// Rate v₀ well below which the force is linear, with |v| = √(v² + v₀²) in the power: a thousandth of the largest rate, above 0.
    /// Required with an exponent below 1; default: 0.
    pub slow: Maybe<f64>,
}
