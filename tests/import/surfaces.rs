//! Surfaces of edges and faces: couplings, and loads along edges.

use super::rows::{SHELL, edited, has, refuses};
use super::values::{model_of, moves, near};
use super::{deck, imported, reasons, refusals, tables};
use crate::support;
use import::KeywordVerdict;

/// The edge of the last two elements as a surface goes with the reference node as a set of its nodes does: M L²/(2 E I).
#[test]
fn a_coupling_of_an_edge() {
    let body = "*Rigid body, Nset=Internal_Rigid_Edge, Ref node=100, Rot node=101\n";
    let edge = "*Elset, Elset=last\n19, 20\n*Surface, Type=Element, Name=edge\nlast, E2\n\
                *Coupling, Constraint name=c, Ref node=100, Surface=edge\n*Kinematic\n";
    let text = edited(&deck("rigid_edge"), &[(body, edge), ("\n101, 2, 10", "\n100, 5, 10")]);
    // Large rotations of 6e-3 lower it by the square over 12.
    near(moves(&text, "mesh.32").0[2], -2.857135e-3, 1e-5);
}

/// Axes of a coupling make no difference where all degrees of freedom go with the node.
#[test]
fn axes_of_a_coupling() {
    let with = |degrees: &str| {
        format!(
            "*NODE\n9, 2., 1., 0.\n*ORIENTATION, NAME=o\n0., 1., 0., -1., 0., 0.\n*SURFACE, NAME=edge\nskin, E2\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=edge, ORIENTATION=o\n*KINEMATIC\n{degrees}*STEP, NLGEOM"
        )
    };
    has(SHELL, &[("*STEP, NLGEOM", &with(""))], None, "nodes = [\"mesh.2\", \"mesh.3\", \"mesh.9\"]\n");
    has(SHELL, &[("*STEP, NLGEOM", &with("1, 6\n"))], None, "nodes = [\"mesh.2\", \"mesh.3\", \"mesh.9\"]\n");
    refuses(SHELL, &[("*STEP, NLGEOM", &with("1, 2\n"))], "the axes of a coupling are the global ones");
    refuses(
        SHELL,
        &[("*STEP, NLGEOM", &with("").replace("SURFACE=edge", "SURFACE=none"))],
        "no surface is named `none`",
    );
}

/// EDNOR acts inwards, EDSHR along the edge, EDTRA against the normal; each on half of the edge at either end.
#[test]
fn loads_along_edges() {
    let load = |line: &str| {
        let lines = format!("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n{line}");
        edited(SHELL, &[("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CLOAD\n3, 3, 5.", &lines)])
    };
    let edge = |line: &str| load(line).replace("*STEP", "*SURFACE, NAME=edge\nskin, E2\n*STEP");
    for (text, force) in [
        (load("*DLOAD\nskin, EDNOR2, 8."), "[-4.0, 0.0, 0.0]"),
        (edge("*DSLOAD\nedge, EDNOR, 8."), "[-4.0, 0.0, 0.0]"),
        (edge("*DSLOAD\nedge, EDSHR, 8."), "[0.0, 4.0, 0.0]"),
        (edge("*DSLOAD\nedge, EDTRA, 8."), "[0.0, 0.0, -4.0]"),
        (edge("*DSLOAD, FOLLOWER=NO\nedge, EDLD, 8., 0., 2., 0."), "[0.0, 4.0, 0.0]"),
    ] {
        has(&text, &[], None, &format!("[[loads]]\nat = [\"mesh.2\", \"mesh.3\"]\nforce = {force}\n"));
    }
    let turns = |text: &str| reasons(&imported(text), KeywordVerdict::Changed).len();
    assert_eq!(turns(&edge("*DSLOAD\nedge, EDNOR, 8.")), 1);
    assert_eq!(turns(&edge("*DSLOAD, FOLLOWER=NO\nedge, EDLD, 8., 0., 2., 0.")), 0);
    assert_eq!(turns(&edge("*DSLOAD\nedge, EDNOR, 8.").replace(", NLGEOM", "")), 0);
    refuses(&edge("*DSLOAD\nedge, EDMOM, 8."), &[], "no moments per length along edges");
    refuses(&edge("*DSLOAD\nedge, EDLD, 8."), &[], "EDLD needs a direction");
    refuses(&load("*DLOAD\nskin, EDNOR5, 8."), &[], "holds no edges of shells");
    refuses(&load("*DLOAD\nskin, EDGE, 8."), &[], "EDNOR, EDSHR, EDTRA and EDLD along edges");
    // Only EDLD and TRVEC obey FOLLOWER=NO.
    assert_eq!(turns(&edge("*DSLOAD, FOLLOWER=NO\nedge, EDNOR, 8.")), 1);
    // An edge that two lines of a surface hold is loaded once; S4 of CalculiX is E2. The closing edge goes from node 4 to node 1.
    let twice = edge("*DSLOAD\nedge, EDNOR, 8.").replace("skin, E2\n", "skin, E2\n1, E2\nskin, S4\n");
    has(&twice, &[], None, "at = [\"mesh.2\", \"mesh.3\"]\nforce = [-4.0, 0.0, 0.0]\n");
    has(&load("*DLOAD\nskin, EDSHR4, 8."), &[], None, "at = [\"mesh.1\", \"mesh.4\"]\nforce = [0.0, -4.0, 0.0]\n");
    // The third edge of a triangle of corners (0, 0), (1, 0), (1, 1): √2 long, inwards along (1, −1)/√2.
    let triangle =
        load("*DLOAD\nskin, EDNOR3, 8.").replace("TYPE=S4,", "TYPE=S3,").replace("1, 1, 2, 3, 4\n", "1, 1, 2, 3\n");
    has(&triangle, &[], None, "at = [\"mesh.1\", \"mesh.3\"]\nforce = [4.0, -4.0, 0.0]\n");
}

