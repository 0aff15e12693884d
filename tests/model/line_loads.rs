//! Loads per length of beams and bars, and the forces at the ends of members that carry them.

use crate::support::{Row, read_deck, tables_of};

const EI: f64 = 6e4;
const GA: f64 = 3e5;

/// A beam of 2 m along x from its clamped start; `rest` holds its loads and what else the scene has.
fn beam(order: usize, elements: usize, rest: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0 }}
        output = {{ sections = {{ at = "both" }}, reactions = true }}
        sections.rod = {{ shape = "general", axial_stiffness = 1e7, shear_stiffness = [{GA:?}, {GA:?}], torsional_stiffness = 1e4, bending_stiffness = [{EI:?}, {EI:?}], mass_per_length = 3.0, inertia_per_length = [0.02, 0.01, 0.01] }}
        points.root = [0.0, 0.0, 0.0]
        points.tip = [2.0, 0.0, 0.0]
        [[beams]]
        name = "rod"
        path = ["root", "tip"]
        elements = {elements}
        order = {order}
        section = "rod"
        orientation = [0.0, 1.0, 0.0]
        [[supports]]
        at = "root"
        fix = "all"
        {rest}
        "#
    )
}

fn last(rows: &[Row], column: &str, is_it: impl Fn(&Row) -> bool) -> f64 {
    rows.iter().rev().find(|row| is_it(row)).expect("such a row").number(column)
}

/// Deflection and slope of the tip of a cantilever under 1 N/m times a profile, by integrals of the load with the influence of a
/// force at s: s²(3L − s)/6EI + s/GA and s²/2EI.
fn tip(profile: &dyn Fn(f64) -> f64) -> [f64; 2] {
    let (length, count) = (2.0, 20_000);
    let step = length / f64::from(count);
    (0..count).fold([0.0; 2], |[u, slope], k| {
        let s = (f64::from(k) + 0.5) * step;
        let q = profile(s / length) * step;
        [u + q * (s * s * (3.0 * length - s) / (6.0 * EI) + s / GA), slope + q * s * s / (2.0 * EI)]
    })
}

