//! `[analysis]`, `[integrator]`, `[iteration]`.

pub mod accuracy;
pub mod choose_scheme;
pub mod control;
pub mod displacement_targets;
pub mod extent;
pub mod linear;
pub mod mass_scaling;
pub mod modes;
pub mod response;
pub mod scaled_masses;
pub mod stops;
pub mod study;

use crate::data::FIRST_STEP;
use crate::data::{Analysis, AnalysisKind, Gyroscopic, Iteration, MassKind, Method, Part, StepLength, Update};
use crate::procedure::accuracy::{accuracy, check_error_control, refuse_step, refuse_without_steps, tolerance};
use crate::procedure::linear::linear;
use crate::procedure::modes::modes;
use crate::procedure::scaled_masses::scales_masses;
use crate::report::{Owner, Report};
use crate::stages::CurrentStage;
use crate::values::{chosen, keys};
use base::diagnostic::{At, Diagnostic, Span};
use base::names::short;
use deck::Deck;
use deck::analysis as words;
use deck::read::ROOT;
use deck::words::kinds::OneOf;
use deck::words::{NumberOrAuto, Table};
use mechanics::integrators::{SCHEMES, Scheme, Stepping, default_scheme};
use std::sync::Arc;

/// Largest number of halvings of a step, unless the deck says otherwise.
const HALVINGS: i32 = 20;
/// Largest number of steps; more are taken for a typing error.
const MOST_STEPS: f64 = 1e9;

/// The analysis and its solution, before the supports say how a path is followed.
pub struct Procedure {
    /// The analysis.
    pub analysis: Analysis,
    /// The scheme.
    pub scheme: Arc<dyn Scheme>,
    /// The iteration.
    pub iteration: Iteration,
}

/// Reads `[analysis]`, `[integrator]` and `[iteration]`, which do not refer to other tables.
pub fn analysis<'d>(deck: &'d Deck, stage: Option<CurrentStage<'d>>, report: &mut Report<'d>) -> Procedure {
    let analysis = match &deck.analysis {
        Some(analysis) => {
            let what = stage.map_or_else(|| "`[analysis]`".to_owned(), |stage| format!("stage `{}`", stage.name()));
            let read = times(&analysis.value, Owner::new(what, &analysis.span), report);
            match stage.map(|stage| stage.times()) {
                Some([begin, end_time]) => Analysis { begin, end_time, ..read },
                None => read,
            }
        }
        None => {
            if !report.is_spoiled(&ROOT, "analysis") {
                let example = "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 1e-3";
                report.push(Diagnostic::error("the deck has no table `[analysis]`").hint(example));
            }
            unread(AnalysisKind::Dynamic, None)
        }
    };
    let scheme = deck.integrator.as_ref().map_or_else(default_scheme, |integrator| self::scheme(integrator, report));
    if let Some(table) = &deck.analysis {
        check_error_control(&analysis.step_length, table, &*scheme, report);
    }
    Procedure { analysis, scheme, iteration: iteration(deck.iteration.as_ref(), report) }
}

