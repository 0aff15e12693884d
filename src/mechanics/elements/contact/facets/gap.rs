//! The least gap of points from facets.

use super::facet::Facet;
use super::lines;
use super::span::FacetSpan;
use super::surface::FacetContacts;
use super::touch;
use crate::elements::contact::grid::GridBox;
use crate::elements::contact::point::ContactPoint;
use crate::state::Node;

/// Least gap of points from facets, for pairs allowed by `may_touch`; infinite without pairs. Facets are searched in the order of one
/// coordinate, until that alone exceeds the least gap so far; `sorted` is working memory.
pub fn facet_gap(
    facets: &[Facet],
    points: &[ContactPoint],
    may_touch: &dyn Fn(usize, usize) -> bool,
    nodes: &[Node],
    sorted: &mut Vec<FacetSpan>,
) -> f64 {
    let places = |facet: &Facet| facet.nodes.map(|node| nodes[node].x);
    let all = GridBox::around(facets.iter().flat_map(places));
    let axis = (all.high - all.low).imax();
    let span = |facet: &Facet| {
        let at = places(facet).map(|x| x[axis]);
        let (low, high) = at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        (low - facet.half, high + facet.half)
    };
    sorted.clear();
    sorted.extend(facets.iter().enumerate().map(|(number, facet)| (span(facet).0, span(facet).1, number)));
    sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let longest = sorted.iter().map(|(low, high, _)| high - low).fold(0.0, f64::max);
    let mut least = f64::INFINITY;
    for (e, point) in points.iter().enumerate() {
        let origin = &nodes[point.nodes[0]];
        let x = point.relative_position(origin, nodes);
        let at = origin.x[axis] + x[axis];
        // Half of the extent of a line along the coordinate.
        let spread = if point.is_line() { x[axis].abs() } else { 0.0 };
        let look = |&(low, high, number): &FacetSpan, least: &mut f64| {
            let facet = &facets[number];
            if (low - at).max(at - high) - spread - point.radius < *least && may_touch(e, number) {
                let nearest =
                    lines::share(point, facet, nodes).map(|share| point.at(share).relative_position(origin, nodes));
                let x = nearest.unwrap_or(x);
                let gap = facet.closest(&facet.seen_from(&x, origin, nodes)).g.norm() - facet.half - point.radius;
                *least = least.min(gap);
            }
        };
        let from = sorted.partition_point(|(low, _, _)| *low < at);
        for facet in &sorted[from..] {
            if facet.0 - at - spread - point.radius >= least {
                break;
            }
            look(facet, &mut least);
        }
        for facet in sorted[..from].iter().rev() {
            if at - facet.0 - longest - spread - point.radius >= least {
                break;
            }
            look(facet, &mut least);
        }
    }
    least
}

/// Least gap of the points from the facets that they may touch; infinite without pairs.
pub(super) fn least_facet_gap(of: &FacetContacts, nodes: &[Node]) -> f64 {
    let may_touch = |e: usize, facet: usize| of.may_touch(e, facet as u32) && !of.is_near_along(e, facet as u32);
    let mut nearby = of.nearby(nodes);
    if of.is_inner {
        // In self-contact only minima of the distance count; the lists hold them within their reach.
        let mut found = std::mem::take(&mut nearby.touches);
        let least = (0..of.points.len()).map(|e| touch::least_minimum(of, nearby.of(e), e, nodes, &mut found));
        let least = least.fold(f64::INFINITY, f64::min);
        nearby.touches = found;
        if least.is_finite() {
            return least;
        }
    }
    facet_gap(&of.facets, &of.points, &may_touch, nodes, &mut nearby.spans)
}

/// True where a facet has a node of a point.
pub fn is_own(point: &ContactPoint, facet: &Facet) -> bool {
    point.nodes().iter().any(|node| facet.nodes().contains(node))
}
