//! The report of a step that was taken.

/// The report of a step that was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Iterations of an implicit step, or evaluations of the residual in an explicit one.
    pub iterations: usize,
    /// Factorizations of the matrix.
    pub factorizations: usize,
    /// Residual at the last evaluation, relative to the largest force or moment at a node.
    pub residual: f64,
    /// Time at the end of the step.
    pub to: f64,
    /// The lasting part of its error, as a length. It is 0 where steps follow no tolerance.
    pub error: f64,
}

impl StepReport {
    /// A report of nothing, for a step to the time `to`.
    pub fn begin(to: f64) -> StepReport {
        StepReport { iterations: 0, factorizations: 0, residual: 0.0, to, error: 0.0 }
    }

    /// The report of two substeps in a row.
    pub fn then(self, next: StepReport) -> StepReport {
        StepReport {
            iterations: self.iterations + next.iterations,
            factorizations: self.factorizations + next.factorizations,
            ..next
        }
    }
}
