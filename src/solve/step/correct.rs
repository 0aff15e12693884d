//! The correction of the increments, and its size.

use crate::context::Context;
use crate::step::size::Size;
use crate::tolerances::correction::{LARGEST, ROUNDING, SLENDER, STILL};
use crate::workspace::Workspace;
use base::math::rotation::inverse_tangent;
use base::math::{Vec6, angular, larger};

/// The size of the correction in `r`.
pub fn size_of_correction(cx: &Context, ws: &Workspace) -> Size {
    let mut size = Size::default();
    for (r, &(_, dof)) in ws.r.iter().zip(cx.plan.dofs.nodal_dofs()) {
        let largest = if dof < 3 { &mut size.translation } else { &mut size.rotation };
        *largest = largest.max(r.abs());
    }
    size
}

/// Shortens the correction in `r` to what may still lie on the way to the equilibrium; returns whether it did. A flat membrane resists
/// pressure by its bending alone until it has moved: its first correction is far too long, and each later one takes a third of that back.
pub fn shorten(cx: &Context, ws: &mut Workspace) -> bool {
    let size = size_of_correction(cx, ws);
    let excess = (size.translation / (LARGEST[0] * cx.length)).max(size.rotation / LARGEST[1]);
    let is_long = excess > 1.0 && excess.is_finite();
    if is_long {
        ws.r.iter_mut().for_each(|r| *r /= excess);
    }
    is_long
}

/// Adds the correction in `r` to the increments and the multipliers. Returns its size and that of the increments.
pub fn correct(cx: &Context, ws: &mut Workspace) -> (Size, Size) {
    let (mut correction, mut motion) = (Size::default(), Size::default());
    for &node in &cx.independent_nodes {
        let rows = cx.plan.dofs.of(node);
        let entry = |i: usize| rows.get(i).map_or(0.0, |row| ws.r[row]);
        let increment = &mut ws.increments[node].q;
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
    ws.forces.multipliers.add(&ws.r[cx.nodal_unknowns()..]);
    (correction, motion)
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

/// True for a correction that changes only the last digits of positions. The iteration must have stopped contracting as
/// well, for increments and accelerations have more digits than positions. Axial stiffness turns rounding of positions
/// into forces, and bending answers these with corrections larger by the slenderness squared. Where even a `fresh`
/// matrix does not help, four more digits are allowed for that, and rotations follow positions over the model's length.
pub fn is_rounding(cx: &Context, ws: &Workspace, correction: Size, fresh: bool) -> bool {
    let (translation, rotation) = if fresh {
        (SLENDER * ROUNDING * ws.reach, SLENDER * ROUNDING * (ws.reach / cx.length).max(1.0))
    } else {
        (ROUNDING * ws.reach, ROUNDING)
    };
    correction.translation <= translation && correction.rotation <= rotation
}
