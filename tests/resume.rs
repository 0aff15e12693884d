//! A run that goes on from a checkpoint takes the very steps of one that never stopped.

use crate::support::{deck_names, read};
use rdsolve::model::Model;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, OtherRun, Outcome, Run};
use rdsolve::system::System;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::io;
use std::sync::atomic::AtomicBool;

/// Keeps a digest of everything that a run shows, and a few checkpoints.
#[derive(Default)]
struct Witness {
    seen: Vec<u64>,
    /// Checkpoints, each with the number of things seen before it, and how often none was taken since.
    checkpoints: Vec<(usize, Vec<u8>)>,
    asked: u64,
    /// A checkpoint is wanted every so often; none where this is 0.
    every: u64,
}

impl Witness {
    fn note(&mut self, what: impl Hash) {
        let mut hasher = DefaultHasher::new();
        what.hash(&mut hasher);
        self.seen.push(hasher.finish());
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
    (frame.step, effort, flags, frame.negative_pivots, frame.passed).hash(&mut hasher);
    hasher.finish()
}

impl Observer for Witness {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.note(digest(frame));
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> io::Result<()> {
        self.note("restart");
        Ok(())
    }

    fn begin_trial(&mut self) {
        self.note("trial");
    }

    fn on_trial(&mut self, frame: &Frame) -> io::Result<()> {
        self.note((1, digest(frame)));
        Ok(())
    }

    fn on_other_run(&mut self, other: Option<OtherRun>) {
        self.note(format!("{other:?}"));
    }

    fn wants_checkpoint(&mut self) -> bool {
        self.asked += 1;
        self.every > 0 && self.asked.is_multiple_of(self.every)
    }

    fn on_checkpoint(&mut self, run: &[u8]) -> io::Result<()> {
        self.checkpoints.push((self.seen.len(), run.to_vec()));
        // Of a long run every second, fourth, ... is kept.
        if self.checkpoints.len() == 16 {
            let mut place = 0..;
            self.checkpoints.retain(|_| place.next().is_some_and(|place: usize| place % 2 == 1));
            self.every *= 2;
        }
        Ok(())
    }
}

/// What is seen of a run from a checkpoint on, how it ends, and its counts.
fn watch(model: &Model, checkpoint: Option<&[u8]>, every: u64) -> (Witness, String) {
    let system = System::new(model).unwrap();
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, &system, &plan, wanted(model), &stop).unwrap();
    if let Some(checkpoint) = checkpoint {
        run.resume(checkpoint.to_vec());
    }
    let mut witness = Witness { every, ..Witness::default() };
    let (outcome, state) = run.run(&mut witness);
    let told = format!(
        "{outcome:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        state.map(|state| state.time.to_bits()),
        run.counts(),
        run.balance(),
        run.warnings(),
        run.remarks(),
        run.step_error(),
        run.joint_violation(),
        run.missed_work()
    );
    assert!(!matches!(outcome, Outcome::Io(_)), "{told}");
    (witness, told)
}

/// Resumes the run of a model at checkpoints spread over it, at least so many; returns their number.
fn resume(name: &str, model: &Model) -> usize {
    let (whole, told) = watch(model, None, 1);
    for (before, checkpoint) in &whole.checkpoints {
        let (rest, told_of_rest) = watch(model, Some(checkpoint), 0);
        let at = rest.seen.iter().zip(&whole.seen[*before..]).position(|(a, b)| a != b);
        assert_eq!(at, None, "{name}: seen {before} before the checkpoint, of {}", whole.seen.len());
        assert_eq!(rest.seen.len() + before, whole.seen.len(), "{name}");
        assert_eq!(told_of_rest, told, "{name}");
    }
    println!("{name}: {} steps and more, {} checkpoints", whole.seen.len(), whole.checkpoints.len());
    whole.checkpoints.len()
}

#[test]
fn every_deck_goes_on_as_if_it_had_never_stopped() {
    let only = std::env::var("RDSOLVE_RESUME").unwrap_or_default();
    let mut checkpoints = 0;
    for name in deck_names().iter().filter(|name| name.contains(&only)) {
        checkpoints += resume(name, &read(name, &[]));
    }
    println!("{checkpoints} checkpoints");
}
