//! `[mesh]`: nodes, elements and groups from a file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

/// A mesh from a file. Each of its groups is a set of nodes by its name; shells and beams are made of groups by `group`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Path relative to the deck's folder: Gmsh in ASCII (.msh, 4.1 or 2.2), or Abaqus or CalculiX input (.inp).
    #[schemars(required)]
    pub file: Maybe<String>,
    /// Factor on all coordinates, above 0. Default: 1.
    pub scale: Maybe<f64>,
}
