//! Nodes for the masses of beams whose centres of mass lie beside the axis: each moves rigidly with a node of the beam.

use crate::data::{Beam, DependentNode, MassKind, Model, Node, PartType, SectionAt};
use crate::report::Report;
use base::math::Vec3;
use deck::Deck;
use mechanics::sections::Stiffness;
use std::collections::HashMap;

/// Least moment of inertia about the centre of a mass that resists turns, over the mass times the square of its distance from the axis.
const POINT: f64 = 1e-6;

/// Adds the nodes of the masses beside the axes of beams. They are the last of all, with the motion at t = 0 that follows from their beams.
pub fn add_mass_nodes(model: &mut Model, deck: &Deck, report: &mut Report) {
    if model.analysis.is_dynamic() && !model.analysis.has_modes() {
        note_points(model, deck, report);
    }
    let Model { nodes, parts, stiffnesses, constraints, .. } = model;
    for beam in parts.iter_mut().filter_map(Beam::of_mut).filter(|beam| beam.mass != MassKind::None) {
        // Elements that meet with the same arm share the node.
        let mut known: HashMap<(usize, [u64; 3]), usize> = HashMap::new();
        for element in &mut beam.elements {
            let arms: [Option<Vec3>; 5] = std::array::from_fn(|k| {
                let SectionAt { section, frame } = element.at_node(k.min(beam.order));
                stiffnesses[section].mass_arm(&frame)
            });
            if arms == [None; 5] {
                continue;
            }
            let mut ids = element.nodes;
            for (id, arm) in ids.iter_mut().zip(arms).take(beam.order + 1) {
                let (Some(arm), master) = (arm, *id) else { continue };
                let number = known.len() + 1;
                *id = *known.entry((master, arm.map(f64::to_bits).into())).or_insert_with(|| {
                    let Node { label, x, v, omega, place, .. } = &nodes[master];
                    let (label, place) = (format!("{label} (mass {number} of {})", beam.name), *place);
                    let (x, v, omega) = (x + arm, v + omega.cross(&arm), *omega);
                    nodes.push(Node { label, named: false, is_number: false, x, v, omega, given: [None, None], place });
                    let node = nodes.len() - 1;
                    constraints.dependents.push(DependentNode { node, master, dofs: [true; 6], place });
                    node
                });
            }
            element.mass_nodes = Some(Box::new(ids));
        }
    }
}

/// Warns of masses beside the axis without inertia about their centres: turns about these have no inertia at all, and their errors make energy.
fn note_points(model: &Model, deck: &Deck, report: &mut Report) {
    for beam in model.each::<Beam>().filter(|beam| beam.mass != MassKind::None) {
        let is_point = |section: usize| {
            let Stiffness { mass_per_length, mass_center: [y, z], inertia_per_length, .. } =
                &model.stiffnesses[section];
            let least = if beam.rotary_inertia { inertia_per_length.symmetric_eigenvalues().min() } else { 0.0 };
            let square = y * y + z * z;
            square > 0.0 && least <= POINT * mass_per_length * square
        };
        if beam.sections().any(is_point)
            && let Some(table) = deck
                .beams
                .iter()
                .find(|table| table.name.as_ref().or(table.group.as_ref()).is_some_and(|name| name.value == beam.name))
        {
            let message =
                format!("the mass of beam `{}` lies beside its axis and has no inertia about its centre", beam.name);
            let hint = match beam.rotary_inertia {
                true => {
                    "give rows 4 to 6 of `mass` more than the mass times the square of the distance, about each axis"
                }
                false => "remove `rotary_inertia = false`: turns of the sections about their centres need inertia",
            };
            report.warn(&table.span, message, hint);
        }
    }
}
