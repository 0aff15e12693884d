//! Mechanisms with a reduced part beside the same with all elements, and parts that are reduced together.

use crate::support::{assert_says_what_to_change, read_deck, run_to_the_end, tables_of};
use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::solve::Frame;
use std::f64::consts::TAU;
use std::sync::Arc;

const STEEL: &str =
    "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\ndensity = 7870.0\n";

fn reduced(modes: Option<usize>) -> String {
    modes.map_or_else(String::new, |modes| format!("reduced = {modes}\n"))
}

/// A crank of 0.15 m at 40 rad/s moves a steel rod of 0.3 m and 6 mm, and that a slider (J. B. Jonker, Multibody Syst. Dyn. 3 (1999)), for an
/// eighth of a turn.
fn slider_crank(modes: Option<usize>) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 0.02
time_step = 2e-4
plane = "off"
[integrator]
scheme = "generalized-alpha"
spectral_radius = 0.9
{STEEL}
[sections.rod]
shape = "circle"
radius = 0.003
[points]
knee = [0.15, 0.0, 0.0]
wrist = [0.45, 0.0, 0.0]
[[beams]]
name = "rod"
path = ["knee", "wrist"]
elements = 12
material = "steel"
section = "rod"
orientation = [0.0, 0.0, 1.0]
mass = "consistent"
{}
[[initial]]
at = ["rod"]
velocity = [0.0, 6.0, 0.0]
angular_velocity = [0.0, 0.0, -20.0]
about = [0.15, 0.0, 0.0]
[[bodies]]
name = "crank"
center = [0.075, 0.0, 0.0]
mass = 0.1
inertia = [1e-4, 1e-4, 1e-4]
velocity = [0.0, 3.0, 0.0]
angular_velocity = [0.0, 0.0, 40.0]
[[bodies]]
name = "slider"
center = [0.45, 0.0, 0.0]
mass = 0.0334
inertia = [1e-5, 1e-5, 1e-5]
[[joints]]
name = "motor"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "crank" }}
motion = {{ velocity = 40.0 }}
[[joints]]
name = "knee_pin"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ body = "crank", point = [0.15, 0.0, 0.0] }}
to = {{ node = "knee" }}
[[joints]]
name = "wrist_pin"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ node = "wrist" }}
to = {{ body = "slider" }}
[[joints]]
name = "guide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = {{ ground = [0.45, 0.0, 0.0] }}
to = {{ body = "slider" }}
"#,
        reduced(modes)
    )
}

/// Places of all nodes, then the mechanical energy less the work of the drive.
fn places(frame: &Frame) -> Vec<f64> {
    let nodes = frame.state.nodes.iter().zip(&frame.model.nodes).filter(|(_, node)| !node.is_number);
    let energy = frame.derived.energy.expect("energies");
    nodes.flat_map(|(node, _)| [node.x.x, node.x.y, node.x.z]).chain([energy.mechanical - energy.external]).collect()
}

fn largest(rows: &[Vec<f64>], others: &[Vec<f64>]) -> f64 {
    let of_row = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        a[..a.len() - 1].iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    };
    rows.iter().zip(others).map(of_row).fold(0.0, f64::max)
}

/// The error of a reduced rod falls with its modes, and energy is that which the drive brings.
#[test]
fn a_slider_crank_approaches_that_of_all_elements() {
    let rows = |modes| run_to_the_end(&read_deck(&slider_crank(modes)), &mut places).rows;
    let full = rows(None);
    let errors = [0, 1, 3].map(|modes| {
        let few = rows(Some(modes));
        assert_eq!(few.len(), full.len());
        let balance = |row: &Vec<f64>| row[row.len() - 1];
        let drift = few.iter().map(|row| (balance(row) - balance(&few[0])).abs()).fold(0.0, f64::max);
        // The error of the steps, of 0.7 J.
        assert!(drift < 1e-3, "{drift:e}");
        largest(&full, &few)
    });
    // Measured 3.9e-7, 3.1e-7 and 1.7e-7, in metres, of a deflection of some 0.3 mm; without static shapes of inertia loads 0 modes erred by 5e-5.
    let falls = errors[1] < 0.9 * errors[0] && errors[2] < 0.7 * errors[1];
    assert!(falls && errors[0] < 5e-7, "{errors:?}");
}

