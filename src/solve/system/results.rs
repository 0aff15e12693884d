//! The results of elements for output: forces of links, stress resultants of beams and shells.

use super::equations::System;
use super::group::Group;
use super::loads::Loading;
use super::parts::beam_sections::{self, EndForces, SectionPoint};
use super::parts::beams;
use super::parts::links::{self, LinkState};
use super::parts::shell_shear::ShearBalance;
use super::parts::shells::{self, ShellState};
use mechanics::state::{Configuration, Node};
use model::Model;

/// Writes the axial force of each element of all bars into `out`, in deck order.
pub fn axial_forces(system: &System, now: &Configuration, out: &mut Vec<f64>) {
    out.clear();
    for group in system.shown_groups().filter(|group| group.kind.is_deformable()) {
        let now = group.configuration(now);
        out.extend((0..group.block.len()).filter_map(|e| group.block.axial_force(e, &now)));
    }
}

/// Writes the states of all links into `out`, in deck order.
pub fn link_states(system: &System, now: &Configuration, out: &mut Vec<LinkState>) {
    links::link_states(&system.links, &system.groups, now, out);
}

/// The group of each link of the deck and its place there, in deck order.
pub fn links_of_deck(system: &System) -> Vec<(&Group, usize)> {
    links::of_deck(&system.links, &system.groups)
}

/// The bushing, by its place among the links, whose ends have turned over against each other between `start` and `end`.
pub fn bushing_turned_over(system: &System, start: &[Node], end: &[Node]) -> Option<usize> {
    links::turned_over(&system.links, start, end)
}

/// The bushing, by its place among the links, whose ends turn against each other too far for a step of length `dt` from `start` to
/// `end`.
pub fn bushing_turns_too_far(system: &System, start: &[Node], end: &[Node], dt: f64) -> Option<usize> {
    links::turns_too_far(&system.links, start, end, dt)
}

/// Writes the largest accumulated plastic strain of each element into `out`: all beams, bars and shells in deck
/// order.
pub fn plastic_strains(system: &System, now: &Configuration, out: &mut Vec<f64>) {
    out.clear();
    for group in system.shown_groups().filter(|group| group.kind.is_deformable()) {
        let history = group.configuration(now).history;
        out.extend((0..group.block.len()).map(|e| group.block.plastic_strain(e, history)));
    }
}

/// Writes for each of these elements whether it has failed into `out`, which stays empty if no element can fail.
pub fn failed(system: &System, now: &Configuration, out: &mut Vec<bool>) {
    out.clear();
    let own = || system.shown_groups().filter(|group| group.kind.is_deformable());
    if own().any(|group| group.block.can_fail()) {
        for group in own() {
            let history = group.configuration(now).history;
            out.extend((0..group.block.len()).map(|e| group.block.has_failed(e, history)));
        }
    }
}

/// Writes the stress resultants of all elements of all shells into `out`, in deck order.
pub fn shell_states(
    system: &System,
    model: &Model,
    (now, threads): (&Configuration, usize),
    balance: &mut ShearBalance,
    out: &mut Vec<ShellState>,
) {
    shells::shell_states(system.shown_groups(), model, now, system.uses_threads(threads), out);
    balance.apply(model, out);
}

/// Writes the stress resultants at each node of each element of all beams into `out`, in deck order.
pub fn nodal_resultants(system: &System, model: &Model, now: &Configuration, out: &mut Vec<[f64; 6]>) {
    beams::nodal_resultants(system.shown_groups(), model, now, out);
}

/// Writes the stress resultants of all beams into `out`, in deck order, at integration points, and at ends if wanted; `loading` holds the
/// loads at the instant.
pub fn section_points(
    system: &System,
    model: &Model,
    (now, loading): (&Configuration, &Loading),
    out: &mut Vec<SectionPoint>,
) {
    let acting =
        system.beam_ends().map(|ends| EndForces { ends, loads: &system.loads, loading, damping: &system.mass_damping });
    beam_sections::section_points(system.shown_groups(), model, now, acting, out);
}
