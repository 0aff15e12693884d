//! Parts that lie along one another without sharing the nodes between: a stiffener on an edge, two beams on one path.
//!
//! An edge of an element lies on another part where its ends and its middle do. Parts that cross have one place in common, and no
//! edge. Bars carry forces between their ends only, and run through other parts as cables do.

use crate::data::{PartIndex, PartKind};
use crate::places::cells::Cells;
use crate::places::nodes::Topology;
use crate::plausibility::coincidence::{Coincidence, corners, lies_on};
use crate::plausibility::ties::Ties;
use base::math::Vec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Two parts, one lying on the other.
pub struct Overlap {
    pub parts: [PartIndex; 2],
    /// How many edges of the first lie on the second.
    pub edges: usize,
}

type Piece = (PartIndex, Vec<usize>);

/// All pairs of parts with edges lying on each other, and an end there that is not connected to the other. Each pair once, by the part with
/// more such edges.
pub fn overlaps(topology: &Topology, ties: &mut Ties, tolerance: &Coincidence, pieces: &[Piece]) -> Vec<Overlap> {
    let pieces: Vec<&Piece> = pieces.iter().filter(|(part, _)| part.kind != PartKind::Bar).collect();
    if pieces.first().is_none_or(|(first, _)| pieces.iter().all(|(part, _)| part == first)) {
        return Vec::new();
    }
    let edges = edges(&pieces);
    let found = Places::new(topology, ties, tolerance, &pieces, &edges);
    let mut counts: BTreeMap<[PartIndex; 2], usize> = BTreeMap::new();
    for (number, (part, ends)) in edges.iter().enumerate() {
        for other in found.on.get(&(topology.list.len() + number)).into_iter().flatten() {
            let lies = |end: &usize| found.lies_on(*end, *other);
            if ends.iter().all(lies) && ends.iter().any(|&end| found.loose.contains(&(end, *other))) {
                *counts.entry([*part, *other]).or_default() += 1;
            }
        }
    }
    let more = |[a, b]: [PartIndex; 2], edges: usize| match counts.get(&[b, a]) {
        Some(&back) => edges > back || edges == back && a < b,
        None => true,
    };
    counts
        .iter()
        .filter(|(pair, edges)| more(**pair, **edges))
        .map(|(&parts, &edges)| Overlap { parts, edges })
        .collect()
}

/// The edges of all elements with their parts, each once.
fn edges(pieces: &[&Piece]) -> Vec<(PartIndex, [usize; 2])> {
    let mut edges = Vec::new();
    for (part, nodes) in pieces {
        let corners = corners(*part, nodes);
        let sides = if corners.len() > 2 { corners.len() } else { 1 };
        edges.extend((0..sides).map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
            (*part, [a.min(b), a.max(b)])
        }));
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Nodes, then the middles of edges, and the parts on which they lie.
struct Places {
    /// Nodes of parts.
    own: HashSet<(usize, PartIndex)>,
    /// Other parts on which a place lies.
    on: HashMap<usize, Vec<PartIndex>>,
    /// Nodes that lie on another part and are not held to it.
    loose: HashSet<(usize, PartIndex)>,
}

impl Places {
    fn new(
        topology: &Topology,
        ties: &mut Ties,
        tolerance: &Coincidence,
        pieces: &[&Piece],
        edges: &[(PartIndex, [usize; 2])],
    ) -> Places {
        let (count, reach) = (topology.list.len(), tolerance.same);
        let own: HashSet<(usize, PartIndex)> =
            pieces.iter().flat_map(|(part, nodes)| nodes.iter().map(|&node| (node, *part))).collect();
        let mut places = Places { own, on: HashMap::new(), loose: HashSet::new() };
        let middle = |[a, b]: [usize; 2]| 0.5 * (topology.x(a) + topology.x(b));
        let at = |place: usize| if place < count { topology.x(place) } else { middle(edges[place - count].1) };
        let nodes: HashSet<usize> = places.own.iter().map(|&(node, _)| node).collect();
        let all = nodes.into_iter().chain(count..count + edges.len()).map(|place| (place, at(place)));
        let cells = Cells::new(tolerance.cell, tolerance.origin, all);
        let mut near = Vec::new();
        for (part, nodes) in pieces {
            let x: Vec<Vec3> = corners(*part, nodes).iter().map(|&node| topology.x(node)).collect();
            near.clear();
            cells.visit_along(&x, reach, &mut |place| near.push(place));
            near.sort_unstable();
            near.dedup();
            for &place in &near {
                let is_own = match place.checked_sub(count) {
                    Some(edge) => edges[edge].0 == *part,
                    None => places.own.contains(&(place, *part)),
                };
                let x_at = at(place);
                let is_corner = || x.iter().any(|corner| (corner - x_at).norm() <= reach);
                if is_own || !lies_on(&x_at, &x, reach) && !is_corner() {
                    continue;
                }
                let on = places.on.entry(place).or_default();
                if !on.contains(part) {
                    on.push(*part);
                }
                if place < count && !nodes.iter().any(|&node| ties.holds([place, node])) {
                    places.loose.insert((place, *part));
                }
            }
        }
        places
    }

    fn lies_on(&self, node: usize, part: PartIndex) -> bool {
        self.own.contains(&(node, part)) || self.on.get(&node).is_some_and(|on| on.contains(&part))
    }
}
