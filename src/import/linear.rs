//! Linear statics: which files are one linear analysis, and its time steps.

use crate::dialect::Dialect;
use crate::file_content::{PropertyOf, StepCard, StepProcedure, SupportLine};
use crate::importer::Importer;
use std::collections::BTreeSet;

/// How near the length of a step must come to whole time steps, over a time step.
const WHOLE: f64 = 1e-9;
/// The most time steps in the shortest step of the file.
const PARTS: u32 = 100;

/// The time step of the linear analysis that all steps of a file are together; `None` where they are none. Loads of each step then act in
/// full at its end.
pub fn time_step(im: &Importer) -> Option<f64> {
    let mut lengths = Vec::new();
    let mut shortest = f64::INFINITY;
    for step in &im.steps.list {
        match &step.procedure {
            Some((StepProcedure::Static { step: first, duration, is_riks: false }, _))
                if !step.is_nonlinear() && step.changes.is_empty() =>
            {
                lengths.push(*duration);
                shortest = shortest.min(if step.has_amplitude() { *first } else { *duration });
            }
            _ => return None,
        }
    }
    if lengths.is_empty() || !has_linear_parts(im) || has_changing_supports(im) {
        return None;
    }
    let fits = |step: f64| {
        lengths.iter().all(|length| {
            let count = (length / step).round();
            (length - count * step).abs() <= WHOLE * step
        })
    };
    (1..=PARTS).map(|parts| shortest / f64::from(parts)).find(|step| fits(*step))
}

/// Ends the loads of each step of Abaqus before a static perturbation, which has its own loads alone.
pub fn end_loads_before_perturbations(im: &mut Importer) {
    let is_abaqus = im.dialect == Some(Dialect::Abaqus);
    for step in im.steps.list.iter_mut().filter(|step| is_abaqus && perturbs(step)) {
        (step.new_forces, step.new_spread, step.new_temperatures) = (true, true, true);
    }
}

/// Why the static perturbations of a file cannot be steps of the deck. One alone is a step like others.
pub fn fault_of_perturbations(im: &Importer, is_linear: bool) -> Option<&'static str> {
    let steps = &im.steps.list;
    let timed = || steps.iter().filter(|step| step.advances_time());
    let goes_back = timed().skip_while(|step| !perturbs(step)).any(|step| !perturbs(step));
    let moves = timed().flat_map(|step| &step.supports).any(|support| support.value != 0.0);
    let is_driven = !im.connectors.drives.is_empty();
    let heats = timed().any(|step| perturbs(step) && !step.temperatures.is_empty());
    match im.dialect {
        _ if timed().count() < 2 || !timed().any(perturbs) => None,
        Some(Dialect::Abaqus) if is_linear && !goes_back && !moves && !is_driven && !heats => None,
        None => Some(
            "a perturbation has its own loads alone in Abaqus, and is about the loaded state in CalculiX: say --from \
             abaqus or --from calculix",
        ),
        Some(Dialect::Calculix) => Some("a perturbation is about the loaded state: give each step a file"),
        Some(Dialect::Abaqus) => Some(
            "perturbations follow linear static steps, without moved supports, driven connectors, temperatures of their own \
             or modes beside them: give each step a file",
        ),
    }
}

fn perturbs(step: &StepCard) -> bool {
    step.is_perturbation && matches!(step.procedure, Some((StepProcedure::Static { .. }, _)))
}

/// True where no force depends on the state.
fn has_linear_parts(im: &Importer) -> bool {
    let is_plastic = im.materials.list.iter().any(|material| !material.plastic.is_empty());
    let opens = im.properties.iter().any(|card| card.is_nonlinear || card.of == PropertyOf::Gap);
    let is_slack = im.materials.list.iter().any(|material| material.no_compression.is_some());
    !is_plastic && !opens && !is_slack && im.constraints.contacts.pairs.is_empty()
}

/// True where a degree of freedom is held or freed in a later step.
fn has_changing_supports(im: &Importer) -> bool {
    let held_in = |step: &StepCard| -> BTreeSet<(String, usize)> {
        let name = |line: &SupportLine| line.target.name.to_lowercase();
        step.supports.iter().flat_map(|line| line.degrees.iter().map(move |dof| (name(line), *dof))).collect()
    };
    let mut known = held_in(&im.steps.before);
    let Some((first, later)) = im.steps.list.split_first() else { return false };
    known.extend(held_in(first));
    later.iter().any(|step| {
        let held = held_in(step);
        if step.new_supports { held != known } else { !held.is_subset(&known) }
    })
}
