//! Driven joints: a slider-crank against minimal coordinates, the work of the drive, statics through half a turn, modes.

use super::{all_schemes, derivative, opening, shown};
use crate::support::{node, read_deck, run_to_the_end, slope, tables_of};
use rdsolve::solve::Frame;

const CRANK: f64 = 0.3;
const ROD: f64 = 1.1;
/// Mass and inertia about the centre, of crank and rod; the mass of the slider.
const INERTIAS: [[f64; 2]; 2] = [[2.0, 0.02], [3.0, 0.35]];
const SLIDER: f64 = 1.5;
const SPEED: f64 = 8.0;

/// A crank that is driven at constant speed, a rod, a slider on the x axis, in the x-y plane.
fn slider_crank(scheme: &str, time_step: f64) -> String {
    let [[m1, j1], [m2, j2]] = INERTIAS;
    let (half, middle, end) = (0.5 * CRANK, CRANK + 0.5 * ROD, CRANK + ROD);
    // The rates of the straight position at the start.
    let (v1, v2, w2) = (half * SPEED, 0.5 * CRANK * SPEED, -CRANK / ROD * SPEED);
    opening(scheme, time_step, 1.0, 0.05)
        + &format!(
            r#"
[[bodies]]
name = "crank"
center = [{half:?}, 0.0, 0.0]
mass = {m1:?}
inertia = [{j1:?}, {j1:?}, {j1:?}]
velocity = [0.0, {v1:?}, 0.0]
angular_velocity = [0.0, 0.0, {SPEED:?}]
[[bodies]]
name = "rod"
center = [{middle:?}, 0.0, 0.0]
mass = {m2:?}
inertia = [{j2:?}, {j2:?}, {j2:?}]
velocity = [0.0, {v2:?}, 0.0]
angular_velocity = [0.0, 0.0, {w2:?}]
[[bodies]]
name = "slider"
center = [{end:?}, 0.0, 0.0]
mass = {SLIDER:?}
inertia = [0.1, 0.1, 0.1]
[[joints]]
name = "motor"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "crank" }}
motion = {{ velocity = {SPEED:?} }}
[[joints]]
name = "knee"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ body = "crank", point = [{CRANK:?}, 0.0, 0.0] }}
to = {{ body = "rod" }}
[[joints]]
name = "wrist"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ body = "rod", point = [{end:?}, 0.0, 0.0] }}
to = {{ body = "slider" }}
[[joints]]
name = "guide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = {{ ground = [{end:?}, 0.0, 0.0] }}
to = {{ body = "slider" }}
"#
        )
}

/// The angle of the rod and the place of the slider at a crank angle.
fn rod_and_slider(theta: f64) -> (f64, f64) {
    let phi = (-CRANK / ROD * theta.sin()).asin();
    (phi, CRANK * theta.cos() + ROD * phi.cos())
}

/// The inertia of the mechanism as the crank feels it: twice its kinetic energy at unit speed.
fn inertia(theta: f64) -> f64 {
    let [[m1, j1], [m2, j2]] = INERTIAS;
    let dphi = derivative(|at| rod_and_slider(at).0, theta);
    let dx = derivative(|at| CRANK * at.cos() + 0.5 * ROD * rod_and_slider(at).0.cos(), theta);
    let dy = derivative(|at| CRANK * at.sin() + 0.5 * ROD * rod_and_slider(at).0.sin(), theta);
    let slider = derivative(|at| rod_and_slider(at).1, theta);
    m1 * 0.25 * CRANK * CRANK + j1 + m2 * (dx * dx + dy * dy) + j2 * dphi * dphi + SLIDER * slider * slider
}

/// At constant speed the drive turns ½ I′ ω²; its work is the change of ½ I ω².
#[test]
fn a_driven_slider_crank_is_that_of_minimal_coordinates() {
    for scheme in all_schemes() {
        let mut points = Vec::new();
        for dt in [4e-3, 2e-3, 1e-3] {
            let model = read_deck(&slider_crank(scheme, dt));
            let slider = node(&model, "slider");
            let places = run_to_the_end(&model, &mut |frame: &Frame| vec![frame.state.nodes[slider].x.x]).rows;
            let (mut effort, mut work) = (0.0f64, 0.0f64);
            for (at, place) in shown(&model, "motor").iter().zip(&places) {
                let theta = SPEED * at.time;
                assert!((at.coordinate - theta).abs() < 1e-11, "{scheme}: {at:?}");
                assert!((at.rate - SPEED).abs() < 1e-10, "{scheme}: {at:?}");
                // The joints are closed to rounding, however long the steps are.
                assert!((place[0] - rod_and_slider(theta).1).abs() < 1e-11, "{scheme}: {at:?}");
                let exact = 0.5 * SPEED * SPEED * derivative(inertia, theta);
                effort = effort.max((at.effort - exact).abs());
                let gained = 0.5 * SPEED * SPEED * (inertia(theta) - inertia(0.0));
                work = work.max((at.external - gained).abs());
            }
            points.push((dt, effort, work));
        }
        println!("{scheme}: {points:?}");
        let order =
            |of: fn(&(f64, f64, f64)) -> f64| slope(&points.iter().map(|at| (at.0, of(at))).collect::<Vec<_>>());
        // Moments and energies are some 30. What is exact but for 1e-7 has no order.
        assert!(points[2].1 < 3e-5 || order(|at| at.1) > 1.85, "{scheme}: {points:?} order {}", order(|at| at.1));
        assert!(points[2].2 < 3e-5 || order(|at| at.2) > 1.85, "{scheme}: {points:?} order {}", order(|at| at.2));
        assert!(points[2].1 < 0.3 && points[2].2 < 0.03, "{scheme}: {points:?}");
    }
}

