//! The box.

use super::kind::{CENTER, ClosestPoint, Placed, SurfaceKind, Touched, center, is_along};
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Cuboid> = SurfaceKind {
    word: "box",
    aliases: &[],
    guesses: &["cuboid", "cube", "block", "brick"],
    about: "A cuboid.",
    keys: &[
        CENTER,
        Key { name: "size", form: Form::Vector, about: "Full edge lengths, above 0." },
        Key { name: "axes", form: Form::Vectors, about: "Its x, and a vector in its x-y plane. Default: global axes." },
    ],
    make: read,
};

fn read(given: &mut Given, body: Option<Vec3>) -> Option<Placed<Cuboid>> {
    let center = center(given, body);
    let size = given.require_vector("size")?;
    if size.iter().any(|&edge| edge <= 0.0) {
        return given.error("size", "the edges of a box must be above zero");
    }
    let axes = given.axes("axes")?;
    Some(Placed { center: center?, axes, shape: Cuboid { half: size.map(|edge| 0.5 * edge).into() } })
}

/// A box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Half the edges.
    pub half: [f64; 3],
}

impl Touched for Cuboid {
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        let q = y.abs() - Vec3::from(self.half);
        let side = |i: usize| Vec3::ith(i, 1f64.copysign(y[i]));
        let outside = (0..3).filter(|&i| q[i] > 0.0).count();
        if outside < 2 {
            // One face is the nearest, from outside or inside.
            let i = q.imax();
            return ClosestPoint { distance: q[i], n: side(i), H: Mat3::zeros() };
        }
        let mut n = Vec3::zeros();
        let mut free = Mat3::zeros();
        for i in (0..3).filter(|&i| q[i] > 0.0) {
            n += q[i] * side(i);
            free[(i, i)] = 1.0;
        }
        let d = n.norm();
        n /= d;
        ClosestPoint { distance: d, n, H: (free - n * n.transpose()) / d }
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        let q = y.abs() - Vec3::from(self.half);
        q.sup(&Vec3::zeros()).norm() + q.max().min(0.0)
    }

    fn reach(&self) -> f64 {
        Vec3::from(self.half).norm()
    }

    fn least(&self) -> f64 {
        2.0 * Vec3::from(self.half).min()
    }

    /// Inside, the nearest face must not be one of the two that lie along the plane.
    fn keeps(&self, e: &Vec3) -> bool {
        (0..3).any(|i| is_along(e, i) && (0..3).any(|j| j != i && self.half[j] < self.half[i]))
    }
}
