//! Beams with sections by station: closed forms of tapered beams, masses by integration, and the bits of uniform beams.

use crate::mesh::Folder;
use crate::support::{node, position, read_deck, run_to_the_end, slope, tables_of};
use rdsolve::math::Vec3;

const HEAD: &str = "materials.m = { model = \"elastic\", youngs_modulus = 1e9, poisson_ratio = 0.3, density = 1000.0 }\n\
    points = { a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }\n\
    sections.root = { shape = \"rectangle\", width = 0.06, height = 0.1 }\n\
    sections.tip = { shape = \"rectangle\", width = 0.03, height = 0.04 }\n";

const TAPER: &str = "stations = [{ at = 0.0, section = \"root\" }, { at = 1.0, section = \"tip\" }]";

fn beam(elements: usize, keys: &str) -> String {
    format!(
        "{HEAD}beams = [{{ name = \"blade\", path = [\"a\", \"b\"], elements = {elements}, material = \"m\", orientation = [0.0, 1.0, 0.0], {keys} }}]\n"
    )
}

/// Displacement of the tip of a cantilever under a force, infinitesimal.
fn tip(text: &str) -> Vec3 {
    let model = read_deck(&format!(
        "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0, geometry = \"linear\" }}\n{text}\
         supports = [{{ at = \"a\", fix = \"all\" }}]\nloads = [{{ at = \"b\", force = [50.0, 3.0, 7.0] }}]\n"
    ));
    let at = node(&model, "b");
    let row = |frame: &rdsolve::solve::Frame| position(&frame.state.nodes[at]).to_vec();
    let rows = run_to_the_end(&model, &mut { row }).rows;
    Vec3::from_column_slice(rows.last().expect("a row")) - Vec3::new(2.0, 0.0, 0.0)
}

/// ∫ ds/EA along the axis, ∫ (L − s)² ds/EI across it, with linear width and height; Gauss points enough for all digits.
fn exact() -> Vec3 {
    let (points, weights) = rdsolve::math::quadrature::gauss(5);
    let pieces = 200;
    let mut sum = Vec3::zeros();
    for piece in 0..pieces {
        for (xi, w) in points.iter().zip(weights) {
            let s = (f64::from(piece) + 0.5 + 0.5 * xi) * 2.0 / f64::from(pieces);
            let (width, height, w) = (0.06 - 0.015 * s, 0.1 - 0.03 * s, w / f64::from(pieces));
            let (EA, arm) = (1e9 * width * height, 2.0 - s);
            let [by_y, by_z] = [height, width].map(|depth| arm * arm * 12.0 / (EA * depth * depth));
            sum += w * Vec3::new(50.0 / EA, 3.0 * by_z, 7.0 * by_y);
        }
    }
    sum
}

/// Errors at the tip fall with the power 2 × order of the length of elements.
#[test]
fn a_tapered_cantilever_converges_to_the_closed_form() {
    let exact = exact();
    for (order, counts) in [(1, [4, 16]), (2, [6, 18]), (3, [3, 6])] {
        let errors = counts.map(|elements| {
            let found = tip(&beam(elements, &format!("{TAPER}, order = {order}, shear = false")));
            let off = (found - exact).component_div(&exact).amax();
            println!("order {order}, {elements}: {off:.1e}");
            ((elements as f64).recip(), off)
        });
        let slope = slope(&errors);
        assert!(slope > 2.0 * order as f64 - 0.7, "order {order}: {slope} {errors:?}");
    }
    // What remains is a ten-thousandth of the deflection by shear, 1e-3 of all.
    let fine = tip(&beam(8, &format!("{TAPER}, shear = false")));
    assert!((fine - exact).component_div(&exact).amax() < 1e-6, "{fine} {exact}");
}

