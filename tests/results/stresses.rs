//! Stresses of beams in tables and fields. Closed forms stand with the sections and in `decks/stressed_console`.

use crate::support::{read_deck, tables_of};
use std::fs;

/// A cantilever of a rectangle 0.1 wide and 0.2 high, 2 long, under a moment at its end.
fn cantilever(section: &str, material: &str, moment: f64) -> String {
    format!(
        "{section}\n{material}\n[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.1\n[output]\nsections = {{ at = \"both\" }}\n\
         [points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 2\n\
         material = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\n\
         moment = [0.0, {moment:?}, 0.0]\n"
    )
}

const RECTANGLE: &str = "sections.s = { shape = \"rectangle\", width = 0.1, height = 0.2 }";
const ELASTIC: &str = "materials.m = { model = \"elastic\", youngs_modulus = 2e11, poisson_ratio = 0.3 }";
const PLASTIC: &str =
    "materials.m = { model = \"elastic-plastic\", youngs_modulus = 2e11, poisson_ratio = 0.3, yield_stress = 2e8 }";
/// The moment of first yield, W σ_Y.
const FIRST_YIELD: f64 = 2e8 * 0.1 * 0.2 * 0.2 / 6.0;

/// A pure moment of 1.3 of that of first yield: fibres at the edges have the yield stress, and no more. Below first yield fibres have the
/// linear stress at their own height, which is that of the edge less half a row at most.
#[test]
fn stresses_of_fibres_stay_within_the_yield_stress() {
    for (factor, most, least) in [(1.3, 2e8, 2e8), (0.5, 1e8, 0.9e8)] {
        let rows = tables_of(&read_deck(&cantilever(RECTANGLE, PLASTIC, factor * FIRST_YIELD))).rows("sections.csv");
        let last: Vec<_> = rows.iter().filter(|row| row.number("time") == 1.0).collect();
        let (points, ends): (Vec<_>, Vec<_>) =
            last.into_iter().partition(|row| row.text("point").parse::<usize>().is_ok());
        assert!(points.len() >= 4 && ends.len() == 4);
        for row in points {
            let [max, min, mises] = ["sigma_max", "sigma_min", "von_mises"].map(|column| row.number(column));
            // Iterations leave 1e-8 of the stress.
            assert!(max <= most * (1.0 + 1e-7) && max >= least * (1.0 - 1e-7), "{factor}: {max}");
            assert!((max + min).abs() < 1e-6 * most && (mises - max).abs() < 1e-6 * most, "{max} {min} {mises}");
        }
        assert!(ends.iter().all(|row| row.text("sigma_max").is_empty()));
    }
}

/// A section of shape "general" does not say where its area is: cells are empty, and `[[expect]]` names what there is.
#[test]
fn sections_without_an_outline_have_no_stresses() {
    let general = "sections.s = { shape = \"general\", area = 0.02, moments = [1e-4, 1e-4], torsion_constant = 1e-4, shear_areas = [0.01, 0.01] }";
    let deck = cantilever(general, ELASTIC, 1e3);
    let rows = tables_of(&read_deck(&deck)).rows("sections.csv");
    assert!(!rows.is_empty() && rows.iter().all(|row| row.text("von_mises").is_empty()));
    let asks =
        format!("{deck}[[expect]]\nat = \"arm\"\nquantity = \"sigma_max\"\ntime = 1.0\nvalue = 1.0\ntolerance = 0.1\n");
    let (_, said) = rdsolve::model::read(&rdsolve::diagnostic::Source::new("deck.toml", asks, &[]));
    assert!(said.iter().any(|said| said.message == "there is no quantity `sigma_max` at `arm`"), "{said:?}");
}

