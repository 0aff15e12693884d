//! `[[loads]]` spread over shells, along their edges, and along beams and bars.

use crate::data::{Load, LoadOrigin, Part, Pressure};
use crate::group_names::{GroupChoice, GroupPlace};
use crate::loads::per_length::{LineLoad, is_chain};
use crate::places::nodes::Topology;
use crate::places::place::Place;
use crate::places::spot::Spot;
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::shells::edges::{Edge, edges_of_shells};
use crate::values::{flag, keys, span, vec3, vec3_or_zero};
use base::diagnostic::At;
use base::math::{Vec3, curved_faces, quadrature};
use deck::loads as words;
use deck::parts::PartIndex;
use deck::words::{Names, Table};
use mechanics::elements::pressure::Face;
use mechanics::elements::shell;
use std::cell::OnceCell;
use std::collections::{BTreeMap, HashMap, HashSet};

/// The elements under spread loads by their nodes, each table made for the first load that needs it.
#[derive(Default)]
pub struct ElementsByNodes {
    /// Elements of beams and bars by their ends in ascending order, as parts and elements.
    lines: OnceCell<HashMap<[usize; 2], (usize, usize)>>,
    /// The edges of shells by their ends in ascending order.
    edges: OnceCell<HashMap<[usize; 2], Edge>>,
    /// The nodes of all faces of shells, by their corners in ascending order.
    faces: OnceCell<HashMap<Vec<usize>, Vec<usize>>>,
}

impl ElementsByNodes {
    fn lines(&self, scene: &Scene) -> &HashMap<[usize; 2], (usize, usize)> {
        self.lines.get_or_init(|| elements_by_ends(&scene.parts.list))
    }

    fn edges(&self, scene: &Scene) -> &HashMap<[usize; 2], Edge> {
        self.edges.get_or_init(|| edges_by_name(scene))
    }
}

/// A load spread over shells, edges or lines, as forces on their nodes; a pressure that follows, as one on their faces.
pub fn spread_load<'d>(
    scene: &Scene<'d>,
    load: &'d At<Table<words::Load>>,
    amplitude: Option<usize>,
    (topology, elements): (&Topology, &ElementsByNodes),
    report: &mut Report<'d>,
) -> (Vec<Load>, Option<Pressure>) {
    let owner = Owner::new("`[[loads]]`", &load.span);
    let unused = keys!(load; force, moment);
    report.reject_unused("a spread load", &unused);
    let follower = load.follower.as_ref().filter(|follower| follower.value);
    if let Some(at) = follower
        && load.force_per_area.is_some()
    {
        let hint = "give the load that keeps its direction a separate entry of `[[loads]]`";
        report.error_with::<()>(&at.span, "of loads spread over shells only `pressure` can follow", hint);
    }
    let Some(names) = names_of(load, &owner, report) else { return (Vec::new(), None) };
    let pressure = load.pressure.as_ref().map_or(0.0, |pressure| pressure.value);
    let mut spread = Spread {
        words: load,
        line: line_load(load, amplitude, report),
        elements,
        area: vec3_or_zero(&load.force_per_area),
        pressure,
        follows: follower.is_some(),
        scene,
        topology,
        forces: BTreeMap::new(),
        faces: Vec::new(),
        shares: Vec::new(),
        seen: HashSet::new(),
        seen_faces: HashSet::new(),
    };
    for name in &names.values {
        let Some(place) = scene.names.find(name, report) else { continue };
        if spread.seen.insert(scene.names.surface_of(place).map_or(place, Place::Part)) {
            spread.over(place, name, report);
        }
    }
    let load = |(node, [force, moment]): (usize, [Vec3; 2])| Load {
        node,
        force,
        moment,
        follower: false,
        amplitude,
        origin: Some(LoadOrigin::Spread),
        moment_counts: false,
    };
    let faces = spread.faces;
    let pressure = if faces.is_empty() { None } else { Some(Pressure { faces, pressure, amplitude }) };
    (spread.forces.into_iter().map(load).chain(spread.shares).collect(), pressure)
}

