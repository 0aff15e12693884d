//! Runs to the end, and runs by a tolerance: the run itself, a trial with longer steps that tells its error, and the run again where that is
//! more than was asked for, see [`super::trials`].

use super::control::{Schedule, comparison_times};
use super::frame::{Observer, OtherRun};
use super::outcome::Outcome;
use super::recorder::Recorder;
use super::run::{NoSearch, Run};
use super::stop_watch::StopWatch;
use super::trials::{Kept, StepError, Trace, Unseen};
use super::warning::Warnings;
use crate::tolerances::search::{EARLY, IN_TIME};
use crate::tolerances::trials::{FEW, LOOSER, MOST_LONGER, MOST_RUNS};
use base::snapshot::{Keep, keep, keep_either};
use mechanics::state::State;
use model::StepLength;

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

/// What is shown of another run, by the factor between the errors of both.
type TellOther = fn(f64) -> OtherRun;

impl Run<'_> {
    /// Runs to the end, to a failure, or until stopped. Returns the outcome and the last state; none where the run did
    /// not start. Where steps follow a tolerance, their error is estimated by a second run, and the run is made again where it is
    /// too large.
    pub fn run(&mut self, observer: &mut dyn Observer) -> (Outcome, Option<State>) {
        match (&self.context.model.analysis.step_length, self.controller.by_tolerance()) {
            (&StepLength::ErrorControlled { tolerance, .. }, Some(_)) => self.within(tolerance, observer),
            _ => self.once(observer, &Schedule::new(self.context.model, std::iter::empty(), false), &mut NoSearch),
        }
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
        let run = trace.into_kept().with_events(self.recorder.events.met());
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
            Some(before) => self.judge(search, Some((OtherRun::Before, before)), observer),
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
        (search.before, search.error.difference) = (None, None);
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
        other: Option<(TellOther, Kept)>,
        observer: &mut dyn Observer,
    ) -> Option<(Outcome, Option<State>)> {
        let Search { error, pieces, judged, .. } = search;
        let (run, inside) = (std::mem::take(&mut judged.run), self.controller.looks_inside());
        let next = match &other {
            Some((_, other)) => error.judge(&run, other, self.context.length),
            None => Some(error.without_trial()),
        };
        let dictated = other.as_ref().is_some_and(|(_, other)| run.has_steps_of(other));
        observer.on_other_run(other.filter(|_| error.estimate.is_some()).map(|(which, _)| which(error.apart)));
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
        let trial = trace.into_kept().with_events(self.recorder.events.met());
        let Search { error, judged, .. } = &mut *search;
        error.add(self.recorder.own());
        std::mem::swap(&mut self.recorder, &mut judged.recorder);
        self.workspace.warnings = std::mem::take(&mut judged.warnings);
        [self.workspace.rotation_drift, self.workspace.joint_violation] = judged.seen;
        match outcome {
            Outcome::Done => self.judge(search, Some((OtherRun::Trial, trial)), observer),
            Outcome::Failed { .. } => self.judge(search, None, observer),
            Outcome::Stopped { .. } => {
                let stopped = Outcome::Stopped { time: model.analysis.end_time };
                Some((stopped, Some(std::mem::take(&mut judged.state))))
            }
            Outcome::Io(_) => Some((outcome, Some(std::mem::take(&mut judged.state)))),
        }
    }
}
