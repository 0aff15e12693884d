//! Parts of the deck as the importer keeps them.

use base::math::Vec3;
use std::collections::BTreeSet;

/// A part of the deck that is a group of the mesh, or a bar.
#[derive(Debug, Clone)]
pub struct PartPiece {
    /// Its name.
    pub name: String,
    /// The names under which loads find it: of a bar one for each element.
    pub names: Vec<String>,
    /// What its elements are.
    pub is_beam: bool,
    /// True for a bar, which is a path in the deck.
    pub is_bar: bool,
    /// The name of the elements in the mesh, and the numbers and nodes of each.
    pub elements: Vec<(&'static str, u64, Vec<u64>)>,
    /// Indices of its elements in the flat mesh.
    pub cells: BTreeSet<usize>,
    /// Thickness of a shell, area of a beam or bar.
    pub size: f64,
    /// Density.
    pub density: f64,
    /// True where it is part of a rigid body.
    pub is_rigid: bool,
    /// Width and height of a beam of a rectangle.
    pub sides: Option<[f64; 2]>,
}

impl PartPiece {
    /// Its mass by the places of its nodes.
    pub fn mass(&self, x: impl Fn(u64) -> Vec3) -> f64 {
        let size = |nodes: &[u64]| {
            let at = |i: usize| x(nodes[i]);
            match (self.is_beam || self.is_bar, nodes.len()) {
                (true, count) => (at(count - 1) - at(0)).norm(),
                (false, 3 | 6) => 0.5 * (at(1) - at(0)).cross(&(at(2) - at(0))).norm(),
                (false, _) => 0.5 * (at(2) - at(0)).cross(&(at(3) - at(1))).norm(),
            }
        };
        self.density * self.size * self.elements.iter().map(|(_, _, nodes)| size(nodes)).sum::<f64>()
    }
}