/// Momentum and its moment of a beam that moves as a whole are its mass and its first moment: A = w h is quadratic along it.
#[test]
fn masses_are_integrals_along_the_beam() {
    // ∫ (0.06 − 0.015 s)(0.1 − 0.03 s) ds and the same times s, from 0 to 2.
    let mass = 1e3 * (0.006 * 2.0 - 0.0033 * 2.0 + 0.00045 * 8.0 / 3.0);
    let first = 1e3 * (0.006 * 2.0 - 0.0033 * 8.0 / 3.0 + 0.00045 * 4.0);
    for kind in ["lumped", "consistent"] {
        for order in [2, 3] {
            let tables = tables_of(&read_deck(&format!(
                "analysis = {{ kind = \"dynamic\", end_time = 1e-4, time_step = 1e-4 }}\n{}\
                 initial = [{{ at = \"blade\", velocity = [0.0, 0.0, 2.0] }}]\n",
                beam(2, &format!("{TAPER}, order = {order}, mass = \"{kind}\""))
            )));
            let row = &tables.rows("energy.csv")[0];
            let near = |found: f64, exact: f64| (found - exact).abs() < 1e-13 * exact.abs();
            assert!(near(row.number("pz"), 2.0 * mass), "{kind} {order}: {} {}", row.number("pz"), 2.0 * mass);
            assert!(near(row.number("ly"), -2.0 * first), "{kind} {order}: {} {}", row.number("ly"), -2.0 * first);
        }
    }
    let model = read_deck(&format!(
        "analysis = {{ kind = \"dynamic\", end_time = 1.0, time_step = 0.1 }}\n{}",
        beam(4, &format!("{TAPER}, rigid = true"))
    ));
    let body = &model.bodies[0];
    assert!((body.mass - mass).abs() < 1e-12 * mass && (model.nodes[body.node].x.x - first / mass).abs() < 1e-12);
}

/// A motion in time, by the last positions of the tip.
fn moved(text: &str) -> Vec<Vec<f64>> {
    let model = read_deck(&format!(
        "analysis = {{ kind = \"dynamic\", end_time = 0.05, time_step = 1e-3 }}\n{text}\
         supports = [{{ at = \"a\", fix = \"all\" }}]\nloads = [{{ at = \"b\", force = [50.0, 300.0, 700.0] }}]\ndamping = {{ stiffness_factor = 1e-4 }}\n"
    ));
    let at = node(&model, "b");
    run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows
}

/// Stations of one section are that section.
#[test]
fn constant_stations_give_the_bits_of_a_uniform_beam() {
    let constant = "stations = [{ at = 0.0, section = \"root\" }, { at = 0.3, section = \"root\" }, { at = 1.0, section = \"root\" }]";
    for more in ["", ", mass = \"consistent\"", ", order = 1"] {
        let [uniform, stations] =
            ["section = \"root\"", constant].map(|keys| moved(&beam(3, &format!("{keys}{more}"))));
        assert_eq!(uniform, stations, "{more}");
    }
}

/// A constant twist is another orientation, and an offset is another matrix of a general section, to rounding.
#[test]
fn twist_and_offset_are_what_they_stand_for() {
    let near = |a: &[Vec<f64>], b: &[Vec<f64>]| {
        let off = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // The tolerance of the iteration.
        assert!(off < 1e-8, "{off:e}");
    };
    let twisted =
        "stations = [{ at = 0.0, section = \"root\", twist = 0.4 }, { at = 1.0, section = \"tip\", twist = 0.4 }]";
    let turned =
        beam(3, TAPER).replace("[0.0, 1.0, 0.0], ", &format!("[0.0, {:?}, {:?}], ", 0.4f64.cos(), 0.4f64.sin()));
    near(&moved(&beam(3, twisted)), &moved(&turned));
    // Γ + κ × c of an axis beside that of the section.
    let general = |stiffness: &str, mass: &str, keys: &str| {
        moved(&format!(
            "points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}\nsections.s = {{ shape = \"general\", stiffness = {stiffness}, mass = {mass} }}\n\
             beams = [{{ name = \"blade\", path = [\"a\", \"b\"], elements = 3, orientation = [0.0, 1.0, 0.0], {keys} }}]\n"
        ))
    };
    let rows = |k: [f64; 3], m: [f64; 3], y: f64| {
        let mut rows = [[0.0; 6]; 6];
        (0..3).for_each(|i| (rows[i][i], rows[3 + i][3 + i]) = (k[i], m[i]));
        (rows[0][5], rows[5][0], rows[2][3], rows[3][2]) = (-k[0] * y, -k[0] * y, k[2] * y, k[2] * y);
        rows[3][3] += k[2] * y * y;
        rows[5][5] += k[0] * y * y;
        format!("{rows:?}")
    };
    let (k, m) = ([5e6, 1e6, 1e6], [4e3, 6e3, 7e3]);
    let (mass, inertia) = ([6.0; 3], [0.05, 0.02, 0.03]);
    let stations = "stations = [{ at = 0.0, section = \"s\", offset = [0.1, 0.0] }, { at = 1.0, section = \"s\", offset = [0.1, 0.0] }]";
    near(
        &general(&rows(k, m, 0.0), &rows(mass, inertia, 0.0), stations),
        &general(&rows(k, m, 0.1), &rows(mass, inertia, 0.1), "section = \"s\""),
    );
}

