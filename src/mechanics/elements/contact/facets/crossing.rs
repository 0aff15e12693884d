//! Crossing edges: two lines with separate points at their ends, a corner of a box on a beam or a node of a beam on a box.
//!
//! δ is the depth between the nearest points of the lines, δ_e the depth of the deepest of their four ends against the other line. The
//! contact potential is
//!
//! ```text
//!  U = ½ k (δ² − δ_e²)
//! ```
//!
//! Without an end in reach it is the potential of the crossing; near an end it fades to zero. A body sliding off an edge over its corner,
//! or along a beam over its nodes, is thus pressed once throughout. Lines side by side press by their ends alone.

use super::facet::{FacetPoint, Region};
use super::pair::{EndForce, FacetPair, PairPlace};
use crate::elements::contact::history::PairMemory;
use crate::state::Node;
use base::math::Vec3;
use std::borrow::Cow;

/// The deepest of the four ends of two edges against the other edge, where one is within reach.
pub(super) fn deepest_end<'a>(pair: &FacetPair<'a>, nodes: &[Node]) -> Option<(FacetPair<'a>, PairPlace)> {
    let at = |share: f64| FacetPair { point: Cow::Owned(pair.point.at(share)), ..pair.clone() };
    let own = [0.0, 1.0].map(|share| {
        let end = at(share);
        let place = end.place(nodes);
        (end, place)
    });
    let others = [0, 1].map(|k| {
        let end = at(share_nearest_to(pair, k, nodes));
        let place = place_at_end(&end, k, nodes);
        (end, place)
    });
    let all = own.into_iter().chain(others);
    all.filter(|(_, place)| place.gap() < 0.0).min_by(|a, b| a.1.gap().total_cmp(&b.1.gap()))
}

/// The force of the deepest end, for a pair with the memory `old`.
pub(super) fn end_force(pair: &FacetPair, old: PairMemory, nodes: &[Node]) -> Option<EndForce> {
    let (end, place) = deepest_end(pair, nodes)?;
    let (law, depth, rate) = (pair.law, -place.gap(), place.rate());
    let normal = law.press(depth, place.inset, rate, old);
    Some(EndForce {
        normal,
        depth,
        power: (normal.force - law.stiffness * depth) * rate,
        F: normal.force * place.n,
        shares: [end.point.weights[0], end.point.weights[1]],
        W: [-place.W[0], -place.W[1]],
    })
}

/// The share of the second end of the line that touches in its point nearest to the k-th end of the other.
fn share_nearest_to(pair: &FacetPair, k: usize, nodes: &[Node]) -> f64 {
    let [a, b] = [0, 1].map(|end| &nodes[pair.point.nodes[end]]);
    let along = b.relative_position(a);
    let square = along.norm_squared();
    let to_end = nodes[pair.facet.nodes[k]].relative_position(a);
    if square > 0.0 { (to_end.dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// Where the point of a pair and the k-th end of the other line are to each other.
fn place_at_end(pair: &FacetPair, k: usize, nodes: &[Node]) -> PairPlace {
    let mut place = pair.place(nodes);
    let origin = &nodes[pair.point.nodes[0]];
    let p = pair.facet.seen_from(&place.x, origin, nodes);
    let mut N = [0.0; 3];
    N[k] = 1.0;
    place.at = FacetPoint { triangle: 0, N, region: Region::Vertex(k), g: -p[k] };
    place.W = pair.facet.weights(&place.at);
    place.d = p[k].norm();
    place.n = if place.d > 0.0 { -p[k] / place.d } else { place.n };
    place.w = pair.parts(&place.W).map(|(node, share)| share * nodes[node].v).sum::<Vec3>();
    place
}
