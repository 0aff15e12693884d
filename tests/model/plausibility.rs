//! What a deck says against itself or hardly means: it is said, and sound decks hear nothing.

use assert_cmd::Command;
use rdsolve::diagnostic::{Severity, Source};
use rdsolve::model::{self, Model};

const OPENING: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.01
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[sections.square]
shape = "rectangle"
width = 0.05
height = 0.05
"#;

fn read(rest: &str) -> (Option<Model>, Vec<(Severity, String)>) {
    let (model, said) = model::read(&Source::new("deck.toml", OPENING.to_owned() + rest, &[]));
    // Not every scene has something of steel.
    let said = said.into_iter().filter(|said| !said.message.starts_with("nothing uses"));
    (model, said.map(|said| (said.severity, said.message)).collect())
}

/// What is said, without what is said of errors that follow.
#[track_caller]
fn says(rest: &str, severity: Severity, words: &[&str]) {
    let (_, said) = read(rest);
    let has = |(of, message): &(Severity, String)| *of == severity && words.iter().all(|word| message.contains(word));
    assert!(said.iter().any(has), "{words:?} not in {said:#?}");
}

#[track_caller]
fn is_silent(rest: &str) -> Model {
    let (model, said) = read(rest);
    assert!(said.is_empty(), "{said:#?}");
    model.unwrap()
}

fn beam(name: &str, path: &str, elements: usize) -> String {
    format!(
        "[[beams]]\nname = \"{name}\"\npath = [{path}]\nelements = {elements}\nmaterial = \"steel\"\n\
         section = \"square\"\norientation = [0.0, 1.0, 0.3]\n"
    )
}

const BALL: &str = r#"
[[bodies]]
name = "ball"
center = [0.0, 5.0, 0.0]
mass = 1.0
inertia = [1.0, 1.0, 1.0]
"#;

fn initial(at: &str, rest: &str) -> String {
    format!("[[initial]]\nat = \"{at}\"\n{rest}\n")
}

#[test]
fn initial_velocities_that_contradict_each_other_are_an_error() {
    let two = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [2.0, 0.0, 0.0]\n".to_owned()
        + &beam("l", "\"a\", \"b\"", 4)
        + &beam("r", "\"b\", \"c\"", 4);
    let up = initial("l", "velocity = [0.0, 0.0, 1.0]");
    says(
        &(two.clone() + &up + &initial("r", "velocity = [0.0, 0.0, 2.0]")),
        Severity::Error,
        &["`b` is given two", "entry 1", "entry 2", "`velocity`"],
    );
    says(&(two.clone() + &up + &initial("all", "velocity = [0.0, 0.0, 2.0]")), Severity::Error, &["and 12 more"]);
    let spinning = BALL.to_owned() + "angular_velocity = [0.0, 0.0, 1.0]\n";
    says(
        &(spinning.clone() + &initial("ball", "angular_velocity = [0.0, 0.0, 2.0]")),
        Severity::Error,
        &["body `ball`", "entry 1"],
    );
    // The motion of a rigid body is an angular velocity too, of zero where it says none.
    says(
        &(spinning + &initial("ball", "velocity = [1.0, 0.0, 0.0]\nabout = [0.0, 0.0, 0.0]")),
        Severity::Error,
        &["`angular_velocity`"],
    );
    is_silent(&(two.clone() + &up + &initial("r", "velocity = [0.0, 0.0, 1.0]")));
    let model = is_silent(&(two + &up + &initial("r", "velocity = [0.0, 0.0, 2.0]\nreplaces = true")));
    assert_eq!(model.nodes[1].v.z, 2.0);
}

#[test]
fn initial_velocities_of_different_quantities_combine() {
    let profile = "[amplitudes.there]\nkind = \"table\"\npoints = [[0.0, 0.0], [10.0, 1.0]]\n";
    let spinning = BALL.to_owned() + "angular_velocity = [0.0, 0.0, 1.0]\n";
    let with = "velocity = [4.0, 0.0, 0.0]\nprofile = [{ amplitude = \"there\", direction = [0.0, 1.0, 0.0] }]";
    let model = is_silent(&(spinning + profile + &initial("ball", with)));
    let ball = &model.nodes[0];
    assert_eq!((ball.v.x, ball.omega.z), (2.0, 1.0));
}

#[test]
fn initial_velocities_that_nothing_takes_are_said() {
    let held = BALL.to_owned() + "velocity = [1.0, 0.0, 2.0]\n[[supports]]\nat = \"ball\"\nfix = [\"ux\"]\n";
    says(&held, Severity::Warning, &["`ball`", "ux", "rest"]);
    let moved = |speed: f64| {
        format!(
            "{BALL}[amplitudes.go]\nkind = \"constant\"\n[[supports]]\nat = \"ball\"\n\
             motion = {{ ux = {{ amplitude = \"go\", scale = 3.0, history = \"velocity\" }} }}\n{}",
            initial("ball", &format!("velocity = [{speed:?}, 0.0, 0.0]"))
        )
    };
    says(&moved(1.0), Severity::Warning, &["`ball`", "ux", "another motion"]);
    is_silent(&moved(3.0));
    let bar = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\nmass = 1.0\n\
               [[links]]\nname = \"spring\"\nfrom = { node = \"a\" }\nto = { node = \"b\" }\nstiffness = 10.0\n\
               [[supports]]\nat = \"a\"\nfix = \"translations\"\n";
    says(&(bar.to_owned() + &initial("b", "angular_velocity = [0.0, 0.0, 1.0]")), Severity::Warning, &["`b`"]);
    // A whole part whose support rests is as it should be.
    let beam = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n"
        .to_owned()
        + &beam("l", "\"a\", \"b\"", 4);
    is_silent(&(beam + &initial("l", "velocity = [0.0, 0.0, 1.0]")));
}

