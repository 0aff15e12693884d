//! `accuracy`: the error of the results by steps, mesh and contact stiffness together.

use crate::data::{ERROR_TOLERANCE, StepLength};
use crate::report::Report;
use crate::values::{keys, span};
use base::diagnostic::{At, Span};
use deck::analysis as words;
use mechanics::integrators::Scheme;

/// Expected number of steps of a run whose error is to be τ, times τ^(1/p), with p the order of the scheme.
const STEPS: f64 = 20.0;

/// Reads `accuracy`, which needs steps in time.
pub fn accuracy<'d>(analysis: &'d words::Analysis, report: &mut Report<'d>) -> Option<f64> {
    let at = analysis.accuracy.as_ref()?;
    if !(at.value > 0.0 && at.value < 1.0) {
        let hint = "it is relative to the largest change of each result, such as 1e-3";
        report.error_with::<()>(&at.span, "`accuracy` must lie between 0 and 1", hint);
        return Some(ERROR_TOLERANCE);
    }
    let follows_path = analysis.control.as_ref().is_some_and(|control| control.value != words::Control::Time);
    if follows_path {
        let hint = "paths on different meshes have no load factors in common: refine `elements` by hand, or give `control = \"time\"`";
        return report.error_with(&at.span, "`accuracy` does not apply to a path that follows a displacement", hint);
    }
    Some(at.value)
}

/// The tolerance of automatic steps, checked; with `accuracy` it is a part of that.
pub fn tolerance(analysis: &words::Analysis, accuracy: Option<f64>, report: &mut Report) -> f64 {
    let is_within = |value: f64| value > 0.0 && accuracy.map_or(value < 1.0, |accuracy| value <= accuracy);
    if let Some(At { value, span }) = &analysis.error_tolerance
        && !is_within(*value)
    {
        match accuracy {
            Some(most) => {
                let message = format!(
                    "`error_tolerance`, the part for time steps, must be above 0 and at most `accuracy`, {most:e}"
                );
                report.error_with::<()>(span, message, "remove it, and pilot runs find it");
            }
            None => {
                let hint = "it is relative to the largest displacement";
                report.error_with::<()>(span, "`error_tolerance` must lie between 0 and 1", hint);
            }
        }
    }
    analysis.error_tolerance.as_ref().map_or(accuracy.unwrap_or(ERROR_TOLERANCE), |at| at.value)
}

/// Refuses a length of steps that `accuracy` is to choose.
pub fn refuse_step(analysis: &words::Analysis, place: &Span, report: &mut Report) {
    if analysis.accuracy.is_some() {
        let hint = "remove `time_step`, or write time_step = \"auto\"";
        report.error_with::<()>(place, "`accuracy` chooses the time steps, and `time_step` is a number", hint);
    }
    report.reject_unused("a `time_step` that is a number", &[("error_tolerance", span(&analysis.error_tolerance))]);
}

/// Refuses `accuracy` in an analysis without steps in time.
pub fn refuse_without_steps(analysis: &words::Analysis, what: &str, report: &mut Report) {
    report.reject_unused(what, &keys!(analysis; accuracy));
}

/// Checks that an error can be controlled: its estimate holds for schemes of second order, and rounding bounds the
/// tolerance from below.
pub fn check_error_control(
    step_length: &StepLength,
    table: &words::Analysis,
    scheme: &dyn Scheme,
    report: &mut Report,
) {
    let &StepLength::ErrorControlled { tolerance, .. } = step_length else { return };
    if scheme.order() < 2
        && let Some(place) = span(&table.time_step).or(span(&table.accuracy))
    {
        let message =
            format!("automatic steps need a scheme of second order, and {} is of first order", scheme.in_words());
        report.error_with::<()>(
            place,
            message,
            "take a scheme such as \"generalized-alpha\", or leave `[integrator]` out",
        );
    }
    for (key, place) in keys!(table; accuracy, error_tolerance) {
        if let Some(place) = place {
            can_be_kept(key, tolerance, scheme, place, report);
        }
    }
}

/// Warns of a tolerance below rounding. Each step rounds, and shorter ones are more: beyond ε n = τ, n = 20/τ^(1/p),
/// the sum may exceed the tolerance. (A mass on a spring ends at 7e-11, whatever is asked of a scheme of second order.)
pub fn can_be_kept(key: &str, tolerance: f64, scheme: &dyn Scheme, place: &Span, report: &mut Report) {
    let order = scheme.order() as f64;
    let least = (STEPS * f64::EPSILON).powf(order / (order + 1.0));
    if tolerance > 0.0 && tolerance < least {
        let message = format!("`{key}` is below the rounding error of numbers with \"{}\"", scheme.word());
        let hint = format!("give {least:.0e} or more; rounding of so many steps may add up to that");
        report.warn(place, message, hint);
    }
}
