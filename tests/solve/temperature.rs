//! Strain by temperature against closed forms: expansion, bending by a gradient, buckling, yielding, vibration.

use crate::support::{Row, Tables, read_deck, run_source, run_with_warnings, tables_of};
use rdsolve::diagnostic::Source;
use rdsolve::solve::Outcome;
use std::f64::consts::PI;

const STEEL: &str = r#"
    materials = { steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25, density = 8000.0, expansion = 1e-5 } }
    sections = { square = { shape = "rectangle", width = 0.1, height = 0.2 } }
"#;
const STATIC: &str = r#"analysis = { kind = "static", end_time = 1.0, time_step = 1.0 }"#;
const LINEAR: &str = r#"analysis = { kind = "static", geometry = "linear" }"#;
const E: f64 = 2e11;
const ALPHA: f64 = 1e-5;
const AREA: f64 = 0.02;

/// The rows of a table at the last step.
fn last(tables: &Tables, file: &str) -> Vec<Row> {
    let mut rows = tables.rows(file);
    let step = rows.last().map(|row| row.number("step"));
    rows.retain(|row| Some(row.number("step")) == step);
    rows
}

/// A column of a node at the last step.
fn at(tables: &Tables, node: &str, column: &str) -> f64 {
    last(tables, "nodes.csv").iter().find(|row| row.text("node") == node).expect("a node").number(column)
}

/// A line of two metres along x, a beam or a bar, with supports and a load of temperature.
fn line(analysis: &str, part: &str, supports: &str, heat: &str) -> Tables {
    tables_of(&read_deck(&format!(
        r#"
        {analysis}
        {STEEL}
        points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
        {part} = [{{ name = "line", path = ["a", "b"], elements = {count}, material = "steel", {keys} }}]
        supports = [{supports}]
        loads = [{{ part = "line", {heat} }}]
        iteration = {{ tolerance = 1e-12 }}
        output = {{ nodes = "all", reactions = true, energy = true, {results} }}
        "#,
        count = if part == "beams" { 2 } else { 1 },
        keys = if part == "beams" { "section = \"square\", orientation = [0.0, 1.0, 0.0]" } else { "area = 0.02" },
        results = if part == "beams" { "sections = { at = \"both\" }" } else { "sections = true" },
    )))
}

const CLAMPED: &str = r#"{ at = ["a", "b"], fix = "all" }"#;
const HELD: &str = r#"{ at = "a", fix = "all" }, { at = "b", fix = ["uy", "uz"] }"#;
const CANTILEVER: &str = r#"{ at = "a", fix = "all" }"#;

