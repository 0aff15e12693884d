//! `*MODEL CHANGE`: springs, connectors and contact pairs that come and go by step.

use super::rows::{BEAM, edited, has, refuses};
use super::values::{moves, near};
use super::{imported, reasons, refusals, tables};
use import::KeywordVerdict;

/// A spring to the ground at the tip of the cantilever.
const SPRING: (&str, &str) =
    ("*BOUNDARY", "*ELEMENT, TYPE=SPRING1, ELSET=k\n5, 2\n*SPRING, ELSET=k\n3\n2e5\n*BOUNDARY");

/// A further static step with these lines.
fn step(lines: &str) -> String {
    format!("*STEP, NLGEOM\n*STATIC\n1., 1.\n{lines}*END STEP\n")
}

/// The cantilever under 5 N, alone and with a spring of 2e5 N/m beside it: F/k, and F/(k + 2e5).
#[test]
fn a_spring_that_goes_and_comes() {
    let bare = moves(BEAM, "mesh.2").0[2];
    let held = 5.0 / (5.0 / bare + 2e5);
    let after = |steps: &[&str]| {
        let later: String = steps.iter().map(|lines| step(lines)).collect();
        moves(&(edited(BEAM, &[SPRING]) + &later), "mesh.2").0[2]
    };
    let (away, back) = ("*MODEL CHANGE, REMOVE\nk,\n", "*MODEL CHANGE, TYPE=ELEMENT, ADD=WITH STRAIN\n5,\n");
    // Displacements of 1e-5 bend the beam by large displacements alone, of less than 1e-9, and load steps converge to less.
    near(after(&[]), held, 1e-8);
    near(after(&[away]), bare, 1e-8);
    near(after(&[away, back]), held, 1e-8);
    // A file without a large displacement has stages too.
    let linear = (edited(BEAM, &[SPRING]) + &step(away)).replace(", NLGEOM", "");
    near(moves(&linear, "mesh.2").0[2], bare, 1e-8);
}

#[test]
fn stages_of_links_and_joints() {
    let text = edited(BEAM, &[SPRING]);
    let later = |lines: &str| text.clone() + &step(lines);
    has(&later("*MODEL CHANGE, REMOVE\nk\n"), &[], None, "0.0]\nstages = \"step_1\"\n");
    // An element that no step has is no link.
    let made = imported(&edited(&text, &[("*CLOAD", "*MODEL CHANGE, REMOVE\nk\n*CLOAD")]));
    assert!(refusals(&made).is_empty() && !made.deck.contains("[[links]]"), "{}", made.deck);
    let added = imported(&later("*MODEL CHANGE, ADD\nk\n"));
    assert!(reasons(&added, KeywordVerdict::Changed)[0].contains("no force at their length in the mesh"));
    refuses(&later("*MODEL CHANGE, REMOVE\nrod\n"), &[], "element 1 acts in all stages: springs, dampers");
    refuses(&later("*MODEL CHANGE, REMOVE\nnone\n"), &[], "no element set is named `none`");
    refuses(&later("*MODEL CHANGE\nk\n"), &[], "needs ADD or REMOVE");
    refuses(&later("*MODEL CHANGE, TYPE=FRACTURE, REMOVE\nk\n"), &[], "TYPE is CONTACT PAIR or ELEMENT");
    refuses(&edited(&text, &[("*STEP", "*MODEL CHANGE, REMOVE\nk\n*STEP")]), &[], "no *STEP is open");
    let pin = "*ELEMENT, TYPE=CONN3D2, ELSET=c\n7, 2, 8\n*NODE\n8, 1., 0., 0.\n*CONNECTOR SECTION, ELSET=c\nJOIN\n*BOUNDARY\n8, 1, 6";
    let pinned = edited(BEAM, &[("*BOUNDARY", pin)]) + &step("*MODEL CHANGE, REMOVE\nc\n");
    has(&pinned, &[], None, "to = { node = \"mesh.8\" }\nstages = \"step_1\"\n");
    // The support at the other end of the connector rests in the second step.
    near(moves(&pinned, "mesh.2").0[2], moves(BEAM, "mesh.2").0[2], 1e-8);
}

/// Pairs go by their surfaces in this order; a pair of a later step is away before.
#[test]
fn contact_pairs() {
    let plate = "*NODE\n11, 0.9, -0.1, 0.2\n12, 1.1, -0.1, 0.2\n13, 1.1, 0.1, 0.2\n14, 0.9, 0.1, 0.2\n*ELEMENT, TYPE=S4, ELSET=plate\n21, 11, 12, 13, 14\n\
                 *SHELL SECTION, ELSET=plate, MATERIAL=m\n0.02\n*NSET, NSET=plate, GENERATE\n11, 14\n\
                 *SURFACE, NAME=below\nplate, SNEG\n*SURFACE, NAME=end, TYPE=NODE\ntip\n*SURFACE INTERACTION, NAME=i\n";
    let pair = "*CONTACT PAIR, INTERACTION=i, TYPE=NODE TO SURFACE, SMALL SLIDING\nend, below\n";
    let text = |before: &str, lines: &str| {
        let edits = [("*BOUNDARY", &format!("{plate}{before}*BOUNDARY\nplate, 1, 6")[..])];
        edited(BEAM, &edits) + &step(lines)
    };
    let change = |how: &str, pair: &str| format!("*MODEL CHANGE, TYPE=CONTACT PAIR, {how}\n{pair}\n");
    let stages = |text: &str, wanted: &str| {
        let made = imported(text);
        assert_eq!(refusals(&made), [""; 0]);
        assert!(tables(&made.deck).contains(&format!("with = \"tip\"\n{wanted}")), "{}", made.deck);
    };
    stages(&text(pair, ""), "[[loads]]");
    stages(&text(pair, &change("REMOVE", "End, below")), "stages = \"step_1\"\n");
    stages(&text("", pair), "stages = \"step_2\"\n");
    let deleted = pair.replace("INTERACTION=i", "OP=DELETE");
    stages(&text(pair, &deleted), "stages = \"step_1\"\n");
    refuses(
        &text(pair, &change("REMOVE", "below, end")),
        &[],
        "no *CONTACT PAIR joins these two surfaces in this order",
    );
}
