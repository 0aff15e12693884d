//! The moment of a motor that swings an arm under gravity.

use super::{opening, shown};
use crate::support::read_deck;

/// τ = (J + m l²) θ″ + m g l cos θ with θ = A sin²(w t), at every time, to 1e-6 of the largest: accelerations of drives are exact, and the
/// convergence of the iteration is left.
#[test]
fn the_moment_of_a_driven_arm_is_that_of_its_equation_of_motion() {
    let (mass, inertia, arm, gravity) = (10.0, 1.0, 0.5, 9.81);
    let (angle, w) = (0.6, std::f64::consts::FRAC_PI_2);
    for scheme in ["newmark", "generalized-alpha", "esdirk3"] {
        let deck = opening(scheme, 0.002, 1.0, 0.05)
            + &format!(
                "[environment]\ngravity = [0.0, {:?}, 0.0]\n[[bodies]]\nname = \"arm\"\ncenter = [{arm:?}, 0.0, 0.0]\nmass = {mass:?}\n\
                 inertia = [0.1, 1.0, {inertia:?}]\n[[joints]]\nname = \"motor\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\n\
                 from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"arm\" }}\n\
                 motion = {{ position = {angle:?}, amplitude = \"swing\" }}\n\
                 [amplitudes.swing]\nkind = \"sine-squared\"\nangular_frequency = {w:?}\n",
                -gravity
            );
        let torque = |t: f64| {
            let theta: f64 = angle * (w * t).sin().powi(2);
            let rate = 2.0 * angle * w * w * (2.0 * w * t).cos();
            (inertia + mass * arm * arm) * rate + mass * gravity * arm * theta.cos()
        };
        let rows = shown(&read_deck(&deck), "motor");
        assert!(rows.len() > 19, "{}", rows.len());
        for row in rows {
            let exact = torque(row.time);
            assert!((row.effort - exact).abs() < 1e-6 * 60.0, "{scheme} {}: {} for {exact}", row.time, row.effort);
        }
    }
}
