//! The inertia of a reduced part by integrals over its mass, which are computed once.
//!
//! A node of the part lies at z = Y + u in the frame and has the rotation ψ there, with (u, ψ) = Φ q. V is the velocity of the mean of the
//! interface, and Ω the angular velocity of the frame, both along its axes. The kinetic energy is
//!   T = ½ m V² + V·(Ω × s + S q̇) + ½ Ω·J Ω + Ω·(N q̇ + Σ q_k B_kl q̇_l) + ½ q̇ᵀ M q̇.
//! Here s = s₀ + S q and J = J₀ + Σ J_k q_k + Σ J_kl q_k q_l (A. A. Shabana, Dynamics of Multibody Systems, 2013, chapter 5). The masses of
//! translations enter exactly. Rotary inertia has the terms of second order in ψ but ½ Ω·(ψ × Jψ̇ + ψ̇ × Jψ). This term is zero where the inertia
//! is the same about all axes. Forces follow from Lagrange's equations:
//!   F = ṗ + Ω × p,  h = L̇ + Ω × L + V × p,  g = d/dt ∂T/∂q̇ − ∂T/∂q.

use super::frame::axial;
use super::recovery::FrameMotion;
use super::{FloatingElement, Scratch, dot, multiply};
use crate::elements::Force;
use crate::state::Node;
use base::math::{Mat3, Vec3, Vec6, angular, linear, skew};
use nalgebra::DMatrix;
use std::array::from_fn;

/// The number of loads by rigid accelerations.
pub const RIGID_LOADS: usize = 12;

/// Velocity and angular velocity of a node.
type NodeVelocities<'v> = &'v dyn Fn(usize) -> [Vec3; 2];

/// The six components of a symmetric tensor: row, column, and how often it stands in a product of two.
const COMPONENTS: [(usize, usize, f64); 6] =
    [(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0), (0, 1, 2.0), (0, 2, 2.0), (1, 2, 2.0)];

/// Inertia of a node: its place among the rows of the shapes, and the tensor about it along the axes of the frame at t = 0.
#[derive(Debug, Clone)]
pub struct NodalMass {
    /// The node.
    pub node: usize,
    /// The tensor.
    pub J0: Mat3,
}

/// The masses of a part: its nodes by their place among the rows of the shapes.
#[derive(Debug, Clone, Default)]
pub struct ModalMass {
    /// Positions relative to the mean of the nodes of the interface, at t = 0.
    pub Y: Vec<Vec3>,
    /// Rotary inertia.
    pub rotary: Vec<NodalMass>,
    /// Masses between two nodes, or of one.
    pub masses: Vec<(usize, usize, f64)>,
}

/// Integrals over the mass of a reduced part.
#[derive(Debug)]
pub struct InertiaIntegrals {
    mass: f64,
    /// Σ m Y.
    s0: Vec3,
    /// S, by rows.
    S: [Vec<f64>; 3],
    J0: Mat3,
    /// The components of J_k.
    J1: [Vec<f64>; 6],
    /// The components of J_kl, each a square matrix.
    J2: [Vec<f64>; 6],
    /// N, by rows.
    N: [Vec<f64>; 3],
    /// The components of B, each an antisymmetric matrix.
    B: [Vec<f64>; 3],
}

/// A linear motion of the part: of the mean of the interface, of the frame, and q̇.
pub(super) struct PartMotion<'m> {
    pub V: Vec3,
    pub spin: Vec3,
    pub q_rate: &'m [f64],
}