#[test]
fn tables_that_do_not_reach_the_ends_of_the_run_say_what_holds() {
    let pushed = |points: &str, more: &str| {
        format!(
            "{BALL}[amplitudes.push]\nkind = \"table\"\npoints = {points}\n{more}\n\
             [[loads]]\nat = \"ball\"\nforce = [1.0, 0.0, 0.0]\namplitude = \"push\"\n"
        )
    };
    says(&pushed("[[0.0, 0.0], [0.5, 2.0]]", ""), Severity::Warning, &["`push` ends at 0.5", "last value, 2"]);
    says(&pushed("[[0.5, 2.0], [1.0, 0.0]]", ""), Severity::Warning, &["`push` begins at 0.5", "first value, 2"]);
    is_silent(&pushed("[[0.0, 2.0], [0.5, 0.0]]", ""));
    is_silent(&pushed("[[0.0, 2.0], [0.9999999, 3.0]]", ""));
    let held = is_silent(&pushed("[[0.0, 0.0], [0.5, 2.0]]", "after = \"hold\""));
    assert_eq!(held.loading.amplitudes[0].value(0.7), 2.0);
    let ended = is_silent(&pushed("[[0.2, 1.0], [0.5, 2.0]]", "after = \"zero\"\nbefore = \"zero\""));
    let value = |t: f64| ended.loading.amplitudes[0].value(t);
    assert_eq!([value(0.1), value(0.2), value(0.35), value(0.7)], [0.0, 1.0, 1.5, 0.0]);
    let late = pushed("[[0.0, 0.0], [1.0, 2.0]]", "").replace("points = [[0.0, 0.0], [1.0, 2.0]]", "start = 2.0");
    says(&late.replace("\"table\"", "\"step\""), Severity::Warning, &["`push` is zero to the end"]);
    let waits = pushed("[[0.0, 0.0], [1.5, 0.0], [2.0, 3.0]]", "");
    says(&waits, Severity::Warning, &["`push` is zero to the end", "it starts at 1.5"]);
    says(&pushed("[[0.0, 0.0], [1.0, 0.0]]", ""), Severity::Warning, &["`push` is zero from 0 to the end"]);
}

const CORNER: &str = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nb2 = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\n";

#[test]
fn parts_that_touch_without_sharing_a_node_are_said() {
    let apart = CORNER.to_owned() + &beam("l", "\"a\", \"b\"", 4) + &beam("r", "\"b2\", \"c\"", 4);
    says(&apart, Severity::Warning, &["`b` of beam `l`", "`b2` of beam `r`"]);
    let joint = "[[joints]]\nname = \"pin\"\nkind = \"spherical\"\nfrom = { node = \"b\" }\nto = { node = \"b2\" }\n";
    is_silent(&(apart.clone() + joint));
    let spring = "[[links]]\nname = \"pad\"\nfrom = { node = \"b\" }\nto = { node = \"b2\" }\n\
                  bushing = [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]\n";
    is_silent(&(apart.clone() + spring));
    is_silent(&apart.replace("b2 = [1.0, 0.0, 0.0]", "b2 = [1.0, 0.0, 0.01]"));
    // At mid-span, between nodes and on one.
    for elements in [3, 4] {
        let tee = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nm = [0.5, 0.0, 0.0]\nc = [0.5, 1.0, 0.0]\n"
            .to_owned()
            + &beam("l", "\"a\", \"b\"", elements)
            + &beam("post", "\"m\", \"c\"", 4);
        says(&tee, Severity::Warning, &["`m` of beam `post`", "beam `l`"]);
    }
    let plates = |more: &str| {
        let shell = |name: &str, corners: &str| {
            format!(
                "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = [5, 5]\nmaterial = \"steel\"\n\
                 thickness = 0.01\n"
            )
        };
        "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nb2 = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\n\
         c2 = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\ne = [2.0, 0.0, 0.0]\nf = [2.0, 1.0, 0.0]\n\
         g = [0.41, 0.33, 0.0]\nh = [0.41, 0.33, 1.0]\n"
            .to_owned()
            + &shell("left", "\"a\", \"b\", \"c\", \"d\"")
            + &shell("right", "\"b2\", \"e\", \"f\", \"c2\"")
            + more
            + &beam("post", "\"g\", \"h\"", 2)
    };
    says(&plates(""), Severity::Warning, &["shell `left`", "`b2` of shell `right`"]);
    says(&plates(""), Severity::Warning, &["`g` of beam `post`", "shell `left`"]);
    // Bodies that only pass, and rest on the same ground, are none of it.
    let body = BALL.replace("[0.0, 5.0, 0.0]", "[1.0, 0.0, 0.0]");
    let tip = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n".to_owned() + &beam("l", "\"a\", \"b\"", 4) + &body;
    says(&tip, Severity::Warning, &["body `ball`"]);
    is_silent(&(tip + "[[attachments]]\nbody = \"ball\"\nnodes = [\"b\"]\n"));
}

/// Along edges and paths, with like divisions and others; what crosses, is joined or runs through as a cable does is not said.
#[test]
fn parts_that_lie_along_one_another_are_said() {
    let shell = |name: &str, corners: &str, elements: &str| {
        format!(
            "[[shells]]\nname = \"{name}\"\ncorners = [{corners}]\nelements = {elements}\nmaterial = \"steel\"\n\
             thickness = 0.01\n"
        )
    };
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n\
                  e = [0.0, 0.0, 1.0]\nf = [1.0, 0.0, 1.0]\ng = [0.25, 0.0, 0.0]\nh = [0.75, 0.0, 0.0]\n\
                  k = [0.5, -0.5, 0.0]\nl = [0.5, 1.5, 0.0]\nm = [0.3, 0.5, -0.5]\nn = [0.3, 0.5, 0.5]\n\
                  o = [0.0, 0.5, -0.5]\np = [1.0, 0.5, -0.5]\nq = [1.0, 0.5, 0.5]\nr = [0.0, 0.5, 0.5]\n";
    let plate = points.to_owned() + &shell("plate", "\"a\", \"b\", \"c\", \"d\"", "[4, 4]");
    for elements in [1, 3, 4, 6] {
        let rib = plate.clone() + &beam("rib", "\"a\", \"b\"", elements);
        says(&rib, Severity::Warning, &["beam `rib`", "shell `plate`", "nothing holds the two together along"]);
        let (_, said) = read(&rib);
        assert_eq!(said.iter().filter(|(_, said)| said.contains("along")).count(), 1, "once: {said:?}");
        let two = points.to_owned() + &beam("x", "\"a\", \"b\"", 4) + &beam("y", "\"a\", \"b\"", elements);
        says(&two, Severity::Warning, &["beam `x`", "beam `y`"]);
        // A web that cuts through a flange, on its lines and off them.
        let web = shell("web", "\"o\", \"p\", \"q\", \"r\"", &format!("[{elements}, 2]"));
        says(&(plate.clone() + &web), Severity::Warning, &["shell `web`", "shell `plate`"]);
    }
    // Patches of like corners share the nodes of an edge.
    is_silent_about("along", &(plate.clone() + &shell("web", "\"a\", \"b\", \"f\", \"e\"", "[4, 2]")));
    // In part.
    let part = points.to_owned() + &beam("long", "\"a\", \"b\"", 4) + &beam("short", "\"g\", \"h\"", 2);
    says(&part, Severity::Warning, &["beam `short`", "beam `long`"]);
    // Crossing in one place, in the plane and through it; at an end.
    is_silent_about("along", &(points.to_owned() + &beam("x", "\"a\", \"b\"", 4) + &beam("y", "\"k\", \"l\"", 4)));
    is_silent_about("along", &(plate.clone() + &beam("pin", "\"m\", \"n\"", 4)));
    is_silent_about("along", &(plate.clone() + &beam("post", "\"a\", \"e\"", 4)));
    // Paths that name the same points share the nodes there.
    let stations = "\"a\", \"g\", \"h\", \"b\"";
    let joined = points.to_owned() + &beam("x", stations, 1) + &beam("y", stations, 1);
    is_silent_about("along", &joined.replace("elements = 1", "elements = [1, 1, 1]"));
}

