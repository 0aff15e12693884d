//! The inertia of superelements in the equation of motion.

use super::mass_damping::MassDamping;
use super::parts::assembled;
use super::reduced;
use super::tangent_weights::TangentWeights;
use crate::tolerances::gyroscopic::STEP;
use base::math::rotation::exp;
use base::math::{Vec3, Vec6};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, FloatingWeights, InertiaIntegrals};
use mechanics::state::Node;
use model::{Model, Part, Reduction};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// The mass of a superelement.
#[derive(Debug, Clone)]
pub struct FloatingMass {
    /// The superelement.
    pub element: Arc<FloatingElement>,
    /// Rayleigh's factor on its mass, per time.
    pub alpha: f64,
    /// The integrals over its mass, where it is a reduced part.
    pub integrals: Option<Arc<InertiaIntegrals>>,
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
        match &self.integrals {
            None => self.element.add_inertia(nodes, field, dynamic, drag, F),
            Some(_) if !dynamic && drag.is_none() && *field == Vec3::zeros() => {}
            Some(own) => own.add_forces(&self.element, nodes, field, dynamic, drag, F),
        }
    }

    /// Writes the derivative of these forces, with the sign of a stiffness.
    pub fn tangent(&self, (nodes, field): (&[Node], &Vec3), weights: &TangentWeights, gyroscopic: bool, K: &mut [f64]) {
        let TangentWeights { rate, acceleration, stiffness, .. } = *weights;
        if let Some(own) = &self.integrals {
            // Gyroscopic terms are small in a step.
            return own.mass_tangent(&self.element, nodes, acceleration + self.alpha * rate, K);
        }
        let field = if stiffness { *field } else { Vec3::zeros() };
        let weights = FloatingWeights { rate, acceleration, alpha: self.alpha, gyroscopic };
        self.element.inertia_tangent(nodes, &field, &weights, K);
    }

    /// The power dissipated by damping in the motion relative to moving frames, and the power put in by the frames.
    pub fn powers(&self, damping: &MassDamping, nodes: &[Node]) -> [f64; 2] {
        let relative = |node: usize| damping.relative(node, nodes);
        let carried = |node: usize| damping.carried(node, nodes);
        match &self.integrals {
            None => self.element.drag_powers(nodes, self.alpha, &relative, &carried),
            Some(own) => own.drag_powers(&self.element, nodes, self.alpha, [&relative, &carried]),
        }
    }

    /// The work of a field between two configurations.
    pub fn work(&self, field: &Vec3, from: &[Node], to: &[Node]) -> f64 {
        self.element.total_mass() * field.dot(&self.moved(from, to))
    }

    /// The displacement of its centre of mass between two configurations.
    pub fn moved(&self, from: &[Node], to: &[Node]) -> Vec3 {
        let Some(own) = &self.integrals else {
            return self.element.center_now(to) - self.element.center_now(from);
        };
        let first = self.element.nodes()[0];
        to[first].relative_position(&from[first]) + own.center(&self.element, to) - own.center(&self.element, from)
    }

    /// Subtracts `factor` times the product of the mass matrix and small motions of all nodes from `F`.
    pub fn subtract_product(&self, nodes: &[Node], motions: &[Vec6], factor: f64, F: &mut [Force]) {
        match &self.integrals {
            None => self.element.subtract_mass(nodes, motions, factor, F),
            Some(own) => own.subtract_product(&self.element, nodes, motions, factor, F),
        }
    }

    /// The derivatives of inertia forces by the rates of small motions, and by these, in a steady spin. `turn` gives the rates of the amplitudes
    /// that lie still in space, per amplitude: they turn against the part. A column for each of six directions of each of its nodes; zeros after
    /// `stops` returns true.
    pub fn spin_derivatives(&self, nodes: &[Node], turn: &DMatrix<f64>, stops: &dyn Fn() -> bool) -> [DMatrix<f64>; 2] {
        let own = self.element.nodes();
        let (interface, size) = (own.len() - turn.nrows(), 6 * own.len());
        let mut nodes: Vec<Node> =
            nodes.iter().map(|node| Node { a: Vec3::zeros(), alpha: Vec3::zeros(), ..*node }).collect();
        let length = own[..interface].iter().map(|&node| (nodes[node].x - nodes[own[0]].x).norm()).fold(0.0, f64::max);
        let spin = nodes[own[0]].omega.norm();
        let square = turn * turn;
        let steady: Vec<Node> = own.iter().map(|&node| nodes[node]).collect();
        let mut F = vec![[0.0; 6]; nodes.len()];
        let mut forces = |column: usize, [x, rate]: [f64; 2]| {
            let (i, dof) = (column / 6, column % 6);
            let node = &mut nodes[own[i]];
            match (i < interface, dof) {
                (true, 0..3) => (node.x[dof], node.v[dof]) = (node.x[dof] + x, node.v[dof] + rate),
                (true, _) => {
                    let axis = Vec3::ith(dof - 3, 1.0);
                    let turned = axis.cross(&node.omega);
                    node.rotation = exp(&(x * axis)) * node.rotation;
                    (node.omega, node.alpha) = (node.omega + rate * axis + x * turned, rate * turned);
                }
                _ => {
                    let k = i - interface;
                    node.x.x += x;
                    node.v.x += rate;
                    for (row, &other) in own[interface..].iter().enumerate() {
                        nodes[other].v.x += x * turn[(row, k)];
                        nodes[other].a.x += x * square[(row, k)] + 2.0 * rate * turn[(row, k)];
                    }
                }
            }
            own.iter().for_each(|&node| F[node] = [0.0; 6]);
            self.add_forces(&nodes, &Vec3::zeros(), true, None, &mut F);
            own.iter().zip(&steady).for_each(|(&node, steady)| nodes[node] = *steady);
            DVector::from_iterator(size, own.iter().flat_map(|&node| F[node]))
        };
        let mut derivative = |step: [f64; 2]| {
            let columns: Vec<DVector<f64>> = (0..size)
                .map(|k| match k / 6 >= interface && k % 6 > 0 || stops() {
                    true => DVector::zeros(size),
                    false => (forces(k, step.map(|step| -step)) - forces(k, step)) / (2.0 * (step[0] + step[1])),
                })
                .collect();
            DMatrix::from_columns(&columns)
        };
        // Forces are products of two rates, whose differences are exact.
        [derivative([0.0, spin]), derivative([STEP * if length > 0.0 { length.min(1.0) } else { 1.0 }, 0.0])]
    }

    /// Kinetic energy, linear momentum, and angular momentum about the origin.
    pub fn motion(&self, nodes: &[Node]) -> (f64, Vec3, Vec3) {
        match &self.integrals {
            None => self.element.motion(nodes),
            Some(own) => own.motion(&self.element, nodes),
        }
    }
}

/// The masses of superelements.
pub fn floating_masses(model: &Model, x: &[Vec3]) -> Vec<FloatingMass> {
    let of_part = |part: &Part| {
        let element = assembled(part).floating(x, 0.0).filter(|element| element.total_mass() > 0.0)?;
        Some(FloatingMass {
            element: Arc::new(element),
            alpha: model.damping.alpha(&part.own_damping()),
            integrals: None,
        })
    };
    let of_reduced = |of: &Reduction| {
        let element = reduced::element(model, of, x, 0.0).filter(|element| element.total_mass() > 0.0)?;
        let integrals = of.made.as_ref()?.integrals.clone();
        Some(FloatingMass { element: Arc::new(element), alpha: model.damping.alpha(&of.damping), integrals })
    };
    let reduced = model.reductions.iter().filter_map(of_reduced);
    model.parts.iter().filter_map(of_part).chain(reduced).collect()
}
