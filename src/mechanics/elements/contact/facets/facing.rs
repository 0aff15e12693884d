//! The side of a point on a facet, where its nearest point lies on the rim.

use base::math::Vec3;

/// The reference for the side of a facet on which a point is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Facing {
    /// The normal of the facet.
    Normal,
    /// For a nearest point on the rim, the sum of the normals of the facets meeting there. A point behind the plane of one of them need not
    /// have come through.
    Rim(Vec3),
    /// None: more than two facets meet there, so the sides are not defined.
    Nothing,
}
