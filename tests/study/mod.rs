//! `rdsolve study`: orders against exact answers, the bar of its own reference, what failed, what it writes.

mod settings;

use crate::support;
use std::collections::HashMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use insta::assert_snapshot;
use tempfile::TempDir;

/// A mass of 2 kg on a spring of 200 N/m along x, pushed at 1 m/s: ω = 10/s, x = sin(ω t)/ω.
const OSCILLATOR: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.005

[[bodies]]
name = "mass"
center = [0.0, 0.0, 0.0]
mass = 2.0
inertia = [1.0, 1.0, 1.0]
velocity = [1.0, 0.0, 0.0]

[[supports]]
at = "mass"
fix = ["uy", "uz", "rx", "ry", "rz"]

[[links]]
name = "spring"
from = { ground = [0.0, 0.0, 0.0] }
to = { body = "mass" }
stiffness = 200.0
direction = [1.0, 0.0, 0.0]

[output]
energy = false
"#;

const KEYS: &str = r#"
[study]
quantities = ["mass.x", "mass.vx"]
reference = "exact.csv"
columns = { displacement = "mass.x" }
samples = 50
time_steps = [0.02, 0.01, 0.005, 0.0025]
schemes = ["newmark", "bathe"]
wanted_error = 1e-3
"#;

/// A strip that swings under its weight, with a stay; cheap.
const STRIP: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.2
time_step = 0.004

[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0

[sections.strip]
shape = "rectangle"
width = 0.030
height = 0.005

[points]
clamp = [0.0, 0.0, 0.0]
knee = [0.6, 0.0, 0.0]
tip = [1.0, 0.0, 0.0]
hook = [0.0, 0.0, 0.5]

[[beams]]
name = "root"
path = ["clamp", "knee"]
elements = 1
order = 2
material = "steel"
section = "strip"
orientation = [0.0, 1.0, 0.0]

[[beams]]
name = "end"
path = ["knee", "tip"]
elements = [1]
order = 2
material = "steel"
section = "strip"
orientation = [0.0, 1.0, 0.0]

[[bars]]
name = "stay"
path = ["hook", "knee"]
material = "steel"
area = 1e-6
mass = "none"

[[supports]]
at = "clamp"
fix = "all"

[[supports]]
at = "hook"
fix = ["ux", "uy", "uz"]

[environment]
gravity = [0.0, 0.0, -9.81]
"#;

fn folder(deck: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("x.toml"), deck).unwrap();
    folder
}

fn exact(folder: &Path) {
    let mut text = "t,displacement,mass.vx\n".to_owned();
    for k in 0..=50 {
        let t = f64::from(k) / 50.0;
        writeln!(text, "{t},{},{}", (10.0 * t).sin() / 10.0, (10.0 * t).cos()).unwrap();
    }
    fs::write(folder.join("exact.csv"), text).unwrap();
}

/// Standard output and standard error of a study.
fn study(folder: &Path, arguments: &[&str], code: i32) -> (String, String) {
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder).args(["study", "x.toml"]).args(arguments).assert().code(code);
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (text(&done.get_output().stdout), text(&done.get_output().stderr))
}

/// Rows of a table by the names of their columns.
fn table(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows: Vec<HashMap<String, String>> = reader.deserialize().map(Result::unwrap).collect();
    rows
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {:?}", row[column]))
}

#[test]
fn orders_are_found_against_an_exact_answer() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let (text, _) = study(folder.path(), &["--repeats", "1", "--quiet"], 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows.len(), 8);
    for row in rows.iter().filter(|row| !row["order"].is_empty()) {
        // The next term of the error is (ω h)²/10 of the first or less, so the local order is within 0.02 of 2 here.
        assert!((number(row, "order") - 2.0).abs() < 0.02, "{row:?}");
    }
    // The trapezoidal rule in closed form: its frequency is 2 atan(ω h/2)/h.
    for row in rows.iter().filter(|row| row["scheme"] == "newmark") {
        let h = number(row, "time_step");
        let slow = 2.0 * (5.0 * h).atan() / h;
        let (mut x, mut v, mut all, mut largest) = (0.0, 0.0, 0.0, 0.0f64);
        for k in 0..=50 {
            let t = f64::from(k) / 50.0;
            // v = v₀ cos, x = v₀/ω sin: the rule keeps the energy.
            let dx = (slow * t).sin() / 10.0 - (10.0 * t).sin() / 10.0;
            let dv = (slow * t).cos() - (10.0 * t).cos();
            x += dx * dx;
            v += dv * dv;
            all += dx * dx + dv * dv;
            largest = largest.max((10.0 * t).sin().powi(2) / 100.0 + (10.0 * t).cos().powi(2));
        }
        let largest_x = (0..=50).map(|k| (0.2 * f64::from(k)).sin().abs() / 10.0).fold(0.0, f64::max);
        for (column, expected) in [
            ("error", (all / 51.0 / largest).sqrt()),
            ("error:mass.x", (x / 51.0).sqrt() / largest_x),
            ("error:mass.vx", (v / 51.0).sqrt()),
        ] {
            // Steps end at a tolerance of 1e-8 of the residual; errors are 1e-4 and more.
            assert!((number(row, column) / expected - 1.0).abs() < 1e-3, "{column} at {h}: {row:?}, not {expected}");
        }
    }
    assert!(text.contains("newmark  2.00 over time steps 0.02 to 0.0025 (4 runs)"), "{text}");
    assert!(text.contains("cheapest for an error of 1e-3\n"), "{text}");
    assert!(text.contains("exact.csv; 2 quantities at 51 times"), "{text}");
}

