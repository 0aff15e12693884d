//! What the plan leaves out must not move: causes that reach a mass by way of dependent nodes, given motion and inertia.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::amplitude::Amplitude;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, History, Model, PrescribedMotion, Restraint};

fn drive(m: &mut Model, node: usize, dof: usize, amplitude: Amplitude, scale: f64) {
    m.loading.amplitudes.push(amplitude);
    let motion = PrescribedMotion { amplitude: m.loading.amplitudes.len() - 1, scale, history: History::Displacement };
    m.constraints.restraints.push(Restraint { node, dof, motion: Some(motion) });
}

const SWING: Amplitude = Amplitude::SineSquared { angular_frequency: 1.5, start: 0.0, end: f64::INFINITY };

/// A force on a point that only rides, also on a dependent node: the body flies and turns as under the force and its moment.
#[test]
fn a_load_on_a_bare_rider_moves_the_body() {
    for links in [1, 2] {
        let scene = |direct: bool| {
            let mut rng = StdRng::seed_from_u64(71);
            let mut m = empty(AnalysisKind::Dynamic, 1.0, 0.01);
            let block = body(&mut m, Vec3::zeros(), 2.0, inertia(&mut rng, 1.0));
            let (mut tip, arm) = (block, Vec3::new(0.5, 0.2, -0.1));
            for _ in 0..links {
                let master = tip;
                let x = m.nodes[master].x + arm;
                tip = node(&mut m, x);
                attach(&mut m, tip, master, ALL);
            }
            let force = Vec3::new(0.0, 3.0, 0.0);
            if direct {
                // Nothing turns yet in the first step: force and moment of the force are the same load there.
                let moment = (m.nodes[tip].x - m.nodes[block].x).cross(&force);
                push(&mut m, block, force, moment, false, None);
            } else {
                push(&mut m, tip, force, Vec3::zeros(), false, None);
            }
            (run(&m), block)
        };
        let ((there, block), (here, _)) = (scene(false), scene(true));
        let [a, b] = [&there, &here].map(|record| &record.states[0].nodes[block]);
        assert!(b.a.norm() > 1.0 && b.alpha.norm() > 0.5);
        assert!((a.a - b.a).norm() + (a.alpha - b.alpha).norm() < 1e-13, "{links}: {a:?} for {b:?}");
        let centre = there.last().nodes[block].x;
        assert!((centre - Vec3::new(0.0, 0.75, 0.0)).norm() < 1e-12, "{links}: {centre}"); // ½ F/m t²
    }
}

/// A driven rotation of a body whose products of inertia turn it about the other axes too. A moment of 1e-13 puts these
/// among the unknowns in any case.
#[test]
fn a_driven_rotation_turns_the_body_about_its_other_axes() {
    let scene = |moment: f64| {
        let mut rng = StdRng::seed_from_u64(72);
        let mut m = empty(AnalysisKind::Dynamic, 1.0, 0.01);
        let block = body(&mut m, Vec3::zeros(), 1.0, inertia(&mut rng, 1.0));
        fix(&mut m, block, 0..3);
        drive(&mut m, block, 3, SWING, 1.0);
        push(&mut m, block, Vec3::zeros(), Vec3::y() * moment, false, None);
        run(&m).last().nodes[block]
    };
    let (plain, pushed) = (scene(0.0), scene(1e-13));
    assert!(pushed.omega.yz().norm() > 0.01, "{}", pushed.omega);
    assert!((plain.omega - pushed.omega).norm() < 1e-10, "{} for {}", plain.omega, pushed.omega);
}

/// A body on a hinge of another: the axis of the hinge is its own, the rest rides. A moment turns the first body, the
/// second follows about its own axis by its gyroscopic moment.
#[test]
fn a_body_on_a_hinge_turns_by_inertia() {
    let mut m = empty(AnalysisKind::Dynamic, 1.0, 0.005);
    let first = body(&mut m, Vec3::zeros(), 1.0, Mat3::identity() * 2.0);
    let second = body(&mut m, Vec3::z() * 0.1, 1.0, Mat3::from_diagonal(&Vec3::new(1.0, 3.0, 3.0)));
    attach(&mut m, second, first, [true, true, true, true, true, false]);
    push(&mut m, first, Vec3::zeros(), Vec3::new(2.0, 1.0, 0.0), false, None);
    let record = run(&m);
    assert!(record.last().nodes[second].omega.z.abs() > 0.01);
    // Nothing gives angular momentum about z. Of second order in the step: 1e-4 here; 0.13 if the axis is left out.
    let lz = record.energies.last().unwrap().l.z;
    assert!(lz.abs() < 1e-3, "{lz}");
}

/// In a static analysis velocities mean nothing and inertia couples nothing.
#[test]
fn spin_is_no_cause_in_statics() {
    let mut m = empty(AnalysisKind::Static, 1.0, 0.5);
    let block = body(&mut m, Vec3::zeros(), 1.0, Mat3::identity());
    let ground = node(&mut m, Vec3::z());
    fix(&mut m, ground, 0..6);
    line(
        &mut m,
        [ground, block],
        rdsolve::elements::link::LinkLaw::Linear { stiffness: 100.0, preload: 0.0 },
        0.0,
        Some(-Vec3::z()),
    );
    m.nodes[block].omega = Vec3::y();
    m.loading.gravity = Vec3::z() * -10.0;
    let sunk = run(&m).last().nodes[block].x.z;
    assert!((sunk + 0.1).abs() < 1e-14, "{sunk}");
}

/// Driven about x, free about y: J turns, so the scene is not linear. A follower of 1e-13 makes it iterate in any case.
#[test]
fn a_driven_body_with_one_free_rotation_is_iterated() {
    let scene = |moment: f64| {
        let mut rng = StdRng::seed_from_u64(73);
        let mut m = empty(AnalysisKind::Dynamic, 1.0, 0.01);
        let block = body(&mut m, Vec3::zeros(), 1.0, inertia(&mut rng, 1.0));
        fix(&mut m, block, [0, 1, 2, 5]);
        drive(&mut m, block, 3, SWING, 2.0);
        if moment > 0.0 {
            push(&mut m, block, Vec3::zeros(), Vec3::y() * moment, true, None);
        }
        run(&m).last().nodes[block]
    };
    let (plain, pushed) = (scene(0.0), scene(1e-13));
    assert!((plain.omega - pushed.omega).norm() < 1e-9, "{} for {}", plain.omega, pushed.omega);
}
