//! Scenes in which nothing happens: what rounding makes of them is no motion, and no warning.

use assert_cmd::Command;

/// Standard error of a run of the deck, which is to end well.
fn said(deck: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("still.toml"), deck).expect("a deck");
    let done =
        Command::cargo_bin("rdsolve").expect("the command").current_dir(folder.path()).arg("still.toml").assert();
    String::from_utf8(done.code(0).get_output().stderr.clone()).expect("text")
}

const HUNG: &str = r#"
environment.gravity = [0.0, 0.0, -9.81]
[[bodies]]
name = "bob"
center = [0.0, 0.0, -0.7]
mass = 2.0
inertia = [0.03, 0.05, 0.02]
[[joints]]
name = "pivot"
KIND
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "bob" }
[[stages]]
name = "load"
kind = "static"
duration = 1.0
time_step = 0.25
[[stages]]
name = "rest"
kind = "dynamic"
duration = 0.01
time_step = 0.001
integrator = { scheme = "SCHEME" }
"#;

#[test]
fn what_hangs_at_rest_makes_no_energy() {
    for kind in ["kind = \"spherical\"", "kind = \"revolute\"\naxis = [0.0, 1.0, 0.0]"] {
        for scheme in ["newmark", "generalized-alpha", "wilson-theta", "esdirk3", "central-difference"] {
            let said = said(&HUNG.replace("KIND", kind).replace("SCHEME", scheme));
            assert!(!said.contains("warning"), "{kind} {scheme}: {said}");
        }
    }
}

/// Three bodies on springs in an oblique row; loads act in none of the stages, or the base stands still in both.
#[test]
fn what_nothing_moves_is_in_equilibrium() {
    let mut row = String::new();
    let at = |k: usize| [0.31 * k as f64, 0.17 * k as f64, 0.53 * k as f64];
    for k in 0..3 {
        let from = if k == 0 { format!("ground = {:?}", at(0)) } else { format!("body = \"b{}\"", k - 1) };
        row += &format!(
            "[[bodies]]\nname = \"b{k}\"\ncenter = {:?}\nmass = {}\ninertia = [0.07, 0.06, 0.05, 0.004, 0.003, 0.002]\n\
             [[links]]\nname = \"l{k}\"\nfrom = {{ {from} }}\nto = {{ body = \"b{k}\", point = {:?} }}\n\
             bushing = [1526.6, 3502.0, 1329.6, 173.6, 345.3, 56.6]\nbushing_damping = [3.0, 5.0, 2.0, 0.1, 0.2, 0.1]\n\
             axes = [[-0.79, 0.37, 0.48], [0.08, -0.72, 0.69]]\n",
            at(k),
            2.7 + 0.4 * k as f64,
            at(k)
        );
    }
    let stages = "[[stages]]\nname = \"d\"\nkind = \"dynamic\"\nduration = 0.002\ntime_step = 0.001\n\
                  [[stages]]\nname = \"f\"\nkind = \"frequency-response\"\nfrequencies = { from = 0.3, to = 20.0, steps = 5 }\n";
    let load = "[[loads]]\nat = \"b1\"\nforce = [1.0, 2.0, 3.0]\namplitude = \"swing\"\n[amplitudes.swing]\nkind = \"harmonic\"\n";
    let said = said(&format!("{row}{stages}{load}"));
    assert!(!said.contains("energy growth") && !said.contains("equilibrium"), "{said}");
}

/// Drives and hinges along any axis hold bodies on which nothing else acts.
#[test]
fn what_joints_alone_hold_is_held_along_any_axis() {
    for axis in [[1.0, 0.0, 0.0], [1.0, 1e-4, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 3.0], [-0.3, 0.2, 0.9]] {
        for kind in ["prismatic", "revolute"] {
            for gravity in ["", "environment.gravity = [0.0, 0.0, -9.81]\n"] {
                let text = format!(
                    "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.5 }}\n{gravity}\
                     amplitudes.way = {{ kind = \"ramp\", end = 1.0 }}\n\
                     bodies = [{{ name = \"slide\", center = [1.0, 0.0, 0.0], mass = 1.0, inertia = [1.0, 1.0, 1.0] }}]\n\
                     [[joints]]\nname = \"drive\"\nkind = \"{kind}\"\nfrom = {{ ground = [1.0, 0.0, 0.0] }}\nto = {{ body = \"slide\" }}\n\
                     axis = {axis:?}\nmotion = {{ position = 0.2, amplitude = \"way\" }}\n\
                     [[expect]]\nat = \"drive\"\nquantity = \"coordinate\"\ntime = 1.0\nvalue = 0.2\ntolerance = 1e-9\nsource = \"its drive\"\n"
                );
                let said = said(&text);
                assert!(!said.contains("warning"), "{kind} {axis:?}: {said}");
            }
        }
    }
}

/// A rack along any axis, geared to a wheel on a spring, moves by r²/k of the force on it, whichever end is named first.
#[test]
fn a_rack_moves_along_any_axis() {
    for axis in [[1.0, 0.0, 0.0], [1.0, 1e-3, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 2.0, 3.0]] {
        for [from, to] in [["from", "to"], ["to", "from"]] {
            let text = format!(
                "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.5 }}\n\
                 [[bodies]]\nname = \"wheel\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[bodies]]\nname = \"rack\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
                 [[joints]]\nname = \"axle\"\nkind = \"revolute\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"wheel\" }}\n\
                 axis = [0.0, 0.0, 1.0]\nstiffness = 40.0\n\
                 [[joints]]\nname = \"slide\"\nkind = \"prismatic\"\n{from} = {{ ground = [1.0, 0.0, 0.0] }}\n{to} = {{ body = \"rack\" }}\n\
                 axis = {axis:?}\ngear = {{ joint = \"axle\", ratio = 0.2 }}\neffort = {{ value = 1.0 }}\n\
                 [[expect]]\nat = \"slide\"\nquantity = \"coordinate\"\ntime = 1.0\nvalue = 0.001\ntolerance = 1e-8\nsource = \"r^2/k\"\n"
            );
            let said = said(&text);
            assert!(!said.contains("warning"), "{axis:?} {from}: {said}");
        }
    }
}

/// Moments that do no work on a driven slide and on a weld: neither a jump of the equilibrium nor missing work.
#[test]
fn moments_that_joints_take_do_no_work() {
    let body = "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.5 }\namplitudes.way = { kind = \"ramp\", end = 1.0 }\n\
                loads = [{ at = \"b\", moment = [-0.52, 1.27, 0.86] }]\n\
                bodies = [{ name = \"b\", center = [0.2, 0.3, -0.4], mass = 1.0, inertia = [1.0, 1.0, 1.0] }]\n";
    let slide = "[[joints]]\nname = \"j\"\nkind = \"prismatic\"\nfrom = { body = \"b\" }\nto = { ground = [0.2, 0.3, -0.4] }\n\
                 axis = [-0.2, -0.6, 0.8]\nmotion = { position = 0.1, amplitude = \"way\" }\n";
    let weld = "[[joints]]\nname = \"j\"\nkind = \"fixed\"\nfrom = { body = \"b\", point = [1.13, 0.0, -0.39] }\n\
                to = { ground = [1.13, 0.0, -0.39] }\n";
    for joint in [slide, weld] {
        let said = said(&format!("{body}{joint}"));
        assert!(!said.contains("work"), "{said}");
    }
}
