//! The same deck gives the same bytes, whatever the number of threads, and every time.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// All files a run leaves, but for those that tell the clock.
fn files(deck: &Path, folder: &Path, threads: &str) -> BTreeMap<String, Vec<u8>> {
    let output = Command::new(env!("CARGO_BIN_EXE_rdsolve"))
        .args(["run", "--quiet", "--threads", threads, "-o"])
        .args([folder, deck])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = entries.map(|path| (path.file_name().unwrap().to_str().unwrap().to_string(), path));
    let lasting = named.filter(|(name, _)| !["result.json", "run.log"].contains(&name.as_str()));
    lasting.map(|(name, path)| (name, std::fs::read(path).unwrap())).collect()
}

fn assert_same(text: &str, kinds: usize) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    let deck = dir.path().join("deck.toml");
    std::fs::write(&deck, text).unwrap();
    let first = files(&deck, &dir.path().join("first"), "1");
    assert!(first.len() >= kinds, "{:?}", first.keys());
    assert!(first["nodes.csv"].len() > 1000);
    for (run, threads) in [("again", "1"), ("two", "2"), ("three", "3")] {
        let other = files(&deck, &dir.path().join(run), threads);
        assert!(first.keys().eq(other.keys()));
        for (name, bytes) in &first {
            assert!(*bytes == other[name], "{name} differs on {threads} threads");
        }
    }
    dir
}

const COMMON: &str = r#"
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0

[sections.tube]
shape = "tube"
radius = 0.05
thickness = 0.005

[environment]
gravity = [0.3, -1.0, -9.81]
"#;

/// A material that yields in the first moments, and a section that lets it.
const SOFT: &str = r#"
[materials.steel]
model = "elastic-viscoplastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 1e6
hardening_modulus = 2e9
kinematic_share = 0.5
viscosity = { law = "power", rate = 40.0, exponent = 5.0 }

[sections.tube]
shape = "rectangle"
width = 0.05
height = 0.05
fibres = [2, 4]

[environment]
gravity = [0.3, -1.0, -9.81]
"#;

/// A space frame of 9³ points. A beam of two elements per segment winds through all points along each axis: 1456 elements
/// in a part, enough for threads to fill matrices, and a factorisation large enough for them.
fn space_frame(common: &str) -> String {
    const N: usize = 9;
    let mut deck = String::from(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.02\ntime_step = 0.01\n\n[iteration]\nupdate = \"step\"\n",
    );
    deck += common;
    deck += "[points]\n";
    let cells = || (0..N).flat_map(|i| (0..N).flat_map(move |j| (0..N).map(move |k| [i, j, k])));
    for [i, j, k] in cells() {
        let (x, y, z) = (i as f64 * 0.7, j as f64 * 0.8, k as f64 * 0.9);
        let _ = writeln!(deck, "p{i}{j}{k} = [{x}, {y}, {}]", z + 0.02 * (x * 1.3).sin() * y);
    }
    for axis in 0..3 {
        // Every other line, and every other sheet of lines, is walked backwards.
        let back = |index: usize, turn: usize| if turn.is_multiple_of(2) { index } else { N - 1 - index };
        let path: Vec<String> = cells()
            .map(|[i, j, k]| {
                let mut at = [back(k, i * N + j), back(j, i), i];
                at.rotate_right(axis);
                format!("\"p{}{}{}\"", at[0], at[1], at[2])
            })
            .collect();
        let path = path.join(", ");
        let _ = write!(
            deck,
            "\n[[beams]]\nname = \"beam{axis}\"\npath = [{path}]\nelements = 2\norder = 1\nmaterial = \"steel\"\n\
             section = \"tube\"\norientation = [1.0, 1.1, 1.2]\n"
        );
    }
    deck += "\n[[supports]]\nat = [\"p000\", \"p080\", \"p800\", \"p880\"]\nfix = \"all\"\n";
    deck
}

#[test]
fn a_large_frame() {
    let folder = assert_same(&space_frame(COMMON), 3);
    let plan = std::fs::read_to_string(folder.path().join("first/result.json")).unwrap();
    assert!(plan.contains("Cholesky"), "threads take part in the factorisation too: {plan}");
}

#[test]
fn a_large_frame_by_central_differences() {
    let text =
        space_frame(COMMON).replace("end_time = 0.02\ntime_step = 0.01", "end_time = 2e-4\ntime_step = \"auto\"");
    assert_same(&(text + "\n[integrator]\nscheme = \"central-difference\"\n\n[output]\ninterval = 1e-4\n"), 3);
}

