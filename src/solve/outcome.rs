//! The outcome of a run, and its effort.

use super::failure::Failure;
use base::snapshot::keep;

/// The way a run ended.
#[derive(Debug)]
pub enum Outcome {
    /// The run came to its end.
    Done,
    /// No step could be taken, however short.
    Failed {
        /// The end time of valid results.
        time: f64,
        /// The failure of the shortest step.
        failure: Failure,
    },
    /// The stop flag was raised.
    Stopped {
        /// The end of the last step; results are valid up to it.
        time: f64,
        /// The failure that has cut the step under way.
        cut: Option<Failure>,
    },
    /// The observer could not write.
    Io(std::io::Error),
}

impl Outcome {
    /// The outcome of a run that a signal stopped after this time.
    pub(super) fn stopped(time: f64) -> Outcome {
        Outcome::Stopped { time, cut: None }
    }

    /// The outcome of a run that ends at a time by a failure for the shortest step.
    pub(super) fn of(failure: Failure, time: f64) -> Outcome {
        match failure {
            Failure::Stopped => Outcome::stopped(time),
            failure => Outcome::Failed { time, failure },
        }
    }
}

/// The effort of a run so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: usize,
    /// Iterations, or evaluations of the residual in an explicit scheme.
    pub iterations: usize,
    /// Factorizations of a matrix.
    pub factorizations: usize,
    /// Solutions of a linear system.
    pub solves: usize,
    /// Cutbacks.
    pub cuts: usize,
}

keep!(Counts: Default { steps, iterations, factorizations, solves, cuts });

impl Counts {
    /// The effort since another time.
    #[must_use]
    pub fn since(&self, then: &Counts) -> Counts {
        let Counts { steps, iterations, factorizations, solves, cuts } = *then;
        Counts {
            steps: self.steps.saturating_sub(steps),
            iterations: self.iterations.saturating_sub(iterations),
            factorizations: self.factorizations.saturating_sub(factorizations),
            solves: self.solves.saturating_sub(solves),
            cuts: self.cuts.saturating_sub(cuts),
        }
    }
}
