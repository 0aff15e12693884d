//! Chains of bodies: time that grows with their number alone, whatever holds them together.

use crate::support::{read_deck, run_to_the_end};
use rdsolve::plan::Plan;
use rdsolve::solve::Counts;
use rdsolve::system::System;
use std::fmt::Write;

/// A chain that falls from the horizontal, its first body held: bodies that hang one on the other by `hold`.
fn chain(bodies: usize, scheme: &str, hold: impl Fn(usize) -> String) -> String {
    let mut deck = format!(
        "analysis = {{ kind = \"dynamic\", end_time = 0.1, time_step = 0.01 }}\nintegrator.scheme = \"{scheme}\"\n\
         environment.gravity = [0.0, 0.0, -9.81]\n[[supports]]\nat = \"b0\"\nfix = \"all\"\n"
    );
    for i in 0..bodies {
        let x = 0.1 * i as f64;
        let _ = write!(
            deck,
            "[[bodies]]\nname = \"b{i}\"\ncenter = [{x:?}, 0.0, 0.0]\nmass = 1.0\ninertia = [1e-3, 1e-3, 1e-3]\n"
        );
    }
    (1..bodies).for_each(|i| deck += &hold(i));
    deck
}

fn attached(method: &str) -> impl Fn(usize) -> String {
    move |i| {
        let before = i - 1;
        format!("[[attachments]]\nbody = \"b{before}\"\nnodes = \"b{i}\"\ndofs = [\"ux\", \"uy\", \"uz\"]\n{method}\n")
    }
}

fn jointed(i: usize) -> String {
    let before = i - 1;
    format!(
        "[[joints]]\nname = \"j{i}\"\nkind = \"spherical\"\nfrom = {{ body = \"b{before}\", point = [{:?}, 0.0, 0.0] }}\n\
         to = {{ body = \"b{i}\" }}\n",
        0.1 * i as f64
    )
}

/// Where the last body is at the end, and what the run took.
fn run(deck: &str) -> ([f64; 3], Counts, usize) {
    let model = read_deck(deck);
    let last = model.bodies.last().expect("a body").node;
    let done = run_to_the_end(&model, &mut |frame| frame.state.nodes[last].x.iter().copied().collect());
    let row = done.rows.last().expect("a row");
    (
        [row[0], row[1], row[2]],
        done.counts,
        model.constraints.dependents.iter().filter(|of| of.dofs != [true; 6]).count(),
    )
}

/// Short chains are eliminated, long ones held by multipliers; that is the same motion.
#[test]
fn long_chains_are_held_by_multipliers() {
    let [auto, told, joints] = [
        run(&chain(30, "newmark", attached(""))),
        run(&chain(30, "newmark", attached("method = \"multipliers\""))),
        run(&chain(30, "newmark", jointed)),
    ];
    assert_eq!((auto.2, told.2), (0, 0));
    assert_eq!(run(&chain(20, "newmark", attached(""))).2, 19);
    assert_eq!(run(&chain(30, "newmark", attached("method = \"elimination\""))).2, 29);
    for i in 0..3 {
        // The iteration ends at 1e-8 of the motion of a step, 0.05.
        assert!((auto.0[i] - told.0[i]).abs() < 1e-8 && (auto.0[i] - joints.0[i]).abs() < 1e-8, "{auto:?} {joints:?}");
    }
    // Explicit, by the sparse system of the 87 constraint equations, to the error of the implicit steps.
    let explicit = run(&chain(30, "runge-kutta", attached("")).replace("time_step = 0.01", "time_step = 1e-3"));
    let fine = run(&chain(30, "newmark", attached("")).replace("time_step = 0.01", "time_step = 1e-3"));
    for i in 0..3 {
        assert!((explicit.0[i] - fine.0[i]).abs() < 1e-4, "{explicit:?} {fine:?}");
        assert!(explicit.1.factorizations < 3, "no mass matrix is factorized in the steps: {explicit:?}");
    }
}

/// Iterations do not grow with the chain: gaps close at once, however smoothly they go over its length. Three thousand bodies took 2.5 times
/// as many as one hundred where a tenth of such gaps was left to the next iteration.
#[test]
fn iterations_do_not_grow_with_a_chain() {
    let [short, long] = [100, 3000].map(|bodies| run(&chain(bodies, "newmark", jointed)).1.iterations);
    // Steps of the falling end are as hard as they are: 5.4 for 4.4 a step.
    assert!(long as f64 <= 1.5 * short as f64, "{short} {long}");
}

/// Redundant equations are found beside a chain that is far too long for a search through all of its joints, and none without a loop.
#[test]
fn redundant_equations_are_found_beside_a_long_chain() {
    let redundant = |text: &str| {
        let model = read_deck(text);
        let system = System::new(&model).expect("a system");
        let rows = Plan::new(&model, &system, 1).redundant_constraints.expect("a search");
        let joint = |row: &usize| model.constraints.joints[system.row(*row).expect("a row").0].name.clone();
        rows.iter().map(joint).collect::<Vec<_>>()
    };
    let open = chain(800, "newmark", jointed);
    assert!(redundant(&open).is_empty());
    // A lid on the second body, on two hinges in line: the second one repeats what the first one holds.
    let mut lid =
        "[[bodies]]\nname = \"lid\"\ncenter = [0.1, 0.3, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n".to_owned();
    for (name, x) in [("first", 0.05), ("second", 0.15)] {
        lid += &format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [1.0, 0.0, 0.0]\nfrom = {{ body = \"b1\", point = [{x:?}, 0.1, 0.0] }}\n\
             to = {{ body = \"lid\", point = [{x:?}, 0.1, 0.0] }}\n"
        );
    }
    assert_eq!(redundant(&(open + &lid)), ["second"; 5]);
}
