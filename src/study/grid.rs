//! The grid of settings that a study runs: lines of schemes, methods and meshes, each over the same time steps, as overrides of
//! the deck.

use crate::deck::Deck;
use crate::deck::analysis::{Analysis, Plane};
use crate::deck::words::OneOrMany;
use crate::diagnostic::Diagnostic;
use crate::integrators::{Scheme, Stepping};
use crate::model::study::{Quantity, Study, obstacle};
use crate::model::{AnalysisKind, ERROR_TOLERANCE, Model, StepLength};
use std::sync::Arc;

/// The number of intervals between samples where the deck gives none.
pub const SAMPLES: usize = 200;
/// The longest time step, in time steps of the deck, where none is asked for.
const LONGEST: f64 = 8.0;
/// The number of times that this step is halved.
const HALVINGS: usize = 6;
/// Over a load step only material that yields makes an error, of first order in general and never above second.
const OF_LOAD_STEPS: f64 = 2.0;

/// A line of settings: a scheme, a method and a mesh, run over all time steps or all tolerances of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyLine {
    /// The words that distinguish it from the other lines.
    pub label: String,
    /// The label of the scheme, with its parameters; `static` in a static analysis.
    pub scheme: String,
    /// The word of the iteration method.
    pub method: String,
    /// The factor on the numbers of elements of the deck.
    pub mesh: f64,
    /// True where the step is automatic, and the grid goes over its tolerance.
    pub automatic: bool,
    /// The order of the scheme in the time step; of load steps, the highest that they can have.
    pub order: f64,
    /// The overrides of the deck that make this line, `KEY=VALUE`.
    pub sets: Vec<String>,
}

/// The grid of settings of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyGrid {
    /// The lines of settings.
    pub lines: Vec<StudyLine>,
    /// The time steps, longest first; each fits a whole number of times between two samples.
    pub time_steps: Vec<f64>,
    /// The error tolerances of automatic steps, largest first.
    pub error_tolerances: Vec<f64>,
    /// The end time of the analysis.
    pub end_time: f64,
    /// The number of intervals between the times at which errors are taken.
    pub samples: usize,
    /// The overrides that all runs have.
    pub sets: Vec<String>,
    /// The entries of `[analysis]` besides those that a resolution sets.
    analysis: String,
    /// The time steps that were asked for and had to be shortened, each with what it has become.
    pub fitted: Vec<(f64, f64)>,
}

impl StudyGrid {
    /// The grid that a deck and its `[study]` ask for; `samples` is the number of intervals of a reference.
    ///
    /// # Errors
    /// What is asked for makes no sense with this deck.
    pub fn new(
        model: &Model,
        deck: &Deck,
        study: &Study,
        quantities: &[Quantity],
        samples: Option<usize>,
    ) -> Result<StudyGrid, Vec<Diagnostic>> {
        let mut problems = Vec::new();
        if let Some(text) = obstacle(model) {
            return Err(vec![Diagnostic::error(text)]);
        }
        if quantities.is_empty() {
            let hint = "name a point or a body, or list `quantities` in `[study]`";
            problems.push(Diagnostic::error("there is nothing to measure errors on").hint(hint));
        }
        if model.analysis.kind == AnalysisKind::Static && !study.schemes.is_empty() {
            problems.push(Diagnostic::error("schemes integrate in time, and a static analysis has none"));
        }
        if model.analysis.kind == AnalysisKind::Static && !study.error_tolerances.is_empty() {
            let message = "error tolerances are about steps in time, and a static analysis has none";
            problems.push(Diagnostic::error(message).hint("load steps have no error in time: give time steps"));
        }
        let end_time = model.analysis.end_time;
        let samples = study.samples.or(samples).unwrap_or(SAMPLES);
        let interval = end_time / samples as f64;
        let error_tolerances = error_tolerances(model, study);
        let asked = match (&study.time_steps[..], study.halvings, &error_tolerances[..]) {
            ([], 0, [_, ..]) => Vec::new(),
            _ => time_steps(model, study, interval),
        };
        if let Some(longest) = asked.first().filter(|&&longest| longest > interval * (1.0 + 1e-9)) {
            let message = format!("the time step {longest} is longer than the {interval} between two samples");
            let hint = "steps end at every sample time: take fewer samples (--samples)";
            problems.push(Diagnostic::error(message).hint(hint));
        }
        let time_steps: Vec<f64> = asked.iter().map(|&step| fitting(interval, step)).collect();
        let differ = |(asked, step): &(f64, f64)| (asked - step).abs() > 1e-9 * asked;
        let fitted = asked.iter().copied().zip(time_steps.iter().copied()).filter(differ).collect();
        let mut time_steps = time_steps;
        time_steps.dedup();
        let kinds: Vec<bool> = [(false, time_steps.is_empty()), (true, error_tolerances.is_empty())]
            .iter()
            .filter(|(_, none)| !none)
            .map(|(automatic, _)| *automatic)
            .collect();
        let lines = lines(model, deck, study, &kinds, &mut problems);
        if !problems.is_empty() {
            return Err(problems);
        }
        let sets = vec![output(quantities, interval, false), "expect=[]".to_owned()];
        let analysis = analysis(model, deck);
        Ok(StudyGrid { lines, time_steps, error_tolerances, end_time, samples, sets, analysis, fitted })
    }

