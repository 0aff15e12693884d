//! Six-component bushing: springs and dampers along and about the axes of a frame that rotates with the first node.
//!
//! d = Bᵀ(x₂ − x₁) − d₀ and Q = Bᵀ R₂ A, with B = R₁ A the frame. The energy ½ d·k d gives the force B k d, and
//! [`super::relative_rotation`] the moment B m(Q). Dampers act on ḋ and on the relative angular velocity in the frame. If full turns count,
//! the history of a bushing holds the angle of twist at the end of the last step. A bushing with failure also remembers its failure.

use super::block::{Branches, Elements, FailureCause, Force, Mechanics, Moduli, Results, subtract};
use super::link_failure::{self, LinkFailure, has_failed};
use super::memories::places;
use super::relative_rotation::{ElasticMoment, RotationalSpring};
use crate::materials::{Dissipation, FAILED_STIFFNESS};
use crate::state::{Configuration, Node};
use base::math::{Mat3, Vec3, skew};
use nalgebra::Quaternion;
use std::ops::Range;

/// One bushing between two nodes.
#[derive(Debug, Clone)]
pub struct Bushing {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// A: the axes as columns, global components at t = 0.
    pub axes: Mat3,
    /// k, force per length along the axes.
    pub stiffness: Vec3,
    /// Moments about the axes.
    pub spring: RotationalSpring,
    /// Force per velocity along the axes, then moment per angular velocity about them.
    pub damping: [f64; 6],
    /// Aᵀ(x₂ − x₁) at t = 0.
    pub offset: Vec3,
    /// Failure forces, the normal one along its first axis; `None` without failure.
    pub failure: Option<LinkFailure>,
}

/// Motion of the second node relative to the first.
struct RelativeMotion {
    B: Mat3,
    /// x₂ − x₁
    r: Vec3,
    /// Velocity of the second node relative to the frame of the first, global components.
    u: Vec3,
    /// ω₂ − ω₁
    w: Vec3,
    /// d, in the frame.
    d: Vec3,
    /// Rotation of the second node relative to the first, in the frame.
    Q: Quaternion<f64>,
}

impl Bushing {
    fn motion(&self, nodes: &[Node]) -> RelativeMotion {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let B = a.R() * self.axes;
        let r = b.relative_position(a);
        RelativeMotion {
            B,
            r,
            u: b.v - a.v - a.omega.cross(&r),
            w: b.omega - a.omega,
            d: B.tr_mul(&r) - self.offset,
            Q: self.relative_rotation(nodes),
        }
    }

    /// Rotation of the second node relative to the first, in the frame.
    fn relative_rotation(&self, nodes: &[Node]) -> Quaternion<f64> {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let Q = a.rotation.conjugate() * b.rotation;
        Quaternion::from_parts(Q.w, self.axes.tr_mul(&Q.imag()))
    }

    /// True if the moment is undefined after the rotation of the ends, in total or in this step: near half a turn of a rotation vector or
    /// of the swing of an axis.
    pub fn is_turned_over(&self, start: &[Node], end: &[Node]) -> bool {
        self.spring.is_turned_over(&self.relative_rotation(start), &self.relative_rotation(end))
    }

    /// True if the ends turn by more than 2 rad in a step of length `dt` from `start` to `end`. The rotations at both ends then do not
    /// define the number of full turns.
    pub fn turns_too_far(&self, start: &[Node], end: &[Node], dt: f64) -> bool {
        /// In radians. The margin to half a turn is for the error of the angle found from the velocities at the ends of a step.
        const LIMIT: f64 = 2.0;
        if !self.spring.resists() {
            return false;
        }
        let spin = |nodes: &[Node]| {
            let [a, b] = self.nodes.map(|n| &nodes[n]);
            self.axes.tr_mul(&a.R().tr_mul(&(b.omega - a.omega)))
        };
        // The mean of both spins is the rotation also for vibrations from step to step.
        let spun = 0.5 * dt * (spin(start) + spin(end));
        let rotations = [start, end].map(|nodes| self.relative_rotation(nodes));
        self.spring.step_angle(&rotations, &spun) > LIMIT
    }

    /// The energy of its springs; `last`: the twist at the end of the last step.
    fn energy(&self, motion: &RelativeMotion, last: f64) -> f64 {
        let d = &motion.d;
        0.5 * self.stiffness.component_mul(d).dot(d) + self.spring.moment(&motion.Q, last).energy
    }

    /// The coefficients of translation and of rotation.
    fn coefficients(values: &[f64; 6]) -> (Vec3, Vec3) {
        let [a, b, c, d, e, f] = *values;
        (Vec3::new(a, b, c), Vec3::new(d, e, f))
    }

