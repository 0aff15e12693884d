//! Mechanisms that pass positions at which they could as well go on along another branch.

use crate::support;
use assert_cmd::Command;
use serde_json::Value;
use std::fs;

/// The largest error of the values that an N-four-bar with N = 2 is held to, up to a time. Its rods lie on one line first after 0.8 s.
fn error(scheme: &str, step: f64, end: f64) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    command.arg(support::decks().join("n_four_bar/deck.toml")).arg("-o").arg(folder.path()).arg("--overwrite");
    let set = |key: &str, value: String| ["--set".to_owned(), format!("{key}={value}")];
    command.args(set("integrator", format!("{{scheme=\"{scheme}\"}}")));
    command.args(set("analysis.time_step", format!("{step:?}")));
    if end < 10.0 {
        command.args(set("analysis.end_time", format!("{end:?}")));
        // By quadrature of the equation of the deck.
        let value = |quantity: &str, value: f64| {
            format!("{{at=\"B0\",quantity=\"{quantity}\",time=1.0,value={value},absolute_tolerance=1e-3}}")
        };
        command.args(set("expect", format!("[{},{}]", value("x", -0.1950203019), value("y", -0.9807992057))));
    }
    let output = command.output().unwrap();
    let result: Value = serde_json::from_slice(&fs::read(folder.path().join("result.json")).unwrap()).unwrap();
    let values = result["expectations"].as_array().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let errors = values.iter().map(|value| value["error"].as_f64().unwrap_or_else(|| panic!("{scheme}: {said}")));
    errors.map(f64::abs).fold(0.0, f64::max)
}

/// Steps of 4 ms err by up to 9e-4 at t = 1, and another branch would be off by more than 0.1.
#[test]
fn every_scheme_goes_on_where_the_rods_lie_on_one_line() {
    for scheme in ["wilson-theta", "newmark", "generalized-alpha", "bathe", "esdirk3", "central-difference"] {
        let error = error(scheme, 4e-3, 1.0);
        assert!(error < 2e-3, "{scheme}: {error}");
    }
}

/// Steps of 2 ms met another branch, and were off by 0.43 m. Passing the position costs digits: 4e-5 are left after eight passages.
#[test]
fn equal_explicit_steps_keep_to_the_branch() {
    let error = error("runge-kutta", 2e-3, 10.0);
    assert!(error < 2e-4, "{error}");
}
