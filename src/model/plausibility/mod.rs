//! Suspicious input in a valid deck: empty decks, unused tables, keys without effect.

pub mod all_held;
pub mod amplitude_ends;
pub mod angles;
pub mod coincidence;
pub mod cyclic_hardening;
pub mod long_chains;
pub mod loose;
pub mod node_places;
pub mod overlaps;
pub mod parts_at_rest;
pub mod proportions;
pub mod record_units;
pub mod scaled_loads;
pub mod shaking;
pub mod slivers;
pub mod sudden_weight;
pub mod ties;
pub mod units;
pub mod unjoined;
pub mod unseen_record;
pub mod unused;
pub mod upward;
pub mod usage;

use crate::places::nodes::Topology;
use crate::plausibility::usage::{named_amplitudes, named_materials, named_sections};
use crate::report::Report;
use crate::values::span;
use base::diagnostic::Diagnostic;
use deck::Deck;
use deck::read::ROOT;
use deck::words::Named;
use std::collections::HashSet;

/// Reports a deck without anything that could move.
pub fn check_content(deck: &Deck, report: &mut Report) {
    // Points between springs move without mass.
    let between = deck.links.iter().flat_map(|link| [&link.from, &link.to]).flatten().any(|end| end.node.is_some());
    let moves = deck.parts().any(|part| part.at.kind.is_deformable())
        || !deck.bodies.is_empty()
        || !deck.masses.is_empty()
        || between;
    let spoiled = ["beams", "bars", "shells", "superelements", "bodies", "masses", "links"]
        .iter()
        .any(|key| report.is_spoiled(&ROOT, key));
    if !moves && !spoiled {
        let message =
            "the deck has nothing that could move: no beams, bars, shells, bodies, masses or links between points";
        report.push(Diagnostic::error(message).hint("add a part, such as [[beams]] or [[bodies]]"));
    }
}

/// Warns of points, materials, sections and amplitudes that nothing uses.
pub fn check_use(deck: &Deck, topology: &Topology, report: &mut Report) {
    let masters: HashSet<usize> = topology.dependents.iter().map(|dependent| dependent.master).collect();
    // A point may be connected by tables of other stages.
    let ends = deck.links.iter().flat_map(|link| [&link.from, &link.to]).flatten();
    let ends = ends.chain(deck.joints.iter().flat_map(|joint| [&joint.from, &joint.to]).flatten());
    let elsewhere: HashSet<&str> = match deck.stages.is_empty() {
        true => HashSet::new(),
        false => ends.filter_map(|end| end.node.as_ref()).map(|name| name.as_str()).collect(),
    };
    for (node, (name, _)) in
        deck.points.0.iter().enumerate().filter(|(_, (name, _))| !elsewhere.contains(name.as_str()))
    {
        let connected = (0..6).any(|dof| topology.is_connected(node, dof)) || topology.attachment(node).is_some();
        if !connected && !masters.contains(&node) {
            let message = format!("nothing is connected to point `{}`", name.value);
            report.warn(
                &name.span,
                message,
                "remove it, or name it in a part or link; it is omitted from the computation",
            );
        }
    }
    check_table("material", &deck.materials, &named_materials(deck), report);
    check_table("section", &deck.sections, &named_sections(deck), report);
    check_table("amplitude", &deck.amplitudes, &named_amplitudes(deck), report);
}

fn check_table<T>(what: &str, table: &Named<T>, used: &HashSet<&str>, report: &mut Report) {
    for (name, _) in table.0.iter().filter(|(name, _)| !used.contains(name.as_str())) {
        report.warn(
            &name.span,
            format!("nothing uses {what} `{}`", name.value),
            "remove it, or name it where it is meant",
        );
    }
}

/// Warns of input without effect in a static analysis.
pub fn check_static(deck: &Deck, report: &mut Report) {
    let velocities = deck.bodies.iter().flat_map(|body| [span(&body.velocity), span(&body.angular_velocity)]).flatten();
    let places = velocities.chain(deck.initial.iter().map(|initial| &initial.span)).chain(span(&deck.damping));
    for place in places {
        report.warn(
            place,
            "this has no effect in a static analysis",
            "remove it: a static analysis has no velocities, no inertia and no damping",
        );
    }
    // Rotations are updated in load steps too.
    let Some(integrator) = &deck.integrator else { return };
    for place in span(&integrator.kind).into_iter().chain(integrator.values.places()) {
        report.warn(place, "this has no effect in a static analysis", "remove it: load steps need no time integration");
    }
}
