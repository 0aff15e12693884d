//! Sweeps: what they run, what they collect, and that it does not matter who ran what, or how often they were killed.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};
use std::time::Duration;

/// A block that falls and is caught by a rope.
const DECK: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.002
[[bodies]]
name = "block"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [1.0, 1.0, 1.0]
[[links]]
name = "rope"
from = { ground = [0.0, 0.0, 1.0] }
to = { body = "block" }
law = "tension-only"
stiffness = 4000.0
gap = 0.1
[environment]
gravity = [0.0, 0.0, -9.81]
[output]
links = true
"#;
const SWEEP: &str = r#"
deck = "deck.toml"
[vary]
"bodies.block.mass" = [1.0, 2.0, 4.0]
"links.rope.stiffness" = { from = 2e3, to = 6e3, steps = 5 }
[collect]
lowest = { at = "block", quantity = "z", peak = "min" }
end = { at = "block", quantity = "z", time = "end" }
half = { at = "block", quantity = "vz", time = 0.5 }
kinetic = { at = "energy", quantity = "kinetic", peak = "max" }
nothing = { at = "block", quantity = "force", peak = "max" }
"#;

fn files(sweep: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.toml"), DECK).unwrap();
    fs::write(folder.path().join("s.toml"), sweep).unwrap();
    folder
}

fn rdsolve(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn rows(folder: &Path, file: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(folder.join(file)).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

/// All combinations are run, each as `run --set` does it, and the summary has the numbers of their tables. What stands is not run again.
#[test]
fn a_sweep_is_its_runs() {
    let folder = files(SWEEP);
    let folder = folder.path();
    let output = rdsolve(folder, &["sweep", "s.toml"]);
    let said = text(&output.stderr);
    assert!(output.status.success() && said.lines().count() == 1 && said.contains("`nothing` is empty"), "{said}");
    assert!(text(&output.stdout).starts_with("15 cases: 15 done; "));
    let cases = rows(folder, "s.out/cases.csv");
    assert_eq!(cases[0], ["case", "folder", "bodies.block.mass", "links.rope.stiffness"]);
    assert_eq!((cases.len(), &cases[8][2..]), (16, &["2.0".to_owned(), "4000.0".to_owned()][..]));
    // The eighth case is the deck itself.
    assert!(rdsolve(folder, &["deck.toml", "-o", "alone", "--threads", "1"]).status.success());
    for table in ["bodies.csv", "energy.csv", "links.csv"] {
        let of_case = fs::read(folder.join("s.out").join(&cases[8][1]).join(table)).unwrap();
        assert_eq!(of_case, fs::read(folder.join("alone").join(table)).unwrap(), "{table}");
    }
    let summary = rows(folder, "s.out/summary.csv");
    let head = [
        "case",
        "bodies.block.mass",
        "links.rope.stiffness",
        "status",
        "lowest",
        "end",
        "half",
        "kinetic",
        "nothing",
        "reason",
        "warnings",
    ];
    assert_eq!(summary[0], head);
    let bodies = rows(folder, "alone/bodies.csv");
    let column = |name: &str| bodies[0].iter().position(|column| column == name).unwrap();
    let values =
        |name: &str| -> Vec<f64> { bodies[1..].iter().map(|row| row[column(name)].parse().unwrap()).collect() };
    let z = values("z");
    let number = |place: usize| summary[8][place].parse::<f64>().unwrap();
    assert_eq!(number(4), z.iter().copied().fold(f64::INFINITY, f64::min));
    assert_eq!((number(5), number(6)), (z[z.len() - 1], values("vz")[250]));
    // A free fall of 0.1 m and more: the energy conservation of a mass on a rope, x = g/ω² + √((g/ω²)² + 2 g h/ω²), to the error of steps.
    let w2 = 4000.0_f64 / 2.0;
    let sag = 9.81 / w2 + ((9.81_f64 / w2).powi(2) + 2.0 * 9.81 * 0.1 / w2).sqrt();
    assert!((number(4) + 0.1 + sag).abs() < 1e-3, "{} {}", number(4), 0.1 + sag);
    assert_eq!(summary[8][8], "");
    let stamp = |case: usize| {
        fs::metadata(folder.join("s.out").join(&cases[case][1]).join("result.json")).unwrap().modified().unwrap()
    };
    let (before, bytes) = (stamp(3), fs::read(folder.join("s.out/summary.csv")).unwrap());
    assert!(rdsolve(folder, &["sweep", "s.toml", "--jobs", "1"]).status.success());
    assert_eq!((stamp(3), fs::read(folder.join("s.out/summary.csv")).unwrap()), (before, bytes));
}

/// A set in `[output] nodes` is named in the rows of its nodes, and is collected by the extreme of them: the second of two masses on springs goes
/// twice as far.
#[test]
fn sets_are_collected_by_the_extreme_of_their_nodes() {
    let folder = tempfile::tempdir().unwrap();
    let deck = r#"
analysis = { kind = "dynamic", end_time = 1.0, time_step = 0.01 }
points = { near = [1.0, 0.0, 0.0], far = [2.0, 0.0, 0.0] }
masses = [{ at = "near", mass = 1.0 }, { at = "far", mass = 1.0 }]
links = [
    { name = "one", from = { ground = [0.0, 0.0, 0.0] }, to = { node = "near" }, stiffness = 100.0 },
    { name = "other", from = { ground = [0.0, 0.0, 0.0] }, to = { node = "far" }, stiffness = 100.0 },
]
supports = [{ at = ["near", "far"], fix = ["uy", "uz"] }]
initial = [{ at = "near", velocity = [1.0, 0.0, 0.0] }, { at = "far", velocity = [2.0, 0.0, 0.0] }]
sets = { both = ["near", "far"], last = ["far"], each = ["far", "near"] }
output = { nodes = ["both", "each", "last"] }
"#;
    let sweep = "deck = \"deck.toml\"\n[vary]\n\"links.one.stiffness\" = [100.0]\n[collect]\n\
                 far = { at = \"far\", quantity = \"ux\", peak = \"abs\" }\nboth = { at = \"both\", quantity = \"ux\", peak = \"abs\" }\n\
                 each = { at = \"each\", quantity = \"ux\", peak = \"abs\" }\nlast = { at = \"last\", quantity = \"ux\", peak = \"abs\" }\n";
    fs::write(folder.path().join("deck.toml"), deck).unwrap();
    fs::write(folder.path().join("s.toml"), sweep).unwrap();
    let output = rdsolve(folder.path(), &["sweep", "s.toml"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
    let found = rows(folder.path(), "s.out/summary.csv");
    let value = |name: &str| found[1][found[0].iter().position(|column| column == name).unwrap()].clone();
    assert!(!value("far").is_empty());
    assert!(["both", "each", "last"].iter().all(|set| value(set) == value("far")), "{found:?}");
    let case = rows(folder.path(), "s.out/cases.csv")[1][1].clone();
    let nodes = rows(folder.path(), &format!("s.out/{case}/nodes.csv"));
    assert_eq!(nodes[0].last().map(String::as_str), Some("set"));
    assert!(nodes[1..].iter().all(|row| row.last().is_some_and(|set| set.starts_with("both|each"))));
    // One time of several nodes is no number.
    fs::write(folder.path().join("s.toml"), sweep.replacen("peak = \"abs\" }\neach", "time = \"end\" }\neach", 1))
        .unwrap();
    let refused = rdsolve(folder.path(), &["sweep", "s.toml", "--collect"]);
    let warning = text(&refused.stderr);
    assert!(
        refused.status.success() && warning.contains("`both` is empty") && warning.contains("several nodes"),
        "{warning}"
    );
}

/// Eight processes that fill one folder at once, three that are killed on the way, and one process alone: the same summary, to the byte.
#[test]
fn it_does_not_matter_who_ran_what() {
    let sweep = SWEEP.replace("steps = 5", "steps = 40");
    let folder = files(&sweep);
    let folder = folder.path();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "alone", "--jobs", "2"]).status.success());
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    let spawn = |arguments: &[&str]| {
        let mut command = std::process::Command::new(&program);
        command.current_dir(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    };
    let shards: Vec<String> = (1..=8).map(|shard| format!("{shard}/8")).collect();
    let mut running: Vec<_> = shards
        .iter()
        .map(|shard| spawn(&["sweep", "s.toml", "-o", "shared", "--case", shard, "--jobs", "1"]))
        .collect();
    running.iter_mut().for_each(|process| assert!(process.wait().unwrap().success()));
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "shared", "--collect"]).status.success());
    for wait in [15, 40, 90] {
        let mut process = spawn(&["sweep", "s.toml", "-o", "killed", "--jobs", "2"]);
        std::thread::sleep(Duration::from_millis(wait));
        process.kill().unwrap();
        process.wait().unwrap();
    }
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "killed"]).status.success());
    let [alone, shared, killed] = ["alone", "shared", "killed"].map(|out| {
        let summary = fs::read(folder.join(out).join("summary.csv")).unwrap();
        assert!(
            !folder.join(out).read_dir().unwrap().any(|entry| entry
                .unwrap()
                .path()
                .extension()
                .is_some_and(|e| e == "tmp"))
        );
        (summary, fs::read(folder.join(out).join("cases.csv")).unwrap())
    });
    assert!(alone == shared && alone == killed);
}

