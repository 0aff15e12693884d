//! Beams: lines of elements that stretch, shear, bend and twist.

use super::case::YieldLimit;
use super::integrals::{MassIntegrals, line_mass};
use super::lattice;
use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, LineElement, NodeWeights, PartAnswers};
use base::math::{Mat3, Vec3};
use base::quantities::{Column, PLASTIC_STRAIN, SECTION_FORCES, SECTION_STRESSES};
use deck::part_table::MassKind;
use mechanics::elements::beam::FibreModel;
use mechanics::elements::heat::Heat;
use mechanics::sections::Stiffness;

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
    /// Index into [`super::Model::stiffnesses`].
    pub section: usize,
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
        let fibres = model.fibres.iter().map(|fibre| [fibre.y, fibre.z]).collect();
        let sections = self.elements.iter().map(|element| element.section).collect();
        Some(YieldLimit { fibres, sections, ..YieldLimit::of(&model.law) })
    }

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        &self.elements[element].nodes[..=self.order]
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        let order = self.order;
        self.elements.iter_mut().flat_map(|e| &mut e.nodes[..=order]).chain(self.heat.nodes_mut()).for_each(visit);
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
        let [start, end] = self.elements[element].ends(self.order).map(|node| nodes[node].x);
        stiffnesses[self.elements[element].section].mass_per_length * (start - end).norm()
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

    /// The mass lies on the axis, with the rotary inertia of the section.
    fn take_out(
        &mut self,
        stiffnesses: &[Stiffness],
        x: &dyn Fn(usize) -> Vec3,
        sums: &mut MassIntegrals,
    ) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        for e in std::mem::take(&mut self.elements) {
            let ends = e.ends(self.order);
            let x = ends.map(x);
            let (length, section) = ((x[1] - x[0]).norm(), &stiffnesses[e.section]);
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

impl BeamElement {
    /// First and last node of an element of this order.
    pub fn ends(&self, order: usize) -> [usize; 2] {
        [self.nodes[0], self.nodes[order]]
    }
}
