//! The runs of a study: one each for its answer, then again for its time, in turn, so that what disturbs the machine for a while
//! disturbs all settings alike.

use super::grid::StudyGrid;
use super::history;
use super::manifest::Manifest;
use super::process::{Ended, Program, first_error};
use super::progress::Progress;
use super::reference::Reference;
use super::{Fault, Options};
use crate::model::study::Quantity;
use crate::output;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Below the folder of a study, that of its runs: one for each setting, by number, ...
pub const RUNS: &str = "runs";
/// ... or the deck as it is, and with a part rigid, by number.
pub const AS_IT_IS: &str = "as_it_is";
pub const RIGID: &str = "rigid_";

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    Done,
    NotConverged,
    /// Refused, or ended in another way.
    Failed,
}

impl Status {
    pub fn word(self) -> &'static str {
        match self {
            Status::Done => "done",
            Status::NotConverged => "not-converged",
            Status::Failed => "failed",
        }
    }
}

/// A setting and what came of it.
#[derive(Debug, Clone)]
pub struct Run {
    /// Index into [`StudyGrid::lines`].
    pub line: usize,
    /// Its time step; on an automatic line, its tolerance.
    pub resolution: f64,
    /// Its folder, below that of the study.
    pub folder: String,
    pub status: Status,
    /// Why it failed; empty when done.
    pub reason: String,
    pub measured: Measured,
    /// Least seconds of the time stepping and of the whole process.
    pub loop_s: f64,
    pub process_s: f64,
    /// Seconds of the time stepping, repeat by repeat.
    pub times: Vec<f64>,
    /// Of all quantities together; `None`: it failed, or there is no reference.
    pub error: Option<f64>,
    /// Of each quantity, relative to its own largest value.
    pub errors: Vec<f64>,
    /// The error is well above that of the reference; if not, `error` is a bound.
    pub resolved: bool,
    /// Quantities at the sample times; empty where it failed.
    pub history: Vec<f64>,
}

/// What result.json says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measured {
    pub unknowns: u64,
    pub steps: u64,
    pub iterations: u64,
    pub factorizations: u64,
    pub cuts: u64,
    pub loop_s: f64,
}

/// Errors below so many times that of the reference are not told apart from it.
pub const RESOLVED: f64 = 3.0;

impl Run {
    /// Its error against a reference.
    pub fn judge(&mut self, reference: &Reference, count: usize) {
        if self.status != Status::Done {
            return;
        }
        let error = history::error(&self.history, &reference.values, count, |_| true);
        self.errors = (0..count).map(|k| history::error(&self.history, &reference.values, count, |i| i == k)).collect();
        self.resolved = error >= RESOLVED * reference.error_bound;
        self.error =
            Some(if self.resolved { error } else { error + reference.error_bound }).filter(|error| error.is_finite());
    }
}

/// The folder of a setting.
fn folder(index: usize) -> String {
    format!("{RUNS}/{}", index + 1)
}

/// Folders of all runs of a grid.
pub fn folders(grid: &StudyGrid) -> Vec<String> {
    let count = (0..grid.lines.len()).map(|line| grid.resolutions(line).len()).sum();
    (0..count).map(folder).collect()
}

/// Runs all settings. Returns the runs that came to be, and whether a signal ended it.
pub fn run_all(
    grid: &StudyGrid,
    quantities: &[Quantity],
    options: &Options,
    manifest: &mut Manifest,
    stop: &AtomicBool,
) -> Result<(Vec<Run>, bool), Fault> {
    let program = program(options)?;
    let mut jobs = Vec::new();
    for line in 0..grid.lines.len() {
        for &resolution in grid.resolutions(line) {
            let sets: Vec<String> = options.sets.iter().cloned().chain(grid.overrides(line, resolution)).collect();
            jobs.push((line, resolution, sets));
        }
    }
    // A process itself costs as much as some hundred steps.
    let work = |line: usize, resolution: f64| 300.0 + grid.work(line, resolution);
    let all: f64 = jobs.iter().map(|(line, resolution, _)| work(*line, *resolution)).sum();
    let mut progress = Progress::new(options.quiet, all * options.repeats as f64);
    let mut runs: Vec<Run> = Vec::new();
    let mut stopped = false;
    for repeat in 0..options.repeats {
        for (index, (line, resolution, sets)) in jobs.iter().enumerate() {
            let label = format!("{}, {}", grid.lines[*line].label, crate::names::short(*resolution));
            progress.show(&label, repeat + 1, options.repeats);
            let folder = folder(index);
            let enough = |run: &Run| run.status != Status::Done || run.process_s * repeat as f64 > options.budget;
            if repeat > 0 && runs.get(index).is_none_or(enough) {
                progress.did(work(*line, *resolution));
                continue;
            }
            let place = options.folder.join(&folder);
            if repeat == 0 {
                manifest.note(&folder)?;
            }
            let Some(ended) = program.run(sets, &place, stop)? else {
                stopped = true;
                break;
            };
            progress.did(work(*line, *resolution));
            if repeat == 0 {
                let run = Run::new(*line, *resolution, folder, &ended, &place)?;
                runs.push(run.with_history(quantities, grid.samples, grid.end_time, &place));
            } else if ended.code == Some(0)
                && let (Some(run), Ok(again)) = (runs.get_mut(index), measured(&place))
            {
                run.again(again.loop_s, ended.process_s);
            }
        }
        if stopped {
            break;
        }
    }
    progress.finish();
    Ok((runs, stopped))
}

