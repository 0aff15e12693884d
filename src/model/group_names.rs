//! Names of the deck in the mesh: sets of nodes and of elements, of parts and of the assembly, may share a name.
//!
//! Lists of nodes mean sets of nodes, and parts are made of sets of elements. Outside parts the set of the assembly comes first, and
//! sections belong to the sets of parts. If two different groups remain, the deck has to choose: `node-set:Edge`, `STRIP-1.Edge`.

use super::report::Report;
use crate::mesh::{GroupKind, Mesh, MeshGroup};
use base::diagnostic::{At, Diagnostic};
use base::names::joined;
use std::collections::HashSet;

/// Whether a group of a mesh is of a kind.
type IsOfKind = fn(&Mesh, &MeshGroup) -> bool;

/// Prefixes for the kind of group.
const KINDS: [(&str, IsOfKind); 4] = [
    ("node-set", |_, group| is_of_nodes(group)),
    ("element-set", |_, group| !is_of_nodes(group)),
    ("line-set", |mesh, group| !is_of_nodes(group) && all(mesh, group, false)),
    ("face-set", |mesh, group| !is_of_nodes(group) && all(mesh, group, true)),
];

/// The group that a name means in some place of the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GroupChoice {
    /// None of this name.
    None,
    /// The group of this index.
    One(u32),
    /// Several that differ.
    Many,
}

/// The groups that a name of the deck means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct GroupPlace {
    /// The nodes for a list.
    pub nodes: GroupChoice,
    /// The lines for a beam or for a load.
    pub lines: GroupChoice,
    /// The faces for a shell.
    pub faces: GroupChoice,
}

impl GroupPlace {
    /// The groups that the name means somewhere.
    pub fn groups(self) -> impl Iterator<Item = usize> {
        [self.nodes, self.lines, self.faces].into_iter().filter_map(|pick| pick.one())
    }
}

impl GroupChoice {
    /// The index of the group, if there is one.
    pub fn one(self) -> Option<usize> {
        if let GroupChoice::One(group) = self { Some(group as usize) } else { None }
    }
}

/// The groups of a name; `None` if the mesh has none.
pub fn place(mesh: &Mesh, name: &str) -> Option<GroupPlace> {
    let found = candidates(mesh, name);
    if found.is_empty() {
        return None;
    }
    let with = |faces: bool| {
        let has = |&&group: &&u32| {
            let group = &mesh.groups[group as usize];
            !is_of_nodes(group) && group.elements.iter().any(|&e| mesh.elements[e as usize].kind.is_line() != faces)
        };
        let having: Vec<u32> = found.iter().filter(has).copied().collect();
        pick(preferred(having, |group| !mesh.groups[group as usize].is_outer), |group| {
            mesh.groups[group as usize].elements.iter().copied().collect()
        })
    };
    Some(GroupPlace { nodes: nodes(mesh, found.clone()), lines: with(false), faces: with(true) })
}

/// The groups of a name, if one is a set of nodes.
pub fn set_of_nodes(mesh: &Mesh, name: &str) -> Option<GroupPlace> {
    let is_set = |&group: &u32| mesh.groups[group as usize].kind == GroupKind::Nodes;
    place(mesh, name).filter(|_| candidates(mesh, name).iter().any(is_set))
}

/// All groups that a name may mean.
fn candidates(mesh: &Mesh, name: &str) -> Vec<u32> {
    let named = mesh.named(name);
    if let (true, Some((kind, rest))) = (named.is_empty(), name.split_once(':'))
        && let Some((_, is_meant)) = KINDS.iter().find(|(word, _)| *word == kind)
    {
        let is_meant = |group: &&u32| is_meant(mesh, &mesh.groups[**group as usize]);
        return mesh.named(rest.trim()).iter().filter(is_meant).copied().collect();
    }
    named.to_vec()
}

/// The group whose nodes a name means. Physical points of Gmsh are groups like others; sets of nodes exist to be named as such.
fn nodes(mesh: &Mesh, found: Vec<u32>) -> GroupChoice {
    let sets = preferred(found, |group| mesh.groups[group as usize].kind == GroupKind::Nodes);
    pick(preferred(sets, |group| mesh.groups[group as usize].is_outer), |group| nodes_of(mesh, group))
}

