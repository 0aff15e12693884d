//! The commands around a run: decks to begin with, summaries, a deck on standard input, diagnostics as JSON, completion of shells.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

fn rdsolve(folder: &Path, arguments: &[&str], input: &str) -> Output {
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    command.current_dir(folder).args(arguments).write_stdin(input).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

const KINDS: [&str; 4] = ["frame", "mechanism", "shell", "impact"];

/// Every deck of `init` is sound without a word, and runs to its end within what it expects.
#[test]
fn decks_to_begin_with_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for kind in KINDS {
        let printed = rdsolve(folder, &["init", kind], "");
        assert!(printed.status.success());
        fs::write(folder.join("deck.toml"), &printed.stdout).unwrap();
        let checked = rdsolve(folder, &["check", "deck.toml"], "");
        assert!(checked.status.success() && checked.stderr.is_empty(), "{kind}: {}", text(&checked.stderr));
        let ran = rdsolve(folder, &["deck.toml", "--overwrite"], "");
        assert!(ran.status.success() && ran.stderr.is_empty(), "{kind}: {}", text(&ran.stderr));
    }
    let without = rdsolve(folder, &["init"], "").stdout;
    assert_eq!(without, rdsolve(folder, &["init", "frame"], "").stdout);
    assert_eq!(rdsolve(folder, &["init", "bridge"], "").status.code(), Some(2));
}

/// A deck on standard input gives the bytes of the same deck in a file; a study cannot read it again and again.
#[test]
fn a_deck_may_come_on_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = text(&rdsolve(folder, &["init", "impact"], "").stdout);
    fs::write(folder.join("ball.toml"), &deck).unwrap();
    assert!(rdsolve(folder, &["ball.toml", "-o", "file"], "").status.success());
    assert!(rdsolve(folder, &["run", "-", "-o", "input"], &deck).status.success());
    for table in ["nodes.csv", "bodies.csv", "energy.csv"] {
        assert_eq!(
            fs::read(folder.join("file").join(table)).unwrap(),
            fs::read(folder.join("input").join(table)).unwrap()
        );
    }
    // Its folder is named after a deck; what is wrong has its place.
    assert!(rdsolve(folder, &["-", "--quiet"], &deck).status.success() && folder.join("deck.out").is_dir());
    let wrong = rdsolve(folder, &["check", "-"], "[analysis]\nkinds = 1\n");
    assert_eq!(wrong.status.code(), Some(3));
    assert!(text(&wrong.stderr).contains("-:2:1"), "{}", text(&wrong.stderr));
    assert_eq!(rdsolve(folder, &["study", "-"], &deck).status.code(), Some(2));
}

/// With `--json` each line on standard error is an object, and says what the text says.
#[test]
fn diagnostics_may_be_json() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = text(&rdsolve(folder, &["init", "frame"], "").stdout);
    fs::write(folder.join("deck.toml"), deck.replace("material = \"steel\"", "material = \"steal\"")).unwrap();
    let line = deck.lines().position(|line| line.starts_with("material =")).unwrap() + 1;
    for arguments in [&["check", "deck.toml", "--json"][..], &["deck.toml", "--json"], &["run", "--json", "deck.toml"]]
    {
        let output = rdsolve(folder, arguments, "");
        assert_eq!(output.status.code(), Some(3));
        let said: Vec<Value> = text(&output.stderr)
            .lines()
            .map(|line| serde_json::from_str(line).expect("an object on each line"))
            .collect();
        let first = &said[0];
        assert_eq!(first["severity"], "error");
        assert_eq!(first["message"], "no material is named `steal`");
        assert_eq!((first["file"].as_str(), first["line"].as_u64()), (Some("deck.toml"), Some(line as u64)));
        assert_eq!((first["column"].as_u64(), first["length"].as_u64()), (Some(12), Some(7)));
        assert!(first["hints"][0].as_str().unwrap().contains("`steel`"));
        assert!(said.last().unwrap()["message"].as_str().unwrap().contains("has 1 error"));
    }
    let missing = rdsolve(folder, &["none.toml", "--json"], "");
    let said: Value = serde_json::from_str(text(&missing.stderr).lines().next().unwrap()).unwrap();
    assert!(said["message"].as_str().unwrap().contains("none.toml") && missing.status.code() == Some(6));
}

/// A summary has the extremes of the tables themselves, in each form.
#[test]
fn a_summary_has_peaks_and_ends() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = text(&rdsolve(folder, &["init", "impact"], "").stdout);
    assert!(rdsolve(folder, &["-", "-o", "out"], &deck).status.success());
    let mut reader = csv::Reader::from_path(folder.join("out/bodies.csv")).unwrap();
    let place = reader.headers().unwrap().iter().position(|name| name == "vz").unwrap();
    let rows: Vec<(f64, f64)> = reader
        .records()
        .map(|row| row.unwrap())
        .map(|row| (row[1].parse().unwrap(), row[place].parse().unwrap()))
        .collect();
    let largest = rows.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap();
    let least = rows.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a }).unwrap();
    let json: Value =
        serde_json::from_slice(&rdsolve(folder, &["summary", "out", "--format", "json"], "").stdout).unwrap();
    assert_eq!(json["status"], "done");
    let column = json["columns"].as_array().unwrap();
    let column = column.iter().find(|column| column["table"] == "bodies.csv" && column["column"] == "vz").unwrap();
    let pair = |key: &str| (column[key]["time"].as_f64().unwrap(), column[key]["value"].as_f64().unwrap());
    for (found, exact) in [(pair("min"), least), (pair("max"), largest), (pair("end"), rows[rows.len() - 1])] {
        // JSON is read here by a parser that may be off by one in the last place.
        assert!(found.0 == exact.0 && (found.1 - exact.1).abs() <= f64::EPSILON * exact.1.abs(), "{found:?} {exact:?}");
    }
    assert_eq!(column["max"]["at"], "ball");
    let table = rdsolve(folder, &["summary", "out", "--format", "csv"], "").stdout;
    let mut reader = csv::Reader::from_reader(&table[..]);
    let row = reader.records().map(|row| row.unwrap()).find(|row| &row[0] == "bodies.csv" && &row[1] == "vz").unwrap();
    assert_eq!((row[6].parse::<f64>().unwrap(), row[5].parse::<f64>().unwrap()), (largest.0, largest.1));
    let lines = text(&rdsolve(folder, &["summary", "out"], "").stdout);
    assert!(lines.starts_with("done\n") && lines.contains("bodies.csv\n") && lines.contains("  vz: "), "{lines}");
    assert_eq!(rdsolve(folder, &["summary", "nowhere"], "").status.code(), Some(6));
}

/// Shells and `man` learn all commands.
#[test]
fn shells_complete_the_commands() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = text(&rdsolve(folder.path(), &["completions", shell], "").stdout);
        for command in ["check", "compare", "summary", "study"] {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    let page = text(&rdsolve(folder.path(), &["man"], "").stdout);
    assert!(page.starts_with(".ie") || page.contains(".TH rdsolve"), "{page}");
    assert_eq!(rdsolve(folder.path(), &["completions", "cmd"], "").status.code(), Some(2));
}