/// A node died with a case of its own: its lock binds nobody once it has given no sign of life for long enough, and the case is run.
#[test]
fn a_case_of_a_host_that_died_is_taken_over() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 1").replace("[1.0, 2.0, 4.0]", "[1.0, 2.0]"));
    let folder = folder.path();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "alone"]).status.success());
    let name = rows(folder, "alone/cases.csv")[1][1].clone();
    let case = folder.join("shared").join(name);
    fs::create_dir_all(&case).unwrap();
    let lock = case.join("run.lock");
    fs::write(&lock, "host elsewhere\nprocess 7\nbegan 1795424821 (then)\nboot x\nrenewed every 30 s\n").unwrap();
    fs::write(case.join("bodies.csv"), "step,time\n0,0.0\n").unwrap();
    fs::write(case.join("run.list"), "# written by this run; --overwrite takes it away\nbodies.csv\n").unwrap();
    let output = rdsolve(folder, &["sweep", "s.toml", "-o", "shared"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("2 cases: 1 done, 1 are still to be run"), "{}", text(&output.stdout));
    // Six minutes later.
    let ago = std::time::SystemTime::now() - Duration::from_secs(360);
    fs::OpenOptions::new().write(true).open(&lock).unwrap().set_modified(ago).unwrap();
    let output = rdsolve(folder, &["sweep", "s.toml", "-o", "shared"]);
    assert!(text(&output.stdout).contains("2 cases: 2 done;"), "{}", text(&output.stdout));
    let summary = |out: &str| fs::read(folder.join(out).join("summary.csv")).unwrap();
    assert!(summary("alone") == summary("shared") && !lock.exists());
}

/// Where the deck has checkpoints a case that was killed goes on from its last; one that is damaged is of no harm.
#[test]
fn a_killed_case_goes_on_from_its_checkpoint() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 1").replace("[1.0, 2.0, 4.0]", "[1.0]"));
    let folder = folder.path();
    let long = DECK
        .replace("end_time = 1.0", "end_time = 400.0")
        .replace("[output]", "[output]\nevery = 500\ncheckpoint = 0.01");
    fs::write(folder.join("deck.toml"), long).unwrap();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "alone"]).status.success());
    let case = rows(folder, "alone/cases.csv")[1][1].clone();
    assert!(!folder.join("alone").join(&case).join("run.checkpoint").exists(), "a case that is done leaves none");
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    let case = folder.join("killed").join(case);
    for damaged in [false, true] {
        let checkpoint = case.join("run.checkpoint");
        // A loaded machine may look too late: the case has then come to its end.
        let killed = (0..20).any(|_| {
            let _ = fs::remove_dir_all(folder.join("killed"));
            let mut command = std::process::Command::new(&program);
            command.current_dir(folder).args(["sweep", "s.toml", "-o", "killed"]).stdout(Stdio::null());
            let mut process = command.spawn().unwrap();
            while !checkpoint.exists() && process.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
            process.kill().unwrap();
            process.wait().unwrap();
            checkpoint.exists() && !case.join("result.json").exists()
        });
        assert!(killed, "it always came to its end without a checkpoint");
        if damaged {
            fs::write(case.join("bodies.csv"), "step").unwrap();
        }
        assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "killed"]).status.success());
        let log = fs::read_to_string(case.join("run.log")).unwrap();
        assert_eq!(log.contains("the run goes on from its checkpoint"), !damaged, "{log}");
        let left = |out: &str, file: &str| fs::read(folder.join(out).join(file)).unwrap();
        assert!(left("alone", "summary.csv") == left("killed", "summary.csv"));
        let of_case = |out: &str| left(out, &format!("{}/bodies.csv", case.file_name().unwrap().to_str().unwrap()));
        assert!(of_case("alone") == of_case("killed") && !checkpoint.exists());
    }
}

