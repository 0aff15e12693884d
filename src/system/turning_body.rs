//! The rotation of a rigid body within a step of an implicit scheme.
//!
//! In the coordinates of a rotation vector a body that turns freely is accelerated, and a scheme that takes this for a motion makes
//! or loses energy by it. So the scheme acts on the departure χ from the free rotation R_f that goes on from the start of the step:
//!
//! R = R₀ R_f exp(φ), φ = exp(−t κ) χ, χ̇ = r₁ χ + r₃ χ̈₀, χ̈ = a₁ χ + a₃ χ̈₀ + a₄ χ̈₀', χ = χ̇ = 0 and χ̈₀ = α₀ − g(ω₀) at the start,
//!
//! in axes of the body, g being the angular acceleration of free rotation. ω and α follow from φ and its rates exactly. A free body has
//! χ = 0: it keeps its angular momentum to rounding and turns as [`FreeMotion`] does. Under moments these are coordinates like others, in
//! which the scheme has its order and its stability.
//!
//! Moments of joints and weights are steady in space rather than in the body, and κ = K ω₀ turns the coordinates back against it. About
//! each axis K is the ratio of the smaller to the larger inertia about the two other ones. So coordinates of like inertias are those of
//! space, and a thin rod follows its axis without turning about it. No error of the large angular momentum across a thin rod
//! enters its own axis, where the small inertia would make a rotation of it.
//!
//! What the deck holds or drives in rotation, what moves in a plane, what has the same inertia about all axes, and what has one that no
//! body can have, turns like all other nodes. So do point masses and bodies that carry masses of dependent nodes: J is then not the inertia
//! of what turns, and its centre of mass is not the node.

use super::free_motion::{FreeMotion, FreeTurn};
use super::inertia::{ConsistentMass, Inertia};
use crate::constraints::rigid_link::RigidLink;
use crate::integrators::{Backward, Coefficients};
use crate::math::{Mat3, Vec3, Vec6, angular, rotation};
use crate::model::{AnalysisKind, Model};
use crate::snapshot::{Keep, Snapshot};
use crate::state::{Increment, Node};
use nalgebra::Quaternion;
use std::iter::{Peekable, Zip};
use std::slice::Iter;

/// The part of the largest principal inertia by which those of a body that turns steadily may differ.
const ALIKE: f64 = 1e-9;

/// A body whose rotation is counted from its free rotation.
#[derive(Debug, Clone)]
pub struct TurningBody {
    /// The node.
    pub node: usize,
    free: FreeMotion,
    /// K, in body axes.
    unwinding: Mat3,
}

/// The free rotation of a body up to an instant, with the axes of its coordinates there.
#[derive(Debug, Clone, Copy)]
struct FreeAxes {
    free: FreeTurn,
    /// κ.
    kappa: Vec3,
    /// exp(−t κ).
    unwound: Mat3,
}

/// What the rotation of a body starts from in a stage, in the axes of the body there, and its free rotation to the instant of equilibrium.
#[derive(Debug, Clone, Copy)]
pub struct TurningStart {
    /// The rotation of the body.
    R: Mat3,
    at_instant: FreeAxes,
    /// What stands in place of χ̇₀ and χ̈₀, as the scheme uses them.
    given: [Vec3; 2],
    /// χ̈₀' of the start of the step, where the scheme uses another one.
    own: Vec3,
}

/// A motion of the coordinates: χ, χ̇, χ̈.
type Coordinates = [Vec3; 3];

impl Keep for TurningStart {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let TurningStart { R, at_instant: FreeAxes { free, kappa, unwound }, given, own } = self;
        let FreeTurn { turn, omega, alpha } = free;
        [R, unwound].into_iter().for_each(|matrix| matrix.keep(snapshot));
        turn.keep(snapshot);
        given.iter_mut().chain([own, kappa, omega, alpha]).for_each(|vector| vector.keep(snapshot));
    }

    fn blank() -> Option<Self> {
        let zero = Vec3::zeros();
        let free = FreeTurn { turn: Quaternion::identity(), omega: zero, alpha: zero };
        let at_instant = FreeAxes { free, kappa: zero, unwound: Mat3::zeros() };
        Some(TurningStart { R: Mat3::zeros(), at_instant, given: [zero; 2], own: zero })
    }
}

impl FreeAxes {
    /// The coordinates of a body that has turned by `turn` since the start of the step, in axes of the body there.
    fn coordinates(&self, turn: &Quaternion<f64>) -> Vec3 {
        self.unwound.tr_mul(&rotation::log(&(self.free.turn.conjugate() * turn)))
    }

    /// φ and its rates from those of the coordinates.
    fn departure(&self, [x, d, dd]: &Coordinates) -> [Vec3; 3] {
        let kappa = &self.kappa;
        let [x, d, dd] = [x, d, dd].map(|vector| self.unwound * vector);
        let turned = kappa.cross(&x);
        [x, d - turned, dd - 2.0 * kappa.cross(&d) + kappa.cross(&turned)]
    }

