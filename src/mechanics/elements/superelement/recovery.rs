//! The nodes inside of a reduced part: their motion follows from that of its superelement.
//!
//! The shapes Φ give displacements and rotation vectors in the frame, (u, ψ) = Φ q. An inner node lies at x = x̄ + R (Y + u) and has the
//! rotation R exp(ψ~). Velocities and accelerations are the time derivatives of these. Forces on inner nodes act on the superelement by the
//! transpose of the map of velocities.

use super::frame::{FloatingFrame, axial, quaternion};
use super::{FloatingElement, Scratch, add_multiple, add_three, dot, set_three, three};
use crate::elements::Force;
use crate::state::Node;
use base::math::rotation::{exp, inverse_tangent, matrix, rates, vector_rates};
use base::math::{Mat3, Vec3, Vec6, angular, linear, skew, stack};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The nodes inside of a reduced part.
#[derive(Debug)]
pub struct InnerNodes {
    nodes: Vec<usize>,
    /// Their positions relative to the mean of the nodes of the interface, at t = 0.
    Y: Vec<Vec3>,
    /// Φ: for each degree of freedom of the superelement six numbers of each node; column-major.
    shapes: Arc<[f64]>,
    /// Products with Φ, or forces.
    memory: Mutex<[Vec<f64>; 3]>,
}

/// The motion of the frame, components along its axes.
pub(super) struct FrameMotion {
    /// Its angular velocity and acceleration.
    pub spin: [Vec3; 2],
    /// Velocity and acceleration of the mean of the nodes of the interface.
    pub mean: [Vec3; 2],
}

