//! A run of one scene from t = 0 to the end time.

use super::context::Context;
use super::control::{Controller, Schedule, comparison_times};
use super::derived::Wanted;
use super::energy_growth::checks_energy_growth;
use super::frame::{Observer, OtherRun};
use super::handover::{EndedStage, Handover, hand_over};
use super::march::March;
use super::modes;
use super::outcome::{Counts, Outcome};
use super::recorder::Recorder;
use super::sample::Samples;
use super::start::start;
use super::start_of_stage::start_stage;
use super::stop_watch::StopWatch;
use super::trials::{FEW, Kept, LOOSER, MOST_LONGER, MOST_RUNS, StepError, Trace, Unseen};
use super::warning::{Remark, Warnings};
use super::workspace::Workspace;
use crate::linear::TooLarge;
use crate::model::{AnalysisKind, Model, StepLength};
use crate::plan::Plan;
use crate::state::State;
use crate::system::System;
use crate::system::energy::Balance;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Into how many the intervals between the times at which steps must end are cut, in the run under way and the one before.
#[derive(Debug, Clone, Copy)]
struct Pieces {
    now: usize,
    before: usize,
}

/// A run of one scene. Whatever its steps need is allocated when it is made.
pub struct Run<'a> {
    context: Context<'a>,
    workspace: Workspace,
    controller: Controller<'a>,
    recorder: Recorder,
    wanted: Wanted,
    step_error: Option<StepError>,
    /// What the stage begins with; `None` for a run from t = 0.
    handover: Option<Handover>,
    /// What ends the stage before its time.
    stop_watch: Option<StopWatch>,
    stop: &'a AtomicBool,
}

