//! Nodes, and their masses: rigid bodies and point masses.

use super::GivenVelocity;
use base::math::{Mat3, Vec3};
use mechanics::solids::SolidShape;
use std::sync::Arc;

/// The deck's words for the six degrees of freedom of a node.
pub const DIRECTIONS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// A node: a point that moves and rotates. Its rotation is measured from the undeformed state, so it starts at the
/// identity.
#[derive(Debug, Clone)]
pub struct Node {
    /// The deck's name, or one made from it: `portal[3]`, `bumper.from`.
    pub label: String,
    /// True for points named in the deck and for bodies.
    pub named: bool,
    /// True for a node without a place: its displacement along x is a scalar, such as the coordinate of a driven joint.
    pub is_number: bool,
    /// Initial position, global components.
    pub x: Vec3,
    /// Initial velocity, global components.
    pub v: Vec3,
    /// Initial angular velocity, global components.
    pub omega: Vec3,
    /// The velocity and the angular velocity given in the deck.
    pub given: [Option<GivenVelocity>; 2],
    /// Bytes in the deck that name it or its part: the first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// A rigid body: a node at its centre of mass, with mass and inertia.
#[derive(Debug, Clone)]
pub struct Body {
    /// The deck's name.
    pub name: String,
    /// The node at its centre of mass.
    pub node: usize,
    /// Mass.
    pub mass: f64,
    /// Inertia tensor about the centre of mass, in body axes, which are global at t = 0.
    pub inertia: Mat3,
    /// The shape for drawing: the deck's, or the cuboid of the same inertia.
    pub shape: Arc<dyn SolidShape>,
}

impl Body {
    /// The index of the body at a node among bodies, which stand in the order of their nodes.
    pub fn at(bodies: &[Body], node: usize) -> Option<usize> {
        bodies.binary_search_by_key(&node, |body| body.node).ok()
    }
}

/// A point mass with optional rotary inertia.
#[derive(Debug, Clone)]
pub struct Mass {
    /// The node.
    pub node: usize,
    /// Mass.
    pub mass: f64,
    /// Inertia tensor about the node, in global axes at t = 0.
    pub inertia: Mat3,
}
