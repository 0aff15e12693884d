//! Positions and directors of the nodes of an element.

use base::math::Vec3;
use std::array::from_fn;

/// Positions and directors of the nodes, or their rates, or a gradient by them.
#[derive(Clone, Copy)]
pub(super) struct NodalVectors<const N: usize> {
    /// Positions from that of the first node.
    pub x: [Vec3; N],
    /// d, t₁ and t₂, which rotate with the nodes.
    pub triads: [[Vec3; N]; 3],
}

/// Σ factors_i v_i.
#[inline(always)]
pub(super) fn sum<const V: usize>(factors: &[f64; V], v: &[Vec3; V]) -> Vec3 {
    let mut sum = Vec3::zeros();
    for i in 0..V {
        sum += factors[i] * v[i];
    }
    sum
}

impl<const N: usize> NodalVectors<N> {
    /// The slopes of a field with the given nodal values.
    #[inline(always)]
    pub fn slopes<const V: usize>(slopes: &[[f64; N]; V], values: &[Vec3; N]) -> [Vec3; V] {
        from_fn(|i| sum(&slopes[i], values))
    }

    /// This + s · other.
    #[inline(always)]
    pub fn plus(&self, s: f64, other: &NodalVectors<N>) -> NodalVectors<N> {
        NodalVectors {
            x: from_fn(|a| self.x[a] + s * other.x[a]),
            triads: from_fn(|k| from_fn(|a| self.triads[k][a] + s * other.triads[k][a])),
        }
    }
}
