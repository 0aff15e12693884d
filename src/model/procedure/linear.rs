//! `geometry = "linear"`: what a linear analysis takes, and what it refuses.

use crate::data::{Analysis, AnalysisKind, Model, StepLength, YieldLimit};
use crate::report::{Owner, Report};
use crate::values::{keys, span};
use base::diagnostic::{Diagnostic, Span};
use deck::Deck;
use deck::analysis::{self as words, AnalysisKind as Word, Geometry};
use deck::links::LinkLaw;
use deck::supports::Rotation;
use deck::words::{Maybe, NumberOrAuto};

/// The time at the end of a linear analysis whose deck gives none.
const END: f64 = 1.0;

/// Reads the keys of a linear analysis; `None` where the deck does not ask for one.
pub fn linear<'d>(
    analysis: &'d words::Analysis,
    owner: &Owner<'d>,
    word: Word,
    report: &mut Report<'d>,
) -> Option<Analysis> {
    let geometry = analysis.geometry.as_ref().filter(|geometry| geometry.value == Geometry::Linear)?;
    if word != Word::Static {
        let hint =
            "modes about the undeformed structure come from a deck without loads; in dynamics small loads do the same";
        report.error_with::<()>(&geometry.span, "`geometry = \"linear\"` needs `kind = \"static\"`", hint);
        return None;
    }
    let unused = keys!(analysis; control, error_tolerance, least_step, stop, steps, growth);
    report.reject_unused("a linear analysis", &unused);
    let end_time = report.positive("end_time", &analysis.end_time).unwrap_or(END);
    let mut step = end_time;
    match analysis.time_step.as_ref().map(|at| (&at.value, &at.span)) {
        None => {}
        Some((NumberOrAuto::Word(_), place)) => {
            report.error_with::<()>(
                place,
                "`time_step` is \"auto\" in a linear analysis",
                "give a number, or leave it out",
            );
        }
        Some((NumberOrAuto::Number(given), place)) if !(*given > 0.0 && *given <= end_time) => {
            let message =
                format!("`time_step` of {} must be above zero and at most `end_time`, {end_time}", owner.what);
            report.error::<()>(place, message);
        }
        Some((NumberOrAuto::Number(given), _)) => step = *given,
    }
    let plane = analysis.plane.as_ref().is_none_or(|plane| plane.value == words::Plane::Auto);
    Some(Analysis {
        kind: AnalysisKind::Static,
        is_linear: true,
        begin: 0.0,
        end_time,
        stage: None,
        accuracy: None,
        step_length: StepLength::Fixed { step },
        least_step: step,
        plane,
    })
}

/// Refuses whatever has no stiffness of its own at t = 0, or another one beyond some force.
pub fn check_linear(deck: &Deck, report: &mut Report) {
    let mut refuse = |place: &Span, what: String, hint: &str| {
        report.error_with::<()>(place, format!("{what} in a linear analysis"), hint);
    };
    let finite = "leave out `geometry = \"linear\"`";
    for contact in &deck.contacts {
        let hint = "contact opens and closes: leave out `geometry = \"linear\"`, or join the parts by `[[attachments]]` or `[[joints]]`";
        refuse(&contact.span, "a contact has no stiffness".to_owned(), hint);
    }
    for link in &deck.links {
        if let Some(law) = link.law.as_ref().filter(|law| law.value != LinkLaw::Linear) {
            let hint =
                "its stiffness depends on its force: use `law = \"linear\"`, or leave out `geometry = \"linear\"`";
            refuse(&law.span, format!("link `{}` is not linear", name_of(&link.name)), hint);
        }
        for (key, place) in present(&keys!(link; preload, pretension, free_length, failure, matrices)) {
            refuse(place, format!("`{key}` of link `{}` does not apply", name_of(&link.name)), finite);
        }
    }
    for joint in &deck.joints {
        let keys = keys!(
            joint; limits, friction, friction_moment, friction_force, yield_moment, yield_force, backbone, rest
        );
        for (key, place) in present(&keys) {
            refuse(place, format!("`{key}` of joint `{}` does not apply", name_of(&joint.name)), finite);
        }
    }
    for bar in &deck.bars {
        let slack = bar.tension_only.as_ref().filter(|slack| slack.value).map(|slack| &slack.span);
        for (key, place) in present(&[("tension_only", slack), ("free_length", span(&bar.free_length))]) {
            refuse(place, format!("`{key}` of bar `{}` does not apply", name_of(&bar.name)), finite);
        }
    }
    for support in &deck.supports {
        let turns = support.rotation.as_ref().filter(|word| word.value != Rotation::Vector);
        if let Some(word) = turns.filter(|_| support.motion.is_some()) {
            refuse(&word.span, "a sequence of rotations does not apply".to_owned(), "small rotations have no sequence");
        }
    }
    for (name, material) in &deck.materials.0 {
        if !material.values.numbers("yield_stress").is_empty() || !material.values.numbers("hardening").is_empty() {
            let message = format!("`{}` stays elastic in a linear analysis", name.value);
            let hint = "stresses beyond its yield stress are reported where they are known; leave out `geometry = \"linear\"` to let it yield";
            report.push(Diagnostic::note(message).at(&name.span).hint(hint));
        }
    }
}

/// Lets all materials stay elastic.
pub fn make_elastic(model: &mut Model) {
    for (index, part) in model.parts.iter_mut().enumerate() {
        let limit = part.make_elastic().map(|limit| YieldLimit { part: index, ..limit });
        model.cases.yield_limits.extend(limit);
    }
}

fn present<'s>(keys: &[(&'static str, Option<&'s Span>)]) -> Vec<(&'static str, &'s Span)> {
    keys.iter().filter_map(|(key, place)| Some((*key, (*place)?))).collect()
}

/// The name in messages.
pub fn name_of(name: &Maybe<String>) -> &str {
    name.as_ref().map_or("", |name| name.as_str())
}
