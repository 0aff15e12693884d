//! Masses that are off their node, held or missing.

use super::scenes::dynamic;
use super::{CENTRAL, EIGHT, WILSON, balance_of, deck, difference, scene};
use crate::support::{node, position, read_stages, run_source, run_to_the_end};
use rdsolve::diagnostic::{Diagnostic, Source};
use rdsolve::model::Model;
use rdsolve::plan::Plan;
use rdsolve::system::System;

/// Directions without mass have no equation: each is named.
#[test]
fn massless_directions_are_named() {
    let sets = [CENTRAL, "beams.legs.elements=1", "beams.legs.order=1", "beams.legs.rotary_inertia=false"];
    let model = deck("right_angle_cantilever", &sets);
    let system = System::new(&model).unwrap();
    let plan = Plan::new(&model, &system, 1);
    let problems = plan.massless(&model, &system);
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(problems[0].message.contains("`elbow` has no mass in direction rx"), "{problems:?}");
    // Each at the name of its point; a node between them at that of the beam.
    let text = std::fs::read_to_string("decks/right_angle_cantilever/deck.toml").unwrap();
    let places = |problems: &[Diagnostic]| -> Vec<String> {
        problems.iter().map(|problem| text[problem.place.clone().expect("a place")].to_owned()).collect()
    };
    assert_eq!(places(&problems), ["elbow", "tip"]);
    let finer = deck("right_angle_cantilever", &[&sets[..1], &["beams.legs.elements=2"], &sets[2..]].concat());
    let system = System::new(&finer).unwrap();
    let inner = places(&Plan::new(&finer, &system, 1).massless(&finer, &system));
    assert!(inner.contains(&"\"legs\"".to_owned()), "{inner:?}");
    let system = System::new(&model).unwrap();
    let text = rdsolve::plan::explain::explain(&plan, &model, &system).to_string();
    assert!(text.contains("nothing is factorized"), "{text}");
}

/// A mass on an arm of a body that does not turn: what holds it bears m s a, here 2 · 1 · 3/(1 + 2).
#[test]
fn held_rotations_bear_what_is_off_the_node() {
    let text = dynamic("1.0", "0.01", "wilson-theta")
        + r#"[points]
q = [0.0, 0.0, 1.0]

[[bodies]]
name = "b"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.1, 0.1]

[[masses]]
at = "q"
mass = 2.0

[[attachments]]
body = "b"
nodes = "q"

[[supports]]
at = "b"
fix = ["uy", "uz", "rx", "ry", "rz"]

[[loads]]
at = "b"
force = [3.0, 0.0, 0.0]

[output]
interval = 0.5
reactions = true
"#;
    for scheme in [WILSON, CENTRAL, EIGHT] {
        let model = scene(&text, &[scheme]);
        let moment = model.constraints.restraints.iter().position(|held| held.dof == 4).unwrap();
        let done = run_to_the_end(&model, &mut |frame| vec![frame.reactions[moment]]);
        // Rounding.
        assert!(done.rows.iter().all(|row| (row[0] - 2.0).abs() < 1e-12), "{scheme}: {:?}", done.rows);
    }
}

/// Two bars of a mechanism that are held in their plane, hung by ball joints: rows that pull across it have nothing to move.
#[test]
fn joints_that_pull_at_held_directions_only() {
    let text = dynamic("1.0", "0.001", "wilson-theta")
        + r#"[points]
q = [3.0, 0.5, 0.0]

[[bodies]]
name = "a"
center = [0.5, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.1, 0.1]

[[bodies]]
name = "b"
center = [1.5, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.1, 0.1]

[[masses]]
at = "q"
mass = 1.0

[[supports]]
at = ["a", "b"]
fix = ["uy", "rx", "rz"]

[[joints]]
name = "j1"
kind = "ball"
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "a", point = [0.0, 0.0, 0.0] }

[[joints]]
name = "j2"
kind = "ball"
from = { body = "a", point = [1.0, 0.0, 0.0] }
to = { body = "b", point = [1.0, 0.0, 0.0] }

[environment]
gravity = [0.0, -1.0, -9.81]

[output]
interval = 0.1
"#;
    let run = |sets: &[&str]| {
        let model = scene(&text, sets);
        let at = ["a", "b"].map(|name| node(&model, name));
        run_to_the_end(&model, &mut |frame| at.map(|n| position(&frame.state.nodes[n])).concat()).rows
    };
    // Order 8 at a hundredth of a swing is exact here.
    let exact = run(&[EIGHT, "analysis.time_step=0.01"]);
    for scheme in [WILSON, CENTRAL] {
        let off = difference(&run(&[scheme]), &exact);
        println!("{scheme}: {off:.2e}");
        // Of second order, 0.01 rad a step.
        assert!(off < 1e-4, "{off}");
    }
}

