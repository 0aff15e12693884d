//! Parts that touch without sharing a node: the deck draws them as one, and they move apart.

use std::collections::{HashMap, HashSet};

use crate::bodies::title;
use crate::data::PartIndex;
use crate::places::cells::Cells;
use crate::places::nodes::Topology;
use crate::plausibility::coincidence::{Coincidence, corners, lies_on, pieces};
use crate::plausibility::overlaps::{Overlap, overlaps};
use crate::plausibility::ties::Ties;
use crate::report::Report;
use crate::scene::Scene;
use base::diagnostic::Span;
use base::math::Vec3;

/// Warns once for each pair of parts that touch without a connection. The deck is sound.
pub fn check_unjoined(scene: &Scene, topology: &Topology, ties: Ties, report: &mut Report) {
    let pieces = pieces(scene);
    let Some(tolerance) = Coincidence::new(&pieces, topology) else { return };
    let mut of_node: Vec<Option<PartIndex>> = vec![None; topology.list.len()];
    for (part, nodes) in pieces.iter() {
        nodes.iter().for_each(|&node| of_node[node] = of_node[node].or(Some(*part)));
    }
    let bodies = scene.bodies.iter().enumerate().rev().map(|(index, body)| (body.node, index)).collect();
    let mut search =
        Search { scene, topology, ties, tolerance, of_node, bodies, found: Vec::new(), known: HashMap::new() };
    search.places();
    search.pieces(&pieces);
    search.report(report);
    let Search { mut ties, tolerance, found, .. } = search;
    let said: HashSet<[String; 2]> = found.iter().map(|touch| touch.pair.clone()).collect();
    for overlap in overlaps(topology, &mut ties, &tolerance, &pieces) {
        let [own, other] = overlap.parts.map(|part| title(scene.deck, part));
        if !said.contains(&[own.clone(), other.clone()]) && !said.contains(&[other.clone(), own.clone()]) {
            report_overlap(scene, &overlap, [&own, &other], report);
        }
    }
}

/// Warns of parts that lie along one another.
fn report_overlap(scene: &Scene, overlap: &Overlap, [own, other]: [&str; 2], report: &mut Report) {
    let place = scene.deck.part(overlap.parts[0]).map(|part| part.place());
    let message = match overlap.edges {
        1 => format!("an edge of {own} lies on {other}, and nothing holds the two together along it"),
        edges => format!("{edges} edges of {own} lie on {other}, and nothing holds the two together along them"),
    };
    let hint = "parts share the nodes of a mesh and points that both name, not those between: name points of both there, or tie \
                them with `[[ties]]`";
    report.warn(place.unwrap_or(&(0..0)), message, hint);
}

/// Two things that touch; the first node and how many.
struct Touch {
    node: usize,
    other: String,
    /// True where the node lies between the nodes of the other.
    between: bool,
    count: usize,
    /// The two by their names.
    pair: [String; 2],
}

struct Search<'a, 'd> {
    scene: &'a Scene<'d>,
    topology: &'a Topology,
    ties: Ties,
    tolerance: Coincidence,
    /// One of the parts of each node.
    of_node: Vec<Option<PartIndex>>,
    /// Indices of bodies by node.
    bodies: HashMap<usize, usize>,
    found: Vec<Touch>,
    /// Index in `found` by the names of the two and whether they meet between nodes.
    known: HashMap<([String; 2], bool), usize>,
}

impl Search<'_, '_> {
    /// True for nodes that the deck or the mesh names and something acts on. Nodes in between divide a path; two of them coincide where
    /// paths cross.
    fn is_end(&self, node: usize) -> bool {
        let named = self.topology.list[node].named || self.scene.names.mesh.id(node).is_some();
        named && (0..3).any(|dof| self.topology.is_connected(node, dof))
    }

    /// Two nodes at one place.
    fn places(&mut self) {
        let nodes = || 0..self.topology.list.len();
        let ends: Vec<(usize, Vec3)> =
            nodes().filter(|&node| self.is_end(node)).map(|node| (node, self.topology.x(node))).collect();
        let (reach, mut near) = (self.tolerance.same, Vec::new());
        let cells = Cells::new(4.0 * reach, self.tolerance.origin, ends.into_iter());
        for node in nodes() {
            let is_end = self.is_end(node);
            if !is_end && self.of_node[node].is_none() {
                continue;
            }
            let (x, margin) = (self.topology.x(node), Vec3::repeat(reach));
            near.clear();
            cells.visit_box(&(x - margin), &(x + margin), &mut |end| near.push(end));
            for &end in &near {
                let once = end != node && (!is_end || end < node);
                if once && (self.topology.x(end) - x).norm() <= reach && !self.ties.holds([end, node]) {
                    self.meet(end, node, None);
                }
            }
        }
    }

