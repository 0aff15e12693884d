//! What a step says of itself once it is taken.

/// A step that was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Iterations of an implicit step, evaluations of the residual in an explicit one.
    pub iterations: usize,
    pub factorizations: usize,
    /// The residual at the last evaluation, relative to the largest force or moment at a node.
    pub residual: f64,
    /// The time at which the step ends.
    pub to: f64,
}

impl StepReport {
    /// Nothing done yet on a step to `to`.
    pub fn begin(to: f64) -> StepReport {
        StepReport { iterations: 0, factorizations: 0, residual: 0.0, to }
    }

    /// The account of a step that went on with `next` after this.
    pub fn then(self, next: StepReport) -> StepReport {
        StepReport {
            iterations: self.iterations + next.iterations,
            factorizations: self.factorizations + next.factorizations,
            ..next
        }
    }
}
