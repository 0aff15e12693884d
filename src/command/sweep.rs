//! `rdsolve sweep sweep.toml`: many variants of one deck, in parallel here or as one shard of many, and one table of their results.

use super::arguments::MAX_THREADS;
use super::console::{complain, counted, print, say, show};
use super::exit::Exit;
use super::folder::named_after;
use super::load::text;
use super::resume::deck_digest;
use super::run::{Case, CaseEnd, CaseFault, run_case};
use super::signals::{EndAtOnce, stop_on_signals};
use super::version::VERSION;
use base::diagnostic::{Diagnostic, Source};
use clap::Args;
use deck::ParsedText;
use deck::number_slips::without_foreign_comments;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use results::collected::{Collected, CollectedWhen};
use results::{SharedLock, replace};
use std::fs;
use std::io::{self, IsTerminal};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex};
use sweep::alike::alike;
use sweep::case_state::{CaseOutcome, CaseState, Computed, one_line};
use sweep::cases::Cases;
use sweep::file::{self, SweepFile};
use sweep::folder::{FAILURE, SweepFolder};
use sweep::marks::mark_all;
use sweep::names::{check_collected, check_keys};

#[derive(Debug, Args)]
#[command(
    after_help = "A case that stands is not run again, so the same command goes on after a stop, and any number of processes may fill \
one folder at once. A signal ends it with whole files; what was killed is run again.

Exit codes: 0 all chosen cases stand, 2 usage, 3 the file of the sweep has errors, 4 a case failed, 5 expected values or stops were missed, \
6 input/output, 75 stopped by a signal"
)]
pub struct SweepArgs {
    /// The file of the sweep, TOML: deck, [vary], [collect]
    sweep: PathBuf,
    /// Folder for all cases [default: the file's name with .out, in the current folder]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Cases to run at once, each on one thread [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MAX_THREADS))]
    jobs: Option<u16>,
    /// One case by its number from 1, every N-th from the I-th on, or those that failed
    #[arg(long, value_name = "I | I/N | failed")]
    case: Option<Choice>,
    /// Print the cases with their states, and run nothing
    #[arg(long)]
    list: bool,
    /// Write the summary of the complete cases, and run nothing
    #[arg(long, conflicts_with_all = ["list", "case"])]
    collect: bool,
    /// Show errors only
    #[arg(long)]
    quiet: bool,
}

/// The cases that are to be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Choice {
    One(usize),
    Shard { index: usize, of: usize },
    Failed,
}

impl FromStr for Choice {
    type Err = String;

    fn from_str(text: &str) -> Result<Choice, String> {
        let number = |text: &str| text.parse::<usize>().ok().filter(|number| *number > 0);
        let choice = match text.split_once('/') {
            None if text == "failed" => Some(Choice::Failed),
            None => number(text).map(Choice::One),
            Some((index, of)) => match (number(index), number(of)) {
                (Some(index), Some(of)) if index <= of => Some(Choice::Shard { index, of }),
                _ => None,
            },
        };
        choice.ok_or_else(|| "it is a number from 1, I/N with I from 1 to N, or `failed`".into())
    }
}

