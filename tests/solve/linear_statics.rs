//! Linear statics against closed forms, against small loads of the nonlinear analysis, and against its own proportionality.

use crate::support::{Row, read_deck, tables_of};
use rdsolve::diagnostic::Source;
use rdsolve::model::Model;
use std::f64::consts::PI;

const STEEL: &str = r#"
    materials = { steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25, density = 8000.0 } }
    sections = { square = { shape = "rectangle", width = 0.1, height = 0.2 } }
"#;

/// Columns that say what a row is about, and stresses that are no linear functions of loads.
const KEYS: [&str; 12] =
    ["step", "time", "x", "y", "z", "s", "element", "layer", "von_mises", "sigma_max", "sigma_min", "tau_max"];

/// The rows of a table that belong to a case, or to the last step where there are none.
fn of_case(model: &Model, file: &str, case: Option<&str>) -> Vec<Vec<f64>> {
    let tables = tables_of(model);
    let rows = tables.rows(file);
    let last = rows.last().map(|row: &Row| row.number("step"));
    let here = |row: &&Row| match case {
        Some(case) => row.text("case") == case,
        None => Some(row.number("step")) == last,
    };
    let numbers = |row: &Row| {
        let mut own = row.numbers();
        // Magnitudes have no derivative where they vanish.
        let is_magnitude = |name: &str| file == "joints.csv" && ["force", "moment"].contains(&name);
        own.retain(|(name, _)| !KEYS.contains(name) && !is_magnitude(name));
        own.sort_unstable_by_key(|(name, _)| *name);
        own.into_iter().map(|(_, value)| value).collect()
    };
    rows.iter().filter(here).map(numbers).collect()
}

/// The largest difference of two tables, column by column over the largest number of the column.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>], factor: f64) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut worst = 0.0f64;
    for column in 0..a[0].len() {
        let largest = a.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        for (a, b) in a.iter().zip(b) {
            if largest > 0.0 {
                worst = worst.max((a[column] - factor * b[column]).abs() / largest);
            }
        }
    }
    worst
}

/// A cantilever of Timoshenko under a force at its tip: w = F L³/(3 E I) + F L/(G A κ), θ = F L²/(2 E I), whatever their size.
#[test]
fn a_cantilever_has_its_closed_form() {
    let text = format!(
        r#"
        analysis = {{ kind = "static", geometry = "linear" }}
        {STEEL}
        points = {{ root = [0.0, 0.0, 0.0], tip = [2.0, 0.0, 0.0] }}
        beams = [{{ name = "arm", path = ["root", "tip"], elements = 2, material = "steel", section = "square",
                    orientation = [0.0, 1.0, 0.0] }}]
        supports = [{{ at = "root", fix = "all" }}]
        loads = [{{ at = "tip", force = [0.0, 0.0, -3e8] }}]
        output = {{ reactions = true, sections = {{ at = "both" }} }}
        "#
    );
    let model = read_deck(&text);
    let (force, length, E, G) = (-3e8, 2.0f64, 2e11, 0.8e11);
    let (I, shear) = (0.1 * 0.2f64.powi(3) / 12.0, model.stiffnesses[0].N[(2, 2)] / G);
    let tables = tables_of(&model);
    let tip = tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "tip").unwrap();
    let (w, turn) =
        (force * length.powi(3) / (3.0 * E * I) + force * length / (G * shear), force * length.powi(2) / (2.0 * E * I));
    // Cubic beams have the exact answer; rotations of 225 rad are proportional to the load like all else.
    assert!((tip.number("uz") / w - 1.0).abs() < 1e-10, "{} {w}", tip.number("uz"));
    assert!((tip.number("ry") / -turn - 1.0).abs() < 1e-10, "{} {turn}", tip.number("ry"));
    let reactions = tables.rows("reactions.csv");
    let of =
        |direction: &str| reactions.iter().rfind(|row| row.text("direction") == direction).unwrap().number("value");
    assert!((of("uz") / -force - 1.0).abs() < 1e-10);
    assert!((of("ry") / (force * length) - 1.0).abs() < 1e-10, "{}", of("ry"));
    for row in tables.rows("sections.csv").into_iter().filter(|row| row.number("step") > 0.0) {
        let moment = -force * (length - row.number("s"));
        // Differences of sixth order, and rounding of the axial stiffness over the bending stiffness.
        assert!((row.number("My") - moment).abs() < 1e-9 * force.abs() * length, "{} {moment}", row.number("My"));
        assert!((row.number("Vz") / force - 1.0).abs() < 1e-9);
    }
}

