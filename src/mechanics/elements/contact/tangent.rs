//! The derivatives of the force on a point, for the tangent.

use super::force::{ContactForce, touch};
use super::kinematics::{ContactKinematics, Contacts};
use super::point::ContactPoint;
use crate::state::Configuration;
use base::math::rotation::inverse_tangent_matrix;
use base::math::{Mat3, Vec3, skew};

/// Derivatives of force and moment on a point with respect to a motion, global components.
type Derivative = (Mat3, Mat3);

/// Derivatives of force and moment on a point.
struct Derivatives {
    /// Derivative with respect to the position of the point.
    by_x: Derivative,
    /// Derivative with respect to the rotation of the carrier, with the point at rest.
    by_turn: Derivative,
    /// Derivative with respect to φ, the rotation of the point relative to the surface.
    by_phi: Derivative,
}

/// Tangent of point `e`: K ← ∂f/∂(x, θ) + `rate_weight` · ∂f/∂(v, ω), f the internal force, which is opposite to the force on
/// the point. Row-major, six directions for each of the point's nodes and the carrier.
pub(super) fn tangent(contacts: &Contacts, e: usize, now: &Configuration, rate_weight: f64, K: &mut [f64]) {
    let Some((at, acting)) = touch(contacts, e, now) else { return };
    let (point, count) = (&contacts.points[e], contacts.count);
    let omega = &now.nodes[contacts.carrier].omega;
    let Derivatives { by_x, mut by_turn, by_phi } = derivatives(point, &at, &acting, omega, rate_weight);
    let f = at.R * acting.F;
    let mut block = Tangent { K, point, count, D: skew(&at.d) };
    for k in 0..count {
        let weight = point.weights[k];
        // The moment d × f on the carrier changes with d too.
        block.put(6 * k, &(weight * by_x.0, weight * by_x.1), &(-weight * skew(&f)));
        if acting.friction.is_some() && point.rolling_radius > 0.0 {
            let old = contacts.memory(e, now.history);
            let phi = contacts.rotation_since(point, k, old, now.nodes);
            let T = at.R * inverse_tangent_matrix(&phi) * at.R.transpose();
            let by_own = (weight * by_phi.0 * T, weight * by_phi.1 * T);
            block.put(6 * k + 3, &by_own, &Mat3::zeros());
            by_turn.0 -= by_own.0;
            by_turn.1 -= by_own.1;
        }
    }
    block.put(6 * count, &(-by_x.0, -by_x.1), &skew(&f));
    block.put(6 * count + 3, &by_turn, &Mat3::zeros());
}

fn derivatives(
    point: &ContactPoint,
    at: &ContactKinematics,
    acting: &ContactForce,
    omega: &Vec3,
    rate_weight: f64,
) -> Derivatives {
    let ContactKinematics { R, d, w, closest, .. } = at;
    let ContactForce { normal: push, friction, F, M } = acting;
    let (n, H) = (&closest.n, &closest.H);
    let (f, m, normal) = (R * F, R * M, R * n);

    // δF and δM by δp and δN, in the frame of the surface.
    let mut F_p = push.force * H;
    let mut M_p = Mat3::zeros();
    let (mut F_N, mut M_N) = (*n, Vec3::zeros());
    let (mut F_phi, mut M_phi) = (Mat3::zeros(), Mat3::zeros());
    if let Some(friction) = friction {
        let r = point.rolling_radius;
        let rolling_arm = r * skew(n);
        F_p -= friction.by_p;
        M_p += rolling_arm * friction.by_p - r * skew(&friction.T) * H;
        F_N -= friction.by_N;
        M_N += rolling_arm * friction.by_N;
        F_phi -= friction.by_phi;
        M_phi += rolling_arm * friction.by_phi;
    }
    // δN = by_depth δ(δ) + by_rate δ(δ̇), with δ̇ = −n·w and w = v − v_s − ω_s × d.
    let N_p = R * (-push.by_depth * n - push.by_rate * (H * R.tr_mul(w)));
    let c = push.by_rate;
    let N_x = N_p - c * (rate_weight * normal - normal.cross(omega));
    let N_turn = -d.cross(&N_p) + c * (rate_weight * d.cross(&normal) - normal.cross(w));
    let turned = |A: &Mat3| R * A * R.transpose();
    let (F_p, M_p, F_phi, M_phi) = (turned(&F_p), turned(&M_p), turned(&F_phi), turned(&M_phi));
    let (F_N, M_N) = (R * F_N, R * M_N);
    let D = skew(d);
    Derivatives {
        by_x: (F_p + F_N * N_x.transpose(), M_p + M_N * N_x.transpose()),
        by_turn: (F_p * D + F_N * N_turn.transpose() - skew(&f), M_p * D + M_N * N_turn.transpose() - skew(&m)),
        by_phi: (F_phi, M_phi),
    }
}

/// The tangent of a point while it is filled.
struct Tangent<'a> {
    K: &'a mut [f64],
    point: &'a ContactPoint,
    count: usize,
    /// Cross product with the arm from the carrier to the point.
    D: Mat3,
}

impl Tangent<'_> {
    /// Adds three columns: the force goes to the nodes of the point by their weights, and in full to the carrier. `extra`: what else
    /// changes of the moment on the carrier.
    fn put(&mut self, column: usize, (A, B): &Derivative, extra: &Mat3) {
        for k in 0..self.count {
            let weight = self.point.weights[k];
            self.add(6 * k, column, &(-weight * A));
            if self.point.rolling_radius > 0.0 {
                self.add(6 * k + 3, column, &(-weight * B));
            }
        }
        self.add(6 * self.count, column, A);
        self.add(6 * self.count + 3, column, &(self.D * A + B + extra));
    }

    fn add(&mut self, row: usize, column: usize, block: &Mat3) {
        let width = 6 * (self.count + 1);
        for i in 0..3 {
            for j in 0..3 {
                self.K[(row + i) * width + column + j] += block[(i, j)];
            }
        }
    }
}