    /// The time steps, or tolerances, that a line goes over.
    pub fn resolutions(&self, line: usize) -> &[f64] {
        if self.lines[line].automatic { &self.error_tolerances } else { &self.time_steps }
    }

    /// All overrides of a run.
    pub fn overrides(&self, line: usize, resolution: f64) -> Vec<String> {
        let of = &self.lines[line];
        let step = match of.automatic {
            false => format!("time_step = {}", float(resolution)),
            true => format!("time_step = \"auto\", error_tolerance = {}", float(resolution)),
        };
        let analysis = format!("analysis={{ {}, {step} }}", self.analysis);
        of.sets.iter().chain(&self.sets).cloned().chain([analysis]).collect()
    }

    /// A guess of the work of a run: its number of steps times the factor on the numbers of elements.
    pub fn work(&self, line: usize, resolution: f64) -> f64 {
        let of = &self.lines[line];
        // The error of an automatic step grows with the square of its length.
        let steps = if of.automatic { 20.0 / resolution.sqrt() } else { self.end_time / resolution };
        steps.max(self.samples as f64) * of.mesh
    }
}

/// The override by which a run writes nothing but what errors are measured on, every `interval` of time; with `parts`, the elastic
/// energies of the parts too.
pub fn output(quantities: &[Quantity], interval: f64, parts: bool) -> String {
    let mut nodes: Vec<String> = Vec::new();
    for quantity in quantities.iter().filter(|quantity| !quantity.body) {
        let name = quoted(&quantity.name);
        if !nodes.contains(&name) {
            nodes.push(name);
        }
    }
    // An empty list would be an error; without the key all named points are written, which costs little.
    let nodes = if nodes.is_empty() { String::new() } else { format!("nodes = [{}], ", nodes.join(", ")) };
    format!("output={{ {nodes}interval = {}, energy = false, parts = {parts} }}", float(interval))
}

/// A text as TOML writes it, which reads the quotes of JSON as its own.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// The shortest text that reads back to the same number.
pub fn float(number: f64) -> String {
    ryu::Buffer::new().format(number).to_owned()
}

/// The time steps asked for, or the default ones, longest first; `interval` is the time between two samples.
fn time_steps(model: &Model, study: &Study, interval: f64) -> Vec<f64> {
    let halve = |longest: f64, times: usize| (0..=times).map(|k| longest * 0.5_f64.powi(k as i32)).collect();
    let deck = model.analysis.nominal_step();
    let from_deck = (LONGEST * deck).min(interval);
    match study.time_steps[..] {
        [] => halve(from_deck, if study.halvings > 0 { study.halvings } else { HALVINGS }),
        [longest] => halve(longest, study.halvings),
        ref list => list.to_vec(),
    }
}

