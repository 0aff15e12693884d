//! `[environment]` and `[damping]`: loads and damping on the whole model.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Numbers, Table, Vector};
use base::diagnostic::At;

/// Acceleration fields.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Acceleration of free fall, global components. Default: none.
    pub gravity: Maybe<Vector>,
    /// Name of the amplitude that multiplies gravity. Default: constant in dynamics, growing linearly in statics.
    pub gravity_amplitude: Maybe<String>,
    /// Names of the stages in which gravity acts. Default: all.
    pub gravity_stages: Maybe<Names>,
    /// Accelerations of the ground. Displacements, velocities and accelerations are then relative to the ground.
    #[serde(default)]
    pub base_acceleration: Vec<At<Table<BaseAcceleration>>>,
}

/// Acceleration of the ground along a direction: scale times amplitude.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BaseAcceleration {
    /// Direction of the acceleration; its length does not count.
    #[schemars(required)]
    pub direction: Maybe<Vector>,
    /// Name of the amplitude that gives the acceleration over time.
    #[schemars(required)]
    pub amplitude: Maybe<String>,
    /// Factor on the amplitude, such as 9.81 for a record in g. With `unit` in the amplitude it is a factor on the whole record. Default: 1.
    pub scale: Maybe<f64>,
}

/// Damping of the whole structure and of single nodes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Rayleigh's alpha in C = alpha M + beta K, per unit of time, 0 or more. It acts on velocities relative to supports that move
    /// together, otherwise relative to the ground. Default: 0. Alias: `alpha`.
    pub mass_factor: Maybe<f64>,
    /// Rayleigh's beta in C = alpha M + beta K, a time, 0 or more. It acts on strain rates of beams, bars and shells, and on springs of
    /// links and joints, not on stops, friction and contacts. Default: 0. Alias: `beta`.
    pub stiffness_factor: Maybe<f64>,
    /// Instead of both, a part of critical damping at two frequencies. It determines alpha and beta.
    pub rayleigh: Maybe<Table<RayleighDamping>>,
    /// Damping of the first modes, besides, in dynamic analyses by implicit schemes. They are the modes of the drawn state without loads.
    pub modal: Maybe<Table<ModalDamping>>,
    /// Dampers from nodes to the ground.
    #[serde(default)]
    pub nodal: Vec<At<Table<NodalDamping>>>,
}

/// Rayleigh damping by the part of critical damping at two frequencies: alpha / (2 w) + beta w / 2 at w = 2 pi f. It is less between them
/// and more outside. `check` shows alpha and beta.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayleighDamping {
    /// Part of critical damping at both frequencies, 0 to below 1.
    pub ratio: Maybe<f64>,
    /// Instead, one at each frequency.
    pub ratios: Maybe<Numbers<2>>,
    /// Two frequencies in ascending order, cycles per unit of time, such as those of two modes.
    #[schemars(required)]
    pub frequencies: Maybe<Numbers<2>>,
}

/// Damping by modes: C = Σ 2 ζ ω M φ φᵀ M. Motions across these modes are not damped by it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModalDamping {
    /// Part ζ of critical damping of each mode, 0 to below 1; with `modes`.
    pub ratio: Maybe<f64>,
    /// Number of modes with that ratio, 1 or more.
    pub modes: Maybe<u64>,
    /// Instead of both, ζ of each mode, the lowest first.
    pub ratios: Maybe<Vec<At<f64>>>,
}

/// A damper from a node to the ground.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodalDamping {
    /// Names of points, bodies or sets.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Force per velocity, 0 or more. Default: 0.
    pub translation: Maybe<f64>,
    /// Moment per angular velocity, 0 or more. Default: 0.
    pub rotation: Maybe<f64>,
}
