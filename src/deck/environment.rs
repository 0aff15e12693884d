//! `[environment]` and `[damping]`: what acts everywhere.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Table, Vector};
use crate::diagnostic::At;

/// Acceleration fields.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Acceleration of free fall. Default: none.
    pub gravity: Maybe<Vector>,
    /// Accelerations of the ground; displacements are then relative to it.
    #[serde(default)]
    pub base_acceleration: Vec<At<Table<BaseAcceleration>>>,
}

/// Acceleration of the ground along a direction: scale times amplitude.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BaseAcceleration {
    /// Of any length; only its direction counts.
    #[schemars(required)]
    pub direction: Maybe<Vector>,
    /// Name of an amplitude.
    #[schemars(required)]
    pub amplitude: Maybe<String>,
    /// Default: 1.
    pub scale: Maybe<f64>,
}

/// Damping of the whole structure and of single nodes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// C = mass_factor M + stiffness_factor K. Per time. Default: 0.
    pub mass_factor: Maybe<f64>,
    /// Time; acts on strain rates of beams and bars. Default: 0.
    pub stiffness_factor: Maybe<f64>,
    #[serde(default)]
    pub nodal: Vec<At<Table<NodalDamping>>>,
}

/// A damper from a node to the ground.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodalDamping {
    /// Names of points, bodies or sets.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Force per velocity. Default: 0.
    pub translation: Maybe<f64>,
    /// Moment per angular velocity. Default: 0.
    pub rotation: Maybe<f64>,
}