/// On an edge or a face the weights of a distributing coupling are lengths or areas: 1/6, 1/2 and 1/3 on edges of 1 and 2.
#[test]
fn weights_of_distributing_couplings() {
    let edits = [
        ("4, 0., 1., 0.\n", "4, 0., 1., 0.\n5, 0., 3., 0.\n6, 1., 3., 0.\n9, 2., 1.5, 0.\n"),
        (
            "1, 1, 2, 3, 4\n",
            "1, 1, 2, 3, 4\n2, 4, 3, 6, 5\n*SURFACE, NAME=edge\nskin, E2\n1, E2\n*SURFACE, NAME=face\nskin, SPOS\n",
        ),
        ("*STEP", "*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=edge\n*DISTRIBUTING\n*STEP"),
        ("3, 3, 5.", "9, 1, 6."),
    ];
    for (node, force) in [(2, 1.0), (3, 3.0), (6, 2.0)] {
        let wanted = format!("at = \"mesh.{node}\"\nforce = [{force:?}, ");
        assert!(forces(&imported(&edited(SHELL, &edits)).deck).contains(&wanted), "{wanted}");
    }
    // A force at the centre of area of the face, (0.5, 1.5): areas of 1 and 2 by their corners.
    let edits = [edits[0], edits[1], (edits[2].0, &edits[2].1.replace("SURFACE=edge", "SURFACE=face")), edits[3]];
    let text = edited(SHELL, &edits).replace("9, 2., 1.5, 0.", "9, 0.5, 1.5, 0.");
    for (node, force) in [(1, 0.5), (2, 0.5), (3, 1.5), (4, 1.5), (5, 1.0), (6, 1.0)] {
        let deck = forces(&imported(&text).deck);
        let of = deck.split("[[loads]]").skip(1).find(|load| load.contains(&format!("\"mesh.{node}\""))).unwrap();
        assert!(of.contains(&format!("force = [{force:?}, 0.0, 0.0]")), "{node} {force}: {deck}");
    }
}

/// The loads of a deck, with forces to ten digits.
fn forces(deck: &str) -> String {
    let round = |word: &str| match word.trim_matches(['[', ']', ',']).parse::<f64>() {
        Ok(x) => word.replace(word.trim_matches(['[', ']', ',']), &format!("{:?}", (x * 1e10).round() / 1e10 + 0.0)),
        Err(_) => word.to_owned(),
    };
    let line = |line: &str| line.split(' ').map(round).collect::<Vec<_>>().join(" ") + "\n";
    tables(deck).lines().map(line).collect()
}