/// A rod that turns its strong axis by a right angle from root to tip: ∫ (L − s)² S(s) F with the flexibility S turned by the twist.
#[test]
fn a_pretwisted_cantilever_bends_as_by_hand() {
    let twist = std::f64::consts::FRAC_PI_2;
    let keys = format!(
        "stations = [{{ at = 0.0, section = \"root\" }}, {{ at = 1.0, section = \"root\", twist = {twist:?} }}], shear = false"
    );
    let (EIy, EIz) = (1e9 * 0.06 * 0.1f64.powi(3) / 12.0, 1e9 * 0.1 * 0.06f64.powi(3) / 12.0);
    let (points, weights) = rdsolve::math::quadrature::gauss(5);
    let mut exact = Vec3::new(50.0 * 2.0 / (1e9 * 0.006), 0.0, 0.0);
    for piece in 0..100 {
        for (xi, w) in points.iter().zip(weights) {
            let s = (f64::from(piece) + 0.5 + 0.5 * xi) / 50.0;
            let (sin, cos) = (twist * 0.5 * s).sin_cos();
            let arm = 2.0 - s;
            // Forces along the twisted axes, and what they move there.
            let (along_y, along_z) = (3.0 * cos + 7.0 * sin, 7.0 * cos - 3.0 * sin);
            let (y, z) = (along_y / EIz, along_z / EIy);
            exact += 0.01 * w * arm * arm * Vec3::new(0.0, cos * y - sin * z, sin * y + cos * z);
        }
    }
    let found = tip(&beam(6, &keys));
    assert!((found - exact).component_div(&exact).amax() < 1e-5, "{found} {exact}");
}

/// Sections of different shapes are joined by their matrices; stresses are then not known.
#[test]
fn different_shapes_are_joined_by_their_matrices() {
    let text = beam(4, "stations = [{ at = 0.0, section = \"root\" }, { at = 1.0, section = \"end\" }], shear = false")
        + "sections.end = { shape = \"general\", area = 0.003, moments = [1e-6, 5e-7], torsion_constant = 1e-6, shear_areas = [0.002, 0.002] }\n";
    let (EIz, end) = (1e9 * 0.1 * 0.06f64.powi(3) / 12.0, 1e9 * 5e-7);
    let steps = 20_000;
    let sum = |of: &dyn Fn(f64) -> f64| {
        (0..steps).map(|k| of((f64::from(k) + 0.5) * 2.0 / f64::from(steps))).sum::<f64>() * 2.0 / f64::from(steps)
    };
    let exact = sum(&|s| 3.0 * (2.0 - s).powi(2) / (EIz + 0.5 * s * (end - EIz)));
    let found = tip(&text).y;
    assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
}

/// A line of segments of a mesh is a beam like a path.
#[test]
fn a_group_of_the_mesh_has_stations() {
    let mesh = |second: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"blade\"\n$EndPhysicalNames\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 2 0 0\n$EndNodes\n\
             $Elements\n2\n1 1 2 1 1 1 2\n2 1 2 1 1 {second}\n$EndElements\n"
        )
    };
    let deck = |part: &str| {
        format!(
            "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0, geometry = \"linear\" }}\n{HEAD}mesh.file = \"m.msh\"\n\
             beams = [{{ {part}, material = \"m\", orientation = [0.0, 1.0, 0.0], {TAPER} }}]\n"
        )
    };
    let of_group = deck("group = \"blade\"")
        + "supports = [{ at = \"mesh.1\", fix = \"all\" }]\nloads = [{ at = \"mesh.3\", force = [50.0, 3.0, 7.0] }]\n";
    let folder = Folder::with(&[("m.msh", &mesh("2 3"))]);
    let model = folder.model(&of_group);
    let at = node(&model, "mesh.3");
    let rows = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows;
    let found = Vec3::from_column_slice(rows.last().expect("a row")) - Vec3::new(2.0, 0.0, 0.0);
    let exact = tip(&beam(2, TAPER));
    assert!((found - exact).norm() < 1e-10 * exact.norm(), "{found} {exact}");
    let backward = Folder::with(&[("m.msh", &mesh("3 2"))]);
    assert!(backward.read(&of_group).1.contains("segment 2 of the group does not begin where segment 1 ends"));
}

