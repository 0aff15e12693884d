//! One stage after the other: each begins with the state that the one before has reached.

use std::io;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::load::{Loaded, model_stage};
use super::verdict::{energy_line, energy_warning, short_of_stop, work_warning};
use super::watchers::{Watchers, stage_begins};
use crate::model::{self, AnalysisKind, Model};
use crate::names::{instant, to_digits};
use crate::output::{settle_cadence, wanted};
use crate::plan::Plan;
use crate::solve::{Counts, Handover, Outcome, Run, StepError};
use crate::state::State;
use crate::system::System;

/// What the stages of a run, or its only one, have left to be told at the end.
#[derive(Default)]
pub struct StagesTold {
    /// Doubts about the results.
    pub warnings: Vec<String>,
    /// What was not judged.
    pub remarks: Vec<String>,
    /// What time integration took from the energy, in a line for each stage.
    pub energy: Vec<String>,
    /// The effort of all.
    pub counts: Counts,
    /// Time spent on output.
    pub observing: Duration,
    /// Largest departure from orthogonality of a truncated rotation update.
    pub rotation_drift: f64,
    /// Largest gap of a joint; `None` without joints.
    pub joint_violation: Option<f64>,
    /// The error of automatic steps, in the last stage that has them.
    pub step_error: Option<StepError>,
    /// Says of a path that it ended before its `stop`.
    pub short: Option<String>,
}

impl StagesTold {
    /// Takes account of a stage that has ended.
    fn take(&mut self, run: &Run, model: &Model, end_time: Option<f64>) {
        let stage = match model_stage(model) {
            "" => String::new(),
            name => format!("stage `{name}`: "),
        };
        let doubts = run.warnings().iter().map(ToString::to_string);
        self.warnings.extend(doubts.map(|text| format!("{stage}{text}")));
        self.remarks.extend(run.remarks().iter().map(|remark| format!("{stage}{remark}")));
        if !stage.is_empty() && model.analysis.modes.is_some() {
            (self.counts, self.observing) = (run.counts(), self.observing + run.observing());
            return;
        }
        let of_run = energy_warning(run.balance(), model).into_iter().chain(work_warning(run));
        let of_stage = stop_missed(run, model)
            .into_iter()
            .chain(left_held(run, model, end_time))
            .chain(weight_left(run, model, end_time));
        self.warnings.extend(of_run.chain(of_stage).map(|text| format!("{stage}{text}")));
        self.energy.extend(energy_line(run.balance(), model).map(|line| format!("{stage}{line}")));
        self.counts = run.counts();
        self.observing += run.observing();
        self.rotation_drift = self.rotation_drift.max(run.rotation_drift());
        self.joint_violation = self.joint_violation.into_iter().chain(run.joint_violation()).reduce(f64::max);
        self.step_error = run.step_error().or(self.step_error);
        self.short = end_time.and_then(|time| short_of_stop(model, run, time));
    }
}

/// Says of a stage that its time was over before it came to its `stop`.
fn stop_missed(run: &Run, model: &Model) -> Option<String> {
    let stop = model.analysis.stage.as_ref()?.stop.as_ref()?;
    let missed = run.has_stopped() == Some(false);
    missed.then(|| format!("{} did not come to {} before the stage was over", stop.label, stop.value))
}

/// Says of a static stage that stopped before its time what it was still taking off.
fn left_held(run: &Run, model: &Model, end_time: Option<f64>) -> Option<String> {
    let holds_back = model.analysis.stage.as_ref()?.holds_back;
    let left = (model.analysis.end_time - end_time?) / model.analysis.duration();
    (holds_back && run.has_stopped() == Some(true)).then(|| {
        let part = to_digits(100.0 * left, 2);
        format!(
            "it stopped while forces that were out of balance at its beginning were still going: {part} % of them are left. A static stage \
             after it takes these off, a dynamic one lets them go at once"
        )
    })
}

/// Says of a static stage that stopped before its time that gravity had not come in full: nothing brings on the rest.
fn weight_left(run: &Run, model: &Model, end_time: Option<f64>) -> Option<String> {
    let analysis = &model.analysis;
    let stage = analysis.stage.as_ref()?;
    let grows = analysis.kind == AnalysisKind::Static && model.loading.gravity_amplitude == Some(stage.own_amplitude);
    let part = (end_time? - analysis.begin) / analysis.duration();
    (grows && part < 1.0 && run.has_stopped() == Some(true) && model.loading.gravity.norm() > 0.0).then(|| {
        let part = to_digits(100.0 * part, 2);
        format!(
            "it stopped while gravity was growing, which stays at {part} % of it: bring it on in a stage of its own, or by `gravity_amplitude`"
        )
    })
}