/// The middle of an edge of three nodes has two thirds of its load, and a curved edge the resultant of its chord.
#[test]
fn loads_along_curved_edges() {
    let eight = edited(
        SHELL,
        &[
            ("4, 0., 1., 0.\n", "4, 0., 1., 0.\n5, 0.5, 0., 0.\n6, 1., 0.5, 0.\n7, 0.5, 1., 0.\n8, 0., 0.5, 0.\n"),
            ("TYPE=S4,", "TYPE=S8R,"),
            ("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4, 5, 6, 7, 8\n"),
            ("*CLOAD\n3, 3, 5.", "*DLOAD\nskin, EDNOR2, 6."),
        ],
    );
    let made = imported(&eight);
    assert_eq!(refusals(&made), [""; 0]);
    for wanted in
        ["at = [\"mesh.2\", \"mesh.3\"]\nforce = [-1.0, 0.0, 0.0]\n", "at = \"mesh.6\"\nforce = [-4.0, 0.0, 0.0]\n"]
    {
        assert!(tables(&made.deck).contains(wanted), "{wanted} is not in\n{}", made.deck);
    }
    // A pressure on any curve between two points has the resultant of their chord: 6 along −x.
    let bent = imported(&eight.replace("6, 1., 0.5, 0.", "6, 1.2, 0.5, 0."));
    let text = tables(&bent.deck);
    let loads = text.split("[[loads]]\n").skip(1);
    let resultant: f64 = loads
        .map(|load| {
            let mut lines = load.lines();
            let nodes = lines.next().unwrap().matches("mesh.").count();
            let force = lines.next().unwrap().trim_start_matches("force = [");
            nodes as f64 * force.split(',').next().unwrap().parse::<f64>().unwrap()
        })
        .sum();
    // Gauss's three points are exact for the normal of a parabola times its shape functions.
    assert!((resultant + 6.0).abs() < 1e-12, "{text}");
}

/// Pre-processors write a line for each element: they are one load of one part, in each step.
#[test]
fn loads_of_single_elements() {
    let edits = [
        ("4, 0., 1., 0.\n", "4, 0., 1., 0.\n5, 0., 3., 0.\n6, 1., 3., 0.\n"),
        ("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4\n2, 4, 3, 6, 5\n"),
        ("*CLOAD\n3, 3, 5.", "*DLOAD\n1, P, 8.\n2, P, 8."),
    ];
    let one = edited(SHELL, &edits);
    has(&one, &[], None, "[[loads]]\npart = \"skin\"\npressure = -8.0\n");
    let two = format!("{one}*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*DLOAD\n2, P, 4.\n1, P, 4.\n*END STEP\n");
    has(&two, &[], None, "points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.5]]\n");
    // A later step that loads one of them alone, or both otherwise, has two loads: one of 8, and one of 8 that becomes 4.
    for loads in ["2, P, 4.", "1, P, 8.\n2, P, 4."] {
        let later = format!("{one}*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*DLOAD\n{loads}\n*END STEP\n");
        let made = imported(&later);
        assert_eq!(refusals(&made), [""; 0]);
        assert_eq!(tables(&made.deck).matches("[[loads]]").count(), 2, "{}", made.deck);
        assert!(made.deck.contains("[0.0, 0.0], [1.0, 1.0], [2.0, 0.5]"), "{}", made.deck);
    }
    // Three of which two are given again: a set of two, and one element.
    let three = one
        .replace("2, 4, 3, 6, 5\n", "2, 4, 3, 6, 5\n3, 5, 6, 8, 7\n")
        .replace("6, 1., 3., 0.\n", "6, 1., 3., 0.\n7, 0., 4., 0.\n8, 1., 4., 0.\n");
    let three = three.replace("2, P, 8.", "2, P, 8.\n3, P, 8.");
    let made = imported(&format!("{three}*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*DLOAD\n1, P, 4.\n2, P, 4.\n*END STEP\n"));
    assert_eq!(refusals(&made), [""; 0]);
    assert_eq!(tables(&made.deck).matches("[[loads]]").count(), 2, "{}", made.deck);
    let made = imported(&one.replace("2, P, 8.", "2, P, 9."));
    assert_eq!(tables(&made.deck).matches("[[loads]]").count(), 2, "{}", made.deck);
}

