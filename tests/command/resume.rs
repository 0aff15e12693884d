//! A run that goes on from a checkpoint takes the very steps of one that never stopped.

use crate::support::witness::{Watch, Watched, watch, whole};
use crate::support::{deck_names, decks, read};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use rdsolve::model::Model;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run};
use rdsolve::system::System;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What a run shows after a checkpoint that is compared, but for the last one: what a checkpoint leaves out shows soon.
const LOOKED_AT: usize = 200;

/// Resumes a run at each of its checkpoints for a while, and after the last to the end; returns their number. With RDSOLVE_RESUME each runs up
/// to the next one.
fn resume(name: &str, model: &Model, whole: &Watched) -> usize {
    let most = std::env::var("RDSOLVE_RESUME").map_or(LOOKED_AT, |_| usize::MAX);
    for (place, (before, checkpoint)) in whole.checkpoints.iter().enumerate() {
        let next = whole.checkpoints.get(place + 1).map_or(whole.things.len(), |(next, _)| *next);
        let is_last = place + 1 == whole.checkpoints.len();
        let next = if is_last { next } else { next.min(before.saturating_add(most)) };
        let rest = watch(model, Watch::From(checkpoint, (!is_last).then_some(next - before)));
        let expected = &whole.things[*before..next];
        let at = rest.things.iter().zip(expected).position(|(a, b)| a != b);
        assert_eq!(at, None, "{name}: seen {before} before the checkpoint, of {}", whole.things.len());
        if is_last {
            assert_eq!(rest.things.len(), expected.len(), "{name}");
            assert_eq!(rest.told, whole.told, "{name}");
        } else {
            assert!(rest.things.len() >= expected.len(), "{name}: {}", rest.told);
        }
    }
    println!("{name}: {} steps and more, {} checkpoints", whole.things.len(), whole.checkpoints.len());
    whole.checkpoints.len()
}

#[test]
fn every_deck_goes_on_as_if_it_had_never_stopped() {
    let only = std::env::var("RDSOLVE_RESUME").unwrap_or_default();
    let mut checkpoints = 0;
    // The test of the values runs the same decks from the first on: both meet in the middle and share the runs.
    for name in deck_names().iter().rev().filter(|name| name.contains(&only)) {
        checkpoints += resume(name, &read(name, &[]), &whole(name));
    }
    println!("{checkpoints} checkpoints");
}

/// A top, a mechanism with joints, and a block caught by a rope, in every scheme, with steps of given length and automatic ones.
#[test]
fn every_scheme_goes_on_as_if_it_had_never_stopped() {
    let implicit = ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"];
    let explicit = ["central-difference", "runge-kutta"];
    for scheme in implicit.into_iter().chain(explicit) {
        for (name, end_time, time_step) in
            [("heavy_top", "0.05", "1e-4"), ("four_bar", "0.2", "1e-3"), ("caught_by_a_rope", "0.5", "5e-4")]
        {
            for time_step in [time_step, "\"auto\""] {
                let sets = [
                    format!("integrator={{scheme=\"{scheme}\"}}"),
                    format!("analysis.end_time={end_time}"),
                    format!("analysis.time_step={time_step}"),
                    "expect=[]".to_owned(),
                ];
                let checkpoints = {
                    let model = read(name, &sets);
                    resume(&format!("{name} {scheme} {time_step}"), &model, &watch(&model, Watch::Whole))
                };
                assert!(checkpoints > 1, "{name} {scheme} {time_step}: {checkpoints}");
            }
        }
    }
}

/// A deck in a folder of its own.
struct Desk {
    dir: tempfile::TempDir,
    deck: PathBuf,
}

