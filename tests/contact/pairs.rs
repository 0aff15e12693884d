//! contacts.csv and contact_pairs.csv: who presses whom, on which side the force is counted, about which point the moment.

use crate::support::{Row, read_deck, tables_of};

/// A plate of 10 x 10 elements held at two edges, and a block of 10 kg that is let down on it by its weight.
fn plate_and_block(size: f64, surface: &str) -> Vec<Vec<Row>> {
    let text = format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0 }}
        environment = {{ gravity = [0.0, 0.0, -9.81] }}
        output = {{ contacts = {{ by = "both" }} }}
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
        name = "plate"
        corners = ["a", "b", "c", "d"]
        elements = [10, 10]
        thickness = 0.01
        material = "steel"
        [[supports]]
        at = ["plate.edge1", "plate.edge3"]
        fix = ["ux", "uy", "uz"]
        [[bodies]]
        name = "block"
        center = [0.5, 0.5, 0.055]
        mass = 10.0
        shape = {{ kind = "box", size = [{size}, {size}, 0.1] }}
        [[supports]]
        at = "block"
        fix = ["ux", "uy", "rx", "ry", "rz"]
        [[contacts]]
        name = "lie"
        {surface}
        stiffness = 1e7
        "#
    );
    let tables = tables_of(&read_deck(&text));
    ["contacts.csv", "contact_pairs.csv"].map(|file| tables.rows(file)).into()
}

fn wrench(row: &Row) -> [f64; 6] {
    ["fx", "fy", "fz", "mx", "my", "mz"].map(|column| row.number(column))
}

fn near(found: [f64; 6], wanted: [f64; 6], tolerance: f64) {
    let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < tolerance, "{found:?} for {wanted:?}");
}

/// The weight of the block presses the plate downward, whether the corners of the block touch the faces of the plate or the nodes of
/// the plate the faces of the block; about the origin, in both tables.
#[test]
fn a_block_presses_a_plate_by_corners_and_by_faces() {
    let weight = 10.0 * 9.81;
    for size in [0.5, 3.0] {
        let tables = plate_and_block(size, "surface = { part = \"plate\" }\nwith = [\"block\"]");
        for rows in &tables {
            let last = rows.last().expect("rows");
            near(wrench(last), [0.0, 0.0, -weight, -0.5 * weight, 0.5 * weight, 0.0], 1e-6 * weight);
        }
        let last = tables[1].last().expect("rows");
        assert_eq!(["contact", "surface", "with"].map(|column| last.text(column)), ["lie", "plate", "block"]);
        assert_eq!(last.number("touching"), tables[0].last().expect("rows").number("touching"));
    }
}

/// The other way round the block is the surface, and the moment of contacts.csv is about its centre.
#[test]
fn a_plate_presses_a_block() {
    let weight = 10.0 * 9.81;
    let tables = plate_and_block(3.0, "surface = { body = \"block\" }\nwith = [\"plate\"]");
    let [contact, pair] = [0, 1].map(|k| tables[k].last().expect("rows"));
    assert_eq!(["surface", "with"].map(|column| pair.text(column)), ["block", "plate"]);
    // Supports take the rest of the moment: the force may stand anywhere below the block.
    let [_, _, fz, mx, my, _] = wrench(contact);
    assert!((fz - weight).abs() < 1e-6 * weight, "{fz}");
    let about_origin = [0.0, 0.0, weight, mx + 0.5 * weight, my - 0.5 * weight, 0.0];
    near(wrench(pair), about_origin, 1e-6 * weight);
}

/// Three blocks, one upon the other on the ground: each carries what is above it, and between each two is one row.
#[test]
fn blocks_in_a_stack() {
    let block = |name: &str, z: f64, mass: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [0.3, 0.2, {z}]\nmass = {mass}\nshape = {{ kind = \"box\", size = [0.2, 0.2, 0.2] }}\n"
        )
    };
    let text = format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.5, time_step = 1e-3 }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        output = {{ contacts = {{ by = "pairs" }} }}
        {}
        {}
        {}
        [[contacts]]
        name = "stack"
        among = ["upper", "lower", "middle"]
        stiffness = 1e6
        damping = 0.5
        [[contacts]]
        name = "floor"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = ["lower", "middle"]
        stiffness = 1e6
        damping = 0.5
        "#,
        block("lower", 0.1, 3.0),
        block("middle", 0.3, 2.0),
        block("upper", 0.5, 1.0),
    );
    let tables = tables_of(&read_deck(&text));
    let rows = tables.rows("contact_pairs.csv");
    let last: Vec<&Row> = rows.iter().filter(|row| row.number("time") == 0.5).collect();
    let pairs =
        [("stack", "lower", "middle", 30.0), ("stack", "middle", "upper", 10.0), ("floor", "ground", "lower", 60.0)];
    assert_eq!(last.len(), pairs.len());
    for (row, (contact, surface, with, force)) in last.into_iter().zip(pairs) {
        assert_eq!(["contact", "surface", "with"].map(|column| row.text(column)), [contact, surface, with]);
        // What is left of the settling.
        near(wrench(row), [0.0, 0.0, -force, -0.2 * force, 0.3 * force, 0.0], 1e-2 * force);
    }
}
