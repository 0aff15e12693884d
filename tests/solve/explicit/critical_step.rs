//! How long steps may be: the limit of stability, steps of automatic length, and what a step costs.

use super::scenes::{AUTO, dynamic, row_of_masses, steps_of_row};
use super::{CENTRAL, EIGHT, FIVE, Probe, deck, place_of, scene, two_bodies};
use crate::support::{Done, error, node, position, reference, run_to_the_end};
use rdsolve::model::{Cadence, Model};
use rdsolve::plan::Plan;
use rdsolve::solve::{Run, Wanted};
use rdsolve::system::System;
use rdsolve::system::energy::Energy;
use std::sync::atomic::AtomicBool;

/// Of a mode with ω² = κ and a damper γ: ¼ κ Δt² + γ Δt = 1.
fn longest(stiffness: f64, damping: f64) -> f64 {
    2.0 / (damping + (damping * damping + stiffness).sqrt())
}

/// Steps are 0.8 of 2/ω of the fastest mode, which a row of masses has in closed form: ω² = 4 k/m sin²(π (2n − 1)/(4 n + 2)).
#[test]
fn automatic_steps_are_a_part_of_the_limit() {
    // A fiftieth of it is no limit then.
    let long = ["analysis.end_time=20.0", "output.interval=20.0"];
    for count in [1usize, 2, 5, 12] {
        let n = count as f64;
        let omega = 2.0 * 50f64.sqrt() * (std::f64::consts::PI * (2.0 * n - 1.0) / (4.0 * n + 2.0)).sin();
        let model = scene(&row_of_masses(count, 0.0), &long);
        let done = run_to_the_end(&model, &mut |_| Vec::new());
        let expected = 20.0 / (0.8 * 2.0 / omega);
        println!("{count}: {} steps, {expected:.2} expected", done.counts.steps);
        // A whole number of steps; power iteration leaves half a per cent.
        let steps = done.counts.steps as f64;
        assert!(steps > 0.995 * expected - 1.0 && steps < expected + 1.0, "{count}: {steps} {expected}");
    }
    // One mass with a damper of 30: ¼ κ Δt² + γ Δt = 1, κ = 50, γ = 15.
    let limit = longest(50.0, 15.0);
    let model = scene(&row_of_masses(1, 30.0), &long);
    let done = run_to_the_end(&model, &mut |_| Vec::new());
    let expected = (20.0 / (0.8 * limit)).ceil();
    assert_eq!(done.counts.steps as f64, expected, "limit {limit}, {} cuts", done.counts.cuts);
}

/// Just below ω Δt = 2 a free oscillator goes on for ever; just above, no step is taken as it is asked for.
#[test]
fn steps_beyond_the_limit_are_cut() {
    // ω² = 50.
    let limit = 2.0 / 50f64.sqrt();
    let run = |part: f64| -> Done {
        let [step, end] = [1.0, 2000.0].map(|steps| steps * part * limit);
        let sets = [format!("analysis.time_step={step}"), format!("analysis.end_time={end}")];
        let model = steps_of_row(1, 0.0, &sets.each_ref().map(String::as_str));
        let mass = node(&model, "p1");
        run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[mass].x.x - 1.0])
    };
    let below = run(0.999);
    assert_eq!(below.counts.cuts, 0);
    // The amplitude is v/ω / √(1 − (ωΔt/2)²) = 0.141/0.045.
    assert!(below.rows.iter().all(|row| row[0].abs() < 3.2), "{:?}", below.rows);
    let above = run(1.001);
    assert!(above.counts.cuts > 1000);
    // At half the limit: 0.141/0.866.
    assert!(above.rows.iter().all(|row| row[0].abs() < 0.164), "{:?}", above.rows);
}