/// N = −E A α ΔT where nothing may expand, in both geometries: nothing moves. The energy is the work of heating, ½ E A (α ΔT)² L.
#[test]
fn what_is_held_is_pressed() {
    for (part, fix) in [("beams", CLAMPED), ("bars", r#"{ at = ["a", "b"], fix = "translations" }"#)] {
        for analysis in [STATIC, LINEAR] {
            let tables = line(analysis, part, fix, "temperature = 40.0");
            let force = E * AREA * ALPHA * 40.0;
            let reaction = last(&tables, "reactions.csv");
            let push = reaction.iter().find(|row| row.text("node") == "a" && row.text("direction") == "ux").unwrap();
            assert!((push.number("value") / force - 1.0).abs() < 1e-12, "{part}: {}", push.number("value"));
            let row = last(&tables, if part == "beams" { "sections.csv" } else { "bars.csv" }).remove(0);
            assert!((row.number("N") / -force - 1.0).abs() < 1e-9, "{part} {analysis}: {}", row.number("N"));
            let energy = last(&tables, "energy.csv").remove(0);
            let stored = 0.5 * force * ALPHA * 40.0 * 2.0;
            assert!((energy.number("strain") / stored - 1.0).abs() < 1e-9, "{}", energy.number("strain"));
            if analysis == STATIC {
                assert!((energy.number("external") / stored - 1.0).abs() < 1e-9, "{}", energy.number("external"));
            }
        }
    }
}

/// The free line is longer by α ΔT L, and has no force.
#[test]
fn what_is_free_expands() {
    for (part, fix) in
        [("beams", HELD), ("bars", r#"{ at = "a", fix = "translations" }, { at = "b", fix = ["uy", "uz"] }"#)]
    {
        for analysis in [STATIC, LINEAR] {
            let tables = line(analysis, part, fix, "temperature = -40.0");
            let u = at(&tables, "b", "ux");
            assert!((u / (-ALPHA * 40.0 * 2.0) - 1.0).abs() < 1e-12, "{part} {analysis}: {u}");
        }
    }
}

/// A gradient of g along z curls a cantilever to an arc of the curvature α g, sagging where the top is hotter; fixed at both ends it
/// has the moment E I α g instead. In linear geometry the tip moves by α g L²/2.
#[test]
fn a_gradient_bends() {
    let inertia = 0.1 * 0.2f64.powi(3) / 12.0;
    let gradient = 5e4 * PI;
    let bend = ALPHA * gradient;
    // Twice as much would make it buckle out of its plane.
    let little = 0.2 * gradient;
    let tables = line(STATIC, "beams", CLAMPED, &format!("temperature_gradient = [0.0, {little:?}]"));
    for row in last(&tables, "sections.csv") {
        let moment = row.number("My");
        assert!((moment / -(E * inertia * ALPHA * little) - 1.0).abs() < 1e-9, "{moment}");
    }
    let linear = line(LINEAR, "beams", CANTILEVER, &format!("temperature_gradient = [0.0, {gradient:?}]"));
    let tip = at(&linear, "b", "uz");
    assert!((tip / (-0.5 * bend * 4.0) - 1.0).abs() < 1e-10, "{tip}");
    // Half a circle, α g L = π, of two cubic elements: sixth order of a quarter of a circle.
    let steps = r#"analysis = { kind = "static", end_time = 1.0, time_step = 0.1 }"#;
    let arc = line(steps, "beams", CANTILEVER, &format!("temperature_gradient = [0.0, {gradient:?}]"));
    let (x, z) = (2.0 + at(&arc, "b", "ux"), at(&arc, "b", "uz"));
    let radius = 2.0 / PI;
    assert!(x.abs() < 1e-4 && (z + 2.0 * radius).abs() < 1e-4, "{x:e} {z}");
    for row in last(&arc, "sections.csv") {
        assert!(row.number("My").abs() < 1e-4 * E * inertia * bend, "{}", row.number("My"));
    }
    let across = line(STATIC, "beams", CLAMPED, &format!("temperature_gradient = [{little:?}, 0.0]"));
    let other = 0.2 * 0.1f64.powi(3) / 12.0;
    let moment = last(&across, "sections.csv").remove(0).number("Mz");
    assert!((moment / (E * other * ALPHA * little) - 1.0).abs() < 1e-9, "{moment}");
}

/// A square of shells of a size of 2, of each kind of element.
fn square(analysis: &str, kind: &str, supports: &str, heat: &str) -> Tables {
    tables_of(&read_deck(&format!(
        r#"
        {analysis}
        {STEEL}
        points = {{ a = [-1.0, -1.0, 0.0], b = [1.0, -1.0, 0.0], c = [1.0, 1.0, 0.0], d = [-1.0, 1.0, 0.0] }}
        shells = [{{ name = "plate", corners = ["a", "b", "c", "d"], elements = 2, {kind}, material = "steel", thickness = 0.02 }}]
        supports = [{supports}]
        loads = [{{ part = "plate", {heat} }}]
        iteration = {{ tolerance = 1e-12 }}
        output = {{ nodes = "all", sections = true }}
        "#
    )))
}

const KINDS: [&str; 4] = [
    r#"kind = "quadrilateral""#,
    r#"kind = "triangle""#,
    r#"kind = "quadrilateral", order = 2"#,
    r#"kind = "triangle", order = 2"#,
];

/// N = −E h α ΔT/(1 − ν) where the edges hold the plate, and M = −E h³ α g/(12 (1 − ν)); free it grows to a picture of itself.
#[test]
fn plates_expand_and_bend() {
    let h = 0.02;
    let edges = r#"{ at = ["plate.edge1", "plate.edge2", "plate.edge3", "plate.edge4"], fix = "all" }"#;
    let free =
        r#"{ at = "a", fix = ["ux", "uy", "uz"] }, { at = "b", fix = ["uy", "uz"] }, { at = "d", fix = ["uz"] }"#;
    for kind in KINDS {
        for analysis in [STATIC, LINEAR] {
            let tables = square(analysis, kind, edges, "temperature = 4.0");
            let N = -E * h * ALPHA * 4.0 / 0.75;
            let exact = if analysis == LINEAR { N } else { N * (1.0 + 0.5 * ALPHA * 4.0) };
            for row in last(&tables, "shells.csv") {
                for column in ["N11", "N22"] {
                    assert!((row.number(column) / exact - 1.0).abs() < 1e-9, "{kind} {}", row.number(column) / exact);
                }
            }
            let tables = square(analysis, kind, edges, "temperature_gradient = 1000.0");
            let M = -E * h * h * h * ALPHA * 1000.0 / (12.0 * 0.75);
            for row in last(&tables, "shells.csv") {
                assert!((row.number("M11") / M - 1.0).abs() < 1e-6, "{kind} {}", row.number("M11") / M);
            }
            let tables = square(analysis, kind, free, "temperature = 40.0");
            let u = at(&tables, "c", "ux");
            assert!((u / (ALPHA * 40.0 * 2.0) - 1.0).abs() < 1e-9, "{kind} {analysis}: {u}");
            for row in last(&tables, "shells.csv") {
                assert!(row.number("N11").abs() < 1e-9 * N.abs(), "{kind}: {}", row.number("N11"));
            }
            // A sphere of the curvature α g = 1e-4: the middle lies above the corners by α g r²/2.
            let tables = square(analysis, kind, free, "temperature_gradient = 10.0");
            let rows = last(&tables, "nodes.csv");
            let centre = rows.iter().find(|row| row.number("x").abs() < 1e-3 && row.number("y").abs() < 1e-3).unwrap();
            let rise = centre.number("uz") / (0.5 * 1e-4 * 2.0) - 1.0;
            // A sphere is not developable: membranes hold it by the square of the rise over the thickness, 2.5e-5, in part.
            assert!(rise.abs() < 1e-5, "{kind} {analysis}: {rise:e}");
        }
    }
}

/// A corner of a beam, a shell and a bar, all heated alike and turned by a radian and a half, has no stress.
#[test]
fn a_turned_structure_that_may_expand_has_no_stress() {
    let tables = tables_of(&read_deck(&format!(
        r#"
        analysis = {{ kind = "static", end_time = 1.0, time_step = 0.1 }}
        {STEEL}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.5], c = [1.0, 1.0, 0.5], d = [0.0, 1.0, 0.0] }}
        beams = [{{ name = "corner", path = ["a", "b", "c"], elements = 2, material = "steel", section = "square",
                    orientation = [0.0, 0.0, 1.0] }}]
        shells = [{{ name = "wall", corners = ["a", "b", "c", "d"], elements = 2, material = "steel", thickness = 0.02 }}]
        bars = [{{ name = "tie", path = ["a", "c"], material = "steel", area = 1e-2 }}]
        supports = [{{ at = "a", fix = ["ux", "uy", "uz", "rx", "rz"], motion = {{ ry = {{ amplitude = "turn", scale = 1.5 }} }} }}]
        amplitudes = {{ turn = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
        loads = [{{ part = ["corner", "wall", "tie"], temperature = 400.0 }}]
        iteration = {{ tolerance = 1e-12 }}
        output = {{ nodes = "all", energy = true }}
        "#
    )));
    let energy = last(&tables, "energy.csv").remove(0).number("strain");
    // The tie alone, held, would store E A (α ΔT)² L/2 = 2.4e4; rounding of strains of 1e-3 is 1e-13 of them.
    assert!(energy.abs() < 1e-12 * 2.4e4, "{energy:e}");
    let [x, z] = ["ux", "uz"].map(|column| at(&tables, "b", column));
    let length = (1.25f64).sqrt() * (1.0 + 4e-3);
    let stretched = ((1.0 + x).powi(2) + (0.5 + z).powi(2)).sqrt();
    assert!((stretched / length - 1.0).abs() < 1e-12, "{stretched} {length}");
}

/// What yields under heat and cools again is left in tension of the stress that heating would have had, less the yield stress.
#[test]
fn yielding_by_heat_leaves_stress() {
    let heat = |part: &str| {
        tables_of(&read_deck(&format!(
            r#"
            analysis = {{ kind = "static", end_time = 2.0, time_step = 0.1 }}
            materials = {{ steel = {{ model = "elastic-plastic", youngs_modulus = 2e11, poisson_ratio = 0.25, yield_stress = 2e8,
                                      hardening_modulus = 0.0, expansion = 1e-5 }} }}
            sections = {{ square = {{ shape = "rectangle", width = 0.1, height = 0.2 }} }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0], c = [2.0, 2.0, 0.0], d = [0.0, 2.0, 0.0] }}
            {part}
            supports = [{{ at = "line", fix = "all" }}]
            amplitudes = {{ cycle = {{ kind = "table", points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]] }} }}
            loads = [{{ part = "line", temperature = 125.0, amplitude = "cycle" }}]
            output = {{ nodes = "all", energy = true, sections = {{ at = "points" }} }}
            "#
        )))
    };
    let left = E * ALPHA * 125.0 - 2e8;
    let bars = heat(r#"bars = [{ name = "line", path = ["a", "b"], material = "steel", area = 0.02 }]"#);
    let force = last(&bars, "bars.csv").remove(0).number("N");
    assert!((force / (AREA * left) - 1.0).abs() < 1e-9, "{force}");
    // The work of the cycle is that of yielding and what is stored. Yielding begins at the end of a step, so trapezoids are exact.
    let energy = last(&bars, "energy.csv").remove(0);
    let spent = energy.number("plastic") + energy.number("strain");
    assert!((energy.number("external") / spent - 1.0).abs() < 1e-9, "{} {spent}", energy.number("external"));
    let beam = r#"beams = [{ name = "line", path = ["a", "b"], elements = 1, material = "steel", section = "square",
                             orientation = [0.0, 1.0, 0.0] }]"#;
    let force = last(&heat(beam), "sections.csv").remove(0).number("N");
    assert!((force / (AREA * left) - 1.0).abs() < 1e-6, "{force}");
    let shell = r#"shells = [{ name = "line", corners = ["a", "b", "c", "d"], elements = 1, material = "steel", thickness = 0.02 }]"#;
    let force = last(&heat(shell), "shells.csv").remove(0).number("N11");
    let both = E * ALPHA * 125.0 * (1.0 + 0.5 * ALPHA * 125.0) / 0.75 - 2e8;
    // Green's strain of the heat.
    assert!((force / (0.02 * both) - 1.0).abs() < 2e-3, "{} {}", force, 0.02 * both);
}

