//! What messages propose works: each row is a deck, words of its message, and the change that the message proposes. After the change the
//! message is gone and the run reaches its end.

use crate::solve::statics::{column, head};
use crate::support::truss::TRUSS;
use insta::assert_snapshot;

/// A deck, words of its message, and the deck changed as the message from these words on proposes.
type Row = (String, &'static str, fn(&str, &str) -> String);

/// The value that a message gives for a key.
fn given<'m>(message: &'m str, key: &str) -> &'m str {
    value_after(message, &format!("`{key}` = "))
}

/// The word after other words of a message.
fn value_after<'m>(message: &'m str, words: &str) -> &'m str {
    let (_, rest) = message.split_once(words).unwrap_or_else(|| panic!("`{words}` is not said: {message}"));
    let value = rest.split([' ', ',', ';', ':', '(', '`', '?', '\n']).next().unwrap_or_default().trim_end_matches('.');
    assert!(!value.is_empty(), "no value behind `{words}`: {message}");
    value
}

/// The deck with a key at another value.
fn with(deck: &str, key: &str, value: &str) -> String {
    let is_line = |line: &&str| line.trim_start().starts_with(&format!("{key} = "));
    let line = deck.lines().find(is_line).unwrap_or_else(|| panic!("no `{key}`\n{deck}"));
    deck.replacen(line, &format!("{key} = {value}"), 1)
}

/// The deck with a key at the value that the message gives.
fn obeyed(deck: &str, message: &str, key: &str) -> String {
    with(deck, key, given(message, key))
}

/// The deck with other words in place of these.
fn replaced(deck: &str, old: &str, new: &str) -> String {
    assert!(deck.contains(old), "{old}\n{deck}");
    deck.replace(old, new)
}

/// The exit code and the messages of a run of the program.
fn run(deck: &str) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut command = assert_cmd::Command::cargo_bin("rdsolve").unwrap();
    let output = command.current_dir(&folder).args(["run", "deck.toml", "-o", "out"]).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

/// The rest of a message's line from these words on, up to what is rounding: residuals, and amplitudes at a resonance.
fn shown(message: &str) -> &str {
    let line = message.lines().next().unwrap_or_default().trim_end_matches("; results are valid up to this time");
    let ends = ["; the largest unbalanced", "; at frequency"].map(|words| line.find(words));
    &line[..ends.into_iter().flatten().min().unwrap_or(line.len())]
}

/// Fails for each row whose message is missing, or whose change leaves the message or another error; compares the messages with a snapshot.
fn hold(name: &str, rows: Vec<Row>) {
    let mut messages = Vec::new();
    for (deck, words, change) in rows {
        let (_, said) = run(&deck);
        let start = said.find(words).unwrap_or_else(|| panic!("`{words}` is not said: {said:?}\n{deck}"));
        let message = &said[start..];
        messages.push(shown(message).to_owned());
        let changed = change(&deck, message);
        let (code, rest) = run(&changed);
        assert!(code == 0 && !rest.contains(words), "the remedy fails: {message}\n{code} {rest}\n{changed}");
    }
    messages.dedup();
    assert_snapshot!(name, messages.join("\n\n"));
}

/// The head of a dynamic analysis.
fn dynamic(end_time: f64, time_step: &str, scheme: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time:?}\ntime_step = {time_step}\n[integrator]\nscheme = \"{scheme}\"\n"
    )
}

/// A ball that falls onto a floor from this height.
fn ball(time_step: &str, height: f64, stiffness: f64) -> String {
    dynamic(0.2, time_step, "newmark")
        + &format!(
            r#"[[bodies]]
name = "ball"
center = [0.0, 0.0, {height:?}]
mass = 1.0
velocity = [0.0, 0.0, -10.0]
shape = {{ kind = "sphere", radius = 0.1 }}
[[contacts]]
name = "stop"
surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
with = "ball"
stiffness = {stiffness:?}
"#
        )
}

const BOB: &str = "[[bodies]]\nname = \"bob\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.5, 0.5, 0.5]\n";

/// A mass of 1 on a spring of 1e4: ω = 100, and central differences are stable up to 0.02.
fn oscillator(time_step: &str, scheme: &str) -> String {
    dynamic(1.0, time_step, scheme)
        + BOB
        + "velocity = [1.0, 0.0, 0.0]\n[[links]]\nname = \"spring\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"bob\" }\n\
           direction = [1.0, 0.0, 0.0]\nstiffness = 1e4\n"
}

