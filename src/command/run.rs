//! `rdsolve run deck.toml`: reads a deck, plans the computation, steps through it and writes the results.

use std::collections::HashMap;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::accuracy::{ChosenSettings, settle};
use super::arguments::{MAX_THREADS, RunArgs};
use super::checkpoints::{Checkpoints, CheckpointsWanted};
use super::console::{complain, print, say, show};
use super::estimate::alternative;
use super::exit::Exit;
use super::folder::{named_after, require_free};
use super::load::{Loaded, Unfit, build_read, load, plan, prepare, too_large};
use super::memory::{Forecast, require_memory};
use super::mesh_error::{Judged, coarser_mesh, of_file, tell_mesh_error};
use super::resume::{checkpoint_in, checkpoint_origin, deck_digest, resume};
use super::signals::{EndAtOnce, end_with_input, stop_on_signals};
use super::stages::{StageRunner, StagesTold, explained_stage};
use super::verdict::{End, end, error_bars_in_words, line};
use super::version::{VERSION, instructions};
use super::watchers::{Watchers, stage_begins};
use base::diagnostic::{Diagnostic, Source};
use deck::ParsedText;
use model::{Model, StepLength};
use results::checkpoint::{Checkpoint, CheckpointOrigin};
use results::collected::{FoundNumber, in_words};
use results::error_bars::ErrorBars;
use results::log::Log;
use results::marks::SceneMarks;
use results::result_json::{
    ReportedCounts, ReportedErrors, ReportedMasses, ReportedMesh, ReportedStepError, RunOrigin, RunResult, Sizes,
    Status, Timings, peak_memory_bytes,
};
use results::{Files, FolderLock, RunKeeps, claim, wanted, wanted_with};
use solve::plan::Plan;
use solve::plan::explain::{Explanation, mass_added};
use solve::system::System;
use solve::{Counts, Outcome, Run, StepError};
use study::{CoarserMesh, LIFELINE};

/// Runs a deck.
///
/// # Errors
/// The exit code of every run that is not done ([`Exit`]); the reason has been shown.
pub fn run(args: &RunArgs) -> Result<(), Exit> {
    let began = Instant::now();
    let reading = EndAtOnce::on_signals();
    if std::env::var_os(LIFELINE).is_some() {
        std::thread::spawn(end_with_input);
    }
    let loaded = load(&args.deck, &args.sets, Vec::new())?.with_chosen_scheme();
    let read_s = began.elapsed().as_secs_f64();
    let folder = args.output.clone().unwrap_or_else(|| named_after(&args.deck, "out"));
    if !args.resume {
        require_free(&folder, args.overwrite)?;
    }
    let threads = use_threads(args.threads);
    let origin = checkpoint_origin(&loaded, deck_digest(&loaded.source.text), args.mesh_error);
    let checkpoint = args.resume.then(|| checkpoint_in(&folder, &origin)).transpose()?;
    let (mut loaded, chosen, pilots_s) = settled(loaded, threads, args.quiet)?;
    let checkpoint = checkpoint.map(|checkpoint| resume(&folder, checkpoint, (&origin, &loaded.hash))).transpose()?;
    let planning = Instant::now();
    let show = |warnings: &[Diagnostic], source: &Source| show(if args.quiet { &[] } else { warnings }, source);
    show(&loaded.warnings, &loaded.source);
    let (system, plan, warnings) = plan(&mut loaded, threads)?;
    show(&warnings, &loaded.source);
    loaded.warnings.extend(warnings);
    let plan_s = planning.elapsed().as_secs_f64();
    offer_alternative(args, &loaded.model, threads);
    let stop = Arc::new(AtomicBool::new(false));
    let forecast = Forecast::begin();
    let mut run = Run::new(&loaded.model, &system, &plan, wanted(&loaded.model), &stop).map_err(too_large)?;
    loaded.warnings.extend(require_memory(forecast, &run, (&loaded, args.quiet))?);
    let apart = loaded.model.output.checkpoint;
    let checkpoints = CheckpointsWanted { origin, apart, keeps_last: apart.is_some() };
    let job = Job {
        loaded: &loaded,
        folder: &folder,
        overwrite: args.overwrite || args.resume,
        checkpoints: Some(checkpoints),
        marks: true,
        keeps: RunKeeps::FILES,
        quiet: args.quiet,
        coarser: coarser_of(args, chosen.as_ref(), &loaded)?,
        chosen: chosen.as_ref(),
        threads,
        stop: &stop,
        began,
        plan: Some(explained(&loaded, &plan, &system)),
        sizes: sizes(&loaded, plan.dofs.unknowns(), system.multipliers()),
        timings: Timings { read_s, pilots_s, plan_s, ..Timings::default() },
    };
    let computed = stop_on_signals(&stop).and_then(|()| {
        drop(reading);
        let _lock = FolderLock::make(&folder)?;
        job.compute(&mut run, checkpoint.flatten())
    });
    let ended = computed.map_err(|error| {
        complain(&format!("cannot write results: {error}"));
        Exit::InputOutput
    })?;
    job.conclude(ended)
}

