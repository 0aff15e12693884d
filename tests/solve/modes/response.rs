//! The frequency response: against closed forms, one method against the other, and against motion in time.

use super::{head, modes, off};
use crate::support::{node, read_deck, run_to_the_end};
use nalgebra::{Complex, Matrix2, Vector2};
use rdsolve::modes::Modes;
use std::f64::consts::{PI, TAU};

type C64 = Complex<f64>;

/// The complex motion of a node in a direction at each frequency, with the frequency.
pub fn motion(found: &Modes, node: usize, dof: usize) -> Vec<(f64, C64)> {
    let response = found.response.as_ref().expect("a response");
    let place = response.nodes.binary_search(&node).expect("a node that is written");
    let of = |row: &rdsolve::modes::ResponseRow| {
        let [real, imaginary] = row.motions[place][dof];
        (row.frequency, C64::new(real, imaginary))
    };
    response.rows.iter().map(of).collect()
}

/// The largest difference from a function of the angular frequency, relative to the largest of its values.
fn differs(found: &[(f64, C64)], exact: impl Fn(f64) -> C64) -> f64 {
    let all: Vec<C64> = found.iter().map(|(frequency, _)| exact(TAU * frequency)).collect();
    let largest = all.iter().map(|x| x.norm()).fold(0.0, f64::max);
    found.iter().zip(&all).map(|((_, x), exact)| (x - exact).norm() / largest).fold(0.0, f64::max)
}

/// `[analysis]` of a response, then a load or motion that is harmonic.
fn analysis(keys: &str) -> String {
    format!("[analysis]\nkind = \"frequency-response\"\n{keys}\n")
}

/// The text with the harmonic amplitudes that it names.
fn shaken(text: String) -> String {
    let all = [
        ("\"shake\"", "[amplitudes.shake]\nkind = \"harmonic\"\n"),
        ("\"late\"", "[amplitudes.late]\nkind = \"harmonic\"\nphase_degrees = -60.0\n"),
    ];
    let used: String = all.iter().filter(|(name, _)| text.contains(name)).map(|(_, table)| *table).collect();
    text + &used
}

/// Two masses, each on a spring and a damper along x: the ground, 3 kg, 2 kg.
fn chain(keys: &str, more: &str) -> String {
    let text = analysis(keys)
        + "[points]\nground = [0.0, 0.0, 0.0]\na = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n\
           [[masses]]\nat = \"a\"\nmass = 3.0\n[[masses]]\nat = \"b\"\nmass = 2.0\n\
           [[links]]\nname = \"first\"\nfrom = { node = \"ground\" }\nto = { node = \"a\" }\nlaw = \"linear\"\nstiffness = 500.0\ndamping = 7.0\n\
           [[links]]\nname = \"second\"\nfrom = { node = \"a\" }\nto = { node = \"b\" }\nlaw = \"linear\"\nstiffness = 300.0\ndamping = 2.0\n\
           [[supports]]\nat = [\"a\", \"b\"]\nfix = [\"uy\", \"uz\"]\n"
        + more;
    shaken(text)
}

/// The motion of the two masses: the forces on them, and the displacement of the ground.
fn of_chain(omega: f64, f: [C64; 2], ground: C64) -> Vector2<C64> {
    let i = C64::i();
    let (k1, k2) = (500.0 + i * omega * 7.0, 300.0 + i * omega * 2.0);
    let square = omega * omega;
    let A = Matrix2::new(k1 + k2 - 3.0 * square, -k2, -k2, k2 - 2.0 * square);
    A.try_inverse().unwrap() * Vector2::new(f[0] + k1 * ground, f[1])
}

const WIDE: &str = "frequencies = { from = 0.2, to = 8.0, steps = 40, spacing = \"logarithmic\" }";

