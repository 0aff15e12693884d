//! What changes when a step is accepted, and nothing else: time and the motion of every node.

use crate::math::{Mat3, Vec3};
use nalgebra::Quaternion;

/// Motion of one node, all in global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    pub x: Vec3,
    /// Rotation from the undeformed state, unit quaternion; see [`Node::R`].
    pub q: Quaternion<f64>,
    pub v: Vec3,
    pub omega: Vec3,
    pub a: Vec3,
    pub alpha: Vec3,
}

impl Node {
    pub fn at_rest(x: Vec3) -> Self {
        let zero = Vec3::zeros();
        Node { x, q: Quaternion::identity(), v: zero, omega: zero, a: zero, alpha: zero }
    }

    /// Rotation matrix of `q`.
    #[inline]
    pub fn R(&self) -> Mat3 {
        crate::math::rotation::matrix(&self.q)
    }
}

/// Time and nodes at the end of an accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub time: f64,
    pub nodes: Vec<Node>,
    /// Energy that has crossed the boundary since t = 0, and the forces it is integrated from.
    pub work: Work,
}

/// Running integrals of power since t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// Done by loads, gravity and prescribed motion.
    pub external: f64,
    /// Taken by dampers, nodal and Rayleigh damping.
    pub damping: f64,
}