/// This program itself, for the deck of a study.
pub fn program(options: &Options) -> io::Result<Program> {
    let path = std::env::current_exe()?;
    Ok(Program { path, deck: options.deck.clone(), threads: options.threads })
}

impl Run {
    pub fn new(line: usize, resolution: f64, folder: String, ended: &Ended, place: &Path) -> io::Result<Run> {
        let status = match ended.code {
            Some(0) => Status::Done,
            Some(4) => Status::NotConverged,
            _ => Status::Failed,
        };
        let reason = match (status, ended.code) {
            (Status::Done, _) => String::new(),
            (Status::NotConverged, _) => reason(place),
            (_, Some(code)) => first_error(&ended.said).unwrap_or_else(|| format!("exit code {code}")),
            (_, None) => "ended by a signal".to_owned(),
        };
        let measured = if status == Status::Failed { Measured::default() } else { measured(place)? };
        Ok(Run {
            line,
            resolution,
            folder,
            status,
            reason,
            measured,
            loop_s: measured.loop_s,
            process_s: ended.process_s,
            times: vec![measured.loop_s],
            error: None,
            errors: Vec::new(),
            resolved: false,
            history: Vec::new(),
        })
    }

    /// One more repeat.
    pub fn again(&mut self, loop_s: f64, process_s: f64) {
        self.times.push(loop_s);
        self.loop_s = self.loop_s.min(loop_s);
        self.process_s = self.process_s.min(process_s);
    }

    /// The median of its times.
    pub fn median_s(&self) -> f64 {
        median(self.times.clone()).unwrap_or(f64::NAN)
    }

    /// With what it has written; where that is not whole, it has failed.
    pub fn with_history(mut self, quantities: &[Quantity], samples: usize, end: f64, place: &Path) -> Run {
        if self.status == Status::Done {
            match history::read(place, quantities, samples, end) {
                Ok(values) => self.history = values,
                Err(error) => (self.status, self.reason) = (Status::Failed, one_line(&error.to_string())),
            }
        }
        self
    }
}

/// The upper median; `None`: there are no numbers.
fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied()
}

/// How far times can be trusted: the median of a setting's times over the least of them, and of these ratios the median over all
/// settings.
/// `None`: nothing was run twice.
pub fn spread(runs: &[Run]) -> Option<f64> {
    let twice = runs.iter().filter(|run| run.times.len() > 1 && run.loop_s > 0.0);
    median(twice.map(|run| run.median_s() / run.loop_s).collect())
}

fn result(place: &Path) -> io::Result<Value> {
    let path = place.join("result.json");
    let bytes = fs::read(&path).map_err(|error| output::at(&path, error))?;
    serde_json::from_slice(&bytes).map_err(|error| output::at(&path, error.into()))
}

fn reason(place: &Path) -> String {
    let result = result(place).unwrap_or_default();
    one_line(result["reason"].as_str().unwrap_or_default())
}

/// For a row of a table.
fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ")
}

/// Counts and the seconds of the time stepping.
pub fn measured(place: &Path) -> io::Result<Measured> {
    let result = result(place)?;
    let count = |key: &str| result["counts"][key].as_u64().unwrap_or(0);
    Ok(Measured {
        unknowns: result["sizes"]["unknowns"].as_u64().unwrap_or(0),
        steps: count("steps"),
        iterations: count("iterations"),
        factorizations: count("factorizations"),
        cuts: count("cuts"),
        loop_s: result["timings"]["loop_s"].as_f64().unwrap_or(f64::NAN),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_one_line() {
        assert_eq!(
            one_line("at t = 1: no root\n  the beam is straight\n\nat its end\n"),
            "at t = 1: no root; the beam is straight; at its end"
        );
        assert_eq!(one_line("at t = 1"), "at t = 1");
    }
}
