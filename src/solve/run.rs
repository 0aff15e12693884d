//! A run of one scene from t = 0 to the end time; one whose steps follow a tolerance may be several, see [`super::global_error`].

use super::context::Context;
use super::control::{Controller, Schedule};
use super::derived::Wanted;
use super::energy_growth::checks_energy_growth;
use super::failure::Failure;
use super::frame::Observer;
use super::global_error::{Kept, StepError, Trace, Unseen};
use super::handover::{EndedStage, Handover, hand_over};
use super::march::{March, RunPosition};
use super::modes::{ModesFault, find_damped};
use super::modes_at_end;
use super::outcome::{Counts, Outcome};
use super::recorder::Recorder;
use super::row_gaps::RowGap;
use super::sample::Samples;
use super::start::start;
use super::start_of_stage::start_stage;
use super::stop_watch::StopWatch;
use super::warning::{Remark, Warning, Warnings};
use super::workspace::Workspace;
use crate::plan::Plan;
use crate::system::System;
use crate::system::energy::Balance;
use crate::system::kinks::has_kinks;
use base::snapshot::{Keep, Snapshot};
use linear::{Solver, TooLarge};
use mechanics::state::State;
use model::{Model, StepLength};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// No control of the global error: the run is the only one.
pub(super) struct SingleRun;

impl Keep for SingleRun {
    fn keep(&mut self, _: &mut Snapshot) {}
}

/// Finds the modes that `modal` damps, if it damps any and none are known.
fn find_modes_of_damping(cx: &Context, warnings: &mut Warnings, stop: &AtomicBool) -> Result<(), Outcome> {
    let begin = cx.model.analysis.begin;
    if !cx.system.modal_damping().lacks_modes() {
        return Ok(());
    }
    match find_damped((cx.model, cx.system, cx.plan), &cx.excitation, stop) {
        Ok([found, wanted]) if found < wanted => warnings.add(Warning::Modes(format!(
            "`modal` damping asks for {wanted} modes, and the scene has {found}: all are damped. Give `modes` = {found}"
        ))),
        Ok(_) => {}
        Err(ModesFault::Stopped) => return Err(Outcome::stopped(begin)),
        Err(fault) => return Err(Outcome::of(Failure::Modes(fault), begin)),
    }
    Ok(())
}

/// The error that a checkpoint is not one of this scene.
fn unfit() -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::InvalidData, "the checkpoint does not fit the scene of the deck")
}

/// A run of one scene. Whatever its steps need is allocated when it is made.
pub struct Run<'a> {
    pub(super) context: Context<'a>,
    pub(super) workspace: Workspace,
    pub(super) controller: Controller<'a>,
    pub(super) recorder: Recorder,
    pub(super) wanted: Wanted,
    pub(super) step_error: Option<StepError>,
    /// The start data of the stage; `None` for a run from t = 0.
    handover: Option<Handover>,
    /// The watch that may end the stage early.
    pub(super) stop_watch: Option<StopWatch>,
    stop: &'a AtomicBool,
    /// A pilot run of the same scene with longer steps, in place of a comparison run.
    pub(super) pilot: Option<Kept>,
    /// The checkpoint that the run resumes from; `None` afterwards.
    pub(super) checkpoint: Option<Snapshot>,
}

