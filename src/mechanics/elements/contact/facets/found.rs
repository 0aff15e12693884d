//! A facet that was found near a point.

use super::facing::Facing;
use base::math::Vec3;

/// A facet that a point touches, or is near to.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacetTouch {
    /// The number of the facet.
    pub facet: usize,
    /// The gap on whichever side the point is.
    pub gap: f64,
    /// The unit vector from the facet to the point.
    pub toward: Vec3,
    /// The nodes of the rim between which the nearest point lies.
    pub rim: [Option<usize>; 2],
    /// The normal of the facet.
    pub normal: Vec3,
    /// The reference for the side of the facet.
    pub facing: Facing,
    /// False for facets that only exclude others from being the nearest.
    pub counts: bool,
    /// Depth without force: the depth of the point in the facet on arrival along the surface, from facets that it cannot touch.
    pub inset: f64,
    /// True where the plane of the facet goes on beyond its rim, to a neighbour in nearly the same plane.
    pub goes_on: bool,
    /// The slot of its memory.
    pub slot: Option<usize>,
    /// For a touching line, the share of its second end in its nearest point.
    pub share: Option<f64>,
    /// For a line, the neighbouring line and the slot whose memory continues here after the contact has passed their common node.
    pub from: Option<(usize, usize)>,
}

impl FacetTouch {
    /// Positive for a point on the side of the normal, negative on the other, zero without sides.
    pub fn height(&self) -> f64 {
        match self.facing {
            Facing::Normal => self.toward.dot(&self.normal),
            Facing::Rim(facing) => self.toward.dot(&facing),
            Facing::Nothing => 0.0,
        }
    }
}

/// A query for the facets near a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct TouchQuery {
    /// The point.
    pub e: usize,
    /// The largest gap.
    pub limit: f64,
    /// True where a point stays with its remembered facet, as long as its nearest point there is a minimum with about the largest depth.
    /// The force then has no kink within a step where two facets of a hollow are equally near, and the iteration converges.
    pub stays: bool,
}