/// An explicit step beyond the limit that may not be cut.
fn too_long() -> String {
    oscillator("0.03\nleast_step = 0.03", "central-difference")
}

/// A body on a hinge, at rest.
fn pendulum() -> String {
    dynamic(0.1, "1e-2", "newmark")
        + BOB
        + r#"[[joints]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "bob", point = [0.0, 0.0, 0.0] }
"#
}

/// A clamped arm along z with another analysis, without its load.
fn arm(analysis: &str, more: &str) -> String {
    let deck = column(1.0, 1.0, "[0.0, 1.0, 0.0]", "");
    let (head, rest) = (deck.find("kind = ").unwrap(), deck.find("[materials").unwrap());
    let deck = format!("{}{analysis}\n{}", &deck[..head], &deck[rest..]);
    deck.split("[[loads]]").next().unwrap().to_owned() + more
}

/// A cantilever along x that its load bends far, in one step with at most so many iterations.
fn bent(limit: usize) -> String {
    let head = head(1.0, &format!("least_step = 1.0\n[iteration]\nlimit = {limit}\n"));
    head + r#"[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
[[beams]]
name = "c"
path = ["a", "b"]
elements = 10
section = "s"
material = "steel"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "a"
fix = "all"
[[loads]]
at = "b"
force = [0.0, 0.0, -300.0]
"#
}

/// The shallow truss, which snaps through under 38.2, under a load that grows with the time.
fn pressed_truss(end_time: f64, points: &str, more: &str) -> String {
    format!(
        "[analysis]\nkind = \"static\"\nend_time = {end_time:?}\ntime_step = 1.0\n{more}{TRUSS}[[loads]]\nat = \"crown\"\n\
         force = [0.0, 0.0, -1.0]\namplitude = \"a\"\n[amplitudes.a]\nkind = \"table\"\npoints = {points}\nafter = \"hold\"\n"
    )
}

/// A spinning body on springs and its modes.
fn rotor(analysis: &str, inertia: &str) -> String {
    format!(
        r#"[analysis]
kind = "modal"
{analysis}
[[bodies]]
name = "top"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = {inertia}
angular_velocity = [0.0, 0.0, 50.0]
[[links]]
name = "k"
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ body = "top" }}
bushing = [1e3, 1e3, 1e3, 1e3, 1e3, 1e3]
"#
    )
}

/// A ship whose yaw alone is fixed, rolling and pitching.
fn ship() -> String {
    dynamic(3.0, "0.02", "newmark")
        + r#"[[bodies]]
name = "ship"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 2.0]
[[supports]]
at = "ship"
fix = ["ux", "uy", "uz", "rz"]
[[initial]]
at = "ship"
angular_velocity = [0.5, 0.0, 0.0]
[[loads]]
at = "ship"
moment = [0.0, 1.0, 0.0]
amplitude = "b"
[amplitudes.b]
kind = "sine-squared"
angular_frequency = 1.0
"#
}

/// A mass behind a bar, one end of which has neither mass nor support.
fn loose_bar() -> String {
    dynamic(0.1, "1e-3", "newmark")
        + r#"[points]
p = [0.0, 0.0, 0.0]
q = [1.0, 0.0, 0.0]
[[masses]]
at = "q"
mass = 1.0
[[bars]]
name = "b"
path = ["p", "q"]
axial_stiffness = 100.0
mass_per_length = 0.0
"#
}

/// A response of the arm to a harmonic force.
fn response(keys: &str) -> String {
    let load =
        "[[loads]]\nat = \"b\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"h\"\n[amplitudes.h]\nkind = \"harmonic\"\n";
    arm(&format!("kind = \"frequency-response\"\n{keys}"), load)
}

const RANGE: &str = "frequencies = { from = 1.0, to = 50.0, steps = 3 }";
const FOLLOWER: &str = "[[loads]]\nat = \"b\"\nfollower = true\nforce = [0.0, 0.0, -1.0]\n";
const PRESS: &str = "[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -1.0]\n";

