//! Steps that find their own length, by their error or by what is stable: the loop that all of them share.

use super::intervals::{CoverInterval, Interval};
use crate::solve::context::Context;
use crate::solve::failure::Failure;
use crate::solve::march::March;
use crate::solve::outcome::Outcome;
use crate::solve::recorder::AcceptedStep;
use crate::solve::report::StepReport;
use crate::solve::workspace::Workspace;
use crate::state::State;

/// What finds the lengths of steps, and leads a stepper by them.
pub trait StepController {
    /// A run starts from this state, or goes on from it after a jump of the loads.
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State);

    /// The length of the next step, where `left` is left to where a step must end.
    ///
    /// # Errors
    /// There is none.
    fn propose(&mut self, cx: &Context, ws: &mut Workspace, state: &State, left: f64) -> Result<f64, Failure>;

    /// Takes a step to `to`, of which the proposal was `length`; `None` where nothing was taken but the next proposal will be
    /// better.
    ///
    /// # Errors
    /// As for [`crate::solve::time_stepper::TimeStepper::step`], and [`Failure::ErrorTooLarge`]; `state` is untouched.
    fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
        length: f64,
    ) -> Result<Option<StepReport>, Failure>;

    /// A step of `dt` failed otherwise than by its error, which has said how long a step may be.
    fn cut_back(&mut self, dt: f64);
}

impl<C: StepController> CoverInterval for C {
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        StepController::restart(self, cx, ws, state);
    }

    /// In steps of equal length, ending at its end, as long as nothing asks for another length.
    fn cover(&mut self, march: &mut March, interval: &Interval) -> Result<(), Outcome> {
        let least = march.cx.model.analysis.least_step;
        let mut cuts = 0;
        while march.state.time < interval.to {
            march.check_stop()?;
            let left = interval.to - march.state.time;
            let length = self.propose(march.cx, march.ws, march.state, left);
            let length = length.map_err(|failure| march.failed(failure))?;
            let pieces = (left / length * (1.0 - 1e-9)).ceil().max(1.0);
            let target = if pieces == 1.0 { interval.to } else { march.state.time + left / pieces };
            let dt = target - march.state.time;
            match self.step(march.cx, march.ws, march.state, target, length) {
                Ok(Some(report)) => {
                    let at_end = march.state.time >= interval.to;
                    let (due, last) = (at_end && interval.due, at_end && march.is_end(interval.to));
                    march.notify(&AcceptedStep { dt, report: &report, cuts, due, last, passed: &[] })?;
                    cuts = 0;
                }
                Ok(None) => {}
                Err(failure) => {
                    // The difference of two times is a length only to rounding.
                    if length <= least || dt <= least {
                        return Err(march.failed(failure));
                    }
                    if !matches!(failure, Failure::ErrorTooLarge { .. }) {
                        self.cut_back(dt);
                    }
                    cuts += 1;
                    march.count_cut();
                }
            }
        }
        Ok(())
    }
}
