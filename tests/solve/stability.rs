//! Buckling is told of whatever matrix leads the iteration, whatever else acts, in the plane of a motion and out of it.

use crate::solve::statics::{Said, beam, column, head, said, truss};
use crate::support::{read_deck, run_with_warnings};
use rdsolve::solve::Outcome;
use rdsolve::system::System;

/// π² EI/4 with EI of the weak axis: a column of 1 m that is clamped, or one of 2 m on pins.
fn weak() -> f64 {
    std::f64::consts::PI.powi(2) * 2.1e11 * 0.03 * 0.005f64.powi(3) / 12.0 / 4.0
}

/// The time in a warning.
pub fn time(text: &str) -> f64 {
    let word = text.split("t = ").nth(1).and_then(|rest| rest.split([' ', ':', ',']).next()).unwrap();
    word.trim_end_matches('.').parse().unwrap()
}

/// What a run says of an equilibrium that becomes unstable: the reason for which it ends there, or its only warning.
fn told(deck: &str) -> String {
    let (_, _, Said { outcome, warnings, .. }) = said(deck);
    match (&outcome, &warnings[..]) {
        (Outcome::Failed { failure, .. }, []) => failure.to_string(),
        (Outcome::Done, [text]) => text.clone(),
        _ => panic!("{outcome:?} {warnings:?}\n{deck}"),
    }
}

const ALONG_X: &str = "[0.0, 1.0, 0.0]";

#[test]
fn the_tangent_is_asked_whatever_matrix_leads_the_iteration() {
    let yields = |deck: String| {
        deck.replace(
            "model = \"elastic\"",
            "model = \"elastic-plastic\"\nyield_stress = 275e6\nhardening_modulus = 1e9",
        )
    };
    let update = |deck: String, update: &str| deck + &format!("[iteration]\nupdate = \"{update}\"\n");
    let column = |step: f64, more: &str| column(1000.0, step, ALONG_X, more);
    for deck in [
        yields(column(1.0, "plane = \"off\"")),
        yields(column(0.5, "plane = \"off\"")),
        yields(column(0.1, "")),
        update(column(0.1, ""), "never"),
        update(column(0.5, ""), "step"),
        update(column(0.5, ""), "auto"),
        // Loads grow along the path, so that it is no limit point that changes the signs of pivots.
        column(0.02, "control = \"arc-length\""),
    ] {
        let text = told(&deck);
        assert!(
            (1000.0 * time(&text) / weak() - 1.0).abs() < 2e-3 && text.contains("`b` most, in direction ux"),
            "{text}"
        );
    }
}

#[test]
fn limit_points_of_a_path_are_not_told_as_buckling() {
    let (_, _, said) = said(&truss(60.0, 0.1).replace("time_step", "control = \"arc-length\"\ntime_step"));
    assert!(
        matches!(said.outcome, Outcome::Done) && said.warnings.is_empty(),
        "{:?} {:?}",
        said.outcome,
        said.warnings
    );
}

#[test]
fn loads_without_a_potential_do_not_hide_buckling() {
    for (axis, load, plane) in [
        (ALONG_X, "force = [0.0, 0.0, 1e-3]\nfollower = true", ""),
        (ALONG_X, "force = [0.0, 0.0, 1e-3]\nfollower = true", "plane = \"off\""),
        (ALONG_X, "moment = [0.0, 0.0, 1e-6]", "plane = \"off\""),
        ("[1.0, 0.0, 0.0]", "force = [0.0, 0.0, 1e-3]\nfollower = true", ""),
    ] {
        let text = told(&(column(1000.0, 0.1, axis, plane) + &format!("[[loads]]\nat = \"b\"\n{load}\n")));
        assert!((1000.0 * time(&text) / weak() - 1.0).abs() < 2e-3, "{text}");
    }
    // Beck's column: a follower force does not buckle it, it flutters at 20.05 EI/L², which is 8.1 times this.
    for factor in [2.0, 6.0] {
        let deck = column(factor * weak(), 0.1, ALONG_X, "").replace("force", "follower = true\nforce");
        assert_eq!(said(&deck).2.warnings, Vec::<String>::new(), "{factor}");
    }
}

