//! Random vectors and rotations.

use nalgebra::Quaternion;
use rand::{Rng, RngExt};
use rdsolve::math::Vec3;

/// A vector whose components lie between −size and size.
pub fn vector(rng: &mut impl Rng, size: f64) -> Vec3 {
    Vec3::from_fn(|_, _| size * rng.random_range(-1.0..1.0))
}

/// Any rotation.
pub fn turn(rng: &mut impl Rng) -> Quaternion<f64> {
    let c = nalgebra::Vector4::from_fn(|_, _| rng.random_range(-1.0..1.0));
    Quaternion::from(c).normalize()
}