/// A case whose folder goes away writes no table: its checkpoint has the numbers found so far, and is of no use to another list.
#[test]
fn a_checkpoint_of_other_numbers_begins_again() {
    let sweep = SWEEP.replace("steps = 5", "steps = 1").replace("[1.0, 2.0, 4.0]", "[1.0]");
    let folder = files(&sweep);
    let folder = folder.path();
    let long = DECK
        .replace("end_time = 1.0", "end_time = 400.0")
        .replace("[output]", "[output]\nevery = 500\ncheckpoint = 0.01");
    fs::write(folder.join("deck.toml"), long).unwrap();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "alone"]).status.success());
    let case = folder.join("killed").join(&rows(folder, "alone/cases.csv")[1][1]);
    let kept = sweep.replacen("[vary]", "keep = \"summary\"\n[vary]", 1);
    let without_energy: String =
        kept.lines().filter(|line| !line.starts_with("kinetic")).map(|line| format!("{line}\n")).collect();
    fs::write(folder.join("s.toml"), without_energy).unwrap();
    let killed = (0..20).any(|_| {
        let _ = fs::remove_dir_all(folder.join("killed"));
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
        command.current_dir(folder).args(["sweep", "s.toml", "-o", "killed"]).stdout(Stdio::null());
        let mut process = command.spawn().unwrap();
        while !case.join("run.checkpoint").exists() && process.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        process.kill().unwrap();
        process.wait().unwrap();
        case.join("run.checkpoint").exists()
    });
    assert!(killed, "it always came to its end without a checkpoint");
    assert!(!["bodies.csv", "energy.csv", "run.log", "run.list"].iter().any(|file| case.join(file).exists()));
    fs::write(folder.join("s.toml"), kept).unwrap();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "killed"]).status.success());
    let summary = |out: &str| fs::read_to_string(folder.join(out).join("summary.csv")).unwrap();
    assert_eq!(summary("alone"), summary("killed"));
}

/// A case that a signal stops goes on from there, whether the deck asks for checkpoints or not, by the same command.
#[test]
#[cfg(unix)]
fn a_stopped_case_goes_on() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 1").replace("[1.0, 2.0, 4.0]", "[1.0, 2.0]"));
    let folder = folder.path();
    let long = DECK.replace("end_time = 1.0", "end_time = 4000.0").replace("[output]", "[output]\nevery = 500");
    fs::write(folder.join("deck.toml"), long).unwrap();
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "alone"]).status.success());
    let cases = rows(folder, "alone/cases.csv");
    let case = |out: &str, number: usize| folder.join(out).join(&cases[number][1]);
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
    command.current_dir(folder).args(["sweep", "s.toml", "-o", "stopped", "--jobs", "1"]).stdout(Stdio::null());
    let mut process = command.stderr(Stdio::piped()).spawn().unwrap();
    // The first row of results is written when the steps have begun.
    while !fs::read_to_string(case("stopped", 1).join("bodies.csv")).is_ok_and(|rows| rows.lines().count() > 2) {
        assert!(process.try_wait().unwrap().is_none(), "it came to its end before it was stopped");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::process::Command::new("kill").args(["-TERM", &process.id().to_string()]).status().unwrap();
    let output = process.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("the same command goes on"));
    assert!(case("stopped", 1).join("run.checkpoint").exists());
    assert!(!case("stopped", 2).exists());
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "stopped", "--jobs", "1"]).status.success());
    let log = fs::read_to_string(case("stopped", 1).join("run.log")).unwrap();
    assert!(log.contains("the run goes on from its checkpoint"), "{log}");
    for number in [1, 2] {
        let [alone, stopped] = ["alone", "stopped"].map(|out| {
            let files = fs::read_dir(case(out, number)).unwrap().map(|entry| entry.unwrap().file_name());
            let mut names: Vec<_> = files.collect();
            names.sort();
            (names, fs::read(case(out, number).join("bodies.csv")).unwrap())
        });
        assert!(alone == stopped, "case {number}");
    }
    let summary = |out: &str| fs::read(folder.join(out).join("summary.csv")).unwrap();
    assert!(summary("alone") == summary("stopped"));
}

