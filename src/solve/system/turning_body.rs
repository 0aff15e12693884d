//! The rotation of a rigid body within a step of an implicit scheme.
//!
//! In the coordinates of a rotation vector a freely turning body has an acceleration. A scheme that treats it as a motion generates or
//! dissipates energy. The relation of the scheme between velocities and accelerations is therefore applied to the angular momentum `π = J
//! ω` in space, which no moment of the body's inertia changes. Its relation between rotation vectors and their rates is made exact to third
//! order for the acceleration g of the rotation vector of a body without moments:
//!
//! `Θ̇ = r₁ Θ + r₂ ω₀ + r₃ α₀ + κ (g(Θ, Θ̇) − g₀), ω = T Θ̇, π̇ = e₁ J ω + e₂ π₀ + e₃ π̇₀, α = J⁻¹ (π̇ − ω×π)`.
//!
//! About a thin axis the error of the momenta across it, divided by its small inertia, would become spin. There the scheme is therefore
//! applied to the angular velocity in body axes, without division by inertia:
//!
//! Ω̇ᵢ = wᵢ (J⁻¹ (Rᵀπ̇ − Ω×JΩ))ᵢ + (1 − wᵢ) (e₁ Ω + e₂ Ω₀ + e₃ Ω̇₀)ᵢ, wᵢ = min(1, Jᵢ / 0.1 J_max)².
//!
//! Both are of second order. If no axis is thin, a free body keeps its angular momentum to rounding, and the error of its rotation is of
//! third order or higher. Under moments order and stability are those of the scheme. T and Θ̇ are those of [`rotation`]. Momentum in space:
//! J. C. Simo, K. K. Wong, Int. J. Numer. Meth. Engng 31 (1991).
//!
//! Other bodies turn like all other nodes: with restrained or driven rotations, in plane motion, with equal principal inertias, or with
//! impossible ones. Point masses and bodies with masses of dependent nodes do too, because the node is then not the centre of the turning
//! mass. The rule would dissipate more energy than the rule of other nodes.

use super::inertia::{ConsistentMass, Inertia};
use crate::tolerances::turning_body::{NEGLIGIBLE, PASSES, ROUNDING, THIN};
use base::math::{Mat3, Vec3, Vec6, angular, rotation};
use base::snapshot::{Keep, Snapshot};
use mechanics::constraints::rigid_link::RigidLink;
use mechanics::integrators::Coefficients;
use mechanics::state::{Increment, Node};
use model::{AnalysisKind, Body, Model};
use nalgebra::SymmetricEigen;
use std::collections::HashSet;
use std::iter::Peekable;
use std::slice::Iter;

/// A body that turns by its angular momentum.
#[derive(Debug, Clone)]
pub struct TurningBody {
    /// The node.
    pub node: usize,
    /// The inertia tensor about the node, in body axes, which are global at t = 0, and its inverse.
    J0: Mat3,
    J0_inverse: Mat3,
    /// The angular acceleration by the rate of angular momentum in space, less the gyroscopic moment: W J₀⁻¹, in body axes.
    by_momentum: Mat3,
    /// The part I − W of the angular acceleration, from angular velocities in body axes; `None` if no axis is thin.
    own: Option<Mat3>,
}

/// The start values of the rotation of a body in a stage, in body axes there. Seen from the body it is space that turns, by −Θ: vectors of
/// the motion have the opposite sign.
#[derive(Debug, Clone, Copy)]
pub struct TurningStart {
    /// The rotation of the body.
    R: Mat3,
    /// Start values of −ω₀ and −α₀ in the relation of the scheme between rotation vectors and their rates.
    omega: Vec3,
    alpha: Vec3,
    /// The part e₂ π₀ + e₃ π̇₀ of π̇.
    momentum: Vec3,
    /// The part e₂ Ω₀ + e₃ Ω̇₀ of Ω̇ in axes of the body.
    own: Vec3,
    /// −g₀.
    free: Vec3,
}

