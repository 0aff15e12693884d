//! Motions that follow tables of positions: samples of a smooth motion carry the forces of that motion, drawings keep their corners.

use assert_cmd::Command;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

/// Runs a deck; the exit code and what was said on standard error.
fn run(folder: &Path, deck: &str) -> (i32, String) {
    fs::write(folder.join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let output = command.current_dir(folder).args(["deck.toml", "-o", "out", "--overwrite"]).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// A column of a table, beside the time.
fn column(folder: &Path, table: &str, column: &str) -> Vec<[f64; 2]> {
    let mut reader = csv::Reader::from_path(folder.join("out").join(table)).unwrap();
    let headers = reader.headers().unwrap().clone();
    let place = |wanted: &str| headers.iter().position(|name| name == wanted).unwrap();
    let (time, value) = (place("time"), place(column));
    reader.records().map(Result::unwrap).map(|row| [row[time].parse().unwrap(), row[value].parse().unwrap()]).collect()
}

/// The reaction of a node along x over time.
fn reaction(folder: &Path, of: &str) -> Vec<[f64; 2]> {
    let mut reader = csv::Reader::from_path(folder.join("out/reactions.csv")).unwrap();
    let rows = reader.records().map(Result::unwrap).filter(|row| &row[2] == of && &row[3] == "ux");
    rows.map(|row| [row[1].parse().unwrap(), row[4].parse().unwrap()]).collect()
}

/// Samples of f as points of a table, with nine digits as files have them.
fn samples(f: impl Fn(f64) -> f64, end: f64, pieces: usize) -> String {
    let point = |k: usize| {
        let t = end * k as f64 / pieces as f64;
        format!("[{t}, {:.9}]", f(t))
    };
    (0..=pieces).map(point).collect::<Vec<_>>().join(", ")
}

fn table(points: &str, keys: &str) -> String {
    format!("[amplitudes.record]\nkind = \"table\"\npoints = [{points}]\n{keys}\n")
}

/// A mass of 10 kg on a support that moves along x, and a damper from it to the ground.
fn pin(step: &str, integrator: &str, amplitude: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = {step}\n[integrator]\n{integrator}\n[points]\npin = [0.0, 0.0, 0.0]\n\
         [[masses]]\nat = \"pin\"\nmass = 10.0\n[[links]]\nname = \"damper\"\nfrom = {{ ground = [-1.0, 0.0, 0.0] }}\n\
         to = {{ node = \"pin\" }}\nlaw = \"linear\"\nstiffness = 0.0\ndamping = 3.0\n[[supports]]\nat = \"pin\"\nfix = [\"uy\", \"uz\"]\n\
         motion = {{ ux = {{ amplitude = \"record\" }} }}\n[output]\nreactions = true\n{amplitude}"
    )
}

fn swing(t: f64) -> f64 {
    0.05 * (1.0 - (TAU * t).cos())
}

/// The support carries m a + c v of the sampled motion, its work is the energy of mass and damper, and nothing is warned of. The second derivative
/// of a spline errs by (ω h)²/12 = 3.3e-4 of the largest with 100 samples a period; Newmark, HHT and central differences take it as it is.
#[test]
fn a_sampled_motion_has_its_forces() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let [m, c] = [10.0, 3.0];
    let force = |t: f64| 0.05 * TAU * (m * TAU * (TAU * t).cos() + c * (TAU * t).sin());
    let points = samples(swing, 1.0, 100);
    for (step, integrator) in [
        ("0.0025", "scheme = \"newmark\""),
        ("0.0033", "scheme = \"generalized-alpha\""),
        ("0.004", "scheme = \"central-difference\""),
        ("\"auto\"\nerror_tolerance = 1e-4", "scheme = \"newmark\""),
    ] {
        let (code, said) = run(folder, &pin(step, integrator, &table(&points, "")));
        assert_eq!((code, said.as_str()), (0, ""), "{step} {integrator}");
        let rows = reaction(folder, "pin");
        assert!(rows.last().is_some_and(|row| row[0] == 1.0), "{step} {integrator}");
        let largest = 0.05 * TAU * TAU * m;
        // The force of a scheme that weights both ends of a step lies within a step of its time: ω Δt = 0.02 at the most.
        let within = if integrator.contains("alpha") { 0.025 } else { 1e-3 };
        for [t, fx] in rows {
            assert!((fx - force(t)).abs() < within * largest, "{step} {integrator} {t}: {fx} for {}", force(t));
        }
        // ∫ c v² = c (0.05 ω)²/2 over a period; the trapezoidal rule over whole periods of a sine has no error, spline and digits 1e-4.
        let damped = column(folder, "energy.csv", "damping").last().unwrap()[1];
        let exact = 0.5 * c * (0.05 * TAU).powi(2);
        assert!((damped - exact).abs() < 2e-3 * exact, "{step} {integrator}: {damped} for {exact}");
        let missing = column(folder, "energy.csv", "numerical").last().unwrap()[1];
        assert!(missing.abs() < 1e-3 * 0.5 * m * (0.05 * TAU).powi(2), "{step} {integrator}: {missing}");
    }
}

