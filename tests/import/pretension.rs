//! Pre-tension sections of beams against closed forms of two beams between two walls.

use super::rows::{edited, has, refuses};
use super::values::{model_of, near};
use super::{imported, imported_from, reasons, refusals, tables};
use crate::support;
use import::{Dialect, KeywordVerdict};

/// Two beams of 1 and 3 between two walls; the first is cut at node 2. E A = 2e8 and loads are small.
const BOLT: &str = "*NODE, NSET=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 4., 0., 0.\n9, 0., 1., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n2, 2, 3\n\
    *MATERIAL, NAME=m\n*ELASTIC\n1e10, 0.\n*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n\
    *PRE-TENSION SECTION, ELEMENT=1, NODE=9\n1., 0., 0.\n*BOUNDARY\n1, 1, 6\n3, 1, 6\n*STEP\n*STATIC\n1., 1.\n*CLOAD\n9, 1, 2e4\n*END STEP\n";
/// A way that tightens, in place of the force.
const WAY: &str = "*BOUNDARY\n9, 1, 1, 4e-4";
/// A second step that holds the section and pulls at node 2.
const HELD: &str = "*END STEP\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY, FIXED\n9, 1\n*CLOAD\n2, 1, 1e4\n*END STEP\n";

/// Displacements along x of node 2 and of the new end of the beam, after the last step.
fn ends(text: &str, dialect: Option<Dialect>) -> [f64; 2] {
    let made = imported_from(text, dialect);
    assert_eq!(refusals(&made), [""; 0]);
    let model = model_of(&made);
    let at = ["mesh.2", "mesh.10"].map(|name| support::node(&model, name));
    let start = at.map(|at| model.nodes[at].x.x);
    let done = support::run_to_the_end(&model, &mut |frame| at.map(|at| frame.state.nodes[at].x.x).to_vec());
    let last = done.rows.last().unwrap();
    [last[0] - start[0], last[1] - start[1]]
}

/// The force F stretches either beam by F L/(E A): node 2 goes back by 3 F/(E A), and the end of the first beam forward by F/(E A).
#[test]
fn a_force_tightens() {
    for text in [BOLT.to_owned(), edited(BOLT, &[("NODE=9\n1., 0., 0.\n", "NODE=9\n")])] {
        let [rest, end] = ends(&text, None);
        near(rest, -3e-4, 1e-9);
        near(end, 1e-4, 1e-9);
    }
    has(BOLT, &[], None, "kind = \"prismatic\"\n");
}

/// A way d that is taken up gives the force E A d/(L1 + L2); a way of zero welds the cut.
#[test]
fn a_way_tightens() {
    let [rest, end] = ends(&edited(BOLT, &[("*CLOAD\n9, 1, 2e4", WAY)]), None);
    near(rest, -3e-4, 1e-9);
    near(end, 1e-4, 1e-9);
    has(BOLT, &[("*CLOAD\n9, 1, 2e4", "*BOUNDARY\n9, 1\n*CLOAD\n2, 1, 5.")], None, "kind = \"fixed\"\n");
}

/// u₂·n − u₁·n + d = 0 in CalculiX, where a normal against the beam makes force and way push. CalculiX 2.20 moves node 2 by +3e-4 under the
/// force; it has no first beam any more, and so moves it by all of the way.
#[test]
fn a_normal_against_the_beam_pushes_in_calculix() {
    let against = edited(BOLT, &[("NODE=9\n1.,", "NODE=9\n-1.,")]);
    let calculix = Some(Dialect::Calculix);
    for text in [against.clone(), edited(&against, &[("*CLOAD\n9, 1, 2e4", WAY)])] {
        let [rest, end] = ends(&text, calculix);
        near(rest, 3e-4, 1e-9);
        near(end, -1e-4, 1e-9);
    }
    let [rest, _] = ends(BOLT, calculix);
    near(rest, -3e-4, 1e-9);
    let changed = reasons(&imported_from(BOLT, calculix), KeywordVerdict::Changed);
    assert!(changed.iter().any(|said| said.contains("CalculiX removes it")), "{changed:?}");
    for dialect in [None, Some(Dialect::Abaqus)] {
        let said = refusals(&imported_from(&against, dialect));
        assert!(said.iter().any(|said| said.contains("the normal points against the beam")), "{said:?}");
    }
}

