//! From the text of a deck to a model and a plan; whatever is wrong with it has been shown when these fail.

use super::console::{complain, counted, show};
use super::exit::Exit;
use crate::diagnostic::{Diagnostic, Source};
use crate::linear::TooLarge;
use crate::model::{self, Model};
use crate::plan::explain::redundant_constraints;
use crate::plan::{Plan, unreachable_targets};
use crate::system::System;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// A deck that can be run.
#[derive(Debug)]
pub struct Loaded {
    pub model: Model,
    pub warnings: Vec<Diagnostic>,
    pub source: Source,
    /// As they were given: `KEY=VALUE`.
    pub sets: Vec<String>,
    /// SHA-256 of the text, the `--set` arguments and the mesh, in hexadecimal.
    pub hash: String,
}

impl Loaded {
    /// Files that the deck is read from.
    pub fn files(&self) -> Vec<PathBuf> {
        let deck = PathBuf::from(&self.source.path);
        let mesh = self.model.origin.mesh.as_ref().map(|mesh| PathBuf::from(&mesh.path));
        let reference = self.model.study.as_ref().and_then(|study| study.reference.as_ref());
        let reference = reference.map(|reference| deck.with_file_name(reference));
        [Some(deck), mesh, reference].into_iter().flatten().collect()
    }
}

/// Reads a deck and builds its model. The last of the overrides stand for `options`, by name: if all that is wrong stands there,
/// the usage is wrong.
pub fn load(path: &Path, sets: &[String], options: Vec<String>) -> Result<Loaded, Exit> {
    let source = Source::new(path.display().to_string(), text(path)?, sets).with_options(options);
    match model::read(&source) {
        (Some(model), warnings) => {
            let hash = hash(&source, sets, &model);
            Ok(Loaded { model, warnings, source, sets: sets.to_vec(), hash })
        }
        (None, problems) => {
            show(&problems, &source);
            Err(conclude(&problems, &source))
        }
    }
}

/// Bytes of a deck at most: some millions of entries.
const LARGEST: u64 = 512 << 20;

/// The text of a deck.
fn text(path: &Path) -> Result<String, Exit> {
    let name = path.display();
    let mut bytes = Vec::new();
    // A pipe is welcome, a device without end is not.
    let read = File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes));
    let judged = read.and_then(|_| match bytes.len() as u64 > LARGEST {
        true => Err(std::io::Error::other(format!("it has more than {} MB", LARGEST >> 20))),
        false => Ok(()),
    });
    judged.map_err(|error| {
        let hint = match error.kind() {
            ErrorKind::IsADirectory => "\n  help: folders of results are for `report` and `compare`",
            _ => "",
        };
        complain(&format!("cannot read the deck `{name}`: {error}{hint}"));
        Exit::InputOutput
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
        complain(&format!("the deck `{name}` is not UTF-8 text: see line {line}"));
        Exit::DeckInvalid
    })
}

/// Counts what is wrong in a last line, and tells wrong options from a wrong deck.
fn conclude(problems: &[Diagnostic], source: &Source) -> Exit {
    let errors: Vec<&Diagnostic> = problems.iter().filter(|problem| problem.is_error()).collect();
    let in_option = |problem: &&Diagnostic| problem.place.as_ref().is_some_and(|place| source.is_option(place));
    if errors.iter().all(in_option) {
        complain(&format!("the options have {}", counted(errors.len(), "error")));
        return Exit::Usage;
    }
    let warnings = problems.iter().filter(|problem| problem.is_warning()).count();
    let besides = if warnings > 0 { format!(" and {}", counted(warnings, "warning")) } else { String::new() };
    complain(&format!("`{}` has {}{besides}", source.path, counted(errors.len(), "error")));
    Exit::DeckInvalid
}

/// The system and the plan of a deck, and what the plan warns of. If that fails, it has been said.
pub fn plan(loaded: &Loaded, threads: usize) -> Result<(System, Plan, Vec<Diagnostic>), Exit> {
    let system = System::new(&loaded.model).map_err(|error| {
        complain(&error);
        Exit::Internal
    })?;
    let plan = Plan::new(&loaded.model, &system, threads);
    let mut problems = unreachable_targets(&plan, &loaded.model);
    problems.extend(plan.massless(&loaded.model, &system));
    problems.extend(plan.partial_rotations(&loaded.model));
    if !problems.is_empty() {
        show(&problems, &loaded.source);
        complain(&format!("`{}` has {}", loaded.source.path, counted(problems.len(), "error")));
        return Err(Exit::DeckInvalid);
    }
    let warnings = plan_warnings(&plan, &loaded.model, &system);
    Ok((system, plan, warnings))
}

/// What the plan has found out about a sound model, as warnings.
fn plan_warnings(plan: &Plan, model: &Model, system: &System) -> Vec<Diagnostic> {
    redundant_constraints(plan, model, system).into_iter().map(Diagnostic::warning).collect()
}

/// There is no memory for the solver.
pub fn too_large(error: TooLarge) -> Exit {
    complain(&error.to_string());
    Exit::Internal
}

fn hash(source: &Source, sets: &[String], model: &Model) -> String {
    let mut hasher = Sha256::new();
    hasher.update(&source.text);
    for set in sets {
        // A byte that no TOML text holds keeps arguments apart.
        hasher.update([0]);
        hasher.update(set);
    }
    if let Some(mesh) = &model.origin.mesh {
        hasher.update([0, 0]);
        hasher.update(mesh.digest);
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
