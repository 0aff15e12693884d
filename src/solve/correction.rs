//! What is left of the forces, what corrects the increments, and how small that is.

use super::step::Stepper;
use crate::math::rotation::inverse_tangent;
use crate::math::{Vec6, bottom, larger};
use crate::system::Scale;

/// Largest translations and rotations of a set of increments.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Size {
    pub translation: f64,
    pub rotation: f64,
}

impl Size {
    /// This size, unless the other is not a number.
    pub(super) fn or_not_finite(self, other: Size) -> Size {
        if other.translation.is_nan() { other } else { self }
    }
}

impl Stepper<'_> {
    /// Residual per unknown; returns its largest entry relative to the forces (moments) it is made of.
    pub(super) fn gather(&mut self, scale: &Scale) -> f64 {
        let (mut force, mut moment) = (0.0, 0.0);
        for (r, &(node, dof)) in self.r.iter_mut().zip(&self.plan.directions) {
            *r = self.forces.on_nodes[node][dof];
            // NaN must not vanish in a comparison.
            let size = if r.is_nan() { f64::INFINITY } else { r.abs() };
            if dof < 3 {
                force = larger(force, size);
            } else {
                moment = larger(moment, size);
            }
        }
        // Forces and moments apart; one counts against the other over the model's length where its own scale is nil.
        let forces = scale.force.max(1e-3 * scale.moment / self.length);
        let moments = scale.moment.max(1e-3 * scale.force * self.length);
        let ratio = |size: f64, of: f64| if size == 0.0 { 0.0 } else { size / of.max(f64::MIN_POSITIVE) };
        ratio(force, forces).max(ratio(moment, moments))
    }

    /// Mixes the correction in `r`, where material yields, and keeps it. Returns its size before that.
    #[inline(never)]
    pub(super) fn prepare(&mut self) -> Size {
        let plain = self.largest_correction();
        if let Some(anderson) = &mut self.anderson {
            anderson.mix(&mut self.r);
        }
        if let Some(search) = &mut self.search {
            let correction = &self.r[..self.plan.directions.len()];
            search.keep_correction(correction, &self.increments, &self.forces.multipliers.values);
        }
        plain
    }

    /// Of the correction in `r`.
    pub(super) fn largest_correction(&self) -> Size {
        let mut size = Size::default();
        for (r, &(_, dof)) in self.r.iter().zip(&self.plan.directions) {
            let largest = if dof < 3 { &mut size.translation } else { &mut size.rotation };
            *largest = largest.max(r.abs());
        }
        size
    }

    /// Adds the correction in `r` to the increments. Returns its size and that of the increments.
    pub(super) fn correct(&mut self) -> (Size, Size) {
        let (mut correction, mut motion) = (Size::default(), Size::default());
        for &node in &self.movers {
            let rows = self.plan.dofs.of(node);
            let entry = |i: usize| rows.get(i).map_or(0.0, |row| self.r[row]);
            let increment = &mut self.increments[node].q;
            let dq = Vec6::from_fn(|i, _| entry(i));
            let theta = bottom(increment);
            // δΘ = T⁻¹ δθ
            let dtheta = inverse_tangent(&theta, &bottom(&dq));
            for i in 0..3 {
                increment[i] += dq[i];
                if rows.has(3 + i) {
                    increment[3 + i] += dtheta[i];
                }
                correction.translation = larger(correction.translation, dq[i].abs());
                correction.rotation = larger(correction.rotation, dq[3 + i].abs());
                motion.translation = larger(motion.translation, increment[i].abs());
                motion.rotation = larger(motion.rotation, increment[3 + i].abs());
            }
            if dq.iter().any(|c| !c.is_finite()) {
                correction.translation = f64::NAN;
            }
        }
        self.forces.multipliers.add(&self.r[self.plan.directions.len()..]);
        (correction, motion)
    }

    /// Correction relative to the motion of the step, translations and rotations apart, with floors for scenes at rest.
    pub(super) fn relative(&self, correction: Size, motion: Size) -> f64 {
        const STILL: f64 = 1e-6; // of the model's length, or radians: a step that moves less is judged on this
        if correction.translation.is_nan() {
            return f64::NAN;
        }
        let translation = correction.translation / motion.translation.max(STILL * self.length);
        translation.max(correction.rotation / motion.rotation.max(STILL))
    }

    /// True for a correction that only stirs the last digits of the positions. (It must have stopped to contract as well:
    /// increments, and the accelerations that follow from them, have more digits than positions.) The axial stiffness
    /// turns these digits into forces, and bending answers them with corrections that are larger by the slenderness
    /// squared: where even a `fresh` matrix does not help, four digits more are given for that, and rotations follow the
    /// positions over the model's length.
    pub(super) fn is_rounding(&self, correction: Size, fresh: bool) -> bool {
        const ROUNDING: f64 = 4.0 * f64::EPSILON;
        let (translation, rotation) = if fresh {
            (1e4 * ROUNDING * self.reach, 1e4 * ROUNDING * (self.reach / self.length).max(1.0))
        } else {
            (ROUNDING * self.reach, ROUNDING)
        };
        correction.translation <= translation && correction.rotation <= rotation
    }
}