/// A clamped-free frame with shells, a joint with a spring, an attached body and a bushing.
fn mixed(analysis: &str, size: f64) -> Model {
    read_deck(&format!(
        r#"
        {analysis}
        {STEEL}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.2, 1.0], c = [2.0, 0.0, 1.0], d = [2.0, 0.0, 0.0], e = [2.0, 1.0, 0.0],
                    f = [2.0, 1.0, 1.0], g = [1.0, 0.2, 0.0] }}
        beams = [{{ name = "arm", path = ["a", "b", "c"], elements = 2, material = "steel", section = "square",
                    orientation = [0.0, 1.0, 0.0] }}]
        bars = [{{ name = "tie", path = ["b", "g"], material = "steel", area = 1e-3 }}]
        shells = [{{ name = "wall", corners = ["c", "d", "e", "f"], elements = 2, material = "steel", thickness = 0.2 }}]
        bodies = [{{ name = "box", center = [1.0, 0.2, 1.5], mass = 100.0, inertia = [1.0, 1.0, 1.0] }}]
        attachments = [{{ body = "box", nodes = "b" }}]
        joints = [{{ name = "hinge", kind = "revolute", from = {{ node = "a" }}, to = {{ ground = [0.0, 0.0, 0.0] }},
                     axis = [0.0, 1.0, 0.0], stiffness = 1e7 }}]
        links = [{{ name = "mount", from = {{ node = "f" }}, to = {{ ground = [2.0, 1.0, 1.0] }},
                    bushing = [1e8, 2e8, 3e8, 1e6, 1e6, 1e6] }},
                 {{ name = "spring", from = {{ node = "f" }}, to = {{ ground = [3.0, 2.0, 2.0] }}, stiffness = 1e8 }}]
        supports = [{{ at = ["d", "e", "g"], fix = "translations" }},
                    {{ at = "c", motion = {{ uz = {{ amplitude = "full", scale = {settling} }} }} }}]
        amplitudes = {{ full = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
        loads = [{{ at = "box", force = [{force}, 0.0, {force}], moment = [0.0, 0.0, {force}] }},
                 {{ at = "wall", pressure = {force} }}]
        iteration = {{ tolerance = 1e-14 }}
        output = {{ nodes = "all", reactions = true, sections = {{ at = "both" }}, layers = true, joints = true, links = true }}
        "#,
        settling = 1e-5 * size,
        force = 1e4 * size,
    ))
}

