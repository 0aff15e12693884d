//! `[[initial]]`: motion at t = 0.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Table, Vector};
use base::diagnostic::At;

/// Velocities at t = 0. Several tables may give a node different quantities; two that give it different values of the same one, or
/// a value other than that of its body, are an error unless the later one `replaces` what the others give.
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
    /// The motion is that of a rigid body about this point, global coordinates, which has `velocity`. Default:
    /// the velocities hold node by node.
    pub about: Maybe<Vector>,
    /// Velocity along the normals of shells, which see the corners go round counter-clockwise, instead of
    /// `velocity`; where patches meet, along the mean of their normals.
    pub normal_velocity: Maybe<f64>,
    /// True where this takes the place of what earlier tables, and bodies in their own, give the same nodes. Default: false.
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
    /// The direction along which the distance is measured, or from which the angle is.
    #[schemars(required)]
    pub direction: Maybe<Vector>,
    /// Takes the angle about this axis, in radians from -pi to pi, instead of the distance.
    pub axis: Maybe<Vector>,
    /// The point where the distance is zero, or a point of the axis, global coordinates. Default: the origin.
    pub center: Maybe<Vector>,
}
