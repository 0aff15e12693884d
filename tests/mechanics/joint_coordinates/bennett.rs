//! A Bennett linkage: four bars in a loop by hinges that are neither parallel nor meet in a point. The hinges set 20 equations for the 18
//! coordinates of the bars that move, and yet it moves: three of them are redundant in every position.

use super::derivative;
use crate::support::run_source;
use nalgebra::{Matrix4, Rotation3, Vector3};
use rdsolve::diagnostic::Source;
use rdsolve::solve::{Frame, Outcome};

/// Lengths of the bars and angles between the axes of their hinges: opposite bars are equal, sines go with lengths.
const LENGTHS: [f64; 2] = [1.0, 1.5];
const TWIST: f64 = 0.5;
/// Masses of the three bars that move.
const MASSES: [f64; 3] = [10.0, 20.0, 15.0];

/// From the frame of a hinge to that of the next one, by Denavit and Hartenberg's rule.
fn bar(turn: f64, length: f64, twist: f64) -> Matrix4<f64> {
    let ((s, c), (st, ct)) = (turn.sin_cos(), twist.sin_cos());
    Matrix4::new(c, -s * ct, s * st, length * c, s, c * ct, -c * st, length * s, 0.0, st, ct, 0.0, 0.0, 0.0, 0.0, 1.0)
}

/// Position and axis of each hinge where the first bar stands at this angle.
fn hinges(angle: f64) -> [[Vector3<f64>; 2]; 4] {
    let twists = [TWIST, (LENGTHS[1] / LENGTHS[0] * TWIST.sin()).asin()];
    let ratio = (0.5 * (twists[1] + twists[0])).sin() / (0.5 * (twists[1] - twists[0])).sin();
    let second = 2.0 * (ratio / (0.5 * angle).tan()).atan();
    // Askew to the weights, so that all hinges carry in all directions.
    let askew = Rotation3::new(Vector3::new(0.4, -0.7, 0.2));
    let mut frame = Matrix4::identity();
    let found = std::array::from_fn(|i| {
        let [x, z] = [3, 2].map(|column| askew * frame.fixed_view::<3, 1>(0, column).into_owned());
        let turn = [angle, second, -angle, -second][i];
        frame *= bar(turn, LENGTHS[i % 2], twists[i % 2]);
        [x, z]
    });
    // The loop is closed.
    assert!((frame - Matrix4::identity()).amax() < 1e-12);
    found
}

/// The centre of each bar that moves.
fn centres(angle: f64) -> [Vector3<f64>; 3] {
    let hinges = hinges(angle);
    std::array::from_fn(|i| 0.5 * (hinges[i][0] + hinges[i + 1][0]))
}

/// The potential of the weights under unit gravity.
fn potential(angle: f64) -> f64 {
    centres(angle).iter().zip(MASSES).map(|(x, m)| m * x.z).sum()
}

/// The linkage, which a drive turns under weights that act before, in these steps.
fn deck(angle: f64, turn: f64, gravity: f64, step: f64) -> String {
    let list = |v: &Vector3<f64>| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let mut text = format!(
        "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
         [[stages]]\nname = \"turn\"\nkind = \"static\"\nduration = 1.0\ntime_step = {step:?}\n\
         [output]\njoints = true\n[environment]\ngravity = [0.0, 0.0, {gravity:?}]\n\
         [amplitudes.turns]\nkind = \"ramp\"\nend = 1.0\nstage = \"turn\"\n"
    );
    for (i, (center, mass)) in centres(angle).iter().zip(MASSES).enumerate() {
        text += &format!(
            "[[bodies]]\nname = \"bar{i}\"\ncenter = {}\nmass = {mass:?}\ninertia = [1.0, 1.0, 1.0]\n",
            list(center)
        );
    }
    for (i, [x, z]) in hinges(angle).iter().enumerate() {
        let end = |bar: usize| match bar {
            0 => format!("{{ ground = {} }}", list(x)),
            _ => format!("{{ body = \"bar{}\", point = {} }}", bar - 1, list(x)),
        };
        text += &format!(
            "[[joints]]\nname = \"hinge{i}\"\nkind = \"revolute\"\naxis = {}\nfrom = {}\nto = {}\n",
            list(z),
            end(i),
            end((i + 1) % 4)
        );
        if i == 0 {
            text += &format!("motion = {{ position = {turn:?}, amplitude = \"turns\" }}\n");
        }
    }
    text
}

#[test]
fn redundant_hinges_do_not_strain_against_each_other_in_statics() {
    let weight: f64 = MASSES.iter().sum();
    for (turn, step) in [(0.7, 0.05), (-0.5, 0.25), (0.3, 0.01)] {
        for gravity in [-10.0, -1e-5, -1e5] {
            let text = deck(1.2, turn, gravity, step);
            let probe = &mut |frame: &Frame| {
                let joints = &frame.derived.joints;
                vec![joints[0].drive, joints.iter().map(|joint| joint.f.amax()).fold(0.0, f64::max)]
            };
            let done = run_source(&Source::new("bennett.toml", &text, &[]), probe);
            assert!(matches!(done.outcome, Outcome::Done), "{turn} {gravity}: {:?}", done.outcome);
            let [drive, largest] = done.rows.last().expect("rows")[..] else { panic!("two numbers") };
            let exact = derivative(potential, 1.2 + turn) * -gravity;
            // The iteration ends at 1e-8 of the largest forces.
            assert!((drive - exact).abs() < 1e-7 * exact.abs(), "{turn} {gravity}: {drive} {exact}");
            // No hinge carries more than the weights, whose arms are as long as the bars, ask of it.
            assert!(largest < 10.0 * weight * gravity.abs(), "{turn} {gravity}: {largest}");
        }
    }
}
