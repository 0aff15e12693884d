//! Elastic foundations of beams: springs between their nodes and the ground.

use crate::data::{Beam, Link, LinkKind, OwnDamping, PartType};
use crate::places::nodes::Nodes;
use crate::report::Report;
use crate::scene::Scene;
use base::math::Mat3;
use base::math::quadrature::lobatto;
use deck::parts::{PartIndex, PartKind};
use std::collections::BTreeMap;

/// The springs of all `foundation` of beams. Each node has the length that Lobatto's rule of its elements gives it.
pub fn foundations(scene: &Scene, nodes: &mut Nodes, report: &mut Report) -> Vec<Link> {
    let mut links = Vec::new();
    for (index, table) in scene.deck.beams.iter().enumerate() {
        let Some(at) = &table.foundation else { continue };
        let [x, y, z] = at.value.0;
        if [x, y, z].iter().any(|k| *k < 0.0) || [x, y, z] == [0.0; 3] {
            let hint = "stiffness per length along global x, y and z, such as [0.0, 0.0, 1e7]";
            report.error_with::<()>(&at.span, "a foundation needs stiffnesses of 0 or more, one of them above 0", hint);
            continue;
        }
        let part = PartIndex { kind: PartKind::Beam, index };
        if scene.parts.entry(part).is_some_and(|entry| entry.rigid_elements.is_some()) {
            let hint = "remove it, and put `[[links]]` between points of the beam and the ground";
            report.error_with::<()>(&at.span, "`foundation` does not apply to a rigid beam", hint);
            continue;
        }
        for beam in scene.parts.of(part).iter().filter_map(Beam::of) {
            for (number, (node, length)) in lengths(beam, nodes).into_iter().enumerate() {
                let name = format!("{}.foundation[{number}]", beam.name);
                let ground = nodes.add(format!("{name}.ground"), false, nodes.x(node));
                (0..6).for_each(|dof| nodes.restrain(ground, dof, None));
                [ground, node].into_iter().for_each(|end| nodes.connect(end, true));
                let stiffness = [x * length, y * length, z * length, 0.0, 0.0, 0.0];
                let kind = LinkKind::Bushing { stiffness, damping: [0.0; 6], axes: Mat3::identity() };
                let (own_damping, failure, take_up) = (OwnDamping::default(), None, None);
                links.push(Link { name, ends: [ground, node], kind, own_damping, failure, take_up });
            }
        }
    }
    links
}

/// The length of beam for which each node stands.
fn lengths(beam: &Beam, nodes: &Nodes) -> BTreeMap<usize, f64> {
    let (_, weights) = lobatto(beam.order + 1);
    let mut lengths = BTreeMap::new();
    for element in &beam.elements {
        let half = 0.5 * (nodes.x(element.nodes[beam.order]) - nodes.x(element.nodes[0])).norm();
        for (node, weight) in element.nodes.iter().zip(weights) {
            *lengths.entry(*node).or_insert(0.0) += half * weight;
        }
    }
    lengths
}
