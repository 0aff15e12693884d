//! `accuracy`: pilot runs choose mesh, contact stiffness and steps, so that their errors together stay below the error asked for.
//!
//! Each error follows from the difference between two pilot runs. The cost of a run is about proportional to e_x^(-1/p) e_t^(-1/q), with the
//! orders p of the mesh and q of the steps. Under e_x + e_t = e it is least for e_x : e_t = 1/p : 1/q.

mod contacts;
mod load_steps;
mod mesh;
mod numbers;
mod pilot_run;
mod pilots;

use super::load::{Loaded, build};
use base::diagnostic::{Diagnostic, Source};
use contacts::{choose_stiffness, open_contacts};
use deck::Deck;
use load_steps::choose_load_steps;
use mesh::{ChosenMesh, choose_mesh};
use model::{Model, StepLength};
use numbers::{rounded_down, two_digits};
use pilot_run::PilotRun;
use pilots::Pilots;
use results::error_bars::ErrorBars;
use results::expect::Expectations;
use results::result_json::{ReportedAccuracy, ReportedMesh, ReportedStepError};
use solve::{Counts, Run};
use std::sync::atomic::AtomicBool;
use study::{CoarserMesh, RefinableParts, mesh_groups};

/// The share of contacts with open stiffness in the error.
const OF_CONTACTS: f64 = 0.25;
/// The share of elastic load steps in the error.
const OF_ELASTIC_STEPS: f64 = 0.1;
/// The least share of the mesh in the error of a motion. Steps for two fifths of an error in place of two thirds are a sixth shorter by a scheme of third
/// order, and the next mesh is twice as dear. Chosen, not measured.
const OF_MESH: f64 = 0.6;
/// Largest ratio of the estimated error to the error asked for; automatic steps have the same.
const WITHIN: f64 = 1.5;
/// Errors below this part of the error asked for are rounding.
const ROUNDING: f64 = 1e-6;

/// The settings that keep an error.
pub struct ChosenSettings {
    /// The account for result.json.
    pub report: ReportedAccuracy,
    /// A coarser mesh, for error bars.
    pub coarser: Option<CoarserMesh>,
    /// The pilot runs of a motion with the chosen mesh, and with the coarser one.
    pilots: [Option<PilotRun>; 2],
}

/// The deck with the chosen settings; unchanged if it has no `accuracy`.
///
/// # Errors
/// The deck is not valid with the settings that were chosen.
pub fn settle(
    loaded: Loaded,
    threads: usize,
    stop: &AtomicBool,
) -> Result<(Loaded, Option<ChosenSettings>), (Vec<Diagnostic>, Source)> {
    let Some(asked) = loaded.model.analysis.accuracy else { return Ok((loaded, None)) };
    let (Some(deck), _) = deck::read(&loaded.source) else { return Ok((loaded, None)) };
    let chosen = choose(&loaded, &deck, asked, (threads, stop));
    let sets: Vec<String> =
        loaded.source.sets.iter().map(|(_, set)| set).chain(&chosen.report.settings).cloned().collect();
    let source = Source::new(loaded.source.path.clone(), loaded.source.text.clone(), &sets);
    let settled = build(source, &sets)?;
    // The hash tells the settings; results name the overrides as they were given.
    Ok((Loaded { sets: loaded.sets, ..settled }, Some(chosen)))
}