#[test]
fn remedies_of_steps_work() {
    hold(
        "steps",
        vec![
            (ball("1e-4", 0.5, 9070.0), "the penetration of", |deck, said| obeyed(deck, said, "stiffness")),
            (ball("2e-3", 0.5, 1e6), "energy growth", |deck, _| with(deck, "time_step", "2e-4")),
            (too_long(), "too long for central differences", |deck, said| {
                with(&obeyed(deck, said, "time_step"), "least_step", "1e-3")
            }),
            (too_long(), "too long for central differences", |deck, _| {
                with(&with(deck, "time_step", "\"auto\""), "least_step", "1e-3")
            }),
            (too_long(), "too long for central differences", |deck, _| with(deck, "scheme", "\"newmark\"")),
            (oscillator("0.02", "bathe"), "numerical dissipation", |deck, _| with(deck, "time_step", "0.002")),
            (
                replaced(&pendulum(), "inertia", "velocity = [1.0, 0.0, 0.0]\ninertia"),
                "initial velocities violate the joints",
                |deck, _| with(deck, "velocity", "[0.0, 0.0, 0.0]"),
            ),
            (ship(), "has drifted to", |deck, _| replaced(deck, "\"rz\"]\n", "\"rz\"]\nrotation = \"vector\"\n")),
            (loose_bar(), "`p` has no mass", |deck, _| deck.to_owned() + "[[masses]]\nat = \"p\"\nmass = 1.0\n"),
        ],
    );
}

#[test]
fn remedies_of_statics_work() {
    let unheld = column(10.0, 0.5, "[0.0, 1.0, 0.0]", "")
        .replace("fix = \"all\"", "fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"rz\"]");
    hold(
        "statics",
        vec![
            (unheld, "is singular at", |deck, _| with(deck, "fix", "\"all\"")),
            // A load of a thousandth of the others in the direction of the mode.
            (column(180.0, 0.05, "[0.0, 1.0, 0.0]", ""), "the structure buckles", |deck, said| {
                assert!(said.contains("moves `b` most, in direction ux"), "{said}");
                deck.to_owned() + "[[loads]]\nat = \"b\"\nforce = [0.18, 0.0, 0.0]\n"
            }),
            (column(180.0, 0.1, "[1.0, 0.0, 0.0]", ""), "buckles out of its plane", |deck, said| {
                assert!(said.contains("Fix uy of `b`"), "{said}");
                deck.to_owned() + "[[supports]]\nat = \"b\"\nfix = [\"uy\"]\n"
            }),
            (bent(5), "forbids shorter steps", |deck, said| obeyed(deck, said, "least_step")),
            (bent(20), "do more work than is stored", |deck, _| {
                with(&with(deck, "time_step", "0.1"), "least_step", "0.1")
            }),
            (pressed_truss(39.0, "[[0.0, 0.0], [100.0, 100.0]]", ""), "reaches its limit load", |deck, said| {
                let control = given(said, "control");
                replaced(deck, "time_step", &format!("control = {control}\ntime_step"))
            }),
            (
                pressed_truss(30.0, "[[0.0, 0.0], [10.0, 10.0]]", "control = \"arc-length\"\n"),
                "no load or prescribed motion changes",
                |deck, _| replaced(deck, "control = \"arc-length\"\n", ""),
            ),
        ],
    );
}

/// The deck with damped modes.
fn damped(deck: &str, _: &str) -> String {
    replaced(deck, "modes = 3", "modes = 3\ndamped = true")
}

