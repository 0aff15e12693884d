//! Which materials, sections and amplitudes of a deck something names.

use deck::Deck;
use std::collections::HashSet;

/// Materials that a part or a section of the deck names.
pub fn named_materials(deck: &Deck) -> HashSet<&str> {
    let of_parts = deck.parts().filter_map(|part| part.table.material());
    let sections = || deck.sections.0.iter().map(|(_, section)| section);
    let of_cores = sections().filter_map(|section| section.core.as_ref());
    let bars = sections().filter_map(|section| section.bars.as_ref()).flat_map(|bars| &bars.value);
    let of_bars = bars.filter_map(|bars| bars.material.as_ref());
    let polygons = sections().filter_map(|section| section.polygons.as_ref()).flat_map(|polygons| &polygons.value);
    let of_polygons = polygons.filter_map(|polygon| polygon.material.as_ref());
    of_parts.chain(of_cores).chain(of_bars).chain(of_polygons).map(|name| name.as_str()).collect()
}

/// Sections that a beam of the deck names.
pub fn named_sections(deck: &Deck) -> HashSet<&str> {
    let stations = deck.beams.iter().filter_map(|beam| beam.stations.as_ref()).flat_map(|stations| &stations.value);
    let of_stations = stations.filter_map(|station| station.section.as_ref());
    let of_beams = deck.beams.iter().filter_map(|beam| beam.section.as_ref());
    of_beams.chain(of_stations).map(|name| name.as_str()).collect()
}

/// Amplitudes that a load, a motion or a profile of the deck names.
pub fn named_amplitudes(deck: &Deck) -> HashSet<&str> {
    let profiles = deck.initial.iter().filter_map(|initial| initial.profile.as_ref()).flat_map(|at| &at.value);
    let profiles = profiles.filter_map(|profile| profile.amplitude.as_ref()).map(|name| name.as_str());
    amplitudes_over_time(deck).into_iter().chain(profiles).collect()
}

/// Amplitudes that are functions of time: those of loads, motions, gravity and the ground.
pub fn amplitudes_over_time(deck: &Deck) -> HashSet<&str> {
    let loads = deck.loads.iter().map(|load| &load.amplitude);
    let motions = deck.supports.iter().filter_map(|support| support.motion.as_ref());
    let motions = motions.flat_map(|motions| motions.each()).flatten().map(|motion| &motion.amplitude);
    let drives = deck.joints.iter().filter_map(|joint| joint.motion.as_ref()).map(|motion| &motion.amplitude);
    let motors = deck.joints.iter().filter_map(|joint| joint.effort.as_ref()).map(|effort| &effort.amplitude);
    let ground = deck.environment.iter().flat_map(|environment| &environment.base_acceleration);
    let gravity = deck.environment.iter().map(|environment| &environment.gravity_amplitude);
    let named =
        loads.chain(motions).chain(drives).chain(motors).chain(gravity).chain(ground.map(|base| &base.amplitude));
    named.flatten().map(|name| name.as_str()).collect()
}
