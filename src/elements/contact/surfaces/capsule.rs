//! The capsule: a cylinder with round ends.

use super::kind::{ClosestPoint, Placed, SurfaceKind, Touched, across, along, round};
use crate::math::{Mat3, Vec3, frame_along};
use crate::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Capsule> = SurfaceKind {
    word: "capsule",
    aliases: &[],
    guesses: &["pill"],
    about: "A cylinder with round ends.",
    keys: &[
        Key { name: "ends", form: Form::Vectors, about: "Two points, the ends of the line that it is round." },
        Key { name: "radius", form: Form::Number, about: "Its radius, above 0." },
    ],
    make: read,
};

fn read(given: &mut Given, _: Option<Vec3>) -> Option<Placed<Capsule>> {
    let radius = given.require_positive("radius");
    let &[ax, ay, az, bx, by, bz] = given.require("ends")? else {
        return given.error("ends", "`ends` takes two points");
    };
    let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
    let Some(axis) = (b - a).try_normalize(0.0) else {
        return given.error_with("ends", "the ends of a capsule lie at one place", "that is a sphere");
    };
    let shape = Capsule { radius: radius?, half: 0.5 * (b - a).norm() };
    Some(Placed { center: 0.5 * (a + b), axes: frame_along(&axis), shape })
}

/// All that is nearer than the radius to a line along the third axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// Radius about the line.
    pub radius: f64,
    /// Half length of the line.
    pub half: f64,
}

impl Touched for Capsule {
    fn closest_point(&self, y: &Vec3) -> ClosestPoint {
        if y.z.abs() < self.half {
            round(&Vec3::new(y.x, y.y, 0.0), self.radius, &Mat3::from_diagonal(&Vec3::new(1.0, 1.0, 0.0)))
        } else {
            round(&(y - Vec3::new(0.0, 0.0, self.half.copysign(y.z))), self.radius, &Mat3::identity())
        }
    }

    #[inline]
    fn distance(&self, y: &Vec3) -> f64 {
        (y - Vec3::new(0.0, 0.0, y.z.clamp(-self.half, self.half))).norm() - self.radius
    }

    fn reach(&self) -> f64 {
        self.radius + self.half
    }

    fn least(&self) -> f64 {
        2.0 * self.radius
    }

    fn keeps(&self, e: &Vec3) -> bool {
        across(e, 2) || along(e, 2)
    }
}
