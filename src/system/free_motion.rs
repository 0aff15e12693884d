//! The rotation of a rigid body on which no moment acts, from its angular velocity.
//!
//! With principal inertias A, B, C about the axes a, b, c the energy is that of a body of revolution about a, with C in place of B, and
//! ½ (1/B − 1/C) (B Ω_b)², which turns the body about b alone. Half of the second, the first and half of the second again are a symmetric
//! step that keeps the angular momentum and is exact for bodies of revolution (A. Dullweber, B. Leimkuhler & R. McLachlan,
//! J. Chem. Phys. 107 (1997)); five of them make a step of fourth order (M. Suzuki, Phys. Lett. A 146 (1990)); b and c are the two axes
//! whose inertias are nearest to one another.
//!
//! Angular velocities are carried in place of momenta. Only ratios of inertias enter, and of a body none exceeds one: nothing is divided
//! by the inertia of a thin rod about its own axis, which the rounding of its momentum would exceed.

use crate::math::{Mat3, Vec3, rotation};
use nalgebra::{Quaternion, SymmetricEigen};

/// The part by which rounding may make the largest principal inertia exceed the sum of the two others.
const ROUNDING: f64 = 1e-9;

/// Parts of a step of fourth order.
const PARTS: [f64; 5] = [SUZUKI, SUZUKI, 1.0 - 4.0 * SUZUKI, SUZUKI, SUZUKI];

/// 1/(4 − ∛4).
const SUZUKI: f64 = 0.414_490_771_794_375_7;

/// Principal axes and ratios of inertias of a body.
#[derive(Debug, Clone)]
pub struct FreeMotion {
    /// The axes a, b, c as columns, in axes of the body that are global at t = 0.
    axes: Mat3,
    /// A/C and B/C.
    over_c: [f64; 2],
    /// The coefficients of Euler's equations: (B − C)/A, (C − A)/B, (A − B)/C.
    euler: Vec3,
}

/// The rotation of a body from where its free motion begins, with its angular velocity and acceleration, in axes of the body.
#[derive(Debug, Clone, Copy)]
pub struct FreeTurn {
    /// The rotation from the axes at the start to those of the body.
    pub turn: Quaternion<f64>,
    /// Angular velocity.
    pub omega: Vec3,
    /// Angular acceleration.
    pub alpha: Vec3,
}

impl FreeMotion {
    /// `None` for an inertia tensor that no body can have: of such a one the acceleration of free rotation may exceed the square of
    /// the angular velocity. `None` too for one without inertia.
    pub fn new(J0: &Mat3) -> Option<FreeMotion> {
        let SymmetricEigen { eigenvectors, eigenvalues } = J0.symmetric_eigen();
        let mut principal: Vec<(f64, Vec3)> =
            eigenvalues.iter().zip(eigenvectors.column_iter()).map(|(&J, axis)| (J, axis.into_owned())).collect();
        principal.sort_by(|one, other| one.0.total_cmp(&other.0));
        let [least, middle, largest] = [principal[0].0, principal[1].0, principal[2].0];
        if least < -ROUNDING * largest || largest > (least + middle) * (1.0 + ROUNDING) || largest <= 0.0 {
            return None;
        }
        // The middle one is c; of the others, the farther is a.
        if largest * (middle - least) < least * (largest - middle) {
            principal.reverse();
        }
        let [(A, a), (C, c), (B, b)] = [principal[0], principal[1], principal[2]];
        let A = A.max(0.0);
        // What exceeds the sum of the others is rounding.
        let B = B.clamp(C - A, C + A);
        let b = if a.cross(&b).dot(&c) < 0.0 { -b } else { b };
        let ratio = |difference: f64, over: f64| if over > 0.0 { difference / over } else { 0.0 };
        Some(FreeMotion {
            axes: Mat3::from_columns(&[a, b, c]),
            over_c: [A / C, B / C],
            euler: Vec3::new(ratio(B - C, A), ratio(C - A, B), ratio(A - B, C)),
        })
    }

    /// The angular acceleration J₀⁻¹ (J₀ Ω×Ω), in axes of the body.
    pub fn acceleration(&self, omega: &Vec3) -> Vec3 {
        let w = self.axes.tr_mul(omega);
        self.axes * self.euler.component_mul(&Vec3::new(w.y * w.z, w.z * w.x, w.x * w.y))
    }

    /// The matrix, in axes of the body, that takes from its angular velocity about each axis the part by which moments of like
    /// inertias are seen from space: the ratio of the smaller to the larger inertia about the two other axes.
    pub fn unwinding(&self) -> Mat3 {
        let [a, b] = self.over_c;
        let like = |one: f64, other: f64| one.min(other) / one.max(other);
        self.axes * Mat3::from_diagonal(&Vec3::new(like(b, 1.0), like(a, 1.0), like(a, b))) * self.axes.transpose()
    }

    /// The motion a time `dt` after one with the angular velocity `omega`.
    pub fn after(&self, omega: &Vec3, dt: f64) -> FreeTurn {
        let mut w = self.axes.tr_mul(omega);
        let mut turn = Quaternion::identity();
        if self.over_c[1] == 1.0 {
            self.revolve(&mut turn, &mut w, dt);
        } else {
            for part in PARTS {
                let h = part * dt;
                self.swing(&mut turn, &mut w, 0.5 * h);
                self.revolve(&mut turn, &mut w, h);
                self.swing(&mut turn, &mut w, 0.5 * h);
            }
        }
        let axis = self.axes * turn.imag();
        let turn = rotation::renormalise(&Quaternion::from_parts(turn.w, axis));
        let omega = self.axes * w;
        FreeTurn { turn, omega, alpha: self.acceleration(&omega) }
    }

    /// The motion of a body of revolution about a with C in place of B: precession about the angular momentum, and spin about a.
    fn revolve(&self, turn: &mut Quaternion<f64>, w: &mut Vec3, h: f64) {
        let [a, b] = self.over_c;
        let spin = h * (1.0 - a) * w.x;
        let precession = h * Vec3::new(a * w.x, b * w.y, w.z);
        *turn = *turn * rotation::exp(&precession) * rotation::exp(&Vec3::new(spin, 0.0, 0.0));
        let (sin, cos) = spin.sin_cos();
        *w = Vec3::new(w.x, cos * w.y + sin * w.z / b, cos * w.z - sin * b * w.y);
    }

    /// The rotation about b by its share of the energy.
    fn swing(&self, turn: &mut Quaternion<f64>, w: &mut Vec3, h: f64) {
        let [a, b] = self.over_c;
        let way = h * w.y;
        let angle = (1.0 - b) * way;
        *turn *= rotation::exp(&Vec3::new(0.0, angle, 0.0));
        let (sin, cos) = angle.sin_cos();
        // sin(β)/β C/A β, finite where A vanishes.
        let whole = if angle == 0.0 { 1.0 } else { sin / angle };
        *w = Vec3::new(cos * w.x + whole * way * self.euler.x * w.z, w.y, cos * w.z + sin * a * w.x);
    }
}
