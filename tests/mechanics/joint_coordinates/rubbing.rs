//! Friction that grows with what a joint carries: rails and pins against closed forms.

use super::{all_schemes, opening, shown};
use crate::support::{read_deck, slope};

/// A sledge on a rail that goes down by an angle of tangent ¾, at rest.
fn slope_deck(scheme: &str, friction: f64) -> String {
    opening(scheme, 1e-3, 1.0, 0.25)
        + &format!(
            "[environment]\ngravity = [0.0, 0.0, -10.0]\n[[bodies]]\nname = \"sledge\"\ncenter = [1.0, 2.0, 3.0]\nmass = 4.0\n\
             inertia = [0.3, 0.2, 0.4]\n[[joints]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [4.0, 0.0, -3.0]\n\
             from = {{ ground = [1.0, 2.0, 3.0] }}\nto = {{ body = \"sledge\" }}\nfriction = {friction:?}\nstick = 1e-6\n"
        )
}

/// On the rail the sledge presses with m g cos φ, so that q̈ = g (sin φ − μ cos φ), or nothing moves.
#[test]
fn a_sledge_on_a_slope() {
    for scheme in all_schemes() {
        for friction in [0.25, 0.7, 1.0] {
            let acceleration = 10.0 * (0.6 - friction * 0.8f64).max(0.0);
            for at in shown(&read_deck(&slope_deck(scheme, friction)), "rail") {
                let exact = 0.5 * acceleration * at.time * at.time;
                // Friction comes within the first step, of which a scheme may miss up to the whole; where it sticks, swings that these steps
                // do not resolve slip some more.
                let missed = friction * 8.0 * 1e-3 * at.time;
                assert!((at.coordinate - exact).abs() < missed + 1e-4, "{scheme}, {friction}: {at:?} {exact}");
                let lost = if acceleration > 0.0 { friction * 32.0 * at.coordinate } else { 0.0 };
                assert!((at.friction - lost).abs() < 1e-3, "{scheme}, {friction}: {at:?} {lost}");
            }
        }
    }
}

/// A body that slides along a rail while a force across presses it on the rail, and less again: m v̇ = −μ F sin ωt. Second order in the time step.
#[test]
fn a_load_that_changes() {
    let (friction, force, omega, mass) = (0.3, 20.0, 5.0, 2.0);
    let exact = |t: f64| {
        let a = friction * force / mass;
        10.0 * t - a * (t / omega - (omega * t).sin() / (omega * omega))
    };
    for scheme in all_schemes() {
        let off = |time_step: f64| {
            let text = opening(scheme, time_step, 0.6, 0.6)
                + &format!(
                    "[amplitudes.press]\nkind = \"sine\"\nangular_frequency = {omega:?}\n[[bodies]]\nname = \"slide\"\n\
                     center = [0.0, 0.0, 0.0]\nmass = {mass:?}\ninertia = [1.0, 1.0, 1.0]\nvelocity = [10.0, 0.0, 0.0]\n\
                     [[joints]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
                     to = {{ body = \"slide\" }}\nfriction = {friction:?}\nstick = 1e-9\n[[loads]]\nat = \"slide\"\n\
                     force = [0.0, 0.0, {force:?}]\namplitude = \"press\"\n"
                );
            let last = *shown(&read_deck(&text), "rail").last().expect("a row");
            // The load that is expected is off by F ω² Δt², and the friction by μ of that, on ways of 10 m/s for 0.6 s: 900 J/s² Δt², of
            // schemes with errors up to twice as large.
            assert!(last.numerical.abs() < 1800.0 * time_step * time_step, "{scheme}: {last:?}");
            (last.coordinate - exact(0.6)).abs()
        };
        let steps = [0.02, 0.01, 0.005];
        let errors = steps.map(off);
        assert!(errors[0] < 1e-2, "{scheme}: {errors:?}");
        let order = slope(&[(steps[1], errors[1]), (steps[2], errors[2])]);
        assert!(order > 1.8, "{scheme}: {order} {errors:?}");
    }
}

/// A wheel on a pin of 20 mm under its weight: J α = −μ r m g, until it stands still.
#[test]
fn a_wheel_on_a_pin_comes_to_rest() {
    let (friction, radius, mass, inertia) = (0.2, 0.02, 30.0, 0.4);
    let acceleration = friction * radius * mass * 10.0 / inertia;
    for scheme in all_schemes() {
        let text = opening(scheme, 1e-3, 1.0, 0.125)
            + &format!(
                "[environment]\ngravity = [0.0, 0.0, -10.0]\n[[bodies]]\nname = \"wheel\"\ncenter = [0.0, 0.0, 0.0]\nmass = {mass:?}\n\
                 inertia = [0.3, {inertia:?}, 0.3]\nangular_velocity = [0.0, 2.0, 0.0]\n[[joints]]\nname = \"pin\"\n\
                 kind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"wheel\" }}\n\
                 friction = {friction:?}\nradius = {radius:?}\nstick = 1e-5\n"
            );
        for at in shown(&read_deck(&text), "pin") {
            let t = at.time.min(2.0 / acceleration);
            let exact = 2.0 * t - 0.5 * acceleration * t * t;
            // Friction comes within the first step, of which a scheme may miss up to the whole, and goes within another.
            let missed = acceleration * 1e-3;
            assert!((at.coordinate - exact).abs() < missed * t + 1e-5, "{scheme}: {at:?} {exact}");
            assert!((at.rate - (2.0 - acceleration * t)).abs() < 2.0 * missed, "{scheme}: {at:?}");
            let lost = at.friction + at.mechanical - 0.5 * inertia * 4.0;
            assert!(lost.abs() < 1.2 * 2.0 * 1e-3, "{scheme}: {at:?}"); // the moment of 1.2 over a step at 2 rad/s
        }
    }
}
