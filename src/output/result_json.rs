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
pub struct Report {
    pub status: Status,
    /// That of the status, unless the failure was one of input/output (6).
    pub exit_code: u8,
    /// One sentence; empty when done, unless a path ended before its `stop`.
    pub reason: String,
    pub version: String,
    /// That of the deck.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// SHA-256 of the deck with its overrides and its mesh, hexadecimal.
    pub deck_hash: String,
    pub plan: serde_json::Value,
    pub counts: Counts,
    pub timings: Timings,
    /// Largest departure from orthogonality that a first- or second-order rotation update left to be mended.
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
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

impl Report {
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
    fn a_report_reads_back() {
        let dir = tempfile::tempdir().unwrap();
        let report = Report {
            status: Status::NotConverged,
            exit_code: Status::NotConverged.exit_code(),
            reason: "no equilibrium at t = 0.1".into(),
            version: "0.1.0".into(),
            title: String::new(),
            deck_hash: "00ff".into(),
            plan: serde_json::json!({ "unknowns": 12 }),
            counts: Counts { steps: 3, ..Counts::default() },
            timings: Timings { loop_s: 0.1, ..Timings::default() },
            rotation_drift: None,
            joint_violation: None,
            peak_memory_bytes: None,
            warnings: vec![],
            expectations: vec![],
        };
        report.write(dir.path()).unwrap();
        let text = std::fs::read(dir.path().join("result.json")).unwrap();
        let read: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(read["status"], "not-converged");
        assert_eq!(read["exit_code"], 4);
        assert_eq!(read["plan"]["unknowns"], 12);
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
