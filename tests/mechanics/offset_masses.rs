//! Beams whose centres of mass lie beside the axis: by the beam along the line of the centres, by closed forms, and by what free motion conserves.

use crate::support::{node, position, read_deck, run_to_the_end, tables_of};
use nalgebra::Matrix6;
use rdsolve::math::{Mat3, Vec3, skew};

/// The centre of mass from the axis.
const CENTRE: [f64; 3] = [0.0, 0.15, -0.1];

/// Mass per length and its inertia about the centre, with a product.
const MASS: f64 = 1.3;
const INERTIA: Mat3 = Mat3::new(0.05, 0.0, 0.0, 0.0, 0.02, 0.004, 0.0, 0.004, 0.03);

/// A matrix by blocks, as rows of the deck.
fn rows(blocks: [Mat3; 4]) -> String {
    let mut M = Matrix6::zeros();
    for (k, block) in blocks.iter().enumerate() {
        M.fixed_view_mut::<3, 3>(3 * (k / 2), 3 * (k % 2)).copy_from(block);
    }
    let rows: Vec<Vec<f64>> = (0..6).map(|i| M.row(i).iter().copied().collect()).collect();
    format!("{rows:?}")
}

/// A section whose elastic axis and mass lie at `c` from the axis: Γ of that place is Γ + κ × c.
fn section(c: [f64; 3]) -> String {
    let s = skew(&Vec3::from(c));
    let (N, M) = (Mat3::from_diagonal(&[2e5, 8e4, 8e4].into()), Mat3::from_diagonal(&[90.0, 120.0, 150.0].into()));
    let stiffness = rows([N, -N * s, s * N, M - s * N * s]);
    let mass = rows([MASS * Mat3::identity(), -MASS * s, MASS * s, INERTIA - MASS * s * s]);
    format!("{{ shape = \"general\", stiffness = {stiffness}, mass = {mass} }}")
}

/// Positions over time of two points on the line of the centres of a cantilever of 2 m that a force at its end bends by more than a radian.
fn swung(scheme: &str, elements: usize, is_offset: bool) -> Vec<Vec<f64>> {
    let c = if is_offset { CENTRE } else { [0.0; 3] };
    let [y, z] = [CENTRE[1] - c[1], CENTRE[2] - c[2]];
    let [cy, cz] = [CENTRE[1], CENTRE[2]];
    let model = read_deck(&format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.4, time_step = 2e-4 }}
        {scheme}
        points = {{ a = [0.0, {y:?}, {z:?}], b = [2.0, {y:?}, {z:?}], tip = [2.0, {cy:?}, {cz:?}] }}
        sections = {{ s = {} }}
        beams = [{{ name = "blade", path = ["a", "b"], elements = {elements}, section = "s", orientation = [0.0, 1.0, 0.0] }}]
        supports = [{{ at = "a", fix = "all" }}]
        attachments = [{{ beam = "blade", nodes = ["tip"] }}]
        environment = {{ gravity = [0.0, 0.0, -9.81] }}
        loads = [{{ at = "tip", force = [0.0, 130.0, 90.0] }}]
        output = {{ interval = 0.05 }}
        "#,
        section(c)
    ));
    let at = node(&model, "tip");
    run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows
}

/// The same blade with its axis elsewhere moves alike: by implicit and explicit schemes, at large rotations.
#[test]
fn a_blade_moves_as_along_the_line_of_its_centres() {
    for scheme in [
        "integrator = { scheme = \"generalized-alpha\", spectral_radius = 0.9 }",
        "integrator = { scheme = \"central-difference\", mass_scaling = \"off\" }",
    ] {
        let distance = |elements: usize| {
            let [there, here] = [true, false].map(|is_offset| swung(scheme, elements, is_offset));
            let pairs = there.iter().flatten().zip(here.iter().flatten());
            pairs.map(|(there, here)| (there - here).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = [2, 4].map(distance);
        println!("{scheme}: {coarse:.1e} {fine:.1e}");
        // Elements of order 3 differ by the sixth power of their length where the motion is smooth.
        assert!(fine < 2e-4 && fine < 0.2 * coarse, "{scheme}: {coarse} {fine}");
    }
}

/// A free blade keeps its momenta, whatever the scheme; they are those of the line of its centres.
#[test]
fn a_thrown_blade_keeps_its_momenta() {
    for scheme in ["wilson-theta", "generalized-alpha", "central-difference"] {
        let tables = tables_of(&read_deck(&format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.5, time_step = 5e-4 }}
            integrator = {{ scheme = "{scheme}" }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            sections = {{ s = {} }}
            beams = [{{ name = "blade", path = ["a", "b"], elements = 3, section = "s", orientation = [0.0, 1.0, 0.0] }}]
            initial = [{{ at = "blade", about = [0.0, 0.0, 0.0], velocity = [1.0, -2.0, 0.5], angular_velocity = [4.0, -2.0, 3.0] }}]
            "#,
            section(CENTRE)
        )));
        let rows = tables.rows("energy.csv");
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        let (centre, omega) = (Vec3::new(1.0, CENTRE[1], CENTRE[2]), Vec3::new(4.0, -2.0, 3.0));
        let (mass, v) = (2.0 * MASS, Vec3::new(1.0, -2.0, 0.5) + omega.cross(&centre));
        let rod = Mat3::from_diagonal(&[0.0, mass * 4.0 / 12.0, mass * 4.0 / 12.0].into());
        let momentum = [mass * v, mass * centre.cross(&v) + (2.0 * INERTIA + rod) * omega];
        for (column, exact) in ["px", "py", "pz", "lx", "ly", "lz"].iter().zip(momentum.iter().flatten()) {
            let [begins, ends] = [first, last].map(|row| row.number(column));
            println!("{scheme} {column}: {exact} {begins} {ends}");
            assert!((begins - exact).abs() < 1e-12 * momentum[1].norm(), "{scheme} {column}: {begins} {exact}");
            // Explicit steps keep both to rounding; in implicit ones they have the error of the steps, a quarter at half their length.
            let most = if scheme == "central-difference" { 1e-13 } else { 3e-6 };
            assert!((ends - begins).abs() < most * momentum[1].norm(), "{scheme} {column}: {begins} {ends}");
        }
    }
}

