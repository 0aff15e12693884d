//! One run of a study: a setting and what came of it.

use super::history;
use super::process::{Ended, first_error};
use crate::model::study::Quantity;
use crate::output;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::Path;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunStatus {
    Done,
    NotConverged,
    /// Refused, or ended in another way.
    Failed,
}

impl RunStatus {
    pub fn word(self) -> &'static str {
        match self {
            RunStatus::Done => "done",
            RunStatus::NotConverged => "not-converged",
            RunStatus::Failed => "failed",
        }
    }
}

/// A setting and what came of it.
#[derive(Debug, Clone)]
pub struct StudyRun {
    /// Index into [`StudyGrid::lines`].
    pub line: usize,
    /// Its time step; on an automatic line, its tolerance.
    pub resolution: f64,
    /// Its folder, below that of the study.
    pub folder: String,
    pub status: RunStatus,
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

impl StudyRun {
    /// Its error against the values of a reference, which are themselves off by up to `error_bound`.
    pub fn judge(&mut self, reference: &[f64], error_bound: f64, count: usize) {
        if self.status != RunStatus::Done {
            return;
        }
        let error = history::error(&self.history, reference, count, |_| true);
        self.errors = (0..count).map(|k| history::error(&self.history, reference, count, |i| i == k)).collect();
        self.resolved = error >= RESOLVED * error_bound;
        self.error = Some(if self.resolved { error } else { error + error_bound }).filter(|error| error.is_finite());
    }
}

impl StudyRun {
    pub fn new(line: usize, resolution: f64, folder: String, ended: &Ended, place: &Path) -> io::Result<StudyRun> {
        let status = match ended.code {
            Some(0) => RunStatus::Done,
            Some(4) => RunStatus::NotConverged,
            _ => RunStatus::Failed,
        };
        let reason = match (status, ended.code) {
            (RunStatus::Done, _) => String::new(),
            (RunStatus::NotConverged, _) => reason(place),
            (_, Some(code)) => first_error(&ended.said).unwrap_or_else(|| format!("exit code {code}")),
            (_, None) => "ended by a signal".to_owned(),
        };
        let measured = if status == RunStatus::Failed { Measured::default() } else { measured(place)? };
        Ok(StudyRun {
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
    pub fn with_history(mut self, quantities: &[Quantity], samples: usize, end: f64, place: &Path) -> StudyRun {
        if self.status == RunStatus::Done {
            match history::read(place, quantities, samples, end) {
                Ok(values) => self.history = values,
                Err(error) => (self.status, self.reason) = (RunStatus::Failed, one_line(&error.to_string())),
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
pub fn spread(runs: &[StudyRun]) -> Option<f64> {
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
