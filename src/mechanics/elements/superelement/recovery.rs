//! The nodes inside of a reduced part: their motion follows from that of its superelement.
//!
//! The shapes Φ give displacements and rotation vectors in the frame, (u, ψ) = Φ q. An inner node lies at x = x̄ + R (Y + u) and has the
//! rotation R exp(ψ~). Velocities and accelerations are the time derivatives of these. Forces on inner nodes act on the superelement by the
//! transpose of the map of velocities.

use super::frame::{axial, quaternion};
use super::{FloatingElement, Scratch, add_three, set_three, three};
use crate::elements::Force;
use crate::state::Node;
use base::math::rotation::{exp, inverse_tangent, matrix, rates, vector_rates};
use base::math::{Mat3, Vec3, Vec6, angular, linear, skew, stack};
use std::sync::Arc;

/// The nodes inside of a reduced part.
#[derive(Debug, Clone)]
pub struct InnerNodes {
    nodes: Vec<usize>,
    /// Their positions relative to the mean of the nodes of the interface, at t = 0.
    Y: Vec<Vec3>,
    /// Φ: six rows for each, over the degrees of freedom of the superelement; row-major.
    shapes: Arc<[f64]>,
}

/// The motion of the frame, components along its axes.
struct FrameMotion {
    /// Its angular velocity and acceleration.
    spin: [Vec3; 2],
    /// Velocity and acceleration of the mean of the nodes of the interface.
    mean: [Vec3; 2],
}

impl InnerNodes {
    /// The inner nodes of the reduced part `of`; `x` are the positions of all nodes at t = 0.
    pub fn new(of: &FloatingElement, nodes: &[usize], x: &[Vec3], shapes: Arc<[f64]>) -> InnerNodes {
        let mean = of.x[0] - of.Y[0];
        InnerNodes { nodes: nodes.to_vec(), Y: nodes.iter().map(|&node| x[node] - mean).collect(), shapes }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// The displacement and the rotation vector of an inner node for the values `q` of the superelement.
    fn motion(&self, inner: usize, q: &[f64]) -> [Vec3; 2] {
        let row = |k: usize| {
            let start = (6 * inner + k) * q.len();
            self.shapes[start..start + q.len()].iter().zip(q).map(|(shape, q)| shape * q).sum::<f64>()
        };
        [0, 3].map(|at| Vec3::new(row(at), row(at + 1), row(at + 2)))
    }

    /// Adds the values of the superelement that a force and a moment on an inner node work on.
    fn add_work(&self, inner: usize, [f, m]: [&Vec3; 2], g: &mut [f64]) {
        for (k, force) in f.iter().chain(m.iter()).enumerate().filter(|(_, force)| **force != 0.0) {
            let start = (6 * inner + k) * g.len();
            let row = &self.shapes[start..start + g.len()];
            g.iter_mut().zip(row).for_each(|(g, shape)| *g += shape * force);
        }
    }
}

impl FloatingElement {
    /// Places the frame and writes q, and its rates and accelerations into the first two vectors.
    fn frame_motion(&self, nodes: &[Node], scratch: &mut Scratch) -> FrameMotion {
        let Scratch { frame, q, vectors: [w, a, ..], .. } = scratch;
        self.place(nodes, frame);
        self.displacements(nodes, frame, q);
        let spin = self.velocities(nodes, frame, w);
        for (i, &node) in self.data.nodes[..self.data.interface].iter().enumerate() {
            set_three(a, 6 * i, &frame.R.tr_mul(&nodes[node].a));
            set_three(a, 6 * i + 3, &frame.R.tr_mul(&nodes[node].alpha));
        }
        self.each_amplitude(|k, i| a[k] = nodes[self.data.nodes[i]].a.x);
        let count = self.data.interface as f64;
        let mean_of = |of: &[f64]| (0..self.data.interface).map(|i| three(of, 6 * i)).sum::<Vec3>() / count;
        let mean = [mean_of(w), mean_of(a)];
        // Σ ½ Y×z + λ axial(E) stays zero, and so do its derivatives: the second gives the angular acceleration.
        let mut moment = Vec3::zeros();
        for (i, Y) in self.Y.iter().enumerate() {
            let (z, omega) = (&frame.z[i], three(w, 6 * i + 3));
            let z_rate = three(w, 6 * i) - mean[0] - spin.cross(z);
            let relative = omega - spin;
            let second = three(a, 6 * i) - mean[1] - 2.0 * spin.cross(&z_rate) - spin.cross(&spin.cross(z));
            let turning = three(a, 6 * i + 3) - spin.cross(&omega);
            let S = skew(&relative);
            moment += 0.5 * Y.cross(&second) + self.turning * (frame.H[i] * turning + axial(&(S * S * frame.E[i])));
            set_three(w, 6 * i, &z_rate);
            set_three(w, 6 * i + 3, &relative);
            set_three(a, 6 * i, &second);
            set_three(a, 6 * i + 3, &turning);
        }
        let spin_rate = frame.inverse * moment;
        for i in 0..self.data.interface {
            add_three(a, 6 * i, &-spin_rate.cross(&frame.z[i]));
            let (rate, second) = vector_rates(&frame.psi[i], &three(w, 6 * i + 3), &(three(a, 6 * i + 3) - spin_rate));
            set_three(w, 6 * i + 3, &rate);
            set_three(a, 6 * i + 3, &second);
        }
        FrameMotion { spin: [spin, spin_rate], mean }
    }

