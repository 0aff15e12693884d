//! Connectivity of the facets of a surface: its free edges, the orientation of its sides, and the facets near along it.

use super::facet::Facet;
use base::math::Vec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// For the two nodes of each edge: its facets, with the edge's index in each.
type FacetEdges = HashMap<[usize; 2], Vec<(usize, usize)>>;

fn edges_of(facets: &[Facet]) -> FacetEdges {
    let mut edges = FacetEdges::new();
    for (number, facet) in facets.iter().enumerate().filter(|(_, facet)| facet.has_sides()) {
        for k in 0..facet.corners {
            edges.entry(edge(facet, k)).or_default().push((number, k));
        }
    }
    edges
}

/// The free edges of a surface (with one facet each), by their nodes and in the order of the facets.
pub fn free_edges(facets: &[Facet]) -> Vec<[usize; 2]> {
    let edges = edges_of(facets);
    let of_facet = |facet: &Facet| (0..facet.corners).map(|k| edge(facet, k)).collect::<Vec<_>>();
    facets.iter().flat_map(of_facet).filter(|nodes| edges.get(nodes).is_some_and(|of| of.len() == 1)).collect()
}

/// Finds the free edges of a surface, and turns its facets so that neighbours face the same way.
pub fn connect(facets: &mut [Facet]) {
    let edges = edges_of(facets);
    let mut free_nodes: HashSet<usize> = HashSet::new();
    for (nodes, sides) in &edges {
        if let [(number, k)] = sides[..] {
            facets[number].free_edges[k] = true;
            free_nodes.extend(nodes);
        }
    }
    for facet in facets.iter_mut() {
        for k in 0..facet.corners {
            facet.free_nodes[k] = free_nodes.contains(&facet.nodes[k]);
        }
    }
    let mut is_seen = vec![false; facets.len()];
    let mut ahead = Vec::new();
    for first in 0..facets.len() {
        ahead.push(first);
        while let Some(number) = ahead.pop() {
            if std::mem::replace(&mut is_seen[number], true) || !facets[number].has_sides() {
                continue;
            }
            for k in 0..facets[number].corners {
                for &(other, l) in edges.get(&edge(&facets[number], k)).into_iter().flatten() {
                    if !is_seen[other] {
                        // Two that face the same way run along their edge in opposite directions.
                        let same = facets[number].nodes[k] == facets[other].nodes[l];
                        facets[other].is_turned = facets[number].is_turned != same;
                        ahead.push(other);
                    }
                }
            }
        }
    }
}

fn edge(facet: &Facet, k: usize) -> [usize; 2] {
    let mut ends = [facet.nodes[k], facet.nodes[(k + 1) % facet.corners]];
    ends.sort_unstable();
    ends
}

/// For each of `nodes`, the facets excluded from contact by folding: those within `distance` along the surface. `x` are the places at t =
/// 0.
pub fn near_along(
    facets: &[Facet],
    nodes: &[usize],
    distance: impl Fn(usize, &Facet) -> f64,
    x: &dyn Fn(usize) -> Vec3,
) -> Vec<Vec<u32>> {
    let mut around: HashMap<usize, Vec<usize>> = HashMap::new();
    for (number, facet) in facets.iter().enumerate() {
        facet.nodes().iter().for_each(|&node| around.entry(node).or_default().push(number));
    }
    let found = nodes.iter().enumerate().map(|(k, &start)| {
        // The reach of Dijkstra's search along edges and diagonals; few nodes lie in it.
        let mut reached: BTreeMap<usize, f64> = BTreeMap::from([(start, 0.0)]);
        let mut ahead = vec![start];
        let mut near = Vec::new();
        while let Some(node) = ahead.pop() {
            let way = reached[&node];
            for &number in around.get(&node).into_iter().flatten() {
                if way > distance(k, &facets[number]) {
                    continue;
                }
                near.push(number as u32);
                for &other in facets[number].nodes() {
                    let longer = way + (x(other) - x(node)).norm();
                    if reached.get(&other).is_none_or(|known| longer < *known) {
                        reached.insert(other, longer);
                        ahead.push(other);
                    }
                }
            }
        }
        near.sort_unstable();
        near.dedup();
        near
    });
    found.collect()
}
