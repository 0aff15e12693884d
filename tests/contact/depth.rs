//! What is pressed in too far is said, with contact and depth; what has a stiffness that holds it is not.

use crate::support::{run_source, run_with_warnings};
use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::solve::Outcome;

/// A body pushed at a surface at first: nothing moves at t = 0.
fn pushed(shape: &str, surface: &str, end_time: f64, stiffness: &str) -> String {
    format!(
        r#"
        [analysis]
        kind = "dynamic"
        end_time = {end_time}
        time_step = 1e-3
        [integrator]
        scheme = "newmark"
        [[bodies]]
        name = "thing"
        center = [0.0, 0.0, 0.5]
        mass = 1.0
        shape = {{ {shape} }}
        [[loads]]
        at = "thing"
        force = [0.0, 0.0, -1000.0]
        amplitude = "push"
        [amplitudes.push]
        kind = "table"
        points = [[0.0, 1.0], [0.01, 1.0], [0.01001, 0.0]]
        [[contacts]]
        name = "stop"
        surface = {{ {surface} }}
        with = "thing"
        {stiffness}
        "#
    )
}

const BALL: &str = "kind = \"sphere\", radius = 0.1";
const BRICK: &str = "kind = \"box\", size = [0.2, 0.3, 0.2]";
const FLOOR: &str = "shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]";
const DRUM: &str =
    "shape = \"cylinder\", center = [0.0, 0.0, -0.5], radius = 0.5, length = 2.0, axis = [0.0, 1.0, 0.0]";

/// The depth in a warning, by its words.
fn depth(said: &[String]) -> Option<f64> {
    let said = said.iter().find(|said| said.contains("contact `stop`: the penetration of"))?;
    assert!(said.contains("Give `stiffness` = "), "{said}");
    let rest = said.split("the penetration of ").nth(1)?;
    rest.split(' ').next()?.parse().ok()
}

#[test]
fn what_is_pressed_in_by_more_than_is_seen_is_said() {
    // 10 m/s: v √(m/k), which this stiffness cannot hold.
    for (shape, surface, end_time) in [(BALL, FLOOR, 4.0), (BRICK, FLOOR, 4.0), (BALL, DRUM, 10.0)] {
        // A brick lies on four corners.
        let corners = if shape == BRICK { 4.0 } else { 1.0 };
        // Beyond the middle of what is 0.2 wide.
        let text = pushed(shape, surface, end_time, &format!("stiffness = {:?}", 7e3 / corners));
        let exact = 10.0 / 7e3f64.sqrt();
        let (outcome, said) = run_with_warnings(&text);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        let found = depth(&said).unwrap_or_else(|| panic!("{shape}, {surface}: {said:?}, {exact}"));
        // The steps hold some five per cent of the turning point; four digits are written.
        assert!((found / exact - 1.0).abs() < 0.05, "{shape}, {surface}: {found} for {exact}");
    }
}

#[test]
fn a_stiffness_given_may_yield_to_the_middle() {
    // The ball of 0.2 goes in by 10/√k: 0.105, then 0.095.
    for (stiffness, said) in [("stiffness = 9.07e3", true), ("stiffness = 1.108e4", false), ("stiffness = 1e6", false)]
    {
        let text = pushed(BALL, FLOOR, 0.2, stiffness);
        let (outcome, warnings) = run_with_warnings(&text);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        assert_eq!(depth(&warnings).is_some(), said, "{stiffness}: {warnings:?}");
        let (_, read) = model::read(&Source::new("deck.toml", text, &[]));
        assert!(read.is_empty(), "{read:?}");
    }
    // Chosen for a fast run, and for gravity: it holds.
    let fast = pushed(BALL, FLOOR, 0.08, "");
    assert_eq!(depth(&run_with_warnings(&fast).1), None);
    let heavy = fast.replace("[[loads]]", "[environment]\ngravity = [0.0, 0.0, -9.81]\n[[loads]]");
    let (_, read) = model::read(&Source::new("deck.toml", heavy, &[]));
    assert!(read.is_empty(), "{read:?}");
}

/// A ball flies through a block whose contact acts in a later stage alone: it is inside when that begins, which is said; where the stage
/// before ends earlier it is not, and nothing is.
#[test]
fn what_lies_inside_as_a_stage_begins_is_said() {
    for (before, inside) in [(0.06, true), (0.03, false)] {
        let text = format!(
            r#"
            stages = [
                {{ name = "fly", kind = "dynamic", duration = {before}, time_step = 1e-3 }},
                {{ name = "hit", kind = "dynamic", duration = 0.01, time_step = 1e-4 }},
            ]
            bodies = [{{ name = "ball", center = [0.0, 0.0, 0.15], mass = 1.0, shape = {{ kind = "sphere", radius = 0.1 }}, velocity = [0.0, 0.0, -1.0] }}]
            [[contacts]]
            name = "stop"
            surface = {{ {FLOOR} }}
            with = "ball"
            stiffness = 1e6
            stages = "hit"
            "#
        );
        let done = run_source(&Source::new("deck.toml", text, &[]), &mut |_| Vec::new());
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let said = done.warnings;
        let found = said.iter().find(|said| said.contains("contact `stop` begins closed in this stage"));
        assert_eq!(found.is_some(), inside, "{said:?}");
        // 0.06 s at 1 m/s, 0.05 m above it: 0.01 inside.
        assert!(found.is_none_or(|found| found.contains("with a penetration of 0.01.")), "{said:?}");
    }
}
