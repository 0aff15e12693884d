//! Pre-tension sections of beams against closed forms of two beams between two walls.

use super::rows::{edited, has, refuses};
use super::values::{model_of, near};
use super::{imported, refusals};
use crate::support;

/// Two beams of 1 and 3 between two walls; the first is cut at node 2. E A = 2e8 and loads are small.
const BOLT: &str = "*NODE, NSET=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 4., 0., 0.\n9, 0., 1., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n2, 2, 3\n\
    *MATERIAL, NAME=m\n*ELASTIC\n1e10, 0.\n*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n\
    *PRE-TENSION SECTION, ELEMENT=1, NODE=9\n1., 0., 0.\n*BOUNDARY\n1, 1, 6\n3, 1, 6\n*STEP\n*STATIC\n1., 1.\n*CLOAD\n9, 1, 2e4\n*END STEP\n";
/// A second step that holds the section and pulls at node 2.
const HELD: &str = "*END STEP\n*STEP\n*STATIC\n1., 1.\n*BOUNDARY, FIXED\n9, 1\n*CLOAD\n2, 1, 1e4\n*END STEP\n";

/// Displacements along x of node 2 and of the new end of the beam, after the last step.
fn ends(text: &str) -> [f64; 2] {
    let made = imported(text);
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
    for text in [
        BOLT.to_owned(),
        edited(BOLT, &[("NODE=9\n1.,", "NODE=9\n-1.,")]),
        edited(BOLT, &[("NODE=9\n1., 0., 0.\n", "NODE=9\n")]),
    ] {
        let [rest, end] = ends(&text);
        near(rest, -3e-4, 1e-9);
        near(end, 1e-4, 1e-9);
    }
    has(BOLT, &[], None, "kind = \"prismatic\"\n");
}

/// A way d that is taken up gives the force E A d/(L1 + L2); a way of zero welds the cut.
#[test]
fn a_way_tightens() {
    let [rest, end] = ends(&edited(BOLT, &[("*CLOAD\n9, 1, 2e4", "*BOUNDARY\n9, 1, 1, 4e-4")]));
    near(rest, -3e-4, 1e-9);
    near(end, 1e-4, 1e-9);
    has(BOLT, &[("*CLOAD\n9, 1, 2e4", "*BOUNDARY\n9, 1\n*CLOAD\n2, 1, 5.")], None, "kind = \"fixed\"\n");
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
}