#[test]
fn errors_are_those_that_runs_in_memory_have() {
    let name = "two_bodies_on_springs";
    let folder = tempfile::tempdir().unwrap();
    for file in ["deck.toml", "reference.csv"] {
        fs::copy(support::decks().join(name).join(file), folder.path().join(file)).unwrap();
    }
    fs::rename(folder.path().join("deck.toml"), folder.path().join("x.toml")).unwrap();
    study(folder.path(), &["--schemes", "wilson-theta,bathe", "--halvings", "2", "--repeats", "1", "--quiet"], 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows.len(), 6);
    for row in &rows {
        let sets = [format!("integrator.scheme={}", row["scheme"]), format!("analysis.time_step={}", row["time_step"])];
        let model = support::read(name, &sets);
        let bodies = ["a", "b"].map(|label| support::node(&model, label));
        let done = support::run_to_the_end(&model, &mut |frame| {
            let nodes = bodies.map(|body| &frame.state.nodes[body]);
            let [x, omega] = [support::position, support::body_omega].map(|of| nodes.map(of).concat());
            [x, omega].concat()
        });
        let error = support::error(&done.rows, &support::reference(name), 0);
        // The same numbers by way of quaternions in a table: round-off of them, against errors of 1e-4 and more.
        assert!((number(row, "error") / error - 1.0).abs() < 1e-9, "{row:?}, not {error}");
    }
}

#[test]
fn the_bar_of_its_own_reference_holds_the_true_error() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    for steps in ["0.02,0.01,0.005", "0.02,0.01,0.004,0.002", "0.02,0.01"] {
        let common = ["--repeats", "1", "--quiet", "--overwrite", "--time-steps", steps, "--schemes"];
        for schemes in ["newmark", "wilson-theta", "newmark,bathe,wilson-theta"] {
            study(folder.path(), &[&common[..], &[schemes, "-o", "true"]].concat(), 0);
            study(folder.path(), &[&common[..], &[schemes, "--finest", "-o", "own"]].concat(), 0);
            let [truth, own] = ["true", "own"].map(|name| table(&folder.path().join(name).join("study.csv")));
            let bar = number(&own[0], "reference_error");
            let finest = truth.iter().map(|row| number(row, "error")).fold(f64::MAX, f64::min);
            // Two steps tell nothing of the order, and their difference is three quarters of the coarser error.
            assert!(bar < 4.0 * finest, "{steps}, {schemes}: a bar of {bar} says nothing, {finest}");
            for (truth, own) in truth.iter().zip(&own) {
                let (error, found) = (number(truth, "error"), number(own, "error"));
                if own["resolved"] == "1" {
                    assert!((error - found).abs() <= bar, "{steps}, {schemes}: {error} and {found}, bar {bar}");
                } else {
                    assert!(error <= found + bar, "{steps}, {schemes}: {error} is not below {found}, bar {bar}");
                }
            }
        }
    }
}