    /// Writes the motion of the inner nodes.
    pub fn recover(&self, inner: &InnerNodes, nodes: &mut [Node]) {
        let scratch = &mut *self.scratch();
        let FrameMotion { spin: [spin, spin_rate], mean } = self.frame_motion(nodes, scratch);
        let Scratch { frame, q, vectors: [q_rate, q_second, ..], .. } = scratch;
        let (first, turned) = (nodes[self.data.nodes[0]], quaternion(&frame.R));
        for (k, (&node, Y)) in inner.nodes.iter().zip(&inner.Y).enumerate() {
            let [[u, psi], [u_rate, psi_rate], [u_second, psi_second]] =
                [&*q, &*q_rate, &*q_second].map(|of| inner.motion(k, of));
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
    pub fn carry(&self, inner: &InnerNodes, nodes: &[Node], motions: &mut [Vec6]) {
        let Scratch { frame, q, vectors: [w, ..], .. } = &mut *self.scratch();
        self.place(nodes, frame);
        self.displacements(nodes, frame, q);
        for (i, &node) in self.data.nodes[..self.data.interface].iter().enumerate() {
            set_three(w, 6 * i, &frame.R.tr_mul(&linear(&motions[node])));
            set_three(w, 6 * i + 3, &frame.R.tr_mul(&angular(&motions[node])));
        }
        self.each_amplitude(|k, i| w[k] = motions[self.data.nodes[i]][0]);
        let phi = self.turn(frame, w);
        let mean = (0..self.data.interface).map(|i| three(w, 6 * i)).sum::<Vec3>() / self.data.interface as f64;
        for i in 0..self.data.interface {
            let relative = three(w, 6 * i) - mean - phi.cross(&frame.z[i]);
            let turn = inverse_tangent(&frame.psi[i], &(three(w, 6 * i + 3) - phi));
            set_three(w, 6 * i, &relative);
            set_three(w, 6 * i + 3, &turn);
        }
        for (k, (&node, Y)) in inner.nodes.iter().zip(&inner.Y).enumerate() {
            let ([u, psi], [du, dpsi]) = (inner.motion(k, q), inner.motion(k, w));
            let turn = rates(&psi, &dpsi, &Vec3::zeros()).0;
            motions[node] = stack(&(frame.R * (mean + phi.cross(&(Y + u)) + du)), &(frame.R * (phi + turn)));
        }
    }

    /// Moves forces on inner nodes to the superelement.
    pub fn transfer(&self, inner: &InnerNodes, nodes: &[Node], F: &mut [Force]) {
        if inner.nodes.iter().all(|&node| F[node] == [0.0; 6]) {
            return;
        }
        let Scratch { frame, q, vectors: [g, ..], .. } = &mut *self.scratch();
        self.place(nodes, frame);
        self.displacements(nodes, frame, q);
        g.fill(0.0);
        let (mut sum, mut h) = (Vec3::zeros(), Vec3::zeros());
        for (k, (&node, Y)) in inner.nodes.iter().zip(&inner.Y).enumerate() {
            let force = std::mem::replace(&mut F[node], [0.0; 6]);
            if force == [0.0; 6] {
                continue;
            }
            let [u, psi] = inner.motion(k, q);
            let [f, m] = [three(&force, 0), three(&force, 3)].map(|force| frame.R.tr_mul(&force));
            inner.add_work(k, [&f, &rates(&-psi, &m, &Vec3::zeros()).0], g);
            sum += f;
            h += (Y + u).cross(&f) + m;
        }
        let at_nodes = (0..self.data.interface).map(|i| three(g, 6 * i)).sum::<Vec3>();
        let mean = (sum - at_nodes) / self.data.interface as f64;
        for i in 0..self.data.interface {
            let m = inverse_tangent(&-frame.psi[i], &three(g, 6 * i + 3));
            h -= frame.z[i].cross(&three(g, 6 * i)) + m;
            set_three(g, 6 * i + 3, &m);
            add_three(g, 6 * i, &mean);
        }
        self.add_turning(frame, &(frame.inverse * h), g);
        g.iter_mut().for_each(|g| *g = -*g);
        self.subtract(frame, g, F);
    }

    /// The largest rotation of an inner node in the frame, in radians.
    pub fn inner_rotation(&self, inner: &InnerNodes, nodes: &[Node]) -> f64 {
        let Scratch { frame, .. } = &mut *self.scratch();
        self.place(nodes, frame);
        let turn = |&node: &usize| {
            let E: Mat3 = frame.R.tr_mul(&matrix(&nodes[node].rotation));
            base::math::rotation::log(&quaternion(&E)).norm()
        };
        inner.nodes.iter().map(turn).fold(0.0, f64::max)
    }
}
