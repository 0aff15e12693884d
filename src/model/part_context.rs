//! The context for reading the tables of deformable parts.

use super::beams::station_file::GivenStations;
use super::groups::Groups;
use super::materials::Materials;
use super::names::Names;
use super::parts::Parts;
use super::places::nodes::Nodes;
use super::report::Report;
use super::sections::Sections;
use deck::Deck;

/// Names and materials are known; nodes, parts, sections and used mesh groups grow from table to table.
pub(super) struct PartContext<'a, 'd> {
    /// The deck.
    pub deck: &'d Deck,
    /// The names of points, bodies, sets and groups.
    pub names: &'a Names<'d>,
    /// The materials by name.
    pub materials: &'a Materials<'d>,
    /// The sections, computed where a beam names them first.
    pub sections: Sections<'a, 'd>,
    /// The stations that files give to beams, in their order.
    pub station_files: &'d [Option<GivenStations>],
    /// The groups of the mesh, and the parts that take them.
    pub groups: Groups<'d>,
    /// The nodes so far.
    pub nodes: &'a mut Nodes,
    /// The parts so far.
    pub parts: Parts,
    /// The report for errors.
    pub report: &'a mut Report<'d>,
}