impl Keep for TurningStart {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let TurningStart { R, omega, alpha, momentum, own, free } = self;
        R.keep(snapshot);
        [omega, alpha, momentum, own, free].into_iter().for_each(|vector| vector.keep(snapshot));
    }

    fn blank() -> Option<Self> {
        let zero = Vec3::zeros();
        Some(TurningStart { R: Mat3::zeros(), omega: zero, alpha: zero, momentum: zero, own: zero, free: zero })
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
        let held = model.constraints.restraints.iter().filter(|held| held.dof > 2).map(|held| held.node);
        let follow = links.iter().filter(|link| link.dofs[3..].contains(&true)).map(|link| link.node);
        let led: HashSet<usize> = held.chain(follow).collect();
        let is_body = |node: usize| Body::at(&model.bodies, node).is_some();
        let turning = |inertia: &mut Inertia| {
            let Inertia { node, J0, .. } = *inertia;
            let alone = |node: usize| is_body(node) && !carries[node] && !led.contains(&node);
            let J0_inverse = inverse_of_a_body(&J0).filter(|_| alone(node))?;
            let (own, by_momentum) = about_thin_axes(&J0).unzip();
            inertia.turns = true;
            inertia.own = own.map(Box::new);
            Some(TurningBody { node, J0, J0_inverse, by_momentum: by_momentum.unwrap_or(J0_inverse), own })
        };
        inertias.iter_mut().filter_map(turning).collect()
    }

    /// The body at a node; calls ascend in the nodes, and bodies at skipped nodes do not move.
    pub fn next_at<'a>(bodies: &mut Peekable<Iter<'a, TurningBody>>, node: usize) -> Option<&'a TurningBody> {
        while bodies.next_if(|body| body.node < node).is_some() {}
        bodies.next_if(|body| body.node == node)
    }

    /// The start values of a step from `node`, with `alpha` as angular acceleration of the scheme.
    pub fn start(&self, node: &Node, alpha: &Vec3, scheme: &Coefficients) -> TurningStart {
        let R = node.R();
        let [of_new, _, of_alpha, of_own] = scheme.of_velocities();
        let (omega, alpha) = (R.tr_mul(&node.omega), R.tr_mul(alpha));
        let momentum = self.J0 * omega;
        let rate = |alpha: &Vec3| self.J0 * alpha + omega.cross(&momentum);
        // A steady rotation has no acceleration: the weights of π₀ and π have equal magnitude, and their rounding errors would add up.
        let mut given = momentum * -of_new + rate(&alpha) * of_alpha;
        let mut own = omega * -of_new + alpha * of_alpha;
        if of_own != 0.0 {
            let at_start = R.tr_mul(&node.alpha);
            given += rate(&at_start) * of_own;
            own += at_start * of_own;
        }
        let free = -self.free_acceleration(&omega);
        TurningStart { R, omega: -omega, alpha: -alpha, momentum: given, own, free }
    }

    /// The start values of a second stage from `node`. `before` replaces the angular velocity, and `rates` its accelerations: the rate of
    /// the angular momentum, and of the angular velocity in body axes.
    pub fn start_of_stage(
        &self,
        node: &Node,
        before: &Vec3,
        [momentum, own]: [Vec3; 2],
        scheme: &Coefficients,
    ) -> TurningStart {
        let R = node.R();
        let weight = scheme.of_velocities()[2];
        let given = R.tr_mul(&momentum) * weight;
        let free = -self.free_acceleration(&R.tr_mul(&node.omega));
        TurningStart { R, omega: -R.tr_mul(before), alpha: Vec3::zeros(), momentum: given, own: own * weight, free }
    }

    /// Writes the rates of the rotation vector in `increment`, at the instant of equilibrium.
    #[inline]
    pub fn differentiate(&self, start: &TurningStart, increment: &mut Increment, scheme: &Coefficients) {
        let theta = -start.R.tr_mul(&angular(&increment.q));
        let chart = rotation::Chart::new(&theta);
        let [r1, r2, r3] = scheme.rate;
        let given = theta * r1 + start.omega * r2 + start.alpha * r3;
        let (mut d, mut motion) = (given, chart.rates(&given));
        if let Some(kappa) = scheme.turning.filter(|kappa| *kappa != 0.0) {
            for _ in 0..PASSES {
                let (omega, own) = motion;
                let free = chart.inverse(&(-self.free_acceleration(&omega) - own));
                d = given + kappa * (free - start.free);
                motion = chart.rates(&d);
            }
        }
        let (omega, own) = motion;
        let momentum = self.J0 * omega;
        let given = start.momentum + rotation::change(&rotation::exp(&theta), &start.momentum);
        let of_new = scheme.of_velocities()[0];
        let mut alpha = self.by_momentum * (given - momentum * of_new - omega.cross(&momentum));
        if let Some(own) = &self.own {
            alpha += own * (start.own - omega * of_new);
        }
        set(&mut increment.d, &(start.R * -d));
        set(&mut increment.dd, &(start.R * chart.inverse(&(alpha + own))));
    }

    /// Writes the rotation vector and its rates in `end`, at the end of a step that begins at `node`.
    pub fn finish(&self, node: &Node, at_instant: &Increment, end: &mut Increment, scheme: &Coefficients) {
        let theta = angular(&at_instant.q);
        if scheme.instant == 1.0 {
            set(&mut end.q, &theta);
            set(&mut end.d, &angular(&at_instant.d));
            set(&mut end.dd, &angular(&at_instant.dd));
            return;
        }
        let (omega, alpha) = rotation::rates(&theta, &angular(&at_instant.d), &angular(&at_instant.dd));
        let there = Node { rotation: rotation::exp(&theta) * node.rotation, omega, ..*node };
        let rate_there = self.momentum_rate(&there, &alpha);
        let rate = self.momentum_rate(node, &node.alpha);
        let [of_q, of_d, of_dd] = scheme.end;
        let rate_then = rate * of_dd[2] + rate_there * of_dd[3];
        let momentum_then = self.momentum(node) * of_d[1] + rate * of_d[2] + rate_there * of_d[3];
        // The rotation vector follows from the mean acceleration that gives the new velocity.
        let vector = |dd: &Vec3| theta * of_q[0] + node.omega * of_q[1] + node.alpha * of_q[2] + dd * of_q[3];
        let turned = |q: &Vec3| rotation::matrix(&rotation::renormalise(&(rotation::exp(q) * node.rotation)));
        let divided = |R: &Mat3, v: &Vec3| R * (self.by_momentum * R.tr_mul(v));
        let own = |R: &Mat3, v: Vec3| self.own.map_or_else(Vec3::zeros, |own| R * (own * v));
        let accelerations = [node.R().tr_mul(&node.alpha), there.R().tr_mul(&alpha)];
        let by_own = |of: [f64; 4]| accelerations[0] * of[2] + accelerations[1] * of[3];
        let own_then = node.R().tr_mul(&node.omega) * of_d[1] + by_own(of_d);
        // From the velocity at the start, which a steady rotation keeps to the last bit.
        let omega_then = |R: &Mat3| {
            let kept = R.tr_mul(&node.omega);
            node.omega + divided(R, &(momentum_then - R * (self.J0 * kept))) + own(R, own_then - kept)
        };
        let [a1, a2, a3, _] = scheme.acceleration;
        let mut q = vector(&(theta * a1 + node.omega * a2 + node.alpha * a3));
        for _ in 1..PASSES {
            let d = rotation::inverse_tangent(&q, &omega_then(&turned(&q)));
            q = vector(&((d - node.omega * of_d[1] - node.alpha * of_d[2]) / of_d[3]));
        }
        let R = turned(&q);
        let omega = omega_then(&R);
        let alpha = divided(&R, &(rate_then - omega.cross(&momentum_then))) + own(&R, by_own(of_dd));
        let (d, dd) = rotation::vector_rates(&q, &omega, &alpha);
        set(&mut end.q, &q);
        set(&mut end.d, &d);
        set(&mut end.dd, &dd);
    }

    /// The angular momentum about the node, global components.
    pub fn momentum(&self, node: &Node) -> Vec3 {
        let R = node.R();
        R * (self.J0 * R.tr_mul(&node.omega))
    }

    /// Its rate J α + ω×π at an angular acceleration.
    pub fn momentum_rate(&self, node: &Node, alpha: &Vec3) -> Vec3 {
        let R = node.R();
        R * (self.J0 * R.tr_mul(alpha)) + node.omega.cross(&(R * (self.J0 * R.tr_mul(&node.omega))))
    }

    /// The weighted sum of angular accelerations at different nodes, as an acceleration of the last node. It sums rates of angular momentum
    /// in space and, about thin axes, of angular velocities in body axes.
    pub fn combine(&self, rates: [(&Node, Vec3, f64); 3]) -> Vec3 {
        let [.., (last, ..)] = rates;
        let R = last.R();
        let rate = rates.iter().map(|(node, alpha, weight)| self.momentum_rate(node, alpha) * *weight).sum::<Vec3>();
        let mut alpha = self.by_momentum * R.tr_mul(&(rate - last.omega.cross(&self.momentum(last))));
        if let Some(own) = &self.own {
            alpha += own * rates.iter().map(|(node, alpha, weight)| node.R().tr_mul(alpha) * *weight).sum::<Vec3>();
        }
        R * alpha
    }

    /// The angular acceleration J₀⁻¹ (J₀ Ω×Ω) of a body on which no moment acts, in body axes.
    fn free_acceleration(&self, omega: &Vec3) -> Vec3 {
        self.J0_inverse * (self.J0 * omega).cross(omega)
    }
}

