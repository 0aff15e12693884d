//! The stiffness that the fibres of a section have together.

use super::section::BeamStiffness;
use crate::sections::Fibre;
use base::math::{Mat3, Mat6, Vec3};

/// The sum of the stiffnesses of fibres, in section axes.
#[derive(Default)]
pub struct FibreSum {
    /// Stiffness with respect to (Γ₁, κ₂, κ₃).
    axial: Mat3,
    /// Stiffness with respect to (Γ₂, Γ₃, κ₁).
    shear: Mat3,
    /// Coupling stiffness with rows (Γ₁, κ₂, κ₃) and columns (Γ₂, Γ₃, κ₁).
    mixed: Mat3,
}

impl FibreSum {
    /// Adds a fibre whose stiffness is `C`.
    #[inline(always)]
    pub fn add<const N: usize>(&mut self, fibre: &Fibre, C: &[[f64; N]; N]) {
        let u = Vec3::new(1.0, fibre.z, -fibre.y);
        let weighted = fibre.area * u;
        self.axial += C[0][0] * weighted * u.transpose();
        for a in 1..N {
            let s_a = Vec3::from(fibre.shear[a - 1]);
            self.mixed += C[0][a] * weighted * s_a.transpose();
            for b in 1..N {
                self.shear += (fibre.area * C[a][b]) * s_a * Vec3::from(fibre.shear[b - 1]).transpose();
            }
        }
    }

    /// The sum with respect to (Γ₁, κ₂, κ₃), without the rounding of moments that cancel: it would couple tension with bending.
    pub fn axial(&self) -> Mat3 {
        let mut out = self.axial;
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            // Sums of some hundred fibres round to 1e-14 of the terms.
            if out[(i, j)].abs() < 1e-12 * (out[(i, i)] * out[(j, j)]).sqrt() {
                (out[(i, j)], out[(j, i)]) = (0.0, 0.0);
            }
        }
        out
    }

    /// The sum as the stiffness of a section.
    pub(super) fn section(&self) -> BeamStiffness {
        const AXIAL: [usize; 3] = [0, 4, 5];
        const SHEAR: [usize; 3] = [1, 2, 3];
        let mut C = Mat6::zeros();
        for i in 0..3 {
            for j in 0..3 {
                C[(AXIAL[i], AXIAL[j])] = self.axial[(i, j)];
                C[(SHEAR[i], SHEAR[j])] = self.shear[(i, j)];
                C[(AXIAL[i], SHEAR[j])] = self.mixed[(i, j)];
                C[(SHEAR[j], AXIAL[i])] = self.mixed[(i, j)];
            }
        }
        let part = |i, j| C.fixed_view::<3, 3>(i, j).into_owned();
        BeamStiffness { N: part(0, 0), M: part(3, 3), NM: part(0, 3), coupled: true }
    }
}
