//! Arguments in, exit code out.

use crate::support::truss::behind_spring;
use rdsolve::names::to_digits;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

const DECK: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.01

[[bodies]]
name = "ball"
center = [0.0, 0.0, 0.0]
mass = 1.0
shape = { kind = "sphere", radius = 0.1 }
"#;

fn folder(deck: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.toml"), deck).unwrap();
    folder
}

fn rdsolve(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("rdsolve").unwrap().current_dir(folder).args(arguments).assert()
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

#[test]
fn a_sound_deck_passes() {
    let folder = folder(DECK);
    let done = rdsolve(folder.path(), &["check", "ball.toml"]).code(0);
    assert_eq!(said(&done), "");
}

/// The matrices of a body on a spring, hinged to another: masses, stiffness, damping and the equations of the hinge.
#[test]
fn matrices_are_exported() {
    let folder = folder(&format!(
        "{DECK}\n[[bodies]]\nname = \"other\"\ncenter = [1.0, 0.0, 0.0]\nmass = 3.0\ninertia = [0.1, 0.2, 0.25]\n\
         [[joints]]\nname = \"hinge\"\nkind = \"spherical\"\nfrom = {{ body = \"ball\", point = [0.5, 0.0, 0.0] }}\nto = {{ body = \"other\" }}\n\
         [[links]]\nname = \"spring\"\nfrom = {{ ground = [-1.0, 0.0, 0.0] }}\nto = {{ body = \"ball\" }}\nstiffness = 40.0\ndamping = 7.0\n"
    ));
    let done = rdsolve(folder.path(), &["check", "ball.toml", "--export-matrices", "matrices"]).code(0);
    let shown = String::from_utf8(done.get_output().stdout.clone()).unwrap();
    assert!(shown.contains("K.mtx, M.mtx, C.mtx, G.mtx, dofs.csv in matrices"), "{shown}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("matrices").join(name)).unwrap();
    let dofs = read("dofs.csv");
    let rows: Vec<Vec<&str>> = dofs.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let row = |node: &str, direction: &str| {
        let place = rows.iter().position(|row| row[1] == node && row[2] == direction);
        place.unwrap_or_else(|| panic!("{direction} of {node}")) + 1
    };
    let entries = |name: &str| -> Vec<(usize, usize, f64)> {
        let text = read(name);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("%%MatrixMarket matrix coordinate real general"));
        let of = |line: &str| -> Vec<f64> { line.split(' ').map(|word| word.parse().unwrap()).collect() };
        let sizes = of(lines.next().unwrap());
        let all: Vec<_> = lines.map(of).map(|entry| (entry[0] as usize, entry[1] as usize, entry[2])).collect();
        assert_eq!(all.len(), sizes[2] as usize);
        assert!(all.iter().all(|entry| entry.0 <= sizes[0] as usize && entry.1 <= sizes[1] as usize));
        all
    };
    let entry = |name: &str, at: (usize, usize)| -> f64 {
        entries(name).iter().filter(|entry| (entry.0, entry.1) == at).map(|entry| entry.2).sum()
    };
    let x = row("ball", "ux");
    assert_eq!((entry("K.mtx", (x, x)), entry("C.mtx", (x, x)), entry("M.mtx", (x, x))), (40.0, 7.0, 1.0));
    let turn = row("other", "rz");
    assert_eq!((entry("M.mtx", (turn, turn)), entry("K.mtx", (turn, turn))), (0.25, 0.0));
    // Three equations hold the hinge: a motion of both bodies along x leaves no gap, one of the ball alone a unit.
    let along = |nodes: &[&str]| -> f64 {
        let of =
            |equation: usize| -> f64 { nodes.iter().map(|node| entry("G.mtx", (equation, row(node, "ux")))).sum() };
        (1..=3).map(|equation| of(equation).powi(2)).sum::<f64>().sqrt()
    };
    assert!((along(&["ball"]) - 1.0).abs() < 1e-15 && along(&["ball", "other"]) < 1e-15);
}

#[test]
fn usage_ends_with_2() {
    let folder = folder(DECK);
    for arguments in
        [&[][..], &["--sett", "ball.toml"], &["ball.toml", "--threads", "0"], &["check"], &["ball.toml", "more"]]
    {
        rdsolve(folder.path(), arguments).code(2);
    }
    for threads in ["65", "1000"] {
        let done = rdsolve(folder.path(), &["ball.toml", "--threads", threads]).code(2);
        assert!(said(&done).contains("1..=64"), "{}", said(&done));
    }
    rdsolve(folder.path(), &["ball.toml", "--threads", "64"]).code(0);
}

/// The help of each command ends with an example; those that need no other input files are run one after the other.
#[test]
fn examples_of_help_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), DECK.replace("end_time = 1.0", "end_time = 0.1")).unwrap();
    let old = ["run", "deck.toml", "-o", "old.out", "--set", "analysis.time_step=1e-3"];
    rdsolve(folder.path(), &old).code(0);
    let printed = |arguments: &[&str]| {
        String::from_utf8(rdsolve(folder.path(), arguments).code(0).get_output().stdout.clone()).unwrap()
    };
    let help = printed(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let names = list.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    let names: Vec<&str> = names.filter(|name| *name != "help").collect();
    assert!(names.len() >= 11, "{names:?}");
    for name in names {
        let help = printed(&[name, "--help"]);
        let example = help.split("Example: `rdsolve ").nth(1).and_then(|rest| rest.split('`').next());
        let example = example.unwrap_or_else(|| panic!("no example of {name}: {help}"));
        let words: Vec<&str> = example.split_whitespace().take_while(|word| *word != ">").collect();
        assert_eq!(words[0], name);
        if !["study", "sweep", "import"].contains(&name) {
            printed(&words);
        }
    }
}

