//! One stage after the other: each begins with the state that the one before has reached.

use std::collections::BTreeSet;
use std::io;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::load::{Loaded, model_stage};
use super::verdict::{
    MissedStop, early_stop, energy_line, energy_warning, has_blown_up, missed_stop, overshoot_warning, rest_warning,
    ringing_warning, rows_warning, work_warning,
};
use super::watchers::{Watchers, stage_begins};
use base::names::{instant, to_digits};
use base::snapshot::{Keep, Snapshot, keep};
use mechanics::state::State;
use model::{self, Model};
use results::checkpoint::Checkpoint;
use results::collected::Collected;
use results::{listed, settle_cadence, wanted_with};
use solve::plan::Plan;
use solve::plan::explain::{Explanation, explain};
use solve::system::System;
use solve::{Counts, Failure, Handover, Outcome, Run, StepError, Warning};

/// The reports of the stages of a run for its end.
#[derive(Default)]
pub struct StagesTold {
    /// Warnings about the results.
    pub warnings: Vec<String>,
    /// What was not judged.
    pub remarks: Vec<String>,
    /// The change of energy by time integration, in a line for each stage.
    pub energy: Vec<String>,
    /// True where time integration has made most of the energy of a stage.
    pub has_blown_up: bool,
    /// The effort of all.
    pub counts: Counts,
    /// Time spent on output.
    pub observing: Duration,
    /// Largest departure from orthogonality of a truncated rotation update.
    pub rotation_drift: f64,
    /// Largest gap of a joint; `None` without joints.
    pub joint_violation: Option<f64>,
    /// The number of failed elements and links; `None` if none can fail.
    pub failed: Option<usize>,
    /// The error of automatic steps, in the last stage that has them.
    pub step_error: Option<StepError>,
    /// The `stop` of each stage or path that ended before it.
    pub missed: Vec<String>,
    /// Time of the first unstable equilibrium.
    pub unstable_from: Option<f64>,
    /// The plan of the current stage; `None` where nobody reads it.
    pub plan: Option<Explanation>,
    /// The plans of later stages as far as they differ from those before, line by line.
    pub plans: Vec<String>,
    /// Names of the contacts that have touched in some stage, and of those that have not in some stage.
    pub contacts: [Vec<String>; 2],
}

keep!(StagesTold {
    warnings, remarks, energy, has_blown_up, counts, rotation_drift, joint_violation, failed, step_error, missed, unstable_from, contacts,
} without { observing, plan, plans });

impl StagesTold {
    /// Notes the plan of the next stage, and returns its lines as far as they differ from those before; none where nobody reads them.
    fn explain(&mut self, model: &Model, plan: &Plan, system: &System) -> Vec<String> {
        let Some(before) = &mut self.plan else { return Vec::new() };
        let text = explained_stage(model, plan, system);
        let lines: Vec<String> = text.beyond(before).to_string().lines().map(str::to_owned).collect();
        self.plans.push(stage_begins(model));
        self.plans.extend_from_slice(&lines);
        *before = text;
        lines
    }
}

/// The plan of a stage, with its output.
pub fn explained_stage(model: &Model, plan: &Plan, system: &System) -> Explanation {
    let mut text = explain(plan, model, system);
    text.computed.push(("output", listed(model, plan)));
    text
}

/// A stage that has come to its end before a checkpoint.
#[derive(Debug, Default)]
struct PastStage {
    /// The state at its end.
    state: State,
    /// The effort up to then.
    counts: Counts,
    /// Other state for the next stage, as [`Run::keep_end`] has it.
    left: Vec<u8>,
}

keep!(PastStage: Default { state, counts, left });

/// The way through the stages so far.
#[derive(Default)]
struct Course {
    /// The stages that have come to their ends.
    past: Vec<PastStage>,
    /// The stages in a checkpoint that have not been passed again, the last first.
    recalled: Vec<PastStage>,
    /// The checkpoint in the stage after these; `None` once it has been taken up.
    checkpoint: Option<Checkpoint>,
}

impl Course {
    /// The way to a checkpoint, or from the beginning.
    fn to(checkpoint: Option<Checkpoint>) -> io::Result<Course> {
        let mut course = Course { checkpoint, ..Course::default() };
        if let Some(checkpoint) = &course.checkpoint {
            // Reports up to a checkpoint are read when the run continues.
            let mut told = StagesTold::default();
            let mut snapshot = Snapshot::of(checkpoint.stages.clone());
            course.recalled.keep(&mut snapshot);
            told.keep(&mut snapshot);
            if !snapshot.is_used_up() {
                return Err(unfit());
            }
            course.recalled.reverse();
        }
        Ok(course)
    }