/// A pinned column buckles at α ΔT E A = π² E I/L², less the part of shear: one bifurcation temperature below it, one above.
#[test]
fn a_heated_column_buckles() {
    let stands = |factor: f64| {
        let euler = PI * PI * (0.01f64.powi(4) / 12.0) / 4.0 / (1e-4 * ALPHA);
        let (outcome, warnings) = run_with_warnings(&format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.1 }}
            materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25, expansion = 1e-5 }} }}
            sections = {{ square = {{ shape = "rectangle", width = 0.01, height = 0.01 }} }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            beams = [{{ name = "line", path = ["a", "b"], elements = 4, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0] }}]
            supports = [{{ at = "a", fix = ["ux", "uy", "uz", "rx", "rz"] }}, {{ at = "b", fix = ["ux", "uy", "uz", "rx", "rz"] }},
                        {{ at = "line", fix = ["uy"] }}]
            loads = [{{ part = "line", temperature = {:?} }}]
            "#,
            factor * euler
        ));
        matches!(outcome, Outcome::Done) && !warnings.iter().any(|said| said.contains("buckle"))
    };
    // Shear and shortening before buckling take 1e-4 of it.
    assert!(stands(0.999));
    assert!(!stands(1.001));
}

/// Factors of temperature: a clamped column at α ΔT = 4 π² I/(A L²), less the part of shear, alone and in a stage after another load; a square
/// plate that is held along its edges at α ΔT = (1 + ν) π² h²/(6 (1 − ν²) a²) · (1 − ν) by the theory of thin plates.
#[test]
fn factors_of_temperature() {
    let column = |analysis: &str, slider: &str, loads: &str| {
        factor(&format!(
            r#"
            {analysis}
            materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25, expansion = 1e-5 }} }}
            sections = {{ square = {{ shape = "rectangle", width = 0.01, height = 0.01 }} }}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            beams = [{{ name = "line", path = ["a", "b"], elements = 8, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0] }}]
            supports = [{{ at = "a", fix = "all" }}, {{ at = "b", fix = ["uz", "rx", "ry", "rz"] }}, {{ at = "line", fix = "uy" }},
                        {{ at = "b", fix = "ux"{slider} }}]
            loads = [{loads}]
            "#
        ))
    };
    let strain = 4.0 * PI * PI * (0.01f64.powi(4) / 12.0) / 4.0 / 1e-4;
    let alone = column("analysis = { kind = \"buckling\", modes = 1 }", "", "{ part = \"line\", temperature = 10.0 }");
    // Shear with its area of 0.85 A takes E/(0.85 G) of the strain; eight elements of order 3 err by less than 5e-6.
    let found = alone * 10.0 * ALPHA / strain;
    assert!((found * (1.0 + strain * 2.5 / 0.85) - 1.0).abs() < 5e-6, "{found}");
    // A column that is pressed by half of what it bears has half of it left for the heat of the next stage.
    let press = format!(
        "{{ at = \"b\", force = [{:?}, 0.0, 0.0], stages = [\"press\", \"heat\"] }}",
        -0.5 * 2e11 * 1e-4 * strain
    );
    let heat = "{ part = \"line\", temperature = 10.0, stages = \"heat\" }";
    let stages = "stages = [{ name = \"press\", kind = \"static\", duration = 1.0, time_step = 1.0 }, \
                  { name = \"heat\", kind = \"buckling\", modes = 1 }]";
    let after = column(stages, ", stages = \"heat\"", &format!("{press}, {heat}"));
    assert!((after * 10.0 * ALPHA / (0.5 * strain) - 1.0).abs() < 1e-3, "{}", after * 10.0 * ALPHA / strain);
    let plate = |n: usize| {
        factor(&format!(
            r#"
            analysis = {{ kind = "buckling", modes = 1 }}
            materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, expansion = 1e-5 }} }}
            points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }}
            shells = [{{ name = "plate", corners = ["a", "b", "c", "d"], elements = {n}, thickness = 0.005, material = "steel" }}]
            supports = [{{ at = ["plate.edge1", "plate.edge2", "plate.edge3", "plate.edge4"], fix = "translations" }}]
            loads = [{{ part = "plate", temperature = 1.0 }}]
            "#
        ))
    };
    // σ = E α ΔT/(1 − ν) = 2 π² D/(a² h).
    let critical = 2.0 * PI * PI * 2e11 * 0.005f64.powi(2) / (12.0 * (1.0 - 0.09)) / (2e11 * ALPHA / 0.7);
    let errors = [4, 8, 16].map(|n| plate(n) / critical - 1.0);
    eprintln!("plate: {errors:?}");
    assert!(errors[0].abs() / errors[1].abs() > 3.5 && errors[2].abs() < 8e-3, "{errors:?}");
}

