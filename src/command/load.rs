//! The way from the text of a deck to a model and a plan. Where it fails, whatever is wrong has been shown.

use super::automatic_steps::{CENTRAL, choice, may_choose_central};
use super::console::{complain, counted, show};
use super::exit::Exit;
use base::diagnostic::{Diagnostic, Source};
use deck::DeckRead;
use linear::TooLarge;
use model::{self, Model};
use results::settle_cadence;
use sha2::{Digest, Sha256};
use solve::modes::reduce;
use solve::plan::explain::{much_mass_added, redundant_constraints};
use solve::plan::{Plan, unreachable_targets};
use solve::share_plane;
use solve::system::{MassScaling, System};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// A deck that can be run.
#[derive(Debug)]
pub struct Loaded {
    /// The scene of the deck, in its first stage.
    pub model: Model,
    /// The scene in the other stages.
    pub later: Vec<Model>,
    /// The mass scaling of the first stage that has any, once planned.
    pub mass_scaling: Option<MassScaling>,
    /// The warnings and notes about the deck, in the order of their display.
    pub warnings: Vec<Diagnostic>,
    /// The texts that the places of diagnostics refer to.
    pub source: Source,
    /// The `--set` arguments as they were given: `KEY=VALUE`.
    pub sets: Vec<String>,
    /// SHA-256 of the text, the `--set` arguments, the mesh and the records, in hexadecimal.
    pub hash: String,
}

/// The model of a deck that has been read before, with further overrides, for a run beside it.
///
/// # Errors
/// The deck is not valid with them.
pub fn read_with(source: &Source, sets: &[String]) -> Result<Model, String> {
    let all: Vec<String> = source.sets.iter().map(|(_, set)| set).chain(sets).cloned().collect();
    let source = Source::new(source.path.clone(), source.text.clone(), &all);
    let with = if sets.is_empty() { String::new() } else { format!(" with {}", sets.join(", ")) };
    let (Some(mut model), _) = model::read(&source) else { return Err(format!("the deck is not valid{with}")) };
    reduce(&mut [&mut model]).map_err(|_| format!("a reduced part has no matrices{with}"))?;
    Ok(model)
}

impl Loaded {
    /// This deck with central differences, if rdsolve chooses them for its automatic steps.
    pub fn with_chosen_scheme(self) -> Loaded {
        by_central_differences(&self).unwrap_or(self)
    }

    /// The models of all stages, or the only one.
    pub fn models(&self) -> Vec<&Model> {
        std::iter::once(&self.model).chain(&self.later).collect()
    }

    /// The files that the deck is read from: the deck itself, its mesh, its records, and the reference of its study.
    pub fn files(&self) -> Vec<PathBuf> {
        let deck = PathBuf::from(&self.source.path);
        let mesh = self.model.origin.mesh.as_ref().map(|mesh| PathBuf::from(&mesh.path));
        let reference = self.model.study.as_ref().and_then(|study| study.reference.as_ref());
        let reference = reference.map(|reference| deck.with_file_name(reference));
        let records = self.model.origin.records.iter().map(|record| PathBuf::from(&record.path));
        [Some(deck), mesh, reference].into_iter().flatten().chain(records).collect()
    }
}

/// Reads a deck and builds its model. The last of the overrides stand for `options`, by name: if all that is wrong stands there,
/// the usage is wrong.
///
/// # Errors
/// [`Exit::InputOutput`] if the deck cannot be read, [`Exit::DeckInvalid`] or [`Exit::Usage`] if it has errors.
pub fn load(path: &Path, sets: &[String], options: Vec<String>) -> Result<Loaded, Exit> {
    let source = Source::new(path.display().to_string(), text(path)?, sets).with_options(options);
    build(source, sets).map_err(|(problems, source)| {
        show(&problems, &source);
        conclude(&problems, &source)
    })
}

/// Builds the model of a deck.
///
/// # Errors
/// All faults, with the texts of their places.
pub fn build(source: Source, sets: &[String]) -> Result<Loaded, (Vec<Diagnostic>, Source)> {
    build_read(deck::read(&source), source, sets)
}

/// As [`build`], of the deck that has been read from the source.
pub fn build_read(deck: DeckRead, source: Source, sets: &[String]) -> Result<Loaded, (Vec<Diagnostic>, Source)> {
    let (mut models, mut said) = model::build_read(deck, &source);
    if let Err(problems) = reduce(&mut models.iter_mut().collect::<Vec<_>>()) {
        said.extend(problems);
        models.clear();
    }
    let mut models = models.into_iter();
    match models.next() {
        Some(model) => {
            let hash = hash(&source, sets, &model);
            Ok(Loaded {
                model,
                later: models.collect(),
                mass_scaling: None,
                warnings: said,
                source,
                sets: sets.to_vec(),
                hash,
            })
        }
        None => Err((said, source)),
    }
}

