//! Equations between displacements against closed forms and against the system without the displacement that they give.

use crate::support::{read_deck, tables_of};
use rdsolve::model::Model;

/// Points on springs along z, some with a mass, and an equation between them.
fn springs(analysis: &str, equation: &str, masses: bool) -> Model {
    let masses = match masses {
        true => "masses = [{ at = \"a\", mass = 2.0 }, { at = \"b\", mass = 1.5 }, { at = \"c\", mass = 4.0 }]",
        false => "",
    };
    read_deck(&format!(
        r#"
        {analysis}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.3], c = [2.0, 1.0, 0.0] }}
        links = [{{ name = "sa", from = {{ node = "a" }}, to = {{ ground = [0.0, 0.0, -5.0] }}, stiffness = 100.0 }},
                 {{ name = "sb", from = {{ node = "b" }}, to = {{ ground = [1.0, 0.0, -5.0] }}, stiffness = 250.0 }},
                 {{ name = "sc", from = {{ node = "c" }}, to = {{ ground = [2.0, 1.0, -5.0] }}, stiffness = 400.0 }}]
        {masses}
        supports = [{{ at = ["a", "b", "c"], fix = ["ux", "uy"] }}]
        equations = [{equation}]
        amplitudes = {{ full = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
        loads = [{{ at = "a", force = [0.0, 0.0, 30.0], amplitude = "full" }}, {{ at = "c", force = [0.0, 0.0, -20.0], amplitude = "full" }}]
        output = {{ nodes = "all" }}
        "#
    ))
}

/// uz of a, b and c at the end.
fn heights(model: &Model) -> [f64; 3] {
    let tables = tables_of(model);
    let rows = tables.rows("nodes.csv");
    ["a", "b", "c"].map(|node| rows.iter().rfind(|row| row.text("node") == node).unwrap().number("uz"))
}

const THREE: &str = r#"{ name = "sum", terms = [{ node = "a", dof = "uz", factor = 1.0 }, { node = "b", dof = "uz", factor = -2.0 },
                                               { node = "c", dof = "uz", factor = 0.5 }] }"#;
const TWO: &str = r#"{ name = "lever", terms = [{ node = "a", dof = "uz", factor = 10.0 }, { node = "b", dof = "uz", factor = 20.0 }] }"#;

