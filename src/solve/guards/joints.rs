//! Checks whether the joints are closed at the end of a step.

use crate::context::Context;
use crate::failure::{self, Failure, NamedResidual};
use crate::guards::guard::Guard;
use crate::step::trial::Step;
use crate::tolerances::joints::{LARGEST_GAP, NO_INERTIA, UNLIKE};
use crate::workspace::Workspace;
use mechanics::materials::Dissipation;
use mechanics::state::Node;
use model::Body;

/// Refuses a step whose joints are open at its end.
pub struct JointGuard;

impl Guard for JointGuard {
    fn at_end(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        _step: &Step,
        _dissipated: &Dissipation,
    ) -> Result<(), Failure> {
        let gap = check(cx, &ws.end.nodes, ws.reach, &mut ws.forces.multipliers.gaps)?;
        ws.joint_violation = ws.joint_violation.max(gap);
        Ok(())
    }
}

/// Like [`check`], for the trial motion; the workspace keeps the largest gap.
///
/// # Errors
/// As for [`check`].
pub fn note(cx: &Context, ws: &mut Workspace) -> Result<(), Failure> {
    let gap = check(cx, &ws.trial.nodes, ws.reach, &mut ws.forces.multipliers.gaps)?;
    ws.joint_violation = ws.joint_violation.max(gap);
    Ok(())
}

/// Writes the gaps of the joints between these nodes. Returns the largest relative to the largest coordinate, `reach`.
///
/// # Errors
/// [`Failure::ConstraintsViolated`] where joints have not closed, however well forces balance: they contradict each other.
pub fn check(cx: &Context, nodes: &[Node], reach: f64, gaps: &mut [f64]) -> Result<f64, Failure> {
    if cx.system.joints.is_empty() {
        return Ok(0.0);
    }
    cx.system.gaps(nodes, 0, gaps);
    let gap = cx.system.largest_gap(gaps, reach);
    if gap > LARGEST_GAP || gap.is_nan() {
        return Err(constraints_violated(cx, gaps));
    }
    Ok(gap)
}

/// The failure of joints that cannot be closed, with their largest gaps.
pub fn constraints_violated(cx: &Context, gaps: &[f64]) -> Failure {
    Failure::ConstraintsViolated { largest: failure::gaps(cx.model, cx.system, gaps), inertias: unlike_inertias(cx) }
}

/// Smallest and largest principal inertia of all bodies, if their ratio exceeds the digits of accelerations; otherwise empty.
fn unlike_inertias(cx: &Context) -> Vec<NamedResidual> {
    let principal = cx.model.bodies.iter().flat_map(|body| {
        let moments = body.inertia.symmetric_eigenvalues();
        // An axis without inertia rotates with its body.
        let own =
            [moments.x, moments.y, moments.z].into_iter().filter(move |&moment| moment > NO_INERTIA * moments.max());
        own.map(move |moment| (body, moment))
    });
    let least = principal.clone().min_by(|a, b| a.1.total_cmp(&b.1));
    let most = principal.max_by(|a, b| a.1.total_cmp(&b.1));
    let named =
        |(body, moment): (&Body, f64)| NamedResidual { label: body.name.clone(), direction: "", residual: moment };
    match (least, most) {
        (Some(least), Some(most)) if most.1 > UNLIKE * least.1 => vec![named(least), named(most)],
        _ => Vec::new(),
    }
}