#[test]
fn cantilevers_deflect_as_beam_theory_says() {
    type Profile = (&'static str, fn(f64) -> f64);
    let profiles: [Profile; 4] = [
        ("", |_| 1.0),
        ("profile = [[0.0, 0.0], [1.0, 1.0]]", |f| f),
        ("profile = [[0.0, 1.0], [0.6, 0.25]]", |f| if f < 0.6 { 1.0 - 1.25 * f } else { 0.0 }),
        ("profile = [[0.3, 1.0], [0.4, 2.0], [0.9, 2.0]]", |f| match f {
            _ if !(0.3..=0.9).contains(&f) => 0.0,
            _ if f < 0.4 => 1.0 + (f - 0.3) * 10.0,
            _ => 2.0,
        }),
    ];
    for (words, profile) in profiles {
        let [deflection, slope] = tip(&profile);
        let errors = |order: usize, elements: usize| {
            let load = format!("[[loads]]\npart = \"rod\"\nforce_per_length = [0.0, 0.0, 1.0]\n{words}\n");
            let rows = tables_of(&read_deck(&beam(order, elements, &load))).rows("nodes.csv");
            let at_tip = |column: &str| last(&rows, column, |row| row.text("node") == "tip");
            [at_tip("uz") / deflection - 1.0, at_tip("ry") / -slope - 1.0].map(f64::abs)
        };
        // Two-node elements bend like the exact beam, and elements of order 3 hold the cubic influence line of the tip: nothing is left but
        // the midpoint rule of the reference.
        for (order, elements) in [(1, 1), (1, 3), (3, 1), (3, 2), (4, 1)] {
            let [deflection, slope] = errors(order, elements);
            assert!(deflection < 1e-7 && slope < 1e-7, "{words} {order} {elements}: {deflection} {slope}");
        }
        // Parabolas meet that line with the fourth power of their length; a load that changes inside them scatters it by a third.
        let [coarse, fine] = [4, 8].map(|elements| errors(2, elements)[0]);
        assert!(coarse < 1e-3 && fine < (coarse / 10.0).max(1e-7), "{words}: {coarse} {fine}");
    }
}

const COLUMNS: [&str; 6] = ["N", "Vy", "Vz", "T", "My", "Mz"];

/// What the rows of sections.csv at an end of an element say, at the last time.
fn end(rows: &[Row], element: usize, point: &str) -> [f64; 6] {
    let is_it = |row: &Row| row.text("element") == element.to_string() && row.text("point") == point;
    COLUMNS.map(|column| last(rows, column, is_it))
}

/// The last reaction in a direction.
fn reaction(rows: &[Row], direction: &str) -> f64 {
    last(rows, "value", |row| row.text("direction") == direction)
}

/// A beam clamped at both ends under its own load: fixed-end moments q L²/12 and shear forces q L/2, whatever the mesh.
#[test]
fn member_end_forces_are_those_of_the_clamped_beam() {
    let rest = "[[supports]]\nat = \"tip\"\nfix = \"all\"\n\
                [[loads]]\nat = \"rod\"\nlocal = [0.0, 0.0, -30.0]\n";
    for (order, elements) in [(1, 1), (1, 2), (2, 1), (3, 1), (3, 2), (4, 3)] {
        let rows = tables_of(&read_deck(&beam(order, elements, rest))).rows("sections.csv");
        let (start, end) = (end(&rows, 0, "start"), end(&rows, elements - 1, "end"));
        // 30 N/m over 2 m. Behind the start the beam presses down by half of it, and bends with tension on the side of +z.
        let (shear, moment) = (30.0, 10.0);
        for (forces, expected) in
            [(start, [0.0, 0.0, -shear, 0.0, moment, 0.0]), (end, [0.0, 0.0, shear, 0.0, moment, 0.0])]
        {
            for (force, expected) in forces.into_iter().zip(expected) {
                // The iteration leaves 1e-8 of what acts, and deflections of 1e-4 a membrane force of second order.
                assert!((force - expected).abs() < 1e-3 * shear, "{order} {elements}: {forces:?}");
            }
            let error = (forces[2].abs() - shear).abs().max((forces[4] - moment).abs());
            assert!(error < 1e-5 * shear, "{order} {elements}: {forces:?}");
        }
    }
}

/// In any motion the resultants at a free end are zero, those at two sides of a node without loads of its own are equal, and those at the
/// clamped end are the reaction: inertia, weight, damping of mass and stiffness and loads along the beam are all accounted for.
#[test]
fn ends_are_in_balance_in_motion() {
    for (order, mass) in [(1, "lumped"), (2, "consistent"), (3, "lumped"), (3, "consistent"), (4, "free-nodes")] {
        let rest = "damping = { mass_factor = 3.0, stiffness_factor = 1e-3 }\nenvironment.gravity = [1.0, 2.0, -9.81]\n\
             amplitudes.pulse = { kind = \"sine\", angular_frequency = 40.0 }\namplitudes.shake = { kind = \"sine\", angular_frequency = 25.0 }\n\
             environment.base_acceleration = [{ amplitude = \"shake\", direction = [0.5, 3.0, 1.0] }]\n";
        let loads = "[[loads]]\npart = \"rod\"\nlocal = [40.0, 500.0, -2000.0]\nfollower = true\namplitude = \"pulse\"\n\
                     profile = [[0.1, 1.0], [0.9, 0.3]]\n";
        let deck = beam(order, 3, loads)
            .replace(
                "kind = \"static\", end_time = 1.0, time_step = 1.0",
                "kind = \"dynamic\", end_time = 0.1, time_step = 5e-4",
            )
            .replace("sections.rod =", &format!("{rest}sections.rod ="))
            .replace("section = \"rod\"", &format!("section = \"rod\"\nmass = \"{mass}\""))
            + "[integrator]\nscheme = \"newmark\"\n[iteration]\ntolerance = 1e-11\n";
        let tables = tables_of(&read_deck(&deck));
        let rows = tables.rows("sections.csv");
        let root = end(&rows, 0, "start");
        let size = root.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
        assert!(size > 100.0, "{root:?} shows little");
        let near = |a: [f64; 6], b: [f64; 6], what: &str| {
            let error = a.iter().zip(b).fold(0.0_f64, |error, (a, b)| error.max((a - b).abs()));
            // What the iteration leaves of the residual, at 1e-11 of the largest force.
            assert!(error < 1e-7 * size, "{order} {mass} {what}: {a:?} {b:?}");
        };
        near(end(&rows, 2, "end"), [0.0; 6], "tip");
        // Turned axes are the same on both sides: elements share the node.
        near(end(&rows, 0, "end"), end(&rows, 1, "start"), "first");
        near(end(&rows, 1, "end"), end(&rows, 2, "start"), "second");
        let reactions = tables.rows("reactions.csv");
        let held = ["ux", "uy", "uz", "rx", "ry", "rz"].map(|direction| reaction(&reactions, direction));
        // The root does not turn: section axes are the global ones. The section acts on what lies before it as the support does not.
        near(root, held.map(|force| -force), "root");
    }
}

/// Snow on a slope is one load per length of the plan, and a load in section axes turns with a beam that turns.
#[test]
fn projected_and_following_loads_keep_to_their_axes() {
    let slope = beam(3, 4, "[[loads]]\npart = \"rod\"\nforce_per_length = [0.0, 0.0, -50.0]\nprojected = true\n")
        .replace("points.tip = [2.0, 0.0, 0.0]", "points.tip = [1.2, 0.0, 1.6]");
    let rows = tables_of(&read_deck(&slope)).rows("reactions.csv");
    // 1.2 m in plan; what the iteration leaves.
    assert!((reaction(&rows, "uz") / 60.0 - 1.0).abs() < 1e-7);

    // The root turns by a right angle about y: z becomes x.
    let turned = beam(2, 3, "[[loads]]\npart = \"rod\"\nlocal = [0.0, 7.0, 20.0]\nfollower = true\n")
        .replace("fix = \"all\"", "fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"rz\"]\nmotion.ry = { amplitude = \"ramp\", scale = 1.5707963267948966 }")
        .replace("time_step = 1.0", "time_step = 0.125")
        .replace("points.root", "amplitudes.ramp = { kind = \"ramp\", end = 1.0 }\npoints.root");
    let rows = tables_of(&read_deck(&turned)).rows("reactions.csv");
    let force = ["ux", "uy", "uz"].map(|direction| reaction(&rows, direction));
    // The beam bends by 5e-4.
    for (force, expected) in force.into_iter().zip([-40.0, -14.0, 0.0]) {
        assert!((force - expected).abs() < 0.05, "{force} for {expected}");
    }
}

/// A rigid beam carries a load per length as a bent line does: its whole force, at its centre.
#[test]
fn rigid_beams_take_loads_per_length() {
    let deck = r#"
        analysis = { kind = "static", end_time = 1.0, time_step = 0.5 }
        output = { reactions = true }
        materials.steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7850.0 }
        sections.rod = { shape = "tube", radius = 0.02, thickness = 0.02 }
        points = { a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0], c = [2.0, 1.0, 0.0] }
        [[beams]]
        name = "rod"
        path = ["a", "b", "c"]
        elements = 4
        order = 2
        material = "steel"
        section = "rod"
        orientation = [0.0, 0.0, 1.0]
        rigid = true
        [[supports]]
        at = "rod"
        fix = "all"
        [[loads]]
        at = AT
        force_per_length = [0.0, 30.0, -100.0]
        [sets]
        group = ["rod"]
        "#;
    for at in ["\"rod\"", "\"group\""] {
        let rows = tables_of(&read_deck(&deck.replace("AT", at))).rows("reactions.csv");
        let [fy, fz] = ["uy", "uz"].map(|direction| reaction(&rows, direction));
        // 3 m, to rounding of the halves.
        assert!((fy + 90.0).abs() < 1e-9 && (fz - 300.0).abs() < 1e-9, "{at}: {fy} {fz}");
    }
}

