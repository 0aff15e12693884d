//! Motion that is given: the three ways to tell it, moving supports against a moving frame, and a driven hub.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::amplitude::Amplitude;
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::model::{AnalysisKind, BaseAcceleration, History, MassKind, Model, PrescribedMotion, Restraint};

/// A bent beam with a body at its end, its foot held in all directions.
fn mast(time_step: f64) -> (Model, usize) {
    let mut rng = StdRng::seed_from_u64(51);
    let mut m = empty(AnalysisKind::Dynamic, 1.5, time_step);
    section(&mut m);
    let p = [[0.0, 0.0, 0.0], [0.2, 0.1, 1.5], [1.2, 0.3, 2.0]].map(|x| node(&mut m, Vec3::from(x)));
    beam(&mut m, [p[0], p[1]], 1, 3, Vec3::x(), MassKind::Lumped);
    beam(&mut m, [p[1], p[2]], 1, 2, Vec3::z(), MassKind::Consistent);
    let block = body(&mut m, Vec3::new(1.4, 0.4, 1.9), 4.0, inertia(&mut rng, 1.0));
    attach(&mut m, p[2], block, ALL);
    fix(&mut m, p[0], 0..6);
    (m, p[0])
}

fn drive(m: &mut Model, node: usize, dof: usize, amplitude: Amplitude, scale: f64, history: History) {
    m.loading.amplitudes.push(amplitude);
    let motion = Some(PrescribedMotion { amplitude: m.loading.amplitudes.len() - 1, scale, history });
    m.constraints.restraints.retain(|h| (h.node, h.dof) != (node, dof));
    m.constraints.restraints.push(Restraint { node, dof, motion });
}

/// s = A sin²(ωt), ṡ = A ω sin(2ωt), s̈ = 2 A ω² cos(2ωt).
fn histories(omega: f64) -> [(Amplitude, f64, History); 3] {
    let end = f64::INFINITY;
    let sine = |phase| Amplitude::Sine { angular_frequency: 2.0 * omega, phase, start: 0.0, end };
    [
        (Amplitude::SineSquared { angular_frequency: omega, start: 0.0, end }, 1.0, History::Displacement),
        (sine(0.0), omega, History::Velocity),
        (sine(std::f64::consts::FRAC_PI_2), 2.0 * omega * omega, History::Acceleration),
    ]
}

/// The given values agree to rounding, and so do the answers.
#[test]
fn displacement_velocity_and_acceleration_tell_the_same_motion() {
    for dof in [0, 4] {
        let states: Vec<_> = histories(3.0)
            .into_iter()
            .map(|(amplitude, scale, history)| {
                let (mut m, foot) = mast(0.01);
                drive(&mut m, foot, dof, amplitude, 0.3 * scale, history);
                run(&m).last().clone()
            })
            .collect();
        for other in &states[1..] {
            let off = apart(&states[0], other);
            eprintln!("direction {dof}: apart by {off:e}");
            assert!(off < 1e-11, "direction {dof}: {off:e}"); // rounding of 150 steps
        }
    }
}

/// Ground acceleration felt by every mass gives the motion relative to supports that move so. The scheme extrapolates the
/// displacement of a support linearly over θΔt, so the two agree to second order of the step.
#[test]
fn shaken_ground_is_supports_that_move() {
    let (omega, size) = (3.0, 0.3);
    let [_, _, (acceleration, scale, _)] = histories(omega);
    let off: Vec<f64> = [0.01, 0.005, 0.0025]
        .iter()
        .map(|&dt| {
            let (mut moved, foot) = mast(dt);
            let [(displacement, ..), ..] = histories(omega);
            drive(&mut moved, foot, 0, displacement, size, History::Displacement);
            let (mut felt, _) = mast(dt);
            felt.loading.amplitudes.push(acceleration.clone());
            felt.loading
                .base_accelerations
                .push(BaseAcceleration { direction: Vec3::x() * size * scale, amplitude: 0 });
            let (moved, felt) = (run(&moved), run(&felt));
            let mut worst = 0.0f64;
            for (a, b) in moved.states.iter().zip(&felt.states) {
                let s = Vec3::x() * size * (omega * a.time).sin().powi(2);
                worst = a.nodes.iter().zip(&b.nodes).map(|(a, b)| (a.x - s - b.x).norm()).fold(worst, f64::max);
            }
            worst
        })
        .collect();
    eprintln!("supports moved and ground shaken: {off:?}");
    assert!(order(off[0], off[1]) > 1.8 && order(off[1], off[2]) > 1.9, "{off:?}");
    assert!(off[2] < 1e-3 * size, "{off:?}");
}