#[test]
fn meshes_are_refined_with_the_steps() {
    let folder = folder(STRIP);
    let arguments = ["--meshes", "1,2,4", "--time-steps", "0.004,0.002,0.001", "--samples", "50", "--repeats", "1"];
    let (text, _) = study(folder.path(), &[&arguments[..], &["--quantities", "tip.uz", "--quiet"]].concat(), 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    let of = |mesh: &str, column: &str| -> Vec<f64> {
        rows.iter().filter(|row| row["mesh"] == mesh).map(|row| number(row, column)).collect()
    };
    assert!(of("1.0", "unknowns")[0] < of("2.0", "unknowns")[0]);
    assert!(of("1.0", "error")[2] > of("4.0", "error")[2], "{text}");
    assert!(text.contains("in the mesh"), "{text}");
    assert!(text.contains("mesh x 4"), "{text}");
    let half = ["--meshes", "0.5", "--quiet", "--overwrite"];
    assert_snapshot!("meshes", study(folder.path(), &half, 3).1);
}

#[test]
fn automatic_steps_are_lines_over_their_tolerances() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let arguments = ["--error-tolerances", "1e-2,1e-3,1e-4", "--schemes", "newmark", "--repeats", "1", "--quiet"];
    let (text, _) = study(folder.path(), &arguments, 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows.len(), 4 + 3);
    let automatic = &rows[4..];
    assert!(automatic.iter().all(|row| row["time_step"].is_empty() && row["status"] == "done"), "{text}");
    assert_eq!([0, 1, 2].map(|i| number(&automatic[i], "error_tolerance")), [1e-2, 1e-3, 1e-4]);
    assert!(automatic.windows(2).all(|pair| number(&pair[1], "error") < number(&pair[0], "error")), "{text}");
    assert!(text.contains("newmark, automatic") && text.contains("tol 0.001"), "{text}");
    // A deck whose step is automatic is studied over its tolerance; given steps replace step and tolerance.
    let deck = OSCILLATOR.replace("time_step = 0.005", "time_step = \"auto\"\nerror_tolerance = 1e-3");
    fs::write(folder.path().join("x.toml"), &deck).unwrap();
    let common = ["--repeats", "1", "--quiet", "--overwrite", "--samples", "20"];
    study(folder.path(), &common, 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!([0, 1, 2, 3].map(|i| number(&rows[i], "error_tolerance")), [1e-2, 1e-3, 1e-4, 1e-5]);
    study(folder.path(), &[&common[..], &["--time-steps", "0.01,0.005"]].concat(), 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert!(rows.len() == 2 && rows.iter().all(|row| row["status"] == "done"), "{rows:?}");
}

/// A scheme without parameters takes those of `[integrator]`, beside one of the same kind with others: in the run of that `[integrator]` has these.
#[test]
fn a_scheme_stands_beside_itself_with_other_parameters() {
    let keys = KEYS.replace(r#""newmark", "bathe""#, r#""generalized-alpha:spectral_radius=0.5", "generalized-alpha""#);
    let own = "[integrator]\nscheme = \"generalized-alpha\"\nspectral_radius = 0.9\n";
    let folder = folder(&format!("{OSCILLATOR}{own}{keys}"));
    exact(folder.path());
    let (text, _) = study(folder.path(), &["--repeats", "1", "--quiet"], 0);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert!(rows.len() == 8 && rows.iter().all(|row| row["status"] == "done"), "{text}");
    // The shorter radius damps more, and errs more.
    assert!(number(&rows[0], "error") > number(&rows[4], "error"), "{text}");
}

#[test]
fn runs_that_fail_are_listed_as_failed() {
    // The shortest step is refused; two iterations are too few for a strip that swings in long ones.
    let deck = STRIP.replace("time_step = 0.004", "time_step = 0.004\nleast_step = 0.0015\n[iteration]\nlimit = 2");
    let folder = folder(&deck);
    let (text, _) = study(
        folder.path(),
        &[
            "--time-steps",
            "0.02,0.002,0.001",
            "--samples",
            "10",
            "--repeats",
            "2",
            "--quiet",
            "--set",
            "iteration.limit=9",
        ],
        0,
    );
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows[2]["status"], "failed", "{text}");
    assert!(rows[2]["reason"].contains("`least_step` must not be above `time_step`"), "{text}");
    assert!(text.contains("failed: `least_step` must not be above"), "{text}");
    assert!(rows[2]["error"].is_empty() && rows[2]["loop_s"].is_empty());
    // One setting has an order with none.
    let folder = self::folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let refused = ["--set", "analysis.least_step=0.003", "--time-steps", "0.02,0.0025,0.00125", "--repeats", "1"];
    let (text, _) = study(folder.path(), &refused, 0);
    assert_eq!(text.matches("no order: no two settings next to each other came to their end").count(), 2, "{text}");
    let folder = self::folder(&deck);
    let (text, said) = study(folder.path(), &["--time-steps", "0.02", "--samples", "10", "-o", "none", "--quiet"], 4);
    assert!(text.contains("not-converged: at t = "), "{text}");
    assert!(text.contains("no reference: too few runs came to their end"), "{text}");
    assert_eq!(said, "error: no run completed: run the deck alone with `rdsolve run`, which prints the cause\n");
}

#[test]
fn files_are_whole() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}").replace("[analysis]", "title = \"<b> & 'x'\"\n[analysis]"));
    exact(folder.path());
    let (first, _) = study(folder.path(), &["--repeats", "2", "--quiet"], 0);
    let out = folder.path().join("x.study");
    let header = fs::read_to_string(out.join("study.csv")).unwrap();
    assert_eq!(
        header.lines().next().unwrap(),
        "run,scheme,method,iteration_tolerance,mesh,beam_order,unknowns,time_step,error_tolerance,status,error,resolved,order,reference_error,loop_s,loop_median_s,process_s,repeats,steps,\
         iterations,factorizations,cuts,other_runs,other_steps,other_iterations,other_factorizations,estimate,folder,reason,error:mass.x,error:mass.vx"
    );
    for row in table(&out.join("study.csv")) {
        assert_eq!((row["repeats"].as_str(), row["status"].as_str()), ("2", "done"));
        assert!(number(&row, "process_s") > number(&row, "loop_s"), "{row:?}");
        // A number reads back to itself.
        assert_eq!(number(&row, "time_step") * number(&row, "steps"), 1.0);
        assert!(out.join(&row["folder"]).join("result.json").is_file());
    }
    let picture = fs::read_to_string(out.join("study.svg")).unwrap();
    well_formed(&picture);
    assert_eq!(picture.matches("<polyline").count(), 2);
    // Four runs a line, and a mark in the legend.
    assert_eq!(picture.matches("<path").count(), 2 * (4 + 1));
    let page = fs::read_to_string(out.join("study.html")).unwrap();
    for word in ["http:", "https:", "src=", "@import", "url(", "<script", "<b>"] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.contains("&lt;b&gt; &amp; &#39;x&#39;") && page.trim_end().ends_with("</html>"));
    // The same answers a second time; only times differ.
    let numbers = |text: &str| text.lines().filter(|line| line.contains("over time steps")).map(String::from).collect();
    let (second, _) = study(folder.path(), &["--repeats", "1", "--quiet", "--overwrite"], 0);
    let [first, second]: [Vec<String>; 2] = [&first, &second].map(|text| numbers(text));
    assert_eq!(first, second);
    assert!(study(folder.path(), &[], 2).1.contains("the folder `x.study` holds files already"));
    let report = Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).args(["report", "x.study"]).assert();
    let said = String::from_utf8(report.code(6).get_output().stderr.clone()).unwrap();
    assert!(said.contains("a study, whose page is study.html there"), "{said}");
}

