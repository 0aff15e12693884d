//! Steps of given length: each is cut into substeps where it fails, and these grow again.

use super::end_at_stop::end_at_stop;
use super::intervals::{CoverInterval, Interval};
use crate::context::Context;
use crate::failure::Failure;
use crate::march::March;
use crate::outcome::Outcome;
use crate::recorder::AcceptedStep;
use crate::report::StepReport;
use crate::sudden_loads::SuddenLoads;
use crate::time_stepper::TimeStepper;
use crate::tolerances::fixed::{CAREFUL_HALVINGS, MANY, MOST_HALVINGS, MOST_SUBSTEPS};
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::state::State;

/// A whole step, in units of the smallest substep.
const WHOLE_STEP: u64 = 1 << MOST_HALVINGS;

/// Leads any stepper in steps of given length.
pub struct FixedController<'a> {
    stepper: TimeStepper<'a>,
    /// Consecutive steps that were cut into many substeps.
    subdivided: SubdividedSteps,
    /// True where loads may act at once as the next step begins.
    sudden: bool,
    /// The step of the deck under way.
    step: Substeps,
}

keep!(FixedController<'_> { stepper, subdivided, sudden, step });

#[derive(Clone, Copy, Default)]
struct SubdividedSteps {
    steps: usize,
    substeps: usize,
}

keep!(SubdividedSteps { steps, substeps });

/// A step of the deck under way. Substeps are halves of halves, so they end where the step ends.
struct Substeps {
    from: f64,
    to: f64,
    /// Time from the start of the step, and the length of the next substep, in parts of [`WHOLE_STEP`].
    at: u64,
    length: u64,
    /// Number of substeps completed, of substeps since the last cutback or doubling, and of cutbacks before the current substep.
    taken: usize,
    successes: usize,
    cuts: usize,
    /// The failure of joints in the step at its full length: gaps shrink with the step and say less and less.
    violated_at_full_length: Option<Failure>,
    /// The failure that cut the last substep.
    cause: Option<Failure>,
    /// The failure of the shortest step, where the step is tried again with shortened corrections.
    of_shortest: Option<Failure>,
}

keep!(Substeps { from, to, at, length, taken, successes, cuts, violated_at_full_length, cause, of_shortest });

impl<'a> FixedController<'a> {
    /// A controller that leads this stepper.
    pub fn new(stepper: TimeStepper<'a>) -> Self {
        FixedController { stepper, subdivided: SubdividedSteps::default(), sudden: true, step: Substeps::NONE }
    }

    /// Takes the k-th step of the interval, in as many substeps as it needs.
    fn advance(&mut self, march: &mut March, interval: &Interval, k: usize) -> Result<(), Outcome> {
        let at_end = |of: bool| k == interval.steps && of;
        let (due, compared) = (at_end(interval.due), at_end(interval.compared));
        if self.step.at == WHOLE_STEP {
            self.step = Substeps::of(march.state.time, interval.time(k));
        }
        while self.step.at < WHOLE_STEP {
            march.pause(self).map_err(|outcome| self.step.stopped_in(outcome))?;
            let target = self.step.target();
            let dt = target - march.state.time;
            if let Some(watch) = march.stop_watch.as_deref_mut() {
                watch.note(march.ws, march.state);
            }
            match self.step_or_stop(march, target, dt) {
                Ok((report, stop)) => {
                    if let Some(dt) = stop {
                        let end = AcceptedStep { due: true, last: true, ..self.step.accepted(&report, dt) };
                        return march.notify(&end).and(Err(Outcome::Done));
                    }
                    march.ws.load_steps.careful = false;
                    self.step.count();
                    self.step.notify(march, &report, dt, [due, compared])?;
                    if march.has_released() {
                        let released = self.stepper.release(march.cx, march.ws, march.state, dt);
                        released.map_err(|failure| march.failed(failure))?;
                    }
                    self.check_substeps(march, dt)?;
                    self.step.grow();
                }
                Err(Failure::Stopped) => {
                    let outcome = march.failed_step(self, Failure::Stopped);
                    return Err(self.step.stopped_in(outcome));
                }
                Err(failure) => {
                    self.step.cut_back(march, failure, dt)?;
                    march.count_cut();
                }
            }
        }
        let SubdividedSteps { steps, substeps } = self.subdivided;
        let subdivided = self.step.taken > MANY && !march.cx.system.has_contacts();
        self.subdivided = match subdivided {
            true => SubdividedSteps { steps: steps + 1, substeps: substeps + self.step.taken },
            false => SubdividedSteps::default(),
        };
        Ok(())
    }

    /// Takes a step to a time, or to where the stage stops before it; its length is then told beside the report.
    ///
    /// # Errors
    /// As for [`TimeStepper::step`].
    fn step_or_stop(&mut self, march: &mut March, target: f64, dt: f64) -> Result<(StepReport, Option<f64>), Failure> {
        let stepper = &mut self.stepper;
        let report = stepper.step(march.cx, march.ws, march.state, target)?;
        let again = &mut |cx: &Context, ws: &mut Workspace, state: &mut State, time| {
            stepper.forget_iterates();
            stepper.step(cx, ws, state, time)
        };
        end_at_stop(march, (target - dt, target), report, again)
    }

    /// # Errors
    /// [`Failure::TooManySubsteps`] where steps need too many substeps.
    fn check_substeps(&self, march: &mut March, dt: f64) -> Result<(), Outcome> {
        let (step, SubdividedSteps { steps, substeps }) = (&self.step, self.subdivided);
        let most = MOST_SUBSTEPS[usize::from(march.cx.system.has_contacts())];
        match &step.cause {
            Some(cause) if substeps + step.taken >= most && step.at < WHOLE_STEP => {
                let (steps, substeps, cause) = (steps + 1, substeps + step.taken, Box::new(cause.clone()));
                Err(march.given_up(Failure::TooManySubsteps { steps, substeps, dt, cause }))
            }
            _ => Ok(()),
        }
    }
}

impl CoverInterval for FixedController<'_> {
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        (self.sudden, self.step) = (true, Substeps::NONE);
        self.stepper.restart(cx, ws, state);
    }

    /// Covers the interval in its equal steps.
    fn cover(&mut self, march: &mut March, interval: &Interval) -> Result<(), Outcome> {
        let is_static = !march.cx.is_dynamic();
        for k in march.place.step + 1..=interval.steps {
            // Loads that change with a stage are ramped over the whole stage, not applied suddenly.
            let begin = march.cx.model.analysis.begin;
            let begins = begin > 0.0 && march.state.time <= begin;
            if is_static && std::mem::take(&mut self.sudden) && !begins {
                march.ws.load_steps.sudden = Some(SuddenLoads::over(march.cx, march.state.time, interval.time(k)));
            }
            self.advance(march, interval, k)?;
            march.ws.load_steps.sudden = None;
            march.place.step = k;
        }
        self.sudden = interval.jump;
        Ok(())
    }
}

