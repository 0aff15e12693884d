//! Output inside the steps of Runge-Kutta schemes: steps find their own ends, and what is written between them is as exact.

use crate::support::{Done, error, read, read_deck, run_to_the_end};
use rdsolve::model::Model;
use rdsolve::solve::Frame;

type Probe = fn(&Model, &Frame) -> Vec<f64>;

const IMPLICIT: &str = "integrator={scheme=\"esdirk3\"}";
const EXPLICIT: [&str; 2] = ["integrator={scheme=\"runge-kutta\"}", "integrator={scheme=\"runge-kutta\",order=5}"];

fn run(scheme: &str, (deck, end): (&str, f64), rows: usize, step: &str, others: &[&str], probe: Probe) -> Done {
    let own = [
        "expect=[]".to_owned(),
        scheme.to_owned(),
        format!("analysis={{kind=\"dynamic\",end_time={end:?},{step}}}"),
        format!("output.interval={:?}", end / rows as f64),
        "output.reactions=true".to_owned(),
        "output.energy=true".to_owned(),
    ];
    let sets: Vec<String> = own.into_iter().chain(others.iter().map(|set| (*set).to_owned())).collect();
    let model = read(deck, &sets);
    run_to_the_end(&model, &mut |frame| probe(&model, frame))
}

fn displacements(model: &Model, frame: &Frame) -> Vec<f64> {
    frame
        .state
        .nodes
        .iter()
        .zip(&model.nodes)
        .flat_map(|(node, start)| <[f64; 3]>::from(node.moved(&start.x)))
        .collect()
}

fn velocities(_: &Model, frame: &Frame) -> Vec<f64> {
    frame.state.nodes.iter().flat_map(|node| <[f64; 3]>::from(node.v)).collect()
}

fn accelerations(_: &Model, frame: &Frame) -> Vec<f64> {
    frame.state.nodes.iter().flat_map(|node| <[f64; 3]>::from(node.a)).collect()
}

fn reactions(_: &Model, frame: &Frame) -> Vec<f64> {
    frame.reactions.to_vec()
}

fn energies(_: &Model, frame: &Frame) -> Vec<f64> {
    let energy = frame.derived.energy.as_ref().expect("energies");
    vec![energy.kinetic, energy.strain + energy.links, energy.external, energy.damping, energy.mechanical]
}

/// Many rows in few steps, against steps that end at every row and are as long in the mean: the errors of motion, of reactions and of
/// energies inside are no larger than 1.5 times those at the ends of the others, or of what was asked for. Axial stiffness of the beam is
/// such that a polynomial alone, without equilibrium, would leave forces of a hundred times the true ones.
#[test]
fn what_is_inside_steps_is_as_exact_as_their_ends() {
    let probes: [(&str, Probe); 4] = [
        ("displacements", displacements),
        ("velocities", velocities),
        ("reactions", reactions),
        ("energies", energies),
    ];
    let beam: &[&str] = &["beams.legs.elements=1", "beams.legs.order=3"];
    let scenes: [(&str, f64, &[&str]); 3] =
        [("two_bodies_on_springs", 2.0, &[]), ("right_angle_cantilever", 4.0, beam), ("heavy_top/pivot", 0.5, &[])];
    let asked = 1e-3;
    for (deck, end, others) in scenes {
        for (what, probe) in probes {
            let of = |rows: usize, step: &str| run(IMPLICIT, (deck, end), rows, step, others, probe);
            let reference = of(240, &format!("time_step={:?}", end / 240.0 / 32.0)).rows;
            if reference[0].is_empty() {
                continue; // nothing is held
            }
            let free = of(240, &format!("time_step=\"auto\",error_tolerance={asked}"));
            let steps = free.counts.steps.next_multiple_of(240).min(240);
            let landing = of(240, &format!("time_step={:?}", end / steps as f64));
            let (inside, ends) = (error(&free.rows, &reference, 1), error(&landing.rows, &reference, 1));
            println!("{deck}, {what}: {} steps, {inside:.1e} inside, {ends:.1e} at {steps} ends", free.counts.steps);
            assert!(inside < 1.5 * ends.max(asked), "{deck}, {what}: {inside:e} and {ends:e}");
        }
    }
}