/// The names under the spread load, by `at` or `part`.
fn names_of<'d>(load: &'d words::Load, owner: &Owner, report: &mut Report<'d>) -> Option<&'d At<Names>> {
    let (key, names) = if load.part.is_some() { ("part", &load.part) } else { ("at", &load.at) };
    if let (Some(_), Some(part)) = (&load.at, &load.part) {
        report.error::<()>(&part.span, "a load takes `at` or `part`, not both");
    }
    let names = report.require_nodes(owner, key, names)?;
    if names.values.is_empty() {
        report.error::<()>(&names.span, format!("`{key}` is empty"));
    }
    Some(names)
}

/// Reads a load per length; `None` where it is one over areas.
fn line_load(load: &words::Load, amplitude: Option<usize>, report: &mut Report) -> Option<LineLoad> {
    let given = load.force_per_length.as_ref().or(load.local.as_ref());
    let keys = keys!(load; projected, profile);
    if given.is_none() {
        report.reject_unused("a load over areas", &keys);
    } else if let Some(at) = [span(&load.pressure), span(&load.force_per_area)].into_iter().flatten().next() {
        report.error::<()>(at, "a load acts per length or per area, not both: give two entries of `[[loads]]`");
    }
    if let (Some(_), Some(local)) = (&load.force_per_length, &load.local) {
        report.error::<()>(&local.span, "a load takes `force_per_length` or `local`, not both");
    }
    if let (Some(_), Some(projected)) = (&load.local, &load.projected) {
        report.error_with::<()>(
            &projected.span,
            "a load in section axes has no projected length",
            "give `force_per_length` in place of `local`",
        );
    }
    let profile = load.profile.as_ref().and_then(|points| report.rising("profile", "fractions of the length", points));
    let outside = |points: &&Vec<[f64; 2]>| points.iter().any(|point| !(0.0..=1.0).contains(&point[0]));
    if let (Some(at), Some(_)) = (&load.profile, profile.as_ref().filter(outside)) {
        report.error::<()>(&at.span, "the fractions of `profile` lie between 0, the start of the part, and 1, its end");
    }
    given.map(|given| LineLoad {
        force: vec3(given),
        local: load.local.is_some(),
        projected: flag(&load.projected, false),
        follower: flag(&load.follower, false),
        profile: profile.unwrap_or_else(|| vec![[0.0, 1.0], [1.0, 1.0]]),
        amplitude,
    })
}

/// The edges of all shells, of those beside their nodes by the nodes that carry them too.
fn edges_by_name(scene: &Scene) -> HashMap<[usize; 2], Edge> {
    let mut edges = edges_of_shells(&scene.parts.list);
    for carried in scene.parts.entries().map(|(_, entry)| &entry.carried).filter(|carried| !carried.is_empty()) {
        let more = edges.iter().filter_map(|(&[a, b], edge)| {
            let name = |node: usize| carried.get(&node).copied();
            let (a, b) = (name(a)?, name(b)?);
            let curve = edge.curve.map(|(nodes, range)| (nodes.map(|node| name(node).unwrap_or(node)), range));
            Some(([a.min(b), a.max(b)], Edge { curve, ..*edge }))
        });
        let more: Vec<_> = more.collect();
        more.into_iter().for_each(|(ends, edge)| {
            edges.entry(ends).or_insert(edge);
        });
    }
    edges
}

/// The elements of beams and bars by their end nodes, in ascending order.
fn elements_by_ends(parts: &[Part]) -> HashMap<[usize; 2], (usize, usize)> {
    let is_line = |part: &Part| part.kind().is_line();
    let mut found = HashMap::new();
    for (index, part) in parts.iter().enumerate().filter(|(_, part)| is_line(part)) {
        for element in 0..part.elements() {
            if let [a, .., b] = *part.nodes(element) {
                found.entry([a.min(b), a.max(b)]).or_insert((index, element));
            }
        }
    }
    found
}

/// True for a beam or a bar.
fn is_line(part: PartIndex) -> bool {
    part.kind.is_line()
}

