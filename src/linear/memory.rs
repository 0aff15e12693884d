//! Checks the available memory for a factor, because a system that overcommits kills programs without a message.

use base::names::amount;
use base::snapshot::{keep, keep_either};
use std::fmt;

/// Bytes for each unknown beside the numbers of a factorisation, at least: vectors of the solution, and lists of the structure. Whole runs of
/// shells take about 1000 beside them, elements and what there is before the plan included.
const BESIDE: f64 = 500.0;

/// The memory does not hold the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    /// Rows of the matrix.
    pub unknowns: usize,
    /// Bytes needed at least.
    pub needed: f64,
    /// Why the factor does not lie in a file either; `None` where all else has no room in memory.
    pub scratch: Option<NoScratch>,
}

/// Why there is no file for a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoScratch {
    /// The disk has no room.
    Full,
    /// The folder for temporary files is itself in memory.
    InMemory,
    /// Nothing can be written there.
    NotWritable,
}

keep!(TooLarge { unknowns, needed, scratch });
keep_either!(NoScratch { 0 => Full, 1 => InMemory, 2 => NotWritable });

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (unknowns, needed) = (self.unknowns, amount(self.needed));
        write!(
            f,
            "the matrix of {unknowns} unknowns needs at least {needed} when factorised: more memory than there is"
        )?;
        if let Some(reason) = self.scratch {
            let folder = std::env::temp_dir();
            let folder = folder.display();
            match reason {
                NoScratch::Full => write!(f, ", and more than the disk of {folder} holds")?,
                NoScratch::InMemory => write!(f, ", and {folder} is itself in memory")?,
                NoScratch::NotWritable => write!(f, ", and nothing can be written in {folder}")?,
            }
            f.write_str("; TMPDIR may name a folder on a disk with room for the factor")?;
        }
        f.write_str(
            "; a coarser mesh needs less, and `scheme = \"central-difference\"` factorises nothing of this size",
        )
    }
}

impl std::error::Error for TooLarge {}

/// Makes sure that the memory holds so many `numbers` of a matrix, its factor and its update matrices.
///
/// # Errors
/// It does not, or a limit of this process forbids it.
pub(super) fn require(unknowns: usize, numbers: usize) -> Result<(), TooLarge> {
    let needed = size_of::<f64>() as f64 * numbers as f64 + BESIDE * unknowns as f64;
    let fits = available().is_none_or(|available| needed <= available);
    // The available memory of the system does not show a limit of this process. The memory is given back at once, untouched.
    let granted = Vec::<u8>::new().try_reserve_exact(needed as usize).is_ok();
    if fits && granted { Ok(()) } else { Err(TooLarge { unknowns, needed, scratch: None }) }
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
        for numbers in [2_000_000_000_000, usize::MAX / 8] {
            let error = require(9_000_000, numbers).unwrap_err();
            assert_eq!(error.needed, 8.0 * numbers as f64 + 500.0 * 9e6);
        }
        let said = require(9_000_000, 2_000_000_000_000).unwrap_err().to_string();
        assert_eq!(
            said,
            "the matrix of 9000000 unknowns needs at least 16004.5 GB when factorised: more memory than there is; a coarser mesh \
             needs less, and `scheme = \"central-difference\"` factorises nothing of this size"
        );
        let error = TooLarge { unknowns: 2, needed: 2e9, scratch: Some(NoScratch::Full) };
        let folder = std::env::temp_dir();
        let said = error.to_string();
        assert!(said.contains(&format!("and more than the disk of {} holds; TMPDIR", folder.display())), "{said}");
    }
}