/// Weight acts at the centres: it turns the root by m g c L, and the tip by m g c L²/2GJ; the ends of elements balance the support.
#[test]
fn weight_and_centrifugal_force_act_at_the_centres() {
    let blade = |load: &str| {
        tables_of(&read_deck(&format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0, geometry = "linear" }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            sections = {{ s = {{ shape = "general", stiffness = {}, mass = {} }} }}
            beams = [{{ name = "blade", path = ["a", "b"], elements = 3, section = "s", orientation = [0.0, 1.0, 0.0] }}]
            supports = [{{ at = "a", fix = "all" }}]
            {load}
            output = {{ reactions = true, sections = {{ at = "ends" }} }}
            "#,
            rows([1e6 * Mat3::identity(), Mat3::zeros(), Mat3::zeros(), 1e4 * Mat3::identity()]),
            {
                let s = skew(&Vec3::from(CENTRE));
                rows([MASS * Mat3::identity(), -MASS * s, MASS * s, INERTIA - MASS * s * s])
            }
        )))
    };
    let tables = blade("environment = { gravity = [0.0, 0.0, -10.0] }");
    let reaction = |tables: &crate::support::Tables, direction: &str| {
        let is = |row: &crate::support::Row| row.text("node") == "a" && row.text("direction") == direction;
        tables.rows("reactions.csv").into_iter().rfind(is).expect("a row").number("value")
    };
    let torque = MASS * 10.0 * CENTRE[1] * 2.0;
    let tip = tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "b").expect("a row").number("rx");
    let start =
        tables.rows("sections.csv").into_iter().find(|row| row.number("time") == 1.0).expect("an end").number("T");
    println!("{} {tip} {start}", reaction(&tables, "rx"));
    assert!((reaction(&tables, "rx") - torque).abs() < 1e-9 * torque);
    assert!((tip + torque / 1e4).abs() < 1e-9 * torque / 1e4, "half the torque on the average");
    assert!((start + torque).abs() < 1e-9 * torque, "{start} {torque}");
    // Turning about x at 5 throws each centre away from the axis.
    let tables = blade("loads = [{ centrifugal = { speed = 5.0, axis = [1.0, 0.0, 0.0] } }]");
    for (direction, c) in [("uy", CENTRE[1]), ("uz", CENTRE[2])] {
        let exact = -25.0 * 2.0 * MASS * c;
        let found = reaction(&tables, direction);
        assert!((found - exact).abs() < 1e-9 * exact.abs(), "{direction}: {found} {exact}");
    }
}

/// A matrix about the centre is the section of its numbers, to the last bit.
#[test]
fn a_centred_matrix_is_the_section_of_its_numbers() {
    let mass = [1.3, 1.3, 1.3, 0.05, 0.02, 0.03];
    let diagonal: [[f64; 6]; 6] = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { mass[i] } else { 0.0 }));
    let run = |mass: &str| {
        let model = read_deck(&format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.05, time_step = 1e-3 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            sections.s = {{ shape = "general", axial_stiffness = 1e5, shear_stiffness = [1e4, 1e4], torsional_stiffness = 9.0, bending_stiffness = [1e2, 2e2], {mass} }}
            beams = [{{ name = "blade", path = ["a", "b"], elements = 3, section = "s", orientation = [0.0, 1.0, 0.0] }}]
            supports = [{{ at = "a", fix = "all" }}]
            loads = [{{ at = "b", force = [0.0, 13.0, 9.0], moment = [1.0, 0.0, 0.0] }}]
            "#
        ));
        assert!(model.constraints.dependents.is_empty());
        let at = node(&model, "b");
        run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows
    };
    let by_numbers = run("mass_per_length = 1.3, inertia_per_length = [0.05, 0.02, 0.03]");
    assert_eq!(run(&format!("mass = {diagonal:?}")), by_numbers);
}

