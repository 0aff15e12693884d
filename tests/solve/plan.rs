//! What a scene does without, and what that saves.

use crate::support::{node, read};
use rdsolve::plan::Plan;
use rdsolve::system::System;

fn savings(name: &str, sets: &[&str]) -> (usize, Vec<String>) {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let model = read(name, &sets);
    let system = System::new(&model).expect("a system");
    let plan = Plan::new(&model, &system, 1);
    (plan.dofs.unknowns(), plan.savings(&model, &system))
}

/// The number before a word in a line.
fn before(line: &str, word: &str) -> f64 {
    let words: Vec<&str> = line.split_whitespace().collect();
    let at = words.iter().position(|w| *w == word).unwrap_or_else(|| panic!("no `{word}` in `{line}`"));
    words[at - 1].parse().unwrap_or_else(|_| panic!("no number before `{word}` in `{line}`"))
}

/// The unknowns that a line counts are those of the plan that keeps them.
#[test]
fn what_a_plane_saves() {
    let (few, lines) = savings("portal_and_block", &[]);
    let (many, _) = savings("portal_and_block", &["analysis.plane=\"off\""]);
    let line = lines.iter().find(|line| line.contains("out of the plane")).expect("a plane scene");
    assert_eq!(before(line, "unknowns") as usize, many, "{line}");
    // Six unknowns a node in place of three along a chain: blocks of twice the size, 2³ = 8 times the operations, a little less
    // where columns end.
    assert!(many > 18 * few / 10, "{few}, {many}");
    let times = before(line, "times");
    assert!((5.0..=8.5).contains(&times), "{line}");
}

/// The shear centre of a box lies at its centroid but for rounding, which is another one for each thickness.
#[test]
fn boxes_of_any_thickness_stay_in_their_plane() {
    let (rectangle, _) = savings("portal_and_block", &[]);
    for thickness in ["0.003", "0.004", "0.005", "0.006", "0.0071"] {
        let section = format!("sections.square={{shape=\"box\",width=0.08,height=0.08,thickness={thickness}}}");
        let (unknowns, _) = savings("portal_and_block", &[&section]);
        assert_eq!(unknowns, rectangle, "{thickness}");
    }
}

/// A hub with two blades: eliminated nodes would be unknowns, and their multipliers as many more.
#[test]
fn what_elimination_saves() {
    let (few, lines) = savings("hub_with_blades", &[]);
    let line = lines.iter().find(|line| line.contains("multipliers")).expect("attached nodes");
    let dependents = 2;
    assert_eq!(before(line, "unknowns") as usize, few + dependents * (6 + 6), "{line}");
}

/// The paper's simplifications (3) and (4): the mass at the attached end of a beam is left out, or
/// all of it.
#[test]
fn masses_left_out() {
    let masses = |kind: &str| {
        let model = read("block_on_cantilever", &[format!("beams.beam.mass=\"{kind}\"")]);
        let system = System::new(&model).expect("a system");
        let of = |label: &str| {
            let node = node(&model, label);
            system.inertias.iter().filter(|inertia| inertia.node == node).map(|inertia| inertia.mass).sum::<f64>()
        };
        (of("tip"), of("block"), system.inertias.iter().map(|inertia| inertia.mass).sum::<f64>())
    };
    let (tip, block, all) = masses("lumped");
    // 0.03 x 0.005 x 7850 over a metre.
    assert!(tip > 0.0 && block == 2.0 && (all - 2.0 - 1.1775).abs() < 1e-12, "{tip}, {block}, {all}");
    let free = masses("free-nodes");
    assert!(free.0 == 0.0 && free.1 == 2.0 && (free.2 - (all - tip)).abs() < 1e-12, "{free:?}");
    assert_eq!(masses("none"), (0.0, 2.0, 2.0));
}
