//! Load steps from states that resist hardly anything: flat membranes, what only pretension holds, and what presses on joints.

use crate::solve::statics::{Said, said};
use crate::support::{node, read_deck};
use rdsolve::model::Model;
use rdsolve::solve::Outcome;
use rdsolve::state::State;

/// Runs a deck to its end without a warning; returns the last position of a node.
fn position(deck: &str, name: &str) -> [f64; 3] {
    let (model, state, Said { outcome, warnings, .. }) = said(deck);
    assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{outcome:?} {warnings:?}\n{deck}");
    state.nodes[node(&model, name)].x.into()
}

/// A flat strip of film between two edges, a hundred thousand times as long as thick: pressure p bends it to a parabola with the tension N,
/// N³ = E t p² L²/24, and sags it by p L²/8 N. No load step was short enough for its bending stiffness.
#[test]
fn a_flat_membrane_carries_pressure() {
    let sag = |elements: usize| {
        let deck = format!(
            r#"
analysis = {{ kind = "static", end_time = 1.0, time_step = 0.5 }}
points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 0.1, 0.0], d = [0.0, 0.1, 0.0] }}
materials.film = {{ model = "elastic", youngs_modulus = 1e9, poisson_ratio = 0.0 }}
[[shells]]
name = "film"
corners = ["a", "b", "c", "d"]
elements = [{elements}, 1]
thickness = 1e-5
material = "film"
[[supports]]
at = ["film.edge2", "film.edge4"]
fix = "all"
[[supports]]
at = "film"
fix = ["uy", "rx", "rz"]
[[loads]]
part = "film"
pressure = 1.0
"#
        );
        let (_, state, Said { outcome, warnings, .. }) = said(&deck);
        assert!(matches!(outcome, Outcome::Done) && warnings.is_empty(), "{outcome:?} {warnings:?}");
        state.nodes.iter().map(|node| node.x.z.abs()).fold(0.0, f64::max)
    };
    let exact = 1.0 / (8.0 * (1e9f64 * 1e-5 / 24.0).cbrt());
    let [coarse, fine] = [4, 8].map(sag);
    // Elements of length h err with h²; what is left is of fourth order, 4e-3 of 8 elements, and the slope squared, 4e-3 (0.067 at the edge).
    let error = (4.0 * fine - coarse) / 3.0 / exact - 1.0;
    assert!(error.abs() < 5e-3, "{coarse} {fine} {exact}: {error}");
}

/// A square film held along its edges: flat elements fold where their edges are free to turn. The message names the remedy, and it holds: fewer
/// elements of order 2 sag as twelve flat ones a side, which do not fold, within 1 %. Those are off by 4e-3, as their square tells.
#[test]
fn a_film_that_folds_is_told_what_helps() {
    let film = |elements: usize, order: usize| {
        said(&format!(
            r#"
analysis = {{ kind = "static", end_time = 1.0, time_step = 0.5 }}
points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }}
materials.film = {{ model = "elastic", youngs_modulus = 2.1e11, poisson_ratio = 0.3 }}
[[shells]]
name = "film"
corners = ["a", "b", "c", "d"]
elements = {elements}
order = {order}
thickness = 1e-4
material = "film"
[[supports]]
at = ["film.edge1", "film.edge2", "film.edge3", "film.edge4"]
fix = "translations"
[[loads]]
at = "film"
pressure = 1e3
"#
        ))
    };
    let sag = |(model, state, Said { outcome, .. }): (Model, State, Said)| {
        assert!(matches!(outcome, Outcome::Done), "{outcome:?} of {} nodes", model.nodes.len());
        state.nodes.iter().map(|node| node.x.z.abs()).fold(0.0, f64::max)
    };
    for elements in [6, 9] {
        let (_, _, Said { outcome, .. }) = film(elements, 1);
        let Outcome::Failed { failure, .. } = outcome else { panic!("{outcome:?}") };
        assert!(failure.to_string().contains("`order = 2` and half as many"), "{failure}");
    }
    let flat = sag(film(12, 1));
    for elements in [3, 4] {
        let found = sag(film(elements, 2));
        assert!((found / flat - 1.0).abs() < 1e-2, "{found} for {flat}");
    }
}

