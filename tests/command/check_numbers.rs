//! Numbers that `check` prints of a scene, beside those that a reader finds by hand.

use assert_cmd::Command;
use std::fs;

/// Two columns 3 m high with a section of 0.01 m², a point mass, a push, a lifted end and a shaken ground.
const FRAME: &str = r#"
[analysis]
kind = "dynamic"
end_time = 2.0
time_step = 0.01
[materials.steel]
model = "elastic-plastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 8000.0
yield_stress = 235e6
[sections.square]
shape = "rectangle"
width = 0.1
height = 0.1
[points]
a = [0.0, 0.0, 0.0]
b = [0.0, 0.0, 3.0]
c = [4.0, 0.0, 0.0]
d = [4.0, 0.0, 3.0]
[[beams]]
name = "left"
path = ["a", "b"]
elements = 2
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
[[beams]]
name = "right"
path = ["c", "d"]
elements = 2
material = "steel"
section = "square"
orientation = [0.0, 1.0, 0.0]
[[masses]]
at = "d"
mass = 480.0
[[supports]]
at = ["a", "c"]
fix = "all"
[[loads]]
at = "b"
force = [100.0, 0.0, -30.0]
[[loads]]
at = "d"
force = [50.0, 0.0, 0.0]
amplitude = "push"
[amplitudes.push]
kind = "ramp"
start = 0.0
end = 1.0
[amplitudes.quake]
kind = "table"
points = [[0.0, 0.0], [0.5, 3.0], [1.0, -4.0], [1.5, 0.0]]
[environment]
gravity = [0.0, 0.0, -10.0]
[[environment.base_acceleration]]
direction = [1.0, 0.0, 0.0]
amplitude = "quake"
scale = 0.5
"#;

fn check(deck: &str, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deck.toml"), deck).unwrap();
    let mut command = Command::cargo_bin("rdsolve").unwrap();
    let done = command.current_dir(folder.path()).args(["check", "deck.toml"]).args(arguments).assert().code(0);
    String::from_utf8(done.get_output().stdout.clone()).unwrap()
}

/// The text behind a label.
#[track_caller]
fn line<'t>(told: &'t str, label: &str) -> &'t str {
    let label = format!("  {label:<11} ");
    let found = told.lines().find_map(|line| line.strip_prefix(&label));
    found.unwrap_or_else(|| panic!("no {label} in\n{told}"))
}

/// Columns of 240 kg with centers at 1.5 m and 480 kg at 3 m: 960 kg at x = (240·4 + 480·4)/960 and z = (480·1.5 + 480·3)/960.
#[test]
fn mass_loads_and_the_ground_are_those_of_a_hand_calculation() {
    let told = check(FRAME, &[]);
    assert_eq!(line(&told, "mass"), "960 with its center at (3, 0, 2.25); weight 9600 under gravity 10 along -z");
    assert_eq!(line(&told, "loads"), "Fx 100 to 150, Fz -30; the largest force is 0.016 times the weight");
    assert_eq!(
        line(&told, "motion"),
        "ground ux: acceleration up to -2 at t = 1; a table of 4 points 0.5 apart, to t = 1.5"
    );
    let told = check(&format!("units = \"SI\"\n{FRAME}"), &[]);
    let mass = "960 kg with its center at (3, 0, 2.25) m; weight 9600 N under gravity 10 m/s² along -z";
    let loads = "Fx 100 to 150 N, Fz -30 N; the largest force is 0.016 times the weight";
    assert_eq!((line(&told, "mass"), line(&told, "loads")), (mass, loads));
    // 2/9.80665 = 0.204.
    let wanted =
        "ground ux: acceleration up to -2 m/s², 0.204 g, at t = 1 s; a table of 4 points 0.5 s apart, to t = 1.5 s";
    assert_eq!(line(&told, "motion"), wanted);
    assert!(line(&told, "effort").starts_with("200 steps in "), "{told}");
    assert!(!told.contains("first mode"), "{told}");
}