/// A led way is held under FIXED, and goes back to 0 where a later step says so without FIXED.
#[test]
fn a_held_way_goes_back() {
    let held = "*END STEP\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY, FIXED\n9, 1\n*END STEP\n";
    let led = edited(BOLT, &[("*CLOAD\n9, 1, 2e4", WAY), ("*END STEP\n", held)]);
    near(ends(&led, None)[0], -3e-4, 1e-9);
    let [rest, end] = ends(&format!("{led}*STEP\n*STATIC\n1., 1.\n*BOUNDARY\n9, 1\n*END STEP\n"), None);
    assert!(rest.abs() < 1e-12 && end.abs() < 1e-12, "{rest} {end}"); // of 3e-4
}

/// The new end of a beam has the temperature and the velocity of its node: with α ΔT = 1e-4 beams of 1 and 3 grow by 1e-4 and 3e-4.
#[test]
fn the_new_end_has_what_its_node_has() {
    let warm = [("1e10, 0.\n", "1e10, 0.\n*EXPANSION\n1e-5\n"), ("2e4\n", "2e4\n*TEMPERATURE\nALL, 10.\n")];
    let [rest, end] = ends(&edited(BOLT, &warm), None);
    near(rest, -6e-4, 1e-9);
    near(end, 2e-4, 1e-9);
    let moving = [
        ("1e10, 0.\n", "1e10, 0.\n*DENSITY\n7.\n"),
        ("*STEP\n*STATIC\n1., 1.", "*INITIAL CONDITIONS, TYPE=VELOCITY\n2, 2, 3.\n*STEP, NLGEOM\n*DYNAMIC\n1e-6, 1e-5"),
    ];
    has(BOLT, &moving, None, "at = [\"mesh.2\", \"mesh.10\"]\nvelocity = [0.0, 3.0, 0.0]\n");
}

/// The normal of a part turns with its instance.
#[test]
fn a_normal_of_a_part() {
    let turned = "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n\
        *END ASSEMBLY\n*MATERIAL, NAME=m\n*ELASTIC\n1e10, 0.\n*BOUNDARY\nI.1, 1, 6\nI.3";
    let edits = [
        ("*NODE, NSET=ALL", "*PART, NAME=P\n*NODE, NSET=ALL"),
        ("*MATERIAL, NAME=m\n*ELASTIC\n1e10, 0.\n", ""),
        ("*BOUNDARY\n1, 1, 6\n3", turned),
        ("*CLOAD\n9", "*CLOAD\nI.9"),
    ];
    let made = imported(&edited(BOLT, &edits));
    assert_eq!(refusals(&made), [""; 0]);
    let text = tables(&made.deck);
    let axis = text.lines().find_map(|line| line.strip_prefix("axis = [")).unwrap();
    let axis: Vec<f64> = axis.trim_end_matches(']').split(", ").map(|x| x.parse().unwrap()).collect();
    // Rounding of the rotation.
    assert!(axis[0].abs() < 1e-12 && (axis[1] - 1.0).abs() < 1e-12, "{text}");
}

/// FOLLOWER turns the normal at large displacements, as the joint does.
#[test]
fn a_normal_that_follows() {
    let large = edited(BOLT, &[("*STEP\n", "*STEP, NLGEOM\n")]);
    let follows = edited(&large, &[("NODE=9\n1.,", "NODE=9, FOLLOWER=YES\n-1.,")]);
    let says = |text: &str| {
        let made = imported(text);
        assert_eq!(refusals(&made), [""; 0]);
        reasons(&made, KeywordVerdict::Changed).iter().any(|said| said.contains("without FOLLOWER"))
    };
    assert!(says(&large) && says(&large.replace("NODE=9\n", "NODE=9, FOLLOWER=NO\n")));
    assert!(!says(&follows) && !says(BOLT));
}

