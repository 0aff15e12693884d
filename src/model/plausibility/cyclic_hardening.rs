//! Hardening that is isotropic by default, in motions to and fro.

use crate::plausibility::usage::named_materials;
use crate::report::Report;
use deck::Deck;
use mechanics::amplitude::Amplitude;

/// Notes materials with hardening and without `kinematic_share` in a deck whose ground shakes or whose loads and motions reverse.
pub fn check_cyclic_hardening(deck: &Deck, amplitudes: &[Amplitude], report: &mut Report) {
    if !reverses(deck, amplitudes) {
        return;
    }
    let used = named_materials(deck);
    for (name, material) in deck.materials.0.iter().filter(|(name, _)| used.contains(name.as_str())) {
        let numbers = |key: &str| material.values.numbers(key);
        let pairs = numbers("hardening");
        let hardens = numbers("hardening_modulus").iter().any(|slope| *slope > 0.0)
            || pairs.chunks_exact(2).any(|pair| pair[1] > pairs[1]);
        if hardens && numbers("kinematic_share").is_empty() {
            let message = format!(
                "the hardening of `{}` is isotropic, and its load reverses: yielding one way raises the yield stress both ways",
                name.value
            );
            report.note(
                &name.span,
                message,
                "for steel in cycles give `kinematic_share = 1.0`; 0.0 says that isotropic is meant",
            );
        }
    }
}

/// True where the ground shakes, or where an amplitude of a load or of a motion has both signs.
fn reverses(deck: &Deck, amplitudes: &[Amplitude]) -> bool {
    let ground = deck.environment.iter().any(|environment| !environment.base_acceleration.is_empty());
    let loads = deck.loads.iter().map(|load| &load.amplitude);
    let motions = deck.supports.iter().filter_map(|support| support.motion.as_ref());
    let motions = motions.flat_map(|motions| motions.each()).flatten().map(|motion| &motion.amplitude);
    let is_both = |amplitude: &Amplitude| match amplitude.points() {
        Some(points) => [-1.0, 1.0].iter().all(|sign| points.iter().any(|[_, value]| sign * value > 0.0)),
        None => matches!(amplitude, Amplitude::Sine { .. }),
    };
    let mut named = loads.chain(motions).flatten().filter_map(|name| deck.amplitudes.position(name));
    ground || named.any(|index| amplitudes.get(index).is_some_and(is_both))
}
