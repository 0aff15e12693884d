//! Unilateral contact against closed forms.

mod balls;
mod boxes;
mod capsules;
mod capsules_on_lines;
mod closing;
mod cylinders;
mod depth;
mod edges;
mod edges_of_solids;
mod element;
mod faces;
mod faces_alone;
mod flat_on_mesh;
mod folds;
mod friction_reversals;
mod impact;
mod lines;
mod lines_alone;
mod multipliers;
mod open_stiffness;
mod pairs;
mod polyhedra;
mod rigid_parts;
mod rubbing;
mod sheet_edges;
mod sight;
mod sliding_far;
mod slipping_plates;
mod stages;
mod stiffness;
mod touch;
mod two_coefficients;
mod unresolved_contacts;

use crate::support::{Done, read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// Runs it to its end.
pub fn go(text: &str, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    run_to_the_end(&read_deck(text), probe)
}

/// Time, mechanical energy, what the scheme took, energy of the contact, its force on what touches along z, momentum, angular momentum.
pub fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let force = frame.derived.contacts.first().map_or(0.0, |contact| -contact.f.z);
    vec![frame.state.time, e.mechanical, e.numerical, e.contact, force, e.p.x, e.p.y, e.p.z, e.l.x, e.l.y, e.l.z]
}
