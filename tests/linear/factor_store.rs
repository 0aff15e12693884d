//! A factor that the memory does not hold lies in a file: the same answer to the byte, and words where there is no room for that either.

#![cfg(target_os = "linux")]

use rdsolve::linear::memory_of_products;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// A square sheet of 100 x 100 quadrilaterals under pressure, 59,400 unknowns: a factor of 104 MB, and some 150 MB beside it.
const SHEET: &str = r#"
analysis = { kind = "static", end_time = 1.0, time_step = 1.0 }
amplitudes.up = { kind = "ramp", end = 1.0 }
points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }
materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }
output.fields = { format = "vtu" }
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [100, 100]
material = "steel"
thickness = 0.01
[[supports]]
at = "sheet.edge1"
fix = "all"
[[loads]]
at = "sheet"
pressure = 100.0
amplitude = "up"
"#;

/// Runs the sheet with so many kilobytes of memory, and temporary files in `scratch`. Its exit code and what it says on standard error.
fn run(folder: &Path, out: &str, kilobytes: &str, scratch: &Path) -> (i32, String) {
    let script = format!("ulimit -d {kilobytes} && exec \"$0\" sheet.toml -o {out} --threads 1");
    let mut command = Command::new("sh");
    command.current_dir(folder).env("TMPDIR", scratch).args(["-c", &script, env!("CARGO_BIN_EXE_rdsolve")]);
    let done = command.stdout(Stdio::null()).output().unwrap();
    (done.status.code().unwrap_or(-1), String::from_utf8(done.stderr).unwrap())
}

#[test]
fn a_factor_that_memory_does_not_hold_lies_in_a_file() {
    // The folder for temporary files may be in memory; that of what is built is on a disk.
    let desk = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let folder = desk.path();
    fs::write(folder.join("sheet.toml"), SHEET).unwrap();
    // The limit counts what is in memory alone, not pages of files: 142 MB beside the buffers of products.
    let limit = (142_000 + memory_of_products() / 1024).to_string();
    for (out, kilobytes) in [("memory", "unlimited"), ("file", &limit)] {
        let (code, said) = run(folder, out, kilobytes, folder);
        assert_eq!(code, 0, "{out}: {said}");
        let log = fs::read_to_string(folder.join(out).join("run.log")).unwrap();
        assert_eq!(log.contains("GB of the factor lie in a file in"), out == "file", "{log}");
    }
    let tables = |out: &str| {
        let mut names: Vec<_> =
            fs::read_dir(folder.join(out)).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.retain(|name| [".vtu", ".csv"].iter().any(|end| name.to_string_lossy().ends_with(end)));
        // What steps cost is not of the scene.
        names.retain(|name| name != "steps.csv");
        names.sort();
        names
    };
    let names = tables("memory");
    assert!(names.len() > 2 && names == tables("file"), "{names:?}");
    for name in names {
        assert_eq!(
            fs::read(folder.join("memory").join(&name)).unwrap(),
            fs::read(folder.join("file").join(&name)).unwrap()
        );
    }
    // The file had no name.
    assert!(fs::read_dir(folder).unwrap().count() == 3);

    // No such folder, and one in memory.
    for (scratch, reason) in
        [(folder.join("none"), "nothing can be written in"), ("/dev/shm".into(), "is itself in memory")]
    {
        if !scratch.starts_with(folder) && !scratch.is_dir() {
            continue;
        }
        let (code, said) = run(folder, "refused", &limit, &scratch);
        assert!(code == 7 && said.contains(reason) && said.contains("Set TMPDIR to a folder"), "{code} {said}");
        assert!(!folder.join("refused").exists());
    }
    // Neither the matrix nor its update matrices have room.
    let (code, said) = run(folder, "refused", "100000", folder);
    assert!(code == 7 && said.contains("more memory than there is. Take a coarser mesh"), "{code} {said}");
}