/// A signal that comes while a case reads its mesh ends the sweep before anything of the case is written.
#[test]
#[cfg(unix)]
fn a_signal_is_heard_while_a_mesh_is_read() {
    let folder = files("deck = \"deck.toml\"\n[vary]\n\"shells.plate.thickness\" = [0.002, 0.003]\n");
    let folder = folder.path();
    let side = 150;
    let node = |i: usize, j: usize| j * (side + 1) + i + 1;
    let mut mesh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"plate\"\n$EndPhysicalNames\n$Nodes\n{}\n",
        node(side, side)
    );
    for (j, i) in (0..=side).flat_map(|j| (0..=side).map(move |i| (j, i))) {
        mesh += &format!("{} {i}.0 {j}.0 0.0\n", node(i, j));
    }
    mesh += &format!("$EndNodes\n$Elements\n{}\n", side * side);
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        let corners = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
        let [a, b, c, d] = corners;
        mesh += &format!("{} 3 2 1 1 {a} {b} {c} {d}\n", j * side + i + 1);
    }
    mesh += "$EndElements\n";
    fs::write(folder.join("plate.msh"), mesh).unwrap();
    fs::write(
        folder.join("deck.toml"),
        "[mesh]\nfile = \"plate.msh\"\n[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.1\n[materials.steel]\n\
         model = \"elastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\ndensity = 7850.0\n[[shells]]\nname = \"plate\"\ngroup = \"plate\"\n\
         material = \"steel\"\nthickness = 0.002\n[environment]\ngravity = [0.0, 0.0, -9.81]\n",
    )
    .unwrap();
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
    command.current_dir(folder).args(["sweep", "s.toml", "--jobs", "1"]).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut process = command.spawn().unwrap();
    let cases = || fs::read_dir(folder.join("s.out")).into_iter().flatten().flatten().filter(|e| e.path().is_dir());
    while cases().count() == 0 {
        assert!(process.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    std::process::Command::new("kill").args(["-TERM", &process.id().to_string()]).status().unwrap();
    let output = process.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{}", text(&output.stderr));
    assert_eq!(cases().count(), 1);
    let left: Vec<_> = cases().flat_map(|case| fs::read_dir(case.path()).unwrap()).flatten().collect();
    assert!(left.is_empty(), "{left:?}");
}

/// The deck with a load that follows a record.
fn with_record(folder: &Path, record: &str, end_time: &str) {
    let load = "[amplitudes.pull]\nkind = \"table\"\nfile = \"pull.csv\"\n[[loads]]\nat = \"block\"\nforce = [0.0, 0.0, 1.0]\namplitude = \"pull\"\n";
    let deck = format!("{}{load}", DECK.replace("end_time = 1.0", &format!("end_time = {end_time}\n")));
    fs::write(folder.join("deck.toml"), deck).unwrap();
    fs::write(folder.join("pull.csv"), record).unwrap();
}

/// A record that is edited is another one, though its length and its time stay: by what it holds the cases are known.
#[test]
fn an_edited_record_is_noticed() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 1"));
    let folder = folder.path();
    let record = |last: &str| format!("t,f\n0.0,0.0\n1.0,{last}\n");
    let mut ends = Vec::new();
    let mut stamp = None;
    for last in ["1.0", "9.0"] {
        with_record(folder, &record(last), "1.0");
        let file = fs::OpenOptions::new().write(true).open(folder.join("pull.csv")).unwrap();
        file.set_modified(*stamp.get_or_insert_with(std::time::SystemTime::now)).unwrap();
        assert!(rdsolve(folder, &["sweep", "s.toml"]).status.success());
        ends.push(rows(folder, "s.out/summary.csv")[1][5].parse::<f64>().unwrap());
        let resumed = rdsolve(folder, &["run", "deck.toml", "--resume", "--quiet"]);
        assert_eq!(resumed.status.code(), Some(if last == "1.0" { 0 } else { 2 }), "{}", text(&resumed.stderr));
    }
    assert!((ends[0] - ends[1]).abs() > 1e-4, "{ends:?}");
}

