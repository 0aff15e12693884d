//! What slides far within a load step, over whole elements, and what just touches: friction does not forget.

use super::go;
use crate::support::{read_deck, run};
use rdsolve::solve::{Frame, Outcome};

/// The force with which all are pressed, the stiffness of contacts and the coefficient of friction.
const PRESSED: f64 = 2000.0;
const STIFFNESS: f64 = 1e7;
const FRICTION: f64 = 0.3;

/// Pressed within the first second, then drawn there and back by so much a second, in so many steps a second.
fn deck(steps: usize, end: f64, [dx, dy]: [f64; 2], name: &str, scene: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "static", end_time = {end:?}, time_step = {:?} }}
        output = {{ energy = true, contacts = true, every = 1 }}
        materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
        amplitudes.press = {{ kind = "table", points = [[0.0, 0.0], [1.0, 1.0]] }}
        amplitudes.draw = {{ kind = "table", points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [3.0, 0.0]] }}
        [[supports]]
        at = "{name}"
        fix = ["rx", "ry", "rz"]
        motion = {{ ux = {{ amplitude = "draw", scale = {dx:?} }}, uy = {{ amplitude = "draw", scale = {dy:?} }} }}
        [[loads]]
        at = "{name}"
        force = [0.0, 0.0, -{PRESSED:?}]
        amplitude = "press"
        {scene}
        [[contacts]]
        name = "on"
        surface = {{ part = "lower", edges = true }}
        with = "{name}"
        stiffness = {STIFFNESS:?}
        friction = {FRICTION:?}
        "#,
        1.0 / steps as f64
    )
}

