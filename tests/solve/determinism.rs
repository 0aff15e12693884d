//! The same deck gives the same bytes, whatever the number of threads, and every time.

use rdsolve::diagnostic::Source;
use rdsolve::materials::Dissipation;
use rdsolve::model::{self, Model};
use rdsolve::plan::Plan;
use rdsolve::solve::{ContactState, Frame, JointState, Observer, Outcome, Run, Wanted};
use rdsolve::state::{Node, State, Work};
use rdsolve::system::System;
use rdsolve::system::energy::Energy;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::AtomicBool;

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

/// Elastic sheets that meet edge to edge and slide.
#[test]
fn sheets_on_edge_on_any_number_of_threads() {
    let sheet = |name: &str, corners: &str| {
        format!(
            "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = 6\nthickness = 0.01\nmaterial = \"steel\"\n"
        )
    };
    let text = format!(
        "analysis = {{ kind = \"dynamic\", end_time = 1e-3, time_step = 1e-5 }}\n\
         output = {{ nodes = \"all\", energy = true, contacts = {{ by = \"both\" }} }}\n\
         points = {{ a = [-0.3, 0.0, -0.5], b = [0.3, 0.0, -0.5], c = [0.3, 0.0, 0.0], d = [-0.3, 0.0, 0.0], e = [0.02, -0.3, 0.0101], \
         f = [0.02, 0.3, 0.0101], g = [0.02, 0.3, 0.5101], h = [0.02, -0.3, 0.5101] }}\n\
         [[initial]]\nat = \"upper\"\nvelocity = [0.5, 0.2, -1.0]\n\
         [[contacts]]\nname = \"edges\"\nsurface = {{ part = \"lower\", edges = true }}\nwith = \"upper\"\nstiffness = 1e8\nfriction = 0.2\n{}{}{COMMON}",
        sheet("lower", "\"a\", \"b\", \"c\", \"d\""),
        sheet("upper", "\"e\", \"f\", \"g\", \"h\"")
    );
    let dir = assert_same(&text, 4);
    let touches = std::fs::read_to_string(dir.path().join("first/contact_pairs.csv")).unwrap();
    assert!(touches.lines().count() > 20, "{touches}");
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
    let deck = include_str!("../../decks/hinged_roof/deck.toml").split("# ---- expected").next().unwrap();
    let deck = deck.replace("[16, 16]", "[34, 34]").replace("time_step = 0.05", "time_step = 0.2\nsteps = 3");
    assert_same(&format!("{deck}\n[output]\nnodes = \"all\"\nreactions = true\n"), 4);
}

/// Every number of a state, to the bit.
fn bits(state: &State) -> Vec<u64> {
    let State { time, nodes, history, jerk, reactions, multipliers, algorithmic_accelerations, work } = state;
    let Work { external, damping, damping_power, material, verlet_energy_offset, accelerations, step } = *work;
    let Dissipation { plastic, viscous, stored, friction, impact, eroded } = material;
    let mut numbers = vec![*time, external, damping, damping_power, verlet_energy_offset, accelerations, step];
    numbers.extend([plastic, viscous, stored, friction, impact, eroded]);
    for Node { x, low, rotation, v, omega, a, alpha } in nodes {
        numbers.extend([x, low, v, omega, a, alpha].into_iter().flatten());
        numbers.extend(rotation.coords.iter());
    }
    numbers.extend(jerk.iter().chain(algorithmic_accelerations).flatten());
    numbers.extend([history, reactions, multipliers].into_iter().flatten());
    assert!(numbers.iter().all(|number| number.is_finite()));
    numbers.into_iter().map(f64::to_bits).collect()
}

/// A step: its length, the state after it, and what is summed over all elements, to the bit.
#[derive(PartialEq)]
struct Step {
    dt: f64,
    state: Vec<u64>,
    sums: Vec<u64>,
    /// Points that touch, of each contact.
    touching: Vec<usize>,
}

/// All energies and momenta of a state.
fn numbers_of(energy: &Energy) -> Vec<f64> {
    let &Energy { kinetic, strain, plastic, viscoplastic, damping, links, contact, friction, impact, eroded, .. } =
        energy;
    let &Energy { external, numerical, mechanical, p, l, verlet_energy_offset, .. } = energy;
    let stored = [kinetic, strain, plastic, viscoplastic, damping, links, contact, friction, impact, eroded];
    let sums = [external, numerical, mechanical, verlet_energy_offset];
    stored
        .into_iter()
        .chain(sums)
        .chain([p, l].into_iter().flat_map(|momentum| [momentum.x, momentum.y, momentum.z]))
        .collect()
}