impl InertiaIntegrals {
    /// The integrals over masses with the shapes Φ, which have six rows for each node.
    pub fn new(of: &ModalMass, shapes: &DMatrix<f64>) -> InertiaIntegrals {
        let size = shapes.ncols();
        let shape = |node: usize, k: usize, at: usize| {
            Vec3::new(shapes[(6 * node + at, k)], shapes[(6 * node + at + 1, k)], shapes[(6 * node + at + 2, k)])
        };
        let Y = &of.Y;
        let (mut mass, mut s0, mut J0) = (0.0, Vec3::zeros(), Mat3::zeros());
        let (mut S, mut N) = (vec![Vec3::zeros(); size], vec![Vec3::zeros(); size]);
        let mut J1 = vec![Mat3::zeros(); size];
        for &(a, b, m) in &of.masses {
            mass += m;
            s0 += m * Y[b];
            J0 -= m * skew(&Y[a]) * skew(&Y[b]);
            for k in 0..size {
                let u = shape(b, k, 0);
                S[k] += m * u;
                N[k] += m * Y[a].cross(&u);
                J1[k] -= m * (skew(&Y[a]) * skew(&u) + skew(&u) * skew(&Y[a]));
            }
        }
        for NodalMass { node, J0: J } in &of.rotary {
            J0 += J;
            for k in 0..size {
                let psi = shape(*node, k, 3);
                N[k] += J * psi;
                J1[k] += skew(&psi) * J - J * skew(&psi);
            }
        }
        let J2 = COMPONENTS.map(|(i, j, _)| {
            let of_masses = Mat3::from_fn(|a, b| {
                let is = |x: usize, y: usize| if x == y { 1.0 } else { 0.0 };
                is(i, j) * is(a, b) - 0.5 * (is(a, i) * is(b, j) + is(a, j) * is(b, i))
            });
            of.form(shapes, &of_masses, |J, psi, other| turned_inertia(J, psi, other)[(i, j)])
        });
        let B = from_fn(|i| {
            // u·A u̇ with A = e~ᵀ is e·(u × u̇).
            let across = skew(&Vec3::ith(i, 1.0)).transpose();
            of.form(shapes, &across, |J, psi, other| (euler(J) * psi.cross(other))[i])
        });
        InertiaIntegrals {
            mass,
            s0,
            S: from_fn(|axis| S.iter().map(|S| S[axis]).collect()),
            J0,
            J1: COMPONENTS.map(|(i, j, _)| J1.iter().map(|J| 0.5 * (J[(i, j)] + J[(j, i)])).collect()),
            J2,
            N: from_fn(|axis| N.iter().map(|N| N[axis]).collect()),
            B,
        }
    }
}

impl ModalMass {
    /// The inertia forces of rigid accelerations a + A Y about the mean of the interface. Three have a of size 1. A has the size 1 over the extent: three
    /// antisymmetric ones turn the part, and six symmetric ones belong to spins. Six rows for each node.
    pub fn rigid_loads(&self) -> DMatrix<f64> {
        let extent = self.Y.iter().map(|Y| Y.norm()).fold(f64::MIN_POSITIVE, f64::max);
        let mut loads = DMatrix::zeros(6 * self.Y.len(), RIGID_LOADS);
        for (k, mut load) in loads.column_iter_mut().enumerate() {
            let (a, A) = match k {
                0..3 => (Vec3::ith(k, 1.0), Mat3::zeros()),
                3..6 => (Vec3::zeros(), skew(&Vec3::ith(k - 3, 1.0 / extent))),
                _ => {
                    let (i, j, _) = COMPONENTS[k - 6];
                    let of_pair = Mat3::from_fn(|a, b| if (a, b) == (i, j) || (a, b) == (j, i) { 1.0 } else { 0.0 });
                    (Vec3::zeros(), of_pair / extent)
                }
            };
            let load = load.as_mut_slice();
            self.masses.iter().for_each(|&(to, from, m)| super::add_three(load, 6 * to, &(m * (a + A * self.Y[from]))));
            for NodalMass { node, J0 } in &self.rotary {
                // Σ m r × A r.
                super::add_three(load, 6 * node + 3, &(2.0 * axial(&(A * euler(J0)))));
            }
        }
        loads
    }

    /// Φᵀ M Φ.
    pub fn matrix(&self, shapes: &DMatrix<f64>) -> DMatrix<f64> {
        let size = shapes.ncols();
        DMatrix::from_vec(size, size, self.form(shapes, &Mat3::identity(), |J, psi, other| psi.dot(&(J * other))))
    }

