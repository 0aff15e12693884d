//! The results of a contact for output: what each touch does to the surface, and the least gap.

use super::convex::{CarriedConvex, ConvexBody, ConvexPairs, ConvexPose};
use super::force::touch;
use super::history::{self, PointHistory};
use super::kinematics::Contacts;
use super::point::ContactPoint;
use super::surface::Surface;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// What one touch does to the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactAction {
    /// A node of what is touched: of a shape the one that carries it, of facets the first of the one that is touched.
    pub on: usize,
    /// A node of what touches.
    pub by: usize,
    /// Force on the surface, global components.
    pub f: Vec3,
    /// Moment on a shape about the node that carries it, and on facets and among bodies about the origin.
    pub m: Vec3,
}

/// Calls with what each point that touches does to the surface.
pub fn each_touch(contacts: &Contacts, now: &Configuration, act: &mut dyn FnMut(ContactAction)) {
    for (e, point) in contacts.points.iter().enumerate() {
        let Some((at, acting)) = touch(contacts, e, now) else { continue };
        let f = at.R * acting.F;
        let m = at.d.cross(&f) + at.R * acting.M;
        act(ContactAction { on: contacts.carrier, by: point.nodes[0], f: -f, m: -m });
    }
}

/// Least distance of points from a surface; infinite where there are none.
pub fn least_gap(surface: &Surface, carrier: usize, points: &[ContactPoint], nodes: &[Node]) -> f64 {
    let carrier = &nodes[carrier];
    let R = carrier.R();
    let gap =
        |point: &ContactPoint| surface.distance(&R.tr_mul(&point.relative_position(carrier, nodes))) - point.radius;
    points.iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// Least gap of points at the end of the last step, by the history of the block; infinite where none is near.
pub fn last_gap(contacts: &Contacts, history: &[f64]) -> f64 {
    least(history::each(contacts, history))
}

/// The same of pairs of convex solids.
pub fn last_pair_gap(pairs: &ConvexPairs, history: &[f64]) -> f64 {
    least((0..pairs.count()).map(|e| pairs.history(e, history)))
}

fn least<'a>(points: impl Iterator<Item = PointHistory<'a>>) -> f64 {
    points.filter(|point| point.is_known()).map(PointHistory::gap).fold(f64::INFINITY, f64::min)
}

/// Calls with what each convex solid that touches does to the one that is touched; each counts once.
pub fn each_pair_touch(pairs: &ConvexPairs, now: &Configuration, act: &mut dyn FnMut(ContactAction)) {
    for e in 0..pairs.count() {
        let pair = pairs.pair(e);
        let Some((at, acting)) = pair.touch(pairs.history(e, now.history), now) else { continue };
        let (f, m) = at.global(&acting.W);
        act(ContactAction { on: pair.other.node, by: pair.one.node, f: -f, m: -(m + at.d.cross(&f)) });
    }
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

/// The distance of two convex solids, negative by their least overlap; where it is beyond a `limit`, a lower bound that is beyond it too.
pub(super) fn distance(one: &ConvexBody, other: &CarriedConvex, limit: f64, nodes: &[Node]) -> f64 {
    let (carrier, R) = (&nodes[other.node], nodes[other.node].R());
    let y = other.axes.tr_mul(&(R.tr_mul(&nodes[one.node].relative_position(carrier)) - other.center));
    let Q = (R * other.axes).tr_mul(&nodes[one.node].R());
    ConvexPose { y, Q, own: &one.shape, other: &other.shape }.distance_within(limit)
}