/// The next stage in which time passes, ready to be planned.
struct NextStage {
    model: Model,
    system: System,
    /// What it begins with; `None` at t = 0.
    handover: Option<Handover>,
}

/// What comes after a stage.
enum Next {
    Stage(Box<NextStage>),
    End(Outcome),
}

/// What runs the stages of a deck.
pub struct StageRunner<'a> {
    /// The deck.
    pub loaded: &'a Loaded,
    /// Number of threads.
    pub threads: usize,
    /// The flag that ends a run.
    pub stop: &'a AtomicBool,
}

impl StageRunner<'_> {
    /// Runs the first stage, or the only one, and then the others as long as each comes to its end.
    ///
    /// # Errors
    /// Results cannot be written, or there is no memory for the solver of a stage.
    pub fn run(&self, first: &mut Run, watchers: &mut Watchers, told: &mut StagesTold) -> io::Result<Outcome> {
        let Loaded { model, .. } = self.loaded;
        let mut ends = Vec::new();
        if model.analysis.stage.is_some() {
            watchers.log.say(&stage_begins(model))?;
        }
        let ended = first.run(watchers);
        told.take(first, model, ended.1.as_ref().map(|state| state.time));
        let mut next = self.next_stage((model, first), ended, &mut ends, (watchers, told))?;
        loop {
            let NextStage { mut model, system, handover } = match next {
                Next::Stage(stage) => *stage,
                Next::End(outcome) => return Ok(outcome),
            };
            let plan = self.begin(&mut model, &system, watchers)?;
            let made = Run::new(&model, &system, &plan, wanted(&model), self.stop);
            let mut run = made.map_err(|error| io::Error::other(error.to_string()))?;
            run.go_on_from(handover);
            let ended = run.run(watchers);
            told.take(&run, &model, ended.1.as_ref().map(|state| state.time));
            next = self.next_stage((&model, &run), ended, &mut ends, (watchers, told))?;
        }
    }

    /// Plans a stage and lets the watchers know.
    fn begin(&self, model: &mut Model, system: &System, watchers: &mut Watchers) -> io::Result<Plan> {
        let plan = Plan::new(model, system, self.threads);
        settle_cadence(model, &plan);
        watchers.next_stage(model)?;
        Ok(plan)
    }

    /// Hands the state over to the next stage in which time passes, after the modes about it where stages between ask for them. `ends` are
    /// the times at which stages have ended.
    fn next_stage(
        &self,
        (before, run): (&Model, &Run),
        (mut outcome, state): (Outcome, Option<State>),
        ends: &mut Vec<f64>,
        (watchers, told): (&mut Watchers, &mut StagesTold),
    ) -> io::Result<Next> {
        let Some(state) = state else { return Ok(Next::End(outcome)) };
        while let (Outcome::Done, Some(planned)) = (&outcome, self.loaded.later.get(ends.len())) {
            ends.push(state.time);
            let mut model = match planned.analysis.begin == state.time {
                true => planned.clone(),
                // The stage has stopped before its time: all others come earlier.
                false => self.planned_anew(ends, planned)?,
            };
            // Where modes come first, nothing has happened yet.
            let (system, handover) = match before.analysis.modes {
                Some(_) => (System::new(&model).map_err(io::Error::other)?, None),
                None => {
                    let handed = run.hand_over((&state, told.counts), &mut model).map_err(io::Error::other)?;
                    (handed.0, Some(handed.1))
                }
            };
            if model.analysis.modes.is_none() {
                return Ok(Next::Stage(Box::new(NextStage { model, system, handover })));
            }
            let plan = self.begin(&mut model, &system, watchers)?;
            let made = Run::new(&model, &system, &plan, wanted(&model), self.stop);
            let mut modes = made.map_err(|error| io::Error::other(error.to_string()))?;
            modes.go_on_from(handover);
            let (ended, at) = modes.run(watchers);
            told.take(&modes, &model, at.map(|state| state.time));
            outcome = ended;
        }
        Ok(Next::End(outcome))
    }

    /// The model of the next stage, which was planned otherwise, after those that have ended at these times.
    fn planned_anew(&self, ends: &[f64], planned: &Model) -> io::Result<Model> {
        model::replan(&self.loaded.source, ends, planned).map_err(|why| {
            let at = ends.last().copied().map(instant).unwrap_or_default();
            io::Error::other(format!("no stage can begin at t = {at}: {why}"))
        })
    }
}