#[derive(Default)]
struct Steps(Vec<Step>);

impl Observer for Steps {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()> {
        let mut sums: Vec<f64> = frame.derived.energy.map_or(Vec::new(), |energy| numbers_of(&energy));
        let mut touching = Vec::new();
        for JointState { f, m, drive } in &frame.derived.joints {
            sums.extend(f.iter().chain(m));
            sums.push(*drive);
        }
        for ContactState { touching: points, slipping, gap, f, m } in &frame.derived.contacts {
            touching.push(*points);
            sums.extend([*gap, *slipping as f64]);
            sums.extend(f.iter().chain(m));
        }
        let sums = sums.into_iter().map(f64::to_bits).collect();
        self.0.push(Step { dt: frame.dt, state: bits(frame.state), sums, touching });
        Ok(())
    }
}

/// The run on so many threads, step by step, and the state it ends with.
fn steps(model: &Model, threads: usize) -> (Vec<Step>, State) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let system = System::new(model).unwrap();
        let plan = Plan::new(model, &system, threads);
        let stop = AtomicBool::new(false);
        let all = Wanted::ALL;
        let mut seen = Steps::default();
        let (outcome, state) = Run::new(model, &system, &plan, all, &stop).unwrap().run(&mut seen);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        (seen.0, state.unwrap())
    })
}

/// A scene of enough elements for threads takes the same steps through the same states on one thread, two and five: more
/// than most machines that run this have cores.
fn assert_same_bits(text: &str) -> (Vec<Step>, State) {
    let source = Source::new("deck.toml", text, &[]);
    let (model, problems) = model::read(&source);
    let said = || problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n");
    let model = model.unwrap_or_else(|| panic!("{}", said()));
    let elements: usize = model.parts.iter().map(|part| part.elements()).sum();
    assert!(elements > 1024, "too small for threads: {elements} elements");
    let one = steps(&model, 1);
    for threads in [2, 5] {
        let (others, _) = steps(&model, threads);
        for (number, (step, other)) in one.0.iter().zip(&others).enumerate() {
            assert!(step == other, "step {number} differs on {threads} threads");
        }
        assert_eq!(others.len(), one.0.len(), "{threads} threads");
    }
    one
}

/// Six trusses in a row, by a joint of every kind from one to the next: they fall, held at the start. Each is three bent beams
/// of 70 elements that share their ends: sums of three, whose last bits would show another order.
fn jointed_row(steps: &str) -> String {
    let kinds = ["hinge", "ball", "universal", "cylinder", "fixed"];
    let bends = [[0.1, 0.0], [-0.05, 0.08], [-0.04, -0.09]];
    let mut deck = format!("[analysis]\nkind = \"dynamic\"\n{steps}\n{COMMON}\n[points]\n");
    for k in 0..6 {
        let x = k as f64;
        let _ = writeln!(deck, "from{k} = [{x}, 0.0, 0.0]\nto{k} = [{}, 0.0, 0.0]", x + 1.0);
        for (b, [y, z]) in bends.into_iter().enumerate() {
            let _ = writeln!(deck, "middle{k}{b} = [{}, {y}, {z}]", x + 0.5);
        }
    }
    for (k, b) in (0..6).flat_map(|k| (0..bends.len()).map(move |b| (k, b))) {
        let _ = write!(
            deck,
            "\n[[beams]]\nname = \"beam{k}{b}\"\npath = [\"from{k}\", \"middle{k}{b}\", \"to{k}\"]\nelements = 35\n\
             order = 1\nmaterial = \"steel\"\nsection = \"tube\"\norientation = [0.0, 1.0, 0.2]\n"
        );
    }
    for (k, kind) in kinds.into_iter().enumerate() {
        let axes = match kind {
            "hinge" => "axis = [0.0, 1.0, 0.0]\n",
            "cylinder" => "axis = [1.0, 0.0, 0.0]\n",
            "universal" => "axis = [0.0, 1.0, 0.0]\ncross_axis = [0.0, 0.0, 1.0]\n",
            _ => "",
        };
        let next = k + 1;
        let _ = write!(
            deck,
            "\n[[joints]]\nname = \"joint{k}\"\nkind = \"{kind}\"\n{axes}from = {{ node = \"to{k}\" }}\nto = {{ node = \"from{next}\" }}\n"
        );
    }
    deck + "\n[[supports]]\nat = \"from0\"\nfix = \"all\"\n"
}

