//! Times of the parts of one Newton iteration: force, tangent, factor, solve. Least of many repeats, one thread.
//!
//! `cargo bench --bench iteration` takes cantilevers of 20 elements of each order, bent by a load at the tip; arguments
//! that end in .toml are decks to take instead. The state is that of the run's end. Beside the parts stands what an
//! iteration costs in a run, time loop over iterations, with the matrix renewed in every iteration and only once.

use rdsolve::diagnostic::Source;
use rdsolve::elements::Moduli;
use rdsolve::model::{self, Model, Update};
use rdsolve::plan::Plan;
use rdsolve::solve::{Outcome, Run, Wanted};
use rdsolve::state::State;
use rdsolve::system::TangentWeights;
use rdsolve::system::{Excitation, Forces, Loading, Side, System};
use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A slender cantilever that swings through rotations of about one radian.
fn cantilever(order: usize) -> String {
    format!(
        r#"
        [analysis]
        kind = "dynamic"
        end_time = 0.2
        time_step = 1e-3

        [materials.steel]
        model = "elastic"
        youngs_modulus = 210e9
        poisson_ratio = 0.3
        density = 7850.0

        [sections.strip]
        shape = "rectangle"
        width = 0.030
        height = 0.005

        [points]
        clamp = [0.0, 0.0, 0.0]
        tip = [1.0, 0.0, 0.0]

        [[beams]]
        name = "beam"
        path = ["clamp", "tip"]
        elements = 20
        order = {order}
        material = "steel"
        section = "strip"
        orientation = [0.0, 1.0, 0.0]

        [[supports]]
        at = "clamp"
        fix = "all"

        [[loads]]
        at = "tip"
        force = [0.0, 50.0, 100.0]
        moment = [5.0, 0.0, 0.0]

        [output]
        energy = false
        "#
    )
}

fn read(name: &str, text: String) -> Model {
    let source = Source::new(name.to_owned(), text, &[]);
    let (model, problems) = model::read(&source);
    model.unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<String>()))
}

/// Seconds of the time loop per iteration, the least of some runs, and the state at the end.
fn run(model: &Model) -> (f64, State) {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let (mut least, mut end) = (f64::INFINITY, None);
    let began = Instant::now();
    while end.is_none() || began.elapsed().as_secs_f64() < 1.0 {
        let mut run = Run::new(model, &system, &plan, Wanted::default(), &stop).unwrap();
        let start = Instant::now();
        let (outcome, state) = run.run(&mut ());
        let seconds = (start.elapsed() - run.observing()).as_secs_f64();
        assert!(matches!(outcome, Outcome::Done), "{}: {outcome:?}", model.title);
        least = least.min(seconds / run.counts().iterations as f64);
        end = state;
    }
    (least, end.expect("a state"))
}

/// Least seconds of one call over half a second of calls.
fn least<T>(subject: &mut T, mut prepare: impl FnMut(&mut T), mut call: impl FnMut(&mut T)) -> f64 {
    let (began, mut least) = (Instant::now(), f64::INFINITY);
    while least.is_infinite() || began.elapsed().as_secs_f64() < 0.5 {
        prepare(subject);
        let start = Instant::now();
        call(subject);
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}

fn measure(name: &str, mut model: Model) {
    model.solution.iteration.update = Update::Iteration;
    let (renewed, state) = run(&model);
    model.solution.iteration.update = Update::Never;
    let (kept, _) = run(&model);

    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    let (mut solver, mut assembly) = plan.build(&system).unwrap();
    let mut loading = Loading::default();
    Excitation::new(&model).loading(state.time, Side::Before, &mut loading);
    let mut forces = Forces::new(&system, model.nodes.len());
    let scheme = &model.solution.scheme;
    let (rate, acceleration) = scheme.coefficients(model.analysis.nominal_step()).weights();
    let weights = TangentWeights { stiffness: true, rate, acceleration, turning: None, moduli: Moduli::Algorithmic };

    let force = least(&mut forces, |_| (), |f| _ = black_box(system.residual(&state.configuration(), &loading, f)));
    let tangent = least(
        &mut (&mut assembly, &mut solver),
        |_| (),
        |(assembly, solver)| assembly.tangent(&system, &state.configuration(), &loading, &mut forces, weights, solver),
    );
    // A factorisation overwrites the matrix.
    let factor = least(
        &mut (&mut assembly, &mut solver),
        |(assembly, solver)| assembly.tangent(&system, &state.configuration(), &loading, &mut forces, weights, solver),
        |(_, solver)| solver.factor().expect("a regular matrix"),
    );
    let solve =
        least(&mut (&mut solver, vec![1.0; plan.dofs.unknowns()]), |(_, b)| b.fill(1.0), |(solver, b)| solver.solve(b));
    let micro = [force, tangent, factor, solve, force + tangent + factor + solve, force + solve, renewed, kept];
    let columns: Vec<String> = micro.iter().map(|seconds| format!("{:>11.2}", seconds * 1e6)).collect();
    println!("{name:24} {:>8}{} {:?}", plan.dofs.unknowns(), columns.concat(), plan.kind);
}

fn main() {
    let decks: Vec<String> = std::env::args().skip(1).filter(|argument| argument.ends_with(".toml")).collect();
    println!(
        "{:24} {:>8}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11} matrix   (microseconds)",
        "scene",
        "unknowns",
        "force",
        "tangent",
        "factor",
        "solve",
        "all four",
        "force+solve",
        "run, new K",
        "run, old K"
    );
    if decks.is_empty() {
        for order in 1..=4 {
            let name = format!("20 beams of order {order}");
            measure(&name, read(&name, cantilever(order)));
        }
    }
    for path in decks {
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let name = std::path::Path::new(&path).file_stem().map_or(path.clone(), |s| s.to_string_lossy().into_owned());
        measure(&name, read(&path, text));
    }
}