impl Substeps {
    /// No step: one that has come to its end.
    const NONE: Substeps = Substeps {
        from: 0.0,
        to: 0.0,
        at: WHOLE_STEP,
        length: WHOLE_STEP,
        taken: 0,
        successes: 0,
        cuts: 0,
        violated_at_full_length: None,
        cause: None,
        of_shortest: None,
    };

    fn of(from: f64, to: f64) -> Substeps {
        Substeps { from, to, at: 0, ..Substeps::NONE }
    }

    /// End time of the next substep.
    fn target(&self) -> f64 {
        match self.at + self.length {
            WHOLE_STEP => self.to,
            next => self.from + (self.to - self.from) * (next as f64 / WHOLE_STEP as f64),
        }
    }

    fn count(&mut self) {
        self.at += self.length;
        self.successes += 1;
        self.taken += 1;
    }

    /// Shows the substep that was taken; with `due`, the end of the step is an output time, with `compared`, runs are compared there.
    fn notify(
        &mut self,
        march: &mut March,
        report: &StepReport,
        dt: f64,
        [due, compared]: [bool; 2],
    ) -> Result<(), Outcome> {
        let ends = self.at == WHOLE_STEP;
        let (due, compared, last) = (ends && due, ends && compared, ends && march.is_end(self.to));
        march.notify(&AcceptedStep { due, compared, last, ..self.accepted(report, dt) })?;
        self.cuts = 0;
        Ok(())
    }

