//! Contacts where a stage begins in the midst of a motion: what is pressed already, what comes, what goes, against closed forms.

use crate::support;
use rdsolve::diagnostic::Source;
use rdsolve::solve::{Frame, Outcome};

const SCHEMES: [&str; 8] = [
    "newmark",
    "wilson-theta",
    "hht-alpha",
    "generalized-alpha",
    "bathe",
    "esdirk3",
    "central-difference",
    "runge-kutta",
];
/// √(k/m): the ball presses on the floor for π/ω = 31 ms, 10 mm deep.
const OMEGA: f64 = 100.0;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = MASS * OMEGA * OMEGA;
/// The first stage ends here, the second at the end.
const BOUNDARY: f64 = 0.02;
const END: f64 = 0.03;
/// The force of a load on the ball, which presses it 5 mm deep.
const LOAD: f64 = 100.0;

/// A ball of radius 0.1 on its way to a floor, without weight.
struct Case {
    name: &'static str,
    /// Height above the floor at t = 0.
    height: f64,
    /// The stages of the floor, and what else there is.
    floor: &'static str,
    more: &'static str,
    /// True where it touches at some time of each stage.
    touches: [bool; 2],
    loaded: bool,
}

const CASES: [Case; 4] = [
    // It touches from 5 ms on, and a load comes while it presses.
    Case {
        name: "a load comes",
        height: 0.005,
        floor: "",
        more: "[[loads]]\nat = \"ball\"\nforce = [0.0, 0.0, -100.0]\nstages = [\"b\"]\n",
        touches: [true, true],
        loaded: true,
    },
    // The floor comes where it touches.
    Case {
        name: "comes at touch",
        height: 0.02,
        floor: "stages = [\"b\"]",
        more: "",
        touches: [false, true],
        loaded: false,
    },
    // The floor comes where the ball lies inside by 4 mm.
    Case {
        name: "comes pressed",
        height: 0.016,
        floor: "stages = [\"b\"]",
        more: "",
        touches: [false, true],
        loaded: false,
    },
    // The floor goes while it presses.
    Case { name: "goes", height: 0.005, floor: "stages = [\"a\"]", more: "", touches: [true, false], loaded: false },
];

impl Case {
    fn deck(&self, scheme: &str, step: f64) -> String {
        let Case { height, floor, more, .. } = self;
        let stage = |name: &str, duration: f64| {
            format!(
                "[[stages]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = {duration:?}\ntime_step = {step:?}\n"
            )
        };
        format!(
            r#"{}{}
[iteration]
tolerance = 1e-10

[integrator]
scheme = "{scheme}"

[[bodies]]
name = "ball"
center = [0.0, 0.0, {:?}]
shape = {{ kind = "sphere", radius = 0.1 }}
mass = {MASS:?}
velocity = [0.0, 0.0, -1.0]

[[contacts]]
name = "floor"
surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
with = "ball"
stiffness = {STIFFNESS:?}
{floor}

{more}
[output]
contacts = true
"#,
            stage("a", BOUNDARY),
            stage("b", END - BOUNDARY),
            0.1 + height
        )
    }

    /// Height and speed at a time, from those before by so much, where the ball touches or not, and where a load acts.
    fn moved([x, v]: [f64; 2], after: f64, touches: bool, load: f64) -> [f64; 2] {
        let (sin, cos) = (OMEGA * after).sin_cos();
        match touches {
            true => {
                let rest = -load / STIFFNESS;
                [rest + (x - rest) * cos + v / OMEGA * sin, v * cos - OMEGA * (x - rest) * sin]
            }
            false => [x + v * after - 0.5 * load / MASS * after * after, v - load / MASS * after],
        }
    }

    /// Height above the floor and force on it: the closed form.
    fn exact(&self, time: f64, in_second: bool) -> [f64; 2] {
        let first = |time: f64| match self.touches[0] && time > self.height {
            true => Case::moved([0.0, -1.0], time - self.height, true, 0.0),
            false => [self.height - time, -1.0],
        };
        let [x, _] = match in_second {
            true => {
                let load = if self.loaded { LOAD } else { 0.0 };
                Case::moved(first(BOUNDARY), time - BOUNDARY, self.touches[1], load)
            }
            false => first(time),
        };
        let touches = self.touches[usize::from(in_second)];
        [x, if touches { STIFFNESS * (-x).max(0.0) } else { 0.0 }]
    }
}

