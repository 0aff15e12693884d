//! Stiffness and linearization of the sections of several beams side by side.

use base::math::number::{LaneVec3, Number};

/// The stiffness C of sections, see [`super::BeamStiffness`].
#[derive(Clone, Copy)]
pub struct SectionStiffness<T> {
    /// ∂n/∂Γ, rows.
    pub N: [[T; 3]; 3],
    /// ∂m/∂κ, rows.
    pub M: [[T; 3]; 3],
    /// ∂n/∂κ, rows, and transposed ∂m/∂Γ.
    pub NM: [[T; 3]; 3],
    /// `NM` is not zero everywhere.
    pub coupled: bool,
}

/// Stress resultants n and m, and their derivative.
pub struct Linearised<T> {
    /// n and m.
    pub stress: [LaneVec3<T>; 2],
    /// The derivative by Γ and κ.
    pub C: SectionStiffness<T>,
}

/// A matrix times a vector.
#[inline(always)]
fn times<T: Number>(A: &[[T; 3]; 3], LaneVec3([x, y, z]): &LaneVec3<T>) -> LaneVec3<T> {
    let row = |i: usize| A[i][0] * *x + A[i][1] * *y + A[i][2] * *z;
    LaneVec3([row(0), row(1), row(2)])
}

/// A transposed matrix times a vector.
#[inline(always)]
fn transposed_times<T: Number>(A: &[[T; 3]; 3], LaneVec3([x, y, z]): &LaneVec3<T>) -> LaneVec3<T> {
    let column = |j: usize| A[0][j] * *x + A[1][j] * *y + A[2][j] * *z;
    LaneVec3([column(0), column(1), column(2)])
}

impl<T: Number> SectionStiffness<T> {
    /// The stiffnesses times `factor`.
    #[inline(always)]
    pub fn scaled(&self, factor: T) -> Self {
        let mut C = *self;
        for part in [&mut C.N, &mut C.M, &mut C.NM] {
            part.as_flattened_mut().iter_mut().for_each(|of| *of = factor * *of);
        }
        C
    }

    /// n and m at the strains Γ, κ: [`super::BeamStiffness::stress`].
    #[inline(always)]
    pub fn stress(&self, [gamma, kappa]: &[LaneVec3<T>; 2]) -> [LaneVec3<T>; 2] {
        let (mut n, mut m) = (times(&self.N, gamma), times(&self.M, kappa));
        if self.coupled {
            n += times(&self.NM, kappa);
            m += transposed_times(&self.NM, gamma);
        }
        [n, m]
    }
}
