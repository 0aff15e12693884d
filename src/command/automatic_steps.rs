//! The scheme of automatic steps for blows of deformable parts, in decks without a scheme and an error. Steps that follow an error have been
//! shorter there than those of central differences, which cost less.

use super::explicit_steps::governor;
use base::names::to_digits;
use model::{MassKind, Model, StepLength};
use solve::system::System;
use std::collections::HashSet;

/// Largest number of critical steps of elements and contacts to the end. The critical step of the model is up to 1.6 times as long, so about 1e5
/// steps are taken. Chosen, not measured.
const MOST_STEPS: f64 = 1.5e5;
/// The entry that chooses them.
pub const CENTRAL: &str = "integrator.scheme=\"central-difference\"";

/// True where central differences may replace the scheme of automatic steps.
pub fn may_choose_central(model: &Model) -> bool {
    let is_consistent = |kind| kind == Some(MassKind::Consistent);
    model.analysis.stage.is_none()
        && model.solution.is_chosen()
        && matches!(model.analysis.step_length, StepLength::ErrorControlled { .. })
        && model.has_few_joint_equations()
        && !model.parts.iter().any(|part| is_consistent(part.mass_kind()))
        && strikes_deformable(model)
        // The step that links ask for is not known before the run, and a clearance monitor exerts no force.
        && model.parts.iter().all(|part| part.kind().is_deformable() || part.kind().is_unilateral())
        && System::critical_step_of_contacts(model).is_finite()
}

/// The reason for central differences, if they are to move this model; `None` where they take too many steps.
pub fn choice(model: &Model, system: &System) -> Option<String> {
    let steps = steps_to_end(model, system).filter(|&steps| steps < MOST_STEPS)?;
    Some(format!(
        "chosen for automatic steps without `error_tolerance`: parts that deform touch something, and elements and contacts ask for about {} steps. \
         `scheme` = \"esdirk3\" follows the error of the steps instead",
        to_digits(steps, 2)
    ))
}

/// True where nodes of deformable parts touch or are touched.
pub fn strikes_deformable(model: &Model) -> bool {
    let nodes = |part: &model::Part| (0..part.elements()).flat_map(|element| part.nodes(element).to_vec()).collect();
    let deformable = model.parts.iter().filter(|part| part.kind().is_deformable());
    let deform: HashSet<usize> = deformable.flat_map(|part| -> Vec<usize> { nodes(part) }).collect();
    let mut contacts = model.parts.iter().filter(|part| part.kind().is_unilateral());
    contacts.any(|contact| nodes(contact).iter().chain(&contact.touched_nodes()).any(|node| deform.contains(node)))
}

/// The number of steps of central differences to the end, by the critical steps of elements and contacts.
fn steps_to_end(model: &Model, system: &System) -> Option<f64> {
    let StepLength::StabilityLimited { fraction } = model.analysis.step_length else { return None };
    let step = governor(model, system)?.step.min(System::critical_step_of_contacts(model));
    Some(model.analysis.duration() / (fraction * step))
}