/// A top of Brüls & Cardona (2010): the mass may be given at its pivot, or at the end of an arm.
#[test]
fn a_top_turns_about_its_pivot_wherever_its_mass_is_given() {
    let ends = [
        ("mass = 15.0", "[15.234375, 0.46875, 15.234375]", ""),
        ("mass = 1e-9", "[0.234375, 0.46875, 0.234375]", "[[masses]]\nat = \"centre_of_mass\"\nmass = 15.0\n"),
    ]
    .map(|(mass, inertia, more)| {
        let head = dynamic("2.0", "1e-3", "central-difference");
        let text = format!(
            r#"{head}[points]
centre_of_mass = [0.0, 1.0, 0.0]
[[bodies]]
name = "top"
center = [0.0, 0.0, 0.0]
{mass}
inertia = {inertia}
angular_velocity = [0.0, 150.0, -4.61538]
[[attachments]]
body = "top"
nodes = "centre_of_mass"
[[supports]]
at = "top"
fix = ["ux", "uy", "uz"]
[[loads]]
at = "centre_of_mass"
force = [0.0, 0.0, -147.15]
{more}
[output]
interval = 0.1
"#
        );
        let model = scene(&text, &[]);
        let at = node(&model, "centre_of_mass");
        let done = run_to_the_end(&model, &mut |frame| {
            let mut row = position(&frame.state.nodes[at]).to_vec();
            // Forces on the pivot over the weight.
            row.extend(frame.reactions.iter().map(|force| force / 147.15));
            row
        });
        // On a guide all rotations are free and one translation is.
        let guided = scene(
            &text.replace("\"uy\", \"uz\"]", "\"uy\"]").replace("-147.15", "0.0"),
            &["analysis.time_step=2e-3", "analysis.end_time=20.0"],
        );
        (done.rows, balance_of(&guided))
    });
    let [(centred, _), (held, guided)] = ends;
    let off = difference(&held, &centred);
    println!("{off:.1e}, on a guide made {:.1e} of {:.1e}", guided.generated, guided.available);
    // Rounding of 2000 steps of 0.15 rad, and a mass of 1e-9 beside 15.
    assert!(off < 1e-8, "{off}");
    // At 0.3 rad a step, of second order; moments that met the predicted velocities alone made two thousand times what there was.
    assert!(guided.generated < 0.05 * guided.available, "{guided:?}");
}

/// Stages with other schemes have the masses of the stage with central differences, whichever comes first: its critical step is that of a deck without
/// them, and no kinetic energy appears as one stage follows the other.
#[test]
fn all_dynamic_stages_have_the_masses_of_central_differences() {
    let plate = |head: &str| {
        let corners = "a = [0.0, 0.0, 0.0]\nb = [0.4, 0.0, 0.0]\nc = [0.4, 0.4, 0.0]\nd = [0.0, 0.4, 0.0]\n";
        format!(
            "{head}[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0\n[points]\n{corners}\
             [[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [4, 4]\nthickness = 0.001\nmaterial = \"steel\"\n\
             [[initial]]\nat = \"plate\"\nangular_velocity = [0.0, 3.0, 0.0]\n"
        )
    };
    let of = |model: &Model| System::new(model).unwrap().mass_scaling().map(|scaling| scaling.critical_step);
    let alone = of(&scene(&plate(&dynamic("1e-3", "\"auto\"", "central-difference")), &[])).expect("raised inertia");
    let stage =
        |name: &str, of: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = 1e-3\n{of}\n");
    let fall = stage("fall", "time_step = 1e-4\nintegrator = { scheme = \"newmark\" }");
    for key in ["", ", mass_scaling_step = 1e-5"] {
        let blow =
            stage("blow", &format!("time_step = \"auto\"\nintegrator = {{ scheme = \"central-difference\"{key} }}"));
        for stages in [fall.clone() + &blow, blow.clone() + &fall] {
            let source = Source::new("plate.toml", plate(&stages), &[]);
            let steps: Vec<Option<f64>> = read_stages(&source).iter().map(of).collect();
            assert_eq!(steps, [Some(if key.is_empty() { alone } else { 1e-5 }); 2], "{key}");
            let done = run_source(&source, &mut |frame| {
                vec![frame.state.time, frame.derived.energy.expect("energies").kinetic]
            });
            let at_boundary: Vec<f64> =
                done.rows.iter().filter(|row| (row[0] - 1e-3).abs() < 1e-9).map(|row| row[1]).collect();
            let [before, after] = at_boundary[..] else { panic!("{at_boundary:?}") };
            assert!((before - after).abs() < 1e-12 * before, "{before} {after}");
        }
    }
}
