//! What a load step without convergence names as its cause: a limit load with evidence alone, else the place and what to change.

use crate::solve::statics::{said, truss};
use crate::support::{read_deck, run_to_the_end};
use rdsolve::solve::Outcome;
use std::f64::consts::PI;

/// The failure of a deck, in words.
fn failure(deck: &str) -> String {
    let outcome = said(deck).2.outcome;
    let Outcome::Failed { failure, .. } = outcome else { panic!("{outcome:?}\n{deck}") };
    failure.to_string()
}

/// A cantilever of 1 m in one load step that may not be cut.
fn cantilever(force: f64, iteration: &str, more: &str) -> String {
    format!(
        r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
least_step = 1.0
[iteration]
{iteration}
[points]
a = [0.0, 0.0, 0.01]
b = [1.0, 0.0, 0.01]
[sections.s]
shape = "rectangle"
width = 0.01
height = 0.01
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[[beams]]
name = "beam"
path = ["a", "b"]
elements = 10
order = 1
material = "steel"
section = "s"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "a"
fix = "all"
[[loads]]
at = "b"
force = [0.0, 0.0, -{force:?}]
{more}"#
    )
}

const FLOOR: &str = r#"[[contacts]]
name = "floor"
surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
with = "beam"
stiffness = 1e9
"#;

/// A truss and a yielding portal are past their limit loads. Their tangents have a negative or no pivot near the last equilibrium.
#[test]
fn a_structure_past_its_limit_load_is_told_so() {
    // The truss bears 38.2. Steps end where forces miss balance by less than a tenth.
    let text = failure(&truss(39.0, 0.1));
    assert!(text.contains("reaches its limit load") || text.contains("jumps"), "{text}");
    // A bar without hardening bears 250 N.
    let text = failure(
        r#"
analysis = { kind = "static", end_time = 1.0, time_step = 0.1, least_step = 1e-3 }
points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0] }
materials.s = { model = "elastic-plastic", youngs_modulus = 1e9, poisson_ratio = 0.3, density = 1.0, yield_stress = 1e6 }
amplitudes.ramp = { kind = "table", points = [[0.0, 0.0], [1.0, 1.0]] }
[[bars]]
name = "bar"
path = ["a", "b"]
material = "s"
area = 2.5e-4
[[supports]]
at = "a"
fix = "translations"
[[supports]]
at = "b"
fix = ["uy", "uz"]
[[loads]]
at = "b"
force = [300.0, 0.0, 0.0]
amplitude = "ramp"
"#,
    );
    assert!(text.contains("reaches its limit load"), "{text}");
}

