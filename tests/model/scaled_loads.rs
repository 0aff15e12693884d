//! Loads that a path scales although they look permanent are named, and what the warning proposes gives the path of permanent loads.

use assert_cmd::Command;
use std::path::Path;

/// A cantilever column of 3 m that carries a weight of 200 kN at its tip and is pushed there, by so much of ux.
fn column(analysis: &str, loads: &str) -> String {
    format!(
        r#"
{analysis}
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.s]
shape = "rectangle"
width = 0.1
height = 0.1
[points]
a = [0.0, 0.0, 0.0]
b = [0.0, 0.0, 3.0]
[[beams]]
name = "column"
path = ["a", "b"]
elements = 4
material = "steel"
section = "s"
mass = "none"
orientation = [0.0, 1.0, 0.0]
[[supports]]
at = "a"
fix = "all"
{loads}
"#
    )
}

const STOP: &str =
    "control = \"displacement\"\nstop = { at = \"b\", quantity = \"ux\", value = 0.05 }\nincrement = 0.01\n";
const PUSH: &str = "[[loads]]\nat = \"b\"\nforce = [20e3, 0.0, 0.0]\n";
const WEIGHT: &str = "[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -200e3]\n";
const MASS: &str = "[[masses]]\nat = \"b\"\nmass = 20e3\n[environment]\ngravity = [0.0, 0.0, -10.0]\n";

fn alone() -> String {
    format!("[analysis]\nkind = \"static\"\n{STOP}")
}

/// Runs a deck in a folder; returns its messages, and the load factor at the end.
fn run(folder: &Path, deck: &str) -> (String, f64) {
    std::fs::write(folder.join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder).args(["run", "deck.toml", "--overwrite"]).assert().code(0);
    let mut rows = csv::Reader::from_path(folder.join("deck.out/nodes.csv")).unwrap();
    let place = rows.headers().unwrap().iter().position(|name| name == "time").unwrap();
    let last = rows.records().last().unwrap().unwrap();
    (String::from_utf8(done.get_output().stderr.clone()).unwrap(), last[place].parse().unwrap())
}

/// Under its whole weight P the column takes less push at the same displacement, by about 1.2 P/L of its stiffness 3EI/L³: 0.02 m less
/// than F L³/3EI. Weight by a stage before, by an amplitude and by gravity is one path to eight digits.
#[test]
fn weight_that_grows_with_the_push_is_told_and_the_remedy_gives_the_path_of_permanent_weight() {
    let folder = tempfile::tempdir().unwrap();
    let run = |deck: &str| run(folder.path(), deck);
    let (said, growing) = run(&column(&alone(), &[WEIGHT, PUSH].concat()));
    assert!(said.contains("the steps move ux, and loads across it, on `b`, grow in proportion"), "{said}");
    let (said, of_gravity) = run(&column(&alone(), &[MASS, PUSH].concat()));
    assert!(said.contains("gravity grows in proportion to the loads"), "{said}");
    assert!((of_gravity - growing).abs() < 1e-7 * growing, "{of_gravity} {growing}");

    let always = "[amplitudes.always]\nkind = \"constant\"\n";
    let (said, constant) = run(&column(&alone(), &[WEIGHT, "amplitude = \"always\"\n", PUSH, always].concat()));
    assert_eq!(said, "");
    let (said, fallen) = run(&column(&alone(), &[MASS, "gravity_amplitude = \"always\"\n", PUSH, always].concat()));
    assert_eq!(said, "");
    let stages = format!(
        "[[stages]]\nname = \"weight\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n[[stages]]\nname = \"push\"\nkind = \"static\"\n{STOP}"
    );
    let (said, staged) = run(&column(&stages, &[WEIGHT, PUSH, "stages = [\"push\"]\n"].concat()));
    assert_eq!(said, "");
    for other in [fallen, staged - 1.0] {
        assert!((constant - other).abs() < 1e-7 * constant, "{constant} {other}");
    }
    // The push of a column under constant axial force P: F = 3EI/L³ u (1 − 1.2 P L²/3EI …), from tan(kL) of the beam-column.
    let (l, ei, p, u) = (3.0, 210e9 * 0.1f64.powi(4) / 12.0, 200e3, 0.05);
    let k: f64 = f64::sqrt(p / ei);
    let exact = p * u / ((k * l).tan() / k - l) / 20e3;
    // Shear and the finite displacement, both of which a beam-column leaves aside, are a thousandth each.
    assert!((constant - exact).abs() < 4e-3 * exact, "{constant} {exact}");
    assert!(growing > 1.02 * constant, "{growing} {constant}");
}