/// A drive that starts at once takes along what is joined to it; velocities that the deck gives are another matter.
#[test]
fn drives_that_start_at_once_are_no_contradiction() {
    let crank = |velocity: &str, more: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 0.02\ntime_step = 1e-3\n[integrator]\nscheme = \"newmark\"\n\
             [[bodies]]\nname = \"crank\"\ncenter = [0.1, 0.0, 0.0]\nmass = 2.0\ninertia = [0.1, 0.2, 0.2]\n\
             [[bodies]]\nname = \"rod\"\ncenter = [0.5, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n{velocity}\n\
             [points]\no = [0.0, 0.0, 0.0]\n[[attachments]]\nbody = \"crank\"\nnodes = [\"o\"]\n\
             [[joints]]\nname = \"bearing\"\nkind = \"revolute\"\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
             to = {{ body = \"crank\" }}\naxis = [0.0, 0.0, 1.0]\n\
             [[joints]]\nname = \"pin\"\nkind = \"revolute\"\nfrom = {{ body = \"crank\", point = [0.2, 0.0, 0.0] }}\n\
             to = {{ body = \"rod\" }}\naxis = [0.0, 0.0, 1.0]\n{more}"
        )
    };
    let drive = "[amplitudes.go]\nkind = \"constant\"\n[[supports]]\nat = \"crank\"\n\
                 motion = { rz = { amplitude = \"go\", scale = 3.0, history = \"velocity\" } }\n";
    let violated = |velocity: &str, more: &str| {
        let (outcome, said) = crate::support::run_with_warnings(&crank(velocity, more));
        assert!(matches!(outcome, rdsolve::solve::Outcome::Done), "{outcome:?}");
        said.iter().any(|said| said.contains("initial velocities violate the joints"))
    };
    assert!(!violated("", drive), "only the drive moves");
    // The pin moves at 3 × 0.2: a rod that flies along agrees, and one that flies elsewhere does not.
    assert!(!violated("velocity = [0.0, 0.6, 0.0]", drive));
    assert!(violated("velocity = [0.0, 2.0, 0.0]", drive));
    assert!(violated("velocity = [0.7, 0.0, 0.0]", drive));
    assert!(violated("velocity = [0.7, 0.0, 0.0]", ""), "without a drive");
    // What is not joined to anything may fly as it likes.
    let other = "[[bodies]]\nname = \"stone\"\ncenter = [5.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.1, 0.1, 0.1]\n\
                 velocity = [1.0, 2.0, 3.0]\n";
    assert!(!violated("", &(drive.to_owned() + other)));
}

#[test]
fn sections_and_thicknesses_that_do_not_go_with_lengths_are_said() {
    let one = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n".to_owned() + &beam("l", "\"a\", \"b\"", 4);
    is_silent(&one);
    let (_, said) = model::read(&Source::new("deck.toml", OPENING.replace("0.05", "50.0") + &one, &[]));
    assert!(said.iter().any(|said| said.message.contains("about 50 deep, and the beam is 1 long")), "{said:?}");
    let general = |moments: &str, torsion: &str| {
        format!(
            "[sections.given]\nshape = \"general\"\narea = 1e-2\nmoments = {moments}\ntorsion_constant = {torsion}\n\
             shear_areas = [1e-2, 1e-2]\n{}",
            one.replace("\"square\"", "\"given\"")
        )
    };
    let sections = |text: String| {
        let text = OPENING.split("[sections.square]").next().unwrap().to_owned() + &text;
        model::read(&Source::new("deck.toml", text, &[])).1.into_iter().map(|said| said.message).collect::<Vec<_>>()
    };
    // A circle has 7.96e-6, the least of all; a flat strip of the same area far more about one axis than that.
    assert!(sections(general("[7.96e-6, 7.96e-6]", "1.59e-5")).is_empty());
    assert!(sections(general("[1e-6, 1e-4]", "4e-6")).is_empty());
    assert!(sections(general("[1e-6, 1e-6]", "1e-6"))[0].contains("too small"));
    assert!(sections(general("[1e-7, 1e-4]", "4e-7"))[0].contains("too small"));
    assert!(sections(general("[1e-5, 1e-5]", "3e-5"))[0].contains("`torsion_constant`"));
    let plate = "[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\nc = [2.0, 0.1, 0.0]\nd = [0.0, 0.1, 0.0]\n\
                 [[shells]]\nname = \"strip\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [20, 1]\n\
                 material = \"steel\"\nthickness = 0.2\n";
    says(plate, Severity::Warning, &["shell `strip` is 0.2 thick", "0.09988 wide"]);
    is_silent_about("thick", &plate.replace("thickness = 0.2", "thickness = 0.01"));
}

#[track_caller]
fn is_silent_about(word: &str, rest: &str) {
    let (_, said) = read(rest);
    assert!(said.iter().all(|(_, message)| !message.contains(word)), "{said:#?}");
}

#[test]
fn ends_apart_by_rounding_are_joined_with_a_note() {
    let pair = |x: &str| {
        format!(
            "{BALL}[[bodies]]\nname = \"arm\"\ncenter = [0.0, 3.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
             [[joints]]\nname = \"pin\"\nkind = \"spherical\"\nfrom = {{ body = \"ball\", point = [0.0, 3.66667, 0.0] }}\n\
             to = {{ body = \"arm\", point = [0.0, {x}, 0.0] }}\n"
        )
    };
    is_silent(&pair("3.66667"));
    says(&pair("3.66666"), Severity::Note, &["joint `pin`", "1e-5 apart"]);
    says(&pair("3.667"), Severity::Error, &["joint `pin`", "same place"]);
}