    /// The matrix of a bilinear form of two shapes: of their displacements at masses, and of their rotations at rotary inertia. Row-major.
    fn form(&self, shapes: &DMatrix<f64>, A: &Mat3, rotary: impl Fn(&Mat3, &Vec3, &Vec3) -> f64) -> Vec<f64> {
        let (rows, size) = shapes.shape();
        let of_rotary: Vec<(usize, Mat3)> = self
            .rotary
            .iter()
            .map(|NodalMass { node, J0 }| {
                (6 * node + 3, Mat3::from_fn(|a, b| rotary(J0, &Vec3::ith(a, 1.0), &Vec3::ith(b, 1.0))))
            })
            .collect();
        let mut product = DMatrix::zeros(rows, size);
        for (shape, mut product) in shapes.column_iter().zip(product.column_iter_mut()) {
            let (shape, product) = (shape.as_slice(), product.as_mut_slice());
            let mut add = |row: usize, from: usize, A: &Mat3, factor: f64| {
                let f = factor * (A * Vec3::new(shape[from], shape[from + 1], shape[from + 2]));
                super::add_three(product, row, &f);
            };
            self.masses.iter().for_each(|&(a, b, m)| add(6 * a, 6 * b, A, m));
            of_rotary.iter().for_each(|(row, A)| add(*row, *row, A, 1.0));
        }
        // Columns are the rows of the form.
        products(&product, shapes).as_slice().to_vec()
    }
}

/// ½ tr J − J: the integral of r rᵀ over the mass.
fn euler(J: &Mat3) -> Mat3 {
    0.5 * Mat3::from_diagonal_element(J.trace()) - J
}

/// Aᵀ B.
pub fn products(A: &DMatrix<f64>, B: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = A.nrows().max(1);
    let entries = B.as_slice().chunks_exact(rows).flat_map(|b| A.as_slice().chunks_exact(rows).map(|a| dot(a, b)));
    DMatrix::from_iterator(A.ncols(), B.ncols(), entries)
}

/// The term of E J Eᵀ with E = exp(ψ~) that is bilinear in two rotation vectors.
fn turned_inertia(J: &Mat3, psi: &Vec3, other: &Vec3) -> Mat3 {
    let (a, b) = (skew(psi), skew(other));
    let square = 0.25 * (a * b + b * a);
    square * J + J * square - 0.5 * (a * J * b + b * J * a)
}