/// Motion and force of a contact over the boundary of stages are of second order in the step, with every scheme; nothing is displaced there.
#[test]
fn over_a_boundary_motion_and_force_are_of_second_order() {
    for case in CASES {
        for scheme in SCHEMES {
            let mut errors = Vec::new();
            for step in [1e-3, 5e-4, 2.5e-4] {
                let mut probe = |frame: &Frame| {
                    let name = frame.model.analysis.stage.as_ref().map_or("", |stage| stage.name.as_str());
                    let force = frame.derived.contacts.first().map_or(0.0, |contact| -contact.f.z);
                    let x = frame.state.nodes[frame.model.bodies[0].node].x.z - 0.1;
                    vec![frame.state.time, f64::from(u8::from(name == "b")), x, force]
                };
                let done = support::run_source(&Source::new("contact.toml", case.deck(scheme, step), &[]), &mut probe);
                assert!(matches!(done.outcome, Outcome::Done), "{}, {scheme}: {:?}", case.name, done.outcome);
                let at = done.rows.iter().position(|row| row[1] == 1.0).expect("a second stage");
                let jump = done.rows[at][2] - done.rows[at - 1][2];
                assert_eq!(jump, 0.0, "{}, {scheme}: nothing is displaced where the stage begins", case.name);
                let mut worst = [0.0f64; 2];
                for row in &done.rows[at..] {
                    let exact = case.exact(row[0], true);
                    // Of the depth and the force of the blow.
                    worst[0] = worst[0].max((row[2] - exact[0]).abs() * OMEGA);
                    worst[1] = worst[1].max((row[3] - exact[1]).abs() * OMEGA / STIFFNESS);
                }
                errors.push((step, worst));
            }
            let order = |k: usize| {
                let points: Vec<(f64, f64)> = errors.iter().map(|(step, worst)| (*step, worst[k])).collect();
                support::slope(&points)
            };
            println!("{}, {scheme}: {errors:?}, order {:.2} {:.2}", case.name, order(0), order(1));
            for k in [0, 1] {
                let finest = errors[2].1[k];
                // The finest steps are 1/40 of a radian: the square of that, times what a scheme of second order makes of it.
                assert!(finest < 1e-3, "{}, {scheme}: {finest:e}", case.name);
                // Where the motion is a straight line or a parabola, all that is left is rounding.
                assert!(finest < 1e-9 || order(k) > 1.8, "{}, {scheme}: order {} of {errors:?}", case.name, order(k));
            }
        }
    }
}

/// A ball that its weight has pressed into the floor in a static stage rests there in the motion that follows.
#[test]
fn what_its_weight_has_pressed_down_rests() {
    for scheme in SCHEMES {
        let text = format!(
            r#"
[[stages]]
name = "weight"
kind = "static"
duration = 1.0
time_step = 0.25

[[stages]]
name = "rest"
kind = "dynamic"
duration = 0.05
time_step = 5e-4
integrator = {{ scheme = "{scheme}" }}

[environment]
gravity = [0.0, 0.0, -10.0]

[iteration]
tolerance = 1e-10

[[bodies]]
name = "ball"
center = [0.0, 0.0, 0.0999]
shape = {{ kind = "sphere", radius = 0.1 }}
mass = {MASS:?}

[[supports]]
at = "ball"
fix = ["ux", "uy", "rx", "ry", "rz"]

[[contacts]]
name = "floor"
surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
with = "ball"
stiffness = {STIFFNESS:?}

[output]
contacts = true
"#
        );
        let mut probe = |frame: &Frame| {
            let x = frame.state.nodes[frame.model.bodies[0].node].x.z - 0.1;
            vec![frame.state.time, x, frame.derived.contacts.first().map_or(0.0, |contact| -contact.f.z)]
        };
        let done = support::run_source(&Source::new("rest.toml", &text, &[]), &mut probe);
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let rests: Vec<&Vec<f64>> = done.rows.iter().filter(|row| row[0] >= 1.0).collect();
        assert!(rests.len() > 90, "{scheme}: {} rows", rests.len());
        for row in rests {
            // mg = 20 N by iterations that end at 1e-10 of it.
            assert!((row[1] + 20.0 / STIFFNESS).abs() < 1e-9 * 20.0 / STIFFNESS * 10.0, "{scheme}: {row:?}");
            assert!((row[2] - 20.0).abs() < 1e-7, "{scheme}: {row:?}");
        }
    }
}
