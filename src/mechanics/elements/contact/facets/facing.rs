//! On which side of a facet a point is, where its nearest point lies on the rim.

use base::math::Vec3;

/// What tells on which side of a facet a point is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Facing {
    /// Its normal.
    Normal,
    /// Where the nearest point lies on the rim, the sum of the normals of the facets that meet there: the point may be behind the plane of one
    /// of them without having come through.
    Rim(Vec3),
    /// Nothing: more than two facets meet there, and what is beside one of them is beyond another.
    Nothing,
}
