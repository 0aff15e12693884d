//! Curvature of triangles by edges that bend between their nodes, see [`super::edge_bubbles`].

use std::array::from_fn;
use std::ops::{Add, AddAssign, Mul};

/// Mean curvature by the numbers of shear: rows of κ₁, κ₂, 2κ₁₂. `T` is a number, or eight of them side by side.
#[derive(Clone, Copy)]
pub struct EdgeBending<T, const N: usize>(pub [[T; N]; 3]);

impl<T: Copy + Add<Output = T> + AddAssign + Mul<Output = T>, const N: usize> EdgeBending<T, N> {
    /// Curvature by the shear of the edges.
    #[inline(always)]
    pub fn curvature(&self, shear: &[T; N]) -> [T; 3] {
        self.0.map(|row| {
            let mut sum = row[0] * shear[0];
            (1..N).for_each(|e| sum += row[e] * shear[e]);
            sum
        })
    }

    /// The stress of the edge shears from the bending stress: the transpose of [`Self::curvature`].
    #[inline(always)]
    pub fn stress(&self, bending: &[T]) -> [T; N] {
        let [a, b, c] = &self.0;
        from_fn(|e| a[e] * bending[0] + b[e] * bending[1] + c[e] * bending[2])
    }
}

impl<const N: usize> EdgeBending<f64, N> {
    /// Straight edges.
    pub const NONE: Self = EdgeBending([[0.0; N]; 3]);
}
