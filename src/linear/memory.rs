//! Checks that the memory holds a factor before it is taken: a system that promises more memory than it has ends the
//! programs that come to use it, without a message.

use crate::snapshot::keep;
use std::fmt;

/// Memory of a factor, its matrix and the update matrices of its fronts, over that of the factor alone. Shells of 250,000
/// unknowns measure 2.05: the process takes 1250 MB, less 4 kB for each element, and the factor 529 MB.
const MEMORY_FACTOR: f64 = 2.0;

/// The memory does not hold the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    /// Rows of the matrix.
    pub unknowns: usize,
    /// Bytes needed at least.
    pub needed: f64,
}

keep!(TooLarge { unknowns, needed });

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (unknowns, needed) = (self.unknowns, self.needed / 1e9);
        write!(
            f,
            "the matrix of {unknowns} unknowns needs at least {needed:.1} GB when factorised: more memory than there is"
        )
    }
}

impl std::error::Error for TooLarge {}

/// Makes sure that the memory holds a factor of `nonzeros` numbers, its matrix and its update matrices.
///
/// # Errors
/// It does not, or a limit of this process forbids it.
pub(super) fn require(unknowns: usize, nonzeros: usize) -> Result<(), TooLarge> {
    let needed = MEMORY_FACTOR * size_of::<f64>() as f64 * nonzeros as f64;
    let fits = available().is_none_or(|available| needed <= available);
    // A limit of this process does not show in what the system has available. The memory is given back at once, untouched.
    let granted = Vec::<u8>::new().try_reserve_exact(needed as usize).is_ok();
    if fits && granted { Ok(()) } else { Err(TooLarge { unknowns, needed }) }
}

/// Bytes that programs may still take, as Linux says; none on other systems.
pub fn available() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let kilobytes = |key: &str| -> Option<f64> {
        let line = text.lines().find_map(|line| line.strip_prefix(key))?;
        line.trim().strip_suffix("kB")?.trim().parse().ok()
    };
    Some(1024.0 * (kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_beyond_all_memory_is_refused_in_words() {
        assert_eq!(require(12, 100), Ok(()));
        // 16 TB, and more than addresses reach.
        for nonzeros in [1_000_000_000_000, usize::MAX / 16] {
            let error = require(9_000_000, nonzeros).unwrap_err();
            assert_eq!(error.needed, 16.0 * nonzeros as f64);
        }
        let said = require(9_000_000, 1_000_000_000_000).unwrap_err().to_string();
        assert_eq!(
            said,
            "the matrix of 9000000 unknowns needs at least 16000.0 GB when factorised: more memory than there is"
        );
    }
}