/// Elements that are no parts keep their own lines, and joined lines share what is said of their load.
#[test]
fn loads_of_single_elements_that_are_refused() {
    let rigid = "1, 1, 2, 3, 4\n*ELEMENT, TYPE=R3D4, ELSET=stiff\n9, 1, 2, 3, 4\n*ELSET, ELSET=both\n1, 9\n*RIGID BODY, ELSET=stiff, REF NODE=1";
    let with = |loads: &str| edited(SHELL, &[("1, 1, 2, 3, 4", rigid), ("*CLOAD\n3, 3, 5.", loads)]);
    let text = with("*DLOAD\n1, P, 8.\n*DLOAD\n9, P, 8.");
    let line = 1 + text.lines().position(|line| line == "9, P, 8.").unwrap();
    let said = refusals(&imported(&text));
    let wanted = format!("{line} *DLOAD: this load acts on elements that are no beams, bars or shells of the deck");
    assert!(said.contains(&wanted), "{said:?}");
    refuses(&with("*DLOAD\nboth, P, 8."), &[], "acts on element 9, which is no beam, bar or shell");
    let two = edited(
        SHELL,
        &[
            ("4, 0., 1., 0.\n", "4, 0., 1., 0.\n5, 0., 3., 0.\n6, 1., 3., 0.\n"),
            ("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4\n2, 4, 3, 6, 5\n"),
            ("*CLOAD\n3, 3, 5.", "*DLOAD\n1, HP, 8.\n*DLOAD\n2, HP, 8."),
        ],
    );
    let said = refusals(&imported(&two));
    assert_eq!(said.iter().filter(|said| said.ends_with("loads of kind HP are not translated")).count(), 2, "{said:?}");
}

/// Tractions on faces have a direction in space.
#[test]
fn tractions_on_faces() {
    let text = edited(
        SHELL,
        &[
            ("*CLOAD\n3, 3, 5.", "*DSLOAD\ntop, TRVEC, 6., 0., 3., 4."),
            ("*STEP,", "*SURFACE, NAME=top\nskin, SNEG\n*STEP,"),
        ],
    );
    // 6 along (0, 0.6, 0.8).
    let made = imported(&text);
    assert_eq!(refusals(&made), [""; 0]);
    let line = made.deck.lines().find_map(|line| line.strip_prefix("force_per_area = [")).unwrap();
    let found: Vec<f64> = line.trim_end_matches(']').split(", ").map(|x| x.parse().unwrap()).collect();
    for (found, wanted) in found.into_iter().zip([0.0, 3.6, 4.8]) {
        assert!((found - wanted).abs() < 1e-14, "{line}"); // rounding
    }
    refuses(&text, &[("TRVEC, 6., 0., 3., 4.", "TRVEC, 6.")], "TRVEC needs a direction");
    refuses(&text, &[("TRVEC", "TRSHR")], "no TRSHR on SNEG");
}

/// A rigid punch over the free end of a cantilever strip.
const PUNCH: &str = "*PART, NAME=Strip\n*NODE\nNODES*ELEMENT, TYPE=S4, ELSET=skin\nCELLS*SHELL SECTION, ELSET=skin, MATERIAL=m\n0.01\n*END PART\n\
    *PART, NAME=Punch\n*NODE\n1, 0.95, -0.05, 0.\n2, 1.1, -0.05, 0.\n3, 1.1, 0.15, 0.\n4, 0.95, 0.15, 0.\n9, 1., 0., 0.1\n\
    *ELEMENT, TYPE=R3D4, ELSET=stamp\n1, 1, 2, 3, 4\n*NSET, NSET=RP\n9\n*END PART\n\
    *ASSEMBLY, NAME=A\n*INSTANCE, NAME=S, PART=Strip\n*END INSTANCE\n*INSTANCE, NAME=P, PART=Punch\n0., 0., 0.006\n*END INSTANCE\n\
    *SURFACE, NAME=top\nS.skin, SPOS\n*SURFACE, NAME=face\nP.stamp, SNEG\n*RIGID BODY, REF NODE=P.RP, ELSET=P.stamp\n*END ASSEMBLY\n\
    *MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.\n*SURFACE INTERACTION, NAME=smooth\n1.\nFRICTION*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n\
    *BOUNDARY\nS.1, 1, 6\nS.22, 1, 6\nP.RP, 1, 2\nP.RP, 4, 6\n*CONTACT PAIR, INTERACTION=smooth, TYPE=SURFACE TO SURFACE\ntop, face\n\
    *STEP, NLGEOM\n*STATIC\n0.1, 1.\n*BOUNDARY\nP.RP, 3, 3, -0.003\n*OUTPUT, FIELD, VARIABLE=PRESELECT\n*END STEP\n";

