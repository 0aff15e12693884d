//! Prescribed motions whose velocity jumps: a step that ends there has the velocity before it, one that begins there that after it.

use crate::support::{read_deck, run, run_source};
use rdsolve::diagnostic::Source;
use rdsolve::solve::Outcome;

const IMPLICIT: [&str; 6] = [
    "scheme = \"newmark\"",
    "scheme = \"wilson-theta\"",
    "scheme = \"hht-alpha\"",
    "scheme = \"generalized-alpha\"",
    "scheme = \"bathe\"",
    "scheme = \"esdirk3\"",
];
const EXPLICIT: [&str; 2] = ["scheme = \"central-difference\"", "scheme = \"runge-kutta\""];

const KINKS: [[f64; 2]; 5] = [[0.0, 0.0], [0.1, 0.02], [0.2, -0.01], [0.4, 0.03], [0.6, 0.0]];
const MASS: f64 = 3.0;
const STIFFNESS: f64 = 1200.0;
const DAMPING: f64 = 20.0;

/// A mass behind a spring and a dashpot, whose other end moves along straight lines.
fn deck(scheme: &str, step: f64) -> String {
    let points: Vec<String> = KINKS.iter().map(|[t, u]| format!("[{t:?}, {u:?}]")).collect();
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.6\ntime_step = {step:?}\n[integrator]\n{scheme}\n[points]\na = [0.0, 0.0, 0.0]\n\
         b = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\nmass = {MASS:?}\n[[links]]\nname = \"k\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\n\
         direction = [1.0, 0.0, 0.0]\nstiffness = {STIFFNESS:?}\ndamping = {DAMPING:?}\n[[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\"]\n\
         motion = {{ ux = {{ amplitude = \"A\" }} }}\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n[amplitudes.A]\nkind = \"table\"\n\
         points = [{}]\n",
        points.join(", ")
    )
}

/// Where the mass is at the end, and the external work: relative to the base, which moves evenly, it vibrates freely.
fn exact() -> [f64; 2] {
    let (decay, square) = (0.5 * DAMPING / MASS, STIFFNESS / MASS);
    let omega = (square - decay * decay).sqrt();
    let (mut x, mut v, mut work) = (0.0, 0.0, 0.0);
    for line in KINKS.windows(2) {
        let ([t, u], [to, next]) = (line[0], line[1]);
        let (speed, span) = ((next - u) / (to - t), to - t);
        let (z, rate) = (x - u, v - speed);
        let motion = |s: f64| {
            let (sin, cos) = (omega * s).sin_cos();
            let b = (rate + decay * z) / omega;
            let at = (-decay * s).exp() * (z * cos + b * sin);
            [at, (-decay * s).exp() * ((b * omega - decay * z) * cos - (z * omega + decay * b) * sin)]
        };
        let [end, end_rate] = motion(span);
        // ∫ (k z + c ż) dt = −m Δż, the force with which the base pulls being its negative.
        work += speed * MASS * (end_rate - rate);
        (x, v) = (next + end, speed + end_rate);
    }
    [x, work]
}

/// The mass, the external work and what is missing of the balance at the end of a run.
fn ending(text: &str, place: &str) -> [f64; 3] {
    let model = read_deck(text);
    let node = crate::support::node(&model, place);
    let start = model.nodes[node].x.x;
    let done = run(&model, &mut |frame| {
        let energy = frame.derived.energy.as_ref().expect("energies");
        vec![frame.state.nodes[node].x.x - start, energy.external, energy.numerical]
    });
    assert!(matches!(done.outcome, Outcome::Done), "{:?}\n{text}", done.outcome);
    done.rows.last().expect("a row")[..].try_into().expect("three numbers")
}

/// A quarter of the step leaves a sixteenth of the error, and less, of the motion and the work: with the velocity after the kink in the step before it a
/// quarter of it was left, whatever the scheme. The bound lies between the two.
#[test]
fn the_order_of_schemes_is_kept_over_kinks() {
    let [x, work] = exact();
    for scheme in IMPLICIT.into_iter().chain(EXPLICIT) {
        let errors = [0.005, 0.0025, 0.00125].map(|step| {
            let [at, external, _] = ending(&deck(scheme, step), "b");
            [(at - x).abs() / 0.03, (external - work).abs() / work]
        });
        for (k, floor) in [(0, 1e-9), (1, 1e-6)] {
            assert!(errors[2][k] <= (0.12 * errors[0][k]).max(floor), "{scheme}: {errors:?}");
        }
    }
}

/// A table that ends with the run ends a motion that lasts: the last state has its velocity, and nothing is missing of the energy.
#[test]
fn a_table_that_ends_with_the_run_ends_no_motion() {
    let text = |scheme: &str, history: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[integrator]\n{scheme}\n[points]\nb = [1.0, 0.0, 0.0]\n[[masses]]\n\
             at = \"b\"\nmass = 2.0\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\nmotion = {{ ux = {{ amplitude = \"A\", history = \"{history}\" }} }}\n\
             [amplitudes.A]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 1.0]]\n"
        )
    };
    for scheme in IMPLICIT.into_iter().chain(EXPLICIT) {
        for (history, reaction, work) in [("displacement", 0.0, 0.0), ("velocity", 2.0, 1.0)] {
            let model = read_deck(&text(scheme, history));
            let done = run(&model, &mut |frame| {
                let energy = frame.derived.energy.as_ref().expect("energies");
                vec![
                    frame.state.nodes[0].v.x,
                    frame.state.reactions.iter().sum(),
                    energy.external,
                    energy.kinetic,
                    energy.numerical,
                ]
            });
            let last = done.rows.last().expect("a row");
            for (found, wanted) in last.iter().zip([1.0, reaction, work, 1.0, 0.0]) {
                // Sums of a hundred steps.
                assert!((found - wanted).abs() < 1e-12, "{scheme} {history}: {last:?}");
            }
        }
    }
}

