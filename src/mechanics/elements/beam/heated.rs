//! Temperatures of beams: the strains without stress, Γ₁ = ε and κ = (0, ∂ε/∂z, −∂ε/∂y) in section axes, and the work of stress on them.

use super::kinematics::BeamHeat;
use crate::state::Node;
use base::math::Vec3;

/// Γ and κ.
type Pair = [Vec3; 2];

impl BeamHeat {
    /// Γ and κ by one of the three strains, in an element with this tangent.
    pub fn unit(&self, e: usize, tangent: &Vec3, of: usize) -> Pair {
        let [y, z] = self.axes[e];
        match of {
            0 => [self.nodes.factor(e) * tangent, Vec3::zeros()],
            1 => [Vec3::zeros(), -z],
            _ => [Vec3::zeros(), y],
        }
    }

    /// Γ and κ without stress.
    pub fn strain(&self, e: usize, tangent: &Vec3, nodes: &[Node]) -> Pair {
        let [axial, by_y, by_z] = self.nodes.strain(nodes);
        let [y, z] = self.axes[e];
        [self.nodes.factor(e) * axial * tangent, by_z * y - by_y * z]
    }

    /// The work of a stress, integrated over the length, by each of the three strains.
    pub fn work(&self, e: usize, tangent: &Vec3, [n, m]: &Pair) -> [f64; 3] {
        let [y, z] = self.axes[e];
        [self.nodes.factor(e) * n.dot(tangent), -m.dot(&z), m.dot(&y)]
    }
}

/// Strains less those without stress.
#[inline]
pub(super) fn less((gamma, kappa): (Vec3, Vec3), free: Option<&Pair>) -> (Vec3, Vec3) {
    match free {
        None => (gamma, kappa),
        Some([of_gamma, of_kappa]) => (gamma - of_gamma, kappa - of_kappa),
    }
}