/// The deck with central differences; `None` where it asks for an error, or where central differences add a warning or take too many steps.
fn by_central_differences(loaded: &Loaded) -> Option<Loaded> {
    let source = &loaded.source;
    if !may_choose_central(&loaded.model) {
        return None;
    }
    let analysis = deck::read(source).0?.analysis?;
    if analysis.error_tolerance.is_some() || analysis.accuracy.is_some() {
        return None;
    }
    // In front of the others, so that the last ones still stand for options.
    let sets: Vec<String> =
        std::iter::once(CENTRAL).chain(source.sets.iter().map(|(_, set)| set.as_str())).map(str::to_owned).collect();
    let source = Source::new(source.path.clone(), source.text.clone(), &sets).with_options(source.options.clone());
    let mut central = build(source, &loaded.sets).ok()?;
    let warns = |of: &Loaded| of.warnings.iter().filter(|said| said.is_warning()).count();
    if warns(&central) > warns(loaded) {
        return None;
    }
    let (system, _, _) = prepare_model(&mut central.model.clone(), 1).ok()?;
    central.model.solution.choice = Some(choice(&central.model, &system)?);
    Some(central)
}

/// True for a deck named `-`, which comes on standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The largest number of bytes of a deck, enough for some millions of entries.
const LARGEST: u64 = 512 << 20;

/// The text of a deck.
pub fn text(path: &Path) -> Result<String, Exit> {
    let name = path.display();
    let mut bytes = Vec::new();
    // The length is bounded while reading, for a pipe has none to ask for and a device may have no end.
    let read = match is_standard_input(path) {
        true => std::io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes),
        false => File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes)),
    };
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

/// Counts the errors in a last line, and distinguishes wrong options from a wrong deck.
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

/// The system and the plan of a deck for a number of threads, and the warnings of the plan; this also fixes the times of output.
///
/// # Errors
/// [`Exit::DeckInvalid`] where the scene cannot be computed as the deck asks; the reason has been shown.
pub fn plan(loaded: &mut Loaded, threads: usize) -> Result<(System, Plan, Vec<Diagnostic>), Exit> {
    prepare(loaded, threads).map_err(|unfit| match unfit {
        Unfit::System(error) => {
            complain(&error);
            Exit::Internal
        }
        Unfit::Deck(problems) => {
            show(&problems, &loaded.source);
            complain(&format!("`{}` has {}", loaded.source.path, counted(problems.len(), "error")));
            Exit::DeckInvalid
        }
    })
}

/// The reason why a sound model cannot be computed.
pub enum Unfit {
    /// There are no equations for it.
    System(String),
    /// The demands of the deck cannot be met.
    Deck(Vec<Diagnostic>),
}

/// Like `plan`, but returns the errors instead of printing them.
///
/// # Errors
/// The reason why the scene cannot be computed as the deck asks.
pub fn prepare(loaded: &mut Loaded, threads: usize) -> Result<(System, Plan, Vec<Diagnostic>), Unfit> {
    if !loaded.later.is_empty() {
        share_plane(std::iter::once(&mut loaded.model).chain(&mut loaded.later)).map_err(Unfit::System)?;
    }
    let (system, plan, mut warnings) = prepare_model(&mut loaded.model, threads)?;
    loaded.mass_scaling = system.mass_scaling().cloned();
    for model in &mut loaded.later {
        let in_stage = |said: Diagnostic| {
            let stage = model_stage(model);
            said.hint(format!("in stage `{stage}`"))
        };
        let (system, _, said) = match prepare_model(&mut model.clone(), threads) {
            Err(Unfit::Deck(problems)) => return Err(Unfit::Deck(problems.into_iter().map(in_stage).collect())),
            prepared => prepared?,
        };
        loaded.mass_scaling = loaded.mass_scaling.take().or_else(|| system.mass_scaling().cloned());
        let is_said = |one: &Diagnostic| {
            warnings.iter().any(|said: &Diagnostic| said.message == one.message && said.place == one.place)
        };
        let new = said.into_iter().filter(|one| !is_said(one)).collect::<Vec<_>>();
        warnings.extend(new.into_iter().map(in_stage));
    }
    Ok((system, plan, warnings))
}

/// The name of the stage of a model; empty for a deck without stages.
pub fn model_stage(model: &Model) -> &str {
    model.analysis.stage.as_ref().map_or("", |stage| &stage.name)
}

/// The system and the plan of one model, with the warnings of the plan.
fn prepare_model(model: &mut Model, threads: usize) -> Result<(System, Plan, Vec<Diagnostic>), Unfit> {
    let system = System::new(model).map_err(Unfit::System)?;
    let plan = Plan::new(model, &system, threads);
    let mut problems = unreachable_targets(&plan, model);
    problems.extend(plan.massless(model, &system));
    problems.extend(plan.partial_rotations(model));
    if !problems.is_empty() {
        return Err(Unfit::Deck(problems));
    }
    settle_cadence(model, &plan);
    let warnings = plan_warnings(&plan, model, &system);
    Ok((system, plan, warnings))
}

/// Warnings about a valid model that need its plan.
fn plan_warnings(plan: &Plan, model: &Model, system: &System) -> Vec<Diagnostic> {
    let redundant = redundant_constraints(plan, model, system).into_iter().map(Diagnostic::warning);
    redundant.chain(much_mass_added(system)).collect()
}

/// Says that there is no memory for the matrix of the solver.
pub fn too_large(error: TooLarge) -> Exit {
    complain(&error.to_string());
    Exit::TooLittleMemory
}

/// SHA-256 of all that the model is read from, in hexadecimal digits.
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
    for record in &model.origin.records {
        hasher.update([0, 0, 0]);
        hasher.update(record.digest);
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