#[test]
fn a_large_frame_that_yields() {
    let shorter = space_frame(SOFT).replace("end_time = 0.02\ntime_step = 0.01", "end_time = 0.002\ntime_step = 0.001");
    let folder = assert_same(&shorter, 3);
    assert!(spent(&folder) > 0.0);
}

/// Of the last row of energy.csv, what plastic flow dissipated.
fn spent(folder: &tempfile::TempDir) -> f64 {
    let mut energy = csv::Reader::from_path(folder.path().join("first/energy.csv")).unwrap();
    let column = energy.headers().unwrap().iter().position(|name| name == "plastic").unwrap();
    energy.records().last().unwrap().unwrap()[column].parse().unwrap()
}

const SCENE: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.2
time_step = 0.002

[points]
clamp = [0.0, 0.0, 0.0]
tip = [1.0, 0.2, 0.1]

[[beams]]
name = "beam"
path = ["clamp", "tip"]
elements = 3
material = "steel"
section = "tube"
orientation = [0.0, 1.0, 0.0]

[[bodies]]
name = "block"
center = [1.1, 0.05, 0.0]
mass = 20.0
inertia = [0.2, 0.1, 0.15]
angular_velocity = [3.0, 1.0, 20.0]

[[attachments]]
body = "block"
nodes = ["tip"]

[[links]]
name = "spring"
from = { body = "block", point = [1.2, 0.0, 0.0] }
to = { ground = [1.2, 0.0, -1.0] }
stiffness = 1e4
damping = 10.0

[[supports]]
at = "clamp"
fix = "all"

[output]
nodes = "all"
links = true
reactions = true
sections = true
fields = { format = "vtu", every = 20 }
"#;

#[test]
fn a_small_scene_with_everything_written() {
    // Tables of nodes, bodies, energy, links, reactions, sections, steps; the list of fields and six grids.
    assert_same(&format!("{SCENE}{COMMON}"), 14);
}

#[test]
fn a_small_scene_that_yields_by_every_method() {
    // Steps that follow the spinning block.
    let scene = SCENE.replace("end_time = 0.2\ntime_step = 0.002", "end_time = 0.02\ntime_step = 5e-5");
    for method in ["tangent-stiffness", "initial-load", "auto"] {
        let deck = format!("{scene}{SOFT}\n[iteration]\nmethod = \"{method}\"\n");
        let folder = assert_same(&deck, 14); // as above
        assert!(spent(&folder) > 0.0, "{method}");
    }
}

/// Two patches on a block, one of triangles, blown up; 1080 elements in the first: enough for threads to fill matrices.
const SHEET: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1e-3
time_step = 5e-4

[points]
a = [0.0, 0.0, 0.0]
b = [2.0, 0.0, 0.0]
c = [2.0, 1.0, 0.1]
d = [0.0, 1.0, 0.0]
e = [2.5, 0.0, 0.0]
f = [2.5, 1.0, 0.0]

[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [36, 30]
thickness = 0.01
material = "steel"
layers = 2

[[shells]]
name = "flap"
corners = ["b", "e", "f", "c"]
elements = [5, 30]
kind = "triangle"
thickness = 0.01
material = "steel"
mass = "consistent"
layers = 2

[[bodies]]
name = "block"
center = [2.6, 0.5, 0.0]
mass = 20.0
inertia = [2.0, 1.0, 1.5]

[[attachments]]
body = "block"
nodes = ["flap.edge2"]

[[supports]]
at = "sheet.edge4"
fix = "all"

[[loads]]
at = ["sheet", "flap"]
pressure = -1e5
follower = true

[output]
nodes = "named"
reactions = true
sections = true
fields = { format = "vtu", every = 2 }
"#;

#[test]
fn shells_under_pressure() {
    let elastic = SHEET.replace("layers = 2\n", "");
    let folder = assert_same(&format!("{elastic}{COMMON}"), 9);
    let plan = std::fs::read_to_string(folder.path().join("first/result.json")).unwrap();
    assert!(plan.contains("Cholesky"), "threads take part in the factorisation too: {plan}");
    let soft = SOFT.replace("yield_stress = 1e6", "yield_stress = 1e7");
    let folder = assert_same(&format!("{SHEET}{soft}"), 9);
    assert!(spent(&folder) > 0.0);
}

/// A roof of enough shells for threads, along its path: the first three steps.
#[test]
fn a_path_of_a_roof() {
    let deck = include_str!("../decks/hinged_roof/deck.toml").split("# ---- expected").next().unwrap();
    let deck = deck.replace("[16, 16]", "[34, 34]").replace("time_step = 0.05", "time_step = 0.2\nsteps = 3");
    assert_same(&format!("{deck}\n[output]\nnodes = \"all\"\nreactions = true\n"), 4);
}
