//! How deep two convex solids are in each other: one number that depends smoothly on where they are.

use base::math::{Vec3, Vec6};

/// The depth of two convex solids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// The depth.
    pub D: f64,
    /// Its derivative by a displacement of the one and a rotation about its centre, in the axes of the other.
    pub g: Vec6,
    /// Centre of what they have in common.
    pub c: Vec3,
    /// The radius at which friction about the normal acts: the mean distance from the centre under an even pressure.
    pub lever: f64,
}