/// Loads in and out of phase with dampers that no modes diagonalise. Two modes are all there are, so both methods are exact: what is
/// left is rounding, with that of modes times the residual of theirs, 1e-9.
#[test]
fn two_masses_under_loads() {
    let held = "[[supports]]\nat = \"ground\"\nfix = \"all\"\n";
    let loads = "[[loads]]\nat = \"b\"\nforce = [4.0, 0.0, 0.0]\namplitude = \"shake\"\n\
                 [[loads]]\nat = \"a\"\nforce = [-3.0, 0.0, 0.0]\namplitude = \"late\"\n";
    let late = C64::from_polar(3.0, -PI / 3.0);
    for (method, tolerance) in [("", 1e-13), ("\nmethod = \"modal\"", 1e-12)] {
        let found = modes(&chain(&(WIDE.to_owned() + method), &[held, loads].concat()));
        for (node, k) in [(1, 0), (2, 1)] {
            let exact = |omega: f64| of_chain(omega, [-late, C64::new(4.0, 0.0)], C64::new(0.0, 0.0))[k];
            let off = differs(&motion(&found, node, 0), exact);
            assert!(off < tolerance, "{method} {node}: {off:e}");
        }
    }
}

/// The ground moves by a displacement, a velocity or an acceleration, or is accelerated under all; the last gives motions relative to
/// it.
#[test]
fn two_masses_on_moving_ground() {
    for (history, factor) in
        [("displacement", C64::new(1.0, 0.0)), ("velocity", -C64::i()), ("acceleration", C64::new(-1.0, 0.0))]
    {
        let moved = format!(
            "[[supports]]\nat = \"ground\"\nfix = [\"uy\", \"uz\"]\nmotion = {{ ux = {{ amplitude = \"late\", scale = 0.3, history = \"{history}\" }} }}\n"
        );
        let power = ["displacement", "velocity", "acceleration"].iter().position(|word| *word == history).unwrap();
        let ground = |omega: f64| factor * C64::from_polar(0.3, -PI / 3.0) / omega.powi(power as i32);
        for (method, tolerance) in [("", 1e-13), ("\nmethod = \"modal\"", 1e-12)] {
            let found = modes(&chain(&(WIDE.to_owned() + method), &moved));
            for (node, k) in [(1, 0), (2, 1)] {
                let off =
                    differs(&motion(&found, node, 0), |omega| of_chain(omega, [C64::default(); 2], ground(omega))[k]);
                assert!(off < tolerance, "{history} {method} {node}: {off:e}");
            }
            assert!(differs(&motion(&found, 0, 0), ground) < 1e-15);
        }
    }
    let base = "[[supports]]\nat = \"ground\"\nfix = \"all\"\n[[environment.base_acceleration]]\ndirection = [2.0, 0.0, 0.0]\n\
                amplitude = \"shake\"\nscale = 5.0\n";
    for method in ["", "\nmethod = \"modal\""] {
        let found = modes(&chain(&(WIDE.to_owned() + method), base));
        let exact = |omega: f64| of_chain(omega, [C64::new(-15.0, 0.0), C64::new(-10.0, 0.0)], C64::default())[1];
        assert!(differs(&motion(&found, 2, 0), exact) < 1e-12, "{method}");
    }
}

/// A clamped beam under a transverse force at its tip: w(L) = F/(EI β³) (sin βL cosh βL − cos βL sinh βL)/(1 + cos βL cosh βL) with
/// β⁴ = m ω²/(EI), by Bernoulli and Euler. Shear and rotary inertia of a slenderness of 2000 change frequencies by up to 1e-5.
#[test]
fn receptance_of_a_clamped_beam() {
    let (E, length, side) = (210e9f64, 2.0f64, 1e-3f64);
    let (EI, per_length) = (E * side.powi(4) / 12.0, 7850.0 * side * side);
    let text = |keys: &str, elements: usize| {
        let text = head(&format!("kind = \"frequency-response\"\n{keys}"), side, side)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\n\
                 elements = {elements}\norder = 3\nmass = \"consistent\"\nmaterial = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
                 [[loads]]\nat = \"b\"\nforce = [0.0, 0.0, 1.0]\namplitude = \"shake\"\n"
            );
        shaken(text)
    };
    let exact = |omega: f64| {
        let b = (per_length * omega * omega / EI).powf(0.25) * length;
        let (s, c, sh, ch) = (b.sin(), b.cos(), b.sinh(), b.cosh());
        C64::new(length.powi(3) / (EI * b.powi(3)) * (s * ch - c * sh) / (1.0 + c * ch), 0.0)
    };
    // Natural frequencies are 0.21, 1.31, 3.66, 7.2 and 11.9.
    let keys = "frequencies = [0.06, 0.4, 0.8, 2.0, 5.0, 9.0]";
    let relative = |found: &[(f64, C64)]| -> Vec<f64> {
        found.iter().map(|(frequency, x)| (x / exact(TAU * frequency) - 1.0).norm()).collect()
    };
    let of = |keys: &str, elements: usize| relative(&motion(&modes(&text(keys, elements)), 1, 2));
    let direct = of(keys, 16);
    assert!(direct.iter().all(|off| *off < 3e-4), "{direct:?}");
    // By the modes up to four times the highest frequency; (ω/ω_6)⁴ of what the others answer is left out.
    let direct = motion(&modes(&text(keys, 16)), 1, 2);
    let modal = motion(&modes(&text(&(keys.to_owned() + "\nmethod = \"modal\""), 16)), 1, 2);
    for ((_, a), (_, b)) in direct.iter().zip(&modal) {
        assert!((a - b).norm() < 2e-3 * a.norm(), "{a} {b}");
    }
    // Without modes all answer as springs, which holds far below the first resonance.
    let few = motion(&modes(&text("frequencies = 0.01\nmethod = \"modal\"\nup_to = 0.1", 16)), 1, 2);
    assert!(off(&[few[0].1.re], &[exact(TAU * 0.01).re]) < 1e-4, "{few:?}");
}