    /// Force and moment on the second node, global components; `last`: the twist at the end of the last step.
    fn forces(&self, motion: &RelativeMotion, last: f64) -> (Vec3, Vec3) {
        let (c, c_phi) = Self::coefficients(&self.damping);
        let f = self.stiffness.component_mul(&motion.d) + c.component_mul(&motion.B.tr_mul(&motion.u));
        let ElasticMoment { moment, .. } = self.spring.moment(&motion.Q, last);
        let m = moment + c_phi.component_mul(&motion.B.tr_mul(&motion.w));
        (motion.B * f, motion.B * m)
    }

    /// The number of its history variables: the twist at the end of the last step where full turns count, and the forces of a failure.
    pub fn memory(&self) -> usize {
        usize::from(self.spring.counts_turns()) + if self.failure.is_some() { link_failure::MEMORY } else { 0 }
    }

    /// The twist at the end of the last step and the forces of a failure, of its history variables.
    fn remembered<'a>(&self, memory: &'a [f64]) -> (f64, &'a [f64]) {
        match (self.spring.counts_turns(), memory) {
            (true, [last, failed @ ..]) => (*last, failed),
            (_, failed) => (0.0, failed),
        }
    }

    /// True where it has failed by its history variables.
    pub fn has_failed(&self, memory: &[f64]) -> bool {
        has_failed(self.remembered(memory).1)
    }

    /// d, its rate along the first axis, force and moment on the second node; components in the frame. `memory`: its history variables.
    pub fn state(&self, nodes: &[Node], memory: &[f64]) -> (Vec3, f64, Vec3, Vec3) {
        let motion = self.motion(nodes);
        let (last, failed) = self.remembered(memory);
        if has_failed(failed) {
            return (motion.d, motion.B.column(0).dot(&motion.u), Vec3::zeros(), Vec3::zeros());
        }
        let (F, M) = self.forces(&motion, last);
        (motion.d, motion.B.column(0).dot(&motion.u), motion.B.tr_mul(&F), motion.B.tr_mul(&M))
    }
}

/// A group of bushings.
pub struct Bushings {
    bushings: Vec<Bushing>,
    /// The history variables of each.
    memories: Vec<Range<usize>>,
}

impl Bushings {
    /// A group of these bushings.
    pub fn new(bushings: Vec<Bushing>) -> Bushings {
        let memories = places(bushings.iter().map(Bushing::memory));
        Bushings { bushings, memories }
    }

    /// Bushings with their twist at the end of the last step, and the forces of their failure.
    fn with_history<'a>(&'a self, history: &'a [f64]) -> impl Iterator<Item = (&'a Bushing, f64, &'a [f64])> {
        self.bushings.iter().zip(&self.memories).map(|(bushing, memory)| {
            let (last, failed) = bushing.remembered(history.get(memory.clone()).unwrap_or(&[]));
            (bushing, last, failed)
        })
    }

    /// Bushings without failure, with their twist at the end of the last step.
    fn whole<'a>(&'a self, history: &'a [f64]) -> impl Iterator<Item = (&'a Bushing, f64)> {
        self.with_history(history)
            .filter(|(_, _, failed)| !has_failed(failed))
            .map(|(bushing, last, _)| (bushing, last))
    }

    fn remembered<'a>(&self, e: usize, history: &'a [f64]) -> (f64, &'a [f64]) {
        self.bushings[e].remembered(history.get(self.memories[e].clone()).unwrap_or(&[]))
    }
}

impl Elements for Bushings {
    fn len(&self) -> usize {
        self.bushings.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.bushings[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }
}

impl Mechanics for Bushings {
    fn is_damped(&self) -> bool {
        self.bushings.iter().any(|b| b.damping.iter().any(|&c| c > 0.0))
    }

