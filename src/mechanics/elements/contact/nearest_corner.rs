//! The corners of a solid against faces, as far as the nodes of these faces depend on them.

use crate::state::Node;
use base::math::Vec3;

/// Corners of a solid that touch faces.
pub trait NearestCorner: Send + Sync {
    /// The least gap of the corners from faces that push them in a direction, within a cosine; infinite where none is near.
    fn least_gap_toward(&self, direction: &Vec3, cosine: f64, nodes: &[Node]) -> f64;
    /// A part of the size of a face, by which gaps are told that are next to each other.
    fn margin(&self) -> f64;
}
