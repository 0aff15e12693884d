//! Failure of bolts, welds and other links by an interaction of normal and shear force, (F_n/N)ᵃ + (F_s/S)ᵇ ≥ 1. Only tension counts as
//! normal force. A failed link carries nothing; its memory holds the two forces at failure.

use super::block::FailureCause;

/// The number of history variables of a link that may fail: normal and shear force at its failure, zeros before.
pub const MEMORY: usize = 2;

/// Failure forces of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkFailure {
    /// N: capacity for pure normal force, above 0; infinite without failure in tension.
    pub normal: f64,
    /// S: capacity for pure shear, above 0; infinite without failure in shear.
    pub shear: f64,
    /// a and b, above 0.
    pub exponents: [f64; 2],
}

impl LinkFailure {
    /// True where the link fails under this normal force, positive in tension, and this shear force.
    pub fn is_reached(&self, normal: f64, shear: f64) -> bool {
        let [a, b] = self.exponents;
        (normal.max(0.0) / self.normal).powf(a) + (shear / self.shear).powf(b) >= 1.0
    }
}

/// True where a link has failed by its memory; one without never fails.
#[inline]
pub fn has_failed(memory: &[f64]) -> bool {
    memory.iter().any(|force| *force != 0.0)
}

/// Why a link has failed: the forces in its memory, none where it cannot fail.
pub fn cause(memory: &[f64]) -> FailureCause {
    let force = |k: usize| memory.get(k).copied().unwrap_or_default();
    FailureCause::Forces { normal: force(0), shear: force(1) }
}
