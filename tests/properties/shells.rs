//! Shells with bodies: free flight, the balance of energies, scenes that turn.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, MassKind, Model};
use rdsolve::system::energy::Energy;

/// A sheet of quadrilaterals whose edge rides on a block, triangles on its other side; soft enough for the steps to follow.
fn flier(time_step: f64, mass: MassKind) -> Model {
    let mut m = empty(AnalysisKind::Dynamic, 1.0, time_step);
    let (x, y) = (Vec3::x(), Vec3::y());
    let sheet = shell(&mut m, [0.3 * x, 1.3 * x, 0.3 * x + y], [3, 2], 4, mass);
    let flap = shell(&mut m, [-1.3 * x, -0.3 * x, -1.3 * x + y], [2, 2], 3, mass);
    let block = body(&mut m, Vec3::new(0.0, 0.5, 0.1), 2.0, inertia(&mut StdRng::seed_from_u64(91), 0.3));
    for n in [sheet[0], sheet[4], sheet[8], flap[2], flap[5], flap[8]] {
        attach(&mut m, n, block, ALL);
    }
    for n in &mut m.nodes {
        let omega = Vec3::new(0.3, 1.0, -0.5);
        (n.v, n.omega) = (omega.cross(&n.x) + Vec3::new(0.2, -0.1, 0.3), omega);
    }
    m
}

/// Free flight: what is conserved stays to second order of the step, as Wilson-θ has it for whatever rides on a body that turns.
#[test]
fn free_flight() {
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        let errors: Vec<[f64; 3]> = [0.005, 0.0025]
            .iter()
            .map(|&dt| {
                let record = run(&flier(dt, mass));
                let (first, last) = (record.energies[0], record.energies.last().unwrap());
                assert!(last.strain > 1e-3 * last.kinetic, "it deforms: {last:?}");
                let most = |of: &dyn Fn(&Energy) -> f64| record.energies.iter().map(of).fold(0.0, f64::max);
                let (p, l) = (first.p.norm(), first.l.norm());
                [
                    most(&|e| (e.p - first.p).norm()) / p,
                    most(&|e| (e.l - first.l).norm()) / l,
                    most(&|e| e.numerical.abs()) / last.mechanical,
                ]
            })
            .collect();
        eprintln!("{mass:?}: momentum, angular momentum, energy {errors:?}");
        for k in 0..3 {
            assert!(order(errors[0][k], errors[1][k]) > 1.7, "{mass:?}: {errors:?}");
            assert!(errors[1][k] < 1e-2, "{mass:?}: {errors:?}");
        }
    }
}

/// The same blown upon by a pressure that follows, and damped by mass and stiffness: the account of work and dissipation closes
/// to second order of the step.
#[test]
fn the_balance_closes_with_damping_and_pressure() {
    let e: Vec<f64> = [0.01, 0.005]
        .iter()
        .map(|&dt| {
            let mut m = flier(dt, MassKind::Lumped);
            let pulse = sine_squared(&mut m, 3.0);
            press(&mut m, 2.0, Some(pulse));
            m.damping.mass_factor = 0.2;
            m.damping.stiffness_factor = 0.005;
            let record = run(&m);
            let last = record.energies.last().unwrap();
            assert!(last.damping > 0.05 * last.kinetic && last.external.abs() > 0.05 * last.kinetic, "{last:?}");
            record.energies.iter().map(|e| e.numerical.abs()).fold(0.0, f64::max) / last.mechanical
        })
        .collect();
    eprintln!("balance {e:?}");
    assert!(order(e[0], e[1]) > 1.7 && e[1] < 1e-2, "{e:?}");
}

/// The scene turned and moved: the answer turned and moved. Bound: rounding, grown by iterations and 100 steps.
#[test]
fn answers_turn_with_the_scene() {
    let mut rng = StdRng::seed_from_u64(92);
    let mut m = flier(0.01, MassKind::Consistent);
    let pulse = sine_squared(&mut m, 3.0);
    press(&mut m, 2.0, Some(pulse));
    let (q, shift) = (turn(&mut rng), vector(&mut rng, 3.0));
    let R: Mat3 = rdsolve::math::rotation::matrix(&q);
    let mut there = turned(&m, &q, &shift);
    // `turned` turns velocities about the origin; they were given there.
    there.analysis.end_time = 0.5;
    m.analysis.end_time = 0.5;
    let (here, there) = (run(&m), run(&there));
    for (a, b) in here.last().nodes.iter().zip(&there.last().nodes) {
        assert!((R * a.x + shift - b.x).norm() < 1e-8, "{} {}", R * a.x + shift, b.x);
    }
}
