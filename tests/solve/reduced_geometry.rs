//! Terms of second order of reduced parts: tension stiffens them, compression lets them buckle, and bending shortens them.

use super::modes::{modes, omegas};
use crate::support::{read_deck, run_source, run_to_the_end};
use rdsolve::diagnostic::Source;
use rdsolve::solve::Outcome;
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

/// Columns that bend to one side of the line between their ends buckle as all elements do: one end guided, and one end pinned.
#[test]
fn unsymmetric_columns_buckle_under_their_loads() {
    let factor = |ends: [&str; 2], key: &str| {
        let held = BEAM.replace("fix = [\"translations\", \"rx\"]", ends[0]).replace("fix = [\"uy\", \"uz\"]", ends[1]);
        let text = format!(
            "[analysis]\nkind = \"buckling\"\nmodes = 1\n{held}[[loads]]\nat = \"b\"\nforce = [-1.0, 0.0, 0.0]\n"
        );
        modes(&text.replacen("elements = 5\n", &format!("elements = 8\n{key}"), 1)).list[0].factor.expect("a factor")
    };
    let clamped = "fix = \"all\"";
    for (ends, exact) in [
        ([clamped, "fix = [\"uy\", \"rotations\"]"], 1.0),
        ([clamped, "fix = [\"uy\", \"uz\", \"rx\"]"], 2.045_75),
        ([clamped, "fix = [\"uy\"]"], 0.25),
    ] {
        let (near, whole) = (factor(ends, "reduced = 6\n"), factor(ends, ""));
        println!("{exact}: {} {}", near / EULER, whole / EULER);
        // The strain at this load, and modes beyond those kept.
        assert!((whole / EULER / exact - 1.0).abs() < 2e-3, "{whole} {exact}");
        assert!((near / whole - 1.0).abs() < 3e-3, "{near} {whole}");
    }
}

/// Pieces of a beam are beams that are reduced each: the same motion but for rounding.
#[test]
fn pieces_are_beams_one_by_one() {
    let analysis = "[analysis]\nkind = \"dynamic\"\nend_time = 0.05\ntime_step = 1e-3\n[environment]\ngravity = [0.0, 2.0, -9.81]\n";
    let held = BEAM.replace("fix = [\"translations\", \"rx\"]", "fix = \"all\"");
    let held = held.split("[[supports]]\nat = \"b\"").next().unwrap_or_default().to_owned();
    let load = "[[loads]]\nat = \"b\"\nforce = [0.0, 10.0, -30.0]\n";
    let whole = held.replacen("elements = 5\n", "elements = 8\nreduced = { modes = 4, pieces = 2 }\n", 1);
    let (start, beam) = held.split_once("[[beams]]").expect("a beam");
    let (beam, support) = beam.split_once("[[supports]]").expect("a support");
    let half = |name: &str, ends: &str| {
        let own = beam.replace("\"arm\"", name).replace("[\"a\", \"b\"]", ends);
        format!("[[beams]]{}", own.replacen("elements = 5\n", "elements = 4\nreduced = 4\n", 1))
    };
    let halves = format!(
        "{start}m = [0.5, 0.0, 0.0]\n{}{}[[supports]]{support}",
        half("\"one\"", "[\"a\", \"m\"]"),
        half("\"two\"", "[\"m\", \"b\"]")
    );
    let tip = |text: &str| {
        let model = read_deck(&format!("{analysis}{text}{load}"));
        assert_eq!(model.reductions.len(), 2);
        let done = run_to_the_end(&model, &mut |frame| {
            let at = frame.model.nodes.iter().position(|node| node.label == "b").expect("a node");
            frame.state.nodes[at].x.iter().copied().collect()
        });
        done.rows.last().expect("a row").clone()
    };
    let (pieces, beams) = (tip(&whole), tip(&halves));
    let off = pieces.iter().zip(&beams).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    // The tolerance of the iteration, 1e-4 of the motion at most.
    assert!(off < 1e-6, "{off:e} {pieces:?} {beams:?}");
}

/// Pieces follow a path with a corner, graded elements and stations of a taper, and stages that hold other nodes share their ends.
#[test]
fn pieces_of_graded_and_tapered_beams_in_stages() {
    let material = BEAM.split("[sections.bar]").next().unwrap_or_default();
    let rows = |key: &str| -> Vec<Vec<f64>> {
        let text = format!(
            "{material}[sections.thick]\nshape = \"rectangle\"\nheight = 0.03\nwidth = 0.02\n[sections.thin]\nshape = \"rectangle\"\nheight = 0.01\nwidth = 0.02\n\
             [points]\na = [0.0, 0.0, 0.0]\nm = [0.5, 0.0, 0.0]\nb = [1.0, 0.0, 0.2]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"m\", \"b\"]\n\
             elements = 5\ngrading = 0.3\nmaterial = \"steel\"\norientation = [0.0, 1.0, 0.0]\n{key}\
             stations = [{{ at = 0.0, section = \"thick\" }}, {{ at = 1.0, section = \"thin\" }}]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
             [[supports]]\nat = \"m\"\nfix = [\"uy\"]\nstages = [\"hold\"]\n[[loads]]\nat = \"b\"\nforce = [0.01, 0.2, -0.3]\nstages = [\"bend\"]\n\
             [[stages]]\nname = \"bend\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
             [[stages]]\nname = \"hold\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n"
        );
        let mut rows = Vec::new();
        let done = run_source(&Source::new("deck.toml", text, &[]), &mut |frame| {
            let nodes = frame.state.nodes.iter().zip(&frame.model.nodes).filter(|(_, node)| node.named);
            rows.push(nodes.flat_map(|(now, node)| (now.x - node.x).iter().copied().collect::<Vec<f64>>()).collect());
            Vec::new()
        });
        assert!(matches!(done.outcome, Outcome::Done), "{key} {:?}", done.outcome);
        rows
    };
    let whole = rows("");
    let moved = whole.iter().flatten().fold(0.0, |most: f64, u| most.max(u.abs()));
    for key in ["reduced = 0\n", "reduced = { modes = 2, pieces = 4 }\n", "reduced = { modes = 0, pieces = 3 }\n"] {
        let few = rows(key);
        assert_eq!(few.iter().map(Vec::len).collect::<Vec<_>>(), whole.iter().map(Vec::len).collect::<Vec<_>>());
        let off =
            few.iter().flatten().zip(whole.iter().flatten()).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        // The square of a rotation of 3e-5; measured 1.4e-10.
        assert!(moved > 1e-5 && off < 1e-9 * moved, "{key} {off:e} of {moved:e}");
    }
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