/// Every element that opens closes, in order.
fn well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    for piece in text.split('<').skip(1) {
        let tag = piece.split('>').next().unwrap();
        assert!(piece.contains('>'), "{piece}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().unwrap());
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_advisor_measures_what_rigid_parts_do() {
    let folder = folder(STRIP);
    let (text, _) = study(
        folder.path(),
        &[
            "--rigidify",
            "--recommend",
            "1e-2",
            "--samples",
            "50",
            "--repeats",
            "1",
            "--quiet",
            "--quantities",
            "tip.uz",
        ],
        0,
    );
    let rows = table(&folder.path().join("x.study/rigidify.csv"));
    let of = |name: &str| rows.iter().find(|row| row["part"] == name).unwrap();
    let shares: f64 = ["root", "end", "stay"].iter().map(|name| number(of(name), "mean_share")).sum();
    assert!((shares - 1.0).abs() < 1e-12, "{shares}");
    // The end beyond the knee carries its own weight alone; the root all.
    assert!(number(of("end"), "peak_share") < number(of("root"), "peak_share"), "{text}");
    assert!(number(of("end"), "unknowns") < number(of(""), "unknowns"));
    // The base and the run with a rigid end are those of the deck run by hand.
    let rigid = Command::cargo_bin("rdsolve")
        .unwrap()
        .current_dir(folder.path())
        .args(["x.toml", "--set", "beams.end.rigid=true", "--set", "output.interval=0.004", "-o", "hand", "--quiet"])
        .assert();
    rigid.code(0);
    let tip = |place: &str| -> Vec<f64> {
        let rows = table(&folder.path().join(place).join("nodes.csv"));
        rows.iter().filter(|row| row["node"] == "tip").map(|row| number(row, "uz")).collect()
    };
    let (hand, base) = (tip("hand"), tip("x.study/runs/as_it_is"));
    let square: f64 = hand.iter().zip(&base).map(|(a, b)| (a - b).powi(2)).sum();
    let largest = base.iter().fold(0.0f64, |most, u| most.max(u.abs()));
    let error = (square / base.len() as f64).sqrt() / largest;
    // The same bytes from the same deck, so the same error but for the rounding of the sum.
    assert!((number(of("end"), "error") / error - 1.0).abs() < 1e-12);
    assert!(of("stay")["reason"].contains("no inertia"), "{text}");
    // The elastic end keeps five modes and more, whose error falls below that of a rigid end.
    let forms: Vec<&str> = rows.iter().filter(|row| row["part"] == "end").map(|row| row["form"].as_str()).collect();
    assert_eq!(forms, ["rigid = true", "reduced = 5", "reduced = 10", "reduced = 20", "reduced = 40"]);
    let reduced = rows.iter().find(|row| row["part"] == "end" && row["form"] == "reduced = 20").unwrap();
    assert!(number(reduced, "error") < number(of("end"), "error"), "{text}");
    assert!(text.contains("for an error of 1e-2") && text.contains("bar `stay`: no other form was measured"), "{text}");
    assert!(text.contains("(as it is)"), "{text}");
}

#[test]
fn elastic_energies_of_parts_are_those_of_the_whole() {
    let folder = folder(&format!("{STRIP}\n[output]\nparts = true\n"));
    Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).args(["x.toml", "--quiet"]).assert().code(0);
    let out = folder.path().join("x.out");
    let whole = table(&out.join("energy.csv"));
    let parts = table(&out.join("parts.csv"));
    assert_eq!(parts.len(), 3 * whole.len());
    assert_eq!(["root", "end", "stay"], [0, 1, 2].map(|i| parts[i]["part"].as_str()));
    assert_eq!(["beam", "beam", "bar"], [0, 1, 2].map(|i| parts[i]["kind"].as_str()));
    for (k, row) in whole.iter().enumerate() {
        let sum: f64 = parts[3 * k..3 * k + 3].iter().map(|part| number(part, "strain")).sum();
        // Three terms, summed in another order.
        assert!((sum - number(row, "strain")).abs() <= 1e-14 * sum.abs(), "{sum} {row:?}");
    }
}

/// A study that goes on by itself for minutes, by a shell that does something before.
#[cfg(unix)]
fn going_on(folder: &Path, before: &str, arguments: &str) -> std::process::Child {
    let program = assert_cmd::cargo::cargo_bin("rdsolve");
    std::process::Command::new("sh")
        .current_dir(folder)
        .args(["-c", &format!("{before} exec '{}' study x.toml --quiet {arguments}", program.display())])
        .stdin(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap()
}

#[cfg(unix)]
fn send(signal: &str, child: &std::process::Child) {
    assert!(std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

/// Whether something comes to be within twenty seconds.
fn comes(what: impl Fn() -> bool) -> bool {
    (0..2000).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(10));
        what()
    })
}

#[test]
#[cfg(unix)]
fn a_signal_ends_it_with_what_there_is() {
    for (before, signals) in [("", &["-TERM"][..]), ("", &["-HUP"]), ("trap '' HUP;", &["-HUP", "-TERM"])] {
        let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
        exact(folder.path());
        let mut child = going_on(folder.path(), before, "--repeats 1000 --budget 1000");
        let first = folder.path().join("x.study/runs/8/result.json");
        assert!(comes(|| first.exists()));
        let (last, others) = signals.split_last().unwrap();
        for signal in others {
            send(signal, &child);
            // Ignored as under nohup: runs come and go as before.
            let written = || fs::metadata(&first).and_then(|found| found.modified()).ok();
            let before = written();
            assert!(comes(|| written() > before));
            assert!(child.try_wait().unwrap().is_none());
        }
        send(last, &child);
        assert_eq!(child.wait().unwrap().code(), Some(75), "{signals:?}");
        let rows = table(&folder.path().join("x.study/study.csv"));
        assert!((7..=8).contains(&rows.len()), "{}", rows.len());
        assert!(fs::read_to_string(folder.path().join("x.study/study.html")).unwrap().contains("stopped by a signal"));
    }
}

/// What nothing can catch: the run sees that its study is gone.
#[test]
#[cfg(target_os = "linux")]
fn a_study_that_is_killed_leaves_no_run_behind() {
    // Runs that end by themselves say nothing: a hundred million steps do not, here.
    let long = OSCILLATOR.replace("end_time = 1.0", "end_time = 10000.0");
    let folder = folder(&long);
    let mut child = going_on(folder.path(), "", "--time-steps 1e-4 --samples 2");
    let runs = || {
        let here = fs::canonicalize(folder.path()).unwrap();
        let processes = fs::read_dir("/proc").unwrap().filter_map(|entry| Some(entry.ok()?.path()));
        let in_folder = processes.filter(|process| fs::read_link(process.join("cwd")).is_ok_and(|cwd| cwd == here));
        in_folder.filter(|process| !process.ends_with(child.id().to_string())).count()
    };
    let started = folder.path().join("x.study/runs/1/steps.csv");
    assert!(comes(|| started.exists()) && runs() == 1);
    send("-KILL", &child);
    let gone = comes(|| runs() == 0);
    child.wait().unwrap();
    assert!(gone, "the run goes on");
}

#[test]
fn an_older_study_is_cleared_away() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let steps =
        |list: &str| study(folder.path(), &["--time-steps", list, "--repeats", "1", "--quiet", "--overwrite"], 0);
    steps("0.02,0.01,0.005,0.0025");
    let at = |name: &str| folder.path().join("x.study").join(name);
    // What no study has written stays, wherever it lies.
    let own =
        ["notes.txt", "runs/7/notes.txt", "runs/mine/result.json", "runs/04b/result.json", "runs/rigid_x/steps.csv"];
    for name in own {
        fs::create_dir_all(at(name).parent().unwrap()).unwrap();
        fs::write(at(name), "mine").unwrap();
    }
    // Left by a run that was killed.
    fs::write(at("runs/8/result.json.tmp"), "old").unwrap();
    steps("0.02,0.01");
    assert!(at("study.csv").exists() && at("runs/4/result.json").exists());
    assert!(own.iter().all(|name| fs::read_to_string(at(name)).unwrap() == "mine"));
    assert_eq!(fs::read_dir(at("runs/7")).unwrap().count(), 1);
    for name in ["runs/5", "runs/8"] {
        assert!(!at(name).exists(), "{name}");
    }
    // The advisor's runs are others.
    fs::write(folder.path().join("x.toml"), STRIP).unwrap();
    study(folder.path(), &["--rigidify", "--repeats", "1", "--quiet", "--overwrite"], 0);
    assert!(at("rigidify.csv").exists() && at("runs/as_it_is/result.json").exists());
    for name in ["runs/1", "runs/2", "study.csv", "study.html", "study.svg"] {
        assert!(!at(name).exists(), "{name}");
    }
}

