//! The balance of energies, and the dissipation of a damper against its closed form.

use super::scene::*;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rdsolve::elements::link::LinkLaw;
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{AnalysisKind, History, MassKind, Model, NodalDamping, PrescribedMotion, Restraint};

/// A crane of a slanted column, a jib and a heavy block on a spring, one foot pushed about. Its beams are soft enough for
/// the steps to follow every motion that takes part.
fn crane(time_step: f64, damped: bool) -> Model {
    let mut rng = StdRng::seed_from_u64(41);
    let mut m = empty(AnalysisKind::Dynamic, 2.0, time_step);
    section(&mut m);
    let p = [[0.0, 0.0, 0.0], [0.3, 0.2, 2.0], [1.8, 0.0, 2.5]].map(|x| node(&mut m, Vec3::from(x)));
    beam(&mut m, [p[0], p[1]], 1, 3, Vec3::x(), MassKind::Lumped);
    beam(&mut m, [p[1], p[2]], 1, 3, Vec3::z(), MassKind::Consistent);
    let block = body(&mut m, Vec3::new(2.0, 0.2, 2.4), 10.0, inertia(&mut rng, 2.0));
    attach(&mut m, p[2], block, ALL);
    let hook = node(&mut m, Vec3::new(2.2, 0.3, 2.0));
    attach(&mut m, hook, block, ALL);
    let load = node(&mut m, Vec3::new(2.3, 0.3, 1.2));
    mass(&mut m, load, 2.0, Mat3::zeros());
    spring(&mut m, [hook, load], 60.0, if damped { 1.0 } else { 0.0 });
    let pulse = sine_squared(&mut m, 2.0);
    let motion = PrescribedMotion { amplitude: pulse, scale: 0.2, history: History::Displacement };
    m.constraints.restraints.push(Restraint { node: p[0], dof: 0, motion: Some(motion) });
    fix(&mut m, p[0], 1..6);
    push(&mut m, block, Vec3::new(0.0, 8.0, 0.0), Vec3::new(0.0, 0.0, 3.0), true, Some(pulse));
    m.loading.gravity = Vec3::new(0.0, 0.0, -3.0);
    m.nodes[block].omega = Vec3::new(0.2, 0.5, -0.3);
    if damped {
        m.damping.mass_factor = 0.3;
        m.damping.stiffness_factor = 0.01;
        m.damping.nodal.push(NodalDamping { node: block, translation: 1.0, rotation: 0.5 });
    }
    m
}

/// What the scheme takes, `numerical`, falls as the square of the step, with dampers and without.
#[test]
fn the_balance_closes_to_second_order() {
    for damped in [false, true] {
        let e: Vec<f64> = [0.005, 0.0025, 0.00125]
            .iter()
            .map(|&dt| {
                let record = run(&crane(dt, damped));
                let size = record.energies.iter().map(|e| e.kinetic.max(e.external.abs())).fold(0.0, f64::max);
                if damped {
                    let taken = record.energies.last().expect("shown").damping;
                    assert!(taken > 0.05 * size, "dampers take part: {taken} of {size}");
                }
                record.energies.iter().map(|e| e.numerical.abs()).fold(0.0, f64::max) / size
            })
            .collect();
        eprintln!("damped {damped}: balance {e:?}");
        assert!(order(e[0], e[1]) > 1.7 && order(e[1], e[2]) > 1.8, "damped {damped}: {e:?}");
        assert!(e[2] < 1e-3, "damped {damped}: {e:?}");
    }
}

/// u̇(0) = v₀ on m ü + c u̇ + k u = 0: the damper takes what the oscillator loses, ½ m v₀² − E(t).
#[test]
fn a_damper_takes_what_the_oscillator_loses() {
    let (m0, c, k, v0, end) = (2.0, 1.2, 50.0, 3.0, 2.0f64);
    let errors: Vec<f64> = [0.01, 0.005]
        .iter()
        .map(|&dt| {
            let mut m = empty(AnalysisKind::Dynamic, end, dt);
            let (a, b) = (node(&mut m, Vec3::zeros()), node(&mut m, Vec3::x()));
            fix(&mut m, a, 0..6);
            fix(&mut m, b, 1..3);
            mass(&mut m, b, m0, Mat3::zeros());
            line(&mut m, [a, b], LinkLaw::Linear { stiffness: k, preload: 0.0 }, c, Some(Vec3::x()));
            m.nodes[b].v = Vec3::x() * v0;
            let record = run(&m);
            let taken = record.energies.last().expect("shown").damping;
            let (delta, omega2) = (c / (2.0 * m0), k / m0);
            let w = (omega2 - delta * delta).sqrt();
            let decay = (-delta * end).exp();
            let u = v0 / w * decay * (w * end).sin();
            let v = v0 * decay * ((w * end).cos() - delta / w * (w * end).sin());
            let exact = 0.5 * m0 * v0 * v0 - 0.5 * (m0 * v * v + k * u * u);
            (taken / exact - 1.0).abs()
        })
        .collect();
    eprintln!("damper: {errors:?}");
    // (ωΔt)²/12 of the trapezoidal rule and a period too long by 1e-3 in 1.6 periods.
    assert!(errors[1] < 1e-3 && order(errors[0], errors[1]) > 1.9, "{errors:?}");
}
