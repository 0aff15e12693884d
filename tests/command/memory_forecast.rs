//! The memory that `check` forecasts is that at the peak of a run, and a run for which there is too little ends before its first step.

#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A square sheet of 90 x 90 quadrilaterals that hangs on an edge: 48,600 unknowns, some 120 MB in all.
const SHEET: &str = r#"
analysis = { kind = "dynamic", end_time = 1e-3, time_step = 1e-3 }
environment.gravity = [0.0, 0.0, -9.81]
points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }
materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = 90
material = "steel"
thickness = 0.01
[[supports]]
at = "sheet.edge1"
fix = "all"
"#;

/// Runs a command of the program under a limit on addresses in kilobytes, or "unlimited".
fn under(folder: &Path, limit: &str, arguments: &str) -> Output {
    let script = format!("ulimit -v {limit} && exec \"$0\" {arguments}");
    Command::new("sh").current_dir(folder).args(["-c", &script, env!("CARGO_BIN_EXE_rdsolve")]).output().unwrap()
}

/// The bytes of the first "about … MB" in what `check` says of memory.
fn forecast(said: &str) -> f64 {
    let line = said.lines().find(|line| line.trim_start().starts_with("memory ")).unwrap_or_else(|| panic!("{said}"));
    let megabytes = line.split("about ").nth(1).and_then(|rest| rest.split(" MB").next());
    1e6 * megabytes.unwrap_or_else(|| panic!("{line}")).parse::<f64>().unwrap()
}

/// `result.json` holds the peak that the system has counted for the process (VmHWM); 1.3 is the promise of the documentation.
#[test]
fn the_forecast_is_that_of_the_run() {
    let desk = tempfile::tempdir().unwrap();
    fs::write(desk.path().join("sheet.toml"), SHEET).unwrap();
    let checked = under(desk.path(), "unlimited", "check sheet.toml");
    let forecast = forecast(&String::from_utf8(checked.stdout).unwrap());
    assert!(under(desk.path(), "unlimited", "sheet.toml -o out --threads 1").status.success());
    let result = fs::read_to_string(desk.path().join("out/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&result).unwrap();
    let peak = result["peak_memory_bytes"].as_f64().unwrap();
    assert!((1.0 / 1.3..1.3).contains(&(forecast / peak)), "{forecast} for {peak}");
}