/// Names alone do not make a run or a table a study's: what is in the way is named, and all stays as it was.
#[test]
fn what_no_study_wrote_stays() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let rdsolve = |arguments: &[&str]| {
        Command::cargo_bin("rdsolve").unwrap().current_dir(folder.path()).args(arguments).assert().code(0);
    };
    let at = |name: &str| folder.path().join(name);
    rdsolve(&["run", "x.toml", "--quiet", "-o", "runs/2024"]);
    let arguments = |list| ["--time-steps", list, "--repeats", "1", "--quiet", "--overwrite", "-o", "."];
    let four = || study(folder.path(), &arguments("0.02,0.01"), 0);
    let mine = |name: &str| assert_eq!(fs::read_to_string(at(name)).unwrap(), "mine");
    let refused = |name: &str, arguments: &[&str]| {
        let (_, said) = study(folder.path(), arguments, 6);
        assert!(said.contains(&format!("`./{name}` was not written by a study there")), "{said}");
    };
    // A folder that never held a study.
    for name in ["study.csv", "study.list"] {
        fs::write(at(name), "mine").unwrap();
        refused(name, &arguments("0.02,0.01"));
        mine(name);
        fs::remove_file(at(name)).unwrap();
    }
    fs::create_dir(at("runs/3")).unwrap();
    fs::write(at("runs/3/nodes.csv"), "mine").unwrap();
    refused("runs/3", &arguments("0.02,0.01"));
    mine("runs/3/nodes.csv");
    fs::rename(at("runs/3"), at("runs/7")).unwrap();
    // Out of the way; and beside a study, which is cleared away.
    four();
    fs::write(at("rigidify.csv"), "mine").unwrap();
    four();
    assert!(at("runs/4/result.json").exists() && at("runs/2024/result.json").exists());
    refused("runs/7", &arguments("0.02,0.01,0.005,0.0025"));
    fs::write(at("x.toml"), STRIP).unwrap();
    refused("rigidify.csv", &["--rigidify", "--repeats", "1", "--quiet", "--overwrite", "-o", "."]);
    // Nothing of the study has gone either.
    assert!(at("study.csv").exists() && at("runs/1/result.json").exists());
    mine("runs/7/nodes.csv");
    mine("rigidify.csv");
}

