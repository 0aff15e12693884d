//! Whether there is memory for a factor, asked before it is taken: where a system promises more than it has, it ends programs
//! that come to use it, without a word.

use std::fmt;

/// Bytes of a factor, its matrix and the updates of its fronts over those of the factor alone. Shells of 250,000 unknowns: 2.05,
/// from 1250 MB of the process without 4 kB an element, over 529 MB.
const LEAST: f64 = 2.0;

/// A factor that does not fit into memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    pub unknowns: usize,
    /// Bytes, at least.
    pub needed: f64,
}

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

/// # Errors
/// There is no memory for a factor of so many numbers.
pub(super) fn room(unknowns: usize, nonzeros: usize) -> Result<(), TooLarge> {
    let needed = LEAST * size_of::<f64>() as f64 * nonzeros as f64;
    let fits = available().is_none_or(|available| needed <= available);
    // What a limit of this process refuses, which the system does not know of; given back at once, untouched.
    let granted = Vec::<u8>::new().try_reserve_exact(needed as usize).is_ok();
    if fits && granted { Ok(()) } else { Err(TooLarge { unknowns, needed }) }
}

/// Bytes that programs may still take; Linux tells it.
fn available() -> Option<f64> {
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
        assert_eq!(room(12, 100), Ok(()));
        // 16 TB; and more than addresses reach.
        for nonzeros in [1_000_000_000_000, usize::MAX / 16] {
            let error = room(9_000_000, nonzeros).unwrap_err();
            assert_eq!(error.needed, 16.0 * nonzeros as f64);
        }
        let said = room(9_000_000, 1_000_000_000_000).unwrap_err().to_string();
        assert_eq!(
            said,
            "the matrix of 9000000 unknowns needs at least 16000.0 GB when factorised: more memory than there is"
        );
    }
}
