//! Accelerations from forces if each independent node is a separate rigid body: its mass and inertia, with all rigidly attached nodes,
//! about their common centre of mass. In body axes these are constant, so nothing is factorized during the run.

use super::dofs::DofMap;
use super::equations::System;
use super::free_rotation::FreeRotation;
use crate::tolerances::masses::{CORRECTIONS, NEGLIGIBLE};
use base::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, rotation, skew, stack};
use mechanics::elements::Force;
use mechanics::state::Node;

/// The masses of a scene: one block for each node that has an unknown.
#[derive(Debug, Clone)]
pub struct Masses {
    /// The blocks, in ascending order of nodes.
    pub blocks: Vec<MassBlock>,
    /// For each node the index of its block in `blocks`; `None` where it has no unknown.
    place: Vec<Option<u32>>,
}

/// The mass and inertia that move with a node.
#[derive(Debug, Clone)]
pub struct MassBlock {
    /// The node that they move with.
    pub node: usize,
    /// True for each degree of freedom that is an unknown.
    pub free: [bool; 6],
    /// Mass, including all rigidly attached nodes.
    pub mass: f64,
    /// Mean moment of inertia about the centre of mass.
    mean_inertia: f64,
    kind: BlockKind,
    body: Box<BodyInertia>,
}

/// The inertia of a block, apart from the data read by every loop over blocks.
#[derive(Debug, Clone)]
struct BodyInertia {
    /// Vector from the node to the centre of mass, in axes fixed to the node that were global at t = 0, like those of
    /// `J0`.
    s0: Vec3,
    /// Inertia tensor about the centre of mass.
    J0: Mat3,
    /// Vector from the node to the point that a rigid body turns about, the inertia tensor about it, and its inverse.
    arm: Vec3,
    J_pivot: Mat3,
    J_pivot_inverse: Mat3,
    free_rotation: FreeRotation,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum BlockKind {
    /// No rotation is an unknown, or the node is the centre of mass and J₀ is a multiple of the identity.
    Point { inverse_inertia: f64 },
    /// All rotations are unknowns. The node is the centre of mass, or the centre moves freely, or the node does not
    /// translate and the body turns about it.
    RigidBody,
    /// The only unknown rotation is about a global axis, a principal axis at t = 0, and the node is the centre of mass.
    OneRotation { axis: usize },
    /// Some degrees of freedom are restrained.
    Restrained,
}

/// Velocities and accelerations of a node, global components.
#[derive(Debug, Clone, Copy)]
pub struct NodeRates {
    /// Velocity.
    pub v: Vec3,
    /// Angular velocity.
    pub omega: Vec3,
    /// Acceleration.
    pub a: Vec3,
    /// Angular acceleration.
    pub alpha: Vec3,
}

impl NodeRates {
    /// The rates at the end of a step of length `dt` by the mean of the accelerations; `missing` is the difference to the accelerations of
    /// the trial motion `now`.
    #[inline]
    pub fn mean(start: &Node, now: &Node, missing: &Vec6, dt: f64) -> NodeRates {
        let (a, alpha) = (now.a + linear(missing), now.alpha + angular(missing));
        let h = 0.5 * dt;
        NodeRates { v: start.v + h * (start.a + a), omega: start.omega + h * (start.alpha + alpha), a, alpha }
    }
}

impl Masses {
    /// Returns `None` if masses of several nodes are coupled: by consistent masses, or by dependent nodes with free rotations.
    pub fn new(system: &System, dofs: &DofMap) -> Option<Masses> {
        if !system.consistent.is_empty() || !system.floating().is_empty() {
            return None;
        }
        // The sums are mass, its first moment, and the inertia tensor about the node.
        let mut sums = vec![(0.0, Vec3::zeros(), Mat3::zeros()); dofs.nodes()];
        let mut link_of = vec![None; dofs.nodes()];
        system.rigid_links.iter().for_each(|dependent| link_of[dependent.node] = Some(dependent));
        let point = |mass: f64, s: &Vec3| -mass * skew(s) * skew(s);
        for inertia in &system.inertias {
            let (mut node, mut arm, mut J0) = (inertia.node, Vec3::zeros(), inertia.J0);
            while let Some(dependent) = link_of[node] {
                if !dependent.rigid {
                    // A spherical joint transfers the mass to the master but not the inertia.
                    if dependent.dofs != [true, true, true, false, false, false] || node != inertia.node {
                        return None;
                    }
                    sums[node].2 += J0;
                    J0 = Mat3::zeros();
                }
                arm += dependent.S0;
                node = dependent.master;
            }
            let (mass, moment, J) = &mut sums[node];
            *mass += inertia.mass;
            *moment += inertia.mass * arm;
            *J += J0 + point(inertia.mass, &arm);
        }
        let mut place = vec![None; dofs.nodes()];
        let mut blocks = Vec::new();
        for (node, (mass, moment, J)) in sums.into_iter().enumerate() {
            let free = dofs.of(node).unknown();
            if !free.contains(&true) {
                continue;
            }
            let s0 = if mass > 0.0 { moment / mass } else { Vec3::zeros() };
            let mut J0 = J - point(mass, &s0);
            // For a point mass at the end of an arm J0 is only rounding.
            let trace = NEGLIGIBLE * J.amax();
            J0.iter_mut().filter(|J| J.abs() < trace).for_each(|J| *J = 0.0);
            place[node] = Some(blocks.len() as u32);
            blocks.push(MassBlock::new(node, free, mass, s0, J0));
        }
        Some(Masses { blocks, place })
    }

