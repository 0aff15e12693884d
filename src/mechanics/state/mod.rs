//! The state of a scene, and nothing but what changes when a step is accepted: time, the motion of every node, history
//! variables, work done so far.

use crate::materials::Dissipation;
use base::math::rotation::{self, RotationUpdate};
use base::math::{Mat3, Vec3, Vec6, angular, linear};
use base::snapshot::{Keep, Snapshot, keep};
use nalgebra::Quaternion;

/// The motion of one node, all in global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Position.
    pub x: Vec3,
    /// Low-order part of the position, beyond the digits of `x`: displacements and distances keep their own digits
    /// however far the origin is.
    pub low: Vec3,
    /// Rotation from the undeformed state as a unit quaternion; see [`Node::R`].
    pub rotation: Quaternion<f64>,
    /// Velocity.
    pub v: Vec3,
    /// Angular velocity.
    pub omega: Vec3,
    /// Acceleration.
    pub a: Vec3,
    /// Angular acceleration.
    pub alpha: Vec3,
}

impl Keep for Node {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let Node { x, low, rotation, v, omega, a, alpha } = self;
        [x, low, v, omega, a, alpha].into_iter().for_each(|vector| vector.keep(snapshot));
        rotation.keep(snapshot);
    }

    fn blank() -> Option<Self> {
        Some(Node::at_rest(Vec3::zeros()))
    }
}

impl Node {
    /// A node at rest at `x`, unrotated.
    pub fn at_rest(x: Vec3) -> Self {
        let zero = Vec3::zeros();
        Node { x, low: zero, rotation: Quaternion::identity(), v: zero, omega: zero, a: zero, alpha: zero }
    }

    /// Sets the position to `x` + `low` + `u`.
    #[inline]
    pub fn place(&mut self, x: &Vec3, low: &Vec3, u: &Vec3) {
        for i in 0..3 {
            let (sum, lost) = two_sum(x[i], u[i]);
            (self.x[i], self.low[i]) = two_sum(sum, lost + low[i]);
        }
    }

    /// The displacement from `x`.
    #[inline]
    pub fn moved(&self, x: &Vec3) -> Vec3 {
        (self.x - x) + self.low
    }

    /// The position of this node less that of another, global components.
    #[inline]
    pub fn relative_position(&self, other: &Node) -> Vec3 {
        (self.x - other.x) + (self.low - other.low)
    }

    /// The displacement from `x` as a sum of two vectors: differences of such displacements between nodes are exact to
    /// their own digits.
    #[inline]
    pub fn parts(&self, x: &Vec3) -> [Vec3; 2] {
        let mut parts = [Vec3::zeros(); 2];
        for i in 0..3 {
            let (u, lost) = two_sum(self.x[i], -x[i]);
            (parts[0][i], parts[1][i]) = (u, lost + self.low[i]);
        }
        parts
    }

    /// The rotation matrix R from the undeformed state, global components.
    #[inline]
    pub fn R(&self) -> Mat3 {
        rotation::matrix(&self.rotation)
    }

    /// Moves the node from `start` by an increment q = (Δu, Θ) with the rates q̇, q̈. Rotations change only here, by R = exp(Θ~) R_n.
    /// Returns the departure from orthogonality of a truncated rotation update.
    #[inline]
    pub fn advance(&mut self, start: &Node, increment: &Increment, update: RotationUpdate) -> f64 {
        let Increment { q, d, dd } = increment;
        let theta = angular(q);
        self.place(&start.x, &start.low, &linear(q));
        self.v = linear(d);
        self.a = linear(dd);
        let (turn, drift) = update.quaternion(&theta);
        self.rotation = rotation::renormalise(&(turn * start.rotation));
        (self.omega, self.alpha) = rotation::rates(&theta, &angular(d), &angular(dd));
        drift
    }
}

/// The sum a + b and its rounding error (Knuth).
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let c = sum - a;
    (sum, (a - (sum - c)) + (b - c))
}

/// The displacement of node `b` relative to node `a`, from their positions `start` at t = 0.
#[inline]
pub fn stretch(a: &Node, b: &Node, start: &[Vec3; 2]) -> Vec3 {
    let ([a, a_low], [b, b_low]) = (a.parts(&start[0]), b.parts(&start[1]));
    (b - a) + (b_low - a_low)
}

/// The change of length |d + u| − |d| of a vector `d`, exact to the digits of `u`; `before` and `now` are |d| and |d +
/// u|.
#[inline]
pub fn elongation(d: &Vec3, before: f64, u: &Vec3, now: f64) -> f64 {
    let sum = now + before;
    if sum > 0.0 { (2.0 * d + u).dot(u) / sum } else { 0.0 }
}

/// The motion of a node within a step: displacement and rotation vector from the start of the step, with their rates.
/// At the start of the step the rates of the rotation vector are ω and α themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increment {
    /// Displacement and rotation vector (Δu, Θ).
    pub q: Vec6,
    /// First derivative q̇.
    pub d: Vec6,
    /// Second derivative q̈.
    pub dd: Vec6,
}

keep!(Increment { q, d, dd });

impl State {
    /// The configuration of the state itself, at the time that it holds.
    pub fn configuration(&self) -> Configuration<'_> {
        Configuration { nodes: &self.nodes, history: &self.history, dt: 0.0, previous: None }
    }
}

