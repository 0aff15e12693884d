//! Accelerations from forces where each moving node is a rigid body of its own: its mass and inertia, with those of all that
//! rides on it, about the centre that they have together. In body axes these never change, so nothing is ever factorised.

use super::dofs::DofMap;
use super::equations::System;
use crate::elements::Force;
use crate::math::{Mat3, Mat6, Vec3, Vec6, angular, linear, skew, stack};
use crate::state::Node;

/// Part of what an inertia was before others were taken from it that counts as none.
const NEGLIGIBLE: f64 = 1e-12;
/// Velocities that what is held leaves to a node are corrected so many times.
pub const CORRECTIONS: usize = 2;

/// The masses of a scene, one for each node that has an unknown.
#[derive(Debug, Clone)]
pub struct Masses {
    pub blocks: Vec<MassBlock>,
    /// By node: its place in `blocks`, where it has unknowns.
    place: Vec<Option<u32>>,
}

/// Mass and inertia that move with a node.
#[derive(Debug, Clone)]
pub struct MassBlock {
    pub node: usize,
    /// Directions that are unknowns.
    pub free: [bool; 6],
    pub mass: f64,
    /// From the node to the centre of mass; axes that were global at t = 0, like those of `J0`.
    s0: Vec3,
    /// About the centre of mass.
    J0: Mat3,
    /// Of a body: where it turns about, from the node, and its inertia about that.
    arm: Vec3,
    J_pivot: Mat3,
    J_pivot_inverse: Mat3,
    kind: BlockKind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum BlockKind {
    /// No rotation is an unknown, or the centre is the node and the inertia is one number.
    Point { inverse_inertia: f64 },
    /// Rotations are free. The centre is the node, or moves freely; or the node does not move and is what the body turns about.
    RigidBody,
    /// Some directions are held.
    Restrained,
}

/// Velocities and accelerations, global components.
#[derive(Debug, Clone, Copy)]
pub struct Motion {
    pub v: Vec3,
    pub omega: Vec3,
    pub a: Vec3,
    pub alpha: Vec3,
}

impl Masses {
    /// `None`: masses of several nodes belong together, by their elements or by dependent nodes that turn on their own.
    pub fn new(system: &System, dofs: &DofMap) -> Option<Masses> {
        if !system.consistent.is_empty() {
            return None;
        }
        // Mass, its moment, inertia about the node.
        let mut sums = vec![(0.0, Vec3::zeros(), Mat3::zeros()); dofs.nodes()];
        let mut rides = vec![None; dofs.nodes()];
        system.rigid_links.iter().for_each(|dependent| rides[dependent.node] = Some(dependent));
        let point = |mass: f64, s: &Vec3| -mass * skew(s) * skew(s);
        for inertia in &system.inertias {
            let (mut node, mut arm, mut J0) = (inertia.node, Vec3::zeros(), inertia.J0);
            while let Some(dependent) = rides[node] {
                if !dependent.rigid {
                    // A ball joint takes over the mass and leaves the inertia.
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
            // What is left of a point mass at the end of an arm.
            let trace = NEGLIGIBLE * J.amax();
            J0.iter_mut().filter(|J| J.abs() < trace).for_each(|J| *J = 0.0);
            place[node] = Some(blocks.len() as u32);
            blocks.push(MassBlock::new(node, free, mass, s0, J0));
        }
        Some(Masses { blocks, place })
    }

    /// That of a node, where it has unknowns.
    pub fn of(&self, node: usize) -> Option<&MassBlock> {
        self.place[node].map(|place| &self.blocks[place as usize])
    }

    /// M⁻¹ F, into `out` by node, where there is an unknown; accelerations of what is held stay zero.
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
        // A node that is held turns a centre elsewhere about itself.
        let centred = s0.amax() == 0.0;
        let equal = J0 == Mat3::identity() * J0[(0, 0)];
        let kind = match (turns, all(&free[3..]), centred) {
            (false, ..) => BlockKind::Point { inverse_inertia: 0.0 },
            (true, _, true) if equal => BlockKind::Point { inverse_inertia: 1.0 / J0[(0, 0)] },
            (true, true, true) => BlockKind::RigidBody,
            (true, true, false) if all(&free) => BlockKind::RigidBody,
            (true, true, false) if !free[..3].contains(&true) => BlockKind::RigidBody,
            _ => BlockKind::Restrained,
        };
        let pivots = !free[..3].contains(&true);
        let (arm, J_pivot) = if pivots { (Vec3::zeros(), J0 - mass * skew(&s0) * skew(&s0)) } else { (s0, J0) };
        let J_pivot_inverse = J_pivot.try_inverse().unwrap_or_else(Mat3::zeros);
        MassBlock { node, free, mass, s0, J0, arm, J_pivot, J_pivot_inverse, kind }
    }

    /// The matrix of all six directions, about the node as it lies.
    fn matrix(&self, R: &Mat3) -> Mat6 {
        let s = skew(&(R * self.s0));
        let mut M = Mat6::identity() * self.mass;
        M.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-self.mass * s));
        M.fixed_view_mut::<3, 3>(3, 0).copy_from(&(self.mass * s));
        M.fixed_view_mut::<3, 3>(3, 3).copy_from(&(R * self.J0 * R.transpose() - self.mass * s * s));
        M
    }

    /// An unknown direction in which nothing resists but stiffness, as the node lies at t = 0.
    pub fn massless(&self) -> Option<usize> {
        let mut M = self.matrix(&Mat3::identity());
        let scale = M.diagonal();
        eliminate(&mut M, &mut Vec6::zeros(), &self.free, &scale)
    }

