//! Thousands of turns: rigid arms keep their length, rotations stay orthonormal, whole turns lead back.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::amplitude::Amplitude;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, History, Model, PrescribedMotion, Restraint, Update};

/// A body far from the origin with an arm on it and an arm on the arm, massive at its end.
fn wheel(time_step: f64, end_time: f64) -> (Model, [usize; 3]) {
    let mut rng = StdRng::seed_from_u64(21);
    let mut m = empty(AnalysisKind::Dynamic, end_time, time_step);
    m.solution.iteration.tolerance = 1e-8;
    let hub = body(&mut m, Vec3::new(3.0, -2.0, 1.0), 2.0, inertia(&mut rng, 1.0));
    let near = node(&mut m, Vec3::new(3.7, -2.4, 1.3));
    let far = node(&mut m, Vec3::new(4.0, -1.1, 0.6));
    attach(&mut m, near, hub, ALL);
    attach(&mut m, far, near, ALL);
    mass(&mut m, far, 0.2, inertia(&mut rng, 0.02));
    (m, [hub, near, far])
}

fn assert_rigid(m: &Model, wheel: [usize; 3], state: &rdsolve::state::State) {
    let [hub, near, far] = wheel;
    for (a, b) in [(hub, near), (near, far), (hub, far)] {
        let length = (m.nodes[b].x - m.nodes[a].x).norm();
        let now = (state.nodes[b].x - state.nodes[a].x).norm();
        assert!((now / length - 1.0).abs() < 1e-12, "{}: {:e}", m.nodes[b].label, now / length - 1.0);
    }
    for &n in &wheel {
        let R = state.nodes[n].R();
        assert!((R.transpose() * R - Mat3::identity()).amax() < 1e-14, "node {n}"); // a few roundings
    }
}

/// A free body that tumbles about no axis of its own; the whole drifts away by 1000 lengths, whose rounding is 1e-13.
#[test]
fn a_tumbling_body_keeps_its_arms() {
    let (mut m, wheel) = wheel(0.02, 1200.0);
    m.nodes[wheel[0]].omega = Vec3::new(3.0, 9.0, 5.0); // 10.7 rad per time: 2045 turns
    m.nodes[wheel[0]].v = Vec3::new(0.5, 0.6, -0.4);
    m.solution.iteration.update = Update::Step;
    m.output.cadence = rdsolve::model::Cadence::Steps(500);
    let record = run(&m);
    for state in &record.states {
        assert_rigid(&m, wheel, state);
    }
}

/// Driven through whole turns, the hub comes back to where it began: the angle of 2π·10⁴ is itself rounded to 7e-12, and
/// each of 10⁵ increments, 0.6 rad, to 1e-16.
#[test]
fn whole_turns_lead_back() {
    let turns = 1e4;
    let (mut m, wheel) = wheel(1e-3, 100.0);
    m.loading.amplitudes.push(Amplitude::Ramp { start: 0.0, end: 100.0 });
    let motion =
        PrescribedMotion { amplitude: 0, scale: std::f64::consts::TAU * turns, history: History::Displacement };
    fix(&mut m, wheel[0], 0..5);
    m.constraints.restraints.push(Restraint { node: wheel[0], dof: 5, motion: Some(motion) });
    m.output.cadence = rdsolve::model::Cadence::Steps(10_000);
    let record = run(&m);
    for state in &record.states {
        assert_rigid(&m, wheel, state);
    }
    let turn = record.last().nodes[wheel[0]].R() - Mat3::identity();
    eprintln!("after {turns} turns off by {:e}", turn.amax());
    assert!(turn.amax() < 7e-12, "{turn}");
}