    /// The block of a node; `None` where the node has no unknown.
    pub fn of(&self, node: usize) -> Option<&MassBlock> {
        self.place[node].map(|place| &self.blocks[place as usize])
    }

    /// Writes M⁻¹ F into `out`, by node, for each node with an unknown, and zero at its restrained degrees of freedom;
    /// the other entries stay.
    pub fn accelerate(&self, nodes: &[Node], F: &[Force], out: &mut [Vec6]) {
        for block in &self.blocks {
            out[block.node] = block.accelerate(&nodes[block.node], &F[block.node]);
        }
    }
}

impl MassBlock {
    fn new(node: usize, free: [bool; 6], mass: f64, s0: Vec3, J0: Mat3) -> MassBlock {
        let all = |free: &[bool]| !free.contains(&false);
        let turns = free[3..].contains(&true);
        // Translations and rotations are not coupled where the node is the centre of mass.
        let centred = s0.amax() == 0.0;
        let equal = J0 == Mat3::identity() * J0[(0, 0)];
        let kind = match (turns, all(&free[3..]), centred) {
            (false, ..) => BlockKind::Point { inverse_inertia: 0.0 },
            (true, _, true) if equal => BlockKind::Point { inverse_inertia: 1.0 / J0[(0, 0)] },
            (true, true, true) => BlockKind::RigidBody,
            (true, true, false) if all(&free) => BlockKind::RigidBody,
            (true, true, false) if !free[..3].contains(&true) => BlockKind::RigidBody,
            (true, false, true) => match free_axis(&free, &J0) {
                Some(axis) => BlockKind::OneRotation { axis },
                None => BlockKind::Restrained,
            },
            _ => BlockKind::Restrained,
        };
        let pivots = !free[..3].contains(&true);
        let (arm, J_pivot) = if pivots { (Vec3::zeros(), J0 - mass * skew(&s0) * skew(&s0)) } else { (s0, J0) };
        let J_pivot_inverse = J_pivot.try_inverse().unwrap_or_else(Mat3::zeros);
        let free_rotation = FreeRotation::new(&J_pivot);
        let mean_inertia = J0.trace() / 3.0;
        let body = Box::new(BodyInertia { s0, J0, arm, J_pivot, J_pivot_inverse, free_rotation });
        MassBlock { node, free, mass, mean_inertia, kind, body }
    }

    /// The accelerations of unknown degrees of freedom, and zero for the others.
    #[inline]
    pub fn of_unknowns(&self, a: &Vec6) -> Vec6 {
        Vec6::from_fn(|i, _| if self.free[i] { a[i] } else { 0.0 })
    }

    /// The moment of inertia about a global axis through the centre of mass.
    #[inline]
    fn moment_of_inertia(&self, node: &Node, axis: usize) -> f64 {
        let J0 = &self.body.J0;
        if turns_about(node, axis) {
            return J0[(axis, axis)];
        }
        let row = node.R().row(axis).transpose();
        let J: [f64; 3] = std::array::from_fn(|j| row[0] * J0[(0, j)] + row[1] * J0[(1, j)] + row[2] * J0[(2, j)]);
        J[0] * row[0] + J[1] * row[1] + J[2] * row[2]
    }

