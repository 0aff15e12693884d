//! Single runs, and runs by a tolerance, see [`super::global_error`]: the run itself, a comparison run with longer steps for its error, and further runs
//! while the error is too large.

use super::control::{Schedule, comparison_times};
use super::failure::Failure;
use super::frame::{Observer, OtherRun};
use super::global_error::{Kept, LookAhead, StepError, Trace, Unseen};
use super::outcome::Outcome;
use super::recorder::Recorder;
use super::run::{Run, SingleRun};
use super::stop_watch::StopWatch;
use super::warning::Warnings;
use crate::tolerances::global_error::{EARLY, FEW, IN_TIME, LOOSER, MOST_EARLY, MOST_LONGER, MOST_RUNS, STRICTER};
use base::snapshot::{Keep, keep, keep_either};
use mechanics::state::State;
use model::StepLength;

/// Number of parts of each interval between required ends of steps, in the current run and the previous one.
#[derive(Debug, Clone, Copy)]
struct Pieces {
    now: usize,
    before: usize,
}

keep!(Pieces { now, before });

/// The data that runs by a tolerance pass to later runs.
struct GlobalErrorControl {
    /// The run that is under way.
    under_way: UnderWay,
    error: StepError,
    pieces: Pieces,
    /// Times for the comparison of the current run, besides the general ones.
    compared: Vec<f64>,
    /// The run before.
    before: Option<Kept>,
    judged: Judged,
    /// The time range of comparison: the stage, or its part up to the stop.
    between: [f64; 2],
}

keep!(GlobalErrorControl { under_way, error, pieces, compared, before, judged, between });

impl GlobalErrorControl {
    /// True if a pilot run tells the error of the current run: no whole run came before, and the times of comparison are the same.
    fn is_told_by(&self, pilot: &Kept) -> bool {
        self.error.others == self.error.early && pilot.is_whole() && pilot.between == self.between
    }
}

/// The kind of the run that is under way.
#[derive(Clone, Copy, PartialEq, Eq)]
enum UnderWay {
    /// A run whose results may be final.
    Main,
    /// One with longer steps that tells the error of the one before it.
    Comparison,
    /// The one before, once more.
    Settled,
}

keep_either!(UnderWay { 0 => Main, 1 => Comparison, 2 => Settled });

/// The run judged by a comparison run, with its data during the comparison run.
struct Judged {
    run: Kept,
    state: State,
    recorder: Recorder,
    warnings: Warnings,
    seen: [f64; 2],
    /// True if it reached the stop value of the stage.
    stopped: bool,
}

keep!(Judged { run, state, recorder, warnings, seen, stopped });

/// The other run as shown to the observer, by the ratio of both errors.
type TellOther = fn(f64) -> OtherRun;