/// Chooses the settings for an error of a sound deck.
fn choose(loaded: &Loaded, deck: &Deck, asked: f64, (threads, stop): (usize, &AtomicBool)) -> ChosenSettings {
    let (source, model) = (&loaded.source, &loaded.model);
    let (effort, runs) = (Counts::default(), 0);
    let mut pilots = Pilots { source, deck, model, tolerance: asked, threads, stop, ends: Vec::new(), runs, effort };
    let report = ReportedAccuracy { asked, ..ReportedAccuracy::default() };
    let mut chosen = ChosenSettings { report, coarser: None, pilots: [None, None] };
    let (groups, fixed) = mesh_groups(deck, model);
    let open = open_contacts(&pilots);
    let shares = Shares::new(asked, model, &groups, !open.is_empty());
    let report = &mut chosen.report;
    report.remarks.extend((!fixed.is_empty()).then(|| super::mesh_error::of_file(&fixed)));
    let reduced = model.reductions.chunk_by(|a, b| a.parts == b.parts);
    report.remarks.extend(reduced.map(|pieces| {
        format!(
            "the error of the modes of {} is not known. Compare with a run with more modes in `reduced`",
            pieces[0].title
        )
    }));
    let is_mesh_known = !groups.is_empty() && fixed.is_empty();
    // A comparison run of bodies tells the error of steps at a lower price than a pilot run, whose steps do not follow those of the last run.
    if pilots.is_automatic() && groups.is_empty() && open.is_empty() {
        leave_to_steps(&pilots, report, &shares);
    } else {
        match pilots.run(&[]) {
            Ok(observed) => {
                let mut mesh = choose_mesh(&mut pilots, groups, shares.mesh, observed);
                report.mesh = mesh.error.filter(|_| is_mesh_known);
                report.settings.extend(mesh.sets.iter().cloned());
                report.remarks.append(&mut mesh.remarks);
                if !open.is_empty() {
                    let with_mesh = (&report.settings[..], &mesh.observed);
                    let stiff = choose_stiffness(&mut pilots, with_mesh, &open, shares.contacts);
                    report.contact = stiff.error;
                    report.remarks.extend(stiff.remarks);
                    report.settings.extend(stiff.sets);
                }
                choose_steps(&mut pilots, report, &mesh.observed, &shares);
                chosen.keep_pilots(&mut pilots, mesh);
            }
            Err(reason) => {
                report.remarks.push(format!("no setting was changed: {reason}. Run the deck without `accuracy` first"))
            }
        }
    }
    let report = &mut chosen.report;
    report.pilot_runs = pilots.runs;
    (report.pilot_steps, report.pilot_iterations) = (pilots.effort.steps, pilots.effort.iterations);
    report.pilot_factorizations = pilots.effort.factorizations;
    chosen
}

/// Leaves the rest of the error to automatic steps.
fn leave_to_steps(pilots: &Pilots, report: &mut ReportedAccuracy, shares: &Shares) {
    let rest = report.asked - report.mesh.unwrap_or(0.0) - report.contact.unwrap_or(0.0);
    let tolerance = shares.given.unwrap_or(rest.max(shares.steps));
    report.steps = Some(tolerance);
    if pilots.deck.analysis.as_ref().is_some_and(|analysis| analysis.time_step.is_none()) {
        report.settings.push("analysis.time_step=\"auto\"".to_owned());
    }
    report.settings.push(format!("analysis.error_tolerance={}", rounded_down(tolerance)));
}

/// Leaves the rest of the error to automatic steps, or chooses load steps.
fn choose_steps(pilots: &mut Pilots, report: &mut ReportedAccuracy, observed: &PilotRun, shares: &Shares) {
    if pilots.is_automatic() {
        return leave_to_steps(pilots, report, shares);
    }
    // The results with stiffer contacts are those to compare with.
    let again = report.settings.iter().any(|set| set.contains(".stiffness=")).then(|| pilots.run(&report.settings));
    let observed = again.as_ref().and_then(|run| run.as_ref().ok()).unwrap_or(observed);
    let chosen = choose_load_steps(pilots, (&report.settings, observed), shares.steps);
    report.load_steps = chosen.error;
    report.remarks.extend(chosen.remarks);
    report.settings.extend(chosen.set);
}

/// The parts of the error.
struct Shares {
    mesh: f64,
    contacts: f64,
    steps: f64,
    /// The part of the steps, if the deck gives it.
    given: Option<f64>,
}

impl Shares {
    fn new(asked: f64, model: &Model, groups: &[RefinableParts], has_contacts: bool) -> Shares {
        let given = match model.analysis.step_length {
            StepLength::ErrorControlled { tolerance, .. } if tolerance < asked => Some(tolerance),
            _ => None,
        };
        let whole = asked - given.unwrap_or(0.0);
        let contacts = if has_contacts { OF_CONTACTS * whole } else { 0.0 };
        let rest = whole - contacts;
        let slope = groups.iter().map(RefinableParts::slope).fold(f64::INFINITY, f64::min);
        let order = if model.analysis.is_dynamic() { model.solution.scheme.order() as f64 } else { 1.0 };
        let by_cost = order / (order + slope);
        let of_mesh = match (groups.is_empty(), given) {
            (true, _) => 0.0,
            (_, Some(_)) => 1.0,
            _ if !model.analysis.is_dynamic() && !model.yields() => 1.0 - OF_ELASTIC_STEPS,
            // A mesh of twice the elements costs more than steps for the rest of the error.
            _ if model.analysis.is_dynamic() => by_cost.max(OF_MESH),
            _ => by_cost,
        };
        Shares { mesh: of_mesh * rest, contacts, steps: (1.0 - of_mesh) * rest, given }
    }
}

