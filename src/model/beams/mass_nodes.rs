//! Nodes for the masses of beams whose centres of mass lie beside the axis: each moves rigidly with a node of the beam.

use crate::data::{Beam, DependentNode, MassKind, Model, Node, PartType, SectionAt};
use base::math::Vec3;
use std::collections::HashMap;

/// Adds the nodes of the masses beside the axes of beams. They are the last of all, with the motion at t = 0 that follows from their beams.
pub fn add_mass_nodes(model: &mut Model) {
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
                *id = *known.entry((master, arm.map(f64::to_bits).into())).or_insert_with(|| {
                    let Node { label, x, v, omega, place, .. } = &nodes[master];
                    let (label, place) = (format!("{label} (mass of {})", beam.name), *place);
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
