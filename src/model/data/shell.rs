//! Shells: surfaces of triangles or of quadrilaterals.

use super::integrals::MassIntegrals;
use super::node::Node;
use super::part_answers::{Drawing, NodeWeights, PartAnswers};
use crate::deck::part_table::MassKind;
use crate::elements::shell::{self, LayerModel, MOST_NODES, Plate};
use crate::math::curved_faces::{self, CurvedFace, NineNodes, SixNodes, facets};
use crate::math::{Mat3, Vec3};
use crate::quantities::{Column, PLASTIC_STRAIN, VON_MISES};
use crate::sections::Stiffness;
use std::collections::HashSet;

/// A surface of elements of one shape. A part of the deck that has several is as many shells of the same name, one after the other.
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
    /// The degree of its sides: 1, or 2 where elements have nodes on their sides and quadrilaterals one in the middle.
    pub order: usize,
    /// The elements.
    pub elements: Vec<ShellElement>,
    /// The number of each element in the deck's part, which is this shell and its neighbours of the same name. Empty where the
    /// shell is the whole part: they count from 0.
    pub numbers: Vec<u32>,
}

impl Shell {
    /// The number of nodes of each element: 3, 4, 6 or 9.
    pub fn size(&self) -> usize {
        match (self.order, self.corners) {
            (2, 3) => 6,
            (2, _) => 9,
            (_, corners) => corners,
        }
    }

    /// An element's number in the deck's part.
    pub fn number(&self, element: usize) -> usize {
        self.numbers.get(element).map_or(element, |&number| number as usize)
    }
}

/// An element of a shell.
#[derive(Debug, Clone)]
pub struct ShellElement {
    /// Nodes, corners counter-clockwise about the normals, then those on the sides, then the middle; the last is repeated beyond
    /// [`Shell::size`].
    pub nodes: [usize; MOST_NODES],
    /// Unit normals of the surface at the nodes, at t = 0.
    pub normals: [Vec3; MOST_NODES],
    /// The part of the bulge of each edge, from each node to the next, that stress works on.
    pub bulge: [f64; 4],
}

impl ShellElement {
    /// An element whose edges are straight.
    pub fn new(nodes: &[usize], normals: &[Vec3]) -> ShellElement {
        let last = nodes.len() - 1;
        ShellElement {
            nodes: std::array::from_fn(|k| nodes[k.min(last)]),
            normals: std::array::from_fn(|k| normals[k.min(last)]),
            bulge: [0.0; 4],
        }
    }

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
        &self.elements[element].nodes[..self.size()]
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
        if self.order == 2 {
            let x: Vec<Vec3> = (0..of.len()).map(x).collect();
            return self.density * self.plate.thickness * shell::shares(&x).iter().sum::<f64>();
        }
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
        Some(Drawing::Face { nodes: self.nodes(element) })
    }

    fn normals(&self, element: usize) -> &[Vec3] {
        &self.elements[element].normals[..self.size()]
    }

    fn places_between(&self, count: usize) -> Vec<NodeWeights> {
        let (mut edges, mut places) = (HashSet::new(), Vec::new());
        let of = (0..self.elements.len()).map(|element| self.nodes(element));
        match self.size() {
            6 => of.for_each(|nodes| curved_lattice::<SixNodes, 6>(nodes, count, &mut edges, &mut places)),
            9 => of.for_each(|nodes| curved_lattice::<NineNodes, 9>(nodes, count, &mut edges, &mut places)),
            _ => of.for_each(|nodes| lattice(nodes, count, &mut edges, &mut places)),
        }
        places
    }

    /// The mass lies on the surface with ρh³/12 per area about every axis, as its nodes have it while it deforms.
    fn take_out(&mut self, _: &[Stiffness], x: &dyn Fn(usize) -> Vec3, sums: &mut MassIntegrals) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        let (h, size) = (self.plate.thickness, self.size());
        let density = if self.mass == MassKind::None { 0.0 } else { self.density };
        for e in std::mem::take(&mut self.elements) {
            let nodes = e.nodes[..size].to_vec();
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

/// The same of a curved element: on its sides between neighbouring nodes, and within the faces between its nodes.
fn curved_lattice<F: CurvedFace<N>, const N: usize>(
    nodes: &[usize],
    between: usize,
    edges: &mut HashSet<[usize; 2]>,
    places: &mut Vec<NodeWeights>,
) {
    let mut own = Vec::new();
    // Of the lines between its nodes, those inside belong to the element alone.
    let mut inside = HashSet::new();
    let round: Vec<usize> = curved_faces::ring(N).collect();
    let pair = |a: usize, b: usize| [a.min(b), a.max(b)];
    let rim: HashSet<[usize; 2]> = (0..round.len()).map(|k| pair(round[k], round[(k + 1) % round.len()])).collect();
    for facet in facets(N) {
        let mut known = HashSet::new();
        for (k, &a) in facet.iter().enumerate() {
            let b = facet[(k + 1) % facet.len()];
            let seen = if rim.contains(&pair(a, b)) {
                !edges.insert(pair(nodes[a], nodes[b]))
            } else {
                !inside.insert(pair(a, b))
            };
            if seen {
                known.insert(pair(a, b));
            }
        }
        lattice(facet, between, &mut known, &mut own);
    }
    for weights in own {
        // The same place in coordinates of the element.
        let at = |i: usize| weights.iter().map(|&(k, w): &(usize, f64)| w * F::NODES[k][i]).sum();
        let values = F::values([at(0), at(1)]);
        let of = nodes.iter().copied().zip(values).filter(|(_, w)| w.abs() > 1e-14);
        places.push(of.collect());
    }
}
