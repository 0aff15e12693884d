//! Files of other programs in the place of a deck, recognized by their first lines.

/// The line of a deck that reads a mesh of Gmsh.
const IN_A_DECK: &str = "name it in a deck: `[mesh]` with `file = \"NAME.msh\"`; its physical groups are sets there";
/// The way from a format that is not read.
const BY_OTHERS: &str = "rdsolve reads meshes as .msh or .inp: convert it, for example by Gmsh or meshio, and name the result in a deck with `[mesh]`";

/// Names a file of another program, and the way from it to a deck. Reads at most the first 200 lines.
pub fn recognized(text: &str) -> Option<(&'static str, &'static str)> {
    let begin = text.trim_start();
    if begin.starts_with("$MeshFormat") {
        return Some(("a mesh of Gmsh", IN_A_DECK));
    }
    if begin.starts_with("# vtk DataFile") || begin.starts_with("<VTKFile") {
        return Some(("a mesh of VTK", BY_OTHERS));
    }
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    if lines.clone().next() == Some("-1") {
        return Some(("a universal file of I-DEAS", BY_OTHERS));
    }
    lines.by_ref().take(200).any(is_of_nastran).then_some(("a model of Nastran", BY_OTHERS))
}

/// True for lines that only files of Nastran have.
fn is_of_nastran(line: &str) -> bool {
    let line = line.to_ascii_uppercase();
    let card = line.split([' ', ',', '\t', '*']).next().unwrap_or_default();
    line == "CEND"
        || line.starts_with("BEGIN BULK")
        || (["GRID", "CQUAD4", "CTRIA3", "CBAR"].contains(&card) && card != line)
}