    /// The part of this that a checkpoint in the current stage must hold.
    fn so_far(&mut self, told: &mut StagesTold) -> Vec<u8> {
        let mut snapshot = Snapshot::taken();
        self.past.keep(&mut snapshot);
        told.keep(&mut snapshot);
        snapshot.into_bytes()
    }
}

/// The error that a checkpoint is not one of this deck.
fn unfit() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the checkpoint does not fit the deck")
}

impl StagesTold {
    /// Takes account of a stage that has ended.
    fn take(&mut self, run: &Run, model: &Model, outcome: &Outcome, end_time: Option<f64>) {
        let stage = match model_stage(model) {
            "" => String::new(),
            name => format!("stage `{name}`: "),
        };
        let warnings = run.warnings().iter().map(ToString::to_string);
        self.warnings.extend(warnings.map(|text| format!("{stage}{text}")));
        self.remarks.extend(run.remarks().iter().map(|remark| format!("{stage}{remark}")));
        if !stage.is_empty() && model.analysis.has_modes() {
            (self.counts, self.observing) = (run.counts(), self.observing + run.observing());
            return;
        }
        let effort = run.counts().since(&self.counts);
        // Without a step, as after a signal before the first one, nothing could move.
        let at_rest = rest_warning(run.balance(), model).filter(|_| stage.is_empty() && effort.steps > 0);
        // The reason of a run that fails by it names the growth of energy once.
        let is_lost = matches!(outcome, Outcome::Failed { failure: Failure::EnergyGrowth { .. }, .. });
        let balance = Some(run.balance()).filter(|_| !is_lost);
        let of_energy = balance.and_then(|balance| energy_warning(balance, model));
        let of_run = of_energy.into_iter().chain(at_rest).chain(work_warning(run));
        let of_stage = left_held(run, model, end_time).into_iter().chain(weight_left(run, model, end_time));
        let of_run =
            of_run.chain(ringing_warning(effort, model)).chain(overshoot_warning(run)).chain(rows_warning(run, model));
        self.warnings.extend(of_run.chain(of_stage).map(|text| format!("{stage}{text}")));
        self.has_blown_up |= has_blown_up(run.balance());
        self.energy
            .extend(balance.and_then(|balance| energy_line(balance, model)).map(|line| format!("{stage}{line}")));
        if !model.analysis.has_modes() {
            self.contacts.iter_mut().zip(run.contacts()).for_each(|(all, of_stage)| all.extend(of_stage));
        }
        self.remarks.extend(early_stop(model, run, effort.steps).map(|text| format!("{stage}{text}")));
        self.counts = run.counts();
        self.observing += run.observing();
        self.rotation_drift = self.rotation_drift.max(run.rotation_drift());
        self.joint_violation = self.joint_violation.into_iter().chain(run.joint_violation()).reduce(f64::max);
        self.failed = run.broken().or(self.failed);
        self.step_error = run.step_error().or(self.step_error);
        let unstable = run.warnings().iter().filter_map(Warning::unstable_from);
        self.unstable_from = unstable.chain(self.unstable_from).reduce(f64::min);
        let missed =
            end_time.filter(|_| matches!(outcome, Outcome::Done)).and_then(|time| missed_stop(model, run, time));
        if let Some(MissedStop { words, required }) = missed {
            let told = if required { &mut self.missed } else { &mut self.remarks };
            told.push(format!("{stage}{words}"));
        }
    }

    /// Says of contacts that nothing touched in the whole run: a note where another did, or else a warning.
    pub fn tell_untouched(&mut self, outcome: &Outcome) {
        if !matches!(outcome, Outcome::Done) {
            return;
        }
        let [touched, open] = std::mem::take(&mut self.contacts);
        let open: BTreeSet<String> = open.into_iter().filter(|name| !touched.contains(name)).collect();
        if open.is_empty() {
            return;
        }
        let names = open.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let what = if open.len() == 1 { "contact" } else { "contacts" };
        match touched.is_empty() {
            true => self.warnings.push(format!(
                "nothing ever touched in {what} {names}. Look at the place and the direction of the motion, or remove the table"
            )),
            false => self.remarks.push(format!("nothing ever touched in {what} {names}")),
        }
    }
}