/// A pendulum hangs from a pivot that is shaken sideways: with x = U − l θ of its centre, θ (m g l − ω² (J + m l²)) = −m l ω² U. The
/// pivot is a joint, or a point of the body that its support moves, which multipliers hold. Rounding of equations that are
/// regularised is left.
#[test]
fn shaken_pendulum() {
    let (m, l, J, g, u) = (2.0, 0.7, 0.05, 9.81, 0.01);
    let body = format!(
        "[environment]\ngravity = [0.0, 0.0, {:?}]\n[points]\npivot = [0.0, 0.0, 0.0]\n[[bodies]]\nname = \"bob\"\n\
         center = [0.0, 0.0, {:?}]\nmass = {m:?}\ninertia = [{J:?}, {J:?}, {J:?}]\n",
        -g, -l
    );
    let moved = format!("motion = {{ ux = {{ amplitude = \"shake\", scale = {u:?} }} }}\n");
    let joint = "[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\nfrom = { node = \"pivot\" }\nto = { body = \"bob\" }\n\
                 axis = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"pivot\"\nfix = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n";
    let attached = "[[attachments]]\nbody = \"bob\"\nnodes = [\"pivot\"]\n[[supports]]\nat = \"bob\"\nfix = [\"rx\", \"rz\"]\n\
                    [[supports]]\nat = \"pivot\"\nfix = [\"uy\", \"uz\"]\n";
    let turn = |omega: f64| -m * l * omega * omega * u / (m * g * l - omega * omega * (J + m * l * l));
    for (name, held) in [("joint", joint), ("attached", attached)] {
        for (method, tolerance) in [("", 1e-10), ("\nmethod = \"modal\"", 1e-8)] {
            let keys = format!("frequencies = {{ from = 0.1, to = 3.0, steps = 9 }}{method}");
            let text = shaken(analysis(&keys) + &body + held + &moved);
            let (model, found) = (read_deck(&text), modes(&text));
            let bob = node(&model, "bob");
            let turned = differs(&motion(&found, bob, 4), |omega| C64::new(turn(omega), 0.0));
            let along = differs(&motion(&found, bob, 0), |omega| C64::new(u - l * turn(omega), 0.0));
            println!("{name} {method}: {turned:e} {along:e}");
            assert!(turned < tolerance && along < tolerance, "{name} {method}: {turned:e} {along:e}");
        }
    }
}

