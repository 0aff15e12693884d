//! result.json: the outcome of a run in one object that a script can read.

use super::collected::FoundNumber;
use super::disk::{at, create, replace};
use super::error_bars::ErrorBar;
use super::expect::Verdict;
use super::marks::SceneMarks;
use serde::{Deserialize, Serialize};
use solve::system::{MassScaling, ScaledPart};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The name of the file in the output folder.
pub const NAME: &str = "result.json";

/// The name of a result that is not marked yet.
pub const UNMARKED: &str = "result.json.tmp";

/// The kind of end that a run came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The run came to its end, and met all expectations and required stops.
    Done,
    /// No step could be taken any more, or an equilibrium is unstable; results are valid up to the time named.
    NotConverged,
    /// The run came to its end, and missed an expectation or the required `stop` of a stage or path.
    ExpectationMissed,
    /// A signal has stopped the run after a whole step.
    Stopped,
    /// The memory is too small for the run.
    TooLittleMemory,
}

impl Status {
    /// The exit code of the program where nothing but the run itself decides.
    pub fn exit_code(self) -> u8 {
        match self {
            Status::Done => 0,
            Status::NotConverged => 4,
            Status::ExpectationMissed => 5,
            Status::TooLittleMemory => 7,
            Status::Stopped => 75,
        }
    }
}

/// The object itself; its fields are the keys, in this order.
#[derive(Debug, Clone, Serialize)]
pub struct RunResult {
    /// The kind of end that the run came to.
    pub status: Status,
    /// The exit code that belongs to the status.
    pub exit_code: u8,
    /// The reason for the end in one sentence. It is empty when done.
    pub reason: String,
    /// The time up to which results are valid, if the run stopped early or an equilibrium is unstable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub valid_until: Option<f64>,
    /// The deck and the program that the results come from.
    #[serde(flatten)]
    pub origin: RunOrigin,
    /// The lines that `rdsolve check` prints.
    pub plan: Vec<String>,
    /// True for displacement control: times are then load factors, and rows of two runs match by steps.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub by_displacement: bool,
    /// The size of the scene and of its equations.
    pub sizes: Sizes,
    /// The work of the solver.
    pub counts: ReportedCounts,
    /// The time that the run took.
    pub timings: Timings,
    /// The estimated errors of the results.
    #[serde(flatten)]
    pub errors: ReportedErrors,
    /// Largest departure from orthogonality that a first- or second-order rotation update left to be corrected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_drift: Option<f64>,
    /// Largest gap that a joint was left with at the end of a step, relative to the largest coordinate of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_violation: Option<f64>,
    /// The largest resident memory of the process; `None` if the system does not report it.
    pub peak_memory_bytes: Option<u64>,
    /// The warnings about the deck and the results, in the order of their occurrence.
    pub warnings: Vec<String>,
    /// The judgements on the expectations, in the order of the deck.
    pub expectations: Vec<Verdict>,
    /// The numbers that a sweep collects of the rows of every step.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub collected: Vec<FoundNumber>,
    /// Supports, loads, joints and sections of beams, for pages and pictures.
    pub marks: SceneMarks,
}

/// The deck and the program that results come from: enough to run them again, and to tell whether two runs were of the same deck
/// and program.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct RunOrigin {
    /// The version of the program, with its commit if known.
    pub version: String,
    /// The level of instructions that it used.
    pub instructions: String,
    /// The title of the deck; empty where it has none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// The system of units of the deck; empty where it has none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub units: String,
    /// The path of the deck, as it was given.
    pub deck: String,
    /// The overrides, as they were given: `KEY=VALUE`.
    pub sets: Vec<String>,
    /// SHA-256 of the deck with its overrides and its mesh, hexadecimal.
    pub deck_hash: String,
}

impl RunOrigin {
    /// The origin in lines for the log.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!("rdsolve {}, deck {}", self.version, self.deck)];
        lines.extend(self.sets.iter().map(|set| format!("--set {set}")));
        lines.push(format!("instructions {}", self.instructions));
        lines.push(format!("deck hash {}", self.deck_hash));
        lines
    }
}