/// Two masses on a spring that fly at a hundred times the speed of their vibration.
fn flying(time_step: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 20.0\ntime_step = {time_step}\n\
         [integrator]\nscheme = \"wilson-theta\"\n\
         [points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
         [[masses]]\nat = \"a\"\nmass = 1.0\n[[masses]]\nat = \"b\"\nmass = 1.0\n\
         [[links]]\nname = \"spring\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\nstiffness = 20.0\n\
         [[initial]]\nat = \"a\"\nvelocity = [99.0, 0.0, 0.0]\n[[initial]]\nat = \"b\"\nvelocity = [101.0, 0.0, 0.0]\n"
    )
}

/// The vibration is a ten-thousandth of the energy: it may die away within 1e-4 of all.
#[test]
fn dissipation_is_measured_against_the_motion() {
    for (time_step, warned) in [(0.1, true), (0.002, false)] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("deck.toml"), flying(time_step)).unwrap();
        let run =
            Command::cargo_bin("rdsolve").unwrap().current_dir(&folder).args(["run", "deck.toml"]).assert().code(0);
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&run.get_output().stdout), text(&run.get_output().stderr));
        let results = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).find(|path| path.is_dir());
        let log = std::fs::read_to_string(results.unwrap().join("run.log")).unwrap();
        for said in [&out, &log] {
            assert!(said.contains("numerical dissipation: "), "{said}");
        }
        for said in [&err, &log] {
            assert_eq!(said.contains("warning: numerical dissipation"), warned, "{time_step}: {said}");
        }
    }
}

/// A hundred-thousandth of a joule where boxes of 4 kg come to rest is nothing; what an impact makes is something.
#[test]
fn energies_that_lift_nothing_are_not_said() {
    let box_on = |gravity: f64, step: f64, rest: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = {step}\n[integrator]\nscheme = \"newmark\"\n\
             [environment]\ngravity = [0.0, 0.0, -{gravity:?}]\n{rest}"
        )
    };
    let settling = "[[bodies]]\nname = \"b\"\ncenter = [0.1, 0.1, 0.05]\nmass = 4.0\n\
                    shape = { kind = \"box\", size = [0.2, 0.2, 0.1] }\n[[contacts]]\nname = \"g\"\n\
                    surface = { shape = \"box\", size = [0.4, 0.4, 0.1], center = [0.0, 0.0, -0.05] }\nwith = \"b\"\n\
                    stiffness = 1e6\nfriction = 0.4\nrestitution = 0.3\n";
    let struck = "[[bodies]]\nname = \"b\"\ncenter = [0.0, 0.0, 0.2]\nmass = 1.0\nvelocity = [0.0, 0.0, -50.0]\n\
                  shape = { kind = \"sphere\", radius = 0.1 }\n[[contacts]]\nname = \"g\"\n\
                  surface = { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nwith = \"b\"\n\
                  stiffness = 2.5e7\nrestitution = 0.8\n";
    // Impacts of three steps each.
    let cases = [(9.81, 5e-4, settling, false), (9.81, 2e-4, struck, true), (0.0, 2e-4, struck, true)];
    for (gravity, step, rest, said) in cases {
        let text = box_on(gravity, step, rest);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("deck.toml"), &text).unwrap();
        let run =
            Command::cargo_bin("rdsolve").unwrap().current_dir(&folder).args(["run", "deck.toml"]).assert().code(0);
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&run.get_output().stdout), text(&run.get_output().stderr));
        assert!(out.contains("numerical growth of energy: "), "{out}");
        assert_eq!(err.contains("energy growth: "), said, "{err}{out}");
    }
}

/// What a deck says on standard error in a folder of its own.
fn said_of(deck: &str, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut run = Command::cargo_bin("rdsolve").unwrap();
    let run = run.current_dir(&folder).args(["run", "deck.toml"]).args(more).assert().code(0);
    String::from_utf8(run.get_output().stderr.clone()).unwrap()
}

/// Automatic steps of central differences are 0.8 of the critical one. Where the fastest mode is the motion itself it comes out larger by
/// 1/√(1 − 0.8²), two thirds, which is said; where a fiftieth of the run is shorter it is 2 % larger.
#[test]
fn stable_steps_that_do_not_resolve_the_motion_are_told() {
    let oscillator = |end_time: f64| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = {end_time:?}\ntime_step = \"auto\"\n[integrator]\nscheme = \"central-difference\"\n\
             [points]\np = [0.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\nmass = 1.0\n[[links]]\nname = \"s\"\nfrom = {{ ground = [-1.0, 0.0, 0.0] }}\n\
             to = {{ node = \"p\" }}\nlaw = \"linear\"\nstiffness = 100.0\n[[supports]]\nat = \"p\"\nfix = [\"uy\", \"uz\"]\n\
             [[initial]]\nat = \"p\"\nvelocity = [1.0, 0.0, 0.0]\n"
        )
    };
    let long = said_of(&oscillator(20.0), &[]);
    assert!(long.contains("Displacements overshoot by about 67 %"), "{long}");
    let short = said_of(&oscillator(2.0), &[]);
    assert!(!short.contains("overshoot"), "{short}");
}

/// A frame that yields in an earthquake takes many times as long with a scheme that damps nothing, which is said with its remedy.
#[test]
fn steps_that_ringing_makes_hard_are_told() {
    let deck = concat!(env!("CARGO_MANIFEST_DIR"), "/decks/shaken_frame/deck.toml");
    let said = |integrator: &str| {
        let folder = tempfile::tempdir().unwrap();
        let mut run = Command::cargo_bin("rdsolve").unwrap();
        let sets = [format!("integrator={integrator}"), "expect=[]".to_owned(), "stages.quake.duration=5.0".to_owned()];
        let sets = sets.iter().flat_map(|set| ["--set", set.as_str()]);
        let run = run.current_dir(&folder).args(["run", deck, "-o", "out"]).args(sets).assert().code(0);
        String::from_utf8(run.get_output().stderr.clone()).unwrap()
    };
    let newmark = said("{scheme=\"newmark\"}");
    assert!(
        newmark.contains("newmark has no numerical dissipation") && newmark.contains("spectral_radius = 0.8"),
        "{newmark}"
    );
    let damped = said("{scheme=\"generalized-alpha\",spectral_radius=0.8}");
    assert!(!damped.contains("no numerical dissipation"), "{damped}");
}

/// The warnings about units and angles of a deck that is read only.
fn slips(deck: &str) -> Vec<String> {
    let (model, said) = model::read(&Source::new("deck.toml", deck, &[]));
    assert!(model.is_some(), "{said:?}\n{deck}");
    said.into_iter().map(|said| format!("{}: {:?}", said.message, said.hints)).collect()
}

