//! The mesh while a reader collects it, by the numbers of the file, and the checks when it is complete.

use super::data::{CellShape, GroupKind, MOST_CELL_NODES, Mesh, MeshElement, MeshGroup, MeshNode, MeshNote, Skipped};
use super::ids::{Ids, short};
use base::diagnostic::Diagnostic;
use base::math::{Vec3, curved_faces};
use base::text_file::{Fault, Text};
use std::collections::{HashMap, HashSet};

/// The most messages that are shown about one file.
const MOST_FAULTS: usize = 20;
/// An element whose area or length, relative to its longest side, is smaller than this has none but for round-off.
const SHAPE_TOLERANCE: f64 = 1e-12;

/// A mesh that is being read.
#[derive(Default)]
pub struct Draft {
    /// The nodes so far, in the order of the file.
    pub nodes: Vec<MeshNode>,
    /// The line of each node.
    pub lines: Vec<u32>,
    /// The elements so far, in the order of the file.
    pub elements: Vec<RawElement>,
    /// The groups so far, in the order of their first names in the file.
    pub groups: Vec<RawGroup>,
    /// Parts of the file that were not read.
    pub skipped: Vec<Skipped>,
    /// Notes on parts of the file read in an unexpected way.
    pub notes: Vec<MeshNote>,
    /// True where case has no meaning in names of groups.
    pub folds_case: bool,
    /// Errors so far.
    pub faults: Vec<Fault>,
    /// Index in `skipped` by `Skipped::what`.
    places: HashMap<String, usize>,
}

/// An element whose nodes are given by their numbers in the file.
#[derive(Clone, Copy)]
pub struct RawElement {
    /// The number in the file.
    pub id: u64,
    /// The shape, which gives the number of its nodes.
    pub kind: CellShape,
    /// The numbers of its nodes in the file; those beyond their number mean nothing.
    pub nodes: [u64; MOST_CELL_NODES],
    /// The number of a node that gives the direction of its section.
    pub toward: Option<u64>,
    /// The line in the file, counted from 1.
    pub line: u32,
}

impl RawElement {
    /// The element with an offset added to all its numbers.
    pub fn moved(mut self, offset: u64) -> Self {
        self.id += offset;
        self.nodes[..self.kind.size()]
            .iter_mut()
            .chain(&mut self.toward)
            .for_each(|node| *node = node.saturating_add(offset));
        self
    }
}

/// A group whose nodes are given by their numbers in the file.
#[derive(Default)]
pub struct RawGroup {
    /// The name in the file.
    pub name: String,
    /// The kind of its members.
    pub kind: GroupKind,
    /// Names that may stand before its own, with a point between.
    pub scopes: Vec<String>,
    /// True outside parts and instances.
    pub is_outer: bool,
    /// Indices into [`Draft::elements`].
    pub elements: Vec<u32>,
    /// Numbers of the nodes that the file lists, with the line.
    pub nodes: Vec<(u64, u32)>,
    /// The number of its elements of shapes that are not read.
    pub skipped: usize,
}

impl Draft {
    /// An empty mesh; `folds_case`: case has no meaning in names of groups.
    pub fn new(folds_case: bool) -> Self {
        Draft { folds_case, ..Draft::default() }
    }

    /// Adds a node.
    pub fn node(&mut self, id: u64, x: Vec3, line: usize) {
        self.nodes.push(MeshNode { id, x });
        self.lines.push(short(line));
    }

    /// Adds an element and returns its index.
    pub fn element(&mut self, id: u64, kind: CellShape, nodes: [u64; MOST_CELL_NODES], line: usize) -> u32 {
        self.elements.push(RawElement { id, kind, nodes, toward: None, line: short(line) });
        short(self.elements.len() - 1)
    }

    /// Drops repeated nodes and elements that are identical. Groups must not hold any elements yet.
    pub fn drop_repeated(&mut self) {
        let (ids, again) = Ids::new(self.nodes.iter().map(|node| node.id));
        let first = |id: u64| ids.get(id).unwrap_or(usize::MAX);
        let same: HashSet<usize> =
            again.into_iter().filter(|&at| self.nodes.get(first(self.nodes[at].id)) == self.nodes.get(at)).collect();
        retain(&mut self.nodes, &same);
        retain(&mut self.lines, &same);
        let (ids, again) = Ids::new(self.elements.iter().map(|element| element.id));
        let is_same = |at: &usize| {
            let of = |element: &RawElement| (element.kind, element.nodes, element.toward);
            let other = ids.get(self.elements[*at].id).map(|first| of(&self.elements[first]));
            other == Some(of(&self.elements[*at]))
        };
        let same = again.into_iter().filter(is_same).collect();
        retain(&mut self.elements, &same);
    }