/// A set is what it holds: edges that another patch shares, an edge beside a beam, two edges one element apart.
#[test]
fn a_set_of_edges_is_each_of_them() {
    let deck = |at: &str| {
        format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0 }}
            output = {{ reactions = true }}
            materials.steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7850.0 }}
            sections.rod = {{ shape = "tube", radius = 0.02, thickness = 0.02 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 0.5, 0.0], d = [0.0, 0.5, 0.0], e = [2.0, 0.0, 0.0], f = [2.0, 0.5, 0.0], g = [3.0, 0.0, 0.0] }}
            sets.some = [{at}]
            shells = [
                {{ name = "S", corners = ["a", "b", "c", "d"], elements = [4, 1], material = "steel", thickness = 0.01 }},
                {{ name = "T", corners = ["b", "e", "f", "c"], elements = [4, 1], material = "steel", thickness = 0.01 }},
            ]
            beams = [{{ name = "B", path = ["e", "g"], elements = 4, material = "steel", section = "rod", orientation = [0.0, 0.0, 1.0] }}]
            supports = [{{ at = "S.edge4", fix = "all" }}]
            loads = [{{ at = WHAT, force_per_length = [0.0, 0.0, 1.0] }}]
            "#
        )
    };
    // Edges 1 and 3 run along x, 4 and 2 across.
    for (at, length) in [
        ("\"T.edge4\", \"T.edge1\"", 1.5),
        ("\"S.edge2\", \"B\"", 1.5),
        ("\"S.edge1\", \"S.edge3\"", 2.0),
        ("\"B\", \"B\"", 1.0),
    ] {
        for what in ["\"some\"".to_owned(), format!("[{at}]"), format!("[\"some\", {at}]")] {
            let rows = tables_of(&read_deck(&deck(at).replace("WHAT", &what))).rows("reactions.csv");
            let at_end = rows.iter().filter(|row| row.number("time") == 1.0 && row.text("direction") == "uz");
            let fz: f64 = at_end.map(|row| row.number("value")).sum();
            // A force of one newton per metre, to the rounding of an equilibrium.
            assert!((fz + length).abs() < 1e-6, "{what}, {at}: {fz} for {length}");
        }
    }
}
