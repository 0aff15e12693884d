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
    /// What tells on which side of the facet the point is.
    pub facing: Facing,
    /// False for facets that only tell that others are not the nearest.
    pub counts: bool,
    /// The depth that does not push, where the point lies in the facet already as it comes there along the surface, from facets that it cannot
    /// touch.
    pub inset: f64,
    /// The place where what is remembered of it stands.
    pub slot: Option<usize>,
    /// Of a line that touches, the share of its second end in its nearest point.
    pub share: Option<f64>,
    /// The neighbour of a line, and its place, from which what is remembered comes where the place of the touch has just gone on.
    pub from: Option<(usize, usize)>,
}

impl FacetTouch {
    /// Positive where the point is on the side of the normal, negative on the other, zero where there are none.
    pub fn height(&self) -> f64 {
        match self.facing {
            Facing::Normal => self.toward.dot(&self.normal),
            Facing::Rim(facing) => self.toward.dot(&facing),
            Facing::Nothing => 0.0,
        }
    }
}

/// What is to be found.
#[derive(Debug, Clone, Copy)]
pub(super) struct TouchQuery {
    /// The point.
    pub e: usize,
    /// The largest gap.
    pub limit: f64,
    /// True where a point stays with the facet that it remembers, as long as the nearest point of that is a minimum and about as deep:
    /// within a step the force then has no kink where two facets of a hollow are equally near, and an iteration comes to an end.
    pub stays: bool,
}
