//! What a step of a large shell costs against its size: forces, tangents, factorisation, substitution, the plan, memory; and the
//! tangent of an element in microseconds, one after the other and eight side by side.
//! Each scene runs in a process of its own, whose peak of memory it is; times are the least of many.
//!
//! `cargo bench --bench shells` takes all scenes; arguments keep those whose names contain all of them, for instance
//! `-- flat quadrilateral 60k`.

use rdsolve::diagnostic::Source;
use rdsolve::elements::Moduli;
use rdsolve::model::{self, Model};
use rdsolve::plan::Plan;
use rdsolve::state::{Configuration, Node};
use rdsolve::system::TangentWeights;
use rdsolve::system::{Excitation, Forces, Loading, Side, System};
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

/// Name and elements along an edge: six unknowns a node.
const SIZES: [(&str, usize); 4] = [("10k", 40), ("60k", 99), ("100k", 128), ("250k", 203)];
const FORMS: [&str; 2] = ["flat", "curved"];
const KINDS: [&str; 2] = ["quadrilateral", "triangle"];
const MATERIALS: [&str; 2] = ["elastic", "yielding"];

/// A square or a quarter of a cylinder, clamped along one edge.
fn deck(form: &str, kind: &str, material: &str, elements: usize) -> String {
    let surface = match form {
        "flat" => "",
        _ => "surface = { kind = \"cylinder\", axis = [0.0, 1.0, 0.0], center = [0.0, 0.0, 0.0] }",
    };
    let (law, layers) = match material {
        "elastic" => ("model = \"elastic\"", ""),
        _ => ("model = \"elastic-plastic\"\nyield_stress = 275e6\nhardening_modulus = 1.5e9", "layers = 5"),
    };
    let [b, c] = match form {
        "flat" => ["[1.0, 0.0, 1.0]", "[1.0, 1.0, 1.0]"],
        _ => ["[1.0, 0.0, 0.0]", "[1.0, 1.0, 0.0]"],
    };
    format!(
        r#"
        [analysis]
        kind = "dynamic"
        end_time = 1e-3
        time_step = 1e-5

        [materials.steel]
        {law}
        youngs_modulus = 210e9
        poisson_ratio = 0.3
        density = 7850.0

        [points]
        a = [0.0, 0.0, 1.0]
        b = {b}
        c = {c}
        d = [0.0, 1.0, 1.0]

        [[shells]]
        name = "sheet"
        corners = ["a", "b", "c", "d"]
        elements = {elements}
        kind = "{kind}"
        thickness = 0.01
        material = "steel"
        {layers}
        {surface}

        [[supports]]
        at = "sheet.edge4"
        fix = "all"

        [output]
        energy = false
        "#
    )
}

fn read(text: String) -> Model {
    let source = Source::new("deck".to_owned(), text, &[]);
    let (model, problems) = model::read(&source);
    model.unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<String>()))
}

/// Stretched and bent until material that yields does so everywhere.
fn moved(model: &Model) -> Vec<Node> {
    let mut nodes: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
    for node in &mut nodes {
        let x = node.x;
        node.x.y += 4e-3 * x.y;
        node.x.z += 1e-2 * (3.0 * x.x).sin() * x.y;
    }
    nodes
}

/// Least seconds of one call over some seconds of calls.
fn least<T>(subject: &mut T, mut prepare: impl FnMut(&mut T), mut call: impl FnMut(&mut T)) -> f64 {
    let (began, mut least, mut calls) = (Instant::now(), f64::INFINITY, 0);
    while calls < 3 || began.elapsed().as_secs_f64() < 1.0 {
        prepare(subject);
        let start = Instant::now();
        call(subject);
        least = least.min(start.elapsed().as_secs_f64());
        calls += 1;
    }
    least
}

/// Least seconds for the tangent of an element, one after the other and side by side, without their places in the matrix.
fn element_tangents(system: &System, now: &Configuration, rate: f64) -> [f64; 2] {
    const CHUNK: usize = 256;
    let block = &system.groups[0].block;
    let (count, length) = (block.len(), (6 * block.nodes(0).len()).pow(2));
    let mut K = vec![0.0; CHUNK * length];
    let firsts = || (0..count).step_by(CHUNK);
    let room = |first: usize| (count - first).min(CHUNK) * length;
    let mut times = [f64::INFINITY; 2];
    for _ in 0..10 {
        let alone = timed(|| {
            for first in firsts() {
                for (k, K) in K[..room(first)].chunks_mut(length).enumerate() {
                    block.tangent(first + k, now, rate, Moduli::Algorithmic, K);
                }
            }
        });
        let eight = timed(|| {
            firsts().for_each(|first| block.tangents(first, now, rate, Moduli::Algorithmic, &mut K[..room(first)]))
        });
        times = [times[0].min(alone.0), times[1].min(eight.0)];
    }
    times.map(|seconds| seconds / count as f64)
}