    /// Nodes on elements that are not theirs.
    fn pieces(&mut self, pieces: &[(PartIndex, Vec<usize>)]) {
        let nodes = 0..self.topology.list.len();
        let ends = nodes.filter(|&node| self.is_end(node)).map(|node| (node, self.topology.x(node)));
        let (reach, mut near) = (self.tolerance.same, Vec::new());
        let cells = Cells::new(self.tolerance.cell, self.tolerance.origin, ends);
        for (part, nodes) in pieces {
            let x: Vec<Vec3> = corners(*part, nodes).iter().map(|&node| self.topology.x(node)).collect();
            near.clear();
            cells.visit_along(&x, reach, &mut |end| {
                if !nodes.contains(&end) {
                    near.push(end);
                }
            });
            near.sort_unstable();
            near.dedup();
            for &end in &near {
                let at = self.topology.x(end);
                let inside = lies_on(&at, &x, reach);
                let is_node = || nodes.iter().any(|&node| (self.topology.x(node) - at).norm() <= reach);
                if inside && !is_node() && !nodes.iter().any(|&node| self.ties.holds([end, node])) {
                    self.meet(end, nodes[0], Some(*part));
                }
            }
        }
    }

    /// Notes that a node touches another one, or a part between its nodes.
    fn meet(&mut self, end: usize, node: usize, between: Option<PartIndex>) {
        let rests = |node: usize| (0..3).all(|dof| self.topology.restraint(node, dof).is_some());
        // A fixed node outside all parts, such as the ground end of a link, may lie on a moving part.
        if rests(end) && self.of_node[end].is_none() {
            return;
        }
        let own = self.name(end, None);
        let other = match (between, self.of_node[node]) {
            (Some(_), _) => self.name(node, between),
            (None, Some(_)) if self.is_end(node) => {
                format!("`{}` of {}", self.topology.label(node), self.name(node, None))
            }
            (None, Some(_)) => format!("a node of {}", self.name(node, None)),
            (None, None) => self.name(node, None),
        };
        let next = self.found.len();
        let names = [own, self.name(node, between)];
        let index = *self.known.entry((names.clone(), between.is_some())).or_insert(next);
        if index == next {
            self.found.push(Touch { node: end, other, between: between.is_some(), count: 1, pair: names });
        } else {
            self.found[index].count += 1;
        }
    }

    /// "beam `a`", the part of a node; or else its body or point.
    fn name(&self, node: usize, part: Option<PartIndex>) -> String {
        match part.or(self.of_node[node]) {
            Some(part) => title(self.scene.deck, part),
            None if self.bodies.contains_key(&node) => {
                format!("body `{}`", self.topology.label(node))
            }
            None => format!("point `{}`", self.topology.label(node)),
        }
    }

    fn report(&self, report: &mut Report) {
        for Touch { node, other, between, count, .. } in &self.found {
            let (label, own) = (self.topology.label(*node), self.name(*node, None));
            let of = if own.ends_with(&format!("`{label}`")) { String::new() } else { format!(" of {own}") };
            let more = match count - 1 {
                0 => String::new(),
                more => format!(" (and {more} more)"),
            };
            let how = match between {
                true => format!("lies on {other}, between its nodes"),
                false => format!("lies at the same place as {other}"),
            };
            let message = format!("`{label}`{of} {how}{more}, and nothing holds the two together");
            let hint = match between {
                true => {
                    "make it a point of the path or a node of the mesh of both, or join them with `[[ties]]` or `[[joints]]`"
                }
                false => {
                    "name the same point in both, or join them with `[[joints]]`, `[[attachments]]` or, on a shell, `[[ties]]`"
                }
            };
            report.warn(self.place(*node), message, hint);
        }
    }

    /// Where the deck names a node, or its part.
    fn place(&self, node: usize) -> &Span {
        let deck = self.scene.deck;
        let point = deck.points.0.get(node).map(|(name, _)| &name.span);
        let part = || self.of_node[node].and_then(|part| deck.part(part)).map(|part| part.place());
        let body = || Some(&deck.bodies.get(*self.bodies.get(&node)?)?.span);
        point.or_else(part).or_else(body).unwrap_or(&(0..0))
    }
}