/// A symmetric tensor by its components.
fn tensor(components: &[f64; 6]) -> Mat3 {
    let [xx, yy, zz, xy, xz, yz] = *components;
    Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Three products with a vector.
fn product(rows: &[Vec<f64>; 3], x: &[f64]) -> Vec3 {
    Vec3::new(dot(&rows[0], x), dot(&rows[1], x), dot(&rows[2], x))
}

/// A row of a square matrix.
fn row(of: &[f64], k: usize, size: usize) -> &[f64] {
    &of[k * size..(k + 1) * size]
}

impl InertiaIntegrals {
    /// The mass of the whole.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// s.
    fn first_moment(&self, q: &[f64]) -> Vec3 {
        self.s0 + product(&self.S, q)
    }

    /// J and, for q̇, its rate. Calls `visit` with each k and the derivative of the components of J by q_k.
    fn inertia(&self, q: &[f64], rates: Option<&[f64]>, mut visit: impl FnMut(usize, [f64; 6])) -> [Mat3; 2] {
        let (mut J, mut rate) = ([0.0; 6], [0.0; 6]);
        for k in 0..q.len() {
            let bent: [f64; 6] = from_fn(|c| dot(row(&self.J2[c], k, q.len()), q));
            let change: [f64; 6] = from_fn(|c| self.J1[c][k] + 2.0 * bent[c]);
            (0..6).for_each(|c| J[c] += q[k] * (self.J1[c][k] + bent[c]));
            if let Some(rates) = rates {
                (0..6).for_each(|c| rate[c] += rates[k] * change[c]);
            }
            visit(k, change);
        }
        [self.J0 + tensor(&J), tensor(&rate)]
    }

    /// B x, for one k.
    fn turning(&self, k: usize, x: &[f64]) -> Vec3 {
        from_fn::<f64, 3, _>(|i| dot(row(&self.B[i], k, x.len()), x)).into()
    }

    fn column(&self, of: &[Vec<f64>; 3], k: usize) -> Vec3 {
        Vec3::new(of[0][k], of[1][k], of[2][k])
    }

    /// Adds weight and, in dynamics, inertia forces and Rayleigh damping by α and velocities `relative` to a moving frame.
    pub fn add_forces(
        &self,
        of: &FloatingElement,
        nodes: &[Node],
        field: &Vec3,
        dynamic: bool,
        drag: Option<(f64, NodeVelocities)>,
        F: &mut [Force],
    ) {
        let scratch = &mut *of.scratch();
        let at = FrameMotion::new(of, nodes, scratch);
        let Scratch { frame, q, vectors: [rates, seconds, g, w, p, ..], .. } = scratch;
        let (mut sum, mut h) = self.forces(of, &at, (q, rates, seconds), frame.R.tr_mul(field), dynamic, g);
        if let Some((alpha, relative)) = drag {
            let [V, spin] = of.small_motion(frame, |i| relative(of.data.nodes[i]), w);
            let [linear, angular] = self.momenta(of, q, &PartMotion { V, spin, q_rate: w }, p);
            (sum, h) = (sum + alpha * linear, h + alpha * angular);
            super::add_multiple(g, alpha, p);
        }
        of.to_nodes(frame, sum, h, g);
        of.subtract(frame, g, F);
    }

    /// F and h, with the weight of a `field` taken off; writes g. Weight alone unless `dynamic`.
    fn forces(
        &self,
        of: &FloatingElement,
        at: &FrameMotion,
        (q, rates, seconds): (&[f64], &[f64], &[f64]),
        field: Vec3,
        dynamic: bool,
        g: &mut [f64],
    ) -> (Vec3, Vec3) {
        let ([spin, spin_rate], s) = (at.spin, self.first_moment(q));
        let a = if dynamic { at.mean[1] - field } else { -field };
        let (mut sum, mut h) = (self.mass * a, s.cross(&a));
        for (k, g) in g.iter_mut().enumerate() {
            *g = self.column(&self.S, k).dot(&a);
        }
        if !dynamic {
            return (sum, h);
        }
        sum += spin_rate.cross(&s) + spin.cross(&(spin.cross(&s) + 2.0 * product(&self.S, rates)));
        sum += product(&self.S, seconds);
        let squares = COMPONENTS.map(|(i, j, times)| 0.5 * times * spin[i] * spin[j]);
        let [J, J_rate] = self.inertia(q, Some(rates), |k, change| g[k] -= dot(&squares, &change));
        let mut momentum = J * spin + product(&self.N, rates);
        let mut momentum_rate = J * spin_rate + J_rate * spin + product(&self.N, seconds);
        for k in 0..q.len() {
            let (by_place, by_rate) = (self.turning(k, q), self.turning(k, rates));
            momentum += q[k] * by_rate;
            momentum_rate -= seconds[k] * by_place;
            g[k] += spin_rate.dot(&(self.column(&self.N, k) - by_place)) - 2.0 * spin.dot(&by_rate);
            g[k] += dot(row(&of.data.mass, k, q.len()), seconds);
        }
        h += momentum_rate + spin.cross(&momentum);
        (sum, h)
    }

    /// The momenta of a motion: p and L about the mean of the interface; writes ∂T/∂q̇.
    pub(super) fn momenta(&self, of: &FloatingElement, q: &[f64], motion: &PartMotion, p: &mut [f64]) -> [Vec3; 2] {
        let PartMotion { V, spin, q_rate } = motion;
        let s = self.first_moment(q);
        multiply(&of.data.mass, q_rate, p);
        let [J, _] = self.inertia(q, None, |_, _| ());
        let mut angular = s.cross(V) + J * spin + product(&self.N, q_rate);
        for (k, p) in p.iter_mut().enumerate() {
            let by_place = self.turning(k, q);
            angular -= q_rate[k] * by_place;
            *p += self.column(&self.S, k).dot(V) + spin.dot(&(self.column(&self.N, k) - by_place));
        }
        [self.mass * V + spin.cross(&s) + product(&self.S, q_rate), angular]
    }

    /// The momenta p and L of a unit of one rate.
    pub(super) fn momenta_of(&self, q: &[f64], k: usize) -> [Vec3; 2] {
        [self.column(&self.S, k), self.column(&self.N, k) - self.turning(k, q)]
    }

    /// Places the frame, and gives the momenta of small motions of the nodes; writes q̇ and ∂T/∂q̇.
    fn settle(&self, of: &FloatingElement, nodes: &[Node], motion: NodeVelocities, scratch: &mut Scratch) -> [Vec3; 4] {
        let Scratch { frame, q, vectors: [rates, p, ..], .. } = scratch;
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        let [V, spin] = of.small_motion(frame, |i| motion(of.data.nodes[i]), rates);
        let [linear, angular] = self.momenta(of, q, &PartMotion { V, spin, q_rate: rates }, p);
        [linear, angular, V, spin]
    }

    /// Subtracts `factor` times the product of the mass matrix and small motions of all nodes from `F`.
    pub fn subtract_product(
        &self,
        of: &FloatingElement,
        nodes: &[Node],
        motions: &[Vec6],
        factor: f64,
        F: &mut [Force],
    ) {
        let scratch = &mut *of.scratch();
        let motion = |node: usize| [linear(&motions[node]), angular(&motions[node])];
        let [sum, h, ..] = self.settle(of, nodes, &motion, scratch);
        let Scratch { frame, vectors: [_, p, ..], .. } = scratch;
        p.iter_mut().for_each(|p| *p *= factor);
        of.to_nodes(frame, factor * sum, factor * h, p);
        of.subtract(frame, p, F);
    }

    /// Kinetic energy, linear momentum, and angular momentum about the origin.
    pub fn motion(&self, of: &FloatingElement, nodes: &[Node]) -> (f64, Vec3, Vec3) {
        let scratch = &mut *of.scratch();
        let motion = |node: usize| [nodes[node].v, nodes[node].omega];
        let [p, L, V, spin] = self.settle(of, nodes, &motion, scratch);
        let Scratch { frame, vectors: [rates, modal, ..], .. } = scratch;
        let kinetic = 0.5 * (p.dot(&V) + L.dot(&spin) + dot(rates, modal));
        let first = &nodes[of.data.nodes[0]];
        let (p, mean) = (frame.R * p, first.x + first.low - frame.R * frame.z[0]);
        (kinetic, p, mean.cross(&p) + frame.R * L)
    }

    /// The power of Rayleigh damping by α of velocities, and the power that it takes from velocities of a moving frame.
    pub fn drag_powers(
        &self,
        of: &FloatingElement,
        nodes: &[Node],
        alpha: f64,
        [relative, carried]: [NodeVelocities; 2],
    ) -> [f64; 2] {
        if alpha == 0.0 {
            return [0.0; 2];
        }
        let scratch = &mut *of.scratch();
        let [p, L, V, spin] = self.settle(of, nodes, relative, scratch);
        let Scratch { frame, vectors: [rates, modal, w, ..], .. } = scratch;
        let own = p.dot(&V) + L.dot(&spin) + dot(rates, modal);
        let [V, spin] = of.small_motion(frame, |i| carried(of.data.nodes[i]), w);
        [alpha * own, -alpha * (p.dot(&V) + L.dot(&spin) + dot(w, modal))]
    }

    /// The centre of mass relative to the first node of the interface, global components.
    pub fn center(&self, of: &FloatingElement, nodes: &[Node]) -> Vec3 {
        let Scratch { frame, q, .. } = &mut *of.scratch();
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        frame.R * (self.first_moment(q) / self.mass - frame.z[0])
    }
}
