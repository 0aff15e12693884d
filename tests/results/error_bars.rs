//! Error bars against the errors themselves: the same deck with far shorter steps, or a far finer mesh.

use crate::support;
use assert_cmd::Command;
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;

const B1: &str = "right_angle_cantilever/deck.toml";
const BEAMS_AND_BODIES: [&str; 3] = [B1, "rotating_blade/deck.toml", "first/deck.toml"];

/// Runs a deck of the gallery with arguments into a folder, and reads its result.json and what was said.
fn run(deck: &str, arguments: &[&str], sets: &[&str], folder: &Path) -> (Value, String) {
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    command.arg(support::decks().join(deck)).arg("-o").arg(folder).args(arguments).args(["--overwrite"]);
    command.args(sets.iter().flat_map(|set| ["--set", *set]));
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{deck}: {said}");
    (serde_json::from_slice(&fs::read(folder.join("result.json")).unwrap()).unwrap(), said)
}

/// The largest magnitude in each column of numbers of each table, in the rows of all times.
fn largest(folder: &Path) -> HashMap<(String, String), f64> {
    let mut all = HashMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        let mut reader = csv::Reader::from_path(&path).unwrap();
        let header = reader.headers().unwrap().clone();
        for row in reader.records() {
            for (name, field) in header.iter().zip(row.unwrap().iter()) {
                let value: f64 = field.parse().unwrap_or(0.0);
                let most = all.entry((file.clone(), name.to_owned())).or_insert(0.0_f64);
                *most = most.max(value.abs());
            }
        }
    }
    all
}

