//! Rotations without limit: bodies that spin on bushings, springs that are wound up, free bodies at large steps.

use crate::support::{node, position, read, read_deck, run, run_to_the_end, slope};
use rdsolve::solve::{Failure, Outcome};

fn opening(scheme: &str, time_step: f64, end_time: f64, interval: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time}\ntime_step = {time_step}\nplane = \"off\"\n\
         [integrator]\nscheme = \"{scheme}\"\n[output]\ninterval = {interval}\nlinks = true\n"
    )
}

/// Spins about z at 20 and is struck about x.
const DISK: &str = r#"
[iteration]
tolerance = 1e-12
[[bodies]]
name = "disk"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.02, 0.02, 0.03]
angular_velocity = [0.3, 0.0, 20.0]
"#;

/// A bushing whose axis is free.
const FREE: &str = r#"
[[links]]
name = "mount"
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "disk" }
bushing = [1e4, 1e4, 1e4, 5.0, 5.0, 0.0]
"#;

/// A hub of next to no mass that does not spin, on which the disk turns.
const ON_A_HUB: &str = r#"
[[bodies]]
name = "hub"
center = [0.0, 0.0, 0.0]
mass = 1e-3
inertia = [1e-8, 1e-8, 1e-8]
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { body = "disk" }
to = { body = "hub" }
[[links]]
name = "mount"
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "hub" }
bushing = [1e4, 1e4, 1e4, 5.0, 5.0, 1e3]
"#;

