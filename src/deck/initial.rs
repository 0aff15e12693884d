//! `[[initial]]`: motion at t = 0.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Table, Vector};
use crate::diagnostic::At;

/// Velocities at t = 0. Of several that cover a node, the last one counts; it also replaces what a body says itself.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Names of points, bodies, beams, bars, shells, edges or sets, or "all".
    #[schemars(required)]
    pub at: Maybe<Names>,
    pub velocity: Maybe<Vector>,
    /// Global components, radians per time.
    pub angular_velocity: Maybe<Vector>,
    /// The motion is that of a rigid body about this point, which has the velocity. Default: node by node.
    pub about: Maybe<Vector>,
    /// Instead of velocity: along the normals of shells, which see the corners go round counter-clockwise; where patches
    /// meet, along the mean of theirs.
    pub normal_velocity: Maybe<f64>,
    /// Factors of the velocities that vary from node to node; several multiply.
    pub profile: Maybe<Vec<At<Table<Profile>>>>,
}

/// A factor by place: an amplitude whose time is a distance or an angle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Name of an amplitude.
    #[schemars(required)]
    pub amplitude: Maybe<String>,
    /// The distance is measured along this direction, an angle from it.
    #[schemars(required)]
    pub direction: Maybe<Vector>,
    /// Takes the angle about this axis, in radians, from -pi to pi, instead of the distance.
    pub axis: Maybe<Vector>,
    /// Where the distance is zero, or a point of the axis. Default: the origin.
    pub center: Maybe<Vector>,
}
