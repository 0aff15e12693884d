//! A mesh as its readers give it.

use super::ids::Ids;
use base::math::Vec3;
use std::collections::HashMap;

/// A mesh from a file. Its elements are valid: their nodes exist, are distinct and span a length or a convex area.
#[derive(Debug)]
pub struct Mesh {
    /// The nodes in the order of the file.
    pub nodes: Vec<MeshNode>,
    /// The elements in the order of the file.
    pub elements: Vec<MeshElement>,
    /// The groups in the order of their first names in the file.
    pub groups: Vec<MeshGroup>,
    /// Parts of the file that were not read.
    pub skipped: Vec<Skipped>,
    /// Notes on parts of the file read in an unexpected way.
    pub notes: Vec<MeshNote>,
    /// The indices of the nodes by their numbers in the file.
    pub(super) ids: Ids,
    /// Indices of groups by each name under which they are found.
    pub(super) by_name: HashMap<String, Vec<u32>>,
    /// True where case has no meaning in names of groups.
    pub(super) folds_case: bool,
}

/// A node of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshNode {
    /// The number in the file.
    pub id: u64,
    /// The position, in the axes and the unit of length of the file.
    pub x: Vec3,
}

/// The shape of an element of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CellShape {
    /// Two nodes.
    Segment,
    /// Three nodes.
    Triangle,
    /// Four nodes.
    Quadrilateral,
    /// Three nodes, the ends first.
    CurvedSegment,
    /// Six nodes, corners first, then those on the sides from each corner to the next.
    CurvedTriangle,
    /// Eight nodes in the same order.
    Serendipity,
    /// Nine nodes: the same, and the middle.
    CurvedQuadrilateral,
}

/// The largest number of nodes of an element.
pub const MOST_CELL_NODES: usize = 9;

impl CellShape {
    /// The number of its nodes.
    pub fn size(self) -> usize {
        match self {
            CellShape::Segment => 2,
            CellShape::Triangle => 3,
            CellShape::Quadrilateral => 4,
            CellShape::CurvedSegment => 3,
            CellShape::CurvedTriangle => 6,
            CellShape::Serendipity => 8,
            CellShape::CurvedQuadrilateral => 9,
        }
    }

    /// The number of its ends or corners.
    pub fn corners(self) -> usize {
        match self {
            CellShape::Segment | CellShape::CurvedSegment => 2,
            CellShape::Triangle | CellShape::CurvedTriangle => 3,
            CellShape::Quadrilateral | CellShape::Serendipity | CellShape::CurvedQuadrilateral => 4,
        }
    }

    /// True for segments, false for faces.
    pub fn is_line(self) -> bool {
        self.corners() == 2
    }

    /// The degree of its sides: 2 where there are nodes on them.
    pub fn order(self) -> usize {
        if self.size() > self.corners() { 2 } else { 1 }
    }
}

/// An element of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshElement {
    /// Its number in the file.
    pub id: u64,
    /// The shape, which gives the number of its nodes.
    pub kind: CellShape,
    /// The indices of its nodes; those beyond their number are 0.
    pub(super) nodes: [u32; MOST_CELL_NODES],
    /// The index of the node for the direction of its section, seen from the first node.
    pub toward: Option<u32>,
    /// Its line in the file, counted from 1.
    pub line: u32,
}

impl MeshElement {
    /// Its nodes as indices into [`Mesh::nodes`], in the order of the file.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.kind.size()]
    }
}

/// The kind of a group's members.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GroupKind {
    /// A set of nodes.
    #[default]
    Nodes,
    /// Elements that are points.
    Points,
    /// Line elements only.
    Lines,
    /// Face elements only.
    Faces,
    /// Elements of any shape.
    Elements,
}

/// A named group of nodes or of elements. Groups of different kinds or scopes may have the same name.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MeshGroup {
    /// The name in the file; a nameless group is named after its tag.
    pub name: String,
    /// The kind of its members.
    pub kind: GroupKind,
    /// Names that may stand before its own with a point between: the instance and its part, or the assembly.
    pub scopes: Vec<String>,
    /// True for a group outside parts and instances.
    pub is_outer: bool,
    /// Indices into [`Mesh::elements`], each once, in the order of the file.
    pub elements: Vec<u32>,
    /// Indices into [`Mesh::nodes`], each once: the nodes that the file lists, then those of the elements.
    pub nodes: Vec<u32>,
    /// The number of its elements of shapes that are not read.
    pub skipped: usize,
}

/// A note on a part of the file read in an unexpected way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeshNote {
    /// The part of the file.
    pub what: String,
    /// The meaning for the mesh.
    pub meaning: String,
    /// The line, counted from 1.
    pub line: usize,
}

/// Parts of one kind in a file that were not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// The name of the kind: "10-node tetrahedra", "*STEP".
    pub what: String,
    /// The number of them.
    pub count: usize,
    /// The line of the first, counted from 1.
    pub line: usize,
}

impl Mesh {
    /// The index of a node by its number in the file.
    pub fn node(&self, id: u64) -> Option<usize> {
        self.ids.get(id)
    }

    /// The indices of all groups of a name, with or without a scope and a point before it.
    pub fn named(&self, name: &str) -> &[u32] {
        let found = if self.folds_case { self.by_name.get(&name.to_lowercase()) } else { self.by_name.get(name) };
        found.map_or(&[], |found| found)
    }

    /// The first group of a name.
    pub fn group(&self, name: &str) -> Option<&MeshGroup> {
        self.named(name).first().map(|&group| &self.groups[group as usize])
    }
}
