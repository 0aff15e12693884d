//! `[[attachments]]`: the constraint map, nodes onto bodies or beams.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Directions, Maybe, Names};

/// Points that move with a body, or each with the nearest node of a beam, at the end of a rigid arm.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// Name of the body that the nodes are attached to.
    pub body: Maybe<String>,
    /// Name of a beam, instead of a body: each node is attached to the nearest node of it. Where the beam is
    /// rigid, all go with its body.
    pub beam: Maybe<String>,
    /// Names of points, bodies, parts or sets. Nodes on the beam itself keep their places.
    #[schemars(required)]
    pub nodes: Maybe<Names>,
    /// Distance from the body's centre, or from a node of the beam, above 0: only nodes within it are attached. The head of a bolt holds the
    /// shell around it. Default: all nodes.
    pub within: Maybe<f64>,
    /// Degrees of freedom that are taken from the body or beam. Default: "all".
    pub dofs: Maybe<Directions>,
    /// How the constraint is enforced. Default: "auto".
    pub method: Maybe<AttachmentMethod>,
}

/// Method that enforces an attachment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AttachmentMethod {
    /// Elimination, and Lagrange multipliers only where a node is attached a second time or more than 24 hinges hang one on the other.
    Auto,
    /// The dependent degrees of freedom are eliminated.
    Elimination,
    /// Lagrange multipliers hold the nodes to the body; the degrees of freedom of both stay unknowns.
    Multipliers,
}