/// Two rigid sheets, one on the edge of the other across it, of so many elements.
fn sheets(elements: usize) -> String {
    let sheet = |name: &str, corners: &str| {
        format!(
            "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = {elements}\nthickness = 0.01\nmaterial = \"steel\"\nrigid = true\n"
        )
    };
    "[[supports]]\nat = \"lower\"\nfix = \"all\"\n[points]\n\
     a = [-0.25, 0.0, -0.5]\nb = [0.25, 0.0, -0.5]\nc = [0.25, 0.0, 0.0]\nd = [-0.25, 0.0, 0.0]\n\
     e = [0.017, -0.237, 0.01]\nf = [0.017, 0.263, 0.01]\ng = [0.017, 0.263, 0.51]\nh = [0.017, -0.237, 0.51]\n"
        .to_owned()
        + &sheet("lower", r#""a", "b", "c", "d""#)
        + &sheet("upper", r#""e", "f", "g", "h""#)
}

/// A ball on a rigid sheet of elements of 50 mm.
fn ball(radius: f64) -> String {
    format!(
        "[[supports]]\nat = \"lower\"\nfix = \"all\"\n[points]\n\
         p = [-0.5, -0.5, 0.0]\nq = [0.5, -0.5, 0.0]\nr = [0.5, 0.5, 0.0]\ns = [-0.5, 0.5, 0.0]\n\
         [[shells]]\nname = \"lower\"\ncorners = [\"p\", \"q\", \"r\", \"s\"]\nelements = 20\nthickness = 0.02\nmaterial = \"steel\"\nrigid = true\n\
         [[bodies]]\nname = \"ball\"\ncenter = [-0.17, 0.017, {:?}]\nshape = {{ kind = \"sphere\", radius = {radius:?} }}\nmass = 1.0\n",
        0.01 + radius
    )
}

/// Step, force along the way and what friction has dissipated.
fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let force = frame.derived.contacts[0].f;
    vec![frame.state.time, force.x.hypot(force.y), e.friction, e.numerical]
}

/// It slips once the spring is stretched by μN/k, and on the way back once it is stretched as much the other way: whatever the steps, and
/// however many elements a step leads over.
#[test]
fn the_work_of_friction_is_its_force_times_the_way() {
    let limit = FRICTION * PRESSED;
    let draws = [([0.0, 0.2], 0.2), ([0.02, 0.2], 0.2f64.hypot(0.02))];
    let scenes = [(sheets(10), "upper"), (sheets(50), "upper"), (ball(0.1), "ball"), (ball(0.01), "ball")];
    for (scene, name) in &scenes {
        for (draw, way) in draws {
            for steps in [20, 10, 5] {
                let text = deck(steps, 3.0, draw, name, scene)
                    .replace("edges = true", if *name == "ball" { "edges = false" } else { "edges = true" });
                let done = go(&text, &mut watch);
                let exact = limit * (2.0 * way - 3.0 * limit / STIFFNESS);
                let last = done.rows.last().expect("rows");
                assert!((last[2] / exact - 1.0).abs() < 1e-6, "{name} {draw:?} {steps}: {last:?} for {exact}");
                for row in done.rows.iter().filter(|row| row[0] > 1.0 + 1e-9) {
                    assert!((row[1] / limit - 1.0).abs() < 1e-6, "{name} {draw:?} {steps}: {row:?}");
                }
            }
        }
    }
}

/// Elastic sheets of second order that just touch as they begin, and are pressed and then drawn: at the end they slip.
#[test]
fn what_just_touches_sticks_before_it_slips() {
    let scene =
        sheets(4).replace("rigid = true", "order = 2").replace("at = \"lower\"\nfix", "at = \"lower.edge1\"\nfix");
    let text = deck(10, 2.0, [0.05, 0.0], "upper", &scene)
        .replace("at = \"upper\"", "at = \"upper.edge3\"")
        .replace("force = [0.0, 0.0, -2000.0]", "force_per_length = [0.0, 0.0, -4000.0]");
    let done = go(&text, &mut watch);
    let last = done.rows.last().expect("rows");
    // The tolerance of the iteration, and the tilt of what is bent.
    assert!((last[1] / (FRICTION * PRESSED) - 1.0).abs() < 1e-2 && last[2] > 25.0, "{last:?}");
}

/// A contact of faces, edges or a heap that begins closed holds what it presses on by itself.
#[test]
fn what_lies_on_faces_is_held_by_them() {
    let pressed = "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.25 }\noutput = { energy = true, contacts = true }\n\
                   materials.steel = { model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }\n";
    let on = |name: &str| {
        format!(
            "[[supports]]\nat = \"{name}\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
             [[loads]]\nat = \"{name}\"\nforce = [0.0, 0.0, -500.0]\n"
        )
    };
    let faces = ball(0.1).replace("0.11]", "0.10999]")
        + &on("ball")
        + "[[contacts]]\nname = \"on\"\nsurface = { part = \"lower\" }\nwith = \"ball\"\nstiffness = 1e6\n";
    let edges = sheets(5).replace("0.01]", "0.00999]").replace("0.51]", "0.50999]")
        + &on("upper")
        + "[[contacts]]\nname = \"on\"\nsurface = { part = \"lower\", edges = true }\nwith = [\"upper\", \"upper.edge1\"]\nstiffness = 1e6\n";
    let solid = |name: &str, z: f64, size: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [0.0, 0.0, {z:?}]\nshape = {{ kind = \"box\", size = [{size:?}, {size:?}, 0.2] }}\nmass = 1.0\n"
        )
    };
    let heap = solid("low", 0.0, 1.0)
        + &solid("top", 0.19999, 0.3)
        + "[[supports]]\nat = \"low\"\nfix = \"all\"\n"
        + &on("top")
        + "[[contacts]]\nname = \"on\"\namong = [\"low\", \"top\"]\nstiffness = 1e6\n";
    for (scene, name, points) in [(&faces, "ball", 1.0), (&edges, "upper", 1.0), (&heap, "top", f64::NAN)] {
        let model = read_deck(&format!("{pressed}{scene}"));
        let node = model.bodies.iter().find(|body| body.name == name).expect("a body").node;
        let done = run(&model, &mut |frame| vec![frame.state.nodes[node].x.z - frame.model.nodes[node].x.z]);
        assert!(matches!(done.outcome, Outcome::Done), "{name}: {:?}", done.outcome);
        // It begins 10 μm deep; the load presses it 500/1e6 deep.
        let sinks = -done.rows.last().expect("rows")[0];
        assert!(points.is_nan() || (sinks - (500.0 / 1e6 - 1e-5)).abs() < 1e-9, "{name}: {sinks}");
        assert!(sinks > 1e-5 && sinks < 1e-3, "{name}: {sinks}");
    }
}
