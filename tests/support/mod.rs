//! Decks read with overrides and run in memory; references and the error against them.
#![allow(dead_code)] // each test uses its part

pub mod blocks;
pub mod grid;
pub mod random;
pub mod truss;
pub mod witness;

use rdsolve::diagnostic::{Diagnostic, Source};
use rdsolve::model::{self, Model};
use rdsolve::output::expect::{Expectations, Verdict};
use rdsolve::output::{Files, wanted};
use rdsolve::plan::Plan;
use rdsolve::solve::{Counts, Frame, Handover, Observer, Outcome, Run, StepError, share_plane};
use rdsolve::state::Node;
use rdsolve::system::System;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// The folder of all decks.
pub fn decks() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("decks")
}

/// A deck by its folder below `decks/`, or by its own name where that is not deck.toml.
fn deck(name: &str) -> PathBuf {
    let path = decks().join(name);
    if name.ends_with(".toml") { path } else { path.join("deck.toml") }
}

/// All decks, as names for [`read`].
pub fn deck_names() -> Vec<String> {
    let mut found = Vec::new();
    names(&decks(), "", &mut found);
    assert!(!found.is_empty(), "no decks");
    found
}

/// Folders below `decks/` that hold a deck, as names for [`read`], sorted.
fn names(folder: &Path, prefix: &str, found: &mut Vec<String>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries.map(Result::unwrap).filter(|entry| entry.path().is_dir()) {
        let name = format!("{prefix}{}", entry.file_name().to_str().expect("a plain name"));
        if entry.path().join("deck.toml").exists() {
            found.push(name.clone());
        }
        names(&entry.path(), &format!("{name}/"), found);
        if name == "tutorial" {
            found.extend(crate::docs::tutorial().iter().map(|deck| format!("{name}/{deck}.toml")));
        }
    }
    found.sort();
}

fn source(name: &str, sets: &[String]) -> Source {
    let path = deck(name);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    // The folder counts: a mesh is found from there.
    Source::new(path.display().to_string(), text, sets)
}

/// The comments of a deck.
pub struct Comments(String);

impl Comments {
    /// What follows these words at the start of lines.
    pub fn after<'a>(&'a self, words: &'a str) -> impl Iterator<Item = &'a str> {
        self.0.lines().filter_map(move |line| line.strip_prefix("# ")?.strip_prefix(words))
    }
}

pub fn comments(name: &str) -> Comments {
    Comments(fs::read_to_string(deck(name)).expect("a deck that was read"))
}

/// What reading a deck says, messages alone.
pub fn warnings(name: &str, sets: &[String]) -> Vec<String> {
    model::read(&source(name, sets)).1.into_iter().map(|problem| problem.message).collect()
}

/// What reading the text of a deck says, messages alone.
pub fn warnings_of(text: &str) -> Vec<String> {
    model::read(&Source::new("deck.toml", text, &[])).1.into_iter().map(|problem| problem.message).collect()
}

/// A model with the matrices of its reduced parts.
fn with_matrices(mut model: Model) -> Model {
    rdsolve::modes::reduce(&mut [&mut model]).expect("matrices of reduced parts");
    model
}

