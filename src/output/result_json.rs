//! result.json: how the run ended, in one object a script can read.

use super::disk::{at, replace};
use super::expect::Verdict;
use serde::Serialize;
use std::io;
use std::path::Path;

pub const NAME: &str = "result.json";

/// Why the run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    Done,
    NotConverged,
    ExpectationMissed,
    /// By a signal, with a checkpoint.
    Stopped,
    Failed,
}

impl Status {
    pub fn exit_code(self) -> u8 {
        match self {
            Status::Done => 0,
            Status::Failed => 1,
            Status::NotConverged => 4,
            Status::ExpectationMissed => 5,
            Status::Stopped => 75,
        }
    }
}

/// The object itself.
#[derive(Debug, Clone, Serialize)]
pub struct RunResult {
    pub status: Status,
    /// That of the status, unless the failure was one of input/output (6).
    pub exit_code: u8,
    /// One sentence; empty when done, unless a path ended before its `stop`.
    pub reason: String,
    /// Where the run did not come to its end, the time up to which its results are valid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub valid_until: Option<f64>,
    /// The deck and the program that the results come from.
    #[serde(flatten)]
    pub origin: RunOrigin,
    /// The lines that `rdsolve check` prints.
    pub plan: Vec<String>,
    pub sizes: Sizes,
    pub counts: ReportedCounts,
    pub timings: Timings,
    /// Largest departure from orthogonality that a first- or second-order rotation update left to be corrected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_drift: Option<f64>,
    /// Largest gap that a joint was left with at the end of a step, relative to the largest coordinate of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_violation: Option<f64>,
    /// `None` where the system does not tell.
    pub peak_memory_bytes: Option<u64>,
    pub warnings: Vec<String>,
    pub expectations: Vec<Verdict>,
}

/// What results come from: enough to run them again, and to tell whether two runs were of the same deck and program.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct RunOrigin {
    /// Version of the program, with the commit it was built from where that was known.
    pub version: String,
    /// That of the deck.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Path of the deck, as it was given.
    pub deck: String,
    /// Overrides, as they were given: `KEY=VALUE`.
    pub sets: Vec<String>,
    /// SHA-256 of the deck with its overrides and its mesh, hexadecimal.
    pub deck_hash: String,
}

impl RunOrigin {
    /// Lines for the log.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!("rdsolve {}, deck {}", self.version, self.deck)];
        lines.extend(self.sets.iter().map(|set| format!("--set {set}")));
        lines.push(format!("deck hash {}", self.deck_hash));
        lines
    }
}

/// How large the scene is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Sizes {
    pub nodes: usize,
    pub bodies: usize,
    /// Of all beams, bars and shells.
    pub elements: usize,
    /// Displacements, rotations and Lagrange multipliers that are solved for.
    pub unknowns: usize,
    /// Of these, Lagrange multipliers.
    pub multipliers: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct ReportedCounts {
    pub steps: usize,
    pub iterations: usize,
    pub factorizations: usize,
    pub solves: usize,
    pub cuts: usize,
}

/// Wall-clock seconds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Timings {
    pub read_s: f64,
    pub plan_s: f64,
    /// The time stepping alone.
    pub loop_s: f64,
    pub write_s: f64,
    pub total_s: f64,
}

impl RunResult {
    /// Writes `result.json` whole or not at all.
    pub fn write(&self, dir: &Path) -> io::Result<()> {
        let path = dir.join(NAME);
        let mut text = serde_json::to_vec_pretty(self).map_err(|e| at(&path, e.into()))?;
        text.push(b'\n');
        replace(&path, &text)
    }
}

/// Greatest resident memory of this process so far; Linux tells it.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_reads_back() {
        let dir = tempfile::tempdir().unwrap();
        let result = RunResult {
            status: Status::NotConverged,
            exit_code: Status::NotConverged.exit_code(),
            reason: "no equilibrium at t = 0.1".into(),
            valid_until: Some(0.1),
            origin: RunOrigin { version: "0.1.0".into(), deck_hash: "00ff".into(), ..RunOrigin::default() },
            plan: vec!["dynamic".into()],
            sizes: Sizes { unknowns: 12, ..Sizes::default() },
            counts: ReportedCounts { steps: 3, ..ReportedCounts::default() },
            timings: Timings { loop_s: 0.1, ..Timings::default() },
            rotation_drift: None,
            joint_violation: None,
            peak_memory_bytes: None,
            warnings: vec![],
            expectations: vec![],
        };
        result.write(dir.path()).unwrap();
        let text = std::fs::read(dir.path().join("result.json")).unwrap();
        let read: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(read["status"], "not-converged");
        assert_eq!(read["exit_code"], 4);
        assert_eq!(read["sizes"]["unknowns"], 12);
        assert_eq!(read["deck_hash"], "00ff");
        assert_eq!(read["timings"]["loop_s"], 0.1);
        assert!(read["peak_memory_bytes"].is_null());
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1, "no temporary file stays");
    }

    #[test]
    fn a_missing_folder_is_named() {
        let error = replace(Path::new("/nowhere/result.json"), b"").unwrap_err();
        assert!(error.to_string().starts_with("/nowhere/result.json: "), "{error}");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn memory_is_known_and_plausible() {
        let bytes = peak_memory_bytes().unwrap();
        assert!((1 << 19..1 << 40).contains(&bytes), "{bytes}");
    }
}
