//! `[[loads]]` spread over shells and along their edges.

use super::data::{Load, Pressure};
use super::nodes::Topology;
use super::place::Place;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::shell_edges::{Edge, edges_of_shells};
use super::spot::Spot;
use super::values::{span, vec3_or_zero};
use crate::deck::loads as words;
use crate::deck::parts::PartIndex;
use crate::deck::words::Table;
use crate::diagnostic::At;
use crate::elements::pressure::Face;
use crate::elements::shell;
use crate::math::Vec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// A load spread over edges or shells, as forces on their nodes; a pressure that follows, as one on their faces.
pub(super) fn spread_load<'d>(
    scene: &Scene<'d>,
    load: &'d At<Table<words::Load>>,
    amplitude: Option<usize>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> (Vec<Load>, Option<Pressure>) {
    let owner = Owner::new("`[[loads]]`", &load.span);
    let unused = [("force", span(&load.force)), ("moment", span(&load.moment))];
    report.reject_unused("a load spread over shells", &unused);
    let follower = load.follower.as_ref().filter(|follower| follower.value);
    if let Some(at) = follower
        && (load.force_per_length.is_some() || load.force_per_area.is_some())
    {
        let hint = "give the load that keeps its direction a `[[loads]]` of its own";
        report.error_with::<()>(&at.span, "of loads spread over shells only `pressure` can follow", hint);
    }
    let Some(names) = report.require_nodes(&owner, "at", &load.at) else { return (Vec::new(), None) };
    if names.values.is_empty() {
        report.error::<()>(&names.span, "`at` is empty");
    }
    let pressure = load.pressure.as_ref().map_or(0.0, |pressure| pressure.value);
    let mut spread = Spread {
        line: load.force_per_length.as_ref().map(|_| vec3_or_zero(&load.force_per_length)),
        area: vec3_or_zero(&load.force_per_area),
        pressure,
        follows: follower.is_some(),
        scene,
        topology,
        edges: if load.force_per_length.is_some() { edges_of_shells(&scene.parts.list) } else { HashMap::new() },
        forces: BTreeMap::new(),
        faces: Vec::new(),
    };
    // A part named twice is loaded once, like nodes.
    let mut seen = HashSet::new();
    for name in &names.values {
        let Some(place) = scene.names.find(name, report) else { continue };
        if seen.insert(scene.names.surface_of(place).map_or(place, Place::Part)) {
            spread.over(place, name, report);
        }
    }
    let load = |(node, [force, moment]): (usize, [Vec3; 2])| Load { node, force, moment, follower: false, amplitude };
    let faces = spread.faces;
    let pressure = if faces.is_empty() { None } else { Some(Pressure { faces, pressure, amplitude }) };
    (spread.forces.into_iter().map(load).collect(), pressure)
}

struct Spread<'a, 'd> {
    /// Force per length; `None` for a load over areas.
    line: Option<Vec3>,
    /// Force per area.
    area: Vec3,
    pressure: f64,
    /// The pressure acts on the faces as they are at the moment.
    follows: bool,
    scene: &'a Scene<'d>,
    topology: &'a Topology,
    /// The edges of shells, for a load per length.
    edges: HashMap<[usize; 2], Edge>,
    /// Force and moment by node.
    forces: BTreeMap<usize, [Vec3; 2]>,
    faces: Vec<Face>,
}