    /// Counts parts of the file that are not read.
    pub fn skip(&mut self, what: &str, count: usize, line: usize) {
        let next = self.skipped.len();
        let place = *self.places.entry(what.to_owned()).or_insert(next);
        if place == next {
            self.skipped.push(Skipped { what: what.to_owned(), count: 0, line });
        }
        self.skipped[place].count += count;
    }

    /// The mesh, once the file is read.
    ///
    /// # Errors
    /// All errors found, at least one.
    pub fn finish(mut self, text: &Text) -> Result<Mesh, Vec<Diagnostic>> {
        if self.nodes.is_empty() && self.faults.is_empty() {
            self.faults.push(text.fault_at_end("the file has no nodes"));
        }
        let (ids, again) = Ids::new(self.nodes.iter().map(|node| node.id));
        for index in again {
            let (id, line) = (self.nodes[index].id, self.lines[index] as usize);
            self.complain(text, line, Some(id), || format!("node {id} is given twice"));
        }
        let (_, again) = Ids::new(self.elements.iter().map(|element| element.id));
        for index in again {
            let RawElement { id, line, .. } = self.elements[index];
            self.complain(text, line as usize, Some(id), || format!("element {id} is given twice"));
        }
        let mut elements = Vec::with_capacity(self.elements.len());
        for index in 0..self.elements.len() {
            let raw = self.elements[index];
            elements.push(self.checked(text, &ids, &raw));
        }
        let groups = self.resolved(text, &ids);
        if !self.faults.is_empty() {
            return Err(self.faults.into_iter().map(|fault| *fault).collect());
        }
        let by_name = by_name(&groups, self.folds_case);
        let Draft { nodes, skipped, notes, folds_case, .. } = self;
        Ok(Mesh { nodes, elements, groups, skipped, notes, ids, by_name, folds_case })
    }

    /// Notes an error at a line, and there at a number, unless there are too many.
    fn complain(&mut self, text: &Text, line: usize, id: Option<u64>, message: impl FnOnce() -> String) {
        if self.faults.len() == MOST_FAULTS {
            let message = format!("`{}` may have more errors; correct these first", text.path);
            self.faults.push(Box::new(Diagnostic::error(message)));
        }
        if self.faults.len() >= MOST_FAULTS {
            return;
        }
        self.faults.push(text.fault_on(message(), line, id));
    }

    /// The element with the indices of its nodes; reports its errors.
    fn checked(&mut self, text: &Text, ids: &Ids, raw: &RawElement) -> MeshElement {
        let (kind, line) = (raw.kind, raw.line as usize);
        let mut element = MeshElement { id: raw.id, kind, nodes: [0; MOST_CELL_NODES], toward: None, line: raw.line };
        for (node, id) in element.nodes.iter_mut().zip(&raw.nodes[..kind.size()]) {
            let Some(index) = ids.get(*id) else {
                self.complain(text, line, Some(*id), || {
                    format!("element {} has node {id}, which does not exist", raw.id)
                });
                return element;
            };
            *node = short(index);
        }
        if let Some(id) = raw.toward {
            element.toward = ids.get(id).map(short);
            if element.toward.is_none() {
                let message = || format!("element {} has the direction node {id}, which does not exist", raw.id);
                self.complain(text, line, Some(id), message);
            }
        }
        let nodes = element.nodes();
        for (i, node) in nodes.iter().enumerate() {
            if nodes[..i].contains(node) {
                let id = raw.nodes[i];
                self.complain(text, line, Some(id), || format!("element {} has node {id} twice", raw.id));
                return element;
            }
        }
        let x: [Vec3; 4] = std::array::from_fn(|i| self.nodes[nodes[i.min(nodes.len() - 1)] as usize].x);
        let at = |i: usize| self.nodes[nodes[i] as usize].x;
        let what = flaw(kind, &x).or_else(|| (kind.order() == 2).then(|| flaw_of_sides(kind, &at)).flatten());
        if let Some(what) = what {
            self.complain(text, line, None, || format!("element {} {what}", raw.id));
        }
        element
    }

