//! Runs that automatic steps make again: they are what they would be had they begun with the steps that they end with.

use crate::support::{self, Tables, read_deck, tables_of};
use std::collections::HashMap;
use std::fmt::Write;

/// A pendulum (1 kg at 1 m from its hinge, J = 0.5 about its centre) that is let go from rest, horizontal.
const PENDULUM: &str = r#"
[environment]
gravity = [0.0, 0.0, -9.81]
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 1.0
inertia = [0.5, 0.5, 0.5]
[[joints]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "bob", point = [0.0, 0.0, 0.0] }
"#;

/// A second arm on the first, with a spring and a damper in its hinge.
const SECOND_ARM: &str = r#"
[[bodies]]
name = "arm"
center = [2.5, 0.0, 0.0]
mass = 2.0
inertia = [0.1, 0.2, 0.2]
[[joints]]
name = "elbow"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { body = "bob", point = [2.0, 0.0, 0.0] }
to = { body = "arm", point = [2.0, 0.0, 0.0] }
stiffness = 20.0
damping = 0.5
"#;

/// A bushing that holds the bob back.
const BUSHING: &str = r#"
[[links]]
name = "rubber"
from = { ground = [1.0, 0.0, 0.0] }
to = { body = "bob" }
bushing = [30.0, 30.0, 30.0, 1.0, 1.0, 1.0]
bushing_damping = [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]
"#;

const OUTPUT: &str = "[output]\njoints = true\nreactions = true\nenergy = true\n[iteration]\ntolerance = 1e-10\n";

/// The scenes with a scheme of each kind of step.
fn scenes() -> Vec<(&'static str, String)> {
    vec![
        ("newmark", PENDULUM.to_owned()),
        ("generalized-alpha", PENDULUM.to_owned() + SECOND_ARM),
        ("wilson-theta", PENDULUM.to_owned() + BUSHING),
        ("bathe", PENDULUM.to_owned() + BUSHING + SECOND_ARM),
        ("runge-kutta", PENDULUM.to_owned() + SECOND_ARM),
    ]
}

fn deck(scheme: &str, scene: &str, steps: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.5\n{steps}[integrator]\nscheme = \"{scheme}\"\n{OUTPUT}{scene}"
    )
}

/// The largest difference of two tables in each column, relative to the largest number of its kind in the first; energies are of one kind.
fn largest_differences(of: &Tables, other: &Tables, file: &str) -> HashMap<String, f64> {
    let kind = |column: &str| match file {
        "energy.csv" => String::new(),
        _ => column.strip_suffix(['x', 'y', 'z', 'w']).unwrap_or(column).to_owned(),
    };
    let (rows, others) = (of.rows(file), other.rows(file));
    assert_eq!(rows.len(), others.len(), "{file}");
    let (mut sizes, mut apart) = (HashMap::new(), HashMap::new());
    for (row, other) in rows.iter().zip(&others) {
        assert_eq!(row.text("time"), other.text("time"), "{file}");
        for (column, value) in row.numbers().into_iter().filter(|(column, _)| *column != "step") {
            let size: &mut f64 = sizes.entry(kind(column)).or_default();
            *size = size.max(value.abs());
            let most: &mut f64 = apart.entry(column.to_owned()).or_default();
            *most = most.max((value - other.number(column)).abs());
        }
    }
    apart.iter_mut().for_each(|(column, apart)| *apart /= sizes[&kind(column)].max(1e-9));
    apart
}

