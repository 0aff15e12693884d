//! `[mesh]`: nodes, elements and groups from a file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::words::Maybe;

/// A mesh from a file. Each of its groups is a set of nodes by its name; shells and beams are made of groups by `group`. Where several
/// groups have one name, lists of nodes take the set of nodes and `group` the set of elements. `node-set:NAME`, `element-set:NAME`,
/// `line-set:NAME` and `face-set:NAME` say which, and `INSTANCE.NAME` names a set of an instance or a part.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Path relative to the deck's folder: Gmsh in ASCII (.msh, 4.1 or 2.2), or Abaqus or CalculiX input (.inp).
    #[schemars(required)]
    pub file: Maybe<String>,
    /// Factor on all coordinates, above 0. Default: 1.
    pub scale: Maybe<f64>,
}