/// A hub turned as told carries a mass on an arm round the circle, exactly; what holds the hub feels m a and J φ̈ to second
/// order.
#[test]
fn a_driven_hub_carries_its_arm() {
    let (m0, arm, J, size, omega) = (2.0, Vec3::new(0.6, -0.3, 0.0), 0.7, 2.5, 1.5);
    let errors: Vec<f64> = [0.01, 0.005]
        .iter()
        .map(|&dt| {
            let mut m = empty(AnalysisKind::Dynamic, 2.0, dt);
            let centre = Vec3::new(1.0, 2.0, 3.0);
            let hub = body(&mut m, centre, 1.0, Mat3::identity() * J);
            let far = node(&mut m, centre + arm);
            attach(&mut m, far, hub, ALL);
            mass(&mut m, far, m0, Mat3::zeros());
            fix(&mut m, hub, 0..6);
            let [(amplitude, scale, history), ..] = histories(omega);
            drive(&mut m, hub, 5, amplitude, size * scale, history);
            let record = run(&m);
            let mut worst = 0.0f64;
            for state in &record.states {
                let t = state.time;
                let (s2, c2) = (2.0 * omega * t).sin_cos();
                let (angle, rate, second) =
                    (size * (omega * t).sin().powi(2), size * omega * s2, 2.0 * size * omega * omega * c2);
                let S = rotation::matrix(&rotation::exp(&(Vec3::z() * angle))) * arm;
                let off = (state.nodes[far].x - centre - S).norm();
                assert!(off < 1e-13, "at t = {t} off the circle by {off:e}"); // rounding of 200 increments
                let a = Vec3::z().cross(&S) * second - S * rate * rate;
                let f = m0 * a;
                let moment = S.cross(&f) + Vec3::z() * J * second;
                let exact = [f.x, f.y, f.z, moment.x, moment.y, moment.z];
                let error = exact.iter().zip(&state.reactions).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                worst = worst.max(error);
            }
            worst / (m0 * arm.norm() * size * size * omega * omega)
        })
        .collect();
    eprintln!("reactions of the driven hub: {errors:?}");
    assert!(errors[1] < 1e-3 && order(errors[0], errors[1]) > 1.8, "{errors:?}");
}

/// A support moves one end of a chain of two equal springs, one with a damper: the point between goes half the way.
#[test]
fn dampers_do_not_act_in_statics() {
    let mut m = empty(AnalysisKind::Static, 1.0, 0.25);
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| node(&mut m, Vec3::x() * x));
    spring(&mut m, [a, b], 100.0, 0.0);
    spring(&mut m, [b, c], 100.0, 50.0);
    fix(&mut m, a, 0..3);
    fix(&mut m, b, 1..3);
    fix(&mut m, c, 1..3);
    drive(&mut m, c, 0, Amplitude::Ramp { start: 0.0, end: 1.0 }, 0.1, History::Displacement);
    for state in run(&m).states {
        let [b, c] = [b, c].map(|n| state.nodes[n].x.x);
        assert!((b - 0.5 * c).abs() < 1e-13, "{b} for {}", 0.5 * c);
    }
}

/// A hub that is turned from the start on turns what rides on it in that direction, whether the rest rides or not.
#[test]
fn riders_start_turned_with_their_masters() {
    let mut m = empty(AnalysisKind::Dynamic, 0.02, 0.01);
    let hub = body(&mut m, Vec3::zeros(), 1.0, Mat3::identity());
    fix(&mut m, hub, [0, 1, 2, 3, 5]);
    drive(&mut m, hub, 4, Amplitude::Constant, 0.5, History::Displacement);
    for dofs in [ALL, [true, true, true, true, true, false]] {
        let p = body(&mut m, Vec3::x(), 1.0, Mat3::identity());
        attach(&mut m, p, hub, dofs);
    }
    for state in run(&m).states {
        for node in &state.nodes {
            let turn = rotation::log(&node.rotation);
            assert!((turn - Vec3::y() * 0.5).norm() < 1e-14, "{turn}");
        }
    }
}
