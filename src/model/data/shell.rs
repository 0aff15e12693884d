//! Shells: surfaces of triangles or of quadrilaterals.

use super::case::YieldLimit;
use super::integrals::MassIntegrals;
use super::lattice;
use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, NodeWeights, PartAnswers};
use base::math::{Mat3, Vec3};
use base::quantities::{Column, PLASTIC_STRAIN, SHELL_RESULTANTS, VON_MISES};
use deck::part_table::MassKind;
use mechanics::elements::heat::Heat;
use mechanics::elements::shell::{self, LayerModel, MOST_NODES, Plate};
use mechanics::sections::Stiffness;

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
    /// Rayleigh factors of this part.
    pub damping: OwnDamping,
    /// The layers and their law; `None` where the material is elastic.
    pub yielding: Option<LayerModel>,
    /// Temperatures.
    pub heat: Heat,
    /// Axis 1 of results, projected onto the surface element by element.
    pub axis: Vec3,
    /// Corners of each element: 3 or 4.
    pub corners: usize,
    /// The degree of its sides: 1, or 2 where elements have nodes on their sides and quadrilaterals one in the middle.
    pub order: usize,
    /// The elements.
    pub elements: Vec<ShellElement>,
    /// The thickness of each element; empty where all have that of the plate.
    pub thicknesses: Vec<f64>,
    /// The number of each element in the deck's part, which is this shell and its neighbours of the same name. Empty where the
    /// shell is the whole part: they count from 0.
    pub numbers: Vec<u32>,
}

/// Thickness over the side of an element, below which bending resists so little that a film folds at its edges.
const FILM: f64 = 2e-3;

impl Shell {
    /// The number of nodes of each element: 3, 4, 6 or 9.
    pub fn size(&self) -> usize {
        match (self.order, self.corners) {
            (2, 3) => 6,
            (2, _) => 9,
            (_, corners) => corners,
        }
    }

    /// The thickness of an element.
    pub fn thickness(&self, element: usize) -> f64 {
        self.thicknesses.get(element).copied().unwrap_or(self.plate.thickness)
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

impl Shell {
    /// The quantities for `[[expect]]`; plastic strain only if its material yields.
    pub(super) const QUANTITIES: &'static [&'static [Column]] = &[&[VON_MISES, PLASTIC_STRAIN], &SHELL_RESULTANTS];
}

impl PartAnswers for Shell {
    fn name(&self) -> &str {
        &self.name
    }

    fn make_elastic(&mut self) -> Option<YieldLimit> {
        self.yielding.take().map(|model| YieldLimit::of(&model.law))
    }

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn folds_at(&self, node: usize, nodes: &[Node]) -> bool {
        let at_node = self.elements.iter().map(|element| &element.nodes).find(|own| own.contains(&node));
        let side = at_node.map(|own| (nodes[own[1]].x - nodes[own[0]].x).norm());
        self.order == 1 && side.is_some_and(|side| self.plate.thickness < FILM * side)
    }

    fn nodes(&self, element: usize) -> &[usize] {
        &self.elements[element].nodes[..self.size()]
    }

    fn corners(&self, element: usize) -> Vec<usize> {
        self.elements[element].nodes[..self.corners].to_vec()
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        self.elements.iter_mut().flat_map(|e| &mut e.nodes).chain(self.heat.nodes_mut()).for_each(visit);
    }

    fn heat(&self) -> Option<&Heat> {
        Some(&self.heat)
    }

    fn heat_mut(&mut self) -> Option<&mut Heat> {
        Some(&mut self.heat)
    }

    fn yields(&self) -> bool {
        self.yielding.is_some()
    }

    fn own_damping(&self) -> OwnDamping {
        self.damping
    }

    fn mass_kind(&self) -> Option<MassKind> {
        Some(self.mass)
    }

    fn element_mass(&self, element: usize, nodes: &[Node], _: &[Stiffness]) -> f64 {
        let of = self.nodes(element);
        let x = |k: usize| nodes[of[k]].x;
        if self.order == 2 {
            let x: Vec<Vec3> = (0..of.len()).map(x).collect();
            return self.density * self.thickness(element) * shell::shares(&x).iter().sum::<f64>();
        }
        let twice = (1..of.len() - 1).map(|k| (x(k) - x(0)).cross(&(x(k + 1) - x(0))).norm()).sum::<f64>();
        self.density * self.thickness(element) * (0.5 * twice)
    }

    fn stretching(&self, element: usize, _: &[Node], _: &[Stiffness]) -> Option<f64> {
        Some(self.plate.E * self.thickness(element))
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
        lattice::over_faces((0..self.elements.len()).map(|element| self.nodes(element)), count)
    }

    /// The mass lies on the surface with ρh³/12 per area about every axis, as its nodes have it while it deforms.
    fn take_out(&mut self, _: &[Stiffness], x: &dyn Fn(usize) -> Vec3, sums: &mut MassIntegrals) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        let size = self.size();
        let density = if self.mass == MassKind::None { 0.0 } else { self.density };
        for (index, e) in std::mem::take(&mut self.elements).into_iter().enumerate() {
            let h = self.thickness(index);
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
