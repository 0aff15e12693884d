//! Deformable parts and links. An element sees the motion of its nodes and hands over forces and their derivatives;
//! of bodies, constraints and schemes it knows nothing.

pub mod bar;
pub mod beam;
pub mod bushing;
pub mod link;

use crate::math::{Mat3, Vec3};
use crate::state::Node;

/// Generalised force on a node: force and moment, global components.
pub type Force = [f64; 6];

/// A group of like elements. Matrices are row-major over the element's nodes, [`Block::dofs`] directions each.
pub trait Block: Send + Sync {
    fn len(&self) -> usize;
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Nodes of element `e`.
    fn nodes(&self, e: usize) -> &[usize];
    /// 3: translations only; 6: translations and rotations.
    fn dofs(&self) -> usize;
    /// Subtracts the internal forces of all elements from `F`, which is indexed by node.
    fn subtract_forces(&self, nodes: &[Node], F: &mut [Force]);
    /// Tangent of element `e`: K ← ∂f/∂(x, θ) + `rate_weight` · ∂f/∂(v, ω), f the internal force, θ spatial.
    fn tangent(&self, e: usize, nodes: &[Node], rate_weight: f64, K: &mut [f64]);
    /// Elastic energy stored.
    fn energy(&self, nodes: &[Node]) -> f64;
    /// Power that the damping of the elements takes (≥ 0), where there is any.
    fn damping_power(&self, _nodes: &[Node]) -> f64 {
        0.0
    }
    /// Stress resultants (N, Q_y, Q_z, T, M_y, M_z) in the axes of `frame` (columns, global at t = 0) at an integration
    /// point, and its distance from the element's start.
    fn resultants(&self, _e: usize, _point: usize, _frame: &Mat3, _nodes: &[Node]) -> Option<(f64, [f64; 6])> {
        None
    }
    /// True when the tangent never changes, whatever the motion.
    fn is_linear(&self) -> bool {
        false
    }
    /// The one direction in which an element acts, where it is fixed.
    fn fixed_direction(&self, _e: usize) -> Option<Vec3> {
        None
    }
    /// True when the element resists or damps by rate.
    fn is_damped(&self) -> bool {
        false
    }
}

#[inline]
pub(crate) fn subtract(F: &mut Force, at: usize, f: &Vec3) {
    F[at] -= f.x;
    F[at + 1] -= f.y;
    F[at + 2] -= f.z;
}