#[test]
fn remedies_of_modes_work() {
    hold(
        "modes",
        vec![
            (arm("kind = \"modal\"\nup_to = 0.5", ""), "no mode lies below", |deck, said| {
                with(deck, "up_to", value_after(said, "Give `up_to` = "))
            }),
            (arm("kind = \"modal\"\nmodes = 500", ""), "fewer than `modes`", |deck, said| {
                with(deck, "modes", value_after(said, "Give `modes` = "))
            }),
            (arm("kind = \"modal\"\nmodes = 3", FOLLOWER), "have no potential", damped),
            (rotor("modes = 3", "[1.0, 1.0, 2.0]"), "omit its gyroscopic moments", damped),
            (rotor("modes = 3\ndamped = true", "[1.0, 1.4, 2.0]"), "not symmetric about its spin axis", |deck, _| {
                with(deck, "inertia", "[1.2, 1.2, 2.0]")
            }),
            // Beck's column flutters at 20.05 EI/L² = 1316; a stiffness of ten times carries the load.
            (
                arm("kind = \"modal\"\nmodes = 4\ndamped = true", &FOLLOWER.replace("-1.0", "-2000.0")),
                "grows with rate",
                |deck, _| with(deck, "youngs_modulus", "2.1e12"),
            ),
            (arm("kind = \"buckling\"\nmodes = 1", ""), "buckling needs loads", |deck, _| deck.to_owned() + PRESS),
            (
                arm("kind = \"buckling\"\nmodes = 1", &PRESS.replace("-1.0", "1.0")),
                "the reversed loads buckle",
                |deck, _| with(deck, "force", "[0.0, 0.0, -1.0]"),
            ),
            (arm("kind = \"buckling\"\nmodes = 2000", PRESS), "no more within reach", |deck, said| {
                obeyed(deck, said, "modes")
            }),
            (
                response(&format!("method = \"modal\"\nmodes = 2\ndamping_ratio = 0.02\n{RANGE}")),
                "the modes found reach",
                |deck, said| replaced(deck, "modes = 2", &format!("up_to = {}", given(said, "up_to"))),
            ),
            (
                response(&format!("method = \"modal\"\nmodes = 2\n{RANGE}")) + "[damping]\nbeta = 1e-3\n",
                "the modes found reach",
                |deck, said| replaced(&obeyed(deck, said, "method"), "modes = 2\n", ""),
            ),
            (
                response(
                    "method = \"direct\"\nfrequencies = { from = 1.0, to = 50.0, steps = 3, around_resonances = 1 }",
                ),
                "nothing limits the motion",
                |deck, said| format!("{deck}[damping]\nbeta = {}\n", given(said, "beta")),
            ),
        ],
    );
}

#[test]
fn remedies_of_amplitudes_and_names_work() {
    let and = |more: &str| pendulum() + more;
    let table = |points: &str| {
        and(&format!(
            "[[loads]]\nat = \"bob\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"push\"\n[amplitudes.push]\nkind = \"table\"\npoints = {points}\n"
        ))
    };
    hold(
        "amplitudes_and_names",
        vec![
            (table("[[0.0, 0.0], [0.05, 1.0]]"), "it holds its last value", |deck, _| {
                deck.to_owned() + "after = \"hold\"\n"
            }),
            (table("[[0.0, 0.0], [0.05, 1.0]]"), "it holds its last value", |deck, _| {
                deck.to_owned() + "after = \"zero\"\n"
            }),
            (table("[[0.05, 1.0], [0.2, 0.0]]"), "it has its first value", |deck, _| {
                deck.to_owned() + "before = \"hold\"\n"
            }),
            (and("[points]\nlone = [3.0, 0.0, 0.0]\n"), "nothing is connected to point `lone`", |deck, _| {
                replaced(deck, "[points]\nlone = [3.0, 0.0, 0.0]\n", "")
            }),
            (
                and("[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\n"),
                "nothing uses material",
                |deck, _| deck.split("[materials").next().unwrap().to_owned(),
            ),
            (and("limits = [0.0, 450.0]\nlimit_stiffness = 1e3\n"), "looks like degrees", |deck, said| {
                replaced(deck, "450.0", value_after(said, "degrees are "))
            }),
            (pendulum().replace("mass =", "mas ="), "there is no key `mas`", |deck, said| {
                replaced(deck, "mas =", &format!("{} =", value_after(said, "did you mean `")))
            }),
            (pendulum().replace("\"revolute\"", "\"revolut\""), "cannot be `revolut`", |deck, said| {
                replaced(deck, "revolut\"", &format!("{}\"", value_after(said, "did you mean `")))
            }),
            (pendulum().replace("body = \"bob\"", "body = \"bib\""), "no body is named", |deck, said| {
                replaced(deck, "bib", value_after(said, "did you mean `"))
            }),
            (pendulum().replace("axis = [0.0, 1.0, 0.0]\n", ""), "needs `axis`", |deck, said| {
                let key = value_after(said, "add `");
                replaced(deck, "\"revolute\"", &format!("\"revolute\"\n{key} = [0.0, 1.0, 0.0]"))
            }),
            (and("lead = 0.1\n"), "`lead` does not apply", |deck, _| replaced(deck, "lead = 0.1\n", "")),
            (pendulum().replace("mass = 1.0\n", "mass = 1.0\nmass = 1.0\n"), "twice", |deck, _| {
                replaced(deck, "mass = 1.0\nmass = 1.0\n", "mass = 1.0\n")
            }),
            (
                pendulum().replace("body = \"bob\", point", "ground"),
                "both ends of joint `hinge` are fixed",
                |deck, _| deck.split("[[joints]]").next().unwrap().to_owned(),
            ),
            (
                and("[[links]]\nname = \"b\"\nfrom = { body = \"bob\" }\nto = { body = \"bob\" }\nstiffness = 1.0\n"),
                "to itself",
                |deck, _| replaced(deck, "to = { body = \"bob\" }", "to = { ground = [2.0, 0.0, 0.0] }"),
            ),
        ],
    );
}