/// A body on an arm with dampers, shaken by a support: amplitude and phase are those to which motion in time settles. With 200 steps a
/// period the trapezoidal rule shifts frequencies by 8e-5, which a resonance of 15 % damping turns into 6e-4; the amplitude of 1e-5
/// leaves less.
#[test]
fn motion_in_time_settles_to_the_response() {
    let deck = |analysis: &str, amplitude: &str| {
        format!(
            "[analysis]\n{analysis}\n[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0\n\
             [sections.s]\nshape = \"rectangle\"\nwidth = 0.03\nheight = 0.02\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
             c = [1.2, 0.0, 0.6]\nd = [1.2, 0.0, 2.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 2\nmaterial = \"steel\"\n\
             section = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"box\"\ncenter = [1.2, 0.1, 0.0]\nmass = 20.0\n\
             inertia = [0.4, 0.3, 0.5]\n[[attachments]]\nbody = \"box\"\nnodes = [\"b\", \"c\"]\n[[links]]\nname = \"spring\"\n\
             from = {{ node = \"c\" }}\nto = {{ node = \"d\" }}\nlaw = \"linear\"\nstiffness = 3e3\n[[supports]]\nat = \"d\"\nfix = \"all\"\n\
             [[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\nmotion = {{ uz = {{ amplitude = \"shake\", scale = 1e-5 }} }}\n\
             [damping]\nalpha = 10.0\nbeta = 1e-3\n[amplitudes.shake]\n{amplitude}\n"
        )
    };
    let frequency = 5.0;
    let text = deck(
        &format!("kind = \"frequency-response\"\nfrequencies = {frequency:?}"),
        "kind = \"harmonic\"\nphase_degrees = -90.0",
    );
    let body = node(&read_deck(&text), "box");
    let steady: Vec<C64> = [0, 2, 3, 4].map(|dof| motion(&modes(&text), body, dof)[0].1).to_vec();
    let (period, periods) = (1.0 / frequency, 24.0);
    let dynamic = format!("kind = \"dynamic\"\nend_time = {:?}\ntime_step = {:?}", periods * period, period / 200.0);
    let sine = format!("kind = \"sine\"\nfrequency = {frequency:?}");
    let model = read_deck(&(deck(&dynamic, &sine) + "[integrator]\nscheme = \"newmark\"\n"));
    let start = model.nodes[body].x;
    let done = run_to_the_end(&model, &mut |frame| {
        let now = &frame.state.nodes[body];
        let (moved, turned) = (now.moved(&start), rdsolve::math::rotation::log(&now.rotation));
        vec![frame.state.time, moved[0], moved[2], turned[0], turned[1]]
    });
    // The first harmonic of the last period.
    let last = &done.rows[done.rows.len() - 200..];
    let largest = steady.iter().map(|x| x.norm()).fold(0.0, f64::max);
    for (k, steady) in steady.iter().enumerate() {
        let part = |row: &Vec<f64>| row[1 + k] * C64::from_polar(1.0, -TAU * frequency * row[0]);
        let found: C64 = last.iter().map(part).sum::<C64>() / 100.0;
        println!("{k}: {found} {steady}");
        assert!((found - steady).norm() < 1e-3 * largest, "{k}: {found} {steady}");
    }
}

/// An unbalance whirls a disc on a shaft without mass (J. P. Den Hartog, Mechanical Vibrations, 6.11): a force that turns with ω meets
/// m, J_t and the gyroscopic moment J_p Ω ω of the disc. Shear adds 5e-7 to the shaft's flexibility.
#[test]
fn unbalanced_disc() {
    let (length, h, m, jt, jp) = (0.8f64, 1e-3f64, 2e-3, 2e-6, 4e-6);
    let ei = 210e9 * h.powi(4) / 12.0;
    let k = [12.0 * ei / length.powi(3), -6.0 * ei / length.powi(2), 4.0 * ei / length];
    for spin in [-150.0, 0.0, 30.0, 200.0] {
        let text = head("kind = \"frequency-response\"\nfrequencies = [0.5, 2.0, 10.0, 25.0]", h, h)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 1\n\
                 material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"disc\"\n\
                 center = [{length:?}, 0.0, 0.0]\nmass = {m:?}\ninertia = [{jp:?}, {jt:?}, {jt:?}]\nangular_velocity = [{spin:?}, 0.0, 0.0]\n\
                 [[attachments]]\nbody = \"disc\"\nnodes = [\"b\"]\ndofs = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n\
                 [[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"disc\"\nforce = [0.0, 1e-3, 0.0]\namplitude = \"ahead\"\n\
                 [[loads]]\nat = \"disc\"\nforce = [0.0, 0.0, 1e-3]\namplitude = \"behind\"\n[amplitudes.ahead]\nkind = \"harmonic\"\n\
                 [amplitudes.behind]\nkind = \"harmonic\"\nphase_degrees = -90.0\n"
            );
        let exact = |omega: f64| {
            let slope = k[2] + jp * spin * omega - jt * omega * omega;
            1e-3 * slope / ((k[0] - m * omega * omega) * slope - k[1] * k[1])
        };
        let found = modes(&text);
        let disc = node(&read_deck(&text), "disc");
        for ((frequency, y), (_, z)) in motion(&found, disc, 1).into_iter().zip(motion(&found, disc, 2)) {
            let w = exact(TAU * frequency);
            let off = ((y - w).norm() + (z + C64::i() * w).norm()) / w.abs();
            println!("spin {spin}, {frequency}: {off:e}");
            assert!(off < 1e-4, "spin {spin}, {frequency}: {y} {z} {w}");
        }
    }
}

