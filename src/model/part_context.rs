//! What the tables of deformable parts are read with.

use super::groups::Groups;
use super::materials::Materials;
use super::names::Names;
use super::nodes::Nodes;
use super::parts::Parts;
use super::report::Report;
use super::sections::Sections;
use crate::deck::Deck;

/// Names and materials are known; nodes, parts, sections and what is taken of the mesh grow from table to table.
pub(super) struct PartContext<'a, 'd> {
    pub deck: &'d Deck,
    pub names: &'a Names<'d>,
    pub materials: &'a Materials<'d>,
    pub sections: Sections<'a, 'd>,
    pub groups: Groups<'d>,
    pub nodes: &'a mut Nodes,
    pub parts: Parts,
    pub report: &'a mut Report<'d>,
}
