//! Statics does not answer where it has no answer: mechanisms, buckling, equilibria that jump, elements turned over.

use crate::support::truss::TRUSS;
use crate::support::{Row, node, read_deck, tables_of};
use rdsolve::model::Model;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Failure, Outcome, Run};
use rdsolve::state::State;
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;

struct Nobody;

impl rdsolve::solve::Observer for Nobody {
    fn on_step(&mut self, _: &rdsolve::solve::Frame) -> std::io::Result<()> {
        Ok(())
    }
}

/// What a run says besides its results.
pub struct Said {
    pub outcome: Outcome,
    pub warnings: Vec<String>,
    pub remarks: Vec<String>,
    /// The part of the energy that the balance of work misses.
    pub missed: Option<f64>,
    pub iterations: usize,
}

/// How a deck ends, its last state, and what the run warns of.
fn run(text: &str) -> (Model, Outcome, State, Vec<String>) {
    let (model, state, Said { outcome, warnings, .. }) = said(text);
    (model, outcome, state, warnings)
}

/// How a deck ends, its last state, and all that the run says.
pub fn said(text: &str) -> (Model, State, Said) {
    let model = read_deck(text);
    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut run = Run::new(&model, &system, &plan, wanted(&model), &stop).unwrap();
    let (outcome, state) = run.run(&mut Nobody);
    let warnings = run.warnings().iter().map(ToString::to_string).collect();
    let remarks = run.remarks().iter().map(ToString::to_string).collect();
    let missed = run.missed_work().map(|(missed, energy)| missed / energy);
    let said = Said { outcome, warnings, remarks, missed, iterations: run.counts().iterations };
    drop(run);
    (model, state.expect("a state"), said)
}

fn failure(text: &str) -> Failure {
    match run(text).1 {
        Outcome::Failed { failure, .. } => failure,
        other => panic!("{other:?}"),
    }
}

/// A steel section of 30 x 5 mm; load steps of this length.
pub fn head(step: f64, more: &str) -> String {
    format!(
        r#"
title = "statics"
[analysis]
kind = "static"
end_time = 1.0
time_step = {step}
{more}
[materials.steel]
model = "elastic"
youngs_modulus = 2.1e11
poisson_ratio = 0.3
density = 7850.0
[sections.s]
shape = "rectangle"
width = 0.03
height = 0.005
"#
    )
}

pub fn beam(name: &str, path: [&str; 2], elements: usize) -> String {
    format!(
        "[[beams]]\nname = \"{name}\"\npath = {path:?}\nelements = {elements}\nsection = \"s\"\nmaterial = \"steel\"\n\
         orientation = [0.0, 1.0, 0.0]\n"
    )
}

pub const GRAVITY: &str = "[environment]\ngravity = [0.0, 0.0, -9.81]\n";

/// A clamped column of 1 m under its end load; `axis`: the direction of its width.
pub fn column(load: f64, step: f64, axis: &str, more: &str) -> String {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 1.0]\n";
    let supports =
        format!("[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -{load:?}]\n");
    format!("{}{points}{}{supports}", head(step, more), beam("c", ["a", "b"], 10).replace("[0.0, 1.0, 0.0]", axis))
}

#[test]
fn columns_above_their_buckling_load_are_warned_of() {
    // π² EI/4L² = 161.92 N about the weak axis; ten elements of second order are within 1e-4, and the load between the ends of a step
    // within 1e-5 of the step.
    let weak = std::f64::consts::PI.powi(2) * 2.1e11 * 0.03 * 0.005f64.powi(3) / 12.0 / 4.0;
    for (axis, step, control) in [
        ("[0.0, 1.0, 0.0]", 0.1, ""),
        ("[0.0, 1.0, 0.0]", 1.0, "plane = \"off\""),
        ("[1.0, 0.0, 0.0]", 0.1, ""),
        ("[1.0, 0.0, 0.0]", 0.1, "plane = \"off\""),
        ("[1.0, 0.0, 0.0]", 0.02, "control = \"arc-length\""),
    ] {
        let (_, outcome, _, warnings) = run(&column(1000.0, step, axis, control));
        // A run that stays on the unstable branch ends there; where no load step can leave it, a warning tells.
        let text = &match (&outcome, &warnings[..]) {
            (Outcome::Failed { failure: failure @ Failure::Buckles(_), .. }, []) => failure.to_string(),
            (Outcome::Done, [text]) => text.clone(),
            _ => panic!("{axis} {step} {control}: {outcome:?} {warnings:?}"),
        };
        let time = super::stability::time(text);
        assert!((1000.0 * time / weak - 1.0).abs() < 2e-3, "{text}");
        assert!(text.contains(if axis.starts_with("[1") {
            "`b` most, in direction uy"
        } else {
            "`b` most, in direction ux"
        }));
    }
    for axis in ["[0.0, 1.0, 0.0]", "[1.0, 0.0, 0.0]"] {
        assert_eq!(run(&column(160.0, 0.1, axis, "")).3, Vec::<String>::new());
    }
}

