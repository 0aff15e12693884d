//! The memory of friction between convex solids: the stretch of its spring and the pose at the last state.

use crate::elements::contact::history::{OWN, PairMemory};
use base::math::{Mat3, Vec3};

const STRETCH: usize = OWN;
const TWIST: usize = STRETCH + 3;
const PLACE: usize = TWIST + 1;
const AXES: usize = PLACE + 3;
const END: usize = AXES + 9;
/// The numbers of friction that are a pair's own.
pub const OWN_NUMBERS: usize = END - OWN;

/// The memory of friction, in the frame of the one that is touched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// Stretch of the spring along the faces.
    pub stretch: Vec3,
    /// Angle of the spring about their normal.
    pub twist: f64,
    /// Centre of the one.
    pub y: Vec3,
    /// Axes of the one.
    pub Q: Mat3,
}

impl Memory {
    /// The rotation vector from the axes remembered to others, exact for small angles: from the sine, not the cosine.
    pub fn turned(&self, Q: &Mat3) -> Vec3 {
        let M = Q * self.Q.transpose();
        let sine = 0.5 * Vec3::new(M[(2, 1)] - M[(1, 2)], M[(0, 2)] - M[(2, 0)], M[(1, 0)] - M[(0, 1)]);
        let size = sine.norm();
        if size > 0.0 { size.atan2(0.5 * (M.trace() - 1.0)) / size * sine } else { Vec3::zeros() }
    }

    /// Reads the history of a pair with friction.
    pub(super) fn read(old: PairMemory) -> Memory {
        let numbers = old.0;
        Memory {
            stretch: Vec3::from_column_slice(&numbers[STRETCH..TWIST]),
            twist: numbers[TWIST],
            y: Vec3::from_column_slice(&numbers[PLACE..AXES]),
            Q: Mat3::from_column_slice(&numbers[AXES..END]),
        }
    }

    /// Writes it behind the rest of a pair's history.
    pub fn write(&self, numbers: &mut [f64]) {
        numbers[STRETCH..TWIST].copy_from_slice(self.stretch.as_slice());
        numbers[TWIST] = self.twist;
        numbers[PLACE..AXES].copy_from_slice(self.y.as_slice());
        numbers[AXES..END].copy_from_slice(self.Q.as_slice());
    }
}