/// The coarser mesh for the error of the mesh, from the settings of `accuracy` or for `--mesh-error`. Without such a mesh the run ends.
fn coarser_of(args: &RunArgs, chosen: Option<&ChosenSettings>, loaded: &Loaded) -> Result<Option<CoarserMesh>, Exit> {
    match chosen.and_then(|chosen| chosen.coarser.clone()) {
        None if args.mesh_error => coarser_mesh(&loaded.source, &loaded.model).map(Some).map_err(|why| {
            complain(&format!("--mesh-error: {why}"));
            Exit::Usage
        }),
        mesh => Ok(mesh),
    }
}

/// Names a scheme that often takes less time.
fn offer_alternative(args: &RunArgs, model: &Model, threads: usize) {
    if !args.quiet && !args.resume {
        alternative(model, threads).iter().for_each(|note| say(&format!("note: {note}")));
    }
}

/// A variant of a deck that is one case of a sweep.
pub struct Case<'a> {
    /// Its overrides.
    pub sets: &'a [String],
    /// Its folder, whose lock is held.
    pub folder: &'a Path,
    /// The text of its deck, parsed without overrides.
    pub parsed: &'a ParsedText<'a>,
    /// The [`deck_digest`] of its deck.
    pub deck: &'a str,
    /// The digests of the files that the sweep has found when it began.
    pub files: &'a HashMap<PathBuf, Vec<u8>>,
    /// What its run keeps.
    pub keeps: RunKeeps<'a>,
}

/// The end of a case.
pub struct CaseEnd {
    /// The kind of end.
    pub status: Status,
    /// Its reason.
    pub reason: String,
    /// The warnings of the run.
    pub warnings: Vec<String>,
    /// The numbers found in the rows of every step, in their order.
    pub numbers: Vec<Option<f64>>,
}

