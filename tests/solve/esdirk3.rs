//! The diagonally implicit Runge-Kutta scheme of third order through the whole program: orders of motion, forces and energies.

use crate::support::{Done, body_omega, error, node, position, read, read_deck, reference, run_to_the_end, slope};
use rdsolve::solve::Frame;

fn sets(step: f64, interval: f64, others: &[&str]) -> Vec<String> {
    let own = [
        "expect=[]".to_owned(),
        "integrator={scheme=\"esdirk3\"}".to_owned(),
        format!("analysis.time_step={step:e}"),
        format!("output.interval={interval}"),
    ];
    own.into_iter().chain(others.iter().map(|set| (*set).to_owned())).collect()
}

fn run(
    deck: &str,
    step: f64,
    interval: f64,
    others: &[&str],
    probe: &mut dyn FnMut(&rdsolve::model::Model, &Frame) -> Vec<f64>,
) -> Done {
    let model = read(deck, &sets(step, interval, others));
    run_to_the_end(&model, &mut |frame| probe(&model, frame))
}

/// Two bodies on springs against a reference of 1e-12.
#[test]
fn third_order_for_rigid_bodies() {
    let exact = reference("two_bodies_on_springs");
    let points = [8.0, 16.0, 32.0].map(|division| {
        let dt = 0.025 / division;
        let done = run("two_bodies_on_springs", dt, 0.025, &["iteration.tolerance=1e-12"], &mut |model, frame| {
            let [a, b] = ["a", "b"].map(|name| &frame.state.nodes[node(model, name)]);
            [position(a), position(b), body_omega(a), body_omega(b)].concat()
        });
        (dt, error(&done.rows, &exact, 0))
    });
    let order = slope(&points);
    println!("bodies {points:?} {order:.2}");
    assert!((2.8..3.2).contains(&order), "{order}: {points:?}");
}

/// A beam at large rotations; the load has its kinks at the ends of steps.
#[test]
fn third_order_for_a_flexible_beam() {
    let run = |dt: f64| {
        let others =
            ["beams.legs.elements=2", "beams.legs.order=3", "analysis.end_time=4.0", "iteration.tolerance=1e-11"];
        let done = run("right_angle_cantilever", dt, 0.25, &others, &mut |model, frame| {
            ["elbow", "tip"].map(|name| frame.state.nodes[node(model, name)].x.z).to_vec()
        });
        done.rows
    };
    let exact = run(1.0 / 512.0);
    let points = [0.125, 0.0625, 0.03125].map(|dt| (dt, error(&run(dt), &exact, 0)));
    let order = slope(&points);
    println!("beam {points:?} {order:.2}");
    assert!((2.5..3.4).contains(&order), "{order}: {points:?}"); // high modes are resolved by no step but the last
}

/// The pivot of a fast top, held by multipliers: joints are closed and velocities projected at every stage, so the order is three.
#[test]
fn order_with_joints() {
    let exact = reference("heavy_top/pivot");
    let points = [5e-4, 2.5e-4, 1.25e-4].map(|dt| {
        let done = run("heavy_top/pivot", dt, 0.01, &["iteration.tolerance=1e-12"], &mut |model, frame| {
            position(&frame.state.nodes[node(model, "top")]).to_vec()
        });
        (dt, error(&done.rows, &exact, 0))
    });
    let order = slope(&points);
    println!("top {points:?} {order:.2}");
    assert!((2.8..3.4).contains(&order), "{order}: {points:?}");
    // Wilson-theta leaves 2e-4 there.
    assert!(points[2].1 < 1e-6, "{points:?}");
}

/// A mass on a spring and a damper under a load that varies, its base driven: work by quadrature over the stages closes the balance with the order of the
/// scheme.
#[test]
fn energies_are_of_third_order() {
    let run = |dt: f64| {
        let deck = format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 2.0, time_step = {dt} }}
            integrator = {{ scheme = "esdirk3" }}
            iteration = {{ tolerance = 1e-13 }}
            points = {{ p = [1.0, 0.0, 0.0], base = [0.0, 0.0, 0.0] }}
            masses = [{{ at = "p", mass = 1.0 }}]
            links = [{{ name = "s", from = {{ node = "base" }}, to = {{ node = "p" }}, stiffness = 40.0, damping = 0.5, direction = [1.0, 0.0, 0.0] }}]
            supports = [{{ at = "p", fix = ["uy", "uz"] }}, {{ at = "base", fix = ["uy", "uz"] }}, {{ at = "base", motion = {{ ux = {{ amplitude = "drive", scale = 0.3 }} }} }}]
            loads = [{{ at = "p", force = [30.0, 0.0, 0.0], amplitude = "wave" }}]
            amplitudes = {{ wave = {{ kind = "sine", frequency = 0.7 }}, drive = {{ kind = "sine", frequency = 0.4 }} }}
            output = {{ energy = true }}
            "#
        );
        let model = read_deck(&deck);
        let mut worst = 0.0f64;
        run_to_the_end(&model, &mut |frame| {
            let energy = frame.derived.energy.as_ref().expect("energies");
            worst = worst.max(energy.numerical.abs());
            Vec::new()
        });
        (dt, worst)
    };
    let points = [0.08, 0.04, 0.02].map(run);
    let order = slope(&points);
    println!("energy {points:?} {order:.2}");
    assert!(order > 2.8, "{order}: {points:?}");
}