/// Without damping there is no steady motion at a resonance: it is said, and the row stays.
#[test]
fn undamped_resonance() {
    let text = analysis("frequencies = [0.0, 0.5, 1.0]")
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\nmass = 1.0\n[[links]]\nname = \"k\"\n\
           from = { node = \"a\" }\nto = { node = \"b\" }\nlaw = \"linear\"\nstiffness = 9.869604401089358\n\
           [[supports]]\nat = \"a\"\nfix = \"all\"\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n\
           [[loads]]\nat = \"b\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n";
    let text = shaken(text);
    let found = modes(&text);
    let all = motion(&found, 1, 0);
    let k = PI * PI;
    assert!((all[0].1.re * k - 1.0).abs() < 1e-12 && (all[2].1.re * -3.0 * k - 1.0).abs() < 1e-12, "{all:?}");
    assert!(!all[1].1.re.is_finite() && found.warnings[0].contains("frequency 0.5"), "{all:?} {:?}", found.warnings);
}

/// The same where rounding leaves a little of the stiffness, by the equations themselves and by modes, which are told; a resonance with the
/// least damping that anything has is none, nor is one that nothing drives.
#[test]
fn undamped_resonance_of_a_beam() {
    let beam = |keys: &str, force: &str| {
        let head = head(&format!("kind = \"frequency-response\"\n{keys}"), 0.03, 0.02);
        shaken(format!(
            "{head}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 4\n\
             material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
             [[loads]]\nat = \"b\"\nforce = {force}\namplitude = \"shake\"\n"
        ))
    };
    let asked = |method: &str, more: &str| {
        let range = "{ from = 1.0, to = 200.0, steps = 5, around_resonances = 1 }";
        format!("method = \"{method}\"\nfrequencies = {range}\n{more}")
    };
    let of = |keys: &str, force: &str| modes(&beam(keys, force));
    for (method, more) in [("direct", ""), ("modal", "modes = 6\n")] {
        let found = of(&asked(method, more), "[0.0, 1.0, 0.0]");
        let said = found.warnings.join("\n");
        assert!(said.contains("nothing limits the motion") && said.contains("that of mode "), "{method}: {said}");
        let motion = motion(&found, 1, 1);
        let infinite = motion.iter().filter(|(_, y)| !y.re.is_finite()).count();
        let largest = motion.iter().map(|(_, y)| y.norm()).filter(|y| y.is_finite()).fold(0.0, f64::max);
        assert!((1..=3).contains(&infinite) && largest < 1.0, "{method}: {infinite} {largest:e}");
    }
    let damped = of(&asked("modal", "modes = 6\ndamping_ratio = 1e-6\n"), "[0.0, 1.0, 0.0]");
    assert!(motion(&damped, 1, 1).iter().all(|(_, y)| y.re.is_finite()), "{:?}", damped.warnings);
}

