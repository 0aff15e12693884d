//! Places between the nodes of elements, as weighted sums of these.

use super::part_answers::NodeWeights;
use base::math::curved_faces::{self, CurvedFace, NineNodes, SixNodes, facets};
use base::math::quadrature;
use std::collections::HashSet;

/// So many places between neighbouring nodes of lines, by the nodes of each.
pub fn along_lines<'a>(elements: impl Iterator<Item = &'a [usize]>, count: usize) -> Vec<NodeWeights> {
    let mut places = Vec::new();
    for nodes in elements {
        let (at_nodes, _) = quadrature::lobatto(nodes.len());
        for pair in at_nodes.windows(2) {
            places.extend((1..=count).map(|k| {
                let at = pair[0] + (pair[1] - pair[0]) * k as f64 / (count + 1) as f64;
                nodes.iter().copied().zip(quadrature::lagrange(at_nodes, at)).collect::<NodeWeights>()
            }));
        }
    }
    places
}

/// Places between the nodes of faces, so many on each side and as dense within.
pub fn over_faces<'a>(elements: impl Iterator<Item = &'a [usize]>, count: usize) -> Vec<NodeWeights> {
    let (mut edges, mut places) = (HashSet::new(), Vec::new());
    for nodes in elements {
        match nodes.len() {
            6 => curved_lattice::<SixNodes, 6>(nodes, count, &mut edges, &mut places),
            9 => curved_lattice::<NineNodes, 9>(nodes, count, &mut edges, &mut places),
            _ => lattice(nodes, count, &mut edges, &mut places),
        }
    }
    places
}

/// A lattice within an element and on those of its edges that are not in `edges` yet.
fn lattice(nodes: &[usize], between: usize, edges: &mut HashSet<[usize; 2]>, places: &mut Vec<NodeWeights>) {
    let (count, parts) = (nodes.len(), between + 1);
    let at = |k: usize| k as f64 / parts as f64;
    for i in 0..count {
        let pair = [nodes[i], nodes[(i + 1) % count]];
        if edges.insert([pair[0].min(pair[1]), pair[0].max(pair[1])]) {
            places.extend((1..parts).map(|k| vec![(pair[0], 1.0 - at(k)), (pair[1], at(k))]));
        }
    }
    for i in 1..parts {
        for j in 1..parts {
            let (s, t) = (at(i), at(j));
            let weights = match count {
                3 if i + j < parts => vec![1.0 - s - t, s, t],
                3 => continue,
                _ => vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t],
            };
            places.push(nodes.iter().copied().zip(weights).collect());
        }
    }
}

/// The lattice of a curved element: on its sides between neighbouring nodes, and within the faces between its nodes.
fn curved_lattice<F: CurvedFace<N>, const N: usize>(
    nodes: &[usize],
    between: usize,
    edges: &mut HashSet<[usize; 2]>,
    places: &mut Vec<NodeWeights>,
) {
    let mut own = Vec::new();
    // Inner lines between its nodes belong to the element alone.
    let mut inside = HashSet::new();
    let round: Vec<usize> = curved_faces::ring(N).collect();
    let pair = |a: usize, b: usize| [a.min(b), a.max(b)];
    let rim: HashSet<[usize; 2]> = (0..round.len()).map(|k| pair(round[k], round[(k + 1) % round.len()])).collect();
    for facet in facets(N) {
        let mut known = HashSet::new();
        for (k, &a) in facet.iter().enumerate() {
            let b = facet[(k + 1) % facet.len()];
            let seen = if rim.contains(&pair(a, b)) {
                !edges.insert(pair(nodes[a], nodes[b]))
            } else {
                !inside.insert(pair(a, b))
            };
            if seen {
                known.insert(pair(a, b));
            }
        }
        lattice(facet, between, &mut known, &mut own);
    }
    for weights in own {
        // The place in coordinates of the element.
        let at = |i: usize| weights.iter().map(|&(k, w): &(usize, f64)| w * F::NODES[k][i]).sum();
        let values = F::values([at(0), at(1)]);
        let of = nodes.iter().copied().zip(values).filter(|(_, w)| w.abs() > 1e-14);
        places.push(of.collect());
    }
}
