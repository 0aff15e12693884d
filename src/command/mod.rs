//! The command line: one file per word. This one holds what they share: arguments, exit codes, reading a deck.

mod check;
mod compare;
mod report;
mod run;
mod schema;
mod study;

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use sha2::{Digest, Sha256};

use crate::diagnostic::{Diagnostic, Source};
use crate::linear::TooLarge;
use crate::model::{self, Model};
use crate::plan::Plan;
use crate::system::System;

/// How the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    Done = 0,
    /// A fault of the program itself.
    Internal = 1,
    Usage = 2,
    DeckInvalid = 3,
    /// Results are valid up to the time named.
    NotConverged = 4,
    /// A comparison or an expected value failed.
    CheckFailed = 5,
    InputOutput = 6,
    /// By a signal.
    Stopped = 75,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// Batch solver for the nonlinear dynamics of structures made of rigid bodies and deformable parts.
#[derive(Debug, Parser)]
#[command(
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    arg_required_else_help = true
)]
#[command(after_help = "`rdsolve deck.toml` is short for `rdsolve run deck.toml`.

Exit codes: 0 done, 1 internal error, 2 usage, 3 deck invalid, 4 did not converge, 5 a check failed, 6 input/output,
75 stopped by a signal.")]
pub struct Cli {
    #[command(subcommand)]
    word: Option<Word>,
    #[command(flatten)]
    run: Option<RunArgs>,
}

#[derive(Debug, Subcommand)]
enum Word {
    /// Run a deck
    Run(RunArgs),
    /// Read and validate a deck and print what would be computed; runs nothing
    Check(DeckArgs),
    /// Say whether two folders of results agree
    Compare(compare::CompareArgs),
    /// Make one HTML file of a folder of results: plots, energy balance, the moving scene
    Report(report::ReportArgs),
    /// Error against run time over time steps, schemes, methods and meshes; or what rigid parts would cost and save
    Study(Box<study::StudyArgs>),
    /// Print the JSON Schema of the deck
    Schema,
}

#[derive(Debug, Args)]
struct DeckArgs {
    /// The deck, a TOML file
    deck: PathBuf,
    /// Override one entry of the deck: a dotted path with list items by name or number, and a TOML value
    /// (beams.portal.elements=24); a bare word is taken as text; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
}

/// More gain nothing, and thousands cannot be had.
const MOST_THREADS: i64 = 64;

#[derive(Debug, Args)]
struct RunArgs {
    // As in `DeckArgs`: clap does not find a group within an optional group.
    /// The deck, a TOML file
    deck: PathBuf,
    /// Override one entry of the deck: a dotted path with list items by name or number, and a TOML value
    /// (beams.portal.elements=24); a bare word is taken as text; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Folder for the results [default: the deck's name with .out, in the current folder]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Threads to use, from 1 to 64; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MOST_THREADS))]
    threads: Option<u8>,
    /// Show errors only
    #[arg(long)]
    quiet: bool,
    /// Write into a folder that already holds files
    #[arg(long)]
    overwrite: bool,
}

/// Does what the command line asks for.
pub fn execute(cli: Cli) -> Exit {
    let done = match (cli.word, cli.run) {
        (Some(Word::Run(args)), _) | (None, Some(args)) => run::run(&args),
        (Some(Word::Check(args)), _) => check::check(&args),
        (Some(Word::Compare(args)), _) => compare::compare(&args),
        (Some(Word::Report(args)), _) => report::report(&args),
        (Some(Word::Study(args)), _) => study::study(&args),
        (Some(Word::Schema), _) => schema::schema(),
        // Clap asks for a deck before it lets this happen.
        (None, None) => Err(Exit::Usage),
    };
    done.err().unwrap_or(Exit::Done)
}

/// A deck that can be run.
#[derive(Debug)]
pub struct Loaded {
    pub model: Model,
    pub warnings: Vec<Diagnostic>,
    pub source: Source,
    /// SHA-256 of the text, the `--set` arguments and the mesh, in hexadecimal.
    pub hash: String,
}

/// Reads a deck and builds its model. If that fails, all errors have been shown.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, Exit> {
    load_with(path, sets, Vec::new())
}

