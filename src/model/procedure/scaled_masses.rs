//! The masses that a scheme gives to elements, as the deck has it.

use base::diagnostic::At;
use base::words::kinds::OneOf;
use deck::Deck;
use deck::analysis::{Integrator, RotaryInertia};
use mechanics::integrators::SchemeKind;

/// The key of mass scaling in the table of the scheme.
pub const KEY: &str = "mass_scaling_step";

/// The masses that a scheme gives to elements: the critical time step of mass scaling, and whether rotary inertia is raised. Where dynamic
/// stages have different schemes, rotary inertia is raised only if the deck asks for it, because a motion goes on with the masses it has.
pub fn masses(integrator: Option<&At<OneOf<Integrator>>>, all_central: bool) -> (Option<f64>, RotaryInertia) {
    let Some(table) = integrator.filter(|table| is_central(table)) else { return (None, RotaryInertia::Off) };
    let step = table.values.numbers(KEY).first().copied();
    match &table.mass_scaling {
        Some(word) => (step, word.value),
        None if all_central => (step, RotaryInertia::default()),
        None => (step, RotaryInertia::Off),
    }
}

/// True for central differences.
pub fn is_central(integrator: &At<OneOf<Integrator>>) -> bool {
    integrator.kind.as_ref().is_some_and(|kind| scales_masses(kind.value))
}

/// True for schemes with mass scaling.
pub fn scales_masses(kind: &SchemeKind) -> bool {
    kind.keys.iter().any(|key| key.name == KEY)
}

/// The rotary inertia of shells and beams in a deck, or in one of its stages.
pub fn rotary_inertia(deck: &Deck, all_central: bool) -> RotaryInertia {
    masses(deck.integrator.as_ref(), all_central).1
}
