//! Keywords that make nodes and elements: the same mesh as one that is written out.

use super::rows::refuses;
use super::{imported, imported_from, refusals};
use import::Dialect;

/// Two rows of nodes, filled; elements of shells and beams, copied and turned.
const MADE: &str = "*NODE, NSET=all\n1, 0., 0., 0.\n5, 4., 0., 0.\n105, 4., 2., 0.\n101, 0., 2., 0.\n*NGEN, NSET=low\n1, 5, 2\n\
    *NGEN, NSET=high\n101, 105, 2\n*NFILL, NSET=all\nlow, high, 2, 50\n*ELEMENT, TYPE=S4\n1, 1, 3, 53, 51\n*ELGEN, ELSET=skin\n\
    1, 2, 2, 1, 2, 50, 2\n*NCOPY, OLD SET=low, NEW SET=far, CHANGE NUMBER=1000, SHIFT\n0., 0., 1.\n0., 0., 0., 0., 0., 1., 180.\n\
    *ELEMENT, TYPE=B31, ELSET=rib\n50, 1, 3\n*ELGEN, ELSET=rib\n50, 2, 2\n*ELCOPY, OLD SET=rib, NEW SET=ribs, ELEMENT SHIFT=100, SHIFT NODES=1000\n";
const WRITTEN: &str = "*NODE\n1, 0., 0., 0.\n3, 2., 0., 0.\n5, 4., 0., 0.\n51, 0., 1., 0.\n53, 2., 1., 0.\n55, 4., 1., 0.\n\
    101, 0., 2., 0.\n103, 2., 2., 0.\n105, 4., 2., 0.\n1001, 0., 0., 1.\n1003, -2., 0., 1.\n1005, -4., 0., 1.\n\
    *NSET, NSET=low\n1, 3, 5\n*ELEMENT, TYPE=S4, ELSET=skin\n1, 1, 3, 53, 51\n2, 3, 5, 55, 53\n3, 51, 53, 103, 101\n\
    4, 53, 55, 105, 103\n*ELEMENT, TYPE=B31, ELSET=rib\n50, 1, 3\n51, 3, 5\n\
    *ELEMENT, TYPE=B31, ELSET=ribs\n150, 1001, 1003\n151, 1003, 1005\n";
const REST: &str = "*ELSET, ELSET=beams\nrib, ribs\n*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*SHELL SECTION, ELSET=skin, MATERIAL=m\n0.1\n\
    *BEAM SECTION, ELSET=beams, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 0., 1.\n*BOUNDARY\nlow, 1, 6\n1001, 1, 6\n\
    *STEP\n*STATIC\n*CLOAD\n1005, 3, 1.\n*END STEP\n";

/// The numbers of nodes with their places, and the elements; places are rounded to what a turn by 180 degrees leaves.
fn mesh(text: &str) -> (Vec<String>, Vec<String>) {
    let made = imported_from(&format!("{text}{REST}"), Some(Dialect::Abaqus));
    assert_eq!(refusals(&made), [""; 0]);
    let (nodes, rest) = made.mesh.split_once("*ELEMENT").unwrap();
    let number = |word: &str| word.parse::<f64>().map_or(word.to_owned(), |x| format!("{:.9}", x + 0.0));
    let place =
        |line: &str| line.split(", ").map(number).collect::<Vec<_>>().join(" ").replace("-0.000000000", "0.000000000");
    let mut nodes: Vec<String> = nodes.lines().filter(|line| !line.starts_with('*')).map(place).collect();
    let cells = rest.split("*NSET").next().unwrap().lines().skip(1).map(str::to_owned);
    let mut cells: Vec<String> = cells.collect();
    nodes.sort();
    cells.sort();
    (nodes, cells)
}

#[test]
fn a_mesh_that_is_made() {
    assert_eq!(mesh(MADE), mesh(WRITTEN));
}

/// Ranges reach the numbers that are made, and an instance has room for them.
#[test]
fn numbers_that_are_made() {
    let ranged = MADE.replace("*ELEMENT, TYPE=S4", "*NSET, NSET=more, GENERATE\n1, 1005\n*ELEMENT, TYPE=S4");
    let made = imported(&format!("{ranged}{REST}").replace("1001, 1, 6\n", "more, 1, 1\n1001, 1, 6\n"));
    assert!(
        made.mesh.contains("*NSET, NSET=more\n1, 3, 5, 51, 53, 55, 101, 103, 105, 1001\n1003, 1005\n"),
        "{}",
        made.mesh
    );
}

#[test]
fn meshes_that_cannot_be_made() {
    for (old, new, why) in [
        ("1, 5, 2\n", "1, 5, 3\n", "does not lead from node 1 to node 5"),
        ("1, 5, 2\n", "1, 6, 1\n", "node 1 or node 6 does not exist"),
        ("*NGEN, NSET=low", "*NGEN, NSET=low, LINE=C", "straight line alone"),
        ("low, high, 2, 50", "low, other, 2, 50", "no node set before this line"),
        ("low, high, 2, 50", "low, all, 2, 50", "must lead to that of the second set"),
        ("low, high, 2, 50", "low, high, 2, 40", "must lead to that of the second set"),
        ("*NFILL, NSET=all", "*NFILL, NSET=all, BIAS=0.5", "even distances alone"),
        ("1, 2, 2, 1, 2, 50, 2\n", "9, 2, 2, 1, 2, 50, 2\n", "element 9 does not exist"),
        ("1, 2, 2, 1, 2, 50, 2\n", "1, 99999999, 2, 1\n", "more than 2000000 nodes and elements"),
        ("CHANGE NUMBER=1000, SHIFT", "CHANGE NUMBER=4, SHIFT", "at another place"),
        ("5, 4., 0., 0.\n", "5, 4., 0., 0.\n3, 9., 9., 9.\n", "node 3 exists before this line, at another place"),
        ("OLD SET=low,", "OLD SET=lost,", "node 99 of this set does not exist"),
        ("CHANGE NUMBER=1000, SHIFT", "CHANGE NUMBER=1000, REFLECT=LINE", "nodes are copied once and by SHIFT alone"),
        ("CHANGE NUMBER=1000, SHIFT", "SHIFT", "needs CHANGENUMBER="),
        ("0., 0., 0., 0., 0., 1., 180.", "0., 0., 0., 0., 0., 0., 180.", "the two points of the axis"),
        ("OLD SET=rib,", "OLD SET=ribbon,", "no set before this line is named `ribbon`"),
    ] {
        assert!(MADE.contains(old), "{old}");
        let text = MADE.replacen(old, new, 1).replacen("*ELEMENT", "*NSET, NSET=lost\n99\n*ELEMENT", 1);
        refuses(&format!("{text}{REST}"), &[], why);
    }
}