/// A beam of this material in a deck with or without a label and gravity.
fn of_material(units: &str, gravity: f64, material: &str) -> String {
    let units = if units.is_empty() { String::new() } else { format!("units = \"{units}\"\n") };
    let gravity =
        if gravity == 0.0 { String::new() } else { format!("[environment]\ngravity = [0.0, 0.0, -{gravity:?}]\n") };
    let analysis = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.1\n";
    let rest = one_beam();
    format!("{units}{analysis}{gravity}[materials.m]\n{material}\n{rest}")
}

fn one_beam() -> String {
    "[sections.s]\nshape = \"rectangle\"\nwidth = 0.05\nheight = 0.05\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
     [[beams]]\nname = \"bar\"\npath = [\"a\", \"b\"]\nelements = 2\nmaterial = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n\
     [[supports]]\nat = \"a\"\nfix = \"all\"\n"
        .to_owned()
}

fn material(modulus: &str, ratio: f64, density: &str, more: &str) -> String {
    let density = if density.is_empty() { String::new() } else { format!("density = {density}\n") };
    let model = if more.is_empty() { "elastic" } else { "elastic-plastic" };
    format!("model = \"{model}\"\nyoungs_modulus = {modulus}\npoisson_ratio = {ratio:?}\n{density}{more}\n")
}

/// Slips of a unit that a number alone does not show: moduli in MPa, GPa, psi or ksi, densities in g/cm³ or t/m³, yield stresses in MPa.
#[test]
fn slips_of_units_are_said() {
    let cases = [
        // Label, gravity, modulus, density, more, what is said of it.
        ("SI", 0.0, "210e3", "7850.0", "", "210000 Pa with 7850 kg/m³"),
        ("SI", 0.0, "210e3", "", "", "softer than rubber"),
        ("SI", 0.0, "30e6", "7850.0", "", "do not go together"),
        ("SI", 0.0, "210e9", "7.85", "", "do not go together"),
        ("SI", 0.0, "70e9", "2.7", "", "do not go together"),
        ("SI", 0.0, "210.0", "7850.0", "", "`youngs_modulus` is not plausible"),
        ("mm-t-s", 0.0, "210.0", "7.85e-9", "", "do not go together"),
        ("mm-t-s", 0.0, "210e9", "7.85e-9", "", "`youngs_modulus` is not plausible"),
        ("mm-t-s", 0.0, "210e3", "7850.0", "", "`density` is not plausible"),
        ("mm-t-s", 0.0, "210e3", "7.85e-6", "", "`density` is not plausible"),
        ("mm-t-s", 9.81, "210e3", "7.85e-9", "", "`gravity` is not plausible"),
        ("mm-kg-ms", 0.0, "210e3", "7.85e-6", "", "`youngs_modulus` is not plausible"),
        ("", 9.81, "210e3", "7850.0", "", "do not go together with the gravity"),
        ("", 9.81, "210e9", "7.85", "", "do not go together with the gravity"),
        ("", 9810.0, "210e3", "7850.0", "", "do not go together with the gravity"),
        ("", 9.81, "210e3", "7.85e-9", "", "do not go together with the gravity"),
        ("", 0.0, "210e3", "7850.0", "", "do not go together: [\"they look like those of steel"),
        ("", 0.0, "210e9", "7.85", "", "do not go together: [\"they look like those of steel"),
        ("", 0.0, "210e3", "7.85", "", "do not go together"),
        ("", 0.0, "210e9", "7.85e-9", "", "do not go together"),
        ("", 0.0, "30e3", "2400.0", "", "those of concrete"),
        ("SI", 9.81, "210e9", "7850.0", "yield_stress = 235.0", "yields at a strain of 1.119e-9"),
        ("", 0.0, "210e9", "", "yield_stress = 235.0", "is it 2.35e8?"),
        ("", 0.0, "210e9", "", "hardening = [[0.0, 235.0], [0.1, 300.0]]", "yields at a strain of"),
        ("", 0.0, "210e3", "", "yield_stress = 235e6", "it may be 2.1e11"),
        ("", 0.0, "29e6", "", "yield_stress = 36.0", "is it 36000?"),
        ("", 0.0, "210e9", "", "yield_stress = 235e6\nhardening_modulus = 1500.0", "which has no effect"),
    ];
    for (units, gravity, modulus, density, more, said) in cases {
        let found = slips(&of_material(units, gravity, &material(modulus, 0.3, density, more)));
        assert!(
            found.iter().any(|found| found.contains(said)),
            "{units} {gravity} {modulus} {density} {more}: {found:?}"
        );
    }
}

/// Materials from foam to diamond in every label are not spoken of, nor are academic numbers without one.
#[test]
fn materials_in_their_units_are_not_said() {
    // Modulus in Pa, Poisson's ratio, density in kg/m³, yield stress in Pa or 0.
    let materials = [
        (210e9, 0.3, 7850.0, 235e6),
        (210e9, 0.3, 7850.0, 1800e6),
        (70e9, 0.33, 2700.0, 15e6),
        (16e9, 0.44, 11340.0, 5e6),
        (1050e9, 0.2, 3520.0, 0.0),
        (400e9, 0.28, 19300.0, 0.0),
        (30e9, 0.2, 2400.0, 30e6),
        (11e9, 0.4, 450.0, 0.0),
        (0.9e9, 0.42, 950.0, 20e6),
        (2e6, 0.49, 1100.0, 0.0),
        (1.2e5, 0.1, 40.0, 0.0),
        (2e5, 0.48, 1000.0, 0.0),
        (140e9, 0.3, 1600.0, 0.0),
        (50e6, 0.3, 1900.0, 0.0),
    ];
    for (units, [length, mass, time]) in [
        ("SI", [1.0, 1.0, 1.0]),
        ("mm-t-s", [1e-3, 1e3, 1.0]),
        ("mm-kg-s", [1e-3, 1.0, 1.0]),
        ("mm-kg-ms", [1e-3, 1.0, 1e-3]),
        ("", [1e-3, 1e3, 1.0]),
    ] {
        let pressure: f64 = mass / (length * time * time);
        for (modulus, ratio, density, stress) in materials {
            let more = if stress > 0.0 { format!("yield_stress = {:e}", stress / pressure) } else { String::new() };
            let density = format!("{:e}", density * length.powi(3) / mass);
            let material = material(&format!("{:e}", modulus / pressure), ratio, &density, &more);
            let found = slips(&of_material(units, 9.81 * time * time / length, &material));
            assert_eq!(found, Vec::<String>::new(), "{units} {material}");
        }
    }
    for (modulus, density, more) in [
        ("1.0", "1.0", ""),
        ("1e4", "2.5e-4", "yield_stress = 6.0"),
        ("210e9", "7850.0", "yield_stress = 1e20"),
        ("2e15", "7850.0", "yield_stress = 250e6"),
    ] {
        let found = slips(&of_material("", 0.0, &material(modulus, 0.0, density, more)));
        assert_eq!(found, Vec::<String>::new(), "{modulus}");
    }
}