/// A girder whose web lies flat under gravity is named with the orientation in which it stands; one that stands, and a flat bar, are not.
#[test]
fn girders_on_their_weak_axis_are_named() {
    let deck = |section: &str, orientation: &str| {
        format!(
            "units = \"SI\"\n[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[points]\na = [0.0, 0.0, 0.0]\nb = [3.0, 0.0, 0.0]\n\
             [materials.steel]\nmodel = \"elastic\"\nE = 210e9\nnu = 0.3\nrho = 7850.0\n[sections.s]\n{section}\n\
             [[beams]]\nname = \"girder\"\npath = [\"a\", \"b\"]\nelements = 4\nmaterial = \"steel\"\nsection = \"s\"\n\
             orientation = {orientation}\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[environment]\ngravity = [0.0, 0.0, -9.81]\n"
        )
    };
    let (girder, bar) = ("profile = \"IPE 200\"", "shape = \"rectangle\"\nwidth = 0.2\nheight = 0.02");
    let flat = check(&deck(girder, "[0.0, 0.0, 1.0]"), &[]);
    assert!(line(&flat, "weak axis").contains("`girder`"), "{flat}");
    assert!(line(&flat, "weak axis").contains("give `orientation` = [0, 1, 0]"), "{flat}");
    for (section, orientation) in [(girder, "[0.0, 1.0, 0.0]"), (bar, "[0.0, 1.0, 0.0]"), (bar, "[0.0, 0.0, 1.0]")] {
        let told = check(&deck(section, orientation), &[]);
        assert!(!told.contains("weak axis"), "{told}");
    }
}

/// Consistent masses have the same sum and center, and loads on faces are pressure times area.
#[test]
fn consistent_masses_and_pressures_count() {
    let consistent = FRAME.replace("section = \"square\"", "section = \"square\"\nmass = \"consistent\"");
    assert_eq!(line(&check(&consistent, &[]), "mass"), line(&check(FRAME, &[]), "mass"));
    let plate = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.5\n[materials.m]\nmodel = \"elastic\"\n\
                 youngs_modulus = 1e7\npoisson_ratio = 0.3\n[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\nc = [2.0, 3.0, 0.0]\n\
                 d = [0.0, 3.0, 0.0]\n[[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [2, 3]\n\
                 thickness = 0.1\nmaterial = \"m\"\n[[supports]]\nat = [\"a\", \"b\", \"c\", \"d\"]\nfix = \"all\"\n\
                 [[loads]]\npart = \"plate\"\npressure = 7.0\n";
    // Pressure acts against the normal, which is +z here.
    assert_eq!(line(&check(plate, &[]), "loads"), "Fz -42 to 0");
}

/// Parts of which the same holds share a line, and a stage prints what differs from the stage before it.
#[test]
fn alike_lines_are_merged() {
    let told = check(FRAME, &[]);
    assert_eq!(told.matches("fibres").count(), 1 + told.matches("fibres of equal").count(), "{told}");
    assert!(line(&told, "yielding").starts_with("beams `left`, `right`: "), "{told}");
    let stage =
        |name: &str| format!("[[stages]]\nname = \"{name}\"\nkind = \"dynamic\"\nduration = 1.0\ntime_step = 0.01\n");
    let begins = FRAME.find("[materials").unwrap();
    let told = check(&format!("{}{}{}", &FRAME[begins..], stage("one"), stage("two")), &[]);
    for label in ["scene", "mass", "yielding", "unknowns"] {
        assert_eq!(told.matches(&format!("\n  {label:<11} ")).count(), 1, "{label} in {told}");
    }
    assert!(told.contains("  otherwise   as in the stage before"), "{told}");
    // The record rises to its peak in the first stage.
    assert_eq!(told.matches("acceleration up to -2 at t = 1").count(), 1, "{told}");
}

