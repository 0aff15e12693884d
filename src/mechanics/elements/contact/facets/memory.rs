//! What a pair of a point and a facet remembers, as a typed view of its numbers: the motion along the normal as that of a point
//! against a surface, then the facet and the side of it on which the point is, then what friction keeps.

use crate::elements::contact::history::{FRICTION_FORCE, PointHistory, PointHistoryMut};
use base::math::Vec3;
use nalgebra::Quaternion;

const FACET: usize = FRICTION_FORCE + 1;
const SIDE: usize = FACET + 1;
const INSET: usize = SIDE + 1;
const ANCHOR: usize = INSET + 1;
const SLIP_SPEED: usize = ANCHOR + 3;
const ROTATIONS: usize = SLIP_SPEED + 1;

/// Number of history variables of a pair, `rotations` being those kept of the point's nodes.
pub(super) const fn width(has_friction: bool, rotations: usize) -> usize {
    if has_friction { ROTATIONS + 4 * rotations } else { ANCHOR }
}

/// Number of history variables of a pair of lines.
pub(super) const fn width_of_lines(has_friction: bool) -> usize {
    if has_friction { TURNS + 4 * STORED } else { ANCHOR }
}

/// Of a pair of lines the stretch of friction stands where others have their anchor, then where their ends stood.
const SLIP_SPEED_OF_LINES: usize = ANCHOR + 2;
const POSITIONS: usize = SLIP_SPEED_OF_LINES + 1;
/// Ends that are stored: all but the first of the line that is touched, from which they are seen.
const STORED: usize = 3;
const TURNS: usize = POSITIONS + 3 * STORED;

/// What friction remembers of a pair of lines, a view of all numbers of the pair.
#[derive(Clone, Copy)]
pub(super) struct LineMemory<'a>(pub &'a [f64]);

impl LineMemory<'_> {
    /// Where the k-th end stands among those stored; `None` for the one from which the others are seen.
    pub fn place_of(end: usize) -> Option<usize> {
        [Some(0), Some(1), None, Some(2)][end]
    }

    /// The stretch along the line that is touched, and across it.
    pub fn stretch(self) -> [f64; 2] {
        [self.0[ANCHOR], self.0[ANCHOR + 1]]
    }

    /// The slip speed of the step before the last state.
    pub fn slip_speed(self) -> f64 {
        self.0[SLIP_SPEED_OF_LINES]
    }

    /// A stored end in the axes of the node from which it is seen.
    pub fn position(self, stored: usize) -> Vec3 {
        Vec3::from_column_slice(&self.0[POSITIONS + 3 * stored..POSITIONS + 3 * stored + 3])
    }

    /// Its rotation relative to that node.
    pub fn rotation(self, stored: usize) -> Quaternion<f64> {
        let q = &self.0[TURNS + 4 * stored..];
        Quaternion::new(q[0], q[1], q[2], q[3])
    }
}

/// The same, to be written.
pub(super) struct LineMemoryMut<'a>(pub &'a mut [f64]);

impl LineMemoryMut<'_> {
    /// Sets the stretch.
    pub fn set_stretch(&mut self, stretch: [f64; 2]) {
        self.0[ANCHOR..ANCHOR + 2].copy_from_slice(&stretch);
    }

    /// Sets the slip speed.
    pub fn set_slip_speed(&mut self, slip_speed: f64) {
        self.0[SLIP_SPEED_OF_LINES] = slip_speed;
    }

    /// Sets where a stored end stands, and how it is turned.
    pub fn set(&mut self, stored: usize, x: &Vec3, q: &Quaternion<f64>) {
        self.0[POSITIONS + 3 * stored..POSITIONS + 3 * stored + 3].copy_from_slice(x.as_slice());
        self.0[TURNS + 4 * stored..TURNS + 4 * stored + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
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
        Vec3::from_column_slice(&self.0[ANCHOR..SLIP_SPEED])
    }

    /// The slip speed of the step before the last state.
    #[inline]
    pub fn slip_speed(self) -> f64 {
        self.0[SLIP_SPEED]
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
        self.0[ANCHOR..SLIP_SPEED].copy_from_slice(anchor.as_slice());
    }

    /// Sets the slip speed.
    pub fn set_slip_speed(&mut self, slip_speed: f64) {
        self.0[SLIP_SPEED] = slip_speed;
    }

    /// Sets the rotation of the point's k-th node.
    pub fn set_rotation(&mut self, k: usize, q: &Quaternion<f64>) {
        self.0[ROTATIONS + 4 * k..ROTATIONS + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
    }
}
