//! Structures that yield: energy balance, agreement of the methods of iteration, cut and rejected steps, threads.
//! `cargo test --test all plasticity -- --nocapture --test-threads 1` shows the figures.

use crate::support::{Done, error, position, read, run_to_the_end, slope};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run};
use rdsolve::state::State;
use rdsolve::system::System;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io;
use std::process::Command;
use std::sync::atomic::AtomicBool;

fn sets(of: &[&str]) -> Vec<String> {
    of.iter().map(|set| (*set).to_owned()).collect()
}

/// Without the values a deck expects: steps would land on their times.
fn scene(deck: &str, of: &[&str]) -> Model {
    let mut model = read(deck, &sets(of));
    model.expects.clear();
    model
}

fn of_text(text: &str, of: &[&str]) -> Model {
    let source = Source::new("deck.toml".to_owned(), text.to_owned(), &sets(of));
    let (model, problems) = model::read(&source);
    model.unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<String>()))
}

/// A portal of two bays' depth in space, struck at a corner: bending about both axes, torsion, shear that yields.
fn space_frame() -> String {
    String::from(
        r#"
[analysis]
kind = "dynamic"
end_time = 0.05
time_step = 2.5e-4

[materials.steel]
model = "elastic-plastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 275e6
hardening_modulus = 1.5e9
kinematic_share = 0.5

[sections.bar]
shape = "rectangle"
width = 0.05
height = 0.04
shear_factor = 0.8333333333333334
fibres = [4, 4]

[points]
f1 = [0.0, 0.0, 0.0]
f2 = [1.5, 0.0, 0.0]
f3 = [1.5, 1.0, 0.0]
f4 = [0.0, 1.0, 0.0]
k1 = [0.0, 0.0, 2.0]
k2 = [1.5, 0.0, 2.0]
k3 = [1.5, 1.0, 2.0]
k4 = [0.0, 1.0, 2.0]

[[beams]]
name = "first"
path = ["f1", "k1", "k2", "f2"]
elements = 2
order = 2
material = "steel"
section = "bar"
orientation = [0.0, 1.0, 0.0]

[[beams]]
name = "second"
path = ["f4", "k4", "k3", "f3"]
elements = 2
order = 2
material = "steel"
section = "bar"
orientation = [0.0, 1.0, 0.0]

[[beams]]
name = "left"
path = ["k1", "k4"]
elements = 2
order = 2
material = "steel"
section = "bar"
orientation = [0.0, 0.0, 1.0]

[[beams]]
name = "right"
path = ["k2", "k3"]
elements = 2
order = 2
material = "steel"
section = "bar"
orientation = [0.0, 0.0, 1.0]

[[supports]]
at = ["f1", "f2", "f3", "f4"]
fix = "all"

[[masses]]
at = "k1"
mass = 100.0

[[initial]]
at = "k1"
velocity = [6.0, 3.0, -1.0]
"#,
    )
}

/// [numerical, plastic, viscous, the largest of all shares] at every step.
fn energies(model: &Model) -> Vec<[f64; 4]> {
    let done = run_to_the_end(model, &mut |frame| {
        let e = frame.derived.energy.expect("energy is wanted");
        vec![e.numerical, e.plastic, e.viscoplastic, e.kinetic.max(e.plastic + e.viscoplastic)]
    });
    done.rows.iter().map(|row| [row[0], row[1], row[2], row[3]]).collect()
}