impl<'a> Run<'a> {
    /// Prepares a run that shows the `wanted` quantities; it ends early where `stop` is raised.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(
        model: &'a Model,
        system: &'a System,
        plan: &'a Plan,
        wanted: Wanted,
        stop: &'a AtomicBool,
    ) -> Result<Self, TooLarge> {
        let wants_energy = wanted.has(Wanted::ENERGY);
        // Load steps are judged by their work.
        let is_static = model.analysis.kind == AnalysisKind::Static;
        let wants_forces = is_static || wanted.has(Wanted::REACTIONS) || wants_energy || checks_energy_growth(model);
        let context = Context::new(model, plan, system, wants_forces, wants_energy);
        let mut workspace = Workspace::new(&context)?;
        let controller = Controller::new(&context, &mut workspace)?;
        let recorder = Recorder::new(model, wanted);
        let stop_watch = StopWatch::new(&context);
        Ok(Run { context, workspace, controller, recorder, wanted, step_error: None, handover: None, stop_watch, stop })
    }

    /// Lets the run begin with what the stage before has left; with `None` it begins at t = 0.
    pub fn go_on_from(&mut self, handover: Option<Handover>) {
        self.handover = handover;
    }

    /// Runs to the end, to a failure, or until stopped. Returns the outcome and the last state; none where the run did
    /// not start. Where steps follow a tolerance, their error is estimated by a second run, and the run is made again where it is
    /// too large.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        match (&self.context.model.analysis.step_length, self.controller.by_tolerance()) {
            (&StepLength::ErrorControlled { tolerance, .. }, Some(_)) => self.within(tolerance, observer),
            _ => self.once(observer, &Schedule::new(self.context.model, std::iter::empty(), false)),
        }
    }

    /// One run as scheduled.
    fn once(&mut self, observer: &mut dyn Observer, schedule: &Schedule) -> (Outcome, Option<State>) {
        let Run { context: cx, workspace: ws, controller, recorder, handover, stop_watch, stop, .. } = self;
        let began = match handover {
            Some(handover) => start_stage(cx, ws, handover),
            None => start(cx, ws),
        };
        let mut state = match began {
            Ok(state) => state,
            Err(failure) => return (Outcome::Failed { time: cx.model.analysis.begin, failure }, None),
        };
        recorder.begin(cx, &state, handover.as_ref());
        let samples = Samples::new(&schedule.samples);
        let stop_watch = stop_watch.as_mut().filter(|_| !recorder.is_trial);
        let mut march = March { cx, ws, state: &mut state, recorder, observer, samples, stop_watch, stop };
        let mut outcome = modes::lead(controller, &mut march, schedule);
        if !matches!(outcome, Err(Outcome::Io(_))) {
            outcome = march.recorder.close(march.cx, march.ws, march.state, march.observer).and(outcome);
        }
        recorder.count_work(ws);
        (outcome.err().unwrap_or(Outcome::Done), Some(state))
    }

    /// Runs with steps that follow a tolerance until the error is the one asked for.
    fn within(&mut self, asked: f64, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let model = self.context.model;
        let power = model.solution.scheme.order() + 1;
        let inside = self.controller.looks_inside();
        let times = || comparison_times(&model.analysis);
        let mut schedule = Schedule::new(model, times(), inside);
        let mut error = StepError::new(asked);
        let mut before: Option<Kept> = None;
        let mut pieces = Pieces { now: 1, before: 1 };
        self.follow(asked, None);
        loop {
            let mut trace = Trace::new(observer, power);
            let (outcome, state) = self.once(&mut trace, &schedule);
            let run = trace.into_kept();
            // What fails with shorter steps did come to its end with those before.
            if before.is_some() && matches!(outcome, Outcome::Failed { .. }) {
                return self.settle(error, &Schedule::new(model, times(), inside).cut(pieces.before), observer);
            }
            if !matches!(outcome, Outcome::Done) {
                return (outcome, state);
            }
            let other = match self.other_run(&run, before.take(), &mut error, observer) {
                Ok(other) => other,
                Err(outcome) => return (outcome, state),
            };
            let next = match &other {
                Some((_, other)) => error.judge(&run, other, self.context.length),
                None => Some(error.without_trial()),
            };
            let dictated = other.as_ref().is_some_and(|(_, other)| run.has_steps_of(other));
            observer.on_other_run(other.filter(|_| error.estimate.is_some()).map(|(which, _)| which));
            // Jumps and kinks of loads dictate most steps: only shorter ones between them tell anything.
            pieces = Pieces { before: pieces.now, now: if dictated { 2 * pieces.now } else { pieces.now } };
            let next = if dictated { Some(error.tolerance) } else { next };
            let Some(tolerance) = next.filter(|_| error.others < MOST_RUNS) else {
                self.workspace.warnings.extend(error.doubt());
                self.step_error = Some(error);
                return (outcome, state);
            };
            let most_steps = MOST_LONGER * self.recorder.own().steps;
            // Steps that no tolerance limits shrink as well, or the run would be the same again.
            let compared = if inside { observer.times_to_compare() } else { Vec::new() };
            schedule = Schedule::new(model, times().chain(compared), inside).cut(pieces.now);
            let longest = run.longest() * (tolerance / error.tolerance).powf(1.0 / (power - 1) as f64);
            if let Err(error) = self.begin_again(&mut error, (tolerance, Some(longest)), observer) {
                return (Outcome::Io(error), state);
            }
            self.recorder.most_steps = most_steps;
            before = Some(run);
        }
    }

    /// The run that tells the error of this one: that before, or a trial; `None` where the trial does not come to its end.
    ///
    /// # Errors
    /// The outcome that ends the run: a signal, or a fault of the observer.
    fn other_run(
        &mut self,
        run: &Kept,
        before: Option<Kept>,
        error: &mut StepError,
        observer: &mut dyn Observer,
    ) -> Result<Option<(OtherRun, Kept)>, Outcome> {
        if let Some(before) = before.filter(|before| run.is_told_by(before)) {
            return Ok(Some((OtherRun::Before(run.apart(&before)), before)));
        }
        let trial = self.trial(error, (run.longest(), run.end()), observer)?;
        Ok(trial.map(|trial| (OtherRun::Trial(run.apart(&trial)), trial)))
    }

    /// Makes the run by the tolerance before once more, for the run under way fails or asks for far too many steps.
    fn settle(
        &mut self,
        mut error: StepError,
        schedule: &Schedule,
        observer: &mut dyn Observer,
    ) -> (Outcome, Option<State>) {
        let of_before = error.before;
        if let Err(error) = self.begin_again(&mut error, of_before, observer) {
            return (Outcome::Io(error), None);
        }
        let (outcome, state) = self.once(observer, schedule);
        self.workspace.warnings.extend(error.doubt());
        self.step_error = Some(error);
        (outcome, state)
    }

    /// Prepares for a run by another tolerance, of which nothing has been seen yet.
    ///
    /// # Errors
    /// The observer cannot forget what it has received.
    fn begin_again(
        &mut self,
        error: &mut StepError,
        (tolerance, longest): (f64, Option<f64>),
        observer: &mut dyn Observer,
    ) -> std::io::Result<()> {
        let model = self.context.model;
        error.add(self.recorder.own());
        error.before = (error.tolerance, error.longest);
        (error.tolerance, error.longest) = (tolerance, longest);
        self.recorder = Recorder::new(model, self.wanted);
        let ws = &mut self.workspace;
        (ws.warnings, ws.rotation_drift, ws.joint_violation) = (Warnings::default(), 0.0, 0.0);
        self.follow(tolerance, longest);
        observer.restart(model)
    }

    /// Runs with longer steps, unseen, for the sake of the error of the run before; `None` where that run does not come to its end.
    ///
    /// # Errors
    /// [`Outcome::Stopped`], and [`Outcome::Io`] where the observer fails.
    fn trial(
        &mut self,
        error: &mut StepError,
        (longest, reached): (f64, f64),
        observer: &mut dyn Observer,
    ) -> Result<Option<Kept>, Outcome> {
        let (model, inside) = (self.context.model, self.controller.looks_inside());
        let power = model.solution.scheme.order() + 1;
        let recorder = std::mem::replace(&mut self.recorder, Recorder::new(model, self.wanted.where_due()));
        self.recorder.is_trial = true;
        let warnings = std::mem::take(&mut self.workspace.warnings);
        let seen = (self.workspace.rotation_drift, self.workspace.joint_violation);
        self.follow(error.tolerance * LOOSER, Some(2.0 * longest));
        self.recorder.most_steps = 2 * recorder.own().steps + FEW;
        let compared = if inside { observer.times_to_compare() } else { Vec::new() };
        let schedule = Schedule::of_trial(model, comparison_times(&model.analysis).chain(compared), inside);
        // A stage that has stopped is compared up to there.
        let schedule = schedule.until(if self.has_stopped() == Some(true) { reached } else { f64::INFINITY });
        observer.begin_trial();
        let mut unseen = Unseen(observer);
        let mut trace = Trace::new(&mut unseen, power);
        let (outcome, _) = self.once(&mut trace, &schedule);
        error.add(self.recorder.own());
        (self.recorder, self.workspace.warnings) = (recorder, warnings);
        (self.workspace.rotation_drift, self.workspace.joint_violation) = seen;
        match outcome {
            Outcome::Done => Ok(Some(trace.into_kept())),
            Outcome::Stopped { .. } => Err(Outcome::Stopped { time: model.analysis.end_time }),
            Outcome::Io(_) => Err(outcome),
            Outcome::Failed { .. } => Ok(None),
        }
    }

    /// Runs once, and shows the observer, as a trial, what happens at these times; steps that follow an error do so as those of another run
    /// did in the end.
    pub fn rehearse(&mut self, times: Vec<f64>, like: Option<StepError>, observer: &mut dyn Observer) -> Outcome {
        let model = self.context.model;
        if let Some(StepError { tolerance, longest, .. }) = like {
            self.follow(tolerance, longest);
        }
        self.recorder.is_trial = true;
        let schedule = Schedule::new(model, times.into_iter(), self.controller.looks_inside());
        observer.begin_trial();
        self.once(&mut Unseen(observer), &schedule).0
    }

    /// Prepares for a run by this tolerance, whose counts begin anew.
    fn follow(&mut self, tolerance: f64, longest: Option<f64>) {
        let ws = &mut self.workspace;
        (ws.factorizations, ws.solves) = (0, 0);
        if let Some(controller) = self.controller.by_tolerance() {
            controller.follow(tolerance, longest);
        }
    }

    /// The effort of the run, once it has ended.
    pub fn counts(&self) -> Counts {
        self.recorder.counts
    }

    /// Prepares the model of the next stage for the state at the end of this one, and builds its system; the counts are those of all
    /// stages before.
    ///
    /// # Errors
    /// As for [`System::new`], and where a part does not remember what it did.
    pub fn hand_over(
        &self,
        (state, counts): (&State, Counts),
        model: &mut Model,
    ) -> Result<(System, Handover), String> {
        let initial_energy = self.recorder.initial_energy();
        let load_steps = &self.workspace.load_steps;
        hand_over(&EndedStage { cx: &self.context, state, counts, initial_energy, load_steps }, model)
    }

    /// Whether the value at which the stage was to stop has been reached; `None` where there is none.
    pub fn has_stopped(&self) -> Option<bool> {
        self.stop_watch.as_ref().map(StopWatch::is_reached)
    }

    /// Time spent in the observer.
    pub fn observing(&self) -> Duration {
        self.recorder.observing
    }

    /// The balance of energy of a dynamic analysis.
    pub fn balance(&self) -> &Balance {
        &self.recorder.growth.balance
    }

    /// Largest departure from orthogonality of a truncated rotation update before it was corrected.
    pub fn rotation_drift(&self) -> f64 {
        self.workspace.rotation_drift
    }

    /// Largest gap of a joint at the end of a step, relative to the largest coordinate; `None` without joints.
    pub fn joint_violation(&self) -> Option<f64> {
        (!self.context.system.joints.is_empty()).then_some(self.workspace.joint_violation)
    }

    /// The error of steps that follow a tolerance; `None` for others.
    pub fn step_error(&self) -> Option<StepError> {
        self.step_error
    }

    /// Doubts about the results.
    pub fn warnings(&self) -> &Warnings {
        &self.workspace.warnings
    }

    /// What the work of the load steps of a static analysis has too much, or lacks, for what is stored and dissipated at the end, and the
    /// energy to which that is compared. `None` in dynamics, where the tangent is constant, and along a path of given arc length, which
    /// does not jump; and where forces are rounding.
    pub fn missed_work(&self) -> Option<(f64, f64)> {
        let (cx, ws) = (&self.context, &self.workspace);
        let along = cx.model.analysis.step_length.is_arc_length();
        if cx.is_dynamic() || cx.plan.linear || along || !ws.load_steps.peak.stressed {
            return None;
        }
        let (missed, energy) = self.balance().missed_in_statics();
        // Loads that act at once do work before they are in equilibrium.
        let beyond = (missed.abs() - ws.load_steps.works.sudden).max(0.0);
        Some((beyond.copysign(missed), energy.max(ws.load_steps.works.largest)))
    }

    /// What was not judged.
    pub fn remarks(&self) -> &[Remark] {
        self.workspace.warnings.remarks()
    }

    /// The displacement at the end of a path that did not reach its `stop`.
    pub fn short_of_stop(&self) -> Option<f64> {
        self.controller.short_of_stop()
    }
}
