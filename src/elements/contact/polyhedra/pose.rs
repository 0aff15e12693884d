//! Two convex polyhedra, one in the axes of the other.

use crate::math::polyhedron::{Polyhedron, PolyhedronEdge};
use crate::math::{Mat3, Vec3};

/// A polyhedron seen from another, whose centre and axes are origin and axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolyhedronPose<'a> {
    /// Centre of the one.
    pub y: Vec3,
    /// Columns: axes of the one.
    pub Q: Mat3,
    /// The one.
    pub own: &'a Polyhedron,
    /// The other.
    pub other: &'a Polyhedron,
}

/// An axis that separates two polyhedra, or along which they overlap least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastAxis {
    /// Unit vector toward the one.
    pub axis: Vec3,
    /// The distance of the two along it, negative where they overlap.
    pub gap: f64,
}

/// Looks for the axis of the largest gap.
struct AxisSearch {
    best: LeastAxis,
    size: f64,
}

impl AxisSearch {
    fn look(&mut self, axis: Vec3, gap: f64) {
        // Rounding does not choose between axes that are as good.
        if gap > self.best.gap + 1e-9 * self.size {
            self.best = LeastAxis { axis, gap };
        }
    }
}

impl PolyhedronPose<'_> {
    /// The length to which positions are rounded.
    pub fn size(&self) -> f64 {
        self.own.reach() + self.other.reach()
    }

    /// The axis of the largest gap among the normals of faces and the products of edges: two convex polyhedra overlap where none of them
    /// separates them (S. Gottschalk, 1996).
    pub fn least_axis(&self) -> LeastAxis {
        let best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        let mut search = AxisSearch { best, size: self.size() };
        match (self.own.half(), self.other.half()) {
            (Some(own), Some(other)) => self.look_along_boxes(own, other, &mut search),
            _ => self.look_along_polyhedra(&mut search),
        }
        search.best
    }

    /// Of boxes the 15 axes, to both sides at once.
    fn look_along_boxes(&self, own: &Vec3, other: &Vec3, search: &mut AxisSearch) {
        let reach = |axis: &Vec3| {
            let own: f64 = (0..3).map(|k| own[k] * self.Q.column(k).dot(axis).abs()).sum();
            own + other.dot(&axis.abs())
        };
        let mut look = |axis: Vec3| {
            let along = self.y.dot(&axis);
            search.look(axis * 1f64.copysign(along), along.abs() - reach(&axis));
        };
        (0..3).for_each(|k| look(Vec3::ith(k, 1.0)));
        (0..3).for_each(|k| look(self.Q.column(k).into_owned()));
        for i in 0..3 {
            for j in 0..3 {
                // Edges that are parallel have the plane of two faces between them.
                if let Some(axis) = Vec3::ith(i, 1.0).cross(&self.Q.column(j)).try_normalize(1e-6) {
                    look(axis);
                }
            }
        }
    }

    /// Of others the normals of all faces, and of each pair of edges the axis across both, where they are a pair that may meet first: where
    /// the arcs between the normals of their faces cross on the sphere (D. Gregorius, 2013).
    fn look_along_polyhedra(&self, search: &mut AxisSearch) {
        for face in self.other.faces() {
            let nearest = self.own.farthest(&-self.Q.tr_mul(&face.normal));
            search.look(face.normal, face.normal.dot(&(self.y + self.Q * nearest)) - face.offset);
        }
        for face in self.own.faces() {
            let axis = -(self.Q * face.normal);
            search.look(axis, axis.dot(&(self.y - self.other.farthest(&axis))) - face.offset);
        }
        for own in self.own.edges() {
            let [a, b] = own.ends.map(|k| self.y + self.Q * self.own.corners()[k]);
            let arc = normals(self.own, own).map(|normal| -(self.Q * normal));
            for other in self.other.edges() {
                let [c, d] = other.ends.map(|k| self.other.corners()[k]);
                if !cross(&normals(self.other, other), &arc) {
                    continue;
                }
                let Some(axis) = (d - c).cross(&(b - a)).try_normalize(1e-6 * (d - c).norm() * (b - a).norm()) else {
                    continue;
                };
                // The origin lies inside the other.
                let outward = axis * 1f64.copysign(axis.dot(&c));
                search.look(outward, outward.dot(&(a - c)));
            }
        }
    }

    /// The one moved along an axis until the two overlap by a `depth` along it.
    pub fn pushed_in(&self, least: &LeastAxis, depth: f64) -> Self {
        PolyhedronPose { y: self.y - (depth + least.gap) * least.axis, ..*self }
    }

    /// The one moved by a small step along an axis, or turned about it where `k` is 3 and more.
    pub fn moved(&self, k: usize, step: f64) -> Self {
        let mut moved = *self;
        if k < 3 {
            moved.y[k] += step;
        } else {
            moved.Q = crate::math::rotation::matrix(&crate::math::rotation::exp(&Vec3::ith(k - 3, step))) * self.Q;
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

    /// The same; where it is beyond a limit, a lower bound that is beyond it too.
    pub fn distance_within(&self, limit: f64) -> f64 {
        let apart = self.y.norm() - self.size();
        if apart >= limit {
            return apart;
        }
        let gap = self.least_axis().gap;
        if gap <= 0.0 || gap >= limit {
            return gap;
        }
        let mut least = f64::INFINITY;
        for corner in self.own.corners() {
            least = least.min(self.other.distance(&(self.y + self.Q * corner)));
        }
        for corner in self.other.corners() {
            least = least.min(self.own.distance(&self.Q.tr_mul(&(corner - self.y))));
        }
        for own in self.own.edges() {
            let own = own.ends.map(|k| self.y + self.Q * self.own.corners()[k]);
            for other in self.other.edges() {
                least = least.min(between_segments(own, other.ends.map(|k| self.other.corners()[k])));
            }
        }
        // The axis bounds it from below; both are exact where faces or edges are the nearest.
        least.max(gap)
    }
}

/// The normals of the two faces that meet in an edge.
fn normals(of: &Polyhedron, edge: &PolyhedronEdge) -> [Vec3; 2] {
    edge.faces.map(|face| of.faces()[face].normal)
}

/// True where the shorter arcs between two pairs of unit vectors cross.
fn cross([a, b]: &[Vec3; 2], [c, d]: &[Vec3; 2]) -> bool {
    let (ab, cd) = (b.cross(a), d.cross(c));
    let (c_ab, d_ab, a_cd, b_cd) = (c.dot(&ab), d.dot(&ab), a.dot(&cd), b.dot(&cd));
    c_ab * d_ab < 0.0 && a_cd * b_cd < 0.0 && c_ab * b_cd > 0.0
}

/// The distance of two segments where the nearest points lie within both; infinite where an end is the nearest, which corners see.
fn between_segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> f64 {
    let (u, w, r) = (b - a, d - c, a - c);
    let (uu, uw, ww) = (u.dot(&u), u.dot(&w), w.dot(&w));
    let det = uu * ww - uw * uw;
    if det <= 1e-12 * uu * ww {
        return f64::INFINITY;
    }
    let s = (uw * w.dot(&r) - ww * u.dot(&r)) / det;
    let t = (uu * w.dot(&r) - uw * u.dot(&r)) / det;
    let within = |s: f64| (0.0..=1.0).contains(&s);
    if within(s) && within(t) { (r + s * u - t * w).norm() } else { f64::INFINITY }
}