/// The largest difference between linear results and the derivatives of nonlinear ones at no load, by differences of fourth order.
fn off_derivatives(model: impl Fn(&str, f64) -> Model, size: f64, files: &[&str]) -> f64 {
    let linear = model(r#"analysis = { kind = "static", geometry = "linear" }"#, 1.0);
    let stepped = r#"analysis = { kind = "static", end_time = 1.0, time_step = 1.0 }"#;
    let nonlinear = [1.0, -1.0, 2.0, -2.0].map(|factor| model(stepped, factor * size));
    let weights = [2.0 / 3.0, -2.0 / 3.0, -1.0 / 12.0, 1.0 / 12.0].map(|weight| weight / size);
    let off = |file: &&str| {
        let tables = nonlinear.each_ref().map(|model| of_case(model, file, None));
        let of = |row: usize, column: usize| tables.iter().zip(weights).map(|(of, w)| w * of[row][column]).sum::<f64>();
        let differences: Vec<Vec<f64>> =
            (0..tables[0].len()).map(|row| (0..tables[0][row].len()).map(|column| of(row, column)).collect()).collect();
        apart(&of_case(&linear, file, None), &differences, 1.0)
    };
    files.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn small_loads_of_the_nonlinear_analysis_agree() {
    let files = ["nodes.csv", "reactions.csv", "sections.csv", "layers.csv", "links.csv", "joints.csv", "bars.csv"];
    // Rotations of 3e-4: the fourth power is 1e-14, and rounding of positions of 1 leaves strains of 1e-6 ten digits.
    let off = off_derivatives(mixed, 1.0, &files);
    assert!(off < 1e-9, "{off:e}");
}

/// Two cantilevers joined at their tips, which a force and a moment move apart as the joint lets them.
fn joined(analysis: &str, (kind, keys): (&str, &str), size: f64) -> Model {
    let gap = if kind == "distance" { 0.3 } else { 0.0 };
    read_deck(&format!(
        r#"
        {analysis}
        {STEEL}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.1, 0.2], c = [{far}, 0.1, 0.2], d = [2.0, 0.5, 0.0] }}
        beams = [{{ name = "left", path = ["a", "b"], elements = 1, material = "steel", section = "square",
                    orientation = [0.0, 1.0, 0.0], offset_start = [0.0, 0.1, 0.0] }},
                 {{ name = "right", path = ["c", "d"], elements = 1, order = 2, material = "steel", section = "square",
                    orientation = [0.0, 1.0, 0.3] }}]
        joints = [{{ name = "pin", kind = "{kind}", from = {{ node = "b" }}, to = {{ node = "c" }}, {keys} }}]
        supports = [{{ at = ["a", "d"], fix = ["ux", "uy", "uz", "rx"] }},
                    {{ at = "a", motion = {{ ry = {{ amplitude = "full", scale = {turn} }}, rz = {{ amplitude = "full", scale = {turn} }} }} }},
                    {{ at = "d", fix = ["ry", "rz"] }}]
        amplitudes = {{ full = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
        loads = [{{ at = "b", force = [{force}, {force}, {force}], moment = [0.0, {force}, {force}] }}]
        iteration = {{ tolerance = 1e-14 }}
        output = {{ nodes = "all", reactions = true, sections = {{ at = "both" }}, joints = true }}
        "#,
        far = 1.0 + gap,
        turn = 1e-4 * size,
        force = 1e4 * size,
        keys = keys.replace("SIZE", &format!("{:e}", 1e-4 * size)).replace("FORCE", &format!("{:e}", 1e4 * size)),
    ))
}

#[test]
fn every_joint_is_linear_as_small_motions_are() {
    let axis = "axis = [0.3, 1.0, 0.2]";
    let kinds = [
        ("spherical", String::new()),
        ("revolute", format!("{axis}, stiffness = 1e6")),
        ("revolute", format!("{axis}, motion = {{ position = SIZE, amplitude = \"full\" }}")),
        ("prismatic", format!("{axis}, effort = {{ value = FORCE, amplitude = \"full\" }}")),
        ("prismatic", format!("{axis}, motion = {{ position = SIZE, amplitude = \"full\" }}")),
        ("cylindrical", axis.to_owned()),
        ("screw", format!("{axis}, lead = 0.1")),
        ("planar", axis.to_owned()),
        ("in-line", axis.to_owned()),
        ("in-plane", axis.to_owned()),
        ("universal", format!("{axis}, cross_axis = [1.0, -0.3, 0.0]")),
        ("fixed", String::new()),
        ("distance", String::new()),
    ];
    for (kind, keys) in &kinds {
        let files = ["nodes.csv", "reactions.csv", "sections.csv", "joints.csv"];
        // Loose joints turn far under small loads.
        let size = if *kind == "distance" { 0.03 } else { 0.1 };
        let off = off_derivatives(|analysis, size| joined(analysis, (kind, keys), size), size, &files);
        assert!(off < 1e-9, "{kind} {keys}: {off:e}");
    }
}

/// A square plate on simple supports under its pressure: w = 0.00406 p a⁴/D (Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells,
/// 1959, table 8), though it deflects by five thicknesses on paper.
#[test]
fn a_plate_deflects_as_plate_theory_has_it() {
    let model = read_deck(
        r#"
        analysis = { kind = "static", geometry = "linear" }
        materials = { soft = { model = "elastic", youngs_modulus = 1.2e7, poisson_ratio = 0.3 } }
        points = { a = [0.0, 0.0, 0.0], b = [5.0, 0.0, 0.0], c = [5.0, 5.0, 0.0], d = [0.0, 5.0, 0.0] }
        shells = [{ name = "quarter", corners = ["a", "b", "c", "d"], elements = 8, material = "soft", thickness = 0.05 }]
        supports = [{ at = ["quarter.edge1", "quarter.edge4"], fix = ["uz"] },
                    { at = "quarter.edge2", fix = ["ux", "ry", "rz"] },
                    { at = "quarter.edge3", fix = ["uy", "rx", "rz"] }]
        loads = [{ at = "quarter", pressure = 1.0 }]
        "#,
    );
    let tables = tables_of(&model);
    let middle = tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "c").unwrap();
    let bending = 1.2e7 * 0.05f64.powi(3) / (12.0 * (1.0 - 0.09));
    let w = -0.004062 * 1e4 / bending;
    // A mesh of 8 × 8 elements for a quarter is off by 0.5 %, and soft supports let corners deflect a little more.
    assert!((middle.number("uz") / w - 1.0).abs() < 0.01, "{} {w}", middle.number("uz"));
    assert!(w.abs() > 5.0 * 0.05);
}