#[test]
fn mechanisms_are_named_whatever_rounding_leaves_of_their_pivots() {
    let oblique = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.6, 0.48, 0.64]\n";
    let straight = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n";
    let hold = |at: &str| format!("[[supports]]\nat = \"{at}\"\nfix = \"translations\"\n");
    for points in [oblique, straight] {
        for elements in [4, 7, 16] {
            for ends in [&["a"][..], &["a", "b"]] {
                let supports: String = ends.iter().map(|at| hold(at)).collect();
                let beams = beam("l", ["a", "b"], elements);
                let deck = format!("{}{GRAVITY}{points}{beams}{supports}", head(0.1, "plane = \"off\""));
                let failure = failure(&deck);
                assert!(matches!(failure, Failure::Singular { .. }), "{elements} {ends:?}: {failure}");
            }
        }
    }
}

/// Further kinds: a hinge about the normal with its load in the plane, a parallelogram, a rod between balls that turns about itself, a beam
/// that slides.
#[test]
fn mechanisms_with_joints_are_named() {
    let joint = |name: &str, kind: &str, from: &str, to: &str| {
        format!(
            "[[joints]]\nname = \"{name}\"\nkind = \"{kind}\"\nfrom = {{ node = \"{from}\" }}\nto = {{ node = \"{to}\" }}\n"
        )
    };
    let hold = |at: &str, fix: &str| format!("[[supports]]\nat = \"{at}\"\nfix = {fix}\n");
    let pull = |force: &str| format!("[[loads]]\nat = \"b\"\nforce = {force}\n");
    let (all, translations, y) = ("\"all\"", "\"translations\"", "axis = [0.0, 1.0, 0.0]\n");
    let row = "[points]\na = [0.0, 0.0, 0.0]\nm = [1.0, 0.0, 0.0]\nn = [1.0, 0.0, 0.0]\n";
    let frame = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 1.0]\nc = [2.0, 0.0, 1.0]\nd = [2.0, 0.0, 0.0]\n\
                 e = [0.0, 0.0, 1.0]\nf = [2.0, 0.0, 1.0]\n";
    let two = beam("l", ["a", "m"], 6) + &beam("r", ["n", "b"], 6);
    let three = beam("p", ["a", "b"], 4) + &beam("q", ["d", "c"], 4) + &beam("t", ["e", "f"], 6);
    let scenes = [
        format!(
            "{row}b = [2.0, 0.0, 0.0]\n{two}{}axis = [0.0, 0.0, 1.0]\n{}{}",
            joint("h", "hinge", "m", "n"),
            hold("a", all),
            pull("[0.0, 1.0, 0.0]")
        ),
        format!(
            "{frame}{three}{}{y}{}{y}{}{}{}",
            joint("h", "hinge", "b", "e"),
            joint("k", "hinge", "c", "f"),
            hold("a", translations),
            hold("d", translations),
            pull("[1.0, 0.0, 0.0]")
        ),
        // Under its own weight the rod would sag, and hang.
        format!(
            "{row}b = [2.0, 0.3, 0.0]\n{two}{}{}{}{}",
            joint("h", "ball", "m", "n"),
            hold("a", all),
            hold("b", translations),
            pull("[0.0, 0.0, -1.0]").replace("\"b\"", "\"m\"")
        ),
        format!(
            "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n{}{}",
            beam("l", ["a", "b"], 5),
            hold("a", "[\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]")
        ),
    ];
    for scene in scenes {
        for (step, plane) in [(1.0, ""), (0.1, "plane = \"off\"")] {
            let gravity = if scene.contains("at = \"m\"") { "" } else { GRAVITY };
            let failure = failure(&format!("{}{gravity}{scene}", head(step, plane)));
            assert!(matches!(failure, Failure::Singular { .. }), "{failure}\n{scene}");
        }
    }
}

