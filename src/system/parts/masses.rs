//! The masses of nodes and elements while they are summed.

use crate::math::Vec3;
use crate::model::{MassKind, Model};
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
