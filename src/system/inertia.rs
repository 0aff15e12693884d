//! Mass of nodes. A rigid body, a point mass and a beam's share at a node are the same thing: m and J₀ at a node, the
//! Newton-Euler equations (33); what falls on one node is summed once, before the run.

use super::scale::Scale;
use crate::elements::Force;
use crate::math::{Mat3, Mat6, Vec3, quadrature, skew};
use crate::state::Node;

/// Mass and inertia at a node; `J0` in the axes that were global at t = 0.
#[derive(Debug, Clone)]
pub struct Inertia {
    pub node: usize,
    pub mass: f64,
    pub J0: Mat3,
    /// J₀ ≠ 0.
    pub rotary: bool,
}

impl Inertia {
    /// J = R J₀ Rᵀ (28).
    #[inline]
    pub fn J(&self, node: &Node) -> Mat3 {
        let R = node.R();
        R * self.J0 * R.transpose()
    }

    /// m (field − a), −(J α + ω×J ω)                                                        (33)
    /// `scale` meets the terms one by one: in free motion they cancel.
    #[inline]
    pub fn force(&self, node: &Node, field: &Vec3, dynamic: bool, scale: &mut Scale) -> Force {
        let weight = self.mass * field;
        scale.include_force(&weight);
        if !dynamic {
            return [weight.x, weight.y, weight.z, 0.0, 0.0, 0.0];
        }
        let inertia = self.mass * node.a;
        scale.include_force(&inertia);
        let f = weight - inertia;
        if !self.rotary {
            return [f.x, f.y, f.z, 0.0, 0.0, 0.0];
        }
        // In body axes J₀ is constant: rotate the two vectors instead of the tensor.
        let R = node.R();
        let (omega, alpha) = (R.tr_mul(&node.omega), R.tr_mul(&node.alpha));
        let (spin, gyroscopic) = (self.J0 * alpha, omega.cross(&(self.J0 * omega)));
        scale.include_moment(&spin);
        scale.include_moment(&gyroscopic);
        let m = R * (spin + gyroscopic);
        [f.x, f.y, f.z, -m.x, -m.y, -m.z]
    }

    pub fn add_damping(&self, node: &Node, factor: f64, f: &mut Force) {
        crate::elements::subtract(f, 0, &(factor * self.mass * node.v));
        if self.rotary {
            crate::elements::subtract(f, 3, &(factor * (self.J(node) * node.omega)));
        }
    }

    pub fn kinetic_energy(&self, node: &Node) -> f64 {
        let mut twice = self.mass * node.v.norm_squared();
        if self.rotary {
            twice += node.omega.dot(&(self.J(node) * node.omega));
        }
        0.5 * twice
    }

    /// Derivative of the inertia and mass-damping force (sign of a stiffness) for increments of weights q̇ and q̈.
    /// With `gyroscopic`, all of it (unsymmetric: C(r) (37) and the turning of J); without, M and α M alone.
    pub fn tangent(&self, node: &Node, (rate, acceleration): (f64, f64), damping: f64, gyroscopic: bool) -> Mat6 {
        let mut K = Mat6::zeros();
        let w = acceleration + damping * rate;
        K.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        K *= w * self.mass;
        if self.rotary {
            let J = self.J(node);
            let mut k = w * J;
            if gyroscopic {
                let (omega, alpha) = (skew(&node.omega), skew(&node.alpha));
                let L = skew(&(J * node.omega));
                let C = omega * J - L;
                // ∂ω/∂θ ≈ rate·I − ½ ω~ and ∂α/∂θ ≈ acceleration·I − ½ α~ along the rotation vector of the step.
                k += C * (rate * Mat3::identity() - 0.5 * omega) + J * (0.5 * alpha) + omega * (J * omega - L)
                    - skew(&(J * node.alpha));
            }
            K.fixed_view_mut::<3, 3>(3, 3).copy_from(&k);
        }
        K
    }
}

/// Sums what falls on each node.
pub struct Lumped(Vec<(f64, Mat3)>);

impl Lumped {
    pub fn new(nodes: usize) -> Self {
        Lumped(vec![(0.0, Mat3::zeros()); nodes])
    }

    pub fn add(&mut self, node: usize, mass: f64, J0: &Mat3) {
        self.0[node].0 += mass;
        self.0[node].1 += J0;
    }

    pub fn finish(self) -> Vec<Inertia> {
        let entry = |(node, (mass, J0)): (usize, (f64, Mat3))| {
            let rotary = J0 != Mat3::zeros();
            (mass > 0.0 || rotary).then_some(Inertia { node, mass, J0, rotary })
        };
        self.0.into_iter().enumerate().filter_map(entry).collect()
    }
}

/// Translational mass of an element by its shape functions: the same number for each direction.
#[derive(Debug, Clone)]
pub struct ConsistentMass {
    pub nodes: Vec<usize>,
    /// Row-major over the nodes.
    pub m: Vec<f64>,
}

impl ConsistentMass {
    /// ∫ N_a N_b over a straight element of this mass with Lobatto nodes.
    pub fn new(nodes: &[usize], mass: f64) -> Self {
        let n = nodes.len();
        let (at, _) = quadrature::lobatto(n);
        let (points, weights) = quadrature::gauss(n);
        let shape =
            |a: usize, xi: f64| -> f64 { (0..n).filter(|&b| b != a).map(|b| (xi - at[b]) / (at[a] - at[b])).product() };
        let entry =
            |a, b| points.iter().zip(weights).map(|(&xi, w)| 0.5 * w * shape(a, xi) * shape(b, xi)).sum::<f64>();
        let m = (0..n * n).map(|i| mass * entry(i / n, i % n)).collect();
        ConsistentMass { nodes: nodes.to_vec(), m }
    }

    /// ∫ N_a N_b over a shell of this mass per area, with the corners at `x`.
    pub fn of_shell(nodes: &[usize], x: &[Vec3], mass: f64) -> Self {
        let n = nodes.len();
        let products = crate::elements::shell::products(x);
        let m = (0..n * n).map(|i| mass * products[i / n][i % n]).collect();
        ConsistentMass { nodes: nodes.to_vec(), m }
    }

    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let n = self.nodes.len();
        self.m.iter().enumerate().map(move |(i, &m)| (self.nodes[i / n], self.nodes[i % n], m))
    }

    pub fn add_forces(&self, nodes: &[Node], field: &Vec3, dynamic: bool, damping: f64, F: &mut [Force]) {
        for (a, b, m) in self.pairs() {
            let mut acceleration = -field;
            if dynamic {
                acceleration += nodes[b].a + damping * nodes[b].v;
            }
            crate::elements::subtract(&mut F[a], 0, &(m * acceleration));
        }
    }

    pub fn kinetic_energy(&self, nodes: &[Node]) -> f64 {
        self.pairs().map(|(a, b, m)| 0.5 * m * nodes[a].v.dot(&nodes[b].v)).sum()
    }

    /// Linear momentum, and angular momentum about the origin.
    pub fn momentum(&self, nodes: &[Node]) -> (Vec3, Vec3) {
        self.pairs().fold((Vec3::zeros(), Vec3::zeros()), |(p, l), (a, b, m)| {
            (p + m * nodes[b].v, l + m * nodes[a].x.cross(&nodes[b].v))
        })
    }
}
