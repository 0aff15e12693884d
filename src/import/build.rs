//! A deck under construction, and how lines of the file name nodes and elements.

use crate::deck_text::{DeckText, UniqueNames};
use crate::flat_mesh::FlatMesh;
use crate::importer::Importer;
use crate::part_piece::PartPiece;
use crate::scopes::{NamedTarget, ScopeContent};
use crate::tied_nodes::TiedNodes;
use crate::timeline::Timeline;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A deck that is being made.
pub struct Build<'b, 'a, 't> {
    /// The file.
    pub im: &'b mut Importer<'a, 't>,
    /// Its mesh.
    pub mesh: FlatMesh,
    /// The tables so far.
    pub deck: DeckText,
    /// Stages and their times.
    pub timeline: Timeline,
    /// Beams and shells, and the index of that of each element.
    pub pieces: Vec<PartPiece>,
    pub piece_of: HashMap<usize, usize>,
    /// Sets of nodes in the mesh.
    pub groups: NodeGroups,
    /// The reference node of each rotation node of a body.
    pub turned: HashMap<u64, u64>,
    /// The name of the body of each node that is attached to one.
    pub body_of: HashMap<u64, String>,
    /// Nodes whose rotations something holds: nodes of beams, shells, bodies.
    pub rotating: BTreeSet<u64>,
    /// Names of parts that form bodies.
    pub parts_of_bodies: BTreeSet<String>,
    /// Nodes whose masses a body has.
    pub weighed: BTreeSet<u64>,
    /// Nodes and their rotations, from 3 to 5, that have springs, dampers or inertia.
    pub turning: BTreeSet<(u64, usize)>,
    /// The constraints on nodes.
    pub tied: TiedNodes,
    /// True where the deck has gravity.
    pub has_gravity: bool,
    /// Amplitudes in the deck by their content, and their names.
    pub amplitudes: (HashMap<String, String>, UniqueNames),
}

/// Sets of nodes.
#[derive(Debug, Default)]
pub struct NodeGroups {
    /// The nodes by the name of the set in the deck.
    pub by_name: BTreeMap<String, Vec<u64>>,
    /// Names by the first node and the number of nodes.
    names: HashMap<(Option<u64>, usize), BTreeSet<String>>,
}

impl NodeGroups {
    fn add(&mut self, name: String, ids: Vec<u64>) {
        self.names.entry((ids.first().copied(), ids.len())).or_default().insert(name.clone());
        self.by_name.insert(name, ids);
    }

    /// The names of the sets that hold these nodes and no others.
    fn alike(&self, ids: &[u64]) -> impl Iterator<Item = &String> {
        let names = self.names.get(&(ids.first().copied(), ids.len())).into_iter().flatten();
        names.filter(move |name| self.by_name[*name] == ids)
    }
}

impl Build<'_, '_, '_> {
    /// Adds a part.
    pub fn add_piece(&mut self, piece: PartPiece) {
        self.piece_of.extend(piece.cells.iter().map(|cell| (*cell, self.pieces.len())));
        self.pieces.push(piece);
    }

    /// The nodes named by a line; refuses other names.
    pub fn nodes(&mut self, target: &NamedTarget) -> Vec<u64> {
        match self.mesh.node_ids(&self.im.scopes, target) {
            Some(ids) if ids.is_empty() && !target.is_set && target.name.parse::<u64>().is_ok() => {
                self.im.refuse(target.line, &format!("node {} does not exist", target.name));
                ids
            }
            Some(ids) if ids.is_empty() => {
                self.im.refuse(target.line, &format!("none of the nodes of `{}` exists", target.name));
                ids
            }
            Some(ids) => ids,
            None => {
                self.im.refuse(target.line, &format!("no node set is named `{}`", target.name));
                Vec::new()
            }
        }
    }

    /// One node that a line names.
    pub fn node(&mut self, target: &NamedTarget) -> Option<u64> {
        let nodes = self.nodes(target);
        if nodes.len() != 1 {
            self.im.refuse(target.line, &format!("`{}` must be one node, and is {}", target.name, nodes.len()));
        }
        nodes.first().copied().filter(|_| nodes.len() == 1)
    }

    /// The elements named by a line; refuses other names.
    pub fn cells(&mut self, target: &NamedTarget) -> Vec<usize> {
        match self.mesh.cell_indices(&self.im.scopes, target) {
            Some(cells) if cells.is_empty() => {
                self.im.refuse(target.line, &format!("none of the elements of `{}` exists", target.name));
                cells
            }
            Some(cells) => cells,
            None => {
                self.im.refuse(target.line, &format!("no element set is named `{}`", target.name));
                Vec::new()
            }
        }
    }

    /// Names for nodes: sets of the file where these cover them, a new set of many, else the nodes themselves.
    pub fn names(&mut self, nodes: &BTreeSet<u64>, targets: &[NamedTarget], new: &str) -> Vec<String> {
        let (mut rest, mut names) = (nodes.clone(), Vec::new());
        let mut seen = BTreeSet::new();
        for target in targets.iter().filter(|target| target.is_set || target.name.parse::<u64>().is_err()) {
            if !seen.insert(&target.name) {
                continue;
            }
            let of_set = self.nodes(target);
            let covers = !of_set.is_empty()
                && of_set.iter().all(|id| nodes.contains(id))
                && of_set.iter().any(|id| rest.contains(id));
            if covers {
                rest.retain(|id| !of_set.contains(id));
                names.push(self.group(&target.name, of_set));
            }
        }
        if rest.len() > 12 {
            let name = self.group(new, rest.into_iter().collect());
            names.push(name);
            return names;
        }
        names.extend(rest.iter().map(|id| format!("mesh.{id}")));
        names
    }

    /// The name in the deck of a set of nodes. A new set is added to the mesh.
    pub fn group(&mut self, name: &str, ids: Vec<u64>) -> String {
        let inner = name.rsplit_once('.').map_or(name, |(_, inner)| inner).to_lowercase();
        if let Some(known) = self.groups.alike(&ids).find(|known| known.to_lowercase().ends_with(&inner)) {
            return known.clone();
        }
        let name = self.deck.unique(name);
        self.groups.add(name.clone(), ids);
        name
    }

    /// Takes the names of all sets of nodes of the file; internal ones get a name where something uses them.
    pub fn groups_of_file(&mut self) {
        let scopes = &self.im.scopes;
        let mut sets: Vec<(String, Vec<u64>)> = Vec::new();
        let mut add = |content: &ScopeContent, offset: u64, scope: &str| {
            for (name, ids) in content.node_sets.list.iter().filter(|(name, _)| !name.starts_with('_')) {
                let ids: BTreeSet<u64> = ids
                    .iter()
                    .map(|id| self.mesh.kept(scopes.shifted(*id, offset)))
                    .filter(|id| self.mesh.has(*id))
                    .collect();
                let name = if scope.is_empty() { name.clone() } else { format!("{scope}.{name}") };
                sets.push((name, ids.into_iter().collect()));
            }
        };
        add(&scopes.outer, 0, "");
        let alone = scopes.instances.len() == 1;
        for at in &scopes.instances {
            let scope = if alone { "" } else { &at.own.name };
            add(&at.own, 0, scope);
            add(&scopes.parts[at.part], at.offset, scope);
        }
        for (name, ids) in sets.into_iter().filter(|(_, ids)| !ids.is_empty()) {
            let name = self.deck.unique(&name);
            self.groups.add(name, ids);
        }
    }
}