    fn history(&self) -> usize {
        self.memories.last().map_or(0, |last| last.end)
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut lost = Dissipation::default();
        for ((bushing, last, failed), memory) in self.with_history(now.history).zip(&self.memories) {
            let Some(memory) = new.get_mut(memory.clone()).filter(|memory| !memory.is_empty()) else { continue };
            let turns = usize::from(bushing.spring.counts_turns());
            memory[..turns].fill(last);
            memory[turns..].copy_from_slice(failed);
            if has_failed(failed) {
                continue;
            }
            if turns > 0 {
                let twist = bushing.spring.moment(&bushing.relative_rotation(now.nodes), last).twist;
                memory[0] = last + part * (twist - last);
            }
            let Some(failure) = bushing.failure else { continue };
            let motion = bushing.motion(now.nodes);
            let force = motion.B.tr_mul(&bushing.forces(&motion, last).0);
            let shear = force.y.hypot(force.z);
            if failure.is_reached(force.x, shear) {
                memory[turns..].copy_from_slice(&[force.x, shear]);
                lost.eroded += bushing.energy(&motion, last);
            }
        }
        lost
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (bushing, last) in self.whole(now.history) {
            let motion = bushing.motion(now.nodes);
            let (f, m) = bushing.forces(&motion, last);
            let [a, b] = bushing.nodes;
            subtract(&mut F[a], 0, &-f);
            subtract(&mut F[a], 3, &-(m + motion.r.cross(&f)));
            subtract(&mut F[b], 0, &f);
            subtract(&mut F[b], 3, &m);
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let bushing = &self.bushings[e];
        let motion = bushing.motion(now.nodes);
        let (last, failed) = self.remembered(e, now.history);
        let (F, M) = bushing.forces(&motion, last);
        let omega = now.nodes[bushing.nodes[0]].omega;
        let (c, c_phi) = Bushing::coefficients(&bushing.damping);
        let B = motion.B;
        let global = |diagonal: &Vec3| B * Mat3::from_diagonal(diagonal) * B.transpose();
        let (k, c, c_phi) = (global(&bushing.stiffness), global(&c), global(&c_phi));
        let k_phi = B * bushing.spring.tangent(&motion.Q, last) * B.transpose();
        let (r, u, w) = (skew(&motion.r), skew(&motion.u), skew(&motion.w));
        // δF = F_r δr + F_1 δθ₁ with δd = Bᵀ(δr + r~ δθ₁), δḋ = Bᵀ(δu + u~ δθ₁) and δu = δv₂ − δv₁ + r~ δω₁ − ω₁~ δr.
        let F_r = k + c * (rate_weight * Mat3::identity() - skew(&omega));
        let F_1 = k * r + c * (u + rate_weight * r) - skew(&F);
        // δM = M_2 (δθ₂ − δθ₁) + M_1 δθ₁
        let M_2 = k_phi + rate_weight * c_phi;
        let M_1 = c_phi * w - skew(&M);
        let Z = Mat3::zeros();
        let dF = [-F_r, F_1, F_r, Z];
        let dM = [Z, M_1 - M_2, Z, M_2];
        for (column, (df, dm)) in dF.iter().zip(&dM).enumerate() {
            let mut moment = -dm - r * df; // of −(M + r × F)
            match column {
                0 => moment -= skew(&F),
                2 => moment += skew(&F),
                _ => {}
            }
            for (row, block) in [-df, moment, *df, *dm].iter().enumerate() {
                for i in 0..3 {
                    for j in 0..3 {
                        K[(3 * row + i) * 12 + 3 * column + j] = block[(i, j)];
                    }
                }
            }
        }
        if has_failed(failed) {
            K.iter_mut().for_each(|k| *k *= FAILED_STIFFNESS);
        }
    }
}

impl Results for Bushings {
    fn can_fail(&self) -> bool {
        self.bushings.iter().any(|bushing| bushing.failure.is_some())
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        has_failed(self.remembered(e, history).1)
    }

    fn energy(&self, now: &Configuration) -> f64 {
        self.whole(now.history).map(|(bushing, last)| bushing.energy(&bushing.motion(now.nodes), last)).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let power = |(b, _): (&Bushing, f64)| {
            let motion = b.motion(now.nodes);
            let (c, c_phi) = Bushing::coefficients(&b.damping);
            let (u, w) = (motion.B.tr_mul(&motion.u), motion.B.tr_mul(&motion.w));
            c.component_mul(&u).dot(&u) + c_phi.component_mul(&w).dot(&w)
        };
        self.whole(now.history).map(power).sum()
    }

    fn failure_cause(&self, e: usize, history: &[f64]) -> FailureCause {
        link_failure::cause(self.remembered(e, history).1)
    }
}

impl Branches for Bushings {}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::rotation;

    #[test]
    fn only_what_resists_rotation_can_be_turned_over() {
        let nodes = |angle: f64| {
            let mut nodes = [Node::at_rest(Vec3::zeros()); 2];
            nodes[1].rotation = rotation::exp(&Vec3::new(0.0, 0.0, angle));
            nodes
        };
        let turns = |stiffness: Vec3, angles: [f64; 2]| {
            let bushing = Bushing {
                nodes: [0, 1],
                axes: Mat3::identity(),
                stiffness: Vec3::repeat(1.0),
                spring: RotationalSpring::new(stiffness),
                damping: [0.0; 6],
                offset: Vec3::zeros(),
                failure: None,
            };
            bushing.is_turned_over(&nodes(angles[0]), &nodes(angles[1]))
        };
        for angles in [[2.9, 3.1], [2.9, 3.6]] {
            assert!(!turns(Vec3::zeros(), angles), "nothing resists");
            assert!(!turns(Vec3::new(1.0, 1.0, 0.0), angles), "a free axis");
            assert!(!turns(Vec3::new(1.0, 1.0, 5.0), angles), "full turns count");
            assert!(turns(Vec3::repeat(1.0), angles), "a rotation vector");
            assert!(turns(Vec3::new(0.0, 1.0, 1.0), angles), "the swing of another axis");
        }
    }
}
