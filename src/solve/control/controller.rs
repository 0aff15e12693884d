//! The controllers of the step length, each with the stepper that it leads.

use super::arc_length::ArcLengthController;
use super::embedded_error::EmbeddedErrorController;
use super::error_controlled::ErrorController;
use super::fixed::FixedController;
use super::intervals::{CoverInterval, Interval, Schedule};
use super::stability_limited::StabilityController;
use super::tolerance::FollowTolerance;
use crate::context::Context;
use crate::initial_transient;
use crate::jumps;
use crate::march::{March, RunPosition};
use crate::outcome::Outcome;
use crate::time_stepper::TimeStepper;
use crate::workspace::Workspace;
use base::snapshot::{Keep, Snapshot};
use linear::TooLarge;
use model::StepLength;

use std::borrow::Cow;

/// The controller of a run, one variant for each way of [`StepLength`].
pub enum Controller<'a> {
    /// Steps of given length.
    Fixed(FixedController<'a>),
    /// Steps by the error of implicit steps, estimated from the motion.
    ErrorControlled(Box<ErrorController<'a>>),
    /// Steps by the error estimate of embedded Runge-Kutta schemes.
    EmbeddedError(EmbeddedErrorController),
    /// Steps by the critical time step of central differences.
    StabilityLimited(StabilityController),
    /// Steps along an equilibrium path.
    ArcLength(Box<ArcLengthController>),
}

/// Controllers are kept as such wherever they pause.
impl Keep for Controller<'_> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        match self {
            Controller::Fixed(controller) => controller.keep(snapshot),
            Controller::ErrorControlled(controller) => controller.keep(snapshot),
            Controller::EmbeddedError(controller) => controller.keep(snapshot),
            Controller::StabilityLimited(controller) => controller.keep(snapshot),
            Controller::ArcLength(controller) => controller.keep(snapshot),
        }
    }
}

impl<'a> Controller<'a> {
    /// The controller of the deck, with its stepper.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(cx: &Context<'a>, ws: &mut Workspace) -> Result<Self, TooLarge> {
        Ok(match (&cx.model.analysis.step_length, TimeStepper::new(cx)?) {
            (&StepLength::ErrorControlled { tolerance, first }, TimeStepper::Implicit(stepper)) => {
                Controller::ErrorControlled(Box::new(ErrorController::new(cx, stepper, tolerance, first)))
            }
            (&StepLength::ErrorControlled { tolerance, first }, TimeStepper::RungeKutta(stepper)) => {
                Controller::EmbeddedError(EmbeddedErrorController::new(cx, stepper, tolerance, first))
            }
            (&StepLength::StabilityLimited { fraction }, TimeStepper::CentralDifference(stepper)) => {
                Controller::StabilityLimited(StabilityController::new(stepper, fraction))
            }
            (StepLength::ArcLength(path), TimeStepper::Implicit(stepper)) => {
                Controller::ArcLength(Box::new(ArcLengthController::new(cx, ws, stepper.solver, path)))
            }
            (_, stepper) => Controller::Fixed(FixedController::new(stepper)),
        })
    }

    /// The controller as one whose steps follow a tolerance; `None` for others.
    pub fn by_tolerance(&mut self) -> Option<&mut dyn FollowTolerance> {
        match self {
            Controller::ErrorControlled(controller) => Some(controller.as_mut()),
            Controller::EmbeddedError(controller) => Some(controller),
            Controller::Fixed(_) | Controller::StabilityLimited(_) | Controller::ArcLength(_) => None,
        }
    }

    /// True if the motion is known inside steps, so output times need no step end.
    pub fn looks_inside(&self) -> bool {
        match self {
            Controller::ErrorControlled(controller) => controller.looks_inside(),
            Controller::EmbeddedError(controller) => controller.looks_inside(),
            Controller::Fixed(_) | Controller::StabilityLimited(_) | Controller::ArcLength(_) => false,
        }
    }

    /// Leads the run from its state at t = 0 to its end, as scheduled.
    ///
    /// # Errors
    /// The outcome that ends it early.
    pub fn run(&mut self, march: &mut March, schedule: &Schedule) -> Result<(), Outcome> {
        let intervals = &schedule.intervals;
        match self {
            Controller::Fixed(controller) => through_intervals(controller, march, intervals),
            Controller::ErrorControlled(controller) => through_intervals(controller.as_mut(), march, intervals),
            Controller::EmbeddedError(controller) => through_intervals(controller, march, intervals),
            Controller::StabilityLimited(controller) => through_intervals(controller, march, intervals),
            Controller::ArcLength(controller) => controller.run(march),
        }
    }

    /// The displacement at the end of a path that did not reach its `stop`.
    pub fn short_of_stop(&self) -> Option<f64> {
        match self {
            Controller::ArcLength(controller) => controller.short_of_stop,
            _ => None,
        }
    }
}

/// Covers the intervals in turn; after a jump of loads with the accelerations after the jump.
fn through_intervals(
    controller: &mut impl CoverInterval,
    march: &mut March,
    intervals: &[Interval],
) -> Result<(), Outcome> {
    if !march.resumes {
        controller.restart(march.cx, march.ws, march.state);
        march.notify_start()?;
        if !march.cx.model.analysis.goes_on() {
            initial_transient::pass_over(march.cx, march.ws, march.state, march.begins_from);
        }
        if let Some(watch) = march.stop_watch.as_deref_mut() {
            watch.begin(march.cx, march.ws, march.state);
        }
    }
    let rest = rest(march, intervals);
    for interval in &rest[march.place.interval.min(rest.len())..] {
        controller.cover(march, interval)?;
        if interval.jump && march.cx.is_dynamic() {
            let before = march.state.nodes.clone();
            jumps::jump(march.cx, march.ws, march.state).map_err(|failure| march.failed(failure))?;
            controller.restart(march.cx, march.ws, march.state);
            initial_transient::pass_over(march.cx, march.ws, march.state, Some(&before));
        }
        march.place =
            RunPosition { begin: march.place.begin, interval: march.place.interval + 1, ..RunPosition::default() };
    }
    march.end(controller)
}

/// Intervals of a run, or the remaining ones of an extended run.
fn rest<'i>(march: &March, intervals: &'i [Interval]) -> Cow<'i, [Interval]> {
    let begin = march.place.begin;
    if begin == 0.0 {
        return Cow::Borrowed(intervals);
    }
    let analysis = &march.cx.model.analysis;
    let left = intervals.iter().copied().filter(|interval| interval.to > begin + 1e-9 * analysis.end_time);
    Cow::Owned(left.map(|interval| interval.after(begin, analysis.nominal_step())).collect())
}
