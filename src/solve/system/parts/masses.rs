//! The masses of nodes and elements while they are summed.

use crate::system::inertia::{ConsistentMass, Lumped};
use base::math::{Mat3, Vec3};
use model::{MassKind, Model};

/// The lumped mass of an element: its shares at the nodes, in their order.
pub struct LumpedElement(pub Vec<NodalShare>);

/// The share of an element in the mass at a node.
pub struct NodalShare {
    /// The node.
    pub node: usize,
    /// Vector to it from the node of the element, global components at t = 0; zero where they are the same.
    pub arm: Vec3,
    /// Mass; zero if the deck omits it.
    pub mass: f64,
    /// Inertia tensor about the node, global components at t = 0; zero likewise.
    pub J0: Mat3,
    /// False where the node turns with a body: mass scaling leaves the rotary inertia there.
    pub turns: bool,
}

/// The masses of a scene while they are summed.
pub struct NodalMasses<'s> {
    /// Initial positions of all nodes.
    pub x: &'s [Vec3],
    /// True for each node that depends on a body.
    attached: Vec<bool>,
    /// True for each node that turns with a body about all axes.
    turned: Vec<bool>,
    /// Lumped masses and inertias of the nodes.
    pub lumped: Lumped,
    /// Consistent mass matrices of elements.
    pub consistent: Vec<ConsistentMass>,
}

impl<'s> NodalMasses<'s> {
    /// No mass yet.
    pub fn new(model: &Model, x: &'s [Vec3]) -> NodalMasses<'s> {
        let none = vec![false; x.len()];
        let [mut is_body, mut attached, mut turned] = [none.clone(), none.clone(), none];
        model.bodies.iter().for_each(|body| is_body[body.node] = true);
        let dependents = model.constraints.dependents.iter();
        for of in dependents.filter(|of| is_body[of.master]) {
            attached[of.node] = true;
            turned[of.node] = of.dofs[3..].iter().all(|&dof| dof);
        }
        NodalMasses { x, attached, turned, lumped: Lumped::new(x.len()), consistent: Vec::new() }
    }

    /// Adds the lumped mass of an element.
    pub fn add(&mut self, element: &LumpedElement) {
        element.0.iter().for_each(|share| self.lumped.add(share.node, share.mass, &share.J0));
    }

    /// True if a deformable part adds mass at this node.
    pub fn has_mass(&self, kind: MassKind, node: usize) -> bool {
        match kind {
            MassKind::Lumped => true,
            MassKind::FreeNodes => !self.attached[node],
            MassKind::Consistent | MassKind::None => false,
        }
    }

    /// False for a node that turns with a body about all axes.
    pub fn turns(&self, node: usize) -> bool {
        !self.turned[node]
    }

    /// True if a deformable part adds rotary inertia at this node.
    pub fn has_rotary_inertia(&self, kind: MassKind, node: usize) -> bool {
        kind == MassKind::Consistent || self.has_mass(kind, node)
    }
}