fn times<'d>(analysis: &'d words::Analysis, owner: Owner<'d>, report: &mut Report<'d>) -> Analysis {
    let word = report.require(&owner, "kind", &analysis.kind).map(|kind| kind.value).unwrap_or_default();
    if let Some(read) = modes(analysis, owner.span, word, report) {
        refuse_without_steps(analysis, "an analysis without time steps: refine `elements` and compare", report);
        return read;
    }
    if let Some(read) = linear(analysis, &owner, word, report) {
        refuse_without_steps(analysis, "a linear analysis: `run --mesh-error` estimates the error of its mesh", report);
        return read;
    }
    let accuracy = accuracy(analysis, report);
    let is_static = word == words::AnalysisKind::Static;
    let is_moved = is_static && analysis.control.as_ref().is_some_and(|at| at.value == words::Control::Displacement);
    let end_time = match &analysis.end_time {
        None if is_moved => Some(1.0),
        end_time => report.require_positive(&owner, "end_time", end_time),
    };
    let (time_step, error_tolerance) = match is_moved {
        true => (end_time, None),
        false => time_step(&owner, analysis, (is_static, accuracy), report),
    };
    let least_step = report.positive("least_step", &analysis.least_step);
    if let (Some(end), Some(step), Some(at)) = (end_time, time_step, &analysis.time_step)
        && step > end
    {
        let message = format!("`time_step` is longer than the run, which ends at {end}");
        report.error_with::<()>(&at.span, message, format!("give {} or less", short(end)));
    }
    if let (Some(end), Some(step), Some(at)) = (end_time, time_step, &analysis.time_step)
        && end / step > MOST_STEPS
    {
        let message = format!("`time_step` asks for {:.1e} steps", end / step);
        report.error_with::<()>(&at.span, message, format!("at most {MOST_STEPS:.0e} are allowed"));
    }
    if let (Some(least), Some(step), Some(at)) = (least_step, time_step, &analysis.least_step)
        && least > step
    {
        report.error::<()>(&at.span, format!("`least_step` must not be above `time_step`, which is {step}"));
    }
    if let (Some(least), Some(end), Some(_), Some(at)) = (least_step, end_time, error_tolerance, &analysis.least_step)
        && least > FIRST_STEP * end
    {
        let longest = short(FIRST_STEP * end);
        report.error::<()>(
            &at.span,
            format!("`least_step` must not be above the first automatic step, which is {longest}"),
        );
    }
    let kind = if is_static { AnalysisKind::Static } else { AnalysisKind::Dynamic };
    let plane = analysis.plane.as_ref().is_none_or(|plane| plane.value == words::Plane::Auto);
    let run = Analysis { plane, accuracy, ..unread(kind, end_time) };
    let (step_length, least) = match (error_tolerance, time_step) {
        (Some(tolerance), _) => {
            (StepLength::ErrorControlled { tolerance, first: FIRST_STEP * run.end_time }, run.end_time / MOST_STEPS)
        }
        (None, Some(step)) => (StepLength::Fixed { step }, step * 0.5_f64.powi(HALVINGS)),
        (None, None) => return run,
    };
    Analysis { step_length, least_step: least_step.unwrap_or(least), ..run }
}

/// The analysis for checks of other tables if the deck lacks steps or an end; no model is built from it. No time lies beyond an end that is
/// not known.
fn unread(kind: AnalysisKind, end_time: Option<f64>) -> Analysis {
    let (end_time, step_length) = (end_time.unwrap_or(f64::MAX), StepLength::Fixed { step: 1.0 });
    let (stage, accuracy) = (None, None);
    Analysis {
        kind,
        is_linear: false,
        begin: 0.0,
        end_time,
        stage,
        step_length,
        accuracy,
        least_step: 1.0,
        plane: true,
    }
}

/// The length of the steps, or the error that it follows.
fn time_step<'d>(
    owner: &Owner,
    analysis: &'d words::Analysis,
    (is_static, accuracy): (bool, Option<f64>),
    report: &mut Report<'d>,
) -> (Option<f64>, Option<f64>) {
    if analysis.time_step.is_none() && accuracy.is_some() && !is_static {
        return (None, Some(tolerance(analysis, accuracy, report)));
    }
    let Some(at) = report.require(owner, "time_step", &analysis.time_step) else { return (None, None) };
    match at.value {
        NumberOrAuto::Number(step) => {
            match is_static {
                true => report.reject_unused("a `time_step` that is a number", &keys!(analysis; error_tolerance)),
                false => refuse_step(analysis, &at.span, report),
            }
            (report.positive("time_step", &Some(At { value: step, span: at.span.clone() })), None)
        }
        NumberOrAuto::Word(_) if is_static => {
            let hint = "load steps have no error in time: give a number";
            report.error_with::<()>(&at.span, "`time_step` is \"auto\" in a static analysis", hint);
            (None, None)
        }
        NumberOrAuto::Word(_) => (None, Some(tolerance(analysis, accuracy, report))),
    }
}

