//! Sheets that yield, stretched far: true stress over logarithmic strain, on the thickness and the width that plastic flow leaves.

use super::benchmarks::{deck, fix, point, shell};
use crate::support::{Row, read_deck, run_with_warnings, tables_of};
use rdsolve::solve::Outcome;

const E: f64 = 210e9;
const NU: f64 = 0.3;
const YIELD: f64 = 355e6;
const HARDENING: f64 = 1e9;
const THICKNESS: f64 = 0.01;

/// A sheet of 1 × 1 whose edge at x = 1 goes to `stretch`, and if `both` that at y = 1 too.
fn stretched(kind: &str, stretch: f64, both: bool, steps: usize) -> String {
    let mut body = String::from("[points]\n");
    for (name, x, y) in [("a", 0.0, 0.0), ("b", 1.0, 0.0), ("c", 1.0, 1.0), ("d", 0.0, 1.0)] {
        body += &point(name, [x, y, 0.0]);
    }
    body += &shell("sheet", "a b c d", [2, 2], kind, "");
    body += &fix("sheet.edge4", "ux");
    body += &fix("sheet.edge1", "uy");
    body += &fix("sheet", "uz rx ry rz");
    let push = |edge: &str, dof: &str| {
        let scale = stretch - 1.0;
        format!(
            "[[supports]]\nat = \"sheet.{edge}\"\nmotion = {{ {dof} = {{ scale = {scale:?}, amplitude = \"grow\" }} }}\n"
        )
    };
    body += &push("edge2", "ux");
    if both {
        body += &push("edge3", "uy");
    }
    body += "[amplitudes.grow]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 1.0]]\n[output]\nreactions = true\n";
    let law = format!("model = \"elastic-plastic\"\nyield_stress = {YIELD:?}\nhardening_modulus = {HARDENING:?}");
    deck("stretched sheet", steps, [E, NU, THICKNESS], &body)
        .replace("model = \"elastic\"", &law)
        .replace("thickness =", "strain = \"logarithmic\"\nthickness =")
}

/// Its tables of reactions and energies.
fn run(kind: &str, stretch: f64, both: bool, steps: usize) -> [Vec<Row>; 2] {
    let tables = tables_of(&read_deck(&stretched(kind, stretch, both, steps)));
    [tables.rows("reactions.csv"), tables.rows("energy.csv")]
}

/// With Green's strain a sheet that stretches by 4 % is let be, and one by 8 % is warned of, pulled or pressed, with what its force is off by.
#[test]
fn far_stretches_are_said() {
    for kind in ["quadrilateral", "triangle2"] {
        for (stretch, green, said) in [
            (1.04, true, None),
            (
                1.08,
                true,
                Some(
                    "a stretch of 1.08. Its strains are taken as small, so forces of yielding material are too large there by about 17 %",
                ),
            ),
            (
                0.92,
                true,
                Some(
                    "a stretch of 0.92. Its strains are taken as small, so forces of yielding material are too small there by about 15 %",
                ),
            ),
            (1.08, false, None),
            (1.3, false, None),
            (1.6, false, Some("a stretch of 1.6. Its logarithmic strain is a series")),
        ] {
            let text = stretched(kind, stretch, false, 10);
            let text = if green { text.replace("strain = \"logarithmic\"", "strain = \"green\"") } else { text };
            let (outcome, found) = run_with_warnings(&text);
            assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
            let found: Vec<_> = found.iter().filter(|found| found.contains("shell `sheet` has a stretch")).collect();
            assert_eq!(found.len(), usize::from(said.is_some()), "{stretch}: {found:?}");
            assert!(said.is_none_or(|said| found[0].contains(said)), "{found:?}");
        }
    }
}

/// The force on the edge at x = 1 in the last row.
fn force(rows: &[Row]) -> f64 {
    let last = rows.last().unwrap().number("time");
    let of = rows.iter().filter(|row| row.number("time") == last && row.text("direction") == "ux");
    of.map(|row| row.number("value")).filter(|value| *value > 0.0).sum()
}

/// True stress times what is left of the section, per width at t = 0: σ h/λ, where plastic flow leaves the volume as it is.
fn exact(stretch: f64, both: bool) -> f64 {
    let strain = stretch.ln().abs();
    // ε = σ/E + εᵖ one way, ε = σ (1 − ν)/E + εᵖ both ways, where the accumulated strain is 2 εᵖ.
    let (compliance, share) = if both { ((1.0 - NU) / E, 2.0) } else { (1.0 / E, 1.0) };
    let stress = (YIELD + share * HARDENING * strain) / (1.0 + share * HARDENING * compliance);
    stress * THICKNESS / stretch
}

#[test]
fn force_is_that_of_true_stress() {
    for kind in ["quadrilateral", "triangle", "quadrilateral2", "triangle2"] {
        for both in [false, true] {
            for (stretch, tolerance) in [(1.02, 1e-4), (1.05, 1e-4), (1.1, 3e-4), (1.2, 1.5e-3), (1.3, 6e-3)] {
                let [reactions, _] = run(kind, stretch, both, 10);
                let error = force(&reactions) / exact(stretch, both) - 1.0;
                println!("{kind} both {both} {stretch}: {error:+.2e}");
                // The logarithm is a series: stress errs by Y⁴ with Y = (λ² − 1)/(λ² + 1). Without it the error would be λ² − 1.
                assert!(error.abs() < tolerance, "{kind} {both} {stretch}: {error}");
            }
        }
    }
}

#[test]
fn work_is_stored_or_dissipated() {
    let numerical = |steps: usize| {
        let [_, energy] = run("quadrilateral", 1.3, false, steps);
        let last = energy.last().unwrap();
        (last.number("numerical") / last.number("external")).abs()
    };
    let errors = [100, 800].map(numerical);
    println!("{errors:?}");
    // Work is summed up by trapezia, and the step in which yield begins has a corner in it: 3e-5, 8e-7.
    assert!(errors[0] < 1e-4 && errors[1] < 2e-6, "{errors:?}");
}
