//! The frame of each accepted step, passed to an observer that can only read it.

use super::derived::Derived;
use super::effort::Effort;
use crate::modes::Modes;
use base::math::Vec6;
use base::snapshot::Snapshot;
use mechanics::state::State;
use model::Model;
use std::ops::Range;

/// One accepted step, read-only.
pub struct Frame<'a> {
    /// The model.
    pub model: &'a Model,
    /// The state at the end of the step.
    pub state: &'a State,
    /// Number of accepted steps, including this one; 0 at t = 0.
    pub step: usize,
    /// Length of the step that led here; 0 at t = 0.
    pub dt: f64,
    /// The effort of the step; at a time inside it, the effort of this time.
    pub effort: Effort,
    /// Number of negative pivots of the last matrix without those of multipliers; arc length only.
    pub negative_pivots: Option<usize>,
    /// True if the output cadence selects this step, and always at t = 0 and for the last step. The last step before a failure is shown
    /// once more for it, with no iterations.
    pub due: bool,
    /// True if the cadence of fields selects this step, and always at t = 0 and at the end of the run.
    pub drawn: bool,
    /// True for the last step of the run.
    pub last: bool,
    /// True at a time inside an unfinished step.
    pub inside: bool,
    /// True at a time for the comparison of runs; quantities are then computed as for tables.
    pub compared: bool,
    /// Indices into [`Model::expects`] of the displacements that this step hits.
    pub passed: &'a [usize],
    /// Reactions on the structure, global components, in the order of the model's restraints; empty unless wanted of
    /// this step.
    pub reactions: &'a [f64],
    /// Quantities computed for output only.
    pub derived: &'a Derived,
    /// The modes about the state, where the frame is theirs.
    pub modes: Option<&'a Modes>,
    /// The case or time of a linear analysis; `None` in others.
    pub case: Option<ShownCase<'a>>,
    /// The rows of the response of these modes that are shown.
    pub rows: Range<usize>,
}

/// What a frame of a linear analysis is about.
#[derive(Clone, Copy)]
pub struct ShownCase<'a> {
    /// The load case, by its place in the model, and its name; `None` at a time.
    pub name: Option<(usize, &'a str)>,
    /// Displacements and rotations of all nodes, which are proportional to loads whatever their size.
    pub motions: &'a [Vec6],
}

/// The observer of a run.
pub trait Observer {
    /// Receives each accepted step. An error is an input/output error; it ends the run with exit code 6.
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()>;

    /// Receives the start of a step that is repeated with a shorter length.
    fn on_cutback(&mut self, _time: f64) {}

    /// Receives the modes about a state, which has been shown before. An error is one of input/output.
    fn on_modes(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }

    /// Receives rows of the response of modes that have been shown, a part after the other. An error is one of input/output.
    fn on_response(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }

    /// Discards everything received: the run begins again at t = 0, with shorter steps. Nothing is done where nothing is kept. An error is
    /// one of input/output.
    fn restart(&mut self, _: &Model) -> std::io::Result<()> {
        Ok(())
    }

    /// The times when this observer needs another run to report errors of the received results.
    fn times_to_compare(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Forgets earlier comparison runs: another begins.
    fn begin_comparison(&mut self) {}

    /// Receives a frame of a comparison run at a time of comparison. An error is one of input/output.
    fn on_comparison(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }

    /// Receives the run used for the errors of the received results; `None` if there is none.
    fn on_other_run(&mut self, _: Option<OtherRun>) {}

    /// True where the run need not go on: its error will be too large. It is asked before every step.
    fn is_futile(&self) -> bool {
        false
    }

    /// The tolerance of later steps, once after each change. It is asked before every step.
    fn new_tolerance(&mut self) -> Option<f64> {
        None
    }

    /// True where a checkpoint is due. It is asked before every step, and at the end of a run that can be made longer.
    fn wants_checkpoint(&mut self, _at_end: bool) -> bool {
        false
    }

    /// Receives all data to resume the run from the last accepted step, or to extend it at its end. An error is one of input/output.
    fn on_checkpoint(&mut self, _run: &[u8], _at_end: bool) -> std::io::Result<()> {
        Ok(())
    }

    /// Saves observers that belong to the run itself; others save their data with [`Observer::on_checkpoint`].
    fn keep_seen(&mut self, _: &mut Snapshot) {}
}

/// Another run of the scene, with longer steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OtherRun {
    /// The comparison run, which [`Observer::on_comparison`] has received; its errors are larger by this factor.
    Comparison(f64),
    /// The run before [`Observer::restart`], likewise.
    Before(f64),
    /// The pilot run that [`crate::Run::compare_with`] has received, likewise.
    Pilot(f64),
}

impl Observer for () {
    fn on_step(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }
}
