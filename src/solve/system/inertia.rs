//! Inertia of nodes. Bodies, point masses and shares of beams have the same form: a mass m and a tensor J₀ at a node with the Newton-Euler
//! equations (33). All that falls on one node is summed once, before the run.

use super::scale::Scale;
use super::tangent_weights::TangentWeights;
use base::math::{Mat3, Mat6, Vec3, quadrature, skew};
use mechanics::elements::Force;
use mechanics::state::Node;

/// Mass and inertia tensor of a node; `J0` has components in axes fixed to the node that were global at t = 0.
#[derive(Debug, Clone)]
pub struct Inertia {
    /// The node.
    pub node: usize,
    /// Inertial mass of the node.
    pub mass: f64,
    /// Gravitational mass: the inertial mass without mass scaling.
    pub weighing: f64,
    /// Inertia tensor J₀ about the node.
    pub J0: Mat3,
    /// The tensor of the deck where [`super::thin_axes`] raises J₀; energies and momenta of the tables are its own.
    pub of_deck: Option<Box<Mat3>>,
    /// True where J₀ ≠ 0.
    pub rotary: bool,
    /// True where the node turns by its angular momentum: one of [`super::TurningBody`].
    pub turns: bool,
    /// The part of its angular acceleration in axes of the body, in axes of [`Inertia::J0`]; `None` where there is none.
    pub own: Option<Box<Mat3>>,
    /// The mass damping of a node whose shares have different factors α; `None` if the factor of the model applies.
    pub drag: Option<Box<OwnDrag>>,
}

/// The sum of α m and of α J₀ at a node whose shares have different factors.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnDrag {
    /// Force per velocity.
    pub mass: f64,
    /// Moment per angular velocity, in the axes of [`Inertia::J0`].
    pub J0: Mat3,
}

impl Inertia {
    /// The inertia tensor J = R J₀ Rᵀ (28), global components.
    #[inline]
    pub fn J(&self, node: &Node) -> Mat3 {
        let R = node.R();
        R * self.J0 * R.transpose()
    }

    /// The force m (field − a), with the gravitational mass for the field, and the moment −(J α + ω×J ω) of (33); weight alone unless
    /// `dynamic`. `scale` includes each term separately, because in free motion the terms cancel.
    #[inline]
    pub fn force(&self, node: &Node, field: &Vec3, dynamic: bool, scale: &mut Scale) -> Force {
        let weight = self.weighing * field;
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
        // J₀ is constant in body axes: two vectors are rotated in place of a tensor.
        let R = node.R();
        let (omega, alpha) = (R.tr_mul(&node.omega), R.tr_mul(&node.alpha));
        let (spin, gyroscopic) = (self.J0 * alpha, omega.cross(&(self.J0 * omega)));
        scale.include_moment(&spin);
        scale.include_moment(&gyroscopic);
        let m = R * (spin + gyroscopic);
        [f.x, f.y, f.z, -m.x, -m.y, -m.z]
    }

    /// Rayleigh damping: force per velocity and moment per angular velocity, global components; `alpha` applies to masses without a
    /// separate factor. `None` without rotary inertia.
    #[inline]
    pub fn drag(&self, node: &Node, alpha: f64) -> (f64, Option<Mat3>) {
        match &self.drag {
            None => (alpha * self.mass, self.rotary.then(|| alpha * self.J(node))),
            Some(own) => {
                let R = node.R();
                (own.mass, self.rotary.then(|| R * own.J0 * R.transpose()))
            }
        }
    }

    /// The angular momentum about the node, with the tensor of the deck, global components.
    pub fn spin(&self, node: &Node) -> Vec3 {
        let R = node.R();
        match &self.of_deck {
            None => self.J(node) * node.omega,
            Some(J0) => R * (**J0 * R.tr_mul(&node.omega)),
        }
    }

    /// The kinetic energy of translation and rotation, with the tensor of the deck.
    pub fn kinetic_energy(&self, node: &Node) -> f64 {
        let mut twice = self.mass * node.v.norm_squared();
        if self.rotary {
            twice += node.omega.dot(&self.spin(node));
        }
        0.5 * twice
    }

