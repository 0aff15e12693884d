//! One run of a study: a setting and its outcome.

use super::history;
use super::process::{Ended, first_error};
use base::text_file::read_regular;
use model::study::Quantity;
use serde_json::Value;
use std::io;
use std::path::Path;

/// The kind of end that a run came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunStatus {
    /// It came to its end time.
    Done,
    /// It came to a step that could not be taken.
    NotConverged,
    /// It was refused, has ended in another way, or lacks results.
    Failed,
}

impl RunStatus {
    /// The word for it in study.csv.
    pub fn word(self) -> &'static str {
        match self {
            RunStatus::Done => "done",
            RunStatus::NotConverged => "not-converged",
            RunStatus::Failed => "failed",
        }
    }
}

/// A setting and the outcome of its runs.
#[derive(Debug, Clone)]
pub struct StudyRun {
    /// The index of its line in [`super::StudyGrid::lines`].
    pub line: usize,
    /// The time step; on an automatic line, the tolerance.
    pub resolution: f64,
    /// The name of its folder, below that of the study.
    pub folder: String,
    /// The kind of end that the first run came to.
    pub status: RunStatus,
    /// The reason for that end in one line; empty when done.
    pub reason: String,
    /// The counts of the first run.
    pub measured: Measured,
    /// The least seconds of the time stepping over all repeats.
    pub loop_s: f64,
    /// The least seconds of the whole process over all repeats.
    pub process_s: f64,
    /// The seconds of the time stepping, repeat by repeat.
    pub times: Vec<f64>,
    /// The relative error over all quantities together; `None` where it failed, or there is no reference.
    pub error: Option<f64>,
    /// The error of each quantity, relative to its own largest value.
    pub errors: Vec<f64>,
    /// The bound of the error of the reference that it was judged by.
    pub error_bound: f64,
    /// True if the error clearly exceeds the error of the reference; otherwise `error` is a bound.
    pub resolved: bool,
    /// The values at the sample times one after the other, each time all quantities; empty where it failed.
    pub history: Vec<f64>,
}

/// The measurements in the result.json of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measured {
    /// The number of unknowns that are solved for.
    pub unknowns: u64,
    /// The number of accepted steps.
    pub steps: u64,
    /// The number of iterations; of an explicit scheme, of evaluations of the residual.
    pub iterations: u64,
    /// The number of factorizations of a matrix.
    pub factorizations: u64,
    /// The number of cutbacks.
    pub cuts: u64,
    /// The number of other runs for the error of automatic steps, ...
    pub other_runs: u64,
    /// ... their steps, ...
    pub other_steps: u64,
    /// ... iterations ...
    pub other_iterations: u64,
    /// ... and factorizations.
    pub other_factorizations: u64,
    /// The error that automatic steps say they leave.
    pub estimate: Option<f64>,
    /// The seconds of the time stepping, those of the other runs included.
    pub loop_s: f64,
}

/// An error below this multiple of the error of the reference cannot be told apart from it.
pub const RESOLVED: f64 = 3.0;

impl StudyRun {
    /// Takes the errors against the values of a reference, which are themselves off by up to `error_bound`; `count` is the number
    /// of quantities.
    pub fn judge(&mut self, reference: &[f64], error_bound: f64, count: usize) {
        if self.status != RunStatus::Done {
            return;
        }
        let error = history::error(&self.history, reference, count, |_| true);
        self.errors = (0..count).map(|k| history::error(&self.history, reference, count, |i| i == k)).collect();
        self.error_bound = error_bound;
        self.resolved = error >= RESOLVED * error_bound;
        self.error = Some(if self.resolved { error } else { error + error_bound }).filter(|error| error.is_finite());
    }
}

impl StudyRun {
    /// The first run of a setting, from its ended process and the files in `place`.
    ///
    /// # Errors
    /// The result of a run that ended normally cannot be read.
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
            error_bound: 0.0,
            resolved: false,
            history: Vec::new(),
        })
    }

    /// A made-up run that has come to its end with this error.
    #[cfg(test)]
    pub fn made_up(line: usize, resolution: f64, loop_s: f64, error: Option<f64>, history: Vec<f64>) -> StudyRun {
        StudyRun {
            line,
            resolution,
            folder: String::new(),
            status: RunStatus::Done,
            reason: String::new(),
            measured: Measured { steps: 1, loop_s, ..Measured::default() },
            loop_s,
            process_s: loop_s,
            times: vec![loop_s],
            error,
            errors: Vec::new(),
            error_bound: 0.0,
            resolved: true,
            history,
        }
    }

    /// The range of the error, given the error of the reference.
    pub fn error_range(&self) -> Option<[f64; 2]> {
        // An unresolved error is stated as a bound that includes the error of the reference.
        let beyond = if self.resolved { self.error_bound } else { 0.0 };
        let below = if self.resolved { self.error_bound } else { 2.0 * self.error_bound };
        self.error.map(|error| [(error - below).max(0.0), error + beyond])
    }

    /// Adds the times of one more repeat.
    pub fn again(&mut self, loop_s: f64, process_s: f64) {
        self.times.push(loop_s);
        self.loop_s = self.loop_s.min(loop_s);
        self.process_s = self.process_s.min(process_s);
    }

    /// The median seconds of the time stepping over all repeats.
    pub fn median_s(&self) -> f64 {
        median(self.times.clone()).unwrap_or(f64::NAN)
    }

    /// The run with its written histories; incomplete histories make it a failed run.
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

/// The upper median; `None` where there are no numbers.
fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied()
}

/// A measure of the scatter of times: the ratio of the median of a setting's times to the least of them, and the median of these ratios
/// over all settings. It is `None` where nothing was run twice.
pub fn spread(runs: &[StudyRun]) -> Option<f64> {
    let twice = runs.iter().filter(|run| run.times.len() > 1 && run.loop_s > 0.0);
    median(twice.map(|run| run.median_s() / run.loop_s).collect())
}

fn result(place: &Path) -> io::Result<Value> {
    let path = place.join("result.json");
    let bytes = read_regular(&path).map_err(|error| results::at(&path, error))?;
    serde_json::from_slice(&bytes).map_err(|error| results::at(&path, error.into()))
}

fn reason(place: &Path) -> String {
    let result = result(place).unwrap_or_default();
    one_line(result["reason"].as_str().unwrap_or_default())
}

/// The lines of a text in one, for a row of a table.
fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ")
}

/// The counts and times that a run has written in `place`.
///
/// # Errors
/// Its result.json cannot be read; the error names it.
pub fn measured(place: &Path) -> io::Result<Measured> {
    let result = result(place)?;
    let count = |key: &str| result["counts"][key].as_u64().unwrap_or(0);
    let other = |key: &str| result["step_error"][key].as_u64().unwrap_or(0);
    Ok(Measured {
        unknowns: result["sizes"]["unknowns"].as_u64().unwrap_or(0),
        steps: count("steps"),
        iterations: count("iterations"),
        factorizations: count("factorizations"),
        cuts: count("cuts"),
        other_runs: other("other_runs"),
        other_steps: other("other_steps"),
        other_iterations: other("other_iterations"),
        other_factorizations: other("other_factorizations"),
        estimate: result["step_error"]["estimate"].as_f64(),
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