    /// The mass matrix of all six degrees of freedom, about the node; `R` is the node's rotation.
    fn matrix(&self, R: &Mat3) -> Mat6 {
        let s = skew(&(R * self.body.s0));
        let mut M = Mat6::identity() * self.mass;
        M.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-self.mass * s));
        M.fixed_view_mut::<3, 3>(3, 0).copy_from(&(self.mass * s));
        M.fixed_view_mut::<3, 3>(3, 3).copy_from(&(R * self.body.J0 * R.transpose() - self.mass * s * s));
        M
    }

    /// A degree of freedom that is an unknown and has no inertia at t = 0.
    pub fn massless(&self) -> Option<usize> {
        let mut M = self.matrix(&Mat3::identity());
        let scale = M.diagonal();
        eliminate(&mut M, &mut Vec6::zeros(), &self.free, &scale)
    }

    /// Accelerations of the unknown degrees of freedom under the force and moment `F` at the node; zero for the others.
    #[inline]
    pub fn accelerate(&self, node: &Node, F: &Force) -> Vec6 {
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        let kept = |a: Vec6| self.of_unknowns(&a);
        match self.kind {
            BlockKind::Point { inverse_inertia } => kept(stack(&(f / self.mass), &(m * inverse_inertia))),
            BlockKind::OneRotation { axis } => {
                let J = self.moment_of_inertia(node, axis);
                let over = |f: f64, mass: f64| if mass > 0.0 { f / mass } else { 0.0 };
                let f = f.map(|f| over(f, self.mass));
                kept(stack(&f, &Vec3::ith(axis, over(m[axis], J))))
            }
            BlockKind::RigidBody => {
                let R = node.R();
                // The moment is taken about the centre of mass, and the acceleration back to the node.
                let s = R * self.body.arm;
                let alpha = R * (self.body.J_pivot_inverse * R.tr_mul(&(m - s.cross(&f))));
                kept(stack(&(f / self.mass - alpha.cross(&s)), &alpha))
            }
            BlockKind::Restrained => {
                let mut M = self.matrix(&node.R());
                let mut x = Vec6::from(*F);
                let scale = M.diagonal();
                eliminate(&mut M, &mut x, &self.free, &scale);
                x
            }
        }
    }

    /// The product aᵀ M b of two small motions of the node.
    #[inline]
    pub fn inner_product(&self, node: &Node, a: &Vec6, b: &Vec6) -> f64 {
        match self.kind {
            BlockKind::Point { inverse_inertia } => {
                let turn = if inverse_inertia > 0.0 { angular(a).dot(&angular(b)) / inverse_inertia } else { 0.0 };
                self.mass * linear(a).dot(&linear(b)) + turn
            }
            _ => {
                let R = node.R();
                let in_body = |v: &Vec6| (R.tr_mul(&linear(v)), R.tr_mul(&angular(v)));
                let ((u, theta), (w, phi)) = (in_body(a), in_body(b));
                let at_centre = |u: Vec3, theta: &Vec3| u + theta.cross(&self.body.s0);
                self.mass * at_centre(u, &theta).dot(&at_centre(w, &phi)) + theta.dot(&(self.body.J0 * phi))
            }
        }
    }

    /// The product aᵀ M a of the accelerations that forces give to the node. For freely turning bodies it excludes the free angular
    /// acceleration, because their rotation is integrated exactly: `f²/m + m·J⁻¹m` with the moments `m = J α + ω × J ω`.
    #[inline]
    pub fn push_product(&self, node: &Node, a: &Vec6) -> f64 {
        if self.kind != BlockKind::RigidBody {
            return self.inner_product(node, a, a);
        }
        let R = node.R();
        let [a, alpha, omega] = [linear(a), angular(a), node.omega].map(|v| R.tr_mul(&v));
        let a = a + alpha.cross(&self.body.arm) + omega.cross(&omega.cross(&self.body.arm));
        let m = self.body.J_pivot * alpha + omega.cross(&(self.body.J_pivot * omega));
        self.mass * a.norm_squared() + m.dot(&(self.body.J_pivot_inverse * m))
    }

    /// Mass and mean moment of inertia, a rough measure for comparisons.
    pub fn mean_mass(&self) -> [f64; 2] {
        [self.mass, self.mean_inertia]
    }

    /// Subtracts inertia forces, F ← F − M a, from all degrees of freedom, the restrained ones included.
    #[inline]
    pub fn subtract_inertia(&self, node: &Node, a: &Vec6, F: &mut Force) {
        match self.kind {
            BlockKind::OneRotation { axis } if turns_about(node, axis) => {
                (0..3).for_each(|i| F[i] -= self.mass * a[i]);
                F[3 + axis] -= self.body.J0[(axis, axis)] * a[3 + axis];
                return;
            }
            BlockKind::OneRotation { .. } | BlockKind::Restrained => {}
            // In all other cases no inertia couples restrained and free degrees of freedom, unless the mass is off the node.
            _ if self.free == [true; 6] || self.body.s0.amax() == 0.0 => return,
            _ => {}
        }
        let rest = self.matrix(&node.R()) * a;
        F.iter_mut().zip(&rest).for_each(|(f, rest)| *f -= rest);
    }

    /// Force and moment due to angular velocities: `m ω × (ω × s)` of a mass off the node, and `ω × J ω` about the centre of mass.
    fn gyroscopic_force(&self, R: &Mat3, omega: &Vec3) -> Vec6 {
        let s = R * self.body.s0;
        let f = self.mass * omega.cross(&omega.cross(&s));
        stack(&f, &(omega.cross(&(R * (self.body.J0 * R.tr_mul(omega)))) + s.cross(&f)))
    }

    /// Displacement and rotation vector of a freely turning body in a step of length `dt` from `start`. Its pivot moves by central
    /// differences, and the body turns about the pivot with its angular momentum at mid-step. Forward and backward are the same, so that no
    /// energy is made steadily. `None` for other nodes.
    #[inline]
    pub fn drift(&self, start: &Node, dt: f64) -> Option<Vec6> {
        if self.kind != BlockKind::RigidBody {
            return None;
        }
        let h = 0.5 * dt;
        let R = start.R();
        let times = |v: &Vec3| R * (self.body.J_pivot * R.tr_mul(v));
        let L = times(&start.omega);
        let L = L + h * (times(&start.alpha) + start.omega.cross(&L));
        let turn = self.body.free_rotation.turn(&start.rotation, &L, dt);
        let s = R * self.body.arm;
        let v = start.v + start.omega.cross(&s);
        let a = start.a + start.alpha.cross(&s) + start.omega.cross(&start.omega.cross(&s));
        let u = dt * (v + h * a) - rotation::change(&rotation::exp(&turn), &s);
        Some(stack(&Vec3::from_fn(|i, _| if self.free[i] { u[i] } else { 0.0 }), &turn))
    }

    /// Velocities and accelerations at the end of a velocity Verlet step of length `dt` from `start`. `F` is the residual at the motion
    /// `now` there, with predicted velocities, and `found` what [`MassBlock::accelerate`] makes of it. The velocities follow from the mean
    /// of the accelerations. For a freely turning body they follow from the mean rate of its angular momentum, which no moment of its
    /// inertia changes. Where degrees of freedom are restrained, the gyroscopic terms of the predicted angular velocities are corrected:
    /// they would feed energy into the motion.
    #[inline]
    pub fn verlet(&self, start: &Node, now: &Node, F: &Force, found: &Vec6, dt: f64) -> NodeRates {
        match self.kind {
            BlockKind::RigidBody => self.turn_freely(start, now, F, dt),
            BlockKind::Point { .. } => NodeRates::mean(start, now, found, dt),
            BlockKind::OneRotation { axis }
                if turns_about(now, axis) && now.omega == Vec3::ith(axis, now.omega[axis]) =>
            {
                NodeRates::mean(start, now, found, dt)
            }
            _ => self.correct(start, now, F, found, dt),
        }
    }

    /// [`MassBlock::verlet`] with the gyroscopic terms of the predicted angular velocities corrected.
    fn correct(&self, start: &Node, now: &Node, F: &Force, found: &Vec6, dt: f64) -> NodeRates {
        let mut end = NodeRates::mean(start, now, found, dt);
        for _ in 0..CORRECTIONS {
            let R = now.R();
            let given = |i: usize| if self.free[3 + i] { end.omega[i] } else { now.omega[i] };
            let change =
                self.gyroscopic_force(&R, &Vec3::from_fn(|i, _| given(i))) - self.gyroscopic_force(&R, &now.omega);
            let F = Vec6::from(*F) - change;
            end = NodeRates::mean(start, now, &self.accelerate(now, F.as_ref()), dt);
        }
        end
    }

    /// [`MassBlock::verlet`] for a body that turns freely.
    #[inline]
    fn turn_freely(&self, start: &Node, now: &Node, F: &Force, dt: f64) -> NodeRates {
        let h = 0.5 * dt;
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        let (R0, R) = (start.R(), now.R());
        let times = |R: &Mat3, v: &Vec3| R * (self.body.J_pivot * R.tr_mul(v));
        let centripetal = |node: &Node, s: &Vec3| node.alpha.cross(s) + node.omega.cross(&node.omega.cross(s));
        let (s0, s) = (R0 * self.body.arm, R * self.body.arm);
        // The balance of angular momentum about the centre of mass, or about a node that does not translate: L̇ = m, at
        // both ends of the step.
        let L0 = times(&R0, &start.omega);
        let m0 = times(&R0, &start.alpha) + start.omega.cross(&L0);
        let m1 = m - s.cross(&f) + times(&R, &now.alpha) + now.omega.cross(&times(&R, &now.omega));
        let L = L0 + h * (m0 + m1);
        let divided = |v: &Vec3| R * (self.body.J_pivot_inverse * R.tr_mul(v));
        let omega = divided(&L);
        let alpha = divided(&(m1 - omega.cross(&L)));
        let a0 = start.a + centripetal(start, &s0);
        let a1 = now.a + centripetal(now, &s) + f / self.mass;
        let v = start.v + start.omega.cross(&s0) + h * (a0 + a1) - omega.cross(&s);
        let mut end = NodeRates { v, omega, a: a1, alpha };
        end.a -= alpha.cross(&s) + omega.cross(&omega.cross(&s));
        // Translations may be restrained where the node is the centre of mass.
        for i in (0..3).filter(|&i| !self.free[i]) {
            (end.v[i], end.a[i]) = (now.v[i], now.a[i]);
        }
        end
    }
}

