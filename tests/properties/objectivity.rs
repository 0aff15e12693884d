//! Turn a whole scene and the answer turns with it; shift it and the answer shifts.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::math::{Vec3, rotation};
use rdsolve::model::{AnalysisKind, History, MassKind, Model, NodalDamping, PrescribedMotion};
use rdsolve::sections::Stiffness;

/// 150 steps in which the ends move by a third of the structure and turn by a radian.
fn lively(rng: &mut StdRng) -> Model {
    let mut m = zoo(rng, AnalysisKind::Dynamic, 0.01);
    m.analysis.end_time = 1.5;
    let pulse = sine_squared(&mut m, 4.0);
    for load in &mut m.loading.nodal {
        load.amplitude = Some(pulse);
    }
    let (hub, omega) = (m.bodies[0].node, vector(rng, 1.0));
    m.nodes[hub].omega = omega;
    m.damping.mass_factor = 0.1;
    m.damping.stiffness_factor = 0.002;
    m.damping.nodal.push(NodalDamping { node: hub, translation: 0.2, rotation: 0.1 });
    // One support shakes along x.
    let held = m.constraints.restraints.iter_mut().find(|h| h.dof == 0).expect("the scene is held");
    held.motion = Some(PrescribedMotion { amplitude: pulse, scale: 0.2, history: History::Displacement });
    m
}

/// Largest differences of positions, rotations, velocities and accelerations from those of the first scene, turned and
/// shifted, relative to the size of the scene and the largest rates.
fn differences(m: &Model, q: &Quat, shift: &Vec3) -> [f64; 4] {
    let (plain, moved) = (run(m), run(&turned(m, q, shift)));
    let R = rotation::matrix(q);
    let (mut size, mut apart) = ([5.0, 1.0, 0.0f64, 0.0f64], [0.0f64; 4]);
    for (a, b) in plain.states.iter().zip(&moved.states) {
        for (a, b) in a.nodes.iter().zip(&b.nodes) {
            let turn = a.R().transpose() * R.transpose() * b.R() * R;
            let errors = [
                (R * a.x + shift - b.x).norm(),
                (turn - rdsolve::math::Mat3::identity()).norm(),
                (R * a.v - b.v).norm(),
                (R * a.a - b.a).norm(),
            ];
            size = [size[0], size[1], size[2].max(a.v.norm()), size[3].max(a.a.norm())];
            for (apart, error) in apart.iter_mut().zip(errors) {
                *apart = apart.max(error);
            }
        }
    }
    std::array::from_fn(|i| apart[i] / size[i])
}

/// Iteration leaves 1e-12 per step and rounding less; 150 steps let it grow tenfold, and what differs by that in position
/// does so by ω² more in acceleration.
#[test]
fn answers_turn_with_the_scene() {
    let mut rng = StdRng::seed_from_u64(11);
    for _ in 0..3 {
        let m = lively(&mut rng);
        let e = differences(&m, &turn(&mut rng), &Vec3::zeros());
        eprintln!("turned: {e:?}");
        assert!(e[..3].iter().all(|&e| e < 1e-11) && e[3] < 1e-10, "{e:?}");
    }
}

/// The same of a scene whose parts yield: what they remember does not turn with it.
#[test]
fn answers_of_yielding_scenes_turn_with_the_scene() {
    let mut rng = StdRng::seed_from_u64(13);
    for _ in 0..3 {
        let mut m = lively(&mut rng);
        soften(&mut m, 20.0);
        let yields = run(&m).energies.last().expect("shown").plastic;
        let e = differences(&m, &turn(&mut rng), &Vec3::zeros());
        eprintln!("turned while it yields: {e:?}, {yields}");
        assert!(yields > 1.0, "{yields}");
        // As above; what yields contracts more slowly, and the last correction leaves thirty times as much.
        assert!(e[..3].iter().all(|&e| e < 3e-10) && e[3] < 3e-9, "{e:?}");
    }
}

/// A hundred lengths away positions are rounded to 1e-13 and forces to that times EA, 1e-10 against loads of 8; a thousand
/// lengths away to ten times that. The tolerance of the iteration, 1e-10 and 1e-8, lies above it and is what remains.
#[test]
fn answers_shift_with_the_scene() {
    let mut rng = StdRng::seed_from_u64(12);
    for (lengths, tolerance) in [(1e2, 1e-10), (1e3, 1e-8)] {
        let mut m = lively(&mut rng);
        m.solution.iteration.tolerance = tolerance;
        let e = differences(&m, &turn(&mut rng), &(vector(&mut rng, 1.0).normalize() * 5.0 * lengths));
        eprintln!("shifted by {lengths} lengths: {e:?}");
        assert!(e[..3].iter().all(|&e| e < 10.0 * tolerance) && e[3] < 100.0 * tolerance, "{e:?}");
    }
}

/// Where rounding of positions exceeds what the tolerance asks of the residual, iteration stops at rounding and no step is
/// cut: a steel beam under a newton, and the same in coordinates of a map.
#[test]
fn small_loads_far_away_meet_rounding_and_go_on() {
    for (kind, load) in [(AnalysisKind::Static, 1.0), (AnalysisKind::Static, 1e-6), (AnalysisKind::Dynamic, 1e-6)] {
        let tip = |x: f64| {
            let mut m = empty(kind.clone(), 1.0, 0.1);
            m.solution.iteration.tolerance = 1e-8;
            let inertia = [0.1, 0.05, 0.05];
            m.stiffnesses.push(Stiffness::general(2e9, [8e8; 2], 1e6, [1.6e6; 2], 78.0, inertia));
            let (a, b) = (node(&mut m, Vec3::new(x, 0.0, 0.0)), node(&mut m, Vec3::new(x + 3.0, 1.0, 0.5)));
            beam(&mut m, [a, b], 8, 3, Vec3::z(), MassKind::Lumped);
            fix(&mut m, a, 0..6);
            push(&mut m, b, Vec3::new(0.0, load, -load), Vec3::zeros(), false, None);
            let record = run(&m);
            assert_eq!(record.counts.cuts, 0, "{kind:?}, load {load}, at {x}");
            record.last().nodes[b].x - m.nodes[b].x
        };
        let near = tip(0.0);
        // Masses far out would be shaken by the rounding alone.
        for &x in if kind == AnalysisKind::Static { &[1e4, 1e6][..] } else { &[1e4] } {
            // Positions are rounded to 2e-12 and 2e-10; slenderness squared, EA L²/EI = 1e4, is what bending makes of it.
            // Masses do as the rounded forces tell them, which is more than the load.
            let off = (tip(x) - near).norm();
            assert!(
                kind == AnalysisKind::Dynamic || off < 1e4 * f64::EPSILON * x,
                "{kind:?}, load {load}, at {x}: {off:e} of {:e}",
                near.norm()
            );
        }
    }
}