/// `a.v1.toml` and `a.v2.toml` are two decks.
#[test]
fn the_folder_has_the_whole_name_of_the_deck() {
    let folder = folder(OSCILLATOR);
    for name in ["a.v1", "a.v2"] {
        fs::copy(folder.path().join("x.toml"), folder.path().join(format!("{name}.toml"))).unwrap();
    }
    for name in ["a.v1", "a.v2"] {
        let rdsolve = || Command::cargo_bin("rdsolve").unwrap();
        let deck = format!("{name}.toml");
        rdsolve().current_dir(folder.path()).args(["run", &deck, "--quiet"]).assert().code(0);
        let study = ["study", &deck, "--quiet", "--time-steps", "0.02,0.01", "--samples", "50", "--repeats", "1"];
        rdsolve().current_dir(folder.path()).args(study).assert().code(0);
        assert!(folder.path().join(format!("{name}.out/result.json")).exists());
        assert!(folder.path().join(format!("{name}.study/runs/2/result.json")).exists());
    }
}

#[test]
fn wrong_keys_are_said_all_at_once() {
    let keys = r#"
[study]
quantities = ["mass.xx", "mas.x", "mass", "mass.x", "mass.x", "spring.force"]
columns = { a = "mass.y" }
samples = 0
time_steps = [0.1, -0.01]
halvings = 3
finest = 1
schemes = ["newmrk", "newmark:gamma=0.4", "newmark:gama=0.6", "bathe:0.5", { theta = 1.4 }, "bathe", "bathe", "bathe:theta=2"]
methods = ["auto", "aut"]
meshes = []
wanted_eror = 1e-3
"#;
    let folder = folder(&format!("{OSCILLATOR}{keys}"));
    let (text, said) = study(folder.path(), &[], 3);
    assert!(text.is_empty());
    assert_snapshot!("deck", said);
    assert!(!folder.path().join("x.study").exists());
}

