//! Modal damping: each mode fades by its own ratio, others stay, and what is lost is dissipated.

use crate::support::{node, read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// Two masses of 1 on two springs of 100 in a row, from rest with these velocities; after ω² = 100 (3 ∓ √5)/2.
fn chain(damping: &str, velocities: [f64; 2], scheme: &str, time_step: f64) -> String {
    let mass = |name: &str, v: f64| {
        format!(
            "[[masses]]\nat = \"{name}\"\nmass = 1.0\n[[initial]]\nat = \"{name}\"\nvelocity = [{v:?}, 0.0, 0.0]\n[[supports]]\nat = \"{name}\"\nfix = [\"uy\", \"uz\"]\n"
        )
    };
    let spring = |from: &str, to: &str| {
        format!(
            "[[links]]\nname = \"{to}_spring\"\nfrom = {{ {from} }}\nto = {{ node = \"{to}\" }}\ndirection = [1.0, 0.0, 0.0]\nstiffness = 100.0\n"
        )
    };
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = {time_step:?}\n[integrator]\nscheme = \"{scheme}\"\n[output]\nevery = 1\nenergy = true\n\
         [damping]\n{damping}\n[points]\na = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n{}{}{}{}",
        mass("a", velocities[0]),
        mass("b", velocities[1]),
        spring("ground = [0.0, 0.0, 0.0]", "a"),
        spring("node = \"a\"", "b")
    )
}

/// ω and φ of modal mass 1.
fn modes() -> [(f64, [f64; 2]); 2] {
    [-1.0, 1.0].map(|sign| {
        let square = 50.0 * (3.0 + sign * 5f64.sqrt());
        let shape = [1.0, 2.0 - square / 100.0];
        let size = (shape[0] * shape[0] + shape[1] * shape[1]).sqrt();
        (square.sqrt(), shape.map(|x| x / size))
    })
}

/// The displacements at a time, with q(0) = 0 in each mode.
fn exact(ratios: [f64; 2], velocities: [f64; 2], time: f64) -> [f64; 2] {
    let mut u = [0.0; 2];
    for ((omega, shape), ratio) in modes().into_iter().zip(ratios) {
        let speed = shape[0] * velocities[0] + shape[1] * velocities[1];
        let damped = omega * (1.0 - ratio * ratio).sqrt();
        let q = speed / damped * (-ratio * omega * time).exp() * (damped * time).sin();
        u = [u[0] + q * shape[0], u[1] + q * shape[1]];
    }
    u
}

/// Rows [time, displacements, energy that is left or dissipated].
fn rows(deck: &str) -> Vec<Vec<f64>> {
    let model = read_deck(deck);
    let at = ["a", "b"].map(|name| (node(&model, name), if name == "a" { 1.0 } else { 2.0 }));
    let row = |frame: &Frame| {
        let energy = frame.derived.energy.expect("energies");
        let [a, b] = at.map(|(node, x)| frame.state.nodes[node].x.x - x);
        vec![frame.state.time, a, b, energy.mechanical + energy.damping]
    };
    run_to_the_end(&model, &mut { row }).rows
}

#[test]
fn each_mode_fades_by_its_ratio() {
    let velocities = [0.3, 1.0];
    for (damping, ratios) in [
        ("modal = { ratio = 0.05, modes = 2 }", [0.05, 0.05]),
        ("modal = { ratios = [0.02, 0.2] }", [0.02, 0.2]),
        ("modal = { ratio = 0.1, modes = 1 }", [0.1, 0.0]),
    ] {
        for scheme in ["newmark", "generalized-alpha", "bathe"] {
            let off = [4e-3, 2e-3].map(|step| {
                let found = rows(&chain(damping, velocities, scheme, step));
                let energy = found[0][3];
                let last = found.last().expect("rows");
                // The damping power by the trapezoidal rule: (ω Δt)²/12 of it.
                assert!((last[3] / energy - 1.0).abs() < 1e-3, "{damping} {scheme}: {last:?} {energy}");
                let miss = |row: &Vec<f64>| {
                    let [a, b] = exact(ratios, velocities, row[0]);
                    (row[1] - a).abs().max((row[2] - b).abs())
                };
                found.iter().map(miss).fold(0.0, f64::max)
            });
            println!("{damping} {scheme}: {off:?}");
            // Of second order: ω t (ω Δt)²/12 of the amplitude of 0.05 in the higher mode.
            assert!(off[0] < 3e-4 && off[1] < 0.3 * off[0], "{damping} {scheme}: {off:?}");
        }
    }
}

/// A run with more modes than there are warns, and damps them all.
#[test]
fn modes_that_are_not_there() {
    let deck =
        |modes: usize| chain(&format!("modal = {{ ratio = 0.05, modes = {modes} }}"), [0.3, 1.0], "newmark", 4e-3);
    let model = read_deck(&deck(7));
    let nothing = |_: &Frame| vec![];
    let done = run_to_the_end(&model, &mut { nothing });
    assert!(done.warnings.iter().any(|warning| warning.contains("asks for 7 modes")), "{:?}", done.warnings);
    assert_eq!(rows(&deck(7)), rows(&deck(2)));
}
