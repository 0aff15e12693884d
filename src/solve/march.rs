//! The data of a run under way, handed as one to its controllers.

use super::context::Context;
use super::failure::Failure;
use super::frame::Observer;
use super::out_of_reach;
use super::outcome::Outcome;
use super::recorder::{AcceptedStep, Recorder};
use super::report::StepReport;
use super::sample::{Sample, Samples};
use super::stop_watch::StopWatch;
use super::workspace::Workspace;
use super::yielded;
use base::snapshot::{Keep, Snapshot, keep};
use mechanics::state::{Node, State};
use std::sync::atomic::{AtomicBool, Ordering};

/// A run in progress: its constants, workspace, state and observer.
pub struct March<'r, 'a> {
    /// Constants of the run.
    pub cx: &'r Context<'a>,
    /// Workspace of the step.
    pub ws: &'r mut Workspace,
    /// The state at the end of the last accepted step.
    pub state: &'r mut State,
    /// The account of the run.
    pub recorder: &'r mut Recorder,
    /// The observer of the run.
    pub observer: &'r mut dyn Observer,
    /// The times inside steps that are still to come.
    pub samples: Samples<'r>,
    /// The watch that may end the stage early.
    pub stop_watch: Option<&'r mut StopWatch>,
    /// The flag that ends the run when it is raised.
    pub stop: &'a AtomicBool,
    /// The nodes at the end of the stage before; `None` at t = 0.
    pub begins_from: Option<&'r [Node]>,
    /// The position of the run between its events.
    pub place: RunPosition,
    /// True if the run resumes from a checkpoint.
    pub resumes: bool,
    /// The control of the global error, which may start further runs of the model.
    pub error_control: &'r mut dyn Keep,
}

/// The place of a run between the events that steps end at.
#[derive(Debug, Clone, Copy, Default)]
pub struct RunPosition {
    /// The end of a run that has been made longer: its intervals begin there.
    pub begin: f64,
    /// The interval that is being covered, from 0.
    pub interval: usize,
    /// Number of completed steps of the interval, if their length is given.
    pub step: usize,
    /// Cutbacks before the current step.
    pub cuts: usize,
}

keep!(RunPosition { begin, interval, step, cuts });

impl March<'_, '_> {
    /// Between two steps of `controller`: writes a checkpoint when due. If the stop flag is raised, it also ends the run.
    ///
    /// # Errors
    /// [`Outcome::Stopped`] if the run is to end, [`Outcome::Failed`] if it is futile, [`Outcome::Io`] if the observer cannot write.
    pub fn pause(&mut self, controller: &mut dyn Keep) -> Result<(), Outcome> {
        if self.observer.is_futile() {
            return Err(Outcome::Failed { time: self.state.time, failure: Failure::ErrorTooLarge { dt: 0.0 } });
        }
        let stops = self.stop.load(Ordering::Relaxed);
        if stops || self.observer.wants_checkpoint(false) {
            self.show_checkpoint(controller, false)?;
        }
        // A step after this pause may be aborted and repeated from here.
        self.ws.matrix.in_step = true;
        if stops { Err(Outcome::stopped(self.state.time)) } else { Ok(()) }
    }

    /// The outcome of a run whose `controller` failed in a step. A step aborted by a signal writes a checkpoint.
    pub fn failed_step(&mut self, controller: &mut dyn Keep, failure: Failure) -> Outcome {
        match failure {
            Failure::Stopped if !self.ws.matrix.loses_nothing => {
                let time = self.state.time;
                self.pause(controller).err().unwrap_or(Outcome::stopped(time))
            }
            failure => self.given_up(failure),
        }
    }

    /// At the end of a run of `controller`: writes a checkpoint for an extension of the run, if wanted.
    ///
    /// # Errors
    /// [`Outcome::Io`] where the observer cannot write.
    pub fn end(&mut self, controller: &mut dyn Keep) -> Result<(), Outcome> {
        if self.cx.model.analysis.can_be_longer() && self.observer.wants_checkpoint(true) {
            self.place = RunPosition { begin: self.state.time, ..RunPosition::default() };
            self.show_checkpoint(controller, true)?;
        }
        Ok(())
    }

    fn show_checkpoint(&mut self, controller: &mut dyn Keep, at_end: bool) -> Result<(), Outcome> {
        let mut snapshot = Snapshot::taken();
        self.error_control.keep(&mut snapshot);
        self.recorder.keep(&mut snapshot);
        self.keep_rest(controller, &mut snapshot);
        self.observer.on_checkpoint(&snapshot.into_bytes(), at_end).map_err(Outcome::Io)
    }

    /// Saves or restores the data after the error control and the recorder.
    pub fn keep_rest(&mut self, controller: &mut dyn Keep, snapshot: &mut Snapshot) {
        let March { ws, state, observer, samples, stop_watch, place, cx, .. } = self;
        place.keep(snapshot);
        samples.keep(snapshot);
        stop_watch.iter_mut().for_each(|watch| watch.keep(snapshot));
        ws.matrix.keep_room(cx, snapshot);
        ws.keep(snapshot);
        state.keep(snapshot);
        controller.keep(snapshot);
        observer.keep_seen(snapshot);
    }

    /// True if parts with stored energy have failed since the last call.
    pub fn has_released(&mut self) -> bool {
        let eroded = self.state.work.material.eroded;
        std::mem::replace(&mut self.recorder.eroded, eroded) != eroded
    }

    /// Shows an accepted step to the observer.
    ///
    /// # Errors
    /// As for [`Recorder::notify`].
    pub fn notify(&mut self, step: &AcceptedStep) -> Result<(), Outcome> {
        self.ws.matrix.loses_nothing &= step.dt == 0.0;
        self.ws.matrix.in_step = false;
        self.recorder.notify(self.cx, self.ws, self.state, self.observer, step)
    }

    /// Shows the state at a sample inside the last step of length `dt`, and counts its effort.
    ///
    /// # Errors
    /// As for [`Recorder::notify_inside`].
    pub fn notify_inside(
        &mut self,
        state: &State,
        report: &StepReport,
        dt: f64,
        sample: &Sample,
    ) -> Result<(), Outcome> {
        self.recorder.notify_inside(self.cx, self.ws, state, self.observer, (report, dt, sample))
    }

    /// The outcome of a run that ends here by a failure.
    pub fn failed(&self, failure: Failure) -> Outcome {
        Outcome::of(failure, self.state.time)
    }

    /// The outcome of a run that ends here because no step is short enough.
    pub fn given_up(&mut self, failure: Failure) -> Outcome {
        let failure =
            out_of_reach::explained(self.cx, (&mut self.ws.forces, &mut self.ws.loads.instant), self.state, failure);
        self.failed(yielded::explained(self.cx, self.state, failure))
    }

    /// Shows the state at t = 0 to the observer.
    ///
    /// # Errors
    /// As for [`Recorder::notify`].
    pub fn notify_start(&mut self) -> Result<(), Outcome> {
        let report = &StepReport::begin(0.0);
        self.notify(&AcceptedStep { dt: 0.0, report, cuts: 0, due: true, compared: false, last: false, passed: &[] })
    }

    /// Counts a cutback, and tells the observer.
    pub fn count_cut(&mut self) {
        self.recorder.counts.cuts += 1;
        self.observer.on_cutback(self.state.time);
    }

    /// True for a time within rounding of the end of the run; no other step comes as near.
    pub fn is_end(&self, time: f64) -> bool {
        time >= self.cx.model.analysis.end_time * (1.0 - 1e-9)
    }
}
