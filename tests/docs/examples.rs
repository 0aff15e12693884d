//! docs/examples: folders for repositories of users, run as they would run them.

use super::root;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The files of a folder, and of those in it, into another.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to);
        } else {
            fs::copy(&path, &to).map(drop).unwrap();
        }
    }
}

/// The scenes are what they were; a change of one is found, and can be accepted.
#[test]
#[cfg(unix)]
fn scenes_of_a_repository_are_tested() {
    let folder = tempfile::tempdir().unwrap();
    copy(&root().join("docs/examples/scene_tests"), folder.path());
    let test = |arguments: &[&str]| {
        let mut command = Command::new("sh");
        command.arg(folder.path().join("test.sh")).args(arguments).env("RDSOLVE", env!("CARGO_BIN_EXE_rdsolve"));
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    assert_eq!(test(&[]), (Some(0), String::new()));
    let deck = folder.path().join("scenes/mast.toml");
    let text = fs::read_to_string(&deck).unwrap();
    fs::write(&deck, text.replace("thickness = 0.005", "thickness = 0.006")).unwrap();
    let (code, said) = test(&[]);
    assert!(code == Some(1) && said.contains("DIFFERS") && said.contains("FAILED mast: not what it was"), "{said}");
    assert_eq!(test(&["--accept"]).0, Some(0));
    assert_eq!(test(&[]).0, Some(0));
    fs::write(&deck, text.replace("thickness = 0.005", "thickness = 0.002")).unwrap();
    let (code, said) = test(&[]);
    assert!(code == Some(1) && said.contains("FAILED mast: it does not run, or misses"), "{said}");
}
