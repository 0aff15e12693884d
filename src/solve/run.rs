//! A run of one scene from t = 0 to the end time.

use super::context::Context;
use super::control::{Controller, Schedule, comparison_times};
use super::derived::Wanted;
use super::energy_growth::checks_energy_growth;
use super::frame::{Observer, OtherRun};
use super::handover::{EndedStage, Handover, hand_over};
use super::march::{March, RunPosition};
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
use crate::linear::{Solver, TooLarge};
use crate::model::{AnalysisKind, Model, StepLength};
use crate::plan::Plan;
use crate::snapshot::{Keep, Snapshot, keep, keep_either};
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

keep!(Pieces { now, before });

/// What runs of a scene by a tolerance leave to those after them.
struct Search {
    /// The run that is under way.
    under_way: UnderWay,
    error: StepError,
    pieces: Pieces,
    /// Times at which the run under way is compared, besides those of every scene.
    compared: Vec<f64>,
    /// The run before.
    before: Option<Kept>,
    judged: Judged,
    /// The times between which runs are compared: those of the stage, or of the part of it in which it comes to its stop.
    between: [f64; 2],
}

keep!(Search { under_way, error, pieces, compared, before, judged, between });

/// The part of the time between comparisons in which a stage must come to its stop for its error to be told.
const EARLY: f64 = 0.4;
/// The part of it in which a stage that has stopped too early is to stop in the next run.
const IN_TIME: f64 = 0.8;

/// The runs of a search.
#[derive(Clone, Copy, PartialEq, Eq)]
enum UnderWay {
    /// One whose results may be those of the deck.
    Main,
    /// One with longer steps that tells the error of the one before it.
    Trial,
    /// The one before, once more.
    Settled,
}

keep_either!(UnderWay { 0 => Main, 1 => Trial, 2 => Settled });

/// A run whose error a trial is to tell, with what is set aside for the trial.
struct Judged {
    run: Kept,
    state: State,
    recorder: Recorder,
    warnings: Warnings,
    seen: [f64; 2],
    /// True where it came to the value at which the stage stops.
    stopped: bool,
}

keep!(Judged { run, state, recorder, warnings, seen, stopped });

/// No search: the run is the only one.
struct NoSearch;

impl Keep for NoSearch {
    fn keep(&mut self, _: &mut Snapshot) {}
}

