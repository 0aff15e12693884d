//! The horizontal axis of error plots: seconds, which scatter, or counts, which are equal on every machine.

use super::run::StudyRun;

/// A cost of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Cost {
    /// The seconds of the time stepping.
    #[default]
    Seconds,
    /// The iterations of the run, and of the other runs for the error of automatic steps.
    Iterations,
    /// The factorizations of both.
    Factorizations,
}

impl Cost {
    /// All costs, in the order of the choice.
    pub const ALL: [Cost; 3] = [Cost::Seconds, Cost::Iterations, Cost::Factorizations];

    /// The word for it, on the command line too.
    pub fn word(self) -> &'static str {
        match self {
            Cost::Seconds => "seconds",
            Cost::Iterations => "iterations",
            Cost::Factorizations => "factorizations",
        }
    }

    /// The title of its axis.
    pub fn title(self) -> &'static str {
        match self {
            Cost::Seconds => "run time of the time stepping (s)",
            Cost::Iterations => "iterations, with those of the other runs of automatic steps",
            Cost::Factorizations => "factorizations, with those of the other runs of automatic steps",
        }
    }

    /// The cost of a run; `None` if it has no cost of this kind, such as factorizations of an explicit run.
    pub fn of(self, run: &StudyRun) -> Option<f64> {
        let m = &run.measured;
        let cost = match self {
            Cost::Seconds => run.loop_s,
            Cost::Iterations => (m.iterations + m.other_iterations) as f64,
            Cost::Factorizations => (m.factorizations + m.other_factorizations) as f64,
        };
        (cost > 0.0).then_some(cost)
    }
}