/// Runs the cases of a sweep that do not stand yet, and writes their summary.
///
/// # Errors
/// The exit code of a sweep with incomplete chosen cases; the reason has been shown.
pub fn sweep(args: &SweepArgs) -> Result<(), Exit> {
    let reading = EndAtOnce::on_signals();
    let (file, sweep_folder, source) = read(&args.sweep)?;
    let deck = sweep_folder.join(&file.deck);
    let deck_text = text(&deck)?;
    let cases = Cases::new(&file, &sweep_folder).map_err(|message| {
        complain(&message);
        Exit::DeckInvalid
    })?;
    let path = args.output.clone().unwrap_or_else(|| named_after(&args.sweep, "out"));
    let folder = SweepFolder::new(path, (&deck.display().to_string(), &deck_text), &cases, VERSION, &file);
    let chosen = chosen(args.case, &folder)?;
    if let (Some(&first), false) = (chosen.first(), args.collect) {
        let case = Source::new(deck.display().to_string(), deck_text.as_str(), &cases.sets(first));
        check_names(&args.sweep, (&file, &source), &case)?;
    }
    if args.list {
        return list(&folder, &cases, &chosen);
    }
    fs::create_dir_all(&folder.path).map_err(|error| cannot_write(&folder.path, &error))?;
    let jobs = args.jobs.map_or_else(cores, usize::from);
    // The summary is gathered on as many threads.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global();
    folder.write_cases(&cases).map_err(|error| cannot_write(&folder.path, &error))?;
    let stop = Arc::new(AtomicBool::new(false));
    let Source { text: composed, .. } = Source::new("", deck_text.as_str(), &[]);
    let plain = without_foreign_comments(&composed);
    let sweep = Sweep {
        deck: &deck,
        text: &deck_text,
        parsed: ParsedText::new(&composed, &plain),
        cases: &cases,
        folder: &folder,
        stop: &stop,
        quiet: args.quiet,
    };
    // To write the summary is short and moves whole files in: it is brought to its end.
    stop_on_signals(&stop).map_err(|error| cannot_write(&folder.path, &error))?;
    drop(reading);
    if !args.collect {
        sweep.run(&chosen, args.case == Some(Choice::Failed), jobs)?;
    }
    let outcomes = folder.write_summary(&cases).map_err(|error| cannot_write(&folder.path, &error))?;
    folder.empty_columns().map_err(|error| cannot_write(&folder.path, &error))?.into_iter().for_each(tell_empty);
    for (case, torn) in folder.torn_tables(&outcomes).map_err(|error| cannot_write(&folder.path, &error))? {
        say(&format!("warning: case {case}: {torn}"));
    }
    sweep.conclude(&chosen, &outcomes)
}

/// Warns of a collected number that no case has.
fn tell_empty(one: &Collected) {
    let Collected { name, at, quantity, stage, when } = one;
    let stage = stage.as_ref().map_or(String::new(), |stage| format!(" in stage `{stage}`"));
    let (time, and_time) = match when {
        CollectedWhen::Time(time) => (format!(" at t = {time}"), ", `time`"),
        _ => (String::new(), ""),
    };
    say(&format!(
        "warning: `{name}` is empty: no table that the cases write has one value of `{quantity}` of `{at}`{stage}{time}. Correct \
         `at`{and_time} or `quantity`, ask for its table in `[output]` of the deck, or give `peak` where `at` names several nodes; their \
         moments have no sum"
    ));
}

fn cannot_write(path: &Path, error: &io::Error) -> Exit {
    complain(&format!("cannot write to `{}`: {error}", path.display()));
    Exit::InputOutput
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS as usize)
}

/// Reads the file of a sweep; returns it with its folder.
fn read(path: &Path) -> Result<(SweepFile, PathBuf, Source), Exit> {
    let source = Source::new(path.display().to_string(), text(path)?, &[]);
    match file::read(&source) {
        (Some(file), _) => Ok((file, path.parent().unwrap_or(Path::new("")).to_owned(), source)),
        (None, problems) => Err(invalid(path, &problems, &source)),
    }
}

/// Shows the errors of the file of a sweep.
fn invalid(path: &Path, problems: &[Diagnostic], source: &Source) -> Exit {
    show(problems, source);
    complain(&format!("`{}` has {}", path.display(), counted(problems.len(), "error")));
    Exit::DeckInvalid
}

/// Refuses a sweep with names that the deck of its first case lacks.
fn check_names(path: &Path, (file, source): (&SweepFile, &Source), case: &Source) -> Result<(), Exit> {
    let of_keys = check_keys(case);
    if !of_keys.is_empty() {
        return Err(invalid(path, &of_keys, case));
    }
    let of_numbers = check_collected(file, case);
    if of_numbers.is_empty() { Ok(()) } else { Err(invalid(path, &of_numbers, source)) }
}

/// The cases that are asked for, counted from 0.
fn chosen(choice: Option<Choice>, folder: &SweepFolder) -> Result<Vec<usize>, Exit> {
    let count = folder.names.len();
    Ok(match choice {
        None => (0..count).collect(),
        Some(Choice::One(case)) if case > count => {
            complain(&format!("there is no case {case}: give a number from 1 to {count}"));
            return Err(Exit::Usage);
        }
        Some(Choice::One(case)) => vec![case - 1],
        Some(Choice::Shard { index, of }) => (index - 1..count).step_by(of).collect(),
        Some(Choice::Failed) => (0..count).filter(|&case| matches!(folder.state(case), CaseState::Failed(_))).collect(),
    })
}