impl Desk {
    fn new(deck: &str) -> Desk {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("deck.toml"), deck).unwrap();
        Desk { deck: dir.path().join("deck.toml"), dir }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn command(&self, folder: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
        command.arg(&self.deck).arg("-o").arg(self.at(folder)).args(more);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Exit code and standard error.
    fn run(&self, folder: &str, more: &[&str]) -> (Option<i32>, String) {
        let output = self.command(folder, more).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    }

    /// Starts a run and stops it by a signal once a file is there and so much time has gone; returns its exit code.
    fn stop(&self, folder: &str, more: &[&str], signal: &str, (file, after): (&str, Duration)) -> Option<i32> {
        let (mut child, began) = (self.command(folder, more).spawn().unwrap(), Instant::now());
        while !self.at(folder).join(file).exists() && child.try_wait().unwrap().is_none() {
            if began.elapsed() > Duration::from_secs(60) {
                child.kill().unwrap();
                panic!("no {file}");
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(after);
        Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        child.wait().unwrap().code()
    }

    /// What a run has left, but for what tells the clock.
    fn left(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.at(folder)).unwrap().map(|entry| entry.unwrap().path());
        let named = entries.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), path));
        let lasting = named.filter(|(name, _)| !["result.json", "run.log", "run.list"].contains(&name.as_str()));
        lasting.map(|(name, path)| (name, fs::read(path).unwrap())).collect()
    }

    fn result(&self, folder: &str) -> serde_json::Value {
        serde_json::from_slice(&fs::read(self.at(folder).join("result.json")).unwrap()).unwrap()
    }
}

/// Runs a deck whole, and again with stops by SIGKILL and SIGTERM wherever the dice fall; compares all that both leave.
fn stopped_and_whole(name: &str, more: &[&str], stops: u64) {
    let deck = fs::read_to_string(decks().join(name).join("deck.toml")).unwrap();
    let desk = Desk::new(&deck);
    let more = [&["--quiet", "--set", "output.checkpoint=0.002"], more].concat();
    let began = Instant::now();
    assert_eq!(desk.run("whole", &more).0, Some(0));
    let took = began.elapsed();
    let resumed = [&more[..], &["--resume"]].concat();
    let mut dice = SmallRng::seed_from_u64(7);
    let mut waits = || took.mul_f64(f64::from(dice.next_u32()) / f64::from(u32::MAX));
    let mut times = 0;
    for k in 0..stops {
        let signal = if k % 3 == 2 { "TERM" } else { "KILL" };
        let code = desk.stop("stopped", &resumed, signal, ("run.list", waits().mul_f64(0.7)));
        assert!(matches!(code, None | Some(0 | 75)), "{code:?}");
        if code == Some(0) {
            fs::remove_dir_all(desk.at("stopped")).unwrap();
        } else {
            times += 1;
        }
    }
    let (code, said) = desk.run("stopped", &resumed);
    assert_eq!(code, Some(0), "{said}");
    assert!(times > 0, "{name}: never stopped in the midst");
    let [whole, stopped] = ["whole", "stopped"].map(|folder| desk.left(folder));
    assert!(whole.keys().eq(stopped.keys()), "{name}: {:?} {:?}", whole.keys(), stopped.keys());
    whole.iter().for_each(|(file, bytes)| assert!(*bytes == stopped[file], "{name}: {file}"));
    let [whole, stopped] = ["whole", "stopped"].map(|folder| desk.result(folder));
    for key in ["counts", "expectations", "warnings", "error_bars", "step_error"] {
        assert_eq!(whole[key], stopped[key], "{name}: {key}");
    }
}

#[test]
fn stages_go_on_where_they_were_stopped() {
    stopped_and_whole("hung_and_shaken", &[], 6);
    stopped_and_whole("protective_frame", &[], 6);
}

#[test]
fn automatic_steps_go_on_where_they_were_stopped() {
    stopped_and_whole(
        "heavy_top",
        &["--set", "analysis.time_step=\"auto\"", "--set", "analysis.end_time=0.2", "--set", "expect=[]"],
        8,
    );
    // Its comparison run steps across kinks of the ground motion and ends early, and a run with half the steps follows.
    let record = decks().join("isolated_building/quake.AT2");
    let record = format!("amplitudes.quake.file={:?}", record.display().to_string());
    let automatic = ["analysis.time_step=\"auto\"", "integrator={scheme=\"esdirk3\"}", "expect=[]"];
    let sets = [&automatic[..], &["analysis.error_tolerance=1e-3", &record]].concat();
    stopped_and_whole("isolated_building", &sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>(), 6);
}

