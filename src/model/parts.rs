//! The deformable parts of a scene in the making, and where each table of the deck has left its nodes and elements.

use std::ops::Range;

use super::data::Part;
use super::place::Place;
use super::report::Report;
use crate::diagnostic::Span;
use crate::sections::Stiffness;

/// The most elements of all beams, bars and shells together; more, at some kilobytes each, are a slip of the keyboard.
const MOST_ELEMENTS: usize = 2_000_000;

/// What one table of the deck has become.
#[derive(Default)]
pub(super) struct PartEntry {
    /// Its nodes; of a beam or bar that follows a path, in order along it.
    pub nodes: Vec<usize>,
    /// Nodes of each edge of a patch of shells, in order along it.
    pub edges: Vec<Vec<usize>>,
    /// Its parts in the list, none where it has errors.
    pub range: Range<usize>,
    /// Faces that left the model because the shell is rigid.
    pub rigid_faces: Option<Vec<Vec<usize>>>,
}

#[derive(Default)]
pub(super) struct Parts {
    pub list: Vec<Part>,
    /// Section stiffnesses and inertias, shared by the beams that name them.
    pub stiffnesses: Vec<Stiffness>,
    // One entry for each table of the deck.
    pub beams: Vec<PartEntry>,
    pub bars: Vec<PartEntry>,
    pub shells: Vec<PartEntry>,
    /// Elements that paths and patches have asked for so far.
    elements: usize,
}

impl Parts {
    /// The entry of a beam, bar or shell.
    pub fn entry(&self, place: Place) -> Option<&PartEntry> {
        match place {
            Place::Beam(beam) => self.beams.get(beam),
            Place::Bar(bar) => self.bars.get(bar),
            Place::Shell(shell) => self.shells.get(shell),
            _ => None,
        }
    }

    /// The parts that a table of the deck has become.
    pub fn of(&self, entry: &PartEntry) -> &[Part] {
        &self.list[entry.range.clone()]
    }

    /// Nodes of the faces of a shell, also of a rigid one.
    pub fn faces(&self, shell: usize) -> Vec<Vec<usize>> {
        let entry = &self.shells[shell];
        let deformable = || {
            let parts = self.of(entry).iter();
            parts.flat_map(|part| (0..part.elements()).map(|element| part.nodes(element).to_vec())).collect()
        };
        entry.rigid_faces.clone().unwrap_or_else(deformable)
    }

    /// Whether a node belongs to a deformable part.
    pub fn has_node(&self, node: usize) -> bool {
        self.beams.iter().chain(&self.bars).chain(&self.shells).any(|entry| entry.nodes.contains(&node))
    }

    /// Counts elements that paths and patches are to be cut into, before they take memory. Together more than
    /// [`MOST_ELEMENTS`] are an error.
    pub fn ask_for(&mut self, elements: usize, place: &Span, report: &mut Report) -> Option<()> {
        let before = self.elements;
        self.elements = before.saturating_add(elements);
        if self.elements <= MOST_ELEMENTS {
            return Some(());
        }
        // This is said once: all that comes after is too many as well.
        if before <= MOST_ELEMENTS {
            let message = format!("with this the deck has {} elements", self.elements);
            let hint = format!("at most {MOST_ELEMENTS} are allowed in all beams, bars and shells together");
            report.error_with::<()>(place, message, hint);
        }
        None
    }
}
