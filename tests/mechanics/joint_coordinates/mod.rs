//! Coordinates of joints: their equations and what acts along them against differences, driven and powered mechanisms against
//! minimal coordinates and a recursive Newton-Euler, friction, stops and screws against closed forms, turns counted.

mod actuators;
mod bennett;
mod derivatives;
mod door;
mod driven_arm;
mod drives;
mod gears;
mod hanging;
mod linkages;
mod motors;
mod robot_arm;
mod rubbing;
mod slots;
mod springs;
mod stages;
mod turns;

use crate::support::run_to_the_end;
use rdsolve::model::Model;
use rdsolve::solve::Frame;

/// Schemes that write equilibrium, and those that find accelerations from forces.
const IMPLICIT: [&str; 6] = ["newmark", "hht-alpha", "generalized-alpha", "bathe", "wilson-theta", "esdirk3"];
const EXPLICIT: [&str; 2] = ["runge-kutta", "central-difference"];

fn all_schemes() -> impl Iterator<Item = &'static str> {
    IMPLICIT.into_iter().chain(EXPLICIT)
}

/// The opening of a deck.
fn opening(scheme: &str, time_step: f64, end_time: f64, interval: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time}\ntime_step = {time_step}\n\
         [iteration]\ntolerance = 1e-12\n[integrator]\nscheme = \"{scheme}\"\n\
         [output]\ninterval = {interval}\nreactions = true\njoints = true\n"
    )
}

/// What a joint shows at an output time.
#[derive(Debug, Clone, Copy)]
struct Shown {
    time: f64,
    coordinate: f64,
    rate: f64,
    effort: f64,
    /// Sum of what changes energy from outside, and all that has been lost.
    external: f64,
    impact: f64,
    friction: f64,
    mechanical: f64,
    numerical: f64,
}

/// A joint at every output time.
fn shown(model: &Model, joint: &str) -> Vec<Shown> {
    let index = model.constraints.joints.iter().position(|made| made.name == joint).expect("the joint");
    let rows = run_to_the_end(model, &mut |frame: &Frame| {
        let made = &model.constraints.joints[index];
        let spring =
            made.coordinate.as_ref().and_then(|coordinate| coordinate.spring).expect("its coordinate is counted");
        let (link, energy) = (frame.derived.links[spring], frame.derived.energy.expect("energies"));
        let effort = frame.derived.joints[index].drive - link.force;
        vec![
            frame.state.time,
            link.elongation,
            link.rate,
            effort,
            energy.external,
            energy.impact,
            energy.friction,
            energy.mechanical,
            energy.numerical,
        ]
    })
    .rows;
    let show = |row: &Vec<f64>| Shown {
        time: row[0],
        coordinate: row[1],
        rate: row[2],
        effort: row[3],
        external: row[4],
        impact: row[5],
        friction: row[6],
        mechanical: row[7],
        numerical: row[8],
    };
    rows.iter().map(show).collect()
}

/// Derivative of sixth order.
fn derivative(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 2e-3; // h⁶ of truncation, 6e-17 times derivatives near 1, and rounding 1e-16/h
    let at = |k: f64| f(x + k * h) - f(x - k * h);
    (45.0 * at(1.0) - 9.0 * at(2.0) + at(3.0)) / (60.0 * h)
}
