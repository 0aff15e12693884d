//! What a pair of a point and a facet remembers, as a typed view of its numbers: the motion along the normal as that of a point
//! against a surface, then the facet and the side of it on which the point is, then what friction keeps.

use crate::elements::contact::history::{FRICTION_FORCE, PointHistory, PointHistoryMut};
use crate::math::Vec3;
use nalgebra::Quaternion;

const FACET: usize = FRICTION_FORCE + 1;
const SIDE: usize = FACET + 1;
const INSET: usize = SIDE + 1;
const ANCHOR: usize = INSET + 1;
const ROTATIONS: usize = ANCHOR + 3;

/// Number of history variables of a pair, `rotations` being those kept of the point's nodes.
pub(super) const fn width(has_friction: bool, rotations: usize) -> usize {
    if has_friction { ROTATIONS + 4 * rotations } else { ANCHOR }
}

/// The memory of one pair.
#[derive(Clone, Copy)]
pub(super) struct PairMemory<'a>(pub &'a [f64]);

impl<'a> PairMemory<'a> {
    /// What is kept as for a point against a surface.
    #[inline]
    pub fn motion(self) -> PointHistory<'a> {
        PointHistory::new(self.0)
    }

    /// The number of the facet; of a pair that is known.
    #[inline]
    pub fn facet(self) -> usize {
        self.0[FACET] as usize
    }

    /// 1 on the side to which the normal of the facet points, −1 on the other.
    #[inline]
    pub fn side(self) -> f64 {
        self.0[SIDE]
    }

    /// The depth at which the point was found where it came along the surface itself, as far as it has not come out since.
    #[inline]
    pub fn inset(self) -> f64 {
        self.0[INSET]
    }

    /// The anchor of the spring of friction in the base vectors of the facet, from its first node.
    #[inline]
    pub fn anchor(self) -> Vec3 {
        Vec3::from_column_slice(&self.0[ANCHOR..ROTATIONS])
    }

    /// Rotation of the point's k-th node relative to the frame of the facet.
    #[inline]
    pub fn rotation(self, k: usize) -> Quaternion<f64> {
        let q = &self.0[ROTATIONS + 4 * k..];
        Quaternion::new(q[0], q[1], q[2], q[3])
    }
}

/// The memory of one pair, to be written.
pub(super) struct PairMemoryMut<'a>(pub &'a mut [f64]);

impl PairMemoryMut<'_> {
    /// What is kept as for a point against a surface.
    pub fn motion(&mut self) -> PointHistoryMut<'_> {
        PointHistoryMut::new(self.0)
    }

    /// Sets the facet and the side.
    pub fn set_facet(&mut self, facet: usize, side: f64) {
        (self.0[FACET], self.0[SIDE]) = (facet as f64, side);
    }

    /// Sets the depth that does not push.
    pub fn set_inset(&mut self, inset: f64) {
        self.0[INSET] = inset;
    }

    /// Sets the anchor.
    pub fn set_anchor(&mut self, anchor: &Vec3) {
        self.0[ANCHOR..ROTATIONS].copy_from_slice(anchor.as_slice());
    }

    /// Sets the rotation of the point's k-th node.
    pub fn set_rotation(&mut self, k: usize, q: &Quaternion<f64>) {
        self.0[ROTATIONS + 4 * k..ROTATIONS + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
}