/// Pilot runs are made again, and tell the same errors.
#[test]
fn an_error_asked_for_goes_on_where_it_was_stopped() {
    let sets =
        ["analysis.accuracy=1e-3", "analysis.time_step=\"auto\"", "expect=[]", "integrator={scheme=\"esdirk3\"}"];
    stopped_and_whole("flying_beam", &sets.map(|set| ["--set", set]).concat(), 6);
    // The tolerance falls on the way, and the rest of the run has to know.
    let mesh = ["beams.0.elements=1", "beams.0.order=2"];
    stopped_and_whole(
        "block_on_cantilever",
        &[&sets[..], &mesh].concat().iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>(),
        6,
    );
}

#[test]
fn fields_and_material_go_on_where_they_were_stopped() {
    let fields = "output.fields={ format = \"vtu\", every = 7 }";
    stopped_and_whole("plastic_collapse", &["--set", fields], 6);
}

/// A ball that flies for hours.
const BALL: &str = "[analysis]\nkind = \"dynamic\"\nend_time = 1e5\ntime_step = 1e-3\n[[bodies]]\nname = \"ball\"\n\
    center = [0.0, 0.0, 0.0]\nmass = 1.0\nvelocity = [1.0, 0.0, 0.0]\nshape = { kind = \"sphere\", radius = 0.1 }\n\
    [output]\nevery = 100\n";

#[test]
fn what_cannot_be_resumed_is_said() {
    let desk = Desk::new(BALL);
    let at_once = Duration::from_millis(50);
    assert_eq!(desk.stop("out", &["--resume"], "TERM", ("bodies.csv", at_once)), Some(75));
    let checkpoint = desk.at("out/run.checkpoint");
    let whole = fs::read(&checkpoint).unwrap();
    let refused = |more: &[&str], code: i32, words: &[&str]| {
        let (ended, said) = desk.run("out", &[&["--resume"], more].concat());
        assert_eq!(ended, Some(code), "{said}");
        words.iter().for_each(|word| assert!(said.contains(word), "`{word}` is not in {said}"));
    };
    refused(&["--set", "analysis.time_step=2e-3"], 2, &["its --set are none, and now `analysis.time_step=2e-3`"]);
    refused(&["--set", "analysis.end_time=2e5"], 2, &["to `end_time` = 100000, which it has not come to"]);
    refused(&["--mesh-error"], 2, &["without --mesh-error"]);
    refused(&["--overwrite"], 2, &["--overwrite", "--resume"]);
    fs::write(&desk.deck, BALL.replace("1.0, 0.0, 0.0]\nshape", "2.0, 0.0, 0.0]\nshape")).unwrap();
    refused(&[], 2, &["is not of this run: the deck has changed since", "--overwrite in place of --resume"]);
    fs::write(&desk.deck, BALL).unwrap();
    fs::write(&checkpoint, &whole[..whole.len() - 1]).unwrap();
    refused(&[], 6, &["run.checkpoint: this is no whole checkpoint"]);
    fs::write(&checkpoint, &whole).unwrap();
    let table = fs::read(desk.at("out/bodies.csv")).unwrap();
    fs::write(desk.at("out/bodies.csv"), &table[..100]).unwrap();
    refused(&[], 6, &["bodies.csv: the table is shorter than it was at the checkpoint"]);
    // All is as it was: the run goes on.
    assert_eq!(desk.result("out")["status"], "stopped");
    fs::write(desk.at("out/bodies.csv"), &table).unwrap();
    let before = desk.result("out")["counts"]["steps"].as_u64().unwrap();
    // What changes nothing but when checkpoints are written may differ.
    let more = ["--resume", "--set", "output.checkpoint=5.0"];
    assert_eq!(desk.stop("out", &more, "TERM", ("bodies.csv", at_once)), Some(75));
    assert!(desk.result("out")["counts"]["steps"].as_u64().unwrap() >= before);
    // Without its checkpoint it has ended.
    fs::remove_file(&checkpoint).unwrap();
    refused(&more[1..], 2, &["was stopped, and its checkpoint is gone"]);
}