/// The first buckling factor of a deck.
fn factor(deck: &str) -> f64 {
    let asked = "[[expect]]\nmode = 1\nquantity = \"factor\"\nvalue = 1.0\ntolerance = 1e9\n";
    let source = Source::new("deck.toml", format!("{deck}\n{asked}"), &[]);
    run_source(&source, &mut |_| Vec::new()).verdicts[0].value.expect("a factor")
}

/// A bar held at one end and heated at once vibrates as one released from compression: the tip moves between 0 and 2 α ΔT L, and no energy
/// comes or goes. Heated over a time, the work of heating is the energy.
#[test]
fn sudden_heat_makes_waves() {
    let bar = |heat: &str| {
        tables_of(&read_deck(&format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 2e-3, time_step = 1e-5 }}
            integrator = {{ scheme = "newmark" }}
            {STEEL}
            points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
            bars = [{{ name = "line", path = ["a", "b"], elements = 40, material = "steel", area = 0.02 }}]
            supports = [{{ at = "line", fix = ["uy", "uz"] }}, {{ at = "a", fix = ["ux"] }}]
            amplitudes = {{ slow = {{ kind = "ramp", start = 0.0, end = 1e-3 }} }}
            loads = [{{ part = "line", temperature = 40.0, {heat} }}]
            output = {{ nodes = "all", energy = true }}
            "#
        )))
    };
    let stored = 0.5 * E * AREA * (ALPHA * 40.0f64).powi(2) * 2.0;
    let sudden = bar("");
    let most = sudden
        .rows("nodes.csv")
        .iter()
        .filter(|row| row.text("node") == "b")
        .map(|row| row.number("ux"))
        .fold(0.0, f64::max);
    // Waves through 40 elements disperse behind their front.
    assert!((most / (2.0 * ALPHA * 40.0 * 2.0) - 1.0).abs() < 0.02, "{most}");
    for row in sudden.rows("energy.csv") {
        assert!((row.number("mechanical") / stored - 1.0).abs() < 1e-6, "{} {stored}", row.number("mechanical"));
    }
    for row in bar(r#"amplitude = "slow""#).rows("energy.csv") {
        let missing = row.number("external") - row.number("mechanical");
        // The trapezoids of the work, over 100 steps of heating.
        assert!(missing.abs() < 1e-3 * stored, "{missing}");
    }
}

