//! `rdsolve check deck.toml`: read, validate, print the plan; run nothing.

use super::arguments::CheckArgs;
use super::console::{complain, print, show};
use super::estimate::{alternative, effort, first_period};
use super::exit::Exit;
use super::explicit_steps::{limit_of_steps, offers};
use super::load::{load, plan, too_large};
use super::memory::Forecast;
use super::signals::EndAtOnce;
use super::watchers::stage_begins;
use base::diagnostic::{Diagnostic, Source};
use model::Model;
use results::{listed, matrix_market, settle_cadence, wanted};
use solve::Run;
use solve::modes::SceneMatrices;
use solve::plan::Plan;
use solve::plan::explain::{Explanation, explain_costs};
use solve::system::System;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Prints the plan of a deck and its cost on standard output; diagnostics go to standard error.
///
/// # Errors
/// The deck is invalid or cannot be read, or its matrix does not fit into memory; the reason has been shown.
pub fn check(args: &CheckArgs) -> Result<(), Exit> {
    let checking = EndAtOnce::on_signals();
    let mut loaded = load(&args.deck.deck, &args.deck.sets, Vec::new())?.with_chosen_scheme();
    show(&loaded.warnings, &loaded.source);
    let (system, plan, warnings) = plan(&mut loaded, 1)?;
    show(&warnings, &loaded.source);
    let mut forecast = Forecast::begin();
    let never = AtomicBool::new(false);
    let mut run = Run::new(&loaded.model, &system, &plan, wanted(&loaded.model), &never).map_err(too_large)?;
    take(&mut forecast, &run, &loaded.model)?;
    let mut text = explain_costs(&plan, &loaded.model, &system, run.solver());
    text.computed.push(("output", listed(&loaded.model, &plan)));
    if let Some(folder) = &args.export_matrices {
        text.computed.push(("matrices", export(folder, (&loaded.model, &system, &plan), &checking)?));
    }
    // As in a run, the first stage keeps all but its matrix.
    run.forget_matrix();
    let mut texts = vec![text];
    let mut later = Vec::new();
    for model in &mut loaded.later {
        let (system, plan) = planned(model)?;
        let stage = Run::new(model, &system, &plan, wanted(model), &never).map_err(too_large)?;
        take(&mut forecast, &stage, model)?;
        let mut text = explain_costs(&plan, model, &system, stage.solver());
        text.computed.push(("output", listed(model, &plan)));
        texts.push(text);
        drop(stage);
        later.push((system, plan));
    }
    if let Some(last) = texts.last_mut() {
        add_memory(last, forecast.as_ref(), &loaded.source)?;
    }
    drop(run);
    let stages = [(&loaded.model, &system, &plan)].into_iter();
    let stages = stages.chain(loaded.later.iter().zip(&later).map(|(model, (system, plan))| (model, system, plan)));
    for (text, (model, system, plan)) in texts.iter_mut().zip(stages) {
        text.computed.extend(limit_of_steps(model, system));
        text.computed.extend(effort(model, system, plan).map(|line| ("effort", line)));
        text.computed.extend(offers(model, system));
        text.notes.extend(alternative(model, plan.threads));
    }
    if args.first_period {
        texts[0].computed.push(("first mode", first_period(&loaded.model)));
    }
    let mut all = format!("{}: no errors\n", loaded.source.path);
    for (number, (text, model)) in texts.iter().zip([&loaded.model].into_iter().chain(&loaded.later)).enumerate() {
        if model.analysis.stage.is_some() {
            all += &format!("{}\n", stage_begins(model));
        }
        all += &match number {
            0 => text.to_string(),
            _ => text.beyond(&texts[number - 1]).to_string(),
        };
    }
    print(&all)
}

/// Takes account of the memory of a run.
fn take(forecast: &mut Option<Forecast>, run: &Run, model: &Model) -> Result<(), Exit> {
    forecast.iter_mut().try_for_each(|forecast| forecast.take(run, model.nodes.len())).map_err(too_large)
}

/// Adds a line about the memory of the whole run, and warns if it may be too little.
fn add_memory(text: &mut Explanation, forecast: Option<&Forecast>, source: &Source) -> Result<(), Exit> {
    let Some(forecast) = forecast else { return Ok(()) };
    text.computed.push(("memory", forecast.in_words()));
    forecast
        .judge()
        .map(|warning| warning.into_iter().for_each(|warning| show(&[Diagnostic::warning(warning)], source)))
}

/// Writes the matrices of the scene, and reports their files.
fn export(
    folder: &Path,
    (model, system, plan): (&Model, &System, &Plan),
    checking: &EndAtOnce,
) -> Result<String, Exit> {
    let matrices = SceneMatrices::of(model, system, plan).map_err(too_large)?;
    checking.writes_into(folder);
    let written = matrix_market::write(folder, &matrices).map_err(|error| {
        complain(&format!("the matrices cannot be written: {error}"));
        Exit::InputOutput
    })?;
    Ok(format!("{} in {}", written.join(", "), folder.display()))
}

/// The system and the plan of a later stage, as far as they are known without its initial state.
fn planned(model: &mut Model) -> Result<(System, Plan), Exit> {
    let system = System::new(model).map_err(|error| {
        complain(&error);
        Exit::Internal
    })?;
    let plan = Plan::new(model, &system, 1);
    settle_cadence(model, &plan);
    Ok((system, plan))
}