/// The motor of an arm that is turned by sampled angles: 2 kg m² times the angular acceleration, 39.5 N m at the most.
#[test]
fn a_sampled_angle_has_its_torque() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let arm = |motion: &str, points: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.0025\n[integrator]\nscheme = \"newmark\"\n[[bodies]]\nname = \"arm\"\n\
             center = [0.0, 0.0, 0.0]\nmass = 10.0\ninertia = [1.0, 1.0, 2.0]\n[[joints]]\nname = \"motor\"\nkind = \"revolute\"\n\
             axis = [0.0, 0.0, 1.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"arm\" }}\nmotion = {{ {motion} }}\n\
             [output]\njoints = true\n{}",
            table(points, "")
        )
    };
    let torque = |t: f64| TAU * TAU * (TAU * t).cos();
    let points = samples(|t| 0.5 * (1.0 - (TAU * t).cos()), 1.0, 100);
    let (code, said) = run(folder, &arm("position = 1.0, amplitude = \"record\"", &points));
    assert_eq!((code, said.as_str()), (0, ""));
    for [t, effort] in column(folder, "joints.csv", "effort") {
        assert!((effort - torque(t)).abs() < 1e-3 * TAU * TAU, "{t}: {effort} for {}", torque(t));
    }
    // Automatic steps of the scheme that they choose, Runge-Kutta here, and of another one: nothing but the angle moves.
    for scheme in ["", "[integrator]\nscheme = \"esdirk3\"\n"] {
        let automatic = arm("position = 1.0, amplitude = \"record\"", &points)
            .replace("time_step = 0.0025", "time_step = \"auto\"")
            .replace("[integrator]\nscheme = \"newmark\"\n", scheme);
        let (code, said) = run(folder, &automatic);
        assert_eq!((code, said.as_str()), (0, ""), "{scheme}");
        let rows = column(folder, "joints.csv", "effort");
        assert!(rows.len() > 20 && rows.last().is_some_and(|row| row[0] == 1.0), "{scheme}");
        rows.iter()
            .for_each(|[t, effort]| assert!((effort - torque(*t)).abs() < 1e-3 * TAU * TAU, "{scheme} {t}: {effort}"));
    }
    // Velocities follow a spline, whose integral errs by (ω h)⁴/720 = 2e-8 of the largest angle; nine digits of the samples add 1e-9.
    let rates = samples(|t| 0.5 * TAU * (TAU * t).sin(), 1.0, 100);
    assert_eq!(run(folder, &arm("velocity = 1.0, amplitude = \"record\"", &rates)), (0, String::new()));
    for [t, angle] in column(folder, "joints.csv", "coordinate") {
        assert!((angle - 0.5 * (1.0 - (TAU * t).cos())).abs() < 1e-7, "{t}: {angle}");
    }
}

