//! Centrifugal forces of masses that turn steadily about an axis, in statics and modes.
//!
//! A mass m at the vector r from the axis feels m Ω² r, and a body with the inertia tensor J about its node the moment −Ω² n × J n. Both are the
//! gradient of Ω² T, where T is the kinetic energy at the angular velocity 1, so that work and load stiffness follow from T.

use super::inertia::{ConsistentMass, Inertia};
use super::mass_sources;
use base::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, skew};
use mechanics::elements::{Force, subtract};
use mechanics::state::Node;
use model::{self, Model, RotationAxis};

/// The masses of a centrifugal load, and its axis.
pub struct CentrifugalLoad {
    axis: RotationAxis,
    /// Lumped masses, in ascending order of nodes.
    pub inertias: Vec<Inertia>,
    /// Consistent mass matrices, element by element.
    pub consistent: Vec<ConsistentMass>,
}

impl CentrifugalLoad {
    /// The load with the masses of the model at its initial positions `x`.
    pub fn new(model: &Model, x: &[Vec3], load: &model::Centrifugal) -> CentrifugalLoad {
        let of = &load.of;
        let (inertias, consistent) = mass_sources::masses_of(
            model,
            x,
            of.bodies.iter().map(|&body| &model.bodies[body]),
            of.masses.iter().map(|&mass| &model.masses[mass]),
            of.parts.iter().map(|&part| &model.parts[part]),
        );
        CentrifugalLoad { axis: load.axis, inertias, consistent }
    }

    /// Adds the forces at this square of the angular velocity, and returns the largest of them.
    pub fn add_forces(&self, square: f64, nodes: &[Node], F: &mut [Force]) -> f64 {
        let mut largest: f64 = 0.0;
        self.forces(square, nodes, &mut |node, force| {
            largest = largest.max(force.amax());
            subtract(&mut F[node], 0, &-force);
        });
        for inertia in self.inertias.iter().filter(|inertia| inertia.rotary) {
            let moment = square * self.axis.moment(&inertia.J(&nodes[inertia.node]));
            subtract(&mut F[inertia.node], 3, &-moment);
        }
        largest
    }

    /// Hands the force of each mass to `visit`, with its node.
    fn forces(&self, square: f64, nodes: &[Node], visit: &mut dyn FnMut(usize, Vec3)) {
        for (node, at, mass) in self.pairs() {
            visit(node, square * mass * self.axis.away(&nodes[at].x));
        }
    }

    /// Each mass with the node that it acts on and the node whose place counts.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let lumped = self.inertias.iter().map(|inertia| (inertia.node, inertia.node, inertia.mass));
        lumped.chain(self.consistent.iter().flat_map(ConsistentMass::pairs))
    }

    /// The sum of the masses.
    pub fn mass(&self) -> f64 {
        self.pairs().map(|(.., mass)| mass).sum()
    }

    /// The sum of the forces at this square of the angular velocity.
    pub fn total(&self, square: f64, nodes: &[Node]) -> Vec3 {
        let mut sum = Vec3::zeros();
        self.forces(square, nodes, &mut |_, force| sum += force);
        sum
    }

    /// Hands the forces at two configurations and the way between them to `visit`, mass by mass.
    pub fn along(&self, from: (&[Node], f64), to: (&[Node], f64), visit: &mut dyn FnMut([Vec3; 2], Vec3)) {
        for (node, at, mass) in self.pairs() {
            let force = |(nodes, square): (&[Node], f64)| square * mass * self.axis.away(&nodes[at].x);
            visit([force(from), force(to)], to.0[node].relative_position(&from.0[node]));
        }
    }

    /// The work between two configurations, each with its square of the angular velocity: exact at constant speed.
    pub fn work(&self, from: (&[Node], f64), to: (&[Node], f64)) -> f64 {
        let mut work = 0.0;
        self.along(from, to, &mut |[old, new], way| work += 0.5 * (old + new).dot(&way));
        let n = &self.axis.direction;
        let turning = |nodes: &[Node]| -> f64 {
            let rotary = self.inertias.iter().filter(|inertia| inertia.rotary);
            rotary.map(|inertia| n.dot(&(inertia.J(&nodes[inertia.node]) * n))).sum()
        };
        work + 0.25 * (from.1 + to.1) * (turning(to.0) - turning(from.0))
    }

    /// Adds the load stiffness of lumped masses to the matrices of their nodes.
    pub fn add_nodal_stiffness(&self, square: f64, nodes: &[Node], own: &mut [Mat6]) {
        let across = -square * self.across();
        let n = skew(&self.axis.direction);
        for inertia in &self.inertias {
            let own = &mut own[inertia.node];
            let mut translations = own.fixed_view_mut::<3, 3>(0, 0);
            translations += inertia.mass * across;
            if inertia.rotary {
                let J = inertia.J(&nodes[inertia.node]);
                let mut rotations = own.fixed_view_mut::<3, 3>(3, 3);
                rotations += square * n * (J * n - skew(&(J * self.axis.direction)));
            }
        }
    }

    /// Writes the load stiffness of a consistent mass matrix, row-major.
    pub fn stiffness(&self, square: f64, mass: &ConsistentMass, K: &mut [f64]) {
        let across = -square * self.across();
        let n = mass.nodes.len();
        for (k, m) in mass.m.iter().enumerate() {
            for i in 0..3 {
                for j in 0..3 {
                    K[(3 * (k / n) + i) * 3 * n + 3 * (k % n) + j] = m * across[(i, j)];
                }
            }
        }
    }

    /// Hands the matrices of the Coriolis forces at an angular velocity to `visit`, with the nodes of their rows and columns. They stand on the
    /// side of the inertia forces. A mass has 2 m Ω n × u̇, and an inertia tensor (n~J + J n~ − (J n)~) Ω θ̇.
    pub fn coriolis(&self, speed: f64, nodes: &[Node], visit: &mut dyn FnMut([usize; 2], &Mat6)) {
        let n = skew(&self.axis.direction);
        let mut G = Mat6::zeros();
        for (a, b, mass) in self.pairs() {
            G.fixed_view_mut::<3, 3>(0, 0).copy_from(&(2.0 * speed * mass * n));
            visit([a, b], &G);
        }
        let mut G = Mat6::zeros();
        for inertia in self.inertias.iter().filter(|inertia| inertia.rotary) {
            let J = inertia.J(&nodes[inertia.node]);
            let turning = n * J + J * n - skew(&(J * self.axis.direction));
            G.fixed_view_mut::<3, 3>(3, 3).copy_from(&(speed * turning));
            visit([inertia.node; 2], &G);
        }
    }

    /// Twice the kinetic energy, at the angular frequency 1, of a small motion across the axis: masses in it feel Coriolis forces.
    pub fn energy_across(&self, nodes: &[Node], motion: &[Vec6]) -> f64 {
        let across = self.across();
        let moved = self.pairs().map(|(a, b, mass)| mass * linear(&motion[a]).dot(&(across * linear(&motion[b]))));
        let turned = self.inertias.iter().filter(|inertia| inertia.rotary).map(|inertia| {
            let theta = across * angular(&motion[inertia.node]);
            theta.dot(&(inertia.J(&nodes[inertia.node]) * theta))
        });
        moved.sum::<f64>() + turned.sum::<f64>()
    }

    /// The projection onto the plane normal to the axis.
    fn across(&self) -> Mat3 {
        Mat3::identity() - self.axis.direction * self.axis.direction.transpose()
    }
}