/// The size of the scene and of its equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Sizes {
    /// The number of all nodes: those of bodies, of ends of links and those on the ground are among them.
    pub nodes: usize,
    /// The number of rigid bodies.
    pub bodies: usize,
    /// The number of elements of all beams, bars and shells.
    pub elements: usize,
    /// The number of displacements, rotations and Lagrange multipliers that are solved for.
    pub unknowns: usize,
    /// The number of Lagrange multipliers among the unknowns.
    pub multipliers: usize,
}

/// The work of the solver over the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct ReportedCounts {
    /// The number of accepted steps, substeps included.
    pub steps: usize,
    /// The number of equilibrium iterations in accepted steps; of an explicit scheme, of evaluations of the residual.
    pub iterations: usize,
    /// The number of factorizations of a matrix.
    pub factorizations: usize,
    /// The number of solutions with a factorized matrix.
    pub solves: usize,
    /// The number of cutbacks: attempts at a step that were given up for a shorter one.
    pub cuts: usize,
    /// The number of failed elements and links, if the scene can fail.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<usize>,
}

/// The estimated errors of the results.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ReportedErrors {
    /// The error of automatic steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step_error: Option<ReportedStepError>,
    /// The mass that mass scaling adds to the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_scaling: Option<ReportedMasses>,
    /// The run with a coarser mesh, which estimates the errors of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<ReportedMesh>,
    /// The settings that `accuracy` has chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<ReportedAccuracy>,
    /// The errors of the largest values of all columns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub error_bars: Vec<ErrorBar>,
}

/// The settings chosen for `accuracy`, with errors estimated by pilot runs. Errors are relative to the largest change of a result.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ReportedAccuracy {
    /// `accuracy` of the deck.
    pub asked: f64,
    /// The estimated error by the mesh; `None` where it is not known.
    pub mesh: Option<f64>,
    /// The estimated error by contact stiffness left open; `None` where there is none, or it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<f64>,
    /// The estimated error by load steps; `None` where steps are automatic, or the load steps make none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_steps: Option<f64>,
    /// The part of the error that is left to automatic steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<f64>,
    /// The settings as overrides of the deck.
    pub settings: Vec<String>,
    /// Errors that remain, or are not known.
    pub remarks: Vec<String>,
    /// Number of pilot runs, ...
    pub pilot_runs: usize,
    /// ... their steps, ...
    pub pilot_steps: usize,
    /// ... iterations ...
    pub pilot_iterations: usize,
    /// ... and factorizations.
    pub pilot_factorizations: usize,
}

/// The error of automatic steps, relative to the largest motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReportedStepError {
    /// `error_tolerance` of the deck.
    pub asked: f64,
    /// Estimated error of the run; `None` where it has not been found.
    pub estimate: Option<f64>,
    /// The tolerance that the steps followed.
    pub tolerance: f64,
    /// Number of other runs for the estimate, ...
    pub other_runs: usize,
    /// ... their steps, ...
    pub other_steps: usize,
    /// ... iterations ...
    pub other_iterations: usize,
    /// ... and factorizations.
    pub other_factorizations: usize,
}

/// The mass that mass scaling adds to the scene, in its first stage with time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportedMasses {
    /// `mass_scaling_step` of the deck, or the step that rotary inertia alone gives to the elements.
    pub critical_step: f64,
    /// Mass of the scene without the added mass.
    pub mass: f64,
    /// Mass that is added, ...
    pub added: f64,
    /// ... and its share of the mass of the scene.
    pub share: f64,
    /// The parts with mass, in the order of the deck.
    pub parts: Vec<ReportedPartMass>,
}

/// The mass that mass scaling adds to a part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportedPartMass {
    /// Its name.
    pub part: String,
    /// Number of elements that are given mass, ...
    pub heavier: usize,
    /// ... of those that are given rotary inertia, ...
    pub rotary: usize,
    /// ... and of all.
    pub elements: usize,
    /// Mass without the added mass.
    pub mass: f64,
    /// Mass that is added, ...
    pub added: f64,
    /// ... and its share of the mass of the part.
    pub share: f64,
    /// Largest factor on the mass of an element.
    pub factor: f64,
    /// Largest factor on the rotary inertia of an element at a node.
    pub rotary_factor: f64,
}

