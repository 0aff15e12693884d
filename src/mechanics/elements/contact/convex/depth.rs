//! The depth of two overlapping convex solids: one number, a smooth function of their positions.

use base::math::{Vec3, Vec6};

/// The depth of two convex solids.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// The depth.
    pub D: f64,
    /// Its derivative by a displacement of the one and a rotation about its centre, in the axes of the other.
    pub g: Vec6,
    /// Centre of the common solid.
    pub c: Vec3,
    /// The radius of friction about the normal: the mean distance from the centre under a uniform pressure.
    pub lever: f64,
}
