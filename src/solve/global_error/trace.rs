//! Observers that keep the motion of a run, or pass a part of it on, for the comparison of runs.

use super::kept::Kept;
use super::look_ahead::LookAhead;
use crate::frame::{Frame, Observer};
use base::snapshot::{Keep, Snapshot};
use model::Model;
use std::io;

/// Positions of nodes and rotations of bodies at a few times, kept while another observer receives the same steps.
pub struct Trace<'o> {
    observer: &'o mut dyn Observer,
    kept: Kept,
    ahead: Option<LookAhead<'o>>,
}

impl<'o> Trace<'o> {
    /// An empty trace in front of another observer, for a comparison between these times; the error of a step is proportional to this power
    /// of its length.
    pub fn new(observer: &'o mut dyn Observer, power: usize, between: [f64; 2]) -> Self {
        Trace { observer, kept: Kept { power: power as i32, between, ..Kept::default() }, ahead: None }
    }

    /// The trace of a run with a pilot run. The tolerance follows their difference, and the run ends early if the predicted error is too large.
    pub fn looking_ahead(self, ahead: Option<LookAhead<'o>>) -> Self {
        Trace { ahead, ..self }
    }

    /// The predicted error of a run that has ended early.
    pub fn predicted(&self) -> Option<f64> {
        self.ahead.as_ref().and_then(LookAhead::predicted)
    }

    /// The mean and the least tolerance of the steps so far, if they followed a pilot run.
    pub fn tolerances(&self) -> Option<[f64; 2]> {
        self.ahead.as_ref().map(|ahead| [ahead.mean_tolerance(), ahead.least_tolerance()])
    }

    /// The kept data.
    pub fn into_kept(self) -> Kept {
        self.kept
    }
}

/// Passes only the compared frames of a comparison run to another observer.
pub struct Unseen<'o> {
    observer: &'o mut dyn Observer,
}

impl<'o> Unseen<'o> {
    /// Nothing passed yet to this observer.
    pub fn new(observer: &'o mut dyn Observer) -> Self {
        Unseen { observer }
    }
}

impl Observer for Unseen<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if frame.compared { self.observer.on_comparison(frame) } else { Ok(()) }
    }

    fn wants_checkpoint(&mut self, at_end: bool) -> bool {
        self.observer.wants_checkpoint(at_end)
    }

    fn on_checkpoint(&mut self, run: &[u8], at_end: bool) -> io::Result<()> {
        self.observer.on_checkpoint(run, at_end)
    }
}

impl Observer for Trace<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if !frame.inside {
            self.kept.ends.push(frame.state.time);
            self.kept.errors.push(frame.effort.error);
            self.kept.longest = self.kept.longest.max(frame.dt);
        }
        let seen = self.kept.times;
        self.kept.look(frame);
        if let Some(ahead) = &mut self.ahead {
            ahead.advance(frame.state.time);
            if self.kept.times > seen {
                ahead.look(&self.kept);
            }
        }
        self.observer.on_step(frame)
    }

    fn is_futile(&self) -> bool {
        self.predicted().is_some()
    }

    fn new_tolerance(&mut self) -> Option<f64> {
        self.ahead.as_mut().and_then(LookAhead::new_tolerance)
    }

    fn wants_checkpoint(&mut self, at_end: bool) -> bool {
        self.observer.wants_checkpoint(at_end)
    }

    fn on_checkpoint(&mut self, run: &[u8], at_end: bool) -> io::Result<()> {
        self.observer.on_checkpoint(run, at_end)
    }

    fn keep_seen(&mut self, snapshot: &mut Snapshot) {
        self.kept.keep(snapshot);
        self.ahead.iter_mut().for_each(|ahead| ahead.keep(snapshot));
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        self.kept = Kept { power: self.kept.power, between: self.kept.between, ..Kept::default() };
        self.observer.restart(model)
    }
}
