//! `rdsolve study deck.toml`: error against run time over a grid of settings; `--rigidify`: what rigid parts would cost and save.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;

use super::arguments::MAX_THREADS;
use super::console::{complain, counted, print, say, show};
use super::exit::Exit;
use super::folder::{named_after, require_free};
use super::load::{Loaded, is_standard_input, load};
use super::processor::Level;
use super::signals::{EndAtOnce, stop_on_signals};
use super::study_defaults;
use base::diagnostic::{Diagnostic, Source};
use base::words::{PER_DECADE, rungs};
use deck::Deck;
use model::Model;
use results::FolderLock;
use solve::plan::Plan;
use solve::system::System;
use study::{
    Cost, Found, Options, RunStatus, StudyAdvice, StudyFault, recommend as recommended, rigidify, study as studied,
    text,
};

#[derive(Debug, Args)]
#[command(
    after_help = "Every run is a process of its own: the first of a setting gives its error, the others, in turn with those of the \
other settings, its time, of which the least counts. Error = rms over equidistant times / largest value, all quantities \
together, relative to the reference of `[study]`, or else to what the finest runs tend to (Richardson extrapolation), with a \
bound of its own error. An option overrides the key of the same name in the deck's `[study]`.

Written: study.csv (a row for each run), study.svg, asked.svg (automatic \
steps), study.html; or rigidify.csv; and study.list, the files that the study has \
written. Runs that failed are listed as failed.

Exit codes: 0 done, 2 usage, 3 deck invalid, 4 no run came to its end, 5 no setting reaches the error of --recommend, 6 input/output, 75 stopped by a signal, with what there is."
)]
pub struct StudyArgs {
    /// The deck, a TOML file
    deck: PathBuf,
    /// Override one entry of the deck, as for `run`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Schemes, with their parameters behind colons: newmark,generalized-alpha:spectral_radius=0.5
    #[arg(long, value_name = "SCHEME", value_delimiter = ',')]
    schemes: Vec<String>,
    /// Iteration methods: tangent-stiffness,initial-load,auto
    #[arg(long, value_name = "METHOD", value_delimiter = ',')]
    methods: Vec<String>,
    /// Time steps; with --halvings, the longest one; 1e-2..1e-4: by factors of 10^(1/4)
    #[arg(long, value_name = "DT", value_delimiter = ',', value_parser = climbed)]
    time_steps: Vec<Climbed>,
    /// Further runs with an automatic time step, at these error tolerances, or a ladder of them: 1e-1..1e-4
    #[arg(long, value_name = "TOL", value_delimiter = ',', value_parser = climbed)]
    error_tolerances: Vec<Climbed>,
    /// Number of times the time step is halved
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=30))]
    halvings: Option<u64>,
    /// Tolerances of the iteration, or a ladder of them: 1e-2,1e-4,1e-8
    #[arg(long, value_name = "TOL", value_delimiter = ',', value_parser = climbed)]
    iteration_tolerances: Vec<Climbed>,
    /// Factors on the numbers of elements: 1,2,4
    #[arg(long, value_name = "FACTOR", value_delimiter = ',', value_parser = positive)]
    meshes: Vec<f64>,
    /// Polynomial degrees of the elements of all beams: 1,2,3
    #[arg(long, value_name = "ORDER", value_delimiter = ',', value_parser = clap::value_parser!(u64).range(1..=4))]
    beam_orders: Vec<u64>,
    /// CSV file of reference values, relative to the current folder
    #[arg(long, value_name = "FILE")]
    reference: Option<PathBuf>,
    /// Use the limit of the finest runs as reference, even if the deck names a reference
    #[arg(long, conflicts_with = "reference")]
    finest: bool,
    /// Quantities on which errors are measured: tip.uz,block.x
    #[arg(long, alias = "quantity", value_name = "NAME.QUANTITY", value_delimiter = ',')]
    quantities: Vec<String>,
    /// Number of intervals between the times of comparison
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    samples: Option<u64>,
    /// Name the cheapest setting for these errors
    #[arg(long, value_name = "ERROR", value_delimiter = ',', value_parser = positive)]
    wanted_error: Vec<f64>,
    /// Horizontal axis of the picture: seconds, or counts, which do not scatter
    #[arg(long, value_name = "COST", value_enum, default_value_t)]
    axis: Cost,
    /// Print only the deck lines of the cheapest setting with this error; exit code 5 if there is none. With `--rigidify` the fastest form of each part
    #[arg(long, value_name = "ERROR", value_parser = positive, conflicts_with = "wanted_error")]
    recommend: Option<f64>,
    /// Runs of each setting
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeats: u16,
    /// Seconds after which a setting is not run again
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = positive)]
    budget: f64,
    /// Instead of a grid of settings, run with each part rigid and reduced in turn: its share of the elastic energy, error, time saved
    #[arg(long, conflicts_with_all = ["schemes", "methods", "time_steps", "error_tolerances", "halvings", "iteration_tolerances", "meshes", "beam_orders", "reference", "finest", "wanted_error", "axis"])]
    rigidify: bool,
    /// Threads of each run, from 1 to 64
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=MAX_THREADS))]
    threads: u8,
    /// Folder for the study [default: the deck's name with .study, in the current folder]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write into a folder that already holds files; those of an older study, listed in its study.list, are removed
    #[arg(long)]
    overwrite: bool,
    /// Show neither progress nor warnings
    #[arg(long)]
    quiet: bool,
}

