//! Steps of given length: each is cut into substeps where it fails, and these grow again.

use super::intervals::{CoverInterval, Interval};
use crate::model::AnalysisKind;
use crate::solve::context::Context;
use crate::solve::failure::Failure;
use crate::solve::march::March;
use crate::solve::outcome::Outcome;
use crate::solve::recorder::AcceptedStep;
use crate::solve::report::StepReport;
use crate::solve::time_stepper::TimeStepper;
use crate::solve::workspace::Workspace;
use crate::state::State;

/// Halvings of a step that are ever tried; the deck's least step may stop earlier.
const DEEPEST: u32 = 40;
/// The whole of a step, in the smallest of its substeps.
const WHOLE: u64 = 1 << DEEPEST;
/// Substeps in which a step of the deck may be taken, without impacts to resolve and with: beyond that nobody waits for the end.
/// Without impacts steps in a row that are each cut into more than `MANY` count together.
const MOST_SUBSTEPS: [usize; 2] = [1024, 4096];
const MANY: usize = 32;

/// Leads any stepper in steps of given length.
pub struct FixedController<'a> {
    stepper: TimeStepper<'a>,
    /// Steps in a row that were cut into many substeps, and these.
    subdivided: SubdividedSteps,
}

#[derive(Clone, Copy, Default)]
struct SubdividedSteps {
    steps: usize,
    substeps: usize,
}

/// A step of the deck on its way. Substeps are halves of halves, so they end where the step ends.
struct Substeps {
    from: f64,
    to: f64,
    /// How far the step has come, and the length of the next substep, in parts of [`WHOLE`].
    at: u64,
    length: u64,
    /// Substeps taken, those of them since one was cut or doubled, and cutbacks before the one at hand.
    taken: usize,
    successes: usize,
    cuts: usize,
    /// Why joints could not be closed in the step as the deck has it: gaps shrink with the step, and say less and less.
    violated_at_full_length: Option<Failure>,
    /// Why the last substep was cut.
    cause: Option<Failure>,
}

impl<'a> FixedController<'a> {
    pub fn new(stepper: TimeStepper<'a>) -> Self {
        FixedController { stepper, subdivided: SubdividedSteps::default() }
    }

    /// Takes the k-th step of the interval, in as many substeps as it takes.
    fn advance(&mut self, march: &mut March, interval: &Interval, k: usize) -> Result<(), Outcome> {
        let due = k == interval.steps && interval.due;
        let mut step = Substeps::of(march.state.time, interval.time(k));
        while step.at < WHOLE {
            march.check_stop()?;
            let target = step.target();
            let dt = target - march.state.time;
            match self.stepper.step(march.cx, march.ws, march.state, target) {
                Ok(report) => {
                    step.took();
                    step.show(march, &report, dt, due)?;
                    self.check_substeps(march, &step, dt)?;
                    step.grow();
                }
                Err(failure) => {
                    step.cut_back(march, failure, dt)?;
                    march.count_cut();
                }
            }
        }
        let SubdividedSteps { steps, substeps } = self.subdivided;
        let subdivided = step.taken > MANY && !march.cx.system.has_contacts();
        self.subdivided = match subdivided {
            true => SubdividedSteps { steps: steps + 1, substeps: substeps + step.taken },
            false => SubdividedSteps::default(),
        };
        Ok(())
    }

    /// # Errors
    /// [`Failure::TooManySubsteps`] where steps need too many substeps.
    fn check_substeps(&self, march: &March, step: &Substeps, dt: f64) -> Result<(), Outcome> {
        let SubdividedSteps { steps, substeps } = self.subdivided;
        let most = MOST_SUBSTEPS[usize::from(march.cx.system.has_contacts())];
        match &step.cause {
            Some(cause) if substeps + step.taken >= most && step.at < WHOLE => {
                let (steps, substeps, cause) = (steps + 1, substeps + step.taken, Box::new(cause.clone()));
                Err(march.failed(Failure::TooManySubsteps { steps, substeps, dt, cause }))
            }
            _ => Ok(()),
        }
    }
}

impl CoverInterval for FixedController<'_> {
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        self.stepper.restart(cx, ws, state);
    }

    /// In its equal steps.
    fn cover(&mut self, march: &mut March, interval: &Interval) -> Result<(), Outcome> {
        for k in 1..=interval.steps {
            self.advance(march, interval, k)?;
        }
        Ok(())
    }
}

impl Substeps {
    fn of(from: f64, to: f64) -> Substeps {
        Substeps {
            from,
            to,
            at: 0,
            length: WHOLE,
            taken: 0,
            successes: 0,
            cuts: 0,
            violated_at_full_length: None,
            cause: None,
        }
    }

    /// Where the next substep ends.
    fn target(&self) -> f64 {
        match self.at + self.length {
            WHOLE => self.to,
            next => self.from + (self.to - self.from) * (next as f64 / WHOLE as f64),
        }
    }

    fn took(&mut self) {
        self.at += self.length;
        self.successes += 1;
        self.taken += 1;
    }

    /// Shows the substep that was taken; `due`: the end of the step is an output time.
    fn show(&mut self, march: &mut March, report: &StepReport, dt: f64, due: bool) -> Result<(), Outcome> {
        let ends = self.at == WHOLE;
        let (due, last) = (ends && due, ends && march.is_end(self.to));
        march.notify(&AcceptedStep { dt, report, cuts: self.cuts, due, last, passed: &[] })?;
        self.cuts = 0;
        Ok(())
    }

    /// Two substeps were taken and a longer one fits: it is tried.
    fn grow(&mut self) {
        if self.successes >= 2 && self.length < WHOLE && self.at.is_multiple_of(2 * self.length) {
            self.length *= 2;
            self.successes = 0;
        }
    }

    /// After a substep of `dt` that failed.
    ///
    /// # Errors
    /// The failure, where no shorter substep is left or none would help.
    fn cut_back(&mut self, march: &March, failure: Failure, dt: f64) -> Result<(), Outcome> {
        let analysis = &march.cx.model.analysis;
        // A structure that nothing restrains is not helped by smaller loads; one that yields may be.
        let unrestrained = analysis.kind == AnalysisKind::Static
            && march.cx.system.history == 0
            && march.state.time == 0.0
            && matches!(failure, Failure::Singular { .. });
        let violated = matches!(failure, Failure::ConstraintsViolated { .. });
        if violated && self.violated_at_full_length.is_none() {
            self.violated_at_full_length = Some(failure.clone());
        }
        if self.length == 1 || 0.5 * dt < analysis.least_step || unrestrained {
            let first = self.violated_at_full_length.take().filter(|_| violated);
            return Err(march.failed(first.unwrap_or(failure)));
        }
        self.cause = Some(failure);
        self.length /= 2;
        self.cuts += 1;
        self.successes = 0;
        Ok(())
    }
}
