//! The membrane strains of a triangle of six nodes whose stress is not in equilibrium, softened.
//!
//! In-plane strains are linear within the triangle, ε = ε₀ + the differences between its three points, and so is their elastic stress σ = C
//! ε. Two of the nine numbers describe the body forces div σ in equilibrium with it. An interior displacement b λ, with a bubble b
//! vanishing on the sides, would remove them: the work of a linear stress on its strain is −λ·div σ ∫ b. Of a linear strain field only
//!
//! ```text
//!  r_p = sym(∇N_p ⊗ λ)/w_p,    N_p = 1 at the point p and 0 at the other two,
//! ```
//!
//! with the weights w_p of the points does that. Eliminating λ would leave two motions without stiffness, those whose strain is such a
//! field. This part of the strain, measured by elastic energy, is therefore reduced only: the fraction [`UNBALANCED`] of its energy
//! remains. Constant strains and linear strains in equilibrium do not change.
//!
//! A cantilever under a force at its end needs a displacement of third degree: the cantilever of R. H. MacNeal & R. L. Harder (Finite Elem.
//! Anal. Des. 1, 1985) in its plane has 6 x 1 pairs of triangles: rectangles, trapezoids, parallelograms. The ratios to its exact
//! deflection are 0.983, 0.961 and 0.952 with `UNBALANCED` 1; 0.993, 0.989 and 0.986 with 0.1. With 0.01 they are 0.994, 0.994 and 0.991.

use super::surface::CurvedPoint;
use crate::elements::shell::plane_strains::PointStrains;
use nalgebra::{Matrix2, Matrix3, Matrix3x2, SMatrix};
use std::array::from_fn;

/// The fraction of the energy of unbalanced stresses that remains.
const UNBALANCED: f64 = 0.1;

/// Slopes along r and s of the three linear functions that are 1 at one integration point and 0 at the others.
const SLOPES: [[f64; 2]; 3] = [[-2.0, -2.0], [2.0, 0.0], [0.0, 2.0]];

/// Softens the membrane strains of a triangle at its three points, with plane stress `C`.
pub(super) fn soften<const P: usize>(strains: &mut [PointStrains<P, P>], points: &[CurvedPoint; 3], C: &Matrix3<f64>) {
    let [u, v, w]: [f64; 3] = from_fn(|p| strains[p].weight);
    let weights = [u, v, w];
    let mut r: [Matrix3x2<f64>; 3] = from_fn(|p| of_bubble(&points[p], SLOPES[p]) / weights[p]);
    // With curved coordinates the mean is not zero; constant stress must do no work.
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