/// A small load across a column starts its buckling, an amplitude says that growth is meant, and a weight in a stage before is permanent.
#[test]
fn growth_that_is_meant_is_not_told() {
    let folder = tempfile::tempdir().unwrap();
    let imperfection = PUSH.replace("20e3", "200.0");
    let heavy = WEIGHT.replace("200e3", "600e3");
    let grows = "amplitude = \"grows\"\n[amplitudes.grows]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n";
    for loads in [[&heavy[..], &imperfection].concat(), [PUSH, WEIGHT, grows].concat(), PUSH.to_owned()] {
        assert_eq!(run(folder.path(), &column(&alone(), &loads)).0, "", "{loads}");
    }
}

/// The pattern of loads takes either sign, in a first stage and after others: the column is the same to both sides, so the force is, too.
/// What began before keeps its value.
#[test]
fn a_displacement_against_the_loads_turns_them_round() {
    let folder = tempfile::tempdir().unwrap();
    let stage = |name: &str, keys: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"static\"\n{keys}");
    let back = STOP.replace("0.05", "-0.05");
    let push = |stage: &str| format!("{PUSH}stages = [\"{stage}\"]\n");
    let (_, there) = run(folder.path(), &column(&alone(), PUSH));
    let (said, alone) = run(folder.path(), &column(&alone().replace(STOP, &back), PUSH));
    assert_eq!(said, "");
    assert!((alone + there).abs() < 1e-9, "{alone} {there}");

    let weight = stage("weight", "duration = 1.0\ntime_step = 0.5\n");
    let (_, there) =
        run(folder.path(), &column(&(weight.clone() + &stage("push", STOP)), &(WEIGHT.to_owned() + &push("push"))));
    let (_, against) =
        run(folder.path(), &column(&(weight.clone() + &stage("push", &back)), &(WEIGHT.to_owned() + &push("push"))));
    assert!((against + there - 2.0).abs() < 1e-7 * there, "{against} {there}");

    // There and back, and rest: loads of the second push point back, for the time runs on from stage to stage.
    let both = weight.clone()
        + &stage("push", STOP)
        + &stage("back", &back)
        + &stage("rest", "duration = 0.1\ntime_step = 0.05\n");
    let pushes = format!("{PUSH}stages = [\"push\", \"back\", \"rest\"]\n");
    let last =
        |sign: &str| format!("{}stages = [\"back\", \"rest\"]\n", PUSH.replace("[20e3", &format!("[{sign}20e3")));
    let expect = "[[expect]]\nat = \"b\"\nquantity = \"ux\"\nstage = \"rest\"\nvalue = -0.05\ntolerance = 1e-6\n";
    let (_, end) = run(folder.path(), &column(&both, &[WEIGHT, &pushes, &last("-"), expect].concat()));
    assert!((end - (there + 2.0 * (there - 1.0) + 0.1)).abs() < 1e-6, "{end} {there}");
    std::fs::write(folder.path().join("deck.toml"), column(&both, &[WEIGHT, &pushes, &last("")].concat())).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder.path()).args(["deck.toml", "--overwrite"]).assert().code(4);
    let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
    assert!(said.contains("Give these loads the other sign"), "{said}");

    // Nothing grows where all loads have grown before.
    std::fs::write(folder.path().join("deck.toml"), column(&(weight + &stage("push", STOP)), PUSH)).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder.path()).args(["check", "deck.toml"]).assert().code(3);
    let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
    assert!(said.contains("nothing grows here") && said.contains("add a load with `stages = [\"push\"]`"), "{said}");
}