/// A mass on a spring: the period is 2π √(m/k), to the four digits that are printed.
#[test]
fn the_first_period_is_that_of_an_oscillator() {
    let deck = "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[[bodies]]\nname = \"ball\"\ncenter = [1.0, 0.0, 0.0]\n\
                mass = 2.0\ninertia = [1.0, 1.0, 1.0]\n[[supports]]\nat = \"ball\"\nfix = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n[[links]]\n\
                name = \"spring\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"ball\" }\nstiffness = 50.0\n";
    let told = check(deck, &["--first-period"]);
    let period = std::f64::consts::TAU * (2.0_f64 / 50.0).sqrt();
    let expected = format!(
        "period {}, frequency {}, of the scene as drawn, without loads; {} steps a period",
        rdsolve::names::short(period),
        rdsolve::names::short(1.0 / period),
        rdsolve::names::to_digits(period / 0.01, 3)
    );
    assert_eq!(line(&told, "first mode"), expected);
    let free = deck.split("[[supports]]").next().unwrap();
    assert!(line(&check(free, &["--first-period"]), "first mode").contains("no mode has stiffness"));
}

/// A sheet that a ball strikes, with nothing said of the scheme.
const STRUCK: &str = r#"
[analysis]
kind = "dynamic"
end_time = 0.01
time_step = "auto"
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [0.5, 0.0, 0.0]
c = [0.5, 0.5, 0.0]
d = [0.0, 0.5, 0.0]
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [4, 4]
thickness = 0.002
material = "steel"
[[bodies]]
name = "ball"
center = [0.3, 0.2, 0.06]
mass = 0.5
velocity = [0.0, 0.0, -5.0]
shape = { kind = "sphere", radius = 0.05 }
[[contacts]]
name = "blow"
surface = { part = "sheet" }
with = "ball"
[[supports]]
at = ["a", "b", "c", "d"]
fix = "all"
"#;

/// The number before a word of a line.
fn number_before(line: &str, word: &str) -> f64 {
    let before = line.split(word).next().unwrap().trim_end();
    before.rsplit(' ').next().unwrap().trim_end_matches(',').parse().unwrap_or_else(|_| panic!("{word} in {line}"))
}

/// Automatic steps of a blow are those of central differences where the deck names no scheme and no error, and their number to the end is low.
#[test]
fn blows_of_parts_that_deform_choose_central_differences() {
    let told = check(STRUCK, &[]);
    let scheme = line(&told, "scheme");
    assert!(scheme.starts_with("central-difference, chosen for automatic steps"), "{told}");
    let step: f64 = line(&told, "step").split(' ').next().unwrap().parse().unwrap();
    let (said, steps) = (number_before(scheme, " steps. "), 0.01 / (0.5 * step));
    // Two digits of the number, three of the step.
    assert!((said - steps).abs() < 0.06 * steps, "{said} {steps}");
    let sets = ["integrator.scheme=\"esdirk3\"", "analysis.error_tolerance=1e-3", "analysis.end_time=1e5"];
    for set in sets {
        let told = check(STRUCK, &["--set", set]);
        assert!(line(&told, "scheme").starts_with("esdirk3"), "{set}: {told}");
    }
    // Nothing deforms where a ball falls on the ground beside the sheet.
    let beside = STRUCK.replace(
        "surface = { part = \"sheet\" }",
        "surface = { shape = \"plane\", point = [0.0, 0.0, -1.0], normal = [0.0, 0.0, 1.0] }",
    );
    assert!(line(&check(&beside, &[]), "scheme").starts_with("esdirk3"));
}

