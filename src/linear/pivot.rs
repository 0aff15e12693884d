//! Criterion for pivots too small to divide by.

use std::fmt;

/// A pivot counts as zero at this fraction of the largest entry that its row of the diagonal block had before elimination. Unsupported
/// chains of up to 1000 beams give at most 5e-15 where an exact pivot would be zero. Chains clamped at the far end give 1e-9, and 5e-14 if
/// slender as well (element length 1000 radii of gyration).
pub(super) const PIVOT_TOLERANCE: f64 = 1e-14;

/// A pivot is zero to working accuracy, or not finite: the matrix is singular, or holds numbers that are not finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Singular {
    /// External row of the pivot.
    pub row: usize,
    /// The pivot itself, in the unit of the row's diagonal entry.
    pub pivot: f64,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "the pivot of row {} vanishes ({:e})", self.row, self.pivot)
    }
}

impl std::error::Error for Singular {}
