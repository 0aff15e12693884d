//! The segment about which a deck makes a capsule.

use base::math::Vec3;
use base::math::convex::Spherocylinder;
use base::words::kinds::{Form, Given, Key};

/// The key of its ends.
pub const ENDS: Key = Key {
    name: "ends",
    form: Form::Vectors,
    about: "Two points, the ends of the line that it is round, global axes at t = 0.",
};

/// The round body about the segment between the deck's points with `radius`, about the middle, and the position of the middle.
pub fn segment_of(given: &mut Given) -> Option<(Spherocylinder, Vec3)> {
    let radius = given.require_positive("radius");
    let &[ax, ay, az, bx, by, bz] = given.require("ends")? else {
        return given.error("ends", "`ends` takes two points");
    };
    let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
    // Nearer, the direction of the line is rounding.
    if (b - a).norm() <= 1e-12 * a.norm().max(radius.unwrap_or(0.0)) {
        return given.error_with("ends", "the ends of a capsule lie at one place", "that is a sphere");
    }
    Some((Spherocylinder { half: 0.5 * (b - a), radius: radius? }, 0.5 * (a + b)))
}