    /// The angular velocity and acceleration, in axes of the body at hand.
    fn rates(&self, motion: &Coordinates) -> [Vec3; 2] {
        let [x, d, dd] = self.departure(motion);
        // From the body it is space that turns, by −φ.
        let (w, dw) = rotation::rates(&-x, &-d, &-dd);
        let seen = rotation::exp(&-x);
        let [omega, alpha] = [self.free.omega, self.free.alpha].map(|v| v + rotation::change(&seen, &v));
        [omega - w, alpha - dw + w.cross(&omega)]
    }

    /// The inverse of [`FreeAxes::rates`] where the body has the coordinates `x`.
    fn motion(&self, x: &Vec3, [omega, alpha]: &[Vec3; 2]) -> Coordinates {
        let phi = self.unwound * x;
        let seen = rotation::exp(&-phi);
        let [free, acceleration] = [self.free.omega, self.free.alpha].map(|v| v + rotation::change(&seen, &v));
        let w = free - omega;
        let (d, dd) = rotation::vector_rates(&-phi, &w, &(acceleration - alpha + w.cross(&free)));
        let turned = self.kappa.cross(&phi);
        let d = turned - d;
        let dd = 2.0 * self.kappa.cross(&d) - self.kappa.cross(&turned) - dd;
        [*x, self.unwound.tr_mul(&d), self.unwound.tr_mul(&dd)]
    }
}

impl TurningStart {
    /// The motion of the coordinates at the instant of equilibrium, where the body has turned by `turn`.
    fn motion(&self, turn: &Quaternion<f64>, scheme: &Coefficients) -> Coordinates {
        let x = self.at_instant.coordinates(turn);
        let ([r1, r2, r3], [a1, a2, a3, a4]) = (scheme.rate, scheme.acceleration);
        let [d, dd] = self.given;
        [x, x * r1 + d * r2 + dd * r3, x * a1 + d * a2 + dd * a3 + self.own * a4]
    }

    /// Writes the rates of the rotation vector of the step, whose quaternion in axes of the body at the start is `turn`.
    fn write(&self, theta: &Vec3, turn: &Quaternion<f64>, rates: [Vec3; 2], increment: &mut Increment) {
        let [omega, alpha] = rates.map(|v| self.R * (v + rotation::change(turn, &v)));
        let (d, dd) = rotation::vector_rates(theta, &omega, &alpha);
        set(&mut increment.d, &d);
        set(&mut increment.dd, &dd);
    }
}

impl TurningBody {
    /// The bodies of a model that turn so, in ascending order of nodes; their inertias are marked.
    pub fn of(
        model: &Model,
        (inertias, consistent): (&mut [Inertia], &[ConsistentMass]),
        links: &[RigidLink],
        plane: Option<usize>,
    ) -> Vec<TurningBody> {
        if model.analysis.kind != AnalysisKind::Dynamic || plane.is_some() {
            return Vec::new();
        }
        let carries = carriers(model.nodes.len(), (inertias, consistent), links);
        let held = |node: usize| model.constraints.restraints.iter().any(|held| held.node == node && held.dof > 2);
        let follows = |node: usize| links.iter().any(|link| link.node == node && link.dofs[3..].contains(&true));
        let is_body = |node: usize| model.bodies.iter().any(|body| body.node == node);
        let turning = |inertia: &mut Inertia| {
            let Inertia { node, J0, .. } = *inertia;
            if !is_body(node) || carries[node] || held(node) || follows(node) || turns_steadily(&J0) {
                return None;
            }
            let free = FreeMotion::new(&J0)?;
            inertia.free = Some(Box::new(free.clone()));
            Some(TurningBody { node, unwinding: free.unwinding(), free })
        };
        inertias.iter_mut().filter_map(turning).collect()
    }

