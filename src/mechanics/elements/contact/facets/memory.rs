//! Additional memory of a point and a facet: the facet and the side of the point, or the positions of the ends of two lines.

use crate::elements::contact::history::{OWN, PairMemory, PairMemoryMut};
use base::math::Vec3;
use nalgebra::Quaternion;

/// A pair of lines stores the stretch of friction in place of the anchor, then the positions of its ends.
const POSITIONS: usize = OWN + 2;
/// Number of stored ends: all but the first of the touched line, which is the origin of the others.
const STORED: usize = 3;
const TURNS: usize = POSITIONS + 3 * STORED;
/// The numbers of friction that are a pair of lines' own.
pub(super) const OF_LINES: usize = TURNS + 4 * STORED - OWN;

/// The index of the k-th end among the stored ones; `None` for the origin.
pub(super) fn place_of(end: usize) -> Option<usize> {
    [Some(0), Some(1), None, Some(2)][end]
}

impl PairMemory<'_> {
    /// The facet.
    #[inline]
    pub(super) fn facet(self) -> usize {
        self.key().abs() as usize - 1
    }

    /// 1 on the side of the facet's normal, −1 on the other.
    #[inline]
    pub(super) fn side(self) -> f64 {
        self.key().signum()
    }

    /// For two lines, the stretch of friction along the touched line, and across it.
    pub(super) fn stretch(self) -> [f64; 2] {
        [self.0[OWN], self.0[OWN + 1]]
    }

    /// Position of a stored end in the axes of the origin node.
    pub(super) fn end(self, stored: usize) -> Vec3 {
        Vec3::from_column_slice(&self.0[POSITIONS + 3 * stored..POSITIONS + 3 * stored + 3])
    }

    /// Its rotation relative to that node.
    pub(super) fn end_rotation(self, stored: usize) -> Quaternion<f64> {
        let q = &self.0[TURNS + 4 * stored..];
        Quaternion::new(q[0], q[1], q[2], q[3])
    }
}

impl PairMemoryMut<'_> {
    /// Sets the facet and the side.
    pub(super) fn set_facet(&mut self, facet: usize, side: f64) {
        self.set_key(side * (facet + 1) as f64);
    }

    /// Sets the stretch of two lines.
    pub(super) fn set_stretch(&mut self, stretch: [f64; 2]) {
        self.0[OWN..OWN + 2].copy_from_slice(&stretch);
    }

    /// Sets where a stored end stands, and how it is turned.
    pub(super) fn set_end(&mut self, stored: usize, x: &Vec3, q: &Quaternion<f64>) {
        self.0[POSITIONS + 3 * stored..POSITIONS + 3 * stored + 3].copy_from_slice(x.as_slice());
        self.0[TURNS + 4 * stored..TURNS + 4 * stored + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
}