    /// The groups with the indices of their nodes and elements.
    fn resolved(&mut self, text: &Text, ids: &Ids) -> Vec<MeshGroup> {
        let mut groups = Vec::new();
        // For each node and each element the last group with it is noted, so that no group holds it twice.
        let (mut of_node, mut of_element) = (vec![0u32; self.nodes.len()], vec![0u32; self.elements.len()]);
        for (index, raw) in std::mem::take(&mut self.groups).into_iter().enumerate() {
            let mark = short(index + 1);
            let RawGroup { name, kind, scopes, is_outer, skipped, .. } = raw;
            let mut group = MeshGroup { name, kind, scopes, is_outer, skipped, ..MeshGroup::default() };
            let mut take = |group: &mut MeshGroup, node: usize| {
                if std::mem::replace(&mut of_node[node], mark) != mark {
                    group.nodes.push(short(node));
                }
            };
            for (id, line) in raw.nodes {
                match ids.get(id) {
                    Some(node) => take(&mut group, node),
                    None => {
                        let name = group.name.clone();
                        let message = || format!("group `{name}` holds node {id}, which does not exist");
                        self.complain(text, line as usize, Some(id), message);
                    }
                }
            }
            for element in raw.elements {
                if std::mem::replace(&mut of_element[element as usize], mark) == mark {
                    continue;
                }
                group.elements.push(element);
                let RawElement { kind, nodes, .. } = self.elements[element as usize];
                // A node that does not exist is reported with its element.
                nodes[..kind.size()].iter().filter_map(|&id| ids.get(id)).for_each(|node| take(&mut group, node));
            }
            group.elements.sort_unstable();
            groups.push(group);
        }
        groups
    }
}

/// Takes entries out of a list.
fn retain<T>(list: &mut Vec<T>, without: &HashSet<usize>) {
    let mut at = 0..;
    list.retain(|_| !at.next().is_some_and(|at| without.contains(&at)));
}

/// The groups by the names under which they are found, also after the names of their scopes.
fn by_name(groups: &[MeshGroup], folds_case: bool) -> HashMap<String, Vec<u32>> {
    let mut by_name: HashMap<String, Vec<u32>> = HashMap::new();
    for (index, group) in groups.iter().enumerate() {
        let scoped = group.scopes.iter().map(|scope| format!("{scope}.{}", group.name));
        let names: HashSet<String> = scoped
            .chain([group.name.clone()])
            .map(|name| if folds_case { name.to_lowercase() } else { name })
            .collect();
        names.into_iter().for_each(|name| by_name.entry(name).or_default().push(short(index)));
    }
    by_name
}

/// The error of the nodes between the corners of an element, with its nodes at `x`.
fn flaw_of_sides(kind: CellShape, x: &impl Fn(usize) -> Vec3) -> Option<&'static str> {
    if kind.is_line() {
        let (along, from) = (x(1) - x(0), x(2) - x(0));
        let part = from.dot(&along) / along.norm_squared();
        return (!(0.25..=0.75).contains(&part)).then_some("has its node between too near to an end");
    }
    let n = kind.corners();
    let area: Vec3 = (0..n).map(|i| (x((i + 1) % n) - x(i)).cross(&(x((i + n - 1) % n) - x(i)))).sum();
    // With tangents against the mean normal the surface folds back.
    let folded = |[r, s]: &[Vec3; 2]| r.cross(s).dot(&area) <= 0.0;
    curved_faces::tangents_of(kind.size(), x).iter().any(folded).then_some("folds back on itself at one of its nodes")
}

/// The error of an element's shape, with its corners at `x` (the last one repeated up to four).
fn flaw(kind: CellShape, x: &[Vec3; 4]) -> Option<&'static str> {
    let n = kind.corners();
    let longest = (0..n).map(|i| (x[(i + 1) % n] - x[i]).norm()).fold(0.0, f64::max);
    if kind.is_line() {
        let size = x[0].amax().max(x[1].amax());
        return (longest <= SHAPE_TOLERANCE * size).then_some("has no length");
    }
    let corner = |i: usize| (x[(i + 1) % n] - x[i]).cross(&(x[(i + n - 1) % n] - x[i]));
    let area: Vec3 = (0..n).map(corner).sum();
    let least = SHAPE_TOLERANCE * longest * longest;
    if area.norm().is_nan() || area.norm() <= least {
        return Some("has no area");
    }
    // At a corner of the other sense the sides cross, or the corner is re-entrant.
    let folded = (0..n).any(|i| corner(i).dot(&area) <= least * area.norm());
    folded.then_some("is not convex: its nodes must follow each other around it")
}