/// A column of 2 m on pins, whose plane is that of its strong axis.
fn on_pins(hold: &str) -> String {
    let points = "[points]\na = [0.0, 0.0, 0.0]\nm = [0.0, 0.0, 1.0]\nb = [0.0, 0.0, 2.0]\n";
    let beam = "[[beams]]\nname = \"c\"\npath = [\"a\", \"m\", \"b\"]\nelements = 6\nsection = \"s\"\nmaterial = \"steel\"\n\
                orientation = [1.0, 0.0, 0.0]\n";
    let rest = format!(
        "[[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"uz\"{hold}]\n[[supports]]\nat = \"b\"\nfix = [\"ux\", \"uy\"]\n\
         [[loads]]\nat = \"b\"\nforce = [0.0, 0.0, -1000.0]\n[[loads]]\nat = \"m\"\nforce = [1.0, 0.0, 0.0]\n"
    );
    format!("{}{points}{beam}{rest}", head(0.1, ""))
}

#[test]
fn a_part_that_may_turn_about_its_axis_is_still_seen_to_buckle() {
    for (hold, turns) in [("", true), (", \"rz\"", false)] {
        let text = told(&on_pins(hold));
        assert!(
            (1000.0 * time(&text) / weak() - 1.0).abs() < 2e-3 && text.contains("`m` most, in direction uy"),
            "{text}"
        );
        let remarks = said(&on_pins(hold)).2.remarks;
        assert_eq!(remarks.iter().any(|text| text.contains("direction rz")), turns, "{remarks:?}");
    }
}

#[test]
fn what_is_not_held_in_its_plane_is_said_not_to_be_judged() {
    let portal = |fix: &str| {
        let points = "[points]\na = [0.0, 0.0, 0.0]\nb = [0.0, 0.0, 2.0]\nc = [2.0, 0.0, 2.0]\nd = [2.0, 0.0, 0.0]\n";
        let beam = beam("f", ["a", "d"], 6)
            .replace("\"a\", \"d\"", "\"a\", \"b\", \"c\", \"d\"")
            .replace("[0.0, 1.0, 0.0]", "[1.0, 0.0, 0.0]");
        let beam = beam.replace("[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]");
        let section = head(0.1, "").replace("width = 0.03", "width = 0.005").replace("height = 0.005", "height = 0.05");
        format!(
            "{section}{points}{beam}[[supports]]\nat = [\"a\", \"d\"]\nfix = {fix}\n[[loads]]\nat = [\"b\", \"c\"]\nforce = [1.0, 0.0, -400.0]\n"
        )
    };
    let (_, _, pinned) = said(&portal("[\"ux\", \"uy\", \"uz\"]"));
    assert!(pinned.warnings.is_empty(), "{:?}", pinned.warnings);
    assert!(
        pinned.remarks.iter().any(|text| text.contains("in direction uy") && text.contains("not checked")),
        "{:?}",
        pinned.remarks
    );
    let text = told(&portal("\"all\""));
    assert!(text.contains("out of its plane"), "{text}");
}

#[test]
fn what_is_unstable_from_the_start_is_said_to_be() {
    // Two links press a mass from both sides by 1e4 N each way; across, springs of 1e3 N/m hold it, where the pressure takes 2e4 N/m away.
    let deck = r#"
title = "pressed"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.25
[points]
m = [1.0, 0.0, 0.0]
[[masses]]
at = "m"
mass = 1.0
[[links]]
name = "l1"
from = { ground = [0.0, 0.0, 0.0] }
to = { node = "m" }
stiffness = 1e6
free_length = 1.01
[[links]]
name = "l2"
from = { node = "m" }
to = { ground = [2.0, 0.0, 0.0] }
stiffness = 1e6
free_length = 1.01
[[links]]
name = "ly"
from = { node = "m" }
to = { ground = [1.0, 1.0, 0.0] }
stiffness = 1e3
direction = [0.0, 1.0, 0.0]
[[links]]
name = "lz"
from = { node = "m" }
to = { ground = [1.0, 0.0, 1.0] }
stiffness = 1e3
direction = [0.0, 0.0, 1.0]
[[loads]]
at = "m"
force = [10.0, 0.0, 0.0]
"#;
    let text = told(deck);
    assert!(text.contains("already from t = 0 on"), "{text}");
}