#[test]
fn words_of_other_versions_are_not_advertised() {
    let folder = folder(DECK);
    let help = rdsolve(folder.path(), &["--help"]).code(0);
    let help = String::from_utf8(help.get_output().stdout.clone()).unwrap();
    for word in [
        "run",
        "check",
        "study",
        "compare",
        "report",
        "sweep",
        "summary",
        "init",
        "completions",
        "schema",
        "--set",
        "--overwrite",
        "--resume",
        "--threads",
        "--quiet",
        "--output",
    ] {
        assert!(help.contains(word), "{word}");
    }
}

#[test]
fn a_wrong_deck_ends_with_3_and_a_count() {
    let folder = folder(&DECK.replace("mass = 1.0", "mas = -1.0").replace("end_time = 1.0", "end_time = 0.0"));
    for arguments in [&["ball.toml"][..], &["run", "ball.toml"], &["check", "ball.toml"]] {
        let failed = rdsolve(folder.path(), arguments).code(3);
        let said = said(&failed);
        assert!(said.contains("ball.toml:10:1"), "{said}");
        assert!(said.contains("did you mean `mass`?"), "{said}");
        assert!(said.ends_with("error: `ball.toml` has 2 errors\n"), "{said}");
        assert!(!said.contains('\u{1b}'), "no colours in a pipe");
        assert!(failed.get_output().stdout.is_empty());
    }
    assert!(!folder.path().join("ball.out").exists());
}

#[test]
fn an_argument_can_mend_or_spoil_a_deck() {
    let folder = folder(DECK);
    rdsolve(folder.path(), &["check", "ball.toml", "--set", "bodies.ball.mass=0"]).code(3);
    std::fs::write(folder.path().join("ball.toml"), DECK.replace("mass = 1.0", "mass = 0")).unwrap();
    rdsolve(folder.path(), &["check", "ball.toml", "--set", "bodies.ball.mass=2"]).code(0);
}