/// The model of a deck below `decks/`, with entries overridden as by `--set`.
pub fn read(name: &str, sets: &[String]) -> Model {
    let source = source(name, sets);
    let (model, problems) = model::read(&source);
    model
        .map(with_matrices)
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// The models of all stages of a deck.
pub fn read_stages(source: &Source) -> Vec<Model> {
    let (mut models, problems) = model::read_stages(source);
    let said = || problems.iter().map(|p| p.draw(source, false)).collect::<Vec<_>>().join("\n");
    assert!(!models.is_empty(), "{}", said());
    rdsolve::modes::reduce(&mut models.iter_mut().collect::<Vec<_>>()).expect("matrices of reduced parts");
    share_plane(models.iter_mut()).expect("systems");
    models
}

/// Runs a deck below `decks/`, with all its stages.
pub fn run_deck(name: &str, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    run_source(&source(name, &[]), probe)
}

/// Runs a deck with all its stages, asking `probe` at every output time.
pub fn run_source(source: &Source, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    let mut models = read_stages(source);
    if models.len() == 1 {
        return run(&models[0], probe);
    }
    let stop = AtomicBool::new(false);
    let mut watchers = Watchers { probe, rows: Vec::new(), expectations: Expectations::new(&models[0]) };
    let (mut ends, mut seconds, mut unknowns) = (Vec::new(), 0.0, 0);
    let mut handed: Option<(System, Handover)> = None;
    loop {
        let stage = ends.len();
        let model = models[stage].clone();
        let (system, handover) = match handed.take() {
            Some((system, handover)) => (system, Some(handover)),
            None => (System::new(&model).expect("a system"), None),
        };
        let plan = Plan::new(&model, &system, 1);
        if stage > 0 {
            watchers.expectations.next_stage(&model);
        }
        let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
        handover.into_iter().for_each(|handover| run.go_on_from(Some(handover)));
        let began = std::time::Instant::now();
        let (outcome, state) = run.run(&mut watchers);
        seconds += (began.elapsed() - run.observing()).as_secs_f64();
        unknowns = plan.dofs.unknowns().max(unknowns);
        let (counts, step_error) = (run.counts(), run.step_error());
        let warnings = run.warnings().iter().map(ToString::to_string).collect();
        let is_done = matches!(outcome, Outcome::Done);
        let (verdicts, rows) = (Vec::new(), Vec::new());
        let mut done = Done { outcome, seconds, counts, step_error, unknowns, warnings, verdicts, rows };
        ends.push(state.as_ref().map_or(0.0, |state| state.time));
        while let (true, Some(state), Some(next)) = (is_done, &state, models.get_mut(ends.len())) {
            if next.analysis.begin != state.time {
                *next = model::replan(source, &ends, next).expect("a stage");
            }
            let (system, handover) = run.hand_over((state, counts), next).expect("a system");
            if !next.analysis.has_modes() {
                handed = Some((system, handover));
                break;
            }
            // Modes are about the state, and change nothing.
            watchers.expectations.next_stage(next);
            let plan = Plan::new(next, &system, 1);
            let mut modes = Run::new(next, &system, &plan, wanted(next), &stop).unwrap();
            modes.go_on_from(Some(handover));
            let (outcome, _) = modes.run(&mut watchers);
            assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
            ends.push(state.time);
        }
        if !is_done || ends.len() == models.len() {
            (done.verdicts, done.rows) = (watchers.expectations.verdicts(), watchers.rows);
            return done;
        }
    }
}

/// A run that came to its end or not.
pub struct Done {
    pub outcome: Outcome,
    /// What was asked for at every output time.
    pub rows: Vec<Vec<f64>>,
    pub verdicts: Vec<Verdict>,
    pub counts: Counts,
    pub step_error: Option<StepError>,
    pub unknowns: usize,
    /// Warnings of the run about its results; of stages, the last.
    pub warnings: Vec<String>,
    /// Wall-clock seconds of the time stepping alone.
    pub seconds: f64,
}

struct Watchers<'p> {
    probe: &'p mut dyn FnMut(&Frame) -> Vec<f64>,
    rows: Vec<Vec<f64>>,
    expectations: Expectations,
}

impl Observer for Watchers<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if frame.due {
            self.rows.push((self.probe)(frame));
        }
        self.expectations.on_step(frame)
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_modes(frame)
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        self.rows.clear();
        self.expectations.restart(model)
    }
}

/// Runs a model, asking `probe` at every output time.
pub fn run(model: &Model, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut watchers = Watchers { probe, rows: Vec::new(), expectations: Expectations::new(model) };
    let mut run = Run::new(model, &system, &plan, wanted(model), &stop).unwrap();
    let began = std::time::Instant::now();
    let (outcome, _) = run.run(&mut watchers);
    Done {
        outcome,
        seconds: (began.elapsed() - run.observing()).as_secs_f64(),
        counts: run.counts(),
        step_error: run.step_error(),
        unknowns: plan.dofs.unknowns(),
        warnings: run.warnings().iter().map(ToString::to_string).collect(),
        verdicts: watchers.expectations.verdicts(),
        rows: watchers.rows,
    }
}

/// Stops a run after some steps, and writes its files until then.
struct Writer<'s> {
    files: Files,
    steps: usize,
    stop: &'s AtomicBool,
}

impl Observer for Writer<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if frame.step >= self.steps {
            self.stop.store(true, Ordering::Relaxed);
        }
        self.files.on_step(frame)
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        self.files.restart(model)
    }
}

/// Runs a model for so many steps at most and writes what it asks for.
pub fn write(model: &Model, folder: &Path, steps: usize) {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, &system, &plan, wanted(model), &stop).unwrap();
    let mut writer = Writer { files: Files::open(folder, model).unwrap(), steps, stop: &stop };
    run.run(&mut writer);
    writer.files.finish().unwrap();
}

/// As [`run`]; the run must reach its end.
pub fn run_to_the_end(model: &Model, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    let done = run(model, probe);
    assert!(matches!(done.outcome, Outcome::Done), "{}: {:?}", model.title, done.outcome);
    done
}

/// The outcome of a run of a deck, and its warnings.
pub fn run_with_warnings(text: &str) -> (Outcome, Vec<String>) {
    struct Nobody;
    impl Observer for Nobody {
        fn on_step(&mut self, _: &Frame) -> io::Result<()> {
            Ok(())
        }
    }
    let model = read_deck(text);
    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
    let (outcome, _) = run.run(&mut Nobody);
    (outcome, run.warnings().iter().map(ToString::to_string).collect())
}

/// Number of a node by the name of its point or body.
pub fn node(model: &Model, label: &str) -> usize {
    model.nodes.iter().position(|node| node.label == label).unwrap_or_else(|| panic!("no node `{label}`"))
}

pub fn position(node: &Node) -> [f64; 3] {
    node.x.into()
}

/// Angular velocity in body axes.
pub fn body_omega(node: &Node) -> [f64; 3] {
    node.R().tr_mul(&node.omega).into()
}