/// How wide the bars of a kind are, in true errors: differences to the largest values of a better run. Columns of rounding are left out.
fn widths(result: &Value, kind: &str, run: &Path, better: &Path) -> Vec<f64> {
    let (own, truth) = (largest(run), largest(better));
    let bars = result["error_bars"].as_array().unwrap();
    let tables: Vec<&str> = bars.iter().map(|bar| bar["table"].as_str().unwrap()).collect();
    let size = |table: &str| {
        let of_table = tables.iter().zip(bars).filter(|(name, _)| **name == table);
        of_table.map(|(_, bar)| bar["value"].as_f64().unwrap().abs()).fold(0.0, f64::max)
    };
    let width = |bar: &Value| {
        let (table, column) = (bar["table"].as_str().unwrap(), bar["column"].as_str().unwrap());
        let key = (table.to_owned(), column.to_owned());
        let (value, error) = (bar["value"].as_f64().unwrap().abs(), (own[&key] - truth[&key]).abs());
        assert!((value - own[&key]).abs() <= 1e-15 * value, "{table} {column}: {value} is not the largest value");
        (value > 1e-9 * size(table) && error > 1e-10 * value).then(|| bar[kind].as_f64().unwrap() / error)
    };
    bars.iter().filter_map(width).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// What shorter steps change is within the bars in 9 columns of 10 (94 % of 1240 columns of 19 decks), and these are no more than 60 times
/// too wide in the median: where runs meet events, bars count that these leave errors of first order. So are the bars of expected values.
#[test]
fn bars_of_steps_hold_the_errors_of_steps() {
    let [folder, better] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let (folder, better) = (folder.path(), better.path());
    let mut all = Vec::new();
    for deck in BEAMS_AND_BODIES {
        let sets =
            ["analysis.time_step=\"auto\"", "integrator={scheme=\"esdirk3\"}", "expect=[]", "output={interval=0.05}"];
        let asked = |tolerance: &'static str| sets.into_iter().chain([tolerance]).collect::<Vec<_>>();
        let (result, _) = run(deck, &[], &asked("analysis.error_tolerance=1e-3"), folder);
        run(deck, &[], &asked("analysis.error_tolerance=1e-5"), better);
        all.extend(widths(&result, "step_error", folder, better));
    }
    let within = all.iter().filter(|width| **width >= 1.0).count() as f64 / all.len() as f64;
    assert!(within > 0.9, "{within} of {} columns", all.len());
    let middle = median(all);
    println!("{within} of the columns, {middle} times too wide in the median");
    assert!(middle < 60.0, "{middle}");
}

/// What a finer mesh changes is within the bars in 9 columns of 10 (95 % of 440 columns of 16 runs), and these are no more than 30 times
/// too wide in the median (11 of all these runs). Tables are the same bytes with and without the other run.
#[test]
fn bars_of_the_mesh_hold_the_errors_of_the_mesh() {
    let [folder, plain, better] = [(); 3].map(|()| tempfile::tempdir().unwrap());
    let (folder, plain, better) = (folder.path(), plain.path(), better.path());
    let mut all = Vec::new();
    for (deck, own, finer) in [
        (B1, &["expect=[]", "beams.0.elements=2"][..], &["expect=[]", "beams.0.elements=16"][..]),
        (B1, &["expect=[]", "beams.0.elements=1", "beams.0.order=2"], &["expect=[]", "beams.0.elements=16"]),
        ("cantilever_end_shear/deck.toml", &["beams.0.elements=8"], &["beams.0.elements=32"]),
        ("portal_and_block/deck.toml", &["expect=[]"], &["expect=[]", "beams.0.elements=16"]),
    ] {
        let (result, _) = run(deck, &["--mesh-error"], own, folder);
        run(deck, &[], own, plain);
        run(deck, &[], finer, better);
        let tables = |of: &Path| ["nodes.csv", "energy.csv"].map(|file| fs::read(of.join(file)).unwrap_or_default());
        assert_eq!(tables(folder), tables(plain), "{deck}");
        all.extend(widths(&result, "mesh_error", folder, better));
    }
    let within = all.iter().filter(|width| **width >= 1.0).count() as f64 / all.len() as f64;
    assert!(within > 0.9, "{within} of {} columns", all.len());
    assert!(median(all) < 30.0);
}

/// Expected values carry both bars, in result.json and in the lines on standard output.
#[test]
fn expected_values_have_bars() {
    let [folder, better] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let auto = ["analysis.time_step=\"auto\"", "integrator={scheme=\"esdirk3\"}", "analysis.error_tolerance=1e-3"];
    let (result, _) = run(B1, &["--mesh-error"], &auto, folder.path());
    let finer = [&auto[..2], &["analysis.error_tolerance=1e-5", "beams.0.elements=16"]].concat();
    let (truth, _) = run(B1, &[], &finer, better.path());
    let of = |result: &Value| result["expectations"].as_array().unwrap().clone();
    let (mut within, all) = (0, of(&result).len());
    for (own, better) in of(&result).iter().zip(of(&truth)) {
        let error = (own["value"].as_f64().unwrap() - better["value"].as_f64().unwrap()).abs();
        let bar = own["step_error"].as_f64().unwrap() + own["mesh_error"].as_f64().unwrap();
        within += usize::from(error <= bar);
    }
    assert!(within * 10 >= all * 9, "{within} of {all}");
    let log = fs::read_to_string(folder.path().join("run.log")).unwrap();
    assert!(log.contains("largest values, and bounds of their errors by estimate:"), "{log}");
}

/// Where nothing is known that is said, and why; steps of given length have no bars of their own.
#[test]
fn what_cannot_be_known_is_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let (result, _) = run(B1, &[], &[], folder.path());
    assert!(result.get("error_bars").is_none());
    for (deck, why) in
        [("hinged_roof/deck.toml", "along a path"), ("four_bar/deck.toml", "there is none, for nothing deforms")]
    {
        let out = folder.path().join("refused");
        let path = support::decks().join(deck);
        let refused =
            Command::cargo_bin("rdsolve").unwrap().arg(&path).arg("-o").arg(&out).arg("--mesh-error").output().unwrap();
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{deck}: {said}");
        assert!(said.contains("the error of the mesh is not known") && said.contains(why), "{deck}: {said}");
        assert!(!out.exists(), "{deck}");
    }
    let (result, said) = run("meshed_bracket/deck.toml", &["--mesh-error"], &["expect=[]"], folder.path());
    let why = "the error of the mesh is that of a part only";
    assert!(said.contains(why), "{said}");
    assert!(result["warnings"].as_array().unwrap().iter().any(|warning| warning.as_str().unwrap().contains(why)));
    assert!(fs::read_to_string(folder.path().join("run.log")).unwrap().contains(why));
}

