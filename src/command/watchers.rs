//! All who watch a run: the log, the files, the expectations, the errors and the terminal.

use super::checkpoints::Checkpoints;
use super::load::model_stage;
use super::modes_told::lines;
use base::names::instant;
use base::snapshot::{Keep, Snapshot};
use model::Model;
use results::error_bars::ErrorBars;
use results::expect::Expectations;
use results::log::Log;
use results::progress::Progress;
use results::{Files, FilesMark};
use solve::{Frame, Observer, OtherRun};
use std::io;

/// All watchers of the run, in the order of their calls.
pub struct Watchers {
    /// The log of the run.
    pub log: Log,
    /// The tables and fields that grow with it.
    pub files: Files,
    /// The values that the deck expects.
    pub expectations: Expectations,
    /// The errors in the largest values, if there is an estimate.
    pub bars: Option<ErrorBars>,
    /// The bar on the terminal.
    pub progress: Progress,
    /// The modes in lines for the terminal, stage by stage.
    pub modes: Vec<String>,
    /// Where the run is to be able to go on after a stop.
    pub checkpoints: Option<Checkpoints>,
}

impl Watchers {
    /// The watchers of a run of this model; with `bars`, errors are estimated. For a continued run, [`Watchers::go_on`] sets the place of the
    /// continuation.
    pub fn new(log: Log, files: Files, model: &Model, [quiet, bars]: [bool; 2]) -> Watchers {
        Watchers {
            log,
            files,
            expectations: Expectations::new(model),
            bars: bars.then(|| ErrorBars::new(model)),
            progress: Progress::new(quiet),
            modes: Vec::new(),
            checkpoints: None,
        }
    }

    /// Goes on from a checkpoint in the stage of this model.
    ///
    /// # Errors
    /// A file has changed since the checkpoint.
    pub fn go_on(&mut self, model: &Model, checkpoint: Vec<u8>) -> io::Result<()> {
        let (mut snapshot, mut mark) = (Snapshot::of(checkpoint), FilesMark::default());
        mark.keep(&mut snapshot);
        self.keep_rest(&mut snapshot);
        if !snapshot.is_used_up() {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "the checkpoint does not fit the deck"));
        }
        self.files.go_on(model, mark)
    }

    /// Keeps the state besides the files in a checkpoint.
    fn keep_rest(&mut self, snapshot: &mut Snapshot) {
        let Watchers { log, expectations, bars, files: _, progress: _, modes: _, checkpoints: _ } = self;
        log.keep(snapshot);
        expectations.keep(snapshot);
        bars.keep(snapshot);
    }
}

impl Watchers {
    /// Goes on with the next stage, whose model this is.
    ///
    /// # Errors
    /// A file cannot be made or written.
    pub fn next_stage(&mut self, model: &Model) -> io::Result<()> {
        self.log.sum_up()?;
        self.log.say(&stage_begins(model))?;
        self.expectations.next_stage(model);
        self.files.next_stage(model)
    }
}

/// A line on the stage of a model.
pub fn stage_begins(model: &Model) -> String {
    let analysis = &model.analysis;
    if analysis.has_modes() {
        let kind = if analysis.buckles() { "buckling" } else { "modal" };
        return format!("stage `{}`, {kind}, at t = {}", model_stage(model), instant(analysis.end_time));
    }
    let kind = if analysis.is_static() { "static" } else { "dynamic" };
    format!(
        "stage `{}`, {kind}, from t = {} to {}",
        model_stage(model),
        instant(analysis.begin),
        instant(analysis.end_time)
    )
}

impl Observer for Watchers {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_step(frame)?;
        self.progress.on_step(frame)?;
        self.log.on_step(frame)?;
        self.bars.iter_mut().try_for_each(|bars| bars.on_step(frame))?;
        self.files.on_step(frame)
    }

    fn on_cutback(&mut self, time: f64) {
        self.progress.on_cutback(time);
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_modes(frame)?;
        let told = frame.modes.map_or(Vec::new(), |modes| lines(modes, frame.model));
        told.iter().try_for_each(|line| self.log.say(line))?;
        self.modes.extend(told);
        self.files.on_modes(frame)
    }

    fn on_response(&mut self, frame: &Frame) -> io::Result<()> {
        self.files.on_response(frame)
    }

    fn wants_checkpoint(&mut self, at_end: bool) -> bool {
        self.checkpoints.as_ref().is_some_and(|checkpoints| checkpoints.is_due(at_end))
    }

    fn on_checkpoint(&mut self, run: &[u8], at_end: bool) -> io::Result<()> {
        if self.checkpoints.is_none() {
            return Ok(());
        }
        let mut snapshot = Snapshot::taken();
        self.files.mark()?.keep(&mut snapshot);
        self.keep_rest(&mut snapshot);
        match &mut self.checkpoints {
            Some(checkpoints) => checkpoints.write(snapshot.into_bytes(), (run, at_end)),
            None => Ok(()),
        }
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        // The tables of the checkpoint are about to go.
        self.checkpoints.iter_mut().try_for_each(Checkpoints::withdraw)?;
        self.log.sum_up()?;
        let why = match model.analysis.begin {
            0.0 => "the steps leave more error than error_tolerance: the run begins again at t = 0, with shorter steps"
                .to_owned(),
            begin => format!(
                "the steps leave more error than error_tolerance: the stage begins again at t = {}, with shorter steps",
                instant(begin)
            ),
        };
        self.log.say(&why)?;
        self.progress.begin_again(&why);
        self.expectations.restart(model)?;
        self.bars.iter_mut().try_for_each(|bars| bars.restart(model))?;
        self.files.restart(model)
    }

    fn times_to_compare(&self) -> Vec<f64> {
        let of_bars = self.bars.iter().flat_map(|bars| bars.times_to_compare());
        self.expectations.times_to_compare().into_iter().chain(of_bars).collect()
    }

    fn begin_comparison(&mut self) {
        self.expectations.begin_comparison();
        self.bars.iter_mut().for_each(Observer::begin_comparison);
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_comparison(frame)?;
        self.bars.iter_mut().try_for_each(|bars| bars.on_comparison(frame))
    }

    fn on_other_run(&mut self, other: Option<OtherRun>) {
        self.expectations.on_other_run(other);
        if let Some(bars) = &mut self.bars {
            bars.on_other_run(other);
        }
    }
}
