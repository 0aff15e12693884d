//! The capsule: a cylinder with round ends.

use super::kind::{ClosestPoint, Placed, SurfaceKind, Touched, is_across, is_along, round};
use crate::solids::segment::{ENDS, segment_of};
use base::math::{Mat3, Vec3, frame_along};
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub const KIND: SurfaceKind<Capsule> = SurfaceKind {
    word: "capsule",
    aliases: &[],
    guesses: &["pill"],
    about: "A cylinder with round ends.",
    keys: &[ENDS, Key { name: "radius", form: Form::Number, about: "Its radius, above 0." }],
    make: read,
};

fn read(given: &mut Given, _: Option<Vec3>) -> Option<Placed<Capsule>> {
    let (segment, center) = segment_of(given)?;
    let half = segment.half.norm();
    let shape = Capsule { radius: segment.radius, half };
    Some(Placed { center, axes: frame_along(&(segment.half / half)), shape })
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
        is_across(e, 2) || is_along(e, 2)
    }
}