/// One table moves a support and is the factor of a load: the load follows straight lines, the support the curve, and both meet the points.
#[test]
fn loads_keep_straight_lines() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let load = "[points]\nother = [0.0, 1.0, 0.0]\npin =";
    let loaded = "[[masses]]\nat = \"other\"\nmass = 1.0\n[[supports]]\nat = \"other\"\nfix = \"translations\"\n\
                  [[loads]]\nat = \"other\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"record\"\n";
    let deck = pin("0.03125", "scheme = \"newmark\"", &table(&samples(swing, 1.0, 16), ""));
    let (code, said) = run(folder, &(deck.replace("[points]\npin =", load) + loaded));
    assert_eq!(code, 0, "{said}");
    let half = 1.0 / 32.0;
    let at_half = |rows: Vec<[f64; 2]>| rows.into_iter().find(|row| (row[0] - half).abs() < 1e-12).unwrap()[1];
    let load = -at_half(reaction(folder, "other"));
    assert!((load - 0.5 * swing(2.0 * half)).abs() < 1e-9, "{load}");
    let ux = column(folder, "nodes.csv", "ux").into_iter().find(|row| (row[0] - half).abs() < 1e-12 && row[1] != 0.0);
    // A spline errs by 5/384 ω⁴ h⁴ = 3e-4 of the largest.
    assert!((ux.unwrap()[1] - swing(half)).abs() < 1e-3 * 0.05, "{ux:?}");
}

/// Without inertia straight lines stay, and a run of statics and then motion follows one curve throughout: the position does not jump.
#[test]
fn stages_follow_one_curve() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let points = samples(swing, 1.0, 16);
    let statics = pin("0.03125", "scheme = \"newmark\"", &table(&points, ""))
        .replace("\"dynamic\"", "\"static\"")
        .replace("[integrator]\nscheme = \"newmark\"\n", "")
        .replace("damping = 3.0\n", "")
        .replace("stiffness = 0.0", "stiffness = 1.0");
    let at = |t: f64| {
        let row = column(folder, "nodes.csv", "ux").into_iter().rev().find(|row| (row[0] - t).abs() < 1e-12);
        row.unwrap_or_else(|| panic!("no row at {t}"))[1]
    };
    assert_eq!(run(folder, &statics).0, 0);
    let half = 1.0 / 32.0;
    assert!((at(half) - 0.5 * swing(2.0 * half)).abs() < 1e-9);
    let stages = "[[stages]]\nname = \"push\"\nkind = \"static\"\nduration = 0.34375\ntime_step = 0.03125\n\
                  [[stages]]\nname = \"move\"\nkind = \"dynamic\"\nduration = 0.65625\ntime_step = 0.0078125\n";
    let staged = pin("0.01", "scheme = \"newmark\"", &table(&points, ""))
        .replace("[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n", stages);
    let (code, said) = run(folder, &staged);
    assert_eq!(code, 0, "{said}");
    for t in [half, 0.34375, 0.34375 + 0.0078125, 0.5] {
        assert!((at(t) - swing(t)).abs() < 1e-3 * 0.05, "{t}: {} for {}", at(t), swing(t));
    }
    // From 0.34375 on the support moves at the velocity of the curve, and the force is that of its acceleration.
    let largest = 0.05 * TAU * TAU * 10.0;
    for [t, fx] in reaction(folder, "pin").into_iter().filter(|row| row[0] > 0.36) {
        let force = 0.05 * TAU * (10.0 * TAU * (TAU * t).cos() + 3.0 * (TAU * t).sin());
        // (ω h)²/12 with 16 samples a period is 0.013.
        assert!((fx - force).abs() < 0.02 * largest, "{t}: {fx} for {force}");
    }
}