#[test]
fn two_beams_in_line_joined_by_a_hinge_are_refused_with_every_step() {
    // The hinge resists only once it has moved: the tangent is singular at t = 0, whatever way leads to the 6.925 mm of the answer.
    let points = "[points]\na = [0.0, 0.0, 0.0]\nm = [1.0, 0.0, 0.0]\nn = [1.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n";
    let hinge = "[[joints]]\nname = \"h\"\nkind = \"hinge\"\nfrom = { node = \"m\" }\nto = { node = \"n\" }\naxis = [0.0, 1.0, 0.0]\n";
    let beams = beam("l", ["a", "m"], 10) + &beam("r", ["n", "b"], 10);
    let supports = "[[supports]]\nat = [\"a\", \"b\"]\nfix = \"translations\"\n";
    for step in [1.0, 0.1, 0.02] {
        let failure = failure(&format!("{}{GRAVITY}{points}{beams}{hinge}{supports}", head(step, "")));
        let Failure::Singular { label, direction, .. } = &failure else { panic!("{step}: {failure}") };
        assert!(["m", "n"].contains(&label.as_str()) && *direction == "uz", "{failure}");
    }
}

/// Two beams in line without hardening, 400 mm² and 2500 mm²: beyond 100 kN the thin one has no stiffness left, and the message names it.
#[test]
fn a_part_that_yields_throughout_is_named() {
    let square = |name: &str, side: f64| {
        format!("[sections.{name}]\nshape = \"rectangle\"\nwidth = {side:?}\nheight = {side:?}\n")
    };
    let part = |name: &str, path: [&str; 2], section: &str| {
        format!(
            "[[beams]]\nname = \"{name}\"\npath = {path:?}\nelements = 2\nmaterial = \"soft\"\nsection = \"{section}\"\n\
             orientation = [0.0, 1.0, 0.0]\n"
        )
    };
    let text = format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.1\n\
         [materials.soft]\nmodel = \"elastic-plastic\"\nyoungs_modulus = 210e9\npoisson_ratio = 0.3\nyield_stress = 250e6\n{}{}\
         [points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [2.0, 0.0, 0.0]\n{}{}\
         [[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"c\"\nforce = [110e3, 0.0, 0.0]\n",
        square("thick", 0.05),
        square("thin", 0.02),
        part("shank", ["a", "b"], "thick"),
        part("neck", ["b", "c"], "thin"),
    );
    let text = failure(&text).to_string();
    assert!(text.contains("beam `neck` yields most"), "{text}");
}

/// The truss under a load on its crown: it bears 38.2 at most, beyond which it snaps through.
pub fn truss(load: f64, step: f64) -> String {
    format!(
        r#"
title = "truss"
[analysis]
kind = "static"
end_time = 1.0
time_step = {step}
least_step = 1e-6
{TRUSS}[[loads]]
at = "crown"
force = [0.0, 0.0, -{load:?}]
"#
    )
}

#[test]
fn a_truss_under_load_control_does_not_snap_through_in_silence() {
    for step in [1.0, 0.3, 0.1] {
        let (_, outcome, state, _) = run(&truss(60.0, step));
        let Outcome::Failed { failure, .. } = &outcome else { panic!("{step}: {outcome:?}") };
        let text = failure.to_string();
        assert!(matches!(failure, Failure::EquilibriumJumps { .. } | Failure::NotConverged { .. }), "{step}: {text}");
        // The limit load by arc length is 38.2 of 60; the last equilibrium lies just below.
        assert!(state.time > 0.55 && state.time < 0.645, "{step}: {}", state.time);
        let (_, below, _, warnings) = run(&truss(36.0, step));
        assert!(matches!(below, Outcome::Done) && warnings.is_empty(), "{step}: {below:?} {warnings:?}");
    }
}

#[test]
fn beams_are_not_compressed_through_zero_length() {
    // EA = 3.15e7: under 4e7 the column would be as long as it was, less 1.27 times its length.
    let held = "[[supports]]\nat = \"b\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n";
    let deck = column(4e7, 0.5, "[0.0, 1.0, 0.0]", "").replace("elements = 10", "elements = 1") + held;
    let failure = failure(&deck);
    // Between its ends it buckles long before.
    assert!(
        matches!(&failure, Failure::TurnedOver { name } if name == "c") || matches!(&failure, Failure::Buckles(_)),
        "{failure}"
    );
}