/// A column of 1 m with a square section of 20 mm, whose load grows to half more than Euler's, with a small load across it.
fn yielding_column(euler: f64, supports: &str, across: f64, analysis: &str) -> String {
    let critical = euler * PI.powi(2) * 210e9 * 0.02f64.powi(4) / 12.0;
    format!(
        r#"
analysis = {{ kind = "static", end_time = 1.5, time_step = 0.1{analysis} }}
points = {{ a = [0.0, 0.0, 0.0], m = [0.0, 0.0, 0.5], c = [0.0, 0.0, 1.0] }}
materials.s = {{ model = "elastic-plastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 1.0, yield_stress = 235e6, hardening_modulus = 2e9 }}
sections.s = {{ shape = "rectangle", width = 0.02, height = 0.02, fibres = [2, 12] }}
beams = [{{ name = "column", path = ["a", "m", "c"], elements = 2, order = 2, material = "s", section = "s", orientation = [1.0, 0.0, 0.0] }}]
supports = [{{ at = "column", fix = ["uy", "rx", "rz"] }}, {supports}]
amplitudes.ramp = {{ kind = "table", points = [[0.0, 0.0], [2.0, 2.0]] }}
loads = [
    {{ at = "c", force = [0.0, 0.0, {}], amplitude = "ramp" }},
    {{ at = "{}", force = [{}, 0.0, 0.0], amplitude = "ramp" }},
]
"#,
        -critical,
        if supports.contains("\"c\"") { "m" } else { "c" },
        across * critical
    )
}

/// Columns that yield as they buckle bear no more beyond: the run ends near the peak that arc-length control finds, and names it.
#[test]
fn columns_beside_their_critical_load_are_told_to_buckle() {
    let free = r#"{ at = "a", fix = "all" }"#;
    let pinned = r#"{ at = "a", fix = ["ux", "uz"] }, { at = "c", fix = "ux" }"#;
    let clamped = r#"{ at = "a", fix = "all" }, { at = "c", fix = ["ux", "ry"] }"#;
    for (euler, supports, across) in
        [(0.25, free, 1e-2), (1.0, pinned, 1e-4), (1.0, pinned, 1e-2), (4.0, clamped, 1e-3), (4.0, clamped, 1e-2)]
    {
        let outcome = said(&yielding_column(euler, supports, across, "")).2.outcome;
        let Outcome::Failed { failure, time, .. } = outcome else { panic!("{outcome:?}") };
        let text = failure.to_string();
        assert!(text.contains("buckles or reaches its limit load"), "{euler} {across}: {text}");
        assert!(text.contains("\"arc-length\"") && !text.contains("no convergence"), "{text}");
        let model = read_deck(&yielding_column(euler, supports, across, r#", control = "arc-length", steps = 40"#));
        let path = run_to_the_end(&model, &mut |frame| vec![frame.state.time]);
        let peak = path.rows.iter().map(|row| row[0]).fold(0.0, f64::max);
        // The steps of the path pass the peak at a distance of their length, a tenth of the load at the most.
        assert!(peak <= time * (1.0 + 1e-3) && peak > 0.95 * time, "{euler} {across}: {peak} for {time}");
    }
}

/// A beam that one step bends far, or onto a stiff floor: iterates are lost far from every path, and their tangents prove nothing. The
/// message names the place and the bound on the steps, and the steps that it gives lead to the end.
#[test]
fn a_step_that_is_too_long_is_no_limit_load() {
    for (force, limit, more) in [(3000.0, 20, ""), (300.0, 6, FLOOR)] {
        let deck = cantilever(force, &format!("limit = {limit}"), more);
        let text = failure(&deck);
        assert!(!text.contains("limit load") && text.contains("is out of balance in direction"), "{text}");
        assert!(text.contains("`least_step` = 1 forbids shorter steps. Give `least_step` = 0.01"), "{text}");
        let outcome = said(&deck.replace("least_step = 1.0", "least_step = 0.01")).2.outcome;
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    }
}

/// A crank of 1 m and a cylinder of 1 m from a fixed point: together they reach 2 m. A longer stroke names the cylinder and the stroke at which both
/// lie in one line, √2 from the length at a right angle, in a motion as in load steps. A
/// part of the weight pulls across the crank there; without it load steps would end without a force.
#[test]
fn a_drive_beyond_its_reach_is_named() {
    let deck = |analysis: &str, position: f64| {
        format!(
            r#"
[analysis]
{analysis}
end_time = 1.0
time_step = 0.01
[environment]
gravity = [9.81, 0.0, -9.81]
[[bodies]]
name = "crank"
center = [0.5, 0.0, 0.0]
mass = 10.0
inertia = [1.0, 1.0, 1.0]
[[joints]]
name = "pivot"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "crank" }}
[[actuators]]
name = "cylinder"
from = {{ ground = [0.0, 0.0, 1.0] }}
to = {{ body = "crank", point = [1.0, 0.0, 0.0] }}
motion = {{ position = {position:?}, amplitude = "stroke" }}
[amplitudes.stroke]
kind = "table"
interpolation = "monotone"
points = [[0.0, 0.0], [1.0, 1.0]]
"#
        )
    };
    for analysis in ["kind = \"dynamic\"", "kind = \"static\""] {
        for position in [0.7, 700.0] {
            let why = failure(&deck(analysis, position));
            assert!(
                why.starts_with("`cylinder` prescribes a `position` beyond the reach of the linkage: near 0.585"),
                "{why}"
            );
        }
        let outcome = said(&deck(analysis, 0.5)).2.outcome;
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    }
}