struct Spread<'a, 'd> {
    /// The load as the deck gives it.
    words: &'d words::Load,
    /// A load per length; `None` for one over areas.
    line: Option<LineLoad>,
    elements: &'a ElementsByNodes,
    /// Force per area.
    area: Vec3,
    pressure: f64,
    /// True where the pressure follows the deformed faces.
    follows: bool,
    scene: &'a Scene<'d>,
    topology: &'a Topology,
    /// Force and moment by node.
    forces: BTreeMap<usize, [Vec3; 2]>,
    faces: Vec<Face>,
    /// Shares on the nodes of beams and bars.
    shares: Vec<Load>,
    /// Places already loaded: a part named twice is loaded once, like nodes.
    seen: HashSet<Place>,
    /// Faces already loaded, by their corners in ascending order.
    seen_faces: HashSet<Vec<usize>>,
}

impl<'d> Spread<'_, 'd> {
    fn over(&mut self, place: Place, name: &'d At<String>, report: &mut Report<'d>) {
        match (place, &self.line) {
            (Place::Edge(surface, edge), Some(_)) => {
                let entry = self.scene.parts.entry(surface);
                let nodes = entry.and_then(|entry| entry.edges.get(edge)).map_or(&[][..], |nodes| nodes);
                if self.acts_on_edges(name, report) {
                    nodes.windows(2).for_each(|pair| self.load_edge([pair[0], pair[1]]));
                }
            }
            (Place::Part(_) | Place::Body(_), Some(_)) if self.line_of(place).is_some() => {
                self.line_of(place).into_iter().for_each(|part| self.load_part(part, name, report));
            }
            (Place::Set(_), line) if line.is_none() || self.is_of_members(place) => {
                for leaf in self.scene.names.leaves(place) {
                    if self.seen.insert(leaf) {
                        self.over(leaf, name, report);
                    }
                }
            }
            (Place::Group(_) | Place::Set(_), Some(_)) => {
                let pairs = line_of(self.scene, place, name, self.topology, report);
                self.load_segments(&pairs, name, report);
            }
            _ => match (self.scene.names.surface_of(place), place) {
                (Some(surface), _) if self.line.is_none() => self.over_surface(surface),
                (None, Place::Group(GroupPlace { faces: GroupChoice::One(group), .. })) => {
                    self.over_group(group as usize, name, report);
                }
                _ => {
                    let what = if self.line.is_some() { "beams, bars and edges of shells" } else { "shells" };
                    let message = format!("this load acts on {what}, and `{}` is {}", name.value, place.kind());
                    match place {
                        Place::Part(part) if is_line(part) => {
                            let hint = "beams and bars take `force_per_length`; gravity acts without an entry";
                            report.error_with::<()>(&name.span, message, hint);
                        }
                        Place::Body(_) => {
                            let hint = "a rigid part takes the `force` and `moment` of the whole load";
                            report.error_with::<()>(&name.span, message, hint);
                        }
                        _ => {
                            report.error_with::<()>(&name.span, message, format!("name one of the {what}"));
                        }
                    }
                }
            },
        }
    }

    /// True for a set of beams, bars, shells and their edges alone: each member is loaded or refused separately. A set with nodes is the
    /// line between them.
    fn is_of_members(&self, set: Place) -> bool {
        let leaves = self.scene.names.leaves(set);
        let is_member = |leaf: &Place| matches!(leaf, Place::Part(_) | Place::Body(_) | Place::Edge(..));
        !leaves.is_empty() && leaves.iter().all(is_member)
    }

    /// The beam or bar that a place is, a rigid one too.
    fn line_of(&self, place: Place) -> Option<PartIndex> {
        match place {
            Place::Part(_) | Place::Body(_) => self.scene.names.line_of(place),
            _ => None,
        }
    }

    /// Distributes a load per length over a beam or bar; over one that is rigid in equal halves to the ends of its elements.
    fn load_part(&mut self, at: PartIndex, name: &'d At<String>, report: &mut Report<'d>) {
        let Some(line) = &self.line else { return };
        let parts = &self.scene.parts;
        let Some(entry) = parts.entry(at) else { return };
        if entry.rigid_elements.is_some() {
            if self.acts_on_edges(name, report) {
                parts.elements(at).iter().for_each(|nodes| self.load_edge([nodes[0], nodes[nodes.len() - 1]]));
            }
            return;
        }
        let has_axes = |part: &Part| part.line(0, 1.0, &parts.stiffnesses).is_some_and(|line| line.axes.is_some());
        if !parts.of(at).iter().all(has_axes) {
            let without = keys!(self.words; local, follower);
            report.reject_unused("a load on a bar, which has no axes", &without);
        }
        for index in entry.range.clone() {
            let part = &parts.list[index];
            if let Some(at) = self.words.profile.as_ref().filter(|_| !is_chain(part)) {
                let hint = "the order of its elements is that of a group of the mesh";
                let message = format!("`profile` goes along a line, and the elements of `{}` are none", name.value);
                report.error_with::<()>(&at.span, message, hint);
            }
            self.shares.extend(line.over_part(part, index, (self.topology, &parts.stiffnesses)));
        }
    }

    /// Distributes a load per length over segments of a group: elements of beams and bars, edges of shells.
    fn load_segments(&mut self, pairs: &[[usize; 2]], name: &'d At<String>, report: &mut Report<'d>) {
        let Some(line) = &self.line else { return };
        let parts = &self.scene.parts;
        let scene = (self.topology, &parts.stiffnesses[..]);
        let (shell_edges, mut edges) = (self.elements.edges(self.scene), Vec::new());
        for &[a, b] in pairs {
            let ends = [a.min(b), a.max(b)];
            match self.elements.lines(self.scene).get(&ends).filter(|_| !shell_edges.contains_key(&ends)) {
                Some(&element) => self.shares.extend(line.over_element(&parts.list[element.0], element, scene)),
                None => edges.push([a, b]),
            }
        }
        let without = keys!(self.words; profile);
        report.reject_unused("a load on segments of a group", &without);
        if edges.is_empty() || !self.acts_on_edges(name, report) {
            return;
        }
        for pair in edges {
            if !self.is_loose(pair, name, report) {
                self.load_edge(pair);
            }
        }
    }

    /// False, with an error, where the load has keys for beams only.
    fn acts_on_edges(&self, name: &'d At<String>, report: &mut Report<'d>) -> bool {
        let words = self.words;
        let follower = words.follower.as_ref().filter(|follower| follower.value).map(|at| &at.span);
        let keys = keys!(words; local, projected, profile);
        let wrong = keys.into_iter().chain([("follower", follower)]).find_map(|(key, at)| Some((key, at?)));
        let Some((key, at)) = wrong else { return true };
        let message =
            format!("`{key}` of a load per length is for beams, and `{}` holds edges or rigid parts", name.value);
        report.error_with::<()>(at, message, "give the load of the edges a separate entry of `[[loads]]`");
        false
    }

    /// True if one of two nodes of a list is not connected.
    fn is_loose(&self, pair: [usize; 2], name: &'d At<String>, report: &mut Report<'d>) -> bool {
        let spot = |node| Spot { node, name: self.scene.label(node, name), span: &name.span, direct: false };
        pair.iter().any(|&node| self.topology.is_loose(&spot(node), "this load", report))
    }

    /// Distributes the force on a segment to its ends in equal halves. The edge of a shell bulges by ½ r (1 − r) L (θ_a − θ_b) in its
    /// surface. The load does work on it too: opposite moments about the normal at the ends.
    fn load_edge(&mut self, pair: [usize; 2]) {
        let Some(line) = self.line.as_ref().map(|line| line.force) else { return };
        let along = self.topology.x(pair[1]) - self.topology.x(pair[0]);
        let edge = self.elements.edges(self.scene).get(&[pair[0].min(pair[1]), pair[0].max(pair[1])]);
        if let Some((nodes, part)) = edge.and_then(|edge| edge.curve) {
            return self.load_curve(nodes, part, &line);
        }
        let moment = edge.map_or_else(Vec3::zeros, |edge| {
            edge.bulge * along.norm() / 12.0 * along.cross(&line).dot(&edge.normal) * edge.normal
        });
        for (node, moment) in pair.into_iter().zip([moment, -moment]) {
            let [force, sum] = self.forces.entry(node).or_default();
            *force += 0.5 * along.norm() * line;
            *sum += moment;
        }
    }

    /// Distributes the force on a part of a curved edge to its nodes, by the work that it does between them.
    fn load_curve(&mut self, nodes: [usize; 3], [begin, end]: [f64; 2], line: &Vec3) {
        let x = nodes.map(|node| self.topology.x(node));
        let half = 0.5 * (end - begin);
        let (points, weights) = quadrature::gauss(4);
        for (point, w) in points.iter().zip(weights) {
            let r = begin + half * (1.0 + point);
            let values = [0.5 * r * (r - 1.0), 0.5 * r * (r + 1.0), 1.0 - r * r];
            let slope: Vec3 = (r - 0.5) * x[0] + (r + 0.5) * x[1] - 2.0 * r * x[2];
            for (node, value) in nodes.into_iter().zip(values) {
                self.forces.entry(node).or_default()[0] += w * half * value * slope.norm() * line;
            }
        }
    }

    fn over_surface(&mut self, surface: PartIndex) {
        self.scene.parts.elements_by_name(surface).iter().for_each(|nodes| self.load_face(nodes));
    }

    /// Distributes the load over the faces of shells in a group of the mesh.
    fn over_group(&mut self, group: usize, name: &'d At<String>, report: &mut Report<'d>) {
        let all = self.elements.faces.get_or_init(|| faces_by_corners(self.scene));
        let faces = self.scene.names.mesh.group_faces(group);
        let of_shells: Vec<&Vec<usize>> = faces.iter().filter_map(|corners| all.get(&sorted(corners))).collect();
        of_shells.iter().for_each(|nodes| self.load_face(nodes));
        let without = faces.len() - of_shells.len();
        if without > 0 && self.topology.is_complete() {
            let message = format!("{without} of the {} faces of `{}` are in no shell", faces.len(), name.value);
            report.error_with::<()>(
                &name.span,
                message,
                "loads per area act on shells: make one of the group with all",
            );
        }
    }

    /// Distributes the load over a face, once.
    fn load_face(&mut self, nodes: &[usize]) {
        if !self.seen_faces.insert(corners(nodes)) {
            return;
        }
        if self.follows {
            self.faces.extend(Face::of(nodes));
            return;
        }
        let x: Vec<Vec3> = nodes.iter().map(|&node| self.topology.x(node)).collect();
        let parts = shell::shares(&x).into_iter().zip(shell::faces(&x));
        for (&node, (share, face)) in nodes.iter().zip(parts) {
            self.forces.entry(node).or_default()[0] += share * self.area - self.pressure * face;
        }
    }
}

