//! Runs of decks watched step by step: a digest of everything that a run shows, and checkpoints on the way.

use super::{Done, read};
use rdsolve::model::Model;
use rdsolve::output::expect::Expectations;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, OtherRun, Outcome, Run};
use rdsolve::system::System;
use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};
use std::time::Instant;

/// A run, or a piece of it.
pub struct Watched {
    /// A digest of each thing that it shows.
    pub things: Vec<u64>,
    /// Checkpoints, each with the number of things before it.
    pub checkpoints: Vec<(usize, Vec<u8>)>,
    /// Its end, its counts and its warnings.
    pub told: String,
    /// Its values; only those of a run from the start are whole.
    pub done: Done,
}

/// The pieces of a run that are watched.
pub enum Watch<'c> {
    /// From the start to the end, with checkpoints spread over the run.
    Whole,
    /// From a checkpoint on, up to so many things or to the end.
    From(&'c [u8], Option<usize>),
}

/// The runs of decks, by their names.
type Runs = Mutex<HashMap<String, Arc<OnceLock<Arc<Watched>>>>>;

/// A deck from start to end. All tests of a process share the run.
pub fn whole(name: &str) -> Arc<Watched> {
    static RUNS: LazyLock<Runs> = LazyLock::new(Mutex::default);
    let run = Arc::clone(RUNS.lock().expect("no test fails here").entry(name.to_owned()).or_default());
    Arc::clone(run.get_or_init(|| Arc::new(watch(&read(name, &[]), Watch::Whole))))
}

/// Runs a model and watches.
pub fn watch(model: &Model, what: Watch) -> Watched {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, &system, &plan, wanted(model), &stop).unwrap();
    let (mut every, mut enough) = (1, None);
    if let Watch::From(checkpoint, until) = what {
        run.resume(checkpoint.to_vec());
        (every, enough) = (0, until);
    }
    let expectations = Expectations::new(model);
    let mut witness =
        Witness { things: Vec::new(), enough, stop: &stop, checkpoints: Vec::new(), asked: 0, every, expectations };
    let began = Instant::now();
    let (outcome, state) = run.run(&mut witness);
    let seconds = (began.elapsed() - run.observing()).as_secs_f64();
    let told = format!(
        "{outcome:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        state.map(|state| state.time.to_bits()),
        run.counts(),
        run.balance(),
        run.warnings(),
        run.remarks(),
        run.step_error(),
        run.joint_violation(),
        run.missed_work(),
        run.broken()
    );
    assert!(!matches!(outcome, Outcome::Io(_)), "{told}");
    let done = Done {
        outcome,
        seconds,
        counts: run.counts(),
        step_error: run.step_error(),
        unknowns: plan.dofs.unknowns(),
        warnings: run.warnings().iter().map(ToString::to_string).collect(),
        verdicts: witness.expectations.verdicts(),
        rows: Vec::new(),
    };
    Watched { things: witness.things, checkpoints: witness.checkpoints, told, done }
}

/// Keeps a digest of everything that a run shows, and a few checkpoints.
struct Witness<'s> {
    things: Vec<u64>,
    /// The run is stopped after so many things.
    enough: Option<usize>,
    stop: &'s AtomicBool,
    checkpoints: Vec<(usize, Vec<u8>)>,
    asked: u64,
    /// A checkpoint is wanted every so often; none where this is 0.
    every: u64,
    expectations: Expectations,
}

impl Witness<'_> {
    fn note(&mut self, what: impl Hash) {
        let mut hasher = DefaultHasher::new();
        what.hash(&mut hasher);
        self.things.push(hasher.finish());
        if self.enough.is_some_and(|enough| self.things.len() >= enough) {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

fn digest(frame: &Frame) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut bits = |values: &[f64]| values.iter().for_each(|value| value.to_bits().hash(&mut hasher));
    let state = frame.state;
    for node in &state.nodes {
        [&node.x, &node.low, &node.v, &node.omega, &node.a, &node.alpha].iter().for_each(|v| bits(v.as_slice()));
        bits(node.rotation.coords.as_slice());
    }
    [&state.history, &state.reactions, &state.multipliers].iter().for_each(|values| bits(values));
    let work = state.work;
    bits(&[state.time, frame.dt, frame.effort.residual, work.external, work.damping, work.material.plastic]);
    bits(&frame.derived.energy.map_or([0.0; 2], |energy| [energy.numerical, energy.mechanical]));
    let effort = [frame.effort, frame.derived.effort].map(|of| (of.iterations, of.refactorizations, of.cuts));
    let flags = [frame.due, frame.drawn, frame.last, frame.inside, frame.compared];
    let broken: Vec<&str> = frame.derived.broken.iter().map(|broken| broken.what.as_str()).collect();
    (frame.step, effort, flags, frame.negative_pivots, frame.passed, broken).hash(&mut hasher);
    hasher.finish()
}

impl Observer for Witness<'_> {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.note(digest(frame));
        self.expectations.on_step(frame)
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        self.expectations.on_modes(frame)
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        self.note("restart");
        self.expectations.restart(model)
    }

    fn begin_comparison(&mut self) {
        self.note("trial");
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        self.note((1, digest(frame)));
        Ok(())
    }

    fn on_other_run(&mut self, other: Option<OtherRun>) {
        self.note(format!("{other:?}"));
    }

    fn wants_checkpoint(&mut self, at_end: bool) -> bool {
        self.asked += 1;
        self.every > 0 && self.asked.is_multiple_of(self.every) && !at_end
    }

    fn on_checkpoint(&mut self, run: &[u8], _: bool) -> io::Result<()> {
        self.checkpoints.push((self.things.len(), run.to_vec()));
        // Of a long run every second, fourth, ... is kept.
        if self.checkpoints.len() == 4 {
            let mut place = 0..;
            self.checkpoints.retain(|_| place.next().is_some_and(|place: usize| place % 2 == 1));
            self.every *= 2;
        }
        Ok(())
    }
}