#[test]
fn without_a_checkpoint_a_run_begins() {
    let desk = Desk::new(&BALL.replace("1e5", "1.0"));
    let (code, said) = desk.run("out", &["--resume"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("there is no checkpoint") && said.contains("begins at t = 0"), "{said}");
    assert!(!desk.at("out/run.checkpoint").exists(), "a run that is done leaves none");
    let (code, said) = desk.run("out", &["--resume"]);
    assert!(code == Some(0) && said.contains("has come to its end"), "{said}");
    let (code, said) = desk.run("out", &["--resume", "--set", "analysis.time_step=2e-3"]);
    assert!(code == Some(2) && said.contains("those of another deck"), "{said}");
    // A run that was killed before its first checkpoint.
    fs::remove_file(desk.at("out/result.json")).unwrap();
    let rows = fs::read(desk.at("out/bodies.csv")).unwrap();
    fs::write(desk.at("out/bodies.csv"), &rows[..rows.len() / 2]).unwrap();
    let (code, said) = desk.run("out", &["--resume"]);
    assert!(code == Some(0) && said.contains("begins at t = 0"), "{said}");
    assert_eq!(fs::read(desk.at("out/bodies.csv")).unwrap(), rows);
    // Another deck, and a folder of somebody else.
    fs::remove_file(desk.at("out/result.json")).unwrap();
    let (code, said) = desk.run("out", &["--resume", "--set", "analysis.time_step=2e-3"]);
    assert!(code == Some(2) && said.contains("those of another deck"), "{said}");
    fs::create_dir(desk.at("mine")).unwrap();
    fs::write(desk.at("mine/letter"), "").unwrap();
    let (code, said) = desk.run("mine", &["--resume"]);
    assert!(code == Some(2) && said.contains("holds files already"), "{said}");
}

/// Raises the flag that ends a run before one of its steps, as a signal that comes while it is computed, and counts what it leaves.
struct Signal<'s> {
    stop: &'s AtomicBool,
    steps_before: usize,
    asked: usize,
    rows: usize,
    checkpoints: usize,
}

impl Observer for Signal<'_> {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        self.rows += 1;
        Ok(())
    }

    fn wants_checkpoint(&mut self, _: bool) -> bool {
        self.stop.store(self.asked == self.steps_before, Ordering::Relaxed);
        self.asked += 1;
        false
    }

    fn on_checkpoint(&mut self, _: &[u8], _: bool) -> io::Result<()> {
        self.checkpoints += 1;
        Ok(())
    }
}

