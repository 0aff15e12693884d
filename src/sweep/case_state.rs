//! The state of a case of a sweep.

use results::FolderLock;
use results::result_json::Status;
use std::path::PathBuf;

/// The state of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CaseState {
    /// It is still to be run, or under way elsewhere.
    Pending,
    /// Its result stands.
    Done,
    /// Its result stands, but expected values were missed: why.
    Missed(String),
    /// It ended early, or its deck has errors: why.
    Failed(String),
}

impl CaseState {
    /// The word for it in summary.csv.
    pub fn word(&self) -> &'static str {
        match self {
            CaseState::Pending => "pending",
            CaseState::Done => "done",
            CaseState::Missed(_) => "expectation-missed",
            CaseState::Failed(_) => "failed",
        }
    }

    /// The reason, in one line.
    pub fn reason(&self) -> &str {
        match self {
            CaseState::Pending | CaseState::Done => "",
            CaseState::Missed(reason) | CaseState::Failed(reason) => reason,
        }
    }
}

/// The outcome of a case: its state, and the warnings of its run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseOutcome {
    /// Its state.
    pub state: CaseState,
    /// The warnings about its deck and its results, in one line each; none of a case without a result.
    pub warnings: Vec<String>,
}

impl CaseOutcome {
    /// The outcome of a run.
    pub fn of(status: Status, reason: &str, warnings: &[String]) -> CaseOutcome {
        let reason = one_line(reason);
        let state = match status {
            Status::Done => CaseState::Done,
            Status::ExpectationMissed => CaseState::Missed(reason),
            // A case that a signal has stopped is run again.
            Status::Stopped => CaseState::Pending,
            Status::NotConverged | Status::TooLittleMemory => CaseState::Failed(reason),
        };
        CaseOutcome { state, warnings: warnings.iter().map(|warning| one_line(warning)).collect() }
    }

    /// The outcome of a case without a result.
    pub fn without_result(state: CaseState) -> CaseOutcome {
        CaseOutcome { state, warnings: Vec::new() }
    }
}

/// A case that has come to its end and is not marked yet.
#[derive(Debug)]
pub struct Computed {
    /// Its folder.
    pub folder: PathBuf,
    /// The lock, which is let go when the case is marked.
    pub lock: FolderLock,
    /// Its end; a pending case was stopped by a signal, and keeps its checkpoint for the continuation.
    pub outcome: CaseOutcome,
    /// The collected numbers, `None` for each that no table has; none of a case without a result.
    pub numbers: Vec<Option<f64>>,
}

/// A reason as one line. An excerpt from a deck is reduced to the remedy at its caret.
pub fn one_line(text: &str) -> String {
    let told = |line: &'_ str| {
        let line = line.trim();
        match line.split_once('|') {
            Some((number, rest)) if number.trim().chars().all(|c| c.is_ascii_digit()) => {
                let remedy = rest.trim_start().strip_prefix('^').map(|rest| rest.trim_start_matches('^').trim());
                remedy.filter(|remedy| !remedy.is_empty()).map(|remedy| format!("; {remedy}"))
            }
            _ => (!line.starts_with("-->")).then(|| format!(" {line}")),
        }
    };
    text.lines().filter_map(told).collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}
