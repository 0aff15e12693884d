//! The least gap between points or solids and a surface carried by one node.

use super::convex::{CarriedConvex, ConvexBody, ConvexPose};
use super::point::ContactPoint;
use super::surface::Surface;
use crate::state::Node;

/// Least distance of points from a surface; infinite where there are none.
pub fn least_gap(surface: &Surface, carrier: usize, points: &[ContactPoint], nodes: &[Node]) -> f64 {
    let carrier = &nodes[carrier];
    let R = carrier.R();
    let gap =
        |point: &ContactPoint| surface.distance(&R.tr_mul(&point.relative_position(carrier, nodes))) - point.radius;
    points.iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// Least distance of convex solids from another; infinite where there are none.
pub fn pair_gap(surface: &Surface, carrier: usize, touching: &[ConvexBody], nodes: &[Node]) -> f64 {
    if touching.is_empty() {
        return f64::INFINITY;
    }
    let reach = touching.iter().map(|one| one.shape.reach()).fold(0.0, f64::max);
    let Some(other) = CarriedConvex::of_surface(surface, carrier, reach) else { return f64::INFINITY };
    touching.iter().fold(f64::INFINITY, |least, one| least.min(distance(one, &other, least, nodes)))
}

/// The distance of two convex solids, negative by their least overlap; beyond a `limit`, a lower bound that exceeds the limit too.
pub(super) fn distance(one: &ConvexBody, other: &CarriedConvex, limit: f64, nodes: &[Node]) -> f64 {
    let (carrier, R) = (&nodes[other.node], nodes[other.node].R());
    let y = other.axes.tr_mul(&(R.tr_mul(&nodes[one.node].relative_position(carrier)) - other.center));
    let Q = (R * other.axes).tr_mul(&nodes[one.node].R());
    ConvexPose { y, Q, own: &one.shape, other: &other.shape }.distance_within(limit)
}
