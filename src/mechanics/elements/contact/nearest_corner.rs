//! The corners of a solid against faces, as far as the nodes of these faces depend on them.

use crate::state::Node;
use base::math::Vec3;

/// Corners of a solid that touch faces.
pub trait NearestCorner: Send + Sync {
    /// The least gap between the corners and faces that push them in about the given direction (angle by its cosine); infinite without near
    /// faces.
    fn least_gap_toward(&self, direction: &Vec3, cosine: f64, nodes: &[Node]) -> f64;
    /// A length proportional to the faces, the scale for rounding of gaps.
    fn margin(&self) -> f64;
}