/// Once the section is held, both beams carry a further force P: node 2 moves by P/(E A/L1 + E A/L2), and the cut keeps its way. Large
/// displacements change it by the strain, 1e-4.
#[test]
fn a_held_section_keeps_its_way() {
    let text = edited(BOLT, &[("*END STEP\n", HELD), ("*END STEP\n*STEP", "*NODE FILE\nU\n*END STEP\n*STEP")]);
    let folder = super::command::folder(&[("a.inp", &text)]);
    let (code, said, problems) = super::command::rdsolve(folder.path(), &["a.inp", "--set", "output.nodes=\"all\""]);
    assert_eq!(code, 0, "{said}{problems}");
    let mut table = csv::Reader::from_path(folder.path().join("a.out/nodes.csv")).unwrap();
    let column = |head: &csv::StringRecord, name: &str| head.iter().position(|other| other == name).unwrap();
    let (node, along) = {
        let head = table.headers().unwrap();
        (column(head, "node"), column(head, "ux"))
    };
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let last = |name: &str| rows.iter().rfind(|row| &row[node] == name).unwrap()[along].parse::<f64>().unwrap();
    let [rest, end] = ["mesh.2", "mesh.10"].map(last);
    near(rest, -3e-4 + 1e4 / (2e8 * (1.0 + 1.0 / 3.0)), 3e-4);
    near(end - rest, 4e-4, 3e-4);
}

#[test]
fn sections_that_are_refused() {
    refuses(BOLT, &[("ELEMENT=1", "SURFACE=s")], "no solids that a surface could cut");
    refuses(BOLT, &[("TYPE=B31", "TYPE=T3D2")], "pre-tension sections cut beams");
    refuses(BOLT, &[("NODE=9\n1., 0.", "NODE=9\n1., 1.")], "must lie along the beam");
    refuses(BOLT, &[("*CLOAD\n9, 1, 2e4", "*CLOAD\n2, 1, 2e4")], "nothing tightens this section");
    refuses(BOLT, &[("*END STEP\n", &HELD.replace(", FIXED", ""))], "say FIXED");
    let freed = format!("{HELD}*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n1, 1, 6\n3, 1, 6\n*END STEP\n");
    refuses(BOLT, &[("*END STEP\n", &freed)], "held and then freed");
    for way in ["9, 1, 1, 1e-3", "9, 1"] {
        let moved = format!("{HELD}*STEP\n*STATIC\n*BOUNDARY\n{way}\n*END STEP\n");
        refuses(BOLT, &[("*END STEP\n", &moved)], "not moved afterwards");
    }
    refuses(BOLT, &[("*CLOAD\n9, 1, 2e4\n", ""), ("*END STEP\n", HELD)], "nothing tightens this section before");
    let late = HELD.replace("*CLOAD\n", "*CLOAD\n9, 1, 2e4\n");
    refuses(BOLT, &[("*CLOAD\n9, 1, 2e4\n", ""), ("*END STEP\n", &late)], "nothing tightens this section before");
    refuses(BOLT, &[("ELEMENT=1", "ELEMENT=rod")], "names 2 beams");
    let twice = "*PRE-TENSION SECTION, ELEMENT=2, NODE=9\n*BOUNDARY\n1, 1, 6";
    refuses(BOLT, &[("*BOUNDARY\n1, 1, 6", twice)], "another section has the pre-tension node 9");
}

/// What no joint takes from a pre-tension node.
#[test]
fn loads_of_its_node_that_are_refused() {
    let one = "degree of freedom 1 alone";
    refuses(BOLT, &[("9, 1, 2e4", "9, 1, 2e4\n9, 2, 1.")], one);
    refuses(BOLT, &[("*CLOAD\n9", "*BOUNDARY\n9, 1, 3, 1e-4\n*CLOAD\n9")], one);
    refuses(BOLT, &[("*CLOAD\n9, 1, 2e4", "*BOUNDARY, TYPE=VELOCITY\n9, 1, 1, 4e-4")], "led by a displacement");
    let other = "*END STEP\n*STEP\n*BUCKLE\n1\n*CLOAD\n9, 1, 1.\n*END STEP\n";
    refuses(BOLT, &[("*END STEP\n", other)], "steps of statics or of motion in time alone");
}
