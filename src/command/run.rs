//! `rdsolve run deck.toml`: read, plan, march, write.

use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::{Exit, Loaded, MOST_THREADS, RunArgs, complain, doubts, load, no_room, output_folder, planned, show};
use crate::diagnostic::Diagnostic;
use crate::model::{ArcLength, DIRECTIONS, Model, StepLength};
use crate::names::short;
use crate::output::expect::{Expectations, Verdict};
use crate::output::log::Log;
use crate::output::progress::Progress;
use crate::output::result_json::{Counts, Report, Status, Timings, peak_memory_bytes};
use crate::output::{Files, wanted};
use crate::solve::{Frame, Observer, Outcome, Run};
use crate::state::State;
use crate::study::LIFELINE;
use crate::system::energy::Balance;

pub(super) fn run(args: &RunArgs) -> Result<(), Exit> {
    let began = Instant::now();
    if std::env::var_os(LIFELINE).is_some() {
        std::thread::spawn(end_with_input);
    }
    let mut loaded = load(&args.deck, &args.sets)?;
    let folder = output_folder(args)?;
    if !args.quiet {
        show(&loaded.warnings, &loaded.source);
    }
    let threads = args.threads.map_or_else(available_threads, usize::from);
    if threads > 1 {
        // As many as asked for; where the pool is there already, as many as it has.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    }
    let mut timings = Timings { read_s: began.elapsed().as_secs_f64(), ..Timings::default() };
    let planning = Instant::now();
    let (system, plan) = planned(&loaded, threads)?;
    let doubts = doubts(&plan, &loaded.model, &system);
    if !args.quiet {
        show(&doubts, &loaded.source);
    }
    loaded.warnings.extend(doubts);
    let stop = Arc::new(AtomicBool::new(false));
    let mut run = Run::new(&loaded.model, &system, &plan, wanted(&loaded.model), &stop).map_err(no_room)?;
    let text = plan.explain(&loaded.model, &system);
    timings.plan_s = planning.elapsed().as_secs_f64();
    let computed =
        stop_on_signals(&stop).and_then(|()| compute(&loaded, &mut run, &text, &folder, args.quiet, timings, began));
    let report = computed.map_err(|error| {
        complain(&format!("cannot write results: {error}"));
        Exit::InputOutput
    })?;
    conclude(&report, &loaded, &folder, args.quiet)
}

/// All cores, as far as `--threads` goes.
fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS as usize)
}

/// Runs the scene and writes its files; an error is one of input/output.
fn compute(
    loaded: &Loaded,
    run: &mut Run,
    text: &str,
    folder: &Path,
    quiet: bool,
    mut timings: Timings,
    began: Instant,
) -> io::Result<Report> {
    let model = &loaded.model;
    let mut log = Log::open(folder, false)?;
    log.say(&format!("rdsolve {}, deck {}", env!("CARGO_PKG_VERSION"), loaded.source.path))?;
    log.say(text)?;
    let mut watchers = Watchers {
        log,
        files: Files::open(folder, model, None)?,
        expectations: Expectations::new(model),
        progress: Progress::new(quiet),
    };
    let looping = Instant::now();
    let (outcome, end) = run.run(&mut watchers);
    let whole = looping.elapsed();
    timings.loop_s = whole.saturating_sub(run.observing()).as_secs_f64();
    timings.write_s = run.observing().as_secs_f64();
    watchers.progress.finish();
    watchers.files.finish()?;

    let mut warnings: Vec<String> = loaded.warnings.iter().map(|w| w.message.clone()).collect();
    // Digits of a deck are not all digits of a number.
    if run.start_jump() > 1e-5 {
        let part = short(run.start_jump());
        let text = format!(
            "initial velocities do not agree with the joints: they were changed by up to {part} of the largest"
        );
        if !quiet {
            show(&[Diagnostic::warning(&text)], &loaded.source);
        }
        warnings.push(text);
    }
    if let Some(text) = imbalance(run.balance(), model) {
        if !quiet {
            show(&[Diagnostic::warning(&text)], &loaded.source);
        }
        warnings.push(text);
    }
    let expectations = watchers.expectations.verdicts();
    let (status, mut reason) = judge(outcome, &expectations)?;
    if let Some(short) = short_of_stop(model, run, &end) {
        reason = if reason.is_empty() { short } else { format!("{reason}; {short}") };
    }
    watchers.log.say(&match (status, reason.as_str()) {
        (Status::Done, "") => "done".to_owned(),
        (Status::Done, reason) => format!("done: {reason}"),
        (_, reason) => reason.to_owned(),
    })?;
    let counts = run.counts();
    timings.total_s = began.elapsed().as_secs_f64();
    let report = Report {
        status,
        exit_code: status.exit_code(),
        reason,
        version: env!("CARGO_PKG_VERSION").to_string(),
        title: model.title.clone(),
        deck_hash: loaded.hash.clone(),
        plan: text.lines().collect(),
        counts: Counts {
            steps: counts.steps,
            iterations: counts.iterations,
            factorizations: counts.factorizations,
            solves: counts.solves,
            cuts: counts.cuts,
        },
        timings,
        joint_violation: run.joint_violation(),
        rotation_drift: (run.rotation_drift() > 0.0).then(|| run.rotation_drift()),
        peak_memory_bytes: peak_memory_bytes(),
        warnings,
        expectations,
    };
    report.write(folder)?;
    Ok(report)
}