impl InnerNodes {
    /// The inner nodes of the reduced part `of`; `x` are the positions of all nodes at t = 0.
    pub fn new(of: &FloatingElement, nodes: &[usize], x: &[Vec3], shapes: Arc<[f64]>) -> InnerNodes {
        let mean = of.x[0] - of.Y[0];
        let memory = std::array::from_fn(|_| vec![0.0; 6 * nodes.len()]);
        let Y = nodes.iter().map(|&node| x[node] - mean).collect();
        InnerNodes { nodes: nodes.to_vec(), Y, shapes, memory: Mutex::new(memory) }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn memory(&self) -> MutexGuard<'_, [Vec<f64>; 3]> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes Φ times values of the superelement: displacement and rotation vector of each node.
    fn multiply<const N: usize>(&self, values: [&[f64]; N], products: &mut [Vec<f64>]) {
        products[..N].iter_mut().for_each(|product| product.fill(0.0));
        for (k, column) in self.shapes.chunks_exact((6 * self.nodes.len()).max(1)).enumerate() {
            for (product, values) in products.iter_mut().zip(values) {
                add_multiple(product, values[k], column);
            }
        }
    }

    /// Writes Φᵀ times forces and moments on the nodes.
    fn multiply_transposed(&self, forces: &[f64], products: &mut [f64]) {
        for (product, column) in products.iter_mut().zip(self.shapes.chunks_exact(forces.len().max(1))) {
            *product = dot(column, forces);
        }
    }
}

impl FrameMotion {
    /// Places the frame and writes q, and its rates and accelerations into the first two vectors.
    pub fn new(of: &FloatingElement, nodes: &[Node], scratch: &mut Scratch) -> FrameMotion {
        let Scratch { frame, q, vectors: [w, a, ..], .. } = scratch;
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        let spin = of.velocities(nodes, frame, w);
        for (i, &node) in of.data.nodes[..of.data.interface].iter().enumerate() {
            set_three(a, 6 * i, &frame.R.tr_mul(&nodes[node].a));
            set_three(a, 6 * i + 3, &frame.R.tr_mul(&nodes[node].alpha));
        }
        of.each_amplitude(|k, i| a[k] = nodes[of.data.nodes[i]].a.x);
        let count = of.data.interface as f64;
        let mean_of = |values: &[f64]| (0..of.data.interface).map(|i| three(values, 6 * i)).sum::<Vec3>() / count;
        let mean = [mean_of(w), mean_of(a)];
        // Σ ½ Y×z + λ axial(E) stays zero, and so do its derivatives: the second gives the angular acceleration.
        let mut moment = Vec3::zeros();
        for (i, Y) in of.Y.iter().enumerate() {
            let (z, omega) = (&frame.z[i], three(w, 6 * i + 3));
            let z_rate = three(w, 6 * i) - mean[0] - spin.cross(z);
            let relative = omega - spin;
            let second = three(a, 6 * i) - mean[1] - 2.0 * spin.cross(&z_rate) - spin.cross(&spin.cross(z));
            let turning = three(a, 6 * i + 3) - spin.cross(&omega);
            let S = skew(&relative);
            moment += 0.5 * Y.cross(&second) + of.turning * (frame.H[i] * turning + axial(&(S * S * frame.E[i])));
            set_three(w, 6 * i, &z_rate);
            set_three(w, 6 * i + 3, &relative);
            set_three(a, 6 * i, &second);
            set_three(a, 6 * i + 3, &turning);
        }
        let spin_rate = frame.inverse * moment;
        for i in 0..of.data.interface {
            add_three(a, 6 * i, &-spin_rate.cross(&frame.z[i]));
            let (rate, second) = vector_rates(&frame.psi[i], &three(w, 6 * i + 3), &(three(a, 6 * i + 3) - spin_rate));
            set_three(w, 6 * i + 3, &rate);
            set_three(a, 6 * i + 3, &second);
        }
        FrameMotion { spin: [spin, spin_rate], mean }
    }
}

impl FloatingElement {
    /// Writes the small motion q̇ in the frame for motions of the nodes, and returns those of their mean and of the frame, along its axes.
    pub(super) fn small_motion(
        &self,
        frame: &FloatingFrame,
        of_node: impl Fn(usize) -> [Vec3; 2],
        w: &mut [f64],
    ) -> [Vec3; 2] {
        self.local(frame, w, of_node);
        let phi = self.turn(frame, w);
        let mean = (0..self.data.interface).map(|i| three(w, 6 * i)).sum::<Vec3>() / self.data.interface as f64;
        for i in 0..self.data.interface {
            let relative = three(w, 6 * i) - mean - phi.cross(&frame.z[i]);
            let turn = inverse_tangent(&frame.psi[i], &(three(w, 6 * i + 3) - phi));
            set_three(w, 6 * i, &relative);
            set_three(w, 6 * i + 3, &turn);
        }
        [mean, phi]
    }

    /// Turns forces `g` on q into forces on the nodes, with the sum of all forces and their moment about the mean of the nodes.
    pub(super) fn to_nodes(&self, frame: &FloatingFrame, sum: Vec3, mut h: Vec3, g: &mut [f64]) {
        let at_nodes = (0..self.data.interface).map(|i| three(g, 6 * i)).sum::<Vec3>();
        let mean = (sum - at_nodes) / self.data.interface as f64;
        for i in 0..self.data.interface {
            let m = inverse_tangent(&-frame.psi[i], &three(g, 6 * i + 3));
            h -= frame.z[i].cross(&three(g, 6 * i)) + m;
            set_three(g, 6 * i + 3, &m);
            add_three(g, 6 * i, &mean);
        }
        self.add_turning(frame, &(frame.inverse * h), g);
    }
}

impl InnerNodes {
    /// Writes the motion of the inner nodes.
    pub fn recover(&self, of: &FloatingElement, nodes: &mut [Node]) {
        let scratch = &mut *of.scratch();
        let FrameMotion { spin: [spin, spin_rate], mean } = FrameMotion::new(of, nodes, scratch);
        let Scratch { frame, q, vectors: [q_rate, q_second, ..], .. } = scratch;
        let products = &mut *self.memory();
        self.multiply([q.as_slice(), q_rate.as_slice(), q_second.as_slice()], products);
        let (first, turned) = (nodes[of.data.nodes[0]], quaternion(&frame.R));
        for (k, (&node, Y)) in self.nodes.iter().zip(&self.Y).enumerate() {
            let [[u, psi], [u_rate, psi_rate], [u_second, psi_second]] =
                products.each_ref().map(|values| [three(values, 6 * k), three(values, 6 * k + 3)]);
            let z = Y + u;
            let (turn, turn_rate) = rates(&psi, &psi_rate, &psi_second);
            let v = mean[0] + spin.cross(&z) + u_rate;
            let a = mean[1] + spin_rate.cross(&z) + spin.cross(&(spin.cross(&z) + 2.0 * u_rate)) + u_second;
            let at = &mut nodes[node];
            at.place(&first.x, &first.low, &(frame.R * (z - frame.z[0])));
            at.rotation = turned * exp(&psi);
            (at.v, at.a) = (frame.R * v, frame.R * a);
            at.omega = frame.R * (spin + turn);
            at.alpha = frame.R * (spin_rate + turn_rate + spin.cross(&turn));
        }
    }

