//! What mass scaling of elements does not go with.

use crate::deck::Deck;
use crate::integrators::Scheme;
use crate::model::data::{Analysis, MassKind, Part, StepLength};
use crate::model::report::Report;
use crate::model::values::span;
use crate::names::short;

/// The key that asks for it, in the table of the scheme.
pub const KEY: &str = "mass_scaling_step";
/// Automatic steps are this part of the critical one.
const SAFETY: f64 = 0.8;
/// Automatic steps are no longer than the duration over this.
const FEWEST: f64 = 50.0;
/// The critical step of the longest automatic ones, over the duration.
const USED: f64 = 1.0 / (SAFETY * FEWEST);

/// Reports what a deck that asks for mass scaling cannot have, once all parts are known.
pub fn check_mass_scaling(deck: &Deck, analysis: &Analysis, scheme: &dyn Scheme, parts: &[Part], report: &mut Report) {
    let place = deck.integrator.as_ref().and_then(|integrator| integrator.values.place(KEY));
    let (Some(step), Some(place)) = (scheme.mass_scaling_step(), place) else { return };
    let kinds = || parts.iter().filter_map(|part| Some((part, part.mass_kind()?)));
    if let Some((part, _)) = kinds().find(|(_, kind)| *kind == MassKind::Consistent) {
        let message = format!("`{KEY}` does not go with the consistent masses of `{}`", part.name());
        report.error_with::<()>(
            place,
            message,
            "the step that an element bears is known for its lumped mass: mass = \"lumped\"",
        );
    } else if kinds().all(|(_, kind)| kind == MassKind::None) {
        let message = format!("`{KEY}` raises masses of beams, bars and shells, of which none has any");
        report.error_with::<()>(place, message, "bodies, point masses, links and contacts keep what they have");
    }
    for base in deck.environment.iter().flat_map(|environment| &environment.base_acceleration) {
        let message = "accelerations of the ground do not go with mass scaling";
        let hint =
            "they act on all that resists acceleration, gravity on the true mass alone: move the supports instead";
        report.error_with::<()>(&base.span, message, hint);
    }
    let alpha = deck.damping.as_ref().and_then(|damping| damping.mass_factor.as_ref());
    if let Some(alpha) = alpha.filter(|alpha| alpha.value * step >= 1.0) {
        let message = format!("no mass makes a step of {} stable with this `mass_factor`", short(step));
        report.error_with::<()>(&alpha.span, message, format!("below {} one does", short(1.0 / step)));
    }
    let duration = analysis.duration();
    if step > duration {
        let message = format!("`{KEY}` is longer than the motion, which takes {}", short(duration));
        report.error_with::<()>(place, message, "the mass that elements would need for it grows with its square");
    } else if let StepLength::StabilityLimited { .. } = &analysis.step_length
        && step > USED * duration
    {
        let message = format!(
            "`{KEY}` adds mass for steps that are not taken: automatic ones are {} at most here",
            short(duration / FEWEST)
        );
        report.warn(place, message, format!("{} is enough", short(USED * duration)));
    }
    if let (StepLength::Fixed { step: length }, Some(at)) = (&analysis.step_length, span_of_step(deck)) {
        if *length > step {
            let message = format!("`time_step` is above `{KEY}`, the step that elements bear");
            let hint = "steps are cut back wherever they are too long: take 0.8 of it, as \"auto\" does";
            report.warn(at, message, hint);
        } else if *length < 0.5 * step {
            let message = format!("`{KEY}` adds mass for steps that are not taken: `time_step` is {}", short(*length));
            report.warn(place, message, format!("{} is enough", short(*length / SAFETY)));
        }
    }
}

/// The place of the length of steps.
fn span_of_step(deck: &Deck) -> Option<&crate::diagnostic::Span> {
    span(&deck.analysis.as_ref()?.time_step)
}