/// The nodes of all faces of shells by their corners.
fn faces_by_corners(scene: &Scene) -> HashMap<Vec<usize>, Vec<usize>> {
    let surfaces = scene.deck.parts().filter(|part| part.at.kind.is_surface());
    let faces = surfaces.flat_map(|part| scene.parts.elements_by_name(part.at));
    faces.map(|nodes| (corners(&nodes), nodes)).collect()
}

/// The corners of a face of shells in ascending order.
fn corners(nodes: &[usize]) -> Vec<usize> {
    sorted(&nodes[..if nodes.len().is_multiple_of(3) && nodes.len() < 9 { 3 } else { 4 }])
}

/// Nodes in ascending order.
fn sorted(nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

/// Pairs of nodes under a load per length: the segments of a group, or edges of shells between nodes of a set. Border edges are preferred.
fn line_of(
    scene: &Scene,
    place: Place,
    name: &At<String>,
    topology: &Topology,
    report: &mut Report,
) -> Vec<[usize; 2]> {
    if let Place::Group(group) = place
        && let Some(group) = group.lines.one()
    {
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
        for face in scene.parts.elements_by_name(surface.at) {
            whole |= face.iter().all(|node| set.contains(node));
            let round: Vec<usize> = curved_faces::ring(face.len()).map(|k| face[k]).collect();
            for (k, &a) in round.iter().enumerate() {
                let b = round[(k + 1) % round.len()];
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
        report.error_with::<()>(
            &name.span,
            message,
            "a load per length acts along beams, bars, edges of shells or segments",
        );
    }
    edges.into_iter().map(|edge| edge.0).collect()
}
