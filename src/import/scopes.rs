//! Scopes of nodes, elements and sets: the file itself or its assembly, parts, and instances of parts.

use crate::element_types::ElementType;
use base::math::{Mat3, Vec3, rotation};
use std::collections::HashMap;

/// The offset of a number beyond those of its instance. Such a number never falls on the next instance.
pub const NOWHERE: u64 = 1 << 40;

/// A part, an instance, or all that stands outside of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ScopeIndex {
    /// The file, or the assembly.
    #[default]
    Outer,
    /// A part.
    Part(usize),
    /// An instance.
    Instance(usize),
}

/// Nodes and elements, or a set of either, as a line names them.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct NamedTarget {
    /// Where the line stands.
    pub scope: ScopeIndex,
    /// The name of a set, or a number.
    pub name: String,
    /// True where it cannot be a number.
    pub is_set: bool,
    /// The line in the text.
    pub line: usize,
}

/// An element as the file has it.
#[derive(Debug, Clone)]
pub struct PlacedElement {
    /// Its number.
    pub id: u64,
    /// Index of its type in [`Scopes::types`].
    pub kind: usize,
    /// Numbers of its nodes.
    pub nodes: Vec<u64>,
    /// Its instance, which may be turned.
    pub instance: Option<usize>,
    /// Its line.
    pub line: usize,
}

/// Sets of one kind by name.
#[derive(Debug, Default)]
pub struct SetTable {
    /// Name and numbers, in the order of the file.
    pub list: Vec<(String, Vec<u64>)>,
    places: HashMap<String, usize>,
}

impl SetTable {
    /// The numbers of a set.
    pub fn find(&self, name: &str) -> Option<&[u64]> {
        self.places.get(&name.to_lowercase()).map(|&at| &self.list[at].1[..])
    }

    /// The numbers of a set; adds a new set.
    pub fn place(&mut self, name: &str) -> &mut Vec<u64> {
        let next = self.list.len();
        let at = *self.places.entry(name.to_lowercase()).or_insert(next);
        if at == next {
            self.list.push((name.to_owned(), Vec::new()));
        }
        &mut self.list[at].1
    }
}

/// Which sets are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Members {
    /// Sets of nodes.
    Nodes,
    /// Sets of elements.
    Cells,
}

/// The nodes, elements and sets of one scope. Numbers of an instance and of the assembly are those of the flat mesh.
#[derive(Debug, Default)]
pub struct ScopeContent {
    /// The name.
    pub name: String,
    /// Number and place of each node.
    pub nodes: Vec<(u64, Vec3)>,
    /// The elements.
    pub cells: Vec<PlacedElement>,
    /// The places of the nodes read so far by number, as [`ScopeContent::update`] left them, and their count.
    pub places: (HashMap<u64, Vec3>, usize),
    /// The indices of the elements read so far by number, likewise.
    pub cells_at: (HashMap<u64, usize>, usize),
    /// Sets of nodes.
    pub node_sets: SetTable,
    /// Sets of elements.
    pub cell_sets: SetTable,
    /// Surfaces: the set or number on each of their lines, and the side.
    pub surfaces: HashMap<String, Vec<(NamedTarget, String)>>,
}

impl ScopeContent {
    /// Brings the maps of nodes and elements up to date.
    pub fn update(&mut self) {
        let (map, count) = &mut self.places;
        map.extend(self.nodes[*count..].iter().copied());
        *count = self.nodes.len();
        let (map, count) = &mut self.cells_at;
        map.extend(self.cells[*count..].iter().zip(*count..).map(|(cell, at)| (cell.id, at)));
        *count = self.cells.len();
    }

    /// Its sets of a kind.
    pub fn sets(&self, of: Members) -> &SetTable {
        if of == Members::Nodes { &self.node_sets } else { &self.cell_sets }
    }
}

/// Where an instance stands.
#[derive(Debug)]
pub struct Placement {
    /// The content of the instance itself.
    pub own: ScopeContent,
    /// Its part.
    pub part: usize,
    /// The offset of its numbers.
    pub offset: u64,
    /// Translation.
    pub translation: Vec3,
    /// A point of the axis about which it is then turned, and the rotation.
    pub turn: Option<(Vec3, Mat3)>,
    /// Lines of data that say so.
    pub rows: usize,
}