/// A support that starts and stops pulls the mass that it carries along: the impulse does the work of its kinetic energy.
#[test]
fn the_impulse_of_a_support_does_work() {
    let text = |scheme: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[integrator]\n{scheme}\n[points]\nb = [1.0, 0.0, 0.0]\n[[masses]]\n\
             at = \"b\"\nmass = 2.0\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\nmotion = {{ ux = {{ amplitude = \"A\" }} }}\n\
             [amplitudes.A]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.3, 0.0], [0.8, 1.0], [1.0, 1.0]]\n"
        )
    };
    for scheme in IMPLICIT.into_iter().chain(EXPLICIT) {
        let model = read_deck(&text(scheme));
        let done = run(&model, &mut |frame| {
            let energy = frame.derived.energy.as_ref().expect("energies");
            vec![frame.state.time, energy.kinetic, energy.external, energy.numerical]
        });
        for row in &done.rows {
            // ½ m v² = 4 J at 2 m/s, up to the step that ends at the kink.
            let kinetic = if row[0] > 0.305 && row[0] < 0.805 { 4.0 } else { 0.0 };
            assert!((row[1] - kinetic).abs() < 1e-9 && row[3].abs() < 1e-9, "{scheme}: {row:?}");
        }
    }
}

/// The work with which a spring is drawn, where the pull ends with the run.
#[test]
fn what_draws_a_spring_does_its_work() {
    let text = |scheme: &str, step: f64| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 0.2\ntime_step = {step:?}\n[integrator]\n{scheme}\n[points]\na = [0.0, 0.0, 0.0]\n\
             b = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\nmass = 0.001\n[[links]]\nname = \"k\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\n\
             direction = [1.0, 0.0, 0.0]\nstiffness = 100.0\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[supports]]\nat = \"b\"\n\
             fix = [\"uy\", \"uz\"]\nmotion = {{ ux = {{ amplitude = \"A\" }} }}\n[amplitudes.A]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.2, 0.1]]\n"
        )
    };
    for scheme in IMPLICIT {
        for step in [0.02, 0.01] {
            let [_, external, _] = ending(&text(scheme, step), "b");
            // The force is linear in time, which all of these schemes integrate.
            assert!((external - 0.5).abs() < 1e-9, "{scheme} {step}: {external}");
        }
    }
}

/// Stages that part where the velocity jumps are the run in one piece: motion, work and the impulse of the support, whether the stages are alike or a
/// load that nothing feels comes with one of them.
#[test]
fn stages_that_part_at_kinks_go_on_over_them() {
    for scheme in IMPLICIT.into_iter().chain(EXPLICIT) {
        let whole = deck(scheme, 0.0025) + "[[masses]]\nat = \"a\"\nmass = 2.0\n";
        let [x, external, numerical] = ending(&whole, "b");
        let stage = |(k, duration): (usize, f64)| {
            format!("[[stages]]\nname = \"s{k}\"\nkind = \"dynamic\"\nduration = {duration:?}\ntime_step = 0.0025\n")
        };
        let stages: String = [0.1, 0.1, 0.2, 0.2].into_iter().enumerate().map(stage).collect();
        let parted =
            whole.replace("[analysis]\nkind = \"dynamic\"\nend_time = 0.6\ntime_step = 0.0025\n", "") + &stages;
        for load in ["", "[[loads]]\nat = \"b\"\nforce = [0.0, 1.0, 0.0]\nstages = \"s1\"\n"] {
            let source = Source::new("stages.toml", parted.clone() + load, &[]);
            let done = run_source(&source, &mut |frame| {
                let energy = frame.derived.energy.as_ref().expect("energies");
                let node = frame.model.nodes.iter().position(|node| node.label == "b").expect("the mass");
                vec![frame.state.nodes[node].x.x - 1.0, energy.external, energy.numerical]
            });
            assert!(matches!(done.outcome, Outcome::Done), "{scheme} {load}: {:?}", done.outcome);
            let last = done.rows.last().expect("a row");
            // The iteration, of 0.03 m and some J.
            for (got, wanted) in last.iter().zip([x, external, numerical]) {
                assert!((got - wanted).abs() < 1e-9, "{scheme} {load}: {last:?} for {:?}", [x, external, numerical]);
            }
        }
    }
}

/// A sine squared that ends with a whole wave is at rest there, up to rounding, and no jump of a velocity is told.
#[test]
fn a_whole_wave_ends_without_a_jump() {
    let wave = |w: f64, end: f64| rdsolve::amplitude::Amplitude::SineSquared { angular_frequency: w, start: 0.0, end };
    assert!(wave(std::f64::consts::PI / 0.9, 0.9).slope_jumps().is_empty());
    assert_eq!(wave(std::f64::consts::PI / 0.9, 0.8).slope_jumps(), [0.8]);
}