impl ChosenSettings {
    /// Keeps the pilot runs with the chosen mesh and a coarser one. In statics a run with the coarser mesh follows the last run.
    fn keep_pilots(&mut self, pilots: &mut Pilots, mut mesh: ChosenMesh) {
        // The run with the chosen mesh had the contacts of the deck.
        if self.report.settings.iter().any(|set| set.contains(".stiffness=")) {
            mesh.observed.motion = None;
        }
        let Some((coarser, run)) = mesh.coarser else {
            self.pilots[0] = pilots.is_automatic().then_some(mesh.observed);
            return;
        };
        if pilots.is_automatic() {
            // Both pilot runs have the contacts of the deck.
            let sets = [&mesh.sets[..], &coarser.sets].concat();
            self.pilots = [Some(mesh.observed), run.or_else(|| pilots.run(&sets).ok())];
        }
        self.coarser = Some(coarser);
    }

    /// Lets the pilot run with the chosen mesh tell the errors of the steps of a run.
    pub fn tell_steps(&self, run: &mut Run, bars: Option<&mut ErrorBars>, expectations: &mut Expectations) {
        let [Some(PilotRun { motion: Some(motion), numbers: Some((of_tables, of_values)), .. }), _] = &self.pilots
        else {
            return;
        };
        run.compare_with(motion.clone());
        bars.into_iter().for_each(|bars| bars.compare_with(of_tables));
        expectations.compare_with(of_values);
    }

    /// Tells the errors of the mesh by the pilot runs. `None` if there are none, because the analysis is static.
    pub fn tell_mesh(&self, bars: &mut ErrorBars, expectations: &mut Expectations) -> Option<ReportedMesh> {
        let [Some(fine), Some(coarse)] = &self.pilots else { return None };
        let (fine, coarse, coarser) = (fine.numbers.as_ref()?, coarse.numbers.as_ref()?, self.coarser.as_ref()?);
        bars.told_by_pilots([&fine.0, &coarse.0], coarser.apart);
        expectations.told_by_pilots([&fine.1, &coarse.1], coarser.apart);
        // The pilot runs count with the choice of settings.
        let (sets, apart, unchanged) = (coarser.sets.clone(), coarser.apart, coarser.unchanged.clone());
        Some(ReportedMesh { sets, apart, unchanged, steps: 0, iterations: 0, factorizations: 0 })
    }

    /// The chosen settings and their errors, for the log and the terminal.
    pub fn lines(&self) -> Vec<String> {
        let ReportedAccuracy { asked, mesh, contact, load_steps, steps, settings, pilot_runs, .. } = &self.report;
        let told = |what: &str, error: &Option<f64>| {
            error.map(|error| match error > ROUNDING * asked {
                true => format!("{what} {}", two_digits(error)),
                false => format!("{what} below rounding"),
            })
        };
        let known = [told("mesh", mesh), told("contact stiffness", contact), told("load steps", load_steps)];
        let left = steps.map(|steps| format!("{} left to time steps", two_digits(steps)));
        let errors: Vec<String> = known.into_iter().flatten().chain(left).collect();
        let runs = format!("{pilot_runs} pilot run{}", if *pilot_runs == 1 { "" } else { "s" });
        let first = format!("accuracy {asked:e} after {runs}: estimated error by {}", errors.join(", "));
        let first = if errors.is_empty() { format!("accuracy {asked:e} after {runs}") } else { first };
        [first].into_iter().chain(settings.iter().map(|set| format!("chosen: {set}"))).collect()
    }

    /// Warnings of errors that remain, once the error of the steps is known.
    pub fn warnings(&self, steps: Option<&ReportedStepError>) -> Vec<String> {
        let ReportedAccuracy { asked, mesh, contact, load_steps, remarks, .. } = &self.report;
        let mut warnings: Vec<String> =
            remarks.iter().map(|remark| format!("`accuracy` = {asked:e} is not certain: {remark}")).collect();
        let of_steps = steps.and_then(|steps| steps.estimate);
        let all: f64 = [mesh, contact, load_steps, &of_steps].into_iter().flatten().sum();
        if all > WITHIN * asked && remarks.is_empty() {
            let all = two_digits(all);
            warnings.push(format!(
                "the estimated errors add up to {all}, more than `accuracy` = {asked:e}. See result.json for each"
            ));
        }
        warnings
    }
}
