//! Load steps with multipliers: nothing is pressed in, whatever the stiffness, and forces are those of exact constraints.

use super::go;
use crate::support::Done;
use rdsolve::solve::{Frame, Outcome};

/// Time; contact energy, friction, numerical; of each contact force, moment and gap; of each node its position.
fn all(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let mut row = vec![frame.state.time, e.contact, e.friction, e.numerical];
    row.extend(frame.derived.contacts.iter().flat_map(|of| [of.f.x, of.f.y, of.f.z, of.m.x, of.m.y, of.m.z, of.gap]));
    row.extend(frame.state.nodes.iter().flat_map(|node| [node.x.x, node.x.y, node.x.z]));
    row
}

/// Of a run that comes to its end.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let Done { outcome, rows, warnings, .. } = go(&format!("output = {{ contacts = true }}\n{text}"), &mut all);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    assert!(warnings.is_empty(), "{warnings:?}");
    rows
}

fn near(found: f64, wanted: f64, tolerance: f64, what: &str) {
    assert!((found - wanted).abs() <= tolerance, "{what}: {found:e} for {wanted:e}");
}

const FORCE: usize = 4;
const GAP: usize = FORCE + 6;

/// A block on a slope, its friction above the tangent: a spring this soft would be pressed in by a centimetre, half of the block, and let it
/// creep by a millimetre.
#[test]
fn a_block_on_a_slope_neither_sinks_nor_creeps() {
    let (c, s) = (0.1f64.cos(), 0.1f64.sin());
    let text = format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 0.25 }}
        environment = {{ gravity = [{:?}, 0.0, {:?}] }}
        [[bodies]]
        name = "block"
        center = [0.0, 0.0, 0.01]
        mass = 4.0
        shape = {{ kind = "box", size = [0.4, 0.2, 0.02] }}
        [[contacts]]
        name = "slope"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = "block"
        stiffness = 1e3
        friction = 0.4
        method = "augmented-lagrangian"
        "#,
        10.0 * s,
        -10.0 * c
    );
    let rows = rows(&text);
    let last = rows.last().expect("rows");
    let wanted = [40.0 * s, 0.0, -40.0 * c];
    // The tolerance of equilibria, 1e-8 of forces; of depth 1e-8 of the thickness, less than a nanometre.
    (0..3).for_each(|i| near(last[FORCE + i], wanted[i], 1e-6, "force"));
    near(last[GAP], 0.0, 2e-10, "gap");
    let first = &rows[0];
    for i in GAP + 1..GAP + 4 {
        near(last[i], first[i], 1e-9, "place");
    }
    near(last[1], 0.0, 0.0, "energy of multipliers");
}

/// A cantilever under an even load, whose tip rests on a plane by multipliers or on a support: the same forces and shape.
#[test]
fn a_propped_beam_is_that_on_a_support() {
    let beam = |tip: &str| {
        format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.5 }}
            [materials.steel]
            model = "elastic"
            youngs_modulus = 210e9
            poisson_ratio = 0.3
            density = 7850.0
            [sections.square]
            shape = "rectangle"
            width = 0.05
            height = 0.05
            [points]
            a = [0.0, 0.0, 0.0]
            b = [2.0, 0.0, 0.0]
            [[beams]]
            name = "beam"
            path = ["a", "b"]
            elements = 8
            material = "steel"
            section = "square"
            orientation = [0.0, 0.0, 1.0]
            [[supports]]
            at = "a"
            fix = "all"
            [[loads]]
            part = "beam"
            force_per_length = [0.0, 0.0, -1000.0]
            {tip}
            "#
        )
    };
    let contact = |stiffness: &str| {
        let plane = "surface = { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }";
        beam(&format!(
            "[[contacts]]\nname = \"prop\"\n{plane}\nwith = \"b\"\nradius = 0.0\n{stiffness}\nmethod = \"augmented-lagrangian\""
        ))
    };
    let held = rows(&beam("[[supports]]\nat = \"b\"\nfix = [\"uz\"]"));
    let held = held.last().expect("rows");
    // Stiffer than the tip by far, as by default, as stiff, and five times as soft: 3 E I/L³ is 41 kN/m.
    for stiffness in ["", "stiffness = 4e4", "stiffness = 8e3"] {
        let propped = rows(&contact(stiffness));
        let propped = propped.last().expect("rows");
        // 3/8 q L, but for shear and the shortening of a bent beam: 1e-3.
        near(propped[FORCE + 2], -750.0, 2.0, stiffness);
        near(propped[GAP], 0.0, 2.1e-8, stiffness);
        // A tip that is out by 2e-8, of the deflection of 1e-3.
        for (found, wanted) in propped[GAP + 1..].iter().zip(&held[4..]) {
            near(*found, *wanted, 3e-8, stiffness);
        }
    }
}

/// A ball in a groove of planes at 60 degrees from the vertical normals: each bears W/(2 cos 60°).
#[test]
fn a_ball_in_a_groove() {
    let plane = |name: &str, x: f64| {
        format!(
            "[[contacts]]\nname = \"{name}\"\nsurface = {{ shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [{x:?}, 0.0, 0.5] }}\n\
             with = \"ball\"\nmethod = \"augmented-lagrangian\"\n"
        )
    };
    let text = format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0 }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        bodies = [{{ name = "ball", center = [0.0, 0.0, 0.2], mass = 1.0, shape = {{ kind = "sphere", radius = 0.1 }} }}]
        supports = [{{ at = "ball", fix = ["uy", "rx", "ry", "rz"] }}]
        {}{}"#,
        plane("left", 0.75f64.sqrt()),
        plane("right", -(0.75f64.sqrt()))
    );
    let rows = rows(&text);
    let last = rows.last().expect("rows");
    for (at, side) in [(FORCE, -1.0), (FORCE + 7, 1.0)] {
        near(last[at], side * 10.0 * 0.75f64.sqrt(), 1e-6, "across");
        near(last[at + 2], -5.0, 1e-6, "down");
        near(last[at + 6], 0.0, 2.1e-9, "gap");
    }
}