/// Reads a number above zero, for clap.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("a number above zero is wanted".to_owned()),
    }
}

/// A number of a list, or a ladder of them.
#[derive(Debug, Clone)]
struct Climbed(Vec<f64>);

/// Reads a number above zero, or a ladder from one to another.
fn climbed(text: &str) -> Result<Climbed, String> {
    match text.split_once("..") {
        None => positive(text).map(|number| Climbed(vec![number])),
        Some((from, to)) => Ok(Climbed(rungs(positive(from)?, positive(to)?, PER_DECADE))),
    }
}

/// Refuses decks of modes, which have no steps.
fn with_steps(loaded: Loaded) -> Result<Loaded, Exit> {
    if !loaded.model.analysis.has_modes() {
        return Ok(loaded);
    }
    complain(
        "a study compares motions or load steps, but this deck computes modes. Give `kind` = \"dynamic\" or \"static\"",
    );
    Err(Exit::DeckInvalid)
}

/// Runs the studies of a deck and prints their outcome.
///
/// # Errors
/// The exit code of every study that has no outcome, or was stopped; the reason has been shown.
pub fn study(args: &StudyArgs) -> Result<(), Exit> {
    let reading = EndAtOnce::on_signals();
    let (mut sets, mut names) = (args.sets.clone(), Vec::new());
    for (name, value) in args.keys()? {
        sets.push(format!("study.{}={value}", name.trim_start_matches("--").replace('-', "_")));
        names.push(name.to_owned());
    }
    if is_standard_input(&args.deck) {
        complain("a study runs its deck many times: give it a file, not standard input");
        return Err(Exit::Usage);
    }
    let mut loaded = with_steps(load_one(&args.deck, &sets, names.clone())?)?;
    if let Some(wanted) = args.recommend {
        // The last of the overrides stand for options: what completes them goes before.
        let defaults = study_defaults::defaults(&loaded.model, wanted);
        sets.splice(args.sets.len()..args.sets.len(), defaults);
        loaded = load(&args.deck, &sets, names)?;
    }
    let folder = args.output.clone().unwrap_or_else(|| named_after(&args.deck, "study"));
    require_free(&folder, args.overwrite)?;
    if !args.quiet {
        show(&loaded.warnings, &loaded.source);
    }
    // Studies run the deck itself with other entries; the model is sound, so there is a deck.
    let (Some(deck), _) = deck::read(&loaded.source) else { return Err(Exit::Internal) };
    if !args.rigidify {
        let problems = massless(&loaded.model)?;
        if !problems.is_empty() {
            return Err(exit(StudyFault::Deck(problems), &loaded.source));
        }
    }
    let stop = Arc::new(AtomicBool::new(false));
    stop_on_signals(&stop).map_err(|error| exit(error.into(), &loaded.source))?;
    drop(reading);
    let (model, options) = (&loaded.model, args.options(&folder));
    let _lock = FolderLock::make(&folder).map_err(|error| exit(error.into(), &loaded.source))?;
    let outcome = if args.rigidify {
        rigidify(model, &deck, &options, &stop).map(|advice| Outcome::of_advice(&advice, args.recommend))
    } else {
        studied(model, &deck, &options, &stop).map(|found| Outcome::of_grid(&found, &deck, args.recommend))
    };
    let Outcome { text, stopped, any, lacking } = outcome.map_err(|fault| exit(fault, &loaded.source))?;
    print(&text)?;
    if !args.quiet {
        say(&format!("results in {}", folder.display()));
    }
    if stopped {
        complain("stopped by a signal; the runs that were complete have been written");
        return Err(Exit::Stopped);
    }
    if !any {
        complain("no run completed: run the deck alone with `rdsolve run`, which prints the cause");
        return Err(Exit::NotConverged);
    }
    if let Some(lacking) = lacking {
        complain(&lacking);
        return Err(Exit::CheckFailed);
    }
    Ok(())
}