/// The file of the punch, with further lines below its law of contact.
fn punch(friction: &str) -> String {
    let place = |k: usize| format!("{}, {:?}, {:?}, 0.\n", k + 1, 0.05 * (k % 21) as f64, 0.1 * (k / 21) as f64);
    let cell = |k: usize| format!("{}, {}, {}, {}, {}\n", k + 1, k + 1, k + 2, k + 23, k + 22);
    let (nodes, cells): (String, String) = ((0..42).map(place).collect(), (0..20).map(cell).collect());
    PUNCH.replace("NODES", &nodes).replace("CELLS", &cells).replace("FRICTION", friction)
}

#[test]
fn a_contact_pair() {
    let made = imported(&punch(""));
    assert_eq!(refusals(&made), [""; 0]);
    assert_eq!(reasons(&made, KeywordVerdict::Changed), [""; 0]);
    assert!(made.mesh.contains("*ELEMENT, TYPE=S4, ELSET=P.stamp_faces\n101, 101, 102, 103, 104\n"), "{}", made.mesh);
    has(&punch(""), &[], None, "surface = { part = \"P.stamp_faces\" }\nwith = \"skin\"\n");
    has(&punch(""), &[], None, "[[bodies]]\nname = \"P.stamp\"\nparts = \"P.stamp_faces\"\n");
}

#[test]
fn laws_of_contact() {
    has(&punch("*FRICTION\n0.2,\n"), &[], None, "friction = 0.2\n");
    has(
        &punch("*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2, 5.\n"),
        &[
            ("*STATIC\n0.1, 1.", "*DYNAMIC\n0.1, 1."),
            ("*BOUNDARY\nP.RP, 3, 3, -0.003\n", ""),
            ("*ELASTIC\n2e11", "*DENSITY\n7800.\n*ELASTIC\n2e11"),
        ],
        None,
        "friction = { static = 0.3, kinetic = 0.2, decay = 5.0 }\n",
    );
    refuses(&punch("*FRICTION, ROUGH\n"), &[], "friction is Coulomb's");
    // Statics has no speeds, and no decay is none.
    let decay = |numbers: &str| punch(&format!("*FRICTION, EXPONENTIAL DECAY\n{numbers}\n"));
    has(&decay("0.3, 0.2, 5."), &[], None, "friction = 0.3\n");
    assert_eq!(reasons(&imported(&decay("0.3, 0.2, 5.")), KeywordVerdict::Changed).len(), 1);
    let moving = [
        ("*STATIC\n0.1, 1.", "*DYNAMIC\n0.1, 1."),
        ("*BOUNDARY\nP.RP, 3, 3, -0.003\n", ""),
        ("*ELASTIC\n2e11", "*DENSITY\n7800.\n*ELASTIC\n2e11"),
    ];
    has(&decay("0.3, 0.2"), &moving, None, "friction = { static = 0.3, kinetic = 0.2 }\n");
    for wrong in ["-0.1, -0.1", "0.2, 0.3, 5.", "0.3, 0.2, -1."] {
        refuses(&decay(wrong), &[], "coefficients of friction are 0 or more");
    }
    // The default of Abaqus leaves out the thickness of shells.
    for (kind, changes) in [
        (", TYPE=NODE TO SURFACE", 1),
        ("", 1),
        (", SMALL SLIDING, TYPE=SURFACE TO SURFACE", 1),
        (", TYPE=SURFACE TO SURFACE", 0),
    ] {
        let text = punch("").replace(", TYPE=SURFACE TO SURFACE", kind);
        assert_eq!(reasons(&imported(&text), KeywordVerdict::Changed).len(), changes, "{kind}");
    }
    refuses(&punch(""), &[("INTERACTION=smooth, ", "")], "*CONTACT PAIR needs INTERACTION=");
    let plain = punch("");
    refuses(&plain, &[("INTERACTION=smooth,", "INTERACTION=rough,")], "no surface interaction is named `rough`");
    refuses(&plain, &[("top, face", "top, none")], "no surface is named `none`");
    refuses(&plain, &[("PRESSURE-OVERCLOSURE=HARD", "NO SEPARATION")], "give *TIE");
    refuses(&plain, &[("*CONTACT PAIR,", "*CONTACT PAIR, TIED,")], "give *TIE");
    refuses(&plain, &[("S.skin, SPOS", "S.skin, E1")], "contact of edges");
    let linear = [("OVERCLOSURE=HARD\n", "OVERCLOSURE=LINEAR\n1e9,\n")];
    let said = reasons(&imported(&edited(&plain, &linear)), KeywordVerdict::Changed);
    assert!(said[0].contains("rdsolve chooses the stiffness"), "{said:?}");
}

