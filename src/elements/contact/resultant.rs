//! The results of a contact for output: the resultant of its points and its least gap.

use super::convex::{CarriedConvex, ConvexBody, ConvexPairs, ConvexPose};
use super::force::touch;
use super::history::{self, PointHistory};
use super::kinematics::Contacts;
use super::point::ContactPoint;
use super::surface::Surface;
use crate::math::Vec3;
use crate::state::{Configuration, Node};

/// The resultant of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resultant {
    /// Number of points in contact.
    pub touching: usize,
    /// Force on the surface, global components.
    pub f: Vec3,
    /// Its moment about the node that carries the surface.
    pub m: Vec3,
}

impl Default for Resultant {
    fn default() -> Self {
        Resultant { touching: 0, f: Vec3::zeros(), m: Vec3::zeros() }
    }
}

/// The resultant of the forces of all points on the surface.
pub fn resultant(contacts: &Contacts, now: &Configuration) -> Resultant {
    let mut sum = Resultant::default();
    for (at, acting) in (0..contacts.points.len()).filter_map(|e| touch(contacts, e, now)) {
        let f = at.R * acting.F;
        sum.touching += 1;
        sum.f -= f;
        sum.m -= at.d.cross(&f) + at.R * acting.M;
    }
    sum
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

/// The resultant of the forces of all pairs of convex solids on the one that is touched; each that touches counts once.
pub fn pair_resultant(pairs: &ConvexPairs, now: &Configuration) -> Resultant {
    let mut sum = Resultant::default();
    for (at, acting) in (0..pairs.count()).filter_map(|e| pairs.pair(e).touch(pairs.history(e, now.history), now)) {
        let (f, m) = at.global(&acting.W);
        sum.touching += 1;
        sum.f -= f;
        sum.m -= m + at.d.cross(&f);
    }
    sum
}

/// Least distance of convex solids from another; infinite where there are none.
pub fn pair_gap(surface: &Surface, carrier: usize, touching: &[ConvexBody], nodes: &[Node]) -> f64 {
    let Some(other) = CarriedConvex::of_surface(surface, carrier).filter(|_| !touching.is_empty()) else {
        return f64::INFINITY;
    };
    touching.iter().fold(f64::INFINITY, |least, one| least.min(distance(one, &other, least, nodes)))
}

/// The distance of two convex solids, negative by their least overlap; where it is beyond a `limit`, a lower bound that is beyond it too.
pub(super) fn distance(one: &ConvexBody, other: &CarriedConvex, limit: f64, nodes: &[Node]) -> f64 {
    let (carrier, R) = (&nodes[other.node], nodes[other.node].R());
    let y = other.axes.tr_mul(&(R.tr_mul(&nodes[one.node].relative_position(carrier)) - other.center));
    let Q = (R * other.axes).tr_mul(&nodes[one.node].R());
    ConvexPose { y, Q, own: &one.shape, other: &other.shape }.distance_within(limit)
}