/// The outcome of a study.
struct Outcome {
    /// The text for standard output.
    text: String,
    /// Whether a signal has stopped it.
    stopped: bool,
    /// Whether any run came to its end.
    any: bool,
    /// Why nothing is recommended, where a recommendation was asked for.
    lacking: Option<String>,
}

impl Outcome {
    fn of_advice(advice: &StudyAdvice, wanted: Option<f64>) -> Outcome {
        let any = advice.base.status == RunStatus::Done;
        Outcome { text: advice.text(wanted), stopped: advice.stopped, any, lacking: None }
    }

    fn of_grid(found: &Found, deck: &Deck, wanted: Option<f64>) -> Outcome {
        let any = found.runs.iter().any(|run| run.status == RunStatus::Done);
        let stopped = found.stopped;
        let (text, lacking) = match wanted.map(|wanted| recommended(found, deck, wanted)) {
            None => (text(found), None),
            Some(Ok(lines)) => (lines, None),
            Some(Err(reason)) => (String::new(), Some(reason)),
        };
        Outcome { text, stopped, any, lacking }
    }
}

/// Says why there is no study, and gives the exit code.
fn exit(fault: StudyFault, source: &Source) -> Exit {
    match fault {
        StudyFault::Deck(problems) => {
            show(&problems, source);
            complain(&format!("`{}` cannot be studied: {}", source.path, counted(problems.len(), "error")));
            Exit::DeckInvalid
        }
        StudyFault::Io(error) if error.kind() == std::io::ErrorKind::Interrupted => {
            complain(&error.to_string());
            Exit::Stopped
        }
        StudyFault::Io(error) => {
            complain(&format!("the study cannot go on: {error}"));
            Exit::InputOutput
        }
    }
}

/// The obstacle for the explicit schemes of a study: free degrees of freedom without mass. The runs would each fail for the same reason.
fn massless(model: &Model) -> Result<Vec<Diagnostic>, Exit> {
    let listed = model.study.iter().flat_map(|study| &study.schemes).map(|choice| &choice.scheme);
    let own = model.study.as_ref().is_none_or(|study| study.schemes.is_empty()).then_some(&model.solution.scheme);
    let mut problems = Vec::new();
    for scheme in listed.chain(own).filter(|scheme| scheme.is_explicit()) {
        let mut model = model.clone();
        model.solution.scheme = scheme.clone();
        let system = System::new(&model).map_err(|error| {
            complain(&error);
            Exit::Internal
        })?;
        problems.extend(Plan::new(&model, &system, 1).massless(&model, &system));
    }
    Ok(problems)
}