/// The edge of the punch presses nodes at a = 0.95 down by u = 2 mm; the strip at x = 0.5 sinks by u x² (3 a - x)/(2 a³). The edge lies on
/// these nodes or beside them. Shear and large rotations change it by less than 1e-3.
#[test]
fn a_rigid_punch() {
    let heavy = ("*ELASTIC\n2e11", "*DENSITY\n7800.\n*ELASTIC\n2e11");
    let beside = [("1, 0.95, -0.05", "1, 0.94, -0.05"), ("4, 0.95, 0.15", "4, 0.94, 0.15")];
    for edits in [vec![], vec![heavy], beside.to_vec(), [&beside[..], &[heavy]].concat()] {
        near(moves(&edited(&punch(""), &edits), "mesh.11").0[2], -6.85231e-4, 2e-3);
    }
}

/// The punch may turn against a spring k at its reference node, and touches the strip at 0.95 and at its end. With e the ways from there to the node,
/// forces F turn it by e·F/k: (c + e eᵀ/k) F = u, with c of a cantilever. Wherever the node lies, multipliers hold the punch there.
#[test]
fn a_rigid_punch_that_may_turn() {
    let turning = |stiffness: f64, [x, y, z]: [f64; 3]| {
        let spring = format!(
            "*NODE\n500, 1., 0., 0.2\n*ELEMENT, TYPE=SPRING2, ELSET=turn\n900, 500, P.9\n*SPRING, ELSET=turn\n5, 5\n{stiffness:?}\n*MATERIAL, NAME=m"
        );
        let edits = [
            ("*MATERIAL, NAME=m", &spring[..]),
            ("P.RP, 4, 6", "P.RP, 4, 4\nP.RP, 6, 6\n500, 1, 6"),
            ("\n9, 1., 0., 0.1\n", &format!("\n9, {x:?}, {y:?}, {z:?}\n")),
        ];
        edited(&punch(""), &edits)
    };
    let center = [1.025, 0.05, 0.0];
    for (stiffness, place) in [(100.0, [1.0, 0.0, 0.1]), (200.0, [1.025, 0.0, 0.0]), (200.0, center)] {
        let (at, over, u) = ([0.95, 1.0], 6.0 * 2e11 * 0.1 * 1e-6 / 12.0, 0.002);
        // The deflection at x under a unit force at a.
        let bend = |x: f64, a: f64| x.min(a).powi(2) * (3.0 * x.max(a) - x.min(a)) / over;
        let c = |i: usize, j: usize| bend(at[i], at[j]) + (place[0] - at[i]) * (place[0] - at[j]) / stiffness;
        let forces = [c(1, 1) - c(0, 1), c(0, 0) - c(0, 1)].map(|x| u * x / (c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1)));
        assert!(forces[0] > 0.0 && forces[1] > 0.0, "{forces:?}");
        let wanted = -forces[0] * bend(0.5, at[0]) - forces[1] * bend(0.5, at[1]);
        near(moves(&turning(stiffness, place), "mesh.11").0[2], wanted, 2e-3);
    }
    // At the centre supports of the body do the same without multipliers. Load steps converge to 1e-8.
    let mut made = imported(&turning(200.0, center));
    let mut sunk = [0.0; 2];
    for sunk in &mut sunk {
        let model = model_of(&made);
        let at = support::node(&model, "mesh.11");
        let done = support::run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[at].x.z]);
        *sunk = done.rows.last().unwrap()[0];
        made.deck = made.deck.replace("at = \"P.RP\"", "at = \"P.stamp\"");
    }
    near(sunk[0], sunk[1], 1e-6);
}

