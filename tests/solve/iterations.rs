//! The number of corrections that an equilibrium takes.

use crate::support::{node, position, read, read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// Automatic steps of a slender frame that are long for it, a fiftieth of the run: stages converge in three to four corrections each.
/// Without the stresses extrapolated from the iterate before, these take 7.5.
#[test]
fn long_steps_of_slender_beams() {
    let sets = [
        "expect=[]",
        "integrator={scheme=\"esdirk3\"}",
        "analysis={kind=\"dynamic\",end_time=30.0,time_step=\"auto\",error_tolerance=1e-2}",
        "beams.legs.elements=1",
        "beams.legs.order=4",
        "output={every=1}",
    ];
    let model = read("right_angle_cantilever", &sets.map(str::to_owned));
    let done = run_to_the_end(&model, &mut |_| Vec::new());
    let stages = 4.0 * done.counts.steps as f64;
    let each = done.counts.iterations as f64 / stages;
    println!("{each:.2} corrections a stage, {:?}", done.counts);
    assert!(each < 4.5, "{each} {:?}", done.counts);
}

/// Iterations a step, and the motion of these nodes, with the iteration of the deck and as many elements as it has.
fn steps_of(deck: &str, labels: &[&str], sets: &[&str]) -> (f64, Vec<Vec<f64>>) {
    let mut given = vec!["expect=[]".to_owned()];
    given.extend(sets.iter().map(|set| (*set).to_owned()));
    let model = read(deck, &given);
    let nodes: Vec<usize> = labels.iter().map(|label| node(&model, label)).collect();
    let mut probe = |frame: &Frame| nodes.iter().flat_map(|&node| position(&frame.state.nodes[node])).collect();
    let done = run_to_the_end(&model, &mut probe);
    (done.counts.iterations as f64 / done.counts.steps as f64, done.rows)
}

fn distance(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Equal steps are iterated to a part of their own error: what the iteration leaves is a tenth of what the steps leave at the most,
/// a hundredth being asked for in each step alone, and two to three corrections do.
#[test]
fn equal_steps_end_with_a_part_of_their_own_error() {
    for (deck, labels, dt, end, most) in [
        ("flying_beam", ["a", "b"], 0.0125, 5.0, 2.7),
        ("right_angle_cantilever", ["elbow", "tip"], 0.0375, 15.0, 3.0),
        ("spherical_cap/elastic", ["apex", "half"], 2.5e-6, 4e-4, 2.2),
    ] {
        let run = |division: f64, tolerance: &[&str]| {
            let step = format!("analysis.time_step={:e}", dt / division);
            let (end, every) = (format!("analysis.end_time={end:e}"), format!("output.interval={:e}", 8.0 * dt));
            steps_of(deck, &labels, &[&[step.as_str(), &end, &every], tolerance].concat())
        };
        let tight = ["iteration.tolerance=1e-10"];
        let ((iterations, motion), (more, exact), (_, finer)) = (run(1.0, &[]), run(1.0, &tight), run(2.0, &tight));
        // A half of the step leaves a quarter of the error.
        let (of_iteration, of_steps) = (distance(&motion, &exact), 4.0 / 3.0 * distance(&exact, &finer));
        println!("{deck}: {iterations:.2} of {more:.2} iterations, {of_iteration:.2e} beside {of_steps:.2e}");
        assert!(iterations < most && of_iteration < 0.1 * of_steps, "{deck}: {iterations} {of_iteration} {of_steps}");
    }
}

/// Schemes that keep energy are iterated to the digits of the default.
#[test]
fn the_trapezoidal_rule_keeps_its_iteration() {
    let newmark = "integrator={scheme=\"newmark\"}";
    let run = |sets: &[&str]| steps_of("flying_beam", &["a"], &[&[newmark, "analysis.end_time=1.0"], sets].concat());
    assert_eq!(run(&[]), run(&["iteration.tolerance=1e-8"]));
}

/// A coarse tolerance of the deck ends no iteration before the step's own error does, whatever the scheme: what it leaves is a tenth of the error of
/// the steps at the most, and was up to ninety times that error. Dissipation decides what is the default, and not what may be asked for.
#[test]
fn a_coarse_tolerance_is_a_ceiling() {
    let legs = "beams.legs.elements=2";
    for (deck, labels, scheme, dt, end, other) in [
        ("right_angle_cantilever", &["elbow", "tip"][..], "wilson-theta", 0.03, 6.0, legs),
        ("right_angle_cantilever", &["elbow", "tip"], "newmark", 0.03, 6.0, legs),
        ("right_angle_cantilever", &["elbow", "tip"], "bathe", 0.03, 3.0, legs),
        ("right_angle_cantilever", &["elbow", "tip"], "esdirk3", 0.03, 3.0, legs),
        ("flying_beam", &["a", "b"], "wilson-theta", 0.0125, 3.0, "expect=[]"),
        ("two_bodies_on_springs", &["a"], "newmark", 0.005, 0.5, "expect=[]"),
        ("two_bodies_on_springs", &["a"], "generalized-alpha", 0.005, 0.5, "expect=[]"),
    ] {
        let run = |division: f64, tolerance: &str| {
            let step = format!("analysis.time_step={:e}", dt / division);
            let (end, every) = (format!("analysis.end_time={end:e}"), format!("output.interval={:e}", end / 20.0));
            let scheme = format!("integrator={{scheme=\"{scheme}\"}}");
            steps_of(deck, labels, &[other, &step, &end, &every, &scheme, tolerance])
        };
        let ((iterations, motion), (more, exact)) =
            (run(1.0, "iteration.tolerance=1e-2"), run(1.0, "iteration.tolerance=1e-11"));
        let (_, finer) = run(2.0, "iteration.tolerance=1e-11");
        let (of_iteration, of_steps) = (distance(&motion, &exact), 4.0 / 3.0 * distance(&exact, &finer));
        println!(
            "{deck} {scheme}: {iterations:.2} of {more:.2} iterations, {:.1e} of the error",
            of_iteration / of_steps
        );
        assert!(iterations < more && of_iteration < 0.1 * of_steps, "{deck} {scheme}: {of_iteration} {of_steps}");
    }
}

/// A sheet clamped at one edge, struck so that it turns by radians in steps that hardly resolve it. Old matrices mislead there.
const STRUCK_SHEET: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.02
time_step = 5e-4
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = 8
thickness = 0.002
material = "steel"
[[supports]]
at = "sheet.edge1"
fix = "all"
[[loads]]
at = "sheet"
pressure = 2e5
amplitude = "blow"
[amplitudes.blow]
kind = "sine-squared"
frequency = 20.0
end = 0.05
[output]
every = 1
"#;

/// The default iteration costs a tenth more than a fresh matrix in every iteration, in units of one iteration of which a matrix costs six. The
/// tenth is spent in four steps that are cut, each after a second try. Without learning from earlier steps it cost 2.1 times as much.
#[test]
fn a_sheet_that_turns_far_costs_little_more_than_with_full_newton() {
    let run = |more: &str| {
        let model = read_deck(&(STRUCK_SHEET.to_owned() + more));
        let corner = node(&model, "c");
        let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[corner]).to_vec());
        let counts = done.counts;
        (counts.iterations + 6 * counts.factorizations, done.rows[done.rows.len() - 1].clone(), counts)
    };
    let (cost, end, counts) = run("");
    let (of_full, exact, full) = run("[iteration]\nupdate = \"iteration\"\n");
    let apart = distance(&[end], &[exact]);
    println!("{cost} for {of_full}, {apart:.1e} apart; {counts:?}, {full:?}");
    // 1.10; whether one more step is cut hangs on rounding, and a cut costs a thirtieth.
    assert!(20 * cost <= 23 * of_full, "{cost} for {of_full}: {counts:?} {full:?}");
    // The corner moves by half a metre; each step leaves 1e-5 of its own motion at the most.
    assert!(apart < 1e-4, "{apart}");
}
