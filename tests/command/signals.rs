//! A signal at any instant of any kind of analysis ends the program soon, with its exit code.

use crate::support::read_deck;
use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};
use rdsolve::model::Model;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run};
use rdsolve::system::System;
use std::fs;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The time within which a process has to end: steps get two seconds to come to their end, and a loaded machine some more.
const SOON: Duration = Duration::from_secs(20);
/// The longest time from the start of the process to the signal.
const LATEST: f64 = 0.4;

/// The keys of a deck with a plate, which come before its tables.
const KEYS: &str = r#"
materials.steel = { model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7850.0 }
points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }
amplitudes.push = { kind = "ramp", end = 1.0 }
amplitudes.shake = { kind = "harmonic" }
"#;

/// The tables of a deck with a plate that is bent.
const PLATE: &str = r#"
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = 12
thickness = 0.01
material = "steel"
[[supports]]
at = ["a", "d"]
fix = "all"
[[loads]]
at = "b"
force = [-1.0, 0.0, 30.0]
"#;

/// The kinds of analysis by name, each with its tables of the deck and the amplitude of its load. None comes to its end before the signal.
const KINDS: [(&str, &str, &str); 15] = [
    ("load steps", r#"analysis = { kind = "static", end_time = 1.0, time_step = 1e-5 }"#, "push"),
    (
        "arc length",
        r#"analysis = { kind = "static", control = "arc-length", end_time = 1.0, time_step = 1e-5, growth = 1.0 }"#,
        "push",
    ),
    ("implicit", r#"analysis = { kind = "dynamic", end_time = 1.0, time_step = 1e-6 }"#, "push"),
    (
        "two stages",
        "analysis = { kind = \"dynamic\", end_time = 1.0, time_step = 1e-6 }\nintegrator.scheme = \"bathe\"",
        "push",
    ),
    (
        "three stages",
        "analysis = { kind = \"dynamic\", end_time = 1.0, time_step = 1e-6 }\nintegrator.scheme = \"esdirk3\"",
        "push",
    ),
    (
        "explicit",
        "analysis = { kind = \"dynamic\", end_time = 1.0, time_step = 1e-7 }\nintegrator.scheme = \"central-difference\"",
        "push",
    ),
    (
        "runge-kutta",
        "analysis = { kind = \"dynamic\", end_time = 1.0, time_step = 1e-8 }\nintegrator.scheme = \"runge-kutta\"",
        "push",
    ),
    (
        "by error",
        r#"analysis = { kind = "dynamic", end_time = 1e3, time_step = "auto", error_tolerance = 1e-9 }"#,
        "push",
    ),
    (
        "by stability",
        "analysis = { kind = \"dynamic\", end_time = 1e3, time_step = \"auto\" }\nintegrator.scheme = \"central-difference\"",
        "push",
    ),
    ("modes", r#"analysis = { kind = "modal", modes = 600 }"#, ""),
    ("damped modes", "analysis = { kind = \"modal\", modes = 60, damped = true }\ndamping = { alpha = 1.0 }", ""),
    ("buckling", r#"analysis = { kind = "buckling", modes = 60 }"#, ""),
    (
        "response",
        "analysis = { kind = \"frequency-response\", frequencies = { from = 1.0, to = 300.0, steps = 400000 } }\ndamping = { alpha = 1.0 }",
        "shake",
    ),
    (
        "response by modes",
        "analysis = { kind = \"frequency-response\", method = \"modal\", modes = 20, frequencies = { from = 1.0, to = 300.0, steps = 400000 } }",
        "shake",
    ),
    (
        "stages",
        "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 1.0\n[[stages]]\nname = \"then\"\nkind = \"dynamic\"\nduration = 1.0\ntime_step = 1e-6",
        "",
    ),
];

/// Starts the program in a folder, sends it the signal after some time, and returns its exit code and what it says.
fn stop(folder: &std::path::Path, arguments: &[&str], after: f64) -> (Option<i32>, String) {
    stop_once(folder, arguments, || std::thread::sleep(Duration::from_secs_f64(after)))
}

/// The same, with the signal after `wait`.
fn stop_once(folder: &std::path::Path, arguments: &[&str], wait: impl FnOnce()) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
    command.current_dir(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    wait();
    let sent = Command::new("kill").args(["-s", "TERM", &child.id().to_string()]).status().unwrap();
    assert!(sent.success(), "{arguments:?} has ended before the signal");
    let (process, sent) = (child.id().to_string(), Instant::now());
    // What does not end is killed, so that the test ends.
    let (ended, waiting) = std::sync::mpsc::channel::<()>();
    let guard = std::thread::spawn(move || {
        if waiting.recv_timeout(2 * SOON).is_err() {
            let _ = Command::new("kill").args(["-s", "KILL", &process]).status();
        }
    });
    let output = child.wait_with_output().unwrap();
    let took = sent.elapsed();
    let _ = ended.send(());
    guard.join().unwrap();
    assert!(took < SOON, "{arguments:?} took {took:?} after a signal");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Every kind of analysis ends with 75, wherever the signal comes: while the deck is read, planned, computed or written.
#[test]
fn a_signal_at_any_instant_ends_every_kind_of_analysis() {
    let mut dice = SmallRng::seed_from_u64(45);
    for (name, analysis, amplitude) in KINDS {
        let folder = tempfile::tempdir().unwrap();
        let amplitude = if amplitude.is_empty() { String::new() } else { format!("amplitude = \"{amplitude}\"\n") };
        fs::write(folder.path().join("deck.toml"), format!("{KEYS}{analysis}\n{PLATE}{amplitude}")).unwrap();
        let after = dice.random_range(0.02..LATEST);
        let (code, said) = stop(folder.path(), &["run", "deck.toml", "-o", "out"], after);
        assert_eq!(code, Some(75), "{name} after {after} s: {said}");
        assert!(said.contains("stopped by a signal"), "{name}: {said}");
    }
}

/// So do commands that run a deck many times, and the export of matrices.
#[test]
fn a_signal_at_any_instant_ends_every_command() {
    let mut dice = SmallRng::seed_from_u64(46);
    let folder = tempfile::tempdir().unwrap();
    let deck = format!("{KEYS}{}\n{PLATE}amplitude = \"push\"\n", KINDS[2].1);
    fs::write(folder.path().join("deck.toml"), &deck).unwrap();
    fs::write(folder.path().join("large.toml"), deck.replace("elements = 12", "elements = 300")).unwrap();
    fs::write(
        folder.path().join("sweep.toml"),
        "deck = \"deck.toml\"\n[vary]\n\"shells.plate.thickness\" = [0.01, 0.02, 0.03]\n",
    )
    .unwrap();
    let commands: [&[&str]; 4] = [
        &["sweep", "sweep.toml", "-o", "cases"],
        &["study", "deck.toml", "-o", "study"],
        &["check", "large.toml", "--export-matrices", "matrices"],
        &["run", "large.toml", "-o", "large"],
    ];
    for arguments in commands {
        let after = dice.random_range(0.02..LATEST);
        let (code, said) = stop(folder.path(), arguments, after);
        assert_eq!(code, Some(75), "{arguments:?} after {after} s: {said}");
    }
}

/// A signal while matrices are written names the folder in which they are not whole.
#[test]
fn a_signal_while_matrices_are_written_names_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let deck = format!("{KEYS}{}\n{PLATE}amplitude = \"push\"\n", KINDS[2].1);
    fs::write(folder.path().join("deck.toml"), deck.replace("elements = 12", "elements = 80")).unwrap();
    let begun = || {
        let (first, began) = (folder.path().join("matrices/K.mtx"), Instant::now());
        // Some tens of megabytes follow once the first file is there.
        while !first.exists() && began.elapsed() < 3 * SOON {
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let (code, said) = stop_once(folder.path(), &["check", "deck.toml", "--export-matrices", "matrices"], begun);
    assert_eq!(code, Some(75), "{said}");
    assert!(said.contains("files in `matrices` may be missing or cut short: run the same command again"), "{said}");
}

/// Keeps what a run shows of a response, and stops it at a place.
#[derive(Default)]
struct Rows {
    /// Frequency, and the real part of the first motion, of each row shown.
    shown: Vec<[f64; 2]>,
    /// How often modes were shown.
    modes: usize,
    /// How often the run has asked whether a checkpoint is due, and the question that is answered with yes.
    asked: usize,
    due: usize,
    checkpoint: Option<Vec<u8>>,
}

struct Stopping<'s> {
    rows: Rows,
    stop: &'s AtomicBool,
    /// Number of rows after which the run is stopped.
    after: usize,
}

impl Observer for Stopping<'_> {
    fn on_step(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }

    fn on_modes(&mut self, _: &Frame) -> std::io::Result<()> {
        self.rows.modes += 1;
        Ok(())
    }

    fn on_response(&mut self, frame: &Frame) -> std::io::Result<()> {
        let response = frame.modes.and_then(|modes| modes.response.as_ref()).unwrap();
        let rows = response.rows[frame.rows.clone()].iter();
        self.rows.shown.extend(rows.map(|row| [row.frequency, row.motions[0][2][0]]));
        if self.rows.shown.len() >= self.after {
            self.stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    }

    fn wants_checkpoint(&mut self, at_end: bool) -> bool {
        self.rows.asked += 1;
        // It stays due until it is written.
        !at_end && self.rows.due > 0 && self.rows.asked >= self.rows.due && self.rows.checkpoint.is_none()
    }

    fn on_checkpoint(&mut self, run: &[u8], _: bool) -> std::io::Result<()> {
        self.rows.checkpoint = Some(run.to_vec());
        if self.rows.due > 0 {
            self.stop.store(true, Ordering::Relaxed);
        }
        Ok(())
    }
}

/// Runs a response, or what is left of it after a checkpoint.
fn response(model: &Model, checkpoint: Option<Vec<u8>>, (due, after): (usize, usize)) -> (Rows, bool) {
    let system = System::new(model).unwrap();
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(model, &system, &plan, wanted(model), &stop).unwrap();
    if let Some(checkpoint) = checkpoint {
        run.resume(checkpoint);
    }
    let mut observer = Stopping { rows: Rows { due, ..Rows::default() }, stop: &stop, after };
    let (outcome, _) = run.run(&mut observer);
    assert!(matches!(outcome, Outcome::Done | Outcome::Stopped { .. }), "{outcome:?}");
    (observer.rows, matches!(outcome, Outcome::Stopped { .. }))
}

/// A response that is stopped between two frequencies, or while its rows are shown, goes on from there and shows each row once, with the same bits.
#[test]
fn a_response_goes_on_where_it_was_stopped() {
    for method in ["direct", "modal"] {
        let keys = KEYS.replace(
            "d = [0.0, 1.0, 0.0] }",
            "d = [0.0, 1.0, 0.0] }\ndamping = { alpha = 1.0 }\noutput = { nodes = [\"b\"] }",
        );
        let frequencies = "frequencies = { from = 1.0, to = 300.0, steps = 600 }";
        let analysis = format!("analysis = {{ kind = \"frequency-response\", method = \"{method}\", {frequencies} }}");
        let plate = PLATE.replace("elements = 12", "elements = 2");
        let model = read_deck(&format!("{keys}{analysis}\n{plate}amplitude = \"shake\"\n"));
        let (whole, stopped) = response(&model, None, (0, usize::MAX));
        assert!(!stopped && whole.shown.len() == 600 && whole.modes == 1, "{}", whole.shown.len());
        // A checkpoint before the 100th frequency, and a signal amid the rows.
        for place in [(100, usize::MAX), (0, 200)] {
            let (begun, stopped) = response(&model, None, place);
            assert!(stopped && begun.shown.len() < 600, "{method} {place:?}");
            let (rest, stopped) = response(&model, begun.checkpoint, (0, usize::MAX));
            let asked = if place.0 > 0 { 100 } else { 0 };
            // Known frequencies are not solved for again.
            assert!(!stopped && rest.asked + asked <= whole.asked + 8, "{method}: {} of {}", rest.asked, whole.asked);
            assert_eq!([begun.shown, rest.shown].concat(), whole.shown, "{method} {place:?}");
            assert_eq!(begun.modes + rest.modes, 1, "{method} {place:?}");
        }
    }
}
