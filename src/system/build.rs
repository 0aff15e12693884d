//! From the model's parts to blocks of like elements and to masses at nodes.

use super::inertia::{ConsistentMass, Lumped};
use super::lanes::MOST_IN_GROUP;
use super::results::Watched;
use super::{Group, GroupKind, Inertia};
use crate::constraints::joint::{Joint, Row};
use crate::elements::ElementBlock;
use crate::elements::bar::{self, YieldingBars};
use crate::elements::beam::{Beams, Description, Yielding};
use crate::elements::bushing::{Bushing, Bushings};
use crate::elements::contact::{Contacts, MOST_NODES, Point};
use crate::elements::link::{Link, Links};
use crate::elements::shell::{self, Quadrilateral, Quadrilaterals, Triangle, Triangles};
use crate::math::{Mat3, Vec3, quadrature};
use crate::model::{self, MassKind, Model};
use crate::sections;
use std::ops::Range;

/// Inertia of bodies, point masses and elements, at their nodes or spread over them.
pub fn masses(model: &Model, x: &[Vec3]) -> (Vec<Inertia>, Vec<ConsistentMass>) {
    let mut lumped = Lumped::new(x.len());
    let mut consistent = Vec::new();
    let mut tied = vec![false; x.len()];
    for body in &model.bodies {
        model.riders.iter().filter(|rider| rider.master == body.node).for_each(|rider| tied[rider.node] = true);
    }
    // Of a deformable part, at a node: whether its mass lies there, and whether it has inertia there.
    let lies = |kind: MassKind, node: usize| match kind {
        MassKind::Lumped => true,
        MassKind::FreeNodes => !tied[node],
        MassKind::Consistent | MassKind::None => false,
    };
    let turns = |kind: MassKind, node: usize| kind == MassKind::Consistent || lies(kind, node);
    model.bodies.iter().for_each(|body| lumped.add(body.node, body.mass, &body.inertia));
    model.masses.iter().for_each(|mass| lumped.add(mass.node, mass.mass, &mass.inertia));
    for beam in &model.beams {
        let (_, weights) = quadrature::lobatto(beam.order + 1);
        for element in &beam.elements {
            let nodes = &element.nodes[..=beam.order];
            let section = &model.stiffnesses[element.section];
            let length = (x[nodes[beam.order]] - x[nodes[0]]).norm();
            let rotary = element.frame * section.inertia_per_length * element.frame.transpose();
            for (&node, w) in nodes.iter().zip(weights) {
                let share = 0.5 * w * length;
                let mass = if lies(beam.mass, node) { share * section.mass_per_length } else { 0.0 };
                let keep = beam.rotary_inertia && turns(beam.mass, node);
                lumped.add(node, mass, &if keep { rotary * share } else { Mat3::zeros() });
            }
            if beam.mass == MassKind::Consistent {
                consistent.push(ConsistentMass::new(nodes, length * section.mass_per_length));
            }
        }
    }
    for part in &model.bars {
        for nodes in &part.elements {
            let mass = part.mass_per_length * part.free * (x[nodes[1]] - x[nodes[0]]).norm();
            for &node in nodes.iter().filter(|&&node| lies(part.mass, node)) {
                lumped.add(node, 0.5 * mass, &Mat3::zeros());
            }
            if part.mass == MassKind::Consistent {
                consistent.push(ConsistentMass::new(nodes, mass));
            }
        }
    }
    for part in &model.shells {
        let h = part.plate.thickness;
        for element in &part.elements {
            let nodes = &element.nodes[..part.corners];
            let corners: Vec<Vec3> = nodes.iter().map(|&n| x[n]).collect();
            for (&node, area) in nodes.iter().zip(shell::shares(&corners)) {
                let mass = if lies(part.mass, node) { part.density * h * area } else { 0.0 };
                // The same about the normal, where a director has none: no direction is left without inertia.
                let rotary = if turns(part.mass, node) { part.density * h.powi(3) / 12.0 * area } else { 0.0 };
                lumped.add(node, mass, &(rotary * Mat3::identity()));
            }
            if part.mass == MassKind::Consistent {
                consistent.push(ConsistentMass::of_shell(nodes, &corners, part.density * h));
            }
        }
    }
    (lumped.finish(), consistent)
}

/// Elements by part, beams first and contacts last, and the links as the deck lists them. `plane`: the normal of a plane motion.
pub fn groups(model: &Model, x: &[Vec3], plane: Option<usize>) -> (Vec<Group>, Vec<Watched>) {
    let beta = model.damping.stiffness_factor;
    let mut groups = Vec::new();
    let mut add = |block: Box<dyn ElementBlock>, kind, part, first| {
        if !block.is_empty() {
            groups.push(Group { block, kind, part, first, history: 0..0 });
        }
    };
    for (k, part) in model.beams.iter().enumerate() {
        pieces(part.elements.len())
            .for_each(|piece| add(beams(part, piece.clone(), model, x, beta, plane), GroupKind::Beam, k, piece.start));
    }
    for (k, part) in model.bars.iter().enumerate() {
        pieces(part.elements.len())
            .for_each(|piece| add(bars(part, piece.clone(), x, beta), GroupKind::Bar, k, piece.start));
    }
    for (k, part) in model.shells.iter().enumerate() {
        pieces(part.elements.len())
            .for_each(|piece| add(shells(part, piece.clone(), x, beta), GroupKind::Shell, k, piece.start));
    }
    let (links, watched) = links(model, x);
    links.into_iter().for_each(|block| add(block, GroupKind::Link, 0, 0));
    for (k, contact) in model.contacts.iter().enumerate() {
        let Some(law) = contact.law else { continue };
        for count in 1..=MOST_NODES {
            let points: Vec<Point> = contact.points.iter().filter(|point| point.count == count).cloned().collect();
            for piece in pieces(points.len()) {
                let block = Contacts::new(law, contact.surface.clone(), contact.node, points[piece.clone()].to_vec());
                add(Box::new(block), GroupKind::Contact, k, piece.start);
            }
        }
    }
    let mut end = 0;
    for group in &mut groups {
        group.history = end..end + group.block.history();
        end = group.history.end;
    }
    (groups, watched)
}

