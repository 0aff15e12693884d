//! Builds blocks of like elements and the masses of nodes from the model's parts.

use super::group::Group;
use super::inertia::{ConsistentMass, Inertia, Lumped};
use super::thread_partition::MOST_IN_GROUP;
use super::watched::Watched;
use crate::constraints::joint::{ConstraintEquation, Joint};
use crate::elements::ElementBlock;
use crate::elements::bar::{self, YieldingBars};
use crate::elements::beam::{BeamGeometry, Beams, FibreModel};
use crate::elements::bushing::{Bushing, Bushings};
use crate::elements::contact::{ContactPoint, Contacts, MOST_NODES};
use crate::elements::link::{Link, Links};
use crate::elements::shell::{self, Quadrilateral, Quadrilaterals, Triangle, Triangles};
use crate::math::{Mat3, Vec3, quadrature};
use crate::model::{self, MassKind, Model, Part};
use crate::sections::{self, Stiffness};
use std::ops::Range;

/// Lumped and consistent masses of bodies, point masses and deformable parts; `x` are the initial positions of all
/// nodes.
pub fn masses(model: &Model, x: &[Vec3]) -> (Vec<Inertia>, Vec<ConsistentMass>) {
    let mut tied = vec![false; x.len()];
    for body in &model.bodies {
        model
            .constraints
            .dependents
            .iter()
            .filter(|dependent| dependent.master == body.node)
            .for_each(|dependent| tied[dependent.node] = true);
    }
    let mut masses = Masses { x, tied, lumped: Lumped::new(x.len()), consistent: Vec::new() };
    model.bodies.iter().for_each(|body| masses.lumped.add(body.node, body.mass, &body.inertia));
    model.masses.iter().for_each(|mass| masses.lumped.add(mass.node, mass.mass, &mass.inertia));
    for part in &model.parts {
        match part {
            Part::Beam(beam) => masses.add_beam(beam, &model.stiffnesses),
            Part::Bar(bar) => masses.add_bar(bar),
            Part::Shell(shell) => masses.add_shell(shell),
            Part::Link(_) | Part::Contact(_) => {}
        }
    }
    (masses.lumped.finish(), masses.consistent)
}

/// The masses of a scene while they are summed.
struct Masses<'s> {
    x: &'s [Vec3],
    /// True for each node that depends on a body.
    tied: Vec<bool>,
    lumped: Lumped,
    consistent: Vec<ConsistentMass>,
}

impl Masses<'_> {
    /// True where a deformable part has mass at a node of its own.
    fn lies(&self, kind: MassKind, node: usize) -> bool {
        match kind {
            MassKind::Lumped => true,
            MassKind::FreeNodes => !self.tied[node],
            MassKind::Consistent | MassKind::None => false,
        }
    }

    /// True where a deformable part has rotary inertia at a node of its own.
    fn turns(&self, kind: MassKind, node: usize) -> bool {
        kind == MassKind::Consistent || self.lies(kind, node)
    }

    fn add_beam(&mut self, beam: &model::Beam, stiffnesses: &[Stiffness]) {
        let (_, weights) = quadrature::lobatto(beam.order + 1);
        for element in &beam.elements {
            let nodes = &element.nodes[..=beam.order];
            let section = &stiffnesses[element.section];
            let length = (self.x[nodes[beam.order]] - self.x[nodes[0]]).norm();
            let rotary = element.frame * section.inertia_per_length * element.frame.transpose();
            for (&node, w) in nodes.iter().zip(weights) {
                let share = 0.5 * w * length;
                let mass = if self.lies(beam.mass, node) { share * section.mass_per_length } else { 0.0 };
                let keep = beam.rotary_inertia && self.turns(beam.mass, node);
                self.lumped.add(node, mass, &if keep { rotary * share } else { Mat3::zeros() });
            }
            if beam.mass == MassKind::Consistent {
                self.consistent.push(ConsistentMass::new(nodes, length * section.mass_per_length));
            }
        }
    }

    fn add_bar(&mut self, bar: &model::Bar) {
        for nodes in &bar.elements {
            let mass = bar.mass_per_length * bar.free * (self.x[nodes[1]] - self.x[nodes[0]]).norm();
            for &node in nodes {
                if self.lies(bar.mass, node) {
                    self.lumped.add(node, 0.5 * mass, &Mat3::zeros());
                }
            }
            if bar.mass == MassKind::Consistent {
                self.consistent.push(ConsistentMass::new(nodes, mass));
            }
        }
    }

    fn add_shell(&mut self, shell: &model::Shell) {
        let h = shell.plate.thickness;
        for element in &shell.elements {
            let nodes = &element.nodes[..shell.corners];
            let corners: Vec<Vec3> = nodes.iter().map(|&n| self.x[n]).collect();
            for (&node, area) in nodes.iter().zip(shell::shares(&corners)) {
                let mass = if self.lies(shell.mass, node) { shell.density * h * area } else { 0.0 };
                // The inertia about the normal is the same, where a director has none, so that no direction is without
                // inertia.
                let rotary = if self.turns(shell.mass, node) { shell.density * h.powi(3) / 12.0 * area } else { 0.0 };
                self.lumped.add(node, mass, &(rotary * Mat3::identity()));
            }
            if shell.mass == MassKind::Consistent {
                self.consistent.push(ConsistentMass::of_shell(nodes, &corners, shell.density * h));
            }
        }
    }
}

