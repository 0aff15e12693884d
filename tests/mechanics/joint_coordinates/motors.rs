//! A four-bar linkage with a motor against minimal coordinates, and two bodies that a motor turns against each other.

use super::{IMPLICIT, all_schemes, derivative, opening, shown};
use crate::support::{read_deck, run_to_the_end, slope};
use rdsolve::solve::Frame;

/// Lengths of crank, coupler, rocker and ground; masses; inertias about centres.
const LENGTHS: [f64; 4] = [0.3, 1.0, 0.8, 1.1];
const MASSES: [f64; 3] = [2.0, 3.0, 2.5];
const INERTIAS: [f64; 3] = [0.02, 0.3, 0.15];
const GRAVITY: f64 = 9.81;
/// The motor's moment is this times sin² 2πt/2, with a damper in the pin and a spring at the rocker.
const MOMENT: f64 = 12.0;
const DAMPING: f64 = 0.8;
const SPRING: f64 = 20.0;
const START: f64 = 0.7;

/// Angles of coupler and rocker by that of the crank: the loop closes on circles about its tip and the far pivot.
fn angles(theta: f64) -> [f64; 2] {
    let [a, b, c, d] = LENGTHS;
    let (x, y) = (d - a * theta.cos(), -a * theta.sin());
    let square = x * x + y * y;
    let length = square.sqrt();
    let across = ((b * b + square - c * c) / (2.0 * b * length)).acos();
    let coupler = y.atan2(x) + across;
    let tip = [a * theta.cos() + b * coupler.cos(), a * theta.sin() + b * coupler.sin()];
    [coupler, tip[1].atan2(tip[0] - d)]
}

/// Centres of the three bars.
fn centers(theta: f64) -> [[f64; 2]; 3] {
    let [a, b, c, d] = LENGTHS;
    let [coupler, rocker] = angles(theta);
    let (x, y) = (theta.cos(), theta.sin());
    [
        [0.5 * a * x, 0.5 * a * y],
        [a * x + 0.5 * b * coupler.cos(), a * y + 0.5 * b * coupler.sin()],
        [d + 0.5 * c * rocker.cos(), 0.5 * c * rocker.sin()],
    ]
}

fn inertia(theta: f64) -> f64 {
    let turn = [1.0, derivative(|at| angles(at)[0], theta), derivative(|at| angles(at)[1], theta)];
    (0..3)
        .map(|i| {
            let [x, y] = [0, 1].map(|k| derivative(|at| centers(at)[i][k], theta));
            MASSES[i] * (x * x + y * y) + INERTIAS[i] * turn[i] * turn[i]
        })
        .sum()
}

fn potential(theta: f64) -> f64 {
    let weight: f64 = (0..3).map(|i| MASSES[i] * GRAVITY * centers(theta)[i][1]).sum();
    weight + 0.5 * SPRING * (angles(theta)[1] - angles(START)[1] - 0.1).powi(2)
}

fn motor(t: f64) -> f64 {
    MOMENT * (std::f64::consts::PI * t).sin().powi(2)
}

/// Crank angle and rate at times `interval` apart, by Runge-Kutta's method.
fn exact(end: f64, interval: f64) -> Vec<[f64; 2]> {
    let slope = |t: f64, [q, dq]: [f64; 2]| {
        let force = motor(t) - DAMPING * dq - derivative(potential, q) - 0.5 * derivative(inertia, q) * dq * dq;
        [dq, force / inertia(q)]
    };
    let mut y = [START, 0.0];
    let mut rows = vec![y];
    let steps = 100; // a twentieth of a second in 100 steps: h⁴ is 6e-14
    let h = interval / f64::from(steps);
    let plus = |a: [f64; 2], s: f64, b: [f64; 2]| [a[0] + s * b[0], a[1] + s * b[1]];
    for row in 0..(end / interval).round() as usize {
        for step in 0..steps {
            let t = row as f64 * interval + f64::from(step) * h;
            let k1 = slope(t, y);
            let k2 = slope(t + 0.5 * h, plus(y, 0.5 * h, k1));
            let k3 = slope(t + 0.5 * h, plus(y, 0.5 * h, k2));
            let k4 = slope(t + h, plus(y, h, k3));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        rows.push(y);
    }
    rows
}

fn four_bar(scheme: &str, time_step: f64) -> String {
    let [a, _, _, d] = LENGTHS;
    let turn = [START, angles(START)[0], angles(START)[1]];
    let knee = [a * START.cos(), a * START.sin(), 0.0];
    let c = centers(START);
    let tip = [2.0 * c[2][0] - d, 2.0 * c[2][1], 0.0];
    let mut text = opening(scheme, time_step, 1.0, 0.05)
        + &format!(
            "[environment]\ngravity = [0.0, -{GRAVITY:?}, 0.0]\n[amplitudes.motor]\nkind = \"sine-squared\"\nfrequency = 0.5\n"
        );
    for (i, name) in ["crank", "coupler", "rocker"].iter().enumerate() {
        // Of a slender bar only the inertia about z counts; turned by its angle it is no other.
        let (j, m) = (INERTIAS[i], MASSES[i]);
        assert!(turn[i].is_finite());
        text += &format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [{:?}, {:?}, 0.0]\nmass = {m:?}\ninertia = [{j:?}, {j:?}, {j:?}]\n",
            c[i][0], c[i][1]
        );
    }
    let joint = |name: &str, from: String, to: &str, along: String| {
        format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ {from} }}\n\
             to = {{ body = \"{to}\" }}\n{along}\n"
        )
    };
    text + &joint(
        "pin",
        "ground = [0.0, 0.0, 0.0]".to_owned(),
        "crank",
        format!("effort = {{ value = {MOMENT:?}, amplitude = \"motor\" }}\ndamping = {DAMPING:?}"),
    ) + &joint("knee", format!("body = \"crank\", point = {knee:?}"), "coupler", String::new())
        + &joint("tip", format!("body = \"coupler\", point = {tip:?}"), "rocker", String::new())
        + &joint(
            "pivot",
            format!("ground = [{d:?}, 0.0, 0.0]"),
            "rocker",
            format!("stiffness = {SPRING:?}\nrest = 0.1"),
        )
}

