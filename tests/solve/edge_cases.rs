//! Scenes at the edge: each runs, or ends soon with a message that names the thing and the exit code of the interface.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How a run ended.
struct Ended {
    code: i32,
    /// Standard error.
    said: String,
    folder: PathBuf,
    _dir: tempfile::TempDir,
}

impl Ended {
    fn result(&self) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.folder.join("result.json")).unwrap()).unwrap()
    }

    /// Rows of a table as numbers by column, of one name.
    fn column(&self, table: &str, name: &str, column: &str) -> Vec<f64> {
        let mut reader = csv::Reader::from_path(self.folder.join(table)).unwrap();
        let at = reader.headers().unwrap().iter().position(|h| h == column).unwrap();
        let rows = reader.records().map(Result::unwrap);
        rows.filter(|row| name.is_empty() || &row[2] == name).map(|row| row[at].parse().unwrap()).collect()
    }

    fn last(&self, name: &str, column: &str) -> f64 {
        *self.column("nodes.csv", name, column).last().unwrap()
    }

    #[track_caller]
    fn assert(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, code, "{}", self.said);
        for word in words {
            assert!(self.said.contains(word), "`{word}` is missing: {}", self.said);
        }
    }
}

fn command(deck: &Path, folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rdsolve"));
    command.arg("run").arg(deck).args(["--quiet", "--threads", "1", "-o"]).arg(folder);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Waits, but not for ever: no scene here may take longer than this.
fn wait(mut child: Child) -> (i32, String) {
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed() > Duration::from_secs(30) {
            child.kill().unwrap();
            panic!("still running after 30 s");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

fn run(deck: impl Display) -> Ended {
    let dir = tempfile::tempdir().unwrap();
    let (path, folder) = (dir.path().join("deck.toml"), dir.path().join("out"));
    std::fs::write(&path, deck.to_string()).unwrap();
    let (code, said) = wait(command(&path, &folder).spawn().unwrap());
    Ended { code, said, folder, _dir: dir }
}

fn dynamic(end_time: f64, time_step: f64) -> String {
    format!("[analysis]\nkind = \"dynamic\"\nend_time = {end_time}\ntime_step = {time_step}\n")
}

const STATIC: &str = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n";

/// A steel strip from `clamp` to `tip`, with more keys.
fn strip(more: &str) -> String {
    format!(
        r#"
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
tip = [1.0, 0.0, 0.0]

[[beams]]
name = "beam"
path = ["clamp", "tip"]
elements = 4
material = "steel"
section = "strip"
orientation = [0.0, 1.0, 0.0]
{more}
"#
    )
}

const CLAMP: &str = "\n[[supports]]\nat = \"clamp\"\nfix = \"all\"\n";
const GRAVITY: &str = "\n[environment]\ngravity = [0.0, 0.0, -9.81]\n";
const BLOCK: &str = r#"
[[bodies]]
name = "block"
center = [1.1, 0.05, 0.0]
mass = 2.0
inertia = [0.02, 0.01, 0.015]
"#;
const ON_TIP: &str = "\n[[attachments]]\nbody = \"block\"\nnodes = [\"tip\"]\n";

fn pull(force: f64) -> String {
    format!("\n[[loads]]\nat = \"tip\"\nforce = [0.0, 0.0, {force:?}]\n")
}

#[test]
fn missing_supports_are_named() {
    let ended = run(format!("{STATIC}{}{}", strip(""), pull(-1.0)));
    ended.assert(4, &["singular at `", "in direction", "a support is missing"]);
    assert_eq!(ended.column("nodes.csv", "tip", "time"), [0.0], "t = 0 is there");
    let result = ended.result();
    assert_eq!((&result["status"], &result["exit_code"]), (&"not-converged".into(), &4.into()));
    assert!(result["reason"].as_str().unwrap().contains("singular at `"));
}

/// Two bars nearly in line hold their joint in the plane only.
#[test]
fn a_mechanism_is_named() {
    let bars = r#"
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [2.0, 0.5, 0.0]

[[bars]]
name = "rope"
path = ["a", "b", "c"]
axial_stiffness = 1e5

[[supports]]
at = ["a", "c"]
fix = "translations"

[[loads]]
at = "b"
force = [0.0, 0.0, 1.0]
"#;
    run(format!("{STATIC}{bars}")).assert(4, &["singular at `b` in direction uz"]);
}

#[test]
fn a_mass_that_nothing_holds_falls_and_has_no_static_answer() {
    let point = "[points]\np = [0.0, 0.0, 0.0]\n\n[[masses]]\nat = \"p\"\nmass = 1.0\n";
    run(format!("{STATIC}{point}{GRAVITY}")).assert(4, &["singular at `p` in direction uz"]);
    let ended = run(format!("{}{point}{GRAVITY}", dynamic(0.1, 0.001)));
    ended.assert(0, &[]);
    assert!((ended.last("p", "uz") + 0.5 * 9.81 * 0.01).abs() < 1e-15); // the scheme is exact under a constant force
}

#[test]
fn a_free_body_without_load_stays_or_flies() {
    let ended = run(format!("{}{BLOCK}", dynamic(0.1, 0.001)));
    ended.assert(0, &[]);
    assert!(ended.column("bodies.csv", "block", "x").iter().all(|&x| x == 1.1));
    let moving = "velocity = [1.0, 2.0, 3.0]\nangular_velocity = [1.0, 2.0, 3.0]\n";
    let ended = run(format!("{}{BLOCK}{moving}", dynamic(0.1, 0.001)));
    ended.assert(0, &[]);
    let x = ended.column("bodies.csv", "block", "x");
    assert!((x.last().unwrap() - 1.2).abs() < 1e-14);
}

#[test]
fn a_body_on_one_node_and_massless_beams_run() {
    for mass in ["", "mass = \"none\""] {
        let ended = run(format!("{}{}{BLOCK}{ON_TIP}{CLAMP}{GRAVITY}", dynamic(0.1, 0.001), strip(mass)));
        ended.assert(0, &[]);
        assert!((-0.049..-0.03).contains(&ended.last("tip", "uz")), "falls, less than freely");
    }
    // Nothing has mass: the beam follows its load as in statics, F L³/3EI = 5.08 mm.
    let ended = run(format!("{}{}{CLAMP}{}", dynamic(0.1, 0.001), strip("mass = \"none\""), pull(-1.0)));
    ended.assert(0, &[]);
    assert!((ended.last("tip", "uz") + 5.08e-3).abs() < 1e-5, "{}", ended.last("tip", "uz"));
}

/// Directions without inertia that lie aslant: sections without polar inertia, and an arm with masses on its end only.
#[test]
fn singular_masses_start_from_rest() {
    let thin = r#"
[sections.thin]
shape = "general"
axial_stiffness = 1e6
shear_stiffness = [4e5, 4e5]
torsional_stiffness = 100.0
bending_stiffness = [200.0, 200.0]
mass_per_length = 1.0
inertia_per_length = [0.0, 0.01, 0.01]

[points]
clamp = [0.0, 0.0, 0.0]
tip = [1.0, 0.7, 0.3]

[[beams]]
name = "beam"
path = ["clamp", "tip"]
elements = 4
section = "thin"
orientation = [0.0, 1.0, 0.0]
"#;
    let ended = run(format!("{}{thin}{CLAMP}{GRAVITY}", dynamic(0.1, 0.001)));
    ended.assert(0, &[]);
    assert!((-0.049..-0.01).contains(&ended.last("tip", "uz")), "{}", ended.last("tip", "uz"));
    let arm = strip("rotary_inertia = false\norder = 1\noffset_end = [0.1, 0.2, 0.3]\n");
    let ended = run(format!("{}{arm}{CLAMP}{GRAVITY}", dynamic(0.1, 0.001)));
    ended.assert(0, &[]);
    assert!((-0.06..-0.01).contains(&ended.last("tip", "uz")), "{}", ended.last("tip", "uz"));
}

#[test]
fn inertia_about_no_axis_is_refused_with_a_reason() {
    for inertia in ["[-1e-9, 0.1, 0.1]", "[0.0, 0.0, 0.0]", "[0.0, 0.0, 0.1]"] {
        let body = BLOCK.replace("[0.02, 0.01, 0.015]", inertia);
        run(format!("{}{body}", dynamic(0.1, 0.001))).assert(3, &["`inertia` must have two positive principal"]);
    }
}

/// A straight rod along (½, −½, √½) has no inertia about itself, which rounding makes −1e-17 of 0.1; along a global axis it is zero.
#[test]
fn a_straight_rod_may_have_no_inertia_about_itself() {
    let oblique = "[0.07499999995804922, 0.07499999995804922, 0.050000000083901576, 0.025000000041950788, 0.03535533905932738, \
                   -0.03535533905932738]";
    for inertia in ["[0.0, 0.1, 0.1]", oblique] {
        let body = BLOCK.replace("[0.02, 0.01, 0.015]", inertia);
        run(format!("{}{body}", dynamic(0.1, 0.001))).assert(0, &[]);
    }
}

#[test]
fn decks_that_make_no_sense_are_errors_in_their_own_words() {
    let time = dynamic(0.1, 0.001);
    let flat = strip("").replace("tip = [1.0, 0.0, 0.0]", "tip = [0.0, 0.0, 0.0]");
    run(format!("{time}{flat}{CLAMP}")).assert(3, &["segment `clamp` - `tip` has no length"]);
    let along = strip("").replace("orientation = [0.0, 1.0, 0.0]", "orientation = [-2.0, 0.0, 0.0]");
    run(format!("{time}{along}{CLAMP}")).assert(3, &["`orientation` is parallel to segment `clamp` - `tip`"]);
    let other = BLOCK.replace("block", "other").replace("1.1", "2.1");
    let on = |body: &str, node: &str| format!("\n[[attachments]]\nbody = \"{body}\"\nnodes = [\"{node}\"]\n");
    let ring = format!("{time}{BLOCK}{other}{}{}", on("block", "other"), on("other", "block"));
    run(ring).assert(3, &["go round in a circle: `other` on `block` on `other`"]);
    let lone = strip("").replace("tip = [", "lone = [3.0, 0.0, 0.0]\ntip = [");
    let load = "\n[[loads]]\nat = \"lone\"\nforce = [1.0, 0.0, 0.0]\n";
    run(format!("{time}{lone}{CLAMP}{load}"))
        .assert(3, &["nothing is connected to `lone`, so this load acts on nothing"]);
    let shake = "\n[environment]\nbase_acceleration = [{ direction = [0.0, 0.0, 1.0], amplitude = \"one\" }]\n\
                 [amplitudes.one]\nkind = \"constant\"\n";
    let light = strip("").replace("density = 7850.0\n", "");
    run(format!("{STATIC}{light}{CLAMP}{shake}")).assert(3, &["material `steel` has no density"]);
    run(format!("{}{}{CLAMP}", dynamic(0.1, 1e-300), strip(""))).assert(3, &["`time_step` asks for 1.0e299 steps"]);
    let often = "\n[output]\ninterval = 1e-12\n";
    run(format!("{time}{}{CLAMP}{often}", strip(""))).assert(3, &["`interval` asks for 1.0e11 rows"]);
}

/// A support rests where links of other stages alone end; one that moves the node would leave it behind, and is an error.
#[test]
fn supports_at_ends_of_links_of_other_stages() {
    let stage =
        |name: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n");
    let beam = strip("").replace("tip = [", "far = [3.0, 0.0, 0.0]\ntip = [");
    let link = "[[links]]\nname = \"k\"\nfrom = { node = \"tip\" }\nto = { node = \"far\" }\nstiffness = 1e5\nstages = \"a\"\n";
    let deck = |support: &str| {
        format!("{}{}{beam}{CLAMP}\n{link}[[supports]]\nat = \"far\"\n{support}\n", stage("a"), stage("b"))
    };
    run(deck("fix = [\"ux\", \"uy\", \"uz\"]")).assert(0, &[]);
    let moves = "fix = [\"uy\", \"uz\"]\nmotion = { ux = { scale = 1e-3 } }";
    let why = "links and joints of other stages end there: `stages` beside it can name theirs";
    run(deck(moves)).assert(3, &["nothing is connected to `far`, so this support acts on nothing", why]);
    let load = "fix = [\"uy\", \"uz\"]\n[[loads]]\nat = \"far\"\nforce = [1.0, 0.0, 0.0]";
    run(deck(load)).assert(3, &["nothing is connected to `far`, so this load acts on nothing", why]);
    run(deck(&format!("{moves}\nstages = \"a\""))).assert(0, &[]);
}

#[test]
fn no_load_is_no_motion() {
    for analysis in [STATIC.to_string(), dynamic(0.1, 0.001)] {
        let ended = run(format!("{analysis}{}{CLAMP}{}", strip(""), pull(0.0)));
        ended.assert(0, &[]);
        assert!(ended.column("nodes.csv", "tip", "ux").iter().all(|u| u.abs() < 1e-12)); // roundings of x = 1, swinging
    }
}

/// A strip that carries 10 N under up to 10³⁰⁰: an answer or a failure that names where, soon; numbers everywhere.
#[test]
fn loads_beyond_reason_end_soon() {
    for force in [1e7, 1e12, 1e160, 1e300] {
        for analysis in [STATIC.to_string(), dynamic(0.1, 0.001)] {
            let ended = run(format!("{analysis}{}{CLAMP}{}", strip(""), pull(-force)));
            let z = ended.column("nodes.csv", "tip", "z");
            assert!(z.iter().all(|z| z.is_finite()));
            match ended.code {
                0 => assert!(force < 1e9 && *z.last().unwrap() < -1.0, "{force:e}: the strip follows its load: {z:?}"),
                _ => {
                    ended.assert(4, &["error: at t = "]);
                    let named = ["the largest unbalanced forces are", "cut into 1024 substeps", "is singular at `"];
                    assert!(named.iter().any(|words| ended.said.contains(words)), "{}", ended.said);
                    assert_eq!(ended.result()["status"], "not-converged");
                }
            }
        }
    }
}

/// 10⁴ times the step that would follow the motion, which is cut: what is left at the end swings about the deflection at
/// rest or has come to it.
#[test]
fn a_step_far_too_long_ends() {
    let ended = run(format!("{}{}{BLOCK}{ON_TIP}{CLAMP}{GRAVITY}", dynamic(1000.0, 10.0), strip("")));
    ended.assert(0, &[]);
    let rest = run(format!("{STATIC}{}{BLOCK}{ON_TIP}{CLAMP}{GRAVITY}", strip("")));
    let (last, rest) = (ended.last("tip", "uz"), rest.last("tip", "uz"));
    assert!((last / rest - 1.0).abs() < 0.1, "{last} {rest}");
}

#[test]
fn ends_of_links_may_meet() {
    let link = |more: &str| {
        format!(
            r#"{}
[points]
p = [0.0, 0.0, 0.0]
q = [1.0, 0.0, 0.0]

[[masses]]
at = "q"
mass = 1.0

[[supports]]
at = "p"
fix = "translations"

[[links]]
name = "spring"
from = {{ node = "p" }}
to = {{ node = "q" }}
{more}
"#,
            dynamic(4.0, 0.01)
        )
    };
    // A spring without length pulls through its centre: cos ωt, ω² = 10.
    let ended = run(link("stiffness = 10.0\nfree_length = 0.0"));
    ended.assert(0, &[]);
    let (x, t) = (ended.column("nodes.csv", "q", "x"), ended.column("nodes.csv", "q", "time"));
    let off = x.iter().zip(&t).map(|(x, t)| (x - (10.0f64.sqrt() * t).cos()).abs()).fold(0.0, f64::max);
    assert!(off < 0.01, "{off}"); // a period too long by 7e-4, over two periods
    // Through the point where it has no direction, pushed.
    let thrown = "\n[[initial]]\nat = \"q\"\nvelocity = [-3.0, 0.0, 0.0]\n";
    let ended = run(link(&format!("stiffness = 10.0\nfree_length = 0.5\n{thrown}")));
    ended.assert(0, &[]);
    assert!(ended.column("nodes.csv", "q", "x").iter().any(|&x| x < -0.5));
    // Two nodes in one place from the start need a direction.
    let met = link("stiffness = 10.0").replace("q = [1.0", "q = [0.0");
    run(&met).assert(3, &["the ends of link `spring` lie at the same place", "direction"]);
    run(met.replace("stiffness = 10.0", "stiffness = 10.0\ndirection = [1.0, 0.0, 0.0]")).assert(0, &[]);
}

#[test]
fn times_land_where_they_are_asked_for() {
    let scene = format!("{}{CLAMP}{GRAVITY}", strip(""));
    let times = |analysis: &str, more: &str| {
        let ended = run(format!("{analysis}{scene}{more}"));
        ended.assert(0, &[]);
        ended.column("nodes.csv", "tip", "time")
    };
    let all = times(&dynamic(0.0105, 0.001), "");
    assert_eq!((all.len(), *all.last().unwrap()), (12, 0.0105), "eleven equal steps");
    let rows = times(&dynamic(0.01, 0.001), "\n[output]\ninterval = 0.003\n");
    let grid = [0.0, 0.003, 0.006, 0.009, 0.01];
    assert!(rows.len() == 5 && rows.iter().zip(grid).all(|(t, at)| (t - at).abs() < 1e-17), "{rows:?}");
    let rows = times(&dynamic(0.01, 0.001), "\n[output]\ninterval = 5.0\n");
    assert_eq!(rows, [0.0, 0.01]);
    let expect = r#"
[[expect]]
at = "tip"
quantity = "uz"
time = 0.00314159
value = -4.844e-5
tolerance = 0.01
"#;
    assert!(times(&dynamic(0.01, 0.001), expect).contains(&0.00314159));
    let late = expect.replace("0.00314159", "5.0");
    run(format!("{}{scene}{late}", dynamic(0.01, 0.001))).assert(3, &["`time` lies outside the run"]);
}

/// Interrupted in the middle: whole rows, a result, exit code 75.
#[test]
fn signals_leave_whole_files() {
    for signal in ["INT", "TERM"] {
        let dir = tempfile::tempdir().unwrap();
        let (deck, folder) = (dir.path().join("deck.toml"), dir.path().join("out"));
        std::fs::write(&deck, format!("{}{}{CLAMP}{GRAVITY}", dynamic(1e4, 1e-3), strip(""))).unwrap();
        let child = command(&deck, &folder).spawn().unwrap();
        let (began, nodes) = (Instant::now(), folder.join("nodes.csv"));
        while std::fs::metadata(&nodes).map_or(0, |file| file.len()) < 1000 {
            assert!(began.elapsed() < Duration::from_secs(20), "no rows");
            std::thread::sleep(Duration::from_millis(5));
        }
        let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let (code, said) = wait(child);
        let ended = Ended { code, said, folder, _dir: dir };
        ended.assert(75, &["stopped by a signal at t = "]);
        assert_eq!(ended.result()["status"], "stopped");
        assert!(std::fs::read_to_string(&nodes).unwrap().ends_with('\n'));
        let (rows, steps) = (ended.column("nodes.csv", "tip", "time"), ended.column("steps.csv", "", "time"));
        assert_eq!(rows[1..], steps[..], "both tables end with the same step");
    }
}

#[test]
fn folders_that_cannot_be_written_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let deck = dir.path().join("deck.toml");
    std::fs::write(&deck, format!("{STATIC}{}{CLAMP}{}", strip(""), pull(-1.0))).unwrap();
    let (code, said) = wait(command(&deck, &dir.path().join("deck.toml/out")).spawn().unwrap());
    assert!(code == 6 && said.contains("deck.toml/out"), "{code} {said}");
    // A folder with something in it is left alone, unless told otherwise.
    let folder = dir.path().join("out");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("thesis.txt"), "mine").unwrap();
    let (code, said) = wait(command(&deck, &folder).spawn().unwrap());
    assert!(code == 2 && said.contains("holds files already") && said.contains("--overwrite"), "{code} {said}");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    let (code, said) = wait(command(&deck, &folder).arg("--overwrite").spawn().unwrap());
    assert_eq!(code, 0, "{said}");
    assert_eq!(std::fs::read_to_string(folder.join("thesis.txt")).unwrap(), "mine");
}