    /// The substep that was taken, as the recorder receives it.
    fn accepted<'s>(&self, report: &'s StepReport, dt: f64) -> AcceptedStep<'s> {
        AcceptedStep { dt, report, cuts: self.cuts, due: false, compared: false, last: false, passed: &[] }
    }

    /// The outcome of a run that ends in this step. A stopped run names the failure behind the last cutback.
    fn stopped_in(&self, outcome: Outcome) -> Outcome {
        match outcome {
            Outcome::Stopped { time, .. } => {
                Outcome::Stopped { time, cut: self.cause.clone().filter(|_| self.cuts > 0) }
            }
            outcome => outcome,
        }
    }

    /// Doubles the substep where two were taken and a longer one fits.
    fn grow(&mut self) {
        if self.successes >= 2 && self.length < WHOLE_STEP && self.at.is_multiple_of(2 * self.length) {
            self.length *= 2;
            self.successes = 0;
        }
    }

    /// Halves the substep after one of `dt` that failed.
    ///
    /// # Errors
    /// The failure, where no shorter substep is left or none would help.
    fn cut_back(&mut self, march: &mut March, failure: Failure, dt: f64) -> Result<(), Outcome> {
        let analysis = &march.cx.model.analysis;
        // Smaller loads do not help an unrestrained structure; they may help one that yields.
        let unrestrained = !analysis.is_dynamic()
            && march.cx.system.history == 0
            && matches!(failure, Failure::Singular { at_start: true, .. });
        let violated = matches!(failure, Failure::ConstraintsViolated { .. });
        if violated && self.violated_at_full_length.is_none() {
            self.violated_at_full_length = Some(failure.clone());
        }
        let stops = failure.is_final();
        let is_shortest = self.length == 1 || 0.5 * dt < analysis.least_step;
        if is_shortest && !unrestrained && !stops && self.is_tried_with_care(march, &failure) {
            return Ok(());
        }
        let careful = march.ws.load_steps.careful && self.length <= WHOLE_STEP >> CAREFUL_HALVINGS;
        if let Some(failure) = self.of_shortest.take_if(|_| careful || is_shortest) {
            return Err(march.given_up(failure));
        }
        if is_shortest || unrestrained || stops {
            let first = self.violated_at_full_length.take().filter(|_| violated);
            return Err(march.given_up(first.unwrap_or(failure)));
        }
        self.cause = Some(failure);
        self.length /= 2;
        self.cuts += 1;
        self.successes = 0;
        Ok(())
    }

    /// After the failure of the shortest step: begins again with the longest substep that ends inside the step, with shortened corrections,
    /// where nothing is stressed yet. A flat membrane or net is so soft then that no step is short enough. Returns false in other cases, and
    /// if this retry was already made.
    fn is_tried_with_care(&mut self, march: &mut March, failure: &Failure) -> bool {
        let load_steps = &mut march.ws.load_steps;
        let is_lost = matches!(
            failure,
            Failure::NotConverged { .. }
                | Failure::NotFinite { .. }
                | Failure::LoadStepTurns { .. }
                | Failure::TurnedOver { .. }
        );
        let is_static = !march.cx.model.analysis.is_dynamic();
        if !is_static || !is_lost || load_steps.peak.stressed || load_steps.careful {
            return false;
        }
        (load_steps.careful, load_steps.doubtful) = (true, None);
        (self.length, self.successes) = (longest(self.at), 0);
        self.of_shortest = Some(failure.clone());
        true
    }
}

/// The longest substep from a place in the step: it ends where halves of the step end.
fn longest(at: u64) -> u64 {
    1 << (at | WHOLE_STEP).trailing_zeros()
}
