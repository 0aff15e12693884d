//! Geared joints against closed forms: wheels, a planetary gear, a rack, a satellite that its wheels turn.

use super::{all_schemes, opening};
use crate::solve::statics::said;
use crate::support::{read_deck, run_source, run_to_the_end, slope};
use rdsolve::diagnostic::Source;
use rdsolve::model::Model;
use rdsolve::solve::{Frame, Outcome};

/// A wheel of J = 2 with a motor, and a pinion of J = 0.5 that is geared to it.
fn wheels(scheme: &str, time_step: f64, ratio: f64, drive: &str) -> String {
    opening(scheme, time_step, 2.0, 0.5)
        + &format!(
            r#"
[[bodies]]
name = "wheel"
center = [0.0, 0.0, 0.0]
mass = 3.0
inertia = [1.0, 1.0, 2.0]
[[bodies]]
name = "pinion"
center = [1.0, 0.0, 0.0]
mass = 1.0
inertia = [0.3, 0.3, 0.5]
[[joints]]
name = "fast"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [1.0, 0.0, 0.0] }}
to = {{ body = "pinion" }}
gear = {{ joint = "slow", ratio = {ratio:?} }}
[[joints]]
name = "slow"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "wheel" }}
{drive}
"#
        )
}

/// Coordinate and effort of drive or gears of the named joints.
fn state(frame: &Frame, names: &[&str]) -> Vec<f64> {
    let joints = &frame.model.constraints.joints;
    let of = |name: &&str| {
        let index = joints.iter().position(|made| made.name == **name).expect("the joint");
        let spring = joints[index].coordinate.as_ref().expect("a coordinate").spring.expect("it is counted");
        [frame.derived.links[spring].elongation, frame.derived.joints[index].drive]
    };
    names.iter().flat_map(of).collect()
}

fn rows(model: &Model, names: &[&str]) -> Vec<Vec<f64>> {
    let probe = &mut |frame: &Frame| [vec![frame.state.time], state(frame, names)].concat();
    run_to_the_end(model, probe).rows
}

/// (J₁ + n² J₂) q̈ = M; the gear takes n J₂ q̈·n from the wheel. A constant acceleration is exact for every scheme, at many turns; so is one
/// that a drive prescribes.
#[test]
fn geared_wheels() {
    for scheme in all_schemes() {
        for (ratio, motor) in [(-3.0, 130.0), (0.731, 13.0), (40.0, 8020.0)] {
            let acceleration = motor / (2.0 + 0.5 * ratio * ratio);
            let motor = format!("effort = {{ value = {motor:?} }}");
            let driven = format!("motion = {{ acceleration = {acceleration:?} }}");
            for (along, gear) in [(motor, -0.5 * ratio * ratio), (driven, 2.0)] {
                for row in rows(&read_deck(&wheels(scheme, 0.01, ratio, &along)), &["slow", "fast"]).iter().skip(1) {
                    let q = 0.5 * acceleration * row[0] * row[0];
                    let exact = [row[0], q, gear * acceleration, ratio * q, 0.5 * ratio * acceleration];
                    for (found, exact) in row.iter().zip(exact) {
                        // Of steps up to 4.8 rad rounding leaves 1e-9 of the whole; multipliers of joints are exact to 1e-11 of the largest.
                        let most = 1e-9 * (ratio.abs().max(1.0) * q).max(acceleration * ratio * ratio).max(10.0);
                        assert!((found - exact).abs() < most, "{scheme}, {ratio}, {along}: {row:?} {exact}");
                    }
                }
            }
        }
    }
}

/// A carrier whose planet rolls inside a ring that is held (four times the planet's teeth) and around a sun (twice); a moment turns the sun. With
/// absolute speeds of 1, 1 − 4 and 1 + 2 per that of the carrier, J = J_c + m r² + 9 J_p + 9 J_s.
fn planetary(scheme: &str, time_step: f64) -> String {
    opening(scheme, time_step, 0.5, 0.5)
        + r#"
[[bodies]]
name = "carrier"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.05, 0.05, 0.08]
[[bodies]]
name = "sun"
center = [0.0, 0.0, 0.05]
mass = 1.0
inertia = [2e-3, 2e-3, 3e-3]
[[bodies]]
name = "planet"
center = [0.15, 0.0, 0.05]
mass = 0.8
inertia = [1e-3, 1e-3, 1.5e-3]
[[joints]]
name = "output"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "carrier" }
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { body = "carrier", point = [0.15, 0.0, 0.05] }
to = { body = "planet" }
gear = { joint = "output", ratio = -4.0 }
[[joints]]
name = "shaft"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { body = "carrier", point = [0.0, 0.0, 0.05] }
to = { body = "sun" }
gear = { joint = "pin", ratio = -0.5 }
[[loads]]
at = "sun"
moment = [0.0, 0.0, 1.0]
"#
}

