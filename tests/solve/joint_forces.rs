//! What joints and supports carry: of second order and with `esdirk3` of third, exact at t = 0, and with light links between heavy bodies.

use crate::support::{body_omega, node, position, read_deck, run_to_the_end, slope};
use rdsolve::model::Model;
use rdsolve::system::System;

const IMPLICIT: [&str; 6] = ["newmark", "hht-alpha", "generalized-alpha", "bathe", "wilson-theta", "esdirk3"];

/// The opening of a deck: out of the plane too, with weight.
fn opening(scheme: &str, time_step: f64, end_time: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time}\ntime_step = {time_step}\nplane = \"off\"\n\
         [iteration]\ntolerance = 1e-12\n[integrator]\nscheme = \"{scheme}\"\n\
         [environment]\ngravity = [0.0, 0.0, -9.81]\n[output]\ninterval = 0.1\nreactions = true\n"
    )
}

/// Released from rest with the arm level.
const PENDULUM: &str = r#"
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 2.0
inertia = [0.1, 0.3, 0.35]
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { body = "bob", point = [0.0, 0.0, 0.0] }
to = { ground = [0.0, 0.0, 0.0] }
"#;

const CHAIN: &str = r#"
[[bodies]]
name = "a"
center = [0.5, 0.0, 0.0]
mass = 1.0
inertia = [0.02, 0.09, 0.1]
angular_velocity = [0.0, 1.0, 0.5]
velocity = [0.0, 0.25, -0.5]
[[bodies]]
name = "b"
center = [1.5, 0.0, 0.0]
mass = 1.0
inertia = [0.02, 0.09, 0.1]
velocity = [0.0, 0.5, -1.0]
[[joints]]
name = "pin"
kind = "spherical"
from = { body = "a", point = [0.0, 0.0, 0.0] }
to = { ground = [0.0, 0.0, 0.0] }
[[joints]]
name = "knee"
kind = "spherical"
from = { body = "b", point = [1.0, 0.0, 0.0] }
to = { body = "a" }
"#;

const SUPPORTED: &str = r#"
[points]
p = [0.0, 0.1, 0.0]
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 2.0
inertia = [0.1, 0.3, 0.35]
[[attachments]]
body = "bob"
nodes = ["p"]
[[supports]]
at = "p"
fix = ["ux", "uy", "uz"]
"#;

/// A four-bar linkage that swings. Two of its joints are spherical, so no equation is redundant.
const LOOP: &str = r#"
[[bodies]]
name = "a"
center = [0.0, 0.0, 0.5]
mass = 1.0
inertia = [0.09, 0.09, 0.02]
velocity = [0.5, 0.0, 0.0]
angular_velocity = [0.0, 1.0, 0.0]
[[bodies]]
name = "b"
center = [1.0, 0.0, 1.0]
mass = 2.0
inertia = [0.02, 0.3, 0.3]
velocity = [1.0, 0.0, 0.0]
[[bodies]]
name = "c"
center = [2.0, 0.0, 0.5]
mass = 1.0
inertia = [0.09, 0.09, 0.02]
velocity = [0.5, 0.0, 0.0]
angular_velocity = [0.0, 1.0, 0.0]
[[joints]]
name = "left"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { body = "a", point = [0.0, 0.0, 0.0] }
to = { ground = [0.0, 0.0, 0.0] }
[[joints]]
name = "knee"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { body = "b", point = [0.0, 0.0, 1.0] }
to = { body = "a" }
[[joints]]
name = "wrist"
kind = "spherical"
from = { body = "b", point = [2.0, 0.0, 1.0] }
to = { body = "c" }
[[joints]]
name = "right"
kind = "spherical"
from = { body = "c", point = [2.0, 0.0, 0.0] }
to = { ground = [2.0, 0.0, 0.0] }
"#;

