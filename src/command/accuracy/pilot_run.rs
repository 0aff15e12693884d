//! The results of one pilot run.

use model::{Model, StepLength};
use results::error_bars::ErrorBars;
use results::expect::Expectations;
use results::observed::ObservedRun;
use solve::{Frame, Kept, Observer};
use std::io;

/// The results of a pilot run at its times of comparison.
pub struct PilotRun {
    /// The results that `accuracy` is about.
    pub observed: ObservedRun,
    /// The motion, if steps are automatic; the error of the last run follows from it.
    pub motion: Option<Kept>,
    /// The numbers of tables and of expectations, for error bars; only where steps are automatic.
    pub numbers: Option<(ErrorBars, Expectations)>,
}

impl PilotRun {
    /// Nothing seen yet of a run of this model.
    pub fn new(model: &Model) -> PilotRun {
        let is_automatic = matches!(model.analysis.step_length, StepLength::ErrorControlled { .. });
        let numbers = is_automatic.then(|| (ErrorBars::new(model), Expectations::new(model)));
        PilotRun { observed: ObservedRun::new(model), motion: None, numbers }
    }
}

impl Observer for PilotRun {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn begin_comparison(&mut self) {
        self.observed.begin_comparison();
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        if let Some((bars, expectations)) = &mut self.numbers {
            bars.on_pilot(frame)?;
            expectations.on_pilot(frame);
        }
        self.observed.on_comparison(frame)
    }
}
