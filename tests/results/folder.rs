//! Output folders: one run at a time, results that belong together, and nothing taken away that no run has written.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A ball in free flight, which is a step of a microsecond or so.
fn ball(end_time: f64, more: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time:?}\ntime_step = 1e-3\n[[bodies]]\nname = \"ball\"\n\
         center = [0.0, 0.0, 0.0]\nmass = 1.0\nvelocity = [1.0, 0.0, 0.0]\nshape = {{ kind = \"sphere\", radius = 0.1 }}\n\
         [output]\nevery = 1\n{more}"
    )
}

struct Desk {
    dir: TempDir,
}

impl Desk {
    /// A folder with a deck that is done at once, `x.toml`, and one that goes on for hours, `long.toml`.
    fn new() -> Desk {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("x.toml"), ball(0.01, "")).unwrap();
        fs::write(dir.path().join("long.toml"), ball(1e6, "")).unwrap();
        Desk { dir }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
        command.current_dir(self.dir.path()).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Exit code and standard error.
    fn run(&self, arguments: &[&str]) -> (i32, String) {
        ended(self.command(arguments).output().unwrap())
    }

    /// A run that is writing rows into `out`.
    fn begin(&self) -> Child {
        let child = self.command(&["long.toml", "-o", "out", "--overwrite"]).spawn().unwrap();
        let began = Instant::now();
        let lock = format!("process {}\n", child.id());
        let has_lock = || fs::read_to_string(self.at("out/run.lock")).is_ok_and(|text| text.contains(&lock));
        let rows = || fs::metadata(self.at("out/bodies.csv")).map_or(0, |file| file.len());
        while !has_lock() || self.at("out/result.json").exists() || rows() < 1000 {
            assert!(began.elapsed() < Duration::from_secs(20), "no rows");
            std::thread::sleep(Duration::from_millis(5));
        }
        child
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.at(folder)).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn ended(output: Output) -> (i32, String) {
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap().success());
}

const DONE: [&str; 6] = ["bodies.csv", "energy.csv", "result.json", "run.list", "run.log", "steps.csv"];

