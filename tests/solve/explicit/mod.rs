//! Explicit schemes through the whole program. `-- --nocapture --test-threads 1` shows the tables.

mod balance;
mod critical_step;
mod energy_growth;
mod implicit;
mod mass_scaling;
mod masses;
mod order;
mod scenes;

use crate::support::{body_omega, error, node, position, read, run_to_the_end, slope};
use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::model::Model;
use rdsolve::solve::Frame;
use rdsolve::system::energy::Balance;

const CENTRAL: &str = "integrator={scheme=\"central-difference\"}";
const EIGHT: &str = "integrator={scheme=\"runge-kutta\"}";
const FIVE: &str = "integrator={scheme=\"runge-kutta\",order=5}";
const WILSON: &str = "integrator={scheme=\"wilson-theta\"}";

type Probe = Box<dyn FnMut(&Frame) -> Vec<f64>>;

fn deck(name: &str, sets: &[&str]) -> Model {
    let sets: Vec<String> = sets.iter().copied().chain(["expect=[]"]).map(str::to_owned).collect();
    read(name, &sets)
}

/// A deck of a few lines.
fn scene(text: &str, sets: &[&str]) -> Model {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let source = Source::new("deck.toml", text, &sets);
    let (model, problems) = model::read(&source);
    let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
    model.unwrap_or_else(|| panic!("{}", drawn.join("\n")))
}

fn attitude(model: &Model) -> Probe {
    let body = node(model, "body");
    Box::new(move |frame| {
        let now = &frame.state.nodes[body];
        body_omega(now).into_iter().chain(now.R().iter().copied()).collect()
    })
}

fn two_bodies(model: &Model) -> Probe {
    let (a, b) = (node(model, "a"), node(model, "b"));
    Box::new(move |frame| {
        let [a, b] = [a, b].map(|body| &frame.state.nodes[body]);
        [position(a), position(b), body_omega(a), body_omega(b)].concat()
    })
}

fn place_of(label: &'static str) -> impl Fn(&Model) -> Probe {
    move |model| {
        let at = node(model, label);
        Box::new(move |frame| position(&frame.state.nodes[at]).to_vec())
    }
}

/// (step, error) for steps of `interval` over each division, against `exact`.
fn ladder(
    name: &str,
    sets: &[&str],
    probe: &dyn Fn(&Model) -> Probe,
    (interval, divisions): (f64, &[u32]),
    exact: &[Vec<f64>],
) -> Vec<(f64, f64)> {
    println!("\n{name} {}", sets[0]);
    let rung = |&division: &u32| {
        let step = interval / f64::from(division);
        let text = [format!("analysis.time_step={step:e}"), format!("output.interval={interval}")];
        let sets: Vec<&str> = sets.iter().copied().chain(text.iter().map(String::as_str)).collect();
        let model = deck(name, &sets);
        let done = run_to_the_end(&model, &mut probe(&model));
        let error = error(&done.rows, exact, 0);
        println!("{step:12.5e} {error:10.3e} {:9.4} s, {} cuts", done.seconds, done.counts.cuts);
        (step, error)
    };
    divisions.iter().map(rung).collect()
}

fn assert_order(points: &[(f64, f64)], range: std::ops::Range<f64>) {
    let order = slope(points);
    println!("slope {order:.2}");
    assert!(range.contains(&order), "order {order}, expected {range:?}");
}

fn balance_of(model: &Model) -> Balance {
    let mut balance = Balance::default();
    run_to_the_end(model, &mut |frame| {
        balance.update(&frame.derived.energy.unwrap());
        Vec::new()
    });
    balance
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    error(a, b, 0)
}
