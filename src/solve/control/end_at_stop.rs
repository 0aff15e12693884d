//! Last step of a stage with a `stop`: it ends at the value.

use crate::context::Context;
use crate::failure::Failure;
use crate::march::March;
use crate::report::StepReport;
use crate::tolerances::end_at_stop::TRIED;
use crate::workspace::Workspace;
use mechanics::state::State;

/// Takes a step from a state to a time.
pub type TakeStep<'s> = dyn FnMut(&Context, &mut Workspace, &mut State, f64) -> Result<StepReport, Failure> + 's;

/// Checks the completed step between two times for the stop value. A step that passes the stop value is repeated up to the value. Returns
/// the report of the step, and its length if it is the last step.
///
/// # Errors
/// The step cannot be repeated, for example after a signal; the state is that at its start.
pub fn end_at_stop(
    march: &mut March,
    (from, to): (f64, f64),
    report: StepReport,
    step: &mut TakeStep,
) -> Result<(StepReport, Option<f64>), Failure> {
    let March { cx, ws, state, stop_watch, .. } = march;
    let Some((watch, left)) = stop_watch.as_deref_mut().and_then(|watch| {
        let left = watch.passed(cx, state)?;
        Some((watch, left))
    }) else {
        return Ok((report, None));
    };
    let mut last = (report, left);
    // The Illinois form of the regula falsi.
    let (mut low, mut high) = ((from, watch.left_before(cx)), (to, last.1));
    for _ in 0..TRIED {
        let time = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        if watch.is_met(last.1) || !(time > low.0 && time < high.0) {
            break;
        }
        watch.go_back(ws, state);
        match step(cx, ws, state, time) {
            Ok(report) => last = (report, watch.left(cx, state)),
            Err(Failure::Stopped) => return Err(Failure::Stopped),
            // Then it ends a little beyond.
            Err(_) => {
                last = (step(cx, ws, state, high.0)?, high.1);
                break;
            }
        }
        if last.1 > 0.0 {
            low = (time, last.1);
            high.1 *= 0.5;
        } else {
            high = (time, last.1);
            low.1 *= 0.5;
        }
    }
    watch.accept(cx, state, true);
    Ok((last.0, Some(state.time - from)))
}