#[test]
fn wrong_options_are_said_in_their_own_words() {
    let folder = folder(OSCILLATOR);
    let options = ["--schemes", "newmark,bath,hht-alpha:alpha=0.3", "--quantities", "mass.q", "--methods", "both"];
    assert_snapshot!("options", study(folder.path(), &options, 2).1);
    assert_snapshot!("long_step", study(folder.path(), &["--time-steps", "0.3", "--samples", "10"], 2).1);
    for options in [&["--time-steps", "0"][..], &["--halvings", "0"], &["--repeats", "0"], &["--wanted-error", "x"]] {
        study(folder.path(), options, 2);
    }
    study(folder.path(), &["--rigidify", "--schemes", "bathe"], 2);
    assert!(study(folder.path(), &["--reference", "nowhere.csv"], 6).1.contains("nowhere.csv"));
}

#[test]
fn wrong_references_are_said() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    let (path, arguments) = (folder.path().join("exact.csv"), ["--quiet", "--overwrite"]);
    let said = |text: Option<&str>| {
        text.iter().for_each(|text| fs::write(&path, text).unwrap());
        study(folder.path(), &arguments, 3).1
    };
    assert_snapshot!("no_reference", said(None));
    assert_snapshot!("no_column", said(Some("t,displacment,v\n0,0,1\n")));
    assert_snapshot!("no_time", said(Some("displacement,mass.vx\n0,1\n")));
    assert_snapshot!("no_number", said(Some("t,displacement,mass.vx\n0,0,1\n0.02,,0.9\n")));
    // The line is the file's own, whatever is blank or quoted before it; a column may be missing besides.
    let many = "\u{feff}time,displacement,note\n\n0,nan,\"a\nb\"\r\n\n0.02,0.1\n 0.02 , 1e999,\"c\"\n0.01,0.1,\n0.03\n";
    assert_snapshot!("many_faults", said(Some(many)));
    assert_snapshot!("empty", said(Some("")));
    let lines: String = (0..30).map(|k| format!("{k},x,0\n")).collect();
    let said_of_many = said(Some(&format!("t,displacement,mass.vx\n{lines}")));
    assert_eq!(said_of_many.matches("no finite number").count(), 20);
    assert!(said_of_many.contains("may have more errors; correct these first"), "{said_of_many}");
    assert_snapshot!("last_row", said(Some("t,displacement,mass.vx\n0,0,1\n0.5,0.1,0.9\n\n")));
    assert_snapshot!("no_row", said(Some("t,displacement,mass.vx\n0,0,1\n0.02,0.1,0.9\n")));
    let rigid = study(folder.path(), &["--rigidify", "--overwrite"], 3).1;
    assert!(rigid.contains("the deck has no part that deforms"), "{rigid}");
}

// Central differences on the oscillator are stable up to 2/ω = 0.2.
#[test]
fn runs_whose_steps_were_made_alike_say_nothing_of_each_other() {
    let folder = folder(&format!("{OSCILLATOR}\n[integrator]\nscheme = \"central-difference\"\n"));
    let common = ["--repeats", "1", "--quiet", "--overwrite", "--quantities", "mass.x"];
    let of = |arguments: &[&str]| study(folder.path(), &[&common[..], arguments].concat(), 0).0;
    // Steps of 0.5 and of 0.25 are both cut, to the same; 0.02 and 0.01 are not.
    let text = of(&["--samples", "2", "--time-steps", "0.5,0.25"]);
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert_eq!(rows[0]["steps"], rows[1]["steps"], "{text}");
    assert!(text.contains("no reference: no two runs of a line differ: steps are as long as samples"), "{text}");
    let text = of(&["--samples", "2", "--time-steps", "0.5,0.25,0.02,0.01"]);
    assert!(text.contains("its own error is at most about"), "{text}");
    // Tolerances so loose that all steps are as long as the samples allow.
    let newmark = ["--schemes", "newmark", "--error-tolerances", "0.9,0.5", "--samples", "1000"];
    let text = of(&newmark);
    assert!(text.contains("no two runs of a line differ"), "{text}");
    let rows = table(&folder.path().join("x.study/study.csv"));
    assert!(rows.iter().all(|row| row["status"] == "done" && row["error"].is_empty()), "{rows:?}");
}