/// What a scene that stiffens on its way does to steps that were short enough: they are cut, and energy is kept.
#[test]
fn steps_follow_a_scene_that_stiffens() {
    let text = dynamic("20.0", "0.05", "central-difference")
        + r#"[points]
ball = [0.0, 0.0, 0.0]

[[masses]]
at = "ball"
mass = 1.0

[[links]]
name = "soft"
from = { ground = [-1.0, 0.0, 0.0] }
to = { node = "ball" }
stiffness = 1.0
direction = [1.0, 0.0, 0.0]

[[links]]
name = "stop"
from = { node = "ball" }
to = { ground = [3.0, 0.0, 0.0] }
law = "table"
points = [[-3.0, -6e3], [-1.0, 0.0], [0.0, 0.0]]
direction = [1.0, 0.0, 0.0]

[[initial]]
at = "ball"
velocity = [2.0, 0.0, 0.0]
"#;
    let model = scene(&text, &[]);
    let system = System::new(&model).unwrap();
    let mut totals = Vec::new();
    let done = run_to_the_end(&model, &mut |frame| {
        let energy = Energy::of(&system, frame.state, None, 1);
        totals.push(energy.mechanical);
        vec![energy.mechanical]
    });
    println!("{} cuts, energy {:?} to {:?}", done.counts.cuts, totals[0], totals[totals.len() - 1]);
    // The stop has ω = 54.8: a step of 0.05 is 2.7 of it.
    assert!(done.counts.cuts > 0);
    // What an unstable step makes grows without bound: ten thousand times as much in this run. At half the step, 1.4 rad of the
    // stop, energies of central differences swing by 1/(1 − (ω Δt)²/4) = 1.9 in an oscillation by themselves.
    assert!(totals.iter().all(|total| (0.5..1.9).contains(&(total / totals[0]))), "{totals:?}");
}

/// The whole error stays below what is allowed, relative to the largest motion.
#[test]
fn automatic_steps_keep_their_error() {
    type Case = (&'static str, fn(&Model) -> Probe, f64);
    let cases: [Case; 2] = [
        ("two_bodies_on_springs", |model| two_bodies(model), 0.025),
        ("heavy_top/pivot", |model| place_of("top")(model), 0.01),
    ];
    for (name, probe, interval) in cases {
        let exact = reference(name);
        for scheme in [EIGHT, FIVE] {
            let mut last = usize::MAX;
            for tolerance in [1e-6, 1e-4, 1e-2] {
                let interval = format!("output.interval={interval}");
                let tolerated = format!("analysis.error_tolerance={tolerance}");
                let sets = [scheme, "analysis.time_step=\"auto\"", &tolerated, &interval];
                let model = deck(name, &sets);
                let done = run_to_the_end(&model, &mut probe(&model));
                let off = error(&done.rows, &exact, 0);
                println!("{name} {scheme} {tolerance:.0e}: {off:.2e} in {} steps", done.counts.steps);
                // Quantities here include velocities of turning at 5 % of the reach; errors of a chaotic top grow on their way.
                assert!(off < 2.0 * tolerance, "{off}");
                assert!(done.counts.steps <= last);
                last = done.counts.steps;
            }
        }
    }
}

/// Nothing is factorised but once, for the start.
#[test]
fn steps_factorise_nothing() {
    for name in ["two_bodies_on_springs", "heavy_top/pivot", "four_bar"] {
        for scheme in [CENTRAL, EIGHT] {
            let model = deck(name, &[scheme, "analysis.end_time=0.1"]);
            let system = System::new(&model).unwrap();
            let plan = Plan::new(&model, &system, 1);
            let stop = AtomicBool::new(false);
            let mut run = Run::new(&model, &system, &plan, Wanted::default(), &stop).unwrap();
            run.run(&mut ());
            assert_eq!(run.counts().factorizations, 1, "{name}");
        }
    }
}

/// A damper at one end of a row of masses, a stiff link near the other: whichever asks for the shorter step has it from the
/// first step on.
#[test]
fn dampers_do_not_hide_what_is_stiff() {
    let row = |damping: f64| {
        let link = |stiffness: &str| {
            format!("from = {{ node = \"p50\" }}\nto = {{ node = \"p51\" }}\nstiffness = {stiffness}\n")
        };
        row_of_masses(60, damping).replace(&link("100.0"), &link("10000.0")).replace("interval = 2.0", "every = 1")
    };
    let steps = |text: &str| -> Vec<f64> {
        let done = run_to_the_end(&scene(text, &[]), &mut |frame| vec![frame.dt]);
        done.rows.into_iter().skip(1).map(|row| row[0]).collect()
    };
    // Two masses against each other, each held by a spring besides; a mass at the damper, between springs. Neighbours that
    // give way change κ by a part of about k/κ m of it, which is 1e-4.
    let stiff = 0.8 * longest(2.0 * 5000.0 + 50.0, 0.0);
    let damped = 0.8 * longest(100.0, 500.0 / 2.0);
    for (damping, expected) in [(0.0, stiff), (5.0, stiff), (500.0, damped)] {
        let steps = steps(&row(damping));
        println!("{damping}: first {:.5}, of {expected:.5}", steps[0]);
        // A whole number of steps, and half a per cent that power iteration leaves.
        assert!(steps.iter().all(|step| (0.97..1.005).contains(&(step / expected))), "{damping}: {steps:?}");
    }
}

/// A bar of a thousand elements that is struck at its end until it yields: steps stay below h/c of what is elastic.
#[test]
fn steps_of_steel_that_yields_are_those_of_elastic_steel() {
    let count = 1000;
    let mut text = dynamic("4e-5", AUTO, "central-difference");
    text += "[materials.steel]\nmodel = \"elastic-plastic\"\nyield_stress = 200e6\n\
         youngs_modulus = 200e9\ndensity = 7800.0\n[output]\nevery = 1\n[points]\n";
    (0..=count).for_each(|k| text += &format!("p{k} = [{}, 0.0, 0.0]\n", f64::from(k) / f64::from(count)));
    let points: Vec<String> = (0..=count).map(|k| format!("\"p{k}\"")).collect();
    text += &format!(
        "[[bars]]\nname = \"bar\"\npath = [{}]\nmaterial = \"steel\"\narea = 1e-4\nmass = \"lumped\"\n\
         [[supports]]\nat = \"p0\"\nfix = \"all\"\n[[supports]]\nat = [{}]\nfix = [\"uy\", \"uz\"]\n\
         [[initial]]\nat = \"p{count}\"\nvelocity = [10.0, 0.0, 0.0]\n",
        points.join(", "),
        points[1..].join(", "),
    );
    let limit = (7800.0 / 200e9_f64).sqrt() / f64::from(count);
    let mut plastic = 0.0;
    let done = run_to_the_end(&scene(&text, &[]), &mut |frame| {
        plastic = frame.derived.energy.unwrap().plastic;
        vec![frame.dt / limit]
    });
    let steps: Vec<f64> = done.rows.into_iter().skip(1).map(|row| row[0]).collect();
    let most = steps.iter().copied().fold(0.0, f64::max);
    println!("{} steps, first {:.3} of the limit, longest {most:.3}", steps.len(), steps[0]);
    assert!(plastic > 0.0);
    // 0.8, and what power iteration leaves of the many modes near the fastest.
    assert!(steps[0] > 0.79 && most < 0.85, "{} {most}", steps[0]);
}

/// A mass that only a load moves bears any step: it has a fiftieth of the run.
#[test]
fn what_nothing_resists_is_followed_all_the_same() {
    let text = dynamic("10.0", AUTO, "central-difference")
        + r#"[points]
p = [0.0, 0.0, 0.0]

[[masses]]
at = "p"
mass = 1.0

[[loads]]
at = "p"
force = [1.0, 0.0, 0.0]
amplitude = "s"

[amplitudes.s]
kind = "sine"
frequency = 1.0

[output]
interval = 10.0
"#;
    let model = scene(&text, &[]);
    let done = run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[0].x.x]);
    assert_eq!(done.counts.steps, 50);
    // t/2π but for a trapezoidal rule of five steps a period: the mean velocity is ½ Δt cot(π/5). To rounding of 50 steps.
    let expected = 10.0 * 0.1 / (std::f64::consts::PI / 5.0).tan();
    let found = done.rows[1][0];
    assert!((found - expected).abs() < 1e-12, "{found}, expected {expected}");
}

