//! Bearings by full matrices: motion in time beside the roots of a rigid rotor.

use crate::support::{node, read_deck, run_to_the_end};
use nalgebra::Complex;
use rdsolve::solve::Frame;

/// The rotor of decks/oil_whirl at some speed, which leaves its place with 1 mm/s, in time.
fn whirl(speed: f64, scheme: &str, time_step: f64) -> Vec<Vec<f64>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/decks/oil_whirl/deck.toml");
    let text = std::fs::read_to_string(path).expect("the deck");
    let scene =
        text.split_once("[[bodies]]").and_then(|(_, rest)| rest.split_once("# ---- expected")).expect("a scene").0;
    let scene = scene.replace("800.0, 0.0, 0.0]", &format!("{speed:?}, 0.0, 0.0]\nvelocity = [0.0, 1e-3, 0.0]"));
    let model = read_deck(&format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = {time_step:?}\n[integrator]\nscheme = \"{scheme}\"\n[output]\n\
         every = 1\n[[bodies]]{scene}"
    ));
    let at = node(&model, "rotor");
    let row = |frame: &Frame| {
        let x = frame.state.nodes[at].x;
        vec![frame.state.time, x.y, x.z]
    };
    run_to_the_end(&model, &mut { row }).rows
}

/// y + i z = Σ aᵢ exp(sᵢ t) with m s² + c s + k ± i q = 0, from the centre with a velocity along y. Motion grows above the threshold, in either sense
/// of the spin, as it fades below.
#[test]
fn a_rotor_whirls_in_its_film_as_its_roots_say() {
    for (speed, grows) in [(300.0_f64, false), (800.0, true), (-800.0, true)] {
        let (m, c, k, q) = (10.0, 200.0, 1e6, 100.0 * speed.abs());
        let inner = Complex::new(c * c - 4.0 * m * k, 4.0 * m * q).sqrt();
        let roots = [1.0, -1.0].map(|sign| (inner * sign - c) / (2.0 * m));
        assert_eq!(roots.iter().any(|s| s.re > 0.0), grows);
        let exact = |t: f64| ((roots[0] * t).exp() - (roots[1] * t).exp()) / (roots[0] - roots[1]) * 1e-3;
        for scheme in ["newmark", "central-difference"] {
            let off = [1e-4, 5e-5].map(|step| {
                let miss = |row: &Vec<f64>| (Complex::new(row[1], row[2]) - exact(row[0])).norm();
                whirl(speed, scheme, step).iter().map(miss).fold(0.0, f64::max) / 3e-6
            });
            println!("{speed} {scheme}: {off:?}");
            // (ω Δt)²/12 of 32 rad with ω Δt = 0.032, of second order.
            assert!(off[0] < 5e-3 && off[1] < 0.27 * off[0], "{speed} {scheme}: {off:?}");
        }
    }
}
