//! A step that is given up leaves nothing behind: not in the motion, not in what the material remembers.

use super::scene::*;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, Expect, ExpectAt, MassKind, Model, Tolerance, Update, When};
use rdsolve::plan::Plan;
use rdsolve::solve::{Counts, Frame, Observer, Outcome, Run, Wanted};
use rdsolve::state::State;
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

/// Iterations that some steps need more of.
const LIMITS: [(AnalysisKind, usize); 2] = [(AnalysisKind::Static, 5), (AnalysisKind::Dynamic, 4)];

/// A cantilever of two beams, bent far over, back, and over again, in steps too long for `limit` iterations.
fn bent(kind: AnalysisKind, limit: usize) -> Model {
    let mut m = empty(kind, 2.0, 0.125);
    m.analysis.least_step = 1e-6;
    section(&mut m);
    let p = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [2.0, 0.0, 0.3]].map(|x| node(&mut m, Vec3::from(x)));
    beam(&mut m, [p[0], p[1]], 2, 3, Vec3::z(), MassKind::Lumped);
    beam(&mut m, [p[1], p[2]], 2, 2, Vec3::z(), MassKind::Lumped);
    soften(&mut m, 10.0);
    fix(&mut m, p[0], 0..6);
    mass(&mut m, p[2], 1.0, Mat3::identity());
    let pulse = sine_squared(&mut m, std::f64::consts::PI);
    push(&mut m, p[2], Vec3::new(0.0, -8.0, 4.0), Vec3::new(3.0, 0.0, 5.0), false, Some(pulse));
    m.solution.iteration.update = Update::Iteration;
    m.solution.iteration.limit = limit;
    m
}

/// Times of all accepted steps.
struct Steps {
    times: Vec<f64>,
    last: Option<State>,
}

impl Observer for Steps {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()> {
        self.times.push(frame.state.time);
        self.last = Some(frame.state.clone());
        Ok(())
    }
}

fn steps(m: &Model) -> (Steps, State, Counts, Outcome) {
    let system = System::new(m).unwrap();
    let plan = Plan::new(m, &system, 1);
    let stop = AtomicBool::new(false);
    let wanted = Wanted::ENERGY | Wanted::REACTIONS;
    let mut run = Run::new(m, &system, &plan, wanted, &stop).unwrap();
    let mut steps = Steps { times: vec![], last: None };
    let (outcome, state) = run.run(&mut steps);
    (steps, state.expect("a start"), run.counts(), outcome)
}

/// Expectations at given times, so that steps land there.
fn told(times: &[f64]) -> Vec<Expect> {
    let at = |&time: &f64| Expect {
        index: 0,
        at: ExpectAt::Energy,
        quantity: "plastic".into(),
        when: When::Time(time),
        value: 1.0,
        tolerance: Tolerance::Relative(1.0),
        source: String::new(),
        label: String::new(),
    };
    times.iter().map(at).collect()
}

/// A run that is told beforehand where the steps of another ended rejects none, and is the same to the last bit.
#[test]
fn rejected_steps_leave_no_trace() {
    for (kind, limit) in LIMITS {
        let m = bent(kind.clone(), limit);
        let (cut, end, counts, outcome) = steps(&m);
        eprintln!("{kind:?}: {counts:?}");
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        assert!(counts.cuts > 3, "{counts:?}");
        assert!(end.work.material.plastic > 0.1, "{:?}", end.work);
        let told = Model { expects: told(&cut.times[1..]), ..m.clone() };
        let (straight, same, counts, _) = steps(&told);
        assert_eq!(counts.cuts, 0, "{kind:?}");
        assert_eq!(straight.times, cut.times, "{kind:?}");
        assert_eq!(same, end, "{kind:?}");
    }
}

/// The same with no shorter step to try: the run ends with the state it had.
#[test]
fn a_run_that_fails_ends_with_its_last_step() {
    for (kind, limit) in LIMITS {
        let mut m = bent(kind.clone(), limit);
        // Short steps first, which succeed, until one is too long.
        m.expects = told(&[0.03, 0.06, 0.09, 0.12, 0.15, 0.18, 0.21, 0.24, 0.27, 0.3]);
        m.analysis.least_step = m.analysis.nominal_step();
        let (seen, end, _, outcome) = steps(&m);
        eprintln!("{kind:?}: {} {:?}", end.time, end.work);
        assert!(matches!(outcome, Outcome::Failed { time, .. } if time == end.time), "{outcome:?}");
        assert!(end.work.material.plastic > 0.0, "{:?}", end.work);
        assert_eq!(seen.last, Some(end));
    }
}
