//! Momenta and energies are kept, and works balance what is moved and stored.

use super::scenes::{dynamic, steps_of_row};
use super::{CENTRAL, EIGHT, FIVE, balance_of, deck, scene};
use crate::support::run_to_the_end;
use rdsolve::system::energy::Balance;

/// Momentum to rounding, energy to the error of the step; the balance of works is a quadrature of the scheme's own order.
#[test]
fn invariants() {
    let energies = |name: &str, sets: &[&str]| -> Vec<[f64; 9]> {
        let model = deck(name, sets);
        let mut rows = Vec::new();
        run_to_the_end(&model, &mut |frame| {
            let e = frame.derived.energy.unwrap();
            rows.push([e.mechanical, e.numerical, e.p.x, e.p.y, e.p.z, e.l.x, e.l.y, e.l.z, e.damping]);
            Vec::new()
        });
        rows
    };
    let worst = |rows: &[[f64; 9]], column: usize| {
        rows.iter().map(|row| (row[column] - rows[0][column]).abs()).fold(0.0, f64::max)
    };
    let step = "analysis.time_step=0.0125";
    for (scheme, energy, spin) in [(CENTRAL, 1e-2, 1e-11), (EIGHT, 1e-7, 1e-8), (FIVE, 5e-3, 5e-4)] {
        let step = if scheme == CENTRAL { "analysis.time_step=0.003125" } else { step };
        let rows = energies("two_bodies_on_springs", &[scheme, step]);
        let start = rows[0][0];
        let [p, l] = [2, 5].map(|first| (first..first + 3).map(|column| worst(&rows, column)).fold(0.0, f64::max));
        println!("{scheme}: balance {:.1e}, p {p:.1e}, l {l:.1e} of {start:.1}", worst(&rows, 1));
        assert!(p < 1e-12, "p {p}"); // rounding of a momentum of 11 over 800 steps
        // Central differences keep the moment of momentum too: rounding. Runge-Kutta: its error at 0.75 rad a step.
        assert!(l < spin, "l {l}");
        // Dampers take a third of the energy.
        assert!(rows.last().unwrap()[8] > 0.2 * start);
        assert!(worst(&rows, 1) < energy * start, "{}", worst(&rows, 1));
    }
    // A free body: its angular momentum is kept to rounding by central differences, whatever the step.
    let rows = energies("free_body", &[CENTRAL, "analysis.time_step=0.025", "analysis.end_time=50.0"]);
    for column in 5..8 {
        assert!(worst(&rows, column) < 1e-12, "{column}: {}", worst(&rows, column));
    }
    // Energy swings by the square of the step, a hundredth at 0.07 rad a step, and does not drift.
    assert!(worst(&rows, 0) < 1e-3, "{}", worst(&rows, 0));
}

/// What loads, and ends that are driven, put into a scene is what it has.
#[test]
fn works_balance_where_motion_is_given() {
    let text = dynamic("3.0", "0.05", "runge-kutta")
        + r#"[points]
hand = [0.0, 0.0, 0.0]
bob = [1.0, 0.0, 0.0]

[[masses]]
at = "bob"
mass = 1.5

[[links]]
name = "spring"
from = { node = "hand" }
to = { node = "bob" }
stiffness = 40.0
damping = 0.7

[[supports]]
at = "hand"
fix = ["uy", "uz"]
motion = { ux = { amplitude = "shake", scale = 0.2 } }

[[loads]]
at = "bob"
force = [0.0, 3.0, 0.0]
amplitude = "shake"

[amplitudes.shake]
kind = "sine"
frequency = 1.3

[environment]
gravity = [0.0, 0.0, -9.81]
"#;
    for (scheme, bound) in [(EIGHT, 1e-8), (FIVE, 1e-4)] {
        let model = scene(&text, &[scheme]);
        let (mut worst, mut most) = (0.0f64, 0.0f64);
        run_to_the_end(&model, &mut |frame| {
            let energy = frame.derived.energy.unwrap();
            worst = worst.max(energy.numerical.abs());
            most = most.max(energy.kinetic);
            Vec::new()
        });
        println!("{scheme}: {worst:.2e} of {most:.2}");
        assert!(most > 1.0);
        // Steps of 0.26 rad of the spring, 0.4 of the hand.
        assert!(worst < bound * most, "{worst}");
    }
}

/// Energies at a step swing; what central differences keep does not, and a growing mode shows in both.
#[test]
fn what_swings_is_not_made_from_nothing() {
    let model = steps_of_row(12, 0.0, &[]);
    let (mut balance, mut swing) = (Balance::default(), 0.0f64);
    let mut last = None;
    run_to_the_end(&model, &mut |frame| {
        let energy = frame.derived.energy.unwrap();
        balance.update(&energy);
        swing = swing.max(-energy.numerical);
        last = Some(energy);
        Vec::new()
    });
    let Balance { generated: made, dissipated: taken, peak: most, available: had, .. } = balance;
    println!("swings by {:.2} of the most, makes {:.1e}", swing / most, made / most);
    assert!(swing > 0.02 * most, "{swing} of {most}");
    assert!(made.max(taken) < 1e-12 * most, "{made} and {taken} of {most}"); // rounding
    assert_eq!(had, 1.0); // 2 · 1²/2
    // A mode beyond the limit: as much as is stored swings, and more than there was moves.
    let mut grown = last.unwrap();
    for energy in [&mut grown.kinetic, &mut grown.links, &mut grown.mechanical] {
        *energy *= 100.0;
    }
    (grown.numerical, grown.verlet_energy_offset) = (1.0 - grown.mechanical, grown.mechanical - 1.0);
    balance.update(&grown);
    assert_eq!(balance.generated, grown.kinetic - 1.0);
    // Others do not swing.
    let sets = ["integrator.scheme=\"newmark\"", "analysis.time_step=0.01"];
    run_to_the_end(&steps_of_row(12, 0.0, &sets), &mut |frame| {
        assert_eq!(frame.derived.energy.unwrap().verlet_energy_offset, 0.0);
        Vec::new()
    });
}

