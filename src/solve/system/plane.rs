//! Planes of motion: vectors and tensors that stay in a plane normal to a global axis.

use crate::tolerances::plane::SMALL;
use base::math::{Mat3, Vec3};

/// A plane normal to a global axis, through the first node.
pub struct MotionPlane {
    /// Index of the axis.
    pub normal: usize,
    /// Largest distance of a node from the first.
    pub size: f64,
}

impl MotionPlane {
    /// True for a vector in the plane. It is judged by its largest entry: the norm of large numbers overflows, and nothing
    /// exceeds infinity.
    pub fn contains(&self, v: &Vec3) -> bool {
        // The comparison is not reversed, so that non-finite entries do not count as outside.
        let outside = v[self.normal].abs() > SMALL * v.amax();
        !outside
    }

    /// True for a vector normal to the plane.
    pub fn is_normal(&self, v: &Vec3) -> bool {
        !(0..3).any(|i| i != self.normal && v[i].abs() > SMALL * v.amax())
    }

    /// True for a symmetric tensor that does not couple the normal with the plane.
    pub fn decouples(&self, J: &Mat3) -> bool {
        let n = self.normal;
        !(0..3).any(|i| i != n && J[(n, i)].abs().max(J[(i, n)].abs()) > SMALL * J.amax())
    }

    /// False for a matrix that couples a vector in the plane with a rotation about an axis in the plane, or the normal
    /// with a rotation about it.
    pub fn decouples_rotations(&self, K: &Mat3) -> bool {
        let n = self.normal;
        !(0..3).any(|i| (0..3).any(|j| (i == n) == (j == n) && K[(i, j)].abs() > SMALL * K.amax()))
    }
}
