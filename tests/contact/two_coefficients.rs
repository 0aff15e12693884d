//! Two coefficients of friction, static and kinetic, against closed forms.

use super::go;
use crate::support::slope;
use rdsolve::solve::Frame;

/// The weight of what lies there, its mass, and the stiffness of the contact.
const WEIGHT: f64 = 20.0;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 1e6;
const STEP: f64 = 1e-3;

/// A scene in which `block` lies on something without turning, `friction` being that of the contact.
fn lying(friction: &str, block: &str, surface: &str, more: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 1.0, time_step = {STEP:?} }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 800.0 }}
        amplitudes.growing = {{ kind = "table", points = [[0.0, 0.0], [1.0, 1.0]] }}
        {block}
        [[supports]]
        at = "block"
        fix = ["rx", "ry", "rz"]
        {more}
        [[contacts]]
        name = "floor"
        surface = {{ {surface} }}
        with = "block"
        stiffness = {STIFFNESS:?}
        friction = {friction}
        "#
    )
}

/// A box of 2 kg, four times as stiff as a point, whose lower side lies so deep in the ground.
fn brick(depth: f64, velocity: f64) -> String {
    format!(
        "bodies = [{{ name = \"block\", center = [0.0, 0.0, {:?}], shape = {{ kind = \"box\", size = [0.2, 0.2, 0.1] }}, mass = {MASS:?}, \
         velocity = [{velocity:?}, 0.0, 0.0] }}]",
        0.05 - depth
    )
}

/// A ball of 2 kg so deep in the faces of a sheet.
fn ball(depth: f64) -> String {
    format!(
        "bodies = [{{ name = \"block\", center = [0.013, 0.017, {:?}], shape = {{ kind = \"sphere\", radius = 0.1 }}, mass = {MASS:?} }}]",
        0.105 - depth
    )
}

const PLANE: &str = "shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]";
const SLAB: &str = "shape = \"box\", center = [0.0, 0.0, -0.5], size = [3.0, 3.0, 1.0]";
const SHEET: &str = "[points]\np = [-1.0, -1.0, 0.0]\nq = [1.0, -1.0, 0.0]\nr = [1.0, 1.0, 0.0]\ns = [-1.0, 1.0, 0.0]\n\
                     [[shells]]\nname = \"lower\"\ncorners = [\"p\", \"q\", \"r\", \"s\"]\nelements = 4\nthickness = 0.01\n\
                     material = \"steel\"\nrigid = true\n[[supports]]\nat = \"lower\"\nfix = \"all\"\n";
const PUSH: &str = "[[loads]]\nat = \"block\"\nforce = [10.0, 0.0, 0.0]\namplitude = \"growing\"\n";