fn nodes_of(mesh: &Mesh, group: u32) -> HashSet<u32> {
    mesh.groups[group as usize].nodes.iter().copied().collect()
}

/// The preferred groups, or all if none is preferred.
fn preferred(groups: Vec<u32>, is_preferred: impl Fn(u32) -> bool) -> Vec<u32> {
    let some: Vec<u32> = groups.iter().copied().filter(|&group| is_preferred(group)).collect();
    if some.is_empty() { groups } else { some }
}

/// The one of some groups, or the first where all hold the same.
fn pick(groups: Vec<u32>, held: impl Fn(u32) -> HashSet<u32>) -> GroupChoice {
    match groups[..] {
        [] => GroupChoice::None,
        [one] => GroupChoice::One(one),
        [first, ref rest @ ..] => {
            let holds = held(first);
            if rest.iter().all(|&other| held(other) == holds) { GroupChoice::One(first) } else { GroupChoice::Many }
        }
    }
}

fn is_of_nodes(group: &MeshGroup) -> bool {
    matches!(group.kind, GroupKind::Nodes | GroupKind::Points)
}

/// True where all elements of a group are faces, or lines.
fn all(mesh: &Mesh, group: &MeshGroup, faces: bool) -> bool {
    group.elements.iter().all(|&e| mesh.elements[e as usize].kind.is_line() != faces)
}

/// The name that means a group and no other, as far as there is one.
pub fn spelling(mesh: &Mesh, group: usize) -> String {
    let MeshGroup { name, kind, scopes, .. } = &mesh.groups[group];
    let kind = match kind {
        GroupKind::Nodes | GroupKind::Points => "node-set",
        GroupKind::Lines => "line-set",
        GroupKind::Faces => "face-set",
        GroupKind::Elements => "element-set",
    };
    let scope = scopes.first().map_or_else(String::new, |scope| format!("{scope}."));
    format!("{kind}:{scope}{name}")
}

/// Names of all groups of a name with their size: "`node-set:Edge` (3 nodes)".
fn spellings(mesh: &Mesh, name: &str) -> String {
    let said = |&group: &u32| {
        let of = &mesh.groups[group as usize];
        let count = if is_of_nodes(of) { (of.nodes.len(), "node") } else { (of.elements.len(), "element") };
        let plural = if count.0 == 1 { "" } else { "s" };
        format!("`{}` ({} {}{plural})", spelling(mesh, group as usize), count.0, count.1)
    };
    let said: Vec<String> = candidates(mesh, name).iter().map(said).collect();
    joined(&said.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Reports a name of several different groups.
pub fn ambiguous<T>(mesh: &Mesh, name: &At<String>, hint: &str, report: &mut Report) -> Option<T> {
    let message = format!("`{}` means several groups of the mesh: {}", name.value, spellings(mesh, name));
    report.error_with(&name.span, message, hint)
}

/// Notes the group used for a list of nodes, if other groups of the name have other nodes.
pub fn note_choice(mesh: &Mesh, name: &At<String>, taken: usize, report: &mut Report) {
    let nodes = nodes_of(mesh, taken as u32);
    if candidates(mesh, name).iter().all(|&other| nodes_of(mesh, other) == nodes) {
        return;
    }
    let message = format!("`{}` means several groups of the mesh: {}", name.value, spellings(mesh, name));
    let hint = format!("`{}` is taken; write that, or another one", spelling(mesh, taken));
    report.push(Diagnostic::note(message).at(&name.span).hint(hint));
}

/// Notes the group used for a part, if other groups of the name have other elements of the kind.
pub fn note_part(mesh: &Mesh, name: &At<String>, taken: usize, faces: bool, report: &mut Report) {
    let of = |group: usize| -> HashSet<u32> {
        let elements = mesh.groups[group].elements.iter().copied();
        elements.filter(|&e| mesh.elements[e as usize].kind.is_line() != faces).collect()
    };
    let elements = of(taken);
    let differs = |&other: &u32| Some(of(other as usize)).is_some_and(|of| !of.is_empty() && of != elements);
    if !candidates(mesh, name).iter().any(differs) {
        return;
    }
    let message = format!("`{}` means several groups of the mesh: {}", name.value, spellings(mesh, name));
    let hint = format!("the part is made of `{}`; write that, or another one", spelling(mesh, taken));
    report.push(Diagnostic::note(message).at(&name.span).hint(hint));
}