fn timed<T>(call: impl FnOnce() -> T) -> (f64, T) {
    let began = Instant::now();
    let out = call();
    (began.elapsed().as_secs_f64(), out)
}

/// In bytes; none where the system does not tell.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

fn measure(name: &str, text: String, threads: usize) {
    let (reading, model) = timed(|| read(text));
    let (system_s, system) = timed(|| System::new(&model).expect("a system"));
    let (plan_s, plan) = timed(|| Plan::new(&model, &system, threads));
    let (build_s, (mut solver, mut assembly)) = timed(|| plan.build(&system).unwrap());
    let nodes = moved(&model);
    let past = vec![0.0; system.history];
    let now = Configuration { nodes: &nodes, history: &past, dt: 1e-5, previous: None };
    let mut loading = Loading::default();
    Excitation::new(&model).loading(0.0, Side::After, &mut loading);
    let mut forces = Forces::new(&system, nodes.len()).on_threads(threads);
    let scheme = &model.solution.scheme;
    let (rate, acceleration) = scheme.coefficients(model.analysis.nominal_step()).weights();
    let weights = TangentWeights { stiffness: true, rate, acceleration, turning: None, moduli: Moduli::Algorithmic };

    let force = least(&mut forces, |_| (), |f| _ = black_box(system.residual(&now, &loading, f)));
    let both = &mut (&mut assembly, &mut solver);
    let tangent = least(both, |_| (), |(a, s)| a.tangent(&system, &now, &loading, &mut forces, weights, s));
    let [alone, eight] = element_tangents(&system, &now, rate);
    // A factorisation overwrites the matrix.
    let fill = |(a, s): &mut (&mut _, &mut _)| {
        let a: &mut rdsolve::system::assembly::Assembly = a;
        a.tangent(&system, &now, &loading, &mut forces, weights, s)
    };
    let factor = least(both, fill, |(_, s)| s.factor().expect("a regular matrix"));
    let solve = least(&mut (&mut solver, vec![1.0; plan.dofs.unknowns()]), |(_, b)| b.fill(1.0), |(s, b)| s.solve(b));
    let stats = solver.stats();
    let bytes = 8.0 * stats.nonzeros as f64;
    let peak = peak_memory().unwrap_or(f64::NAN);
    let planning = [reading, system_s, plan_s, build_s].map(|s| format!("{s:>7.2}")).concat();
    let times = [force, tangent, factor, solve].map(|s| format!("{:>9.2}", 1e3 * s)).concat();
    println!(
        "{name:36} {:>7} {threads} {times} {:>6.2} {:>6.2} {:>6.2} {:>6.1}{planning} {:>7.0} {:>7.0} {:>5.2} {}",
        plan.dofs.unknowns(),
        1e6 * alone,
        1e6 * eight,
        tangent / factor,
        stats.flops / factor / 1e9,
        bytes / 1e6,
        peak / 1e6,
        peak / bytes,
        stats.ordering,
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    if let [first, form, kind, material, elements, name, threads] = &arguments[..]
        && first == "one"
    {
        let elements = elements.parse().expect("a number");
        let threads = threads.parse().expect("a number");
        // The pool has no more threads than are measured.
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("a pool");
        return measure(name, deck(form, kind, material, elements), threads);
    }
    println!(
        "{:36} {:>7} t {:>9}{:>9}{:>9}{:>9} {:>6} {:>6} {:>6} {:>6}{:>7}{:>7}{:>7}{:>7} {:>7} {:>7} {:>5} order",
        "scene (milliseconds)",
        "rows",
        "forces",
        "tangents",
        "factor",
        "solve",
        "one µs",
        "eight",
        "t/f",
        "GF/s",
        "read s",
        "system",
        "plan",
        "build",
        "L MB",
        "peak MB",
        "p/L",
    );
    let this = std::env::current_exe().expect("this program");
    for (size, elements) in SIZES {
        for form in FORMS {
            for kind in KINDS {
                for material in MATERIALS {
                    let name = format!("{form} {kind} {material} {size}");
                    if !arguments.iter().all(|argument| name.contains(argument.as_str())) {
                        continue;
                    }
                    for threads in ["1", "2"] {
                        let elements = elements.to_string();
                        let status =
                            Command::new(&this).args(["one", form, kind, material, &elements, &name, threads]).status();
                        assert!(status.is_ok_and(|status| status.success()), "{name}");
                    }
                }
            }
        }
    }
}