/// A crank that turns, a rod on spherical joints and a slider on a guide.
const SLIDER_CRANK: &str = r#"
[[bodies]]
name = "crank"
center = [0.15, 0.0, 0.0]
mass = 2.0
inertia = [0.02, 0.02, 0.02]
velocity = [0.0, 0.6, 0.0]
angular_velocity = [0.0, 0.0, 4.0]
[[bodies]]
name = "rod"
center = [0.85, 0.0, 0.0]
mass = 3.0
inertia = [0.02, 0.35, 0.35]
velocity = [0.0, 0.6, 0.0]
angular_velocity = [0.0, 0.0, -1.0909090909090909]
[[bodies]]
name = "slider"
center = [1.4, 0.0, 0.0]
mass = 1.5
inertia = [0.1, 0.1, 0.1]
[[joints]]
name = "bearing"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "crank" }
[[joints]]
name = "knee"
kind = "spherical"
from = { body = "crank", point = [0.3, 0.0, 0.0] }
to = { body = "rod" }
[[joints]]
name = "wrist"
kind = "spherical"
from = { body = "rod", point = [1.4, 0.0, 0.0] }
to = { body = "slider" }
[[joints]]
name = "guide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = { ground = [1.4, 0.0, 0.0] }
to = { body = "slider" }
"#;

/// An arm that a motor turns at 3 rad/s, and a second arm that swings on it.
const DRIVEN_ARM: &str = r#"
[[bodies]]
name = "arm"
center = [0.5, 0.0, 0.0]
mass = 2.0
inertia = [0.02, 0.2, 0.2]
velocity = [0.0, 0.0, -1.5]
angular_velocity = [0.0, 3.0, 0.0]
[[bodies]]
name = "bob"
center = [1.5, 0.0, 0.0]
mass = 1.0
inertia = [0.02, 0.09, 0.1]
velocity = [0.0, 0.5, -3.0]
angular_velocity = [0.0, 0.0, 1.0]
[[joints]]
name = "motor"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "arm" }
motion = { velocity = 3.0 }
[[joints]]
name = "knee"
kind = "spherical"
from = { body = "bob", point = [1.0, 0.0, 0.0] }
to = { body = "arm" }
"#;

/// Three bodies of unequal inertias that are set tumbling: a rod without mass, attached beside the centres of two of them, and a joint to the
/// third. They turn by their angular momentum, and what is eliminated follows.
const TUMBLING_BODIES: &str = r#"
[materials.rubber]
model = "elastic"
youngs_modulus = 1e8
poisson_ratio = 0.3
density = 1000.0
[sections.rod]
shape = "rectangle"
width = 0.03
height = 0.04
[points]
root = [0.1, 0.2, 0.0]
tip = [0.1, 1.2, 0.1]
[[beams]]
name = "rod"
path = ["root", "tip"]
elements = 1
order = 1
mass = "none"
material = "rubber"
section = "rod"
orientation = [1.0, 0.0, 0.0]
[[bodies]]
name = "a"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.1, 0.3, 0.35]
[[bodies]]
name = "b"
center = [1.0, 0.0, 0.0]
mass = 1.0
inertia = [0.05, 0.09, 0.1]
[[bodies]]
name = "c"
center = [0.2, 1.4, 0.0]
mass = 1.5
inertia = [0.08, 0.12, 0.15]
[[attachments]]
body = "a"
nodes = ["root"]
[[attachments]]
body = "c"
nodes = ["tip"]
[[joints]]
name = "knee"
kind = "spherical"
from = { body = "b", point = [0.5, 0.0, 0.0] }
to = { body = "a" }
[[loads]]
at = "a"
moment = [6.0, 9.0, 12.0]
amplitude = "smooth"
[amplitudes.smooth]
kind = "sine-squared"
frequency = 1.0
end = 0.5
"#;

/// Forces of all joints and reactions at every output time.
fn forces(model: &Model) -> Vec<Vec<f64>> {
    let probe = &mut |frame: &rdsolve::solve::Frame| {
        let joints = frame.derived.joints.iter().flat_map(|joint| joint.f.iter().copied());
        joints.chain(frame.reactions.iter().copied()).collect()
    };
    run_to_the_end(model, probe).rows
}

