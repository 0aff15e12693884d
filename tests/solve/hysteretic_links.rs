//! Links that remember: cycles of a given motion, and a mass that is let go.

use crate::support::{node, read_deck, run_to_the_end};
use rdsolve::solve::Frame;
use std::f64::consts::TAU;

/// A point that moves by 5 mm sin 2πt beside the ground, joined to it by a link of 1 MN/m that yields at 2 kN.
fn cycles(law: &str) -> String {
    format!(
        "[analysis]\nkind = \"static\"\nend_time = 3.0\ntime_step = 0.005\n[output]\nevery = 1\nenergy = true\nlinks = true\n[points]\np = [1.0, 0.0, 0.0]\n\
         [[links]]\nname = \"damper\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\nstiffness = 1e6\nyield_force = 2e3\n\
         post_yield_stiffness = 1e5\n{law}\n[[supports]]\nat = \"p\"\nfix = [\"uy\", \"uz\"]\nmotion = {{ ux = {{ amplitude = \"way\", scale = 5e-3 }} }}\n\
         [amplitudes.way]\nkind = \"sine\"\nfrequency = 1.0\n"
    )
}

/// The rows [time, force, dissipated] of a deck.
fn rows(deck: &str) -> Vec<[f64; 3]> {
    let model = read_deck(deck);
    let row = |frame: &Frame| {
        vec![frame.state.time, frame.derived.links[0].force, frame.derived.energy.expect("energies").plastic]
    };
    run_to_the_end(&model, &mut { row }).rows.iter().map(|row| [row[0], row[1], row[2]]).collect()
}

/// Straight lines: a cycle dissipates 4 (1 − k₂/k) F_y (X − x_y), and its peak is F_y + k₂ (X − x_y).
#[test]
fn cycles_of_straight_lines_by_hand() {
    let found = rows(&cycles("law = \"yielding\""));
    let at = |time: f64| found.iter().find(|row| (row[0] - time).abs() < 1e-9).expect("a row");
    let cycle = 4.0 * 0.9 * 2e3 * (5e-3 - 2e-3);
    // Rounding: lines are followed exactly.
    assert!(((at(3.0)[2] - at(2.0)[2]) / cycle - 1.0).abs() < 1e-9, "{:?} {cycle}", at(3.0));
    assert!((at(2.25)[1] / (2e3 + 1e5 * 3e-3) - 1.0).abs() < 1e-9);
    assert!((at(2.75)[1] / (2e3 + 1e5 * 3e-3) + 1.0).abs() < 1e-9);
}

/// Isotropic hardening: the yield force grows by H = k k₂/(k − k₂) times the plastic path, in both senses. Each half cycle begins from the
/// peak before it.
#[test]
fn cycles_of_isotropic_hardening_by_hand() {
    let found = rows(&cycles("law = \"yielding\"\nhardening = \"isotropic\""));
    let at = |time: f64| found.iter().find(|row| (row[0] - time).abs() < 1e-9).expect("a row");
    let (k, H) = (1e6, 1e6 * 1e5 / 9e5);
    let (mut force, mut sense, mut dissipated, mut q) = (2e3, 1.0, 0.0, 0.0);
    let mut effort = 0.0;
    for (time, next) in [(0.25, 5e-3), (0.75, -5e-3), (1.25, 5e-3), (1.75, -5e-3), (2.25, 5e-3)] {
        // |F + k Δq| − k a = F_y + H a
        let path = (k * (next - q) * sense + effort * sense - force) / (k + H);
        dissipated += path * (force + 0.5 * H * path);
        force += H * path;
        (effort, q, sense) = (force * sense, next, -sense);
        assert!((at(time)[1] / effort - 1.0).abs() < 1e-9, "{:?} {effort}", at(time));
        assert!((at(time)[2] / dissipated - 1.0).abs() < 1e-9, "{:?} {dissipated}", at(time));
    }
}

/// The smooth law comes near the lines with a sharp knee; with n = 1 and b = ½ its loop has the force that exponentials give.
#[test]
fn cycles_of_the_smooth_law() {
    let sharp = rows(&cycles("law = \"bouc-wen\"\nexponent = 20.0"));
    let lines = rows(&cycles("law = \"yielding\""));
    let [sharp, lines] = [sharp, lines].map(|rows| rows.last().expect("rows")[2]);
    // A knee of n = 20 takes 1 % off the area.
    assert!((sharp / lines - 1.0).abs() < 0.02 && sharp < lines, "{sharp} {lines}");
    let found = rows(&cycles("law = \"bouc-wen\"\nexponent = 1.0"));
    let at = |time: f64| found.iter().find(|row| (row[0] - time).abs() < 1e-9).expect("a row");
    // First loading: z = x_y (1 − exp(−x/x_y)).
    let z = 2e-3 * (1.0 - (-2.5f64).exp());
    assert!((at(0.25)[1] / (1e5 * 5e-3 + 9e5 * z) - 1.0).abs() < 1e-7, "{:?}", at(0.25));
}