    /// Writes the small motions of the inner nodes that follow from those of the superelement.
    pub fn carry(&self, of: &FloatingElement, nodes: &[Node], motions: &mut [Vec6]) {
        let Scratch { frame, q, vectors: [w, ..], .. } = &mut *of.scratch();
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        let of_node = |i: usize| {
            let motion = &motions[of.data.nodes[i]];
            [linear(motion), angular(motion)]
        };
        let [mean, phi] = of.small_motion(frame, of_node, w);
        let products = &mut *self.memory();
        self.multiply([q.as_slice(), w.as_slice()], products);
        for (k, (&node, Y)) in self.nodes.iter().zip(&self.Y).enumerate() {
            let [[u, psi], [du, dpsi], _] =
                products.each_ref().map(|values| [three(values, 6 * k), three(values, 6 * k + 3)]);
            let turn = rates(&psi, &dpsi, &Vec3::zeros()).0;
            motions[node] = stack(&(frame.R * (mean + phi.cross(&(Y + u)) + du)), &(frame.R * (phi + turn)));
        }
    }

    /// Moves forces on inner nodes to the superelement.
    pub fn transfer(&self, of: &FloatingElement, nodes: &[Node], F: &mut [Force]) {
        if self.nodes.iter().all(|&node| F[node] == [0.0; 6]) {
            return;
        }
        let Scratch { frame, q, vectors: [g, ..], .. } = &mut *of.scratch();
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        let [moved, forces, _] = &mut *self.memory();
        self.multiply([q.as_slice()], std::slice::from_mut(moved));
        let (mut sum, mut h) = (Vec3::zeros(), Vec3::zeros());
        for (k, (&node, Y)) in self.nodes.iter().zip(&self.Y).enumerate() {
            let force = std::mem::replace(&mut F[node], [0.0; 6]);
            let (u, psi) = (three(moved, 6 * k), three(moved, 6 * k + 3));
            let [f, m] = [three(&force, 0), three(&force, 3)].map(|force| frame.R.tr_mul(&force));
            set_three(forces, 6 * k, &f);
            set_three(forces, 6 * k + 3, &rates(&-psi, &m, &Vec3::zeros()).0);
            sum += f;
            h += (Y + u).cross(&f) + m;
        }
        self.multiply_transposed(forces, g);
        of.to_nodes(frame, sum, h, g);
        g.iter_mut().for_each(|g| *g = -*g);
        of.subtract(frame, g, F);
    }

    /// The largest rotation of an inner node in the frame, in radians.
    pub fn rotation(&self, of: &FloatingElement, nodes: &[Node]) -> f64 {
        let Scratch { frame, .. } = &mut *of.scratch();
        of.place(nodes, frame);
        let turn = |&node: &usize| {
            let E: Mat3 = frame.R.tr_mul(&matrix(&nodes[node].rotation));
            base::math::rotation::log(&quaternion(&E)).norm()
        };
        self.nodes.iter().map(turn).fold(0.0, f64::max)
    }
}