/// The error that a checkpoint is not one of this scene.
fn unfit() -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::InvalidData, "the checkpoint does not fit the scene of the deck")
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
    /// The checkpoint that the run goes on from; `None` once it does.
    checkpoint: Option<Snapshot>,
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
        let context = Context::new(model, plan, system, [wants_forces, wants_energy], stop);
        let mut workspace = Workspace::new(&context)?;
        let controller = Controller::new(&context, &mut workspace)?;
        let recorder = Recorder::new(model, wanted);
        let stop_watch = StopWatch::new(&context);
        let (step_error, handover, checkpoint) = (None, None, None);
        Ok(Run { context, workspace, controller, recorder, wanted, step_error, handover, stop_watch, stop, checkpoint })
    }

    /// Lets the run begin with what the stage before has left; with `None` it begins at t = 0.
    pub fn go_on_from(&mut self, handover: Option<Handover>) {
        self.handover = handover;
    }

    /// Lets the run go on from a checkpoint that [`Observer::on_checkpoint`] has received from a run of the same scene.
    pub fn resume(&mut self, checkpoint: Vec<u8>) {
        self.checkpoint = Some(Snapshot::of(checkpoint));
    }

    /// Runs to the end, to a failure, or until stopped. Returns the outcome and the last state; none where the run did
    /// not start. Where steps follow a tolerance, their error is estimated by a second run, and the run is made again where it is
    /// too large.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        match (&self.context.model.analysis.step_length, self.controller.by_tolerance()) {
            (&StepLength::ErrorControlled { tolerance, .. }, Some(_)) => self.within(tolerance, observer),
            _ => self.once(observer, &Schedule::new(self.context.model, std::iter::empty(), false), &mut NoSearch),
        }
    }

    /// One run as scheduled, or the rest of it.
    fn once(
        &mut self,
        observer: &mut dyn Observer,
        schedule: &Schedule,
        search: &mut dyn Keep,
    ) -> (Outcome, Option<State>) {
        let Run { context: cx, workspace: ws, controller, recorder, handover, stop_watch, stop, checkpoint, .. } = self;
        let mut checkpoint = checkpoint.take();
        ws.matrix.loses_nothing &= checkpoint.is_none() && handover.is_none();
        let began = match (&mut checkpoint, handover.as_ref()) {
            (Some(snapshot), _) => {
                recorder.keep(snapshot);
                Ok(State::default())
            }
            (None, Some(handover)) => start_stage(cx, ws, handover),
            (None, None) => start(cx, ws),
        };
        let mut state = match began {
            Ok(state) => state,
            Err(failure) => return (Outcome::of(failure, cx.model.analysis.begin), None),
        };
        if checkpoint.is_none() {
            recorder.begin(cx, &state, handover.as_ref());
        }
        let samples = Samples::new(&schedule.samples);
        let stop_watch = stop_watch.as_mut().filter(|_| !recorder.is_trial);
        let (place, resumes) = (RunPosition::default(), checkpoint.is_some());
        let state_at = &mut state;
        let mut march =
            March { cx, ws, state: state_at, recorder, observer, samples, stop_watch, stop, place, resumes, search };
        if let Some(mut snapshot) = checkpoint {
            march.keep_rest(controller, &mut snapshot);
            if !snapshot.is_used_up() {
                return (Outcome::Io(unfit()), None);
            }
        }
        let mut outcome = modes::lead(controller, &mut march, schedule);
        if !matches!(outcome, Err(Outcome::Io(_))) {
            outcome = march.recorder.close(march.cx, march.ws, march.state, march.observer).and(outcome);
        }
        recorder.count_work(ws);
        (outcome.err().unwrap_or(Outcome::Done), Some(state))
    }

    /// Runs with steps that follow a tolerance until the error is the one asked for.
    fn within(&mut self, asked: f64, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let mut search = self.begin_search(asked);
        loop {
            let ended = match search.under_way {
                UnderWay::Main => self.main_run(&mut search, observer),
                UnderWay::Trial => self.trial(&mut search, observer),
                UnderWay::Settled => Some(self.settle(&mut search, observer)),
            };
            if let Some(ended) = ended {
                return ended;
            }
        }
    }

    /// Begins with the first run, or takes up the search at a checkpoint.
    fn begin_search(&mut self, asked: f64) -> Search {
        let model = self.context.model;
        let mut search = Search {
            under_way: UnderWay::Main,
            error: StepError::new(asked),
            pieces: Pieces { now: 1, before: 1 },
            compared: Vec::new(),
            between: [model.analysis.begin, model.analysis.end_time],
            before: None,
            judged: Judged {
                run: Kept::default(),
                state: State::default(),
                recorder: Recorder::new(model, self.wanted),
                warnings: Warnings::default(),
                seen: [0.0; 2],
                stopped: false,
            },
        };
        self.follow(asked, None);
        if let Some(snapshot) = &mut self.checkpoint {
            search.keep(snapshot);
            if search.under_way == UnderWay::Trial {
                self.recorder = Recorder::new(model, self.wanted.where_due());
                self.stop_watch.iter_mut().for_each(|watch| watch.recall(search.judged.stopped));
            }
        }
        search
    }

    /// Makes a run that may be the last, or the rest of it. Returns what ends the search, if anything does.
    fn main_run(&mut self, search: &mut Search, observer: &mut dyn Observer) -> Option<(Outcome, Option<State>)> {
        let model = self.context.model;
        let times = comparison_times(search.between).chain(search.compared.iter().copied());
        let schedule = Schedule::new(model, times, self.controller.looks_inside()).cut(search.pieces.now);
        let mut trace = Trace::new(observer, model.solution.scheme.order() + 1, search.between);
        let (outcome, state) = self.once(&mut trace, &schedule, search);
        let run = trace.into_kept();
        // What fails with shorter steps did come to its end with those before.
        if search.before.is_some() && matches!(outcome, Outcome::Failed { .. }) {
            let of_before = search.error.before;
            let begun = self.begin_again(&mut search.error, of_before, observer);
            search.under_way = UnderWay::Settled;
            return begun.err().map(|error| (Outcome::Io(error), None));
        }
        let (Outcome::Done, Some(state)) = (&outcome, &state) else { return Some((outcome, state)) };
        if let Some(end) = self.early_stop(search.between, state.time) {
            return self.compare_until(end, search, observer).err().map(|error| (Outcome::Io(error), None));
        }
        search.judged.run = run;
        search.judged.state.clone_from(state);
        match search.before.take().filter(|before| search.judged.run.is_told_by(before)) {
            Some(before) => {
                let apart = search.judged.run.apart(&before);
                self.judge(search, Some((OtherRun::Before(apart), before)), observer)
            }
            None => {
                self.begin_trial(search, observer);
                None
            }
        }
    }

    /// The end of the times at which a run is to be compared that has come to its stop so early that hardly any of them lie before; `None` for
    /// any other. They limit steps as well, of which the first in a long stage may be too long for what it does until it stops.
    fn early_stop(&self, [begin, end]: [f64; 2], stopped: f64) -> Option<f64> {
        let is_early = self.has_stopped() == Some(true) && stopped - begin < EARLY * (end - begin);
        (is_early && stopped > begin).then(|| begin + (stopped - begin) / IN_TIME)
    }

    /// Prepares for the same run again, to be compared up to this time.
    ///
    /// # Errors
    /// As for [`Run::begin_again`].
    fn compare_until(&mut self, end: f64, search: &mut Search, observer: &mut dyn Observer) -> std::io::Result<()> {
        search.between[1] = end;
        search.before = None;
        let StepError { tolerance, longest, .. } = search.error;
        self.begin_again(&mut search.error, (tolerance, longest), observer)?;
        // It is no run that tells of an error.
        search.error.others -= 1;
        Ok(())
    }

    /// Judges the run that has come to its end by another one. Returns what ends the search, if it is good enough, and prepares for a
    /// further one else.
    fn judge(
        &mut self,
        search: &mut Search,
        other: Option<(OtherRun, Kept)>,
        observer: &mut dyn Observer,
    ) -> Option<(Outcome, Option<State>)> {
        let Search { error, pieces, judged, .. } = search;
        let (run, inside) = (std::mem::take(&mut judged.run), self.controller.looks_inside());
        let next = match &other {
            Some((_, other)) => error.judge(&run, other, self.context.length),
            None => Some(error.without_trial()),
        };
        let dictated = other.as_ref().is_some_and(|(_, other)| run.has_steps_of(other));
        observer.on_other_run(other.filter(|_| error.estimate.is_some()).map(|(which, _)| which));
        // Jumps and kinks of loads dictate most steps: only shorter ones between them tell anything.
        *pieces = Pieces { before: pieces.now, now: if dictated { 2 * pieces.now } else { pieces.now } };
        let next = if dictated { Some(error.tolerance) } else { next };
        let Some(tolerance) = next.filter(|_| error.others < MOST_RUNS) else {
            self.workspace.warnings.extend(error.doubt());
            self.step_error = Some(*error);
            return Some((Outcome::Done, Some(std::mem::take(&mut judged.state))));
        };
        let most_steps = MOST_LONGER * self.recorder.own().steps;
        // Steps that no tolerance limits shrink as well, or the run would be the same again.
        search.compared = if inside { observer.times_to_compare() } else { Vec::new() };
        let power = self.context.model.solution.scheme.order();
        let longest = run.longest() * (tolerance / error.tolerance).powf(1.0 / power as f64);
        if let Err(fault) = self.begin_again(error, (tolerance, Some(longest)), observer) {
            return Some((Outcome::Io(fault), Some(std::mem::take(&mut judged.state))));
        }
        self.recorder.most_steps = most_steps;
        (search.before, search.under_way) = (Some(run), UnderWay::Main);
        None
    }

    /// Makes the run by the tolerance before once more, for the run after it fails or asks for far too many steps.
    fn settle(&mut self, search: &mut Search, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let model = self.context.model;
        let schedule = Schedule::new(model, comparison_times(search.between), self.controller.looks_inside());
        let (outcome, state) = self.once(observer, &schedule.cut(search.pieces.before), search);
        self.workspace.warnings.extend(search.error.doubt());
        self.step_error = Some(search.error);
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

    /// Sets aside what belongs to the run that has come to its end, for a trial with longer steps.
    fn begin_trial(&mut self, search: &mut Search, observer: &mut dyn Observer) {
        let (model, Search { error, judged, .. }) = (self.context.model, &mut *search);
        judged.recorder = std::mem::replace(&mut self.recorder, Recorder::new(model, self.wanted.where_due()));
        self.recorder.is_trial = true;
        judged.warnings = std::mem::take(&mut self.workspace.warnings);
        judged.seen = [self.workspace.rotation_drift, self.workspace.joint_violation];
        judged.stopped = self.stop_watch.as_ref().is_some_and(StopWatch::is_reached);
        self.follow(error.tolerance * LOOSER, Some(2.0 * judged.run.longest()));
        self.recorder.most_steps = 2 * judged.recorder.own().steps + FEW;
        search.compared = if self.controller.looks_inside() { observer.times_to_compare() } else { Vec::new() };
        search.under_way = UnderWay::Trial;
        observer.begin_trial();
    }

    /// Runs with longer steps, unseen, for the sake of the error of the run before, and judges that. Returns what ends the search, if
    /// anything does.
    fn trial(&mut self, search: &mut Search, observer: &mut dyn Observer) -> Option<(Outcome, Option<State>)> {
        let model = self.context.model;
        let times = comparison_times(search.between).chain(search.compared.iter().copied());
        // A stage that has stopped is compared up to there.
        let until = if search.judged.stopped { search.judged.run.end() } else { f64::INFINITY };
        let schedule = Schedule::of_trial(model, times, self.controller.looks_inside()).until(until);
        let mut unseen = Unseen(observer);
        let mut trace = Trace::new(&mut unseen, model.solution.scheme.order() + 1, search.between);
        let (outcome, _) = self.once(&mut trace, &schedule, search);
        let trial = trace.into_kept();
        let Search { error, judged, .. } = &mut *search;
        error.add(self.recorder.own());
        std::mem::swap(&mut self.recorder, &mut judged.recorder);
        self.workspace.warnings = std::mem::take(&mut judged.warnings);
        [self.workspace.rotation_drift, self.workspace.joint_violation] = judged.seen;
        match outcome {
            Outcome::Done => {
                let apart = judged.run.apart(&trial);
                self.judge(search, Some((OtherRun::Trial(apart), trial)), observer)
            }
            Outcome::Failed { .. } => self.judge(search, None, observer),
            Outcome::Stopped { .. } => {
                let stopped = Outcome::Stopped { time: model.analysis.end_time };
                Some((stopped, Some(std::mem::take(&mut judged.state))))
            }
            Outcome::Io(_) => Some((outcome, Some(std::mem::take(&mut judged.state)))),
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
        self.once(&mut Unseen(observer), &schedule, &mut NoSearch).0
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

    /// Keeps what a run that has come to its end leaves to the stage after it, besides its state and counts: what
    /// [`Run::hand_over`] needs where the run was made before a checkpoint.
    pub fn keep_end(&mut self, snapshot: &mut Snapshot) {
        self.recorder.initial_energy_mut().keep(snapshot);
        self.workspace.load_steps.keep(snapshot);
    }

    /// Gives back the memory of the matrix and its factor; what the run has found and leaves to the next stage stays.
    pub fn forget_matrix(&mut self) {
        self.workspace.matrix.solver = Solver::none();
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

    /// The number of elements and links that have failed; `None` where none can.
    pub fn broken(&self) -> Option<usize> {
        self.recorder.broken()
    }

    /// The error of steps that follow a tolerance; `None` for others.
    pub fn step_error(&self) -> Option<StepError> {
        self.step_error
    }

    /// Doubts about the results.
    pub fn warnings(&self) -> &Warnings {
        &self.workspace.warnings
    }

    /// The part by which central differences with automatic steps overshoot displacements on the mean, where the steps that are stable are too
    /// long for the motion itself: an oscillation comes out larger by 1/√(1 − (ω Δt/2)²). `None` for other steps.
    pub fn overshoot(&self) -> Option<f64> {
        let [resisted, all] = self.workspace.warnings.resisted;
        let square = 0.25 * resisted / all;
        let is_automatic = matches!(self.context.model.analysis.step_length, StepLength::StabilityLimited { .. });
        (is_automatic && square > 0.0 && square < 1.0).then(|| 1.0 / (1.0 - square).sqrt() - 1.0)
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
        // Where nothing gives way, what is done is that of the displacements which the iteration leaves.
        let left = cx.model.solution.iteration.tolerance * cx.length * ws.load_steps.peak.forces.force;
        Some((beyond.copysign(missed), energy.max(ws.load_steps.works.largest).max(left)))
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