/// A mass 1 on a spring of 100 whose load goes up or down by a step.
fn stepped(more: &str) -> String {
    dynamic("4.0", "0.18", "central-difference")
        + &r#"[output]
every = 1
[points]
b = [0.0, 0.0, 0.0]
[[masses]]
at = "b"
mass = 1.0
[[links]]
name = "s"
from = { ground = [0.0, 0.0, -1.0] }
to = { node = "b" }
stiffness = 100.0
direction = [0.0, 0.0, 1.0]
[[supports]]
at = "b"
fix = ["ux", "uy"]
[[loads]]
at = "b"
force = [0.0, 0.0, 10.0]
amplitude = "st"
[amplitudes.st]
kind = "step"
"#
        .replace("direction", &format!("{more}\ndirection"))
}

/// Loads that jump change accelerations, and nothing that moves or is stored: no energy is made or taken at 0.9 of the limit, by
/// linear springs at all, preloaded or not.
#[test]
fn load_steps_and_preloads_balance() {
    let preload = "preload = 10.0";
    for (text, step) in [(stepped("") + "start = 1.8\n", 0.18), (stepped(preload) + "end = 1.8\n", 0.05)] {
        for step in [step, 0.1] {
            let model = scene(&text, &[&format!("analysis.time_step={step}")]);
            let Balance { generated: made, dissipated: taken, peak: most, .. } = balance_of(&model);
            println!("made {made:.1e}, taken {taken:.1e} of {most:.2}");
            // Half of 10 · 0.1 moves, but for (ω Δt/2)² of it: a quarter.
            assert!(most > 0.37, "{most}");
            assert!(made.max(taken) < 1e-12 * most, "{made} and {taken} of {most}"); // rounding
        }
    }
    // Where totals are zero by exact cancellation, the motion is not: half of 10 · 0.1 moves.
    for scheme in ["wilson-theta", "generalized-alpha"] {
        let set = format!("integrator.scheme=\"{scheme}\"");
        let model = scene(&(stepped(preload) + "end = 1.8\n"), &[&set, "analysis.time_step=0.01"]);
        let Balance { dissipated: taken, peak: most, .. } = balance_of(&model);
        println!("{scheme}: taken {taken:.1e} of {most:.2}");
        // At 0.1 rad a step the schemes damp less than two per cent in the three periods and a half that are left.
        assert!(most > 0.45 && taken < 0.1 * most, "{taken} of {most}");
    }
}

/// What forces do to a body counts as an offset of energies, and what it does by itself does not: a body that turns freely, with a
/// mass at an arm or without, is followed as it is.
#[test]
fn bodies_that_turn_freely_have_no_offset_of_energies() {
    let body = |inertia: &str, spin: &str, step: f64, more: &str| {
        dynamic("20.0", step, "central-difference")
            + &format!(
                "[[bodies]]\nname = \"body\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = {inertia}\n\
                 angular_velocity = {spin}\n{more}"
            )
    };
    let arm = "[points]\np = [0.0, 1.0, 0.3]\n[[attachments]]\nbody = \"body\"\nnodes = [\"p\"]\n[[masses]]\nat = \"p\"\nmass = 0.5\n";
    let spring = "[[links]]\nname = \"spring\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"body\" }\n\
                  bushing = [1.0, 1.0, 1.0, 20.0, 20.0, 20.0]\n";
    let cases = [
        // Bodies of revolution are exact: rounding.
        ("[2.0, 1.0, 1.0]", "[1.0, 0.2, 0.3]", 0.3, "", 1e-12),
        ("[2.0, 1.0, 1.0]", "[1.0, 0.2, 0.3]", 1.0, "", 1e-12),
        // With a mass at an arm no axis is one of revolution: the square of the step, 1 rad a second.
        ("[0.0001, 1.0, 1.0]", "[0.3, 1.0, 0.2]", 0.1, arm, 1e-3),
        ("[0.0001, 1.0, 1.0]", "[0.3, 1.0, 0.2]", 0.3, arm, 6e-3),
        // On a spring of 0.45 rad a step: the linear part of the offset, without that of gyroscopic moments, which is 1e-2.
        ("[2.0, 1.0, 1.0]", "[0.4, 0.3, 0.0]", 0.1, spring, 2e-3),
    ];
    for (inertia, spin, step, more, bound) in cases {
        let (mut balance, mut swing) = (Balance::default(), 0.0f64);
        run_to_the_end(&scene(&body(inertia, spin, step, more), &[]), &mut |frame| {
            let energy = frame.derived.energy.unwrap();
            balance.update(&energy);
            swing = swing.max(energy.numerical.abs());
            Vec::new()
        });
        let made = balance.generated.max(balance.dissipated) / balance.peak;
        println!("{inertia}, {step}: {made:.1e}, swings by {:.1e}", swing / balance.peak);
        assert!(made < bound, "{inertia}, {step}: {made}");
        assert!(more != spring || swing > 5.0 * bound * balance.peak, "the offset is needed: {swing}");
    }
}