/// Nobody is left who wants the run of a study that is gone: it ends at once, as a study itself ends its runs.
fn end_with_input() {
    let mut input = io::stdin().lock();
    let mut bytes = [0; 64];
    // Zero bytes are the end, and so is an input that cannot be read.
    while input.read(&mut bytes).is_ok_and(|count| count > 0) {}
    std::process::exit(i32::from(Exit::Stopped as u8));
}

/// Interrupt, termination and the loss of the terminal raise the flag: the run ends after the step in hand, with whole files.
pub(super) fn stop_on_signals(flag: &Arc<AtomicBool>) -> io::Result<()> {
    // A second one from the keyboard ends the program at once; schedulers send theirs to a process and to its group, which is
    // two at the same moment.
    let code = i32::from(Exit::Stopped as u8);
    signal_hook::flag::register_conditional_shutdown(signal_hook::consts::SIGINT, code, Arc::clone(flag))?;
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(flag))?;
    }
    #[cfg(unix)]
    if !is_ignored(signal_hook::consts::SIGHUP) {
        signal_hook::flag::register(signal_hook::consts::SIGHUP, Arc::clone(flag))?;
    }
    Ok(())
}

/// As `nohup` asks for; also where nobody tells, so that nothing is caught that was to be ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask >> (signal - 1) & 1 == 1)
}

fn judge(outcome: Outcome, expectations: &[Verdict]) -> io::Result<(Status, String)> {
    Ok(match outcome {
        Outcome::Io(error) => return Err(error),
        Outcome::Failed { time, failure } => {
            (Status::NotConverged, format!("at t = {time}: {failure}; results are valid up to this time"))
        }
        Outcome::Stopped { time } => {
            (Status::Stopped, format!("stopped by a signal at t = {time}; results are valid up to this time"))
        }
        Outcome::Done => {
            let missed = expectations.iter().filter(|v| !v.passed).count();
            match missed {
                0 => (Status::Done, String::new()),
                n => (Status::ExpectationMissed, format!("{n} of {} expected values missed", expectations.len())),
            }
        }
    })
}

/// A path that ended before its `stop`, in a sentence.
fn short_of_stop(model: &Model, run: &Run, end: &Option<State>) -> Option<String> {
    let (StepLength::ArcLength(ArcLength { stop: Some(stop), .. }), Some(value)) =
        (&model.analysis.step_length, run.short_of_stop())
    else {
        return None;
    };
    let (node, direction) = (&model.nodes[stop.node].label, DIRECTIONS[stop.dof]);
    let pass = if stop.pass == 1 { String::new() } else { format!(" for pass {}", stop.pass) };
    let (time, steps) = (end.as_ref()?.time, run.counts().steps);
    Some(format!(
        "`stop` was not reached: {direction} of {node} never came to {}{pass}; it is {value} at the end, t = {time}, \
         after {steps} steps",
        stop.value
    ))
}