/// Rows of reference.csv beside a deck, without the time.
pub fn reference(name: &str) -> Vec<Vec<f64>> {
    let path = decks().join(name).join("reference.csv");
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let number = |text: &str| text.parse::<f64>().expect("a number");
    reader.records().map(|row| row.expect("a row").iter().skip(1).map(number).collect()).collect()
}

/// √(mean |q − q_ref|²)/max |q_ref| over the rows after the first `skip`.
pub fn error(rows: &[Vec<f64>], reference: &[Vec<f64>], skip: usize) -> f64 {
    assert_eq!(rows.len(), reference.len(), "times of the run and of the reference");
    let square = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>();
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for (row, exact) in rows.iter().zip(reference).skip(skip) {
        assert_eq!(row.len(), exact.len(), "columns of the run and of the reference");
        sum += square(&mut row.iter().zip(exact).map(|(a, b)| a - b));
        largest = largest.max(square(&mut exact.iter().copied()));
    }
    (sum / (rows.len() - skip) as f64 / largest).sqrt()
}

/// Slope of the straight line through (log x, log y), by least squares.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
    let (mx, my) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - mx) * (p.1 - my)) / mean(&|p| (p.0 - mx).powi(2))
}

/// The model of a deck's text.
pub fn read_deck(text: &str) -> Model {
    let source = Source::new("deck.toml", text, &[]);
    let (model, problems) = model::read(&source);
    model
        .map(with_matrices)
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// The tables that a run writes.
pub struct Tables(tempfile::TempDir);

/// Runs a model to its end and keeps its tables.
pub fn tables_of(model: &Model) -> Tables {
    let folder = tempfile::tempdir().unwrap();
    let (system, stop) = (System::new(model).expect("a system"), AtomicBool::new(false));
    let plan = Plan::new(model, &system, 1);
    let mut files = Files::open(folder.path(), model).unwrap();
    let (outcome, _) = Run::new(model, &system, &plan, wanted(model), &stop).unwrap().run(&mut files);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    files.finish().unwrap();
    Tables(folder)
}

impl Tables {
    /// The tables in a folder.
    pub fn of(folder: tempfile::TempDir) -> Tables {
        Tables(folder)
    }

    /// Bytes of all grids, or of all other files.
    pub fn bytes(&self, of_grids: bool) -> u64 {
        let entries = fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap());
        let entries = entries.filter(|entry| entry.path().extension().is_some_and(|kind| kind == "vtu") == of_grids);
        entries.map(|entry| entry.metadata().unwrap().len()).sum()
    }

    pub fn rows(&self, file: &str) -> Vec<Row> {
        let mut reader = csv::Reader::from_path(self.0.path().join(file)).unwrap();
        reader.deserialize().map(|row| Row(row.unwrap())).collect()
    }
}

/// A row of a table by the names of its columns.
pub struct Row(HashMap<String, String>);

impl Row {
    pub fn text(&self, column: &str) -> &str {
        self.0.get(column).unwrap_or_else(|| panic!("no column `{column}`"))
    }

    /// All columns that hold a number here.
    pub fn numbers(&self) -> Vec<(&str, f64)> {
        self.0.iter().filter_map(|(column, text)| Some((column.as_str(), text.parse().ok()?))).collect()
    }

    pub fn number(&self, column: &str) -> f64 {
        self.text(column).parse().unwrap_or_else(|_| panic!("{column}: {}", self.text(column)))
    }
}

/// Verbs with which a message begins to say what to change.
const REMEDIES: [&str; 33] = [
    "add", "bring", "check", "choose", "close", "compare", "correct", "end", "find", "fix", "follow", "give", "halve",
    "join", "leave", "let", "list", "look", "lower", "make", "move", "name", "put", "raise", "remove", "rename",
    "replace", "reverse", "run", "start", "take", "use", "write",
];

/// True where a clause of the message begins with a verb that says what to change.
fn says_what_to_change(message: &str) -> bool {
    let first = |clause: &str| {
        clause.split(|c: char| !c.is_alphanumeric()).find(|word| !word.is_empty()).map(str::to_lowercase)
    };
    let mut clauses = message.split(['.', ':', ';', ',', '\n']).filter_map(first);
    clauses.any(|word| REMEDIES.contains(&&*word))
}

/// Fails where a message names no thing or value, or does not say what to change.
#[track_caller]
pub fn assert_three_parts(message: &str) {
    let names = message.contains('`') || message.contains(|c: char| c.is_ascii_digit());
    assert!(names, "no thing and no value: {message}");
    assert!(says_what_to_change(message), "no remedy: {message}");
}

/// Forms of errors that say what to write.
const REQUIREMENTS: [&str; 8] =
    ["must ", " takes ", " can be ", " lie between ", "at most ", "at least ", " has errors", " has none"];

/// Fails where a message about a deck does not say what to change.
#[track_caller]
pub fn assert_says_what_to_change(problem: &Diagnostic) {
    let message = &problem.message;
    let requires = problem.is_error() && REQUIREMENTS.iter().any(|form| message.contains(form));
    assert!(requires || says_what_to_change(message) || !problem.remedies().is_empty(), "no remedy: {message}");
}
