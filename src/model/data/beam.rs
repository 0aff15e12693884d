//! Beams: lines of elements that stretch, shear, bend and twist.

use super::case::YieldLimit;
use super::integrals::{MassIntegrals, line_mass};
use super::lattice;
use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, LineElement, NodeWeights, PartAnswers};
use base::math::quadrature::lobatto;
use base::math::{Mat3, Vec3};
use base::quantities::{Column, PLASTIC_STRAIN, SECTION_FORCES, SECTION_STRESSES};
use deck::part_table::MassKind;
use mechanics::elements::beam::FibreModel;
use mechanics::elements::heat::Heat;
use mechanics::sections::Stiffness;
use std::ops::Range;

/// A line of nodes, cut into elements with one or more inner nodes.
#[derive(Debug, Clone)]
pub struct Beam {
    /// The deck's name.
    pub name: String,
    /// Degree of the interpolation: an element has `order + 1` nodes.
    pub order: usize,
    /// The distribution of the mass.
    pub mass: MassKind,
    /// True where the section's rotary inertia is kept.
    pub rotary_inertia: bool,
    /// Rayleigh factors of this part.
    pub damping: OwnDamping,
    /// The fibres and their law; `None` where the material is elastic.
    pub yielding: Option<FibreModel>,
    /// True where the elements of a segment differ in length.
    pub graded: bool,
    /// Temperatures.
    pub heat: Heat,
    /// The elements along the line.
    pub elements: Vec<BeamElement>,
}

/// An element of a beam.
#[derive(Debug, Clone)]
pub struct BeamElement {
    /// Nodes from one end to the other; the first `order + 1` are used. Inner nodes lie at the Lobatto points of a straight line.
    pub nodes: [usize; 5],
    /// Columns: section axes x (along the beam), y, z in global components at t = 0.
    pub frame: Mat3,
    /// Index into [`super::Model::stiffnesses`]: the section, or that at a point near the middle.
    pub section: usize,
    /// Sections and axes by place, where they differ.
    pub varied: Option<Box<VariedElement>>,
    /// Nodes that carry its mass beside the axis and move rigidly with `nodes`; `None` of a mass on the axis.
    pub mass_nodes: Option<Box<[usize; 5]>>,
}

/// The sections of an element that differ from place to place.
#[derive(Debug, Clone)]
pub struct VariedElement {
    /// At its nodes; the first `order + 1` are used.
    pub nodes: [SectionAt; 5],
    /// At its Gauss points; the first `order` are used.
    pub points: [SectionAt; 4],
}

/// The section at a place of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionAt {
    /// Index into [`super::Model::stiffnesses`].
    pub section: usize,
    /// Columns: axes x (along the beam), y, z of the section in global components at t = 0.
    pub frame: Mat3,
}

impl Beam {
    /// The quantities for `[[expect]]`; plastic strain only if its material yields.
    pub(super) const QUANTITIES: &'static [&'static [Column]] =
        &[&SECTION_FORCES, &SECTION_STRESSES, &[PLASTIC_STRAIN]];
}

impl PartAnswers for Beam {
    fn name(&self) -> &str {
        &self.name
    }

