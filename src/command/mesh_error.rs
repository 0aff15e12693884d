//! `run --mesh-error`: the error of the mesh, estimated by another run with a coarser one.

use super::load::read_with;
use base::diagnostic::Source;
use model::{Cadence, Model};
use results::error_bars::ErrorBars;
use results::expect::Expectations;
use results::result_json::ReportedMesh;
use results::wanted;
use solve::plan::Plan;
use solve::system::System;
use solve::{Counts, Frame, Observer, Outcome, Run, StepError};
use std::io;
use std::sync::atomic::AtomicBool;
use study::{CoarserMesh, coarser};

/// Largest ratio of the errors of two meshes that is believed.
const MOST_APART: f64 = 30.0;

/// The receivers of the error of the mesh.
pub struct Judged<'j> {
    /// The expectations of the run, which has come to its end.
    pub expectations: &'j mut Expectations,
    /// The account of the tables that it has written.
    pub bars: &'j mut ErrorBars,
}

/// The coarser mesh of a deck for another run.
///
/// # Errors
/// The reason why the error of the mesh cannot be known, in a sentence.
pub fn coarser_mesh(source: &Source, model: &Model) -> Result<CoarserMesh, String> {
    let by_hand = "Run the deck with half as many `elements` by `--set`, and give both folders to `rdsolve compare`";
    let unknown = |why: &str| Err(format!("the error of the mesh is not known: {why}"));
    if model.analysis.stage.is_some() {
        return unknown(&format!("it is estimated for decks without stages only. {by_hand}"));
    }
    if model.analysis.step_length.is_arc_length() {
        return unknown(&format!("along a path, steps have other load factors with another mesh. {by_hand}"));
    }
    if !model.parts.iter().any(|part| part.kind().is_deformable()) {
        return unknown("there is none, for nothing deforms");
    }
    let (Some(deck), _) = deck::read(source) else { return unknown("the deck cannot be read again") };
    let mesh = coarser(&deck, model);
    if !mesh.sets.is_empty() {
        return Ok(mesh);
    }
    let why = "no part can have fewer elements, or a lower degree, than it has";
    unknown(&if deck.mesh.is_none() || mesh.unchanged.is_empty() { why.to_owned() } else { of_file(&mesh.unchanged) })
}

/// Makes the other run with this mesh, and passes its estimate to expectations and tables.
///
/// # Errors
/// The reason why the error is not known, in a sentence.
pub fn tell_mesh_error(
    (source, model): (&Source, &Model),
    (steps, threads, stop): (Option<StepError>, usize, &AtomicBool),
    mesh: CoarserMesh,
    judged: Judged,
) -> Result<ReportedMesh, String> {
    let unknown = |why: &str| format!("the error of the mesh is not known: {why}");
    let CoarserMesh { sets, mut apart, unchanged, coarsest } = mesh;
    let times = judged.bars.times_for_mesh().into_iter().chain(judged.expectations.times_for_mesh()).collect();
    let mut other =
        OtherMesh { source, cadence: model.output.cadence, steps, threads, stop, times, is_coarsest: false, judged };
    let Counts { mut steps, mut iterations, mut factorizations, .. } = other.run(&sets).map_err(|why| unknown(&why))?;
    if !coarsest.is_empty() {
        other.is_coarsest = true;
        // Without this run the least ratio is assumed.
        if let Ok(counts) = other.run(&coarsest) {
            apart = other.judged.bars.measured_ratio().unwrap_or(apart).clamp(apart, MOST_APART);
            steps += counts.steps;
            iterations += counts.iterations;
            factorizations += counts.factorizations;
        }
    }
    other.judged.expectations.on_coarser_mesh(apart);
    other.judged.bars.on_coarser_mesh(apart);
    Ok(ReportedMesh { sets, apart, unchanged, steps, iterations, factorizations })
}

/// Runs with other meshes that are compared with the run of the deck.
struct OtherMesh<'r> {
    source: &'r Source,
    cadence: Cadence,
    /// The error of the steps that all runs follow.
    steps: Option<StepError>,
    threads: usize,
    stop: &'r AtomicBool,
    times: Vec<f64>,
    /// True if the mesh is coarser than that of another such run.
    is_coarsest: bool,
    judged: Judged<'r>,
}

impl OtherMesh<'_> {
    /// Runs the deck with these overrides, and tells its counts.
    ///
    /// # Errors
    /// The reason why there is no such run.
    fn run(&mut self, sets: &[String]) -> Result<Counts, String> {
        let mut theirs = read_with(self.source, sets)?;
        let system = System::new(&theirs)?;
        let plan = Plan::new(&theirs, &system, self.threads);
        theirs.output.cadence = self.cadence;
        let run = Run::new(&theirs, &system, &plan, wanted(&theirs).where_due(), self.stop);
        let mut run = run.map_err(|error| error.to_string())?;
        let (expectations, bars) = (Expectations::new(&theirs), ErrorBars::new(&theirs));
        let judged = Judged { expectations: self.judged.expectations, bars: self.judged.bars };
        let mut watchers = Coarser { expectations, bars, judged, is_coarsest: self.is_coarsest };
        match run.rehearse(self.times.clone(), (self.steps, &[]), &mut watchers).0 {
            Outcome::Done => Ok(run.counts()),
            Outcome::Failed { time, failure } => {
                Err(format!("the run with the coarser mesh ends at t = {time}: {failure}"))
            }
            Outcome::Stopped { .. } => Err("the run with the coarser mesh was stopped by a signal".to_owned()),
            Outcome::Io(error) => Err(error.to_string()),
        }
    }
}

/// Says that parts come from a file.
pub fn of_file(parts: &[String]) -> String {
    format!(
        "the elements of {} come from a mesh file, so rdsolve cannot coarsen them. Compare with a run of a coarser mesh",
        parts.join(", ")
    )
}

/// Reads the values of the run with the coarser mesh at the times of the other run.
struct Coarser<'j> {
    expectations: Expectations,
    bars: ErrorBars,
    judged: Judged<'j>,
    is_coarsest: bool,
}

impl Observer for Coarser<'_> {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn begin_comparison(&mut self) {
        if self.is_coarsest {
            return;
        }
        self.judged.expectations.begin_comparison();
        self.judged.bars.begin_comparison();
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        if self.is_coarsest {
            return self.judged.bars.on_coarsest_mesh(&mut self.bars, frame);
        }
        self.judged.expectations.on_other_mesh(&self.expectations, frame);
        self.judged.bars.on_other_mesh(&mut self.bars, frame)
    }
}
