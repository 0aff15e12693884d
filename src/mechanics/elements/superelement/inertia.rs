//! Inertia of a superelement. Velocities w of the nodes along the axes of the frame give the kinetic energy ½ wᵀ M w. M is the sum of the
//! mass at its centre and of a rest that a translation does not move:
//!   T = ½ m |ẋ_c|² + ½ wᵀ M' w.
//! The centre x_c = x̄ + R ξ follows from q, so that the momentum is m ẋ_c in every motion, and a steady velocity exerts no force. The rest has
//! the momenta p = M' w, and its inertia forces are ṗ at nodes, less ω × p for rotations, and a moment Σ v × p + ω × p that turns the frame.

use super::center::Center;
use super::frame::FloatingFrame;
use super::inertia_change::InertiaChange;
use super::{FloatingElement, FloatingWeights, MassProperties, Scratch, add_three, multiply, set_three, three};
use crate::elements::block::Force;
use crate::state::Node;
use base::math::{Vec3, Vec6, angular, linear};

/// Velocity and angular velocity of a node.
type NodeVelocities<'v> = &'v dyn Fn(usize) -> [Vec3; 2];

impl FloatingElement {
    /// Adds weight and, in dynamics, inertia and Rayleigh damping by α and velocities `relative` to a moving frame.
    pub fn add_inertia(
        &self,
        nodes: &[Node],
        field: &Vec3,
        dynamic: bool,
        drag: Option<(f64, NodeVelocities)>,
        F: &mut [Force],
    ) {
        let Some(mass) = &self.mass else { return };
        let Scratch { frame, q, vectors: [w, a, p, f, product, ..], .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let center = Center::new(self, mass, frame, q);
        let mut force = -mass.total * frame.R.tr_mul(field);
        f.fill(0.0);
        if dynamic {
            let spin = self.velocities(nodes, frame, w);
            self.accelerations(nodes, frame, a);
            force += mass.total * center.motion(w, a, spin).acceleration;
            self.add_rest(mass, frame, (w, a, spin), [p, product], f);
        }
        center.add_force(&force, f);
        if let Some((alpha, relative)) = drag {
            self.local(frame, w, |i| relative(self.data.nodes[i]));
            self.momenta((mass, &center), frame, w, p);
            f.iter_mut().zip(&*p).for_each(|(f, p)| *f += alpha * p);
        }
        self.subtract(frame, f, F);
    }

    /// Writes motions of all nodes of the superelement along the axes of the frame.
    pub(super) fn local(&self, frame: &FloatingFrame, w: &mut [f64], of: impl Fn(usize) -> [Vec3; 2]) {
        for i in 0..self.data.interface {
            let [v, omega] = of(i);
            set_three(w, 6 * i, &frame.R.tr_mul(&v));
            set_three(w, 6 * i + 3, &frame.R.tr_mul(&omega));
        }
        self.each_amplitude(|k, i| w[k] = of(i)[0].x);
    }

    /// Places the frame and writes the displacements in it.
    fn settle(&self, nodes: &[Node], frame: &mut FloatingFrame, q: &mut [f64]) {
        self.place(nodes, frame);
        self.displacements(nodes, frame, q);
    }

    /// Writes accelerations along the axes of the frame.
    fn accelerations(&self, nodes: &[Node], frame: &FloatingFrame, a: &mut [f64]) {
        self.local(frame, a, |i| {
            let node = &nodes[self.data.nodes[i]];
            [node.a, node.alpha]
        });
    }

    /// Adds the inertia forces of M' for velocities `w` and accelerations `a`. Writes the momenta p, and returns the moment Σ v × p + ω × p
    /// divided by G; `rates` is memory.
    pub(super) fn add_rest(
        &self,
        mass: &MassProperties,
        frame: &FloatingFrame,
        (w, a, spin): (&[f64], &[f64], Vec3),
        [p, rates]: [&mut Vec<f64>; 2],
        f: &mut [f64],
    ) -> Vec3 {
        rates.copy_from_slice(a);
        for at in (0..self.placed()).step_by(3) {
            add_three(rates, at, &-spin.cross(&three(w, at)));
        }
        multiply(&mass.rest, rates, p);
        f.iter_mut().zip(&*p).for_each(|(f, rate)| *f += rate);
        multiply(&mass.rest, w, p);
        let mut moment = Vec3::zeros();
        for i in 0..self.data.interface {
            let [v, omega] = [0, 3].map(|at| three(w, 6 * i + at));
            let [p_x, p_t] = [0, 3].map(|at| three(p, 6 * i + at));
            moment += v.cross(&p_x) + omega.cross(&p_t);
            add_three(f, 6 * i, &spin.cross(&p_x));
            add_three(f, 6 * i + 3, &(spin.cross(&p_t) - omega.cross(&p_t)));
        }
        let turning = frame.inverse * moment;
        self.add_turning(frame, &turning, f);
        turning
    }

    /// Writes the momenta ∂T/∂w of velocities `w`, along the axes of the frame.
    pub(super) fn momenta(
        &self,
        (mass, center): (&MassProperties, &Center),
        frame: &FloatingFrame,
        w: &[f64],
        p: &mut [f64],
    ) {
        multiply(&mass.rest, w, p);
        let velocity = center.velocity(w, self.turn(frame, w));
        center.add_force(&(mass.total * velocity), p);
    }

    /// Kinetic energy, linear momentum, and angular momentum about the origin.
    pub fn motion(&self, nodes: &[Node]) -> (f64, Vec3, Vec3) {
        let Some(mass) = &self.mass else { return Default::default() };
        let Scratch { frame, q, vectors: [w, p, ..], .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let center = Center::new(self, mass, frame, q);
        self.velocities(nodes, frame, w);
        self.momenta((mass, &center), frame, w, p);
        let twice: f64 = w.iter().zip(&*p).map(|(w, p)| w * p).sum();
        let (mut linear, mut spin) = (Vec3::zeros(), Vec3::zeros());
        for i in 0..self.data.interface {
            let [p, l] = [0, 3].map(|at| frame.R * three(p, 6 * i + at));
            linear += p;
            spin += nodes[self.data.nodes[i]].x.cross(&p) + l;
        }
        (0.5 * twice, linear, spin)
    }

    /// The power of Rayleigh damping by α of velocities, and the power that it takes from velocities of a moving frame.
    pub fn drag_powers(
        &self,
        nodes: &[Node],
        alpha: f64,
        relative: NodeVelocities,
        carried: NodeVelocities,
    ) -> [f64; 2] {
        let Some(mass) = self.mass.as_ref().filter(|_| alpha > 0.0) else { return [0.0; 2] };
        let Scratch { frame, q, vectors: [w, p, v, ..], .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let center = Center::new(self, mass, frame, q);
        self.local(frame, w, |i| relative(self.data.nodes[i]));
        self.local(frame, v, |i| carried(self.data.nodes[i]));
        self.momenta((mass, &center), frame, w, p);
        let power = |of: &[f64]| alpha * of.iter().zip(&*p).map(|(v, p)| v * p).sum::<f64>();
        [power(w), -power(v)]
    }

    /// The centre of mass, global coordinates.
    pub fn center_now(&self, nodes: &[Node]) -> Vec3 {
        let Some(mass) = &self.mass else { return self.x[0] };
        let Scratch { frame, q, .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let first = &nodes[self.data.nodes[0]];
        first.x + first.low + Center::new(self, mass, frame, q).beside_first()
    }

    /// Subtracts `factor` times the product of the mass matrix and motions of all nodes from `F`.
    pub fn subtract_mass(&self, nodes: &[Node], motions: &[Vec6], factor: f64, F: &mut [Force]) {
        let Some(mass) = &self.mass else { return };
        let Scratch { frame, q, vectors: [w, p, ..], .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let center = Center::new(self, mass, frame, q);
        self.local(frame, w, |i| {
            let motion = &motions[self.data.nodes[i]];
            [linear(motion), angular(motion)]
        });
        self.momenta((mass, &center), frame, w, p);
        p.iter_mut().for_each(|p| *p *= factor);
        self.subtract(frame, p, F);
    }

    /// Writes the derivative of inertia forces and of the weight by a `field`, with the sign of a stiffness, row-major over six degrees of
    /// freedom of each node. Without gyroscopic terms inertia forces are those of the mass matrix alone.
    pub fn inertia_tangent(&self, nodes: &[Node], field: &Vec3, weights: &FloatingWeights, K: &mut [f64]) {
        let Some(mass) = &self.mass else { return K.fill(0.0) };
        let Scratch { frame, q, vectors, matrix, .. } = &mut *self.scratch();
        self.settle(nodes, frame, q);
        let center = Center::new(self, mass, frame, q);
        let [w, a, ..] = &mut *vectors;
        w.fill(0.0);
        a.fill(0.0);
        if weights.gyroscopic {
            self.velocities(nodes, frame, w);
            self.accelerations(nodes, frame, a);
        }
        let weight = mass.total * frame.R.tr_mul(field);
        let change = InertiaChange::new((self, mass), (frame, &center), weight, vectors);
        matrix.fill(0.0);
        self.each_motion(frame, |moved| {
            change.column(weights, moved, vectors);
            matrix[moved.dof * self.size()..(moved.dof + 1) * self.size()].copy_from_slice(&vectors[7]);
        });
        self.turned(&frame.R, matrix, 1.0, K);
    }
}
