//! Forces and moments in the tables of results against equilibrium: every column, with its sign and in its axes.

use crate::support::{read_deck, tables_of};
use rdsolve::math::{Mat3, Vec3};
use std::collections::HashMap;

/// The end of the frame of [`frame`], what acts there, and the corner.
const TIP: Vec3 = Vec3::new(1.5, 0.0, 2.0);
const KNEE: Vec3 = Vec3::new(0.0, 0.0, 2.0);
const FORCE: Vec3 = Vec3::new(300.0, -500.0, 700.0);
const MOMENT: Vec3 = Vec3::new(110.0, 130.0, -170.0);
/// How far the foot turns about z.
const TURN: f64 = 1.1;

/// A frame of two legs, so stiff that it keeps its shape, clamped at its foot, which turns about z while the loads keep their
/// directions: statically determinate.
fn frame(path: &str, section: &str) -> String {
    let vector = |v: Vec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 0.125 }}
        output = {{ sections = true }}
        amplitudes.ramp = {{ kind = "ramp", end = 1.0 }}
        {section}
        [points]
        foot = [0.0, 0.0, 0.0]
        knee = {}
        tip = {}
        [[beams]]
        name = "frame"
        path = [{path}]
        elements = 2
        order = 3
        section = "stiff"
        orientation = [1.0, 2.0, 1.0]
        [[supports]]
        at = "foot"
        fix = ["ux", "uy", "uz", "rx", "ry"]
        motion.rz = {{ amplitude = "ramp", scale = {TURN} }}
        [[loads]]
        at = "tip"
        force = {}
        moment = {}
        "#,
        vector(KNEE),
        vector(TIP),
        vector(FORCE),
        vector(MOMENT),
    )
}

const STIFFNESSES: &str = r#"sections.stiff = { shape = "general", axial_stiffness = 1e10, shear_stiffness = [2e10, 3e10], torsional_stiffness = 4e10, bending_stiffness = [5e10, 6e10], mass_per_length = 1.0, inertia_per_length = [1.0, 1.0, 1.0] }"#;
/// Fibres that do not come to yield.
const FIBRES: &str = r#"
        sections.stiff = { shape = "rectangle", width = 0.2, height = 0.3 }
        materials.stiff = { model = "elastic-plastic", youngs_modulus = 1e13, poisson_ratio = 0.3, density = 1.0, yield_stress = 1e11 }"#;

/// Section axes of a leg from one point to another: x along it, y in the plane of x and the orientation.
fn section_axes(from: Vec3, to: Vec3) -> Mat3 {
    let x = (to - from).normalize();
    let orientation = Vec3::new(1.0, 2.0, 1.0);
    let y = (orientation - orientation.dot(&x) * x).normalize();
    Mat3::from_columns(&[x, y, x.cross(&y)])
}

/// What the part of the frame beyond a section, as seen from the start of the path, exerts on the part before it balances what
/// acts on the part of the tip; section axes turn with the frame.
#[test]
fn sections_of_a_determinate_frame_are_in_equilibrium() {
    let (sin, cos) = TURN.sin_cos();
    let turn = Mat3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    let foot = Vec3::zeros();
    let fibres = FIBRES;
    for (section, material) in [(STIFFNESSES, ""), (fibres, "material = \"stiff\"")] {
        for (path, places, sign) in [
            (r#""foot", "knee", "tip""#, [foot, KNEE, TIP], 1.0),
            (r#""tip", "knee", "foot""#, [TIP, KNEE, foot], -1.0),
        ] {
            let deck = frame(path, section).replace("order = 3\n", &format!("order = 3\n{material}\n"));
            let rows = tables_of(&read_deck(&deck)).rows("sections.csv");
            let last: Vec<_> = rows.iter().filter(|row| row.number("time") == 1.0).collect();
            assert_eq!(last.len(), 12, "three points in each of four elements");
            for row in last {
                let s = row.number("s");
                let first = (places[1] - places[0]).norm();
                let (leg, along) = if s < first { (0, s) } else { (1, s - first) };
                let axes = section_axes(places[leg], places[leg + 1]);
                let at = turn * (places[leg] + along * axes.column(0));
                let axes = (turn * axes).transpose();
                let n = sign * axes * FORCE;
                let m = sign * axes * (MOMENT + (turn * TIP - at).cross(&FORCE));
                let columns = ["N", "Vy", "Vz", "T", "My", "Mz"];
                for (column, expected) in columns.into_iter().zip(n.iter().chain(m.iter())) {
                    let value = row.number(column);
                    // What is left bends by 1e-7, and residuals are 1e-8 of what the stiff legs could bear.
                    assert!((value - expected).abs() < 1e-2, "{path} at {s}: {column} {value}, {expected} expected");
                    assert!(expected.abs() > 10.0, "{column} would show no sign at {s}: {expected}");
                }
                assert_eq!(row.number("plastic_strain"), 0.0);
            }
        }
    }
}

/// A ball that slides and spins on a surface of a body that is held.
fn sliding(surface: &str, start: [f64; 3], velocity: [f64; 3]) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.02, time_step = 1e-4 }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        output = {{ contacts = true, reactions = true, every = 20 }}
        [[bodies]]
        name = "ball"
        center = {start:?}
        shape = {{ kind = "sphere", radius = 0.1 }}
        mass = 2.0
        velocity = {velocity:?}
        angular_velocity = [3.0, -4.0, 5.0]
        [[bodies]]
        name = "stand"
        center = [0.7, -0.4, -0.9]
        mass = 1e-9
        inertia = [1e-9, 1e-9, 1e-9]
        [[supports]]
        at = "stand"
        fix = "all"
        [[contacts]]
        name = "rub"
        surface = {surface}
        with = "ball"
        stiffness = 1e5
        friction = 0.3
        "#
    )
}