/// Fields carry the stresses of the nodes: W σ = M at each of a beam under a pure moment.
#[test]
fn fields_have_stresses_of_beams() {
    let deck = cantilever(RECTANGLE, ELASTIC, 0.5 * FIRST_YIELD)
        .replace("[output]\n", "[output]\nfields = { format = \"vtu\" }\n");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut command = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
    command.current_dir(folder.path()).args(["deck.toml", "--quiet"]).assert().code(0);
    let last = fs::read(folder.path().join("deck.out/fields_000010.vtu")).unwrap();
    let text = String::from_utf8_lossy(&last);
    for name in ["sigma_max", "sigma_min", "tau_max", "von_mises"] {
        assert!(text.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    // The page colours elements by them: W σ = M in each at the last of eleven times.
    let mut command = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
    command.current_dir(folder.path()).args(["report", "deck.out"]).assert().code(0);
    let (data, bytes) = crate::results::report::data(&fs::read_to_string(folder.path().join("deck.html")).unwrap());
    let fields = data["scene"]["fields"].as_array().unwrap();
    for (name, value) in [("sigma_max", 1e8), ("sigma_min", -1e8), ("tau_max", 0.0), ("von_mises", 1e8)] {
        let field = fields.iter().find(|field| field["name"] == name).unwrap();
        let values = crate::results::report::floats(&bytes, &field["values"]);
        assert_eq!(values.len(), 11 * 2, "{name}");
        // Float32 has seven digits; rounding of forces is 1e-10 of the largest.
        values[20..].iter().for_each(|x| assert!((f64::from(*x) - value).abs() < 100.0, "{name} {x}"));
    }
}

/// A pull N on a hook beside the axis of an I section, at e_y and e_z, and a shear force V, at the clamp of a cantilever:
/// σ = N/A ± (N e_z − V l) h/(2 I_y) ± N e_y b/(2 I_z), and the shear stress V S/(I_y t) of the web. Deflections change 1e-6 of the moments;
/// along middle lines of the walls the static moment S over I_y is 0.1 % smaller.
#[test]
fn an_eccentric_pull_bends_and_shears_a_profile() {
    let [b, h, web, flange]: [f64; 4] = [0.15, 0.3, 0.0071, 0.0107];
    let (pull, e_y, e_z, shear, length) = (10.0, 0.05, 0.12, 20.0, 2.0);
    let section = format!(
        "sections.s = {{ shape = \"i\", width = {b:?}, height = {h:?}, web_thickness = {web:?}, flange_thickness = {flange:?} }}"
    );
    let deck = cantilever(&section, ELASTIC, 0.0)
        .replace("[[beams]]", &format!("hook = [2.0, {e_y:?}, {e_z:?}]\n[[beams]]"))
        .replace(
            "[[loads]]\nat = \"b\"\nmoment = [0.0, 0.0, 0.0]",
            &format!("[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, {shear:?}]"),
        )
        + &format!(
            "[[loads]]\nat = \"hook\"\nforce = [{pull:?}, 0.0, 0.0]\n[[bodies]]\nname = \"head\"\ncenter = [2.0, 0.0, 0.0]\n\
             [[attachments]]\nbody = \"head\"\nnodes = [\"b\", \"hook\"]\n"
        );
    let rows = tables_of(&read_deck(&deck)).rows("sections.csv");
    let clamp = rows.iter().rfind(|row| row.text("point") == "start" && row.text("element") == "0").unwrap();
    let inner = h - 2.0 * flange;
    let area = 2.0 * b * flange + inner * web;
    let i_y = (b * h.powi(3) - (b - web) * inner.powi(3)) / 12.0;
    let i_z = (2.0 * flange * b.powi(3) + inner * web.powi(3)) / 12.0;
    let (m_y, m_z) = (f64::abs(pull * e_z - shear * length), pull * e_y);
    let bending = m_y * h / (2.0 * i_y) + m_z * b / (2.0 * i_z);
    let flow = b * flange * (h - flange) / 2.0 + web * inner * inner / 8.0;
    for (column, exact, tolerance) in [
        ("sigma_max", pull / area + bending, 5e-6),
        ("sigma_min", pull / area - bending, 5e-6),
        ("tau_max", shear * flow / (i_y * web), 2e-3),
    ] {
        let found = clamp.number(column);
        assert!((found - exact).abs() < tolerance * exact.abs(), "{column}: {found} for {exact}");
    }
}