/// A record that changes while the sweep is under way is not taken for the one by which the folders of its cases are named.
#[test]
fn a_record_that_changes_on_the_way_is_said() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 1"));
    let folder = folder.path();
    with_record(folder, "t,f\n0.0,0.0\n1.0,1.0\n", "200.0");
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
    command.current_dir(folder).args(["sweep", "s.toml", "--jobs", "1"]).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut process = command.spawn().unwrap();
    let has_begun = || {
        let mut entries = fs::read_dir(folder.join("s.out")).into_iter().flatten().flatten();
        entries.any(|entry| entry.path().join("bodies.csv").exists())
    };
    while !has_begun() {
        assert!(process.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::write(folder.join("pull.csv"), "t,f\n0.0,0.0\n1.0,2.0\n").unwrap();
    let output = process.wait_with_output().unwrap();
    let said = text(&output.stderr);
    assert!(output.status.code() == Some(4) && said.contains("`pull.csv` has changed since the sweep began"), "{said}");
    assert!(rdsolve(folder, &["sweep", "s.toml"]).status.success());
}

/// Nothing but results is left in the folders of a sweep, also where processes were killed.
#[test]
fn no_lock_is_left() {
    let folder = files(&SWEEP.replace("steps = 5", "steps = 60"));
    let folder = folder.path();
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    for wait in [20, 60] {
        let mut command = std::process::Command::new(&program);
        command.current_dir(folder).args(["sweep", "s.toml", "--jobs", "2"]).stdout(Stdio::null());
        let mut process = command.spawn().unwrap();
        std::thread::sleep(Duration::from_millis(wait));
        process.kill().unwrap();
        process.wait().unwrap();
    }
    assert!(rdsolve(folder, &["sweep", "s.toml"]).status.success());
    let within = |path: &Path| -> Vec<std::path::PathBuf> {
        fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let top = within(&folder.join("s.out"));
    let files = top.iter().filter(|path| path.is_dir()).flat_map(|path| within(path)).chain(top.iter().cloned());
    let left: Vec<_> = files.filter(|path| path.to_string_lossy().ends_with(".lock")).collect();
    assert!(left.is_empty(), "{left:?}");
}

/// Cases that fail are told with their reasons and leave the others alone; they can be run again by themselves.
#[test]
fn failures_are_listed_and_run_again() {
    let folder = files(&SWEEP.replace("[1.0, 2.0, 4.0]", "[1.0, -2.0]").replace("steps = 5", "steps = 2"));
    let folder = folder.path();
    let output = rdsolve(folder, &["sweep", "s.toml"]);
    assert_eq!(output.status.code(), Some(4));
    let said = text(&output.stderr);
    assert!(said.contains("cases 3, 4: ") && said.matches("`mass` must").count() == 1, "{said}");
    assert!(text(&output.stdout).contains("4 cases: 2 done, 2 failed"));
    let listed = text(&rdsolve(folder, &["sweep", "s.toml", "--list"]).stdout);
    assert_eq!(
        (listed.lines().count(), listed.matches(" done ").count(), listed.matches(" failed: ").count()),
        (4, 2, 2)
    );
    let summary = rows(folder, "s.out/summary.csv");
    assert_eq!((&summary[1][3][..], &summary[3][3][..], &summary[3][4][..]), ("done", "failed", ""));
    // Without a change they fail again; one case and one shard are what they say.
    assert_eq!(rdsolve(folder, &["sweep", "s.toml", "--case", "failed"]).status.code(), Some(4));
    assert!(rdsolve(folder, &["sweep", "s.toml", "--case", "1"]).status.success());
    assert_eq!(text(&rdsolve(folder, &["sweep", "s.toml", "--case", "2/2", "--list"]).stdout).lines().count(), 2);
    for (case, code) in [("0", 2), ("9", 2), ("3/2", 2), ("x", 2)] {
        assert_eq!(rdsolve(folder, &["sweep", "s.toml", "--case", case]).status.code(), Some(code), "{case}");
    }
    // Expected values that are missed are results all the same.
    let expects = "[[expect]]\nat = \"block\"\nquantity = \"z\"\npeak = \"min\"\nat_least = -0.12\n";
    fs::write(folder.join("deck.toml"), format!("{DECK}{expects}")).unwrap();
    fs::write(folder.join("s.toml"), SWEEP.replace("steps = 5", "steps = 1")).unwrap();
    let output = rdsolve(folder, &["sweep", "s.toml"]);
    assert_eq!(output.status.code(), Some(5), "{}", text(&output.stderr));
    assert!(rows(folder, "s.out/summary.csv")[1][4].parse::<f64>().is_ok());
}

/// Cases that succeed with warnings are counted. A warning that differs in its numbers alone is reported once with its cases, and each case
/// has its own in the summary, whether its folder is kept or not.
#[test]
fn warnings_of_cases_are_listed() {
    let sweep = "deck = \"deck.toml\"\n[vary]\n\"analysis.time_step\" = [0.001, 0.02, 0.03]\n";
    let folder = files(sweep);
    let folder = folder.path();
    let mut summaries = Vec::new();
    for (keep, out) in [("", "all"), ("keep = \"summary\"\n", "summary")] {
        fs::write(folder.join("s.toml"), format!("{keep}{sweep}")).unwrap();
        let output = rdsolve(folder, &["sweep", "s.toml", "-o", out]);
        let (said, told) = (text(&output.stderr), text(&output.stdout));
        assert!(output.status.success() && told.starts_with("3 cases: 3 done, warnings in 2; "), "{told}{said}");
        assert!(
            said.lines().count() == 1
                && said.starts_with("warning: cases 2, 3, with the numbers of case 2: numerical dissipation: "),
            "{said}"
        );
        assert!(text(&rdsolve(folder, &["sweep", "s.toml", "-o", out, "--quiet"]).stderr).is_empty());
        let summary = rows(folder, &format!("{out}/summary.csv"));
        let place = summary[0].iter().position(|column| column == "warnings").unwrap();
        assert_eq!(summary[1][place], "");
        assert!(summary[2][place].starts_with("numerical dissipation: ") && summary[2][place] != summary[3][place]);
        summaries.push(summary);
    }
    assert_eq!(summaries[0], summaries[1]);
}

/// Cases from a table and from samples.
#[test]
fn cases_come_from_tables_and_samples() {
    let table = "deck = \"deck.toml\"\n[vary]\ntable = \"cases.csv\"\n";
    let folder = files(table);
    let folder = folder.path();
    fs::write(
        folder.join("cases.csv"),
        "# two of them\nbodies.block.mass, integrator.scheme\n1.5, newmark\n2.5, bathe\n",
    )
    .unwrap();
    let output = rdsolve(folder, &["sweep", "s.toml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let cases = rows(folder, "s.out/cases.csv");
    let result = fs::read_to_string(folder.join("s.out").join(&cases[2][1]).join("result.json")).unwrap();
    assert!(result.contains("bodies.block.mass=2.5") && result.contains("integrator.scheme=bathe"));
    for kind in ["sobol", "latin-hypercube"] {
        let sample = format!(
            "deck = \"deck.toml\"\n[vary]\nsample = {{ kind = \"{kind}\", cases = 6, seed = 3 }}\n\"bodies.block.mass\" = {{ from = 1.0, to = 2.0 }}\n\
             \"integrator\" = [{{ scheme = \"newmark\" }}]\n\"links.rope.gap\" = {{ from = 0.0, to = 0.2 }}\n"
        );
        fs::write(folder.join("s.toml"), sample).unwrap();
        assert!(rdsolve(folder, &["sweep", "s.toml", "-o", kind]).status.success());
        let cases = rows(&folder.join(kind), "cases.csv");
        assert_eq!(cases.len(), 7);
        assert!(cases[1..].iter().all(|case| (1.0..2.0).contains(&case[2].parse::<f64>().unwrap())));
        // One value holds in all cases, and takes no dimension of the sample.
        assert!(
            cases[1..]
                .iter()
                .all(|case| case[3].contains("newmark") && (0.0..0.2).contains(&case[4].parse::<f64>().unwrap()))
        );
    }
}

/// The sweep that the documentation shows runs as it stands there.
#[test]
fn the_sweep_of_the_documentation_runs() {
    let page = fs::read_to_string("docs/sweeps.md").unwrap();
    let shown = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let folder = files(shown);
    let decks = folder.path().join("decks/tutorial");
    fs::create_dir_all(&decks).unwrap();
    fs::copy("decks/tutorial/mast.toml", decks.join("mast.toml")).unwrap();
    let output = rdsolve(folder.path(), &["sweep", "s.toml", "--case", "15"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = rows(folder.path(), "s.out/summary.csv");
    let columns: Vec<&str> = summary[0].iter().map(String::as_str).collect();
    assert_eq!(columns[5..8], ["sway", "end", "energy"]);
    assert!(summary[15][5..8].iter().all(|value| value.parse::<f64>().is_ok()), "{:?}", summary[15]);
}

/// What is wrong with the file of a sweep is said all at once, each with its place.
#[test]
fn bad_files_are_errors_with_their_places() {
    let folder = files("");
    let folder = folder.path();
    for (sweep, said) in [
        ("", &["`deck` is missing", "`[vary]` is missing"][..]),
        (
            "deck = 1\nvary = 2\ncolect = {}\n",
            &["`deck` must be the path", "`[vary]` must be a table", "did you mean `collect`?", "s.toml:3:1"],
        ),
        ("deck = \"deck.toml\"\n[vary]\n", &["nothing varies"]),
        ("deck = \"deck.toml\"\n[vary]\nbodies.block.mass = [1.0]\n", &["put the whole key into quotes"]),
        (
            "deck = \"deck.toml\"\n[vary]\n\"a\" = []\n\"b\" = 3\n\"c\" = { from = 1.0 }\n\"d\" = { from = 1.0, to = 2.0 }\n",
            &["`a` has no values", "`b` must be a list", "the range of `c` needs `from` and `to`", "`d` needs `steps`"],
        ),
        (
            "deck = \"deck.toml\"\n[vary]\n\"a\" = { from = 1, to = 2, steps = 0 }\n",
            &["`steps` must be a whole number from 1"],
        ),
        ("deck = \"deck.toml\"\n[vary]\ntable = \"x.csv\"\n\"a\" = [1]\n", &["remove the other entries"]),
        ("deck = \"deck.toml\"\n[vary]\ntable = \"x.csv\"\n", &["cannot read the table of cases `x.csv`"]),
        (
            "deck = \"deck.toml\"\n[vary]\nsample = { kind = \"grid\" }\n\"a\" = [1]\n",
            &["\"sobol\" or \"latin-hypercube\""],
        ),
        (
            "deck = \"deck.toml\"\n[vary]\nsample = { kind = \"sobol\", cases = 4 }\n\"a\" = [1, 2]\n",
            &["a sample needs ranges"],
        ),
        ("deck = \"deck.toml\"\n[vary]\nsample = { kind = \"sobol\", cases = 4 }\n\"a\" = [1]\n", &["nothing varies"]),
        (
            "deck = \"deck.toml\"\nsample = { kind = \"sobol\", cases = 4 }\n[vary]\n\"a\" = { from = 1, to = 2 }\n",
            &["`sample` stands below `[vary]`", "s.toml:2:1"],
        ),
        (
            "deck = \"deck.toml\"\n[vary]\n\"a\" = [1]\n[collect]\nx = { at = \"b\", peak = \"top\" }\ny = 1\ncase = { at = \"b\", quantity = \"z\", time = 1 }\n",
            &["`peak` can be", "`y` must be a table", "`case` is a column of the summary already"],
        ),
        (
            "deck = \"deck.toml\"\n[vary]\n\"a\" = [1]\n[collect]\nx = { at = \"b\" }\n",
            &["`x` needs `at`, `quantity` and `peak` or `time`"],
        ),
    ] {
        fs::write(folder.join("s.toml"), sweep).unwrap();
        let output = rdsolve(folder, &["sweep", "s.toml"]);
        let found = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{sweep}: {found}");
        said.iter().for_each(|said| assert!(found.contains(said), "{sweep}: {found}"));
    }
    fs::write(folder.join("s.toml"), SWEEP.replace("deck.toml", "none.toml")).unwrap();
    assert_eq!(rdsolve(folder, &["sweep", "s.toml"]).status.code(), Some(6));
    assert_eq!(rdsolve(folder, &["sweep", "none.toml"]).status.code(), Some(6));
}

/// Slips of names end the sweep before its first case, with the nearest name; nothing is written.
#[test]
fn names_are_checked_before_the_first_case() {
    let folder = files("");
    let folder = folder.path();
    for (from, to, said) in [
        (
            "links.rope.stiffness",
            "links.ropes.stiffness",
            &["`links` has no item named `ropes`", "did you mean `rope`?", "--set"][..],
        ),
        (r#""bodies.block.mass""#, r#""bodies.block.mas""#, &["`mas`", "mass"]),
        (
            r#"quantity = "vz""#,
            r#"quantity = "vzz""#,
            &["no table has a column `vzz`", "did you mean `vz`?", "s.toml:9:"],
        ),
        (
            r#"at = "block", quantity = "vz""#,
            r#"at = "blok", quantity = "vz""#,
            &["`half` of [collect]", "did you mean `block`?"],
        ),
        (r#"quantity = "vz""#, r#"quantity = "vz", stage = "fall""#, &["no stage `fall`", "remove `stage`"]),
    ] {
        assert!(SWEEP.contains(from), "{from}");
        fs::write(folder.join("s.toml"), SWEEP.replace(from, to)).unwrap();
        let output = rdsolve(folder, &["sweep", "s.toml"]);
        let found = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{to}: {found}");
        said.iter().for_each(|said| assert!(found.contains(said), "{to}: {found}"));
        assert!(!folder.join("s.out").exists(), "{to}");
    }
}

/// Without folders a case that a signal stops leaves a checkpoint alone, goes on from there, and has the numbers of an undisturbed run. The rows
/// before the checkpoint have some of them, and those after it the others.
#[test]
#[cfg(unix)]
fn a_stopped_case_without_files_goes_on() {
    let collect = "[collect]\nearly = { at = \"block\", quantity = \"z\", time = 1.0 }\n\
                   end = { at = \"block\", quantity = \"vz\", time = \"end\" }\n\
                   kinetic = { at = \"energy\", quantity = \"kinetic\", peak = \"max\" }\n";
    let sweep = format!("keep = \"summary\"\ndeck = \"deck.toml\"\n[vary]\n\"bodies.block.mass\" = [1.0]\n{collect}");
    let folder = files(&sweep);
    let folder = folder.path();
    let long = DECK
        .replace("end_time = 1.0", "end_time = 400.0")
        .replace("[output]", "[output]\ncheckpoint = 0.001\nevery = 500");
    fs::write(folder.join("deck.toml"), long).unwrap();
    fs::write(folder.join("all.toml"), sweep.replace("keep = \"summary\"\n", "")).unwrap();
    assert!(rdsolve(folder, &["sweep", "all.toml", "-o", "all"]).status.success());
    let case = folder.join("stopped").join(&rows(folder, "all/cases.csv")[1][1]);
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
    command.current_dir(folder).args(["sweep", "s.toml", "-o", "stopped"]).stdout(Stdio::null());
    let mut process = command.stderr(Stdio::piped()).spawn().unwrap();
    while !case.join("run.checkpoint").exists() {
        assert!(process.try_wait().unwrap().is_none(), "it came to its end before it was stopped");
        std::thread::sleep(Duration::from_millis(1));
    }
    std::process::Command::new("kill").args(["-TERM", &process.id().to_string()]).status().unwrap();
    assert_eq!(process.wait_with_output().unwrap().status.code(), Some(75));
    let names: Vec<_> = fs::read_dir(&case).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["run.checkpoint"]);
    assert_eq!(rows(folder, "stopped/summary.csv")[1][2], "pending");
    assert!(rdsolve(folder, &["sweep", "s.toml", "-o", "stopped"]).status.success());
    let summary = |out: &str| fs::read_to_string(folder.join(out).join("summary.csv")).unwrap();
    assert_eq!(summary("all"), summary("stopped"));
    assert!(!case.exists());
}

/// The summary is the same whatever is kept, whoever runs the cases and however often; folders that are not kept leave one file a process.
#[test]
fn cases_that_are_not_kept_stand_in_the_summary() {
    let varied = SWEEP.replace("[1.0, 2.0, 4.0]", "[1.0, -1.0]");
    let folder = files(&varied);
    let at = folder.path();
    let keeping = |word: &str| varied.replacen("[vary]", &format!("keep = \"{word}\"\n[vary]"), 1);
    for word in ["failed", "summary"] {
        fs::write(at.join(format!("{word}.toml")), keeping(word)).unwrap();
    }
    assert_eq!(rdsolve(at, &["sweep", "s.toml", "--quiet"]).status.code(), Some(4));
    let summary = |name: &str| fs::read_to_string(at.join(format!("{name}.out/summary.csv"))).unwrap();
    let folders = |name: &str| {
        let entries = fs::read_dir(at.join(format!("{name}.out"))).unwrap().map(|entry| entry.unwrap());
        entries.filter(|entry| entry.file_type().unwrap().is_dir() && entry.file_name() != "records").count()
    };
    let lines = |name: &str| {
        let entries = fs::read_dir(at.join(format!("{name}.out/records"))).unwrap();
        entries.map(|entry| fs::read_to_string(entry.unwrap().path()).unwrap().lines().count()).sum::<usize>()
    };
    // Three processes at once, then once more: nothing is left to run but what failed.
    for (word, kept, recorded) in [("failed", 5, 5), ("summary", 0, 10)] {
        let command = || {
            let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("rdsolve"));
            command.current_dir(at).args(["sweep", &format!("{word}.toml"), "--quiet", "--jobs", "1"]);
            command.stderr(Stdio::null()).spawn().unwrap()
        };
        let codes: Vec<_> = [(); 3].map(|()| command()).into_iter().map(|mut run| run.wait().unwrap().code()).collect();
        assert_eq!(codes, [Some(4); 3]);
        assert_eq!(rdsolve(at, &["sweep", &format!("{word}.toml"), "--quiet"]).status.code(), Some(4));
        assert_eq!(summary(word), summary("s"), "{word}");
        assert_eq!((folders(word), lines(word)), (kept, recorded), "{word}");
    }
    // Failures are run again when they are asked for, and another list of numbers has all cases run again.
    rdsolve(at, &["sweep", "summary.toml", "--case", "failed", "--quiet"]);
    assert_eq!((summary("summary"), lines("summary")), (summary("s"), 15));
    fs::write(at.join("summary.toml"), keeping("summary").replace("half =", "middle =")).unwrap();
    rdsolve(at, &["sweep", "summary.toml", "--quiet"]);
    assert_eq!((summary("summary"), lines("summary")), (summary("s").replace("half", "middle"), 25));
}

/// Peaks between rows are collected too, whatever is kept; another list of numbers has only the rows of the tables.
#[test]
fn peaks_between_rows_are_collected() {
    let collect = "energy = { at = \"energy\", quantity = \"kinetic\", peak = \"max\" }\npull = { at = \"rope\", quantity = \"force\", peak = \"abs\" }\n";
    let sweep = |deck: &str, keep: &str| {
        format!(
            "deck = \"{deck}\"\nkeep = \"{keep}\"\n[vary]\n\"bodies.block.mass\" = [1.0, 4.0]\n[collect]\n{collect}"
        )
    };
    let folder = files("");
    let at = folder.path();
    for (deck, every) in [("fine.toml", 1), ("thin.toml", 20)] {
        fs::write(at.join(deck), format!("{DECK}every = {every}\n")).unwrap();
    }
    let summary = |name: &str, deck: &str, keep: &str| {
        fs::write(at.join(format!("{name}.toml")), sweep(deck, keep)).unwrap();
        assert_eq!(rdsolve(at, &["sweep", &format!("{name}.toml"), "--quiet"]).status.code(), Some(0));
        fs::read_to_string(at.join(format!("{name}.out/summary.csv"))).unwrap()
    };
    let fine = summary("every", "fine.toml", "all");
    for keep in ["all", "failed", "summary"] {
        assert_eq!(summary(keep, "thin.toml", keep), fine, "{keep}");
    }
    // The column may have another name, and comes from the run; another peak comes from the rows.
    fs::write(at.join("all.toml"), sweep("thin.toml", "all").replace("pull =", "tension =")).unwrap();
    assert!(rdsolve(at, &["sweep", "all.toml", "--collect", "--quiet"]).status.success());
    assert_eq!(fs::read_to_string(at.join("all.out/summary.csv")).unwrap(), fine.replace("pull", "tension"));
    fs::write(at.join("all.toml"), sweep("thin.toml", "all").replace("\"abs\"", "\"max\"")).unwrap();
    assert!(rdsolve(at, &["sweep", "all.toml", "--collect", "--quiet"]).status.success());
    assert_ne!(fs::read_to_string(at.join("all.out/summary.csv")).unwrap(), fine);
}

#[test]
fn a_table_of_cases_is_a_regular_file() {
    let folder = files("deck = \"deck.toml\"\n[vary]\ntable = \"/dev/zero\"\n");
    let refused = rdsolve(folder.path(), &["sweep", "s.toml"]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(text(&refused.stderr).contains("a device or a pipe"), "{}", text(&refused.stderr));
}

/// Modes by their number, reactions of supports by their component, and a column that nothing fills, of which a warning tells.
#[test]
fn modes_and_reactions_are_collected() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = r#"
[[stages]]
name = "pull"
kind = "static"
duration = 1.0
time_step = 1.0
[[stages]]
name = "modes"
kind = "modal"
modes = 1
[points]
wall = [0.0, 0.0, 0.0]
mass = [1.0, 0.0, 0.0]
[[masses]]
at = "mass"
mass = 4.0
[[links]]
name = "spring"
from = { node = "wall" }
to = { node = "mass" }
stiffness = 100.0
[[supports]]
at = "wall"
fix = "translations"
[[supports]]
at = "mass"
fix = ["uy", "uz"]
[[loads]]
at = "mass"
force = [10.0, 0.0, 0.0]
[output]
reactions = true
"#;
    let sweep = "deck = \"deck.toml\"\n[vary]\n\"masses.0.mass\" = [1.0, 4.0]\n[collect]\nf = { mode = 1, quantity = \"frequency\" }\n\
                 base = { at = \"wall\", quantity = \"fx\", peak = \"abs\" }\nnone = { at = \"wall\", quantity = \"kinetic\", peak = \"max\" }\n";
    fs::write(folder.join("deck.toml"), deck).unwrap();
    fs::write(folder.join("s.toml"), sweep).unwrap();
    let done = rdsolve(folder, &["sweep", "s.toml"]);
    let said = text(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    assert!(said.contains("`none` is empty") && !said.contains("`base` is empty"), "{said}");
    let found = rows(folder, "s.out/summary.csv");
    for (row, mass) in found[1..].iter().zip([1.0f64, 4.0]) {
        let [f, base]: [f64; 2] = [row[3].parse().unwrap(), row[4].parse().unwrap()];
        let exact = (100.0 / mass).sqrt() / std::f64::consts::TAU;
        assert!((f - exact).abs() < 1e-9 * exact && (base + 10.0).abs() < 1e-9, "{row:?}");
        assert_eq!(row[5], "");
    }
}

/// The reaction of a set, a group or an edge is the sum over its nodes: of two feet it is the load on the frame. Moments about two feet have no sum.
#[test]
fn reactions_of_a_set_are_summed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = r#"
analysis = { kind = "static", end_time = 1.0, time_step = 0.5 }
points = { a = [0.0, 0.0, 0.0], b = [0.0, 0.0, 1.0], c = [2.0, 0.0, 1.0], d = [2.0, 0.0, 0.0] }
materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3 }
sections.bar = { shape = "rectangle", width = 0.05, height = 0.05 }
sets = { feet = ["a", "d"], foot = ["a"] }
supports = [{ at = "feet", fix = "all" }, { at = "foot", fix = "all" }]
loads = [{ at = "b", force = [1000.0, 0.0, -500.0] }, { at = "c", force = [0.0, 0.0, -700.0] }]
output = { reactions = true }
[[beams]]
name = "frame"
path = ["a", "b", "c", "d"]
elements = 1
material = "steel"
section = "bar"
orientation = [0.0, 1.0, 0.0]
"#;
    let sweep = "deck = \"deck.toml\"\n[vary]\n\"loads.0.force\" = [[1000.0, 0.0, -500.0], [200.0, 0.0, -500.0]]\n[collect]\n\
                 end = { at = \"feet\", quantity = \"fx\", time = \"end\" }\nhalf = { at = \"feet\", quantity = \"fz\", time = 0.5 }\n\
                 peak = { at = \"feet\", quantity = \"fz\", peak = \"max\" }\nfoot = { at = \"foot\", quantity = \"my\", time = \"end\" }\n\
                 one = { at = \"a\", quantity = \"my\", time = \"end\" }\nmoment = { at = \"feet\", quantity = \"my\", time = \"end\" }\n";
    fs::write(folder.join("deck.toml"), deck).unwrap();
    fs::write(folder.join("s.toml"), sweep).unwrap();
    let done = rdsolve(folder, &["sweep", "s.toml"]);
    let said = text(&done.stderr);
    assert!(
        done.status.success() && said.contains("`moment` is empty") && said.contains("moments have no sum"),
        "{said}"
    );
    let found = rows(folder, "s.out/summary.csv");
    for (row, push) in found[1..].iter().zip([1000.0, 200.0]) {
        let value = |name: &str| row[found[0].iter().position(|column| column == name).unwrap()].clone();
        // Equilibrium, to the tolerance of the iteration.
        let exact = [("end", -push), ("half", 600.0), ("peak", 1200.0)];
        assert!(
            exact.iter().all(|(name, f)| (value(name).parse::<f64>().unwrap() - f).abs() < 1e-5 * 1200.0),
            "{row:?}"
        );
        assert!(value("foot") == value("one") && !value("one").is_empty() && value("moment").is_empty(), "{row:?}");
    }
    fs::write(folder.join("t.toml"), format!("keep = \"summary\"\n{sweep}")).unwrap();
    assert!(rdsolve(folder, &["sweep", "t.toml"]).status.success());
    assert_eq!(rows(folder, "t.out/summary.csv"), found);
    // A curve takes the name of the set as well.
    let case = rows(folder, "s.out/cases.csv")[1][1].clone();
    let curve =
        ["summary", &format!("s.out/{case}"), "--format", "csv", "--curve", "nodes.csv:b:ux", "-reactions.csv:feet:fx"];
    let curve = text(&rdsolve(folder, &curve).stdout);
    let last: f64 = curve.lines().last().unwrap().rsplit(',').next().unwrap().parse().unwrap();
    assert!((last - 1000.0).abs() < 1e-2, "{curve}");
}
