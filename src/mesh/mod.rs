//! Meshes from files: nodes, segments, triangles and quadrilaterals, and the groups that the file names.
//!
//! Gmsh in ASCII, versions 4.1 and 2.2, and the subset of Abaqus and CalculiX input that describes a mesh. What else a file
//! holds is listed in [`Mesh::skipped`]. The readers are our own: the crates there are know one version or one format each,
//! and none says where in the file an error stands.

mod abaqus;
mod draft;
mod gmsh;
mod normals;
pub mod text;

use crate::diagnostic::Diagnostic;
use crate::math::Vec3;
use draft::{Draft, Ids};
pub use normals::{FOLD, normals};
use text::Text;

/// A mesh as its file has it, sound: elements have nodes that exist, are different and span a length or an area.
#[derive(Debug)]
pub struct Mesh {
    /// In the order of the file.
    pub nodes: Vec<Node>,
    pub elements: Vec<Element>,
    pub groups: Vec<Group>,
    /// What was not read.
    pub skipped: Vec<Skipped>,
    ids: Ids,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The file's number.
    pub id: u64,
    pub x: Vec3,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Segment,
    Triangle,
    Quadrilateral,
}

impl Kind {
    /// Nodes of an element.
    pub fn size(self) -> usize {
        match self {
            Kind::Segment => 2,
            Kind::Triangle => 3,
            Kind::Quadrilateral => 4,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Element {
    /// The file's number.
    pub id: u64,
    pub kind: Kind,
    nodes: [u32; 4],
    /// Of the file, counted from 1.
    pub line: u32,
}

impl Element {
    /// Indices into [`Mesh::nodes`].
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.kind.size()]
    }
}

/// A named group of nodes and elements.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Group {
    pub name: String,
    /// Indices into [`Mesh::elements`], each once, in the order of the file.
    pub elements: Vec<u32>,
    /// Indices into [`Mesh::nodes`], each once: those given, then those of the elements.
    pub nodes: Vec<u32>,
    /// Elements of kinds that are not read.
    pub skipped: usize,
}

/// Something in the file that was not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Skipped {
    /// "10-node tetrahedra", "*STEP".
    pub what: String,
    pub count: usize,
    /// Where it stands first, counted from 1.
    pub line: usize,
}

impl Mesh {
    /// Index of a node by the file's number.
    pub fn node(&self, id: u64) -> Option<usize> {
        self.ids.get(id)
    }

    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }
}

/// Reads the bytes of a file, which messages call `path`; its extension says what it is, .msh or .inp.
///
/// # Errors
/// All that is wrong with it, at least one.
pub fn read(path: &str, bytes: &[u8]) -> Result<Mesh, Vec<Diagnostic>> {
    let mut text = Text::new(path, bytes);
    let mut draft = Draft::default();
    let extension = path.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase());
    let read = match extension.as_deref() {
        Some("msh") => gmsh::read(&mut text, &mut draft),
        Some("inp") => abaqus::read(&mut text, &mut draft),
        _ => {
            let message = format!("`{path}` is no mesh by its name");
            return Err(vec![Diagnostic::error(message).hint("meshes are .msh (Gmsh) or .inp (Abaqus, CalculiX)")]);
        }
    };
    // What a truncated file lacks would only repeat itself.
    if let Err(fault) = read {
        draft.faults.push(fault);
        return Err(draft.faults.into_iter().map(|fault| *fault).collect());
    }
    draft.finish(&text)
}
