//! How a run ended, and what it took.

use super::failure::Failure;

/// How a run ended.
#[derive(Debug)]
pub enum Outcome {
    Done,
    /// The least step failed; results are valid up to `time`.
    Failed {
        time: f64,
        failure: Failure,
    },
    /// The flag was raised.
    Stopped {
        time: f64,
    },
    /// The observer could not write.
    Io(std::io::Error),
}

/// The effort of a run so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    pub steps: usize,
    pub iterations: usize,
    pub factorizations: usize,
    pub solves: usize,
    pub cuts: usize,
}