impl Placement {
    /// Turns it about an axis from one point to another by an angle in degrees; `None` where the points coincide.
    pub fn set_turn(&mut self, from: Vec3, to: Vec3, degrees: f64) -> Option<()> {
        let axis = (to - from).try_normalize(0.0)?;
        self.turn = Some((from, rotation::matrix(&rotation::exp(&(axis * degrees.to_radians())))));
        Some(())
    }

    /// Where a point of the part is.
    fn place(&self, x: &Vec3) -> Vec3 {
        let x = x + self.translation;
        self.turn.as_ref().map_or(x, |(center, turn)| center + turn * (x - center))
    }
}

/// All scopes of a file.
#[derive(Debug, Default)]
pub struct Scopes {
    /// The content outside of parts and instances.
    pub outer: ScopeContent,
    /// The offset of numbers there.
    pub outer_offset: u64,
    /// The difference of offsets between one instance and the next.
    pub step: u64,
    /// The largest number of a node or an element.
    pub largest: u64,
    /// The parts.
    pub parts: Vec<ScopeContent>,
    /// The instances.
    pub instances: Vec<Placement>,
    /// The scope of the line being read.
    pub at: ScopeIndex,
    /// The types of elements in the file.
    pub types: Vec<ElementType>,
    /// Nodes and elements that keywords have made.
    pub made: u64,
}

impl Scopes {
    /// What a scope holds.
    pub fn content(&self, at: ScopeIndex) -> &ScopeContent {
        match at {
            ScopeIndex::Outer => &self.outer,
            ScopeIndex::Part(part) => &self.parts[part],
            ScopeIndex::Instance(instance) => &self.instances[instance].own,
        }
    }

    /// The content of the scope of the line being read.
    pub fn here(&mut self) -> &mut ScopeContent {
        match self.at {
            ScopeIndex::Outer => &mut self.outer,
            ScopeIndex::Part(part) => &mut self.parts[part],
            ScopeIndex::Instance(instance) => &mut self.instances[instance].own,
        }
    }

    /// The offset of numbers on the line being read; numbers of parts have none until parts are placed.
    pub fn offset_here(&self) -> u64 {
        match self.at {
            ScopeIndex::Outer => self.outer_offset,
            ScopeIndex::Part(_) => 0,
            ScopeIndex::Instance(instance) => self.instances[instance].offset,
        }
    }

    /// The index of a type of elements.
    pub fn kind(&mut self, name: &str) -> usize {
        let kind = ElementType::new(name);
        let found = self.types.iter().position(|known| *known == kind);
        found.unwrap_or_else(|| {
            self.types.push(kind);
            self.types.len() - 1
        })
    }

    /// The instance of a name, or the first one of the part of that name.
    pub fn instance(&self, name: &str) -> Option<usize> {
        let same = |other: &str| other.to_lowercase() == name.to_lowercase();
        let own = self.instances.iter().position(|instance| same(&instance.own.name));
        own.or_else(|| self.instances.iter().position(|instance| same(&self.parts[instance.part].name)))
    }

    /// A number of an instance in the flat mesh. A number beyond those of the instance becomes one that does not exist.
    pub fn shifted(&self, id: u64, offset: u64) -> u64 {
        if self.step > 0 && id >= self.step { id + NOWHERE } else { id + offset }
    }

    /// Numbers in the flat mesh of a set of an instance or of its part.
    fn of_instance(&self, instance: usize, of: Members, name: &str) -> Option<Vec<u64>> {
        let placed = &self.instances[instance];
        if let Some(own) = placed.own.sets(of).find(name) {
            return Some(own.to_vec());
        }
        let set = self.parts[placed.part].sets(of).find(name)?;
        Some(set.iter().map(|id| self.shifted(*id, placed.offset)).collect())
    }

