//! Once the first step is taken, the march allocates nothing.

use super::allocations;
use crate::properties::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::diagnostic::Source;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{
    AnalysisKind, BaseAcceleration, Cadence, History, Iteration, MassKind, Method, Model, NodalDamping,
    PrescribedMotion, Restraint, StepLength, Update,
};
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run, Wanted};
use rdsolve::state::State;
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

/// Allocations made so far, by step, and whether the step was cut; room for them is there beforehand.
struct Counts(Vec<(usize, bool)>);

impl Observer for Counts {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()> {
        assert!(self.0.len() < self.0.capacity());
        self.0.push((allocations(), frame.effort.cuts > 0));
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> std::io::Result<()> {
        self.0.clear();
        Ok(())
    }
}

fn lively(rng: &mut StdRng) -> Model {
    let mut m = zoo(rng, AnalysisKind::Dynamic, 0.005);
    m.analysis.end_time = 0.3;
    m.solution.iteration.tolerance = 1e-8;
    let pulse = sine_squared(&mut m, 4.0);
    m.loading.nodal[0].amplitude = Some(pulse);
    m.loading.base_accelerations.push(BaseAcceleration { direction: Vec3::x(), amplitude: pulse });
    let foot = m.constraints.restraints[0].clone();
    m.constraints.restraints[0] = Restraint {
        motion: Some(PrescribedMotion { amplitude: pulse, scale: 0.1, history: History::Displacement }),
        ..foot
    };
    m.damping.mass_factor = 0.1;
    m.damping.stiffness_factor = 0.001;
    m.damping.nodal.push(NodalDamping { node: 2, translation: 0.2, rotation: 0.1 });
    let ball = body(&mut m, Vec3::new(5.0, 5.0, 5.0), 1.0, Mat3::identity());
    m.nodes[ball].omega = Vec3::new(1.0, 2.0, 3.0);
    m.constraints.restraints.sort_by_key(|h| (h.node, h.dof));
    m
}

/// Every update policy and both factorisations, with all that can be shown, and every way to iterate where parts yield: all
/// on the thread of this test.
#[test]
fn no_step_after_the_first_allocates() {
    let mut m = lively(&mut StdRng::seed_from_u64(71));
    let end = std::mem::replace(&mut m.analysis.end_time, 0.15);
    for update in [Update::Iteration, Update::Step, Update::Auto, Update::Never] {
        for kind in [rdsolve::linear::Factorization::BlockLu, rdsolve::linear::Factorization::Cholesky] {
            for cadence in [Cadence::Steps(1), Cadence::Interval(0.012)] {
                m.solution.iteration.update = update;
                m.output.cadence = cadence;
                assert_none(&m, kind);
            }
        }
    }
    m.analysis.end_time = end;
    let fixed = m.analysis.step_length.clone();
    m.analysis.step_length = StepLength::ErrorControlled { tolerance: 1e-4, first: m.analysis.nominal_step() };
    assert_none(&m, rdsolve::linear::Factorization::BlockLu);
    m.analysis.step_length = fixed;
    soften(&mut m, 10.0);
    m.solution.iteration.limit = 200;
    for method in [Method::TangentStiffness, Method::InitialLoad, Method::Auto] {
        for update in [Update::Step, Update::Auto] {
            (m.solution.iteration.method, m.solution.iteration.update) = (method, update);
            let state = assert_none(&m, rdsolve::linear::Factorization::BlockLu);
            assert!(state.work.material.plastic > 0.1, "{:?}", state.work);
        }
    }
    for deck in
        [include_str!("../../decks/lees_frame/deck.toml"), include_str!("../../decks/hinged_roof/thin/deck.toml")]
    {
        let source = Source::new("deck.toml", deck, &["analysis.growth=1.0".to_string()]);
        let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
        let StepLength::ArcLength(path) = &mut model.analysis.step_length else { panic!("no path") };
        path.first *= 0.5;
        for kind in [rdsolve::linear::Factorization::BlockLu, rdsolve::linear::Factorization::Cholesky] {
            assert_none(&model, kind);
        }
    }
    contacts_neither();
    joints_neither();
    superelements_neither();
    shells_neither();
    large_scenes_neither();
}

/// Bodies on springs, a loop of joints, an impact, beams and bodies that carry one another, and steel that yields.
#[test]
fn explicit_steps_allocate_nothing_either() {
    let decks = [
        include_str!("../../decks/two_bodies_on_springs/deck.toml"),
        include_str!("../../decks/four_bar/deck.toml"),
        include_str!("../../decks/bouncing_ball/deck.toml"),
        include_str!("../../decks/flying_beam/deck.toml"),
        include_str!("../../decks/colliding_balls/deck.toml"),
    ];
    for (deck, end) in decks.into_iter().zip([0.5, 0.5, 0.06, 0.4, 0.02]) {
        for scheme in ["central-difference", "runge-kutta"] {
            let source = Source::new("deck.toml", deck, &[format!("integrator={{scheme=\"{scheme}\"}}")]);
            let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
            model.analysis.end_time = end;
            model.expects.clear();
            model.output.cadence = Cadence::Steps(1);
            model.analysis.step_length = StepLength::Fixed { step: end / 500.0 };
            assert_none(&model, rdsolve::linear::Factorization::BlockLu);
        }
    }
    // Tables are due inside automatic steps.
    let sets =
        ["integrator={scheme=\"runge-kutta\"}", "analysis.time_step=\"auto\"", "output={interval=0.01,links=true}"];
    let source = Source::new("deck.toml", decks[0], &sets.map(str::to_string));
    let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
    model.expects.clear();
    assert_none(&model, rdsolve::linear::Factorization::BlockLu);
    let deck = include_str!("../../decks/portal_and_block/deck.toml");
    let sets = ["integrator.scheme=\"central-difference\"", "beams.portal.elements=3", "beams.portal.order=1"];
    let source = Source::new("deck.toml", deck, &sets.map(str::to_string));
    let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
    (model.analysis.end_time, model.analysis.step_length) = (0.02, StepLength::Fixed { step: 8e-6 });
    model.expects.clear();
    let state = assert_none(&model, rdsolve::linear::Factorization::BlockLu);
    assert!(state.work.material.plastic > 1.0, "{:?}", state.work);
}

/// A blade of superelements that spins up.
fn superelements_neither() {
    let path = crate::support::decks().join("spin_up/superelements/deck.toml");
    let text = std::fs::read_to_string(&path).expect("a deck");
    for scheme in ["newmark", "generalized-alpha", "esdirk3"] {
        let sets = [format!("integrator={{scheme=\"{scheme}\"}}")];
        let source = Source::new(path.display().to_string(), text.as_str(), &sets);
        let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
        model.analysis.end_time = 0.5;
        model.expects.clear();
        assert_none(&model, rdsolve::linear::Factorization::BlockLu);
    }
    // The same blade of reduced beams, under a load over its length.
    let path = crate::support::decks().join("spin_up/reduced/deck.toml");
    let text = std::fs::read_to_string(&path).expect("a deck");
    let text = text + "\n[[loads]]\npart = \"blade\"\nforce_per_length = [0.0, 0.1, 1.0]\n";
    for scheme in ["newmark", "generalized-alpha", "esdirk3"] {
        let sets = [format!("integrator={{scheme=\"{scheme}\"}}")];
        let source = Source::new(path.display().to_string(), text.as_str(), &sets);
        let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
        rdsolve::modes::reduce(&mut [&mut model]).expect("matrices");
        model.analysis.end_time = 0.5;
        model.expects.clear();
        assert_none(&model, rdsolve::linear::Factorization::BlockLu);
    }
}

/// A ball that rolls on a floor, lands on a beam and leaves it.
fn contacts_neither() {
    let deck = include_str!("../contact/beam_and_ball.toml");
    let model = rdsolve::model::read(&Source::new("deck.toml", deck, &[])).0.expect("a sound deck");
    for kind in [rdsolve::linear::Factorization::BlockLu, rdsolve::linear::Factorization::Cholesky] {
        let state = assert_none(&model, kind);
        assert!(state.work.material.friction > 0.0 && state.work.material.impact > 0.0, "{:?}", state.work);
    }
}

/// A closed loop of hinges with rows that say the same twice, by every kind of scheme.
fn joints_neither() {
    let deck = include_str!("../../decks/four_bar/deck.toml");
    for scheme in ["wilson-theta", "newmark", "generalized-alpha", "bathe", "esdirk3"] {
        let source = Source::new("deck.toml", deck, &[format!("integrator.scheme=\"{scheme}\"")]);
        let mut model = rdsolve::model::read(&source).0.expect("a sound deck");
        model.analysis.end_time = 0.5;
        model.expects.clear();
        for kind in [rdsolve::linear::Factorization::BlockLu, rdsolve::linear::Factorization::Cholesky] {
            let state = assert_none(&model, kind);
            assert!(state.multipliers.iter().any(|force| force.abs() > 1.0), "{scheme}: {:?}", state.multipliers);
        }
    }
}

/// Shells of both kinds and masses, elastic and yielding, on a body, under pressure that follows.
fn shells_neither() {
    let mut m = empty(AnalysisKind::Dynamic, 0.3, 0.005);
    m.solution.iteration.tolerance = 1e-8;
    let [o, x, y] = [Vec3::zeros(), Vec3::x(), Vec3::y()];
    let first = shell(&mut m, [o, 2.0 * x, y], [3, 2], 4, MassKind::Consistent);
    shell(&mut m, [3.0 * x, 5.0 * x, 3.0 * x + y], [2, 2], 3, MassKind::Lumped);
    let block = body(&mut m, Vec3::new(2.5, 0.5, 0.0), 1.0, Mat3::identity());
    [3, 7, 11].into_iter().for_each(|k| attach(&mut m, first[k], block, ALL));
    m.nodes[block].omega = Vec3::new(0.0, 1.0, 0.5);
    [0, 4, 8].into_iter().for_each(|k| fix(&mut m, first[k], 0..6));
    let pulse = sine_squared(&mut m, 4.0);
    press(&mut m, 4.0, Some(pulse));
    m.damping.stiffness_factor = 1e-3;
    for kind in [rdsolve::linear::Factorization::BlockLu, rdsolve::linear::Factorization::Cholesky] {
        assert_none(&m, kind);
    }
    soften(&mut m, 10.0);
    m.solution.iteration.limit = 200;
    m.solution.iteration.method = Method::Auto;
    let state = assert_none(&m, rdsolve::linear::Factorization::BlockLu);
    assert!(state.work.material.plastic > 0.01, "{:?}", state.work);
}

/// Shells enough for lanes of forces and for fronts above subtrees, on one thread.
fn large_scenes_neither() {
    let mut m = empty(AnalysisKind::Dynamic, 0.028, 0.001);
    m.solution.iteration.tolerance = 1e-8;
    let nodes = shell(&mut m, [Vec3::zeros(), 2.0 * Vec3::x(), Vec3::y()], [36, 30], 4, MassKind::Lumped);
    (0..31).for_each(|row| fix(&mut m, nodes[37 * row], 0..6));
    let pulse = sine_squared(&mut m, 0.028);
    press(&mut m, 0.1, Some(pulse));
    m.solution.iteration.update = Update::Step;
    assert_none(&m, rdsolve::linear::Factorization::Cholesky);
}

fn assert_none(m: &Model, kind: rdsolve::linear::Factorization) -> State {
    let system = System::new(m).unwrap();
    let stop = AtomicBool::new(false);
    let wanted = Wanted::ALL;
    let mut plan = Plan::new(m, &system, 1);
    plan.kind = kind;
    let mut run = Run::new(m, &system, &plan, wanted, &stop).unwrap();
    let mut counts = Counts(Vec::with_capacity(4000));
    let (outcome, state) = run.run(&mut counts);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    let Counts(counts) = counts;
    assert!(counts.len() > 25, "t = 0 and 25 steps");
    // A try that is given up names what is out of balance.
    let kept = counts.windows(2).skip(1).filter(|pair| !pair[1].1);
    let made: Vec<usize> = kept.map(|pair| pair[1].0 - pair[0].0).collect();
    assert!(2 * made.len() > counts.len(), "most steps are taken at once");
    let Iteration { method, update, .. } = m.solution.iteration;
    // A doubt is written down once: its words, and its place in the list.
    let warnings = 2 * run.warnings().iter().count();
    assert!(
        made.iter().sum::<usize>() <= warnings,
        "{method:?}, {update:?}, {kind:?}, {:?}: {made:?}",
        m.output.cadence
    );
    state.expect("a start")
}
