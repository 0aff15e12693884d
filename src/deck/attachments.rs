//! `[[attachments]]`: the constraint map, nodes onto bodies.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Directions, Maybe, Names};

/// Points that move with a body.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Name of a body.
    #[schemars(required)]
    pub body: Maybe<String>,
    /// Names of points, bodies or sets.
    #[schemars(required)]
    pub nodes: Maybe<Names>,
    /// Which motions are taken from the body. Default: "all".
    pub dofs: Maybe<Directions>,
    /// Default: "auto".
    pub method: Maybe<Method>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    Auto,
    /// The attached motions leave the unknowns.
    Elimination,
}
