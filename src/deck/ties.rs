//! `[[ties]]`: nodes held to the faces or nodes beside them.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::{Maybe, Names};

/// Nodes that move with the place beside them on the faces of shells, or with the nearest node: meshes that do not fit become one. A
/// multiplier holds each direction; a rigid arm bridges the distance.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// Name, for messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of points, bodies, parts or sets: the nodes that are tied. Of two meshes take the finer one. Nodes of `to` itself keep their
    /// places.
    #[schemars(required)]
    pub nodes: Maybe<Names>,
    /// Names of shells, or of groups of their faces. Or names of points, bodies, beams, bars and sets of nodes: each node is tied to the nearest of
    /// them.
    #[schemars(required)]
    pub to: Maybe<Names>,
    /// Largest distance of a tied node. Default: the thickness of the shell; for nodes 1e-6 of the size of the model.
    pub distance: Maybe<f64>,
    /// Treatment of nodes farther away. Default: "error".
    pub beyond: Maybe<Beyond>,
    /// Degrees of freedom that are tied. Nodes without rotations have translations alone. Default: "all".
    pub dofs: Maybe<TiedDofs>,
}

/// The treatment of nodes beyond the distance of a tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Beyond {
    /// They are an error.
    Error,
    /// They stay free: `nodes` may then name a whole part to tie one edge of it.
    Free,
}

/// Degrees of freedom of a tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TiedDofs {
    /// Translations and rotations: a weld.
    All,
    /// Translations alone: a hinge.
    Translations,
}
