//! The inertia of superelements in the equation of motion.

use super::mass_damping::MassDamping;
use super::parts::assembled;
use super::reduced;
use super::reduced_mass::ReducedMass;
use super::tangent_weights::TangentWeights;
use base::math::{Vec3, Vec6};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, FloatingWeights};
use mechanics::state::Node;
use model::{Model, Part, Reduction};
use std::sync::Arc;

/// The mass of a superelement.
#[derive(Debug, Clone)]
pub struct FloatingMass {
    /// The superelement.
    pub element: Arc<FloatingElement>,
    /// Rayleigh's factor on its mass, per time.
    pub alpha: f64,
    /// The masses of its nodes, where it is a reduced part.
    pub nodes: Option<Arc<ReducedMass>>,
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
        let damping = damping.filter(|_| self.alpha > 0.0);
        let relative = damping.map(|damping| move |node: usize| damping.relative(node, nodes));
        let drag = relative.as_ref().map(|relative| (self.alpha, relative as &dyn Fn(usize) -> [Vec3; 2]));
        match &self.nodes {
            None => self.element.add_inertia(nodes, field, dynamic, drag, F),
            Some(own) => {
                own.add_forces(nodes, field, dynamic, F);
                if drag.is_some() {
                    self.element.add_inertia(nodes, &Vec3::zeros(), false, drag, F);
                }
            }
        }
    }

    /// Writes the derivative of these forces, with the sign of a stiffness.
    pub fn tangent(&self, (nodes, field): (&[Node], &Vec3), weights: &TangentWeights, gyroscopic: bool, K: &mut [f64]) {
        let TangentWeights { rate, acceleration, stiffness, .. } = *weights;
        if self.nodes.is_some() {
            // Gyroscopic terms of the matrices differ from the forces of the nodes, and are small in a step.
            return self.element.mass_tangent(nodes, acceleration + self.alpha * rate, K);
        }
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
        match &self.nodes {
            None => self.element.center_now(to) - self.element.center_now(from),
            Some(own) => own.center_moved(to) - own.center_moved(from),
        }
    }

    /// Subtracts `factor` times the product of the mass matrix and small motions of all nodes from `F`.
    pub fn subtract_product(&self, nodes: &[Node], motions: &[Vec6], factor: f64, F: &mut [Force]) {
        match &self.nodes {
            None => self.element.subtract_mass(nodes, motions, factor, F),
            Some(own) => own.subtract_product(nodes, motions, factor, F),
        }
    }

    /// Kinetic energy, linear momentum, and angular momentum about the origin.
    pub fn motion(&self, nodes: &[Node]) -> (f64, Vec3, Vec3) {
        self.nodes.as_ref().map_or_else(|| self.element.motion(nodes), |own| own.motion(nodes))
    }
}

/// The masses of superelements.
pub fn floating_masses(model: &Model, x: &[Vec3]) -> Vec<FloatingMass> {
    let of_part = |part: &Part| {
        let element = assembled(part).floating(x, 0.0).filter(|element| element.total_mass() > 0.0)?;
        Some(FloatingMass { element: Arc::new(element), alpha: model.damping.alpha(&part.own_damping()), nodes: None })
    };
    let of_reduced = |of: &Reduction| {
        let element = reduced::element(model, of, x, 0.0).filter(|element| element.total_mass() > 0.0)?;
        let nodes = ReducedMass::new(model, of, x).map(Arc::new);
        Some(FloatingMass { element: Arc::new(element), alpha: model.damping.alpha(&of.damping), nodes })
    };
    let reduced = model.reductions.iter().filter_map(of_reduced);
    model.parts.iter().filter_map(of_part).chain(reduced).collect()
}