#[test]
fn files_that_cannot_be_read_end_with_6_and_bytes_that_are_no_text_with_3() {
    let folder = folder(DECK);
    assert!(said(&rdsolve(folder.path(), &["none.toml"]).code(6)).contains("none.toml"));
    rdsolve(folder.path(), &["check", "."]).code(6);
    std::fs::write(folder.path().join("ball.toml"), b"title = \"a\"\n# \xff\n").unwrap();
    assert!(said(&rdsolve(folder.path(), &["ball.toml"]).code(3)).contains("line 2"));
}

#[test]
fn results_are_not_overwritten_unasked() {
    let folder = folder(DECK);
    let results = folder.path().join("ball.out");
    std::fs::create_dir(&results).unwrap();
    std::fs::write(results.join("nodes.csv"), "kept").unwrap();
    assert!(said(&rdsolve(folder.path(), &["ball.toml"]).code(2)).contains("--overwrite"));
    rdsolve(folder.path(), &["ball.toml", "-o", "ball.toml"]).code(6);
    assert_eq!(std::fs::read_to_string(results.join("nodes.csv")).unwrap(), "kept");
}

#[test]
fn the_schema_is_a_schema_of_the_deck() {
    let folder = folder(DECK);
    let done = rdsolve(folder.path(), &["schema"]).code(0);
    let schema: serde_json::Value = serde_json::from_slice(&done.get_output().stdout).unwrap();
    assert_eq!(schema["title"], "Deck");
    assert_eq!(schema["additionalProperties"], false);
    // A deck has `[analysis]` or `[[stages]]`.
    assert!(schema["required"].is_null() && schema["properties"]["stages"].is_object());
    let beam = &schema["$defs"]["Beam"]["properties"];
    assert_eq!(beam["rotary_inertia"]["type"], "boolean");
    assert!(beam["orientation"]["description"].is_string());
    assert!(!schema.to_string().contains("null"));
    let sweep = rdsolve(folder.path(), &["schema", "--sweep"]).code(0);
    let sweep: serde_json::Value = serde_json::from_slice(&sweep.get_output().stdout).unwrap();
    assert_eq!(sweep["title"], "Sweep");
    assert!(sweep["properties"]["vary"]["description"].is_string());
}

/// A truss behind a spring snaps back; with steps that may not be cut its path is lost on the way.
fn snap_back() -> String {
    const PATH: &str = r#"
[analysis]
kind = "static"
control = "arc-length"
end_time = 60.0
time_step = 5.0
least_step = 5.0
"#;
    format!("{PATH}{}[[loads]]\nat = \"hand\"\nforce = [0.0, 0.0, -60.0]\n", behind_spring(40.0))
}