/// Deterioration over growing cycles has the forces of OpenSees 3.7.1, uniaxial material IMKBilin with 20,000 strains in each half cycle: there losses
/// follow the trapezoidal rule, and here they are exact in steps of any length.
#[test]
fn deterioration_is_that_of_opensees() {
    let ways = [0.0, 0.02, -0.02, 0.035, -0.035, 0.05, -0.05, 0.05, -0.05, 0.08, -0.08, 0.12, -0.12, 0.0];
    let points: Vec<String> = ways.iter().enumerate().map(|(k, way)| format!("[{k}.0, {way:?}]")).collect();
    let law = "law = \"ibarra-medina-krawinkler\"\ndeterioration = { capping = 0.03, post_capping = 0.2, residual = 0.1, strength = 0.6, softening = 0.6, unloading = 0.9 }";
    let deck = cycles(law)
        .replace("end_time = 3.0\ntime_step = 0.005", "end_time = 13.0\ntime_step = 0.25")
        .replace("kind = \"sine\"\nfrequency = 1.0", &format!("kind = \"table\"\npoints = [{}]", points.join(", ")))
        .replace("scale = 5e-3", "scale = 1.0")
        .replace(
            "stiffness = 1e6\nyield_force = 2e3\npost_yield_stiffness = 1e5",
            "stiffness = 1e3\nyield_force = 10.0\npost_yield_stiffness = 20.0",
        );
    let found = rows(&deck);
    let others = [
        10.2,
        -10.0332185,
        10.15516,
        -9.7002306,
        8.887897,
        -8.1474178,
        7.4396738,
        -6.726676,
        5.1845466,
        -4.0636564,
        2.5452082,
        -1.4442025,
        1.3632362,
    ];
    for (k, other) in others.iter().enumerate() {
        let [_, force, _] = found.iter().find(|row| (row[0] - (k + 1) as f64).abs() < 1e-9).expect("a row");
        // Its error of 5e-7 falls with its strains: it is 1e-2 with 100 of them, of a force of 10.
        assert!((force - other).abs() < 1e-6, "{force} {other}");
    }
}

/// A mass on a link that yields: what it loses is dissipated, and the motion is of second order in the step.
#[test]
fn a_mass_on_a_hysteretic_link() {
    for law in
        ["law = \"yielding\"", "law = \"bouc-wen\"", "law = \"bouc-wen\"\nstrength_loss = 0.02\nstiffness_loss = 0.01"]
    {
        let run = |scheme: &str, step: f64| {
            let deck = cycles(law)
                .replace("kind = \"static\"", "kind = \"dynamic\"")
                .replace("end_time = 3.0", "end_time = 0.5")
                .replace("time_step = 0.005", &format!("time_step = {step:?}\n[integrator]\nscheme = \"{scheme}\""))
                .replace(
                    "fix = [\"uy\", \"uz\"]\nmotion = { ux = { amplitude = \"way\", scale = 5e-3 } }",
                    "fix = [\"uy\", \"uz\"]",
                )
                .replace("[amplitudes.way]\nkind = \"sine\"\nfrequency = 1.0\n", "")
                + "[[masses]]\nat = \"p\"\nmass = 100.0\n[[initial]]\nat = \"p\"\nvelocity = [1.0, 0.0, 0.0]\n";
            let model = read_deck(&deck);
            let at = node(&model, "p");
            let row = |frame: &Frame| {
                let energy = frame.derived.energy.expect("energies");
                vec![frame.state.nodes[at].x.x, energy.mechanical + energy.plastic]
            };
            run_to_the_end(&model, &mut { row }).rows
        };
        let period = TAU / 100.0;
        for scheme in ["newmark", "central-difference"] {
            let [coarse, fine, finest] = [100, 200, 800].map(|n| run(scheme, period / f64::from(n)));
            let finest_end = finest.last().expect("rows").clone();
            let off = |rows: &[Vec<f64>], every: usize| {
                let pairs = rows.iter().zip(finest.iter().step_by(every)).take(rows.len() - 1);
                pairs.map(|(row, exact)| (row[0] - exact[0]).abs()).fold(0.0, f64::max)
            };
            let (a, b, finest) = (off(&coarse, 8), off(&fine, 4), finest_end);
            println!("{law} {scheme}: {a:e} {b:e}, energy {:e}", finest[1] / 50.0 - 1.0);
            // Of second order; where lines turn inside a step errors scatter with the place of the kink. Motions are of 1 cm.
            let order = if law.contains("yielding") { 1.0 } else { 0.5 };
            assert!(a < 2e-4 && b < order * a, "{law} {scheme}: {a} {b}");
            assert!((finest[1] / 50.0 - 1.0).abs() < 1e-4, "{law} {scheme}: {finest:?}");
        }
    }
}
