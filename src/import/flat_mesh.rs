//! The mesh with all instances in place, and which nodes the model uses.

use crate::scopes::{Members, NOWHERE, NamedTarget, PlacedElement, Scopes};
use base::math::Vec3;
use std::cell::OnceCell;
use std::collections::{BTreeSet, HashMap};

/// All nodes and elements by numbers that are theirs alone.
#[derive(Debug, Default)]
pub struct FlatMesh {
    /// Number and place of each node.
    pub nodes: Vec<(u64, Vec3)>,
    /// The elements.
    pub cells: Vec<PlacedElement>,
    /// Nodes that something in the deck uses.
    pub used: BTreeSet<u64>,
    node_at: HashMap<u64, usize>,
    cell_at: HashMap<u64, usize>,
    /// The node that replaces a merged one.
    merged: HashMap<u64, u64>,
    /// The largest extent; copies of nodes do not change it.
    size: OnceCell<f64>,
}

impl FlatMesh {
    /// The mesh of all scopes, and its errors: line, reason.
    pub fn new(scopes: &Scopes) -> (FlatMesh, Vec<(usize, String)>) {
        let (all, cells) = scopes.flat();
        let (mut mesh, mut faults) = (FlatMesh::default(), Vec::new());
        for (id, x) in all {
            match mesh.node_at.get(&id) {
                None => {
                    mesh.node_at.insert(id, mesh.nodes.len());
                    mesh.nodes.push((id, x));
                }
                Some(&at) if mesh.nodes[at].1 == x => {}
                Some(_) => faults.push((0, format!("node {id} is given twice, at different places"))),
            }
        }
        for cell in cells {
            let lost = cell.nodes.iter().find(|id| **id != 0 && !mesh.node_at.contains_key(id));
            if let Some(id) = lost {
                faults
                    .push((cell.line, format!("element {} has node {}, which does not exist", cell.id, id % NOWHERE)));
                continue;
            }
            match mesh.cell_at.get(&cell.id) {
                None => {
                    mesh.cell_at.insert(cell.id, mesh.cells.len());
                    mesh.cells.push(cell);
                }
                Some(&at) if mesh.cells[at].nodes == cell.nodes && mesh.cells[at].kind == cell.kind => {}
                Some(_) => faults.push((cell.line, format!("element {} is given twice", cell.id))),
            }
        }
        (mesh, faults)
    }

    /// The place of a node.
    pub fn x(&self, id: u64) -> Vec3 {
        self.node_at.get(&id).map_or(Vec3::zeros(), |&at| self.nodes[at].1)
    }

    /// True for a node that exists.
    pub fn has(&self, id: u64) -> bool {
        self.node_at.contains_key(&id)
    }

    /// The node, or its replacement if it was merged.
    pub fn kept(&self, id: u64) -> u64 {
        let mut id = id;
        while let Some(&other) = self.merged.get(&id) {
            id = other;
        }
        id
    }

    /// Adds a node at the place of another, and returns its number.
    pub fn copy_of(&mut self, id: u64) -> u64 {
        let new = self.nodes.iter().map(|node| node.0).max().unwrap_or(0) + 1;
        self.node_at.insert(new, self.nodes.len());
        self.nodes.push((new, self.x(id)));
        new
    }

    /// Merges a node into another.
    pub fn merge(&mut self, id: u64, into: u64) {
        let (id, into) = (self.kept(id), self.kept(into));
        if id != into {
            self.merged.insert(id, into);
        }
    }

    /// Replaces merged nodes in all elements.
    pub fn apply_merges(&mut self) {
        let merged = std::mem::take(&mut self.merged);
        let kept = |mut id: u64| {
            while let Some(&other) = merged.get(&id) {
                id = other;
            }
            id
        };
        self.cells.iter_mut().for_each(|cell| cell.nodes.iter_mut().for_each(|id| *id = kept(*id)));
        self.merged = merged;
    }

    /// Existing nodes that a line names, each once, in ascending order.
    pub fn node_ids(&self, scopes: &Scopes, target: &NamedTarget) -> Option<Vec<u64>> {
        let ids = scopes.members(target, Members::Nodes)?;
        let ids: BTreeSet<u64> = ids.into_iter().map(|id| self.kept(id)).filter(|id| self.has(*id)).collect();
        Some(ids.into_iter().collect())
    }

    /// Indices of existing elements that a line names, in ascending order.
    pub fn cell_indices(&self, scopes: &Scopes, target: &NamedTarget) -> Option<Vec<usize>> {
        let ids = scopes.members(target, Members::Cells)?;
        let found: BTreeSet<usize> = ids.iter().filter_map(|id| self.cell_at.get(id).copied()).collect();
        Some(found.into_iter().collect())
    }

    /// The largest number of an element.
    pub fn last_cell(&self) -> u64 {
        self.cells.iter().map(|cell| cell.id).max().unwrap_or(0)
    }

    /// The largest extent of the mesh.
    pub fn size(&self) -> f64 {
        *self.size.get_or_init(|| {
            let bound = |of: fn(f64, f64) -> f64, start: f64| {
                self.nodes.iter().fold(Vec3::from_element(start), |b, (_, x)| b.zip_map(x, of))
            };
            match self.nodes.is_empty() {
                true => 1.0,
                false => (bound(f64::max, f64::MIN) - bound(f64::min, f64::MAX)).amax().max(1e-300),
            }
        })
    }
}
