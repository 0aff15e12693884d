//! The mass matrix of a reduced part in its bent state. Mass beside the axis has inertia about it, beside the small one of sections.

use super::integrals::{InertiaIntegrals, PartMotion};
use super::{FloatingElement, Scratch, add_multiple, set_three};
use crate::state::Node;
use base::math::Vec3;
use base::math::rotation::inverse_tangent_matrix;

impl InertiaIntegrals {
    /// Writes the mass matrix times `weight`, row-major over six degrees of freedom of each node.
    pub fn mass_tangent(&self, of: &FloatingElement, nodes: &[Node], weight: f64, K: &mut [f64]) {
        let Scratch { frame, q, vectors: [rates, _, fixed @ ..], matrix, inverses, .. } = &mut *of.scratch();
        of.place(nodes, frame);
        of.displacements(nodes, frame, q);
        inverses.iter_mut().zip(&frame.psi).for_each(|(inverse, psi)| *inverse = inverse_tangent_matrix(psi));
        // Momenta where the frame moves along or about each axis, and the nodes stay.
        let mut sums = [[Vec3::zeros(); 2]; 6];
        for (k, (p, sums)) in fixed.iter_mut().zip(&mut sums).enumerate() {
            let mut motion = [Vec3::zeros(); 2];
            motion[k / 3][k % 3] = 1.0;
            let [V, spin] = motion;
            for (i, z) in frame.z.iter().enumerate() {
                set_three(rates, 6 * i, &-(V + spin.cross(z)));
                set_three(rates, 6 * i + 3, &-(inverses[i] * spin));
            }
            rates[of.placed()..].fill(0.0);
            *sums = self.momenta(of, q, &PartMotion { V, spin, q_rate: rates }, p);
        }
        let (size, interface) = (of.size(), of.data.interface);
        matrix.fill(0.0);
        of.each_motion(frame, |moved| {
            let p = &mut matrix[moved.dof * size..(moved.dof + 1) * size];
            let [mut sum, mut h] = [Vec3::zeros(); 2];
            let mut add = |k: usize, rate: f64| {
                let [linear, angular] = self.momenta_of(q, k);
                add_multiple(p, rate, &of.data.mass[k * size..(k + 1) * size]);
                (sum, h) = (sum + rate * linear, h + rate * angular);
            };
            match moved.node < interface && moved.direction > 2 {
                true => (0..3)
                    .for_each(|axis| add(6 * moved.node + 3 + axis, inverses[moved.node][(axis, moved.direction - 3)])),
                false => add(moved.dof, 1.0),
            }
            let mean = moved.mean(interface);
            let by = [mean.x, mean.y, mean.z, moved.phi.x, moved.phi.y, moved.phi.z];
            for (by, (fixed, [linear, angular])) in by.iter().zip(fixed.iter().zip(&sums)) {
                add_multiple(p, *by, fixed);
                (sum, h) = (sum + *by * linear, h + *by * angular);
            }
            of.to_nodes(frame, sum, h, p);
        });
        of.turned(&frame.R, matrix, weight, K);
    }
}
