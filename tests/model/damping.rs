//! Rayleigh damping: on what its factors act, and relative to what.

use crate::support::{node, read_deck, run_to_the_end, warnings_of};
use rdsolve::solve::Frame;
use std::f64::consts::TAU;

/// A damped mode of each kind of spring: the angular frequency without damping, and the part of critical damping.
const SPRINGS: [(f64, f64); 6] = [(10.0, 0.01), (20.0, 0.02), (30.0, 0.06), (40.0, 0.08), (50.0, 0.01), (60.0, 0.06)];

/// Springs on masses of their own: a link, one by a table, a bushing (along and about an axis), a sliding joint with a damper alone and a
/// hinge that yields. The global factor is 0.002, that of the bushing 0.004.
fn springs() -> String {
    let sites = [("c", 10.0, 1.0), ("d", 15.0, 1.0), ("e", 20.0, 2.0)];
    let body = |(name, y, j): (&str, f64, f64)| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [0.0, {y:?}, 0.0]\nmass = 2.0\ninertia = [{j:?}, {j:?}, {j:?}]\n"
        )
    };
    let bodies: String = sites.into_iter().map(body).collect();
    format!(
        r#"
[analysis]
kind = "modal"
damped = true
modes = 6
[points]
a = [1.0, 0.0, 0.0]
b = [1.0, 5.0, 0.0]
[[masses]]
at = ["a", "b"]
mass = 2.0
[[supports]]
at = ["a", "b"]
fix = ["uy", "uz"]
[[supports]]
at = "c"
fix = ["uy", "uz", "rx", "ry"]
{bodies}
[[links]]
name = "line"
from = {{ ground = [0.0, 0.0, 0.0] }}
to = {{ node = "a" }}
stiffness = 200.0
[[links]]
name = "table"
from = {{ ground = [0.0, 5.0, 0.0] }}
to = {{ node = "b" }}
law = "table"
points = [[-1.0, -800.0], [1.0, 800.0]]
[[links]]
name = "bushing"
from = {{ ground = [0.0, 10.0, 0.0] }}
to = {{ body = "c" }}
bushing = [1800.0, 1.0, 1.0, 1.0, 1.0, 1600.0]
damping = {{ beta = 0.004 }}
[[joints]]
name = "slide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
from = {{ ground = [0.0, 15.0, 0.0] }}
to = {{ body = "d" }}
stiffness = 5000.0
damping = {{ beta = 0.0, viscous = 2.0 }}
[[joints]]
name = "hinge"
kind = "revolute"
axis = [0.0, 0.0, 1.0]
from = {{ ground = [0.0, 20.0, 0.0] }}
to = {{ body = "e" }}
backbone = [[0.01, 72.0], [0.05, 80.0]]
[damping]
beta = 0.002
"#
    )
}

/// ζ = β ω/2 where β acts, ω = √(k/m); of a damper c/(2 √(k m)).
#[test]
fn beta_damps_springs_of_links_joints_and_bushings() {
    let expect = |(number, (natural, ratio)): (usize, &(f64, f64))| {
        let damped = natural * (1.0 - ratio * ratio).sqrt();
        // The mode of one mass alone: rounding of the eigenvalue.
        let row = |quantity: &str, value: f64| {
            format!("[[expect]]\nmode = {number}\nquantity = \"{quantity}\"\nvalue = {value:?}\ntolerance = 1e-9\n")
        };
        row("angular_frequency", damped) + &row("damping_ratio", *ratio)
    };
    let expected: String = (1..).zip(&SPRINGS).map(expect).collect();
    let done = run_to_the_end(&read_deck(&(springs() + &expected)), &mut |_: &Frame| Vec::new());
    assert_eq!(done.verdicts.len(), 2 * SPRINGS.len());
    for verdict in done.verdicts {
        assert!(verdict.passed, "{verdict:?}");
    }
}