    /// The body at a node with what it starts from, where nodes are asked for in ascending order; bodies at nodes that are not asked for
    /// do not move.
    pub fn next_at<'a>(
        bodies: &mut Peekable<Zip<Iter<'a, TurningBody>, Iter<'a, TurningStart>>>,
        node: usize,
    ) -> Option<(&'a TurningBody, &'a TurningStart)> {
        while bodies.next_if(|(body, _)| body.node < node).is_some() {}
        bodies.next_if(|(body, _)| body.node == node)
    }

    /// What a step from `node` starts from, where the scheme takes `alpha` for the angular acceleration.
    pub fn start(&self, node: &Node, alpha: &Vec3, scheme: &Coefficients) -> TurningStart {
        let R = node.R();
        let given = [Vec3::zeros(), self.relative_acceleration(node, alpha)];
        let own =
            if scheme.acceleration[3] == 0.0 { Vec3::zeros() } else { self.relative_acceleration(node, &node.alpha) };
        TurningStart { R, at_instant: self.free_axes(node, scheme.ahead()), given, own }
    }

    /// What a second stage from `node` starts from; `given` stands in place of the rates of the coordinates at its start.
    pub fn start_of_stage(&self, node: &Node, given: [Vec3; 2], scheme: &Coefficients) -> TurningStart {
        let at_instant = self.free_axes(node, scheme.ahead());
        TurningStart { R: node.R(), at_instant, given, own: Vec3::zeros() }
    }

    /// What stands in place of the rates of the coordinates in a second stage from `between`, which looks back by `ahead` to the start
    /// of the step.
    pub fn look_back(&self, between: &Node, (start, ahead): (&Node, f64), backward: &Backward) -> [Vec3; 2] {
        let axes = self.free_axes(between, -ahead);
        let turn = between.rotation.conjugate() * start.rotation;
        let omega = start.R().tr_mul(&start.omega);
        let [x, d, _] = axes.motion(&axes.coordinates(&turn), &[omega, Vec3::zeros()]);
        [x * -backward.start, d * backward.start]
    }

    /// Writes the rates of the rotation vector in `increment`, at the instant of equilibrium.
    #[inline]
    pub fn differentiate(&self, start: &TurningStart, increment: &mut Increment, scheme: &Coefficients) {
        let theta = angular(&increment.q);
        let turn = rotation::exp(&start.R.tr_mul(&theta));
        let rates = start.at_instant.rates(&start.motion(&turn, scheme));
        start.write(&theta, &turn, rates, increment);
    }

    /// Writes the rotation vector and its rates in `end`, at the end of a step that begins at `node`.
    pub fn finish(
        &self,
        (node, start): (&Node, &TurningStart),
        at_instant: &Increment,
        end: &mut Increment,
        scheme: &Coefficients,
    ) {
        if scheme.instant == 1.0 {
            set(&mut end.q, &angular(&at_instant.q));
            set(&mut end.d, &angular(&at_instant.d));
            set(&mut end.dd, &angular(&at_instant.dd));
            return;
        }
        let [x, _, there] = start.motion(&rotation::exp(&start.R.tr_mul(&angular(&at_instant.q))), scheme);
        let [d, dd] = start.given;
        let motion =
            scheme.end.map(|[of_q, of_d, of_dd, of_there]| x * of_q + d * of_d + dd * of_dd + there * of_there);
        let axes = self.free_axes(node, scheme.ahead() / scheme.instant);
        let turn = axes.free.turn * rotation::exp(&(axes.unwound * motion[0]));
        let theta = start.R * rotation::log(&turn);
        set(&mut end.q, &theta);
        start.write(&theta, &turn, axes.rates(&motion), end);
    }

    /// The acceleration that a scheme takes from the end of a step into the next one, global components: that of the coordinates is
    /// the sum, by `weights`, of the one that it took from the step before, `before`, and those at both ends.
    pub fn algorithmic_acceleration(
        &self,
        start: &TurningStart,
        (node, end): (&Node, &Node),
        before: &Vec3,
        [of_before, of_start, of_end]: [f64; 3],
    ) -> Vec3 {
        let (axes, R) = (&start.at_instant, end.R());
        let x = axes.coordinates(&(node.rotation.conjugate() * end.rotation));
        let [x, d, dd] = axes.motion(&x, &[&end.omega, &end.alpha].map(|v| R.tr_mul(v)));
        let dd = self.relative_acceleration(node, before) * of_before
            + self.relative_acceleration(node, &node.alpha) * of_start
            + dd * of_end;
        let [_, alpha] = axes.rates(&[x, d, dd]);
        R * alpha
    }

    /// The free rotation that goes on from `node` for a time `dt`.
    fn free_axes(&self, node: &Node, dt: f64) -> FreeAxes {
        let omega = node.R().tr_mul(&node.omega);
        let kappa = self.unwinding * omega;
        let unwound = rotation::matrix(&rotation::exp(&(-dt * kappa)));
        FreeAxes { free: self.free.after(&omega, dt), kappa, unwound }
    }

    /// The angular acceleration less that of free rotation, in axes of the body.
    fn relative_acceleration(&self, node: &Node, alpha: &Vec3) -> Vec3 {
        let R = node.R();
        R.tr_mul(alpha) - self.free.acceleration(&R.tr_mul(&node.omega))
    }
}

/// Which nodes carry masses of dependent nodes; `links` as they are sorted, masters first.
fn carriers(nodes: usize, (inertias, consistent): (&[Inertia], &[ConsistentMass]), links: &[RigidLink]) -> Vec<bool> {
    let mut massive = vec![false; nodes];
    let of_elements = consistent.iter().flat_map(|element| &element.nodes);
    inertias.iter().map(|inertia| &inertia.node).chain(of_elements).for_each(|&node| massive[node] = true);
    let mut carries = vec![false; nodes];
    for link in links.iter().rev() {
        carries[link.master] |= massive[link.node] || carries[link.node];
    }
    carries
}

/// Writes the angular part of six components.
fn set(of: &mut Vec6, angular: &Vec3) {
    (0..3).for_each(|i| of[3 + i] = angular[i]);
}

/// True where the principal inertias are alike, or none: such a body turns steadily when it is free.
fn turns_steadily(J0: &Mat3) -> bool {
    let J = J0.symmetric_eigenvalues();
    J.max() - J.min() <= ALIKE * J.amax()
}