/// A rod wound up by a moment turns by 0.16 or 0.3 rad in a step. Between the ends of such a step the tangents combined are those of no
/// configuration: half the runs of this rod were called unstable, at times that depended on their steps. A small load in the direction
/// that was named moves it by as little as before, with no pole.
#[test]
fn what_turns_in_a_step_is_not_called_unstable() {
    let rod = |step: f64| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 0.03\ntime_step = {step}\n[sections.rod]\nshape = \"general\"\n\
             axial_stiffness = 1e4\nshear_stiffness = [1e4, 1e4]\ntorsional_stiffness = 100.0\n\
             bending_stiffness = [100.0, 100.0]\n[points]\na = [0.0, 0.0, 0.0]\nb = [10.0, 0.0, 0.0]\n\
             [[beams]]\nname = \"rod\"\npath = [\"a\", \"b\"]\nelements = 80\nsection = \"rod\"\n\
             orientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
             [[loads]]\nat = \"b\"\nforce = [0.0, 0.0, 50.0]\nmoment = [0.0, 0.0, 628.3185307179587]\n"
        )
    };
    for step in [0.0025, 0.005] {
        let (outcome, warnings) = run_with_warnings(&rod(step));
        assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{step}: {outcome:?} {warnings:?}");
    }
}

/// A block that slips on a floor a million times as stiff as the spring that holds it: a point that is pressed deeper is held back more, and
/// nothing pushes it out for that, so that the symmetric part of the tangent has a negative eigenvalue.
fn slipping(friction: f64, stiffness: f64) -> String {
    format!(
        "[[bodies]]\nname = \"block\"\ncenter = [0.0, 5.0, 0.01]\nmass = 4.0\n\
         shape = {{ kind = \"box\", size = [0.4, 0.2, 0.02] }}\n\
         [[loads]]\nat = \"block\"\nforce = [50.0, 0.0, -40.0]\n\
         [[links]]\nname = \"spring\"\nfrom = {{ ground = [-1.0, 5.0, 0.01] }}\nto = {{ body = \"block\" }}\n\
         law = \"linear\"\nstiffness = 1000.0\n\
         [[contacts]]\nname = \"floor\"\n\
         surface = {{ shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\nwith = \"block\"\n\
         stiffness = {stiffness:?}\nfriction = {friction:?}\n\
         [[supports]]\nat = \"block\"\nfix = [\"uy\", \"rx\", \"ry\", \"rz\"]\n"
    )
}

#[test]
fn what_slips_on_stiff_contacts_is_not_called_unstable() {
    for (friction, stiffness) in [(0.2, 1e9), (0.5, 1e6), (0.5, 1e11), (1.0, 1e8)] {
        for plane in ["", "plane = \"off\""] {
            let (model, state, Said { outcome, warnings, .. }) =
                said(&(head(0.1, plane) + &slipping(friction, stiffness)));
            assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{stiffness}: {outcome:?} {warnings:?}");
            let moved = state.nodes[crate::support::node(&model, "block")].x.x;
            // Friction lags by its elastic slip, μ N/4k = 1e-6 m at the most.
            let wanted = (50.0 - friction * 40.0) / 1000.0;
            assert!((moved - wanted).abs() < 1e-5, "{friction} {stiffness}: {moved} for {wanted}");
        }
    }
}