/// Where velocities jump inside the run it is said, with the place and a remedy; the balance of energies holds all the same.
#[test]
fn corners_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let newmark = "scheme = \"newmark\"";
    let drawn = "[0.0, 0.0], [0.5, 0.1], [1.5, 0.1]";
    for (amplitude, said) in [
        (table(drawn, ""), "velocity jumps at t = 0.5\n"),
        (table("[0.0, 0.0], [0.5, 0.1]", "after = \"hold\""), "velocity jumps at t = 0.5\n"),
        (table("[0.2, 0.0], [0.6, 0.1], [0.8, 0.0]", ""), "velocity jumps at t = 0.2 and 2 times more"),
        (table(&samples(swing, 1.0, 20), "interpolation = \"linear\""), "velocity jumps at t = 0.05 and 16 times more"),
        ("[amplitudes.record]\nkind = \"ramp\"\nend = 0.5\n".to_owned(), "velocity jumps at t = 0.5\n"),
    ] {
        let (code, found) = run(folder, &pin("0.0125", newmark, &amplitude));
        assert!(code == 0 && found.contains(said) && found.contains("[amplitudes.record]"), "{amplitude}: {found}");
        assert!(found.contains("interpolation = \"monotone\""), "{found}");
        assert!(!found.contains("energy"), "{amplitude}: {found}");
    }
    // Steps that do not end at the corners miss the impulses: the balance says so, and blames the corners.
    let linear = table(&samples(swing, 1.0, 20), "interpolation = \"linear\"");
    let (code, found) = run(folder, &pin("0.0033", newmark, &linear));
    assert!(code == 0 && found.contains("first at t = 0.05. Let steps end there"), "{found}");
    assert!(!found.contains("a tenth of `time_step`"), "{found}");
    // What rounds the corners, or has none, is not spoken of.
    for amplitude in [
        table(drawn, "interpolation = \"monotone\""),
        table("[0.0, 0.0], [1.0, 0.1]", ""),
        table(&samples(swing, 1.0, 16), ""),
        table(&samples(|t| swing(t.clamp(0.2, 0.7) - 0.2), 1.0, 100), "interpolation = \"monotone\""),
        table(&samples(|t| 0.1 * (TAU * t).sin(), 1.0, 40), ""),
    ] {
        let (code, found) = run(folder, &pin("0.0125", newmark, &amplitude));
        assert_eq!((code, found.as_str()), (0, ""), "{amplitude}");
    }
    let overshoot = table("[0.0, 0.0], [0.4, 0.0], [0.5, 0.1], [0.6, 0.1], [1.0, 0.12]", "interpolation = \"cubic\"");
    let (code, found) = run(folder, &pin("0.0125", newmark, &overshoot));
    assert!(code == 0 && found.contains("goes beyond its points"), "{found}");
}

/// The work of a drive whose acceleration jumps where steps end is of second order: each side of the jump has its own force. With the force
/// before the jump on both sides the errors at 5 ms were 0.97 J with samples of velocity, and fell with the first power of the step.
#[test]
fn work_is_of_second_order_where_accelerations_jump() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let missing = |step: f64, scheme: &str, motion: &str, amplitude: &str| {
        let deck = format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = {step}\n[integrator]\nscheme = \"{scheme}\"\n[[bodies]]\nname = \"arm\"\n\
             center = [0.3, 0.0, 0.0]\nmass = 10.0\ninertia = [1.0, 1.0, 1.1]\n[[joints]]\nname = \"motor\"\nkind = \"revolute\"\n\
             axis = [0.0, 0.0, 1.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"arm\" }}\n\
             motion = {{ {motion} = 1.0, amplitude = \"record\" }}\n{amplitude}"
        );
        assert_eq!(run(folder, &deck), (0, String::new()), "{step} {scheme} {motion} {amplitude}");
        column(folder, "energy.csv", "numerical").iter().fold(0.0, |most: f64, row| most.max(row[1].abs()))
    };
    let samples_of_rate = samples(|t| 0.5 * TAU * (TAU * t).sin(), 1.0, 100);
    for (motion, amplitude) in [
        ("velocity", table(&samples_of_rate, "")),
        ("velocity", table(&samples_of_rate, "interpolation = \"linear\"")),
        ("velocity", table("[0.0, 0.0], [0.2, 3.0], [0.7, 3.0], [0.9, 0.0]", "")),
        ("acceleration", table("[0.0, 6.0], [0.3, 8.0], [0.8, -6.0]", "after = \"zero\"")),
        ("acceleration", "[amplitudes.record]\nkind = \"step\"\nstart = 0.2\nend = 0.6\n".to_owned()),
        ("velocity", "[amplitudes.record]\nkind = \"sine\"\nfrequency = 1.0\nstart = 0.1\nend = 0.85\n".to_owned()),
        (
            "position",
            "[amplitudes.record]\nkind = \"sine-squared\"\nfrequency = 0.5\nstart = 0.1\nend = 1.1\n".to_owned(),
        ),
    ] {
        for scheme in ["newmark", "generalized-alpha"] {
            let points = [0.01, 0.005].map(|step| (step, missing(step, scheme, motion, &amplitude)));
            // Where the acceleration does not jump, or is constant on each side, samples of nine digits leave 1e-6 J of 20 J.
            let order = (points[0].1 / points[1].1).log2();
            assert!(points[0].1 < 1e-5 || order > 1.9, "{scheme} {motion} {amplitude}: {points:?}");
            assert!(points[0].1 < 0.02, "{scheme} {motion} {amplitude}: {points:?}");
        }
    }
}