impl<'a> Run<'a> {
    /// Prepares a run that shows the `wanted` quantities; it ends early if `stop` is raised.
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
        let is_static = !model.analysis.is_dynamic();
        let wants_forces = is_static || wanted.has(Wanted::REACTIONS) || wants_energy || checks_energy_growth(model);
        let context = Context::new(model, plan, system, [wants_forces, wants_energy], stop);
        let mut workspace = Workspace::new(&context)?;
        let controller = Controller::new(&context, &mut workspace)?;
        let recorder = Recorder::new(model, wanted);
        let stop_watch = StopWatch::new(&context);
        let (step_error, handover, pilot, checkpoint) = (None, None, None, None);
        Ok(Run {
            context,
            workspace,
            controller,
            recorder,
            wanted,
            step_error,
            handover,
            stop_watch,
            stop,
            pilot,
            checkpoint,
        })
    }

    /// Estimates the error of steps that follow a tolerance by a pilot run of the same scene. A comparison run follows only if the steps of the
    /// pilot run are no longer.
    pub fn compare_with(&mut self, pilot: Kept) {
        self.pilot = Some(pilot);
    }

    /// Starts the run from the end of the previous stage; with `None` it starts at t = 0.
    pub fn go_on_from(&mut self, handover: Option<Handover>) {
        self.handover = handover;
    }

    /// Resumes the run from a checkpoint that [`Observer::on_checkpoint`] has received from a run of the same model.
    pub fn resume(&mut self, checkpoint: Vec<u8>) {
        self.checkpoint = Some(Snapshot::of(checkpoint));
    }

    /// One run as scheduled, or the rest of it.
    pub(super) fn once(
        &mut self,
        observer: &mut dyn Observer,
        schedule: &Schedule,
        error_control: &mut dyn Keep,
    ) -> (Outcome, Option<State>) {
        let Run { context: cx, workspace: ws, controller, recorder, handover, stop_watch, stop, checkpoint, .. } = self;
        let mut checkpoint = checkpoint.take();
        if let Err(outcome) = find_modes_of_damping(cx, &mut ws.warnings, stop) {
            return (outcome, None);
        }
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
            cx.system.recover(&mut state.nodes);
            recorder.begin(cx, &mut state, handover.as_ref());
        }
        let samples = Samples::new(&schedule.samples);
        let stop_watch = stop_watch.as_mut().filter(|_| !recorder.is_comparison);
        let (place, resumes) = (RunPosition::default(), checkpoint.is_some());
        let begins_from = handover.as_ref().map(|handover| &handover.state.nodes[..]);
        let mut march = March {
            cx,
            ws,
            state: &mut state,
            recorder,
            observer,
            samples,
            stop_watch,
            stop,
            begins_from,
            place,
            resumes,
            error_control,
        };
        if let Some(mut snapshot) = checkpoint {
            march.keep_rest(controller, &mut snapshot);
            if !snapshot.is_used_up() {
                return (Outcome::Io(unfit()), None);
            }
        }
        let mut outcome = modes_at_end::run(controller, &mut march, schedule);
        if !matches!(outcome, Err(Outcome::Io(_))) {
            outcome = march.recorder.close(march.cx, march.ws, march.state, march.observer).and(outcome);
        }
        recorder.count_work(ws);
        ws.warn_of_friction(cx);
        (outcome.err().unwrap_or(Outcome::Done), Some(state))
    }

    /// True if forces may have kinks, such as at contact, yield and failure.
    pub fn has_kinks(&self) -> bool {
        has_kinks(self.context.system)
    }

    /// Runs once and shows the observer these times as a comparison run. Error-controlled steps use the final tolerance of another run, and
    /// end at these `ends` as well. Returns the motion, too.
    pub fn rehearse(
        &mut self,
        times: Vec<f64>,
        (like, ends): (Option<StepError>, &[f64]),
        observer: &mut dyn Observer,
    ) -> (Outcome, Kept) {
        let (model, inside) = (self.context.model, self.controller.looks_inside());
        if let Some(StepError { asked, tolerance, longest, .. }) = like {
            self.follow(tolerance, longest);
            if let Controller::ErrorControlled(controller) = &mut self.controller {
                controller.iterate_to(asked.min(tolerance));
            }
        }
        self.recorder.is_comparison = true;
        // Times of output inside steps would cost an equilibrium each. A trial ends at its last time, so that has to be the end of the run.
        let is_whole = times.last().is_some_and(|last| *last >= model.analysis.end_time);
        let make = if like.is_some() && inside && is_whole { Schedule::of_trial } else { Schedule::new };
        let schedule = make(model, times.into_iter(), inside).with_ends(ends);
        observer.begin_comparison();
        let mut unseen = Unseen::new(observer);
        let between = [model.analysis.begin, model.analysis.end_time];
        let mut trace = Trace::new(&mut unseen, model.solution.scheme.order() + 1, between);
        let outcome = self.once(&mut trace, &schedule, &mut SingleRun).0;
        let tolerance = like.map_or(0.0, |like| like.tolerance);
        (outcome, Kept { tolerance, ..trace.into_kept().with_events(self.recorder.events.met()) })
    }

    /// Prepares for a run by this tolerance, with counts from zero.
    pub(super) fn follow(&mut self, tolerance: f64, longest: Option<f64>) {
        let ws = &mut self.workspace;
        (ws.factorizations, ws.solves) = (0, 0);
        ws.begin_run(&self.context);
        if let Some(controller) = self.controller.by_tolerance() {
            controller.follow(&self.context, tolerance, longest);
        }
    }

    /// The solver of the matrix of a step.
    pub fn solver(&self) -> &Solver {
        &self.workspace.matrix.solver
    }

    /// The effort of the run, once it has ended.
    pub fn counts(&self) -> Counts {
        self.recorder.counts
    }

    /// Prepares the model of the next stage for the state at the end of this one, and builds its system; `counts` include all previous
    /// stages.
    ///
    /// # Errors
    /// As for [`System::new`], and if the history of a part does not match.
    pub fn hand_over(
        &self,
        (state, counts): (&State, Counts),
        model: &mut Model,
    ) -> Result<(System, Handover), String> {
        let initial_energy = self.recorder.initial_energy();
        let load_steps = &self.workspace.load_steps;
        hand_over(&EndedStage { cx: &self.context, state, counts, initial_energy, load_steps }, model)
    }

    /// Saves the data of a completed run for the next stage, besides its state and counts: [`Run::hand_over`] needs them if the run ended
    /// before a checkpoint.
    pub fn keep_end(&mut self, snapshot: &mut Snapshot) {
        self.recorder.initial_energy_mut().keep(snapshot);
        self.workspace.load_steps.keep(snapshot);
    }

    /// Frees the memory of the matrix and its factor; results and data for the next stage are kept.
    pub fn forget_matrix(&mut self) {
        self.workspace.matrix.solver = Solver::none();
    }

    /// Whether the stage has reached its stop value; `None` if it has none.
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

    /// The number of failed elements and links; `None` if none can fail.
    pub fn broken(&self) -> Option<usize> {
        self.recorder.broken()
    }

    /// The error of steps that follow a tolerance; `None` for others.
    pub fn step_error(&self) -> Option<StepError> {
        self.step_error
    }

    /// Warnings about the results.
    pub fn warnings(&self) -> &Warnings {
        &self.workspace.warnings
    }

    /// The mean relative overshoot of displacements by central differences with automatic steps, if stable steps are too long for the
    /// motion. An oscillation is too large by 1/√(1 − (ω Δt/2)²). `None` for other steps, and for a motion that is rounding.
    pub fn overshoot(&self) -> Option<f64> {
        let [resisted, all] = self.workspace.warnings.resisted;
        let square = 0.25 * resisted / all;
        let is_automatic = matches!(self.context.model.analysis.step_length, StepLength::StabilityLimited { .. });
        let is_seen = 0.5 * all > self.recorder.own().steps as f64 * self.balance().rounding;
        (is_automatic && is_seen && square > 0.0 && square < 1.0).then(|| 1.0 / (1.0 - square).sqrt() - 1.0)
    }

    /// The missing or excess work of the load steps of a static analysis, compared with stored and dissipated energy at the end, and the
    /// reference energy. `None` in dynamics, with a constant tangent, under arc-length control, which does not jump, and if forces are
    /// rounding.
    pub fn missed_work(&self) -> Option<(f64, f64)> {
        let (cx, ws) = (&self.context, &self.workspace);
        let along = cx.model.analysis.step_length.is_arc_length();
        if cx.is_dynamic() || cx.plan.linear || along || !ws.load_steps.peak.stressed {
            return None;
        }
        let (works, (missed, energy)) = (&ws.load_steps.works, self.balance().missed_in_statics());
        // Loads that act at once do work before they are in equilibrium.
        let beyond = (missed.abs() - works.sudden).max(0.0);
        // In rigid models displacements are convergence errors, and their work is the reference.
        let left = cx.model.solution.iteration.tolerance * cx.length * ws.load_steps.peak.forces.force;
        Some((beyond.copysign(missed), energy.max(works.largest).max(0.5 * works.gross).max(left)))
    }

    /// The largest motion between the rows of tables, if they are too far apart to follow it.
    pub fn row_gap(&self) -> Option<RowGap> {
        self.recorder.row_gaps.largest(self.context.rounding)
    }

    /// Names of the contacts with a force that have touched, and of those that have not.
    pub fn contacts(&self) -> [Vec<String>; 2] {
        let has_touched = |place: &usize| self.workspace.warnings.touched.contains(place);
        let (touched, open): (Vec<_>, Vec<_>) = self.context.system.contact_parts().into_iter().partition(has_touched);
        let name = |place: usize| self.context.model.parts[place].name().to_owned();
        [touched, open].map(|places| places.into_iter().map(name).collect())
    }

    /// The remarks on omitted checks.
    pub fn remarks(&self) -> &[Remark] {
        self.workspace.warnings.remarks()
    }

    /// The displacement at the end of a path that did not reach its `stop`.
    pub fn short_of_stop(&self) -> Option<f64> {
        self.controller.short_of_stop()
    }
}