/// Two panels with a common edge.
fn panels(own: &str, rest: &str) -> String {
    format!(
        r#"
[materials.metal]
model = "elastic"
youngs_modulus = 7e10
poisson_ratio = 0.3
density = 2700.0
[points]
a = [0.0, 0.0, 0.0]
b = [0.3, 0.0, 0.0]
c = [0.3, 0.4, 0.1]
d = [0.0, 0.4, 0.1]
e = [0.6, 0.0, 0.1]
f = [0.6, 0.4, 0.2]
[[shells]]
name = "left"
corners = ["a", "b", "c", "d"]
elements = [3, 4]
thickness = 0.004
material = "metal"
{own}
[[shells]]
name = "right"
corners = ["b", "e", "f", "c"]
elements = [3, 4]
thickness = 0.003
material = "metal"
{own}
[[supports]]
at = ["a", "d"]
fix = "all"
{rest}
"#
    )
}

const TOGETHER: &str = "[[parts]]\nname = \"roof\"\nparts = [\"left\", \"right\"]\nreduced = 12\n";

fn frequencies(text: &str) -> Vec<f64> {
    let model = read_deck(&format!("[analysis]\nkind = \"modal\"\nmodes = 5\n{text}"));
    tables_of(&model).rows("modes.csv").iter().map(|row| row.number("frequency")).collect()
}

/// Parts that are reduced together have their common edge inside, and the frequencies of the whole.
#[test]
fn parts_are_reduced_together() {
    let text = panels("", TOGETHER);
    let model = read_deck(&format!("[analysis]\nkind = \"modal\"\n{text}"));
    let [of] = &model.reductions[..] else { panic!("one reduction") };
    // Six points; 35 nodes in all.
    assert_eq!((of.interface.len(), of.inner.len(), of.parts.len()), (6, 29, 2));
    let (full, few) = (frequencies(&panels("", "")), frequencies(&text));
    let errors: Vec<f64> = few.iter().zip(&full).map(|(few, full)| few / full - 1.0).collect();
    // From above. Measured 2e-3 for the fifth.
    assert!(errors.iter().all(|error| (-1e-8..5e-3).contains(error)), "{errors:?}");
    let sets =
        text.replace("parts = [\"left\", \"right\"]", "parts = \"both\"") + "[sets]\nboth = [\"left\", \"right\"]\n";
    assert_eq!(few, frequencies(&sets));
}

/// The panels with a hinge at each end of their edge in place of common nodes.
fn apart() -> String {
    let hinge = |a: &str, b: &str| {
        format!(
            "[[joints]]\nname = \"at {a}\"\nkind = \"ball\"\nfrom = {{ node = \"{a}\" }}\nto = {{ node = \"{b}\" }}\n"
        )
    };
    panels("", TOGETHER)
        .replace("e = [", "b2 = [0.3, 0.0, 0.0]\nc2 = [0.3, 0.4, 0.1]\ne = [")
        .replace("[\"b\", \"e\", \"f\", \"c\"]", "[\"b2\", \"e\", \"f\", \"c2\"]")
        + &hinge("b", "b2")
        + &hinge("c", "c2")
}

/// A stiffener beside a panel, on rigid arms, is one with it.
#[test]
fn rigid_arms_join_pieces() {
    let stiffener = format!(
        "{STEEL}[sections.rib]\nshape = \"rectangle\"\nheight = 0.02\nwidth = 0.004\n[[beams]]\nname = \"rib\"\npath = [\"b\", \"c\"]\n\
         elements = 4\nsection = \"rib\"\nmaterial = \"steel\"\norientation = [0.0, 0.0, 1.0]\noffset_start = [0.0, 0.0, -0.01]\n\
         offset_end = [0.0, 0.0, -0.01]\n"
    );
    let list = TOGETHER.replace("\"left\", ", "\"rib\", \"left\", ");
    let (full, few) = (frequencies(&panels("", &stiffener)), frequencies(&panels("", &(stiffener.clone() + &list))));
    // As without the stiffener.
    assert!(few.iter().zip(&full).all(|(few, full)| (-1e-8..5e-3).contains(&(few / full - 1.0))), "{few:?} {full:?}");
}

#[test]
fn wrong_lists_of_parts_are_refused() {
    let said = |text: &str| {
        let text = format!("[analysis]\nkind = \"modal\"\n{text}");
        let (_, problems) = model::read_stages(&Source::new("deck.toml", text.as_str(), &[]));
        problems.iter().filter(|problem| problem.is_error()).for_each(assert_says_what_to_change);
        problems.iter().map(|problem| problem.message.clone()).collect::<Vec<_>>().join("\n")
    };
    let list = |names: &str| TOGETHER.replace("\"left\", \"right\"", names);
    let cases = [
        (panels("", &list("\"left\", \"rigth\"")), "no beam or shell is named `rigth`"),
        (panels("", &list("\"left\", \"left\"")), "shell `left` is reduced twice"),
        (panels("reduced = 4", TOGETHER), "shell `left` is reduced twice"),
        (panels("", &list("")), "has no parts"),
        (
            panels("", TOGETHER).replacen("thickness = 0.003", "thickness = 0.003\ndamping = { beta = 1e-3 }", 1),
            "different `damping`",
        ),
        (apart(), "parts `roof` is in several pieces: no element leads from `a` to `b2`"),
        (
            panels("", TOGETHER)
                .replace("[3, 4]\nthickness = 0.003", "[3, 4]\nmass = \"free-nodes\"\nthickness = 0.003"),
            "shell `right`",
        ),
    ];
    for (text, expected) in cases {
        let said = said(&text);
        assert!(said.contains(expected), "{expected}: {said}");
    }
}

