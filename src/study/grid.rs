//! The grid of settings that a study runs: lines of settings ([`StudyLine`]), each over the same time steps or tolerances, as
//! overrides of the deck.

use super::cells::float;
use super::lines::{StudyLine, lines};
use base::diagnostic::Diagnostic;
use deck::Deck;
use deck::analysis::{Analysis, Plane};
use model::study::{Quantity, Study, obstacle};
use model::{ERROR_TOLERANCE, Model, StepLength};

/// The number of intervals between samples where the deck gives none.
pub const SAMPLES: usize = 200;
/// The longest time step, in time steps of the deck, where none is asked for.
const LONGEST: f64 = 8.0;
/// The number of times that this step is halved.
const HALVINGS: usize = 6;

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
    /// The number of intervals between the times of comparison.
    pub samples: usize,
    /// The overrides that all runs have.
    pub sets: Vec<String>,
    /// The entries of `[analysis]` besides those that a resolution sets.
    analysis: String,
    /// The requested time steps that were shortened, each with the shortened step.
    pub fitted: Vec<(f64, f64)>,
}

impl StudyGrid {
    /// The grid that a deck and its `[study]` ask for; `samples` is the number of intervals of a reference.
    ///
    /// # Errors
    /// The options contradict this deck.
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
        if !model.analysis.is_dynamic() && !study.schemes.is_empty() {
            problems.push(
                Diagnostic::error("schemes integrate in time, and a static analysis has none").hint("remove `schemes`"),
            );
        }
        if !model.analysis.is_dynamic() && !study.error_tolerances.is_empty() {
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

    /// A made-up grid of fixed steps.
    #[cfg(test)]
    pub fn of_steps(lines: Vec<StudyLine>, time_steps: Vec<f64>, end_time: f64, samples: usize) -> StudyGrid {
        let (error_tolerances, sets, analysis, fitted) = (time_steps.clone(), Vec::new(), String::new(), Vec::new());
        StudyGrid { lines, time_steps, error_tolerances, end_time, samples, sets, analysis, fitted }
    }

    /// The time steps, or tolerances, that a line goes over.
    pub fn resolutions(&self, line: usize) -> &[f64] {
        if self.lines[line].automatic { &self.error_tolerances } else { &self.time_steps }
    }

    /// All overrides of a run.
    pub fn overrides(&self, line: usize, resolution: f64) -> Vec<String> {
        self.setting(line, resolution).into_iter().chain(self.sets.iter().cloned()).collect()
    }

    /// The overrides that distinguish a run, without those common to all.
    pub fn setting(&self, line: usize, resolution: f64) -> Vec<String> {
        let of = &self.lines[line];
        let step = match of.automatic {
            false => format!("time_step = {}", float(resolution)),
            true => format!("time_step = \"auto\", error_tolerance = {}", float(resolution)),
        };
        let analysis = format!("analysis={{ {}, {step} }}", self.analysis);
        of.sets.iter().cloned().chain([analysis]).collect()
    }

    /// A guess of the work of a run: its number of steps times the factor on the numbers of elements.
    pub fn work(&self, line: usize, resolution: f64) -> f64 {
        let of = &self.lines[line];
        // The error of an automatic step grows with the square of its length.
        let steps = if of.automatic { 20.0 / resolution.sqrt() } else { self.end_time / resolution };
        steps.max(self.samples as f64) * of.mesh
    }
}

/// The override that limits the output of a run to the compared quantities, every `interval` of time; with `parts`, also the elastic
/// energies of the parts.
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
    let kind = if !model.analysis.is_dynamic() { "static" } else { "dynamic" };
    let mut text = format!("kind = \"{kind}\", end_time = {}", float(model.analysis.end_time));
    let Some(at) = &deck.analysis else { return text };
    // The keys are named one by one, so that a new one cannot be forgotten here.
    let Analysis {
        least_step,
        plane,
        kind: _,
        geometry: _,
        control: _,
        end_time: _,
        time_step: _,
        accuracy: _,
        error_tolerance: _,
        stop: _,
        increment: _,
        steps: _,
        growth: _,
        modes: _,
        up_to: _,
        damped: _,
        speeds: _,
        frequencies: _,
        method: _,
        damping_ratio: _,
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