/// Runs a variant of a deck on one thread, without messages, in a separate folder, with an unmarked result. Without files, it writes
/// nothing but checkpoints. The run continues from the checkpoint of a stopped run, or of a killed run whose deck requests checkpoints.
///
/// # Errors
/// The obstacle: errors of the deck as text, or an error of input/output.
pub fn run_case(source: Source, case: &Case, stop: &AtomicBool) -> Result<CaseEnd, CaseFault> {
    let Case { sets, folder, parsed, deck, files, keeps } = *case;
    let began = Instant::now();
    let faults = |problems: &[Diagnostic], source: &Source| {
        let errors = problems.iter().filter(|problem| problem.is_error());
        CaseFault::Deck(errors.map(|problem| problem.draw(source, false)).collect::<Vec<_>>().join("\n"))
    };
    let read = parsed.clone().into_deck(&source);
    let loaded =
        build_read(read, source, sets).map_err(|(problems, source)| faults(&problems, &source))?.with_chosen_scheme();
    go_on_unless(stop)?;
    let (mut loaded, chosen) = settle(loaded, 1, stop).map_err(|(problems, source)| faults(&problems, &source))?;
    go_on_unless(stop)?;
    refuse_changed(&loaded, files)?;
    let read_s = began.elapsed().as_secs_f64();
    let planning = Instant::now();
    let (system, plan, warnings) = prepare(&mut loaded, 1).map_err(|unfit| match unfit {
        Unfit::System(error) => CaseFault::Deck(error),
        Unfit::Deck(problems) => faults(&problems, &loaded.source),
    })?;
    go_on_unless(stop)?;
    loaded.warnings.extend(warnings);
    let made = || Run::new(&loaded.model, &system, &plan, wanted_with(&loaded.model, keeps.numbers), stop);
    let made = || made().map_err(|error| CaseFault::Deck(error.to_string()));
    let job = Job {
        loaded: &loaded,
        folder,
        overwrite: true,
        checkpoints: Some(CheckpointsWanted {
            origin: CheckpointOrigin {
                numbers: format!("{keeps:?}"),
                ..checkpoint_origin(&loaded, deck.to_owned(), false)
            },
            apart: loaded.model.output.checkpoint,
            keeps_last: false,
        }),
        marks: false,
        keeps,
        quiet: true,
        coarser: chosen.as_ref().and_then(|chosen| chosen.coarser.clone()),
        chosen: chosen.as_ref(),
        threads: 1,
        stop,
        began,
        plan: keeps.files.then(|| explained(&loaded, &plan, &system)),
        sizes: sizes(&loaded, plan.dofs.unknowns(), system.multipliers()),
        timings: Timings { read_s, plan_s: planning.elapsed().as_secs_f64(), ..Timings::default() },
    };
    if let Some(checkpoint) = job.checkpoints.as_ref().and_then(|wanted| left_over(folder, &wanted.origin)) {
        match job.compute(&mut made()?, Some(checkpoint)) {
            Err(error) if [ErrorKind::InvalidData, ErrorKind::NotFound].contains(&error.kind()) => {
                Checkpoint::remove(folder).map_err(CaseFault::Io)?;
            }
            done => return done.map(CaseEnd::from).map_err(CaseFault::Io),
        }
    }
    job.compute(&mut made()?, None).map(CaseEnd::from).map_err(CaseFault::Io)
}

/// Ends a case before it writes anything, if a signal came during the possibly long reading and planning.
fn go_on_unless(stop: &AtomicBool) -> Result<(), CaseFault> {
    if stop.load(Ordering::Relaxed) { Err(CaseFault::Stopped) } else { Ok(()) }
}

/// Refuses a case if its files differ from those in the name of its folder.
fn refuse_changed(loaded: &Loaded, files: &HashMap<PathBuf, Vec<u8>>) -> Result<(), CaseFault> {
    let origin = &loaded.model.origin;
    let mesh = origin.mesh.iter().map(|mesh| (&mesh.path, mesh.digest));
    let records = origin.records.iter().map(|record| (&record.path, record.digest));
    let is_other = |(path, digest): &(&String, [u8; 32])| {
        files.get(Path::new(path.as_str())).is_some_and(|found| found[..] != digest[..])
    };
    match mesh.chain(records).find(is_other) {
        Some((path, _)) => Err(CaseFault::Deck(format!(
            "`{path}` has changed since the sweep began: give the same command again, and all cases run with the new file"
        ))),
        None => Ok(()),
    }
}

/// The checkpoint of this origin in the folder of a case, if there is a whole one.
fn left_over(folder: &Path, origin: &CheckpointOrigin) -> Option<Checkpoint> {
    Checkpoint::read(folder).ok().flatten().filter(|found| found.origin.difference(origin).is_none())
}

