//! Parts, their instances and the assembly: the blocks with nodes, elements and sets.

use super::sets::{BlockIndex, SetIndex, SetKind, Sets};
use crate::mesh::draft::RawElement;
use base::math::{Vec3, rotation};
use nalgebra::Quaternion;

/// Nodes, elements and sets that stand together in the file.
#[derive(Default)]
pub struct Block {
    /// The name of the part, the instance or the assembly.
    pub name: String,
    /// Number, place and line of each node.
    pub nodes: Vec<(u64, Vec3, u32)>,
    /// The elements of types that are read.
    pub elements: Vec<RawElement>,
    /// The numbers of all other elements.
    pub others: Vec<u64>,
    /// The sets.
    pub sets: Sets,
}

/// A part where it stands in the assembly.
pub struct Instance {
    /// The nodes, elements and sets of the instance itself.
    pub own: Block,
    /// Its part.
    pub part: usize,
    /// Translation, in the axes and the unit of length of the file.
    pub translation: Vec3,
    /// A point of the axis about which it is then turned, and the rotation.
    pub rotation: Option<(Vec3, Quaternion<f64>)>,
    /// The number of lines read for its position.
    pub rows: usize,
    /// Its line, counted from 1.
    pub line: usize,
}

impl Instance {
    /// Turns it about an axis from one point to another, by an angle in degrees. `None` where the points coincide.
    pub fn turn(&mut self, from: Vec3, to: Vec3, degrees: f64) -> Option<()> {
        let axis = (to - from).try_normalize(0.0)?;
        self.rotation = Some((from, rotation::exp(&(axis * degrees.to_radians()))));
        Some(())
    }

    /// Where a point of the part is in the assembly.
    pub fn place(&self, x: &Vec3) -> Vec3 {
        let x = x + self.translation;
        self.rotation.map_or(x, |(center, q)| center + rotation::matrix(&q) * (x - center))
    }
}

/// All blocks of a file.
pub struct Blocks {
    /// The data outside parts and instances.
    pub root: Block,
    /// The parts.
    pub parts: Vec<Block>,
    /// The instances.
    pub instances: Vec<Instance>,
    /// The block of the current line.
    pub at: BlockIndex,
}

impl Default for Blocks {
    fn default() -> Self {
        let root = Block { name: "Assembly".to_owned(), ..Block::default() };
        Blocks { root, parts: Vec::new(), instances: Vec::new(), at: BlockIndex::Root }
    }
}

impl Blocks {
    /// A block.
    pub fn block(&self, at: BlockIndex) -> &Block {
        match at {
            BlockIndex::Root => &self.root,
            BlockIndex::Part(part) => &self.parts[part],
            BlockIndex::Instance(instance) => &self.instances[instance].own,
        }
    }

    /// The block of the current line.
    pub fn block_mut(&mut self) -> &mut Block {
        match self.at {
            BlockIndex::Root => &mut self.root,
            BlockIndex::Part(part) => &mut self.parts[part],
            BlockIndex::Instance(instance) => &mut self.instances[instance].own,
        }
    }

    /// The index of a set in the current block; a new set is added.
    pub fn place(&mut self, kind: SetKind, name: &str) -> usize {
        self.block_mut().sets.place(kind, name)
    }

    /// Begins a part.
    pub fn begin_part(&mut self, name: &str) {
        self.at = BlockIndex::Part(self.parts.len());
        self.parts.push(Block { name: name.to_owned(), ..Block::default() });
    }

    /// Begins an instance; `None` where there is no such part.
    pub fn begin_instance(&mut self, name: &str, part: &str, line: usize) -> Option<()> {
        let part = self.parts.iter().position(|known| known.name.eq_ignore_ascii_case(part))?;
        self.add_instance(name, part, line);
        self.at = BlockIndex::Instance(self.instances.len() - 1);
        Some(())
    }

    /// Adds an instance that is not moved.
    pub fn add_instance(&mut self, name: &str, part: usize, line: usize) {
        let own = Block { name: name.to_owned(), ..Block::default() };
        self.instances.push(Instance { own, part, translation: Vec3::zeros(), rotation: None, rows: 0, line });
    }

    /// The instance of a name, or the first of the part of that name.
    pub fn instance(&self, name: &str) -> Option<usize> {
        let own = self.instances.iter().position(|instance| instance.own.name.eq_ignore_ascii_case(name));
        let of_part = |instance: &Instance| self.parts[instance.part].name.eq_ignore_ascii_case(name);
        own.or_else(|| self.instances.iter().position(of_part))
    }

    /// Finds a set by name: in the given instance, in the current block, or in the instance named before a point.
    pub fn refer(&self, instance: Option<usize>, kind: SetKind, name: &str) -> Option<SetIndex> {
        let within = |instance: usize, name: &str| {
            let find = |block: BlockIndex| {
                let set = self.block(block).sets.find(kind, name)?;
                Some(SetIndex { block, instance: Some(instance), set })
            };
            find(BlockIndex::Instance(instance)).or_else(|| find(BlockIndex::Part(self.instances[instance].part)))
        };
        if let Some(instance) = instance {
            return within(instance, name);
        }
        if let Some(set) = self.block(self.at).sets.find(kind, name) {
            return Some(SetIndex { block: self.at, instance: None, set });
        }
        if let BlockIndex::Instance(instance) = self.at {
            return within(instance, name);
        }
        let (of, name) = name.split_once('.')?;
        within(self.instance(of)?, name)
    }

    /// Instance and number of a node or an element in the form `P-1.3`.
    pub fn number_in_instance(&self, name: &str) -> Option<(usize, u64)> {
        let (instance, id) = name.split_once('.')?;
        Some((self.instance(instance)?, id.parse().ok()?))
    }
}
