//! The membrane strains of a triangle of six nodes whose stress is not in equilibrium, softened.
//!
//! Strains in the plane are linear within the triangle, ε = ε₀ + the differences between its three points, and so is their elastic stress
//! σ = C ε. Two of the nine numbers that describe it are the body forces div σ that it would need. An interior displacement b λ, with a
//! bubble b that is zero on the sides, would take them away: the work of any linear stress on its strain is −λ·div σ ∫ b. Of a linear
//! strain field only
//!
//! ```text
//!  r_p = sym(∇N_p ⊗ λ)/w_p,    N_p = 1 at the point p and 0 at the other two,
//! ```
//!
//! with the weights w_p of the points does that. Eliminating λ would leave two motions without stiffness, those whose strain is such
//! a field. The part of the strain that is one, measured by elastic energy, is therefore not taken away, but by so much that of
//! its energy the part [`UNBALANCED`] is left. Even strains, and linear ones in equilibrium, have none of it and stay what they are.
//!
//! A cantilever under a force at its end needs a displacement of third degree: the cantilever of R. H. MacNeal & R. L. Harder (Finite
//! Elem. Anal. Des. 1, 1985) in its plane, 6 x 1 pairs of triangles, rectangles, trapezoids and parallelograms, comes to 0.983, 0.961 and
//! 0.952 of its deflection with 1 in place of [`UNBALANCED`], to 0.993, 0.989 and 0.986 with 0.1, and 0.994, 0.994 and 0.991 with 0.01.

use super::surface::CurvedPoint;
use crate::elements::shell::plane_strains::PointStrains;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, SMatrix};
use std::array::from_fn;

/// The part of the energy of stresses that are not in equilibrium that is left.
const UNBALANCED: f64 = 0.1;

/// Slopes along r and s of the three linear functions that are 1 at one integration point and 0 at the others.
const SLOPES: [[f64; 2]; 3] = [[-2.0, -2.0], [2.0, 0.0], [0.0, 2.0]];

/// Softens the membrane strains of a triangle at its three points, with plane stress `C`.
pub(super) fn soften<const P: usize>(strains: &mut [PointStrains<P, P>], points: &[CurvedPoint; 3], C: &Matrix3<f64>) {
    let [u, v, w]: [f64; 3] = from_fn(|p| strains[p].weight);
    let weights = [u, v, w];
    let mut r: [Matrix3x2<f64>; 3] = from_fn(|p| of_bubble(&points[p], SLOPES[p]) / weights[p]);
    // Where the coordinates are curved the mean is not zero by itself; even stress must do no work.
    let mean = weights.iter().zip(&r).map(|(w, r)| *w * r).sum::<Matrix3x2<f64>>() / (u + v + w);
    r.iter_mut().for_each(|r| *r -= mean);
    let mut of_bubbles = Matrix2::zeros();
    let mut of_strains = SMatrix::<f64, 2, P>::zeros();
    for (p, strains) in strains.iter().enumerate() {
        let stress = weights[p] * r[p].transpose() * C;
        of_bubbles += stress * r[p];
        of_strains += stress * strains.membrane;
    }
    let Some(inverse) = of_bubbles.try_inverse() else { return };
    let taken = (1.0 - UNBALANCED.sqrt()) * inverse * of_strains;
    strains.iter_mut().zip(&r).for_each(|(strains, r)| strains.membrane -= r * taken);
}

/// sym(g ⊗ λ) as ε₁, ε₂, γ₁₂, for λ along both axes, from the slopes g along r and s.
fn of_bubble(point: &CurvedPoint, [along_r, along_s]: [f64; 2]) -> Matrix3x2<f64> {
    let [r, s] = point.jacobian;
    let along_coordinates =
        Matrix3x2::from_fn(|i, k| [along_r * r[k], along_s * s[k], along_r * s[k] + along_s * r[k]][i]);
    point.along_axes() * along_coordinates
}
