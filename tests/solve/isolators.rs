//! Seismic isolators: cycles and circles of a given motion under a weight, a slider that is lifted, and a mass that swings on its dish.

use crate::support::{read_deck, run_source, run_to_the_end};
use rdsolve::diagnostic::Source;
use rdsolve::solve::Frame;
use std::f64::consts::TAU;

const WEIGHT: f64 = 1e5;
const PENDULUM: &str =
    "law = \"friction-pendulum\"\nradius = 2.0\nfriction = 0.05\nstiffness = 1e7\naxial_stiffness = 1e9";
const RUBBER: &str =
    "law = \"lead-rubber\"\nyield_force = 5e3\npost_yield_stiffness = 5e4\nstiffness = 1e6\naxial_stiffness = 1e9";

/// A slider under a weight, led along x by `x` and along y by `y`, functions of period 1, in metres.
fn led(law: &str, motion: &str) -> String {
    format!(
        "[analysis]\nkind = \"static\"\nend_time = 3.0\ntime_step = 0.002\n[output]\nevery = 1\nenergy = true\nlinks = true\n[points]\np = [0.0, 0.0, 0.0]\n\
         [[links]]\nname = \"bearing\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\naxes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]\n{law}\n\
         [[supports]]\nat = \"p\"\nmotion = {{ {motion} }}\n[[loads]]\nat = \"p\"\nforce = [0.0, 0.0, -{WEIGHT:?}]\namplitude = \"on\"\n\
         [amplitudes.on]\nkind = \"constant\"\n[amplitudes.sine]\nkind = \"sine\"\nfrequency = 1.0\n[amplitudes.cosine]\nkind = \"sine\"\nfrequency = 1.0\nphase = 1.5707963267948966\n"
    )
}

/// Rows [time, force on the ground along x and y, dissipated].
fn rows(deck: &str) -> Vec<[f64; 4]> {
    let model = read_deck(deck);
    let row = |frame: &Frame| {
        let f = frame.derived.links[0].f;
        vec![frame.state.time, f.x, f.y, frame.derived.energy.expect("energies").plastic]
    };
    run_to_the_end(&model, &mut { row }).rows.iter().map(|row| [row[0], row[1], row[2], row[3]]).collect()
}

fn at(rows: &[[f64; 4]], time: f64) -> [f64; 4] {
    *rows.iter().find(|row| (row[0] - time).abs() < 1e-9).expect("a row")
}

/// A cycle of amplitude d dissipates 4 Q (d − Q/k): Q is μ N, or F_y (1 − k₂/k) of rubber, and k the stiffness of what slips. At the end of the way
/// the force is Q and the restoring force, N d/R or k₂ d.
#[test]
fn cycles_dissipate_by_the_closed_form() {
    let motion = "ux = { amplitude = \"sine\", scale = 0.1 }, uy = { amplitude = \"sine\", scale = 0.0 }";
    for (law, slip, stiffness, restoring) in
        [(PENDULUM, 0.05 * WEIGHT, 1e7, WEIGHT / 2.0), (RUBBER, 0.95 * 5e3, 0.95e6, 5e4)]
    {
        let found = rows(&led(law, motion));
        let cycle = 4.0 * slip * (0.1 - slip / stiffness);
        let [early, late] = [2.0, 3.0].map(|time| at(&found, time)[3]);
        // The iteration leaves 1e-8 of the weight; slip is followed exactly.
        assert!(((late - early) / cycle - 1.0).abs() < 1e-6, "{law}: {} {cycle}", late - early);
        for (time, sign) in [(1.25, 1.0), (1.75, -1.0)] {
            let [_, f, across, _] = at(&found, time);
            assert!((f / (sign * (slip + restoring * 0.1)) - 1.0).abs() < 1e-6, "{law}: {f}");
            assert!(across.abs() < 1e-6 * slip);
        }
    }
}

