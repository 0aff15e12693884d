//! Checks whether the joints are closed at the end of a step.

use crate::context::Context;
use crate::failure::{self, Failure};
use crate::tolerances::joints::LARGEST_GAP;
use crate::workspace::Workspace;

/// Measures the gaps of the trial motion and keeps the largest in the workspace.
///
/// # Errors
/// [`Failure::ConstraintsViolated`] where joints have not closed, however well forces balance: they contradict each other.
pub fn check(cx: &Context, ws: &mut Workspace) -> Result<(), Failure> {
    if cx.system.joints.is_empty() {
        return Ok(());
    }
    let gaps = &mut ws.forces.multipliers.gaps;
    cx.system.gaps(&ws.trial, 0, gaps);
    let gap = cx.system.largest_gap(gaps, ws.reach);
    if gap > LARGEST_GAP || gap.is_nan() {
        return Err(constraints_violated(cx, ws));
    }
    ws.joint_violation = ws.joint_violation.max(gap);
    Ok(())
}

/// The failure of joints that cannot be closed; the gaps at hand say where.
pub fn constraints_violated(cx: &Context, ws: &Workspace) -> Failure {
    Failure::ConstraintsViolated { largest: failure::gaps(cx.model, cx.system, &ws.forces.multipliers.gaps) }
}
