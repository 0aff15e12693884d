//! Meshes from files: nodes, segments, triangles and quadrilaterals, also with nodes on their sides, and the groups that the file
//! names.
//!
//! Gmsh in ASCII, versions 4.1 and 2.2, and the subset of Abaqus and CalculiX input that describes a mesh are read. Other parts
//! of a file are listed in [`Mesh::skipped`]. The readers are our own: existing crates know one version or one format each, and
//! none tells the line of an error.

mod abaqus;
mod data;
mod draft;
mod gmsh;
mod ids;
mod normals;

use base::diagnostic::Diagnostic;
use base::text_file::Text;
pub use data::{CellShape, GroupKind, MOST_CELL_NODES, Mesh, MeshElement, MeshGroup, MeshNode, MeshNote, Skipped};
use draft::Draft;
pub use normals::{FOLD, normals};

/// Reads a mesh from the bytes of a file that includes no other.
///
/// # Errors
/// All errors found in the file, at least one.
pub fn read(path: &str, bytes: &[u8]) -> Result<Mesh, Vec<Diagnostic>> {
    read_text(&mut Text::new(path, bytes))
}

/// True for the path of a file that may include others.
pub fn may_include(path: &str) -> bool {
    extension(path).as_deref() == Some("inp")
}

fn extension(path: &str) -> Option<String> {
    path.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase())
}

/// Reads a mesh from a text. The extension of its path gives the format, .msh or .inp.
///
/// # Errors
/// All errors found in the file, at least one.
pub fn read_text(text: &mut Text) -> Result<Mesh, Vec<Diagnostic>> {
    // Names in Abaqus and CalculiX are not case-sensitive.
    let mut draft = Draft::new(may_include(text.path));
    let read = match extension(text.path).as_deref() {
        Some("msh") => gmsh::read(text, &mut draft),
        Some("inp") => abaqus::read(text, &mut draft),
        _ => {
            let message = format!("`{}` does not have the extension of a mesh", text.path);
            return Err(vec![Diagnostic::error(message).hint("meshes are .msh (Gmsh) or .inp (Abaqus, CalculiX)")]);
        }
    };
    // Further checks of a file that is not read to its end would only repeat the error.
    if let Err(fault) = read {
        draft.faults.push(fault);
        return Err(draft.faults.into_iter().map(|fault| *fault).collect());
    }
    draft.finish(text)
}
