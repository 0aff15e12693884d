//! `run --mesh-error`: the error of the mesh, estimated by another run with a coarser one.

use base::diagnostic::Source;
use model::{self, Model};
use results::error_bars::ErrorBars;
use results::expect::Expectations;
use results::result_json::ReportedMesh;
use results::wanted;
use solve::modes::reduce;
use solve::plan::Plan;
use solve::system::System;
use solve::{Frame, Observer, Outcome, Run, StepError};
use std::io;
use std::sync::atomic::AtomicBool;
use study::{CoarserMesh, coarser};

/// The receivers of the error of the mesh.
pub struct Judged<'j> {
    /// The expectations of the run, which has come to its end.
    pub expectations: &'j mut Expectations,
    /// The account of the tables that it has written.
    pub bars: &'j mut ErrorBars,
}

/// Makes the other run, and passes its estimate to expectations and tables.
///
/// # Errors
/// The reason why the error is not known, in a sentence.
pub fn tell_mesh_error(
    source: &Source,
    model: &Model,
    (steps, threads, stop): (Option<StepError>, usize, &AtomicBool),
    judged: Judged,
) -> Result<ReportedMesh, String> {
    let unknown = |why: &str| format!("the error of the mesh is not known: {why}");
    if model.analysis.step_length.is_arc_length() {
        return Err(unknown("paths of given arc length have other load factors at each step with another mesh"));
    }
    let (Some(deck), _) = deck::read(source) else { return Err(unknown("the deck cannot be read again")) };
    if !model.parts.iter().any(|part| part.kind().is_deformable()) {
        return Err(unknown("there is none, for nothing deforms"));
    }
    let CoarserMesh { sets, apart, unchanged } = coarser(&deck, model);
    if sets.is_empty() {
        let why = "no part can have fewer elements, or a lower degree, than it has";
        return Err(unknown(&if unchanged.is_empty() { why.to_owned() } else { of_file(&unchanged) }));
    }
    let all: Vec<String> = source.sets.iter().map(|(_, set)| set).chain(&sets).cloned().collect();
    let source = Source::new(source.path.clone(), source.text.clone(), &all);
    let (Some(mut theirs), _) = model::read(&source) else {
        return Err(unknown(&format!("the deck is not valid with {}", sets.join(", "))));
    };
    if reduce(&mut [&mut theirs]).is_err() {
        return Err(unknown("a reduced part has no matrices with another mesh"));
    }
    let system = System::new(&theirs).map_err(|error| unknown(&error))?;
    let plan = Plan::new(&theirs, &system, threads);
    theirs.output.cadence = model.output.cadence;
    let mut run =
        Run::new(&theirs, &system, &plan, wanted(&theirs).where_due(), stop).map_err(|e| unknown(&e.to_string()))?;
    let times = judged.bars.times_for_mesh().into_iter().chain(judged.expectations.times_for_mesh()).collect();
    let mut watchers = Coarser { expectations: Expectations::new(&theirs), bars: ErrorBars::new(&theirs), judged };
    match run.rehearse(times, steps, &mut watchers) {
        Outcome::Done => {}
        Outcome::Failed { time, failure } => {
            return Err(unknown(&format!("the run with the coarser mesh ends at t = {time}: {failure}")));
        }
        Outcome::Stopped { .. } => return Err(unknown("the run with the coarser mesh was stopped by a signal")),
        Outcome::Io(error) => return Err(unknown(&error.to_string())),
    }
    watchers.judged.expectations.on_coarser_mesh(apart);
    watchers.judged.bars.on_coarser_mesh(apart);
    let counts = run.counts();
    let (steps, iterations, factorizations) = (counts.steps, counts.iterations, counts.factorizations);
    Ok(ReportedMesh { sets, apart, unchanged, steps, iterations, factorizations })
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
}

impl Observer for Coarser<'_> {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn begin_comparison(&mut self) {
        self.judged.expectations.begin_comparison();
        self.judged.bars.begin_comparison();
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        self.judged.expectations.on_other_mesh(&self.expectations, frame);
        self.judged.bars.on_other_mesh(&mut self.bars, frame)
    }
}
