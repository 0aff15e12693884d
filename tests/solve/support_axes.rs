//! Supports along axes of their own: the scene turned with its axes moves as the scene about global axes. Supports that lead to a place.

use crate::support::{read_deck, run_source, tables_of};
use rdsolve::diagnostic::Source;
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::model::Model;

/// A frame with a roller, a sliding guide that is moved, and a force, all turned by `R`; the supports have axes where it is turned.
fn frame(analysis: &str, R: &Mat3) -> Model {
    let turned = |v: [f64; 3]| {
        let v = R * Vec3::from(v);
        format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
    };
    let axes = match *R == Mat3::identity() {
        true => String::new(),
        false => format!("axes = [{}, {}],", turned([2.0, 0.0, 0.0]), turned([1.0, 0.5, 0.0])),
    };
    read_deck(&format!(
        r#"
        {analysis}
        materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25, density = 8000.0 }} }}
        sections = {{ square = {{ shape = "rectangle", width = 0.1, height = 0.2 }} }}
        points = {{ a = {a}, b = {b}, c = {c} }}
        beams = [{{ name = "frame", path = ["a", "b", "c"], elements = 2, material = "steel", section = "square",
                    orientation = {across} }}]
        supports = [{{ {axes} at = "a", fix = ["ux", "uz", "rx", "ry", "rz"], motion = {{ uy = {{ amplitude = "wave", scale = 0.02 }} }} }},
                    {{ {axes} at = "c", fix = "uz" }}]
        amplitudes = {{ wave = {{ kind = "sine-squared", angular_frequency = 60.0 }}, full = {{ kind = "ramp", start = 0.0, end = 0.02 }} }}
        loads = [{{ at = "c", force = {force}, amplitude = "full" }}]
        output = {{ nodes = "all", reactions = true }}
        "#,
        a = turned([0.0, 0.0, 0.0]),
        b = turned([1.0, 0.2, 1.0]),
        c = turned([2.0, 0.0, 0.5]),
        across = turned([0.0, 1.0, 0.3]),
        force = turned([2e4, 3e4, 0.0]),
    ))
}

/// The last displacement of each point, and the sum of the reactions, in the axes of the scene.
fn result(model: &Model, R: &Mat3) -> Vec<Vec3> {
    let tables = tables_of(model);
    let rows = tables.rows("nodes.csv");
    let end = rows.last().unwrap().number("step");
    let last = |node: &str| {
        // Points of supports have the names of their nodes, and follow them.
        let row = rows.iter().find(|row| row.number("step") == end && row.text("node") == node).unwrap();
        R.transpose() * Vec3::new(row.number("ux"), row.number("uy"), row.number("uz"))
    };
    let reactions = tables.rows("reactions.csv");
    let sum = |direction: &str| -> f64 {
        let here = reactions.iter().filter(|row| row.number("step") == end && row.text("direction") == direction);
        here.map(|row| row.number("value")).sum()
    };
    vec![last("a"), last("b"), last("c"), R.transpose() * Vec3::new(sum("ux"), sum("uy"), sum("uz"))]
}

#[test]
fn a_turned_scene_moves_as_it_does_along_global_axes() {
    let turned = rotation::matrix(&rotation::exp(&Vec3::new(0.4, -0.7, 0.3)));
    for (analysis, tolerance) in [
        // One factorization; multipliers in place of elimination.
        (r#"analysis = { kind = "static", geometry = "linear", end_time = 0.02 }"#, 1e-9),
        // The iteration's tolerance.
        (r#"analysis = { kind = "static", end_time = 0.02, time_step = 0.01 }"#, 1e-7),
        // An equation in place of a given motion: both are of second order, 1.8e-2 apart with a step of 0.002.
        (r#"analysis = { kind = "dynamic", end_time = 0.02, time_step = 0.0005 }"#, 3e-3),
        (
            "analysis = { kind = \"dynamic\", end_time = 0.002, time_step = 1e-5 }\nintegrator = { scheme = \"central-difference\" }",
            1e-6,
        ),
    ] {
        let along = result(&frame(analysis, &Mat3::identity()), &Mat3::identity());
        let other = result(&frame(analysis, &turned), &turned);
        for (a, b) in along.iter().zip(&other) {
            println!("{analysis}: {:.6e} {:.1e}", a.norm(), (a - b).norm());
        }
        let moved = along[2].norm();
        for (a, b) in along[..3].iter().zip(&other) {
            assert!((a - b).norm() < tolerance * moved, "{analysis}: {a} {b}");
        }
        let (a, b) = (along[3], other[3]);
        assert!((a - b).norm() < 100.0 * tolerance * a.norm(), "{analysis}: {a} {b}");
    }
}

/// Two beams on an inclined roller: a cantilever whose tip slides along n⊥: R = −(n·C f)/(n·C n) with the flexibility C of its tip.
#[test]
fn an_inclined_roller_has_its_closed_form() {
    let model = read_deck(
        r#"
        analysis = { kind = "static", geometry = "linear" }
        materials = { steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25 } }
        sections = { square = { shape = "rectangle", width = 0.1, height = 0.2 } }
        points = { a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }
        beams = [{ name = "beam", path = ["a", "b"], elements = 1, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0] }]
        supports = [{ at = "a", fix = "all" }, { at = "b", axes = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]], fix = ["ux"] }]
        loads = [{ at = "b", force = [0.0, 0.0, -1e5] }]
        output = { reactions = true }
        "#,
    );
    let (length, E, G, area) = (2.0f64, 2e11, 0.8e11, 0.02);
    let shear = model.stiffnesses[0].N[(2, 2)] / G;
    let C = [length / (E * area), length.powi(3) / (3.0 * E * 0.1 * 0.2f64.powi(3) / 12.0) + length / (G * shear)];
    let n = [0.6, 0.8];
    let R = 1e5 * n[1] * C[1] / (n[0] * n[0] * C[0] + n[1] * n[1] * C[1]);
    let tables = tables_of(&model);
    let tip = tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "b").unwrap();
    let expected = [R * n[0] * C[0], (R * n[1] - 1e5) * C[1]];
    assert!((tip.number("ux") / expected[0] - 1.0).abs() < 1e-9, "{} {expected:?}", tip.number("ux"));
    assert!((tip.number("uz") / expected[1] - 1.0).abs() < 1e-9, "{} {expected:?}", tip.number("uz"));
    let reactions = tables.rows("reactions.csv");
    let of = |direction: &str| {
        let row = reactions.iter().rfind(|row| row.text("node") == "b" && row.text("direction") == direction);
        row.unwrap().number("value")
    };
    assert!((of("ux") / (R * n[0]) - 1.0).abs() < 1e-9 && (of("uz") / (R * n[1]) - 1.0).abs() < 1e-9);
}