/// A box that tumbles, lands on a corner and slides: impacts leave errors that shorter steps hardly lessen. Runs with equal steps of 2e-5, 1e-5
/// and 5e-6 by another scheme agree on the value within 2e-4.
#[test]
fn the_bar_of_a_box_that_lands_holds() {
    const VALUE: f64 = 0.4964;
    const KNOWN_WITHIN: f64 = 2e-4;
    let folder = tempfile::tempdir().unwrap();
    let deck = folder.path().join("deck.toml");
    fs::write(&deck, LANDING_BOX).unwrap();
    let out = folder.path().join("out");
    Command::cargo_bin("rdsolve").unwrap().arg(&deck).arg("-o").arg(&out).output().unwrap();
    let result: Value = serde_json::from_slice(&fs::read(out.join("result.json")).unwrap()).unwrap();
    let x = &result["expectations"][0];
    let error = (x["value"].as_f64().unwrap() - VALUE).abs();
    // A bar that is not known is none that is wrong.
    let Some(bar) = x["step_error"].as_f64() else {
        assert!(result["step_error"]["estimate"].is_null() && !result["warnings"].as_array().unwrap().is_empty());
        return;
    };
    assert!(error <= bar + KNOWN_WITHIN, "{error} with a bar of {bar}");
    assert!(bar < 0.05, "{bar}: a tenth of the value says nothing");
}

/// A stage after one of motion begins with errors that both of its runs share: it has no bar, where 4e-18 was told.
#[test]
fn stages_after_a_motion_have_no_bars() {
    let folder = tempfile::tempdir().unwrap();
    let deck = folder.path().join("deck.toml");
    fs::write(&deck, STOPPED_SWING).unwrap();
    let out = folder.path().join("out");
    Command::cargo_bin("rdsolve").unwrap().arg(&deck).arg("-o").arg(&out).assert().success();
    let result: Value = serde_json::from_slice(&fs::read(out.join("result.json")).unwrap()).unwrap();
    assert!(result["expectations"][0].get("step_error").is_none(), "{result}");
}

const STOPPED_SWING: &str = r#"
[[stages]]
name = "swing"
kind = "dynamic"
time_step = "auto"
duration = 3.0
error_tolerance = 1e-2
stop = { at = "b", quantity = "ux", value = 0.5 }

[[stages]]
name = "on"
kind = "dynamic"
time_step = "auto"
duration = 1.0

[[bodies]]
name = "b"
center = [0.0, 0.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
velocity = [1.0, 0.0, 0.0]

[[links]]
name = "l"
from = { ground = [-1.0, 0.0, 0.0] }
to = { body = "b" }
stiffness = 1.0

[[expect]]
at = "b"
quantity = "ux"
stage = "on"
at_most = 2.0
"#;

const LANDING_BOX: &str = r#"
[[bodies]]
name = "b"
center = [0.0, 0.0, 0.4]
mass = 1.0
velocity = [1.0, 0.0, 0.0]
angular_velocity = [1.0, 2.0, 0.0]
[bodies.shape]
kind = "hull"
points = [[-0.1, -0.15, -0.2], [-0.1, -0.15, 0.2], [-0.1, 0.15, -0.2], [-0.1, 0.15, 0.2],
          [0.1, -0.15, -0.2], [0.1, -0.15, 0.2], [0.1, 0.15, -0.2], [0.1, 0.15, 0.2]]

[[contacts]]
name = "c"
surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
with = "b"
stiffness = 1e5
restitution = 0.5
friction = 0.3

[environment]
gravity = [0.0, 0.0, -9.81]

[analysis]
kind = "dynamic"
end_time = 0.919
time_step = "auto"
error_tolerance = 1e-3

[output]
interval = 0.0574375

[[expect]]
at = "b"
quantity = "x"
time = 0.919
value = 0.4964
absolute_tolerance = 1.5e-3
"#;