impl Run<'_> {
    /// Runs to the end, to a failure, or until stopped. Returns the outcome and the last state; none where the run did not start. If steps
    /// follow a tolerance, a second run estimates their error, and the run is repeated if it is too large.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        match (&self.context.model.analysis.step_length, self.controller.by_tolerance()) {
            (&StepLength::ErrorControlled { tolerance, .. }, Some(_)) => self.within(tolerance, observer),
            _ => self.once(observer, &Schedule::new(self.context.model, std::iter::empty(), false), &mut SingleRun),
        }
    }

    /// Runs with steps that follow a tolerance until the requested error is met.
    fn within(&mut self, asked: f64, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let mut control = self.begin_control(asked);
        loop {
            let ended = match control.under_way {
                UnderWay::Main => self.main_run(&mut control, observer),
                UnderWay::Comparison => self.comparison_run(&mut control, observer),
                UnderWay::Settled => Some(self.settle(&mut control, observer)),
            };
            if let Some(ended) = ended {
                return ended;
            }
        }
    }

    /// Begins with the first run, or resumes it at a checkpoint.
    fn begin_control(&mut self, asked: f64) -> GlobalErrorControl {
        let model = self.context.model;
        let mut control = GlobalErrorControl {
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
        // In a scene with kinks a pilot run chooses its steps. Its difference gives an error only if they are longer.
        if let Some(pilot) = self.pilot.as_ref().filter(|pilot| pilot.is_whole() && self.has_kinks()) {
            let tolerance = asked.min(STRICTER * pilot.tolerance);
            (control.error.tolerance, control.error.least) = (tolerance, tolerance);
        }
        self.follow(control.error.tolerance, None);
        if let Some(snapshot) = &mut self.checkpoint {
            control.keep(snapshot);
            if control.under_way == UnderWay::Comparison {
                self.recorder = Recorder::new(model, self.wanted.where_due());
                self.stop_watch.iter_mut().for_each(|watch| watch.recall(control.judged.stopped));
            }
        }
        control
    }

    /// Makes a run that may be the last, or the rest of it. Returns the outcome if it ends the sequence of runs.
    fn main_run(
        &mut self,
        control: &mut GlobalErrorControl,
        observer: &mut dyn Observer,
    ) -> Option<(Outcome, Option<State>)> {
        let model = self.context.model;
        let times = comparison_times(control.between).chain(control.compared.iter().copied());
        let schedule = Schedule::new(model, times, self.controller.looks_inside()).cut(control.pieces.now);
        let pilot = self.pilot.take();
        // Events may come late, and their errors of first order do not follow from the steps so far.
        let ahead = pilot.as_ref().filter(|pilot| control.is_told_by(pilot) && !self.has_kinks());
        let StepError { asked, tolerance, early, .. } = control.error;
        let ahead =
            ahead.map(|pilot| LookAhead::new(pilot, (asked, tolerance), self.context.size(), early < MOST_EARLY));
        let mut trace = Trace::new(observer, model.solution.scheme.order() + 1, control.between).looking_ahead(ahead);
        let (outcome, state) = self.once(&mut trace, &schedule, control);
        let predicted = trace.predicted();
        if let Some([mean, least]) = trace.tolerances() {
            (control.error.tolerance, control.error.least) = (mean, least);
        }
        let run = trace.into_kept().with_events(self.recorder.events.met());
        self.pilot = pilot;
        if let Some(begun) = self.begin_instead((&outcome, predicted, &run), control, observer) {
            return begun.err().map(|error| (Outcome::Io(error), None));
        }
        let (Outcome::Done, Some(state)) = (&outcome, &state) else { return Some((outcome, state)) };
        if let Some(end) = self.early_stop(control.between, state.time) {
            return self.compare_until(end, control, observer).err().map(|error| (Outcome::Io(error), None));
        }
        control.judged.run = run;
        control.judged.state.clone_from(state);
        let size = self.context.size();
        let (error, run) = (&control.error, &control.judged.run);
        let judges = |pilot: &Kept| control.is_told_by(pilot) && error.is_judged_by(run, pilot, size);
        let pilot = self.pilot.take().filter(judges);
        let other = control.before.take().map(|before| (OtherRun::Before as TellOther, before));
        let other = other.or(pilot.map(|pilot| (OtherRun::Pilot as TellOther, pilot)));
        if let Some(other) = other.filter(|(_, other)| control.judged.run.is_told_by(other)) {
            return self.judge(control, Some(other), observer);
        }
        self.begin_comparison(control, observer);
        None
    }

    /// Prepares for another run, if this one has failed or its predicted error is too large. `None`: this run stands.
    fn begin_instead(
        &mut self,
        (outcome, predicted, run): (&Outcome, Option<f64>, &Kept),
        control: &mut GlobalErrorControl,
        observer: &mut dyn Observer,
    ) -> Option<std::io::Result<()>> {
        if let Some(predicted) = predicted.filter(|_| !matches!(outcome, Outcome::Io(_))) {
            // Later steps may be longer than those so far. Pilot runs may have steps twice as long as this run.
            let longest = self.pilot.iter().map(|pilot| 0.5 * pilot.longest()).fold(run.longest(), f64::max);
            let shorter = (control.error.in_place_of_early(predicted), longest);
            let begun = self.begin_shorter(shorter, control, observer);
            control.error.early += 1;
            return Some(begun);
        }
        // The run fails with shorter steps, but the previous run was complete.
        if control.before.is_some() && matches!(outcome, Outcome::Failed { .. }) {
            let of_before = control.error.before;
            let begun = self.begin_again(&mut control.error, of_before, observer);
            control.under_way = UnderWay::Settled;
            return Some(begun);
        }
        // A smaller tolerance may keep the motion.
        let is_lost = matches!(outcome, Outcome::Failed { failure: Failure::EnergyGrowth { .. }, .. });
        if is_lost && control.error.others - control.error.early < MOST_RUNS {
            let shorter = (control.error.without_comparison(), run.longest());
            return Some(self.begin_shorter(shorter, control, observer));
        }
        None
    }

    /// Prepares for a run with this smaller tolerance in place of one with this longest step.
    ///
    /// # Errors
    /// As for [`Run::begin_again`].
    fn begin_shorter(
        &mut self,
        (tolerance, longest): (f64, f64),
        control: &mut GlobalErrorControl,
        observer: &mut dyn Observer,
    ) -> std::io::Result<()> {
        let longest = self.shortened(longest, tolerance / control.error.tolerance);
        self.begin_again(&mut control.error, (tolerance, Some(longest)), observer)
    }

    /// The longest step of a run whose tolerance is smaller by this factor.
    fn shortened(&self, longest: f64, factor: f64) -> f64 {
        longest * factor.powf(1.0 / self.context.model.solution.scheme.order() as f64)
    }

    /// The new end of the comparison times if a run has stopped so early that hardly any of them lie before; `None` otherwise. Comparison
    /// times also limit steps: in a long stage they may be too long for the motion until the stop.
    fn early_stop(&self, [begin, end]: [f64; 2], stopped: f64) -> Option<f64> {
        let is_early = self.has_stopped() == Some(true) && stopped - begin < EARLY * (end - begin);
        (is_early && stopped > begin).then(|| begin + (stopped - begin) / IN_TIME)
    }

    /// Prepares for the same run again, to be compared up to this time.
    ///
    /// # Errors
    /// As for [`Run::begin_again`].
    fn compare_until(
        &mut self,
        end: f64,
        control: &mut GlobalErrorControl,
        observer: &mut dyn Observer,
    ) -> std::io::Result<()> {
        control.between[1] = end;
        (control.before, control.error.difference) = (None, None);
        let StepError { least: tolerance, longest, .. } = control.error;
        self.begin_again(&mut control.error, (tolerance, longest), observer)?;
        // The aborted run does not contribute to the error estimate.
        control.error.others -= 1;
        Ok(())
    }

    /// True if jumps and kinks of loads determine most steps of the run. A comparison run that ends steps on kinks would have the same steps, so it
    /// steps across them. If it does not bound the error, rdsolve divides the intervals between kinks once.
    fn is_dictated(&self, GlobalErrorControl { judged: Judged { run, .. }, pieces, .. }: &GlobalErrorControl) -> bool {
        let inside = self.controller.looks_inside();
        let schedule = Schedule::of_trial(self.context.model, std::iter::empty(), inside).until(run.end());
        // Each interval with one step has the same step in both runs, and every other one has two steps at least.
        pieces.now == 1 && 3 * run.steps() < 4 * schedule.intervals.len()
    }

    /// Judges the run that has come to its end by another one. Returns the outcome if the run is good enough, and otherwise prepares for a
    /// further run.
    fn judge(
        &mut self,
        control: &mut GlobalErrorControl,
        other: Option<(TellOther, Kept)>,
        observer: &mut dyn Observer,
    ) -> Option<(Outcome, Option<State>)> {
        let across_kinks = control.under_way == UnderWay::Comparison && self.is_dictated(control);
        let GlobalErrorControl { error, pieces, judged, .. } = control;
        let (run, inside) = (std::mem::take(&mut judged.run), self.controller.looks_inside());
        let next = match &other {
            Some((_, other)) => error.judge(&run, other, self.context.size()),
            None => Some(error.without_comparison()),
        };
        let dictated = across_kinks || other.as_ref().is_some_and(|(_, other)| run.has_steps_of(other));
        // Both runs of a stage begin with the errors of earlier stages, which their difference does not contain.
        let tells = error.estimate.is_some() && !self.context.model.analysis.follows_motion();
        observer.on_other_run(other.filter(|_| tells).map(|(which, _)| which(error.apart)));
        // If jumps and kinks of loads determine most steps, only a finer division between them changes the steps.
        *pieces = Pieces { before: pieces.now, now: if dictated { 2 * pieces.now } else { pieces.now } };
        // All other steps become half as long, too.
        let next = next.map(|tolerance| if dictated { error.tolerance / LOOSER } else { tolerance });
        let Some(tolerance) = next.filter(|_| error.others - error.early < MOST_RUNS) else {
            self.workspace.warnings.extend(error.warning());
            self.step_error = Some(*error);
            return Some((Outcome::Done, Some(std::mem::take(&mut judged.state))));
        };
        let most_steps = MOST_LONGER * self.recorder.own().steps;
        // Steps that no tolerance limits shrink as well, or the run would be the same again.
        control.compared = if inside { observer.times_to_compare() } else { Vec::new() };
        let longest = self.shortened(run.longest(), tolerance / error.tolerance);
        if let Err(fault) = self.begin_again(error, (tolerance, Some(longest)), observer) {
            return Some((Outcome::Io(fault), Some(std::mem::take(&mut judged.state))));
        }
        self.recorder.most_steps = most_steps;
        (control.before, control.under_way) = (Some(run), UnderWay::Main);
        None
    }

    /// Repeats the run with the previous tolerance, because the later run fails or needs far too many steps.
    fn settle(&mut self, control: &mut GlobalErrorControl, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        let model = self.context.model;
        let schedule = Schedule::new(model, comparison_times(control.between), self.controller.looks_inside());
        let (outcome, state) = self.once(observer, &schedule.cut(control.pieces.before), control);
        self.workspace.warnings.extend(control.error.warning());
        self.step_error = Some(control.error);
        (outcome, state)
    }

    /// Prepares for a run by another tolerance, without results yet.
    ///
    /// # Errors
    /// The observer cannot discard the received data.
    fn begin_again(
        &mut self,
        error: &mut StepError,
        (tolerance, longest): (f64, Option<f64>),
        observer: &mut dyn Observer,
    ) -> std::io::Result<()> {
        let model = self.context.model;
        error.add(self.recorder.own());
        error.before = (error.least, error.longest);
        (error.tolerance, error.least, error.longest) = (tolerance, tolerance, longest);
        self.recorder = Recorder::new(model, self.wanted);
        self.follow(tolerance, longest);
        observer.restart(model)
    }

    /// Stores the data of the completed run during a comparison run with longer steps.
    fn begin_comparison(&mut self, control: &mut GlobalErrorControl, observer: &mut dyn Observer) {
        // Steps across kinks are two steps of the run, whatever their error.
        let looser = if self.is_dictated(control) { LOOSER.powi(2) } else { LOOSER };
        let (model, GlobalErrorControl { error, judged, .. }) = (self.context.model, &mut *control);
        judged.recorder = std::mem::replace(&mut self.recorder, Recorder::new(model, self.wanted.where_due()));
        self.recorder.is_comparison = true;
        judged.warnings = std::mem::take(&mut self.workspace.warnings);
        judged.seen = [self.workspace.rotation_drift, self.workspace.joint_violation];
        judged.stopped = self.stop_watch.as_ref().is_some_and(StopWatch::is_reached);
        self.follow(error.tolerance * looser, Some(2.0 * judged.run.longest()));
        self.recorder.most_steps = 2 * judged.recorder.own().steps + FEW;
        control.compared = if self.controller.looks_inside() { observer.times_to_compare() } else { Vec::new() };
        control.under_way = UnderWay::Comparison;
        observer.begin_comparison();
    }

    /// Runs with longer steps, unseen, for the sake of the error of the run before, and judges that. Returns the outcome if it ends the
    /// sequence of runs.
    fn comparison_run(
        &mut self,
        control: &mut GlobalErrorControl,
        observer: &mut dyn Observer,
    ) -> Option<(Outcome, Option<State>)> {
        let model = self.context.model;
        let times = comparison_times(control.between).chain(control.compared.iter().copied());
        // A stage that has stopped is compared up to there.
        let until = if control.judged.stopped { control.judged.run.end() } else { f64::INFINITY };
        let mut schedule = Schedule::of_trial(model, times, self.controller.looks_inside()).until(until);
        let bounded = self.is_dictated(control).then(|| control.judged.run.clone());
        if let Some(run) = &bounded {
            schedule = schedule.with_ends(&run.ends).in_pairs();
        }
        let bound = bounded.as_ref().map(|run| LookAhead::bound(run, control.error.asked, self.context.size()));
        let mut unseen = Unseen::new(observer);
        let order = model.solution.scheme.order();
        let mut trace = Trace::new(&mut unseen, order + 1, control.between).looking_ahead(bound);
        let (outcome, _) = self.once(&mut trace, &schedule, control);
        let comparison = trace.into_kept().with_events(self.recorder.events.met());
        let GlobalErrorControl { error, judged, .. } = &mut *control;
        error.add(self.recorder.own());
        std::mem::swap(&mut self.recorder, &mut judged.recorder);
        self.workspace.warnings = std::mem::take(&mut judged.warnings);
        [self.workspace.rotation_drift, self.workspace.joint_violation] = judged.seen;
        match outcome {
            Outcome::Done => self.judge(control, Some((OtherRun::Comparison, comparison)), observer),
            Outcome::Failed { .. } => self.judge(control, None, observer),
            Outcome::Stopped { .. } => {
                let stopped = Outcome::stopped(model.analysis.end_time);
                Some((stopped, Some(std::mem::take(&mut judged.state))))
            }
            Outcome::Io(_) => Some((outcome, Some(std::mem::take(&mut judged.state)))),
        }
    }
}
