//! Edges that bulge with the drilling rotations of their ends (Allman 1984), at any rotation.
//!
//! Every end has a unit vector τ that turns with its node, normal to the edge and to the director there at t = 0. The edge e = x_b − x_a of
//! length L bulges by ½ r (1 − r) L (θ_a − θ_b) across itself, with r from 0 to 1 and
//!   θ_a − θ_b = −(e·τ_a/c_a − e·τ_b/c_b),    c_a = e·(τ_a × d_a) at t = 0.
//! Only the nodes determine it: both elements of an edge have the same bulge. A membrane force passing through does no work on it, at any
//! angle between the elements. Measured about the normals of the elements it would bend and buckle a sheet under tension. Where membrane
//! forces jump between elements or end at a free edge, the difference acts on directors tilted both along and across the edge. Bending
//! stiffness resists it.

use base::math::Vec3;
use std::array::from_fn;

/// Square of the cosine between an edge and the surface below which the edge is taken as normal to it.
const UPRIGHT: f64 = 1e-3;

/// An edge from a to b: for each end the coefficients of t₁ and t₂ of the node in its part of (θ_a − θ_b)/e.
#[derive(Clone, Copy)]
pub(super) struct EdgeTangents(pub [[f64; 2]; 2]);

impl EdgeTangents {
    /// `along`: x_b − x_a at t = 0; `tangents`: orthonormal t₁ and t₂ of a and b, normal to their directors.
    pub fn new(along: &Vec3, tangents: [&[Vec3; 2]; 2]) -> Self {
        EdgeTangents(from_fn(|end| {
            let [c, s] = tangents[end].map(|t| t.dot(along));
            // τ = (−s t₁ + c t₂)/√(c² + s²).
            let squared = c * c + s * s;
            // An edge that stands upright on the surface has no bulge in it.
            let scale = if squared > UPRIGHT * along.norm_squared() { squared.recip() } else { 0.0 };
            let scale = if end == 0 { -scale } else { scale };
            [-s * scale, c * scale]
        }))
    }
}
