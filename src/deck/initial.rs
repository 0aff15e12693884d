//! `[[initial]]`: motion at t = 0.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Vector};

/// Velocities at t = 0. Of several that cover a node, the last one counts; it also replaces what a body says itself.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Names of points, bodies, beams, bars or sets, or "all".
    #[schemars(required)]
    pub at: Maybe<Names>,
    pub velocity: Maybe<Vector>,
    /// Global components, radians per time.
    pub angular_velocity: Maybe<Vector>,
    /// The motion is that of a rigid body about this point, which has the velocity. Default: node by node.
    pub about: Maybe<Vector>,
}
