//! An arm of six revolute joints whose angles are prescribed, against a recursive Newton-Euler computed here.

use super::{IMPLICIT, opening};
use crate::support::{read_deck, run_to_the_end, slope};
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::solve::Frame;

/// A link: where its joint lies, the axis, its centre, mass and principal inertias, and its motion A sin²(2π f t).
struct LinkOfArm {
    joint: [f64; 3],
    axis: [f64; 3],
    center: [f64; 3],
    mass: f64,
    inertia: [f64; 3],
    amplitude: f64,
    frequency: f64,
}

const fn link([joint, axis, center, inertia]: [[f64; 3]; 4], mass: f64, [amplitude, frequency]: [f64; 2]) -> LinkOfArm {
    LinkOfArm { joint, axis, center, mass, inertia, amplitude, frequency }
}

const ARM: [LinkOfArm; 6] = [
    link([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.05, 0.3], [0.8, 0.7, 0.5]], 30.0, [1.5, 0.25]),
    link([[0.0, 0.1, 0.6], [0.0, 1.0, 0.0], [0.05, 0.1, 0.95], [1.2, 1.1, 0.3]], 20.0, [0.9, 0.3]),
    link([[0.0, 0.1, 1.3], [0.0, 1.0, 0.0], [0.3, 0.05, 1.35], [0.2, 0.9, 0.8]], 12.0, [-1.1, 0.2]),
    link([[0.4, 0.0, 1.4], [1.0, 0.0, 0.0], [0.6, 0.0, 1.4], [0.05, 0.2, 0.2]], 6.0, [4.0, 0.4]),
    link([[0.9, 0.0, 1.4], [0.0, 1.0, 0.0], [0.95, 0.0, 1.4], [0.02, 0.03, 0.025]], 3.0, [0.7, 0.5]),
    link([[1.0, 0.0, 1.4], [0.6, 0.0, 0.8], [1.1, 0.02, 1.45], [0.01, 0.015, 0.02]], 1.5, [9.0, 0.35]),
];
const GRAVITY: f64 = 9.81;

fn deck(scheme: &str, time_step: f64) -> String {
    let mut text = opening(scheme, time_step, 1.0, 0.1) + &format!("[environment]\ngravity = [0.0, 0.0, -{GRAVITY}]\n");
    for (i, link) in ARM.iter().enumerate() {
        let from = if i == 0 { "ground = ".to_owned() } else { format!("body = \"b{}\", point = ", i - 1) };
        let LinkOfArm { joint, axis, center, mass, inertia, amplitude, frequency } = link;
        text += &format!(
            "[[bodies]]\nname = \"b{i}\"\ncenter = {center:?}\nmass = {mass:?}\ninertia = {inertia:?}\n\
             [amplitudes.a{i}]\nkind = \"sine-squared\"\nfrequency = {frequency:?}\n\
             [[joints]]\nname = \"j{i}\"\nkind = \"revolute\"\naxis = {axis:?}\nfrom = {{ {from}{joint:?} }}\n\
             to = {{ body = \"b{i}\" }}\nmotion = {{ position = {amplitude:?}, amplitude = \"a{i}\" }}\n"
        );
    }
    text
}

/// Moments of the drives at a time: velocities and accelerations outwards, forces and moments inwards.
fn recursive_newton_euler(t: f64) -> [f64; 6] {
    let (mut R, mut omega, mut alpha) = (Mat3::identity(), Vec3::zeros(), Vec3::zeros());
    let (mut x, mut a) = (Vec3::zeros(), Vec3::new(0.0, 0.0, GRAVITY));
    let mut before = Vec3::zeros();
    let mut links = Vec::new();
    for link in &ARM {
        let w = 2.0 * std::f64::consts::PI * link.frequency;
        let q = link.amplitude * (w * t).sin().powi(2);
        let dq = link.amplitude * w * (2.0 * w * t).sin();
        let ddq = link.amplitude * 2.0 * w * w * (2.0 * w * t).cos();
        let [joint, axis, center] = [link.joint, link.axis, link.center].map(Vec3::from);
        let arm = R * (joint - before);
        (x, a) = (x + arm, a + alpha.cross(&arm) + omega.cross(&omega.cross(&arm)));
        let e = R * axis;
        alpha += ddq * e + omega.cross(&(dq * e));
        omega += dq * e;
        R *= rotation::matrix(&rotation::exp(&(q * axis)));
        let s = R * (center - joint);
        let force = link.mass * (a + alpha.cross(&s) + omega.cross(&omega.cross(&s)));
        let J = R * Mat3::from_diagonal(&Vec3::from(link.inertia)) * R.transpose();
        links.push((x, e, s, force, J * alpha + omega.cross(&(J * omega))));
        before = joint;
    }
    let (mut force, mut moment, mut from) = (Vec3::zeros(), Vec3::zeros(), Vec3::zeros());
    let mut moments = [0.0; 6];
    for (i, (x, e, s, f, n)) in links.into_iter().enumerate().rev() {
        moment += (from - x).cross(&force) + n + s.cross(&f);
        force += f;
        from = x;
        moments[i] = moment.dot(&e);
    }
    moments
}

/// The largest difference of moments, over all output times, relative to the largest.
fn error(scheme: &str, time_step: f64) -> f64 {
    let model = read_deck(&deck(scheme, time_step));
    let done = run_to_the_end(&model, &mut |frame: &Frame| {
        let mut row = vec![frame.state.time];
        row.extend(frame.derived.joints.iter().map(|joint| joint.drive));
        row
    });
    let (mut difference, mut largest) = (0.0f64, 0.0f64);
    for row in &done.rows {
        for (moment, exact) in row[1..].iter().zip(recursive_newton_euler(row[0])) {
            difference = difference.max((moment - exact).abs());
            largest = largest.max(exact.abs());
        }
    }
    assert!(largest > 100.0, "{largest}");
    difference / largest
}

/// Accelerations are prescribed, so moments follow from them without any error of the step.
#[test]
fn moments_are_those_of_a_recursive_newton_euler() {
    let found = error("runge-kutta", 5e-3);
    println!("runge-kutta: {found:e}");
    assert!(found < 1e-10, "runge-kutta: {found:e}"); // rounding, some 1e-13
    for scheme in IMPLICIT.into_iter().chain(["central-difference"]) {
        let points = [1e-2, 5e-3, 2.5e-3].map(|dt| (dt, error(scheme, dt)));
        println!("{scheme}: {points:?} order {:.3}", slope(&points));
        // Multipliers of implicit schemes keep the part 1e-7 of what closes redundant equations; Wilson-theta carries them along a
        // straight line from past the end of the step, to second order, and half steps of velocities leave central differences with it.
        assert!(points[2].1 < 1e-6 || slope(&points) > 1.85, "{scheme}: {points:?}");
        assert!(points[2].1 < 2e-2, "{scheme}: {points:?}");
    }
}