/// A mast on a foot that the ground shakes, or that moves as the ground does.
fn mast(foot: &str, more: &str) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = 2.0
time_step = 0.01
[integrator]
scheme = "newmark"
[iteration]
tolerance = 1e-10
[points]
a = [0.0, 0.0, 0.0]
b = [0.0, 0.0, 3.0]
[sections.tube]
shape = "tube"
radius = 0.05
thickness = 0.005
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[[beams]]
name = "mast"
path = ["a", "b"]
elements = 2
material = "steel"
section = "tube"
orientation = [0.0, 1.0, 0.0]
mass = "consistent"
[[masses]]
at = "b"
mass = 200.0
[amplitudes.quake]
kind = "table"
points = [[0.0, 0.0], [0.25, 2.0], [0.5, 0.0], [4.0, 0.0]]
{foot}
{more}
"#
    )
}

const SHAKEN: &str = "[[supports]]\nat = \"a\"\nfix = \"all\"\n[[environment.base_acceleration]]\ndirection = [1.0, 0.0, 0.0]\namplitude = \"quake\"\n";
const MOVED: &str = "[[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\nmotion = { ux = { amplitude = \"quake\", history = \"acceleration\" } }\n";

/// Sway of the tip against the foot, and the energies that damping took, that came from outside and that are missing.
fn sway(text: &str) -> Vec<[f64; 4]> {
    let model = read_deck(text);
    let [a, b] = ["a", "b"].map(|name| node(&model, name));
    let mut probe = |frame: &Frame| {
        let [foot, tip] = [a, b].map(|at| frame.state.nodes[at].x.x);
        let energy = frame.derived.energy.expect("energies");
        vec![tip - foot, energy.damping, energy.external, energy.numerical]
    };
    run_to_the_end(&model, &mut probe).rows.into_iter().map(|row| [row[0], row[1], row[2], row[3]]).collect()
}

fn largest(rows: &[[f64; 4]], column: usize) -> f64 {
    rows.iter().map(|row| row[column].abs()).fold(0.0, f64::max)
}

#[test]
fn alpha_damps_motion_against_a_support_that_moves() {
    let damping = "[damping]\nalpha = 1.5\n";
    let (shaken, moved) = (sway(&mast(SHAKEN, damping)), sway(&mast(MOVED, damping)));
    let apart = shaken.iter().zip(&moved).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
    // The way of the foot is exact in one and the scheme's in the other: second order in the step, 1.1e-3 here and 2.6e-4 with half the
    // step. Without frames the sway is off by 21 %.
    assert!(apart < 2e-3 * largest(&shaken, 0), "{apart}");
    let [of_shaken, of_moved] = [&shaken, &moved].map(|rows| rows[rows.len() - 1]);
    // What is dissipated is the same; the trapezoidal rule sums it with an error of second order, 3.1e-3 here.
    assert!((of_shaken[1] - of_moved[1]).abs() < 5e-3 * of_shaken[1], "{of_shaken:?} {of_moved:?}");
    assert!(largest(&moved, 3) < 2e-3 * largest(&moved, 2), "{}", largest(&moved, 3));
}

/// The factor of the only part is that of the scene: the rest has none.
#[test]
fn a_factor_of_a_part_replaces_that_of_the_scene() {
    let own = |damping: &str, more: &str| {
        let text = mast(SHAKEN, more).replace("mass = \"consistent\"", &format!("mass = \"lumped\"\n{damping}"));
        sway(&text.replace("[[masses]]\nat = \"b\"\nmass = 200.0\n", ""))
    };
    let of_scene = own("", "[damping]\nalpha = 8.0\nbeta = 1e-3\n");
    for given in [
        own("damping = { alpha = 8.0, beta = 1e-3 }", ""),
        own("damping = { alpha = 8.0 }", "[damping]\nalpha = 1.0\nbeta = 1e-3\n"),
    ] {
        let apart = of_scene.iter().zip(&given).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
        // Rounding, and what the iteration leaves.
        assert!(apart < 1e-8 * largest(&of_scene, 0), "{apart}");
    }
    let free = own("damping = { alpha = 0.0, beta = 0.0 }", "[damping]\nalpha = 8.0\nbeta = 1e-3\n");
    assert_eq!(largest(&free, 1), 0.0);
    assert!(largest(&of_scene, 1) > 0.0);
}

