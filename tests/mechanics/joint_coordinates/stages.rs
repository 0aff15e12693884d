//! What acts along the coordinates of joints goes on from stage to stage.

use super::all_schemes;
use crate::support::run_source;
use rdsolve::diagnostic::Source;
use rdsolve::solve::{Frame, Outcome};

/// A rotor on a pin with all that may act along it: a motor, a spring, a damper, stops that lose speed, and friction; a driven one; and a
/// slider that sticks and slips.
const BODIES: &str = r#"
[amplitudes.beat]
kind = "sine"
angular_frequency = 9.0
[[bodies]]
name = "rotor"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [0.3, 0.3, 0.5]
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "rotor" }
effort = { value = 40.0, amplitude = "beat" }
stiffness = 3.0
damping = 0.05
limits = [-0.2, 2.0]
limit_stiffness = 4e3
restitution = 0.5
friction_moment = 1.5
[[bodies]]
name = "wheel"
center = [3.0, 0.0, 0.0]
mass = 2.0
inertia = [0.3, 0.5, 0.3]
[[joints]]
name = "shaft"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { ground = [3.0, 0.0, 0.0] }
to = { body = "wheel" }
motion = { velocity = 37.0 }
[[bodies]]
name = "slide"
center = [0.0, 5.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[joints]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = { ground = [0.0, 5.0, 0.0] }
to = { body = "slide" }
effort = { value = 6.0, amplitude = "beat" }
friction_force = 4.0
stick = 1e-2
"#;

fn stage(name: &str, kind: &str, duration: f64, time_step: f64) -> String {
    format!("[[stages]]\nname = \"{name}\"\nkind = \"{kind}\"\nduration = {duration:?}\ntime_step = {time_step:?}\n")
}

/// Time, coordinate, rate, effort of what acts along it but motors, and vertical force of the named joints, at every output time.
fn shown(text: &str, joints: &[&str]) -> Vec<Vec<f64>> {
    let probe = &mut |frame: &Frame| {
        let mut row = vec![frame.state.time];
        for name in joints {
            let index = frame.model.constraints.joints.iter().position(|made| made.name == *name).expect("the joint");
            let coordinate = frame.model.constraints.joints[index].coordinate.as_ref().expect("a coordinate");
            let link = &frame.derived.links[coordinate.spring.expect("it is counted")];
            let joint = &frame.derived.joints[index];
            row.extend([link.elongation, link.rate, joint.drive - link.force, joint.f.z]);
        }
        row
    };
    let done = run_source(&Source::new("stages.toml", text, &[]), probe);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    done.rows
}

#[test]
fn a_stage_that_begins_amid_turns_impacts_and_friction_changes_nothing() {
    for scheme in all_schemes() {
        // The rotor lands on a stop at 0.31, which it leaves at 0.33; the slide sticks from 0.39 to 0.45.
        let (step, parts) = (1e-3, [0.32, 0.1, 0.18]);
        let one = format!("[analysis]\nkind = \"dynamic\"\nend_time = 0.6\ntime_step = {step:?}\n");
        let three: String =
            ["a", "b", "c"].iter().zip(parts).map(|(name, part)| stage(name, "dynamic", part, step)).collect();
        let rest = format!(
            "[integrator]\nscheme = \"{scheme}\"\n[iteration]\ntolerance = 1e-12\n[output]\njoints = true\n{BODIES}"
        );
        let [one, three] = [one, three].map(|analysis| {
            let rows = shown(&format!("{analysis}{rest}"), &["pin", "shaft", "rail"]);
            rows.last().cloned().expect("rows")
        });
        for (a, b) in one.iter().zip(&three) {
            // The iteration ends at 1e-12 of the largest force, 4e3 of a stop; a matrix that is kept ends elsewhere.
            assert!((a - b).abs() < 1e-7 * a.abs().max(1.0), "{scheme}: {one:?} {three:?}");
        }
    }
}

/// A static stage between two motions: it takes the speed away, but neither the turns nor what winds up a spring nor where friction
/// holds.
#[test]
fn turns_outlast_a_static_stage() {
    let deck = stage("spin", "dynamic", 1.0, 1e-2)
        + &stage("hold", "static", 1.0, 0.25)
        + &stage("go", "dynamic", 0.5, 1e-2)
        + "[output]\njoints = true\n[amplitudes.turn]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [2.5, 2.0]]\n"
        + "[[bodies]]\nname = \"wheel\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.3, 0.5]\n"
        + "[[joints]]\nname = \"shaft\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = { ground = [0.0, 0.0, 0.0] }\n\
           to = { body = \"wheel\" }\nmotion = { velocity = 37.0, amplitude = \"turn\" }\nstiffness = 0.25\n";
    // The integral of the speed: 18.5 in the first second, 37 in the next, and 0.75 of a second of 37 in the last half.
    for row in shown(&deck, &["shaft"]) {
        let [time, coordinate, effort] = [row[0], row[1], row[3]];
        let turned = match time {
            _ if time <= 1.0 => 0.5 * time * time,
            _ if time <= 2.0 => time - 0.5,
            _ => 1.5 + (time - 2.0) + (time - 2.0) * (time - 2.0),
        };
        assert!((coordinate - 37.0 * turned).abs() < 1e-9 * 37.0, "{time}: {coordinate}");
        // Drive and spring hold each other; what accelerated the wheel up to the kink, J α = 18.5 N m, is taken off over the stage. The drive's
        // part of it has 1e-5 after a step of 9 radians.
        let is_held = (1.25..2.0).contains(&time);
        assert!(!is_held || (effort - 18.5 * (2.0 - time)).abs() < 1e-3, "{time}: {effort}");
    }
}

/// A jib takes its weight, then slews by a motor's moment: the support carries the weight from the start, and the turn is that of the
/// moment on its inertia.
#[test]
fn a_crane_takes_its_weight_before_it_slews() {
    let deck = stage("weight", "static", 1.0, 0.5)
        + &stage("slew", "dynamic", 2.0, 1e-2)
        + r#"
        [environment]
        gravity = [0.0, 0.0, -10.0]
        [output]
        joints = true
        reactions = true
        [amplitudes.start]
        kind = "table"
        points = [[0.0, 0.0], [1.0, 0.0], [1.5, 1.0], [3.0, 1.0]]
        [[bodies]]
        name = "jib"
        center = [2.0, 0.0, 3.0]
        mass = 100.0
        inertia = [10.0, 130.0, 130.0]
        [[joints]]
        name = "slew"
        kind = "revolute"
        axis = [0.0, 0.0, 1.0]
        from = { ground = [0.0, 0.0, 3.0] }
        to = { body = "jib", point = [0.0, 0.0, 3.0] }
        motion = { velocity = 1.2, amplitude = "start" }
        "#;
    let rows = shown(&deck, &["slew"]);
    // The ground bears the weight from the first load in full on; 130 + 100 2² are set in motion.
    for (time, coordinate, effort) in [(1.0, 0.0, 0.0), (1.25, 0.075, 530.0 * 2.4), (3.0, 0.3 + 1.8, 0.0)] {
        // At the end of the first stage nothing moves yet.
        let row = rows.iter().find(|row| (row[0] - time).abs() < 1e-9).expect("a row");
        assert!((row[1] - coordinate).abs() < 1e-9, "{time}: {row:?}");
        // Of second order in the step.
        assert!((row[3] - effort).abs() < 1e-3 * 1272.0, "{time}: {row:?}");
        assert!((row[4].abs() - 1000.0).abs() < 1e-6 * 1000.0, "{time}: {row:?}");
    }
}

/// An arm that carries a weight is turned by its drive, upwards or downwards, under a weight that has long been there: all forces balance before
/// each load step, so that the drive alone does work. The moment of the drive is that of the weight.
#[test]
fn a_drive_lifts_and_lowers_a_weight_in_a_later_static_stage() {
    for angle in [-1.0471975511965976_f64, -0.3, 0.3, 1.0] {
        for step in [0.05, 0.1, 0.2] {
            let text = stage("weight", "static", 1.0, 1.0)
                + &stage("turn", "static", 1.0, step)
                + &format!(
                    r#"
[output]
joints = true
[environment]
gravity = [0.0, 0.0, -10.0]
[amplitudes.turns]
kind = "ramp"
end = 1.0
stage = "turn"
[[bodies]]
name = "arm"
center = [1.0, 0.0, 0.0]
mass = 3.0
inertia = [1.0, 2.0, 3.0]
[[joints]]
name = "pin"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "arm", point = [0.0, 0.0, 0.0] }}
motion = {{ position = {angle:?}, amplitude = "turns" }}
"#
                );
            let rows = shown(&text, &["pin"]);
            let [_, coordinate, _, effort, ..] = rows.last().expect("rows")[..] else { panic!("{rows:?}") };
            // Both to the tolerance of the iteration, 1e-8 of the motion of a step.
            assert!((coordinate - angle).abs() < 1e-9, "{angle} {step}: {coordinate}");
            assert!((effort + 30.0 * angle.cos()).abs() < 1e-7, "{angle} {step}: {effort}");
        }
    }
}
