//! The correction of a trial motion, and its size.

use crate::context::Context;
use crate::step::size::Size;
use crate::step::trial::TrialMotion;
use crate::system::{Multipliers, NodeRows};
use crate::tolerances::correction::{LARGEST, ROUNDING, SLENDER, STILL};
use base::math::rotation::inverse_tangent;
use base::math::{Vec6, angular, larger};
use base::snapshot::keep;

/// The solution of a linear system by unknown: displacements and rotations, then multipliers as used by [`Multipliers::add`].
pub struct Correction {
    /// Its entries.
    pub values: Vec<f64>,
}

keep!(Correction { values });

impl Correction {
    /// No correction.
    pub fn new(cx: &Context) -> Correction {
        Correction { values: vec![0.0; cx.plan.dofs.unknowns()] }
    }

    /// The motion of a node; zero where it has no unknown.
    pub fn of(&self, rows: &NodeRows) -> Vec6 {
        rows.gather(&self.values)
    }

    /// The entries of nodes.
    pub fn of_nodes(&self, cx: &Context) -> &[f64] {
        &self.values[..cx.nodal_unknowns()]
    }

    /// The entries of multipliers.
    pub fn of_multipliers(&self, cx: &Context) -> &[f64] {
        &self.values[cx.nodal_unknowns()..]
    }

    /// The largest translation and the largest rotation.
    pub fn size(&self, cx: &Context) -> Size {
        let mut size = Size::default();
        for (r, &(_, dof)) in self.values.iter().zip(cx.plan.dofs.nodal_dofs()) {
            let largest = if dof < 3 { &mut size.translation } else { &mut size.rotation };
            *largest = largest.max(r.abs());
        }
        size
    }

    /// Shortens the correction to a length that may still lead to the equilibrium; returns whether it did. A flat membrane resists
    /// pressure only by its bending stiffness until it has moved. Its first correction is far too long, and each later one reduces it by
    /// only a third.
    pub fn shorten(&mut self, cx: &Context) -> bool {
        let size = self.size(cx);
        let excess = (size.translation / (LARGEST[0] * cx.length)).max(size.rotation / LARGEST[1]);
        let is_long = excess > 1.0 && excess.is_finite();
        if is_long {
            self.values.iter_mut().for_each(|r| *r /= excess);
        }
        is_long
    }

    /// Adds the correction to the increments and the multipliers. Returns its size and the size of the increments.
    pub fn add_to(&self, cx: &Context, trial: &mut TrialMotion, multipliers: &mut Multipliers) -> (Size, Size) {
        let (mut correction, mut motion) = (Size::default(), Size::default());
        for &node in &cx.independent_nodes {
            let rows = cx.plan.dofs.of(node);
            let entry = |i: usize| rows.get(i).map_or(0.0, |row| self.values[row]);
            let increment = &mut trial.increments[node].q;
            let dq = Vec6::from_fn(|i, _| entry(i));
            let theta = angular(increment);
            // δΘ = T⁻¹ δθ
            let dtheta = inverse_tangent(&theta, &angular(&dq));
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
        multipliers.add(self.of_multipliers(cx));
        (correction, motion)
    }
}

/// The size of a correction relative to the motion of the step, the larger of translations and rotations, with floors
/// for scenes at rest.
pub fn relative(cx: &Context, correction: Size, motion: Size) -> f64 {
    if correction.translation.is_nan() {
        return f64::NAN;
    }
    let translation = correction.translation / motion.translation.max(STILL * cx.length);
    translation.max(correction.rotation / motion.rotation.max(STILL))
}

/// True if a correction changes only the last digits of positions, whose magnitude is `reach`. The iteration must have stopped contracting
/// as well, for increments and accelerations have more digits than positions. Axial stiffness turns rounding of positions into forces, and
/// these cause bending corrections larger by the slenderness squared. With a `fresh` matrix the limit is wider by four digits, and the
/// limit of rotations follows positions over the model's length.
pub fn is_rounding(cx: &Context, reach: f64, correction: Size, fresh: bool) -> bool {
    let (translation, rotation) = if fresh {
        (SLENDER * ROUNDING * reach, SLENDER * ROUNDING * (reach / cx.length).max(1.0))
    } else {
        (ROUNDING * reach, ROUNDING)
    };
    correction.translation <= translation && correction.rotation <= rotation
}
