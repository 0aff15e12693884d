//! The rotation of a rigid body on which nothing acts but its own angular momentum ℓ.
//!
//! With inverse principal inertias iₐ, i_b, i_c the energy is the sum of two terms. The first, `½ i_c ℓ² + ½ (iₐ − i_c) ℓₐ²`, belongs to a
//! body of revolution about a, with a known closed-form motion. The second, `½ (i_b − i_c) ℓ_b²`, turns the body about b alone. Half of the
//! second, the first and half of the second form a symmetric step. It keeps ℓ and is exact for bodies of revolution (A. Dullweber, B.
//! Leimkuhler & R. McLachlan, J. Chem. Phys. 107 (1997)); b and c are the two axes that are nearest to one another.

use crate::tolerances::free_rotation::NEGLIGIBLE;
use base::math::{Mat3, Vec3, rotation};
use nalgebra::{Quaternion, SymmetricEigen};

/// Principal axes and inverse inertias of a body. Axes are those of the body, global at t = 0.
#[derive(Debug, Clone)]
pub struct FreeRotation {
    /// a, b, c.
    axes: [Vec3; 3],
    inverse: [f64; 3],
}

impl FreeRotation {
    /// `J0`: the inertia about the point that the body turns about.
    pub fn new(J0: &Mat3) -> Self {
        let SymmetricEigen { eigenvectors, eigenvalues } = J0.symmetric_eigen();
        let largest = eigenvalues.amax();
        let mut principal: Vec<(f64, Vec3)> = eigenvalues
            .iter()
            .zip(eigenvectors.column_iter())
            .map(|(&J, axis)| (if J > NEGLIGIBLE * largest { 1.0 / J } else { 0.0 }, axis.into_owned()))
            .collect();
        principal.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The middle one is c; the farther of its neighbours is a.
        if principal[1].0 - principal[0].0 < principal[2].0 - principal[1].0 {
            principal.reverse();
        }
        let [a, c, b] = [principal[0], principal[1], principal[2]];
        FreeRotation { axes: [a.1, b.1, c.1], inverse: [a.0, b.0, c.0] }
    }

    /// The rotation vector, global components, of a body at `start` with angular momentum `l` over the time `dt`.
    pub fn turn(&self, start: &Quaternion<f64>, l: &Vec3, dt: f64) -> Vec3 {
        let [a, b, _] = &self.axes;
        let [i_a, i_b, i_c] = self.inverse;
        let along = |q: &Quaternion<f64>, axis: &Vec3| (l + rotation::change(&q.conjugate(), l)).dot(axis);
        let about = |q: Quaternion<f64>, axis: &Vec3, rate: f64, dt: f64| match rate {
            0.0 => q,
            _ => q * rotation::exp(&(dt * rate * along(&q, axis) * axis)),
        };
        let mut q = about(*start, b, i_b - i_c, 0.5 * dt);
        q = about(q, a, i_a - i_c, dt);
        q = rotation::exp(&(dt * i_c * l)) * q;
        q = about(q, b, i_b - i_c, 0.5 * dt);
        rotation::log(&(q * start.conjugate()))
    }
}