#[test]
fn planetary_gear() {
    let exact = |t: f64| {
        let inertia = 0.08 + 0.8 * 0.15 * 0.15 + 9.0 * 1.5e-3 + 9.0 * 3e-3;
        let acceleration = 3.0 / inertia;
        let q = 0.5 * acceleration * t * t;
        // The gears turn planet and sun against the carrier: on the planet J_p times its absolute acceleration, on the sun what the moment
        // leaves of it.
        let (planet, sun) = (-3.0 * 1.5e-3 * acceleration, 3.0 * 3e-3 * acceleration - 1.0);
        // What gears exert along their coordinates is in equilibrium: f₁ − 4 f₂ + 2 f₃ = 0.
        [q, 4.0 * planet - 2.0 * sun, -4.0 * q, planet, 2.0 * q, sun]
    };
    for scheme in all_schemes() {
        let off = |time_step: f64| {
            let last = rows(&read_deck(&planetary(scheme, time_step)), &["output", "pin", "shaft"]).pop().unwrap();
            last[1..].iter().zip(exact(last[0])).map(|(found, exact)| (found / exact - 1.0).abs()).fold(0.0, f64::max)
        };
        let steps = [4e-3, 2e-3, 1e-3];
        let errors = steps.map(off);
        // The planet goes round by 0.04 rad a step at the end: second order leaves 1/12 of its square, and some schemes a few times that.
        assert!(errors[0] < 2e-3, "{scheme}: {errors:?}");
        let order = slope(&[(steps[1], errors[1]), (steps[2], errors[2])]);
        // Beyond the second order down to rounding and the tolerance of the iteration.
        assert!(order > 1.9 || errors[2] < 1e-9, "{scheme}: {order} {errors:?}");
    }
}

/// A satellite at rest with two wheels across each other, geared together; a motor turns the first. Without angular momentum the body turns about
/// the fixed axis J⁻¹h, h being that of the wheels per rate of the first: J_eff q̈ = M, J_eff = j₁ + n² j₂ − h·J⁻¹h.
#[test]
fn wheels_turn_a_satellite() {
    let (ratio, moment, j) = (-2.0, 0.5, [0.02, 0.01]);
    let across = [0.015, 0.006];
    let body = [0.3, 0.5, 0.4];
    let whole = [body[0] + j[0] + across[1], body[1] + across[0] + j[1], body[2] + across[0] + across[1]];
    let h = [j[0], ratio * j[1]];
    let turn = [h[0] / whole[0], h[1] / whole[1]];
    let effective = j[0] + ratio * ratio * j[1] - h[0] * turn[0] - h[1] * turn[1];
    let text = |scheme: &str, time_step: f64| {
        opening(scheme, time_step, 1.0, 1.0)
            + &format!(
                r#"
[[bodies]]
name = "satellite"
center = [0.0, 0.0, 0.0]
mass = 30.0
inertia = {body:?}
[[bodies]]
name = "first"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [{}, {}, {}]
[[bodies]]
name = "second"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [{}, {}, {}]
[[joints]]
name = "x"
kind = "revolute"
axis = [1.0, 0.0, 0.0]
from = {{ body = "satellite" }}
to = {{ body = "first" }}
effort = {{ value = {moment:?} }}
[[joints]]
name = "y"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = {{ body = "satellite" }}
to = {{ body = "second" }}
gear = {{ joint = "x", ratio = {ratio:?} }}
"#,
                j[0], across[0], across[0], across[1], j[1], across[1]
            )
    };
    let axis = rdsolve::math::Vec3::new(-turn[0], -turn[1], 0.0);
    let exact = 0.5 * moment / effective;
    for scheme in all_schemes() {
        let off = |time_step: f64| {
            let model = read_deck(&text(scheme, time_step));
            let satellite = crate::support::node(&model, "satellite");
            let done = run_to_the_end(&model, &mut |frame: &Frame| {
                let turned = rdsolve::math::rotation::log(&frame.state.nodes[satellite].rotation);
                [state(frame, &["x", "y"]), turned.as_slice().to_vec()].concat()
            });
            let last = done.rows.last().unwrap();
            assert!((last[2] - ratio * last[0]).abs() < 1e-11 * exact, "{scheme}: the ratio {last:?}");
            let turned = (0..3).map(|i| (last[4 + i] - axis[i] * exact).abs()).fold(0.0, f64::max);
            turned.max((last[0] - exact).abs() / exact)
        };
        let steps = [0.02, 0.01, 0.005];
        let errors = steps.map(off);
        assert!(errors[0] < 5e-3, "{scheme}: {errors:?}");
        let order = slope(&[(steps[1], errors[1]), (steps[2], errors[2])]);
        assert!(order > 1.85 || errors[2] < 1e-9, "{scheme}: {order} {errors:?}");
    }
}