/// Reports a static stage that stopped before its end while it was still unloading.
fn left_held(run: &Run, model: &Model, end_time: Option<f64>) -> Option<String> {
    let holds_back = model.analysis.stage.as_ref()?.holds_back;
    // A path may pass the end, and go back beyond the beginning.
    let left = ((model.analysis.end_time - end_time?) / model.analysis.duration()).min(1.0);
    (holds_back && left > 0.0 && run.has_stopped() == Some(true)).then(|| {
        let part = to_digits(100.0 * left, 2);
        format!(
            "it stopped while forces that were out of balance at its beginning were still going: {part} % of them are left. Let it run to its \
             end; else a later static stage removes these forces, and a dynamic one releases them suddenly"
        )
    })
}

/// Reports a static stage that stopped before gravity was complete: no later stage adds the rest.
fn weight_left(run: &Run, model: &Model, end_time: Option<f64>) -> Option<String> {
    let analysis = &model.analysis;
    let stage = analysis.stage.as_ref()?;
    let grows = !analysis.is_dynamic() && model.loading.gravity_amplitude == Some(stage.own_amplitude);
    let part = (end_time? - analysis.begin) / analysis.duration();
    (grows && part < 1.0 && run.has_stopped() == Some(true) && model.loading.gravity.norm() > 0.0).then(|| {
        let part = to_digits(100.0 * part, 2);
        format!(
            "it stopped while gravity was growing, so gravity stays at {part} % of its value. Apply it in an earlier stage, or by \
             `gravity_amplitude`"
        )
    })
}

/// The next stage with time, ready for planning.
struct NextStage {
    model: Model,
    system: System,
    /// Its initial state; `None` at t = 0.
    handover: Option<Handover>,
}

/// The event after a stage.
enum Next {
    Stage(Box<NextStage>),
    End(Outcome),
}

/// Runs the stages of a deck.
pub struct StageRunner<'a> {
    /// The deck.
    pub loaded: &'a Loaded,
    /// Number of threads.
    pub threads: usize,
    /// The flag that ends a run.
    pub stop: &'a AtomicBool,
    /// The numbers that are found in the rows of every step.
    pub numbers: &'a [Collected],
}

