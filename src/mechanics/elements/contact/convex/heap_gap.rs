//! The least gap of convex solids among themselves.

use super::pair::{CarriedConvex, ConvexBody};
use crate::elements::contact::gap::distance;
use crate::state::Node;

/// Least distance between solids, except the pairs `joined`; negative for overlap, infinite with fewer than two solids.
pub fn heap_gap(solids: &[ConvexBody], joined: &[[usize; 2]], nodes: &[Node]) -> f64 {
    let mut least = f64::INFINITY;
    // Solids are searched in the order of a coordinate; the search ends beyond the least gap so far.
    let low = |one: &ConvexBody| nodes[one.node].x.x - one.shape.reach();
    let mut order: Vec<(usize, &ConvexBody)> = solids.iter().enumerate().collect();
    order.sort_by(|a, b| low(a.1).total_cmp(&low(b.1)));
    for (k, &(i, one)) in order.iter().enumerate() {
        let high = nodes[one.node].x.x + one.shape.reach();
        for &(j, other) in &order[k + 1..] {
            if low(other) - high >= least {
                break;
            }
            let d = nodes[one.node].relative_position(&nodes[other.node]);
            let is_near = d.norm() - one.shape.reach() - other.shape.reach() < least;
            if is_near && joined.binary_search(&[i.min(j), i.max(j)]).is_err() {
                least = least.min(distance(one, &CarriedConvex::of_body(other), least, nodes));
            }
        }
    }
    least
}