/// Angles of 90 radians, limits of ±30 and phases of 180 are degrees; turns of a winch and limits in radians are not.
#[test]
fn degrees_are_said() {
    let hinge = |more: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 0.1\ntime_step = 0.01\n[integrator]\nscheme = \"newmark\"\n\
             [[bodies]]\nname = \"arm\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
             [[joints]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
             to = {{ body = \"arm\" }}\n{more}\n"
        )
    };
    let ramp = "[amplitudes.a]\nkind = \"ramp\"\nend = 0.1\n";
    let turned = |position: f64, points: &str| {
        hinge(&format!(
            "motion = {{ position = {position:?}, amplitude = \"a\" }}\n[amplitudes.a]\nkind = \"table\"\npoints = {points}"
        ))
    };
    let sine = |phase: f64| {
        hinge(&format!(
            "effort = {{ value = 1.0, amplitude = \"a\" }}\n[amplitudes.a]\nkind = \"sine\"\nfrequency = 1.0\nphase = {phase:?}"
        ))
    };
    let support = |scale: f64| {
        format!(
            "{}[points]\np = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n[[supports]]\nat = \"p\"\n\
             fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\nmotion = {{ rz = {{ amplitude = \"a\", scale = {scale:?} }} }}\n{ramp}",
            hinge("")
        )
    };
    for (deck, said) in [
        (hinge("limits = [-30.0, 30.0]\nlimit_stiffness = 1e3"), "30 radians, 4.8 turns"),
        (hinge("limits = [-10.0, 0.0]\nlimit_stiffness = 1e3"), "-10 radians"),
        (hinge("stiffness = 1.0\nrest = 45.0"), "45 radians"),
        (hinge(&format!("motion = {{ position = 90.0, amplitude = \"a\" }}\n{ramp}")), "90 degrees are 1.571 radians"),
        (
            hinge(&format!("motion = {{ position = -20.0, amplitude = \"a\" }}\n{ramp}")),
            "-20 degrees are -0.3491 radians",
        ),
        (turned(1.0, "[[0.0, 0.0], [0.1, 180.0]]"), "180 degrees"),
        (support(-45.0), "-45 degrees"),
        (sine(90.0), "`phase_degrees`"),
    ] {
        let found = slips(&deck);
        assert!(found.iter().any(|found| found.contains(said)), "{said}: {found:?}\n{deck}");
    }
    for deck in [
        hinge("limits = [-0.5, 0.5]\nlimit_stiffness = 1e3"),
        hinge("limits = [-31.4, 31.4]\nlimit_stiffness = 1e3"),
        hinge("stiffness = 1.0\nrest = 1.5"),
        hinge(&format!("motion = {{ position = 62.83, amplitude = \"a\" }}\n{ramp}")),
        hinge(&format!("motion = {{ position = 1.0, amplitude = \"a\" }}\n{ramp}")),
        hinge("motion = { velocity = 90.0 }"),
        hinge("limits = [-30.0, 30.0]\nlimit_stiffness = 1e3").replace("revolute", "prismatic"),
        support(0.5),
        sine(1.57),
    ] {
        let found = slips(&deck);
        assert!(found.iter().all(|found| !found.contains("degrees")), "{found:?}\n{deck}");
    }
}

/// A stiff damper stops a mass within a step: the work from the power at the ends of steps is c v² Δt, which is 50 J of 0.5 J that there were.
/// Nothing has grown, and the mass is at rest.
#[test]
fn dampers_that_stop_a_motion_within_a_step_are_no_energy_growth() {
    let text = "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.05\n[integrator]\nscheme = \"bathe\"\n\
                [points]\na = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"a\"\nmass = 1.0\n\
                [[supports]]\nat = \"a\"\nfix = [\"uy\", \"uz\"]\n[[initial]]\nat = \"a\"\nvelocity = [1.0, 0.0, 0.0]\n\
                [[links]]\nname = \"k\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\nstiffness = 1e4\ndamping = 1e3\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deck.toml"), text).unwrap();
    let run = Command::cargo_bin("rdsolve").unwrap().current_dir(&folder).args(["run", "deck.toml"]).assert().code(0);
    let said = String::from_utf8([&run.get_output().stdout[..], &run.get_output().stderr].concat()).unwrap();
    assert!(!said.contains("growth"), "{said}");
    assert!(said.contains("dampers have dissipated more"), "{said}");
}

/// Loads in N of what is meant in kN strain an elastic beam as no material can be: 20 MPa become 20 GPa. Without units nothing is known.
#[test]
fn stresses_that_no_material_bears_are_said() {
    let stretched = |force: f64| {
        format!(
            "units = \"SI\"\n{}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n{}[[supports]]\nat = \"a\"\nfix = \"all\"\n\
             [[loads]]\nat = \"b\"\nforce = [{force:?}, 0.0, 0.0]\n",
            OPENING.replace("dynamic", "static"),
            beam("tie", "\"a\", \"b\"", 1)
        )
    };
    let warns = |text: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("deck.toml"), text).unwrap();
        let run = Command::cargo_bin("rdsolve").unwrap().current_dir(&folder).args(["deck.toml"]).assert().code(0);
        String::from_utf8(run.get_output().stderr.clone()).unwrap().contains("few materials stay elastic")
    };
    // A = 25 cm²: 60 GPa are a strain of 0.29, 60 MPa one of 3e-4.
    assert!(warns(&stretched(1.5e8)) && !warns(&stretched(1.5e5)));
    assert!(!warns(&stretched(1.5e8).replace("units = \"SI\"\n", "")));
    assert!(warns(&stretched(1.5e8).replace("[analysis]\n", "[analysis]\ngeometry = \"linear\"\n")));
}

/// A bolt between two plates may be deeper than long; a beam of metres with a section in millimetres is not.
#[test]
fn a_bolt_may_be_as_short_as_it_is_thick() {
    let bolt = |length: &str| {
        format!(
            "[points]\nhead = [0.0, 0.0, 0.0]\nnut = [0.0, 0.0, {length}]\n{}[[supports]]\nat = \"head\"\nfix = \"all\"\n",
            beam("bolt", "\"head\", \"nut\"", 1)
        )
    };
    is_silent(&bolt("0.04"));
    says(&bolt("0.01"), Severity::Warning, &["the section of beam `bolt` is about", "deep, and the beam is 0.01 long"]);
    // Points in millimetres beside a section in metres.
    says(&bolt("30000.0"), Severity::Warning, &["beam `bolt` extends over 30000", "times the depth of its section"]);
    is_silent(&bolt("2000.0"));
}