/// A rotor that its support turns is damped against the support: the steady moment is zero, and not α J ω.
#[test]
fn alpha_does_not_brake_what_a_support_turns() {
    let foot = "[amplitudes.start]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.5, 2.0], [4.0, 2.0]]\n[[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\nmotion = { rx = { amplitude = \"start\", history = \"velocity\" } }\n";
    let model = read_deck(&mast(foot, "[damping]\nalpha = 20.0\nbeta = 1e-3\n[output]\nreactions = true\n"));
    let at = model.constraints.restraints.iter().position(|held| held.motion.is_some()).expect("a motion");
    let mut moment = 0.0;
    run_to_the_end(&model, &mut |frame: &Frame| {
        moment = frame.reactions[at];
        Vec::new()
    });
    // α J ω = 20 · 200 · 9 · 2 = 7.2e4 of the mass alone; what rings of the start has died away to less than a thousandth of it.
    assert!(moment.abs() < 72.0, "{moment}");
}

/// The greatest moment of the drive in the last tenth of a run, by the foot's supports.
fn moment_of_drive(foot: &str, damping: &str) -> f64 {
    let start = "[amplitudes.start]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.5, 2.0], [4.0, 2.0]]\n";
    let more = format!("{damping}[output]\nreactions = true\n");
    let model = read_deck(&mast(&format!("{start}{foot}"), &more));
    let at = model.constraints.restraints.iter().position(|held| held.motion.is_some()).expect("a motion");
    let mut moment = 0.0f64;
    run_to_the_end(&model, &mut |frame: &Frame| {
        moment = if frame.state.time < 1.8 { 0.0 } else { moment.max(frame.reactions[at].abs()) };
        Vec::new()
    });
    moment
}

/// One rotation is driven, another one held or free, and the third free: equations give them in place of restraints.
#[test]
fn alpha_does_not_brake_what_a_support_turns_beside_a_free_rotation() {
    let turn = "motion = { rx = { amplitude = \"start\", history = \"velocity\", scale = 0.5 } }\n";
    let foot = |fix: &str, more: &str| format!("[[supports]]\nat = \"a\"\nfix = [{fix}]\n{more}{turn}");
    let feet = [
        foot("\"ux\", \"uy\", \"uz\", \"ry\"", ""),
        foot("\"ux\", \"uy\", \"uz\", \"ry\"", "rotation = \"xyz\"\n"),
        foot("\"ux\", \"uy\", \"uz\", \"ry\"", "rotation = \"zyx\"\n"),
        foot("\"ux\", \"uy\", \"uz\"", "rotation = \"xyz\"\n"),
        foot("\"ux\", \"uy\", \"uz\"", ""),
    ];
    for foot in feet {
        let moment = moment_of_drive(&foot, "[damping]\nalpha = 20.0\nbeta = 1e-3\n");
        // As with all three held, at half the speed: a thousandth of α J ω = 3.6e4 rings on.
        assert!(moment < 36.0, "{moment} {foot}");
    }
}

/// A joint that drives the mast about its foot: α brakes it, and the run says so where masses have α.
#[test]
fn alpha_on_what_a_joint_drives_is_warned_of() {
    let joint = "[[joints]]\nname = \"motor\"\nkind = \"revolute\"\naxis = [1.0, 0.0, 0.0]\n\
                 from = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\nmotion = { velocity = 1.0, amplitude = \"quake\" }\n";
    let said = |damping: &str| warnings_of(&mast(joint, damping));
    let alone = "`alpha` brakes what joint `motor` drives, against the ground at rest";
    assert_eq!(said("[damping]\nalpha = 1.5\n"), [alone]);
    assert_eq!(said("[damping]\nbeta = 1.5e-3\n"), Vec::<String>::new());
    let of_part = |alpha: f64| {
        let own = format!("mass = \"consistent\"\ndamping = {{ alpha = {alpha:?} }}");
        let text = mast(joint, "").replace("mass = \"consistent\"", &own);
        warnings_of(&text)
    };
    assert_eq!(of_part(1.5), [alone]);
    assert_eq!(of_part(0.0), Vec::<String>::new());
}