/// The same for explicit schemes, whose steps are several times as long as the time between two rows: bodies on springs, a top on its
/// pivot, and an arm whose joints are driven. Without forces in the output, accelerations are those of the polynomial, by one order less.
#[test]
fn what_is_inside_explicit_steps_is_as_exact() {
    let probes: [(&str, Probe); 5] = [
        ("displacements", displacements),
        ("velocities", velocities),
        ("accelerations", accelerations),
        ("reactions", reactions),
        ("energies", energies),
    ];
    let asked = 1e-5;
    for (scheme, rows) in EXPLICIT.into_iter().zip([300, 600]) {
        for (deck, end) in [("two_bodies_on_springs", 1.0), ("heavy_top/pivot", 0.1), ("robot_arm", 1.0)] {
            for (what, probe) in probes {
                let of =
                    |scheme: &str, step: &str, others: &[&str]| run(scheme, (deck, end), rows, step, others, probe);
                let reference = of(EXPLICIT[0], &format!("time_step={:?}", end / 1200.0), &[]).rows;
                if reference[0].is_empty() {
                    continue; // nothing is held
                }
                let auto = format!("time_step=\"auto\",error_tolerance={asked}");
                let free = of(scheme, &auto, &[]);
                let inside = error(&free.rows, &reference, 1);
                println!("{deck}, {what}: {} steps, {inside:.1e}", free.counts.steps);
                assert!(free.counts.steps < rows, "{deck}: {} steps", free.counts.steps);
                assert!(inside < asked, "{deck}, {what}: {inside:e}");
                if what == "accelerations" {
                    let bare = of(scheme, &auto, &["output.reactions=false", "output.energy=false"]);
                    let inside = error(&bare.rows, &reference, 1);
                    println!("{deck}, {what} of the polynomial: {inside:.1e}");
                    assert!(inside < 3.0 * asked, "{deck}, {what} of the polynomial: {inside:e}");
                }
            }
        }
    }
}

/// Explicit steps are the same to the last bit whatever is written inside them; with contacts they end at the times that are written.
#[test]
fn output_does_not_change_explicit_steps() {
    for scheme in EXPLICIT {
        for (deck, end) in [("two_bodies_on_springs", 2.0), ("heavy_top/pivot", 0.5)] {
            let of = |rows: usize| {
                run(scheme, (deck, end), rows, "time_step=\"auto\",error_tolerance=1e-3", &[], displacements)
            };
            // Halves are exact, so the times of both have the same digits.
            let (few, many) = (of(16), of(512));
            assert_eq!(few.counts.steps, many.counts.steps, "{deck}");
            for (row, same) in few.rows.iter().zip(many.rows.iter().step_by(32)) {
                assert_eq!(row, same, "{deck}");
            }
        }
    }
}

/// Steps do not get shorter by what is written: the same steps with 16 rows as with 400, and the same motion at times of both.
#[test]
fn output_does_not_shorten_steps() {
    let of = |rows: usize| {
        let step = "time_step=\"auto\",error_tolerance=1e-3";
        run(IMPLICIT, ("two_bodies_on_springs", 2.0), rows, step, &[], displacements)
    };
    let (few, many) = (of(16), of(400));
    assert_eq!(few.counts.steps, many.counts.steps);
    // Each time inside takes one iteration, or two.
    let more = (many.counts.iterations - few.counts.iterations) as f64 / 384.0;
    assert!(more < 2.0, "{more}");
    for (row, same) in few.rows.iter().zip(many.rows.iter().step_by(25)) {
        // Iterations inside begin from the matrix at hand, which another time inside may have renewed.
        assert!(row.iter().zip(same).all(|(a, b)| (a - b).abs() < 1e-5), "{row:?} {same:?}");
    }
}

/// Loads that jump are met all the same, and the values that a deck expects at a time inside a step are those of that time: a mass under
/// a force that is switched on and off, (t - 1)² and then a straight line.
#[test]
fn jumps_end_steps_and_expected_times_do_not() {
    for scheme in ["esdirk3", "runge-kutta"] {
        jumps_end_steps(scheme);
    }
}

fn jumps_end_steps(scheme: &str) {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 3.0, time_step = "auto", error_tolerance = 1e-4 }
        integrator = { scheme = "SCHEME" }
        points = { p = [0.0, 0.0, 0.0] }
        masses = [{ at = "p", mass = 2.0 }]
        loads = [{ at = "p", force = [4.0, 0.0, 0.0], amplitude = "switched" }]
        output = { interval = 0.37 }
        [amplitudes.switched]
        kind = "step"
        start = 1.0
        end = 2.5
        [[expect]]
        at = "p"
        quantity = "ux"
        time = 1.613
        value = 0.375769
        absolute_tolerance = 1e-9
        [[expect]]
        at = "p"
        quantity = "vx"
        time = 1.71
        value = 1.42
        absolute_tolerance = 1e-9
        "#;
    let model = read_deck(&text.replace("SCHEME", scheme));
    let done = run_to_the_end(&model, &mut |frame| vec![frame.state.time, frame.state.nodes[0].x.x]);
    for row in &done.rows {
        let (t, x) = (row[0], row[1]);
        let exact = match t {
            t if t <= 1.0 => 0.0,
            t if t <= 2.5 => (t - 1.0).powi(2),
            t => 2.25 + 3.0 * (t - 2.5),
        };
        // A parabola is met to rounding of the equilibrium.
        assert!((x - exact).abs() < 1e-9, "{t}: {x} {exact}");
    }
    assert!(done.verdicts.iter().all(|verdict| verdict.reason.is_none()), "{:?}", done.verdicts);
}
