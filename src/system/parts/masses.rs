//! The masses of nodes and elements while they are summed.

use crate::math::{Mat3, Vec3, quadrature};
use crate::model::{Beam, MassKind, Model};
use crate::sections::Stiffness;
use crate::system::inertia::{ConsistentMass, Lumped};

/// The masses of a scene while they are summed.
pub struct NodalMasses<'s> {
    /// Initial positions of all nodes.
    pub x: &'s [Vec3],
    /// True for each node that depends on a body.
    attached: Vec<bool>,
    /// Lumped masses and inertias of the nodes.
    pub lumped: Lumped,
    /// Consistent mass matrices of elements.
    pub consistent: Vec<ConsistentMass>,
}

impl<'s> NodalMasses<'s> {
    /// No mass yet.
    pub fn new(model: &Model, x: &'s [Vec3]) -> NodalMasses<'s> {
        let (mut is_body, mut attached) = (vec![false; x.len()], vec![false; x.len()]);
        model.bodies.iter().for_each(|body| is_body[body.node] = true);
        let dependents = model.constraints.dependents.iter();
        dependents.filter(|of| is_body[of.master]).for_each(|of| attached[of.node] = true);
        NodalMasses { x, attached, lumped: Lumped::new(x.len()), consistent: Vec::new() }
    }

    /// Lumped mass and inertia tensor (global components at t = 0) of an element of a beam at its `a`-th node.
    pub fn share_of_beam(&self, beam: &Beam, element: usize, a: usize, stiffnesses: &[Stiffness]) -> (f64, Mat3) {
        let (_, weights) = quadrature::lobatto(beam.order + 1);
        let element = &beam.elements[element];
        let (node, section) = (element.nodes[a], &stiffnesses[element.section]);
        let length = (self.x[element.nodes[beam.order]] - self.x[element.nodes[0]]).norm();
        let rotary = element.frame * section.inertia_per_length * element.frame.transpose();
        let share = 0.5 * weights[a] * length;
        let mass = if self.has_mass(beam.mass, node) { share * section.mass_per_length } else { 0.0 };
        let keep = beam.rotary_inertia && self.has_rotary_inertia(beam.mass, node);
        (mass, if keep { rotary * share } else { Mat3::zeros() })
    }

    /// True where a deformable part has mass at a node of its own.
    pub fn has_mass(&self, kind: MassKind, node: usize) -> bool {
        match kind {
            MassKind::Lumped => true,
            MassKind::FreeNodes => !self.attached[node],
            MassKind::Consistent | MassKind::None => false,
        }
    }

    /// True where a deformable part has rotary inertia at a node of its own.
    pub fn has_rotary_inertia(&self, kind: MassKind, node: usize) -> bool {
        kind == MassKind::Consistent || self.has_mass(kind, node)
    }
}