/// A stage of a response is about the state that stages before it have reached: a column under an axial load is softer, as it is under the
/// same load held in `[analysis]`. Joints and supports with harmonic motion rest in the stages before. The equilibria are found to 1e-8.
#[test]
fn stage_about_a_loaded_state() {
    let column = |analysis: &str, of_stage: &str| {
        let head = head("kind = \"frequency-response\"", 0.03, 0.02);
        let scene = head.split_once("[materials").unwrap().1;
        let text = format!(
            "{analysis}[materials{scene}[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\n\
             elements = 4\nmaterial = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\n\
             fix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\nmotion = {{ uz = {{ amplitude = \"shake\", scale = 0.1, history = \"acceleration\" }} }}\n\
             [[loads]]\nat = \"b\"\nforce = [-1500.0, 0.0, 0.0]\n[[loads]]\nat = \"b\"\nforce = [0.0, 5.0, 0.0]\namplitude = \"late\"\n{of_stage}"
        );
        shaken(text)
    };
    let keys = "frequencies = [1.0, 2.0, 3.0]\n";
    let alone = modes(&column(&analysis(keys), ""));
    let stages = format!(
        "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.25\n[[stages]]\nname = \"shaken\"\n\
         kind = \"frequency-response\"\n{keys}"
    );
    let folder = tempfile::tempdir().unwrap();
    let expected = motion(&alone, 1, 2)[1].1.norm();
    let expect =
        format!("[[expect]]\nat = \"b\"\nquantity = \"uz\"\nfrequency = 2.0\nvalue = {expected:?}\ntolerance = 1e-6\n");
    std::fs::write(folder.path().join("d.toml"), column(&stages, "stages = \"shaken\"\n") + &expect).unwrap();
    let run =
        assert_cmd::Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).arg("d.toml").output().unwrap();
    let said = String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && said.contains("ok   uz of b at frequency 2"), "{said}");
    let softer = motion(&modes(&column(&analysis(keys), "").replace("-1500.0", "-0.001")), 1, 2)[1].1.norm();
    assert!((softer / expected - 1.0).abs() > 0.05, "{softer} {expected}");
}

/// A drive between ground and body is shaken: the body turns by what the drive says, whatever the frequency, and its centre with it.
#[test]
fn shaken_drive() {
    for method in ["", "\nmethod = \"modal\"\nmodes = 1"] {
        let text = analysis(&format!("frequencies = [0.5, 2.0]{method}"))
            + "[[bodies]]\nname = \"arm\"\ncenter = [1.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.4, 0.5]\n\
               [[bodies]]\nname = \"other\"\ncenter = [0.0, 5.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.4, 0.5]\n\
               [[joints]]\nname = \"pin\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = { ground = [0.0, 0.0, 0.0] }\n\
               to = { body = \"arm\" }\nmotion = { position = 0.1, amplitude = \"shake\" }\n";
        let text = shaken(text);
        let (model, found) = (read_deck(&text), modes(&text));
        let arm = node(&model, "arm");
        for (dof, size) in [(5, 0.1), (1, 0.1), (0, 0.0)] {
            let motion = motion(&found, arm, dof);
            assert_eq!(motion.len(), 2);
            assert!(motion.iter().all(|(_, x)| (x - size).norm() < 1e-8), "{method:?} {dof}: {motion:?}");
        }
    }
}

/// One oscillator, asked below half of its frequency and expected above it: the mode answers with its inertia and its damping, as in the
/// closed form.
#[test]
fn modes_beyond_the_frequencies_asked_answer_too() {
    let (m, k, ratio) = (2.0, 710.6, 0.2);
    let text = analysis(&format!("frequencies = [1.0]\nmethod = \"modal\"\ndamping_ratio = {ratio:?}"))
        + "[points]\na = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"a\"\nmass = 2.0\n\
           [[links]]\nname = \"first\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\nlaw = \"linear\"\nstiffness = 710.6\n\
           [[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\"]\n\
           [[loads]]\nat = \"a\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n\
           [[expect]]\nat = \"a\"\nquantity = \"ux\"\nfrequency = 3.0\nvalue = 1.0\ntolerance = 1e9\n";
    let text = shaken(text);
    let (model, found) = (read_deck(&text), modes(&text));
    let exact = |omega: f64| {
        let damping = 2.0 * ratio * f64::sqrt(k / m) * m;
        C64::new(1.0, 0.0) / C64::new(k - omega * omega * m, omega * damping)
    };
    let found = motion(&found, node(&model, "a"), 0);
    assert_eq!(found.len(), 2);
    assert!(differs(&found, exact) < 1e-9, "{found:?}");
}