/// The obstacle that keeps a case of a sweep from running.
pub enum CaseFault {
    /// Its deck has errors, which are these.
    Deck(String),
    /// A file cannot be read or written.
    Io(io::Error),
    /// A signal has come before its first step.
    Stopped,
}

/// Chooses and shows the settings for the accuracy of a deck, and measures the seconds of the pilot runs.
fn settled(loaded: Loaded, threads: usize, quiet: bool) -> Result<(Loaded, Option<ChosenSettings>, f64), Exit> {
    let began = Instant::now();
    let (loaded, chosen) = settle(loaded, threads, &AtomicBool::new(false)).map_err(|(problems, source)| {
        show(&problems, &source);
        Exit::DeckInvalid
    })?;
    let lines = chosen.iter().filter(|_| !quiet).flat_map(ChosenSettings::lines);
    lines.for_each(|line| say(&line));
    let seconds = if chosen.is_some() { began.elapsed().as_secs_f64() } else { 0.0 };
    Ok((loaded, chosen, seconds))
}

/// Makes the threads of a run, all cores unless a number is asked for, and returns their number.
fn use_threads(asked: Option<u8>) -> usize {
    let threads = asked.map_or_else(available_threads, usize::from);
    if threads > 1 {
        // Where the pool is there already, its threads serve: results do not depend on their number.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    }
    threads
}

/// The last line of the log.
fn last_line(end: &End) -> String {
    if end.status == Status::Done { "done".to_owned() } else { end.sentence() }
}

/// True where steps move a displacement.
fn moves_displacement(model: &Model) -> bool {
    matches!(&model.analysis.step_length, StepLength::ArcLength(path) if path.increment.is_some())
}

/// The plan of the first stage.
fn explained(loaded: &Loaded, plan: &Plan, system: &System) -> Explanation {
    let mut text = explained_stage(&loaded.model, plan, system);
    if let (None, Some(scaling)) = (system.mass_scaling(), &loaded.mass_scaling) {
        text.computed.extend(mass_added(scaling));
    }
    text
}

/// The number of threads without `--threads`: all cores, up to the limit of that option.
fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS as usize)
}

/// The sizes of the scene for the result.
fn sizes(loaded: &Loaded, unknowns: usize, multipliers: usize) -> Sizes {
    let model = &loaded.model;
    let elements = model.parts.iter().filter(|part| part.kind().is_deformable()).map(|part| part.elements()).sum();
    Sizes { nodes: model.nodes.len(), bodies: model.bodies.len(), elements, unknowns, multipliers }
}

/// One run that has come to an end.
struct Ended {
    end: End,
    result: RunResult,
    /// The modes and the energies in lines for the terminal.
    lines: Vec<String>,
    numbers: Vec<Option<f64>>,
}

impl From<Ended> for CaseEnd {
    fn from(Ended { result: RunResult { status, reason, warnings, .. }, numbers, .. }: Ended) -> CaseEnd {
        CaseEnd { status, reason, warnings, numbers }
    }
}

/// One run with all that is known of it before it begins.
struct Job<'a> {
    loaded: &'a Loaded,
    folder: &'a Path,
    overwrite: bool,
    /// The checkpoints; `None` where none are written.
    checkpoints: Option<CheckpointsWanted>,
    /// True if the result is final once written; otherwise the caller marks it, and removes the checkpoint.
    marks: bool,
    keeps: RunKeeps<'a>,
    quiet: bool,
    /// The mesh of another run for the error of the mesh.
    coarser: Option<CoarserMesh>,
    /// The settings that `accuracy` has chosen.
    chosen: Option<&'a ChosenSettings>,
    threads: usize,
    stop: &'a AtomicBool,
    began: Instant,
    /// The plan of the first stage; `None` where no files are kept.
    plan: Option<Explanation>,
    sizes: Sizes,
    timings: Timings,
}

