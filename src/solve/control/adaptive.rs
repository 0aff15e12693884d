//! Adaptive steps, by error or stability: the loop that all such controllers share.

use super::end_at_stop::end_at_stop;
use super::intervals::{CoverInterval, Interval};
use crate::context::Context;
use crate::failure::Failure;
use crate::march::March;
use crate::outcome::Outcome;
use crate::recorder::AcceptedStep;
use crate::report::StepReport;
use crate::workspace::Workspace;
use base::snapshot::Keep;
use mechanics::state::State;

/// A controller that finds the length of each step, and leads a stepper by it.
pub trait StepController: Keep {
    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State);

    /// Takes the state over a failure of material or of a link in the step of length `dt` that was taken last. Nothing is done for central
    /// differences.
    ///
    /// # Errors
    /// As for [`crate::jumps::release`].
    fn release(&mut self, _: &Context, _: &mut Workspace, _: &mut State, _dt: f64) -> Result<(), Failure> {
        Ok(())
    }

    /// The length of the next step; `left` is the time to the next event.
    ///
    /// # Errors
    /// There is none.
    fn propose(&mut self, cx: &Context, ws: &mut Workspace, state: &State, left: f64) -> Result<f64, Failure>;

    /// Takes a step to the time `to`, proposed as `length`. Returns `None` where no step was taken but the next proposal will be better.
    ///
    /// # Errors
    /// As for [`crate::time_stepper::TimeStepper::step`], and [`Failure::ErrorTooLarge`]; `state` is untouched.
    fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
        length: f64,
    ) -> Result<Option<StepReport>, Failure>;

    /// Records a step of length `dt` that failed for another reason than its error; errors limit the next length anyway.
    fn cut_back(&mut self, dt: f64);

    /// State at a time inside the last step, which led to `end`, and its cost; `None` if steps end at all output times.
    ///
    /// # Errors
    /// No equilibrium was found there.
    fn look_inside(
        &mut self,
        _: &Context,
        _: &mut Workspace,
        _end: &State,
        _time: f64,
    ) -> Result<Option<(&State, StepReport)>, Failure> {
        Ok(None)
    }

    /// Follows another error tolerance from here on. Nothing is done where steps follow none.
    fn go_on_with(&mut self, _tolerance: f64) {}

    /// Returns to the start of the last step, if the motion inside turns out unknown.
    fn take_back(&mut self, _: &mut State) {}
}

impl<C: StepController> CoverInterval for C {
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        StepController::restart(self, cx, ws, state);
    }

    /// Covers the interval in equal steps as long as nothing requires another length.
    fn cover(&mut self, march: &mut March, interval: &Interval) -> Result<(), Outcome> {
        let least = march.cx.model.analysis.least_step;
        while march.state.time < interval.to {
            if let Some(tolerance) = march.observer.new_tolerance() {
                self.go_on_with(tolerance);
            }
            march.pause(self)?;
            let left = interval.to - march.state.time;
            let length = self.propose(march.cx, march.ws, march.state, left);
            let length = length.map_err(|failure| march.failed_step(self, failure))?;
            let pieces = (left / length * (1.0 - 1e-9)).ceil().max(1.0);
            let target = if pieces == 1.0 { interval.to } else { march.state.time + left / pieces };
            let dt = target - march.state.time;
            if let Some(watch) = march.stop_watch.as_deref_mut() {
                watch.note(march.ws, march.state);
            }
            let mut taken = step_or_stop(self, march, target, length);
            if let Ok(Some((_, stop))) = &taken
                && let Err(failure) = show_inside(self, march, stop.unwrap_or(dt))?
            {
                self.take_back(march.state);
                taken = Err(failure);
            }
            match taken {
                Ok(Some((report, stop))) => {
                    let at_end = march.state.time >= interval.to;
                    let (due, compared) = (at_end && interval.due, at_end && interval.compared);
                    let (stops, dt) = (stop.is_some(), stop.unwrap_or(dt));
                    let (due, compared) = (due || stops, compared || stops);
                    let last = stops || at_end && march.is_end(interval.to);
                    let cuts = std::mem::take(&mut march.place.cuts);
                    march.notify(&AcceptedStep { dt, report: &report, cuts, due, compared, last, passed: &[] })?;
                    if stops {
                        return Err(Outcome::Done);
                    }
                    if march.has_released() {
                        let released = self.release(march.cx, march.ws, march.state, dt);
                        released.map_err(|failure| march.failed(failure))?;
                    }
                }
                Ok(None) => {}
                Err(failure) => {
                    // The difference of two times is a length only to rounding.
                    if length <= least || dt <= least || failure.is_final() {
                        return Err(march.failed_step(self, failure));
                    }
                    if !matches!(failure, Failure::ErrorTooLarge { .. }) {
                        self.cut_back(dt);
                    }
                    march.place.cuts += 1;
                    march.count_cut();
                }
            }
        }
        Ok(())
    }
}

/// Takes a step to a time, proposed as `length`, or to an earlier stop of the stage; its length is then returned beside the report.
///
/// # Errors
/// As for [`StepController::step`].
fn step_or_stop(
    controller: &mut impl StepController,
    march: &mut March,
    target: f64,
    length: f64,
) -> Result<Option<(StepReport, Option<f64>)>, Failure> {
    let from = march.state.time;
    let taken = controller.step(march.cx, march.ws, march.state, target, length)?;
    let again = &mut |cx: &Context, ws: &mut Workspace, state: &mut State, time| {
        controller.take_back(state);
        let taken = controller.step(cx, ws, state, time, length);
        taken.and_then(|report| report.ok_or(Failure::ErrorTooLarge { dt: time - from }))
    };
    taken.map(|report| end_at_stop(march, (from, target), report, again)).transpose()
}

/// Shows the times inside the last step of length `dt`. The failure belongs to a time inside without an equilibrium.
///
/// # Errors
/// As for [`March::notify_inside`].
fn show_inside(
    controller: &mut impl StepController,
    march: &mut March,
    dt: f64,
) -> Result<Result<(), Failure>, Outcome> {
    let end = march.state.time;
    while let Some(sample) = march.samples.next(end) {
        let March { cx, ws, state, .. } = &mut *march;
        match ws.inside_step(|ws| controller.look_inside(cx, ws, state, sample.time)) {
            Ok(Some((state, report))) => march.notify_inside(state, &report, dt, &sample)?,
            Ok(None) => {}
            Err(failure) => return Ok(Err(failure)),
        }
        march.samples.pass();
    }
    Ok(Ok(()))
}