    /// Accelerations of the unknown directions under a force and a moment at the node.
    #[inline]
    pub fn accelerate(&self, node: &Node, F: &Force) -> Vec6 {
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        let kept = |a: Vec6| Vec6::from_fn(|i, _| if self.free[i] { a[i] } else { 0.0 });
        match self.kind {
            BlockKind::Point { inverse_inertia } => kept(stack(&(f / self.mass), &(m * inverse_inertia))),
            BlockKind::RigidBody => {
                let R = node.R();
                // About the centre of mass, and back.
                let s = R * self.arm;
                let alpha = R * (self.J_pivot_inverse * R.tr_mul(&(m - s.cross(&f))));
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

    /// aᵀ M b of small motions of the node.
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
                let at_centre = |u: Vec3, theta: &Vec3| u + theta.cross(&self.s0);
                self.mass * at_centre(u, &theta).dot(&at_centre(w, &phi)) + theta.dot(&(self.J0 * phi))
            }
        }
    }

    /// About what accelerations of translations and of rotations weigh, for a quick look.
    pub fn mean_mass(&self) -> [f64; 2] {
        [self.mass, self.J0.trace() / 3.0]
    }

    /// F ← F − M a: what accelerations leave of a force, on directions that are held too.
    #[inline]
    pub fn subtract_inertia(&self, node: &Node, a: &Vec6, F: &mut Force) {
        // Elsewhere nothing couples what is held with what is not.
        let coupled = self.s0.amax() > 0.0 && self.free.contains(&false);
        if !coupled && self.kind != BlockKind::Restrained {
            return;
        }
        let rest = self.matrix(&node.R()) * a;
        F.iter_mut().zip(&rest).for_each(|(f, rest)| *f -= rest);
    }

    /// What angular velocities make of mass off the node and of inertia: m ω × (ω × s), and ω × J ω about the centre.
    fn gyroscopic_force(&self, R: &Mat3, omega: &Vec3) -> Vec6 {
        let s = R * self.s0;
        let f = self.mass * omega.cross(&omega.cross(&s));
        stack(&f, &(omega.cross(&(R * (self.J0 * R.tr_mul(omega)))) + s.cross(&f)))
    }

    /// Rates at the end of a step of length `dt` from `start`, where forces F are left over from the motion `now` there: the
    /// mean of the accelerations makes the velocities. That of a body which turns freely is taken of its angular momentum,
    /// which no moment of its own inertia changes. Elsewhere what masses off the node and inertias make of the predicted angular
    /// velocities is corrected: it would feed the motion.
    #[inline]
    pub fn verlet(&self, start: &Node, now: &Node, F: &Force, dt: f64) -> Motion {
        let h = 0.5 * dt;
        if self.kind != BlockKind::RigidBody {
            let mean = |push: Vec6| {
                let (a, alpha) = (now.a + linear(&push), now.alpha + angular(&push));
                Motion { v: start.v + h * (start.a + a), omega: start.omega + h * (start.alpha + alpha), a, alpha }
            };
            let mut end = mean(self.accelerate(now, F));
            for _ in 0..if self.kind == BlockKind::Restrained { CORRECTIONS } else { 0 } {
                let R = now.R();
                let given = |i: usize| if self.free[3 + i] { end.omega[i] } else { now.omega[i] };
                let change =
                    self.gyroscopic_force(&R, &Vec3::from_fn(|i, _| given(i))) - self.gyroscopic_force(&R, &now.omega);
                let F = Vec6::from(*F) - change;
                end = mean(self.accelerate(now, F.as_ref()));
            }
            return end;
        }
        let (f, m) = (Vec3::new(F[0], F[1], F[2]), Vec3::new(F[3], F[4], F[5]));
        let (R0, R) = (start.R(), now.R());
        let times = |R: &Mat3, v: &Vec3| R * (self.J_pivot * R.tr_mul(v));
        let centripetal = |node: &Node, s: &Vec3| node.alpha.cross(s) + node.omega.cross(&node.omega.cross(s));
        let (s0, s) = (R0 * self.arm, R * self.arm);
        // About the centre of mass, or a node that does not move: Ḷ = m, on both sides of the step.
        let L0 = times(&R0, &start.omega);
        let m0 = times(&R0, &start.alpha) + start.omega.cross(&L0);
        let m1 = m - s.cross(&f) + times(&R, &now.alpha) + now.omega.cross(&times(&R, &now.omega));
        let L = L0 + h * (m0 + m1);
        let divided = |v: &Vec3| R * (self.J_pivot_inverse * R.tr_mul(v));
        let omega = divided(&L);
        let alpha = divided(&(m1 - omega.cross(&L)));
        let a0 = start.a + centripetal(start, &s0);
        let a1 = now.a + centripetal(now, &s) + f / self.mass;
        let v = start.v + start.omega.cross(&s0) + h * (a0 + a1) - omega.cross(&s);
        let mut end = Motion { v, omega, a: a1, alpha };
        end.a -= alpha.cross(&s) + omega.cross(&omega.cross(&s));
        // Where the centre is the node, it may be held.
        for i in (0..3).filter(|&i| !self.free[i]) {
            (end.v[i], end.a[i]) = (now.v[i], now.a[i]);
        }
        end
    }
}

/// Solves M x = b for the free directions, which overwrites both; the others come out as zero. Returns a direction whose pivot
/// vanishes, if any.
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
