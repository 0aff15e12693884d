//! Modes: `kind = "modal"`, `"buckling"` and `"frequency-response"` of `[analysis]`.
//!
//! An analysis of modes begins with a static analysis under the loads at t = 0, with load steps chosen by the program; the modes are those
//! about its equilibrium. For the deck of a dynamic analysis these are the modes about its state of rest.

use crate::data::{Analysis, AnalysisKind, History, Model, ModesAsked, StepLength};
use crate::procedure::extent::{count, extent};
use crate::procedure::linear::name_of;
use crate::procedure::response::{is_harmonic, keys_of_response, response};
use crate::report::{Owner, Report};
use crate::values::{flag, keys, span};
use base::diagnostic::{Diagnostic, Span};
use deck::Deck;
use deck::analysis::{self as words, AnalysisKind as Word};
use deck::words::{NumberOrTable, Spacing};
use mechanics::amplitude::Amplitude;

/// End time of the static analysis, equal to the load factor.
const END: f64 = 1.0;
/// Speeds of rotation unless the deck says how many.
const SPEEDS: usize = 21;
/// Most speeds of rotation.
const MOST_SPEEDS: usize = 10_000;
/// Load steps; they are halved where they fail.
const STEP: f64 = 0.1;
/// Shortest load step.
const LEAST_STEP: f64 = STEP / 1024.0;

/// Reads the keys of modes; `None` where the deck does not ask for any.
pub fn modes<'d>(
    analysis: &'d words::Analysis,
    place: &'d Span,
    word: Word,
    report: &mut Report<'d>,
) -> Option<Analysis> {
    let of_modal = keys!(analysis; up_to, damped, speeds);
    let what = match word {
        Word::Static => "a static analysis",
        Word::Dynamic => "a dynamic analysis",
        Word::Modal => "a modal analysis",
        Word::Buckling => "a buckling analysis",
        Word::FrequencyResponse => "a frequency response",
    };
    if matches!(word, Word::Static | Word::Dynamic) {
        report.reject_unused(what, &keys!(analysis; modes));
        report.reject_unused(what, &of_modal);
        report.reject_unused(what, &keys_of_response(analysis));
        return None;
    }
    let of_paths = keys!(analysis; control, stop, increment, steps, growth);
    report.reject_unused(what, &of_paths);
    if word == Word::Buckling {
        report.reject_unused(what, &of_modal);
    }
    if word != Word::FrequencyResponse {
        report.reject_unused(what, &keys_of_response(analysis));
    }
    note_times(analysis, what, report);
    let plane = analysis.plane.as_ref().is_some_and(|plane| plane.value == words::Plane::Auto);
    let kind = match word {
        Word::FrequencyResponse => AnalysisKind::Response(response(analysis, place, report)),
        Word::Buckling => AnalysisKind::Buckling(count(analysis, report)),
        _ => {
            let damped = flag(&analysis.damped, false);
            let speeds = speeds(analysis, damped, report);
            AnalysisKind::Modal(ModesAsked { extent: extent(analysis, report), damped, speeds })
        }
    };
    let step_length = StepLength::Fixed { step: STEP };
    Some(Analysis {
        kind,
        is_linear: false,
        begin: 0.0,
        end_time: END,
        stage: None,
        accuracy: None,
        step_length,
        least_step: LEAST_STEP,
        plane,
    })
}

/// Reads `speeds`; empty where the deck has none.
fn speeds<'d>(analysis: &'d words::Analysis, damped: bool, report: &mut Report<'d>) -> Vec<f64> {
    let Some(range) = &analysis.speeds else { return Vec::new() };
    if !damped {
        let hint =
            "`damped = true` takes account of gyroscopic moments, without which modes do not depend on the speed";
        report.error_with::<()>(&range.span, "`speeds` needs complex modes", hint);
    }
    let from = report.not_negative("from", &range.from, 0.0);
    let to = report.require_positive(&Owner::new("`speeds`", &range.span), "to", &range.to);
    let steps = report.count("steps", &range.steps, SPEEDS);
    if let Some(at) = range.steps.as_ref().filter(|_| !(2..=MOST_SPEEDS).contains(&steps)) {
        report.error::<()>(&at.span, format!("`steps` must be 2 to {MOST_SPEEDS}"));
    }
    match (to, &range.to) {
        (Some(to), Some(at)) if to <= from => {
            report.error::<()>(&at.span, format!("`to` must be above `from`, which is {from}"));
            Vec::new()
        }
        (Some(to), _) => Spacing::Linear.between(from, to, steps.clamp(2, MOST_SPEEDS)),
        (None, _) => Vec::new(),
    }
}

