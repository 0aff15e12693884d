//! The deformable parts of a scene in the making, and where each table of the deck has left its nodes and elements.

use std::cell::OnceCell;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use super::data::{Part, SectionFacts};
use super::report::Report;
use base::diagnostic::Span;
use base::math::Mat3;
use deck::Deck;
use deck::parts::PartIndex;
use linear::available_memory;
use mechanics::sections::{SectionStresses, Stiffness};

/// Largest number of elements in a segment, and in a patch; more are taken for a typing error, and would exhaust memory.
pub(super) const MOST_IN_SEGMENT: u64 = 1_000_000;
pub(super) const MOST_IN_PATCH: usize = 1_000_000;
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
    /// Numbers of sections of polygons.
    pub sections: Vec<SectionFacts>,
    /// Ends of beams that are held to their points in some directions alone.
    pub releases: Vec<ReleasedEnd>,
    /// One for each table of a deformable part that has been begun.
    entries: BTreeMap<PartIndex, PartEntry>,
    /// True where the elements of paths and patches together do not fit into memory.
    too_many: bool,
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

    /// Counts the elements that paths and patches are to be cut into, before any takes memory. The table with which they become more than there
    /// is memory for is an error; nothing is then cut.
    pub fn foresee(&mut self, deck: &Deck, report: &mut Report) {
        let mut asked = 0_usize;
        let most = OnceCell::new();
        for (elements, place) in asked_elements(deck) {
            asked = asked.saturating_add(elements);
            let most = || *most.get_or_init(|| available_memory().map_or(f64::INFINITY, |bytes| bytes / BYTES));
            if asked < FEW || asked as f64 <= most() {
                continue;
            }
            let message = format!("with this the deck has {asked} elements");
            let hint = format!("they need at least {:.1} GB, more memory than there is", BYTES * asked as f64 / 1e9);
            report.error_with::<()>(place, message, hint);
            self.too_many = true;
            break;
        }
    }

    /// `None` where the elements of the deck together do not fit into memory.
    pub fn require_room(&self) -> Option<()> {
        (!self.too_many).then_some(())
    }
}

/// The number of elements that each path and patch asks for, with its place, in the order of reading. Numbers that are too large for one path or
/// patch are left out: they are errors of their own.
fn asked_elements(deck: &Deck) -> impl Iterator<Item = (usize, &Span)> {
    let beams = deck.beams.iter().map(|beam| (&beam.elements, &beam.path));
    let bars = deck.bars.iter().map(|bar| (&bar.elements, &bar.path));
    let lines = beams.chain(bars).filter_map(|(elements, path)| {
        let (counts, points) = (elements.as_ref()?, path.as_ref()?);
        let segments = if counts.value.single { points.value.values.len().saturating_sub(1) } else { 1 };
        let sum = counts.value.values.iter().map(|count| count.value as usize).fold(0, usize::saturating_add);
        let sound = counts.value.values.iter().all(|count| count.value <= MOST_IN_SEGMENT);
        sound.then(|| (sum.saturating_mul(segments), &counts.span))
    });
    let patches = deck.shells.iter().filter_map(|shell| {
        let counts = shell.elements.as_ref()?;
        let [first, last] = [counts.value.values.first()?, counts.value.values.last()?];
        let elements = (first.value as usize).saturating_mul(last.value as usize);
        (elements <= MOST_IN_PATCH).then_some((elements, &counts.span))
    });
    lines.chain(patches)
}
