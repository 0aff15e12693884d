//! Two convex solids, one in the axes of the other.

use crate::elements::contact::segments::PARALLEL;
use base::math::convex::ConvexShape;
use base::math::polyhedron::Polyhedron;
use base::math::{Mat3, Vec3};

/// A convex solid seen from another, whose centre and axes are origin and axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvexPose<'a> {
    /// Centre of the one.
    pub y: Vec3,
    /// Columns: axes of the one.
    pub Q: Mat3,
    /// The one.
    pub own: &'a ConvexShape,
    /// The other.
    pub other: &'a ConvexShape,
}

/// The separating axis of two convex solids, or their axis of least overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastAxis {
    /// Unit vector toward the one.
    pub axis: Vec3,
    /// The distance of the two along it, negative where they overlap.
    pub gap: f64,
}

/// Two polyhedra, the one in the axes of the other.
#[derive(Clone, Copy)]
pub(super) struct PolyhedronPose<'a> {
    /// Centre of the one.
    pub y: Vec3,
    /// Columns: axes of the one.
    pub Q: Mat3,
    /// The one.
    pub own: &'a Polyhedron,
    /// The other.
    pub other: &'a Polyhedron,
}

impl<'a> ConvexPose<'a> {
    /// The length that scales rounding errors of positions.
    pub fn size(&self) -> f64 {
        self.own.reach() + self.other.reach()
    }

    /// A lower bound of the distance of the two, by the balls that hold them.
    pub fn apart(&self) -> f64 {
        match self.other {
            ConvexShape::HalfSpace(_) => self.y.z - self.own.reach(),
            _ => self.y.norm() - self.size(),
        }
    }

    /// The two, where both are polyhedra.
    pub(super) fn as_polyhedra(&self) -> Option<PolyhedronPose<'a>> {
        let (own, other) = (self.own.as_polyhedron()?, self.other.as_polyhedron()?);
        Some(PolyhedronPose { y: self.y, Q: self.Q, own, other })
    }

    /// The one moved along an axis until the two overlap by a `depth` along it.
    pub fn pushed_in(&self, least: &LeastAxis, depth: f64) -> Self {
        ConvexPose { y: self.y - (depth + least.gap) * least.axis, ..*self }
    }

    /// The one moved by a small step along an axis, or turned about it where `k` is 3 and more.
    pub fn moved(&self, k: usize, step: f64) -> Self {
        let mut moved = *self;
        if k < 3 {
            moved.y[k] += step;
        } else {
            moved.Q = base::math::rotation::matrix(&base::math::rotation::exp(&Vec3::ith(k - 3, step))) * self.Q;
        }
        moved
    }

    /// The corner of the one that lies deepest against an axis toward it.
    pub fn deepest(&self, axis: &Vec3) -> Vec3 {
        self.y + self.Q * self.own.farthest(&-self.Q.tr_mul(axis))
    }

    /// The distance of the two; negative by their least overlap where they do.
    pub fn distance(&self) -> f64 {
        self.distance_within(f64::INFINITY)
    }

    /// The distance; beyond a limit, a lower bound that exceeds the limit too.
    pub fn distance_within(&self, limit: f64) -> f64 {
        let apart = self.apart();
        if apart >= limit {
            return apart;
        }
        let gap = self.least_axis().gap;
        if gap <= 0.0 || gap >= limit {
            return gap;
        }
        // The axis bounds it from below; both are exact where faces or edges are the nearest.
        self.as_polyhedra().map_or(gap, |polyhedra| nearest_parts(&polyhedra).max(gap))
    }
}

/// The least distance of corners from the other polyhedron, and of edges from edges.
fn nearest_parts(pose: &PolyhedronPose) -> f64 {
    let PolyhedronPose { y, Q, own, other } = pose;
    let mut least = f64::INFINITY;
    for corner in own.corners() {
        least = least.min(other.distance(&(y + Q * corner)));
    }
    for corner in other.corners() {
        least = least.min(own.distance(&Q.tr_mul(&(corner - y))));
    }
    for edge in own.edges() {
        let edge = edge.ends.map(|k| y + Q * own.corners()[k]);
        for other_edge in other.edges() {
            least = least.min(between_segments(edge, other_edge.ends.map(|k| other.corners()[k])));
        }
    }
    least
}

/// The distance of two segments with nearest points within both; infinite otherwise, since corners cover that case.
fn between_segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> f64 {
    let (u, w, r) = (b - a, d - c, a - c);
    let (uu, uw, ww) = (u.dot(&u), u.dot(&w), w.dot(&w));
    let det = uu * ww - uw * uw;
    if det <= PARALLEL * uu * ww {
        return f64::INFINITY;
    }
    let s = (uw * w.dot(&r) - ww * u.dot(&r)) / det;
    let t = (uu * w.dot(&r) - uw * u.dot(&r)) / det;
    let within = |s: f64| (0.0..=1.0).contains(&s);
    if within(s) && within(t) { (r + s * u - t * w).norm() } else { f64::INFINITY }
}
