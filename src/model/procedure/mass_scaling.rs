//! Conflicts of mass scaling with other input.

use crate::data::{ElementMasses, FEWEST_STEPS, MassKind, SAFE, SAFE_WHERE_STRUCK, StepLength};
use crate::procedure::scaled_masses::KEY;
use crate::report::Report;
use crate::scene::Scene;
use crate::values::span;
use base::diagnostic::Span;
use base::names::short;
use deck::Deck;
use deck::analysis::RotaryInertia;

/// Reports conflicts of mass scaling, once all parts are known.
pub fn check_mass_scaling(scene: &Scene, masses: ElementMasses, report: &mut Report) {
    let (deck, parts) = (scene.deck, &scene.parts.list);
    let ElementMasses::ForStep(step) = masses else { return };
    check_word(deck, report);
    check_ground_and_damping(deck, step, report);
    // Other stages than those with central differences have the masses, but not the key.
    let Some(place) = deck.integrator.as_ref().and_then(|integrator| integrator.values.place(KEY)) else { return };
    let kinds = || parts.iter().filter_map(|part| Some((part, part.mass_kind()?)));
    if let Some((part, _)) = kinds().find(|(_, kind)| *kind == MassKind::Consistent) {
        let message = format!("`{KEY}` does not go with the consistent masses of `{}`", part.name());
        report.error_with::<()>(
            place,
            message,
            "the critical step of an element is known for lumped masses only: give `mass` = \"lumped\"",
        );
    } else if kinds().all(|(_, kind)| kind == MassKind::None) {
        let message = format!("`{KEY}` raises masses of beams, bars and shells, but none of them has any");
        report.error_with::<()>(place, message, "bodies, point masses, links and contacts keep their masses");
    }
    check_length(scene, (step, place), report);
}

/// Reports accelerations of the ground and damping that do not go with added mass.
fn check_ground_and_damping(deck: &Deck, step: f64, report: &mut Report) {
    for base in deck.environment.iter().flat_map(|environment| &environment.base_acceleration) {
        let message = "accelerations of the ground do not go with mass scaling";
        let hint =
            "they act on all that resists acceleration, gravity on the true mass alone: move the supports instead";
        report.error_with::<()>(&base.span, message, hint);
    }
    let of_all = deck.damping.iter().filter_map(|damping| Some(("mass_factor", damping.mass_factor.as_ref()?)));
    let of_parts = deck.parts().filter_map(|part| Some(("alpha", part.table.damping()?.alpha.as_ref()?)));
    for (key, alpha) in of_all.chain(of_parts).filter(|(_, alpha)| alpha.value * step >= 1.0) {
        let message = format!("no mass makes a step of {} stable with this `{key}`", short(step));
        report.error_with::<()>(&alpha.span, message, format!("below {} one does", short(1.0 / step)));
    }
}

/// Reports a step of mass scaling where masses are to be kept.
fn check_word(deck: &Deck, report: &mut Report) {
    let word = deck.integrator.as_ref().and_then(|integrator| integrator.mass_scaling.as_ref());
    if let Some(word) = word.filter(|word| word.value == RotaryInertia::Off) {
        let message = format!("`mass_scaling = \"off\"` contradicts `{KEY}`, which raises rotary inertia and mass");
        report.error_with::<()>(&word.span, message, "remove one of them");
    }
}

/// Reports a step longer than the motion or than the time steps.
fn check_length(scene: &Scene, (step, place): (f64, &Span), report: &mut Report) {
    let (deck, analysis) = (scene.deck, &scene.analysis);
    // A stage may be shorter than the step that suits all.
    if step > analysis.end_time {
        let message = format!("`{KEY}` is longer than the motion, {}", short(analysis.end_time));
        report.error_with::<()>(
            place,
            message,
            "give a tenth of the shortest period of interest; the added mass grows with its square",
        );
        return;
    }
    match (&analysis.step_length, span_of_step(deck)) {
        (StepLength::Fixed { step: length }, Some(at)) if *length > step => {
            let message = format!("`time_step` is above `{KEY}`, the step that elements bear");
            let hint = "take 0.8 of it, as \"auto\" does; longer steps are cut back";
            report.warn(at, message, hint);
        }
        (StepLength::Fixed { step: length }, _) if *length < 0.5 * step => {
            let message = format!("`{KEY}` adds mass for steps that are not taken: `time_step` is {}", short(*length));
            report.warn(place, message, format!("give {}", short(*length / SAFE)));
        }
        (StepLength::Fixed { .. }, _) => {}
        _ => {
            let (longest, enough) = (analysis.duration() / FEWEST_STEPS, 1.0 / SAFE_WHERE_STRUCK);
            if scene.stage.is_none() && step > enough * longest {
                let message = format!(
                    "`{KEY}` adds mass for steps that are not taken: automatic ones are {} at most",
                    short(longest)
                );
                report.warn(place, message, format!("give {}", short(enough * longest)));
            }
        }
    }
}

/// The place of the length of steps.
fn span_of_step(deck: &Deck) -> Option<&base::diagnostic::Span> {
    span(&deck.analysis.as_ref()?.time_step)
}
