//! What `[[expect]]` may ask of bars, supports, shells and joints, and the tables that have the same.

use crate::support::{read_deck, run_to_the_end};
use rdsolve::output::TABLES;
use rdsolve::solve::Frame;

fn row(at: &str, quantity: &str, value: f64) -> String {
    format!("[[expect]]\nat = \"{at}\"\nquantity = \"{quantity}\"\ntime = 1.0\nvalue = {value:?}\ntolerance = 1e-5\n")
}

fn all_pass(text: &str, count: usize) {
    let done = run_to_the_end(&read_deck(text), &mut |_: &Frame| Vec::new());
    assert_eq!(done.verdicts.len(), count);
    for verdict in &done.verdicts {
        assert!(verdict.passed, "{verdict:?}");
    }
}

/// Two bars of slope 3:4:5 under 800 N carry 500 N each; a strip pulled by 1000 N/m has N11 = 1000 and a stress of 1e5 at 1 cm.
/// Displacements are 1e-6 of the size: the tolerance.
#[test]
fn forces_of_bars_reactions_and_resultants_of_shells() {
    let text = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
[points]
a = [-3.0, 4.0, 0.0]
b = [3.0, 4.0, 0.0]
c = [0.0, 0.0, 0.0]
p = [10.0, 0.0, 0.0]
q = [12.0, 0.0, 0.0]
r = [12.0, 1.0, 0.0]
s = [10.0, 1.0, 0.0]
[materials.steel]
model = "elastic"
youngs_modulus = 2e11
poisson_ratio = 0.0
[materials.soft]
model = "elastic-plastic"
youngs_modulus = 2e11
poisson_ratio = 0.0
yield_stress = 4e6
hardening_modulus = 1e10
[[bars]]
name = "left"
path = ["a", "c"]
axial_stiffness = 1e9
[[bars]]
name = "right"
path = ["c", "b"]
area = 5e-3
material = "soft"
[[shells]]
name = "plate"
corners = ["p", "q", "r", "s"]
elements = [2, 1]
thickness = 0.01
material = "steel"
[[bodies]]
name = "block"
center = [20.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[supports]]
at = "block"
fix = "all"
[[supports]]
at = ["a", "b"]
fix = ["ux", "uy", "uz"]
[[supports]]
at = "c"
fix = ["uz"]
[[supports]]
at = ["p", "s"]
fix = "all"
[[supports]]
at = ["q", "r"]
fix = ["uz", "rx", "ry", "rz"]
[[loads]]
at = "c"
force = [0.0, -800.0, 0.0]
[[loads]]
at = ["q", "r"]
force = [500.0, 0.0, 0.0]
[[loads]]
at = "block"
force = [0.0, 7.0, 0.0]
moment = [0.0, 0.0, 3.0]
"#;
    let expected = [
        row("left", "N", 500.0),
        row("right", "N", 500.0),
        row("a", "fx", -300.0),
        row("a", "fy", 400.0),
        row("s", "fx", -500.0),
        row("block", "fy", -7.0),
        row("block", "mz", -3.0),
        row("plate", "N11", 1000.0),
        row("plate", "von_mises_top", 1e5),
        row("plate", "von_mises", 1e5),
    ];
    all_pass(&(text.to_owned() + &expected.concat()), expected.len());
}

/// A slider with a spring of 100 N/m that 5 N have stretched by 0.05 m along x, across which 7 N act: the joint pushes its first part by
/// (5, 7), spring and constraints together, in `[[expect]]` and in joints.csv.
#[test]
fn forces_of_a_joint_act_on_its_first_part_wherever_they_stand() {
    let text = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5
[[bodies]]
name = "slide"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[joints]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "slide" }
stiffness = 100.0
[[loads]]
at = "slide"
force = [5.0, 7.0, 0.0]
[output]
joints = true
"#;
    let expected =
        [row("rail", "coordinate", 0.05), row("rail", "fx", 5.0), row("rail", "fy", 7.0), row("rail", "effort", -5.0)];
    all_pass(&(text.to_owned() + &expected.concat()), expected.len());
    let joints = TABLES.iter().find(|table| table.file == "joints.csv").expect("a table");
    let fx = joints.columns().find(|column| column.name == "fx").expect("a column");
    assert!(fx.meaning.contains("on its first part"), "{}", fx.meaning);
}
