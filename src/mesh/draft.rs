//! What a reader collects, by the file's own numbers, and what is checked when all of it is there.

use super::text::{Fault, Text};
use super::{Element, Group, Kind, Mesh, Node, Skipped};
use crate::diagnostic::Diagnostic;
use crate::math::Vec3;
use std::collections::HashMap;

/// More messages about one file help nobody.
const MOST_FAULTS: usize = 20;
/// Area or length of an element, relative to its longest side, that is round-off of its coordinates.
const NOTHING: f64 = 1e-12;

#[derive(Default)]
pub struct Draft {
    pub nodes: Vec<Node>,
    pub lines: Vec<u32>,
    pub elements: Vec<RawElement>,
    pub groups: Vec<RawGroup>,
    pub skipped: Vec<Skipped>,
    pub faults: Vec<Fault>,
    places: HashMap<String, usize>,
}

/// With the file's numbers of its nodes.
#[derive(Clone, Copy)]
pub struct RawElement {
    pub id: u64,
    pub kind: Kind,
    pub nodes: [u64; 4],
    pub line: u32,
}

#[derive(Default)]
pub struct RawGroup {
    pub name: String,
    /// Indices into [`Draft::elements`].
    pub elements: Vec<u32>,
    /// Numbers of nodes that are given by themselves, with the line.
    pub nodes: Vec<(u64, u32)>,
    pub skipped: usize,
}

impl Draft {
    pub fn node(&mut self, id: u64, x: Vec3, line: usize) {
        self.nodes.push(Node { id, x });
        self.lines.push(short(line));
    }

    /// The element's index.
    pub fn element(&mut self, id: u64, kind: Kind, nodes: [u64; 4], line: usize) -> u32 {
        self.elements.push(RawElement { id, kind, nodes, line: short(line) });
        short(self.elements.len() - 1)
    }

    pub fn skip(&mut self, what: &str, count: usize, line: usize) {
        let next = self.skipped.len();
        let place = *self.places.entry(what.to_owned()).or_insert(next);
        if place == next {
            self.skipped.push(Skipped { what: what.to_owned(), count: 0, line });
        }
        self.skipped[place].count += count;
    }

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
        Ok(Mesh { nodes: self.nodes, elements, groups, skipped: self.skipped, ids })
    }

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

    /// The element by indices of its nodes; reports one that is none.
    fn checked(&mut self, text: &Text, ids: &Ids, raw: &RawElement) -> Element {
        let (kind, line) = (raw.kind, raw.line as usize);
        let mut element = Element { id: raw.id, kind, nodes: [0; 4], line: raw.line };
        for (node, id) in element.nodes.iter_mut().zip(&raw.nodes[..kind.size()]) {
            let Some(index) = ids.get(*id) else {
                self.complain(text, line, Some(*id), || {
                    format!("element {} has node {id}, which is not there", raw.id)
                });
                return element;
            };
            *node = short(index);
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
        if let Some(what) = flaw(kind, &x) {
            self.complain(text, line, None, || format!("element {} {what}", raw.id));
        }
        element
    }

    fn resolved(&mut self, text: &Text, ids: &Ids) -> Vec<Group> {
        let mut groups = Vec::new();
        // Per node and per element: the last group that took it.
        let (mut of_node, mut of_element) = (vec![0u32; self.nodes.len()], vec![0u32; self.elements.len()]);
        for (index, raw) in std::mem::take(&mut self.groups).into_iter().enumerate() {
            let mark = short(index + 1);
            let mut group = Group { name: raw.name, skipped: raw.skipped, ..Group::default() };
            let mut take = |group: &mut Group, node: usize| {
                if std::mem::replace(&mut of_node[node], mark) != mark {
                    group.nodes.push(short(node));
                }
            };
            for (id, line) in raw.nodes {
                match ids.get(id) {
                    Some(node) => take(&mut group, node),
                    None => {
                        let name = group.name.clone();
                        let message = || format!("`{name}` holds node {id}, which is not there");
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
                // A node that is not there has been reported.
                nodes[..kind.size()].iter().filter_map(|&id| ids.get(id)).for_each(|node| take(&mut group, node));
            }
            group.elements.sort_unstable();
            groups.push(group);
        }
        groups
    }
}

/// What an element lacks. Its corners as the file has them; beyond its kind's the last is repeated.
fn flaw(kind: Kind, x: &[Vec3; 4]) -> Option<&'static str> {
    let n = kind.size();
    let longest = (0..n).map(|i| (x[(i + 1) % n] - x[i]).norm()).fold(0.0, f64::max);
    if kind == Kind::Segment {
        let size = x[0].amax().max(x[1].amax());
        return (longest <= NOTHING * size).then_some("has no length");
    }
    let corner = |i: usize| (x[(i + 1) % n] - x[i]).cross(&(x[(i + n - 1) % n] - x[i]));
    let area: Vec3 = (0..n).map(corner).sum();
    let least = NOTHING * longest * longest;
    if area.norm().is_nan() || area.norm() <= least {
        return Some("has no area");
    }
    // A corner seen from the other side: the sides cross, or go in.
    let folded = (0..n).any(|i| corner(i).dot(&area) <= least * area.norm());
    folded.then_some("is not convex: go round its corners one after the other")
}

/// Indices and lines, of which a file of a few gigabytes has fewer than this.
pub fn short(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

/// From the file's numbers to indices: a table where the numbers lie close, else a sorted list.
#[derive(Debug)]
pub enum Ids {
    /// Index + 1, by number; 0 for none.
    Table(Vec<u32>),
    Sorted(Vec<(u64, u32)>),
}

impl Ids {
    /// With the indices of numbers that came before.
    pub fn new(ids: impl ExactSizeIterator<Item = u64> + Clone) -> (Ids, Vec<usize>) {
        let (count, last) = (ids.len() as u64, ids.clone().max().unwrap_or(0));
        let mut again = Vec::new();
        if last <= 8 * count + 1000 {
            let mut table = vec![0u32; last as usize + 1];
            for (index, id) in ids.enumerate() {
                let entry = &mut table[id as usize];
                if *entry == 0 {
                    *entry = short(index + 1);
                } else {
                    again.push(index);
                }
            }
            return (Ids::Table(table), again);
        }
        let mut sorted: Vec<(u64, u32)> = ids.enumerate().map(|(index, id)| (id, short(index))).collect();
        sorted.sort_unstable();
        sorted.dedup_by(|later, first| {
            let same = later.0 == first.0;
            if same {
                again.push(later.1 as usize);
            }
            same
        });
        (Ids::Sorted(sorted), again)
    }

    pub fn get(&self, id: u64) -> Option<usize> {
        match self {
            Ids::Table(table) => (*table.get(usize::try_from(id).ok()?)? as usize).checked_sub(1),
            Ids::Sorted(sorted) => {
                let at = sorted.binary_search_by_key(&id, |entry| entry.0).ok()?;
                Some(sorted[at].1 as usize)
            }
        }
    }
}
