//! The size of a motion, translations and rotations apart.

use base::snapshot::keep;

/// The lengths that the motions of a model are measured by.
#[derive(Debug, Clone, Copy)]
pub struct ModelSize {
    /// The reference length between translations and rotations.
    pub length: f64,
    /// The length below which a motion is rounding.
    pub rounding: f64,
}

impl ModelSize {
    /// The least motion that rounding lets have this relative error.
    pub fn least_motion(self, error: f64) -> Size {
        let translation = self.rounding / error;
        Size { translation, rotation: translation / self.length }
    }

    /// True for a motion that is more than rounding.
    pub fn is_seen(self, motion: Size) -> bool {
        motion.translation > self.rounding || motion.rotation * self.length > self.rounding
    }
}

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
    /// The larger of each kind.
    pub fn max(self, other: Size) -> Size {
        Size { translation: self.translation.max(other.translation), rotation: self.rotation.max(other.rotation) }
    }

    /// This size, unless the other is not a number.
    pub fn or_not_finite(self, other: Size) -> Size {
        if other.translation.is_nan() { other } else { self }
    }
}
