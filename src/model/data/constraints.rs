//! Dependent nodes, joints and restraints.

use crate::constraints::joint::ConstraintEquation;
use crate::deck::supports::History;

/// What ties nodes to one another and to the ground.
#[derive(Debug, Clone, Default)]
pub struct Constraints {
    /// Nodes tied to other nodes, each at most once, in no particular order.
    pub dependents: Vec<DependentNode>,
    /// In deck order; those that hold supports of dependent nodes come last.
    pub joints: Vec<Joint>,
    /// Each direction of a node at most once, sorted by node and direction.
    pub restraints: Vec<Restraint>,
}

/// A node constrained to another in some of its directions (45)-(48).
#[derive(Debug, Clone)]
pub struct DependentNode {
    pub node: usize,
    pub master: usize,
    /// Which of ux, uy, uz, rx, ry, rz are taken from the master.
    pub dofs: [bool; 6],
    /// Where the deck attaches it: first byte, and the one after the last.
    pub place: Option<[usize; 2]>,
}

/// Two nodes held together by multipliers (57).
#[derive(Debug, Clone)]
pub struct Joint {
    pub name: String,
    /// Nodes at `from` and `to`: dependent nodes of a node or body, the node itself, or a restrained node for the ground.
    pub ends: [usize; 2],
    pub equations: Vec<ConstraintEquation>,
    /// It holds a dependent node to its support, whose reactions say what it carries.
    pub supports: bool,
}

/// A restrained direction of a node: it is at rest, or its motion is prescribed.
#[derive(Debug, Clone)]
pub struct Restraint {
    pub node: usize,
    /// 0..6: ux, uy, uz, rx, ry, rz.
    pub dof: usize,
    /// `None`: at rest.
    pub motion: Option<PrescribedMotion>,
}

/// A prescribed motion: an amplitude times a factor.
#[derive(Debug, Clone)]
pub struct PrescribedMotion {
    pub amplitude: usize,
    pub scale: f64,
    pub history: History,
}