#[test]
fn a_cantilever_rolled_up_in_one_step_keeps_its_balance() {
    // M = 2π EI/L rolls it into a circle; the moment does ½ M 2π of work.
    let stiffness = 2.1e11 * 0.03 * 0.005f64.powi(3) / 12.0;
    let moment = 2.0 * std::f64::consts::PI * stiffness;
    let deck = column(1.0, 1.0, "[0.0, 1.0, 0.0]", "")
        .replace("force = [0.0, 0.0, -1.0]", &format!("moment = [0.0, {moment:?}, 0.0]"))
        .replace("elements = 10", "elements = 20");
    let (model, outcome, state, warnings) = run(&deck);
    assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{outcome:?} {warnings:?}");
    let work = state.work.external / (std::f64::consts::PI * moment);
    // Twenty elements turn by 18 degrees each: 1e-5 of the energy.
    assert!((work - 1.0).abs() < 1e-3, "{work}");
    assert!(state.nodes[node(&model, "b")].x.norm() < 1e-3, "{:?}", state.nodes[node(&model, "b")].x);
}

#[test]
fn tiny_loads_keep_their_digits_or_say_so() {
    let shell = |load: f64| {
        head(1.0, "").replace("width = 0.03", "width = 0.05")
            + &format!(
                r#"
[points]
a = [0.0, 0.0, 0.0]
b = [0.8, 0.6, 0.0]
c = [0.8, 0.6, 1.0]
d = [0.0, 0.0, 1.0]
[[shells]]
name = "s"
corners = ["a", "b", "c", "d"]
elements = [4, 4]
thickness = 0.002
material = "steel"
[[supports]]
at = "s.edge1"
fix = "all"
[[loads]]
at = "d"
force = [{:?}, {:?}, 0.0]
"#,
                0.6 * load,
                -0.8 * load
            )
    };
    let deflection = |load: f64| {
        let (model, outcome, state, warnings) = run(&shell(load));
        assert!(matches!(outcome, Outcome::Done), "{load:e}: {outcome:?}");
        (state.nodes[node(&model, "d")].moved(&model.nodes[node(&model, "d")].x).y / load, warnings)
    };
    // Strains of 1e-9 have seven digits, of 1e-15 hardly one.
    let (exact, none) = deflection(1e-3);
    assert!(none.is_empty(), "{none:?}");
    let (u, warnings) = deflection(1e-9);
    assert!((u / exact - 1.0).abs() < 1e-5 || !warnings.is_empty(), "{u} {exact}");
    let (_, warnings) = deflection(1e-12);
    assert!(warnings.len() == 1 && warnings[0].contains("which is rounding error"), "{warnings:?}");
}

#[test]
fn loads_that_go_back_to_zero_are_judged_by_those_that_have_been() {
    let ways = [
        // To zero at the end, through zero on the way, and from one load to another while the first fades.
        "[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]",
        "[[0.0, 0.0], [0.25, 1.0], [0.5, 0.0], [0.75, -1.0], [1.0, 0.0]]",
        "[[0.0, 0.5], [0.5, 1.0], [1.0, 0.0]]",
        "[[0.0, 1.0], [0.5, 0.0], [1.0, 0.0]]",
    ];
    for (way, yields) in ways.into_iter().map(|way| (way, false)).chain(ways[..2].iter().map(|way| (*way, true))) {
        let mut deck = head(0.125, "")
            + &beam("beam", ["a", "b"], 4)
            + &format!(
                r#"
[points]
a = [0.0, 0.0, 0.0]
b = [0.7, 0.1, 0.9]
[[supports]]
at = "a"
fix = "all"
[[loads]]
at = "b"
force = [3.0, 1.0, 1.0]
amplitude = "way"
[amplitudes.way]
kind = "table"
points = {way}
"#
            );
        if yields {
            deck = deck.replace(
                "model = \"elastic\"",
                "model = \"elastic-plastic\"\nyield_stress = 1.2e7\nhardening_modulus = 1e9",
            );
        }
        let (model, outcome, state, warnings) = run(&deck);
        assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{way}: {outcome:?} {warnings:?}");
        let b = node(&model, "b");
        let left = state.nodes[b].moved(&model.nodes[b].x).norm();
        // Elastically the beam is back where it began, to the rounding of positions a thousand times over; yielding, it is bent.
        assert!(if yields { left > 1e-4 } else { left < 1e-12 }, "{way}: {left:e}");
    }
}