#[test]
fn a_disk_spins_on_a_bushing_as_on_a_hub() {
    for scheme in ["newmark", "bathe"] {
        let moments = |mount: &str| {
            let model = read_deck(&(opening(scheme, 2e-3, 2.0, 0.05) + DISK + mount));
            let mut balance = Vec::new();
            let done = run_to_the_end(&model, &mut |frame| {
                let energy = frame.derived.energy.unwrap();
                balance.push([energy.mechanical, energy.l.z]);
                frame.derived.links[0].m.iter().copied().collect()
            });
            (done.rows, balance)
        };
        let (free, balance) = moments(FREE);
        let (hub, _) = moments(ON_A_HUB);
        for [energy, spin] in &balance {
            // What the schemes of second order leave in six turns at 0.04 rad a step: 6e-8 of 6, 3e-9 of 0.6.
            assert!((energy - balance[0][0]).abs() < 2e-7 * balance[0][0], "{scheme}: {energy}");
            assert!((spin - balance[0][1]).abs() < 1e-8 * balance[0][1], "{scheme}: {spin}");
        }
        let largest = hub.iter().flatten().fold(0.0f64, |most, m| most.max(m.abs()));
        let apart = free.iter().flatten().zip(hub.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // The hub has a mass and gives way about z: 1.6e-5.
        assert!(largest > 0.05 && apart < 5e-5 * largest, "{scheme}: {apart} of {largest}");
    }
}

fn wound(axis: &str, stiffness: &str) -> String {
    let others: Vec<String> = ["rx", "ry", "rz"].iter().filter(|r| **r != axis).map(|r| format!("{r:?}")).collect();
    format!(
        "[[bodies]]\nname = \"arm\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n\
         [amplitudes.wind]\nkind = \"ramp\"\nend = 1.0\n\
         [[supports]]\nat = \"arm\"\nfix = [\"ux\", \"uy\", \"uz\", {}]\n\
         motion = {{ {axis} = {{ amplitude = \"wind\", scale = 19.0 }} }}\n\
         [[links]]\nname = \"spring\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"arm\" }}\n\
         bushing = [1e4, 1e4, 1e4, {stiffness}]\n",
        others.join(", ")
    )
}

/// Three turns: k times the angle, whatever the scheme.
#[test]
fn a_spring_wound_over_three_turns_counts_them() {
    for (axis, stiffness, k) in [("rz", "5.0, 5.0, 2.0", 2), ("rx", "2.0, 7.0, 7.0", 0), ("ry", "5.0, 2.0, 4.0", 1)] {
        for scheme in ["newmark", "bathe", "wilson-theta", "runge-kutta"] {
            let model = read_deck(&(opening(scheme, 1e-2, 1.0, 0.5) + &wound(axis, stiffness)));
            let done = run_to_the_end(&model, &mut |frame| frame.derived.links[0].m.iter().copied().collect());
            let end = &done.rows[done.rows.len() - 1];
            // Rotations add up to rounding; the moment is that on the first end.
            assert!((end[k] - 2.0 * 19.0).abs() < 1e-9, "{scheme}, {axis}: {end:?}");
        }
    }
}

/// About an axis that is no axis of twist the moment ends at half a turn.
#[test]
fn half_a_turn_of_a_bushing_is_refused() {
    for (axis, stiffness) in [("rz", "2.0, 2.0, 2.0"), ("rx", "5.0, 5.0, 2.0"), ("ry", "2.0, 5.0, 4.0")] {
        let model = read_deck(&(opening("newmark", 1e-2, 1.0, 0.5) + &wound(axis, stiffness)));
        let done = run(&model, &mut |_| Vec::new());
        let Outcome::Failed { time, failure } = done.outcome else { panic!("{axis}, {stiffness}: not refused") };
        assert!(matches!(&failure, Failure::BushingTurnedOver { name } if name == "spring"), "{failure:?}");
        assert!(failure.to_string().contains("half a turn"), "{failure}");
        // π of 19 rad in a second, to the step that is cut near it.
        assert!((time - std::f64::consts::PI / 19.0).abs() < 0.011, "{time}");
    }
}

/// A rotor that turns by more than half a turn, or by whole turns, in a step of the deck winds its spring all the same.
#[test]
fn turns_within_a_step_are_counted_or_the_step_is_cut() {
    let rotor = |scheme: &str, dt: f64, spin: &str, stiffness: &str| {
        opening(scheme, dt, 16.0 * dt, 16.0 * dt)
            + &format!(
                "[[bodies]]\nname = \"rotor\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [2.0, 2.0, 2.0]\n\
                 angular_velocity = {spin}\n[[links]]\nname = \"spring\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
                 to = {{ body = \"rotor\" }}\nbushing = [100.0, 100.0, 100.0, {stiffness}]\n"
            )
    };
    let axes = [("[100.0, 0.0, 0.0]", "0.01, 30.0, 30.0", 0), ("[0.0, -100.0, 0.0]", "5.0, 0.01, 7.0", 1)];
    // 4, 5.1, 6.3 rad: a turn but for 5e-4, and 12.6.
    for dt in [0.04, 0.051, 0.0628, 0.1257] {
        for (scheme, (spin, stiffness, k)) in ["newmark", "bathe", "wilson-theta", "runge-kutta", "central-difference"]
            .into_iter()
            .flat_map(|s| axes.map(|a| (s, a)))
        {
            let model = read_deck(&rotor(scheme, dt, spin, stiffness));
            let done = run_to_the_end(&model, &mut |frame| frame.derived.links[0].m.iter().copied().collect());
            let frequency = (0.01f64 / 2.0).sqrt();
            let angle = 100.0 / frequency * (frequency * 16.0 * dt).sin();
            let end = done.rows.last().unwrap()[k].abs();
            // Cut steps are 0.004 of a radian of the vibration: 1e-5; a full turn less would be 0.063.
            assert!((end - 0.01 * angle).abs() < 2e-4, "{scheme}, {dt}: {end} for {}", 0.01 * angle);
        }
    }
    // Where the moment ends at half a turn, a step beyond does not hide it: nearly one turn, one and a half, two.
    for dt in [0.058, 0.09, 0.1257] {
        for (spin, stiffness) in [("[100.0, 0.0, 0.0]", "0.01, 0.01, 0.01"), ("[0.0, 0.0, 100.0]", "3.0, 0.01, 0.02")] {
            let done = run(&read_deck(&rotor("newmark", dt, spin, stiffness)), &mut |_| Vec::new());
            let Outcome::Failed { time, failure } = done.outcome else { panic!("{dt}, {stiffness}: not refused") };
            assert!(time < 0.0315, "half a turn at 100 rad a second: {time}, {failure}");
        }
    }
    // A free axis counts nothing: no step is cut.
    let done =
        run_to_the_end(&read_deck(&rotor("newmark", 0.04, "[100.0, 0.0, 0.0]", "0.0, 30.0, 30.0")), &mut |_| vec![]);
    assert_eq!(done.counts.cuts, 0);
}

fn free(inertia: &str, scheme: &str, dt: f64, end: f64, interval: f64) -> rdsolve::model::Model {
    read_deck(&format!(
        "{}[[bodies]]\nname = \"body\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = {inertia}\n\
         angular_velocity = [1.0, 0.4, 0.3]\n",
        opening(scheme, dt, end, interval)
    ))
}

/// Largest change of energy and of angular momentum, relative.
fn changes(model: &rdsolve::model::Model) -> [f64; 2] {
    let mut seen: Vec<[f64; 4]> = Vec::new();
    run_to_the_end(model, &mut |frame| {
        let energy = frame.derived.energy.unwrap();
        seen.push([energy.mechanical, energy.l.x, energy.l.y, energy.l.z]);
        Vec::new()
    });
    let [e, x, y, z] = seen[0];
    let size = (x * x + y * y + z * z).sqrt();
    seen.iter().fold([0.0, 0.0], |[de, dl], now| {
        let l = (now[1] - x).abs().max((now[2] - y).abs()).max((now[3] - z).abs());
        [f64::max(de, (now[0] - e).abs() / e), f64::max(dl, l / size)]
    })
}

#[test]
fn free_bodies_keep_energy_and_momentum_under_central_differences() {
    for dt in [0.1, 0.25, 1.0] {
        // A needle turns by 1.1 rad at the largest step; a thousand steps of rounding.
        let [energy, momentum] = changes(&free("[1.0, 1.0, 1e-3]", "central-difference", dt, 100.0, 2.0));
        assert!(energy < 1e-11 && momentum < 1e-11, "needle at {dt}: {energy} {momentum}");
        let [energy, momentum] = changes(&free("[1.0, 2.0, 2.5]", "central-difference", dt, 100.0, 2.0));
        // Bounded, and of second order: 3.75e-5 at 0.1, 3.9e-3 at 1.
        assert!(energy < 5e-3 * dt * dt && momentum < 1e-11, "{dt}: {energy} {momentum}");
    }
}

#[test]
fn free_bodies_turn_with_second_order_under_central_differences() {
    let attitudes = |scheme: &str, dt: f64| {
        let model = free("[1.0, 2.0, 2.5]", scheme, dt, 10.0, 1.0);
        let body = node(&model, "body");
        run_to_the_end(&model, &mut |frame| frame.state.nodes[body].R().iter().copied().collect()).rows
    };
    let exact = attitudes("runge-kutta", 2e-3);
    let points = [0.04, 0.02, 0.01].map(|dt| {
        let rows = attitudes("central-difference", dt);
        let pairs = rows.iter().flatten().zip(exact.iter().flatten());
        (dt, pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    });
    assert!((slope(&points) - 2.0).abs() < 0.05, "{points:?}");
    assert!(points[2].1 < 5e-6, "{points:?}");
}

/// Where all turns as one, a matrix serves for any number of turns; where it swings as well, for many steps. The answer is that of
/// a matrix of its own for every iteration, to the tolerance of the iteration over the steps.
#[test]
fn a_matrix_turns_with_the_scene() {
    // The last number: factorisations a step. A rotor needs one for its start, and one for the end of what drives it.
    for (deck, step, most) in [
        ("spin_up", 0.005, 0.05),
        ("rotating_blade", 0.002, 0.01),
        ("hub_with_blades", 0.0009375, 0.2),
        ("hub_with_blades", 0.005, 0.2),
        ("block_on_cantilever", 0.000625, 0.2),
    ] {
        let ends = ["auto", "iteration"].map(|update| {
            let sets = [format!("analysis.time_step={step}"), format!("iteration.update={update:?}")];
            let model = read(deck, &sets);
            let done = run_to_the_end(&model, &mut |frame| frame.state.nodes.iter().flat_map(position).collect());
            if update == "auto" {
                let share = done.counts.factorizations as f64 / done.counts.steps as f64;
                assert!(share < most, "{deck}, steps of {step}: {share} factorisations a step");
            }
            done.rows
        });
        let largest = ends[1].iter().flatten().fold(0.0f64, |largest, x| largest.max(x.abs()));
        for (kept, own) in ends[0].iter().flatten().zip(ends[1].iter().flatten()) {
            assert!((kept - own).abs() < 1e-5 * largest, "{deck}, steps of {step}: {kept}, {own}");
        }
    }
}
