//! The mesh of the deck: a flat file of nodes, elements by part, and sets of nodes.

use crate::build::Build;
use std::fmt::Write;

/// Numbers of a set on a line.
const A_LINE: usize = 10;

/// The text of the mesh.
pub fn mesh(build: &Build) -> String {
    let mut text = String::from("** the mesh of a deck that rdsolve import has written\n*NODE\n");
    for (id, x) in build.mesh.nodes.iter().filter(|(id, _)| build.mesh.used.contains(id)) {
        let _ = writeln!(text, "{id}, {:?}, {:?}, {:?}", x[0], x[1], x[2]);
    }
    for piece in build.pieces.iter().filter(|piece| !piece.is_bar) {
        let mut kind = "";
        for (of, id, nodes) in &piece.elements {
            if *of != kind {
                let _ = writeln!(text, "*ELEMENT, TYPE={of}, ELSET={}", name(&piece.name));
                kind = of;
            }
            let numbers: Vec<String> = [id].into_iter().chain(nodes).map(u64::to_string).collect();
            let _ = writeln!(text, "{}", numbers.join(", "));
        }
    }
    for (set, ids) in &build.groups.by_name {
        let ids: Vec<u64> = ids.iter().copied().filter(|id| build.mesh.used.contains(id)).collect();
        if !ids.is_empty() {
            add_set(&mut text, "NSET", set, &ids);
        }
    }
    for (set, ids) in &build.tied.faces {
        add_set(&mut text, "ELSET", set, ids);
    }
    text
}

/// Adds a set of nodes or of elements.
fn add_set(text: &mut String, keyword: &str, set: &str, ids: &[u64]) {
    let _ = writeln!(text, "*{keyword}, {keyword}={}", name(set));
    for line in ids.chunks(A_LINE) {
        let line: Vec<String> = line.iter().map(u64::to_string).collect();
        let _ = writeln!(text, "{}", line.join(", "));
    }
}

/// A name as a parameter: in quotes where it has a comma or blanks.
fn name(name: &str) -> String {
    if name.contains([',', ' ']) { format!("\"{name}\"") } else { name.to_owned() }
}