/// On a circle of radius r the slipping spring of stretch s = Q/k turns with the slider, across its own way: u_p goes on a circle of radius √(r² − s²), and a
/// turn dissipates 2π Q times that.
#[test]
fn circles_turn_the_friction_with_the_way() {
    let motion = "ux = { amplitude = \"cosine\", scale = 0.1 }, uy = { amplitude = \"sine\", scale = 0.1 }";
    for (law, slip, stiffness) in [(PENDULUM, 0.05 * WEIGHT, 1e7), (RUBBER, 0.95 * 5e3, 0.95e6)] {
        let found = rows(&led(law, motion));
        let s: f64 = slip / stiffness;
        let turn = TAU * slip * (0.01 - s * s).sqrt();
        let lost = at(&found, 3.0)[3] - at(&found, 2.0)[3];
        // The return to the circle of friction lags by half a step of 2π/500, across the stretch of the spring: 0.0063 s/r, 3e-4 of rubber and 3e-5 of the pendulum.
        assert!((lost / turn - 1.0).abs() < 1.5 * 0.0063 * s / 0.1, "{law}: {lost} {turn}");
    }
}

/// Lifted by a millimetre the slider moves without force and dissipation.
#[test]
fn a_lifted_slider_carries_nothing() {
    let motion = "ux = { amplitude = \"sine\", scale = 0.02 }, uy = { amplitude = \"sine\", scale = 0.02 }, uz = { amplitude = \"on\", scale = 1e-3 }";
    let found = rows(
        &led(PENDULUM, motion)
            .replace("[[loads]]\nat = \"p\"\nforce = [0.0, 0.0, -100000.0]\namplitude = \"on\"\n", ""),
    );
    let last = found.last().expect("rows");
    assert!(found[1..].iter().all(|row| row[1] == 0.0 && row[2] == 0.0), "{last:?}");
    assert_eq!(last[3], 0.0);
}

/// A mass that is let go at a₀ on the dish comes to rest after half a period, 2π √(R/g)/2, at a₀ − 2μR on the other side; motion and dissipation keep the
/// energy.
#[test]
fn a_mass_swings_on_its_dish() {
    // Energies of explicit steps are those of velocities between them.
    for (scheme, tolerance) in [("newmark", 1e-3), ("generalized-alpha", 1e-3), ("central-difference", 1e-2)] {
        swing(scheme, tolerance);
    }
}

fn swing(scheme: &str, tolerance: f64) {
    let deck = "[[stages]]\nname = \"lead\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.05\n[[stages]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = 1.5\n\
         time_step = 5e-4\n[integrator]\nscheme = \"newmark\"\n[output]\nevery = 1\nenergy = true\n[points]\np = [0.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\n\
         mass = 1e4\n[environment]\ngravity = [0.0, 0.0, -9.81]\n[[links]]\nname = \"bearing\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"p\" }\n\
         axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]\nlaw = \"friction-pendulum\"\nradius = 2.0\nfriction = 0.005\nstiffness = 1e7\naxial_stiffness = 1e9\n\
         [[supports]]\nat = \"p\"\nmotion = { ux = { to = 0.1 } }\nstages = \"lead\"\n[[supports]]\nat = \"p\"\nfix = [\"uy\"]\n"
        .replace("newmark", scheme);
    let row = |frame: &Frame| {
        let energy = frame.derived.energy.expect("energies");
        let at = frame.model.nodes.iter().position(|node| node.label == "p").expect("a node");
        vec![frame.state.time, frame.state.nodes[at].x.x, energy.mechanical + energy.plastic - energy.external]
    };
    let found = run_source(&Source::new("deck.toml", &deck, &[]), &mut { row }).rows;
    let swing: Vec<&Vec<f64>> = found.iter().filter(|row| row[0] > 1.0).collect();
    let back = swing.iter().min_by(|a, b| a[1].total_cmp(&b[1])).expect("a row");
    let half = 0.5 * TAU * (2.0f64 / 9.81).sqrt();
    // (a₀/R)²/4 of the amplitude by the rise and the changing weight: 6e-4, and the stretch of the spring that slips, 5e-5 m.
    assert!((back[1] + 0.1 - 2.0 * 0.005 * 2.0).abs() < 2e-4, "{back:?}");
    assert!((back[0] - 1.0 - half).abs() < 2e-3 * half, "{back:?} {half}");
    let drift = |row: &&Vec<f64>| (row[2] - swing[0][2]).abs();
    let worst = swing.iter().map(drift).fold(0.0, f64::max);
    // The first energy of the motion is m g a₀²/2R = 245 J; a step errs where friction turns.
    assert!(worst < tolerance * 245.0, "{scheme}: {worst}");
}

