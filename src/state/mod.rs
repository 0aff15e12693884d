//! What changes when a step is accepted, and nothing else: time, the motion of every node, work done so far.

use crate::materials::Spent;
use crate::math::rotation::{self, RotationUpdate};
use crate::math::{Mat3, Vec3, Vec6, bottom, top};
use nalgebra::Quaternion;

/// Motion of one node, all in global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    pub x: Vec3,
    /// Rotation from the undeformed state, unit quaternion; see [`Node::R`].
    pub q: Quaternion<f64>,
    pub v: Vec3,
    pub omega: Vec3,
    pub a: Vec3,
    pub alpha: Vec3,
}

impl Node {
    pub fn at_rest(x: Vec3) -> Self {
        let zero = Vec3::zeros();
        Node { x, q: Quaternion::identity(), v: zero, omega: zero, a: zero, alpha: zero }
    }

    /// Rotation matrix of `q`.
    #[inline]
    pub fn R(&self) -> Mat3 {
        rotation::matrix(&self.q)
    }

    /// The node moved from `start` by an increment q = (Δu, Θ) whose rates are q̇, q̈: the only place where a rotation is
    /// updated, R = exp(Θ~) R_n. Returns how far the matrix of a truncated update was from orthogonal.
    #[inline]
    pub fn advance(&mut self, start: &Node, increment: &Increment, update: RotationUpdate) -> f64 {
        let Increment { q, d, dd } = increment;
        let theta = bottom(q);
        self.x = start.x + top(q);
        self.v = top(d);
        self.a = top(dd);
        let (turn, drift) = update.quaternion(&theta);
        self.q = rotation::renormalise(&(turn * start.q));
        (self.omega, self.alpha) = rotation::rates(&theta, &bottom(d), &bottom(dd));
        drift
    }
}

/// Motion of a node within a step: displacement and rotation vector from the start of the step, with their rates.
/// At the start of the step the rates of the rotation vector are ω and α themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increment {
    pub q: Vec6,
    pub d: Vec6,
    pub dd: Vec6,
}

impl State {
    /// The state itself as elements see it.
    pub fn now(&self) -> Now<'_> {
        Now { nodes: &self.nodes, past: &self.history, since: 0.0 }
    }
}

impl State {
    /// Takes over another state of the same scene without allocating.
    pub fn copy_from(&mut self, other: &State) {
        let State { time, nodes, history, jerk, reactions, multipliers, followers, work } = other;
        (self.time, self.work) = (*time, *work);
        self.nodes.copy_from_slice(nodes);
        self.history.copy_from_slice(history);
        self.jerk.copy_from_slice(jerk);
        self.reactions.copy_from_slice(reactions);
        self.multipliers.copy_from_slice(multipliers);
        self.followers.copy_from_slice(followers);
    }
}

impl Increment {
    pub const ZERO: Increment = {
        let zero = Vec6::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        Increment { q: zero, d: zero, dd: zero }
    };
}

/// The motion at an instant, as elements see it.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    pub nodes: &'a [Node],
    /// What the material points remember of the last accepted state; an element's share of [`State::history`].
    pub past: &'a [f64],
    /// Time since that state.
    pub since: f64,
}

impl<'a> Now<'a> {
    /// Without a past: all materials are elastic.
    pub fn of(nodes: &'a [Node]) -> Self {
        Now { nodes, past: &[], since: 0.0 }
    }
}

/// Time and nodes at the end of an accepted step.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub time: f64,
    pub nodes: Vec<Node>,
    /// What the material points remember: plastic strains and their kin, a range for each group of elements. Zero at t = 0.
    pub history: Vec<f64>,
    /// Change of (a, α) per time over the last step, for the prediction of the next.
    pub jerk: Vec<Vec6>,
    /// Forces on the held directions, in the order of the model's list.
    pub reactions: Vec<f64>,
    /// Forces and moments in the joints, a number for each row.
    pub multipliers: Vec<f64>,
    /// Accelerations (a, α) that follow those of equilibrium, where the scheme runs on such.
    pub followers: Vec<Vec6>,
    pub work: Work,
}

/// Running integrals of power since t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// Done by loads, gravity and prescribed motion.
    pub external: f64,
    /// Taken by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Power of the damping at the end of the step.
    pub damping_power: f64,
    /// Of the material points.
    pub material: Spent,
}
