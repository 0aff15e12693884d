//! The magnitudes of forces and moments.

use crate::tolerances::scale::ARM;
use base::math::{Vec3, larger};
use base::snapshot::keep;
use mechanics::elements::Force;

/// The largest force and the largest moment met while a residual is summed. The residual is judged relative to them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Scale {
    /// Largest absolute force component, global.
    pub force: f64,
    /// Largest absolute moment component, global.
    pub moment: f64,
}

keep!(Scale { force, moment });

impl Scale {
    /// The scale of moments in a scene of this size, where these may be rounding of forces.
    pub fn moment_beside_forces(&self, length: f64) -> f64 {
        self.moment.max(ARM * length * self.force)
    }

    /// The larger of two scales, of forces and of moments.
    pub fn or_larger(&self, other: &Scale) -> Scale {
        Scale { force: larger(self.force, other.force), moment: larger(self.moment, other.moment) }
    }

    /// Raises the scale of forces to the largest component of a force.
    #[inline]
    pub(super) fn include_force(&mut self, f: &Vec3) {
        self.force = f.iter().fold(self.force, |most, f| larger(most, f.abs()));
    }

    /// Raises the scale of moments to the largest component of a moment.
    #[inline]
    pub(super) fn include_moment(&mut self, m: &Vec3) {
        self.moment = m.iter().fold(self.moment, |most, m| larger(most, m.abs()));
    }

    /// Raises both scales to the largest components of forces and moments on nodes.
    #[inline]
    pub(super) fn include(&mut self, forces: &[Force]) {
        let mut most = [0.0; 6];
        for f in forces {
            for i in 0..6 {
                most[i] = larger(most[i], f[i].abs());
            }
        }
        self.force = larger(self.force, larger(most[0], larger(most[1], most[2])));
        self.moment = larger(self.moment, larger(most[3], larger(most[4], most[5])));
    }
}