#[test]
fn a_lost_path_names_nodes_and_leaves_what_it_found() {
    let folder = folder(&snap_back());
    let done = rdsolve(folder.path(), &["ball.toml"]).code(4);
    let said = said(&done);
    assert!(said.contains("crown uz") || said.contains("hand uz"), "{said}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("ball.out").join(name)).unwrap();
    let result: serde_json::Value = serde_json::from_str(&read("result.json")).unwrap();
    assert_eq!(result["status"], "not-converged");
    let (steps, nodes) = (read("steps.csv"), read("nodes.csv"));
    // A header, and the start with four points in one of them.
    let found = result["counts"]["steps"].as_u64().unwrap() as usize;
    assert!(found > 2);
    assert_eq!((steps.lines().count(), nodes.lines().count()), (1 + found, 1 + 4 * (1 + found)));
    assert!(nodes.ends_with('\n'));
    // With cuts it arrives, and the log says what lies on the way.
    rdsolve(folder.path(), &["ball.toml", "--overwrite", "--set", "analysis.least_step=1e-3"]).code(0);
    let log = read("run.log");
    let limits: Vec<&str> = log.lines().filter(|line| line.contains("limit point")).collect();
    assert!(limits.len() == 2 && limits[0].contains("0, now 1") && limits[1].contains("1, now 0"), "{log}");
}

/// The truss never comes up: the run fails by its `stop`, unless the deck does not require it.
#[test]
fn a_path_that_never_comes_to_its_stop_says_so() {
    let stop = "analysis.stop={ at = \"crown\", quantity = \"uz\", value = 0.2, pass = 2 }";
    let folder = folder(&snap_back());
    let run = |more: &[&str]| {
        let sets = ["ball.toml", "--overwrite", "--set", "analysis.least_step=1e-3", "--set", stop];
        rdsolve(folder.path(), &[&sets[..], more].concat()).code(5)
    };
    let read = |name: &str| std::fs::read_to_string(folder.path().join("ball.out").join(name)).unwrap();
    let words = "`stop` was not reached: uz of `crown` never reached 0.2 for pass 2, and is -";
    for (more, end) in [(&[][..], "t = 60,"), (&["--set", "analysis.steps=3"], "after 3 steps")] {
        let told = said(&run(more));
        assert!(told.starts_with(&format!("error: {words}")) && told.contains(end), "{told}");
        let log = read("run.log");
        assert!(log.lines().last().unwrap().starts_with(words), "{log}");
        let result: serde_json::Value = serde_json::from_str(&read("result.json")).unwrap();
        assert_eq!((&result["status"], &result["exit_code"]), (&"expectation-missed".into(), &5.into()));
        assert!(result["reason"].as_str().unwrap().starts_with(words), "{result}");
    }
    // Where the crown ends is in nodes.csv too.
    let nodes = read("nodes.csv");
    let crown = nodes.lines().rfind(|line| line.contains(",crown,")).unwrap();
    let uz = to_digits(crown.split(',').nth(8).unwrap().parse().unwrap(), 7);
    assert!(read("result.json").contains(&format!("and is {uz} at the end")), "{crown}");
    assert!(said(&run(&["--quiet"])).starts_with(&format!("error: {words}")));
    let allowed = stop.replace("pass = 2", "pass = 2, required = false");
    let done =
        rdsolve(folder.path(), &["ball.toml", "--overwrite", "--set", "analysis.least_step=1e-3", "--set", &allowed]);
    assert_eq!(said(&done.code(0)), "");
    assert!(read("run.log").contains(&format!("note: {words}")));
    // One that is reached leaves nothing to say; nor does a miss hide it.
    let reached = stop.replace("0.2, pass = 2", "-0.2");
    let done =
        rdsolve(folder.path(), &["ball.toml", "--overwrite", "--set", "analysis.least_step=1e-3", "--set", &reached]);
    assert_eq!(said(&done.code(0)), "");
    assert!(read("result.json").contains("\"reason\": \"\""));
    let expect = "[[expect]]\nat = \"crown\"\nquantity = \"uz\"\ntime = 60.0\nvalue = 1.0\ntolerance = 0.1\n";
    std::fs::write(folder.path().join("ball.toml"), snap_back() + expect).unwrap();
    let sets = ["ball.toml", "--overwrite", "--set", "analysis.least_step=1e-3", "--set", stop];
    let missed = said(&rdsolve(folder.path(), &sets).code(5));
    assert!(missed.contains("1 of 1 expected values missed; `stop` was not reached"), "{missed}");
}

/// The truss is plane, so that its crown never moves to the side: known before the run begins.
#[test]
fn a_passage_out_of_the_plane_is_an_error_of_the_deck() {
    let folder = folder(&snap_back());
    let stop = "stop = { at = \"crown\", quantity = \"uy\", value = 0.2 }\n[points]";
    let when = "[[expect]]\nat = \"analysis\"\nquantity = \"time\"\nvalue = 1.0\ntolerance = 0.1\n\
                when = { at = \"hand\", quantity = \"uy\", value = 0.1 }\n";
    let deck = snap_back().replace("[points]", stop) + when;
    std::fs::write(folder.path().join("ball.toml"), &deck).unwrap();
    for arguments in [&["ball.toml"][..], &["check", "ball.toml"]] {
        let told = said(&rdsolve(folder.path(), arguments).code(3));
        let errors = [
            "uy of `crown` never changes: the scene is plane, and this is normal to it\n --> ball.toml:8:35",
            "uy of `hand` never changes: nothing acts on it\n  --> ball.toml:36:34",
        ];
        assert!(errors.iter().all(|error| told.contains(error)), "{told}");
        assert!(told.contains("`ball.toml` has 2 errors"), "{told}");
    }
    // What is kept in the scene may move.
    let when = "expect.0.when.quantity=\"uz\"";
    rdsolve(folder.path(), &["check", "ball.toml", "--set", "analysis.plane=\"off\"", "--set", when]).code(0);
}

/// One bar that yields to and fro under a mass, at 0.9 of the longest step that is stable.
const YIELDING: &str = r#"
[analysis]
kind = "dynamic"
end_time = 40.0
time_step = 0.2546
[integrator]
scheme = "central-difference"
[materials.spring]
model = "elastic-plastic"
youngs_modulus = 5000.0
yield_stress = 6.0
[points]
wall = [0.0, 0.0, 0.0]
mass = [1000.0, 0.0, 0.0]
[[bars]]
name = "spring"
path = ["wall", "mass"]
material = "spring"
area = 1.0
mass = "none"
[[masses]]
at = "mass"
mass = 0.1
[[supports]]
at = "wall"
fix = "all"
[[supports]]
at = "mass"
fix = ["uy", "uz"]
[[initial]]
at = "mass"
velocity = [12.0, 0.0, 0.0]
"#;

/// Flow is booked with stresses that the motion has met only half of the step: it is not motion that is made. At a fiftieth of
/// the step the difference, of second order, is below what is told.
#[test]
fn what_plastic_flow_takes_too_much_of_is_called_so() {
    let folder = folder(YIELDING);
    let told = said(&rdsolve(folder.path(), &["ball.toml"]).code(0));
    assert!(told.contains("plastic flow has dissipated more energy than was available, by "), "{told}");
    assert!(told.contains("plastic strains are too large") && !told.contains("energy growth"), "{told}");
    let short = ["ball.toml", "--overwrite", "--set", "analysis.time_step=0.005"];
    assert_eq!(said(&rdsolve(folder.path(), &short).code(0)), "");
    // What makes steps shorter where they find their own length.
    let tolerated =
        ["analysis={kind=\"dynamic\",end_time=40.0,time_step=\"auto\",error_tolerance=0.5}", "integrator={}"];
    let stable = ["analysis.time_step=\"auto\"", "title=\"\""];
    for (sets, advice) in [(tolerated, "Give a tenth of `error_tolerance`"), (stable, "Give a number as `time_step`")] {
        let told =
            said(&rdsolve(folder.path(), &["ball.toml", "--overwrite", "--set", sets[0], "--set", sets[1]]).code(0));
        assert!(told.contains(advice), "{told}");
    }
}

/// Steps that find their own length are never shorter than the least: what refuses that ends the run, and does not advise what
/// is done already. The spring of 5 and the mass of 0.1 bear 2/√50 = 0.28.
#[test]
fn the_least_step_ends_steps_of_their_own_length() {
    let folder = folder(YIELDING);
    let least = |least: &str| {
        let least = format!("analysis.least_step={least}");
        let sets = ["analysis.time_step=\"auto\"", "analysis.end_time=100.0", &least];
        let sets = sets.iter().flat_map(|set| ["--set", *set]);
        let arguments: Vec<&str> = ["ball.toml", "--overwrite"].into_iter().chain(sets).collect();
        rdsolve(folder.path(), &arguments)
    };
    let told = said(&least("0.4").code(4));
    assert!(told.contains("a step of 4.000e-1 is too long for central differences"), "{told}");
    assert!(told.contains("Give `least_step` = 0.1414") && !told.contains("auto"), "{told}");
    least("0.2").code(0);
}

/// Velocities whose squares no double can hold.
#[test]
fn numbers_beyond_the_range_are_said_to_be_missing() {
    let deck = |velocity: &str| format!("{DECK}velocity = {velocity}\n");
    for velocity in ["[1e200, 0.0, 0.0]", "[0.0, -1e155, 2e155]"] {
        let folder = folder(&deck(velocity));
        let done = rdsolve(folder.path(), &["ball.toml"]).code(0);
        let said = said(&done);
        assert!(said.contains("empty in energy.csv") && said.contains("t = 0"), "{velocity}: {said}");
        let result = std::fs::read_to_string(folder.path().join("ball.out/result.json")).unwrap();
        assert!(result.contains("empty in energy.csv"), "{result}");
    }
    let folder = folder(&deck("[1e100, 0.0, 0.0]"));
    let done = rdsolve(folder.path(), &["ball.toml"]).code(0);
    assert!(!said(&done).contains("empty"), "{}", said(&done));
}

/// A bound in a stage is one of its extreme, which the inherited state may be; with `time = "end"` it is one of the value at the end, as after unloading.
#[test]
fn bounds_at_the_end() {
    let deck = |stages: bool, bound: &str| {
        let times = match stages {
            true => {
                "[[stages]]\nname = \"push\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n[[stages]]\nname = \"off\"\nkind = \"static\"\nduration = 1.0\n\
                 time_step = 0.5\n"
            }
            false => "[analysis]\nkind = \"static\"\nend_time = 2.0\ntime_step = 0.5\n",
        };
        format!(
            "{times}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[links]]\nname = \"k\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\n\
             law = \"linear\"\nstiffness = 100.0\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n\
             [[loads]]\nat = \"b\"\nforce = [2.0, 0.0, 0.0]\namplitude = \"up_down\"\n[amplitudes.up_down]\nkind = \"table\"\n\
             points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.25]]\n[[expect]]\nat = \"b\"\nquantity = \"ux\"\n{bound}\n"
        )
    };
    for (stages, bound, code) in [
        (false, "at_most = 0.01", 5),
        (false, "at_most = 0.01\ntime = \"end\"", 0),
        (false, "at_least = 0.01\ntime = \"end\"", 5),
        (true, "at_most = 0.01\nstage = \"off\"", 5),
        (true, "at_most = 0.01\nstage = \"off\"\ntime = \"end\"", 0),
        (true, "value = 0.005\ntolerance = 1e-6\nstage = \"off\"\ntime = \"end\"", 0),
        (true, "at_least = 0.01\nstage = \"push\"\ntime = \"end\"", 0),
    ] {
        let folder = folder(&deck(stages, bound));
        let code_found = rdsolve(folder.path(), &["ball.toml"]).get_output().status.code();
        assert_eq!(code_found, Some(code), "{stages} {bound}");
    }
    let folder = folder(&deck(false, "at_most = 0.01\ntime = \"last\""));
    assert!(said(&rdsolve(folder.path(), &["ball.toml"]).code(3)).contains("`time` cannot be `last`"));
}

/// A bound of the greatest absolute value is one of its size, whichever way the motion goes.
#[test]
fn bounds_of_the_greatest_absolute_value_are_of_its_size() {
    let deck = |force: f64, bound: &str| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.5\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[links]]\nname = \"k\"\n\
             from = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\nlaw = \"linear\"\nstiffness = 100.0\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
             [[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n[[loads]]\nat = \"b\"\nforce = [{force:?}, 0.0, 0.0]\n\
             [[expect]]\nat = \"b\"\nquantity = \"ux\"\npeak = \"abs\"\n{bound}\n"
        )
    };
    for force in [2.0, -2.0] {
        for (bound, code) in
            [("at_most = 0.01", 5), ("at_most = 0.03", 0), ("at_least = 0.01", 0), ("at_least = 0.03", 5)]
        {
            let folder = folder(&deck(force, bound));
            let code_found = rdsolve(folder.path(), &["ball.toml"]).get_output().status.code();
            assert_eq!(code_found, Some(code), "{force} {bound}");
        }
    }
}
