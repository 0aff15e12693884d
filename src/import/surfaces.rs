//! Surfaces: sets of nodes, faces of elements and edges of shells under one name.

use crate::build::Build;
use crate::scopes::{Members, NamedTarget};
use base::math::curved_faces::corners;
use std::collections::BTreeSet;

/// The sets of a surface with their sides; a set of nodes is a surface too. Refuses other names.
pub fn lines(build: &mut Build, surface: &NamedTarget) -> Option<Vec<(NamedTarget, String)>> {
    let found = build.im.scopes.surface(surface);
    let is_set = build.im.scopes.members(surface, Members::Nodes).is_some();
    let lines =
        found.or_else(|| is_set.then(|| vec![(NamedTarget { is_set: true, ..surface.clone() }, "NODE".to_owned())]));
    if lines.is_none() {
        build.im.refuse(surface.line, &format!("no surface is named `{}`", surface.name));
    }
    let here = |(set, side): (NamedTarget, String)| (NamedTarget { line: surface.line, ..set }, side);
    Some(lines?.into_iter().map(here).collect())
}

/// The nodes of a surface: those of a set, of elements, or of their edges.
pub fn nodes_of(build: &mut Build, surface: &NamedTarget) -> Option<BTreeSet<u64>> {
    let mut nodes = BTreeSet::new();
    for (set, side) in lines(build, surface)? {
        if side == "NODE" {
            nodes.extend(build.nodes(&set));
            continue;
        }
        for at in build.cells(&set) {
            let all = &build.mesh.cells[at].nodes;
            nodes.extend(match edge(&side, all.len()) {
                Some(edge) => edge.into_iter().filter_map(|k| all.get(k).copied()).collect(),
                None => all.clone(),
            });
        }
    }
    Some(nodes)
}

/// The sets of nodes of a surface, by which the deck names them.
pub fn node_sets(build: &Build, surface: &NamedTarget) -> Vec<NamedTarget> {
    match build.im.scopes.surface(surface) {
        Some(lines) => lines.into_iter().filter(|(_, side)| side == "NODE").map(|(set, _)| set).collect(),
        None => vec![NamedTarget { is_set: true, ..surface.clone() }],
    }
}

/// The places, among its nodes, of those of an edge of a shell: E1 of Abaqus, S3 of CalculiX for the first one. Ends come first.
pub fn edge(side: &str, nodes: usize) -> Option<Vec<usize>> {
    let number: usize = side.get(1..)?.parse().ok()?;
    let first = match side.as_bytes()[0] {
        b'E' => number.checked_sub(1)?,
        _ => number.checked_sub(3)?,
    };
    let n = corners(nodes);
    let middle = (nodes > n).then_some(n + first);
    (first < n).then(|| [first, (first + 1) % n].into_iter().chain(middle).collect())
}
