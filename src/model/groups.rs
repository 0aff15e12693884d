//! Groups of the mesh used for parts: their elements, and the elements left over.

use std::collections::HashMap;

use super::data::MeshFile;
use super::group_names::{self, GroupChoice};
use super::mesh_file::MeshNodes;
use super::names::Names;
use super::report::Report;
use crate::mesh::{self, GroupKind, MOST_CELL_NODES, Mesh};
use base::diagnostic::At;
use base::names::{joined, nearest, quoted};
use deck::Deck;

/// The groups and elements of the mesh that parts have taken so far.
pub(super) struct Groups<'d> {
    /// The nodes of the mesh.
    pub mesh: MeshNodes<'d>,
    /// Groups used as parts, with their titles: "shell `roof`".
    parts: HashMap<usize, String>,
    /// True for each element that is in a part.
    taken: Vec<bool>,
    /// The number of each node of the mesh in the part in hand, from 1; 0 for none.
    local: Vec<u32>,
}

impl<'d> Groups<'d> {
    /// No part has taken anything yet.
    pub fn new(mesh: MeshNodes<'d>) -> Self {
        let elements = mesh.input.map_or(0, |input| input.mesh.elements.len());
        Groups { mesh, parts: HashMap::new(), taken: vec![false; elements], local: Vec::new() }
    }

    /// Takes the segments or the faces of a group for a part.
    pub fn take(
        &mut self,
        what: &str,
        name: &'d At<String>,
        faces: bool,
        report: &mut Report<'d>,
    ) -> Option<Vec<&'d mesh::MeshElement>> {
        if self.mesh.is_lost {
            return None;
        }
        let Some(input) = self.mesh.input else {
            let message = "`group` needs a mesh, and the deck has none";
            return report.error_with(&name.span, message, "give it `[mesh]` with its `file`");
        };
        let mesh = &input.mesh;
        let at = meant(mesh, name, faces, report)?;
        if let Some(other) = self.parts.get(&at) {
            let message = format!("group `{}` is already {other}", name.value);
            return report.error_with(&name.span, message, "a group makes one part; remove one of the two");
        }
        self.parts.insert(at, what.to_owned());
        let group = &mesh.groups[at];
        if group.skipped > 0 {
            let message = format!("{} elements of group `{}` are of unsupported types", group.skipped, name.value);
            report.lose_connections();
            let hint = "mesh it with lines of two or three nodes and faces of three, four, six, eight or nine";
            return report.error_with(&name.span, message, hint);
        }
        let is_meant = |e: &&mesh::MeshElement| e.kind.is_line() != faces;
        let indices = || group.elements.iter().map(|&e| e as usize);
        let elements: Vec<&mesh::MeshElement> = indices().map(|e| &mesh.elements[e]).filter(is_meant).collect();
        if elements.is_empty() {
            report.lose_connections();
            let wanted = if faces { "triangles or quadrilaterals" } else { "segments" };
            let message = format!("group `{}` has no {wanted}", name.value);
            return match group.kind {
                GroupKind::Nodes => {
                    report.error_with(&name.span, message, "it is a set of nodes; name a set of elements")
                }
                _ => report.error_with(&name.span, message, format!("name a group of {wanted}")),
            };
        }
        let mut shared = 0;
        for e in indices().filter(|&e| is_meant(&&mesh.elements[e])) {
            shared += usize::from(std::mem::replace(&mut self.taken[e], true));
        }
        if shared > 0 {
            let message = format!("{shared} elements of group `{}` are already in another part", name.value);
            return report.error_with(
                &name.span,
                message,
                "an element belongs to one part: remove them from one of the groups in the mesh",
            );
        }
        Some(elements)
    }

    /// Lists the nodes of faces, each once in the order of the faces, and gives each face by its places in that list. The time
    /// taken grows with the number of faces alone, not with the mesh.
    #[allow(clippy::type_complexity)]
    pub fn own_nodes(&mut self, faces: &[&mesh::MeshElement]) -> Option<(Vec<u32>, Vec<[u32; MOST_CELL_NODES]>)> {
        let local = &mut self.local;
        local.resize(self.mesh.input?.mesh.nodes.len(), 0);
        let (mut own, mut of) = (Vec::new(), Vec::with_capacity(faces.len()));
        for face in faces {
            let mut nodes = [0; MOST_CELL_NODES];
            for (place, &node) in nodes.iter_mut().zip(face.nodes()) {
                let number = &mut local[node as usize];
                if *number == 0 {
                    own.push(node);
                    *number = own.len() as u32;
                }
                *place = *number - 1;
            }
            of.push(nodes);
        }
        own.iter().for_each(|&node| local[node as usize] = 0);
        Some((own, of))
    }

    /// Warns of elements outside all parts and named groups; returns the record of the file.
    pub fn finish(self, deck: &Deck, names: &Names, report: &mut Report) -> Option<MeshFile> {
        let (input, file) = (self.mesh.input?, deck.mesh.as_ref()?.file.as_ref()?);
        let mut used = self.taken.clone();
        for group in names.groups_in_lists() {
            input.mesh.groups[group].elements.iter().for_each(|&e| used[e as usize] = true);
        }
        let kinds = [(2, "segments"), (3, "triangles"), (4, "quadrilaterals")];
        let mut left = Vec::new();
        for (corners, what) in kinds {
            let elements = input.mesh.elements.iter().zip(&used);
            let count = elements.filter(|(element, used)| element.kind.corners() == corners && !*used).count();
            if count > 0 {
                left.push(format!("{count} {what}"));
            }
        }
        // A part with errors would take some of them.
        if !left.is_empty() && !report.has_errors() {
            let words: Vec<&str> = left.iter().map(String::as_str).collect();
            report.warn(
                &file.span,
                format!("{} of the mesh are in no part", joined(&words)),
                "name them in a part if they are meant; they are omitted",
            );
        }
        Some(MeshFile {
            path: input.path.clone(),
            digest: input.digest,
            nodes: input.mesh.nodes.len(),
            elements: input.mesh.elements.len(),
            used: self.taken.iter().filter(|&&taken| taken).count(),
        })
    }
}

/// The group that a part of lines or of `faces` is made of.
fn meant(mesh: &Mesh, name: &At<String>, faces: bool, report: &mut Report) -> Option<usize> {
    let Some(place) = group_names::place(mesh, name) else { return unknown_group(mesh, name, report) };
    match if faces { place.faces } else { place.lines } {
        GroupChoice::One(group) => {
            group_names::note_part(mesh, name, group as usize, faces, report);
            Some(group as usize)
        }
        GroupChoice::Many => {
            report.lose_connections();
            group_names::ambiguous(mesh, name, "write the one that is meant", report)
        }
        // The message names the group found instead.
        GroupChoice::None => place.groups().next().or_else(|| mesh.named(name).first().map(|&group| group as usize)),
    }
}

fn unknown_group<T>(mesh: &Mesh, name: &At<String>, report: &mut Report) -> Option<T> {
    let known = mesh.groups.iter().map(|group| group.name.as_str());
    let hint = match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if mesh.groups.is_empty() => "it has none".to_owned(),
        None => format!("its groups are {}", quoted(known.take(12))),
    };
    report.lose_connections();
    report.error_with(&name.span, format!("the mesh has no group `{}`", name.value), hint)
}