/// A run of fixed steps with the same ends, which expected values dictate, shares nothing with the search. Both iterate to 1e-8 of the motion at
/// most in each of hundreds of steps, which rates and forces show a thousand times larger. What lives on is of the size of the forces.
#[test]
fn a_run_made_again_is_one_that_began_with_its_steps() {
    for (scheme, scene) in scenes() {
        let automatic = read_deck(&deck(scheme, &scene, "time_step = \"auto\"\nerror_tolerance = 1e-6\n"));
        let done = support::run_to_the_end(&automatic, &mut |frame| vec![frame.state.time]);
        let runs = done.step_error.expect("an error of steps").others;
        assert!(runs > 1 || scheme == "runge-kutta", "{scheme}: no run was made again, {runs}");
        let lengths = done.rows.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        let longest = 1.0001 * lengths.fold(0.0, f64::max);
        let mut given = deck(scheme, &scene, &format!("time_step = {longest:?}\n"));
        for time in done.rows.iter().skip(1) {
            let time = time[0];
            write!(
                given,
                "[[expect]]\nat = \"bob\"\nquantity = \"x\"\ntime = {time:?}\nvalue = 0.0\nabsolute_tolerance = 9.0\n"
            )
            .unwrap();
        }
        let [again, at_once] = [tables_of(&automatic), tables_of(&read_deck(&given))];
        for file in ["joints.csv", "bodies.csv", "energy.csv"] {
            for (column, apart) in largest_differences(&again, &at_once, file) {
                assert!(apart < 1e-3, "{scheme}: {column} of {file} is {apart:e} apart");
            }
        }
    }
}

/// At t = 0 the hinge carries m g − m a = 9.81 − 9.81/1.5 = 3.27 N, which pulls the ground down, whatever runs were made before.
#[test]
fn the_first_row_knows_nothing_of_runs_before() {
    for scheme in ["newmark", "wilson-theta", "generalized-alpha", "hht-alpha", "bathe", "esdirk3", "runge-kutta"] {
        let model = read_deck(&deck(scheme, PENDULUM, "time_step = \"auto\"\nerror_tolerance = 1e-6\n"));
        let tables = tables_of(&model);
        let first = &tables.rows("joints.csv")[0];
        let [fx, fz] = ["fx", "fz"].map(|column| first.number(column));
        assert!(fx.abs() < 1e-9 && (fz + 3.27).abs() < 1e-9, "{scheme}: {fx} {fz}");
    }
}

/// The hinge pulls the ground with m (g − a), a being that of the bob on its circle by the energy of its fall. Trial steps of another scheme, by
/// which automatic steps look ahead, had left their change of the multipliers to Wilson-θ: an offset of 2 % whatever error was asked for. The
/// error of forces is of the order of that asked for; a thousandth is the largest seen.
#[test]
fn trial_steps_leave_no_force_in_joints() {
    let free = PENDULUM.to_owned() + "[output]\njoints = true\n";
    for scheme in ["newmark", "wilson-theta", "generalized-alpha", "hht-alpha", "bathe", "esdirk3"] {
        let head = "[analysis]\nkind = \"dynamic\"\nend_time = 0.5\ntime_step = \"auto\"\nerror_tolerance = 1e-3\n";
        let tables = tables_of(&read_deck(&format!("{head}[integrator]\nscheme = \"{scheme}\"\n{free}")));
        let (joints, bodies) = (tables.rows("joints.csv"), tables.rows("bodies.csv"));
        let mut worst = 0.0_f64;
        for (joint, body) in joints.iter().zip(&bodies) {
            let (x, z) = (body.number("x"), body.number("z"));
            // m = 1, l = 1, J + m l² = 1.5: ω² = 2 g (−z)/1.5, and ω̇ = g x/1.5, downwards.
            let (omega2, alpha) = (2.0 * 9.81 * -z / 1.5, 9.81 * x / 1.5);
            let a = [alpha * z - omega2 * x, -alpha * x - omega2 * z];
            let force = [joint.number("fx") + a[0], joint.number("fz") + 9.81 + a[1]];
            worst = force.iter().fold(worst, |worst, off| worst.max(off.abs()));
        }
        println!("{scheme}: {worst:.1e} N");
        assert!(joints.len() > 10 && worst < 1e-3 * 9.81, "{scheme}: {worst} N off");
    }
}
