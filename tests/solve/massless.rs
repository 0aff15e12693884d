//! Nodes without mass in dynamics: held in every direction they follow what holds them, and where nothing holds them the run says so,
//! whatever axes that direction lies oblique to.

use crate::support::{Tables, read_deck};
use rdsolve::output::{Files, wanted};
use rdsolve::plan::Plan;
use rdsolve::solve::{Failure, Outcome, Run};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

const SCHEMES: [&str; 5] = ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe"];

fn run(deck: &str, scheme: &str) -> (Outcome, Tables) {
    run_to(0.05, deck, scheme)
}

fn run_to(end: f64, deck: &str, scheme: &str) -> (Outcome, Tables) {
    let model = read_deck(&format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end}\ntime_step = 1e-3\n[integrator]\nscheme = \"{scheme}\"\n{deck}"
    ));
    let (system, stop) = (System::new(&model).expect("a system"), AtomicBool::new(false));
    let (plan, folder) = (Plan::new(&model, &system, 1), tempfile::tempdir().unwrap());
    let mut files = Files::open(folder.path(), &model).unwrap();
    let (outcome, _) = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap().run(&mut files);
    files.finish().unwrap();
    (outcome, Tables::of(folder))
}

const BODY: &str = "[[bodies]]\nname = \"block\"\ncenter = [3.1, 3.3, 3.7]\nmass = 1.0\ninertia = [0.1, 0.2, 0.3]\n\
                    velocity = [0.1, 0.2, 0.3]\nangular_velocity = [0.3, 0.1, -0.2]\n";

fn spring(name: &str, from: &str, to: &str, law: &str) -> String {
    format!("[[links]]\nname = \"{name}\"\nfrom = {{ {from} }}\nto = {{ {to} }}\n{law}\n")
}

/// The node and the direction that a run names at its start.
fn refused(deck: &str, scheme: &str) -> (String, [f64; 3]) {
    match run(deck, scheme).0 {
        Outcome::Failed { time, failure: Failure::MasslessDirection { label, direction, .. } } => {
            assert_eq!(time, 0.0);
            (label, direction)
        }
        outcome => panic!("{scheme}: {outcome:?}\n{deck}"),
    }
}

/// A spring, or a damper, alone: to the ground, to a body that moves and turns, with a load and without one. Nothing holds the node
/// across it.
#[test]
fn a_node_at_the_end_of_a_link_is_refused_across_it() {
    let place = [0.6, -1.1, 0.35];
    let point = format!("[points]\nfree = {place:?}\n");
    let load = "[[loads]]\nat = \"free\"\nforce = [0.4, 0.2, -1.0]\n";
    for scheme in SCHEMES {
        for law in ["stiffness = 1e3", "damping = 10.0", "stiffness = 1e6\ndamping = 3.0"] {
            for (from, end) in
                [("ground = [0.3, 0.1, 0.0]", [0.3, 0.1, 0.0]), ("body = \"block\", point = [3.0, 3.0, 3.0]", [3.0; 3])]
            {
                for load in ["", load] {
                    let deck = format!("{BODY}{point}{}{load}", spring("s", from, "node = \"free\"", law));
                    let (label, direction) = refused(&deck, scheme);
                    let along: f64 = (0..3).map(|i| direction[i] * (place[i] - end[i])).sum();
                    // The least eigenvector of a matrix of rank one, beside entries of 1e6.
                    assert!(label == "free" && along.abs() < 1e-6, "{scheme} {law} {direction:?}");
                }
            }
        }
    }
}

/// Chains of nodes without mass, in line or not, between grounds and bodies: across the line, or out of the plane of two links.
#[test]
fn chains_without_mass_are_refused_out_of_their_plane() {
    let stiff = "stiffness = 1e3";
    let points = "[points]\na = [0.7, 0.2, 0.4]\nb = [1.9, 1.1, 0.3]\n";
    let first = spring("s1", "ground = [0.0, 0.0, 0.0]", "node = \"a\"", stiff);
    let second = spring("s2", "node = \"a\"", "node = \"b\"", stiff);
    let third = spring("s3", "node = \"b\"", "body = \"block\", point = [3.0, 3.0, 3.0]", "damping = 20.0");
    let (label, _) = refused(&format!("{BODY}{points}{first}{second}{third}"), "newmark");
    assert!(label == "a" || label == "b");
    // In line, halfway to a body.
    let point = "[points]\na = [1.5, 1.5, 1.5]\n";
    let to_body = spring("s2", "node = \"a\"", "body = \"block\", point = [3.0, 3.0, 3.0]", stiff);
    let (label, direction) = refused(&format!("{BODY}{point}{first}{to_body}"), "wilson-theta");
    assert!(label == "a" && direction.iter().sum::<f64>().abs() < 1e-6, "{direction:?}");
    // Each node is held in all directions, but not both of them together: two that move alike.
    let held = |name: &str, node: &str, ground: [f64; 3]| {
        spring(name, &format!("ground = {ground:?}"), &format!("node = \"{node}\""), stiff)
    };
    let pair = format!(
        "[points]\na = [0.0, 0.0, 0.0]\nb = [0.8, 0.0, 0.6]\n{}{}{}{}{}",
        held("a1", "a", [-0.6, 1.0, 0.8]),
        held("a2", "a", [-0.6, -1.0, 0.8]),
        held("b1", "b", [0.2, 1.0, 1.4]),
        held("b2", "b", [0.2, -1.0, 1.4]),
        spring("between", "node = \"a\"", "node = \"b\"", stiff)
    );
    let (_, direction) = refused(&format!("{BODY}{pair}"), "newmark");
    assert!((direction[0].abs() - 0.8).abs() < 1e-6 && (direction[2].abs() - 0.6).abs() < 1e-6, "{direction:?}");
}