#[test]
fn joints_between_many_elements() {
    let (_, state) = assert_same_bits(&jointed_row("end_time = 0.01\ntime_step = 0.0005"));
    assert!(state.multipliers.iter().any(|force| force.abs() > 1.0), "the joints bear nothing");
}

#[test]
fn automatic_steps_of_many_elements() {
    let (steps, _) = assert_same_bits(&jointed_row("end_time = 0.02\ntime_step = \"auto\"\nerror_tolerance = 1e-2"));
    let (least, most) =
        steps[1..].iter().fold((f64::INFINITY, 0.0_f64), |(a, b), step| (a.min(step.dt), b.max(step.dt)));
    assert!(most > 2.0 * least, "steps from {least:e} to {most:e} choose nothing");
}

/// A sheet slides over the ground as a ball falls on it; points between its nodes touch too.
const TOUCHING: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.005
time_step = 2.5e-4

[points]
a = [0.0, 0.0, 0.005]
b = [1.0, 0.0, 0.005]
c = [1.0, 1.0, 0.006]
d = [0.0, 1.0, 0.007]

[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [12, 12]
thickness = 0.01
material = "steel"

[[bodies]]
name = "ball"
center = [0.47, 0.52, 0.113]
mass = 20.0
shape = { kind = "sphere", radius = 0.1 }
velocity = [0.5, 0.0, -2.0]
angular_velocity = [0.0, 3.0, 0.0]

[[initial]]
at = "sheet"
velocity = [1.0, 0.5, -0.5]

[[contacts]]
name = "ground"
surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
with = "sheet"
stiffness = 1e5
restitution = 0.5
friction = 0.3
points = 2

[[contacts]]
name = "landing"
surface = { shape = "sphere", body = "ball", radius = 0.1 }
with = "sheet"
stiffness = 1e6
friction = 0.2
points = 2
"#;

#[test]
fn contacts_of_many_points() {
    let (steps, state) = assert_same_bits(&format!("{TOUCHING}{COMMON}"));
    assert!((0..2).all(|contact| steps.iter().any(|step| step.touching[contact] > 0)), "a contact never touches");
    let spent = state.work.material;
    assert!(spent.friction > 0.0 && spent.impact > 0.0, "{spent:?}");
}

/// A sheet falls on another, and a ball on both: their faces see each other.
const SHEETS: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.005
time_step = 2.5e-4

[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
e = [0.1, 0.2, 0.0102]
f = [1.2, 0.1, 0.0102]
g = [1.1, 0.9, 0.0103]
h = [0.2, 1.1, 0.0104]

[[shells]]
name = "lower"
corners = ["a", "b", "c", "d"]
elements = 12
thickness = 0.01
material = "steel"

[[shells]]
name = "upper"
corners = ["e", "f", "g", "h"]
elements = 10
thickness = 0.01
material = "steel"

[[bodies]]
name = "ball"
center = [0.47, 0.52, 0.1163]
mass = 20.0
shape = { kind = "sphere", radius = 0.1 }
velocity = [0.5, 0.0, -2.0]
angular_velocity = [0.0, 3.0, 0.0]

[[initial]]
at = "upper"
velocity = [0.3, 0.5, -0.5]

[[contacts]]
name = "sheets"
surface = { part = "lower" }
with = "upper"
stiffness = 1e5
restitution = 0.5
friction = 0.3
points = 2

[[contacts]]
name = "landing"
surface = { part = "upper" }
with = "ball"
stiffness = 1e6
friction = 0.2
"#;

#[test]
fn contacts_of_faces() {
    let (steps, state) = assert_same_bits(&format!("{SHEETS}{COMMON}"));
    assert!((0..2).all(|contact| steps.iter().any(|step| step.touching[contact] > 0)), "a contact never touches");
    let spent = state.work.material;
    assert!(spent.friction > 0.0 && spent.impact > 0.0, "{spent:?}");
}
