//! Turns are counted, however many and however long the steps are.

use super::{all_schemes, opening, shown};
use crate::support::read_deck;
use rdsolve::constraints::angle::Angle;
use rdsolve::constraints::joint::{ConstraintEquation, Drive};
use rdsolve::elements::coordinate_law::{CoordinateLaw, MEMORY};
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::state::Node;
use rdsolve::system::parts::coordinate_springs::CoordinateSpring;
use std::f64::consts::TAU;

fn rotor(scheme: &str, time_step: f64, along: &str) -> String {
    opening(scheme, time_step, 10.0, 1.0)
        + "[[bodies]]\nname = \"rotor\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.3, 0.5]\n\
           [[joints]]\nname = \"pin\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 2.0]\nfrom = { ground = [0.0, 0.0, 0.0] }\n\
           to = { body = \"rotor\" }\n"
        + along
}

/// From rest to ten turns a second in ten seconds: 50 turns, and back through half turns in the other direction.
#[test]
fn a_hundred_turns_are_counted() {
    for scheme in all_schemes() {
        for (moment, dt) in [(TAU, 0.01), (-TAU, 0.01), (TAU, 0.02)] {
            let text = rotor(scheme, dt, &format!("effort = {{ value = {moment:?} }}\n"));
            let rows = shown(&read_deck(&text), "pin");
            for at in &rows {
                let exact = moment * at.time * at.time; // J = 0.5
                assert!((at.coordinate - exact).abs() < 1e-9 * TAU * 100.0, "{scheme}, {dt}: {at:?} for {exact}");
                let work = moment * exact;
                // Work of the moment; of steps up to 2.5 rad.
                assert!((at.external - work).abs() < 1e-7 * 100.0 * TAU * TAU, "{scheme}, {dt}: {at:?} for {work}");
            }
            assert!((rows.last().unwrap().coordinate.abs() / TAU - 100.0).abs() < 1e-6);
        }
    }
}

/// Steps of more than a turn: rates tell how many. (The moment of a motor does its work along the shortest rotation of a step, so
/// here there is none.)
#[test]
fn steps_of_more_than_a_turn_are_counted() {
    for scheme in all_schemes() {
        for speed in [9.0, -9.0, 20.0, 63.0] {
            let spins = format!("angular_velocity = [0.0, 0.0, {speed:?}]\n[[joints]]");
            let text = rotor(scheme, 0.5, "").replace("[[joints]]", &spins);
            for at in shown(&read_deck(&text), "pin") {
                assert!(
                    (at.coordinate - speed * at.time).abs() < 1e-9 * speed.abs() * 10.0,
                    "{scheme}, {speed}: {at:?}"
                );
            }
        }
    }
}

/// A driven rotor, by speed and by a spring that is wound up: its moment counts turns too.
#[test]
fn a_spring_is_wound_up_by_turns() {
    for scheme in all_schemes() {
        let text = rotor(scheme, 0.02, "motion = { velocity = 12.566370614359172 }\nstiffness = 3.0\n");
        for at in shown(&read_deck(&text), "pin").iter().skip(1) {
            assert!((at.coordinate / TAU - 2.0 * at.time).abs() < 1e-9, "{scheme}: {at:?}");
            // The drive bears the spring, so that both together do nothing at constant speed: of 3 · 2π · 20.
            assert!(at.effort.abs() < 1e-4, "{scheme}: {at:?}");
            let wound = 0.5 * 3.0 * at.coordinate * at.coordinate;
            assert!((at.mechanical - wound - 0.25 * (2.0 * TAU).powi(2)).abs() < 1e-6 * wound, "{scheme}: {at:?}");
        }
    }
}

/// A drive that turns by more than a turn in one step, from rest and back to rest: rates at its ends tell nothing, the drive itself does.
#[test]
fn the_turns_of_a_drive_are_those_that_it_says() {
    let (zero, x, axis) = (Vec3::zeros(), Vec3::x(), Vec3::z());
    let lock = ConstraintEquation::Angle(Angle::about_first(&Mat3::from_columns(&[axis, x, Vec3::y()])));
    let turned = |turn: f64| Node { rotation: rotation::exp(&(turn * axis)), ..Node::at_rest(zero) };
    let sense = lock.gap(&turned(0.0), &turned(0.1))[0].signum();
    for turn in [7.0, -20.0, 2.0, 40.0] {
        let nodes = [turned(0.0), turned(sense * turn), Node::at_rest(x * (1.0 + turn))];
        let drive = Some(Drive { node: 2, start: x, ratio: 1.0, is_free: false });
        let spring = CoordinateSpring { nodes: [0, 1], lock, law: CoordinateLaw::FREE, drive };
        let at = spring.state(&nodes, &[0.0; MEMORY], 0.1);
        assert!((at.q - turn).abs() < 1e-12, "{turn}: {at:?}");
    }
}
