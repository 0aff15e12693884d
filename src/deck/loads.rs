//! `[[loads]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names, Vector};

/// A force or moment on points or bodies.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Names of points, bodies or sets; each gets the whole load.
    #[schemars(required)]
    pub at: Maybe<Names>,
    /// Global components.
    pub force: Maybe<Vector>,
    /// Global components.
    pub moment: Maybe<Vector>,
    /// Turns with its node. Default: false.
    pub follower: Maybe<bool>,
    /// Name of an amplitude that multiplies the load. Default: constant (dynamic), growing linearly (static).
    pub amplitude: Maybe<String>,
}