/// Stresses and forces by place follow the section there: the largest stress of a beam whose depth falls faster than the moment lies inside.
#[test]
fn stresses_are_those_of_the_section_at_the_place() {
    let tables = tables_of(&read_deck(&format!(
        "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0, geometry = \"linear\" }}\n{}\
         supports = [{{ at = \"a\", fix = \"all\" }}]\nloads = [{{ at = \"b\", force = [0.0, 0.0, 7.0] }}]\noutput = {{ sections = {{ at = \"both\" }} }}\n",
        beam(3, TAPER)
    )));
    let rows: Vec<_> = tables.rows("sections.csv").into_iter().filter(|row| row.number("time") == 1.0).collect();
    for row in &rows {
        let s = row.number("s");
        let (width, height) = (0.06 - 0.015 * s, 0.1 - 0.03 * s);
        let sigma = 6.0 * 7.0 * (2.0 - s) / (width * height * height);
        assert!((row.number("sigma_max") - sigma).abs() < 1e-8 * 7e4, "{s}: {} {sigma}", row.number("sigma_max"));
    }
    assert!(rows.len() == 15);
}

#[test]
fn stations_that_do_not_span_the_beam_are_refused() {
    let told = |keys: &str| {
        let text = format!("analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0 }}\n{}", beam(2, keys));
        let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
        let (_, problems) = rdsolve::model::read(&source);
        problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    let station = |at: &str, section: &str| format!("{{ at = {at}, section = \"{section}\" }}");
    let of = |all: &[(&str, &str)]| {
        let all: Vec<String> = all.iter().map(|(at, section)| station(at, section)).collect();
        format!("stations = [{}]", all.join(", "))
    };
    for (keys, message) in [
        (of(&[]), "`stations` is empty"),
        (of(&[("0.1", "root"), ("1.0", "tip")]), "the first station lies at 0.1, not at 0.0"),
        (of(&[("0.0", "root"), ("2.0", "tip")]), "the last station lies at 2, not at 1.0"),
        (of(&[("0.0", "root")]), "the last station lies at 0, not at 1.0"),
        (
            of(&[("0.0", "root"), ("0.5", "tip"), ("0.5", "root"), ("1.0", "tip")]),
            "station 3 lies at 0.5, not beyond the one before",
        ),
        (of(&[("0.0", "root"), ("1.0", "tap")]), "no section is named `tap`"),
        (format!("{TAPER}, section = \"root\""), "beam `blade` has `section` and `stations`"),
        ("stations = [{ section = \"root\" }, { at = 1.0, section = \"tip\" }]".into(), "needs `at`"),
    ] {
        let found = told(&keys);
        assert!(found.contains(message), "{message}\n{found}");
    }
    let steel =
        "[materials.s]\nmodel = \"elastic-plastic\"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\nyield_stress = 2e8\n";
    let text =
        format!("analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0 }}\n{}{steel}", beam(2, TAPER))
            .replace("material = \"m\"", "material = \"s\"");
    let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
    let problems = rdsolve::model::read(&source).1;
    let found = problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n");
    assert!(found.contains("beam `blade` has `stations`, and its material yields"), "{found}");
}

/// Keys that elastic beams do not use do not count; others keep dimensions from being linear, which a note tells.
#[test]
fn keys_that_differ_are_told() {
    let told = |tip: &str| {
        let sections = format!(
            "sections.root = {{ shape = \"box\", width = 0.06, height = 0.1, thickness = 0.004, fibres = [8, 2] }}\nsections.tip = {{ {tip} }}\n"
        );
        let text = format!(
            "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0 }}\nsupports = [{{ at = \"a\", fix = \"all\" }}]\n{}",
            beam(2, TAPER).replace(&HEAD[HEAD.find("sections.root").expect("sections")..], &sections)
        );
        let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
        let (_, problems) = rdsolve::model::read(&source);
        problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(told("shape = \"box\", width = 0.03, height = 0.05, thickness = 0.003"), "");
    let two = told("shape = \"box\", width = 0.03, height = 0.05, thickness = [0.003, 0.002]");
    assert!(two.contains("note") && two.contains("`thickness` differs"), "{two}");
}

/// Stresses are expected of beams that have them at all places.
#[test]
fn stresses_are_not_expected_of_half_a_beam() {
    let text = format!(
        "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0 }}\n{}\
         sections.end = {{ shape = \"general\", area = 0.003, moments = [1e-6, 5e-7], torsion_constant = 1e-6, shear_areas = [0.002, 0.002] }}\n\
         expect = [{{ at = \"blade\", quantity = \"sigma_max\", peak = \"max\", value = 1.0, tolerance = 1.0, source = \"none\" }}]\n",
        beam(
            2,
            "stations = [{ at = 0.0, section = \"root\" }, { at = 0.5, section = \"tip\" }, { at = 1.0, section = \"end\" }]"
        )
    );
    let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
    let problems = rdsolve::model::read(&source).1;
    let told = problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n");
    assert!(told.contains("`sigma_max`") && told.contains("error"), "{told}");
}