/// The blocks of like elements in the order of the parts; links share one block for lines and one for bushings. `plane`
/// is the normal of a plane motion.
pub fn groups(model: &Model, x: &[Vec3], plane: Option<usize>) -> (Vec<Group>, Vec<Watched>) {
    let beta = model.damping.stiffness_factor;
    let mut groups = Vec::new();
    let mut add = |block: Box<dyn ElementBlock>, part: usize, first| {
        if !block.is_empty() {
            groups.push(Group { block, kind: model.parts[part].kind(), part, first, history: 0..0 });
        }
    };
    let mut watched = Vec::new();
    for (place, part) in model.parts.iter().enumerate() {
        match part {
            Part::Beam(beam) => pieces(part.elements())
                .for_each(|piece| add(beams(beam, piece.clone(), model, x, beta, plane), place, piece.start)),
            Part::Bar(bar) => {
                pieces(part.elements()).for_each(|piece| add(bars(bar, piece.clone(), x, beta), place, piece.start));
            }
            Part::Shell(shell) => {
                pieces(part.elements()).for_each(|piece| add(shells(shell, piece.clone(), x, beta), place, piece.start))
            }
            // The first link stands for all.
            Part::Link(_) if watched.is_empty() => {
                let blocks;
                (blocks, watched) = links(model, x);
                blocks.into_iter().for_each(|block| add(block, place, 0));
            }
            Part::Link(_) => {}
            Part::Contact(contact) => {
                contacts(contact).into_iter().for_each(|(block, first)| add(block, place, first));
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

/// Divides elements into ranges for a group each, as equal as possible.
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
    let elements = part.elements[piece].iter().map(|e| BeamGeometry {
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
            FibreModel { fibres, ..yielding.clone() }.beams::<N>(elements, x, beta)
        }
    }
}

/// Whether a plane motion bends all elements of a part along local z (true) or y (false); `None` if it does neither.
pub fn in_plane(part: &model::Beam, plane: Option<usize>) -> Option<bool> {
    let normal = plane?;
    let across = |axis: usize| part.elements.iter().all(|e| e.frame[(normal, axis)].abs() > 1.0 - 1e-12);
    if across(1) { Some(true) } else { across(2).then_some(false) }
}

fn bars(part: &model::Bar, piece: Range<usize>, x: &[Vec3], beta: f64) -> Box<dyn ElementBlock> {
    let elements = &part.elements[piece];
    match &part.yielding {
        None => Box::new(bar::elastic_bars(elements, part.axial_stiffness, part.tension_only, part.free, x, beta)),
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
        .map(|e| shell::ShellGeometry { nodes: &e.nodes[..corners], normals: &e.normals[..corners] });
    match (&part.yielding, corners) {
        (None, 3) => Box::new(Triangles::new(elements, x, &part.plate, beta)),
        (None, _) => Box::new(Quadrilaterals::new(elements, x, &part.plate, beta)),
        (Some(yielding), 3) => yielding.shells::<Triangle, 3, 2, 3>(elements, x, &part.plate, beta),
        (Some(yielding), _) => yielding.shells::<Quadrilateral, 4, 3, 5>(elements, x, &part.plate, beta),
    }
}

/// The blocks of points with equally many nodes, with the number of the first point among those; none for a clearance
/// monitor.
fn contacts(contact: &model::Contact) -> Vec<(Box<dyn ElementBlock>, usize)> {
    let Some(law) = contact.law else { return Vec::new() };
    let mut blocks: Vec<(Box<dyn ElementBlock>, usize)> = Vec::new();
    for count in 1..=MOST_NODES {
        let points: Vec<ContactPoint> = contact.points.iter().filter(|point| point.count == count).cloned().collect();
        for piece in pieces(points.len()) {
            let block = Contacts::new(law, contact.surface.clone(), contact.node, points[piece.clone()].to_vec());
            blocks.push((Box::new(block), piece.start));
        }
    }
    blocks
}

fn links(model: &Model, x: &[Vec3]) -> ([Box<dyn ElementBlock>; 2], Vec<Watched>) {
    let mut lines = Vec::new();
    let mut bushings = Vec::new();
    let mut watched = Vec::new();
    for link in model.each::<model::Link>() {
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

/// The joints with the constraint equations that a plane motion needs.
pub fn joints(model: &Model, x: &[Vec3], plane: Option<usize>) -> Vec<Joint> {
    let joint = |joint: &model::Joint| {
        let d = x[joint.ends[0]] - x[joint.ends[1]];
        let says = |row: &&ConstraintEquation| plane.is_none_or(|normal| row.in_plane(normal, &d) != Some(false));
        Joint {
            nodes: joint.ends,
            equations: joint.equations.iter().filter(says).copied().collect(),
            supports: joint.supports,
        }
    };
    model.constraints.joints.iter().map(joint).collect()
}