#[test]
fn what_slips_beside_it_does_not_hide_buckling() {
    for (friction, stiffness) in [(0.5, 1e6), (0.5, 1e11)] {
        for step in [0.1, 0.02] {
            let deck = column(1000.0, step, ALONG_X, "plane = \"off\"") + &slipping(friction, stiffness);
            let text = told(&deck);
            assert!((1000.0 * time(&text) / weak() - 1.0).abs() < 2e-3 && text.contains("is unstable"), "{text}");
            assert!(text.contains("`b` most, in direction ux"), "{text}");
        }
    }
}

/// A sheet clamped along one edge and pressed at the other. Its buckling is told alike by the symmetric part of the matrix, by the whole
/// matrix, and without what slips beside it.
#[test]
fn large_scenes_are_judged_by_the_whole_tangent() {
    let sheet = |follower: bool, more: &str| {
        format!(
            "{}[points]\np = [0.0, 0.0, 0.0]\nq = [0.3, 0.0, 0.0]\nr = [0.3, 0.0, 1.0]\ns = [0.0, 0.0, 1.0]\n\
             [[shells]]\nname = \"sheet\"\ncorners = [\"p\", \"q\", \"r\", \"s\"]\nelements = [10, 18]\nthickness = 0.005\n\
             material = \"steel\"\n[[supports]]\nat = \"sheet.edge1\"\nfix = \"all\"\n\
             [[loads]]\nat = \"r\"\nforce = [0.0, 0.0, -1500.0]\nfollower = {follower}\n\
             [[loads]]\nat = \"s\"\nforce = [0.0, 0.0, -1500.0]\nfollower = {follower}\n{more}",
            head(0.1, "")
        )
    };
    let right = "[iteration]\ngyroscopic = \"right\"\n";
    // The symmetric part finds equilibria where μ² k is below twice the stiffness of the spring.
    let (slips, stiff) = (slipping(0.2, 1.5e3), slipping(0.5, 1e9));
    let alone = time(&told(&sheet(false, "")));
    let Outcome::Failed { failure, .. } = said(&sheet(false, &(stiff.clone() + right))).2.outcome else {
        panic!("the symmetric part finds no equilibrium where it slips");
    };
    assert!(failure.to_string().contains("`gyroscopic = \"left\"`"), "{failure}");
    // Load steps with friction solve with the whole matrix, unless the deck asks for its symmetric part.
    for deck in [sheet(false, &(slips.clone() + right)), sheet(false, &slips), sheet(false, &stiff)] {
        let text = told(&deck);
        // The load is found to 1e-5 of a step.
        assert!((time(&text) - alone).abs() < 1e-4 && text.contains("is unstable"), "{text} {alone}");
    }
    // Forces that follow do not buckle it: it would flutter at eight times that load. The symmetric part alone says nothing of that.
    assert_eq!(said(&sheet(true, "")).2.warnings, Vec::<String>::new());
}

/// In its plane the edge of a shell bends between its nodes, and takes its share of a load by moments there. They are none that the deck gives.
#[test]
fn dead_loads_along_edges_have_a_potential() {
    let deck = |load: &str| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = \"elastic\"\n\
             youngs_modulus = 7e10\npoisson_ratio = 0.3\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.3]\n\
             d = [0.0, 1.0, 0.3]\n[[shells]]\nname = \"p\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = 2\nthickness = 0.01\n\
             material = \"m\"\n[[supports]]\nat = \"p.edge1\"\nfix = \"all\"\n[[loads]]\n{load}\n"
        )
    };
    let has_potential = |load: &str| {
        let model = read_deck(&deck(load));
        assert!(model.loading.nodal.iter().any(|load| load.moment.norm() > 0.0), "{load}");
        System::new(&model).expect("a system").has_potential(None)
    };
    let dead = "at = \"p.edge3\"\nforce_per_length = [0.0, -1.0, -0.3]";
    assert!(has_potential(dead));
    // Nor does buckling speak of loads that follow.
    let folder = tempfile::tempdir().unwrap();
    let buckling = deck(dead).replace("\"static\"\nend_time = 1.0\ntime_step = 1.0", "\"buckling\"\nmodes = 1");
    std::fs::write(folder.path().join("deck.toml"), buckling).unwrap();
    let output =
        assert_cmd::Command::cargo_bin("rdsolve").unwrap().current_dir(&folder).arg("deck.toml").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && !said.contains("follower loads"), "{said}");
    assert!(!has_potential("at = \"c\"\nmoment = [0.0, 1.0, 0.0]"));
}

