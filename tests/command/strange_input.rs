//! Arguments, names and files that no engineer writes on purpose: each ends at once, with its code and a reason.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::time::Duration;

const DECK: &str = "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = 0.01\n[[bodies]]\nname = \"ball\"\ncenter = [0.0, 0.0, 0.0]\n\
                    mass = 1.0\ninertia = [1.0, 1.0, 1.0]\n";

fn folder(deck: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.toml"), deck).unwrap();
    folder
}

fn rdsolve(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    command.current_dir(folder).args(arguments).timeout(Duration::from_secs(60)).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[cfg(unix)]
#[test]
fn an_argument_need_not_be_text() {
    use std::os::unix::ffi::OsStrExt;
    let name = std::ffi::OsStr::from_bytes(b"m\xff.toml");
    let folder = folder(DECK);
    let run = || Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).arg(name).output().unwrap();
    assert_eq!(run().status.code(), Some(6), "{}", said(&run()));
    fs::copy(folder.path().join("deck.toml"), folder.path().join(name)).unwrap();
    assert_eq!(run().status.code(), Some(0), "{}", said(&run()));
}

/// A pipe that nobody fills would hold whoever reads it.
#[cfg(unix)]
#[test]
fn pipes_among_results_are_no_results() {
    let folder = folder(DECK);
    assert_eq!(rdsolve(folder.path(), &["deck.toml", "--quiet"]).status.code(), Some(0));
    for name in ["result.json", "run.log", "run.checkpoint", "run.list"] {
        let out = folder.path().join("deck.out");
        let _ = fs::remove_file(out.join("result.json"));
        let _ = fs::remove_file(out.join(name));
        let made = std::process::Command::new("mkfifo").arg(out.join(name)).status().unwrap();
        assert!(made.success());
        let resumed = rdsolve(folder.path(), &["deck.toml", "--resume", "--quiet"]);
        assert!(resumed.status.code().is_some(), "{name}: {}", said(&resumed));
        let report = rdsolve(folder.path(), &["summary", "deck.out"]);
        assert!(report.status.code().is_some(), "{name}: {}", said(&report));
        fs::remove_file(out.join(name)).unwrap();
    }
}

/// Each override costs as much as the one before: thousands of them took gigabytes.
#[test]
fn many_overrides_are_read_at_once() {
    let folder = folder(DECK);
    let sets: Vec<String> = (1..=3000).map(|mass| format!("bodies.ball.mass={mass}.0")).collect();
    let mut arguments = vec!["check", "deck.toml"];
    arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
    let checked = rdsolve(folder.path(), &arguments);
    assert_eq!(checked.status.code(), Some(0), "{}", said(&checked));
    // Places are those within the argument.
    arguments.extend(["--set", "bodies.ball.velocity=[1.0, x, 0.0]"]);
    let refused = said(&rdsolve(folder.path(), &arguments));
    assert!(refused.contains("--set:1:28"), "{refused}");
}

#[test]
fn errors_beyond_those_shown_are_counted() {
    let wrong: String = (0..120).map(|key| format!("key{key} = 1\n")).collect();
    let told = said(&rdsolve(folder(&format!("{wrong}{DECK}")).path(), &["check", "deck.toml"]));
    assert!(told.contains("… and 70 more errors") && told.contains("has 120 errors"), "{told}");
    let wrong: String = (0..300).map(|key| format!("key{key} = 1\n")).collect();
    let told = said(&rdsolve(folder(&format!("{wrong}{DECK}")).path(), &["check", "deck.toml"]));
    assert!(told.contains("stopped reading after 200 errors") && told.contains("has 200 errors"), "{told}");
}

#[test]
fn names_are_equal_however_their_accents_are_coded() {
    let deck =
        format!("{DECK}[[supports]]\nat = \"balle\u{301}\"\nfix = [\"uz\"]\n").replace("\"ball\"", "\"ball\u{e9}\"");
    let folder = folder(&deck);
    let run = rdsolve(folder.path(), &["deck.toml", "--set", "bodies.balle\u{301}.mass=2.0"]);
    assert_eq!(run.status.code(), Some(3), "a bare key has no accents: {}", said(&run));
    let run = rdsolve(folder.path(), &["deck.toml", "--set", "bodies.\"balle\u{301}\".mass=2.0"]);
    assert_eq!(run.status.code(), Some(0), "{}", said(&run));
}

#[test]
fn names_that_other_programs_obey_are_told() {
    let refused = rdsolve(folder(&DECK.replace("\"ball\"", "\"b\\u001b[31m\"")).path(), &["check", "deck.toml"]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(said(&refused).contains("control character"), "{}", said(&refused));
    for name in ["=1+1", "@x", "-left"] {
        let warned = rdsolve(folder(&DECK.replace("\"ball\"", &format!("\"{name}\""))).path(), &["check", "deck.toml"]);
        assert_eq!(warned.status.code(), Some(0));
        assert!(said(&warned).contains("for a formula"), "{}", said(&warned));
    }
}

/// Where memory is limited, the program ends with a code of its own, at whatever point that is.
#[cfg(target_os = "linux")]
#[test]
fn want_of_memory_has_a_code() {
    let plate = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 2e11\n\
                 poisson_ratio = 0.3\ndensity = 7850.0\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\n\
                 d = [0.0, 1.0, 0.0]\n[[shells]]\nname = \"p\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = 80\nthickness = 0.01\n\
                 material = \"m\"\n[[supports]]\nat = \"p.edge1\"\nfix = \"all\"\n[environment]\ngravity = [0.0, 0.0, -9.81]\n";
    let folder = folder(plate);
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    for megabytes in [100, 150, 200] {
        let line = format!("ulimit -v {}; exec \"$0\" deck.toml --overwrite --quiet --threads 1", megabytes * 1000);
        let limited =
            std::process::Command::new("sh").current_dir(folder.path()).args(["-c", &line]).arg(&program).output();
        let limited = limited.unwrap();
        assert_eq!(limited.status.code(), Some(7), "{megabytes} MB: {}", said(&limited));
    }
}
