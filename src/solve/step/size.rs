//! The size of a motion, translations and rotations apart.

use base::snapshot::keep;

/// The largest translation and the largest rotation of a set of nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Size {
    /// Largest displacement.
    pub translation: f64,
    /// Largest rotation, in radians.
    pub rotation: f64,
}

keep!(Size { translation, rotation });

impl Size {
    /// This size, unless the other is not a number.
    pub fn or_not_finite(self, other: Size) -> Size {
        if other.translation.is_nan() { other } else { self }
    }
}