/// The balance closes but for what the scheme takes, and that falls with the step; what is dissipated stays dissipated.
fn balance(deck: &str, of: &[&str], steps: &[f64], least_order: f64, last: f64) {
    println!("\n{deck}\n{:>12} {:>12} {:>12} {:>12}", "step", "numerical", "plastic", "viscous");
    let mut points = Vec::new();
    for step in steps {
        let step_set = format!("analysis.time_step={step:e}");
        let all: Vec<&str> = of.iter().copied().chain([step_set.as_str(), "output.every=1"]).collect();
        let rows = energies(&scene(deck, &all));
        let scale = rows[0][3];
        let worst = rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max) / scale;
        let end = rows.last().unwrap();
        println!("{step:12.4e} {worst:12.4e} {:12.4e} {:12.4e}", end[1], end[2]);
        for pair in rows.windows(2) {
            assert!(pair[1][1] >= pair[0][1], "plastic work fell from {} to {}", pair[0][1], pair[1][1]);
            assert!(pair[1][2] >= pair[0][2], "viscous work fell from {} to {}", pair[0][2], pair[1][2]);
        }
        assert!(end[1] > 0.3 * scale, "little has yielded");
        points.push((*step, worst));
    }
    let order = slope(&points);
    println!("slope {order:.2}");
    assert!(order > least_order, "the numerical energy falls with order {order}");
    assert!(points.last().unwrap().1 < last);
}

#[test]
fn the_energy_of_the_portal_balances() {
    // The scheme is of second order; the blow keeps the slope a little below.
    let of = ["beams.portal.elements=4", "beams.portal.order=2", "output={ every = 1 }"];
    balance("portal_and_block", &of, &[3.75e-4, 1.875e-4, 9.375e-5, 4.6875e-5], 1.5, 5e-5);
}

#[test]
fn the_energy_of_the_ring_balances() {
    balance("free_ring", &[], &[2e-6, 1e-6, 5e-7, 2.5e-7], 1.5, 1e-3);
}

#[test]
fn the_energy_of_the_viscoplastic_ring_balances() {
    // Backward Euler is of first order in the overstress; with the scheme's second order the slope lies between.
    balance("free_ring/viscoplastic", &[], &[2e-6, 1e-6, 5e-7, 2.5e-7], 1.1, 2e-3);
}

fn everything(frame: &Frame) -> Vec<f64> {
    frame.state.nodes.iter().flat_map(position).collect()
}

fn displacements(model: &Model, done: &Done) -> Vec<Vec<f64>> {
    let start: Vec<f64> = model.nodes.iter().flat_map(|node| <[f64; 3]>::from(node.x)).collect();
    done.rows.iter().map(|row| row.iter().zip(&start).map(|(a, b)| a - b).collect()).collect()
}

/// Each method at each tolerance against tangent stiffness at the finest.
fn methods_agree(build: &dyn Fn(&[&str]) -> Model) {
    let history = |method: &str, tolerance: f64| {
        let (method, tolerance) =
            (format!("iteration.method=\"{method}\""), format!("iteration.tolerance={tolerance:e}"));
        let model = build(&[&method, &tolerance]);
        let done = run_to_the_end(&model, &mut everything);
        (displacements(&model, &done), done.counts)
    };
    let (exact, counts) = history("tangent-stiffness", 1e-12);
    for method in ["tangent-stiffness", "initial-load", "auto"] {
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let (rows, counts) = history(method, tolerance);
            let error = error(&rows, &exact, 0);
            println!(
                "{method:18} {tolerance:8.0e} {error:10.2e} {:6.2} iterations a step, {:5} factorizations, {:3} cuts",
                counts.iterations as f64 / counts.steps as f64,
                counts.factorizations,
                counts.cuts
            );
            // Every step leaves at most the tolerance of its increment.
            assert!(error < 10.0 * tolerance * counts.steps as f64, "{method} at {tolerance}: {error}");
        }
    }
    assert!(counts.steps > 50);
}

#[test]
fn all_methods_take_the_portal_the_same_way() {
    println!("\nportal");
    let of = ["beams.portal.elements=2", "beams.portal.order=2", "analysis.time_step=7.5e-4", "output.sections=false"];
    methods_agree(&|more| scene("portal_and_block", &[&of[..], more].concat()));
}

#[test]
fn all_methods_take_a_frame_in_space_the_same_way() {
    println!("\nspace frame");
    methods_agree(&|more| of_text(&space_frame(), more));
}

