//! Elastic foundations of beams and shells: springs between their nodes and the ground.

use crate::data::{Beam, Link, LinkKind, OwnDamping, Part, PartType, Shell};
use crate::places::nodes::Nodes;
use crate::report::Report;
use crate::scene::Scene;
use base::diagnostic::At;
use base::math::quadrature::lobatto;
use base::math::{Mat3, Vec3};
use deck::parts::{PartIndex, PartKind};
use deck::words::Vector;
use mechanics::elements::shell;
use std::collections::BTreeMap;

/// The springs of all `foundation`s, of beams and then of shells. Each node of a beam has the length that Lobatto's rule of its elements gives it,
/// each node of a shell the integral of its shape function.
pub fn foundations(scene: &Scene, nodes: &mut Nodes, report: &mut Report) -> Vec<Link> {
    let beams = scene.deck.beams.iter().map(|beam| &beam.foundation);
    let shells = scene.deck.shells.iter().map(|shell| &shell.foundation);
    let beams = beams.enumerate().map(|(index, at)| (PartIndex { kind: PartKind::Beam, index }, at));
    let shells = shells.enumerate().map(|(index, at)| (PartIndex { kind: PartKind::Shell, index }, at));
    let mut links = Vec::new();
    for (part, at) in beams.chain(shells) {
        let Some(at) = at.as_ref().filter(|at| is_sound(scene, part, at, report)) else { continue };
        let Some(name) = scene.parts.of(part).first().map(|part| part.name().to_owned()) else { continue };
        let mut extents = BTreeMap::new();
        for part in scene.parts.of(part) {
            extents_of(part, nodes, &mut extents);
        }
        // Nodes on the sides of curved elements have it all.
        for (number, (node, extent)) in extents.into_iter().filter(|(_, extent)| *extent > 0.0).enumerate() {
            links.push(spring(format!("{name}.foundation[{number}]"), node, extent * Vec3::from(at.value.0), nodes));
        }
    }
    links
}

/// Reports a foundation that pushes, or that of a rigid part.
fn is_sound(scene: &Scene, part: PartIndex, at: &At<Vector>, report: &mut Report) -> bool {
    let (per, what) = if part.kind == PartKind::Beam { ("length", "beam") } else { ("area", "shell") };
    if at.value.0.iter().any(|k| *k < 0.0) || at.value.0 == [0.0; 3] {
        let hint = format!("stiffness per {per} along global x, y and z, such as [0.0, 0.0, 1e7]");
        report.error_with::<()>(&at.span, "a foundation needs stiffnesses of 0 or more, one of them above 0", hint);
        return false;
    }
    if scene.parts.entry(part).is_some_and(|entry| entry.rigid_elements.is_some()) {
        let hint = format!("remove it, and put `[[links]]` between points of the {what} and the ground");
        let message = format!("`foundation` does not apply to a rigid {what}");
        report.error_with::<()>(&at.span, message, hint);
        return false;
    }
    true
}

/// A bushing between a node and a point of the ground at the same place.
fn spring(name: String, node: usize, stiffness: Vec3, nodes: &mut Nodes) -> Link {
    let ground = nodes.add(format!("{name}.ground"), false, nodes.x(node));
    (0..6).for_each(|dof| nodes.restrain(ground, dof, None));
    [ground, node].into_iter().for_each(|end| nodes.connect(end, true));
    let stiffness = [stiffness.x, stiffness.y, stiffness.z, 0.0, 0.0, 0.0];
    let kind = LinkKind::Bushing { stiffness, damping: [0.0; 6], axes: Mat3::identity() };
    Link { name, ends: [ground, node], kind, own_damping: OwnDamping::default(), failure: None, take_up: None }
}

/// Adds the length of beam or the area of shell for which each node of a part stands.
fn extents_of(part: &Part, nodes: &Nodes, extents: &mut BTreeMap<usize, f64>) {
    let mut add = |node: usize, extent: f64| *extents.entry(node).or_insert(0.0) += extent;
    if let Some(beam) = Beam::of(part) {
        let (_, weights) = lobatto(beam.order + 1);
        for element in &beam.elements {
            let half = 0.5 * (nodes.x(element.nodes[beam.order]) - nodes.x(element.nodes[0])).norm();
            element.nodes.iter().zip(weights).for_each(|(node, weight)| add(*node, half * weight));
        }
    }
    if let Some(shell) = Shell::of(part) {
        for element in &shell.elements {
            let element = &element.nodes[..shell.size()];
            let x: Vec<Vec3> = element.iter().map(|node| nodes.x(*node)).collect();
            element.iter().zip(shell::shares(&x)).for_each(|(node, share)| add(*node, share));
        }
    }
}
