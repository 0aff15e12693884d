//! The effort of a step, and its error.

use base::snapshot::keep;

/// The effort of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effort {
    /// Iterations.
    pub iterations: usize,
    /// Factorizations of the matrix.
    pub refactorizations: usize,
    /// Relative residual at the last evaluation.
    pub residual: f64,
    /// Cutbacks before the step was accepted.
    pub cuts: usize,
    /// The lasting part of the error of the step, as a length. It is 0 where steps follow no tolerance.
    pub error: f64,
}

keep!(Effort { iterations, refactorizations, residual, cuts, error });

impl Effort {
    /// The sum of this effort and another one.
    #[must_use]
    pub fn and(self, other: Effort) -> Effort {
        Effort {
            iterations: self.iterations + other.iterations,
            refactorizations: self.refactorizations + other.refactorizations,
            residual: self.residual.max(other.residual),
            cuts: self.cuts + other.cuts,
            error: self.error + other.error,
        }
    }
}