/// Steps that are cut for want of convergence change the answer by no more than the length of the step does.
#[test]
fn cut_steps_go_on() {
    let history = |of: &[&str]| {
        let common = [
            "beams.portal.elements=2",
            "beams.portal.order=2",
            "iteration.update=\"step\"",
            "iteration.tolerance=1e-8",
        ];
        let model = scene("portal_and_block", &[&common[..], of].concat());
        let done = run_to_the_end(&model, &mut everything);
        (displacements(&model, &done), done.counts)
    };
    let (whole, none) = history(&["analysis.time_step=1.5e-3", "iteration.limit=60"]);
    let (cut, some) = history(&["analysis.time_step=1.5e-3", "iteration.limit=4"]);
    let (fine, _) = history(&["analysis.time_step=1.875e-4", "iteration.limit=60"]);
    let (change, step) = (error(&cut, &whole, 0), error(&whole, &fine, 0));
    println!("{} and {} cuts; cut from whole {change:.2e}, whole from fine {step:.2e}", none.cuts, some.cuts);
    assert!(some.cuts > 5 + none.cuts);
    assert!(change < 2.0 * step);
    assert!(error(&cut, &fine, 0) < 2.0 * step);
}

struct Blind;
impl Observer for Blind {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }
}

fn end_of(model: &Model) -> (Outcome, State) {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let (outcome, state) = Run::new(model, &system, &plan, wanted(model), &stop).unwrap().run(&mut Blind);
    (outcome, state.expect("a state"))
}

/// A step that fails leaves what the material remembers as it was, to the last bit.
#[test]
fn a_rejected_step_leaves_no_trace() {
    // No step is cut: the first that needs more iterations than the limit ends the run.
    let of = [
        "analysis.time_step=1.5e-3",
        "analysis.least_step=1.5e-3",
        "beams.portal.elements=4",
        "iteration.limit=4",
        "expect=[]",
    ];
    let (outcome, failed) = end_of(&scene("portal_and_block", &of));
    let Outcome::Failed { time, .. } = outcome else { panic!("{outcome:?}") };
    assert_eq!(time, failed.time);
    println!("failed after {time}");
    let until = format!("analysis.end_time={time:e}");
    let (outcome, stopped) = end_of(&scene("portal_and_block", &[&of[..], &[until.as_str()]].concat()));
    assert!(matches!(outcome, Outcome::Done));
    assert!(failed.history.iter().any(|h| *h != 0.0), "nothing has yielded before");
    let bits = |state: &State| state.history.iter().map(|h| h.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&failed), bits(&stopped));
    assert_eq!(failed, stopped);
}

