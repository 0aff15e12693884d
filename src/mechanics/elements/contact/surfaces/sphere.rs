//! The sphere.

use super::kind::{CENTER, ClosestPoint, Placed, SurfaceKind, Touched, center, round};
use base::math::{Mat3, Vec3};
use base::words::kinds::{Form, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Sphere> = SurfaceKind {
    word: "sphere",
    aliases: &[],
    guesses: &["ball"],
    about: "A ball.",
    keys: &[CENTER, Key { name: "radius", form: Form::Number, about: "Its radius, above 0." }],
    make: |given, body| {
        let (center, radius) = (center(given, body), given.require_positive("radius"));
        Some(Placed { center: center?, axes: Mat3::identity(), shape: Sphere { radius: radius? } })
    },
};

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Radius.
    pub radius: f64,
}

impl Touched for Sphere {
    #[inline]
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        round(y, self.radius, &Mat3::identity())
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        y.norm() - self.radius
    }

    fn reach(&self) -> f64 {
        self.radius
    }

    fn least(&self) -> f64 {
        2.0 * self.radius
    }

    fn keeps(&self, _: &Vec3) -> bool {
        true
    }
}