impl<'d> Spread<'_, 'd> {
    fn over(&mut self, place: Place, name: &'d At<String>, report: &mut Report<'d>) {
        match (place, self.line) {
            (Place::Edge(surface, edge), Some(line)) => {
                let entry = self.scene.parts.entry(surface);
                let nodes = entry.and_then(|entry| entry.edges.get(edge)).map_or(&[][..], |nodes| nodes);
                nodes.windows(2).for_each(|pair| self.along([pair[0], pair[1]], line));
            }
            (Place::Group(_) | Place::Set(_), Some(line)) => {
                for pair in line_of(self.scene, place, name, self.topology, report) {
                    if !self.is_loose(pair, name, report) {
                        self.along(pair, line);
                    }
                }
            }
            _ => match self.scene.names.surface_of(place) {
                Some(surface) if self.line.is_none() => self.over_surface(surface),
                _ => {
                    let what = if self.line.is_some() { "edges of shells" } else { "shells" };
                    let message = format!("this load acts on {what}, and `{}` is {}", name.value, place.kind());
                    match place {
                        Place::Part(part) if part.kind.is_deformable() && !part.kind.is_surface() => {
                            let hint = "beams and bars take forces at points along them; gravity acts by itself";
                            report.error_with::<()>(&name.span, message, hint);
                        }
                        _ => {
                            report.error::<()>(&name.span, message);
                        }
                    }
                }
            },
        }
    }

    /// True where one of two nodes, which a list brought in under a name, is loose.
    fn is_loose(&self, pair: [usize; 2], name: &'d At<String>, report: &mut Report<'d>) -> bool {
        let spot = |node| Spot { node, name: self.scene.label(node, name), span: &name.span, direct: false };
        pair.iter().any(|&node| self.topology.is_loose(&spot(node), "this load", report))
    }

    /// Distributes the force on a segment to its ends in equal halves. The edge of a shell bulges by ½ r (1 − r) L (θ_a − θ_b) in
    /// its surface, on which the load does work too: moments about the normal at the ends, opposite to each other.
    fn along(&mut self, pair: [usize; 2], line: Vec3) {
        let along = self.topology.x(pair[1]) - self.topology.x(pair[0]);
        let edge = self.edges.get(&[pair[0].min(pair[1]), pair[0].max(pair[1])]);
        let moment = edge.map_or_else(Vec3::zeros, |edge| {
            edge.bulge * along.norm() / 12.0 * along.cross(&line).dot(&edge.normal) * edge.normal
        });
        for (node, moment) in pair.into_iter().zip([moment, -moment]) {
            let [force, sum] = self.forces.entry(node).or_default();
            *force += 0.5 * along.norm() * line;
            *sum += moment;
        }
    }

    fn over_surface(&mut self, surface: PartIndex) {
        for nodes in self.scene.parts.elements(surface) {
            if self.follows {
                self.faces.extend(Face::of(&nodes));
                continue;
            }
            let x: Vec<Vec3> = nodes.iter().map(|&node| self.topology.x(node)).collect();
            let parts = shell::shares(&x).into_iter().zip(shell::faces(&x));
            for (&node, (share, face)) in nodes.iter().zip(parts) {
                self.forces.entry(node).or_default()[0] += share * self.area - self.pressure * face;
            }
        }
    }
}

/// Pairs of nodes along which a load per length acts: the segments of a group, or edges of shells between nodes of a set,
/// those at the border if there are any.
fn line_of(
    scene: &Scene,
    place: Place,
    name: &At<String>,
    topology: &Topology,
    report: &mut Report,
) -> Vec<[usize; 2]> {
    if let Place::Group(group) = place {
        let segments = scene.names.mesh.group_segments(group);
        if !segments.is_empty() {
            return segments;
        }
    }
    let set: HashSet<usize> = scene.nodes_of(place).into_iter().collect();
    // Each edge between two of them, with the number of its faces; in order of first appearance.
    let (mut edges, mut places): (Vec<([usize; 2], usize)>, _) = (Vec::new(), HashMap::new());
    let mut whole = false;
    for surface in scene.deck.parts().filter(|part| part.at.kind.is_surface()) {
        for face in scene.parts.elements(surface.at) {
            whole |= face.iter().all(|node| set.contains(node));
            for (k, &a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                if set.contains(&a) && set.contains(&b) {
                    let next = edges.len();
                    let place = *places.entry([a.min(b), a.max(b)]).or_insert(next);
                    if place == next {
                        edges.push(([a, b], 0));
                    }
                    edges[place].1 += 1;
                }
            }
        }
    }
    let border: Vec<[usize; 2]> = edges.iter().filter(|edge| edge.1 == 1).map(|edge| edge.0).collect();
    if !border.is_empty() {
        return border;
    }
    if whole {
        let message = format!("`{}` contains whole elements, not the nodes of an edge alone", name.value);
        report.error_with::<()>(&name.span, message, "name the nodes along one line");
    } else if edges.is_empty() && topology.is_complete() {
        let message = format!("no edge of a shell lies between two nodes of `{}`", name.value);
        report.error_with::<()>(&name.span, message, "a load per length acts along edges of shells or segments");
    }
    edges.into_iter().map(|edge| edge.0).collect()
}