/// Prints a line for each case.
fn list(folder: &SweepFolder, cases: &Cases, chosen: &[usize]) -> Result<(), Exit> {
    let line = |&case: &usize| {
        let state = folder.state(case);
        let reason = if state.reason().is_empty() { String::new() } else { format!(": {}", state.reason()) };
        format!("{} {} {}{reason}  {}\n", case + 1, folder.names[case], state.word(), cases.sets(case).join(" "))
    };
    print(&chosen.iter().map(line).collect::<String>())
}

/// The data shared by all threads of a sweep.
struct Pool<'p> {
    /// True for a case that is still to be run.
    is_open: &'p (dyn Fn(usize) -> bool + Sync),
    /// The locks of the folders.
    locks: &'p SharedLock,
    /// The digest of the deck.
    deck: &'p str,
}

/// A sweep that is under way.
struct Sweep<'s> {
    deck: &'s Path,
    text: &'s str,
    parsed: ParsedText<'s>,
    cases: &'s Cases,
    folder: &'s SweepFolder,
    stop: &'s AtomicBool,
    quiet: bool,
}

impl Sweep<'_> {
    /// Runs the incomplete cases among the chosen ones, so many at once; with `again` also the failed ones.
    fn run(&self, chosen: &[usize], again: bool, jobs: usize) -> Result<(), Exit> {
        let is_open = |case: usize| match self.folder.state(case) {
            CaseState::Pending => true,
            CaseState::Failed(_) => again,
            CaseState::Done | CaseState::Missed(_) => false,
        };
        let open: Vec<usize> = chosen.iter().copied().filter(|&case| is_open(case)).collect();
        if open.is_empty() {
            return Ok(());
        }
        let failed = |error: io::Error| cannot_write(&self.folder.path, &error);
        let (locks, deck) = (SharedLock::new(&self.folder.path).map_err(&failed)?, deck_digest(self.text));
        let pool = Pool { is_open: &is_open, locks: &locks, deck: &deck };
        let bar = self.bar(open.len());
        // One disk that is full keeps all from running.
        let (next, fault) = (AtomicUsize::new(0), Mutex::new(None));
        let work = |done: &Sender<Computed>| {
            while let Some(&case) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
                if self.stop.load(Ordering::Relaxed) {
                    return Ok(());
                }
                // Whoever marks has failed, and says so.
                if self.run_one(case, &pool)?.is_some_and(|computed| done.send(computed).is_err()) {
                    return Ok(());
                }
                bar.inc(1);
            }
            Ok(())
        };
        let note = |ended: io::Result<()>| {
            if let (Err(error), Ok(mut first)) = (ended, fault.lock()) {
                first.get_or_insert(error);
            }
        };
        std::thread::scope(|scope| {
            let (done, computed) = channel();
            for _ in 0..jobs.min(open.len()) {
                let (done, work, note) = (done.clone(), &work, &note);
                scope.spawn(move || note(work(&done)));
            }
            drop(done);
            note(mark_all(self.folder, &computed));
        });
        bar.finish_and_clear();
        fault.into_inner().ok().flatten().map_or(Ok(()), |error| Err(failed(error)))
    }

    /// Runs one case, unless another process does or has done it. Its own errors are noted in its folder.
    fn run_one(&self, case: usize, pool: &Pool) -> io::Result<Option<Computed>> {
        let (folder, sets) = (self.folder.case(case), self.cases.sets(case));
        fs::create_dir_all(&folder)?;
        let lock = match pool.locks.take(&folder) {
            Err(error) if error.kind() == io::ErrorKind::ResourceBusy => return Ok(None),
            // Another process has done the case, and its folder is gone.
            Err(error) if error.kind() == io::ErrorKind::NotFound && !(pool.is_open)(case) => return Ok(None),
            taken => taken?,
        };
        if !(pool.is_open)(case) {
            drop(lock);
            // The folder made for the check is empty.
            let _ = fs::remove_dir(&folder);
            return Ok(None);
        }
        let failure = folder.join(FAILURE);
        if failure.exists() {
            fs::remove_file(&failure)?;
        }
        let source = Source::new(self.deck.display().to_string(), self.text, &sets);
        let (parsed, files) = (&self.parsed, &self.folder.files);
        let what = Case { sets: &sets, folder: &folder, parsed, deck: pool.deck, files, keeps: self.folder.keeps() };
        let ran = catch_unwind(AssertUnwindSafe(|| run_case(source, &what, self.stop)));
        let why = match ran {
            Ok(Ok(CaseEnd { status, reason, warnings, numbers })) => {
                let outcome = CaseOutcome::of(status, &reason, &warnings);
                return Ok(Some(Computed { folder, lock, outcome, numbers }));
            }
            Ok(Err(CaseFault::Stopped)) => return Ok(None),
            Ok(Err(CaseFault::Io(error))) => return Err(error),
            Ok(Err(CaseFault::Deck(text))) => text,
            Err(_) => "the program itself has a fault: the run of this case has panicked".to_owned(),
        };
        let outcome = CaseOutcome::without_result(CaseState::Failed(one_line(&why)));
        if self.folder.keeps().files {
            replace(&failure, why.as_bytes())?;
        }
        self.folder.let_go(vec![Computed { folder, lock, outcome, numbers: Vec::new() }])?;
        Ok(None)
    }

    fn bar(&self, count: usize) -> ProgressBar {
        if self.quiet || !io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{bar:32} {pos} of {len} cases  {per_sec}  {eta} left");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    }

    /// Reports the outcomes of the chosen cases.
    fn conclude(&self, chosen: &[usize], outcomes: &[CaseOutcome]) -> Result<(), Exit> {
        let of = |is: fn(&CaseState) -> bool| chosen.iter().filter(|&&case| is(&outcomes[case].state)).count();
        let failed = of(|state| matches!(state, CaseState::Failed(_)));
        let missed = of(|state| matches!(state, CaseState::Missed(_)));
        let pending = of(|state| matches!(state, CaseState::Pending));
        let done = chosen.len() - failed - missed - pending;
        // An error of the deck is that of all its cases.
        let is_failed = |case: &&usize| matches!(outcomes[**case].state, CaseState::Failed(_));
        tell("reasons", complain, chosen.iter().filter(is_failed).map(|&case| (case, outcomes[case].state.reason())));
        if !self.quiet {
            let stands = |case: &&usize| matches!(outcomes[**case].state, CaseState::Done | CaseState::Missed(_));
            let of_case = |&case: &usize| outcomes[case].warnings.iter().map(move |warning| (case, warning.as_str()));
            tell("warnings", warn, chosen.iter().filter(stands).flat_map(of_case));
            let warned = chosen.iter().filter(stands).filter(|&&case| !outcomes[case].warnings.is_empty()).count();
            let parts =
                [(missed, "missed an expected value or a stop"), (failed, "failed"), (pending, "are still to be run")];
            let parts = parts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!(", {count} {what}"));
            let summary = self.folder.path.join("summary.csv");
            let total = counted(chosen.len(), "case");
            let warned = if warned > 0 { format!(", warnings in {warned}") } else { String::new() };
            print(&format!("{total}: {done} done{}{warned}; {}\n", parts.collect::<String>(), summary.display()))?;
        }
        match () {
            () if self.stop.load(Ordering::Relaxed) => {
                complain("stopped by a signal; the same command goes on");
                Err(Exit::Stopped)
            }
            () if failed > 0 => Err(Exit::NotConverged),
            () if missed > 0 => Err(Exit::CheckFailed),
            () => Ok(()),
        }
    }
}

/// Reports texts of cases, alike ones once with their first cases.
fn tell<'t>(what: &str, report: fn(&str), texts: impl Iterator<Item = (usize, &'t str)>) {
    /// The number of reported texts; the summary has all of them.
    const TOLD: usize = 20;
    /// The number of cases that are named with a text.
    const NAMED: usize = 5;
    let all = alike(texts);
    for one in all.iter().take(TOLD) {
        let count = one.cases.len();
        let first: Vec<String> = one.cases.iter().take(NAMED).map(|case| (case + 1).to_string()).collect();
        let more = if count > NAMED { format!(" and {} more", count - NAMED) } else { String::new() };
        let word = if count > 1 { "cases" } else { "case" };
        let of =
            if one.differ && count > 1 { format!(", with the numbers of case {}", first[0]) } else { String::new() };
        report(&format!("{word} {}{more}{of}: {}", first.join(", "), one.text));
    }
    if all.len() > TOLD {
        say(&format!("… and {} more {what}: see summary.csv", all.len() - TOLD));
    }
}

fn warn(text: &str) {
    say(&format!("warning: {text}"));
}
