//! Dampers whose force is a power of the rate: cycles of a given motion, and a mass that one brakes.

use crate::support::{node, read_deck, run_to_the_end};
use rdsolve::solve::Frame;
use std::f64::consts::TAU;

/// A damper of 3 kN at 1 m/s between the ground and a point, along x.
fn deck(analysis: &str, damping: &str, rest: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\n{analysis}\n[output]\nevery = 1\nenergy = true\nlinks = true\n[points]\np = [1.0, 0.0, 0.0]\n\
         [[links]]\nname = \"damper\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\ndirection = [1.0, 0.0, 0.0]\n\
         damping = {{ viscous = 3e3, {damping} }}\n[[supports]]\nat = \"p\"\n{rest}\n"
    )
}

/// A cycle X sin Ωt dissipates 4·2ᵃ Γ²(1 + a/2)/Γ(2 + a) c X¹⁺ᵃ Ωᵃ.
#[test]
fn cycles_dissipate_what_the_closed_form_says() {
    // Γ(1.25)²/Γ(2.5), π/4/Γ(3) and Γ(2)²/Γ(4).
    let cases =
        [(0.5f64, 0.906_402_477_055_477_f64.powi(2) / 1.329_340_388_179_137), (1.0, TAU / 16.0), (2.0, 1.0 / 6.0)];
    for (exponent, gammas) in cases {
        let damping = if exponent < 1.0 { "exponent = 0.5, slow = 3e-5" } else { &format!("exponent = {exponent:?}") };
        let motion = "fix = [\"uy\", \"uz\"]\nmotion = { ux = { amplitude = \"way\", scale = 5e-3 } }\n\
                      [amplitudes.way]\nkind = \"sine\"\nfrequency = 1.0";
        let model = read_deck(&deck("end_time = 2.0\ntime_step = 5e-4", damping, motion));
        let row = |frame: &Frame| vec![frame.derived.links[0].force, frame.derived.energy.expect("energies").damping];
        let rows = run_to_the_end(&model, &mut { row }).rows;
        let cycle = rows[4000][1] - rows[2000][1];
        let exact = 4.0 * 2f64.powf(exponent) * gammas * 3e3 * 5e-3 * (5e-3 * TAU).powf(exponent);
        // Power is summed by trapezoids of 1/2000 of a cycle; at its kinks |sin|^1.5 this leaves (TAU/2000)² of it.
        assert!((cycle / exact - 1.0).abs() < 1e-5, "{exponent}: {cycle} {exact}");
        let most = rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max);
        assert!((most / (3e3 * (5e-3 * TAU).powf(exponent)) - 1.0).abs() < 1e-5, "{exponent}: {most}");
    }
}

/// A mass braked by the damper alone: v¹⁻ᵃ falls by (1 − a) c/m of the time. Motion and force are of second order.
#[test]
fn a_mass_is_braked_as_the_closed_form_says() {
    // Explicit steps bear the slope at rest of a fluid damper only if they are far shorter.
    let (implicit, all) = (["newmark", "esdirk3"], ["newmark", "esdirk3", "central-difference"]);
    for (exponent, slow, schemes) in [(0.3f64, "1e-5", &implicit[..]), (2.0, "0.0", &all)] {
        for scheme in schemes {
            let run = |steps: u32| {
                let analysis = format!(
                    "end_time = 0.2\ntime_step = {:?}\n[integrator]\nscheme = \"{scheme}\"",
                    0.2 / f64::from(steps)
                );
                let rest = "fix = [\"uy\", \"uz\"]\n[[masses]]\nat = \"p\"\nmass = 1e3\n[[initial]]\nat = \"p\"\n\
                            velocity = [1.0, 0.0, 0.0]";
                let damping = format!("exponent = {exponent:?}, slow = {slow}");
                let model = read_deck(&deck(&analysis, &damping, rest));
                let at = node(&model, "p");
                let row = |frame: &Frame| vec![frame.state.nodes[at].v.x, frame.derived.links[0].force];
                run_to_the_end(&model, &mut { row }).rows.pop().expect("rows")
            };
            let v = (1.0 - (1.0 - exponent) * 3.0 * 0.2).powf((1.0 - exponent).recip());
            let exact = [v, 3e3 * v.powf(exponent)];
            let [coarse, fine] = [40, 80].map(run);
            for k in 0..2 {
                let [a, b] = [&coarse, &fine].map(|row| (row[k] / exact[k] - 1.0).abs());
                println!("{exponent} {scheme} {k}: {a:e} {b:e}");
                // A ratio of 4 is the second order; the tolerance of the iteration and the slow rate leave 1e-8.
                assert!(a < 1e-3 && b < a / 3.5 + 1e-8, "{exponent} {scheme} {k}: {a} {b}");
            }
        }
    }
}

/// The slope of a fluid damper is largest at rest, 450 N s/m here for 3.4 at the first speed. Automatic explicit steps bear it from the start.
#[test]
fn explicit_steps_bear_the_slope_at_rest() {
    let end = |scheme: &str, step: &str| {
        let analysis = format!("end_time = 1.0\ntime_step = {step}\n[integrator]\nscheme = \"{scheme}\"");
        let rest = "fix = [\"uy\", \"uz\"]\n[[masses]]\nat = \"p\"\nmass = 1.0\n[[initial]]\nat = \"p\"\nvelocity = [2.0, 0.0, 0.0]\n\
                    [[links]]\nname = \"spring\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"p\" }\nstiffness = 400.0";
        let deck = deck(&analysis, "exponent = 0.3, slow = 1e-3", rest).replace("viscous = 3e3", "viscous = 5.0");
        let model = read_deck(&deck);
        let at = node(&model, "p");
        run_to_the_end(&model, &mut { |frame: &Frame| vec![frame.state.nodes[at].x.x - 1.0] }).rows.pop().expect("rows")
            [0]
    };
    let (explicit, fine) = (end("central-difference", "\"auto\""), end("newmark", "2.5e-4"));
    // Steps near 3e-3 turn the phase by (ωh)²/24 a radian, 3e-3 in all; 2e-3 of the first swing of 0.1 is left by then. Wrong steps miss by 2e-3.
    assert!((explicit - fine).abs() < 1e-4, "{explicit} {fine}");
}
