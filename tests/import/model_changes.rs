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
    // What is there already does not come; an element that comes again has its force from the mesh on.
    let changed = |text: &str| reasons(&imported(text), KeywordVerdict::Changed);
    assert_eq!(changed(&later("*MODEL CHANGE, ADD\nk\n")), [""; 0]);
    let comes = |element: &str, how: &str| {
        edited(BEAM, &[("*BOUNDARY", element)])
            + &step("*MODEL CHANGE, REMOVE\nk\n")
            + &step(&format!("*MODEL CHANGE, {how}\nk\n"))
    };
    let line = "*ELEMENT, TYPE=SPRINGA, ELSET=k\n5, 9, 2\n*SPRING, ELSET=k\n\n2e5\n*BOUNDARY";
    assert!(changed(&comes(line, "ADD"))[0].contains("no force at its length in the mesh"));
    assert_eq!(changed(&comes(line, "ADD=WITH STRAIN")), [""; 0]);
    refuses(&comes(SPRING.1, "ADD=STRAIN FREE"), &[], "springs along axes have no force where the mesh");
    assert_eq!(changed(&comes(&line.replace("SPRING", "DASHPOT"), "ADD")), [""; 0]);
    // The nodes of a joint lie at one place, but for one that the first step does not have.
    let joined = "*ELEMENT, TYPE=CONN3D2, ELSET=k\n7, 2, 9\n*CONNECTOR SECTION, ELSET=k\nHINGE\n*BOUNDARY";
    let absent = edited(BEAM, &[("*BOUNDARY", joined), ("*CLOAD", "*MODEL CHANGE, REMOVE\nk\n*CLOAD")]);
    has(&(absent + &step("*MODEL CHANGE, ADD\nk\n")), &[], None, "stages = \"step_2\"\n");
    let comes = |element: &str, how: &str| comes(element, how).replace("9, 0., 0., 1.", "9, 1., 0., 0.");
    let joint = "*ELEMENT, TYPE=CONN3D2, ELSET=k\n7, 2, 9\n*CONNECTOR SECTION, ELSET=k\nHINGE\n*BOUNDARY";
    assert_eq!(changed(&comes(joint, "ADD")), [""; 0]);
    assert!(changed(&comes(joint, "ADD=WITH STRAIN"))[0].contains("as the step finds them"));
    // Springs of joints count from t = 0.
    let sprung = joint.replace(
        "SECTION, ELSET=k",
        "BEHAVIOR, NAME=b\n*CONNECTOR ELASTICITY, COMPONENT=4\n3.\n*CONNECTOR SECTION, ELSET=k, BEHAVIOR=b",
    );
    refuses(&comes(&sprung, "ADD"), &[], "a joint with a spring, a stop or a drive");
    assert_eq!(
        refusals(&imported(
            &(edited(BEAM, &[("*BOUNDARY", &sprung), ("9, 0., 0., 1.", "9, 1., 0., 0.")])
                + &step("*MODEL CHANGE, REMOVE\nk\n"))
        )),
        [""; 0]
    );
    // CalculiX makes strains of solids residual by a word that stands alone.
    refuses(&later("*MODEL CHANGE, MECHSTRAINTORESIDUAL\nk\n"), &[], "MECHSTRAINTORESIDUAL is not translated");
    assert_eq!(refusals(&imported(&later("*MODEL CHANGE, ACTIVATE\n"))), [""; 0]);
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
    // A plate 2e-6 above the tip, which the load bends by more, holds it; once the pair is away the tip goes where the bare beam does.
    let above = |text: String| {
        let corners = ["0.9, -0.1", "1.1, -0.1", "1.1, 0.1", "0.9, 0.1"];
        corners.iter().fold(text, |text, xy| text.replace(&format!("{xy}, 0.2"), &format!("{xy}, 0.010002")))
    };
    let uz = |text: String| moves(&text, "mesh.2").0[2];
    let bare = uz(BEAM.to_owned());
    // It stops within a tenth of the way to where it would be.
    assert!((uz(above(text(pair, ""))) - 2e-6).abs() < 0.1 * bare);
    // Load steps converge to less.
    near(uz(above(text(pair, &change("REMOVE", "end, below")))), bare, 1e-6);
    // A pair that comes again has one contact, whether it is named again or added.
    let again = |lines: &str| text(pair, &deleted) + &step(lines);
    for lines in [pair, &change("ADD", "end, below")] {
        stages(&again(lines), "stages = [\"step_1\", \"step_3\"]\n");
        assert_eq!(imported(&again(lines)).deck.matches("[[contacts]]").count(), 1);
    }
    let other = pair.replace("=i,", "=j,");
    refuses(&again(&format!("*SURFACE INTERACTION, NAME=j\n{other}")), &[], "names this pair already");
    refuses(&text(&format!("{pair}{pair}"), ""), &[], "names this pair already");
    for lines in [pair, &deleted[..]] {
        refuses(&(text(pair, "") + lines + &step("")), &[], "no *STEP is open");
    }
    refuses(&text("", &deleted), &[], "no *CONTACT PAIR joins these two surfaces in this order");
    refuses(
        &text(pair, &change("REMOVE", "below, end")),
        &[],
        "no *CONTACT PAIR joins these two surfaces in this order",
    );
}