    fn make_elastic(&mut self) -> Option<YieldLimit> {
        let model = self.yielding.take()?;
        let (law, fibres) = model.plastic()?;
        let fibres = fibres.iter().map(|fibre| [fibre.y, fibre.z]).collect();
        let sections = self.elements.iter().map(|element| element.section).collect();
        Some(YieldLimit { fibres, sections, ..YieldLimit::of(law) })
    }

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        &self.elements[element].nodes[..=self.order]
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        let order = self.order;
        for element in &mut self.elements {
            let masses = element.mass_nodes.iter_mut().flat_map(|nodes| &mut nodes[..=order]);
            element.nodes[..=order].iter_mut().chain(masses).for_each(&mut *visit);
        }
        self.heat.nodes_mut().for_each(visit);
    }

    fn keep_elements(&mut self, elements: &Range<usize>) {
        self.elements = self.elements[elements.clone()].to_vec();
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

    fn section(&self, element: usize) -> Option<usize> {
        self.elements.get(element).map(|spec| spec.section)
    }

    fn line(&self, element: usize, length: f64, stiffnesses: &[Stiffness]) -> Option<LineElement> {
        let spec = &self.elements[element];
        let section = &stiffnesses[spec.section];
        // Along y the beam bends about z, and along z about y.
        let shear = |along: usize| {
            let about = 3 - along;
            12.0 * section.M[(about, about)] / (section.N[(along, along)] * length * length)
        };
        let bends = self.order == 1 && self.yielding.is_none();
        Some(LineElement { axes: Some(spec.frame), shear: bends.then(|| [shear(1), shear(2)]) })
    }

    fn element_mass(&self, element: usize, nodes: &[Node], stiffnesses: &[Stiffness]) -> f64 {
        let spec = &self.elements[element];
        let [start, end] = spec.ends(self.order).map(|node| nodes[node].x);
        let length = (start - end).norm();
        if spec.varied.is_none() {
            return stiffnesses[spec.section].mass_per_length * length;
        }
        let (_, weights) = lobatto(self.order + 1);
        let masses = (0..=self.order).map(|k| stiffnesses[spec.at_node(k).section].mass_per_length);
        masses.zip(weights).map(|(mass, weight)| 0.5 * weight * length * mass).sum()
    }

    fn stretching(&self, element: usize, nodes: &[Node], stiffnesses: &[Stiffness]) -> Option<f64> {
        let [start, end] = self.elements[element].ends(self.order).map(|node| nodes[node].x);
        Some(stiffnesses[self.elements[element].section].N[(0, 0)] / (start - end).norm())
    }

    fn depths(&self, stiffnesses: &[Stiffness]) -> Option<[f64; 2]> {
        let stiffness = &stiffnesses[self.elements.first()?.section];
        let depth = |i: usize| (12.0 * stiffness.M[(i, i)] / stiffness.N[(0, 0)]).sqrt();
        let [a, b] = [depth(1), depth(2)];
        Some([a.min(b), a.max(b)])
    }

    fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        Some(Drawing::Curve { nodes: self.nodes(element), axes: self.elements[element].frame })
    }

    fn places_between(&self, count: usize) -> Vec<NodeWeights> {
        lattice::along_lines(self.elements.iter().map(|element| &element.nodes[..=self.order]), count)
    }

    /// The mass lies on the line of the centres of mass, with the rotary inertia of the section.
    fn take_out(
        &mut self,
        stiffnesses: &[Stiffness],
        x: &dyn Fn(usize) -> Vec3,
        sums: &mut MassIntegrals,
    ) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        for e in std::mem::take(&mut self.elements) {
            let ends = e.ends(self.order);
            if e.varied.is_some() {
                self.take_varied(&e, stiffnesses, x, sums);
                taken.push(ends.to_vec());
                continue;
            }
            let mut x = ends.map(x);
            let (length, section) = ((x[1] - x[0]).norm(), &stiffnesses[e.section]);
            if let Some(arm) = section.mass_arm(&e.frame) {
                x.iter_mut().for_each(|x| *x += arm);
            }
            let density = if self.mass == MassKind::None { 0.0 } else { section.mass_per_length };
            sums.add(density, &x, |a, b| length * line_mass(a, b));
            if self.rotary_inertia && self.mass != MassKind::None {
                sums.rotary += length * e.frame * section.inertia_per_length * e.frame.transpose();
            }
            taken.push(ends.to_vec());
        }
        taken
    }
}

impl Beam {
    /// The sections of all places of all elements, by their indices.
    pub fn sections(&self) -> impl Iterator<Item = usize> {
        self.elements.iter().flat_map(|element| {
            let at_nodes = (0..=self.order).map(|k| element.at_node(k).section);
            at_nodes.chain((0..self.order).map(|g| element.at_point(g).section))
        })
    }

    /// Adds the mass of an element whose sections differ, by the masses at its nodes.
    fn take_varied(
        &self,
        element: &BeamElement,
        stiffnesses: &[Stiffness],
        x: &dyn Fn(usize) -> Vec3,
        sums: &mut MassIntegrals,
    ) {
        let [start, end] = element.ends(self.order).map(x);
        let (at, weights) = lobatto(self.order + 1);
        for (k, (xi, weight)) in at.iter().zip(weights).enumerate() {
            let SectionAt { section, frame } = element.at_node(k);
            let (section, share) = (&stiffnesses[section], 0.5 * weight * (end - start).norm());
            let place = start + (end - start) * (0.5 * (1.0 + xi)) + section.mass_arm(&frame).unwrap_or_default();
            let density = if self.mass == MassKind::None { 0.0 } else { section.mass_per_length };
            sums.add(density, &[place], |_, _| share);
            if self.rotary_inertia && self.mass != MassKind::None {
                sums.rotary += share * frame * section.inertia_per_length * frame.transpose();
            }
        }
    }
}

impl BeamElement {
    /// An element with these nodes and axes, its mass on the axis.
    pub fn new(nodes: [usize; 5], frame: Mat3, section: usize) -> BeamElement {
        BeamElement { nodes, frame, section, varied: None, mass_nodes: None }
    }

    /// The section at a node of the element.
    pub fn at_node(&self, k: usize) -> SectionAt {
        let same = SectionAt { section: self.section, frame: self.frame };
        self.varied.as_ref().map_or(same, |varied| varied.nodes[k])
    }

    /// The section at a Gauss point.
    pub fn at_point(&self, g: usize) -> SectionAt {
        let same = SectionAt { section: self.section, frame: self.frame };
        self.varied.as_ref().map_or(same, |varied| varied.points[g])
    }

    /// The nodes that carry its mass.
    pub fn mass_nodes(&self) -> &[usize; 5] {
        self.mass_nodes.as_deref().unwrap_or(&self.nodes)
    }

    /// First and last node of an element of this order.
    pub fn ends(&self, order: usize) -> [usize; 2] {
        [self.nodes[0], self.nodes[order]]
    }
}