/// A cantilever of 1 m under 30 N at its tip with this amplitude.
fn cantilever(amplitude: &str, step: f64) -> String {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.8, 0.0, 0.6]\n";
    let load = "[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -30.0]\namplitude = \"c\"\n";
    format!("{}{points}{}{load}[amplitudes.c]\n{amplitude}\n", head(step, ""), beam("be", ["a", "b"], 6))
}

#[test]
fn loads_that_go_back_to_zero_leave_no_doubt() {
    for (amplitude, step) in [
        ("kind = \"table\"\npoints = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]", 0.25),
        ("kind = \"table\"\npoints = [[0.0, 0.0], [0.25, 1.0], [0.75, -1.0], [1.0, 0.0]]", 0.05),
        ("kind = \"table\"\npoints = [[0.0, 0.0], [0.4, 0.0], [0.5, 1.0], [0.7, 0.0], [1.0, 0.0]]", 0.1),
        ("kind = \"step\"\nstart = 0.5\nend = 0.8", 0.25),
    ] {
        let (model, state, said) = said(&cantilever(amplitude, step));
        assert!(matches!(said.outcome, Outcome::Done) && said.warnings.is_empty(), "{amplitude} {:?}", said.warnings);
        let b = node(&model, "b");
        assert!(state.nodes[b].moved(&model.nodes[b].x).norm() < 1e-12, "{amplitude}");
        // Six or seven a step under load; where nothing acts it ends as soon.
        assert!(said.iterations as f64 * step < 8.0, "{amplitude} {}", said.iterations);
    }
    // What is left after it has yielded is measured as well.
    let rest = "kind = \"table\"\npoints = [[0.0, 0.0], [0.5, 1.0], [0.9, 1e-14], [1.0, 1e-14]]";
    let (_, _, _, warnings) = run(&cantilever(rest, 0.1));
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn supports_that_move_all_as_one_leave_no_doubt() {
    let points = "[points]\na = [0.0, 0.0, 0.5]\nb = [0.3, 0.0, 0.01]\n";
    let drive = "[[supports]]\nat = \"a\"\nfix = [\"uy\", \"rx\", \"rz\"]\n[[supports]]\nat = \"a\"\n\
                 motion = { ux = { amplitude = \"r\", scale = 0.1 }, uz = { amplitude = \"r\", scale = -0.03 }, ry = { amplitude = \"r\", scale = 1.0 } }\n\
                 [amplitudes.r]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n";
    let (_, _, said) = said(&format!("{}{points}{}{drive}", head(0.1, ""), beam("be", ["a", "b"], 6)));
    assert!(matches!(said.outcome, Outcome::Done) && said.warnings.is_empty(), "{:?}", said.warnings);
    assert_eq!(said.missed, None);
}

/// A beam that its support turns by 1.3 rad in its plane, under a load that does as much work as the support takes.
fn turned(step: f64) -> String {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n";
    let drive = "[[supports]]\nat = \"a\"\nfix = \"translations\"\n[[supports]]\nat = \"a\"\nmotion = { rz = { amplitude = \"r\", scale = 1.3 } }\n\
                 [amplitudes.r]\nkind = \"ramp\"\nstart = 0.0\nend = 1.0\n[[loads]]\nat = \"b\"\nforce = [0.0, 2.0, 0.0]\n";
    format!("{}{points}{}{drive}", head(step, ""), beam("be", ["a", "b"], 8))
}

#[test]
fn what_the_balance_of_work_misses_is_of_second_order() {
    let missed = |step: f64| said(&turned(step)).2.missed.expect("a balance");
    let [coarse, middle, fine] = [0.1, 0.05, 0.025].map(missed);
    for ratio in [coarse / middle, middle / fine] {
        assert!((ratio - 4.0).abs() < 0.4, "{coarse:e} {middle:e} {fine:e}");
    }
    // One step of the whole motion is warned of, ten are not: 0.04.
    assert!(missed(1.0).abs() > 0.04 && coarse.abs() < 0.04, "{} {coarse}", missed(1.0));
    // Loads that act at once are brought on in one step, and miss what a ramp in one step misses.
    let [sudden, ramp] = [("kind = \"constant\"", 0.25), ("kind = \"ramp\"\nstart = 0.0\nend = 1.0", 1.0)]
        .map(|(amplitude, step)| said(&cantilever(amplitude, step)).2.missed.expect("a balance"));
    assert!((sudden - ramp).abs() < 1e-6 && sudden.abs() < 0.06, "{sudden} {ramp}");
}

#[test]
fn beams_in_line_a_little_out_of_line_do_not_snap_through_in_silence() {
    // A rise of 1 mm over 1 m carries a hundredth of the weight.
    for (rise, step) in [(0.001, 1.0), (0.001, 0.2), (0.001, 0.05), (0.001, 0.01), (0.0005, 0.05), (0.002, 0.02)] {
        let points = format!(
            "[points]\na = [0.0, 0.0, 0.0]\nm = [1.0, 0.0, {rise:?}]\nn = [1.0, 0.0, {rise:?}]\nb = [2.0, 0.0, 0.0]\n"
        );
        let hinge = "[[joints]]\nname = \"h\"\nkind = \"revolute\"\nfrom = { node = \"m\" }\nto = { node = \"n\" }\naxis = [0.0, 1.0, 0.0]\n";
        let beams = beam("l", ["a", "m"], 4) + &beam("r", ["n", "b"], 4);
        let supports = "[[supports]]\nat = [\"a\", \"b\"]\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"rz\"]\n";
        let (_, state, said) = said(&format!("{}{GRAVITY}{points}{beams}{hinge}{supports}", head(step, "")));
        let told = matches!(said.outcome, Outcome::Failed { .. }) && state.time < 0.03
            || said.missed.is_some_and(|missed| missed.abs() > 0.05);
        assert!(told, "{rise} {step}: {:?} {:?}", said.outcome, said.missed);
    }
}

/// A beam on a pin and on a link that only pushes, under a load of this amplitude.
fn lifted(step: f64, elements: usize) -> String {
    let points = "[points]\na = [0.0, 0.0, 0.5]\nb = [0.9, 0.37, 0.0]\n";
    let rest = r#"[[supports]]
at = "a"
fix = ["ux", "uy", "uz", "rz"]
[[supports]]
at = "b"
fix = ["uy"]
[[links]]
name = "g"
from = { node = "b" }
to = { ground = [0.9, 0.37, -1.0] }
law = "compression-only"
stiffness = 1e5
free_length = 1.0005
[[loads]]
at = "b"
force = [0.0, 0.0, 1.0]
amplitude = "p"
[amplitudes.p]
kind = "table"
points = [[0.0, 0.0], [0.3, -100.0], [0.6, 50.0], [1.0, 50.0]]
"#;
    format!("{}{points}{}{rest}", head(step, ""), beam("be", ["a", "b"], elements))
}

#[test]
fn a_support_that_lifts_off_is_named() {
    for (step, elements) in [(0.1, 3), (0.05, 7), (1.0, 16), (0.1, 16)] {
        let (_, state, said) = said(&lifted(step, elements));
        let Outcome::Failed { failure, .. } = &said.outcome else { panic!("{step} {elements}: {:?}", said.outcome) };
        // The load changes its sign at 0.5; no step length keeps what follows from being looked for.
        assert!((state.time - 0.5).abs() < 1e-3, "{step} {elements}: {}", state.time);
        assert!(failure.to_string().contains("`g`"), "{step} {elements}: {failure}");
    }
}

#[test]
fn supports_that_just_touch_hold_what_presses_on_them() {
    let points = "[points]\na = [0.0, 0.0, 0.5]\nb = [0.9, 0.37, 0.1]\n";
    for (law, ground) in [("compression-only", -0.9), ("tension-only", 1.1)] {
        let rest = format!(
            "[[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"rz\"]\n[[links]]\nname = \"g\"\nfrom = {{ node = \"b\" }}\n\
             to = {{ ground = [0.9, 0.37, {ground:?}] }}\nlaw = \"{law}\"\nstiffness = 1e5\nfree_length = 1.0\n[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -100.0]\n"
        );
        let (model, outcome, state, warnings) =
            run(&format!("{}{points}{}{rest}", head(0.5, ""), beam("be", ["a", "b"], 4)));
        assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{law}: {outcome:?} {warnings:?}");
        // The beam turns about its pin: the link takes the whole load, but for how far the beam leans.
        let down = state.nodes[node(&model, "b")].moved(&model.nodes[node(&model, "b")].x).z;
        assert!((down * 1e5 / -100.0 - 1.0).abs() < 0.02, "{law}: {down}");
    }
}

#[test]
fn limit_loads_are_told_how_to_be_passed() {
    let failure = failure(&truss(60.0, 0.1));
    assert!(failure.to_string().contains("arc-length"), "{failure}");
}

/// A rigid body that nothing but a joint to the ground holds: no stiffness is there at all, and the joint bears weight and moment.
#[test]
fn joints_alone_hold_a_rigid_body() {
    for (kind, soft) in [("fixed", ""), ("fixed", SOFT_SPRING), ("revolute", ""), ("revolute", SOFT_SPRING)] {
        let along = if kind == "fixed" {
            ""
        } else {
            "axis = [0.0, 0.0, 1.0]\nmotion = { position = 0.0, amplitude = \"none\" }"
        };
        let deck = format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.5 }}
            environment = {{ gravity = [0.0, 0.0, -10.0] }}
            output = {{ reactions = true }}
            amplitudes.none = {{ kind = "ramp", end = 1.0 }}
            {soft}
            [[bodies]]
            name = "jib"
            center = [2.0, 0.5, 3.0]
            mass = 100.0
            inertia = [10.0, 130.0, 130.0]
            [[joints]]
            name = "post"
            kind = "{kind}"
            from = {{ ground = [0.0, 0.0, 3.0] }}
            to = {{ body = "jib", point = [0.0, 0.0, 3.0] }}
            {along}
            "#
        );
        let rows = tables_of(&read_deck(&deck)).rows("reactions.csv");
        for (direction, force) in
            [("ux", 0.0), ("uy", 0.0), ("uz", -1000.0), ("rx", -500.0), ("ry", 2000.0), ("rz", 0.0)]
        {
            let of_post = |row: &&Row| row.text("node").starts_with("post") && row.text("direction") == direction;
            let value = rows.iter().rev().find(of_post).expect("a reaction").number("value");
            // What the body exerts on the ground. The iteration leaves 1e-8 of the largest moment.
            assert!((value - force).abs() < 1e-4, "{kind} {direction}: {value} for {force}");
        }
    }
}