impl Job<'_> {
    /// The deck and the program that the results will come from.
    fn origin(&self) -> RunOrigin {
        let Loaded { model, source, sets, hash, .. } = self.loaded;
        RunOrigin {
            version: VERSION.to_owned(),
            instructions: instructions(),
            title: model.title.clone(),
            units: model.output.units.clone().unwrap_or_default(),
            deck: source.path.clone(),
            sets: sets.clone(),
            deck_hash: hash.clone(),
        }
    }

    /// Runs the scene, or the rest of it after a checkpoint, and writes its files; an error is one of input/output.
    fn compute(&self, run: &mut Run, checkpoint: Option<Checkpoint>) -> io::Result<Ended> {
        let (resumes, writes) = (checkpoint.is_some(), self.keeps.files);
        let log = if writes { self.begin(resumes)? } else { Log::unread() };
        let mut watchers = self.watchers(log, resumes, run)?;
        let looping = Instant::now();
        let mut told = StagesTold { plan: self.plan.clone(), ..StagesTold::default() };
        let outcome = self.stages().run(run, checkpoint, (&mut watchers, &mut told))?;
        let whole = looping.elapsed();
        watchers.progress.finish();
        watchers.files.finish()?;
        watchers.log.sum_up()?;
        let mesh = self.mesh_error_of(&outcome, run, &mut watchers);

        told.tell_untouched(&outcome);
        told.remarks.iter().try_for_each(|remark| watchers.log.say(&format!("note: {remark}")))?;
        let warnings = std::mem::take(&mut told.warnings);
        let steps = told.step_error.map(step_error);
        let of_accuracy = self.chosen.map_or(Vec::new(), |chosen| chosen.warnings(steps.as_ref()));
        let of_files = [watchers.files.empty_fields(), of_accuracy].concat();
        let of_run = self.warnings_of(warnings, of_files, mesh.as_ref());
        of_run.iter().try_for_each(|warning| watchers.log.warn(warning))?;
        let warnings = self.warnings_of_deck().map(str::to_owned).chain(of_run).collect();
        let expectations = watchers.expectations.verdicts();
        let errors = ReportedErrors {
            step_error: steps,
            mass_scaling: self.loaded.mass_scaling.as_ref().map(ReportedMasses::from),
            mesh: mesh.and_then(Result::ok),
            accuracy: self.chosen.map(|chosen| chosen.report.clone()),
            error_bars: watchers.bars.map(ErrorBars::into_bars).unwrap_or_default(),
        };
        let bars = error_bars_in_words(&errors.error_bars);
        told.energy.iter().chain(&bars).try_for_each(|line| watchers.log.say(line))?;
        let bars = if errors.mesh.is_some() && expectations.is_empty() { bars } else { Vec::new() };
        let lines = [std::mem::take(&mut watchers.modes), std::mem::take(&mut told.energy), bars].concat();
        let end = end(outcome, (&told.missed, told.unstable_from, told.has_blown_up), &expectations)?;
        watchers.log.say(&last_line(&end))?;
        let result = RunResult {
            status: end.status,
            exit_code: end.status.exit_code(),
            reason: end.reason.clone(),
            valid_until: end.valid_until,
            origin: self.origin(),
            plan: [self.plan_in_words(), std::mem::take(&mut told.plans)].concat(),
            by_displacement: self.loaded.models().into_iter().any(moves_displacement),
            sizes: self.sizes,
            counts: counts(told.counts, told.failed),
            timings: self.timings_of(told.observing, whole),
            errors,
            joint_violation: told.joint_violation,
            rotation_drift: (told.rotation_drift > 0.0).then_some(told.rotation_drift),
            peak_memory_bytes: if writes { peak_memory_bytes() } else { None },
            warnings,
            expectations,
            collected: self.found(&watchers.files),
            marks: if writes { SceneMarks::of(&self.loaded.models()) } else { SceneMarks::default() },
        };
        let serves = end.status == Status::Stopped || watchers.checkpoints.is_some_and(|last| last.is_over());
        self.leave(&result, serves)?;
        Ok(Ended { end, result, lines, numbers: watchers.files.numbers() })
    }

    /// The collected numbers as the result has them.
    fn found(&self, files: &Files) -> Vec<FoundNumber> {
        let all = self.keeps.numbers.iter().cloned().zip(files.numbers());
        all.map(|(wanted, value)| FoundNumber { wanted, value: in_words(value) }).collect()
    }

    /// Writes the result unless numbers alone are kept, and removes a useless checkpoint; for a case the caller does both when its files are safe.
    fn leave(&self, result: &RunResult, checkpoint_serves: bool) -> io::Result<()> {
        if !self.keeps.files {
            return Ok(());
        }
        if !self.marks {
            return result.write_unmarked(self.folder);
        }
        result.write(self.folder)?;
        match self.checkpoints {
            Some(_) if !checkpoint_serves => Checkpoint::remove(self.folder),
            _ => Ok(()),
        }
    }

    /// Prepares the folder, and notes the run or its continuation in the log.
    fn begin(&self, resumes: bool) -> io::Result<Log> {
        if resumes {
            let mut log = Log::open(self.folder, true)?;
            log.say(&format!("the run goes on from its checkpoint, instructions {}", instructions()))?;
            return Ok(log);
        }
        claim(self.folder, self.overwrite, &self.loaded.models(), &self.loaded.files())?;
        let mut log = Log::open(self.folder, false)?;
        log.say(&[self.origin().lines(), self.plan_in_words()].concat().join("\n"))?;
        self.warnings_of_deck().try_for_each(|warning| log.warn(warning))?;
        Ok(log)
    }

    /// Who watches the run. Both receive the pilot run that tells the errors of steps.
    fn watchers(&self, log: Log, resumes: bool, run: &mut Run) -> io::Result<Watchers> {
        let model = &self.loaded.model;
        // Bars are those of one run from t = 0 on.
        let tells_errors = (by_error(model) || self.coarser.is_some()) && model.analysis.stage.is_none();
        let options = [self.quiet, tells_errors];
        let files = Files::waiting(self.folder, self.keeps);
        let files = if resumes { files } else { files.begin(model)? };
        let mut watchers = Watchers::new(log, files, model, options);
        watchers.checkpoints =
            self.checkpoints.clone().map(|wanted| Checkpoints::new(self.folder, wanted).after_another(resumes));
        if let Some(chosen) = self.chosen {
            chosen.tell_steps(run, watchers.bars.as_mut(), &mut watchers.expectations);
        }
        Ok(watchers)
    }

    /// The plan in the lines that `check` prints, after a line for each stage, and the chosen settings.
    fn plan_in_words(&self) -> Vec<String> {
        let models = self.plan.iter().flat_map(|_| self.loaded.models());
        let stages = models.filter(|model| model.analysis.stage.is_some()).map(stage_begins);
        let text = self.plan.as_ref().map(Explanation::to_string).unwrap_or_default();
        let chosen = self.chosen.filter(|_| self.plan.is_some());
        let lines = stages.chain(text.lines().map(str::to_owned));
        lines.chain(chosen.iter().flat_map(|chosen| chosen.lines())).collect()
    }

    /// The runner of the stages of the deck.
    fn stages(&self) -> StageRunner<'_> {
        StageRunner { loaded: self.loaded, threads: self.threads, stop: self.stop, numbers: self.keeps.numbers }
    }

    /// The time of the whole run; the steps and their output needed the `whole`.
    fn timings_of(&self, observing: Duration, whole: Duration) -> Timings {
        Timings {
            loop_s: whole.saturating_sub(observing).as_secs_f64(),
            write_s: observing.as_secs_f64(),
            total_s: self.began.elapsed().as_secs_f64(),
            ..self.timings
        }
    }

    /// Makes the run with a coarser mesh where it is asked for and this one has come to its end.
    fn mesh_error_of(
        &self,
        outcome: &Outcome,
        run: &Run,
        watchers: &mut Watchers,
    ) -> Option<Result<ReportedMesh, String>> {
        let (Watchers { expectations, bars: Some(bars), .. }, Outcome::Done) = (watchers, outcome) else { return None };
        let coarser = self.coarser.clone()?;
        if let Some(told) = self.chosen.and_then(|chosen| chosen.tell_mesh(bars, expectations)) {
            return Some(Ok(told));
        }
        let (source, model) = (&self.loaded.source, &self.loaded.model);
        let like = (run.step_error(), self.threads, self.stop);
        Some(tell_mesh_error((source, model), like, coarser, Judged { expectations, bars }))
    }

    /// The warnings about the deck. Notes are left out, for they question no result.
    fn warnings_of_deck(&self) -> impl Iterator<Item = &str> {
        self.loaded.warnings.iter().filter(|said| said.is_warning()).map(|warning| warning.message.as_str())
    }

    /// The warnings about the results of a run and about its files, after showing them.
    fn warnings_of(
        &self,
        warnings: Vec<String>,
        of_files: Vec<String>,
        mesh: Option<&Result<ReportedMesh, String>>,
    ) -> Vec<String> {
        let of_mesh = mesh.and_then(|told| match told {
            Ok(told) if told.unchanged.is_empty() => None,
            Ok(told) => Some(format!("the error of the mesh is that of a part only: {}", of_file(&told.unchanged))),
            Err(why) => Some(why.clone()),
        });
        let of_run: Vec<String> = warnings.into_iter().chain(of_files).chain(of_mesh).collect();
        if !self.quiet {
            of_run.iter().for_each(|text| show(&[Diagnostic::warning(text)], &self.loaded.source));
        }
        of_run
    }

    /// Says how the run ended: failures on standard error, the verdicts and the folder on standard output.
    fn conclude(&self, Ended { end, result, lines, .. }: Ended) -> Result<(), Exit> {
        let judged = result.expectations.iter().filter(|verdict| !self.quiet || !verdict.passed);
        let mut text: String = judged.map(|verdict| format!("{}\n", line(verdict))).collect();
        if !self.quiet {
            let RunResult { timings, counts, .. } = &result;
            text.extend(lines.iter().map(|line| format!("{line}\n")));
            text += &format!(
                "{} steps, {} iterations, {} factorizations; time stepping {:.4} s of {:.4} s; results in {}\n",
                counts.steps,
                counts.iterations,
                counts.factorizations,
                timings.loop_s,
                timings.total_s,
                self.folder.display()
            );
        }
        print(&text)?;
        let exit = match end.status {
            Status::Done => return Ok(()),
            Status::NotConverged => Exit::NotConverged,
            Status::ExpectationMissed => Exit::CheckFailed,
            Status::Stopped => Exit::Stopped,
            Status::TooLittleMemory => Exit::TooLittleMemory,
        };
        complain(&end.sentence());
        if exit == Exit::Stopped {
            say("  help: the same command with --resume goes on from there");
        }
        Err(exit)
    }
}

/// True where steps follow an error.
fn by_error(model: &Model) -> bool {
    matches!(model.analysis.step_length, StepLength::ErrorControlled { .. })
}

/// The error of automatic steps that the result reports.
fn step_error(error: StepError) -> ReportedStepError {
    let StepError { asked, tolerance, estimate, others, effort, .. } = error;
    ReportedStepError {
        asked,
        estimate,
        tolerance,
        other_runs: others,
        other_steps: effort.steps,
        other_iterations: effort.iterations,
        other_factorizations: effort.factorizations,
    }
}

/// The counts of the solver that the result reports.
fn counts(counts: Counts, failed: Option<usize>) -> ReportedCounts {
    ReportedCounts {
        steps: counts.steps,
        iterations: counts.iterations,
        factorizations: counts.factorizations,
        solves: counts.solves,
        cuts: counts.cuts,
        failed,
    }
}