/// Ranges of elements for a group each, as even as can be.
fn pieces(elements: usize) -> impl Iterator<Item = Range<usize>> {
    let count = elements.div_ceil(MOST_IN_GROUP);
    (0..count).map(move |k| k * elements / count..(k + 1) * elements / count)
}

fn beams(
    part: &model::Beam,
    piece: Range<usize>,
    model: &Model,
    x: &[Vec3],
    beta: f64,
    plane: Option<usize>,
) -> Box<dyn ElementBlock> {
    match part.order {
        1 => beams_of::<2>(part, piece, model, x, beta, plane),
        2 => beams_of::<3>(part, piece, model, x, beta, plane),
        3 => beams_of::<4>(part, piece, model, x, beta, plane),
        _ => beams_of::<5>(part, piece, model, x, beta, plane),
    }
}

fn beams_of<const N: usize>(
    part: &model::Beam,
    piece: Range<usize>,
    model: &Model,
    x: &[Vec3],
    beta: f64,
    plane: Option<usize>,
) -> Box<dyn ElementBlock> {
    let elements = part.elements[piece].iter().map(|e| Description {
        nodes: &e.nodes,
        frame: &e.frame,
        stiffness: &model.stiffnesses[e.section],
    });
    match &part.yielding {
        None => Box::new(Beams::<N>::new(elements, x, beta)),
        Some(yielding) => {
            let fibres = match in_plane(part, plane) {
                Some(along_z) => sections::flattened(&yielding.fibres, along_z),
                None => yielding.fibres.clone(),
            };
            Yielding { fibres, ..yielding.clone() }.beams::<N>(elements, x, beta)
        }
    }
}

/// Whether a plane motion bends all elements of a part along local z (or y); `None` if it does neither.
pub fn in_plane(part: &model::Beam, plane: Option<usize>) -> Option<bool> {
    let normal = plane?;
    let across = |axis: usize| part.elements.iter().all(|e| e.frame[(normal, axis)].abs() > 1.0 - 1e-12);
    if across(1) { Some(true) } else { across(2).then_some(false) }
}

fn bars(part: &model::Bar, piece: Range<usize>, x: &[Vec3], beta: f64) -> Box<dyn ElementBlock> {
    let elements = &part.elements[piece];
    match &part.yielding {
        None => Box::new(bar::links(elements, part.axial_stiffness, part.tension_only, part.free, x, beta)),
        Some(law) => {
            let stiffness = part.axial_stiffness;
            Box::new(YieldingBars::new(elements, stiffness, law, part.tension_only, part.free, x, beta))
        }
    }
}

fn shells(part: &model::Shell, piece: Range<usize>, x: &[Vec3], beta: f64) -> Box<dyn ElementBlock> {
    let corners = part.corners;
    let elements = part.elements[piece]
        .iter()
        .map(|e| shell::Description { nodes: &e.nodes[..corners], normals: &e.normals[..corners] });
    match (&part.yielding, corners) {
        (None, 3) => Box::new(Triangles::new(elements, x, &part.plate, beta)),
        (None, _) => Box::new(Quadrilaterals::new(elements, x, &part.plate, beta)),
        (Some(yielding), 3) => yielding.shells::<Triangle, 3, 2, 3>(elements, x, &part.plate, beta),
        (Some(yielding), _) => yielding.shells::<Quadrilateral, 4, 3, 5>(elements, x, &part.plate, beta),
    }
}

fn links(model: &Model, x: &[Vec3]) -> ([Box<dyn ElementBlock>; 2], Vec<Watched>) {
    let mut lines = Vec::new();
    let mut bushings = Vec::new();
    let mut watched = Vec::new();
    for link in &model.links {
        match &link.kind {
            model::LinkKind::Line { law, damping, direction, free_length } => {
                let start = link.ends.map(|node| x[node]);
                let line = Link::new(link.ends, law.clone(), *damping, *direction, *free_length, start);
                watched.push(Watched::Line(line.clone()));
                lines.push(line);
            }
            model::LinkKind::Bushing { stiffness, damping, axes } => {
                let bushing = Bushing {
                    nodes: link.ends,
                    axes: *axes,
                    stiffness: *stiffness,
                    damping: *damping,
                    offset: axes.tr_mul(&(x[link.ends[1]] - x[link.ends[0]])),
                };
                watched.push(Watched::Bushing(bushing.clone()));
                bushings.push(bushing);
            }
        }
    }
    ([Box::new(Links(lines)), Box::new(Bushings(bushings))], watched)
}

/// Joints with the rows that say anything where all moves in a plane.
pub fn joints(model: &Model, x: &[Vec3], plane: Option<usize>) -> Vec<Joint> {
    let joint = |joint: &model::Joint| {
        let d = x[joint.ends[0]] - x[joint.ends[1]];
        let says = |row: &&Row| plane.is_none_or(|normal| row.in_plane(normal, &d) != Some(false));
        Joint { nodes: joint.ends, rows: joint.rows.iter().filter(says).copied().collect(), supports: joint.supports }
    };
    model.joints.iter().map(joint).collect()
}