/// Moved by its support, an oscillator with a damping ratio answers as in the closed form for damping of its motion relative to the support,
/// whether or not something else is free, for which modes are found about another shift.
#[test]
fn damping_of_modes_is_that_of_the_motion_relative_to_supports() {
    let (m, k, ratio) = (2.0, 710.6, 0.2);
    for (history, more) in [("displacement", false), ("displacement", true), ("acceleration", true)] {
        let free = "[[bodies]]\nname = \"free\"\ncenter = [0.0, 5.0, 0.0]\nmass = 2.0\ninertia = [0.3, 0.4, 0.5]\n";
        let text = analysis(&format!(
            "frequencies = [1.0, 2.5, 4.0]\nmethod = \"modal\"\nmodes = 8\ndamping_ratio = {ratio:?}"
        )) + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\nmass = 2.0\n\
               [[links]]\nname = \"spring\"\nfrom = { node = \"a\" }\nto = { node = \"b\" }\nlaw = \"linear\"\nstiffness = 710.6\n\
               [[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n\
               [[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\"]\n"
            + &format!("motion = {{ ux = {{ amplitude = \"shake\", scale = 0.1, history = \"{history}\" }} }}\n")
            + if more { free } else { "" };
        let text = shaken(text);
        let (model, found) = (read_deck(&text), modes(&text));
        let exact = |omega: f64| {
            let natural = f64::sqrt(k / m);
            let u = if history == "displacement" { 0.1 } else { -0.1 / (omega * omega) };
            let left = C64::new(natural * natural - omega * omega, 2.0 * ratio * natural * omega);
            C64::new(u, 0.0) * (C64::new(1.0, 0.0) + C64::new(omega * omega, 0.0) / left)
        };
        let found = motion(&found, node(&model, "b"), 0);
        assert_eq!(found.len(), 3);
        // What modes and solutions leave of one oscillator, whatever lies beside it.
        assert!(differs(&found, exact) < 1e-9, "{history}, {more}: {found:?}");
    }
}

/// Two undamped absorbers on a machine, asked where one of them would resonate alone: the machine rests, and the absorber takes the force.
#[test]
fn a_tuned_absorber_is_no_resonance() {
    let tuned = TAU * TAU * 4.0; // 1 kg at 2 Hz
    let text = analysis("frequencies = [2.0]")
        + "[points]\na = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\nc = [3.0, 0.0, 0.0]\n\
           [[masses]]\nat = \"a\"\nmass = 10.0\n[[masses]]\nat = [\"b\", \"c\"]\nmass = 1.0\n\
           [[links]]\nname = \"first\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\nlaw = \"linear\"\nstiffness = 3000.0\n\
           [[supports]]\nat = [\"a\", \"b\", \"c\"]\nfix = [\"uy\", \"uz\"]\n\
           [[loads]]\nat = \"a\"\nforce = [10.0, 0.0, 0.0]\namplitude = \"shake\"\n"
        + &format!(
            "[[links]]\nname = \"second\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\nlaw = \"linear\"\nstiffness = {tuned:?}\n\
             [[links]]\nname = \"third\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"c\" }}\nlaw = \"linear\"\nstiffness = {:?}\n",
            2.25 * tuned
        );
    let text = shaken(text);
    let (model, found) = (read_deck(&text), modes(&text));
    let [a, b] = ["a", "b"].map(|name| motion(&found, node(&model, name), 0)[0].1);
    // The answer is that of a frequency 1e-9 beside.
    assert!(a.norm() < 1e-8 && (b + 10.0 / tuned).norm() < 1e-6 * 10.0 / tuned, "{a} {b}");
}

/// A pendulum upside down, on a joint: no steady motion about it lasts, and a direct response says so; hanging, it says nothing.
#[test]
fn a_response_about_an_unstable_state_is_doubted() {
    for (height, unstable) in [(0.7, true), (-0.7, false)] {
        let text = analysis("frequencies = [0.5]")
            + "[environment]\ngravity = [0.0, 0.0, -9.81]\n[[bodies]]\nname = \"bob\"\nmass = 2.0\ninertia = [0.05, 0.05, 0.05]\n"
            + &format!("center = [0.0, 0.0, {height:?}]\n")
            + "[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"bob\" }\n\
               axis = [0.0, 1.0, 0.0]\n[[loads]]\nat = \"bob\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n";
        let warnings = modes(&shaken(text)).warnings;
        assert_eq!(warnings.iter().any(|warning| warning.contains("unstable")), unstable, "{height}: {warnings:?}");
    }
}

