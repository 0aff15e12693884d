//! Sets of one part, one instance or the assembly. Sets of nodes and sets of elements have separate names.

use std::collections::HashMap;

/// The kind of a set's members.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SetKind {
    /// Nodes.
    Nodes,
    /// Elements.
    Elements,
}

/// A set by the block that holds it and its index there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SetIndex {
    /// The block that holds it.
    pub block: BlockIndex,
    /// The instance whose numbers it means, if the block is a part.
    pub instance: Option<usize>,
    /// Its index in the sets of the block.
    pub set: usize,
}

/// The index of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BlockIndex {
    /// All that stands outside parts and instances: a flat file, or the assembly.
    Root,
    /// A part.
    Part(usize),
    /// An instance.
    Instance(usize),
}

/// Members of a set as the file gives them, with the line.
pub enum Member {
    /// One number, in the instance or where the set stands.
    Number(u64, Option<usize>, u32),
    /// First, last and step. Numbers between that do not exist are passed over.
    Range([u64; 3], Option<usize>, u32),
    /// All members of another set of the same kind.
    Set(SetIndex),
    /// All nodes of the elements of a set.
    NodesOf(SetIndex, u32),
}

/// A set of nodes or of elements.
pub struct Set {
    /// The name as the file first spells it.
    pub name: String,
    /// The kind of its members.
    pub kind: SetKind,
    /// The members.
    pub members: Vec<Member>,
}

/// The sets of a block.
#[derive(Default)]
pub struct Sets {
    /// Index in `list`, by the kind and the name in lower case.
    names: HashMap<(SetKind, String), usize>,
    /// All sets in the order of their first names in the file.
    pub list: Vec<Set>,
}

impl Sets {
    /// The index of a set.
    pub fn find(&self, kind: SetKind, name: &str) -> Option<usize> {
        self.names.get(&(kind, name.to_ascii_lowercase())).copied()
    }

    /// The index of a set; a new set is added.
    pub fn place(&mut self, kind: SetKind, name: &str) -> usize {
        let next = self.list.len();
        let place = *self.names.entry((kind, name.to_ascii_lowercase())).or_insert(next);
        if place == next {
            self.list.push(Set { name: name.to_owned(), kind, members: Vec::new() });
        }
        place
    }
}