/// The deflection over the length of a column that is clamped at its foot, at `ratio` times its buckling load: the elastica, K(k) = π/2 √ratio and
/// w/L = 2 k/K(k) (S. P. Timoshenko & J. M. Gere, Theory of Elastic Stability, 1961, article 2.7).
fn elastica(ratio: f64) -> f64 {
    let K = |k: f64| {
        let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
        for _ in 0..8 {
            (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
        }
        0.5 * std::f64::consts::PI / a
    };
    let wanted = 0.5 * std::f64::consts::PI * ratio.sqrt();
    let (mut low, mut high) = (0.0, 1.0 - 1e-12);
    for _ in 0..60 {
        let k = 0.5 * (low + high);
        if K(k) < wanted { low = k } else { high = k }
    }
    2.0 * low / wanted
}

/// A clamped column under one and a half times its buckling load, with a small load beside it: whatever the steps, it bends away to the side of that
/// load. Steps of a hundredth had ended on the straight path, or on the other side.
#[test]
fn a_small_load_leads_to_the_path_that_buckles() {
    for step in [0.01, 0.05, 0.25] {
        for part in [1e-3, 1e-4, 1e-6] {
            let load = 1.5 * weak();
            let deck = column(load, step, ALONG_X, "plane = \"off\"")
                + &format!("[[loads]]\nat = \"b\"\nforce = [{}, 0.0, 0.0]\n", part * load);
            let (model, state, Said { outcome, warnings, .. }) = said(&deck);
            assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{step} {part}: {outcome:?} {warnings:?}");
            let moved = state.nodes[crate::support::node(&model, "b")].x.x;
            // The small load moves the end by its own part, amplified twice or so; the mesh of the column errs by 3e-4.
            let error = moved / elastica(1.5) - 1.0;
            assert!(error.abs() < 2.0 * part + 1e-3, "{step} {part}: {moved} for {}", elastica(1.5));
        }
    }
}

/// Joints with multipliers have negative pivots of their own: a post on a hinge that a spring k holds upright buckles at k/L, and leans beyond
/// with P L sin φ = k φ.
#[test]
fn multipliers_do_not_count_as_unstable() {
    let post = |side: f64| {
        format!(
            "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.1, plane = \"off\" }}\n[[bodies]]\nname = \"post\"\n\
             center = [0.0, 0.0, 1.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n[[joints]]\nname = \"hinge\"\nkind = \"revolute\"\n\
             from = {{ ground = [0.0, 0.0, 0.0] }}\nto = {{ body = \"post\" }}\naxis = [0.0, 1.0, 0.0]\nstiffness = 100.0\n\
             [[loads]]\nat = \"post\"\nforce = [{side}, 0.0, -150.0]\n"
        )
    };
    let text = told(&post(0.0));
    // k/L over 150 N; the tangents at the ends of a step are combined, which a rigid post makes exact.
    assert!((time(&text) - 2.0 / 3.0).abs() < 1e-4 && text.contains("is unstable"), "{text}");
    let (model, state, Said { outcome, warnings, .. }) = said(&post(1e-4));
    assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{outcome:?} {warnings:?}");
    let x = state.nodes[crate::support::node(&model, "post")].x.x;
    let phi = x.asin();
    assert!((150.0 * x / (100.0 * phi) - 1.0).abs() < 1e-5, "{x}");
}