/// Two springs on a foot that moves alike or differently.
#[test]
fn supports_that_move_differently_are_warned_of() {
    let foot = |scale: f64| {
        let one = MOVED
            .replace("\"a\"", "\"b\"")
            .replace("\"acceleration\"", &format!("\"acceleration\", scale = {scale:?}"));
        mast(&format!("{MOVED}{one}"), "[damping]\nalpha = 1.5\n").replace("[[masses]]\nat = \"b\"\nmass = 200.0\n", "")
    };
    assert_eq!(warnings_of(&foot(1.0)), Vec::<String>::new());
    let said = warnings_of(&foot(2.0));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].starts_with("the supports at `a` and `b` move differently"), "{said:?}");
}

/// Messages about damping of parts, links and joints that cannot be.
#[test]
fn what_has_no_mass_takes_no_alpha() {
    let said = |from: &str, to: &str| {
        let text = springs();
        assert!(text.contains(from), "{from}");
        warnings_of(&text.replacen(from, to, 1))
    };
    let of_bushing = "damping = { beta = 0.004 }";
    assert_eq!(said(of_bushing, "damping = { alpha = 0.1 }"), ["`alpha` does not apply to a link, which has no mass"]);
    assert_eq!(said(of_bushing, "damping = {}"), ["`damping` is empty"]);
    assert_eq!(said(of_bushing, "damping = { beta = -1.0 }"), ["`beta` must not be negative"]);
    assert_eq!(said(of_bushing, "damping = { viscous = 1.0 }"), ["`damping` does not apply to a bushing"]);
    assert_eq!(said(of_bushing, "damping = 1.0"), ["`damping` does not apply to a bushing"]);
    let of_joint = "damping = { beta = 0.0, viscous = 2.0 }";
    assert_eq!(said(of_joint, "damping = { alpha = 1.0 }"), ["`alpha` does not apply to a joint, which has no mass"]);
    let rigid = mast(SHAKEN, "").replace("mass = \"consistent\"", "rigid = true\ndamping = { alpha = 1.0 }");
    assert!(
        warnings_of(&rigid).contains(&"`damping` does not apply to a rigid part".to_owned()),
        "{:?}",
        warnings_of(&rigid)
    );
}

/// ζ = ½ (α/ω + β ω), and the transmissibility of a damped spring on a support that moves: |T| = |k + iωc|/|k − mω² + iωc|.
#[test]
fn a_response_to_moving_supports_has_damping_relative_to_them() {
    let text = r#"
[analysis]
kind = "frequency-response"
method = "direct"
frequencies = [3.0]
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
[[masses]]
at = "b"
mass = 2.0
[[supports]]
at = "a"
fix = ["uy", "uz"]
motion = { ux = { amplitude = "shake", scale = 0.01 } }
[[supports]]
at = "b"
fix = ["uy", "uz"]
[[links]]
name = "spring"
from = { node = "a" }
to = { node = "b" }
stiffness = 600.0
[damping]
alpha = 1.5
beta = 0.01
[amplitudes.shake]
kind = "harmonic"
phase = 0.0
[[expect]]
at = "b"
quantity = "ux"
frequency = 3.0
value = 0.0307880508198
tolerance = 1e-10
"#;
    let done = run_to_the_end(&read_deck(text), &mut |_: &Frame| Vec::new());
    assert!(done.verdicts[0].passed, "{:?}", done.verdicts);
}

/// Five masses on springs between ground and top, with one strong damper: its mode has a tenth of critical damping and more.
fn shear_frame(damper: usize, c: f64, method: &str) -> String {
    let mut text = format!(
        "[analysis]\nkind = \"frequency-response\"\nmethod = \"{method}\"\nfrequencies = {{ from = 0.5, to = 2.0, steps = 16 }}\n\
         [points]\nn0 = [0.0, 0.0, 0.0]\n"
    );
    (1..6).for_each(|k| text += &format!("n{k} = [0.0, 0.0, {k}.0]\n"));
    text += "[[masses]]\nat = [\"n1\", \"n2\", \"n3\", \"n4\", \"n5\"]\nmass = 1000.0\n\
             [[supports]]\nat = \"n0\"\nfix = [\"ux\", \"uy\", \"uz\"]\n\
             [[supports]]\nat = [\"n1\", \"n2\", \"n3\", \"n4\", \"n5\"]\nfix = [\"ux\", \"uy\"]\n\
             [[loads]]\nat = \"n5\"\nforce = [0.0, 0.0, 1000.0]\namplitude = \"shake\"\n\
             [amplitudes.shake]\nkind = \"harmonic\"\nphase = 0.0\n";
    for k in 1..6 {
        let damping = if k == damper { c } else { 0.0 };
        text += &format!(
            "[[links]]\nname = \"k{k}\"\nfrom = {{ node = \"n{}\" }}\nto = {{ node = \"n{k}\" }}\nstiffness = 1e6\ndamping = {damping:?}\n",
            k - 1
        );
    }
    text
}

