//! The plane: all on one side of it is solid.

use super::kind::{ClosestPoint, Placed, SurfaceKind, Touched, is_across};
use base::math::{Mat3, Vec3, frame_along};
use base::words::kinds::{Form, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Plane> = SurfaceKind {
    word: "plane",
    aliases: &[],
    guesses: &["halfspace", "half-space", "floor", "wall"],
    about: "Everything on one side is solid.",
    keys: &[
        Key { name: "point", form: Form::Vector, about: "A point of the plane." },
        Key { name: "normal", form: Form::Vector, about: "Out of the solid side. Any length." },
    ],
    make: |given, _| {
        let (point, normal) = (given.require_vector("point"), given.require_unit("normal"));
        Some(Placed { center: point?, axes: frame_along(&normal?), shape: Plane })
    },
};

/// The half space below a plane normal to the third axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane;

impl Touched for Plane {
    #[inline]
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        ClosestPoint { distance: y.z, n: Vec3::z(), H: Mat3::zeros() }
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        y.z
    }

    fn reach(&self) -> f64 {
        f64::INFINITY
    }

    fn least(&self) -> f64 {
        f64::INFINITY
    }

    fn keeps(&self, e: &Vec3) -> bool {
        is_across(e, 2)
    }
}
