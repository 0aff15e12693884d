//! Targets of an equilibrium path that stay zero because the plan omits their motion.

use super::Plan;
use super::dof_status::DofStatus;
use base::diagnostic::Diagnostic;
use model::{ArcLength, DIRECTIONS, DisplacementTarget, Model, StepLength, When};

/// An error for each `stop` and each `when` of the model whose displacement cannot change, with its place in the
/// deck.
pub fn unreachable_targets(plan: &Plan, model: &Model) -> Vec<Diagnostic> {
    let stop = match &model.analysis.step_length {
        StepLength::ArcLength(ArcLength { stop: Some(stop), .. }) => Some(stop),
        _ => None,
    };
    let expected = model.expects.iter().filter_map(|expect| match &expect.when {
        When::Target(target) => Some(target),
        _ => None,
    });
    let targets = stop.into_iter().chain(expected);
    targets.filter_map(|target| why_unreachable(plan, model, target)).collect()
}

fn why_unreachable(plan: &Plan, model: &Model, target: &DisplacementTarget) -> Option<Diagnostic> {
    let &DisplacementTarget { node, dof, place: [start, end], .. } = target;
    let why = match plan.nodes[node][dof] {
        // A dependent node moves with its master, which the deck allows or not.
        DofStatus::Unknown | DofStatus::Dependent | DofStatus::Reduced => return None,
        DofStatus::Restrained => "a support gives it",
        DofStatus::Unused => "nothing acts on it",
        DofStatus::Inactive => "nothing sets it moving",
        DofStatus::Plane => "the scene is plane, and this is normal to it",
    };
    let message = format!("{} of `{}` never changes: {why}", DIRECTIONS[dof], model.nodes[node].label);
    Some(Diagnostic::error(message).at(&(start..end)).hint("name a displacement that is an unknown"))
}
