//! Linkages without any stiffness of their own in statics: weights, the forces of joints and a drive alone hold each other.

use super::derivative;
use crate::support::run_source;
use rdsolve::diagnostic::Source;
use rdsolve::solve::{Frame, Outcome};

/// Lengths of crank, coupler and rocker, the distance of the pins on the ground, and the weights of the three bars.
const CRANK: f64 = 1.0;
const COUPLER: f64 = 2.0;
const ROCKER: f64 = 1.5;
const GROUND: f64 = 2.0;
/// The length of the mast.
const MAST: f64 = 5.0;
const WEIGHTS: [f64; 3] = [20.0, 30.0, 25.0];

/// The ends of the coupler where the crank stands at an angle above the x axis, in the x-z plane.
fn ends(angle: f64) -> [[f64; 2]; 2] {
    let b = [CRANK * angle.cos(), CRANK * angle.sin()];
    let d = [GROUND - b[0], -b[1]];
    let length = d[0].hypot(d[1]);
    let along = (COUPLER * COUPLER - ROCKER * ROCKER + length * length) / (2.0 * length);
    let across = (COUPLER * COUPLER - along * along).sqrt();
    let c = [(along * d[0] - across * d[1]) / length, (along * d[1] + across * d[0]) / length];
    [b, [b[0] + c[0], b[1] + c[1]]]
}

/// The potential of the weights.
fn potential(angle: f64) -> f64 {
    let [b, c] = ends(angle);
    0.5 * (WEIGHTS[0] * b[1] + WEIGHTS[1] * (b[1] + c[1]) + WEIGHTS[2] * c[1])
}

/// A four-bar linkage on which `gravity` and a `load` downwards on a mast, five cranks long and in line with the crank, act from the first
/// stage on, and which its drive turns by `turn` about y, which lowers the angle,
/// in the second.
fn four_bar(angle: f64, turn: f64, [gravity, load]: [f64; 2]) -> String {
    let [b, c] = ends(angle);
    let bar = |name: &str, [x, z]: [f64; 2], weight: f64| {
        let mass = weight / 10.0;
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [{x:?}, 0.0, {z:?}]\nmass = {mass:?}\ninertia = [1.0, 1.0, 1.0]\n"
        )
    };
    let pin = |name: &str, from: String, to: &str| {
        format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nfrom = {{ {from} }}\nto = {{ body = \"{to}\" }}\n"
        )
    };
    let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    let mast = format!(
        "[points]\ntip = [{:?}, 0.0, {:?}]\n[[attachments]]\nbody = \"crank\"\nnodes = \"tip\"\n\
         [[loads]]\nat = \"tip\"\nforce = [0.0, 0.0, {:?}]\n",
        MAST * b[0],
        MAST * b[1],
        -load
    );
    let (origin, ground) = ([0.0, 0.0], [GROUND, 0.0]);
    let on = |body: &str, [x, z]: [f64; 2]| format!("body = \"{body}\", point = [{x:?}, 0.0, {z:?}]");
    format!(
        "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n\
         [[stages]]\nname = \"turn\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.05\n\
         [environment]\ngravity = [0.0, 0.0, {gravity:?}]\n\
         [amplitudes.turns]\nkind = \"ramp\"\nend = 1.0\nstage = \"turn\"\n[output]\njoints = true\n"
    ) + &bar("crank", middle(origin, b), WEIGHTS[0])
        + &bar("coupler", middle(b, c), WEIGHTS[1])
        + &bar("rocker", middle(c, ground), WEIGHTS[2])
        + &mast
        + &pin("A", "ground = [0.0, 0.0, 0.0]".into(), "crank")
        + &format!("motion = {{ position = {turn:?}, amplitude = \"turns\" }}\n")
        + &pin("B", on("crank", b), "coupler")
        + &pin("C", on("coupler", c), "rocker")
        + &pin("D", format!("ground = [{GROUND:?}, 0.0, 0.0]"), "rocker")
}

#[test]
fn a_drive_turns_a_loop_of_bars_under_their_weight() {
    // Between these angles coupler and rocker do not come into one line, where the forces of joints have no limit.
    for angle in [1.0, std::f64::consts::FRAC_PI_2, 2.0] {
        for turn in [-0.6, 0.3, 0.9] {
            for [gravity, load] in [[-10.0, 0.0], [-10.0, 1e4], [-1e-6, 0.0], [-1e6, 0.0], [0.0, 0.0]] {
                let text = four_bar(angle, turn, [gravity, load]);
                let probe = &mut |frame: &Frame| vec![frame.derived.joints[0].drive];
                let done = run_source(&Source::new("four_bar.toml", &text, &[]), probe);
                assert!(matches!(done.outcome, Outcome::Done), "{angle} {turn} {gravity} {load}: {:?}", done.outcome);
                let drive = done.rows.last().expect("rows")[0];
                let exact = derivative(potential, angle - turn) * gravity / 10.0 - load * MAST * (angle - turn).cos();
                // The iteration ends at 1e-8 of the largest forces, some hundred times the weights near a line.
                // Without weights rounding of positions is all that joints feel.
                let off = (drive - exact).abs();
                assert!(
                    off < 1e-6 * (gravity.abs() + load) + 1e-12,
                    "{angle} {turn} {gravity} {load}: {drive} {exact}"
                );
            }
        }
    }
}
