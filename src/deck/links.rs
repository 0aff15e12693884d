//! `[[links]]`: springs, dampers and gaps between two points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Numbers, Table, Vector};
use crate::diagnostic::At;

/// A spring and damper between two ends, along the line between them, along a direction, or a bushing.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Link {
    #[schemars(required)]
    pub name: Maybe<String>,
    #[schemars(required)]
    pub from: Maybe<Table<End>>,
    #[schemars(required)]
    pub to: Maybe<Table<End>>,
    /// Force against elongation. Default: "linear".
    pub law: Maybe<Law>,
    /// Force per length: linear, compression-only, tension-only.
    pub stiffness: Maybe<f64>,
    /// Force per velocity. Default: 0.
    pub damping: Maybe<f64>,
    /// Free play before the link acts. Default: 0. compression-only, tension-only.
    pub gap: Maybe<f64>,
    /// Force at zero elongation, tension positive. Default: 0. linear.
    pub preload: Maybe<f64>,
    /// Length without force, or projection without force along `direction`. Default: as the ends lie at t = 0.
    pub free_length: Maybe<f64>,
    /// Fixed global direction from `from` to `to`, for coincident points and for bumpers; otherwise along the line between
    /// them, which turns round when one point passes the other.
    pub direction: Maybe<Vector>,
    /// [[elongation, force], ...]: table.
    pub points: Maybe<Vec<At<Numbers<2>>>>,
    /// Six stiffnesses [x, y, z, about x, about y, about z] in the frame of the first end, instead of a law.
    pub bushing: Maybe<Numbers<6>>,
    /// Six damping values of the bushing. Default: 0.
    pub bushing_damping: Maybe<Numbers<6>>,
    /// Axes of the bushing at t = 0: x, and a vector in the x-y plane. Default: global.
    pub axes: Maybe<Vec<Vector>>,
}

/// `{ node = "name" }`, `{ body = "name", point = [x, y, z] }` or `{ ground = [x, y, z] }`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// Name of a point.
    pub node: Maybe<String>,
    /// Name of a body.
    pub body: Maybe<String>,
    /// Where on the body, global coordinates at t = 0. Default: its centre.
    pub point: Maybe<Vector>,
    /// A fixed point, global coordinates.
    pub ground: Maybe<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    Linear,
    /// Straight lines through `points`; the end slopes go on.
    Table,
    CompressionOnly,
    TensionOnly,
}