/// The scheme of a table like `[integrator]`.
pub fn scheme<'d>(integrator: &'d At<OneOf<words::Integrator>>, report: &mut Report<'d>) -> Arc<dyn Scheme> {
    let kind = integrator.kind.as_ref().map_or(SCHEMES[0], |kind| kind.value);
    let owner = Owner::new(format!("the scheme \"{}\"", kind.word), &integrator.span);
    if !kind.make.rotation_update {
        report.reject_unused(&owner.what, &keys!(integrator; rotation_update));
    }
    if !scales_masses(kind) {
        report.reject_unused(&owner.what, &keys!(integrator; mass_scaling));
    }
    let rotation = chosen(&integrator.rotation_update);
    report.read(&owner, &owner.what, &integrator.values, kind, |given| (kind.make.scheme)(given, rotation))
}

/// Refuses yielding material with schemes that do not support it; `place` is the scheme's name in the deck.
pub fn check_yielding(scheme: &dyn Scheme, place: &Span, yields: bool, report: &mut Report) {
    if yields && matches!(scheme.stepping(), Stepping::RungeKutta(_)) {
        let hint = "material that yields remembers the way it came: \"central-difference\" follows it, and implicit schemes do";
        let message = format!("\"{}\" does not go with material that yields", scheme.word());
        report.error_with::<()>(place, message, hint);
    }
}

/// Reports input unsuitable for an explicit scheme, once all parts are known.
pub fn check_explicit(deck: &Deck, analysis: &Analysis, scheme: &dyn Scheme, parts: &[Part], report: &mut Report) {
    let Some(at) = deck.integrator.as_ref().and_then(|integrator| integrator.kind.as_ref()) else { return };
    if !analysis.is_dynamic() || !scheme.is_explicit() {
        return;
    }
    if let Some(part) = parts.iter().find(|part| part.kind().is_floating()) {
        let message =
            format!("explicit schemes do not take the superelement `{}`: its masses are coupled", part.name());
        report.error_with::<()>(&at.span, message, "give an implicit scheme, such as `scheme` = \"generalized-alpha\"");
    }
    if let Some(modal) = deck.damping.as_ref().and_then(|damping| damping.modal.as_ref()) {
        let hint = "give `alpha`, or an implicit scheme, such as `scheme` = \"generalized-alpha\"";
        report.error_with::<()>(&modal.span, "`modal` damping does not go with explicit schemes", hint);
    }
    check_yielding(scheme, &at.span, parts.iter().any(|part| part.yields()), report);
    if parts.iter().any(|part| part.mass_kind() == Some(MassKind::Consistent)) {
        let hint = "give `mass` = \"lumped\", which needs no matrix at all";
        report.warn(&at.span, "consistent masses are factorised at every evaluation of an explicit scheme", hint);
    }
    for shear in deck.beams.iter().filter_map(|beam| beam.shear.as_ref()).filter(|shear| !shear.value) {
        let hint = "leave it out with explicit schemes: slender beams deform little in shear";
        report.warn(&shear.span, "`shear = false` makes the critical time step up to 100 times shorter", hint);
    }
    let errors = deck.analysis.iter().flat_map(|analysis| keys!(analysis; error_tolerance, accuracy));
    for (key, place) in errors.filter(|_| matches!(scheme.stepping(), Stepping::Verlet)) {
        if let Some(place) = place {
            let message = format!("`{key}` does not apply to the scheme \"{}\"", scheme.word());
            report.error_with::<()>(place, message, "its steps are as long as is stable");
        }
    }
}

fn iteration(table: Option<&At<Table<words::Iteration>>>, report: &mut Report) -> Iteration {
    let mut iteration = Iteration {
        method: Method::Auto,
        update: Update::Auto,
        gyroscopic: Gyroscopic::Auto,
        tolerance: 1e-8,
        follows_step: true,
        limit: Iteration::LIMIT,
    };
    let Some(table) = table else { return iteration };
    if let Some(at) = &table.tolerance {
        if !(at.value > 0.0 && at.value < 1.0) {
            report.error_with::<()>(&at.span, "`tolerance` must lie between 0 and 1", "it is relative");
        }
        (iteration.tolerance, iteration.follows_step) = (at.value, false);
    }
    iteration.method = chosen(&table.method);
    iteration.gyroscopic = chosen(&table.gyroscopic);
    iteration.update = chosen(&table.update);
    // An elastic matrix converges slowly while material yields, at little cost per iteration.
    let default = if iteration.method == Method::InitialLoad { 10 } else { 1 } * iteration.limit;
    iteration.limit = report.count("limit", &table.limit, default);
    iteration
}
