//! The masses that a scheme gives to elements, as the deck has it.

use crate::data::ElementMasses;
use base::diagnostic::At;
use base::words::kinds::OneOf;
use deck::analysis::{Integrator, RotaryInertia};
use mechanics::integrators::SchemeKind;

/// The key of mass scaling in the table of the scheme.
pub const KEY: &str = "mass_scaling_step";

/// The masses of elements by central differences; `None` for other schemes.
pub fn masses(integrator: Option<&At<OneOf<Integrator>>>) -> Option<ElementMasses> {
    let table = integrator.filter(|table| is_central(table))?;
    let word = table.mass_scaling.as_ref().map_or_else(RotaryInertia::default, |word| word.value);
    // The check of the scheme reports a step of 0 or less.
    let step = table.values.numbers(KEY).first().copied().filter(|&step| step > 0.0);
    Some(match (step, word) {
        (Some(step), _) => ElementMasses::ForStep(step),
        (None, RotaryInertia::Rotary) => ElementMasses::Rotary,
        (None, RotaryInertia::Off) => ElementMasses::OfSections,
    })
}

/// True for central differences.
pub fn is_central(integrator: &At<OneOf<Integrator>>) -> bool {
    integrator.kind.as_ref().is_some_and(|kind| scales_masses(kind.value))
}

/// True for schemes with mass scaling.
pub fn scales_masses(kind: &SchemeKind) -> bool {
    kind.keys.iter().any(|key| key.name == KEY)
}