/// A signal ends the factorisation in hand before the first step is done: nothing is lost then. A later step is done first, and leaves a
/// checkpoint.
#[test]
fn a_signal_ends_the_first_factorization() {
    let text = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
[materials.steel]
model = "elastic"
youngs_modulus = 200e9
poisson_ratio = 0.3
density = 8000.0
[points]
a = [0.0, 0.0, 0.0]
b = [2.0, 0.0, 0.0]
c = [2.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = 24
thickness = 0.05
material = "steel"
[[supports]]
at = ["a", "b", "c", "d"]
fix = "all"
[[loads]]
at = "plate"
pressure = 1e3
"#;
    let model = crate::support::read_deck(text);
    let system = System::new(&model).unwrap();
    let plan = Plan::new(&model, &system, 1);
    for (steps_before, rows, checkpoints, end) in [(0, 1, 0, 0.0), (1, 3, 1, 0.5)] {
        let stop = AtomicBool::new(false);
        let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
        let mut signal = Signal { stop: &stop, steps_before, asked: 0, rows: 0, checkpoints: 0 };
        let (outcome, _) = run.run(&mut signal);
        assert!(matches!(outcome, Outcome::Stopped { time, .. } if time == end), "{steps_before}: {outcome:?}");
        assert_eq!((signal.rows, signal.checkpoints), (rows, checkpoints), "{steps_before}");
    }
}

/// A run that is stopped while its step is halved again and again says what it was halved for.
#[test]
fn a_signal_in_a_step_that_is_cut_back_tells_why() {
    let model = crate::support::read_deck(include_str!("../../decks/extreme/overloaded/deck.toml"));
    let system = System::new(&model).unwrap();
    let plan = Plan::new(&model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
    let mut signal = Signal { stop: &stop, steps_before: 3, asked: 0, rows: 0, checkpoints: 0 };
    let (outcome, _) = run.run(&mut signal);
    let Outcome::Stopped { time, cut: Some(failure) } = outcome else { panic!("{outcome:?}") };
    assert_eq!(time, 0.0);
    assert!(failure.to_string().contains("unbalanced forces"), "{failure}");
}

/// A run that a signal has ended before its first step was done leaves a result without a checkpoint, and begins anew.
#[test]
fn what_was_stopped_before_its_first_step_begins() {
    let desk = Desk::new(&BALL.replace("1e5", "1.0"));
    let (code, said) = desk.run("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    let rows = fs::read(desk.at("out/bodies.csv")).unwrap();
    let stopped = |steps: u64| {
        let mut result = desk.result("out");
        result["status"] = "stopped".into();
        result["counts"]["steps"] = steps.into();
        fs::write(desk.at("out/result.json"), result.to_string()).unwrap();
        desk.run("out", &["--resume"])
    };
    let (code, said) = stopped(3);
    assert!(code == Some(2) && said.contains("its checkpoint is gone"), "{said}");
    let (code, said) = stopped(0);
    assert!(code == Some(0) && said.contains("begins at t = 0"), "{said}");
    assert_eq!(fs::read(desk.at("out/bodies.csv")).unwrap(), rows);
}

/// A heavy top made longer goes where one goes that was as long from the beginning; steps begin anew at its end, which rounds differently.
#[test]
fn a_run_that_is_over_can_be_made_longer() {
    let desk = Desk::new(&fs::read_to_string(decks().join("heavy_top/deck.toml")).unwrap());
    let to = |end: &str| format!("analysis.end_time={end}");
    let common = ["--quiet", "--set", "output.checkpoint=600"];
    let run =
        |folder: &str, end: &str, more: &[&str]| desk.run(folder, &[&common[..], &["--set", &to(end)], more].concat());
    let text = fs::read_to_string(&desk.deck).unwrap();
    fs::write(&desk.deck, &text[..text.find("[[expect]]").unwrap_or(text.len())]).unwrap();
    assert_eq!(run("whole", "0.2", &[]).0, Some(0));
    assert_eq!(run("longer", "0.1", &[]).0, Some(0));
    let (code, said) = run("longer", "0.1", &["--resume"]);
    assert!(code == Some(0) && said.contains("the run there has come to its end"), "{said}");
    let (code, said) = run("longer", "0.05", &["--resume"]);
    assert!(code == Some(2) && said.contains("to `end_time` = 0.1"), "{said}");
    let (code, said) = run("longer", "0.2", &["--resume"]);
    assert_eq!(code, Some(0), "{said}");
    let last = |folder: &str| -> Vec<f64> {
        let table = fs::read_to_string(desk.at(folder).join("bodies.csv")).unwrap();
        table.lines().last().unwrap().split(',').filter_map(|word| word.parse().ok()).collect()
    };
    let [whole, longer] = ["whole", "longer"].map(last);
    let largest = whole.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    assert!(whole.len() > 10 && whole.len() == longer.len());
    for (a, b) in whole.iter().zip(&longer) {
        // Rounding of step lengths, some hundred steps long.
        assert!((a - b).abs() < 1e-9 * largest, "{whole:?} {longer:?}");
    }
}

/// The mesh counts as much as the deck: a run of another is not gone on with.
#[test]
fn a_mesh_that_has_changed_is_said() {
    let mesh = |length: f64| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"rod\"\n$EndPhysicalNames\n\
             $Nodes\n2\n1 0 0 0\n2 {length} 0 0\n$EndNodes\n$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n"
        )
    };
    let desk = Desk::new(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.01\ntime_step = 1e-3\n[mesh]\nfile = \"rod.msh\"\n\
         [materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0\n\
         [sections.rod]\nshape = \"rectangle\"\nwidth = 0.01\nheight = 0.01\n\
         [[beams]]\ngroup = \"rod\"\nmaterial = \"steel\"\nsection = \"rod\"\norientation = [0.0, 1.0, 0.0]\n\
         [output]\nnodes = \"all\"\ncheckpoint = 600.0\n",
    );
    let file = desk.deck.with_file_name("rod.msh");
    fs::write(&file, mesh(1.0)).unwrap();
    let (code, said) = desk.run("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    fs::write(&file, mesh(2.0)).unwrap();
    let longer = ["--resume", "--set", "analysis.end_time=0.02"];
    let (code, said) = desk.run("out", &longer);
    assert!(code == Some(2) && said.contains("rod.msh` has changed since"), "{said}");
    fs::write(&file, mesh(1.0)).unwrap();
    let (code, said) = desk.run("out", &longer);
    assert_eq!(code, Some(0), "{said}");
}