    /// The numbers that a name or a number stands for. Those of a part are its own as long as it has no instances.
    pub fn members(&self, at: &NamedTarget, of: Members) -> Option<Vec<u64>> {
        let NamedTarget { scope, name, is_set, .. } = at;
        let number = name.parse::<u64>().ok().filter(|_| !is_set);
        let of_part = |part: usize| self.instances.iter().filter(move |instance| instance.part == part);
        if let ScopeIndex::Part(part) = *scope
            && let Some(local) =
                number.map(|id| vec![id]).or_else(|| self.parts[part].sets(of).find(name).map(<[u64]>::to_vec))
        {
            return match of_part(part).next() {
                None => Some(local),
                Some(_) => {
                    Some(of_part(part).flat_map(|at| local.iter().map(|id| self.shifted(*id, at.offset))).collect())
                }
            };
        }
        if let Some(id) = number {
            let offset = match scope {
                ScopeIndex::Instance(instance) => self.instances[*instance].offset,
                _ => self.outer_offset,
            };
            return Some(vec![self.shifted(id, offset)]);
        }
        if let ScopeIndex::Instance(instance) = *scope
            && let Some(found) = self.of_instance(instance, of, name)
        {
            return Some(found);
        }
        if let Some(found) = self.outer.sets(of).find(name) {
            return Some(found.to_vec());
        }
        let (instance, inner) = name.split_once('.')?;
        let instance = self.instance(instance)?;
        match inner.parse::<u64>() {
            Ok(id) => Some(vec![self.shifted(id, self.instances[instance].offset)]),
            Err(_) => self.of_instance(instance, of, inner),
        }
    }

    /// The lines of a surface.
    pub fn surface(&self, at: &NamedTarget) -> Option<Vec<(NamedTarget, String)>> {
        let key = at.name.to_lowercase();
        let find = |scope: ScopeIndex| self.content(scope).surfaces.get(&key).cloned();
        let dotted = || {
            let (instance, inner) = key.split_once('.')?;
            let at = self.instance(instance)?;
            let own = self.instances[at].own.surfaces.get(inner);
            let lines = own.or_else(|| self.parts[self.instances[at].part].surfaces.get(inner))?;
            let placed = |set: &NamedTarget| NamedTarget { scope: ScopeIndex::Instance(at), ..set.clone() };
            Some(lines.iter().map(|(set, side)| (placed(set), side.clone())).collect())
        };
        find(at.scope).or_else(|| find(ScopeIndex::Outer)).or_else(dotted)
    }

    /// Places parts once where the file has no instances at all.
    pub fn place_parts(&mut self) {
        if self.instances.is_empty() {
            for part in (0..self.parts.len()).filter(|&part| !self.parts[part].nodes.is_empty()).collect::<Vec<_>>() {
                let name = self.parts[part].name.clone();
                self.add_instance(&name, part, 0);
            }
        }
    }

    /// Adds an instance at the position of its part.
    pub fn add_instance(&mut self, name: &str, part: usize, offset: u64) {
        let own = ScopeContent { name: name.to_owned(), ..ScopeContent::default() };
        self.instances.push(Placement { own, part, offset, translation: Vec3::zeros(), turn: None, rows: 0 });
    }

    /// All nodes and elements with their numbers in the flat mesh.
    pub fn flat(&self) -> (Vec<(u64, Vec3)>, Vec<PlacedElement>) {
        let (mut nodes, mut cells) = (Vec::new(), Vec::new());
        for (index, at) in self.instances.iter().enumerate() {
            let part = &self.parts[at.part];
            nodes.extend(part.nodes.iter().map(|(id, x)| (id + at.offset, at.place(x))));
            nodes.extend(at.own.nodes.iter().map(|(id, x)| (*id, at.place(x))));
            let placed = |cell: &PlacedElement, offset: u64| PlacedElement {
                id: cell.id + offset,
                nodes: cell.nodes.iter().map(|id| if *id == 0 { 0 } else { self.shifted(*id, offset) }).collect(),
                instance: Some(index),
                ..cell.clone()
            };
            cells.extend(part.cells.iter().map(|cell| placed(cell, at.offset)));
            cells.extend(at.own.cells.iter().map(|cell| placed(cell, 0)));
        }
        nodes.extend(self.outer.nodes.iter().copied());
        cells.extend(self.outer.cells.iter().cloned());
        (nodes, cells)
    }
}
