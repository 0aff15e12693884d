//! `[[loads]]`: forces and moments at nodes.

pub mod centrifugal;
pub mod nodal_temperature;
pub mod per_length;
pub mod placed;
pub mod spread;
pub mod temperature;
pub mod unbalance;

use crate::data::{Actors, Centrifugal, Load, Mass, Pressure};
use crate::loads::centrifugal::centrifugal_load;
use crate::loads::placed::placed_load;
use crate::loads::spread::{ElementsByNodes, spread_load};
use crate::places::nodes::Topology;
use crate::procedure::stops::NamedActors;
use crate::report::{Owner, Report};
use crate::scene::{Reach, Scene};
use crate::values::{directions, flag, keys, span, vec3_or_zero};
use base::diagnostic::At;
use deck::loads as words;
use deck::words::Table;
use mechanics::amplitude::Amplitude;

/// Loads of the scene, in the order of the deck.
#[derive(Default)]
pub struct Loads {
    /// Forces and moments on nodes.
    pub nodal: Vec<Load>,
    /// Follower pressures.
    pub pressures: Vec<Pressure>,
    /// Centrifugal loads.
    pub centrifugal: Vec<Centrifugal>,
}

/// Reads `[[loads]]`; loads on edges and surfaces are shared out to their nodes. Named loads are added to `actors`. The `efforts` of joints
/// come after them.
pub fn loads<'d>(
    scene: &Scene<'d>,
    (efforts, masses): (Vec<Load>, &[Mass]),
    amplitudes: &[Amplitude],
    topology: &Topology,
    actors: &mut NamedActors<'d>,
    report: &mut Report<'d>,
) -> Loads {
    let (mut loads, elements) = (Loads::default(), ElementsByNodes::default());
    for load in scene.deck.loads.iter().filter(|load| !is_temperature(load) && load.unbalance.is_none()) {
        let first = [loads.nodal.len(), loads.pressures.len(), loads.centrifugal.len()];
        let amplitude = amplitude(scene, load, report);
        if let Some(rotation) = &load.centrifugal {
            let amplitude = (amplitude, amplitudes);
            loads.centrifugal.extend(centrifugal_load(scene, (load, rotation), amplitude, (masses, topology), report));
        } else if load.distance.is_some() {
            loads.nodal.extend(placed_load(scene, load, amplitude, topology, report));
        } else if is_spread(load) {
            let (nodal, pressure) = spread_load(scene, load, amplitude, (topology, &elements), report);
            loads.nodal.extend(nodal);
            loads.pressures.extend(pressure);
        } else {
            loads.nodal.extend(nodal_load(scene, load, amplitude, topology, report));
        }
        if let Some(name) = &load.name {
            let (nodal, pressures) = (first[0]..loads.nodal.len(), first[1]..loads.pressures.len());
            let centrifugal = first[2]..loads.centrifugal.len();
            let are_new = scene.stage.is_some_and(|stage| stage.is_new(&load.stages));
            actors.push((name, Actors { nodal, pressures, centrifugal, motions: Vec::new(), are_new }));
        }
    }
    loads.nodal.extend(efforts);
    loads
}

/// True for a load that heats parts.
pub fn is_temperature(load: &words::Load) -> bool {
    load.temperature.is_some() || load.temperature_gradient.is_some() || !load.nodal_temperature.0.is_empty()
}

/// True for a load that is spread over parts or edges.
fn is_spread(load: &words::Load) -> bool {
    let over_lines = load.force_per_length.is_some() || load.local.is_some();
    over_lines || load.force_per_area.is_some() || load.pressure.is_some()
}

fn nodal_load<'d>(
    scene: &Scene<'d>,
    load: &'d At<Table<words::Load>>,
    amplitude: Option<usize>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Vec<Load> {
    let owner = Owner::new("`[[loads]]`", &load.span);
    // For a load with `part` in place of `at`, this is the only error to report.
    let names_part = load.part.is_some() && load.at.is_none();
    let spots = if names_part { Vec::new() } else { scene.spots(&owner, "at", &load.at, Reach::Nodes, report) };
    if let (Some(_), Some(total)) = (&load.force, &load.total_force) {
        report.error::<()>(&total.span, "a load has `force` or `total_force`, not both");
    }
    let given = if load.total_force.is_some() { &load.total_force } else { &load.force };
    let share = if load.total_force.is_some() { 1.0 / spots.len().max(1) as f64 } else { 1.0 };
    let (force, moment) = (vec3_or_zero(given) * share, vec3_or_zero(&load.moment));
    let keys = [
        "force",
        "total_force",
        "moment",
        "force_per_length",
        "local",
        "force_per_area",
        "pressure",
        "temperature",
        "temperature_gradient",
        "centrifugal",
        "unbalance",
    ];
    let unused = keys!(load; part, projected, profile);
    let unread = keys.iter().any(|key| report.is_spoiled(owner.span, key));
    if given.is_none() && load.moment.is_none() && !unread {
        report.error_with::<()>(
            owner.span,
            "this load is empty",
            "give it `force`, `moment`, `temperature`, `centrifugal` or `unbalance`; of beams also `force_per_length`, of shells `pressure` or `force_per_area`",
        );
    } else if !unread {
        report.reject_unused("a load at nodes", &unused);
    }
    let follower = flag(&load.follower, false);
    let mut loads = Vec::new();
    for spot in spots {
        if topology.is_loose(&spot, "this load", report) {
            continue;
        }
        for (first, part, place) in [(0, &force, span(given)), (3, &moment, span(&load.moment))] {
            let lost = (0..3).filter(|&i| part[i] != 0.0 && !topology.is_taken(spot.node, first + i));
            let lost = directions(lost.map(|i| first + i));
            if let Some(place) = place.filter(|_| topology.is_complete() && !lost.is_empty()) {
                let message = format!("nothing connected to `{}` resists a load in {lost}", spot.name);
                report.error_with::<()>(place, message, "bars, springs and point masses have no rotations");
            }
        }
        loads.push(Load { node: spot.node, force, moment, follower, amplitude, origin: None, moment_counts: true });
    }
    loads
}

/// The index of the amplitude of a load.
fn amplitude<'d>(scene: &Scene<'d>, load: &'d words::Load, report: &mut Report<'d>) -> Option<usize> {
    let Some(name) = &load.amplitude else { return scene.stage.map(|stage| stage.amplitude_of_load(&load.stages)) };
    report.find("amplitude", &scene.deck.amplitudes, name).map(|(index, _)| index)
}
