//! The strains in the plane of an element, by what describes its motion: numbers of the membrane and of bending.
//!
//! Numbers of the membrane are the products ½ v_i·v_i and v_i·v_j of the slopes less their values at t = 0, the bulges θ_a − θ_b of the
//! edges, and drilling. Numbers of bending are the products v_i·w_i and v_i·w_j + v_j·w_i, with w the slopes of the directors.

use super::interpolation::Interpolation;
use super::surface::ElementSurface;
use nalgebra::SMatrix;

/// Strains ε₁, ε₂, γ₁₂ and curvatures at an integration point, from the numbers of the element.
pub struct PointStrains<const P: usize, const E: usize> {
    /// Strain of the reference surface from the numbers of the membrane.
    pub membrane: SMatrix<f64, 3, E>,
    /// Curvature from the numbers of bending.
    pub bending: SMatrix<f64, 3, P>,
    /// Area that belongs to the point.
    pub weight: f64,
}

/// How strains in the plane follow from P products of slopes and E numbers of the membrane.
pub trait PlaneStrains<const N: usize, const V: usize, const P: usize, const E: usize>: Interpolation<N, V, P> {
    /// Strains at the integration points; `bulge`: the part of the bulge of each edge that stress works on.
    fn strains(surface: &ElementSurface<N, V>, nu: f64, bulge: &[f64; N]) -> Vec<PointStrains<P, E>>;
    /// Rows of drilling stiffness by the numbers of the membrane: mean drilling and, in the quadrilateral, drilling with alternating sign.
    /// Strains do not depend on them.
    fn drilling(surface: &ElementSurface<N, V>, bulge: &[f64; N]) -> [[f64; E]; 2];

    /// Strains at a point from the products, with the coefficients `s` of the slopes in x,₁ and x,₂ there.
    fn of_products([s, t]: &[[f64; V]; 2]) -> SMatrix<f64, 3, P> {
        SMatrix::from_fn(|row, n| {
            let [i, j] = Self::PAIRS[n];
            match row {
                0 => s[i] * s[j],
                1 => t[i] * t[j],
                _ => s[i] * t[j] + s[j] * t[i],
            }
        })
    }
}
