//! `[[initial]]`: motion at t = 0.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Table, Vector};
use base::diagnostic::At;

/// Velocities at t = 0. Several tables may give a node different quantities. Two different values of one quantity, or a value that differs
/// from that of the node's body, are an error unless the later table `replaces` the earlier one.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Names of points, bodies, beams, bars, shells, edges or sets, or "all".
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Velocity, global components.
    pub velocity: Maybe<Vector>,
    /// Angular velocity, global components, radians per unit of time.
    pub angular_velocity: Maybe<Vector>,
    /// Global point of a rigid motion: the nodes move with `velocity` at this point. Default: the velocities hold node by node.
    pub about: Maybe<Vector>,
    /// Velocity along the normals of shells instead of `velocity`; corners run counter-clockwise about the normal. Where patches meet, the
    /// mean of their normals counts.
    pub normal_velocity: Maybe<f64>,
    /// True if the values replace those of earlier tables and of bodies at the same nodes. Default: false.
    pub replaces: Maybe<bool>,
    /// Name of the dynamic stage that begins with it. Default: the first.
    pub stages: Maybe<Names>,
    /// Factors on the velocities that vary from node to node; several multiply.
    pub profile: Maybe<Vec<At<Table<Profile>>>>,
}

/// A factor by place: an amplitude whose time is a distance or an angle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Name of an amplitude, whose time is here the distance or the angle.
    #[schemars(required)]
    pub amplitude: Maybe<String>,
    /// Direction of the distance, or reference direction of the angle.
    #[schemars(required)]
    pub direction: Maybe<Vector>,
    /// Takes the angle about this axis, in radians from -pi to pi, instead of the distance.
    pub axis: Maybe<Vector>,
    /// The point where the distance is zero, or a point of the axis, global coordinates. Default: the origin.
    pub center: Maybe<Vector>,
}