/// Cases of a frame with a settling support, a weight and a load along a beam.
fn cases() -> Model {
    read_deck(&format!(
        r#"
        analysis = {{ kind = "static", geometry = "linear" }}
        {STEEL}
        points = {{ a = [0.0, 0.0, 0.0], b = [0.0, 0.0, 3.0], c = [4.0, 0.0, 3.0], d = [4.0, 1.0, 0.0] }}
        beams = [{{ name = "frame", path = ["a", "b", "c", "d"], elements = 1, material = "steel", section = "square",
                    orientation = [0.3, 1.0, 0.1] }}]
        supports = [{{ name = "settling", at = "a", fix = ["ux", "uy", "rx", "ry", "rz"],
                       motion = {{ uz = {{ amplitude = "full", scale = -0.01 }} }} }},
                    {{ at = "d", fix = "all" }}]
        amplitudes = {{ full = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        loads = [{{ name = "wind", at = "b", force = [1e3, 500.0, 0.0] }},
                 {{ name = "snow", part = "frame", force_per_length = [0.0, 0.0, -500.0] }}]
        load_cases = [{{ name = "dead", loads = "gravity" }}, {{ name = "wind", loads = "wind" }},
                      {{ name = "all", loads = ["gravity", "wind", "snow", "settling"], factors = [1.35, 1.5, -0.5, 2.0] }},
                      {{ name = "snow", loads = "snow" }}, {{ name = "settled", loads = "settling" }}]
        combinations = [{{ name = "sum", cases = ["dead", "wind", "snow", "settled"], factors = [1.35, 1.5, -0.5, 2.0] }}]
        envelopes = [{{ name = "band", cases = ["dead", "wind", "sum"] }}]
        output = {{ nodes = "all", reactions = true, sections = {{ at = "both" }}, energy = true }}
        "#
    ))
}

#[test]
fn cases_superpose_and_envelopes_hold_their_extremes() {
    let model = cases();
    for file in ["nodes.csv", "reactions.csv", "sections.csv"] {
        let of = |case: &str| of_case(&model, file, Some(case));
        let [dead, wind, snow, settled] = ["dead", "wind", "snow", "settled"].map(of);
        let sum = |row: usize, column: usize| {
            1.35 * dead[row][column] + 1.5 * wind[row][column] - 0.5 * snow[row][column] + 2.0 * settled[row][column]
        };
        let expected: Vec<Vec<f64>> =
            (0..dead.len()).map(|row| (0..dead[row].len()).map(|column| sum(row, column)).collect()).collect();
        // Sums of four solutions of 1e-12, and differences of 5e-13.
        for case in ["sum", "all"] {
            let off = apart(&expected, &of(case), 1.0);
            assert!(off < 1e-9, "{file} {case}: {off:e}");
        }
        let (most, least) = (of("band.max"), of("band.min"));
        for row in 0..dead.len() {
            for column in 0..dead[row].len() {
                let all = [dead[row][column], wind[row][column], of("sum")[row][column]];
                assert_eq!(most[row][column], all.into_iter().fold(f64::NEG_INFINITY, f64::max));
                assert_eq!(least[row][column], all.into_iter().fold(f64::INFINITY, f64::min));
            }
        }
    }
}

#[test]
fn reactions_balance_the_loads_and_work_the_energy() {
    let model = cases();
    let tables = tables_of(&model);
    let sum = |case: &str, direction: &str| -> f64 {
        let rows = tables.rows("reactions.csv");
        rows.iter()
            .filter(|row| row.text("case") == case && row.text("direction") == direction)
            .map(|row| row.number("value"))
            .sum()
    };
    let length = 3.0 + 4.0 + 10f64.sqrt();
    let weight = 8000.0 * 0.02 * length * 10.0;
    assert!((sum("dead", "uz") / weight - 1.0).abs() < 1e-9, "{}", sum("dead", "uz"));
    assert!((sum("snow", "uz") / (500.0 * length) - 1.0).abs() < 1e-9);
    assert!((sum("wind", "ux") / -1e3 - 1.0).abs() < 1e-9 && (sum("wind", "uy") / -500.0 - 1.0).abs() < 1e-9);
    assert!(sum("settled", "uz").abs() < 1e-9 * weight);
    for row in tables.rows("energy.csv").iter().filter(|row| !row.text("case").starts_with("band")) {
        let (strain, external) = (row.number("strain"), row.number("external"));
        assert!((strain / external - 1.0).abs() < 1e-9, "{strain} {external}");
    }
}

/// One instant after the other where there are no cases: the loads of an amplitude, from one matrix.
#[test]
fn times_follow_amplitudes() {
    let model = read_deck(&format!(
        r#"
        analysis = {{ kind = "static", geometry = "linear", end_time = 2.0, time_step = 0.25 }}
        {STEEL}
        points = {{ root = [0.0, 0.0, 0.0], tip = [2.0, 0.0, 0.0] }}
        beams = [{{ name = "arm", path = ["root", "tip"], elements = 1, material = "steel", section = "square",
                    orientation = [0.0, 1.0, 0.0] }}]
        supports = [{{ at = "root", fix = "all" }}]
        amplitudes = {{ wave = {{ kind = "sine", frequency = 0.5 }} }}
        loads = [{{ at = "tip", force = [0.0, 0.0, -1.0], amplitude = "wave" }}]
        "#
    ));
    let tables = tables_of(&model);
    let tip: Vec<Row> = tables.rows("nodes.csv").into_iter().filter(|row| row.text("node") == "tip").collect();
    assert_eq!(tip.len(), 9);
    let most = tip[2].number("uz");
    for row in &tip {
        let expected = most * (PI * row.number("time")).sin();
        assert!((row.number("uz") - expected).abs() < 1e-12 * most.abs(), "{} {expected}", row.number("uz"));
    }
}

/// A hub without mass between two guided cantilevers: w = (F/2) L³/(12 E I) + (F/2) L/(G A κ). In dynamics, and under gravity, it needs one.
#[test]
fn a_body_needs_no_mass_where_nothing_depends_on_it() {
    let text = |geometry: &str, force: f64, more: &str| {
        format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 1.0, geometry = "{geometry}" }}
            {STEEL}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0], c = [2.4, 0.0, 0.0], d = [4.4, 0.0, 0.0] }}
            beams = [{{ name = "left", path = ["a", "b"], elements = 1, material = "steel", section = "square",
                        orientation = [0.0, 1.0, 0.0] }},
                     {{ name = "right", path = ["c", "d"], elements = 1, material = "steel", section = "square",
                        orientation = [0.0, 1.0, 0.0] }}]
            bodies = [{{ name = "hub", center = [2.2, 0.0, 0.0] {more} }}]
            attachments = [{{ body = "hub", nodes = ["b", "c"] }}]
            supports = [{{ at = ["a", "d"], fix = "all" }}]
            loads = [{{ at = "hub", force = [0.0, 0.0, {force}] }}]
            "#
        )
    };
    let (length, E, G) = (2.0f64, 2e11, 0.8e11);
    let I = 0.1 * 0.2f64.powi(3) / 12.0;
    for (geometry, force, tolerance) in [("linear", 1e6, 1e-10), ("finite", 1e2, 1e-7)] {
        // The axial force of the nonlinear analysis stiffens by the square of the slope, 4e-9 · A L²/I.
        let model = read_deck(&text(geometry, force, ""));
        let shear = model.stiffnesses[0].N[(2, 2)] / G;
        let w = 0.5 * force * (length.powi(3) / (12.0 * E * I) + length / (G * shear));
        let tables = tables_of(&model);
        let hub = tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "b").unwrap();
        assert!((hub.number("uz") / w - 1.0).abs() < tolerance, "{geometry}: {} {w}", hub.number("uz"));
    }
    let gravity = "\nenvironment = { gravity = [0.0, 0.0, -9.81] }";
    let said = |text: String| {
        let problems = rdsolve::model::read(&Source::new("deck.toml", text, &[])).1;
        problems.iter().map(|problem| format!("{problem:?}")).collect::<String>()
    };
    assert!(said(text("linear", 1.0, "") + gravity).contains("gravity acts, and body `hub` has no `mass`"));
    assert!(!said(text("linear", 1.0, ", mass = 0.0") + gravity).contains("no `mass`"));
    let dynamic = text("finite", 1.0, "").replace("\"static\"", "\"dynamic\"");
    assert!(said(dynamic).contains("only in statics and buckling a body may have none"));
}