/// What a contact exerts on a body that is held, its supports take: forces, and moments about its centre. Friction pulls the
/// surface along with the ball, and its force acts where they touch, not at the centre of the ball.
#[test]
fn contacts_exert_what_supports_take() {
    let surfaces = [
        (r#"{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], body = "stand" }"#, Vec3::z()),
        (r#"{ shape = "box", center = [0.2, 0.1, -0.5], size = [3.0, 3.0, 1.0], body = "stand" }"#, Vec3::z()),
        (r#"{ shape = "sphere", center = [0.0, 0.0, -2.0], radius = 2.0, body = "stand" }"#, Vec3::z()),
        (
            r#"{ shape = "cylinder", center = [0.0, 0.0, -2.0], axis = [0.0, 1.0, 0.0], radius = 2.0, length = 4.0, body = "stand" }"#,
            Vec3::z(),
        ),
        (
            r#"{ shape = "capsule", ends = [[0.0, -2.0, -2.0], [0.0, 2.0, -2.0]], radius = 2.0, body = "stand" }"#,
            Vec3::z(),
        ),
    ];
    for (surface, normal) in surfaces {
        let tables = tables_of(&read_deck(&sliding(surface, [0.0, 0.0, 0.0998], [0.6, 0.8, 0.0])));
        let mut reactions = HashMap::new();
        for row in tables.rows("reactions.csv").iter().filter(|row| row.text("node") == "stand") {
            reactions.insert((row.text("step").to_string(), row.text("direction").to_string()), row.number("value"));
        }
        let balls = tables.rows("bodies.csv");
        let contacts = tables.rows("contacts.csv");
        assert!(contacts.len() > 5);
        for row in contacts.iter().filter(|row| row.number("time") > 0.0) {
            let step = row.text("step");
            assert_eq!(row.number("touching"), 1.0, "{surface} at step {step}");
            let wrench: [f64; 6] = ["fx", "fy", "fz", "mx", "my", "mz"].map(|column| row.number(column));
            let size = Vec3::new(wrench[0], wrench[1], wrench[2]).norm();
            for (value, direction) in wrench.into_iter().zip(["ux", "uy", "uz", "rx", "ry", "rz"]) {
                let taken = reactions[&(step.to_string(), direction.to_string())];
                assert!(
                    (value + taken).abs() < 2e-5 * size,
                    "{surface}, {direction}: {value}, the support takes {taken}"
                );
            }
            let ball = balls.iter().find(|ball| ball.text("body") == "ball" && ball.text("step") == step).unwrap();
            let [x, v, omega] = [["x", "y", "z"], ["vx", "vy", "vz"], ["wx", "wy", "wz"]]
                .map(|columns| Vec3::from(columns.map(|column| ball.number(column))));
            let (f, m) = (Vec3::from_row_slice(&wrench[..3]), Vec3::from_row_slice(&wrench[3..]));
            // The surface is all but level where the ball slides in the first 0.02 s, over 0.02.
            let touch = x - 0.1 * normal;
            let slip = v - 0.1 * omega.cross(&normal);
            let friction = f - f.dot(&normal) * normal;
            assert!(
                f.dot(&normal) < 0.0 && friction.dot(&slip) > 0.29 * f.norm() * slip.norm() * 0.9,
                "{surface}: {f:?}"
            );
            let arm = touch - Vec3::new(0.7, -0.4, -0.9);
            assert!((m - arm.cross(&f)).norm() < 5e-3 * m.norm(), "{surface}: {m:?}, {:?} expected", arm.cross(&f));
            // With the force at the centre of the ball the moment would be another.
            assert!((m - (arm + 0.1 * normal).cross(&f)).norm() > 2.5e-2 * m.norm());
        }
    }
}

/// A point that moves at constant speed on a straight line, on springs and dampers between it and the ground.
const LINKS: &str = r#"
    analysis = { kind = "dynamic", end_time = 1.0, time_step = 0.1 }
    output = { links = true }
    points.p = [1.0, 2.0, -1.0]
    amplitudes.even = { kind = "table", points = [[0.0, 0.0], [2.0, 2.0]] }
    [[masses]]
    at = "p"
    mass = 1.0
    [[supports]]
    at = "p"
    fix = "rotations"
    motion = { ux = { amplitude = "even", scale = 0.5 }, uy = { amplitude = "even", scale = -1.5 }, uz = { amplitude = "even", scale = 0.25 } }
    [[links]]
    name = "strut"
    from = { ground = [0.0, 0.0, 0.0] }
    to = { node = "p" }
    stiffness = 100.0
    damping = 30.0
    free_length = 2.0
    [[links]]
    name = "turned round"
    from = { node = "p" }
    to = { ground = [0.0, 0.0, 0.0] }
    stiffness = 100.0
    damping = 30.0
    free_length = 2.0
    [[links]]
    name = "directed"
    from = { ground = [0.0, 0.0, 0.0] }
    to = { node = "p" }
    direction = [0.6, 0.8, 0.0]
    stiffness = 100.0
    damping = 30.0
    [[links]]
    name = "rope"
    from = { ground = [0.0, 0.0, 0.0] }
    to = { node = "p" }
    law = "tension-only"
    stiffness = 100.0
    damping = 30.0
    free_length = 1.0
    [[links]]
    name = "bushing"
    from = { ground = [1.0, 2.0, -1.0] }
    to = { node = "p" }
    bushing = [100.0, 200.0, 300.0, 0.0, 0.0, 0.0]
    bushing_damping = [30.0, 20.0, 10.0, 0.0, 0.0, 0.0]
"#;

/// Elongation, its rate, and force with the damper's share, along the link; on its first end as components.
#[test]
fn links_show_elongation_rate_and_damper() {
    let tables = tables_of(&read_deck(LINKS));
    let rows = tables.rows("links.csv");
    assert_eq!(rows.len(), 5 * 11);
    let (start, velocity) = (Vec3::new(1.0, 2.0, -1.0), Vec3::new(0.5, -1.5, 0.25));
    let mut dampers = 0;
    for row in &rows {
        let time = row.number("time");
        let x = start + time * velocity;
        let along = x.normalize();
        let fixed = Vec3::new(0.6, 0.8, 0.0);
        let spring = |delta: f64, rate: f64| 100.0 * delta + 30.0 * rate;
        let (delta, rate, force, f) = match row.text("link") {
            name @ ("strut" | "turned round") => {
                let (delta, rate) = (x.norm() - 2.0, along.dot(&velocity));
                let force = spring(delta, rate);
                (delta, rate, force, if name == "strut" { force * along } else { -force * along })
            }
            "directed" => {
                let (delta, rate) = (fixed.dot(&(x - start)), fixed.dot(&velocity));
                (delta, rate, spring(delta, rate), spring(delta, rate) * fixed)
            }
            "rope" => {
                let (delta, rate) = (x.norm() - 1.0, along.dot(&velocity));
                let force = if delta > 0.0 { spring(delta, rate).max(0.0) } else { 0.0 };
                (delta, rate, force, force * along)
            }
            "bushing" => {
                let d = x - start;
                let f = Vec3::new(100.0, 200.0, 300.0).component_mul(&d)
                    + Vec3::new(30.0, 20.0, 10.0).component_mul(&velocity);
                (d.x, velocity.x, f.x, f)
            }
            other => panic!("no link {other}"),
        };
        let shown = ["elongation", "rate", "force", "fx", "fy", "fz"].map(|column| row.number(column));
        let expected = [delta, rate, force, f.x, f.y, f.z];
        for (column, (shown, expected)) in shown.into_iter().zip(expected).enumerate() {
            assert!(
                (shown - expected).abs() < 1e-9,
                "{} at {time}: {shown}, {expected} expected ({column})",
                row.text("link")
            );
        }
        dampers += usize::from(rate < -0.5);
    }
    assert!(dampers > 20, "links that shorten: {dampers}");
}
