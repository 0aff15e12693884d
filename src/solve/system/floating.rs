//! The inertia of superelements in the equation of motion.

use super::mass_damping::MassDamping;
use super::tangent_weights::TangentWeights;
use base::math::{Vec3, Vec6};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, FloatingWeights};
use mechanics::state::Node;
use std::sync::Arc;

/// The mass of a superelement.
#[derive(Debug, Clone)]
pub struct FloatingMass {
    /// The superelement.
    pub element: Arc<FloatingElement>,
    /// Rayleigh's factor on its mass, per time.
    pub alpha: f64,
}

impl FloatingMass {
    /// Subtracts inertia forces and Rayleigh damping from `F`, and adds weight; weight alone unless `dynamic`.
    pub fn add_forces(
        &self,
        nodes: &[Node],
        field: &Vec3,
        dynamic: bool,
        damping: Option<&MassDamping>,
        F: &mut [Force],
    ) {
        match damping.filter(|_| self.alpha > 0.0) {
            None => self.element.add_inertia(nodes, field, dynamic, None, F),
            Some(damping) => {
                let relative = |node: usize| damping.relative(node, nodes);
                self.element.add_inertia(nodes, field, dynamic, Some((self.alpha, &relative)), F);
            }
        }
    }

    /// Writes the derivative of these forces, with the sign of a stiffness.
    pub fn tangent(&self, (nodes, field): (&[Node], &Vec3), weights: &TangentWeights, gyroscopic: bool, K: &mut [f64]) {
        let TangentWeights { rate, acceleration, stiffness, .. } = *weights;
        let field = if stiffness { *field } else { Vec3::zeros() };
        let weights = FloatingWeights { rate, acceleration, alpha: self.alpha, gyroscopic };
        self.element.inertia_tangent(nodes, &field, &weights, K);
    }

    /// The power dissipated by damping in the motion relative to moving frames, and the power put in by the frames.
    pub fn powers(&self, damping: &MassDamping, nodes: &[Node]) -> [f64; 2] {
        let relative = |node: usize| damping.relative(node, nodes);
        let carried = |node: usize| damping.carried(node, nodes);
        self.element.drag_powers(nodes, self.alpha, &relative, &carried)
    }

    /// The work of a field between two configurations.
    pub fn work(&self, field: &Vec3, from: &[Node], to: &[Node]) -> f64 {
        self.element.total_mass() * field.dot(&self.moved(from, to))
    }

    /// The displacement of its centre of mass between two configurations.
    pub fn moved(&self, from: &[Node], to: &[Node]) -> Vec3 {
        self.element.center_now(to) - self.element.center_now(from)
    }

    /// Subtracts `factor` times the product of the mass matrix and small motions of all nodes from `F`.
    pub fn subtract_product(&self, nodes: &[Node], motions: &[Vec6], factor: f64, F: &mut [Force]) {
        self.element.subtract_mass(nodes, motions, factor, F);
    }
}