/// A spring elsewhere, too soft to tell anything of the weight.
const SOFT_SPRING: &str = r#"
            masses = [{ at = "aside", mass = 1e-6 }]
            points.aside = [9.0, 0.0, 0.0]
            supports = [{ at = "aside", fix = ["uy", "uz"] }]
            links = [{ name = "soft", from = { ground = [8.0, 0.0, 0.0] }, to = { node = "aside" }, stiffness = 1e-3 }]
"#;

/// Springs alone, without mass: F/k₁ + F/k₂.
#[test]
fn points_between_springs_are_a_structure() {
    let link = |name: &str, ends: [&str; 2], stiffness: f64| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = {:?} }}\nto = {{ node = {:?} }}\nstiffness = {stiffness:?}\n",
            ends[0], ends[1]
        )
    };
    let deck = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.5\n[points]\na = [0.0, 0.0, 0.0]\n\
                b = [1.0, 0.0, 0.0]\nc = [2.0, 0.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[supports]]\nat = [\"b\", \"c\"]\n\
                fix = [\"uy\", \"uz\"]\n[[loads]]\nat = \"c\"\nforce = [6.0, 0.0, 0.0]\n"
        .to_owned()
        + &link("soft", ["a", "b"], 100.0)
        + &link("stiff", ["b", "c"], 300.0);
    let (model, outcome, state, warnings) = run(&deck);
    assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{outcome:?} {warnings:?}");
    for (name, exact) in [("b", 0.06), ("c", 0.08)] {
        let i = node(&model, name);
        // Linear: the tolerance of the iteration is 1e-8.
        assert!(
            (state.nodes[i].x.x - model.nodes[i].x.x - exact).abs() < 1e-8 * exact,
            "{name}: {:?}",
            state.nodes[i].x
        );
    }
}
