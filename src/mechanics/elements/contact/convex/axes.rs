//! The separating axis of two convex solids, or their axis of least overlap.

use super::cylinder::CylinderPose;
use super::pose::{ConvexPose, LeastAxis, PolyhedronPose};
use super::swept::Swept;
use base::math::Vec3;
use base::math::convex::ConvexShape;
use base::math::polyhedron::{Polyhedron, PolyhedronEdge};

/// Looks for the axis of the largest gap.
struct AxisSearch {
    best: LeastAxis,
    size: f64,
}

impl AxisSearch {
    fn look(&mut self, axis: Vec3, gap: f64) {
        self.look_if_wider(gap, || axis);
    }

    fn look_if_wider(&mut self, gap: f64, axis: impl FnOnce() -> Vec3) {
        // Rounding does not choose between axes that are as good.
        if gap > self.best.gap + 1e-9 * self.size {
            self.best = LeastAxis { axis: axis(), gap };
        }
    }
}

impl ConvexPose<'_> {
    /// The axis of the largest gap. For polyhedra it is a face normal or a product of two edges: they overlap if none of these separates
    /// them (S. Gottschalk, 1996).
    pub fn least_axis(&self) -> LeastAxis {
        self.least_axis_within(f64::INFINITY)
    }

    /// As [`ConvexPose::least_axis`]; boxes further apart than a `limit` along the normal of a face may get that axis.
    pub fn least_axis_within(&self, limit: f64) -> LeastAxis {
        if let ConvexShape::HalfSpace(_) = self.other {
            return LeastAxis { axis: Vec3::z(), gap: self.deepest(&Vec3::z()).z };
        }
        let best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        let mut search = AxisSearch { best, size: self.size() };
        let Some(pose) = self.as_polyhedra() else {
            let of_cylinder = || CylinderPose::of(self).map(|pose| pose.least_axis());
            return Swept::of(self).map(|swept| swept.least_axis()).or_else(of_cylinder).unwrap_or(best);
        };
        match (pose.own.half(), pose.other.half()) {
            (Some(own), Some(other)) => pose.look_along_boxes(own, other, limit, &mut search),
            _ => pose.look_along_polyhedra(&mut search),
        }
        search.best
    }
}

impl PolyhedronPose<'_> {
    /// Boxes: the 15 axes, to both sides at once. On the axis e_i × Q_j the halves of the edges e_i and Q_j are points.
    fn look_along_boxes(&self, own: &Vec3, other: &Vec3, limit: f64, search: &mut AxisSearch) {
        let (Q, y, A) = (&self.Q, &self.y, self.Q.abs());
        let along_own = Q.tr_mul(y);
        let (reach_of_own, reach_of_other) = (A * own, A.tr_mul(other));
        for k in 0..3 {
            let gap = y[k].abs() - (other[k] + reach_of_own[k]);
            search.look_if_wider(gap, || Vec3::ith(k, 1f64.copysign(y[k])));
        }
        for k in 0..3 {
            let gap = along_own[k].abs() - (own[k] + reach_of_other[k]);
            search.look_if_wider(gap, || Q.column(k) * 1f64.copysign(along_own[k]));
        }
        if search.best.gap > limit {
            return;
        }
        const NEXT: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
        for (i, [i1, i2]) in NEXT.into_iter().enumerate() {
            for (j, [j1, j2]) in NEXT.into_iter().enumerate() {
                let length = (Q[(i1, j)] * Q[(i1, j)] + Q[(i2, j)] * Q[(i2, j)]).sqrt();
                // Edges that are parallel have the plane of two faces between them.
                if length <= 1e-6 {
                    continue;
                }
                let along = y[i2] * Q[(i1, j)] - y[i1] * Q[(i2, j)];
                let reach =
                    other[i1] * A[(i2, j)] + other[i2] * A[(i1, j)] + own[j1] * A[(i, j2)] + own[j2] * A[(i, j1)];
                search.look_if_wider((along.abs() - reach) / length, || {
                    Vec3::ith(i, 1f64.copysign(along) / length).cross(&Q.column(j))
                });
            }
        }
    }

    /// Other polyhedra: the normals of all faces, and the axes across pairs of edges. A pair counts if the arcs between the normals of its
    /// faces cross on the sphere (D. Gregorius, 2013).
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