    /// Derivative of the inertia and mass-damping forces, with the sign of a stiffness, for increments of the weights `q̇` and `q̈`. With
    /// `gyroscopic` it is complete and unsymmetric, due to C(r) (37) and the rotation of J; otherwise it is M and α M.
    pub fn tangent(&self, node: &Node, weights: &TangentWeights, damping: f64, gyroscopic: bool) -> Mat6 {
        let TangentWeights { rate, acceleration, turning, .. } = *weights;
        let mut K = Mat6::zeros();
        let w = acceleration + damping * rate;
        K.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        K *= self.drag.as_ref().map_or(w * self.mass, |own| acceleration * self.mass + rate * own.mass);
        if self.rotary {
            let J = self.J(node);
            let mut k = match &self.drag {
                None => w * J,
                Some(own) => {
                    let R = node.R();
                    acceleration * J + rate * (R * own.J0 * R.transpose())
                }
            };
            if let (true, true, Some(kappa)) = (gyroscopic, self.turns, turning) {
                let weights = [rate, acceleration / rate, kappa];
                let more = self.momentum_tangent(node, &J, weights);
                k += match &self.own {
                    Some(own) => {
                        let R = node.R();
                        more + R * (**own * R.tr_mul(&(self.own_tangent(node, &J, weights) - more)))
                    }
                    None => more,
                };
            } else if gyroscopic {
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

    /// The derivative of the rate of angular momentum `e J ω + …`, less `e rate J`, for a small turn δθ. The momentum changes by `δθ×π + J
    /// δΩ`, and the angular velocity in body axes by `δΩ = (rate + ½ ω~ + κ rate J⁻¹ (π~ − ω~J)) δθ`. A finite rotation vector adds terms
    /// of second order in the step.
    fn momentum_tangent(&self, node: &Node, J: &Mat3, [rate, e, kappa]: [f64; 3]) -> Mat3 {
        let (omega, L) = (skew(&node.omega), skew(&(J * node.omega)));
        e * (0.5 * J * omega - L + kappa * rate * (L - omega * J))
    }

    /// Like [`Inertia::momentum_tangent`] if the scheme relates angular velocities in body axes: `J Ω̇ + Ω×JΩ` turns with the body, and
    /// changes by `e J δΩ` and by the gyroscopic part of δΩ.
    fn own_tangent(&self, node: &Node, J: &Mat3, [rate, e, kappa]: [f64; 3]) -> Mat3 {
        let (omega, momentum) = (skew(&node.omega), J * node.omega);
        let gyroscopic = omega * J - skew(&momentum);
        let moment = J * node.alpha + node.omega.cross(&momentum);
        e * (0.5 * J * omega - kappa * rate * gyroscopic) + rate * gyroscopic - skew(&moment)
    }
}

/// Sums mass and inertia on each node.
pub struct Lumped {
    sums: Vec<(f64, Mat3)>,
    /// The sums multiplied by α, if parts have separate factors.
    drags: Vec<OwnDrag>,
    /// α of the masses added next.
    alpha: f64,
}

impl Lumped {
    /// No mass at this number of nodes.
    pub fn new(nodes: usize) -> Self {
        Lumped { sums: vec![(0.0, Mat3::zeros()); nodes], drags: Vec::new(), alpha: 0.0 }
    }

    /// Sums the mass damping separately, for parts with separate factors α.
    pub fn with_drags(&mut self) {
        self.drags = vec![OwnDrag { mass: 0.0, J0: Mat3::zeros() }; self.sums.len()];
    }

    /// Sets α for all masses added from now on.
    pub fn set_alpha(&mut self, alpha: f64) {
        self.alpha = alpha;
    }

    /// Adds a mass and an inertia tensor J₀ at a node.
    pub fn add(&mut self, node: usize, mass: f64, J0: &Mat3) {
        self.sums[node].0 += mass;
        self.sums[node].1 += J0;
        if let Some(drag) = self.drags.get_mut(node) {
            drag.mass += self.alpha * mass;
            drag.J0 += self.alpha * J0;
        }
    }

    /// The nodes that have mass or inertia.
    pub fn finish(self) -> Vec<Inertia> {
        let entry = |(node, (mass, J0)): (usize, (f64, Mat3))| {
            let rotary = J0 != Mat3::zeros();
            let drag = || self.drags.get(node).cloned().map(Box::new);
            (mass > 0.0 || rotary).then(|| Inertia {
                node,
                mass,
                weighing: mass,
                J0,
                of_deck: None,
                rotary,
                turns: false,
                own: None,
                drag: drag(),
            })
        };
        self.sums.into_iter().enumerate().filter_map(entry).collect()
    }
}

/// The consistent mass matrix of an element for translations; it is the same for each direction.
#[derive(Debug, Clone)]
pub struct ConsistentMass {
    /// The nodes of the element.
    pub nodes: Vec<usize>,
    /// Entries, row-major over the nodes of the element.
    pub m: Vec<f64>,
    /// Rayleigh's factor on it, per time.
    pub alpha: f64,
}

impl ConsistentMass {
    /// Entries ∫ N_a N_b over a straight element of this mass with Lobatto nodes.
    pub fn new(nodes: &[usize], mass: f64) -> Self {
        let n = nodes.len();
        let (at, _) = quadrature::lobatto(n);
        let (points, weights) = quadrature::gauss(n);
        let shapes: Vec<Vec<f64>> = points.iter().map(|&xi| quadrature::lagrange(at, xi)).collect();
        let entry = |a: usize, b: usize| {
            shapes.iter().zip(weights).map(|(shape, w)| 0.5 * w * shape[a] * shape[b]).sum::<f64>()
        };
        let m = (0..n * n).map(|i| mass * entry(i / n, i % n)).collect();
        ConsistentMass { nodes: nodes.to_vec(), m, alpha: 0.0 }
    }

    /// Entries ∫ m N_a N_b over such an element. `masses` are the mass per length at each node times the length.
    pub fn varied(nodes: &[usize], masses: &[f64]) -> Self {
        let n = nodes.len();
        let (at, _) = quadrature::lobatto(n);
        // Exact for masses that are linear.
        let (points, weights) = quadrature::gauss(n + 1);
        let mut m = vec![0.0; n * n];
        for (&xi, w) in points.iter().zip(weights) {
            let shape = quadrature::lagrange(at, xi);
            let mass: f64 = shape.iter().zip(masses).map(|(N, mass)| N * mass).sum();
            m.iter_mut().enumerate().for_each(|(i, m)| *m += 0.5 * w * mass * shape[i / n] * shape[i % n]);
        }
        ConsistentMass { nodes: nodes.to_vec(), m, alpha: 0.0 }
    }

    /// Entries ∫ N_a N_b over a shell element of this mass per area with the corners `x`.
    pub fn of_shell(nodes: &[usize], x: &[Vec3], mass: f64) -> Self {
        let n = nodes.len();
        let products = mechanics::elements::shell::products(x);
        let m = (0..n * n).map(|i| mass * products[i / n][i % n]).collect();
        ConsistentMass { nodes: nodes.to_vec(), m, alpha: 0.0 }
    }

    /// Each entry of the matrix with its row's and its column's node.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let n = self.nodes.len();
        self.m.iter().enumerate().map(move |(i, &m)| (self.nodes[i / n], self.nodes[i % n], m))
    }

    /// Subtracts M (a − field) and Rayleigh's damping force α M v from `F`, with velocities `relative` to the moving frame if given; weight
    /// alone unless `dynamic`.
    pub fn add_forces(
        &self,
        nodes: &[Node],
        field: &Vec3,
        dynamic: bool,
        relative: Option<&dyn Fn(usize) -> Vec3>,
        F: &mut [Force],
    ) {
        for (a, b, m) in self.pairs() {
            let mut acceleration = -field;
            if dynamic {
                acceleration += nodes[b].a;
            }
            if let Some(relative) = relative {
                acceleration += self.alpha * relative(b);
            }
            mechanics::elements::subtract(&mut F[a], 0, &(m * acceleration));
        }
    }

    /// The kinetic energy ½ vᵀ M v.
    pub fn kinetic_energy(&self, nodes: &[Node]) -> f64 {
        self.pairs().map(|(a, b, m)| 0.5 * m * nodes[a].v.dot(&nodes[b].v)).sum()
    }

    /// Linear momentum, and angular momentum about the origin, global components.
    pub fn momentum(&self, nodes: &[Node]) -> (Vec3, Vec3) {
        self.pairs().fold((Vec3::zeros(), Vec3::zeros()), |(p, l), (a, b, m)| {
            (p + m * nodes[b].v, l + m * nodes[a].x.cross(&nodes[b].v))
        })
    }
}