impl State {
    /// Copies another state of the same scene without allocating.
    pub fn copy_from(&mut self, other: &State) {
        let State { time, nodes, history, jerk, reactions, multipliers, algorithmic_accelerations, work } = other;
        (self.time, self.work) = (*time, *work);
        self.nodes.copy_from_slice(nodes);
        self.history.copy_from_slice(history);
        self.jerk.copy_from_slice(jerk);
        self.reactions.copy_from_slice(reactions);
        self.multipliers.copy_from_slice(multipliers);
        self.algorithmic_accelerations.copy_from_slice(algorithmic_accelerations);
    }
}

impl Increment {
    /// No motion.
    pub const ZERO: Increment = {
        let zero = Vec6::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        Increment { q: zero, d: zero, dd: zero }
    };
}

/// Motion of all nodes at an instant, and the material history before it: the input of elements.
#[derive(Debug, Clone, Copy)]
pub struct Configuration<'a> {
    /// Motion by node, in the order of the model.
    pub nodes: &'a [Node],
    /// The history variables of the last accepted state: all of [`State::history`], or an element group's range of it.
    pub history: &'a [f64],
    /// Time from that state to this instant.
    pub dt: f64,
    /// The previous iterate; its velocities are the last correction. `None` if there is none.
    ///
    /// A correction moves slender parts along straight lines and so stretches them. Stress and geometric stiffness of the iterate are then
    /// far from those of the equilibrium ahead. Stresses that are extrapolated linearly from the iterate before are not (D. Magisano, L.
    /// Leonetti, G. Garcea, Comput. Methods Appl. Mech. Engrg 313 (2017), 271-289).
    pub previous: Option<&'a [Node]>,
}

impl<'a> Configuration<'a> {
    /// A configuration without history variables: all materials are elastic.
    pub fn of(nodes: &'a [Node]) -> Self {
        Configuration { nodes, history: &[], dt: 0.0, previous: None }
    }
}

/// The state at the end of an accepted step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct State {
    /// Time at the end of the step.
    pub time: f64,
    /// Motion by node, in the order of the model.
    pub nodes: Vec<Node>,
    /// History variables of all integration points and contacts: plastic strains and the like, a range for each group
    /// of elements. They are zero at t = 0.
    pub history: Vec<f64>,
    /// Rate of change of (a, α) over the last step, for the prediction of the next.
    pub jerk: Vec<Vec6>,
    /// Reactions at the restrained degrees of freedom, in the order of the model's list.
    pub reactions: Vec<f64>,
    /// Lagrange multipliers of the joints, one for each constraint equation: forces and moments.
    pub multipliers: Vec<f64>,
    /// Algorithmic accelerations (a, α) of schemes that keep accelerations besides those of equilibrium; empty for
    /// others.
    pub algorithmic_accelerations: Vec<Vec6>,
    /// Work and dissipation since t = 0.
    pub work: Work,
}

keep!(State: Default { time, nodes, history, jerk, reactions, multipliers, algorithmic_accelerations, work });

/// Running integrals of power since t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    /// Work of loads, gravity and prescribed motion.
    pub external: f64,
    /// Energy dissipated by dampers, nodal and Rayleigh damping.
    pub damping: f64,
    /// Power of this damping at the end of the step.
    pub damping_power: f64,
    /// Energy dissipated and stored by materials and contacts.
    pub material: Dissipation,
    /// Offset between the energy at a step and the energy that velocity Verlet conserves: the change of ⅛ Δt² aᵀMa
    /// since the start. Jumps of loads change accelerations and do no work.
    pub verlet_energy_offset: f64,
    /// The product aᵀMa at the end of the last step; zero at the start, after a jump, and with other schemes than
    /// central differences.
    pub accelerations: f64,
    /// Length of the last step; zero likewise.
    pub step: f64,
}

keep!(Work { external, damping, damping_power, material, verlet_energy_offset, accelerations, step });

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_keep_what_sums_lose() {
        let start = Vec3::new(1e6, -3.0, 0.0);
        let mut node = Node::at_rest(start);
        let step = Vec3::new(1e-7, 0.1, -1e-3);
        for _ in 0..1_000_000 {
            let before = node;
            node.place(&before.x, &before.low, &step);
        }
        // A million steps, each rounded once as a number: 1e6 times 1e-7 is 0.1 to the last digit but one.
        let exact = Vec3::new(0.1, 1e5, -1e3);
        let off = (node.moved(&start) - exact).component_div(&exact).amax();
        assert!(off < 4.0 * f64::EPSILON, "{off:e}");
        // x alone is the nearest number.
        assert_eq!(node.x.x, 1e6 + 0.1);
    }

    #[test]
    fn lengths_and_their_changes() {
        let start = [Vec3::new(1e6, 2.0, 3.0), Vec3::new(1e6 + 1.0, 2.5, 3.25)];
        let mut nodes = start.map(Node::at_rest);
        let u = [Vec3::new(3.0, -4.0, 5e5), Vec3::new(3.0 + 2e-13, -4.0, 5e5 + 1e-13)];
        // The second node moves twice: by the shared large displacement, and by its own.
        nodes[0].place(&start[0], &Vec3::zeros(), &u[0]);
        nodes[1].place(&start[1], &Vec3::zeros(), &u[0]);
        let own = Vec3::new(2e-13, 0.0, 1e-13);
        let Node { x, low, .. } = nodes[1];
        nodes[1].place(&x, &low, &own);
        let stretched = stretch(&nodes[0], &nodes[1], &start);
        // Digits of 5e5 in two parts: 1e-16 of 6e-11.
        assert!((stretched - own).amax() < 1e-26, "{stretched:?}");
        let d = start[1] - start[0];
        let more = elongation(&d, d.norm(), &stretched, (d + stretched).norm());
        assert!((more / (d.dot(&own) / d.norm()) - 1.0).abs() < 1e-12, "{more:e}");
    }
}