impl StudyArgs {
    /// How the study is run: all options that are no keys of `[study]`.
    fn options(&self, folder: &Path) -> Options {
        Options {
            deck: self.deck.clone(),
            sets: self.sets.clone(),
            folder: folder.to_owned(),
            threads: usize::from(self.threads),
            repeats: usize::from(self.repeats),
            budget: self.budget,
            axis: self.axis,
            quiet: self.quiet,
            instructions: Level::BUILT_FOR.map_or("", Level::name),
        }
    }

    /// Options that stand for keys of `[study]`, with their values in TOML.
    fn keys(&self) -> Result<Vec<(&'static str, String)>, Exit> {
        // Strings are written in JSON, which is valid TOML.
        let texts = |list: &[String]| serde_json::Value::from(list.to_vec()).to_string();
        let numbers = |list: &[f64]| {
            let list: Vec<String> = list.iter().map(|number| format!("{number:?}")).collect();
            format!("[{}]", list.join(", "))
        };
        let ladder = |list: &[Climbed]| numbers(&list.iter().flat_map(|of| of.0.iter().copied()).collect::<Vec<_>>());
        let mut keys = Vec::new();
        let mut add = |name, given: bool, value: String| {
            if given {
                keys.push((name, value));
            }
        };
        add("--schemes", !self.schemes.is_empty(), texts(&self.schemes));
        add("--methods", !self.methods.is_empty(), texts(&self.methods));
        add("--time-steps", !self.time_steps.is_empty(), ladder(&self.time_steps));
        // A list of time steps on the command line is complete, whatever the deck would halve.
        let halvings = self.halvings.or((!self.time_steps.is_empty()).then_some(0));
        add("--halvings", halvings.is_some(), halvings.unwrap_or_default().to_string());
        add("--error-tolerances", !self.error_tolerances.is_empty(), ladder(&self.error_tolerances));
        add("--iteration-tolerances", !self.iteration_tolerances.is_empty(), ladder(&self.iteration_tolerances));
        add("--beam-orders", !self.beam_orders.is_empty(), format!("{:?}", self.beam_orders));
        add("--meshes", !self.meshes.is_empty(), numbers(&self.meshes));
        add("--quantities", !self.quantities.is_empty(), texts(&self.quantities));
        add("--samples", self.samples.is_some(), self.samples.unwrap_or_default().to_string());
        let wanted: Vec<f64> = self.recommend.into_iter().chain(self.wanted_error.iter().copied()).collect();
        add("--wanted-error", !wanted.is_empty(), numbers(&wanted));
        add("--finest", self.finest, "true".into());
        if let Some(file) = &self.reference {
            // A path in the deck starts at the deck; one on the command line starts at the current folder.
            let file = file.canonicalize().map_err(|error| {
                complain(&format!("cannot read the reference `{}`: {error}", file.display()));
                Exit::InputOutput
            })?;
            keys.push(("--reference", serde_json::Value::from(file.display().to_string()).to_string()));
        }
        Ok(keys)
    }
}

/// Reads a deck like [`load`], which must not have stages.
///
/// # Errors
/// As for [`load`], and [`Exit::DeckInvalid`] for a deck with stages; the reason has been shown.
fn load_one(deck: &Path, sets: &[String], names: Vec<String>) -> Result<Loaded, Exit> {
    let loaded = load(deck, sets, names)?;
    if loaded.model.analysis.stage.is_some() {
        complain("a study does not go over stages: give it a deck with one [analysis] in place of `[[stages]]`");
        return Err(Exit::DeckInvalid);
    }
    Ok(loaded)
}