impl From<&MassScaling> for ReportedMasses {
    fn from(scaling: &MassScaling) -> ReportedMasses {
        let part = |told: &ScaledPart| {
            let ScaledPart { elements, heavier, rotary, mass, added, factor, rotary_factor, .. } = *told;
            let (part, share) = (told.name.clone(), told.share());
            ReportedPartMass { part, heavier, rotary, elements, mass, added, share, factor, rotary_factor }
        };
        ReportedMasses {
            critical_step: scaling.critical_step,
            mass: scaling.mass,
            added: scaling.added(),
            share: scaling.added() / scaling.mass,
            parts: scaling.parts.iter().map(part).collect(),
        }
    }
}

/// The run with a coarser mesh, which estimates the errors of the mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportedMesh {
    /// The overrides that ask for it.
    pub sets: Vec<String>,
    /// The assumed ratio of its errors to the errors of this run.
    pub apart: f64,
    /// The names of parts with the same mesh in both runs, whose error is therefore unknown.
    pub unchanged: Vec<String>,
    /// Its steps, ...
    pub steps: usize,
    /// ... iterations ...
    pub iterations: usize,
    /// ... and factorizations.
    pub factorizations: usize,
}

/// The time that the run took, in seconds of the wall clock.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Timings {
    /// Reading the deck and its mesh, and building the model.
    pub read_s: f64,
    /// Pilot runs for `accuracy`.
    #[serde(skip_serializing_if = "is_zero")]
    pub pilots_s: f64,
    /// Making the plan, the system of equations and the solver.
    pub plan_s: f64,
    /// The time stepping alone.
    pub loop_s: f64,
    /// Showing accepted steps to all that write, draw or judge them.
    pub write_s: f64,
    /// From the start of the program to the writing of this object.
    pub total_s: f64,
}

/// True for no time at all.
fn is_zero(seconds: &f64) -> bool {
    *seconds == 0.0
}

impl RunResult {
    /// Writes `result.json` whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn write(&self, dir: &Path) -> io::Result<()> {
        let path = dir.join(NAME);
        let mut text = serde_json::to_vec_pretty(self).map_err(|e| at(&path, e.into()))?;
        text.push(b'\n');
        replace(&path, &text)
    }

    /// Writes the same under another name, until [`mark`] gives it its own.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn write_unmarked(&self, dir: &Path) -> io::Result<()> {
        let path = unmarked(dir);
        let mut text = serde_json::to_vec_pretty(self).map_err(|e| at(&path, e.into()))?;
        text.push(b'\n');
        create(&path).and_then(|mut file| file.write_all(&text)).map_err(|error| at(&path, error))
    }
}

/// The path of a result that is not marked yet.
fn unmarked(dir: &Path) -> PathBuf {
    dir.join(UNMARKED)
}

/// Marks a run as finished by giving its result file the final name.
///
/// # Errors
/// There is no result, or the system refuses.
pub fn mark(dir: &Path) -> io::Result<()> {
    let path = unmarked(dir);
    std::fs::rename(&path, dir.join(NAME)).map_err(|error| at(&path, error))
}

/// The largest resident memory of this process so far on Linux; `None` elsewhere.
pub fn peak_memory_bytes() -> Option<u64> {
    process_bytes("VmHWM:").map(|bytes| bytes as u64)
}

/// A size of this process by its name in `/proc/self/status`, in bytes; `None` if the system does not report it.
pub fn process_bytes(name: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kilobytes)
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
            by_displacement: false,
            sizes: Sizes { unknowns: 12, ..Sizes::default() },
            counts: ReportedCounts { steps: 3, ..ReportedCounts::default() },
            timings: Timings { loop_s: 0.1, ..Timings::default() },
            rotation_drift: None,
            errors: ReportedErrors::default(),
            joint_violation: None,
            peak_memory_bytes: None,
            warnings: vec![],
            expectations: vec![],
            collected: vec![],
            marks: SceneMarks::default(),
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