/// A block on a spring, pulled to and fro over a floor: it sticks to the last, then slips, and turns round as Coulomb's law says.
#[test]
fn a_pulled_block_sticks_and_slips() {
    let text = r#"
        analysis = { kind = "static", end_time = 5.0, time_step = 0.1 }
        bodies = [{ name = "block", center = [0.0, 0.0, 0.01], mass = 4.0, shape = { kind = "box", size = [0.4, 0.2, 0.02] } }]
        supports = [{ at = "block", fix = ["uy", "rx", "ry", "rz"] }]
        amplitudes.weight = { kind = "table", points = [[0.0, 0.0], [1.0, 1.0], [5.0, 1.0]] }
        amplitudes.pull = { kind = "table", points = [[0.0, 0.0], [1.0, 0.0], [2.0, 40.0], [4.0, -40.0], [5.0, 0.0]] }
        loads = [
            { at = "block", force = [0.0, 0.0, -40.0], amplitude = "weight" },
            { at = "block", force = [1.0, 0.0, 0.0], amplitude = "pull" },
        ]
        [[links]]
        name = "spring"
        from = { ground = [-1.0, 0.0, 0.01] }
        to = { body = "block" }
        law = "linear"
        stiffness = 1000.0
        [[contacts]]
        name = "floor"
        surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
        with = "block"
        stiffness = 2e3
        friction = 0.5
        method = "augmented-lagrangian"
    "#;
    let rows = rows(text);
    // μN = 20 N: it slips by 20 mm, sticks while the pull falls by 40 N to zero, goes back to -20 mm, and sticks there.
    let place = |t: f64| match t {
        t if t <= 1.5 => 0.0,
        t if t <= 2.0 => 0.04 * (t - 1.5),
        t if t <= 3.0 => 0.02,
        t if t <= 4.0 => 0.02 - 0.04 * (t - 3.0),
        _ => -0.02,
    };
    let slipped = |t: f64| place(t.min(2.0)) + (0.02 - place(t.max(2.0)));
    for row in &rows {
        let t = row[0];
        // Tolerances of depth, 2e-10 a step, and of equilibria.
        near(row[GAP + 1], place(t), 2e-8, &format!("place at {t}"));
        near(row[2], 20.0 * slipped(t), 1e-5, &format!("friction at {t}"));
        near(row[3], 0.0, 1e-5, &format!("balance at {t}"));
    }
}

/// Balls on each other, in line, on springs that the weight of all would press in by a millimetre: they stand as drawn.
#[test]
fn ten_balls_stand_as_drawn() {
    let mut text = String::from(
        "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.5 }\nenvironment = { gravity = [0.0, 0.0, -9.81] }\n",
    );
    for i in 0..10 {
        let z = 0.2 * (i as f64 + 0.5);
        text += &format!(
            "[[bodies]]\nname = \"b{i}\"\ncenter = [0.0, 0.0, {z:?}]\nmass = 10.0\nshape = {{ kind = \"sphere\", radius = 0.1 }}\n\
             [[supports]]\nat = \"b{i}\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n"
        );
    }
    for i in 0..10 {
        let surface = match i {
            0 => "{ shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }".to_owned(),
            i => format!("{{ body = \"b{}\" }}", i - 1),
        };
        text += &format!(
            "[[contacts]]\nname = \"c{i}\"\nsurface = {surface}\nwith = \"b{i}\"\nstiffness = 1e6\n\
             method = \"augmented-lagrangian\"\npenetration_tolerance = 1e-10\n"
        );
    }
    let rows = rows(&text);
    let (first, last) = (&rows[0], rows.last().expect("rows"));
    for i in 0..10 {
        near(last[FORCE + 7 * i + 2], -98.1 * (10 - i) as f64, 1e-5, "force");
        // A two-thousand-millionth of the size.
        near(last[GAP + 7 * i], 0.0, 1.1e-10, "gap");
    }
    // Ten gaps of the tolerance.
    for i in 0..10 {
        let z = FORCE + 70 + 3 * i + 2;
        near(last[z], first[z], 1.1e-9, "height");
    }
}

/// A block let down in load steps, all of which a spring takes within the tolerance, or in hundred times of it: contacts.csv has its weight.
#[test]
fn forces_are_those_of_the_equilibrium_whatever_the_tolerance() {
    for tolerance in [2e-6, 1e-8] {
        let text = format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.1 }}
            environment = {{ gravity = [0.0, 0.0, -10.0] }}
            [[bodies]]
            name = "block"
            center = [0.0, 0.0, 0.01]
            mass = 4.0
            shape = {{ kind = "box", size = [0.4, 0.2, 0.02] }}
            [[supports]]
            at = "block"
            fix = ["ux", "uy", "rz"]
            [[contacts]]
            name = "floor"
            surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
            with = "block"
            stiffness = 1e7
            method = "augmented-lagrangian"
            penetration_tolerance = {tolerance}
            "#
        );
        let rows = rows(&text);
        // Four corners carry 40 N: a spring each would be pressed in by 1e-6. The force errs as the equilibrium, 1e-8.
        let last = rows.last().expect("rows");
        near(last[FORCE + 2], -40.0, 1e-5, "force");
        assert!(last[GAP].abs() <= 1e-6_f64.min(tolerance) * (1.0 + 1e-6), "{}", last[GAP]);
    }
}