/// A soft wire on a stiff panel tells parts apart.
#[test]
fn soft_members_tell_parts_apart() {
    let pair = |y: f64, name: &str, torsion: f64| {
        let points = format!(
            "{name}0 = [0.0, {y}, 0.0]\n{name}1 = [0.3, {y}, 0.0]\n{name}2 = [0.3, {}, 0.0]\n{name}3 = [0.0, {}, 0.0]\n{name}4 = [0.6, {y}, 0.0]\n",
            y + 0.2,
            y + 0.2
        );
        let parts = format!(
            "[sections.{name}]\nshape = \"general\"\naxial_stiffness = 1e6\nshear_stiffness = [1e5, 1e5]\n\
             torsional_stiffness = {torsion}\nbending_stiffness = [10.0, 10.0]\n[[shells]]\nname = \"{name}_panel\"\ncorners = [\"{name}0\", \"{name}1\", \"{name}2\", \"{name}3\"]\n\
             elements = [3, 2]\nthickness = 0.02\nmaterial = \"steel\"\n[[beams]]\nname = \"{name}_wire\"\npath = [\"{name}1\", \"{name}4\"]\nelements = 3\n\
             section = \"{name}\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n\
             [[parts]]\nname = \"{name}\"\nparts = [\"{name}_panel\", \"{name}_wire\"]\nreduced = 3\n[[supports]]\nat = \"{name}0\"\nfix = \"all\"\n\
             [[masses]]\nat = \"{name}4\"\nmass = 0.1\ninertia = [1e-4, 1e-4, 1e-4]\n"
        );
        (points, parts)
    };
    // A tenth of the torsion is some 1e-13 of the largest entry of the panel.
    let pairs = [pair(0.0, "p", 1e-3), pair(1.0, "q", 1.1e-3), pair(2.0, "r", 1e-3)];
    let (points, parts): (String, String) = pairs.into_iter().unzip();
    let [first, second, third, ..] = frequencies(&format!("{STEEL}[points]\n{points}{parts}"))[..] else { panic!() };
    // The disks turn on their wires: ω² = GJ/(L I). Measured 4e-8.
    let of_wire = |torsion: f64| (torsion / (0.3 * 1e-4)).sqrt() / TAU;
    for (found, torsion) in [(first, 1e-3), (second, 1e-3), (third, 1.1e-3)] {
        assert!((found / of_wire(torsion) - 1.0).abs() < 1e-6, "{first} {second} {third}");
    }
}

/// Parts that are alike share their matrices; others do not.
#[test]
fn parts_that_are_alike_share_matrices() {
    let arm = |name: &str| {
        format!(
            "[[beams]]\nname = \"{name}\"\npath = [\"{name}0\", \"{name}1\"]\nelements = 8\nmaterial = \"steel\"\nsection = \"bar\"\n\
             orientation = [0.0, 1.0, 0.0]\nreduced = 4\n[[supports]]\nat = \"{name}0\"\nfix = \"all\"\n"
        )
    };
    let arms = [("p", 0.0, 1.0), ("q", 0.7, 1.0), ("r", 1.3, 1.1)];
    let points: String = arms
        .iter()
        .map(|(name, x, length)| format!("{name}0 = [{x}, 0.0, 0.1]\n{name}1 = [{x}, 0.0, {}]\n", 0.1 + length))
        .collect();
    let beams: String = arms.iter().map(|(name, ..)| arm(name)).collect();
    let text =
        format!("{STEEL}[sections.bar]\nshape = \"rectangle\"\nheight = 0.02\nwidth = 0.03\n[points]\n{points}{beams}");
    let model = read_deck(&format!("[analysis]\nkind = \"modal\"\n{text}"));
    let made = |index: usize| model.reductions[index].made.as_ref().expect("matrices");
    assert!(Arc::ptr_eq(&made(0).shapes, &made(1).shapes) && !Arc::ptr_eq(&made(0).shapes, &made(2).shapes));
    assert_eq!(made(1).matrices.nodes[..2], model.reductions[1].interface);
    let frequencies = frequencies(&text);
    // The longest arm is the softest; the other two bend with the same frequency.
    assert!((frequencies[1] / frequencies[2] - 1.0).abs() < 1e-9, "{frequencies:?}");
}
