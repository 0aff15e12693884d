//! What a run works on while it goes through time, handed as one to whatever leads it.

use super::context::Context;
use super::failure::Failure;
use super::frame::Observer;
use super::outcome::Outcome;
use super::recorder::{AcceptedStep, Recorder};
use super::report::StepReport;
use super::workspace::Workspace;
use crate::state::State;
use std::sync::atomic::{AtomicBool, Ordering};

/// A run under way: what it reads, what it writes, its state, and who watches it.
pub struct March<'r, 'a> {
    pub cx: &'r Context<'a>,
    pub ws: &'r mut Workspace,
    pub state: &'r mut State,
    pub recorder: &'r mut Recorder,
    pub observer: &'r mut dyn Observer,
    /// Raised by whoever wants the run to end.
    pub stop: &'a AtomicBool,
}

impl March<'_, '_> {
    /// # Errors
    /// [`Outcome::Stopped`] where the run is to end.
    pub fn check_stop(&self) -> Result<(), Outcome> {
        match self.stop.load(Ordering::Relaxed) {
            true => Err(Outcome::Stopped { time: self.state.time }),
            false => Ok(()),
        }
    }

    /// Shows an accepted step.
    ///
    /// # Errors
    /// As for [`Recorder::notify`].
    pub fn notify(&mut self, step: &AcceptedStep) -> Result<(), Outcome> {
        self.recorder.notify(self.cx, self.ws, self.state, self.observer, step)
    }

    /// The run ends here, because of this.
    pub fn failed(&self, failure: Failure) -> Outcome {
        Outcome::Failed { time: self.state.time, failure }
    }

    /// Shows the state at t = 0.
    ///
    /// # Errors
    /// As for [`Recorder::notify`].
    pub fn notify_start(&mut self) -> Result<(), Outcome> {
        let report = &StepReport::begin(0.0);
        self.notify(&AcceptedStep { dt: 0.0, report, cuts: 0, due: true, last: false, passed: &[] })
    }

    /// Notes that a step was cut.
    pub fn count_cut(&mut self) {
        self.recorder.counts.cuts += 1;
    }

    /// True for a time within rounding of the end: no other step comes as near.
    pub fn is_end(&self, time: f64) -> bool {
        time >= self.cx.model.analysis.end_time * (1.0 - 1e-9)
    }
}