#[test]
fn a_four_bar_with_a_motor_is_that_of_minimal_coordinates() {
    let reference = exact(1.0, 0.05);
    for scheme in all_schemes() {
        let mut points = Vec::new();
        for dt in [4e-3, 2e-3, 1e-3] {
            let model = read_deck(&four_bar(scheme, dt));
            let rows = shown(&model, "pin");
            assert_eq!(rows.len(), reference.len());
            let (mut error, mut balance, mut largest) = (0.0f64, 0.0f64, 0.0f64);
            for (at, [q, dq]) in rows.iter().zip(&reference) {
                error = error.max((at.coordinate - (q - START)).abs()).max((at.rate - dq).abs());
                largest = largest.max(at.mechanical.abs());
                balance = balance.max(at.numerical.abs());
            }
            points.push((dt, error, balance / largest));
        }
        let order = slope(&points.iter().map(|at| (at.0, at.1)).collect::<Vec<_>>());
        println!("{scheme}: {points:?} order {order:.3}");
        // Runge-Kutta's own error is that of rounding in the differences of minimal coordinates.
        assert!(order > 1.9 || points[2].1 < 1e-9, "{scheme}: {points:?} order {order}");
        // Wilson-theta and esdirk3 dissipate most, of a part 1e-4 of the energy.
        assert!(points[2].1 < 2e-3 && points[2].2 < 1e-3, "{scheme}: {points:?}");
    }
}

/// A motor between two free bodies: what one gets the other loses, and the work is what the motor does.
#[test]
fn a_motor_between_free_bodies_changes_no_momentum() {
    for scheme in IMPLICIT.into_iter().chain(["runge-kutta"]) {
        let text = opening(scheme, 2e-3, 1.0, 0.1)
            + "[amplitudes.on]\nkind = \"sine-squared\"\nfrequency = 1.0\n\
               [[bodies]]\nname = \"a\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.4, 0.5]\n\
               [[bodies]]\nname = \"b\"\ncenter = [0.6, 0.1, 0.2]\nmass = 1.0\ninertia = [0.1, 0.15, 0.2]\n\
               [[joints]]\nname = \"tube\"\nkind = \"cylindrical\"\naxis = [1.0, 0.3, 0.0]\n\
               from = { body = \"a\" }\nto = { body = \"b\", point = [0.0, 0.0, 0.0] }\n\
               effort = { value = 3.0, amplitude = \"on\" }\nstiffness = 15.0\ndamping = 0.4\n\
               [[joints]]\nname = \"unused\"\nkind = \"spherical\"\nfrom = { ground = [5.0, 0.0, 0.0] }\nto = { body = \"c\" }\n\
               [[bodies]]\nname = \"c\"\ncenter = [5.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n";
        let model = read_deck(&text);
        let mut largest = 0.0f64;
        let rows = run_to_the_end(&model, &mut |frame: &Frame| {
            let energy = frame.derived.energy.unwrap();
            largest = largest.max(energy.mechanical);
            [energy.p.as_slice(), energy.l.as_slice(), &[energy.numerical]].concat()
        })
        .rows;
        assert!(largest > 0.05, "{scheme}: {largest}");
        let drift = rows.iter().flat_map(|row| &row[..6]).fold(0.0f64, |most, x| most.max(x.abs()));
        let lost = rows.iter().fold(0.0f64, |most, row| most.max(row[6].abs()));
        println!("{scheme}: momentum {drift:e}, energy {lost:e} of {largest}");
        // Projections at the ends of steps keep linear momentum; the angular one to the order of the scheme.
        assert!(drift < 1e-4, "{scheme}: {drift}");
        assert!(lost < 2e-3 * largest, "{scheme}: {lost} of {largest}");
    }
}
