//! Shells: surfaces of triangles or of quadrilaterals.

use super::integrals::MassIntegrals;
use super::node::Node;
use super::part_answers::{Drawing, NodeWeights, PartAnswers};
use crate::deck::part_table::MassKind;
use crate::elements::shell::{self, LayerModel, Plate};
use crate::math::{Mat3, Vec3};
use crate::quantities::{Column, PLASTIC_STRAIN, VON_MISES};
use crate::sections::Stiffness;
use std::collections::HashSet;

/// A surface of triangles or of quadrilaterals. A part of the deck that has both is two shells of the same name, one after the
/// other.
#[derive(Debug, Clone)]
pub struct Shell {
    /// The deck's name.
    pub name: String,
    /// Thickness and elastic constants.
    pub plate: Plate,
    /// Mass per volume.
    pub density: f64,
    /// The distribution of the mass.
    pub mass: MassKind,
    /// The layers and their law; `None` where the material is elastic.
    pub yielding: Option<LayerModel>,
    /// Axis 1 of results, projected onto the surface element by element.
    pub axis: Vec3,
    /// Corners of each element: 3 or 4.
    pub corners: usize,
    /// The elements.
    pub elements: Vec<ShellElement>,
    /// The number of each element in the deck's part, which is this shell and its neighbour of the same name. Empty where the
    /// shell is the whole part: they count from 0.
    pub numbers: Vec<u32>,
}

impl Shell {
    /// An element's number in the deck's part.
    pub fn number(&self, element: usize) -> usize {
        self.numbers.get(element).map_or(element, |&number| number as usize)
    }
}

/// An element of a shell.
#[derive(Debug, Clone)]
pub struct ShellElement {
    /// Nodes, counter-clockwise about the normals; a triangle uses the first three.
    pub nodes: [usize; 4],
    /// Unit normals of the surface at the nodes, at t = 0.
    pub normals: [Vec3; 4],
    /// The part of the bulge of each edge, from each node to the next, that stress works on.
    pub bulge: [f64; 4],
}

impl ShellElement {
    /// The nodes of an edge, the lower first.
    pub fn edge(&self, a: usize, corners: usize) -> [usize; 2] {
        let mut ends = [self.nodes[a], self.nodes[(a + 1) % corners]];
        ends.sort_unstable();
        ends
    }
}

impl PartAnswers for Shell {
    const QUANTITIES: &'static [&'static [Column]] = &[&[VON_MISES, PLASTIC_STRAIN]];

    fn name(&self) -> &str {
        &self.name
    }

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        &self.elements[element].nodes[..self.corners]
    }

    fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize)) {
        self.elements.iter_mut().flat_map(|e| &mut e.nodes).for_each(visit);
    }

    fn yields(&self) -> bool {
        self.yielding.is_some()
    }

    fn mass_kind(&self) -> Option<MassKind> {
        Some(self.mass)
    }

    fn element_mass(&self, element: usize, nodes: &[Node], _: &[Stiffness]) -> f64 {
        let of = self.nodes(element);
        let x = |k: usize| nodes[of[k]].x;
        let twice = (1..of.len() - 1).map(|k| (x(k) - x(0)).cross(&(x(k + 1) - x(0))).norm()).sum::<f64>();
        self.density * self.plate.thickness * (0.5 * twice)
    }

    fn stretching(&self, _: &[Node], _: &[Stiffness]) -> Option<f64> {
        Some(self.plate.E * self.plate.thickness)
    }

    fn depths(&self, _: &[Stiffness]) -> Option<[f64; 2]> {
        Some([self.plate.thickness; 2])
    }

    fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        Some(Drawing::Face { corners: self.nodes(element) })
    }

    fn normals(&self, element: usize) -> &[Vec3] {
        &self.elements[element].normals[..self.corners]
    }

    fn places_between(&self, count: usize) -> Vec<NodeWeights> {
        let (mut edges, mut places) = (HashSet::new(), Vec::new());
        (0..self.elements.len()).for_each(|element| lattice(self.nodes(element), count, &mut edges, &mut places));
        places
    }

    /// The mass lies on the surface with ρh³/12 per area about every axis, as its nodes have it while it deforms.
    fn take_out(&mut self, _: &[Stiffness], x: &dyn Fn(usize) -> Vec3, sums: &mut MassIntegrals) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        let h = self.plate.thickness;
        let density = if self.mass == MassKind::None { 0.0 } else { self.density };
        for e in std::mem::take(&mut self.elements) {
            let nodes = e.nodes[..self.corners].to_vec();
            let x: Vec<Vec3> = nodes.iter().map(|&node| x(node)).collect();
            let products = shell::products(&x);
            sums.add(density * h, &x, |a, b| products[a][b]);
            let area: f64 = products.iter().flatten().sum();
            sums.rotary += density * h.powi(3) / 12.0 * area * Mat3::identity();
            taken.push(nodes);
        }
        taken
    }
}

/// A lattice within an element and on those of its edges that are not in `edges` yet.
fn lattice(nodes: &[usize], between: usize, edges: &mut HashSet<[usize; 2]>, places: &mut Vec<NodeWeights>) {
    let (count, parts) = (nodes.len(), between + 1);
    let at = |k: usize| k as f64 / parts as f64;
    for i in 0..count {
        let pair = [nodes[i], nodes[(i + 1) % count]];
        if edges.insert([pair[0].min(pair[1]), pair[0].max(pair[1])]) {
            places.extend((1..parts).map(|k| vec![(pair[0], 1.0 - at(k)), (pair[1], at(k))]));
        }
    }
    for i in 1..parts {
        for j in 1..parts {
            let (s, t) = (at(i), at(j));
            let weights = match count {
                3 if i + j < parts => vec![1.0 - s - t, s, t],
                3 => continue,
                _ => vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t],
            };
            places.push(nodes.iter().copied().zip(weights).collect());
        }
    }
}
