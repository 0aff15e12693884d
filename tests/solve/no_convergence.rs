//! What a load step without convergence names as its cause: a limit load with evidence alone, else the place and what to change.

use crate::solve::statics::{said, truss};
use rdsolve::solve::Outcome;

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
    assert!(text.contains("a limit load?") || text.contains("jumps"), "{text}");
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
    assert!(text.contains("a limit load?"), "{text}");
}

/// A beam that one step bends far, or onto a stiff floor: iterates are lost far from every path, and their tangents prove nothing. The
/// message names the place and the bound on the steps, and the steps that it gives lead to the end.
#[test]
fn a_step_that_is_too_long_is_no_limit_load() {
    for (force, limit, more) in [(3000.0, 20, ""), (300.0, 6, FLOOR)] {
        let deck = cantilever(force, &format!("limit = {limit}"), more);
        let text = failure(&deck);
        assert!(!text.contains("limit load") && text.contains("is out of balance in direction"), "{text}");
        assert!(text.contains("`least_step` = 1 forbids shorter steps: give a hundredth of it, 0.01"), "{text}");
        let outcome = said(&deck.replace("least_step = 1.0", "least_step = 0.01")).2.outcome;
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    }
}