/// Two cases of temperature from one factorization, and the same at a small temperature in finite geometry.
#[test]
fn small_temperatures_are_linear() {
    let frame = |head: &str, tail: &str, size: f64| {
        tables_of(&read_deck(&format!(
            r#"
            {head}
            {STEEL}
            points = {{ a = [0.0, 0.0, 0.0], b = [0.0, 0.0, 2.0], c = [3.0, 0.0, 2.0], d = [3.0, 0.0, 0.0], e = [3.0, 2.0, 2.0], f = [0.0, 2.0, 2.0] }}
            beams = [{{ name = "frame", path = ["a", "b", "c", "d"], elements = 1, material = "steel", section = "square",
                        orientation = [0.0, 1.0, 0.0] }}]
            shells = [{{ name = "roof", corners = ["b", "c", "e", "f"], elements = 2, material = "steel", thickness = 0.02 }}]
            supports = [{{ at = ["a", "d", "e"], fix = "all" }}]
            loads = [{{ name = "sun", part = "roof", temperature = {0:?}, temperature_gradient = {1:?} }},
                     {{ name = "fire", part = "frame", temperature = {0:?}, temperature_gradient = [{1:?}, {1:?}] }}]
            {tail}
            iteration = {{ tolerance = 1e-14 }}
            output = {{ nodes = "all", sections = {{ at = "ends" }} }}
            "#,
            40.0 * size,
            400.0 * size
        )))
    };
    let cases = r#"
        load_cases = [{ name = "one", loads = ["sun", "fire"] }, { name = "two", loads = ["sun"], factors = -2.0 }]
        combinations = [{ name = "both", cases = ["one", "two"], factors = [1.0, 0.5] }]"#;
    let (linear, combined) = (frame(LINEAR, "", 1.0), frame(LINEAR, cases, 1.0));
    let small = [1.0, -1.0, 2.0, -2.0].map(|factor| frame(STATIC, "", factor * 1e-3));
    let of = |tables: &Tables, column: &str| {
        last(tables, "nodes.csv").iter().map(|row| row.number(column)).collect::<Vec<_>>()
    };
    for column in ["ux", "uz", "ry"] {
        let sampled = small.each_ref().map(|tables| of(tables, column));
        let exact = of(&linear, column);
        let largest = exact.iter().fold(0.0f64, |most, u| most.max(u.abs()));
        for (i, u) in exact.iter().enumerate() {
            // Differences of fourth order: those of second order err by 6e-9, and rounding by 1e-10.
            let difference = (8.0 * (sampled[0][i] - sampled[1][i]) - (sampled[2][i] - sampled[3][i])) / (12.0 * 1e-3);
            assert!((difference - u).abs() < 1e-9 * largest, "{column}: {difference} {u}");
        }
        let rows = combined.rows("nodes.csv");
        let case = |name: &str| {
            rows.iter().filter(|row| row.text("case") == name).map(|row| row.number(column)).collect::<Vec<_>>()
        };
        let (one, two, both) = (case("one"), case("two"), case("both"));
        for i in 0..exact.len() {
            assert!((one[i] - exact[i]).abs() < 1e-12 * largest, "{column}");
            assert!((one[i] + 0.5 * two[i] - both[i]).abs() < 1e-12 * largest, "{column}");
        }
    }
}
