//! Properties that every table of a part reports, each in the file of its kind, and common keys of deformable parts.

use super::part_damping::PartDamping;
use super::words::{Maybe, Names, NumberOrTable, OneOrMany, Table};
use base::diagnostic::At;
use schemars::JsonSchema;
use serde::Deserialize;

/// The table of a part. The defaults describe a part without the property.
pub trait PartTable {
    /// The name that the table gives the part.
    fn name(&self) -> Option<&At<String>>;

    /// The group of the mesh that the part is made of.
    fn group(&self) -> Option<&At<String>> {
        None
    }

    /// Names of nodes, groups or parts that the part consists of, joins or touches.
    fn members(&self) -> Vec<&At<String>>;

    /// True if the name of the part represents its nodes in a list of points, bodies and sets, because its inner nodes have no names.
    fn is_node_list(&self) -> bool {
        false
    }

    /// Number of named edges, such as `roof.edge1`.
    fn named_edges(&self) -> usize {
        0
    }

    /// The name of the material that it is made of.
    fn material(&self) -> Option<&At<String>> {
        None
    }

    /// Its own Rayleigh damping.
    fn damping(&self) -> Option<&At<Table<PartDamping>>> {
        None
    }

    /// How many elements the part is cut into; `None` where more of them would make it another part.
    fn elements(&self) -> Option<&At<OneOrMany<u64>>> {
        None
    }

    /// The polynomial degree of its elements; `None` where the deck has no say in it.
    fn order(&self) -> Option<u64> {
        None
    }

    /// The key `rigid`; `None` for a part that cannot be a body.
    fn rigid(&self) -> Option<bool> {
        None
    }

    /// The key `reduced`.
    fn reduced(&self) -> Option<&At<NumberOrTable<Table<ReducedTable>>>> {
        None
    }
}

/// The names of a list, none where it is missing.
pub(super) fn names(list: &Option<At<Names>>) -> Vec<&At<String>> {
    list.iter().flat_map(|list| &list.value.values).collect()
}

/// The shapes that a reduced part keeps.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReducedTable {
    /// The number of modes with a fixed interface, the lowest, 0 to 500. Default: 20.
    pub modes: Maybe<u64>,
    /// The highest frequency of these modes, above 0, in cycles per time. Default: without bound.
    pub up_to: Maybe<f64>,
    /// Pieces of a beam along a path, each with these modes and a frame of its own. Beams that bend by more than 0.3 rad need several. Default: 1.
    pub pieces: Maybe<u64>,
    /// Bending shortens the part, and forces in it stiffen it: terms of second order. Parts with more than 100 unknowns of interface and modes
    /// have none. Default: true.
    pub geometric_stiffness: Maybe<bool>,
}

/// Where the mass of a part goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// At the nodes, by the element's Lobatto rule: a diagonal (lumped) mass matrix.
    #[default]
    Lumped,
    /// Translations by the element's shape functions, with off-diagonal terms; rotary inertia at the nodes.
    Consistent,
    /// Lumped, but without the mass at nodes that are rigidly attached to a body.
    FreeNodes,
    /// The part has no mass.
    None,
}