/// The scenes of a plane switch: on, by itself, or off.
fn sliding_mass(axes: &str, plane: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.2\ntime_step = 1e-4\nplane = \"{plane}\"\n[output]\nevery = 100\nlinks = true\n[points]\np = [0.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\n\
         mass = 1e4\n[[initial]]\nat = \"p\"\nvelocity = [0.5, 0.0, 0.0]\n[[links]]\nname = \"bearing\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\naxes = {axes}\n\
         law = \"friction-pendulum\"\nradius = 2.0\nfriction = 0.05\nstiffness = 1e7\naxial_stiffness = 1e9\n"
    )
}

/// A slider that moves in the plane of its dish rises out of it: a plane motion would hold it down.
#[test]
fn a_dish_in_the_plane_of_motion_is_not_plane() {
    let forces = |deck: &str| {
        let model = read_deck(deck);
        let row = |frame: &Frame| frame.derived.links[0].f.iter().copied().collect();
        run_to_the_end(&model, &mut { row }).rows
    };
    for axes in ["[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]", "[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]"] {
        let [auto, off] = ["auto", "off"].map(|plane| forces(&sliding_mass(axes, plane)));
        for (a, b) in auto.iter().flatten().zip(off.iter().flatten()) {
            // Rounding of forces of 1e5 and the tolerance of the iteration.
            assert!((a - b).abs() < 1.0, "{axes}: {a} {b}");
        }
    }
}

/// Pushed until it slips, a pendulum under its weight is stable: the dish restores it.
#[test]
fn a_slip_is_no_buckling() {
    for push in ["10e3, 0.0", "8e3, 6e3"] {
        let deck = led(PENDULUM, "")
            .replace(
                "[[supports]]\nat = \"p\"\nmotion = {  }\n",
                &format!("[[loads]]\nat = \"p\"\nforce = [{push}, 0.0]\n"),
            )
            .replace("end_time = 3.0\ntime_step = 0.002", "end_time = 1.0\ntime_step = 0.05");
        let model = read_deck(&deck);
        let nothing = |_: &Frame| vec![];
        let done = run_to_the_end(&model, &mut { nothing });
        assert!(done.warnings.is_empty(), "{:?}", done.warnings);
    }
}

/// Without friction a pendulum swings at √(g/R)/2π; with it the modes are those of a slider that sticks.
#[test]
fn modes_on_a_dish() {
    let deck = |friction: &str| {
        format!(
            "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n[[stages]]\nname = \"modes\"\nkind = \"modal\"\nmodes = 2\n[points]\np = [0.0, 0.0, 0.0]\n\
             [[masses]]\nat = \"p\"\nmass = 1e4\n[environment]\ngravity = [0.0, 0.0, -9.81]\n[[supports]]\nat = \"p\"\nfix = [\"uy\"]\n[[links]]\nname = \"bearing\"\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\naxes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]\nlaw = \"friction-pendulum\"\nradius = 2.0\nfriction = {friction}\n\
             stiffness = 1e7\naxial_stiffness = 1e9\n[[expect]]\nquantity = \"frequency\"\nmode = 1\nvalue = {:?}\ntolerance = 1e-4\nsource = \"closed form\"\n",
            if friction == "0.0" {
                (9.81f64 / 2.0).sqrt() / TAU
            } else {
                ((1e7f64 + 1e4 * 9.81 / 2.0) / 1e4).sqrt() / TAU
            }
        )
    };
    for friction in ["0.0", "0.05"] {
        let done = run_source(&Source::new("deck.toml", deck(friction), &[]), &mut |_| vec![]);
        assert!(done.verdicts.len() == 1 && done.verdicts[0].passed, "{friction}");
    }
}
