//! Strains, stresses and stiffnesses of shell elements in their planes: of one element, or of eight side by side.

use base::math::number::Number;
use std::array::from_fn;

/// Strains of an element in its plane, integrated over it, or the stresses conjugate to them: E numbers of the membrane and P of
/// bending, see [`super::plane_strains`].
#[derive(Debug, Clone, Copy)]
pub struct InPlane<const P: usize, const E: usize, T = f64> {
    /// Numbers of the membrane.
    pub membrane: [T; E],
    /// Numbers of bending.
    pub bending: [T; P],
}

impl<const P: usize, const E: usize, T: Number> InPlane<P, E, T> {
    /// All zero.
    pub const ZERO: Self = InPlane { membrane: [T::ZERO; E], bending: [T::ZERO; P] };

    /// The numbers of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> InPlane<P, E> {
        InPlane { membrane: self.membrane.map(|of| of.lane(lane)), bending: self.bending.map(|of| of.lane(lane)) }
    }

    /// σ·ε over membrane and bending.
    #[inline]
    pub fn dot(&self, other: &Self) -> T {
        product(&self.membrane, &other.membrane) + product(&self.bending, &other.bending)
    }
}

/// Stress of elements in their planes, and the stiffness C.
pub struct LinearisedPlane<const P: usize, const E: usize, T> {
    /// Stress.
    pub stress: InPlane<P, E, T>,
    /// Membrane.
    pub N: [[T; E]; E],
    /// Bending.
    pub M: [[T; P]; P],
    /// Rows of the membrane, columns of bending; nothing unless `coupled`.
    pub NM: [[T; P]; E],
    /// `NM` is not zero.
    pub coupled: bool,
}

/// Σ aᵢ bᵢ.
#[inline(always)]
pub(super) fn product<T: Number, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    let mut sum = a[0] * b[0];
    (1..N).for_each(|i| sum += a[i] * b[i]);
    sum
}

/// K ← K − Aᵀ C B.
#[inline(always)]
pub(super) fn subtract<T: Number, const R: usize, const Q: usize>(
    A: &[[T; R]; 3],
    C: &[[T; 3]; 3],
    B: &[[T; Q]; 3],
    K: &mut [[T; Q]; R],
) {
    let CB: [[T; Q]; 3] = from_fn(|i| from_fn(|n| product(&C[i], &[B[0][n], B[1][n], B[2][n]])));
    for m in 0..R {
        let A: [T; 3] = from_fn(|i| T::ZERO - A[i][m]);
        for n in 0..Q {
            K[m][n] = T::fma(A[2], CB[2][n], T::fma(A[1], CB[1][n], T::fma(A[0], CB[0][n], K[m][n])));
        }
    }
}
