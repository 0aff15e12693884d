//! The analysis or the stages of the deck.

use crate::build::Build;
use crate::deck_text::{DeckTable, inline, number, quoted};
use crate::file_content::{DampingOfModes, StepCard, StepProcedure};
use crate::harmonics;
use crate::linear;

/// Why a file without steps is refused.
const NO_STEPS: &str = "the file has no *STEP, and nothing tells what to compute";

/// Adds the analysis or the stages.
pub fn stages(build: &mut Build) {
    for step in &build.im.steps.list.clone() {
        if step.procedure.is_none() {
            build.im.refuse(step.line, "this step computes nothing that rdsolve has");
        }
    }
    if let Some(why) = linear::fault_of_perturbations(build.im, build.timeline.linear_step.is_some())
        && let Some(step) = build.im.steps.list.iter().find(|step| step.is_perturbation)
    {
        build.im.refuse(step.line, why);
    }
    if build.im.steps.list.is_empty() {
        build.im.refuse(1, NO_STEPS);
    }
    if !build.im.steps.list.is_empty() && !build.timeline.general.is_empty() {
        lines_of_modes(build);
    }
    if let Some(step) = build.timeline.linear_step {
        return linear(build, step);
    }
    let stages = build.timeline.stages.clone();
    for stage in &stages {
        let step = build.im.steps.list[stage.step].clone();
        let Some((procedure, line)) = &step.procedure else { continue };
        say_changes(build, &step, procedure, *line);
        let table = match build.timeline.is_staged() {
            true => DeckTable::new("stages", step.line).with_lines([*line]).text("name", &stage.name),
            false => DeckTable::new("analysis", step.line).with_lines([*line]),
        };
        let table = table.text("kind", kind(procedure));
        let table = times(table, procedure, build.timeline.is_staged());
        let table = match step.damping {
            Some((DampingOfModes::Ratio(ratio), ..)) => table.number("damping_ratio", ratio),
            _ => table,
        };
        let scheme = scheme(procedure);
        let table = match scheme {
            Some(keys) if build.timeline.is_staged() => table.value("integrator", inline(&keys)),
            Some(keys) => {
                let integrator = keys
                    .into_iter()
                    .fold(DeckTable::new("integrator", *line), |table, (key, value)| table.value(key, value));
                build.deck.add(integrator);
                table
            }
            None => table,
        };
        build.deck.add(table);
    }
}

/// Adds the linear analysis that all steps are together.
fn linear(build: &mut Build, time_step: f64) {
    let lines: Vec<usize> = build.im.steps.list.iter().map(|step| step.line).collect();
    let table = DeckTable::new("analysis", lines[0])
        .with_lines(lines)
        .text("kind", "static")
        .text("geometry", "linear")
        .number("end_time", build.timeline.end())
        .number("time_step", time_step);
    build.deck.add(table);
}

/// Supports in a step of modes hold only there. A deck cannot express this beside steps that advance time.
fn lines_of_modes(build: &mut Build) {
    let timed = |at: usize| build.timeline.stages[at].duration > 0.0;
    if !build.timeline.general.iter().any(|&at| timed(at)) {
        return;
    }
    let steps = &build.im.steps.list;
    let without_time = build.timeline.stages.iter().filter(|stage| stage.duration == 0.0);
    let lines: Vec<usize> =
        without_time.flat_map(|stage| &steps[stage.step].supports).map(|support| support.line).collect();
    for line in lines {
        build.im.refuse(line, "supports of a step of modes hold in that step alone; put them before the first step");
    }
}

/// The kind of an analysis.
fn kind(procedure: &StepProcedure) -> &'static str {
    match procedure {
        StepProcedure::Static { .. } => "static",
        StepProcedure::Dynamic { .. } => "dynamic",
        StepProcedure::Frequency { .. } => "modal",
        StepProcedure::Buckle { .. } => "buckling",
        StepProcedure::Response(_) => "frequency-response",
    }
}

/// Reports a procedure that the deck computes in another way.
fn say_changes(build: &mut Build, step: &StepCard, procedure: &StepProcedure, line: usize) {
    match procedure {
        StepProcedure::Static { .. } if !step.is_nonlinear() => {
            build.im.change(line, "a step without NLGEOM is linear; beside other steps, gaps and yielding rdsolve computes it at large displacements");
        }
        StepProcedure::Dynamic { .. } if !step.is_nonlinear() => {
            build
                .im
                .change(line, "a step without NLGEOM is linear; rdsolve computes the motion at large displacements");
        }
        StepProcedure::Static { is_riks: true, .. } if build.timeline.is_staged() => {
            build.im.refuse(line, "the arc-length method needs a deck of one step");
        }
        _ => {}
    }
}

/// Adds times, or the number of modes.
fn times(table: DeckTable, procedure: &StepProcedure, is_staged: bool) -> DeckTable {
    let end = if is_staged { "duration" } else { "end_time" };
    match procedure {
        StepProcedure::Static { step, duration, is_riks } => {
            let table = table.number(end, *duration).number("time_step", *step);
            if *is_riks { table.text("control", "arc-length") } else { table }
        }
        StepProcedure::Dynamic { step: Some(step), duration, .. } => {
            table.number(end, *duration).number("time_step", *step)
        }
        StepProcedure::Dynamic { duration, .. } => table.number(end, *duration).text("time_step", "auto"),
        StepProcedure::Frequency { count, up_to, is_complex } => {
            let table = match (count, up_to) {
                (Some(count), _) => table.value("modes", count.max(&1).to_string()),
                (None, Some(up_to)) => table.number("up_to", *up_to),
                (None, None) => table,
            };
            if *is_complex { table.value("damped", "true") } else { table }
        }
        StepProcedure::Buckle { count } => table.value("modes", count.max(&1).to_string()),
        StepProcedure::Response(card) => harmonics::keys(table, card),
    }
}

/// The scheme of a step in time.
fn scheme(procedure: &StepProcedure) -> Option<Vec<(&'static str, String)>> {
    let StepProcedure::Dynamic { alpha, is_explicit, mass_scaling, .. } = procedure else { return None };
    if !is_explicit {
        return Some(vec![("scheme", quoted("hht-alpha")), ("alpha", number(*alpha))]);
    }
    let mut keys = vec![("scheme", quoted("central-difference"))];
    keys.extend(mass_scaling.map(|step| ("mass_scaling_step", number(step))));
    Some(keys)
}