#[test]
fn why_there_is_no_reference_is_said() {
    let folder = folder(OSCILLATOR);
    let common = ["--repeats", "1", "--quiet", "--overwrite", "--samples", "10"];
    let of = |arguments: &[&str]| study(folder.path(), &[&common[..], arguments].concat(), 0).0;
    let text = of(&["--time-steps", "0.01"]);
    assert!(text.contains("no reference: each line has one run: take two time steps or more"), "{text}");
    // Beside one fixed step, automatic ones tell the limit.
    let text = of(&["--time-steps", "0.01", "--error-tolerances", "1e-2,1e-3,1e-4", "--schemes", "newmark"]);
    assert!(text.contains("the finest runs of newmark, automatic, "), "{text}");
    let spin = OSCILLATOR.replace("velocity = [1.0, 0.0, 0.0]", "angular_velocity = [1.0, 0.0, 0.0]");
    let spin = spin.replace("\"uz\", \"rx\", \"ry\"", "\"uz\", \"ry\"");
    fs::write(folder.path().join("x.toml"), spin).unwrap();
    let text = of(&["--time-steps", "0.02,0.01"]);
    assert!(text.contains("nothing moves") && text.contains("`quantities = [\"mass.body_wx\"]`"), "{text}");
}

#[test]
fn what_no_run_could_do_is_refused_before_any() {
    let folder = folder(
        &OSCILLATOR
            .replace("0.005", "\"auto\"")
            .replace("[[bodies]]", "[integrator]\nscheme = \"central-difference\"\n[[bodies]]"),
    );
    let said = study(folder.path(), &[], 3).1;
    assert!(said.contains("`central-difference` has no error tolerance:"), "{said}");
    study(folder.path(), &["--time-steps", "0.02,0.01", "--samples", "50", "--repeats", "1", "--quiet"], 0);
    let said = study(folder.path(), &["--schemes", "newmark:gamma=0.6", "--overwrite"], 3).1;
    assert!(said.contains("`newmark:gamma=0.6` is of first order"), "{said}");
    fs::write(folder.path().join("x.toml"), STRIP.replace("\"dynamic\"", "\"static\"")).unwrap();
    let said = study(folder.path(), &["--error-tolerances", "1e-3", "--overwrite"], 3).1;
    assert!(said.contains("error tolerances are about steps in time"), "{said}");
    let plastic = STRIP.replace("model = \"elastic\"", "model = \"elastic-plastic\"\nyield_stress = 235e6");
    fs::write(folder.path().join("x.toml"), plastic).unwrap();
    let said = study(folder.path(), &["--schemes", "runge-kutta", "--overwrite"], 2).1;
    assert!(said.contains("does not go with material that yields"), "{said}");
    fs::write(folder.path().join("x.toml"), STRIP.replace("order = 2", "order = 2\nmass = \"none\"")).unwrap();
    let said = study(folder.path(), &["--schemes", "bathe,central-difference", "--overwrite"], 3).1;
    assert!(said.contains("has no mass in direction"), "{said}");
}

#[test]
fn quantities_of_the_command_leave_columns_aside() {
    let folder = folder(&format!("{OSCILLATOR}{KEYS}"));
    exact(folder.path());
    let (text, _) = study(folder.path(), &["--quantities", "mass.vx", "--repeats", "1", "--quiet"], 0);
    assert!(text.contains("exact.csv; 1 quantity at 51 times"), "{text}");
    let (text, _) = study(folder.path(), &["--quantities", "mass.x", "--repeats", "1", "--quiet", "--overwrite"], 0);
    assert!(text.contains("exact.csv; 1 quantity at 51 times"), "{text}");
}

#[test]
fn the_advisor_says_nothing_against_a_base_that_did_not_end() {
    // One iteration is too few for a strip that deforms.
    let folder = folder(&format!("{STRIP}\n[iteration]\nlimit = 1\n"));
    let arguments = ["--rigidify", "--samples", "50", "--repeats", "2", "--quiet"];
    let (text, _) = study(folder.path(), &arguments, 4);
    assert!(!text.contains('%') && text.contains("(as it is)"), "{text}");
    let rows = table(&folder.path().join("x.study/rigidify.csv"));
    assert!(rows.iter().all(|row| row["peak_share"].is_empty() && row["mean_share"].is_empty()), "{rows:?}");
}