/// A rack and pinion in three stages: a motor winds up a spring at the rack, lets go, and what is left swings with ω² = k r²/(J + m r²) about
/// zero.
#[test]
fn a_rack_goes_on_over_stages() {
    let text = |scheme: &str| {
        format!(
            r#"
[[stages]]
name = "wind"
kind = "static"
duration = 1.0
time_step = 0.25
[[stages]]
name = "swing"
kind = "dynamic"
duration = 3.0
time_step = 0.002
[integrator]
scheme = "{scheme}"
[output]
interval = 0.5
joints = true
[[bodies]]
name = "pinion"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 0.7]
[[bodies]]
name = "rack"
center = [0.0, 0.1, 0.0]
mass = 10.0
inertia = [1.0, 1.0, 1.0]
[[joints]]
name = "slide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = {{ ground = [0.0, 0.1, 0.0] }}
to = {{ body = "rack" }}
stiffness = 1000.0
gear = {{ joint = "pivot", ratio = -0.1 }}
[[joints]]
name = "pivot"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "pinion" }}
[[loads]]
at = "pinion"
moment = [0.0, 0.0, 200.0]
stages = ["wind"]
"#
        )
    };
    let omega = (1000.0f64 * 0.01 / (0.7 + 10.0 * 0.01)).sqrt();
    for scheme in all_schemes() {
        let probe = &mut |frame: &Frame| [vec![frame.state.time], state(frame, &["pivot", "slide"])].concat();
        let done = run_source(&Source::new("rack.toml", text(scheme), &[]), probe);
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        for row in done.rows.iter().filter(|row| row[0] >= 1.0) {
            let exact = 20.0 * (omega * (row[0] - 1.0)).cos();
            // Second order: (ωΔt)²/12 a unit of phase, 5e-6 × 11 rad, of schemes with errors a few times larger.
            assert!((row[1] - exact).abs() < 20.0 * 5e-4, "{scheme}: {row:?} {exact}");
            assert!((row[3] + 0.1 * row[1]).abs() < 1e-10, "{scheme}: {row:?}");
        }
        assert!((done.rows.last().unwrap()[0] - 4.0).abs() < 1e-9);
    }
}

/// Initial velocities that agree with the gears are left alone; others are said to be corrected.
#[test]
fn turning_wheels_may_be_geared() {
    for (pinion, corrected) in [(-0.3, false), (-0.30000000000000004, false), (-0.2, true)] {
        let deck = wheels("newmark", 0.01, -3.0, "")
            .replace("inertia = [1.0, 1.0, 2.0]", "inertia = [1.0, 1.0, 2.0]\nangular_velocity = [0.0, 0.0, 0.1]")
            .replace(
                "inertia = [0.3, 0.3, 0.5]",
                &format!("inertia = [0.3, 0.3, 0.5]\nangular_velocity = [0.0, 0.0, {pinion:?}]"),
            );
        let warnings = said(&deck).2.warnings;
        assert_eq!(warnings.iter().any(|warning| warning.contains("initial velocities")), corrected, "{warnings:?}");
    }
}