impl StageRunner<'_> {
    /// Runs the first stage, and the others as long as each reaches its end; or continues from a checkpoint in any of them.
    ///
    /// # Errors
    /// Results cannot be written, the checkpoint does not fit, or there is no memory for the solver of a stage.
    pub fn run(
        &self,
        first: &mut Run,
        checkpoint: Option<Checkpoint>,
        (watchers, told): (&mut Watchers, &mut StagesTold),
    ) -> io::Result<Outcome> {
        let Loaded { model, .. } = self.loaded;
        let mut course = Course::to(checkpoint)?;
        if model.analysis.stage.is_some() && course.checkpoint.is_none() {
            watchers.log.say(&stage_begins(model))?;
        }
        let mut ends = Vec::new();
        let ended = self.run_stage((model, first), &mut course, (watchers, told))?;
        let mut next = self.next_stage((model, first), ended, (&mut ends, &mut course), (watchers, told))?;
        loop {
            let NextStage { mut model, system, handover } = match next {
                Next::Stage(stage) => *stage,
                Next::End(outcome) => return Ok(outcome),
            };
            let plan = self.begin(&mut model, &system, &course, (watchers, told))?;
            let made = Run::new(&model, &system, &plan, wanted_with(&model, self.numbers), self.stop);
            let mut run = made.map_err(|error| io::Error::other(error.to_string()))?;
            run.go_on_from(handover);
            let ended = self.run_stage((&model, &mut run), &mut course, (watchers, told))?;
            next = self.next_stage((&model, &run), ended, (&mut ends, &mut course), (watchers, told))?;
        }
    }

    /// Runs a stage, goes on in it from a checkpoint, or recalls how it ended before that.
    fn run_stage(
        &self,
        (model, run): (&Model, &mut Run),
        course: &mut Course,
        (watchers, told): (&mut Watchers, &mut StagesTold),
    ) -> io::Result<(Outcome, Option<State>)> {
        if let Some(past) = course.recalled.pop() {
            run.keep_end(&mut Snapshot::of(past.left.clone()));
            run.forget_matrix();
            told.counts = past.counts;
            let state = past.state.clone();
            course.past.push(past);
            return Ok((Outcome::Done, Some(state)));
        }
        if let Some(checkpoint) = course.checkpoint.take() {
            let mut snapshot = Snapshot::of(checkpoint.stages);
            course.past.keep(&mut snapshot);
            told.keep(&mut snapshot);
            watchers.go_on(model, checkpoint.watchers)?;
            run.resume(checkpoint.run);
        }
        if let Some(checkpoints) = &mut watchers.checkpoints {
            checkpoints.begin_stage(course.so_far(told));
        }
        let (outcome, state) = run.run(watchers);
        // Later stages have other matrices.
        run.forget_matrix();
        told.take(run, model, &outcome, state.as_ref().map(|state| state.time));
        // A checkpoint in a later stage needs the end of this one; the last stage has no successor.
        let has_later = course.past.len() < self.loaded.later.len();
        if let (Outcome::Done, Some(state), true) = (&outcome, &state, has_later) {
            let mut left = Snapshot::taken();
            run.keep_end(&mut left);
            course.past.push(PastStage { state: state.clone(), counts: told.counts, left: left.into_bytes() });
        }
        Ok((outcome, state))
    }

    /// Plans a stage and lets the watchers know, unless it lies before a checkpoint.
    fn begin(
        &self,
        model: &mut Model,
        system: &System,
        course: &Course,
        (watchers, told): (&mut Watchers, &mut StagesTold),
    ) -> io::Result<Plan> {
        let plan = Plan::new(model, system, self.threads);
        settle_cadence(model, &plan);
        let lines = told.explain(model, &plan, system);
        match course.checkpoint {
            None => {
                watchers.next_stage(model)?;
                lines.iter().try_for_each(|line| watchers.log.say(line))?;
            }
            Some(_) => watchers.expectations.next_stage(model),
        }
        Ok(plan)
    }

    /// Passes the state to the next stage with time, and computes the modes about it if stages between request them. `ends` are the end
    /// times of the stages.
    fn next_stage(
        &self,
        (before, run): (&Model, &Run),
        (mut outcome, state): (Outcome, Option<State>),
        (ends, course): (&mut Vec<f64>, &mut Course),
        (watchers, told): (&mut Watchers, &mut StagesTold),
    ) -> io::Result<Next> {
        let Some(state) = state else { return Ok(Next::End(outcome)) };
        while let (Outcome::Done, Some(planned)) = (&outcome, self.loaded.later.get(ends.len())) {
            let (begin, end) = (before.analysis.begin, state.time);
            if end < begin {
                return Ok(Next::End(Outcome::Failed { failure: Failure::TimeWentBack { begin, end }, time: end }));
            }
            ends.push(end);
            // Where a stage has ended at another time, later ones begin then, and the amplitudes of its loads end there.
            let mut model = match self.went_as_planned(ends) {
                true => planned.clone(),
                false => self.planned_anew(ends, planned)?,
            };
            // Where modes come first, nothing has happened yet.
            let (system, handover) = match before.analysis.has_modes() {
                true => (System::new(&model).map_err(io::Error::other)?, None),
                false => {
                    let handed = run.hand_over((&state, told.counts), &mut model).map_err(io::Error::other)?;
                    (handed.0, Some(handed.1))
                }
            };
            if !model.analysis.has_modes() {
                return Ok(Next::Stage(Box::new(NextStage { model, system, handover })));
            }
            let plan = self.begin(&mut model, &system, course, (watchers, told))?;
            let made = Run::new(&model, &system, &plan, wanted_with(&model, self.numbers), self.stop);
            let mut modes = made.map_err(|error| io::Error::other(error.to_string()))?;
            modes.go_on_from(handover);
            outcome = self.run_stage((&model, &mut modes), course, (watchers, told))?.0;
        }
        Ok(Next::End(outcome))
    }

    /// True where all stages have ended as planned. Paths find their ends.
    fn went_as_planned(&self, ends: &[f64]) -> bool {
        let Loaded { model, later, .. } = self.loaded;
        let ended = std::iter::once(model).chain(later);
        let kept = |((end, of), next): ((&f64, &Model), &Model)| {
            *end == next.analysis.begin && !of.analysis.step_length.is_arc_length()
        };
        ends.iter().zip(ended).zip(later).all(kept)
    }

    /// The model of the next stage, planned again for the actual ends of the earlier stages.
    fn planned_anew(&self, ends: &[f64], planned: &Model) -> io::Result<Model> {
        model::replan(&self.loaded.source, ends, planned).map_err(|why| {
            let at = ends.last().copied().map(instant).unwrap_or_default();
            io::Error::other(format!("no stage can begin at t = {at}: {why}"))
        })
    }
}
