//! The analysis and its integration scheme in words.

use super::explanation::Explanation;
use super::quantities::symbol;
use super::response;
use base::quantities::{Unit, UnitSystem};
use model::{Analysis, AnalysisKind, ArcLength, DIRECTIONS, ModeExtent, Model, StepLength};

/// Adds lines about the analysis.
pub fn explain(text: &mut Explanation, model: &Model) {
    let analysis = &model.analysis;
    let steps = (analysis.duration() / analysis.nominal_step() - 1e-9).ceil().max(1.0);
    let end = analysis.end_time;
    match (&analysis.kind, &analysis.step_length) {
        (AnalysisKind::Response(asked), _) => text.add("analysis", response::explain(asked, model)),
        (AnalysisKind::Modal(_) | AnalysisKind::Buckling(_), _) => text.add("analysis", modes(analysis)),
        (AnalysisKind::Static, _) if analysis.is_linear() => text.add("analysis", linear(model, steps)),
        (AnalysisKind::Static, StepLength::ArcLength(control)) => text.add("analysis", path(model, control)),
        (AnalysisKind::Static, _) => text.add("analysis", format!("static, to t = {end} in {steps} load steps")),
        (AnalysisKind::Dynamic, step_length) => {
            let of_time = symbol(Unit::Time, model.output.units.as_deref().and_then(UnitSystem::find));
            let how = match step_length {
                StepLength::StabilityLimited { fraction } => {
                    format!("in steps of {fraction} of the critical time step")
                }
                StepLength::ErrorControlled { tolerance, .. } => {
                    format!("in automatic steps, for a relative error of {tolerance} at the end")
                }
                _ => format!("in {steps} steps of {}{of_time}", analysis.nominal_step()),
            };
            text.add("analysis", format!("dynamic, to t = {end}{of_time} {how}"));
            let choice = model.solution.choice.as_ref().map_or_else(String::new, |choice| format!(", {choice}"));
            text.add("scheme", format!("{}{choice}", model.solution.scheme.in_words()));
            text.notes.extend(model.solution.scheme.note().map(str::to_owned));
        }
    }
    if let Some(accuracy) = analysis.accuracy {
        let what = if analysis.is_dynamic() {
            "time steps, mesh and contact stiffness"
        } else {
            "load steps, mesh and contact stiffness"
        };
        let how = "chosen by pilot runs before the run; `rdsolve recommend` prints them";
        text.add("accuracy", format!("{accuracy:e} for {what}, {how}"));
    }
}

fn linear(model: &Model, steps: f64) -> String {
    let count = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let of = match model.cases.list.len() {
        0 => count(steps as usize, "solution"),
        cases => count(cases, "load case"),
    };
    format!("linear static, one factorization for {of}")
}

fn modes(analysis: &Analysis) -> String {
    let is_stage = analysis.stage.is_some();
    let state = if is_stage { "the state that has been reached" } else { "the equilibrium under the loads at t = 0" };
    let which = match analysis.extent() {
        ModeExtent::Count(1) => "the lowest".to_owned(),
        ModeExtent::Count(count) => format!("the {count} lowest"),
        ModeExtent::UpTo(frequency) => format!("all up to {frequency} per time"),
    };
    match (analysis.buckles(), analysis.damps_modes()) {
        (false, false) => format!("natural modes, {which}, about {state}"),
        (false, true) => {
            format!("complex modes, {which}, with damping and gyroscopic moments, about {state}")
        }
        (true, _) if is_stage => {
            format!("linear buckling about {state}, {which} factors of the loads that first act here")
        }
        (true, _) => format!("linear buckling, {which} factors of the loads at t = 0"),
    }
}

fn path(model: &Model, control: &ArcLength) -> String {
    let stop = control.stop.as_ref().map_or(String::new(), |stop| {
        let (node, direction) = (&model.nodes[stop.node].label, DIRECTIONS[stop.dof]);
        format!(", or until {direction} of {node} = {}", stop.value)
    });
    if let (Some(increment), Some(stop)) = (control.increment, &control.stop) {
        let (node, direction) = (&model.nodes[stop.node].label, DIRECTIONS[stop.dof]);
        return format!(
            "static, by displacement: {direction} of {node} moves to {} in steps of {increment}, loads follow",
            stop.value
        );
    }
    let end = model.analysis.end_time;
    format!("static, by arc length to load factor t = {end}{stop}; the first increment of t is {}", control.first)
}