/// A part that nothing joins to the supported ones falls or stands still; a free scene, a part that flies and one that a load moves are meant.
#[test]
fn parts_that_nothing_holds_are_said() {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 3.0]\nc = [2.0, 0.0, 0.0]\nd = [2.0, 0.0, 3.0]\n";
    let two = format!("{points}{}{}", beam("mast", "\"a\", \"b\"", 2), beam("stay", "\"c\", \"d\"", 2));
    let held = format!("{two}[[supports]]\nat = \"a\"\nfix = \"all\"\n");
    let gravity = "[environment]\ngravity = [0.0, 0.0, -9.81]\n";
    says(&held, Severity::Warning, &["nothing joins `stay`", "stands still"]);
    says(&format!("{held}{gravity}"), Severity::Warning, &["nothing joins `stay`", "falls freely"]);
    // A load does not hold it in statics.
    let pulled = format!("{held}[[loads]]\nat = \"d\"\nforce = [1.0, 0.0, 0.0]\n");
    let text = format!("{}{pulled}", OPENING.replace("dynamic", "static"));
    let (_, said) = model::read(&Source::new("deck.toml", text, &[]));
    assert!(said.iter().any(|said| said.message.contains("`stay`") && said.message.contains("no static equilibrium")));
    let loose = format!("{}{two}", OPENING.replace("dynamic", "static"));
    let (_, said) = model::read(&Source::new("deck.toml", loose, &[]));
    assert!(said.iter().any(|said| said.message.contains("any other part: there is no static equilibrium")));
    let link = "[[links]]\nname = \"k\"\nfrom = { node = \"b\" }\nto = { node = \"d\" }\nstiffness = 1.0\n";
    let floor = "[[contacts]]\nname = \"floor\"\nwith = \"stay\"\nstiffness = 1e6\ndamping = 1.0\n\
                 surface = { shape = \"plane\", point = [0.0, 0.0, -1.0], normal = [0.0, 0.0, 1.0] }\n";
    let flies = initial("stay", "velocity = [1.0, 0.0, 0.0]");
    let load = "[[loads]]\nat = \"d\"\nforce = [1.0, 0.0, 0.0]\n";
    for more in [link, floor, &flies, load] {
        is_silent_about("nothing joins", &format!("{held}{gravity}{more}"));
    }
    // Without any support a fall into the void is none that is meant; without gravity, or with a floor, it may be.
    says(&format!("{two}{gravity}"), Severity::Warning, &["holds `mast` or any other part", "fall freely"]);
    for more in [String::new(), format!("{gravity}{floor}")] {
        is_silent_about("fall freely", &format!("{two}{more}"));
    }
    // One of two that fall alike never meets the floor.
    let alike = initial("all", "velocity = [0.0, 0.0, -4.0]");
    says(
        &format!("{two}{gravity}{floor}{alike}"),
        Severity::Note,
        &["`mast` starts with the velocity of other parts", "nothing joins it"],
    );
    let both = floor.replace("\"stay\"", "[\"stay\", \"mast\"]");
    is_silent_about("velocity of other parts", &format!("{two}{gravity}{both}{alike}"));
    let behind = both.replace("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, -1.0]");
    says(
        &format!("{two}{gravity}{behind}"),
        Severity::Warning,
        &["everything lies behind the plane", "up to 4.025 deep"],
    );
    is_silent_about("behind the plane", &format!("{two}{gravity}{both}"));
    // A mass at a point of its own is a part too.
    let payload = "[[masses]]\nat = \"c\"\nmass = 800.0\n";
    let mast = format!(
        "{points}{}[[supports]]\nat = \"a\"\nfix = \"all\"\n{gravity}{payload}",
        beam("mast", "\"a\", \"b\"", 2)
    );
    says(&mast, Severity::Warning, &["nothing joins `c` to the parts that supports hold", "falls freely"]);
    is_silent_about("nothing joins", &mast.replace("at = \"c\"\nmass", "at = \"b\"\nmass"));
    // What flies is meant to, perhaps.
    says(&format!("{two}{gravity}{flies}"), Severity::Note, &["holds `mast` or any other part", "fall freely"]);
}

/// One of two parts that share a node moves at t = 0, so that the velocity jumps between neighbouring nodes.
#[test]
fn a_part_at_rest_beside_one_that_moves_is_said() {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 3.0]\nc = [2.0, 0.0, 3.0]\n";
    let two = format!("{points}{}{}", beam("mast", "\"a\", \"b\"", 2), beam("arm", "\"b\", \"c\"", 2));
    let moves = |at: &str| format!("{two}{}", initial(at, "velocity = [4.43, 0.0, 0.0]"));
    says(&moves("arm"), Severity::Note, &["`arm` starts at 4.43", "`mast`, which shares `b` with it, at rest"]);
    is_silent_about("at rest: the velocity jumps", &moves("all"));
    is_silent_about("at rest: the velocity jumps", &moves("c"));
}

/// A relative tolerance above 1 was meant in percent; a mesh in mm makes a model of hundreds of metres.
#[test]
fn a_tolerance_in_percent_is_said() {
    let mast = format!("[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 3.0]\n{}", beam("mast", "\"a\", \"b\"", 2));
    let expect = |tolerance: &str| {
        let of = "[[expect]]\nat = \"b\"\nquantity = \"ux\"\ntime = \"end\"\nvalue = 1.0\n";
        format!("{mast}{}{of}tolerance = {tolerance}\n", initial("mast", "velocity = [1.0, 0.0, 0.0]"))
    };
    says(&expect("5"), Severity::Note, &["`tolerance` is 500 % of the expected value"]);
    is_silent_about("% of the expected value", &expect("0.05"));
}

/// A weight that acts at once sags to twice its deflection at rest as the ground begins to move. A static stage before, an amplitude or no
/// moving ground are no such slip.
#[test]
fn a_weight_at_once_under_a_moving_ground_is_said() {
    let quake = "[amplitudes.quake]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]\n\
                 [[environment.base_acceleration]]\ndirection = [1.0, 0.0, 0.0]\namplitude = \"quake\"\n";
    let mast = format!(
        "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 3.0]\n{}[[supports]]\nat = \"a\"\nfix = \"all\"\n",
        beam("mast", "\"a\", \"b\"", 2)
    );
    let weight = "[environment]\ngravity = [0.0, 0.0, -9.81]\n";
    says(&format!("{mast}{weight}{quake}"), Severity::Warning, &["gravity acts at once", "sags to twice"]);
    let grown = format!("{weight}gravity_amplitude = \"rise\"\n{quake}[amplitudes.rise]\nkind = \"ramp\"\nend = 0.5\n");
    for more in [grown, weight.to_owned(), format!("[environment]\n{quake}")] {
        is_silent_about("gravity acts at once", &format!("{mast}{more}"));
    }
}