/// A mass between two parts in a line, of which one is pulled to 1000 N: its weight across is held by that force, as by a `preload`.
#[test]
fn pretension_holds_what_nothing_else_does() {
    let link = |name: &str, ends: [&str; 2], more: &str| {
        let [from, to] = ends;
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ node = \"{from}\" }}\nto = {{ node = \"{to}\" }}\nstiffness = 1e6\n{more}\n"
        )
    };
    let bar = "[[bars]]\nname = \"bar\"\npath = [\"m\", \"b\"]\narea = 1e-5\nmaterial = \"steel\"\n".to_owned();
    let yields = "[[bars]]\nname = \"bar\"\npath = [\"m\", \"b\"]\narea = 1e-5\nmaterial = \"yields\"\n".to_owned();
    for (law, other) in [
        ("", link("other", ["m", "b"], "")),
        ("", bar),
        ("", yields),
        ("", link("other", ["m", "b"], "law = \"tension-only\"")),
        ("law = \"tension-only\"", link("other", ["m", "b"], "")),
    ] {
        for across in ["[0.0, 1.0, 0.0]", "[0.0, 0.0, 1.0]", "[0.0, 0.6, 0.8]"] {
            let deck = format!(
                "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.25 }}\n\
                 points = {{ a = [0.0, 0.0, 0.0], m = [1.0, 0.0, 0.0], b = [2.0, 0.0, 0.0] }}\n\
                 materials.steel = {{ model = \"elastic\", youngs_modulus = 1e11 }}\n\
                 materials.yields = {{ model = \"elastic-plastic\", youngs_modulus = 1e11, yield_stress = 1e9, hardening_modulus = 1e9 }}\n\
                 [[masses]]\nat = \"m\"\nmass = 1.0\n{}{other}[[supports]]\nat = [\"a\", \"b\"]\nfix = \"all\"\n\
                 [[loads]]\nat = \"m\"\nforce = {across}\n",
                link("pulled", ["a", "m"], &format!("pretension = 1e3\n{law}"))
            );
            let [x, y, z] = position(&deck, "m");
            // 1000 N stretch the other part by 1 mm, and both resist with N/l.
            let stiffness = 1e3 * (1.0 / 0.999 + 1.0 / 1.001);
            assert!((x - 0.999).abs() < 1e-6 && (y.hypot(z) * stiffness - 1.0).abs() < 1e-5, "{x} {y} {z}\n{deck}");
        }
    }
}

/// A bar pressed against a joint is held by it: what the pressure takes away across is less than the joint holds. The force of the joint is that
/// of the bar, elastic and yielding, stretched and let back, whatever matrix leads the iteration.
#[test]
fn a_bar_pressed_on_a_joint_is_held_by_it() {
    let deck = |yields: &str, points: &str, update: &str, axis: usize| {
        let along = |x: f64| {
            let mut place = [0.0; 3];
            place[axis] = x;
            format!("{place:?}")
        };
        let directions = ["ux", "uy", "uz"];
        let across: Vec<&str> = (0..3).filter(|&i| i != axis).map(|i| directions[i]).collect();
        format!(
            "analysis = {{ kind = \"static\", end_time = 2.0, time_step = 0.25 }}\niteration.update = \"{update}\"\n\
             points = {{ a = {}, b = {} }}\nmaterials.steel = {{ {yields}, youngs_modulus = 2e11 }}\n\
             [[bars]]\nname = \"bar\"\npath = [\"a\", \"b\"]\narea = 5e-4\nmaterial = \"steel\"\n\
             [[joints]]\nname = \"held\"\nkind = \"spherical\"\nfrom = {{ ground = {} }}\nto = {{ node = \"a\" }}\n\
             [[supports]]\nat = \"b\"\nfix = {across:?}\nmotion = {{ {} = {{ amplitude = \"strain\" }} }}\n\
             [amplitudes.strain]\nkind = \"table\"\npoints = {points}\n",
            along(0.0),
            along(1.0),
            along(0.0),
            directions[axis]
        )
    };
    let elastic = "model = \"elastic\"";
    let yielding = "model = \"elastic-plastic\", yield_stress = 2e8, hardening_modulus = 2e9";
    for update in ["auto", "iteration", "step", "never"] {
        for axis in 0..3 {
            for (law, points, force) in [
                (elastic, "[[0.0, 0.0], [2.0, -1e-3]]", 1e5),
                (elastic, "[[0.0, 0.0], [1.0, 1e-3], [2.0, -2e-3]]", 2e5),
                // E A strain on the branch back: 2e8 + H (3e-3 - 1e-3) - E 2e-3, with 2e9 E/(E + 2e9) for the slope.
                (yielding, "[[0.0, 0.0], [1.0, 3e-3], [2.0, 1e-3]]", 98019.80198019803),
                (yielding, "[[0.0, 0.0], [2.0, -3e-3]]", 0.0),
            ] {
                let force = if force == 0.0 { 5e-4 * (2e8 + 2e9 / 1.01 * 2e-3) } else { force };
                let text = deck(law, points, update, axis);
                let (model, state, Said { outcome, warnings, .. }) = said(&text);
                assert!(
                    matches!(outcome, Outcome::Done) && warnings.is_empty(),
                    "{update}: {outcome:?} {warnings:?}\n{text}"
                );
                assert!(!read_deck(&text).constraints.joints.is_empty());
                let carried = state.multipliers.iter().map(|lambda| lambda.abs()).fold(0.0, f64::max);
                assert!((carried / force - 1.0).abs() < 1e-6, "{update} {axis}: {carried} for {force} {}", model.title);
            }
        }
    }
}
