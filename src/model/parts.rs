//! The deformable parts of a scene in the making, and where each table of the deck has left its nodes and elements.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::data::Part;
use super::report::Report;
use base::diagnostic::Span;
use base::math::Mat3;
use deck::parts::PartIndex;
use linear::available_memory;
use mechanics::sections::{SectionStresses, Stiffness};

/// Least memory of an element in bytes, with its nodes and its part of the matrix before factorization.
const BYTES: f64 = 4e3;
/// Fewer elements are not compared with the free memory: the answer takes 0.1 ms, which is felt in sweeps of small cases.
const FEW: usize = 2500;

/// The parts and nodes that one table of the deck has become.
#[derive(Default)]
pub(super) struct PartEntry {
    /// Its nodes; of a beam or bar that follows a path, in order along it.
    pub nodes: Vec<usize>,
    /// Nodes of each edge of a patch of shells, in order along it.
    pub edges: Vec<Vec<usize>>,
    /// Its parts in the list, none where it has errors.
    pub range: Range<usize>,
    /// Contact radius: half of its thickness unless given.
    pub contact_radius: f64,
    /// The node of the deck or mesh that carries each node of its elements, where these lie beside them.
    pub carried: HashMap<usize, usize>,
    /// Nodes of its elements where these have left the model because the part is rigid.
    pub rigid_elements: Option<Vec<Vec<usize>>>,
}

/// The end of a beam that is held to its point but for released rotations.
pub(super) struct ReleasedEnd {
    /// The name of the end.
    pub name: String,
    /// The point, and the node at the end of the beam.
    pub ends: [usize; 2],
    /// Rotations about the axes of the section that are held.
    pub held: [bool; 3],
    /// Axes of the section.
    pub axes: Mat3,
}

/// The deformable parts of a scene that is being built.
#[derive(Default)]
pub(super) struct Parts {
    /// The parts, in deck order.
    pub list: Vec<Part>,
    /// Section stiffnesses and inertias, shared by the beams that name them.
    pub stiffnesses: Vec<Stiffness>,
    /// What stresses of these sections follow from.
    pub stresses: Vec<Option<SectionStresses>>,
    /// Ends of beams that are held to their points in some directions alone.
    pub releases: Vec<ReleasedEnd>,
    /// One for each table of a deformable part that has been begun.
    entries: BTreeMap<PartIndex, PartEntry>,
    /// Elements that paths and patches have asked for so far.
    asked: usize,
    /// The number of elements that fit into memory, once determined.
    most: Option<f64>,
}

impl Parts {
    /// Begins a part: it has an entry, also where it has errors.
    pub fn begin(&mut self, at: PartIndex) {
        self.entries.insert(at, PartEntry::default());
    }

    /// Lists the model parts made of one table.
    pub fn add(&mut self, at: PartIndex, made: impl IntoIterator<Item = Part>) {
        let first = self.list.len();
        self.list.extend(made);
        self.entry_mut(at).range = first..self.list.len();
    }

    /// The entry of a deformable part; `None` where it has not been begun.
    pub fn entry(&self, at: PartIndex) -> Option<&PartEntry> {
        self.entries.get(&at)
    }

    /// The entry of a part that has been begun.
    pub fn entry_mut(&mut self, at: PartIndex) -> &mut PartEntry {
        self.entries.entry(at).or_default()
    }

    /// All entries with their part index, in deck order.
    pub fn entries(&self) -> impl Iterator<Item = (PartIndex, &PartEntry)> {
        self.entries.iter().map(|(at, entry)| (*at, entry))
    }

    /// The model parts made of one table; none after errors.
    pub fn of(&self, at: PartIndex) -> &[Part] {
        self.entry(at).map_or(&[], |entry| &self.list[entry.range.clone()])
    }

    /// Nodes of the elements of a part, also of a rigid one.
    pub fn elements(&self, at: PartIndex) -> Vec<Vec<usize>> {
        let deformable = || {
            let parts = self.of(at).iter();
            parts.flat_map(|part| (0..part.elements()).map(|element| part.nodes(element).to_vec())).collect()
        };
        self.entry(at).and_then(|entry| entry.rigid_elements.clone()).unwrap_or_else(deformable)
    }

    /// Like [`Parts::elements`], by the nodes of the deck or mesh where the elements lie beside them.
    pub fn elements_by_name(&self, at: PartIndex) -> Vec<Vec<usize>> {
        let mut elements = self.elements(at);
        if let Some(carried) = self.entry(at).map(|entry| &entry.carried).filter(|carried| !carried.is_empty()) {
            let nodes = elements.iter_mut().flatten();
            nodes.for_each(|node| *node = carried.get(node).copied().unwrap_or(*node));
        }
        elements
    }

    /// True where a node belongs to a deformable part.
    pub fn has_node(&self, node: usize) -> bool {
        self.entries.values().any(|entry| entry.nodes.contains(&node))
    }

    /// Counts elements that paths and patches are to be cut into, before they take memory. Together more than
    /// there is memory for are an error.
    pub fn ask_for(&mut self, elements: usize, place: &Span, report: &mut Report) -> Option<()> {
        let before = self.asked;
        self.asked = before.saturating_add(elements);
        if self.asked < FEW {
            return Some(());
        }
        let most = *self.most.get_or_insert_with(|| available_memory().map_or(f64::INFINITY, |bytes| bytes / BYTES));
        if self.asked as f64 <= most {
            return Some(());
        }
        // Later parts exceed the limit too, so the error is reported once.
        if before as f64 <= most {
            let message = format!("with this the deck has {} elements", self.asked);
            let hint =
                format!("they need at least {:.1} GB, more memory than there is", BYTES * self.asked as f64 / 1e9);
            report.error_with::<()>(place, message, hint);
        }
        None
    }
}