/// Warns that keys of times have no effect.
fn note_times(analysis: &words::Analysis, what: &str, report: &mut Report) {
    for (key, place) in keys!(analysis; end_time, time_step, error_tolerance, least_step) {
        if let Some(place) = place {
            let message = format!("`{key}` has no effect in {what}");
            let hint = "loads are those at t = 0, brought on in load steps of the program's own";
            report.push(Diagnostic::note(message).at(place).hint(hint));
        }
    }
}

/// Refuses dampers with an exponent where damping is linearized at rest: the slope there belongs to no motion.
pub fn refuse_power_dampers(deck: &Deck, report: &mut Report) {
    for link in &deck.links {
        let Some(NumberOrTable::Table(damping)) = link.damping.as_ref().map(|damping| &damping.value) else { continue };
        let Some(exponent) = damping.exponent.as_ref().filter(|exponent| exponent.value != 1.0) else { continue };
        let name = name_of(&link.name);
        let message = format!("link `{name}` has a damper with an exponent, which linear vibrations do not have");
        let hint = "give the `viscous` of a linear damper with the same dissipation at the expected amplitude, and no `exponent`";
        report.error_with::<()>(&exponent.span, message, hint);
    }
}

/// Warns of input without effect on modes.
pub fn check_modal(deck: &Deck, report: &mut Report) {
    let Some(integrator) = &deck.integrator else { return };
    for place in span(&integrator.kind).into_iter().chain(integrator.values.places()) {
        let message = "this has no effect on modes";
        report.push(Diagnostic::note(message).at(place).hint("nothing is integrated in time"));
    }
}

/// Replaces loads and motions by their values at t = 0, without amplitudes, so that they grow over the static analysis.
pub fn hold_at_start(model: &mut Model) {
    let loading = &mut model.loading;
    // Harmonic loads of a response keep their amplitude, which is zero over time.
    let excites = model.analysis.response().is_some();
    let amplitudes = &loading.amplitudes;
    let at_start = |amplitude: &mut Option<usize>| match *amplitude {
        Some(_) if excites && is_harmonic(amplitudes, *amplitude) => 1.0,
        _ => amplitude.take().map_or(1.0, |i| amplitudes[i].value(0.0)),
    };
    for load in &mut loading.nodal {
        let factor = at_start(&mut load.amplitude);
        load.scale(factor);
    }
    for load in &mut loading.pressures {
        load.pressure *= at_start(&mut load.amplitude);
    }
    for load in &mut loading.centrifugal {
        load.speed *= at_start(&mut load.amplitude);
    }
    loading.gravity *= at_start(&mut loading.gravity_amplitude);
    loading.base_accelerations.retain(|base| {
        let keeps = excites && is_harmonic(&loading.amplitudes, Some(base.amplitude));
        if !keeps {
            loading.gravity -= loading.amplitudes[base.amplitude].value(0.0) * base.direction;
        }
        keeps
    });
    for restraint in &mut model.constraints.restraints {
        let Some(motion) = &mut restraint.motion else { continue };
        if excites && is_harmonic(&loading.amplitudes, Some(motion.amplitude)) {
            continue;
        }
        let displaced = match motion.history {
            History::Displacement => motion.scale * loading.amplitudes[motion.amplitude].value(0.0),
            // Velocities and accelerations begin undisplaced.
            _ => 0.0,
        };
        if displaced == 0.0 {
            restraint.motion = None;
            continue;
        }
        motion.scale = displaced;
        motion.amplitude = loading.amplitudes.len();
        loading.amplitudes.push(Amplitude::Ramp { start: 0.0, end: END });
    }
}