const PENDULUM: &str = r#"
[environment]
gravity = [0.0, 0.0, -9.81]
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 2.0
inertia = [0.1, 0.3, 0.35]
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "bob", point = [0.0, 0.0, 0.0] }
"#;

/// A weight that is turned by almost one and a half turns, past where it stands upright.
#[test]
fn a_static_drive_turns_a_weight() {
    let text = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.125\n[output]\njoints = true\n\
                [amplitudes.up]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n"
        .to_owned()
        + PENDULUM
        + "motion = { position = 9.0, amplitude = \"up\" }\n";
    let model = read_deck(&text);
    let rows = shown(&model, "pin");
    assert!(rows.len() >= 9, "steps are cut where the weight pushes");
    for at in &rows {
        let theta = 9.0 * at.time;
        assert!((at.coordinate - theta).abs() < 1e-12, "{at:?}");
        // Weight without an amplitude grows with the time.
        let exact = -at.time * 2.0 * 9.81 * theta.cos();
        assert!((at.effort - exact).abs() < 1e-7, "{at:?} for {exact}"); // tolerance of the iteration 1e-8
    }
}

/// A drive holds its joint: what swings about a driven one has the frequency of a fixed one.
#[test]
fn a_driven_joint_is_locked_in_modes() {
    let modes = |along: &str| {
        let text = "[analysis]\nkind = \"modal\"\nmodes = 5\n".to_owned()
            + "[[bodies]]\nname = \"a\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 2.0]\n\
               [[bodies]]\nname = \"b\"\ncenter = [0.0, 0.0, 1.0]\nmass = 1.0\ninertia = [2.0, 2.0, 3.0]\n\
               [[joints]]\nname = \"pin\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\n\
               from = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"a\" }\n"
            + along
            + "[[joints]]\nname = \"spring\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\n\
               from = { body = \"a\", point = [0.0, 0.0, 1.0] }\nto = { body = \"b\" }\nstiffness = 12.0\n";
        let model = read_deck(&text);
        let rows = tables_of(&model).rows("modes.csv");
        rows.iter().map(|row| row.number("angular_frequency")).collect::<Vec<f64>>()
    };
    let held = modes(
        "motion = { position = 1.0, amplitude = \"up\" }\n[amplitudes.up]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n",
    );
    assert_eq!(held.len(), 1, "{held:?}");
    assert!((held[0] - 2.0).abs() < 1e-9, "{held:?}"); // √(12/3)
    let sprung = modes("stiffness = 8.0\n");
    assert_eq!(sprung.len(), 2, "{sprung:?}");
    // 2·3 λ² − (3 (8 + 12) + 2·12) λ + 8·12 = 0
    let root = (84.0f64 * 84.0 - 4.0 * 6.0 * 96.0).sqrt();
    let exact = [((84.0 - root) / 12.0).sqrt(), ((84.0 + root) / 12.0).sqrt()];
    assert!((sprung[0] - exact[0]).abs() < 1e-9 && (sprung[1] - exact[1]).abs() < 1e-9, "{sprung:?} for {exact:?}");
}

/// Velocities that lead nowhere over the run are rest: a drive that begins slowly does not contradict them. Others do.
#[test]
fn a_drive_begins_beside_bodies_at_rest_but_for_rounding() {
    let text = |kind: &str, omega: f64, v: f64| {
        opening("newmark", 0.01, 1.0, 0.5)
            + &format!(
                "[amplitudes.r]\nkind = \"sine-squared\"\nangular_frequency = 1.0\n\
                 [[bodies]]\nname = \"a\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 angular_velocity = [0.0, 0.0, {omega:?}]\nvelocity = [0.0, 0.0, {v:?}]\n\
                 [[bodies]]\nname = \"b\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 angular_velocity = [0.0, 0.0, -1e-15]\nvelocity = [0.0, 0.0, 1e-16]\n\
                 [[joints]]\nname = \"pin\"\nkind = \"{kind}\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ body = \"a\" }}\nto = {{ body = \"b\" }}\n\
                 motion = {{ position = 1.0, amplitude = \"r\" }}\n"
            )
    };
    for (kind, omega, v) in [("revolute", 4e-14, 0.0), ("prismatic", 0.0, -3e-13), ("cylindrical", 2e-12, 1e-13)] {
        let done = run_to_the_end(&read_deck(&text(kind, omega, v)), &mut |_: &Frame| Vec::new());
        assert!(done.warnings.is_empty(), "{kind}: {:?}", done.warnings);
    }
}
