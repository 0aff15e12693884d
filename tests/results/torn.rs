//! A table that ends within a row: every command that reads the folder omits the row and says so.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

const DECK: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.1
time_step = 0.01
[[bodies]]
name = "block"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [1.0, 1.0, 1.0]
[environment]
gravity = [0.0, 0.0, -10.0]
"#;
const SWEEP: &str = "deck = \"deck.toml\"\n[vary]\n\"bodies.block.mass\" = [1.0, 2.0]\n[collect]\n\
                     end = { at = \"block\", quantity = \"z\", time = \"end\" }\n";

/// Standard error and standard output of a command that succeeds.
fn rdsolve(folder: &Path, arguments: &[&str]) -> [String; 2] {
    let done = Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).assert().code(0);
    let output = done.get_output();
    [&output.stderr, &output.stdout].map(|bytes| String::from_utf8(bytes.clone()).unwrap())
}

/// Cuts the end of the last row off.
fn tear(table: &Path) {
    let text = fs::read_to_string(table).unwrap();
    fs::write(table, &text[..text.len() - 5]).unwrap();
}

#[test]
fn all_readers_say_that_a_last_row_is_torn() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    fs::write(folder.join("deck.toml"), DECK).unwrap();
    fs::write(folder.join("s.toml"), SWEEP).unwrap();
    rdsolve(folder, &["run", "deck.toml"]);
    rdsolve(folder, &["sweep", "s.toml"]);
    let torn = "the last line of bodies.csv is incomplete and omitted";
    let commands: [&[&str]; 6] = [
        &["summary", "deck.out"],
        &["summary", "deck.out", "--format", "csv"],
        &["summary", "deck.out", "--format", "json"],
        &["summary", "deck.out", "--curve", "bodies.csv:block:z", "bodies.csv:block:vz"],
        &["report", "deck.out", "--overwrite"],
        &["sweep", "s.toml", "--collect"],
    ];
    for command in commands {
        assert!(!rdsolve(folder, command).concat().contains("incomplete"), "{command:?}");
    }
    tear(&folder.join("deck.out/bodies.csv"));
    let cases = fs::read_dir(folder.join("s.out")).unwrap().map(|entry| entry.unwrap().path());
    let case = cases.filter(|path| path.is_dir()).min().unwrap();
    tear(&case.join("bodies.csv"));
    for command in commands {
        let [err, out] = rdsolve(folder, command);
        assert_eq!([&err, &out].iter().filter(|said| said.contains(torn)).count(), 1, "{command:?}: {err}{out}");
    }
    assert!(fs::read_to_string(folder.join("deck.html")).unwrap().contains(torn));
    // The rows before it count: z = −g t²/2 at t = 0.09.
    let [_, out] = rdsolve(folder, &["summary", "deck.out", "--only", "bodies.csv:z"]);
    assert!(out.contains("t = 0.09"), "{out}");
}
