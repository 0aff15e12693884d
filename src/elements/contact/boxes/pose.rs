//! Two boxes, one in the axes of the other.

use crate::math::{Mat3, Vec3};

/// A box seen from another, whose centre and axes are origin and axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxPose {
    /// Centre of the one.
    pub y: Vec3,
    /// Columns: axes of the one.
    pub Q: Mat3,
    /// Half its edges.
    pub own: Vec3,
    /// Half the edges of the other.
    pub other: Vec3,
}

/// An axis that separates two boxes, or along which they overlap least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastAxis {
    /// Unit vector toward the one.
    pub axis: Vec3,
    /// The distance of the boxes along it, negative where they overlap.
    pub gap: f64,
}

impl BoxPose {
    /// The length to which positions are rounded.
    pub fn size(&self) -> f64 {
        self.own.norm() + self.other.norm()
    }

    /// The axis of the largest gap among the normals of faces and the products of edges: two boxes overlap where none of the 15
    /// separates them (S. Gottschalk, 1996).
    pub fn least_axis(&self) -> LeastAxis {
        let mut best = LeastAxis { axis: Vec3::z(), gap: f64::NEG_INFINITY };
        let reach = |axis: &Vec3| {
            let own: f64 = (0..3).map(|k| self.own[k] * self.Q.column(k).dot(axis).abs()).sum();
            own + self.other.dot(&axis.abs())
        };
        let mut look = |axis: Vec3| {
            let along = self.y.dot(&axis);
            let gap = along.abs() - reach(&axis);
            // Rounding does not choose between axes that are as good.
            if gap > best.gap + 1e-9 * self.size() {
                best = LeastAxis { axis: axis * 1f64.copysign(along), gap };
            }
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
        best
    }

    /// The one moved along an axis until the boxes overlap by a `depth` along it.
    pub fn pushed_in(&self, least: &LeastAxis, depth: f64) -> BoxPose {
        BoxPose { y: self.y - (depth + least.gap) * least.axis, ..*self }
    }

    /// The one moved by a small step along an axis, or turned about it where `k` is 3 and more.
    pub fn moved(&self, k: usize, step: f64) -> BoxPose {
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
        let mut corner = self.y;
        for k in 0..3 {
            let edge = self.Q.column(k);
            corner -= edge * self.own[k].copysign(edge.dot(axis));
        }
        corner
    }

    /// The distance of the boxes; negative by their least overlap where they do.
    pub fn distance(&self) -> f64 {
        let gap = self.least_axis().gap;
        if gap <= 0.0 {
            return gap;
        }
        let seen = |x: &Vec3, half: &Vec3| (x.abs() - half).sup(&Vec3::zeros()).norm();
        let back = |x: &Vec3| self.Q.tr_mul(&(x - self.y));
        let mut least = f64::INFINITY;
        for k in 0..8 {
            let sign = corner(k);
            let own = self.y + self.Q * sign.component_mul(&self.own);
            least = least.min(seen(&own, &self.other));
            least = least.min(seen(&back(&sign.component_mul(&self.other)), &self.own));
        }
        for (a, b) in edges(&self.own) {
            let (a, b) = (self.y + self.Q * a, self.y + self.Q * b);
            for (c, d) in edges(&self.other) {
                least = least.min(between_segments([a, b], [c, d]));
            }
        }
        // The axis bounds it from below; both are exact where faces or edges are the nearest.
        least.max(gap)
    }
}

/// The signs of the k-th corner of a box, of 8.
pub fn corner(k: usize) -> Vec3 {
    let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
    Vec3::new(sign(0), sign(1), sign(2))
}

fn edges(half: &Vec3) -> impl Iterator<Item = (Vec3, Vec3)> + '_ {
    let pairs = (0..8).flat_map(|k| (0..3).filter(move |bit| k >> bit & 1 == 0).map(move |bit| (k, k | 1 << bit)));
    pairs.map(|(a, b)| (corner(a).component_mul(half), corner(b).component_mul(half)))
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