#[test]
fn remedies_of_values_work() {
    let scheme = |name: &str, more: &str| pendulum().replace("\"newmark\"\n", &format!("\"{name}\"\n{more}\n"));
    let step = |step: &str| with(&pendulum(), "time_step", step);
    let of_steel = |more: &str| {
        let column = column(1.0, 0.5, "[0.0, 1.0, 0.0]", "");
        column.replace("model = \"elastic\"", &format!("model = \"elastic-plastic\"\n{more}"))
    };
    let explicit = |more: &str| {
        let analysis =
            "kind = \"dynamic\"\nend_time = 1e-3\ntime_step = \"auto\"\n[integrator]\nscheme = \"central-difference\"";
        arm(&format!("{analysis}\n{more}"), "[[loads]]\nat = \"b\"\nforce = [1.0, 0.0, 0.0]\n")
    };
    let in_mm = column(1e-6, 0.5, "[0.0, 1.0, 0.0]", "").replace("title", "units = \"mm-t-s\"\ntitle");
    hold(
        "values",
        vec![
            (scheme("newmark", "gamma = 0.6"), "is of first order", |deck, said| obeyed(deck, said, "gamma")),
            (scheme("newmark", "beta = 0.2"), "not unconditionally stable", |deck, said| obeyed(deck, said, "beta")),
            (scheme("wilson-theta", "theta = 1.2"), "not unconditionally stable", |deck, said| {
                obeyed(deck, said, "theta")
            }),
            (step("0.2"), "is longer than the run", |deck, said| with(deck, "time_step", value_after(said, "give "))),
            (step("\"0.01\""), "cannot be `0.01`", |deck, _| with(deck, "time_step", "0.01")),
            (step("1e-2\nleast_step = 0.1"), "must not be above `time_step`", |deck, said| {
                with(deck, "least_step", value_after(said, "which is "))
            }),
            (step("\"auto\"\nerror_tolerance = 1e-15"), "below the rounding error of numbers", |deck, said| {
                with(deck, "error_tolerance", value_after(said, "give "))
            }),
            (ball("1e-4", 0.05, 1e6), "begins closed", |deck, said| {
                let up: f64 = value_after(said, "move it out by ").parse().unwrap();
                with(deck, "center", &format!("[0.0, 0.0, {:?}]", 0.05 + up))
            }),
            (
                explicit("").replace("elements = 10", "elements = 10\nmass = \"consistent\""),
                "consistent masses are",
                |deck, said| obeyed(deck, said, "mass"),
            ),
            (explicit("mass_scaling_step = 1e-2"), "is longer than the motion", |deck, _| {
                with(deck, "mass_scaling_step", "1e-5")
            }),
            (
                column(1.0, 0.5, "[0.0, 1.0, 0.0]", "") + "[damping]\nalpha = 1.0\n",
                "no effect in a static",
                |deck, _| replaced(deck, "[damping]\nalpha = 1.0\n", ""),
            ),
            (in_mm, "`youngs_modulus` is not plausible", |deck, _| {
                with(&with(deck, "youngs_modulus", "210000.0"), "density", "7.85e-9")
            }),
            (of_steel("yield_stress = 3e8\nfailure_strain = 25.0"), "fails at a plastic strain", |deck, _| {
                with(deck, "failure_strain", "0.25")
            }),
            (of_steel("yield_stress = 275.0"), "yields at a strain of", |deck, said| {
                with(deck, "yield_stress", value_after(said, "is it "))
            }),
            (
                response(&format!("method = \"modal\"\nmodes = 60\ndamping_ratio = 2.0\n{RANGE}")),
                "nothing vibrates",
                |deck, said| with(deck, "damping_ratio", value_after(said, "such as ")),
            ),
        ],
    );
}