/// The punch moves without a force until it touches: nothing resists it, and nothing is left to balance.
#[test]
fn a_rigid_punch_that_does_not_touch() {
    for edge in ["0.94", "0.95"] {
        let text =
            punch("").replace("0.95, -0.05", &format!("{edge}, -0.05")).replace("0.95, 0.15", &format!("{edge}, 0.15"));
        let text = edited(&text, &[("3, 3, -0.003", "3, 3, -0.0005")]);
        // The regularization of joints leaves its part of the motion, 1e-11.
        near(moves(&text, "mesh.101").0[2], -0.0005, 1e-9);
    }
}

/// A clamped strip pressed down by 3 mm by a thick plate: nodes of the strip at 0.25, as CalculiX 2.20 has them with S4 and with S8R.
#[test]
fn a_contact_between_shells() {
    let grid = |first: usize, [nx, ny]: [usize; 2], [x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64| -> [String; 2] {
        let place = |k: usize| {
            let (i, j) = (k % (nx + 1), k / (nx + 1));
            let at = |a: f64, b: f64, i: usize, n: usize| a + (b - a) * i as f64 / n as f64;
            format!("{}, {:?}, {:?}, {z:?}\n", first + k + 1, at(x0, x1, i, nx), at(y0, y1, j, ny))
        };
        let cell = |k: usize| {
            let a = first + k / nx * (nx + 1) + k % nx + 1;
            format!("{}, {a}, {}, {}, {}\n", first + k + 1, a + 1, a + nx + 2, a + nx + 1)
        };
        [(0..(nx + 1) * (ny + 1)).map(place).collect(), (0..nx * ny).map(cell).collect()]
    };
    let [strip_nodes, strip] = grid(0, [40, 4], [0.0, 1.0], [0.0, 0.1], 0.0);
    let [plate_nodes, plate] = grid(1000, [6, 6], [0.45, 0.55], [-0.02, 0.12], 0.016);
    let text = format!(
        "*NODE\n{strip_nodes}{plate_nodes}*ELEMENT, TYPE=S4, ELSET=strip\n{strip}*ELEMENT, TYPE=S4, ELSET=plate\n{plate}\
         *NSET, NSET=ends\n1, 42, 83, 124, 165, 41, 82, 123, 164, 205\n*NSET, NSET=top, GENERATE\n1001, 1049\n\
         *SURFACE, NAME=below, TYPE=ELEMENT\nplate, SNEG\n*SURFACE, NAME=above, TYPE=ELEMENT\nstrip, SPOS\n\
         *MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*SHELL SECTION, ELSET=strip, MATERIAL=m\n0.01\n\
         *SHELL SECTION, ELSET=plate, MATERIAL=m\n0.02\n*BOUNDARY\nends, 1, 6\ntop, 1, 2\ntop, 4, 6\n\
         *SURFACE INTERACTION, NAME=hard\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n\
         *CONTACT PAIR, INTERACTION=hard, TYPE=SURFACE TO SURFACE\nabove, below\n\
         *STEP, NLGEOM\n*STATIC\n0.1, 1.\n*BOUNDARY\ntop, 3, 3, -0.004\n*END STEP\n"
    );
    // -0.0015521 with S4, and -0.0015477 with S8R on the same mesh: their elements differ by 3e-3.
    near(moves(&text, "mesh.11").0[2], -0.0015521, 5e-3);
}
