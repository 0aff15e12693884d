//! `[[supports]]`: motion that is given.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Directions, Maybe, Names, Table};

/// Directions held at rest or moved as told.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Names of points, bodies or sets.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Directions held at rest.
    pub fix: Maybe<Directions>,
    /// Directions moved as a function of time.
    pub motion: Maybe<Table<Motions>>,
}

/// Prescribed motion by direction.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motions {
    pub ux: Maybe<Table<Motion>>,
    pub uy: Maybe<Table<Motion>>,
    pub uz: Maybe<Table<Motion>>,
    pub rx: Maybe<Table<Motion>>,
    pub ry: Maybe<Table<Motion>>,
    pub rz: Maybe<Table<Motion>>,
}

/// A motion: scale times amplitude.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Name of an amplitude.
    #[schemars(required)]
    pub amplitude: Maybe<String>,
    /// Default: 1.
    pub scale: Maybe<f64>,
    /// What the amplitude describes. Default: "displacement".
    pub history: Maybe<History>,
}

/// The quantity that the amplitude of a prescribed motion gives over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum History {
    /// The displacement or, about an axis, the rotation.
    #[default]
    Displacement,
    /// The velocity, which is integrated from zero displacement on.
    Velocity,
    /// The acceleration, which is integrated twice.
    Acceleration,
}