/// Held by three springs and dampers that are oblique to the axes, a node follows its load: c v + k u = f with small motions, a decay
/// time c/k of a thousandth of a step, from u = 0 and v = 0. Newmark's rule keeps what the first step leaves, 2 c/(k Δt) of the load, and
/// takes it to the other side with each step, smaller by (1 − 2 c/(k Δt))/(1 + 2 c/(k Δt)); the others damp it, hht-alpha
/// by a tenth in a step.
#[test]
fn a_node_that_is_held_follows_its_load() {
    let grounds = [[1.0, 0.2, 0.1], [-0.3, 1.0, 0.2], [0.2, -0.4, 1.0]];
    let springs: String = (0..3)
        .map(|i| {
            let ground = format!("ground = {:?}", grounds[i]);
            spring(&format!("s{i}"), &ground, "node = \"held\"", "stiffness = 1e3\ndamping = 1e-3")
        })
        .collect();
    let load = "[[loads]]\nat = \"held\"\nforce = [1e-3, 2e-3, -1e-3]\n";
    for scheme in SCHEMES {
        let (outcome, tables) =
            run_to(0.2, &format!("{BODY}[points]\nheld = [0.0, 0.0, 0.0]\n{springs}{load}"), scheme);
        assert!(matches!(outcome, Outcome::Done), "{scheme}: {outcome:?}");
        let rows = tables.rows("nodes.csv");
        let u = ["ux", "uy", "uz"].map(|name| rows.last().unwrap().number(name));
        let mut f = [0.0; 3];
        for ground in grounds {
            let length = ground.iter().map(|x| x * x).sum::<f64>().sqrt();
            let n = ground.map(|x| x / length);
            let pull: f64 = (0..3).map(|i| n[i] * u[i]).sum();
            (0..3).for_each(|i| f[i] += 1e3 * pull * n[i]);
        }
        let ratio: f64 = 2.0 * 1e-6 / 1e-3;
        let ringing = match scheme {
            "newmark" => ratio / (1.0 + ratio) * (-(1.0 - ratio) / (1.0 + ratio)).powi(199),
            _ => 0.0,
        };
        // Displacements of 3e-6 turn springs of length 1 by as much.
        let error = f.iter().zip([1e-3, 2e-3, -1e-3]).map(|(a, b)| (a - b * (1.0 - ringing)).abs()).fold(0.0, f64::max);
        assert!(error < 2e-5 * 2e-3, "{scheme}: {f:?}");
    }
}

/// A chain that is pulled holds its middle across; pushed together it does not, and the run ends when that comes about.
#[test]
fn a_chain_is_held_while_it_is_pulled() {
    let chain = |velocity: &str| {
        format!(
            "[[bodies]]\nname = \"block\"\ncenter = [1.2, 1.6, 0.0]\nmass = 10.0\ninertia = [1.0, 1.0, 1.0]\n{velocity}\n\
             [points]\nmiddle = [0.6, 0.8, 0.0]\nend = [1.2, 1.6, 0.0]\n\
             [[attachments]]\nbody = \"block\"\nnodes = [\"end\"]\n\
             {}{}",
            spring("s1", "ground = [0.0, 0.0, 0.0]", "node = \"middle\"", "stiffness = 1e3\nfree_length = 0.99"),
            spring("s2", "node = \"middle\"", "node = \"end\"", "stiffness = 1e3\nfree_length = 0.99")
        )
    };
    let (outcome, _) = run(&chain("velocity = [0.06, 0.08, 0.02]"), "newmark");
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    let (outcome, _) = run(&chain("velocity = [-0.6, -0.8, 0.0]"), "newmark");
    let Outcome::Failed { time, failure: Failure::MasslessDirection { label, .. } } = &outcome else {
        panic!("{outcome:?}")
    };
    // Both springs are slack when the body has come 20 mm, at 1 m/s.
    assert!(label == "middle" && (time - 0.02).abs() < 1e-3, "{time}");
}

/// A damper holds along its line, and supports across it: the motion is that of its load, v = f/c, but for what the first step takes from
/// v = 0, half of it or less.
#[test]
fn a_node_on_a_damper_is_held_by_supports_across_it() {
    let damper = spring("d", "ground = [0.0, 0.0, 0.0]", "node = \"free\"", "damping = 10.0");
    let held = "[points]\nfree = [1.0, 0.0, 0.0]\n[[supports]]\nat = \"free\"\nfix = [\"uy\", \"uz\"]\n";
    for scheme in SCHEMES {
        let deck = format!("{BODY}{held}{damper}[[loads]]\nat = \"free\"\nforce = [0.4, 0.0, 0.0]\n");
        let (outcome, tables) = run(&deck, scheme);
        assert!(matches!(outcome, Outcome::Done), "{scheme}: {outcome:?}");
        let rows = tables.rows("nodes.csv");
        let u = rows.last().unwrap().number("ux");
        assert!((u - 0.04 * 0.05).abs() <= 0.04 * 1e-3, "{scheme}: {u}");
        let (label, direction) = refused(&deck.replace("\"uy\", ", ""), scheme);
        assert!(label == "free" && direction[1].abs() == 1.0, "{scheme}: {direction:?}");
    }
}