/// A slender cantilever, in N, mm and t, is far from singular: what is left of its equations is the rounding of stiff terms, and nothing is doubted.
/// It answers as its stiffness says, 3EI/L³.
#[test]
fn slender_structures_are_not_next_to_singular() {
    let text = shaken(
        analysis("frequencies = [0.01]\nmethod = \"direct\"")
            + "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 2e5\npoisson_ratio = 0.3\ndensity = 7.85e-9\n\
               [sections.r]\nshape = \"rectangle\"\nwidth = 50.0\nheight = 50.0\n[points]\na = [0.0, 0.0, 0.0]\nb = [5000.0, 0.0, 0.0]\n\
               [[beams]]\nname = \"m\"\npath = [\"a\", \"b\"]\nelements = 10\nsection = \"r\"\nmaterial = \"steel\"\norientation = [0.0, 1.0, 0.0]\n\
               [[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, 1.0]\namplitude = \"shake\"\n",
    );
    let model = read_deck(&text);
    let found = modes(&text);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let wanted = 5000f64.powi(3) / (3.0 * 2e5 * 50f64.powi(4) / 12.0);
    // Shear adds 8e-5, inertia at a hundredth of a Hertz 5e-5.
    assert!((motion(&found, node(&model, "b"), 2)[0].1.re / wanted - 1.0).abs() < 2e-4, "{wanted}");
}

/// Two equal masses on two equal springs resonate at 0.618 and 1.618 times the frequency of one, where the driven mass stands still. A resonance between two
/// frequencies has a warning with its place and the height of its peak, by both methods; an antiresonance and a peak with rows on it have none.
#[test]
fn a_resonance_between_frequencies() {
    let k = TAU * TAU;
    let scene = |keys: &str, damping: f64| {
        shaken(format!(
            "[analysis]\nkind = \"frequency-response\"\n{keys}\n[points]\na = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[masses]]\nat = \"a\"\nmass = 1.0\n\
             [[masses]]\nat = \"b\"\nmass = 1.0\n[[supports]]\nat = [\"a\", \"b\"]\nfix = [\"uy\", \"uz\"]\n\
             [[links]]\nname = \"first\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"a\" }}\nstiffness = {k:?}\ndamping = {damping:?}\n\
             [[links]]\nname = \"second\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\nstiffness = {k:?}\ndamping = {damping:?}\n\
             [[loads]]\nat = \"a\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"shake\"\n[output]\nnodes = [\"a\"]\n"
        ))
    };
    let said = |keys: &str, damping: f64| {
        let found = modes(&scene(keys, damping));
        found.warnings.into_iter().filter(|said| said.contains("a resonance lies between")).collect::<Vec<_>>()
    };
    let coarse = "frequencies = [0.5, 0.55, 0.6, 0.65, 0.7]\n";
    for method in ["", "method = \"modal\"\nmodes = 2\n"] {
        let said = said(&format!("{coarse}{method}"), 1e-3);
        assert_eq!(said.len(), 1, "{method}");
        let number = |after: &str| {
            let rest = said[0].split(after).nth(1).unwrap();
            rest.split([' ', ':', ';']).next().unwrap().parse::<f64>().unwrap()
        };
        let at = |f: f64| modes(&scene(&format!("frequencies = [{f:?}]"), 1e-3));
        let a = node(&read_deck(&scene(coarse, 1e-3)), "a");
        let size = |f: f64| motion(&at(f), a, 0)[0].1.norm();
        let [exact, frequency] = [(5.0f64.sqrt() - 1.0) / 2.0, number("near ")];
        let higher = size(exact) / size(0.6).max(size(0.65));
        println!("{}: {frequency} {exact}, {higher}", said[0]);
        // The other mode moves the driven mass by a tenth there.
        assert!((frequency - exact).abs() < 0.1 * 0.05, "{}", said[0]);
        assert!((number("about ") / higher - 1.0).abs() < 0.2, "{} {higher}", said[0]);
    }
    assert!(said("frequencies = [0.8, 0.9, 0.95, 1.05, 1.1, 1.2]", 1e-3).is_empty());
    assert!(said(coarse, 5.0).is_empty());
    assert!(said("frequencies = { from = 0.5, to = 0.7, steps = 5, around_resonances = 10 }", 1e-2).is_empty());
}