/// Says how the run ended: failures on standard error, the verdicts and the folder on standard output.
fn conclude(report: &Report, loaded: &Loaded, folder: &Path, quiet: bool) -> Result<(), Exit> {
    let mut text = String::new();
    for verdict in &report.expectations {
        if !quiet || !verdict.passed {
            text += &format!("{}\n", line(verdict));
        }
    }
    if !quiet {
        let t = &report.timings;
        let c = &report.counts;
        text += &format!(
            "{} steps, {} iterations, {} factorizations; time loop {:.4} s of {:.4} s; results in {}\n",
            c.steps,
            c.iterations,
            c.factorizations,
            t.loop_s,
            t.total_s,
            folder.display()
        );
    }
    super::print(&text)?;
    let exit = match report.status {
        Status::Done => {
            if !report.reason.is_empty() && !quiet {
                show(&[Diagnostic::warning(report.reason.as_str())], &loaded.source);
            }
            return Ok(());
        }
        Status::NotConverged => Exit::NotConverged,
        Status::ExpectationMissed => Exit::CheckFailed,
        Status::Stopped => Exit::Stopped,
        Status::Failed => Exit::Internal,
    };
    complain(&report.reason);
    Err(exit)
}

fn line(v: &Verdict) -> String {
    let mark = if v.passed { "ok  " } else { "MISS" };
    let value = v.value.map_or("no value".to_string(), |value| format!("{value:.6e}"));
    if let Some(bound) = v.bound {
        return format!("{mark} {}: {value}, {bound} {:.6e}", v.label, v.expected);
    }
    let error = match (v.error, &v.reason) {
        (Some(error), _) => {
            let kind = if v.relative { "relative" } else { "absolute" };
            format!("{kind} error {error:.2e} of {}", short(v.tolerance))
        }
        (None, Some(reason)) => reason.clone(),
        (None, None) => String::new(),
    };
    format!("{mark} {}: {value}, expected {:.6e}, {error}", v.label, v.expected)
}

/// A balance of energies that no one should take on trust.
fn imbalance(balance: &Balance, model: &Model) -> Option<String> {
    const MADE: f64 = 0.02; // of the most there was: schemes make next to nothing
    const TAKEN: f64 = 0.2; // they may damp what no step resolves
    let part = |energy: f64| format!("{:.0} % of the most energy there was", 100.0 * energy / balance.most);
    let shorter = match model.analysis.step_length {
        StepLength::Fixed { .. } | StepLength::ArcLength(_) => "shorter steps",
        StepLength::StabilityLimited { .. } => "a number as `time_step`, shorter than the steps of \"auto\"",
        StepLength::ErrorControlled { .. } => "a smaller `error_tolerance`",
    };
    let longer = format!("look at `numerical` in energy.csv, and try {shorter}");
    if balance.made > MADE * balance.most {
        let part = part(balance.made);
        // Flow is booked with the stress at the end of a step, which the motion meets only then. It is the plastic strain that
        // comes out wrong by it: no motion is made.
        Some(if balance.made <= balance.plastic {
            format!(
                "plastic flow has taken more than there was to take, by {part}: steps do not resolve where material begins \
                 to yield, and plastic strains are too large; {longer}"
            )
        } else {
            format!("the time integration has made energy from nothing, {part}: {longer}")
        })
    } else if balance.taken > TAKEN * balance.most {
        Some(format!("the time integration has taken {}: {longer}", part(balance.taken)))
    } else {
        None
    }
}

/// Everyone who watches the run, one after the other.
struct Watchers {
    log: Log,
    files: Files,
    expectations: Expectations,
    progress: Progress,
}

impl Observer for Watchers {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_step(frame)?;
        self.progress.on_step(frame)?;
        self.log.on_step(frame)?;
        self.files.on_step(frame)
    }
}
