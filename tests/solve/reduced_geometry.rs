//! Terms of second order of reduced parts: tension stiffens them, compression lets them buckle, and bending shortens them.

use super::modes::{modes, omegas};
use crate::support::{read_deck, run_source, run_to_the_end};
use rdsolve::diagnostic::Source;
use std::f64::consts::TAU;

/// A straight steel beam of 1 m, pinned at `a` and free to slide at `b`, of Euler and Bernoulli.
const BEAM: &str = r#"
[materials.steel]
model = "elastic"
youngs_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = 0.01
width = 0.02
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
[[beams]]
name = "arm"
path = ["a", "b"]
elements = 5
order = 3
shear = false
section = "bar"
material = "steel"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "a"
fix = ["translations", "rx"]
[[supports]]
at = "b"
fix = ["uy", "uz"]
"#;
/// π² EI about the weak axis.
const EULER: f64 = 9.869_604_401_089_358 * 2e11 * 0.02 * 0.01 * 0.01 * 0.01 / 12.0;

/// Tension raises the frequency of a reduced beam by the square root of 1 + T/P, P being the load of Euler.
#[test]
fn tension_stiffens_a_reduced_beam() {
    let stages = format!(
        "{BEAM}[[loads]]\nat = \"b\"\nforce = [{EULER}, 0.0, 0.0]\n[[stages]]\nname = \"pull\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
         [[stages]]\nname = \"modes\"\nkind = \"modal\"\nmodes = 1\n"
    );
    let frequency = |text: &str| {
        let asked = "[[expect]]\nstage = \"modes\"\nmode = 1\nquantity = \"frequency\"\nvalue = 1.0\ntolerance = 1e9\n";
        let done = run_source(&Source::new("deck.toml", format!("{text}{asked}"), &[]), &mut |_| Vec::new());
        done.verdicts[0].value.expect("a frequency")
    };
    let with = |key: &str| stages.replacen("elements = 5\n", &format!("elements = 5\n{key}\n"), 1);
    let whole = frequency(&stages);
    let near = frequency(&with("reduced = 10"));
    let linear = frequency(&with("reduced = { modes = 10, geometric_stiffness = false }"));
    let rest = omegas(&modes(&format!("[analysis]\nkind = \"modal\"\nmodes = 1\n{BEAM}")))[0] / TAU;
    // Rotary inertia and the strain of 4e-3 are not in the closed form.
    assert!((whole / rest / 2f64.sqrt() - 1.0).abs() < 5e-3, "{whole} {rest}");
    // Modes beyond those kept, and terms of third order in the strain.
    assert!((near / whole - 1.0).abs() < 1e-3, "{near} {whole}");
    assert!((linear / rest - 1.0).abs() < 5e-3, "{linear} {rest}");
}

/// A reduced column buckles under the load of Euler, and nobody is told that it cannot.
#[test]
fn a_reduced_column_buckles() {
    let text =
        format!("[analysis]\nkind = \"buckling\"\nmodes = 1\n{BEAM}[[loads]]\nat = \"b\"\nforce = [-1.0, 0.0, 0.0]\n");
    let found = modes(&text.replacen("elements = 5\n", "elements = 5\nreduced = 4\n", 1));
    let factor = found.list[0].factor.expect("a factor");
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    // The shapes that bend differ from a sine by their fourth mode, and the column is shorter by the strain at this load.
    assert!((factor / EULER - 1.0).abs() < 2e-3, "{factor} {EULER}");
}

/// A moment bends a cantilever: the error of its tip falls with the fourth power of the angle, and with the pieces.
#[test]
fn bending_shortens_a_reduced_beam() {
    let EI = EULER / 9.869_604_401_089_358;
    let held = BEAM.replace("fix = [\"translations\", \"rx\"]", "fix = \"all\"");
    let held = held.split("[[supports]]\nat = \"b\"").next().unwrap_or_default();
    let tip = |angle: f64, key: &str| {
        let analysis = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n";
        let load = format!("[[loads]]\nat = \"b\"\nmoment = [0.0, {}, 0.0]\n", -EI * angle);
        let held = held.replace("shear = false\n", "");
        let text = format!("{analysis}{}{load}", held.replacen("elements = 5\n", &format!("elements = 8\n{key}"), 1));
        let found = run_to_the_end(&read_deck(&text), &mut |frame| {
            let node = |label: &str| frame.model.nodes.iter().position(|node| node.label == label).expect("a node");
            frame.state.nodes[node("b")].x.iter().copied().collect()
        });
        found.rows.last().expect("a row").clone()
    };
    let error = |angle: f64, key: &str| {
        let (found, whole) = (tip(angle, key), tip(angle, ""));
        found.iter().zip(&whole).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    };
    let (one, half) = (error(0.4, "reduced = 6\n"), error(0.2, "reduced = 6\n"));
    let linear = error(0.4, "reduced = { modes = 6, geometric_stiffness = false }\n");
    let pieces = error(0.4, "reduced = { modes = 6, pieces = 4 }\n");
    println!("{one:e} {half:e} {linear:e} {pieces:e}");
    assert!(half < one / 12.0 && linear > 20.0 * one && pieces < one / 16.0, "{one:e} {half:e} {linear:e} {pieces:e}");
}