/// A space frame of 7³ points whose members yield at once under a stiff shove, enough elements for threads.
fn block_of_frames() -> String {
    const N: usize = 7;
    let mut deck = String::from(
        r#"
[analysis]
kind = "dynamic"
end_time = 2e-3
time_step = 5e-4

[materials.steel]
model = "elastic-viscoplastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
yield_stress = 275e6
hardening_modulus = 1.5e9
viscosity = { law = "power", rate = 40.4, exponent = 5.0 }

[sections.bar]
shape = "rectangle"
width = 0.05
height = 0.04
fibres = [2, 2]

[[supports]]
at = "bottom"
fix = "all"

[[initial]]
at = "top"
velocity = [30.0, 10.0, -20.0]

[output]
nodes = "all"
sections = true
"#,
    );
    let name = |p: [usize; 3]| format!("p{}{}{}", p[0], p[1], p[2]);
    let (mut points, mut layers) = (String::from("[points]\n"), [Vec::new(), Vec::new()]);
    for i in 0..N.pow(3) {
        let p = [i / N / N, i / N % N, i % N];
        writeln!(points, "{} = [{}.0, {}.0, {}.0]", name(p), p[0], p[1], p[2]).unwrap();
        if p[2].is_multiple_of(N - 1) {
            layers[p[2] / (N - 1)].push(format!("{:?}", name(p)));
        }
    }
    writeln!(deck, "{points}\n[sets]\nbottom = [{}]\ntop = [{}]\n", layers[0].join(", "), layers[1].join(", "))
        .unwrap();
    for axis in 0..3 {
        for i in 0..N * N {
            let at = |k: usize| {
                let mut p = [0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (k, i / N, i % N);
                format!("{:?}", name(p))
            };
            let path: Vec<String> = (0..N).map(at).collect();
            let orientation = [[0, 1, 0], [0, 0, 1], [1, 0, 0]][axis];
            let [x, y, z] = orientation;
            writeln!(
                deck,
                "[[beams]]\nname = \"m{axis}_{i}\"\npath = [{}]\nelements = 1\norder = 1\nmaterial = \"steel\"\n\
                 section = \"bar\"\norientation = [{x}.0, {y}.0, {z}.0]\n",
                path.join(", ")
            )
            .unwrap();
        }
    }
    deck
}

/// The files a run leaves, but for those that tell the clock.
fn files(deck: &std::path::Path, folder: &std::path::Path, threads: &str) -> BTreeMap<String, Vec<u8>> {
    let output = Command::new(env!("CARGO_BIN_EXE_rdsolve"))
        .args(["run", "--quiet", "--threads", threads, "-o"])
        .args([folder, deck])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = paths.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), path));
    let lasting = named.filter(|(name, _)| !["result.json", "run.log"].contains(&name.as_str()));
    lasting.map(|(name, path)| (name, std::fs::read(path).unwrap())).collect()
}

#[test]
fn threads_change_no_byte() {
    let dir = tempfile::tempdir().unwrap();
    let deck = dir.path().join("deck.toml");
    for (scene, text) in [("space frame", space_frame()), ("block of frames", block_of_frames())] {
        std::fs::write(&deck, text).unwrap();
        let [one, two, three] = ["1", "2", "3"].map(|threads| {
            let folder = dir.path().join(format!("{scene} {threads}"));
            files(&deck, &folder, threads)
        });
        let energy = String::from_utf8(one["energy.csv"].clone()).unwrap();
        let plastic = energy.lines().last().unwrap().split(',').nth(4).unwrap().parse::<f64>().unwrap();
        println!("{scene}: plastic work {plastic}");
        assert!(plastic > 0.0);
        for other in [two, three] {
            assert!(one.keys().eq(other.keys()));
            for (name, bytes) in &one {
                assert!(*bytes == other[name], "{scene}: {name} differs");
            }
        }
    }
}

/// The plan says what moments of few layers err by, and nothing of sixteen, which cycles want.
#[test]
fn few_layers_are_told_what_moments_err_by() {
    for (layers, told) in [(5, Some("5.5 %")), (7, Some("5.5 %")), (9, Some("1 %")), (14, Some("0.5 %")), (16, None)] {
        let model = crate::support::read_deck(&format!(
            r#"
analysis = {{ kind = "static", end_time = 1.0, time_step = 0.5 }}
points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }}
materials.steel = {{ model = "elastic-plastic", youngs_modulus = 2.1e11, poisson_ratio = 0.3, yield_stress = 2.4e8 }}
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = 2
thickness = 0.01
layers = {layers}
material = "steel"
[[supports]]
at = "plate.edge1"
fix = "all"
[[loads]]
at = "plate"
pressure = 1e3
"#
        ));
        let system = rdsolve::system::System::new(&model).unwrap();
        let plan = rdsolve::plan::Plan::new(&model, &system, 1);
        let text = rdsolve::plan::explain::explain(&plan, &model, &system).to_string();
        let said = text.split("moments err by up to ").nth(1);
        assert_eq!(said.map(|rest| rest.split(" of the plastic").next().unwrap()), told, "{layers}: {text}");
    }
}