/// Largest difference over the largest value.
fn difference(rows: &[Vec<f64>], exact: &[Vec<f64>]) -> f64 {
    assert_eq!(rows.len(), exact.len());
    let largest = exact.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let pairs = rows.iter().flatten().zip(exact.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}

#[test]
fn forces_of_joints_and_supports_are_of_second_order() {
    for (name, scene) in [("pendulum", PENDULUM), ("chain", CHAIN), ("supported", SUPPORTED)] {
        let of = |scheme: &str, dt: f64| forces(&read_deck(&(opening(scheme, dt, 0.8) + scene)));
        // Fourth order at 5e-4: its own error is below 1e-9.
        let exact = of("runge-kutta", 5e-4);
        for scheme in IMPLICIT {
            let points = [4e-3, 2e-3, 1e-3].map(|dt| (dt, difference(&of(scheme, dt), &exact)));
            let order = slope(&points);
            println!("{name}, {scheme}: {points:?} order {order:.3}");
            assert!(order > 1.9, "{name}, {scheme}: {points:?} order {order}");
            // Wilson-theta in the chain has the largest error, 6.3e-5 at 1e-3.
            assert!(points[2].1 < 1e-4, "{name}, {scheme}: {points:?}");
        }
    }
}

/// Positions and velocities of all nodes, and forces of joints and supports.
fn motion_and_forces(model: &Model) -> [Vec<Vec<f64>>; 2] {
    let mut forces = Vec::new();
    let probe = &mut |frame: &rdsolve::solve::Frame| {
        let joints = frame.derived.joints.iter().flat_map(|joint| joint.f.iter().copied());
        forces.push(joints.chain(frame.reactions.iter().copied()).collect());
        frame.state.nodes.iter().flat_map(|node| [position(node), node.v.into(), body_omega(node)].concat()).collect()
    };
    let motion = run_to_the_end(model, probe).rows;
    [motion, forces]
}

/// Stages close the joints and project their velocities. With velocities projected at the ends of steps alone, the order was two.
#[test]
fn esdirk3_is_of_third_order_with_joints() {
    for (name, scene) in [
        ("pendulum", PENDULUM),
        ("chain", CHAIN),
        ("four-bar", LOOP),
        ("slider-crank", SLIDER_CRANK),
        ("driven arm", DRIVEN_ARM),
        ("supported", SUPPORTED),
    ] {
        let model = |scheme: &str, dt: f64| read_deck(&(opening(scheme, dt, 0.8) + scene));
        // Of high order: its own error is below 1e-10.
        let exact = motion_and_forces(&model("runge-kutta", 5e-4));
        let runs = [8e-3, 4e-3, 2e-3].map(|dt| (dt, motion_and_forces(&model("esdirk3", dt))));
        for (i, what) in ["motion", "forces"].iter().enumerate() {
            let points = runs.each_ref().map(|(dt, run)| (*dt, difference(&run[i], &exact[i])));
            let order = slope(&points);
            println!("{name}, {what}: {points:?} order {order:.2}");
            // The four-bar has 2.73 between these steps.
            assert!(order > 2.65, "{name}, {what}: {points:?} order {order}");
        }
    }
}

#[test]
fn tumbling_bodies_keep_the_order() {
    let of = |scheme: &str, dt: f64| {
        let weightless = opening(scheme, dt, 1.0).replace("-9.81", "0.0"); // weight at once would set all modes swinging
        let model = read_deck(&(weightless + TUMBLING_BODIES));
        assert_eq!(System::new(&model).unwrap().turning_bodies().len(), 3);
        let [body, tip] = ["a", "tip"].map(|name| node(&model, name));
        let mut forces = Vec::new();
        let motion = run_to_the_end(&model, &mut |frame| {
            forces.push(frame.derived.joints.iter().flat_map(|joint| joint.f.iter().copied()).collect::<Vec<f64>>());
            let [body, tip] = [body, tip].map(|node| &frame.state.nodes[node]);
            [position(tip), body_omega(body)].concat()
        });
        (motion.rows, forces)
    };
    let exact = of("runge-kutta", 2.5e-4);
    for scheme in IMPLICIT {
        let runs = [4e-3, 2e-3, 1e-3].map(|dt| (dt, of(scheme, dt)));
        let orders = [
            runs.each_ref().map(|(dt, run)| (*dt, difference(&run.0, &exact.0))),
            runs.each_ref().map(|(dt, run)| (*dt, difference(&run.1, &exact.1))),
        ];
        for (what, points) in ["motion", "forces"].iter().zip(orders) {
            let order = slope(&points);
            println!("{scheme}, {what}: {points:?} order {order:.3}");
            // The rod's own oscillations have up to 0.6 rad in the longest step.
            assert!(order > 1.8, "{scheme}, {what}: {points:?} order {order}");
        }
    }
}

/// m g J/(J + m l²) of the pendulum at t = 0: its centre falls with g m l²/(J + m l²).
#[test]
fn forces_of_joints_at_the_start_are_exact() {
    let exact = 2.0 * 9.81 * 0.3 / 2.3;
    for scheme in IMPLICIT.iter().chain(&["runge-kutta", "central-difference"]) {
        let model = read_deck(&(opening(scheme, 1e-3, 0.1) + PENDULUM));
        let mut start = None;
        run_to_the_end(&model, &mut |frame| {
            start = start.or(Some(frame.derived.joints[0].f));
            Vec::new()
        });
        let f = start.unwrap();
        assert!((f.z.abs() - exact).abs() < 1e-10 * exact, "{scheme}: {} for {exact}", f.z);
        assert!(f.x.abs().max(f.y.abs()) < 1e-10 * exact, "{scheme}: {f}");
    }
}

/// A link of mass m between the ground and a body of mass M.
fn hung(scheme: &str, light: f64, heavy: f64) -> Model {
    let text = format!(
        "[[bodies]]\nname = \"link\"\ncenter = [0.5, 0.0, 0.0]\nmass = {light:e}\ninertia = [{:e}, {:e}, {:e}]\n\
         [[bodies]]\nname = \"heavy\"\ncenter = [1.5, 0.0, 0.0]\nmass = {heavy:e}\ninertia = [{:e}, {:e}, {:e}]\n\
         [[joints]]\nname = \"pin\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\
         from = {{ body = \"link\", point = [0.0, 0.0, 0.0] }}\nto = {{ ground = [0.0, 0.0, 0.0] }}\n\
         [[joints]]\nname = \"knee\"\nkind = \"spherical\"\n\
         from = {{ body = \"heavy\", point = [1.0, 0.0, 0.0] }}\nto = {{ body = \"link\" }}\n",
        0.001 * light,
        light / 12.0,
        light / 12.0,
        0.01 * heavy,
        0.09 * heavy,
        0.1 * heavy,
    );
    read_deck(&(opening(scheme, 4e-3, 0.6) + &text))
}

/// The motion depends on the ratio of masses alone, and on it no more where it is small: 1e-6 moves the body by 2.7e-7 of the
/// way less than none does.
#[test]
fn light_links_between_heavy_bodies_take_the_steps_of_others() {
    for scheme in IMPLICIT {
        let run = |light: f64, heavy: f64| {
            let model = hung(scheme, light, heavy);
            let body = node(&model, "heavy");
            let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[body]).to_vec());
            assert_eq!(done.counts.cuts, 0, "{scheme}: {light} under {heavy}");
            (done.rows, done.counts.iterations)
        };
        let (exact, usual) = run(1.0, 1e6);
        for (light, heavy) in [(1e-4, 1e4), (1e-6, 1e4), (1e-4, 1e6), (1e-6, 1e6)] {
            let (rows, iterations) = run(light, heavy);
            let difference = difference(&rows, &exact);
            assert!(difference < 1e-6, "{scheme}: {light} under {heavy} differs by {difference}");
            assert!(10 * iterations < 12 * usual, "{scheme}: {iterations} iterations for {usual}");
        }
    }
}