/// The axis of the only free rotation, if it is a principal axis of `J0`.
fn free_axis(free: &[bool; 6], J0: &Mat3) -> Option<usize> {
    let axis = free[3..].iter().position(|&free| free)?;
    let alone = (0..3).all(|i| i == axis || !free[3 + i] && J0[(axis, i)] == 0.0 && J0[(i, axis)] == 0.0);
    alone.then_some(axis)
}

/// True where a node has turned about this global axis alone.
#[inline]
fn turns_about(node: &Node, axis: usize) -> bool {
    let q = &node.rotation;
    let off = [q.i, q.j, q.k];
    (0..3).all(|i| i == axis || off[i] == 0.0)
}

/// Solves M x = b for the free degrees of freedom and overwrites both; the other entries of x are zero. Returns a
/// degree of freedom whose pivot vanishes, if there is one.
fn eliminate(M: &mut Mat6, b: &mut Vec6, free: &[bool; 6], scale: &Vec6) -> Option<usize> {
    let mut lost = None;
    for k in 0..6 {
        if !free[k] {
            b[k] = 0.0;
            continue;
        }
        let pivot = M[(k, k)];
        if pivot <= NEGLIGIBLE * scale[k] {
            lost = lost.or(Some(k));
            b[k] = 0.0;
            continue;
        }
        for i in (k + 1..6).filter(|&i| free[i]) {
            let l = M[(i, k)] / pivot;
            for j in k..6 {
                M[(i, j)] -= l * M[(k, j)];
            }
            b[i] -= l * b[k];
        }
    }
    for k in (0..6).rev().filter(|&k| free[k] && M[(k, k)] > NEGLIGIBLE * scale[k]) {
        let sum: f64 = (k + 1..6).filter(|&j| free[j]).map(|j| M[(k, j)] * b[j]).sum();
        b[k] = (b[k] - sum) / M[(k, k)];
    }
    lost
}