#[test]
#[cfg(unix)]
fn a_folder_is_one_runs_at_a_time() {
    let desk = Desk::new();
    let first = desk.begin();
    let (code, said) = desk.run(&["x.toml", "-o", "out", "--overwrite"]);
    assert!(
        code == 6 && said.contains(&format!("another run writes there: process {} on ", first.id())),
        "{code} {said}"
    );
    assert!(said.contains("begun 2") && said.contains("-o"), "{said}");
    let (code, said) = desk.run(&["study", "x.toml", "-o", "out", "--overwrite", "--time-steps", "1e-3"]);
    assert!(code == 6 && said.contains("another run writes there"), "{code} {said}");
    signal(&first, "TERM");
    assert_eq!(ended(first.wait_with_output().unwrap()).0, 75);
    let mut left = desk.names("out");
    left.retain(|name| name != "run.checkpoint");
    assert_eq!(left, DONE, "the lock is gone");
    assert!(desk.at("out/run.checkpoint").exists());
    // One that is killed leaves its lock, which binds nobody.
    let killed = desk.begin();
    signal(&killed, "KILL");
    killed.wait_with_output().unwrap();
    assert!(desk.at("out/run.lock").exists() && !desk.at("out/result.json").exists());
    let (code, said) = desk.run(&["x.toml", "-o", "out", "--overwrite"]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(desk.names("out"), DONE);
}

/// Twelve at once into one folder: one of them writes it all, the others say why they do not.
#[test]
fn of_many_at_once_the_tables_are_those_of_one() {
    let desk = Desk::new();
    let children: Vec<(usize, Child)> = (1..=12)
        .map(|mass| {
            let set = format!("bodies.ball.mass={mass}");
            (
                mass,
                desk.command(&["x.toml", "-o", "out", "--overwrite", "--set", &set, "--set", "analysis.end_time=0.5"])
                    .spawn()
                    .unwrap(),
            )
        })
        .collect();
    let ends: Vec<(usize, i32, String)> = children
        .into_iter()
        .map(|(mass, child)| {
            let (code, said) = ended(child.wait_with_output().unwrap());
            (mass, code, said)
        })
        .collect();
    assert!(ends.iter().any(|end| end.1 == 0) && ends.iter().all(|end| matches!(end.1, 0 | 6)), "{ends:?}");
    assert_eq!(desk.names("out"), DONE);
    let result: serde_json::Value = serde_json::from_slice(&fs::read(desk.at("out/result.json")).unwrap()).unwrap();
    let mass: f64 = result["sets"][0].as_str().unwrap().rsplit('=').next().unwrap().parse().unwrap();
    let energy = fs::read_to_string(desk.at("out/energy.csv")).unwrap();
    assert_eq!(energy.lines().count(), 502);
    // A speed of one: half the mass, in each row.
    for row in energy.lines().skip(1) {
        let kinetic: f64 = row.split(',').nth(2).unwrap().parse().unwrap();
        assert!((kinetic - 0.5 * mass).abs() < 1e-12 * mass, "{row}");
    }
}

#[test]
#[cfg(unix)]
fn a_run_whose_tables_go_says_so() {
    type Spoil<'s> = (&'s str, &'s dyn Fn(&Path));
    let spoil: [Spoil; 4] = [
        ("bodies.csv", &|out| fs::remove_file(out.join("bodies.csv")).unwrap()),
        ("energy.csv", &|out| fs::write(out.join("energy.csv"), "mine\n").unwrap()),
        ("steps.csv", &|out| fs::rename(out.join("bodies.csv"), out.join("steps.csv")).unwrap()),
        ("", &|out| fs::rename(out, out.with_file_name("elsewhere")).unwrap()),
    ];
    for (name, spoil) in spoil {
        let desk = Desk::new();
        let child = desk.begin();
        spoil(&desk.at("out"));
        let (code, said) = ended(child.wait_with_output().unwrap());
        assert!(code == 6 && said.contains("taken away, replaced or changed"), "{code} {said}");
        assert!(said.contains(name) || name == "steps.csv", "{said}");
        assert!(!desk.at("out/result.json").exists() && !desk.at("elsewhere/result.json").exists());
    }
}

#[test]
fn only_what_a_run_has_listed_is_taken_away() {
    let desk = Desk::new();
    fs::write(desk.at("fields.toml"), ball(0.01, "fields = { format = \"vtu\", every = 5 }\n")).unwrap();
    assert_eq!(desk.run(&["fields.toml", "-o", "out"]).0, 0);
    assert!(desk.names("out").contains(&"fields_000005.vtu".into()));
    // Somebody's, by names like ours.
    let mine = ["nodes.csv", "links.csv", "my_nodes.csv", "fields_mine.vtu", "fields_000007.vtu", "run.log.old"];
    mine.iter().for_each(|name| fs::write(desk.at("out").join(name), "mine").unwrap());
    assert_eq!(desk.run(&["x.toml", "-o", "out", "--overwrite"]).0, 0);
    let mut all: Vec<&str> = mine.iter().chain(&DONE).copied().collect();
    all.sort();
    assert_eq!(desk.names("out"), all);
    assert!(mine.iter().all(|name| fs::read_to_string(desk.at("out").join(name)).unwrap() == "mine"));
    // In the way of what is to be written: nothing goes.
    let (code, said) = desk.run(&["fields.toml", "-o", "out", "--overwrite"]);
    assert!(code == 6 && said.contains("fields_000007.vtu` was not written by a run"), "{code} {said}");
    assert_eq!(desk.names("out"), all);
    // A folder that no run has written: its files are all somebody's, a deck of the name of a table too.
    fs::create_dir(desk.at("data")).unwrap();
    for name in ["energy.csv", "result.json", "run.log", "run.list", "bodies.csv"] {
        let file = desk.at("data").join(name);
        fs::write(&file, ball(0.01, "")).unwrap();
        let (code, said) = desk.run(&["x.toml", "-o", "data", "--overwrite"]);
        assert!(code == 6 && said.contains(name) && said.contains("was not written by a run"), "{code} {said}");
        let (code, said) = desk.run(&[&format!("data/{name}"), "-o", "data", "--overwrite"]);
        assert!(code == 6 && said.contains(name), "{code} {said}");
        assert_eq!(fs::read_to_string(&file).unwrap(), ball(0.01, ""));
        fs::remove_file(file).unwrap();
    }
    // Lists lead nowhere else, and a deck that one names stays.
    fs::write(desk.at("precious"), "mine").unwrap();
    let head = "# written by this run; --overwrite takes it away\n";
    fs::write(desk.at("data/run.list"), format!("{head}../precious\nbodies.csv\n..\n\n/etc/passwd\n")).unwrap();
    fs::write(desk.at("data/bodies.csv"), ball(0.01, "")).unwrap();
    let (code, said) = desk.run(&["data/bodies.csv", "-o", "data", "--overwrite"]);
    assert!(code == 6 && said.contains("bodies.csv: this run reads it"), "{code} {said}");
    assert_eq!(desk.run(&["x.toml", "-o", "data", "--overwrite"]).0, 0);
    assert_eq!(fs::read_to_string(desk.at("precious")).unwrap(), "mine");
}

#[test]
#[cfg(unix)]
fn links_are_never_followed() {
    use std::os::unix::fs::symlink;
    let desk = Desk::new();
    assert_eq!(desk.run(&["x.toml", "-o", "out"]).0, 0);
    // Put where a run has written: the links go, what they lead to stays.
    for (number, name) in DONE.iter().enumerate().filter(|(_, name)| **name != "run.list") {
        let target = desk.at(&format!("mine_{number}"));
        fs::write(&target, "kept").unwrap();
        fs::remove_file(desk.at("out").join(name)).unwrap();
        symlink(&target, desk.at("out").join(name)).unwrap();
    }
    for (name, target) in [("result.json.tmp", "mine_0"), ("run.lock", "mine_1")] {
        symlink(desk.at(target), desk.at("out").join(name)).unwrap();
    }
    assert_eq!(desk.run(&["x.toml", "-o", "out", "--overwrite"]).0, 0);
    assert_eq!(desk.names("out"), DONE);
    assert!(DONE.iter().all(|name| !desk.at("out").join(name).is_symlink()));
    for number in [0, 1, 2, 4, 5] {
        assert_eq!(fs::read_to_string(desk.at(&format!("mine_{number}"))).unwrap(), "kept");
    }
    // A list that is a link, and a link that no list names.
    fs::rename(desk.at("out/run.list"), desk.at("list")).unwrap();
    symlink(desk.at("list"), desk.at("out/run.list")).unwrap();
    let (code, said) = desk.run(&["x.toml", "-o", "out", "--overwrite"]);
    assert!(code == 6 && said.contains("run.list` was not written by a run"), "{code} {said}");
    fs::create_dir(desk.at("new")).unwrap();
    symlink("/dev/full", desk.at("new/energy.csv")).unwrap();
    let (code, said) = desk.run(&["x.toml", "-o", "new", "--overwrite"]);
    assert!(code == 6 && said.contains("energy.csv` was not written by a run"), "{code} {said}");
}

/// True once a process catches a signal.
#[cfg(target_os = "linux")]
fn catches(child: &Child, number: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).map(str::trim);
    mask.and_then(|mask| u64::from_str_radix(mask, 16).ok()).is_some_and(|mask| mask >> (number - 1) & 1 == 1)
}