/// The nodes that carry masses of dependent nodes; `links` are sorted, masters first.
pub fn carriers(
    nodes: usize,
    (inertias, consistent): (&[Inertia], &[ConsistentMass]),
    links: &[RigidLink],
) -> Vec<bool> {
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

/// The inverse of a physically possible inertia tensor: no principal inertia vanishes or exceeds the sum of the others. This bounds the
/// acceleration of free rotation by ω². Also `None` for equal principal inertias, since such a free body turns steadily.
fn inverse_of_a_body(J0: &Mat3) -> Option<Mat3> {
    let mut J = J0.symmetric_eigenvalues();
    J.as_mut_slice().sort_by(f64::total_cmp);
    let largest = J[2];
    let is_body = J[0] > NEGLIGIBLE * largest && largest <= (J[0] + J[1]) * (1.0 + ROUNDING);
    let is_sphere = largest - J[0] <= ROUNDING * largest;
    J0.try_inverse().filter(|_| is_body && !is_sphere)
}

/// The part I − W of accelerations from angular velocities in axes of the body, and W J₀⁻¹ of those from the momentum in space. W has the
/// principal axes of the body and is 1 above [`THIN`] of the largest inertia. `None` where no axis is thin.
///
/// W is proportional to the squared inertia, so W J₀⁻¹ is bounded and vanishes with the inertia.
fn about_thin_axes(J0: &Mat3) -> Option<(Mat3, Mat3)> {
    let SymmetricEigen { eigenvectors, eigenvalues } = J0.symmetric_eigen();
    let largest = eigenvalues.max();
    let share = |J: f64| (J / (THIN * largest)).clamp(0.0, 1.0).powi(2);
    let along = |parts: &Vec3| eigenvectors * Mat3::from_diagonal(parts) * eigenvectors.transpose();
    let own = eigenvalues.map(|J| 1.0 - share(J));
    (own.max() > 0.0).then(|| (along(&own), along(&eigenvalues.map(|J| share(J) / J))))
}