/// Central differences are offered with the number of steps that they then take, measured by making the first ones, where the deck asks for an
/// error; where it names a scheme, or the run would take hours, they are not offered.
#[test]
fn central_differences_are_offered_with_the_steps_that_they_take() {
    let told = check(STRUCK, &["--set", "analysis.error_tolerance=1e-3"]);
    let offer =
        told.lines().find(|line| line.contains("blows of parts that deform")).unwrap_or_else(|| panic!("{told}"));
    let central = "[integrator]\nscheme = \"central-difference\"\n[materials.steel]";
    let accepted = check(&STRUCK.replace("[materials.steel]", central), &[]);
    let [offered, taken] = [number_before(offer, " steps in "), number_before(line(&accepted, "effort"), " steps in ")];
    // The sheet stiffens as it bends, so that steps shorten along the run, and more or fewer of them are made in the time of a check.
    assert!((offered - taken).abs() < 0.2 * taken, "{offered} {taken}");
    assert!(!accepted.contains("blows of parts"), "{accepted}");
    let long = check(&STRUCK.replace("end_time = 0.01", "end_time = 1e5"), &[]);
    assert!(!long.contains("blows of parts"), "{long}");
}

/// The `mass_scaling_step` of each offer adds the mass of the offer, up to the three digits of the step.
#[test]
fn mass_scaling_adds_what_was_offered() {
    let central = "[integrator]\nscheme = \"central-difference\"\n[materials.steel]";
    let deck = STRUCK.replace("[materials.steel]", central);
    let told = check(&deck, &[]);
    let offers: Vec<&str> = told.lines().filter(|line| line.contains("would add")).collect();
    // None follows one that more than doubles the mass.
    let share =
        |offer: &str| offer.split(", ").find_map(|part| part.strip_suffix(" % of the mass of the scene")?.parse().ok());
    let shares: Vec<f64> = offers.iter().map(|offer| share(offer).unwrap()).collect();
    let light = shares.iter().take_while(|share| **share < 100.0).count();
    assert_eq!(shares.len(), (light + 1).min(3), "{told}");
    for offer in offers {
        let behind = |words: &str| offer.split(words).nth(1).unwrap().split(',').next().unwrap().trim();
        let (step, offered) = (behind("`mass_scaling_step` ="), behind("would add").parse::<f64>().unwrap());
        let accepted = check(&deck, &["--set", &format!("integrator.mass_scaling_step={step}")]);
        let added: f64 = line(&accepted, "mass added").split(',').next().unwrap().parse().unwrap();
        assert!((added - offered).abs() < 0.015 * offered, "{offer}: {added}");
    }
}

/// Loads stand beside the weight, so that a wrong unit shows, and a weight that points up is noted. A beam of 54 kg weighs 532 N.
#[test]
fn loads_are_told_beside_the_weight() {
    let deck = |force: &str| {
        format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.25 }}
            environment = {{ gravity = [0.0, 0.0, -9.81] }}
            points = {{ root = [0.0, 0.0, 0.0], tip = [2.0, 0.0, 0.0] }}
            sections.box = {{ shape = "box", width = 0.1, height = 0.2, thickness = 0.006 }}
            supports = [{{ at = "root", fix = "all" }}]
            loads = [{{ at = "tip", force = {force} }}]
            materials.steel = {{ model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }}
            [[beams]]
            name = "beam"
            path = ["root", "tip"]
            elements = 4
            material = "steel"
            section = "box"
            orientation = [0.0, 1.0, 0.0]
            "#
        )
    };
    let said = |force: &str| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("deck.toml"), deck(force)).unwrap();
        let mut check = Command::cargo_bin("rdsolve").unwrap();
        let done = check.current_dir(folder.path()).args(["check", "deck.toml"]).assert().code(0);
        [&done.get_output().stdout, &done.get_output().stderr].map(|said| String::from_utf8(said.clone()).unwrap())
    };
    let [told, noted] = said("[0.0, 0.0, -0.5]");
    assert!(line(&told, "loads").ends_with("the largest force is 0.00094 times the weight"), "{told}");
    assert_eq!(noted, "");
    let [_, noted] = said("[0.0, 0.0, 1e3]");
    assert!(
        noted.starts_with("note: this load acts upwards, against gravity") && noted.contains("[0.0, 0.0, -1000.0]"),
        "{noted}"
    );
}
