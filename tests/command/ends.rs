//! Runs that come to their end and fail all the same: a `stop` that is missed, an equilibrium that is unstable, an error of the mesh that
//! cannot be known.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

/// A spring of 1e6 N/m under 1 kN: 0.5 J at the end of the first stage.
const RAM: &str = r#"
[[stages]]
name = "ram"
kind = "static"
duration = 1.0
time_step = 0.25
stop = { load = "ram", work = 10.0 }
[[stages]]
name = "after"
kind = "static"
duration = 1.0
time_step = 0.5
[points]
plate = [0.1, 0.0, 0.0]
[[masses]]
at = "plate"
mass = 20.0
[[supports]]
at = "plate"
fix = ["uy", "uz"]
[[links]]
name = "pad"
from = { ground = [0.0, 0.0, 0.0] }
to = { node = "plate" }
stiffness = 1e6
[[loads]]
name = "ram"
at = "plate"
force = [1e3, 0.0, 0.0]
"#;

/// A column that stays straight beyond its Euler load of 29.985 kN; the load is 30 kN times the time.
const COLUMN: &str = r#"
[analysis]
kind = "static"
control = "arc-length"
end_time = 2.0
time_step = 0.25
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.square]
shape = "rectangle"
width = 0.05
height = 0.05
[points]
foot = [0.0, 0.0, 0.0]
head = [0.0, 0.0, 3.0]
[[beams]]
name = "column"
path = ["foot", "head"]
elements = 4
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "foot"
fix = "all"
[[loads]]
at = "head"
force = [0.0, 0.0, -60e3]
"#;

/// Runs a deck in a folder with these arguments.
fn run(folder: &Path, deck: &str, arguments: &[&str]) -> Output {
    fs::write(folder.join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    command.current_dir(folder).args(["deck.toml", "--overwrite"]).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join("deck.out").join(file)).unwrap()
}

/// A stage that ends before its `stop` fails the run, though later stages follow; a limit that need not be reached is a note in the log.
#[test]
fn a_stage_that_misses_its_stop_fails_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let missed = run(folder, RAM, &[]);
    let words =
        "stage `ram`: `stop` was not reached: the work of ram did not come to 10 until the end of the stage, t = 1.";
    assert_eq!(missed.status.code(), Some(5));
    assert!(text(&missed.stderr).contains(&format!("error: {words}")), "{}", text(&missed.stderr));
    let result: Value = serde_json::from_str(&read(folder, "result.json")).unwrap();
    assert_eq!((&result["status"], &result["exit_code"]), (&"expectation-missed".into(), &5.into()));
    assert!(result["reason"].as_str().unwrap().starts_with(words), "{result}");
    // Both stages have their rows.
    assert!(read(folder, "nodes.csv").contains(",after,"));
    let allowed = run(folder, &RAM.replace("work = 10.0", "work = 10.0, required = false"), &[]);
    assert!(allowed.status.success() && allowed.stderr.is_empty(), "{}", text(&allowed.stderr));
    assert!(read(folder, "run.log").contains(&format!("note: {words}")));
    let reached = run(folder, &RAM.replace("work = 10.0", "work = 0.25"), &[]);
    assert!(reached.status.success() && !read(folder, "run.log").contains("`stop`"), "{}", text(&reached.stderr));
}

/// Beyond a bifurcation results are valid up to it alone: exit code 4, with its time.
#[test]
fn an_unstable_equilibrium_fails_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let ran = run(folder, COLUMN, &[]);
    let said = text(&ran.stderr);
    assert_eq!(ran.status.code(), Some(4), "{said}");
    assert!(
        said.contains("Later results are not valid")
            && said.contains("the structure buckles; results are valid up to t = ")
    );
    let result: Value = serde_json::from_str(&read(folder, "result.json")).unwrap();
    assert_eq!((&result["status"], &result["exit_code"]), (&"not-converged".into(), &4.into()));
    // Four elements of order 3 have the Euler load within a thousandth.
    let valid_until = result["valid_until"].as_f64().unwrap();
    assert!((valid_until / 0.9995 - 1.0).abs() < 2e-3, "{valid_until}");
    let below = run(folder, &COLUMN.replace("-60e3", "-29e3"), &[]);
    assert!(below.status.success(), "{}", text(&below.stderr));
}

/// What the error of the mesh cannot be known of is refused before the run; else it is printed where nothing is expected.
#[test]
fn the_error_of_the_mesh_is_refused_or_printed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (deck, why) in [
        (RAM, "decks without stages only"),
        (COLUMN, "along a path"),
        (&steps().replace("elements = 4", "elements = 1\norder = 1"), "fewer elements"),
    ] {
        let refused = run(folder, deck, &["--mesh-error"]);
        let said = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains("--mesh-error: the error of the mesh is not known") && said.contains(why), "{said}");
        assert!(!folder.join("deck.out").exists());
    }
    let told = text(&run(folder, &steps(), &["--mesh-error"]).stdout);
    assert!(told.contains("largest values, and bounds of their errors") && told.contains("by the mesh"), "{told}");
}

/// The column under a load across it, in load steps.
fn steps() -> String {
    COLUMN.replace("control = \"arc-length\"\n", "").replace("[0.0, 0.0, -60e3]", "[1e3, 0.0, 0.0]")
}

/// "named" may stand beside other names, and an empty list leaves the table out.
#[test]
fn nodes_of_output_may_be_named_and_others() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let deck = |nodes: &str| format!("{}[output]\nnodes = {nodes}\n", steps());
    let rows_at_start = |nodes: &str| {
        let ran = run(folder, &deck(nodes), &[]);
        assert!(ran.status.success(), "{}", text(&ran.stderr));
        read(folder, "nodes.csv").lines().filter(|line| line.starts_with("0,")).map(str::to_owned).collect::<Vec<_>>()
    };
    let both = rows_at_start("[\"named\", \"column\"]");
    assert_eq!(
        (rows_at_start("\"named\"").len(), rows_at_start("[\"named\", \"head\"]").len(), both.len()),
        (2, 2, 13)
    );
    assert!(both[0].contains("column|named") && both[2].contains("column") && !both[2].contains("named"), "{both:?}");
    let ran = run(folder, &deck("[]"), &[]);
    assert!(ran.status.success() && !folder.join("deck.out/nodes.csv").exists(), "{}", text(&ran.stderr));
}