/// Modes that are not found push back on those found through a local damper; the direct solution has them all.
#[test]
fn modes_answer_to_local_dampers_as_the_direct_solution_does() {
    let amplitudes = |text: &str| {
        let expect = |k: usize| {
            format!("[[expect]]\nat = \"n{k}\"\nquantity = \"uz\"\npeak = \"max\"\nvalue = 1.0\ntolerance = 9.0\n")
        };
        let text = text.to_owned() + &(1..6).map(expect).collect::<String>();
        let done = run_to_the_end(&read_deck(&text), &mut |_: &Frame| Vec::new());
        done.verdicts.iter().map(|verdict| verdict.value.expect("an amplitude")).collect::<Vec<f64>>()
    };
    for (damper, c) in [(1, 2e4), (1, 6e4), (3, 4e4), (5, 2e4)] {
        let [modal, direct] = ["modal", "direct"].map(|method| amplitudes(&shear_frame(damper, c, method)));
        for (modal, direct) in modal.iter().zip(&direct) {
            // Two of five modes answer as springs with the first term of their inertia, (ω/ω₄)⁴ = 3e-3 of their share of a few per cent.
            // Without the motions that dampers cause: 2 to 9 %.
            assert!((modal - direct).abs() < 5e-4 * direct, "{damper} {c}: {modal} for {direct}");
        }
    }
}

/// A chain of two masses with two ratios at its own frequencies: modes have exactly these. α and β are those of the two equations
/// ζ = α/(2ω) + βω/2.
#[test]
fn ratios_at_two_frequencies() {
    // Masses 2 and springs 200: ω² = 100 (3 ± √5)/2.
    let omega = [1.0, -1.0].map(|sign: f64| (50.0 * (3.0 - sign * 5f64.sqrt())).sqrt());
    let [low, high] = omega.map(|omega| omega / TAU);
    for (given, ratios) in [("ratio = 0.03", [0.03, 0.03]), ("ratios = [0.02, 0.04]", [0.02, 0.04])] {
        let row = |(number, ratio): (usize, &f64)| {
            // Roots have eleven digits.
            format!("[[expect]]\nmode = {number}\nquantity = \"damping_ratio\"\nvalue = {ratio:?}\ntolerance = 1e-9\n")
        };
        let expected: String = (1..).zip(&ratios).map(row).collect();
        let text = format!(
            r#"
analysis = {{ kind = "modal", damped = true, modes = 2 }}
points = {{ a = [1.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}
masses = [{{ at = ["a", "b"], mass = 2.0 }}]
supports = [{{ at = ["a", "b"], fix = ["uy", "uz"] }}]
links = [
    {{ name = "first", from = {{ ground = [0.0, 0.0, 0.0] }}, to = {{ node = "a" }}, stiffness = 200.0 }},
    {{ name = "second", from = {{ node = "a" }}, to = {{ node = "b" }}, stiffness = 200.0 }},
]
damping = {{ rayleigh = {{ {given}, frequencies = [{low:?}, {high:?}] }} }}
{expected}"#
        );
        let model = read_deck(&text);
        for (omega, ratio) in omega.into_iter().zip(ratios) {
            let sum = 0.5 * (model.damping.mass_factor / omega + model.damping.stiffness_factor * omega);
            assert!((sum - ratio).abs() < 1e-14, "{given}: {sum}");
        }
        let done = run_to_the_end(&model, &mut |_: &Frame| Vec::new());
        assert_eq!(done.verdicts.len(), 2);
        done.verdicts.iter().for_each(|verdict| assert!(verdict.passed, "{verdict:?}"));
    }
}