/// u = K⁻¹ (f + c λ) with c·u = 0: λ = −c·K⁻¹f / c·K⁻¹c.
#[test]
fn springs_share_their_loads_by_the_equation() {
    let (k, f) = ([100.0, 250.0, 400.0], [30.0, 0.0, -20.0]);
    for (equation, c) in [(THREE, [1.0, -2.0, 0.5]), (TWO, [10.0, 20.0, 0.0])] {
        let over = |a: &[f64; 3]| (0..3).map(|i| c[i] * a[i] / k[i]).sum::<f64>();
        let multiplier = -over(&f) / over(&c);
        let exact: [f64; 3] = std::array::from_fn(|i| (f[i] + c[i] * multiplier) / k[i]);
        for (analysis, tolerance) in [
            (r#"analysis = { kind = "static", geometry = "linear" }"#, 1e-10),
            // Springs stay along z, so that the iteration ends with the exact answer.
            (r#"analysis = { kind = "static", end_time = 1.0, time_step = 0.5 }"#, 1e-8),
        ] {
            let found = heights(&springs(analysis, equation, false));
            for (found, exact) in found.iter().zip(exact) {
                assert!((found - exact).abs() < tolerance, "{analysis}: {found} {exact}");
            }
        }
    }
}

/// Two masses on a lever are one mass m_a + m_b/4 on a spring k_a + k_b/4: its frequency, and its motion by the same scheme.
#[test]
fn a_lever_moves_as_one_mass() {
    let modal = springs(r#"analysis = { kind = "modal", modes = 2 }"#, TWO, true);
    let tables = tables_of(&modal);
    let mut found: Vec<f64> = tables.rows("modes.csv").iter().map(|row| row.number("frequency")).collect();
    found.sort_unstable_by(f64::total_cmp);
    let of = |k: f64, m: f64| (k / m).sqrt() / std::f64::consts::TAU;
    let mut exact = [of(100.0 + 250.0 / 4.0, 2.0 + 1.5 / 4.0), of(400.0, 4.0)];
    exact.sort_unstable_by(f64::total_cmp);
    for (found, exact) in found.iter().zip(exact) {
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
    }
    let single = |analysis: &str| {
        let model = read_deck(&format!(
            r#"
            {analysis}
            points = {{ a = [0.0, 0.0, 0.0] }}
            links = [{{ name = "sa", from = {{ node = "a" }}, to = {{ ground = [0.0, 0.0, -5.0] }}, stiffness = 162.5 }}]
            masses = [{{ at = "a", mass = 2.375 }}]
            supports = [{{ at = "a", fix = ["ux", "uy"] }}]
            amplitudes = {{ full = {{ kind = "ramp", start = 0.0, end = 1.0 }} }}
            loads = [{{ at = "a", force = [0.0, 0.0, 30.0], amplitude = "full" }}]
            "#
        ));
        let tables = tables_of(&model);
        tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == "a").unwrap().number("uz")
    };
    for analysis in [
        r#"analysis = { kind = "dynamic", end_time = 1.0, time_step = 0.01 }"#,
        "analysis = { kind = \"dynamic\", end_time = 1.0, time_step = 0.01 }\nintegrator = { scheme = \"central-difference\" }",
    ] {
        let (lever, one) = (heights(&springs(analysis, TWO, true)), single(analysis));
        assert!(
            (lever[0] / one - 1.0).abs() < 1e-8 && (lever[1] / one + 0.5).abs() < 1e-8,
            "{analysis}: {lever:?} {one}"
        );
        // Three terms: b follows a and c.
        let [a, b, c] = heights(&springs(analysis, THREE, true));
        assert!((a - 2.0 * b + 0.5 * c).abs() < 1e-9 * a.abs(), "{analysis}: {a} {b} {c}");
    }
}

/// Without b = a/2 + c/4 two masses are left: det(K − ω² M) = 0.
#[test]
fn three_terms_leave_two_modes() {
    let tables = tables_of(&springs(r#"analysis = { kind = "modal", modes = 2 }"#, THREE, true));
    let M = [2.0 + 1.5 / 4.0, 1.5 / 8.0, 4.0 + 1.5 / 16.0];
    let K = [100.0 + 250.0 / 4.0, 250.0 / 8.0, 400.0 + 250.0 / 16.0];
    for row in tables.rows("modes.csv") {
        let squared = (std::f64::consts::TAU * row.number("frequency")).powi(2);
        let [a, b, c]: [f64; 3] = std::array::from_fn(|i| K[i] - squared * M[i]);
        assert!((a * c - b * b).abs() < 1e-9 * K[0] * K[2], "{squared}");
    }
}

/// A rack on the tip of a cantilever: u = r θ. With the flexibility C of the tip θ = C₂₁ F/(1 + C₂₂ k r²).
#[test]
fn a_rotation_moves_a_rack() {
    let (r, k, force) = (0.3, 4e6, 1e3);
    let model = read_deck(&format!(
        r#"
        analysis = {{ kind = "static", geometry = "linear" }}
        materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.25 }} }}
        sections = {{ square = {{ shape = "rectangle", width = 0.1, height = 0.2 }} }}
        points = {{ a = [0.0, 0.0, 0.0], tip = [2.0, 0.0, 0.0], rack = [2.0, 0.0, 1.0] }}
        beams = [{{ name = "beam", path = ["a", "tip"], elements = 1, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0] }}]
        links = [{{ name = "spring", from = {{ node = "rack" }}, to = {{ ground = [3.0, 0.0, 1.0] }}, stiffness = {k} }}]
        supports = [{{ at = "a", fix = "all" }}, {{ at = "rack", fix = ["uy", "uz"] }}]
        equations = [{{ name = "rack and pinion", terms = [{{ node = "rack", dof = "ux", factor = -1.0 }},
                                                          {{ node = "tip", dof = "ry", factor = {r} }}] }}]
        loads = [{{ at = "tip", force = [0.0, 0.0, -{force}] }}]
        "#
    ));
    let bending = 2e11 * 0.1 * 0.2f64.powi(3) / 12.0;
    let turn = force * 4.0 / (2.0 * bending) / (1.0 + 2.0 / bending * k * r * r);
    let tables = tables_of(&model);
    let last = |node: &str| tables.rows("nodes.csv").into_iter().rfind(|row| row.text("node") == node).unwrap();
    assert!((last("tip").number("ry") / turn - 1.0).abs() < 1e-9, "{} {turn}", last("tip").number("ry"));
    assert!((last("rack").number("ux") / (r * turn) - 1.0).abs() < 1e-9);
}