/// Two rigid sheets on edge, one across the other: 0.5 m x 0.5 m x 10 mm at 800 kg/m³ weigh 2 kg.
fn crossing_sheets(depth: f64) -> String {
    let sheet = |name: &str, corners: &str| {
        format!(
            "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = 1\nthickness = 0.01\nmaterial = \"steel\"\nrigid = true\n"
        )
    };
    let (low, high) = (0.01 - depth, 0.51 - depth);
    format!(
        "[points]\na = [-0.5, 0.0, -0.5]\nb = [0.5, 0.0, -0.5]\nc = [0.5, 0.0, 0.0]\nd = [-0.5, 0.0, 0.0]\n\
         e = [0.0, -0.237, {low:?}]\nf = [0.0, 0.263, {low:?}]\ng = [0.0, 0.263, {high:?}]\nh = [0.0, -0.237, {high:?}]\n\
         [[supports]]\nat = \"lower\"\nfix = \"all\"\n"
    ) + &sheet("lower", r#""a", "b", "c", "d""#)
        + &sheet("block", r#""e", "f", "g", "h""#)
}

/// The displacement and velocity of the last node that moves, and the energies.
fn motion(frame: &Frame) -> Vec<f64> {
    let energy = frame.derived.energy.expect("energies");
    let fastest = frame.state.nodes.iter().max_by(|a, b| a.v.x.abs().total_cmp(&b.v.x.abs())).expect("nodes");
    vec![frame.state.time, fastest.v.x, energy.friction, energy.numerical, energy.external]
}

/// A force 10 t pushes 2 kg with a weight of 20 N: they stick up to 6 N, then move with 2 v' = 10 t − 4. Points, convex solids, faces and lines.
#[test]
fn a_growing_force_breaks_loose_and_then_meets_less() {
    const BOTH: &str = "{ static = 0.3, kinetic = 0.2 }";
    let deep = |stiffness: f64| WEIGHT / stiffness;
    let scenes = [
        ("points", lying(BOTH, &brick(deep(4.0 * STIFFNESS), 0.0), PLANE, PUSH)),
        ("solids", lying(BOTH, &brick(deep(4.0 * STIFFNESS), 0.0), SLAB, PUSH)),
        ("faces", lying(BOTH, &ball(deep(STIFFNESS)), "part = \"lower\"", &(SHEET.to_owned() + PUSH))),
        ("lines", lying(BOTH, &crossing_sheets(deep(STIFFNESS)), "part = \"lower\", edges = true", PUSH)),
    ];
    for (name, deck) in scenes {
        let rows = go(&deck, &mut motion).rows;
        let last = rows.last().unwrap();
        let breaks = rows.iter().find(|row| row[1] > 0.01).unwrap()[0];
        println!("{name}: breaks {breaks}, {last:?}");
        // With one coefficient of 0.3 the speed were 0.4, with 0.2 it were 0.9. The force breaks loose in one step and knows it in the next: a
        // step and a half at 1 m/s². What swings on the spring adds 2 N / √(k m) = 1.4e-3.
        assert!((last[1] - 0.8).abs() < 1.5 * STEP + 1.4e-3, "{name}: {last:?}");
        // At 1 m/s² and more 0.01 m/s are there within 10 ms.
        assert!(breaks > 0.6 && breaks < 0.6 + 0.01 + 2.0 * STEP, "{name}: {breaks}");
        // 4 N over the way of 2/15 m.
        assert!((last[2] - 4.0 * 2.0 / 15.0).abs() < 0.01 * last[2], "{name}: {last:?}");
        assert!(last[3].abs() < 1e-3 * last[4], "{name}: {last:?}");
    }
}

/// The coefficient falls with the speed as μ = 0.1 + 0.2 exp(−2 v). So u = exp(2 v) follows u' = −2 g (0.1 u + 0.2), which is solved by an exponential.
#[test]
fn friction_falls_with_the_slip_speed() {
    let (kinetic, drop, decay, v0): (f64, f64, f64, f64) = (0.1, 0.2, 2.0, 1.0);
    let deck = lying("{ static = 0.3, kinetic = 0.1, decay = 2.0 }", &brick(WEIGHT / (4.0 * STIFFNESS), v0), PLANE, "");
    let exact = |t: f64| {
        let rest = drop / kinetic;
        (((decay * v0).exp() + rest) * (-decay * 10.0 * kinetic * t).exp() - rest).max(1.0).ln() / decay
    };
    let stops = 0.5 * (((decay * v0).exp() + 2.0) / 3.0).ln();
    // The coefficient is that of the speed a step and a half before. With the deceleration 1 + 2 exp(−2 v) this changes the speed by at most
    // 1.5 ∫ 4 exp(−2 v) dv = 3 (1 − exp(−2)) steps, which grows by 3/(1 + 2 exp(−2)) until it stops.
    let bound = 3.0 * (1.0 - (-2.0f64).exp()) * 3.0 / (1.0 + 2.0 * (-2.0f64).exp());
    let mut errors = Vec::new();
    let mut last = Vec::new();
    for step in [STEP, 0.5 * STEP] {
        let rows = go(&deck.replace("time_step = 0.001", &format!("time_step = {step:?}")), &mut motion).rows;
        let slides = rows.iter().filter(|row| row[0] < stops - 0.01);
        let worst = slides.map(|row| (row[1].abs() - exact(row[0])).abs()).fold(0.0, f64::max);
        println!("step {step}: worst {worst:e}, stops at {stops}");
        assert!(worst < bound * step, "{worst}");
        errors.push((step, worst));
        last = rows.last().unwrap().clone();
    }
    assert!((slope(&errors) - 1.0).abs() < 0.15, "{errors:?}");
    // It swings on the spring of what has stopped, μ g / √(4 k/m) at most.
    assert!(last[1].abs() < 3.0 / (4.0 * STIFFNESS / MASS).sqrt(), "{last:?}");
    assert!((last[2] - 0.5 * MASS * v0 * v0).abs() < 1e-3, "{last:?}");
}

/// Two coefficients that are equal are one, to the last bit.
#[test]
fn equal_coefficients_are_one() {
    let rows = |friction: &str| go(&lying(friction, &brick(5e-6, 0.3), PLANE, PUSH), &mut motion).rows;
    assert_eq!(rows("0.25"), rows("{ static = 0.25, kinetic = 0.25, decay = 1.0 }"));
}