/// The same; the last of the overrides stand for `options`: if all that is wrong stands there, the usage is wrong.
fn load_with(path: &Path, sets: &[String], options: Vec<String>) -> Result<Loaded, Exit> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| {
        complain(&format!("cannot read the deck `{name}`: {error}"));
        Exit::InputOutput
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
        complain(&format!("the deck `{name}` is not UTF-8 text: see line {line}"));
        Exit::DeckInvalid
    })?;
    let source = Source::new(name, text, sets).with_options(options);
    match model::read(&source) {
        (Some(model), warnings) => {
            let hash = hash(&source, sets, &model);
            Ok(Loaded { model, warnings, source, hash })
        }
        (None, problems) => {
            let errors = problems.iter().filter(|problem| problem.is_error()).count();
            show(&problems, &source);
            let in_option = |problem: &Diagnostic| problem.place.as_ref().is_some_and(|place| source.is_option(place));
            if problems.iter().filter(|problem| problem.is_error()).all(in_option) {
                complain(&format!("the options have {}", counted(errors, "error")));
                return Err(Exit::Usage);
            }
            let warnings = problems.len() - errors;
            let besides = if warnings > 0 { format!(" and {}", counted(warnings, "warning")) } else { String::new() };
            complain(&format!("`{}` has {}{besides}", source.path, counted(errors, "error")));
            Err(Exit::DeckInvalid)
        }
    }
}

/// What a deck that can be run needs to be run. If that fails, it has been said.
fn planned(loaded: &Loaded, threads: usize) -> Result<(System, Plan), Exit> {
    let system = System::new(&loaded.model).map_err(|error| {
        complain(&error);
        Exit::Internal
    })?;
    let plan = Plan::new(&loaded.model, &system, threads);
    let mut problems = plan.never_passed(&loaded.model);
    problems.extend(plan.massless(&loaded.model, &system));
    problems.extend(plan.half_turning(&loaded.model));
    if problems.is_empty() {
        return Ok((system, plan));
    }
    show(&problems, &loaded.source);
    complain(&format!("`{}` has {}", loaded.source.path, counted(problems.len(), "error")));
    Err(Exit::DeckInvalid)
}

fn no_room(error: TooLarge) -> Exit {
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
    if let Some(mesh) = &model.mesh {
        hasher.update([0, 0]);
        hasher.update(mesh.digest);
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// Draws diagnostics on standard error.
pub fn show(problems: &[Diagnostic], source: &Source) {
    for problem in problems {
        say(&format!("{}\n", problem.draw(source, is_styled())));
    }
}

/// What the plan has found out about a sound model, as warnings.
pub fn doubts(plan: &Plan, model: &Model, system: &System) -> Vec<Diagnostic> {
    plan.repeated(model, system).into_iter().map(|text| Diagnostic::warning(format!("joints: {text}"))).collect()
}

/// An error that has no place in a deck.
pub fn complain(message: &str) {
    let (bold, plain) = if is_styled() { ("\u{1b}[1m\u{1b}[91m", "\u{1b}[0m") } else { ("", "") };
    say(&format!("{bold}error{plain}: {message}"));
}

/// One line on standard error; there is nowhere to report that it cannot be written.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

fn is_styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// The folder for the results of a deck, which must be new, empty, or given up by `--overwrite`.
fn output_folder(args: &RunArgs) -> Result<PathBuf, Exit> {
    let folder = args.output.clone().unwrap_or_else(|| beside(&args.deck, "out"));
    free_folder(&folder, args.overwrite).map(|()| folder)
}

/// A folder named after a deck, whose last extension alone goes: `a.v1.toml` and `a.v2.toml` are two.
fn beside(deck: &Path, extension: &str) -> PathBuf {
    let mut name = deck.file_stem().unwrap_or_default().to_owned();
    name.push(".");
    name.push(extension);
    PathBuf::from(name)
}

/// A folder is new, empty, or given up.
fn free_folder(folder: &Path, overwrite: bool) -> Result<(), Exit> {
    let entries = match std::fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_some(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => false,
        Err(error) => {
            complain(&format!("cannot write to `{}`: {error}", folder.display()));
            return Err(Exit::InputOutput);
        }
    };
    if entries && !overwrite {
        complain(&format!("the folder `{}` holds files already", folder.display()));
        say("  help: --overwrite replaces results; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    Ok(())
}

/// Results for a script, on standard output. A reader that has gone away is no fault.
fn print(text: &str) -> Result<(), Exit> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot write to standard output: {error}"));
            Err(Exit::InputOutput)
        }
        _ => Ok(()),
    }
}
