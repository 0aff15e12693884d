//! The same answers as implicit schemes.

use super::scenes::dynamic;
use super::{CENTRAL, EIGHT, WILSON, deck, difference, scene};
use crate::support::{node, position, run_to_the_end};

/// A beam with a rigid block on its tip.
#[test]
fn a_block_on_a_beam_as_by_wilson() {
    let mesh = ["beams.beam.elements=3", "beams.beam.order=1", "analysis.end_time=0.2", "output.interval=0.01"];
    let run = |sets: &[&str]| {
        let model = deck("block_on_cantilever", &[sets, &mesh].concat());
        let at = ["block", "tip"].map(|name| node(&model, name));
        run_to_the_end(&model, &mut |frame| at.map(|n| position(&frame.state.nodes[n])).concat()).rows
    };
    let wilson = run(&[WILSON, "analysis.time_step=1e-5"]);
    for scheme in [CENTRAL, EIGHT] {
        let explicit = run(&[scheme, "analysis.time_step=\"auto\""]);
        let off = difference(&explicit, &wilson);
        println!("{scheme}: {off:.2e}");
        // Wilson-θ damps the modes that weight let loose at t = 0 and its steps do not resolve: 1e-5 of the motion.
        assert!(off < 2e-5, "{off}");
    }
}

/// A ball that bounces: energy comes back but for what restitution takes, by every scheme.
#[test]
fn impacts_as_by_wilson() {
    let run = |scheme: &str, step: &str| {
        let model = deck("bouncing_ball", &[scheme, step, "analysis.end_time=1.45", "output.interval=0.05"]);
        let ball = node(&model, "ball");
        run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[ball].x.z]).rows
    };
    let wilson = run(WILSON, "analysis.time_step=2.5e-5");
    for scheme in [CENTRAL, EIGHT] {
        let off = difference(&run(scheme, "analysis.time_step=2.5e-5"), &wilson);
        println!("{scheme}: {off:.2e}");
        // Stations of the impact are met to a step: restitution is measured anew at each, 1e-2 of the height at most.
        assert!(off < 2e-2, "{scheme}: {off}");
    }
}

/// A portal that yields under a blow.
#[test]
fn yielding_steel_as_by_wilson() {
    let mesh = ["beams.portal.elements=4", "beams.portal.order=1", "output.interval=0.003"];
    let run = |sets: &[&str]| {
        let model = deck("portal_and_block", &[sets, &mesh].concat());
        let at = ["knee_left", "block"].map(|name| node(&model, name));
        let mut plastic = 0.0;
        let done = run_to_the_end(&model, &mut |frame| {
            plastic = frame.derived.energy.unwrap().plastic;
            at.map(|n| frame.state.nodes[n].x.x).to_vec()
        });
        (done.rows, plastic)
    };
    let (wilson, spent) = run(&[WILSON, "analysis.time_step=5e-5"]);
    let (explicit, plastic) = run(&[CENTRAL, "integrator.mass_scaling=\"off\"", "analysis.time_step=\"auto\""]);
    let off = difference(&explicit, &wilson);
    println!("{off:.2e}, plastic work {plastic} and {spent}");
    // 4 m/s of 500 kg: the most of 4000 J goes into hinges.
    assert!(spent > 2000.0 && (plastic / spent - 1.0).abs() < 2e-3, "{plastic} {spent}");
    assert!(off < 2e-3, "{off}");
}

/// Masses of several nodes that belong together, and dependent nodes that turn on their own.
#[test]
fn consistent_masses_as_by_wilson() {
    let mesh = [
        "beams.rod.elements=3",
        "beams.rod.order=1",
        "beams.rod.mass=\"consistent\"",
        "analysis.end_time=2.0",
        "output.interval=0.1",
    ];
    let run = |sets: &[&str]| {
        let model = deck("flying_beam", &[sets, &mesh].concat());
        let at = ["a", "b"].map(|name| node(&model, name));
        run_to_the_end(&model, &mut |frame| at.map(|n| position(&frame.state.nodes[n])).concat()).rows
    };
    let wilson = run(&[WILSON, "analysis.time_step=1e-4"]);
    for scheme in [CENTRAL, EIGHT] {
        let off = difference(&run(&[scheme, "analysis.time_step=1e-3"]), &wilson);
        println!("{scheme}: {off:.2e}");
        assert!(off < 1e-5, "{off}"); // of second order: 1e-3 s is 0.06 rad of the fastest mode
    }
}

/// A beam on a pivot that a mass hangs from: on an arm of the node that is held, where only its inertia about that counts, with
/// an inertia of its own that is equal about all axes, and with none.
#[test]
fn masses_off_a_pivot_as_by_wilson() {
    let text = dynamic("0.5", "1e-4", "wilson-theta")
        + r#"[materials.s]
model = "elastic"
youngs_modulus = 2e9
poisson_ratio = 0.3
density = 7800.0

[sections.q]
shape = "rectangle"
width = 0.02
height = 0.02

[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
q = [0.0, 0.0, -0.5]

[[beams]]
name = "r"
path = ["a", "b"]
elements = 1
order = 1
mass = "none"
material = "s"
section = "q"
orientation = [0.0, 1.0, 0.0]

[[masses]]
at = "b"
mass = 1.0
inertia = [0.1, 0.1, 0.1]

[[masses]]
at = "q"
mass = 2.0
inertia = [0.25, 0.25, 0.25]

[[attachments]]
beam = "r"
nodes = "q"

[[supports]]
at = "a"
fix = ["ux", "uy", "uz", "rx", "rz"]

[[supports]]
at = "b"
fix = ["uy", "rx", "rz"]

[environment]
gravity = [0.0, 0.0, -9.81]

[output]
interval = 0.1
"#;
    for text in [text.clone(), text.replace("inertia = [0.25, 0.25, 0.25]\n", "")] {
        let run = |scheme: &str| {
            let model = scene(&text, &[scheme]);
            let b = node(&model, "b");
            run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[b]).to_vec()).rows
        };
        let wilson = run(WILSON);
        for scheme in [CENTRAL, EIGHT] {
            let off = difference(&run(scheme), &wilson);
            println!("{scheme}: {off:.2e}");
            // Of second order: steps of 1e-3 rad of the swing, and the stretching of the beam, of 0.05 rad a step, is as small.
            assert!(off < 1e-6, "{off}");
        }
    }
}