/// The tolerances asked for; where nothing is asked for, those around the tolerance of a deck with automatic steps.
fn error_tolerances(model: &Model, study: &Study) -> Vec<f64> {
    let own = match model.analysis.step_length {
        StepLength::ErrorControlled { tolerance, .. } => Some(tolerance),
        StepLength::StabilityLimited { .. } => Some(ERROR_TOLERANCE),
        StepLength::Fixed { .. } | StepLength::ArcLength(_) => None,
    };
    match own {
        _ if !study.error_tolerances.is_empty() => study.error_tolerances.clone(),
        Some(own) if study.time_steps.is_empty() && study.halvings == 0 => {
            [10.0, 1.0, 0.1, 0.01].map(|part| part * own).into_iter().filter(|tolerance| *tolerance < 1.0).collect()
        }
        _ => Vec::new(),
    }
}

/// The entries of `[analysis]` besides its step. The table is replaced as a whole, for a tolerance of the deck means nothing beside
/// a given step, and no override can unset it.
fn analysis(model: &Model, deck: &Deck) -> String {
    let kind = if model.analysis.kind == AnalysisKind::Static { "static" } else { "dynamic" };
    let mut text = format!("kind = \"{kind}\", end_time = {}", float(model.analysis.end_time));
    let Some(at) = &deck.analysis else { return text };
    // The keys are named one by one, so that a new one cannot be forgotten here.
    let Analysis {
        least_step,
        plane,
        kind: _,
        control: _,
        end_time: _,
        time_step: _,
        error_tolerance: _,
        stop: _,
        steps: _,
        growth: _,
    } = &*at.value;
    if let Some(least) = least_step {
        text += &format!(", least_step = {}", float(least.value));
    }
    if plane.as_ref().is_some_and(|plane| plane.value == Plane::Off) {
        text += ", plane = \"off\"";
    }
    text
}

/// The longest step up to this one that fits an interval a whole number of times.
fn fitting(interval: f64, step: f64) -> f64 {
    interval / (interval / step - 1e-9).ceil().max(1.0)
}

/// The lines of a grid: all schemes with all methods, meshes and `kinds` of steps (true: automatic).
fn lines(model: &Model, deck: &Deck, study: &Study, kinds: &[bool], problems: &mut Vec<Diagnostic>) -> Vec<StudyLine> {
    let word = model.solution.scheme.word().to_owned();
    let is_static = model.analysis.kind == AnalysisKind::Static;
    let scheme = |label: &str, scheme: &Arc<dyn Scheme>, set: Option<String>| (label.to_owned(), scheme.clone(), set);
    let schemes: Vec<_> = match study.schemes[..] {
        [] if is_static => vec![scheme("static", &model.solution.scheme, None)],
        [] => vec![scheme(&word, &model.solution.scheme, None)],
        ref list => {
            list.iter().map(|of| scheme(&of.label, &of.scheme, Some(format!("integrator={}", of.table)))).collect()
        }
    };
    if !is_static && kinds.contains(&true) {
        problems.extend(schemes.iter().filter_map(|(label, scheme, _)| no_tolerance(label, &**scheme)));
    }
    let methods: Vec<_> = match study.methods[..] {
        [] => vec![(model.solution.iteration.method.word(), None)],
        ref list => list.iter().map(|of| (of.word(), Some(format!("iteration.method=\"{}\"", of.word())))).collect(),
    };
    let meshes: Vec<f64> = if study.meshes.is_empty() { vec![1.0] } else { study.meshes.clone() };
    let refined: Vec<Vec<String>> = meshes.iter().map(|&mesh| refine(deck, mesh, problems)).collect();
    let mut lines = Vec::new();
    for (scheme, which, of_scheme) in &schemes {
        let order = if is_static { OF_LOAD_STEPS } else { which.order() as f64 };
        for (method, of_method) in &methods {
            let meshes = meshes.iter().zip(&refined).flat_map(|of| kinds.iter().map(move |kind| (of, *kind)));
            for ((&mesh, of_mesh), automatic) in meshes {
                let mut words = Vec::new();
                if schemes.len() > 1 || (methods.len() == 1 && refined.len() == 1) {
                    words.push(scheme.clone());
                }
                if methods.len() > 1 {
                    words.push((*method).to_owned());
                }
                if refined.len() > 1 {
                    words.push(format!("mesh x {mesh}"));
                }
                if automatic {
                    words.push("automatic".to_owned());
                }
                let label = words.join(", ");
                let sets = of_scheme.iter().chain(of_method).chain(of_mesh).cloned().collect();
                let (scheme, method) = (scheme.clone(), (*method).to_owned());
                lines.push(StudyLine { label, scheme, method, mesh, automatic, order, sets });
            }
        }
    }
    lines
}

