//! A folder with programs for several levels of instructions: which of them runs. The others are scripts that say how they were started.

#![cfg(all(unix, target_arch = "x86_64"))]

use std::fs;
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const VARIABLE: &str = "RDSOLVE_INSTRUCTIONS";
/// Says its name, its arguments, the level and what stands on standard input.
const SCRIPT: &str = "#!/bin/sh\nprintf '%s|' \"$@\" \"$RDSOLVE_INSTRUCTIONS\"\ncat\nexit 42\n";

/// Puts the program of these tests into a folder under some name.
fn place(folder: &Path, name: &str) {
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    // It is large, and a link has a path of its own; another file system needs a copy.
    if fs::hard_link(&program, folder.join(name)).is_err() {
        fs::copy(&program, folder.join(name)).unwrap();
    }
}

fn script(folder: &Path, name: &str, mode: u32) {
    fs::write(folder.join(name), SCRIPT).unwrap();
    fs::set_permissions(folder.join(name), fs::Permissions::from_mode(mode)).unwrap();
}

fn run(program: &Path, arguments: &[&str], variable: Option<&str>) -> Output {
    let mut command = Command::new(program);
    command.args(arguments).env_remove(VARIABLE).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    variable.map(|level| command.env(VARIABLE, level));
    let mut child = command.spawn().unwrap();
    // A program that ends at once does not read it.
    let _ = child.stdin.take().unwrap().write_all(b"input");
    child.wait_with_output().unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The level that these tests were built for, and a lower one; `None` where there is no lower one.
fn levels() -> Option<(&'static str, &'static str)> {
    if cfg!(target_feature = "avx512f") {
        Some(("x86-64-v4", "x86-64-v3"))
    } else if cfg!(all(target_feature = "avx2", target_feature = "fma")) {
        Some(("x86-64-v3", "x86-64"))
    } else {
        None
    }
}

/// The program of the level that is asked for runs in place of the one that was called: arguments, standard input, exit code.
#[test]
fn a_level_is_asked_for() {
    let Some((own, lower)) = levels() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("rdsolve");
    place(folder.path(), "rdsolve");
    script(folder.path(), &format!("rdsolve-{lower}"), 0o755);
    let option = format!("--instructions={lower}");
    for (arguments, variable) in [
        (vec!["check", "a deck.toml", "--instructions", lower], None),
        (vec![&option, "a deck.toml"], Some(own)),
        (vec!["a deck.toml"], Some(lower)),
    ] {
        let output = run(&program, &arguments, variable);
        assert_eq!(out(&output), format!("{}|{lower}|input", arguments.join("|")), "{}", said(&output));
        assert_eq!(output.status.code(), Some(42));
    }
    // Otherwise it runs itself, which is the best of the two, and says what there is.
    for (arguments, variable) in [
        (vec!["--version"], None),
        (vec!["--version", "--instructions", own], Some(lower)),
        (vec!["--version"], Some("")),
    ] {
        let output = run(&program, &arguments, variable);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        assert!(out(&output).contains(&format!("instructions {own}")), "{}", out(&output));
        assert!(out(&output).contains(&format!("of {lower}, {own}")), "{}", out(&output));
    }
}

#[test]
fn what_cannot_be_had_is_told() {
    let Some((own, lower)) = levels() else { return };
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("rdsolve");
    place(folder.path(), "rdsolve");
    let refused = |program: &Path, arguments: &[&str], variable, code: i32, text: &str| {
        let output = run(program, arguments, variable);
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert!(said(&output).contains(text), "{}", said(&output));
    };
    refused(&program, &["--instructions", "sse9", "schema"], None, 2, "possible values: x86-64, x86-64-v3, x86-64-v4");
    refused(&program, &["schema"], Some("sse9"), 2, "RDSOLVE_INSTRUCTIONS=sse9 names no level of instructions");
    refused(&program, &["schema", "--instructions", lower], None, 2, &format!("there is {own} alone"));
    refused(&program, &["schema", "--instructions", lower, "--json"], None, 2, "{\"message\":\"there is no program");
    // A program that has the name of another level would not compute what its name says.
    let misnamed = format!("rdsolve-{lower}");
    place(folder.path(), &misnamed);
    refused(&folder.path().join(&misnamed), &["schema"], None, 2, &format!("was built for {own}"));
    refused(&program, &["schema"], Some(lower), 2, &format!("is named after {lower}"));
    fs::remove_file(folder.path().join(&misnamed)).unwrap();
    script(folder.path(), &misnamed, 0o644);
    refused(&program, &["schema"], Some(lower), 6, "does not start");
}

/// A program that is called by the name of its level runs, whatever stands beside it.
#[test]
fn the_name_of_a_level_is_that_level() {
    let Some((own, lower)) = levels() else { return };
    let folder = tempfile::tempdir().unwrap();
    let name = format!("rdsolve-{own}");
    place(folder.path(), &name);
    for level in ["x86-64-v3", "x86-64-v4"].iter().filter(|level| **level != own) {
        script(folder.path(), &format!("rdsolve-{level}"), 0o755);
    }
    script(folder.path(), "rdsolve", 0o755);
    let output = run(&folder.path().join(&name), &["--version"], None);
    assert!(out(&output).starts_with("rdsolve 0"), "{}", out(&output));
    let output = run(&folder.path().join(&name), &["deck.toml"], Some(lower));
    assert_eq!(output.status.code(), Some(42), "{}", said(&output));
}
