//! Slip under reversing loads: the spring of friction and the steps let it begin with a speed of their own. The run warns of that, with the stiffness and
//! the step that do.

use crate::support::{read_deck, run_with_warnings, tables_of};
use std::f64::consts::TAU;

const DECK: &str = r#"
[analysis]
kind = "dynamic"
end_time = 3.0
time_step = 0.005
[integrator]
scheme = "newmark"
[amplitudes.shaking]
kind = "sine"
frequency = 1.0
end = 2.0
[[bodies]]
name = "block"
center = [0.0, 0.0, 0.25]
mass = 100.0
shape = { kind = "box", size = [1.0, 1.0, 0.5] }
"#;

const SHAKES: &str = r#"
[[environment.base_acceleration]]
direction = [1.0, 0.0, 0.0]
amplitude = "shaking"
scale = 4.0
"#;

/// The block on a floor that shakes.
fn on_floor() -> String {
    format!(
        "{DECK}{SHAKES}[environment]\ngravity = [0.0, 0.0, -9.81]\n[[contacts]]\nname = \"floor\"\n\
         surface = {{ shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nwith = \"block\"\n\
         damping = 1e4\nfriction = 0.2\nstiffness = 1962000.0\n"
    )
}

/// The same on another box.
fn on_box() -> String {
    on_floor().replace(
        "surface = { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }",
        "surface = { body = \"table\" }",
    ) + "[[bodies]]\nname = \"table\"\ncenter = [0.0, 0.0, -0.5]\nmass = 1000.0\n\
           shape = { kind = \"box\", size = [4.0, 4.0, 1.0] }\n[[supports]]\nat = \"table\"\nfix = \"all\"\n"
}

/// The same on a rail whose friction has the same limit.
fn on_rail() -> String {
    format!(
        "{DECK}{SHAKES}[[joints]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1.0, 0.0, 0.0]\n\
         from = {{ ground = [0.0, 0.0, 0.25] }}\nto = {{ body = \"block\" }}\nfriction_force = 196.2\nstick = 1e-5\n"
    )
}

/// A wheel on a pin, whose friction and load are those of the block for a unit of inertia.
fn on_pin() -> String {
    let wheel = DECK.replace("shape = { kind = \"box\", size = [1.0, 1.0, 0.5] }", "inertia = [1.0, 1.0, 1.0]");
    format!(
        "{wheel}[[loads]]\nat = \"block\"\nmoment = [0.0, 0.0, -4.0]\namplitude = \"shaking\"\n[[joints]]\nname = \"pin\"\n\
         kind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ ground = [0.0, 0.0, 0.25] }}\nto = {{ body = \"block\" }}\n\
         friction_moment = 1.962\nstick = 1e-4\n"
    )
}

/// Slip at the end, and the largest, of the block by Coulomb's law alone: Newmark's sliding block, in steps that leave 1e-6.
fn exact() -> [f64; 2] {
    let (mut x, mut v, mut most) = (0.0f64, 0.0f64, 0.0f64);
    let (h, limit) = (1e-5, 0.2 * 9.81);
    for k in 0..300_000 {
        let t = (f64::from(k) + 0.5) * h;
        let pull = if t < 2.0 { -4.0 * (TAU * t).sin() } else { 0.0 };
        let held = v == 0.0 && pull.abs() <= limit;
        let a = if held { 0.0 } else { pull - limit * if v == 0.0 { pull.signum() } else { v.signum() } };
        let next = v + h * a;
        // Friction stops what slides, and does not turn it round.
        let next = if v * next < 0.0 { 0.0 } else { next };
        x += 0.5 * h * (v + next);
        v = next;
        most = most.max(x.abs());
    }
    [x, most]
}

/// Where the block, or the angle at which the wheel, comes to rest.
fn left(deck: &str) -> f64 {
    let tables = tables_of(&read_deck(deck));
    let last = tables.rows("bodies.csv").into_iter().rfind(|row| row.text("body") == "block").unwrap();
    if deck.contains("name = \"pin\"") { 2.0 * last.number("qz") } else { last.number("x") }
}

/// The number behind a key in a message.
fn number(text: &str, key: &str) -> Option<f64> {
    let rest = text.split(key).nth(1)?;
    let end = rest.find([',', ' ', ')']).unwrap_or(rest.len());
    rest[..end].parse().ok()
}

/// What a deck is warned of beside its slip is no business here.
fn warning(deck: &str) -> Option<String> {
    run_with_warnings(deck).1.into_iter().find(|warning| warning.contains("after reversals slip begins"))
}

#[test]
fn slip_that_begins_with_a_speed_is_warned_of_and_the_remedy_does() {
    let [exact, largest] = exact();
    // The block comes to rest 5.88 mm from where it began, after slips of up to 134 mm.
    assert!((exact.abs() - 5.88e-3).abs() < 2e-5 && (largest - 0.134).abs() < 1e-3, "{exact} {largest}");
    for deck in [on_floor(), on_box(), on_rail(), on_pin()] {
        let text = warning(&deck).unwrap_or_else(|| panic!("no warning\n{deck}"));
        let off = (left(&deck).abs() - exact.abs()).abs();
        let told = number(&text, "up to about ").unwrap();
        // The estimate takes errors of single slips to last until their end, so that it is an upper one, by less than a factor of three.
        assert!(off > 0.02 * largest && told > 0.8 * off && told < 3.0 * off, "{off}: {text}");
        let step = number(&text, "`time_step` = ").unwrap();
        let mut stiff = deck.replace("time_step = 0.005", &format!("time_step = {step:?}"));
        if let Some(stiffness) = number(&text, "`stiffness` = ") {
            stiff = stiff.replace("stiffness = 1962000.0", &format!("stiffness = {stiffness:?}"));
        }
        if let Some(stick) = number(&text, "`stick` = ") {
            stiff = stiff
                .replace("stick = 1e-5", &format!("stick = {stick:?}"))
                .replace("stick = 1e-4", &format!("stick = {stick:?}"));
        }
        let rest = (left(&stiff).abs() - exact.abs()).abs();
        // The remedy is meant to leave a hundredth of the largest slip.
        assert!(rest < 0.01 * largest && warning(&stiff).is_none(), "{rest}: {text}\n{:?}", warning(&stiff));
    }
}

/// Slip that goes one way, that begins with a speed of the deck's, or that a landing begins, has no such error.
#[test]
fn slip_without_reversals_is_not_warned_of() {
    let steady = on_floor().replace(SHAKES, "[[loads]]\nat = \"block\"\nforce = [300.0, 0.0, 0.0]\n");
    let thrown = on_floor().replace(SHAKES, "").replace("mass = 100.0", "mass = 100.0\nvelocity = [2.0, 0.0, 0.0]");
    let landing = thrown
        .replace("center = [0.0, 0.0, 0.25]", "center = [0.0, 0.0, 0.26]")
        .replace("end_time = 3.0", "end_time = 0.5");
    let decks = [steady.replace("time_step = 0.005", "time_step = 0.002"), thrown, landing];
    for deck in decks {
        assert_eq!(warning(&deck), None, "{deck}");
    }
}

/// A look inside a step is no further step: the warning, with its numbers, is that of a run with hardly any output.
#[test]
fn output_inside_steps_does_not_change_the_warning() {
    let deck = on_floor().replace("newmark", "esdirk3").replace("time_step = 0.005", "time_step = \"auto\"");
    let [few, many] = [16.0, 512.0]
        .map(|rows: f64| warning(&format!("{deck}[output]\ninterval = {:?}\n", 3.0 / rows)).expect("a warning"));
    assert_eq!(few, many);
}