/// Why a scheme cannot be studied over tolerances; `None` where it can.
fn no_tolerance(label: &str, scheme: &dyn Scheme) -> Option<Diagnostic> {
    let (message, hint) = match scheme.stepping() {
        Stepping::Verlet => (
            format!("`{label}` has no error tolerance: its automatic steps follow the critical time step"),
            "give time steps (--time-steps): those above the critical time step are cut back",
        ),
        _ if scheme.order() < 2 => (
            format!("`{label}` is of first order, and automatic steps want second"),
            "use a scheme of second order, such as \"generalized-alpha\", or give time steps (--time-steps)",
        ),
        _ => return None,
    };
    Some(Diagnostic::error(message).hint(hint))
}

/// The overrides that multiply all numbers of elements.
fn refine(deck: &Deck, factor: f64, problems: &mut Vec<Diagnostic>) -> Vec<String> {
    if factor == 1.0 {
        return Vec::new();
    }
    let mut sets = Vec::new();
    for part in deck.parts() {
        if part.table.group().is_some() {
            let message = format!("`meshes` cannot refine `{}`: its elements are those of the mesh file", part.label());
            problems.push(Diagnostic::error(message));
        } else if let Some(elements) = part.table.elements() {
            match multiplied(elements, factor) {
                Some(numbers) => sets.push(format!("{}.elements={numbers}", part.table_path())),
                None => {
                    let count: Vec<String> = elements.values.iter().map(|count| count.value.to_string()).collect();
                    let (count, label) = (count.join(", "), part.label());
                    let message = format!("{factor} times the {count} elements of `{label}` is no whole number");
                    problems.push(Diagnostic::error(message));
                }
            }
        }
    }
    if sets.is_empty() && problems.is_empty() {
        problems.push(Diagnostic::error("`meshes` has nothing to refine: the deck has no elements"));
    }
    sets
}

/// The numbers of elements times a factor, as a deck writes them; `None` where one is not whole.
fn multiplied(elements: &OneOrMany<u64>, factor: f64) -> Option<String> {
    let whole = elements.values.iter().map(|count| {
        let scaled = count.value as f64 * factor;
        let whole = scaled.round();
        ((scaled - whole).abs() < 1e-9 && whole >= 1.0).then(|| (whole as u64).to_string())
    });
    let numbers = whole.collect::<Option<Vec<String>>>()?;
    Some(if elements.single { numbers.concat() } else { format!("[{}]", numbers.join(", ")) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_fit_between_samples() {
        assert_eq!(fitting(0.01, 0.01), 0.01);
        assert_eq!(fitting(0.01, 0.005), 0.005);
        assert_eq!(fitting(0.01, 0.006), 0.005);
        assert_eq!(fitting(0.01, 0.01 / 3.0), 0.01 / 3.0);
    }
}
