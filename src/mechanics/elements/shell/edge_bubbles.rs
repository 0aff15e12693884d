//! Edges of triangles that bend between their nodes: the element of I. Katili (Int. J. Numer. Meth. Engrg. 36, 1993), with the shear
//! of Lee & Bathe.
//!
//! Directors are linear between the nodes, plus a part of second degree along each edge, 4 r (1 − r) Δ. An edge is a beam; g is its shear
//! strain times its length ℓ. Then Δ = −3/2 (g/ℓ)/(1 + φ), and the fraction φ/(1 + φ) of g remains as shear, φ = 12 D/(k G h ℓ²). Thin
//! edges bend without shear then, thick ones shear without bending. The curvature from Δ has
//! - a mean, from twisting alone: −(t nᵀ + n tᵀ)/(2 A (1 + φ)) g, t along the edge and n out of the element. With it strips in torsion are
//!   right whatever the shape of the elements; without it narrow ones have half of their stiffness. Next to a free edge twisting turns into
//!   shear over a third of the thickness, too narrow for wider elements: the mean uses 6 φ in place of φ. Only the edge determines it; both
//!   elements have the same and their twisting moments there cancel.
//! - an elastic rest: it depends on the shear numbers alone and replaces shear stiffness in thin elements.
//!
//! A beam has no width. In an element the bubble of an edge also twists over the height w of the element above it. An element thick against
//! its width thus shears rather than bends at any length. Shear and the rest use φ + φ_w/10 in place of φ, φ_w = 12 D/(k G h w²). Slivers
//! do not lock by it: a tenth of the edge is the least w.

use super::edge_bending::EdgeBending;
use super::interpolation::Interpolation;
use super::surface::ElementSurface;
use nalgebra::{Matrix3, SMatrix, Vector3};
use std::array::from_fn;

/// Factor on φ in the mean curvature. The error of strips of 5 : 1 in torsion, four triangles wide, is 7 % with 4, 5 % with 6 and 4 % with
/// 8; cylinders under point forces become softer with larger factors.
const FADING: f64 = 6.0;

/// Factor on φ_w for an edge. Clamped plates of 1 : 5 with a thickness of 1/7 of the width, 8 x 8, are too soft by 13 and 7 % with 0 (the
/// two directions of diagonals), by 7 and 1.5 % with 0.1. With ¼ they are exact, but strips in torsion are 8 % too stiff.
const WIDTH: f64 = 0.1;

/// The least height over an edge, by its length.
const LEAST_HEIGHT: f64 = 0.1;

/// The mean curvature by the numbers of shear, the fraction of each edge's shear remaining as shear, and the stiffness of the rest of the
/// curvature. For linear interpolation. `C`: moments by curvatures; `squared`: 12 D/(k G h).
pub fn edge_bubbles<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(
    surface: &ElementSurface<N, V>,
    C: &Matrix3<f64>,
    squared: f64,
) -> (EdgeBending<f64, N>, [f64; N], [[f64; N]; N]) {
    let sides = K::EDGES.map(|[a, b]| surface.flat(&(surface.X[b] - surface.X[a])));
    let over = |length: f64| squared / (length * length);
    let phi = sides.map(|e| over(e.norm()));
    let wide = from_fn::<_, N, _>(|e| {
        let length = sides[e].norm();
        phi[e] + WIDTH * over(f64::max(2.0 * surface.area / length, LEAST_HEIGHT * length))
    });
    // The mean curvature of an edge that is thin.
    let mean = SMatrix::<f64, 3, N>::from_columns(&from_fn::<_, N, _>(|e| {
        let t = sides[e].normalize();
        // n = (t₂, −t₁) on the right of an edge that runs counter-clockwise.
        -K::sense(e) / surface.area * Vector3::new(t.x * t.y, -t.x * t.y, t.y * t.y - t.x * t.x)
    }));
    let slopes = |a: usize| [surface.slopes[0][a], surface.slopes[1][a]];
    let mut rest = SMatrix::<f64, N, N>::zeros();
    for (values, point) in K::VALUES.iter().zip(&surface.points) {
        let mut B = SMatrix::<f64, 3, N>::zeros();
        for (e, [a, b]) in K::EDGES.into_iter().enumerate() {
            let [q1, q2] = from_fn(|i| 4.0 * (values[a] * slopes(b)[i] + values[b] * slopes(a)[i]));
            let t = -1.5 * sides[e] / sides[e].norm_squared();
            let all = Vector3::new(q1 * t.x, q2 * t.y, q2 * t.x + q1 * t.y);
            B.set_column(e, &((all - mean.column(e)) / (1.0 + wide[e])));
        }
        rest += point.weight * B.transpose() * C * B;
    }
    let rest = from_fn(|i| from_fn(|j| 0.5 * (rest[(i, j)] + rest[(j, i)])));
    let mean = from_fn(|i| from_fn(|e| mean[(i, e)] / (1.0 + FADING * phi[e])));
    (EdgeBending(mean), wide.map(|phi| phi / (1.0 + phi)), rest)
}
