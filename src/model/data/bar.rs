//! Bars and cables: lines of elements that resist stretching alone.

use super::case::YieldLimit;
use super::integrals::{MassIntegrals, line_mass};
use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, LineElement, NodeWeights, PartAnswers};
use base::math::{Mat3, Vec3};
use base::quantities::{AXIAL_FORCE, Column, PLASTIC_STRAIN};
use deck::part_table::MassKind;
use mechanics::elements::heat::Heat;
use mechanics::materials::MaterialLaw;
use mechanics::sections::Stiffness;

/// A line of nodes, each two of them joined by an element that resists stretching alone.
#[derive(Debug, Clone)]
pub struct Bar {
    /// The deck's name.
    pub name: String,
    /// E A, force per unit strain.
    pub axial_stiffness: f64,
    /// Mass per length.
    pub mass_per_length: f64,
    /// The distribution of the mass.
    pub mass: MassKind,
    /// Rayleigh factors of this part.
    pub damping: OwnDamping,
    /// True where the bar goes slack under compression.
    pub tension_only: bool,
    /// Length without force over that at t = 0.
    pub free: f64,
    /// The law of the material; `None` where it is elastic.
    pub yielding: Option<MaterialLaw>,
    /// Temperatures.
    pub heat: Heat,
    /// The two nodes of each element.
    pub elements: Vec<[usize; 2]>,
}

impl Bar {
    /// The quantities for `[[expect]]`; plastic strain only if its material yields.
    pub(super) const QUANTITIES: &'static [&'static [Column]] = &[&[AXIAL_FORCE, PLASTIC_STRAIN]];
}

impl PartAnswers for Bar {
    fn name(&self) -> &str {
        &self.name
    }

    fn make_elastic(&mut self) -> Option<YieldLimit> {
        let limit = YieldLimit::of(&self.yielding.take()?);
        Some(YieldLimit { area: self.axial_stiffness / limit.modulus, ..limit })
    }

    fn elements(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, element: usize) -> &[usize] {
        &self.elements[element]
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        self.elements.iter_mut().flatten().chain(self.heat.nodes_mut()).for_each(visit);
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

    fn line(&self, _: usize, _: f64, _: &[Stiffness]) -> Option<LineElement> {
        Some(LineElement { axes: None, shear: None })
    }

    fn element_mass(&self, element: usize, nodes: &[Node], _: &[Stiffness]) -> f64 {
        let [start, end] = self.elements[element].map(|node| nodes[node].x);
        self.mass_per_length * (start - end).norm()
    }

    fn stretching(&self, element: usize, nodes: &[Node], _: &[Stiffness]) -> Option<f64> {
        let [start, end] = self.elements[element].map(|node| nodes[node].x);
        Some(self.axial_stiffness / (start - end).norm())
    }

    fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        Some(Drawing::Curve { nodes: self.nodes(element), axes: Mat3::identity() })
    }

    fn places_between(&self, count: usize) -> Vec<NodeWeights> {
        let mut places = Vec::new();
        for &[a, b] in &self.elements {
            places.extend((1..=count).map(|k| {
                let s = k as f64 / (count + 1) as f64;
                vec![(a, 1.0 - s), (b, s)]
            }));
        }
        places
    }

    fn take_out(&mut self, _: &[Stiffness], x: &dyn Fn(usize) -> Vec3, sums: &mut MassIntegrals) -> Vec<Vec<usize>> {
        let mut taken = Vec::new();
        for ends in std::mem::take(&mut self.elements) {
            let x = ends.map(x);
            let density = if self.mass == MassKind::None { 0.0 } else { self.mass_per_length };
            sums.add(density, &x, |a, b| (x[1] - x[0]).norm() * line_mass(a, b));
            taken.push(ends.to_vec());
        }
        taken
    }
}
