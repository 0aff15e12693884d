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

use crate::diagnostic::Diagnostic;
use crate::text_file::Text;
pub use data::{CellShape, MOST_CELL_NODES, Mesh, MeshElement, MeshGroup, MeshNode, Skipped};
use draft::Draft;
pub use normals::{FOLD, normals};

/// Reads a mesh from the bytes of a file whose path, for messages, is `path`. The extension gives the format, .msh or .inp.
///
/// # Errors
/// All errors found in the file, at least one.
pub fn read(path: &str, bytes: &[u8]) -> Result<Mesh, Vec<Diagnostic>> {
    let mut text = Text::new(path, bytes);
    let mut draft = Draft::default();
    let extension = path.rsplit_once('.').map(|(_, extension)| extension.to_ascii_lowercase());
    let read = match extension.as_deref() {
        Some("msh") => gmsh::read(&mut text, &mut draft),
        Some("inp") => abaqus::read(&mut text, &mut draft),
        _ => {
            let message = format!("`{path}` does not have the extension of a mesh");
            return Err(vec![Diagnostic::error(message).hint("meshes are .msh (Gmsh) or .inp (Abaqus, CalculiX)")]);
        }
    };
    // Further checks of a file that is not read to its end would only repeat the error.
    if let Err(fault) = read {
        draft.faults.push(fault);
        return Err(draft.faults.into_iter().map(|fault| *fault).collect());
    }
    draft.finish(&text)
}
