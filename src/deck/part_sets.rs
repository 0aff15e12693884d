//! `[[parts]]`: several parts as one.

use schemars::JsonSchema;
use serde::Deserialize;

use super::part_table::ReducedTable;
use super::words::{Maybe, Names, NumberOrTable, Table};

/// Beams and shells that are reduced together: nodes that they share are inside, and the modes are those of the whole.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartSet {
    /// Name, for messages.
    #[schemars(required)]
    pub name: Maybe<String>,
    /// Names of beams and shells, groups of the mesh of which these are made, or sets of them.
    #[schemars(required)]
    pub parts: Maybe<Names>,
    /// The parts deform by so many modes with a fixed interface, and by the static shapes of the interface, as `reduced` of one part says.
    #[schemars(required)]
    pub reduced: Maybe<NumberOrTable<Table<ReducedTable>>>,
}