/// Nothing stiff limits tops and mechanisms: automatic steps turn no body by more than 0.05 rad, but for what its acceleration
/// grows by in a step: a seventh in the mechanism.
#[test]
fn automatic_steps_turn_bodies_by_little() {
    // Steps of three quarters of a radian, a fiftieth of the run, had the top fall over with more energy than there was, and put the
    // mechanism, done, 2e-3 beside its place. Published ends; errors of second order at 0.05 rad over 48 turns, and over 10.
    for (name, label, expected, allowed) in [
        ("heavy_top", "centre_of_mass", [-0.150416823, -0.724165592, -0.67302227], 3e-3),
        ("andrews_squeezer", "F", [-0.00696303942622, -0.000718388438694, 0.0], 5e-5),
    ] {
        let mut model = deck(name, &[CENTRAL, "analysis.time_step=\"auto\""]);
        model.output.cadence = Cadence::Steps(1);
        let at = node(&model, label);
        let mut turn = 0.0f64;
        let done = run_to_the_end(&model, &mut |frame| {
            let nodes = &frame.state.nodes;
            let rate = model.bodies.iter().map(|body| nodes[body.node].omega.norm()).fold(0.0, f64::max);
            turn = turn.max(rate * frame.dt);
            position(&nodes[at]).to_vec()
        });
        let last = done.rows.last().unwrap();
        let off = last.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
        println!("{name}: {turn:.4} rad a step, {off:.1e} off, {} steps", done.counts.steps);
        assert!(turn < 0.06, "{name}: {turn}");
        assert!(off < allowed, "{name}: {off}");
    }
}