/// While a deck is read and planned there is nothing to bring to an end: signals, that of `ulimit -t` among them, end the program at once,
/// with a word and the exit code of a run that is stopped. A pipe into which nobody writes is read for as long as one likes.
#[test]
#[cfg(target_os = "linux")]
fn signals_before_the_first_step_end_the_run_with_a_word() {
    let desk = Desk::new();
    assert!(Command::new("mkfifo").arg(desk.at("pipe.toml")).status().unwrap().success());
    for command in ["run", "check", "study"] {
        for (name, number) in [("INT", 2), ("TERM", 15), ("XCPU", 24)] {
            let mut started = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
            started
                .current_dir(desk.dir.path())
                .args([command, "pipe.toml"])
                .stdout(Stdio::null())
                .stderr(Stdio::piped());
            let mut child = started.spawn().unwrap();
            while !catches(&child, number) {
                assert!(child.try_wait().unwrap().is_none(), "{command} has ended by itself");
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
            signal(&child, name);
            let (code, said) = ended(child.wait_with_output().unwrap());
            assert!(code == 75 && said.contains("stopped by a signal before the first step"), "{name}: {code} {said}");
        }
    }
    assert!(!desk.names(".").iter().any(|name| name.contains("out") || name.contains("study")));
}

/// A limit of the shell on the size of files, as of a disk that is full: whole rows, and exit code 6.
#[test]
#[cfg(unix)]
fn a_file_that_cannot_grow_ends_the_run_with_whole_rows() {
    let desk = Desk::new();
    // Blocks of 512 bytes: 33 of them end within a row.
    let script = "ulimit -f 33 && exec \"$0\" long.toml -o out";
    let mut command = Command::new("sh");
    command.current_dir(desk.dir.path()).args(["-c", script, env!("CARGO_BIN_EXE_rdsolve")]).stderr(Stdio::piped());
    let (code, said) = ended(command.output().unwrap());
    assert!(code == 6 && said.contains("cannot write results: out/") && said.contains("ulimit -f"), "{code} {said}");
    assert!(!desk.at("out/result.json").exists() && !desk.at("out/run.lock").exists());
    for name in ["bodies.csv", "energy.csv", "steps.csv"] {
        assert!(fs::read_to_string(desk.at("out").join(name)).unwrap().ends_with('\n'), "{name}");
    }
    let long = fs::metadata(desk.at("out/bodies.csv"))
        .unwrap()
        .len()
        .max(fs::metadata(desk.at("out/steps.csv")).unwrap().len());
    assert!(long > 10_000, "{long}");
    // The page of a report, and a limit that not even the log fits in.
    let script = "ulimit -f 8 && exec \"$0\" report out";
    let mut command = Command::new("sh");
    command.current_dir(desk.dir.path()).args(["-c", script, env!("CARGO_BIN_EXE_rdsolve")]).stderr(Stdio::piped());
    let (code, said) = ended(command.output().unwrap());
    assert!(code == 6 && said.contains("cannot write `out.html`"), "{code} {said}");
    let script = "ulimit -f 0 && exec \"$0\" x.toml -o none";
    let mut command = Command::new("sh");
    command.current_dir(desk.dir.path()).args(["-c", script, env!("CARGO_BIN_EXE_rdsolve")]).stderr(Stdio::piped());
    assert_eq!(ended(command.output().unwrap()).0, 6);
}
