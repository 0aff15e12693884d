//! Nodes, and what gives them mass: rigid bodies and point masses.

use crate::math::{Mat3, Vec3};
use crate::solids::SolidShape;
use std::sync::Arc;

/// Words for the six directions of a node.
pub const DIRECTIONS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

/// A point that moves. Its rotation is measured from the undeformed state, so it starts at the identity.
#[derive(Debug, Clone)]
pub struct Node {
    /// The deck's name, or one made from it: `portal[3]`, `bumper.from`.
    pub label: String,
    /// True for points named in the deck and for bodies.
    pub named: bool,
    pub x: Vec3,
    /// Initial velocity and angular velocity, global components.
    pub v: Vec3,
    pub omega: Vec3,
    /// Where the deck names it, or the part that it belongs to: first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// A rigid body: a node at its centre of mass, with mass and inertia.
#[derive(Debug, Clone)]
pub struct Body {
    pub name: String,
    pub node: usize,
    pub mass: f64,
    /// About the centre, body axes = global axes at t = 0.
    pub inertia: Mat3,
    /// For drawing: what the deck said, or the cuboid of the same inertia.
    pub shape: Arc<dyn SolidShape>,
}

/// A point mass (with optional rotary inertia, global axes at t = 0).
#[derive(Debug, Clone)]
pub struct Mass {
    pub node: usize,
    pub mass: f64,
    pub inertia: Mat3,
}