/// Where nothing acts, all results are zero, and the run says so.
#[test]
fn a_run_without_any_load_is_told() {
    let mast = format!(
        "{OPENING}[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 3.0]\n{}[[supports]]\nat = \"a\"\nfix = \"all\"\n",
        beam("mast", "\"a\", \"b\"", 2)
    );
    let fixed = format!("{mast}[[loads]]\nat = \"a\"\nforce = [1.0, 0.0, 0.0]\n");
    for kind in ["dynamic", "static"] {
        let set = format!("analysis.kind={kind}");
        for deck in [&mast, &fixed] {
            assert!(said_of(deck, &["--set", &set]).contains("nothing moves: no load"), "{kind}");
        }
        let loaded = fixed.replace("at = \"a\"\nforce", "at = \"b\"\nforce");
        assert!(!said_of(&loaded, &["--set", &set]).contains("nothing moves"), "{kind}");
    }
}

/// Rows that are farther apart than a third of a period miss its peaks, and the run says so with the period; rows that follow the motion, a
/// bounce within a few of them, and a small vibration on a slow motion are told nothing.
#[test]
fn rows_too_far_apart_for_the_motion_are_told() {
    // ω = 20 π: a period of 0.1.
    let oscillator = |interval: f64, more: &str| {
        format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = 0.001\n[integrator]\nscheme = \"newmark\"\n\
             [points]\np = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"p\"\nmass = 1.0\n[[links]]\nname = \"spring\"\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ node = \"p\" }}\nstiffness = 3947.84\n[[supports]]\nat = \"p\"\n\
             fix = [\"uy\", \"uz\"]\n[output]\ninterval = {interval:?}\n{more}"
        )
    };
    let moving = "[[initial]]\nat = \"p\"\nvelocity = [1.0, 0.0, 0.0]\n";
    for (interval, told) in [(0.025, true), (0.031, true), (0.043, true), (0.02, false), (0.01, false)] {
        let said = said_of(&oscillator(interval, moving), &[]);
        let period = said
            .split("apart for `p`: between")
            .nth(1)
            .map(|rest| rest.split("period near ").nth(1).unwrap().split(". ").next().unwrap().parse::<f64>().unwrap());
        assert_eq!(period.is_some(), told, "{interval}: {said}");
        // The rows of two seconds hold no whole number of periods.
        assert!(period.is_none_or(|period| (period - 0.1).abs() < 0.01), "{interval}: {said}");
    }
    // A slow push of 0.5 with a vibration of 0.001 on it.
    let pushed = "[[loads]]\nat = \"p\"\nforce = [2000.0, 0.0, 0.0]\namplitude = \"slow\"\n[amplitudes.slow]\n\
                  kind = \"sine-squared\"\nfrequency = 0.25\n[[initial]]\nat = \"p\"\nvelocity = [0.06, 0.0, 0.0]\n";
    assert!(!said_of(&oscillator(0.043, pushed), &[]).contains("too far apart"));
    let bouncing = "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = 0.0005\n[[bodies]]\nname = \"ball\"\ncenter = [0.0, 0.0, 0.6]\n\
                    mass = 1.0\nshape = { kind = \"sphere\", radius = 0.1 }\n[[contacts]]\nname = \"floor\"\nwith = \"ball\"\nstiffness = 1e6\n\
                    surface = { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\nrestitution = 0.9\n\
                    [environment]\ngravity = [0.0, 0.0, -9.81]\n[output]\ninterval = 0.05\n";
    assert!(!said_of(bouncing, &[]).contains("too far apart"), "{}", said_of(bouncing, &[]));
}

/// Steel that hardens is noted where the ground shakes or a load has both signs, unless the deck chooses the hardening.
#[test]
fn isotropic_hardening_in_cycles_is_noted() {
    let deck = |hardening: &str, load: &str| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.5\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
             [materials.steel]\nmodel = \"elastic-plastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\nyield_stress = 235e6\n{hardening}\n\
             [[bars]]\nname = \"bar\"\npath = [\"a\", \"b\"]\narea = 1e-4\nmaterial = \"steel\"\n[[supports]]\nat = \"a\"\nfix = \"translations\"\n\
             [[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n[[loads]]\nat = \"b\"\nforce = [1000.0, 0.0, 0.0]\namplitude = \"way\"\n\
             [amplitudes.way]\nkind = \"table\"\npoints = {load}\n"
        )
    };
    let (cycle, push) = ("[[0.0, 0.0], [0.5, 1.0], [1.0, -1.0]]", "[[0.0, 0.0], [1.0, 1.0]]");
    let table = "hardening = [[0.0, 235e6], [0.1, 300e6]]";
    for (hardening, load, noted) in [
        ("hardening_modulus = 2e9", cycle, true),
        (table, cycle, true),
        ("hardening_modulus = 2e9", push, false),
        ("hardening_modulus = 0.0", cycle, false),
        ("", cycle, false),
        ("hardening_modulus = 2e9\nkinematic_share = 1.0", cycle, false),
        ("hardening_modulus = 2e9\nkinematic_share = 0.0", cycle, false),
    ] {
        let deck = deck(hardening, load);
        let deck = if hardening == table { deck.replace("yield_stress = 235e6\n", "") } else { deck };
        let said = said_of(&deck, &[]);
        assert_eq!(said.contains("the hardening of `steel` is isotropic"), noted, "{hardening}, {load}: {said}");
    }
}

/// A mechanism that rests moves by rounding between its rows: no motion, and no warning.
#[test]
fn rounding_between_rows_is_no_motion() {
    let deck = "[analysis]\nkind = \"dynamic\"\nend_time = 2.0\ntime_step = 0.005\n[environment]\ngravity = [0.0, 0.0, -9.81]\n[output]\nevery = 7\n\
                [[bodies]]\nname = \"bob\"\ncenter = [0.3, 0.1, -0.6]\nmass = 800.0\ninertia = [80.0, 80.0, 80.0]\n\
                [[links]]\nname = \"rope\"\nfrom = { ground = [0.3, 0.1, 1.0] }\nto = { body = \"bob\" }\nstiffness = 1e9\nfree_length = 1.599992152\n";
    let said = said_of(deck, &[]);
    assert!(!said.contains("too far apart"), "{said}");
}