/// A rigid blade is a body with its centre of mass and inertia.
#[test]
fn a_rigid_blade_has_its_centre_of_mass() {
    let model = read_deck(&format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.1, time_step = 1e-3 }}
        points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
        sections = {{ s = {} }}
        beams = [{{ name = "blade", path = ["a", "b"], elements = 3, section = "s", orientation = [0.0, 1.0, 0.0], rigid = true }}]
        "#,
        section(CENTRE)
    ));
    let body = &model.bodies[0];
    let rod = Mat3::from_diagonal(&[0.0, 2.0 * MASS / 3.0, 2.0 * MASS / 3.0].into());
    assert!((model.nodes[body.node].x - Vec3::new(1.0, CENTRE[1], CENTRE[2])).norm() < 1e-14);
    assert!((body.inertia - (2.0 * INERTIA + rod)).norm() < 1e-13, "{}", body.inertia);
}

/// What is not the mass of a section is refused by its entry.
#[test]
fn matrices_that_no_section_has_are_refused() {
    let refusal = |change: &dyn Fn(&mut [[f64; 6]; 6])| {
        let mut rows = [
            [2.0, 0.0, 0.0, 0.0, 0.0, -0.4],
            [0.0, 2.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 2.0, 0.4, 0.0, 0.0],
            [0.0, 0.0, 0.4, 0.2, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.05, 0.0],
            [-0.4, 0.0, 0.0, 0.0, 0.0, 0.15],
        ];
        change(&mut rows);
        let text = format!(
            "analysis = {{ kind = \"dynamic\", end_time = 0.1, time_step = 1e-3 }}\npoints = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}\n\
             sections.s = {{ shape = \"general\", axial_stiffness = 1e5, shear_stiffness = [1e4, 1e4], torsional_stiffness = 9.0, \
             bending_stiffness = [1e2, 2e2], mass = {rows:?} }}\n\
             beams = [{{ name = \"blade\", path = [\"a\", \"b\"], elements = 3, section = \"s\", orientation = [0.0, 1.0, 0.0] }}]\n"
        );
        let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
        let (_, problems) = rdsolve::model::read(&source);
        problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(refusal(&|_| {}), "");
    type Change = fn(&mut [[f64; 6]; 6]);
    let changes: [(Change, &str); 6] = [
        (|rows| rows[5][0] = 0.4, "`mass` is not symmetric: row 6 has 0.4 in column 1"),
        (|rows| rows[1][1] = 2.5, "`mass` is not that of a section: row 2 has 2.5 in column 2, and 2 would belong"),
        (
            |rows| {
                rows[2][3] = 0.5;
                rows[3][2] = 0.5;
            },
            "`mass` is not that of a section: row 1 has -0.4 in column 6, and -0.5 would belong",
        ),
        (
            |rows| rows[3][3] = 0.02,
            "`mass` is not positive: with its centre at y = 0.2, z = 0 the moment of inertia -0.06",
        ),
        (|rows| rows[0][0] = 0.0, "`mass` has 0 in row 1, column 1"),
        (
            |rows| {
                rows[0][1] = 0.3;
                rows[1][0] = 0.3;
            },
            "`mass` is not that of a section: row 1 has 0.3 in column 2",
        ),
    ];
    for (change, message) in changes {
        let told = refusal(&change);
        assert!(told.contains(message), "{message}\n{told}");
    }
}

/// A mass beside the axis without inertia about its centre is told of where it moves in time, and its nodes have names of their own.
#[test]
fn points_beside_the_axis_are_told() {
    let told = |inertia: f64| {
        let s = skew(&Vec3::from(CENTRE));
        let mass = rows([MASS * Mat3::identity(), -MASS * s, MASS * s, inertia * Mat3::identity() - MASS * s * s]);
        let text = format!(
            "analysis = {{ kind = \"dynamic\", end_time = 0.1, time_step = 1e-3 }}\npoints = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0], c = [2.0, 1.0, 0.0] }}\n\
             sections.s = {{ shape = \"general\", axial_stiffness = 1e5, shear_stiffness = [1e4, 1e4], torsional_stiffness = 9.0, bending_stiffness = [1e2, 2e2], mass = {mass} }}\n\
             beams = [{{ name = \"blade\", path = [\"a\", \"b\", \"c\"], elements = 2, section = \"s\", orientation = [0.0, 0.0, 1.0] }}]\n"
        );
        let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
        let (model, problems) = rdsolve::model::read(&source);
        let model = model.expect("a sound deck");
        let labels: std::collections::HashSet<&str> = model.nodes.iter().map(|node| node.label.as_str()).collect();
        assert_eq!(labels.len(), model.nodes.len(), "names of nodes");
        problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(told(0.01), "");
    assert!(told(0.0).contains("the mass of beam `blade` lies beside its axis and has no inertia about its centre"));
}
