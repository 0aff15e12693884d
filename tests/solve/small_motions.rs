//! Motions of micrometres that start at once: light nodes ring as no step resolves, and the iteration is not led astray by them.

use crate::support::{read_deck, run};
use rdsolve::math::rotation;
use rdsolve::solve::Outcome;

/// A clamped beam whose other end moves off at once, or along a table with kinks; with damping in its material the nodes near the end,
/// whose rotary inertia is small, have angular accelerations of 1e10 rad/s² at a millimetre a second.
fn beam(scheme: &str, dt: f64, motion: &str, damping: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {}\ntime_step = {dt}\n[integrator]\nscheme = \"{scheme}\"\n\
         [materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0\n\
         [sections.square]\nshape = \"rectangle\"\nwidth = 0.01\nheight = 0.01\n\
         [points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
         [[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nelements = 6\nmaterial = \"steel\"\nsection = \"square\"\n\
         orientation = [0.0, 1.0, 0.0]\n\
         [[supports]]\nat = \"a\"\nfix = \"all\"\n[damping]\nstiffness_factor = {damping}\n\
         [[supports]]\nat = \"b\"\nmotion = {{ uz = {{ amplitude = \"drive\", {motion} }} }}\n\
         [amplitudes.drive]\nkind = \"table\"\npoints = [[0.0, 1.0], [{}, 1.0], [{}, 2.0], [{}, 0.5], [{}, 0.5]]\n",
        40.0 * dt,
        7.0 * dt,
        11.5 * dt,
        20.0 * dt,
        50.0 * dt,
    )
}

/// Runs a deck; no step is cut, and no node turns by more than ten times what the end moves over the length of an element.
fn check(deck: &str, stages: usize, at: &str) {
    let mut largest = [0.0f64; 2];
    let done = run(&read_deck(deck), &mut |frame| {
        for node in &frame.state.nodes {
            largest[0] = largest[0].max(node.x.z.abs());
            largest[1] = largest[1].max(rotation::log(&node.rotation).norm());
        }
        Vec::new()
    });
    assert!(matches!(done.outcome, Outcome::Done), "{at}: {:?}", done.outcome);
    assert_eq!(done.counts.cuts, 0, "{at}");
    // What schemes make of accelerations that no step resolves stays below a thousandth in the first step.
    assert!(largest[1] <= 10.0 * largest[0] * 6.0 + 2e-3, "{at}: {largest:?}");
    // Motions are that small that the scene is nearly linear; rounding takes some iterations, for Newmark's rule damps nothing.
    assert!(done.counts.iterations <= 6 * stages * done.counts.steps, "{at}: {:?}", done.counts);
}

const SCHEMES: [(&str, usize); 6] =
    [("wilson-theta", 1), ("newmark", 1), ("hht-alpha", 1), ("generalized-alpha", 1), ("bathe", 2), ("esdirk3", 3)];

#[test]
fn micrometres_need_no_cuts() {
    for (scheme, stages) in SCHEMES {
        for dt in [1e-5, 1e-4, 1e-3] {
            for velocity in [1e-6, 1e-3] {
                for damping in [1e-3, 0.1] {
                    let motion = format!("history = \"velocity\", scale = {velocity:e}");
                    let at = format!("{scheme}, {dt} s, {velocity} m/s, {damping} s");
                    check(&beam(scheme, dt, &motion, damping), stages, &at);
                }
            }
        }
    }
}

/// Other ways to begin at once: a support that turns, pins at the other end, a load, an initial velocity, a metre a second.
#[test]
fn other_motions_that_begin_at_once_need_no_cuts() {
    for (scheme, stages) in SCHEMES {
        let motion = |scale: &str| format!("history = \"velocity\", scale = {scale}");
        let driven = beam(scheme, 1e-3, &motion("1e-3"), 0.1);
        let free = &driven[..driven.find("[[supports]]\nat = \"b\"").unwrap()];
        let cases = [
            ("turned", driven.replace("uz =", "ry =")),
            ("pinned", driven.replace("fix = \"all\"", "fix = [\"ux\", \"uy\", \"uz\"]")),
            ("loaded", format!("{free}[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, 1e-4]\n")),
            ("struck", format!("{free}[[initial]]\nat = \"b\"\nvelocity = [0.0, 0.0, 1e-3]\n")),
            ("fast", beam(scheme, 1e-3, &motion("1.0"), 0.1)),
        ];
        for (name, deck) in cases {
            let done = run(&read_deck(&deck), &mut |_| Vec::new());
            assert!(matches!(done.outcome, Outcome::Done), "{scheme}, {name}: {:?}", done.outcome);
            assert!(
                done.counts.cuts == 0 && done.counts.iterations <= 7 * stages * done.counts.steps,
                "{scheme}, {name}: {:?}",
                done.counts
            );
        }
    }
}

/// Where steps resolve it, a large acceleration at t = 0 stays what it is: a body under a moment that turns it by 0.02 rad in the first
/// step, exactly by the trapezoidal rule, beside a damper that makes the scene a damped one.
#[test]
fn accelerations_that_steps_resolve_are_kept() {
    let deck = "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = 0.01\n[integrator]\nscheme = \"newmark\"\n\
                [[bodies]]\nname = \"wheel\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                [[bodies]]\nname = \"other\"\ncenter = [2.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                [[links]]\nname = \"damper\"\nfrom = { ground = [1.0, 0.0, 0.0] }\nto = { body = \"other\" }\ndamping = 1.0\n\
                [[loads]]\nat = \"wheel\"\nmoment = [0.0, 0.0, 400.0]\n";
    let model = read_deck(deck);
    let done = run(&model, &mut |frame| vec![rotation::log(&frame.state.nodes[0].rotation).z]);
    let angle = done.rows.last().expect("a row")[0];
    // ½ α t² of a constant acceleration is exact to rounding.
    assert!((angle - 0.5 * 400.0 * 0.01).abs() < 1e-12, "{angle}");
}