/// A roller that comes when the tip has turned keeps the axis of the deck: the tip no longer moves along it.
#[test]
fn axes_of_a_later_stage_stay_as_they_are() {
    let text = r#"
        materials = { steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25 } }
        sections = { strip = { shape = "rectangle", width = 0.1, height = 0.02 } }
        points = { a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }
        beams = [{ name = "beam", path = ["a", "b"], elements = 2, material = "steel", section = "strip", orientation = [0.0, 1.0, 0.0] }]
        supports = [{ at = "a", fix = "all" },
                    { at = "b", stages = "slide", axes = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]], fix = ["ux"] }]
        loads = [{ at = "b", force = [0.0, 0.0, -3e3] }, { at = "b", stages = "slide", force = [-2e3, 0.0, 0.0] }]
        stages = [{ name = "bend", kind = "static", duration = 1.0, time_step = 0.25 },
                  { name = "slide", kind = "static", duration = 1.0, time_step = 0.25 }]
    "#;
    let mut tip = 0;
    let done = run_source(&Source::new("deck.toml", text, &[]), &mut |frame| {
        tip = frame.model.nodes.iter().position(|node| node.label == "b").unwrap();
        let node = &frame.state.nodes[tip];
        vec![frame.state.time, node.x.x, node.x.z, rotation::log(&node.rotation).y]
    });
    let at = |time: f64| done.rows.iter().rfind(|row| (row[0] - time).abs() < 1e-9).unwrap().clone();
    let (bent, slid) = (at(1.0), at(2.0));
    assert!(bent[3].abs() > 0.2, "{bent:?}");
    let moved = [slid[1] - bent[1], slid[2] - bent[2]];
    assert!(moved[0].hypot(moved[1]) > 1e-4, "{moved:?}");
    // What multipliers leave open in an iteration that has converged.
    assert!((0.6 * moved[0] + 0.8 * moved[1]).abs() < 1e-8, "{moved:?}");
}

/// A spring that a force has lengthened is led to a place: the reaction is what the spring takes there, less the force.
#[test]
fn a_support_leads_to_a_place_from_wherever_it_begins() {
    let text = r#"
        points = { a = [1.0, 0.0, 0.0] }
        links = [{ name = "spring", from = { ground = [0.0, 0.0, 0.0] }, to = { node = "a" }, stiffness = 1000.0 }]
        supports = [{ at = "a", fix = ["uy", "uz"] },
                    { at = "a", stages = ["lead", "hold"], motion = { ux = { to = 0.05 } } },
                    { at = "a", stages = "back", motion = { ux = { to = -0.02 } } }]
        loads = [{ at = "a", force = [20.0, 0.0, 0.0] }]
        stages = [{ name = "pull", kind = "static", duration = 1.0, time_step = 0.5 },
                  { name = "lead", kind = "static", duration = 1.0, time_step = 0.5 },
                  { name = "hold", kind = "static", duration = 1.0, time_step = 0.5 },
                  { name = "free", kind = "static", duration = 1.0, time_step = 0.5 },
                  { name = "back", kind = "static", duration = 1.0, time_step = 0.5 }]
        output = { reactions = true }
    "#;
    let done = run_source(&Source::new("deck.toml", text, &[]), &mut |frame| {
        vec![frame.state.time, frame.state.nodes[0].x.x - 1.0]
    });
    let last = |time: f64| done.rows.iter().rfind(|row| (row[0] - time).abs() < 1e-9).unwrap()[1];
    for (time, exact) in [(1.0, 0.02), (2.0, 0.05), (3.0, 0.05), (4.0, 0.02), (5.0, -0.02)] {
        assert!((last(time) - exact).abs() < 1e-9, "{time}: {} {exact}", last(time));
    }
}
