//! Modes against the motion that they are of: a scene set in motion by the shape of a mode swings at its frequency.

use super::modes;
use crate::support::{node, read_deck, run_to_the_end};
use std::f64::consts::TAU;

/// A body on an arm beyond a cantilever under gravity-free tension from a taut rope, at rest at t = 0.
fn deck(analysis: &str, velocity: &str) -> String {
    format!(
        "[analysis]\n{analysis}\n[integrator]\nscheme = \"newmark\"\n[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\n\
         poisson_ratio = 0.3\ndensity = 7850.0\n[sections.s]\nshape = \"rectangle\"\nwidth = 0.03\nheight = 0.02\n[points]\n\
         a = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.2, 0.0, 0.6]\nd = [1.2, 0.0, 2.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\n\
         elements = 2\nmaterial = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"box\"\n\
         center = [1.2, 0.1, 0.0]\nmass = 20.0\ninertia = [0.4, 0.3, 0.5]\n{velocity}\n[[attachments]]\nbody = \"box\"\nnodes = [\"b\", \"c\"]\n\
         [[links]]\nname = \"spring\"\nfrom = {{ node = \"c\" }}\nto = {{ node = \"d\" }}\nlaw = \"linear\"\nstiffness = 3e3\n\
         [[supports]]\nat = [\"a\", \"d\"]\nfix = \"all\"\n"
    )
}

/// The times at which a mode's motion passes zero tell its frequency: with 400 steps a period the trapezoidal rule is (ω Δt)²/12 =
/// 2e-5 slow, which is taken off; the amplitude of 1e-5, in which modes begin to mix, leaves 3e-6 in the fourth.
#[test]
fn shapes_swing_at_their_frequencies() {
    let text = deck("kind = \"modal\"\nmodes = 4", "");
    let body = node(&read_deck(&text), "box");
    for (number, mode) in modes(&text).list.iter().enumerate() {
        let (shape, period) = (mode.shape[body], 1.0 / mode.frequency());
        let size = 1e-5 * mode.angular_frequency();
        let vector =
            |at: usize| format!("[{:?}, {:?}, {:?}]", size * shape[at], size * shape[at + 1], size * shape[at + 2]);
        let dynamic = format!("kind = \"dynamic\"\nend_time = {:?}\ntime_step = {:?}", 4.3 * period, period / 400.0);
        let model = read_deck(&deck(&dynamic, &format!("velocity = {}\nangular_velocity = {}", vector(0), vector(3))));
        let (largest, start) = (shape.iamax(), model.nodes[body].x);
        let done = run_to_the_end(&model, &mut |frame| {
            let now = &frame.state.nodes[body];
            let turned = rdsolve::math::rotation::log(&now.rotation);
            let moved = now.moved(&start);
            vec![frame.state.time, if largest < 3 { moved[largest] } else { turned[largest - 3] }]
        });
        let crossings: Vec<f64> = done
            .rows
            .windows(2)
            .filter(|pair| pair[0][1] != 0.0 && pair[0][1] * pair[1][1] <= 0.0)
            .map(|pair| pair[0][0] - pair[0][1] * (pair[1][0] - pair[0][0]) / (pair[1][1] - pair[0][1]))
            .collect();
        let found = 2.0 * (crossings[7] - crossings[1]) / 6.0;
        let exact = period * (1.0 + (TAU / 400.0).powi(2) / 12.0);
        println!("mode {}: period {found} of {exact}", number + 1);
        assert!((found / exact - 1.0).abs() < 1e-5, "mode {}: {found} {exact}", number + 1);
    }
}
