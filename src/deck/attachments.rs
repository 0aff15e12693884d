//! `[[attachments]]`: the constraint map, nodes onto bodies or beams.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Directions, Maybe, Names};

/// Points that move with a body, or each with the nearest node of a beam, at the end of a rigid arm.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Name of a body.
    pub body: Maybe<String>,
    /// Name of a beam, instead of a body. Where the beam is rigid, all of them go with its body.
    pub beam: Maybe<String>,
    /// Names of points, bodies or sets. Those on the beam itself stay as they are.
    #[schemars(required)]
    pub nodes: Maybe<Names>,
    /// Which motions are taken from the body or beam. Default: "all".
    pub dofs: Maybe<Directions>,
    /// Default: "auto".
    pub method: Maybe<AttachmentMethod>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AttachmentMethod {
    /// Elimination, and multipliers only where a node is attached a second time.
    Auto,
    /// The attached motions leave the unknowns.
    Elimination,
    /// The motions of both stay unknown, and forces hold them together.
    Multipliers,
}
