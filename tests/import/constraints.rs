//! Axes at nodes, equations, couplings that spread forces, and parts beside their nodes: values against closed forms.

use super::rows::{BEAM, SHELL, edited, has, refuses};
use super::values::{moves, near};
use super::{imported, imported_from, reasons, refusals};
use import::{Dialect, KeywordVerdict};

/// A linear cantilever of one beam that is pulled.
fn pulled(edits: &[(&str, &str)]) -> String {
    edited(&edited(BEAM, &[(", NLGEOM", ""), ("2, 3, 5.", "2, 1, 5.")]), edits)
}

/// A force at the upper side of a strip bends it down by P e L²/(2 E I), e half the thickness; one element carries a constant moment.
#[test]
fn a_shell_below_its_nodes() {
    let edits = [
        (", NLGEOM", ""),
        ("3, 3, 5.", "2, 1, 2.5\n3, 1, 2.5"),
        ("1, 1, 6", "1, 1, 6\n4, 1, 6"),
        ("1e9, 0.3", "1e9, 0."),
    ];
    let text = SHELL.replace("MATERIAL=m\n0.01", "MATERIAL=m, OFFSET=SPOS\n0.01");
    let moved = moves(&edited(&text, &edits), "mesh.3").0;
    near(moved[2], -5.0 * 0.005 / (2.0 * 1e9 * 0.01_f64.powi(3) / 12.0), 1e-6);
    let made = imported_from(&edited(&text, &edits), Some(Dialect::Calculix));
    assert!(reasons(&made, KeywordVerdict::Changed)[0].contains("rigid arms"), "{}", made.deck);
}

/// A force at the side of a rectangle, or at the lower edge of an I section: P e L²/(2 E I) towards the other side.
#[test]
fn beams_beside_their_nodes() {
    let section = "SECTION=RECT\n0.1, 0.2";
    let moved = moves(&pulled(&[(section, "SECTION=RECT, OFFSET1=0.5\n0.1, 0.2")]), "mesh.2").0;
    near(moved[1], -5.0 * 0.05 / (2.0 * 1e9 * 0.2 * 0.1_f64.powi(3) / 12.0), 1e-6);
    let moved = moves(&pulled(&[(section, "SECTION=I\n0., 0.2, 0.1, 0.1, 0.01, 0.01, 0.005")]), "mesh.2").0;
    let moment = (0.1 * 0.2_f64.powi(3) - 0.095 * 0.18_f64.powi(3)) / 12.0;
    near(moved[2], 5.0 * 0.1 / (2.0 * 1e9 * moment), 1e-6);
    refuses(BEAM, &[(section, "SECTION=PIPE, OFFSET1=a\n0.1, 0.01")], "OFFSET1 must be a number");
    let general = "SECTION=GENERAL, OFFSET1=0.5\n0.02, 3e-3, 0., 4e-3, 5e-3";
    refuses(BEAM, &[(section, general)], "of rectangles, boxes, tubes and ellipses alone");
}

/// A square tube by its walls has the integrals of a box with the same middle line; a hexagon those of two solid ones.
#[test]
fn sections_of_thin_walls() {
    let walls = "SECTION=ARBITRARY\n4, 0., 0., 0.1, 0., 0.01\n0.1, 0.1, 0.01\n0., 0.1, 0.01\n0., 0., 0.01";
    let made = imported(&edited(BEAM, &[("SECTION=RECT\n0.1, 0.2", walls)]));
    assert_eq!(refusals(&made), [""; 0]);
    let number = |key: &str| -> f64 {
        let line = made.deck.lines().find(|line| line.starts_with(key)).unwrap();
        line.split(['[', ' ', ',', ']']).filter_map(|word| word.parse().ok()).next().unwrap()
    };
    near(number("area"), 0.004, 1e-12);
    let moment = 2.0 * 0.01 * (0.1_f64.powi(3) / 12.0 + 0.1 * 0.01_f64.powi(2) / 12.0 + 0.1 * 0.05_f64.powi(2));
    near(number("moments"), moment, 1e-12);
    near(number("torsion_constant"), 0.01 * 0.1_f64.powi(3) + 0.4 * 0.01_f64.powi(3) / 3.0, 1e-12);
    // The centroid lies half a side along n1 = y and n2 = z from the node.
    let line = made.deck.lines().find(|line| line.starts_with("offset_start")).unwrap();
    let arm: Vec<f64> = line.split(['[', ' ', ',', ']']).filter_map(|word| word.parse().ok()).collect();
    assert_eq!(arm[0], 0.0);
    arm[1..].iter().for_each(|x| near(*x, 0.05, 1e-12));
    let root = 3.0_f64.sqrt();
    let inner = 0.1 - 0.02 / root;
    let area = 1.5 * root * (0.01 - inner * inner);
    let made = imported(&edited(BEAM, &[("SECTION=RECT\n0.1, 0.2", "SECTION=HEX\n0.1, 0.01")]));
    let line = made.deck.lines().find(|line| line.starts_with("area")).unwrap();
    near(line.trim_start_matches("area = ").parse().unwrap(), area, 1e-12);
    let branched = "SECTION=ARBITRARY\n3, 0., 0., 0.1, 0., 0.01\n0.1, 0.1, 0.01\n0.1, 0., 0.01";
    refuses(BEAM, &[("SECTION=RECT\n0.1, 0.2", branched)], "form one line");
    refuses(BEAM, &[("SECTION=RECT\n0.1, 0.2", "SECTION=HEX\n0.1, 0.1")], "thicker than its radius");
}

const BARS: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 3., 0., 0.\n4, 4., 0., 0.\n*ELEMENT, TYPE=T3D2, ELSET=bars\n1, 1, 2\n2, 3, 4\n\
                    *MATERIAL, NAME=m\n*ELASTIC\n1e9\n*SOLID SECTION, ELSET=bars, MATERIAL=m\n0.01\n*BOUNDARY\n1, 1, 3\n3, 1, 3\n4, 2, 3\n2, 3\n\
                    *STEP\n*STATIC\n1., 1.\n*CLOAD\n4, 1, 5.\n*END STEP\n";

/// A bar on a roller at 30 degrees, pushed along the roller by F: along x it takes F over the cosine.
#[test]
fn a_roller_along_its_own_axes() {
    let (sine, cosine) = (0.5_f64, 0.75_f64.sqrt());
    let axes =
        format!("*NSET, NSET=roller\n2\n*TRANSFORM, NSET=roller\n{cosine}, {sine}, 0., {}, {cosine}, 0.\n", -sine);
    let text = edited(BARS, &[("*STEP", &format!("{axes}*BOUNDARY\n2, 2\n*STEP")), ("4, 1, 5.", "2, 1, 5.")]);
    let moved = moves(&text, "mesh.2").0;
    near(moved[0], 5.0 / cosine / 1e7, 1e-9);
    near(moved[1], moved[0] * sine / cosine, 1e-9);
    // About an axis along z through (1, −1, 0) node 2 has its radius along y: held, it moves along x alone.
    let turned =
        "*NSET, NSET=roller\n2\n*TRANSFORM, NSET=roller, TYPE=C\n1., -1., 0., 1., -1., 1.\n*BOUNDARY\n2, 1\n*STEP";
    let moved = moves(&edited(BARS, &[("*STEP", turned), ("4, 1, 5.", "2, 2, -5.")]), "mesh.2").0;
    near(moved[0], 5.0 / 1e7, 1e-9);
}

/// Two bars of stiffness k whose ends move as 1 to 2: the first moves by 2 F/(k + 4 k).
#[test]
fn an_equation_of_two_bars() {
    let text = edited(BARS, &[("*STEP", "*EQUATION\n2\n2, 1, 2., 4, 1, -1.\n*BOUNDARY\n2, 2\n*STEP")]);
    near(moves(&text, "mesh.2").0[0], 2.0 * 5.0 / 5e7, 1e-9);
    near(moves(&text, "mesh.4").0[0], 4.0 * 5.0 / 5e7, 1e-9);
    // A term of a node without elements that is at rest is nothing; one that is free is refused.
    let ground = "*NODE\n9, 0., 9., 0.\n*EQUATION\n3\n2, 1, 2., 4, 1, -1., 9, 1, 1.\n*BOUNDARY\n2, 2\n9, 1, 3\n*STEP";
    near(moves(&edited(BARS, &[("*STEP", ground)]), "mesh.4").0[0], 4.0 * 5.0 / 5e7, 1e-9);
    refuses(BARS, &[("*STEP", &ground.replace("9, 1, 3\n", ""))], "node 9 of this equation has no element");
}

/// A node in the middle of two others has half of the displacement of each.
#[test]
fn points_between_others() {
    let plate = |mpc: &str| {
        let nodes = "*NODE\n5, 0.5, 0., 0.\n6, 0.5, 0., 1.\n*ELEMENT, TYPE=B31, ELSET=mast\n2, 5, 6\n*BEAM SECTION, ELSET=mast, MATERIAL=m, SECTION=RECT\n\
                     0.1, 0.1\n1., 0., 0.\n";
        edited(SHELL, &[("*MATERIAL", &format!("{nodes}*MATERIAL")), ("*STEP, NLGEOM", &format!("*MPC\n{mpc}\n*STEP"))])
    };
    let half = "terms = [{ node = \"mesh.1\", dof = \"rx\", factor = -0.5 }, { node = \"mesh.2\", dof = \"rx\", factor = -0.5 }, \
                { node = \"mesh.5\", dof = \"rx\", factor = 1.0 }]\n";
    has(&plate("LINEAR, 5, 1, 2"), &[], None, half);
    let line = "terms = [{ node = \"mesh.1\", dof = \"uz\", factor = -0.5 }, { node = \"mesh.2\", dof = \"uz\", factor = -0.5 }, \
                { node = \"mesh.5\", dof = \"uz\", factor = 1.0 }]\n";
    let made = imported(&plate("STRAIGHT, 1, 2, 5"));
    assert!(made.deck.contains(&line[..line.len() - 1]), "{}", made.deck);
    assert_eq!(made.deck.matches("[[equations]]").count(), 2);
    let plane = imported(&plate("PLANE, 1, 2, 3, 5"));
    assert!(plane.deck.contains(&line[..line.len() - 1]), "{}", plane.deck);
    let finite = plate("PLANE, 1, 2, 3, 5").replace("*STEP\n", "*STEP, NLGEOM\n");
    assert!(refusals(&imported(&finite))[0].contains("other steps than linear statics"));
}

/// Four nodes at the corners of a square: a force at its middle is a quarter each, a moment M about its normal M/(4 r) along the circle.
#[test]
fn forces_that_are_distributed() {
    let coupled = |load: &str| {
        let set = "*NODE\n9, 0.5, 0.5, 0.\n*NSET, NSET=all, GENERATE\n1, 4\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=all\n*DISTRIBUTING\n\
                   *STEP";
        edited(SHELL, &[("*STEP, NLGEOM", set), ("3, 3, 5.", load)])
    };
    has(
        &coupled("9, 3, 8."),
        &[],
        None,
        "[[loads]]\nat = [\"mesh.1\", \"mesh.2\", \"mesh.3\", \"mesh.4\"]\nforce = [0.0, 0.0, 2.0]\n",
    );
    let made = imported(&coupled("9, 6, 8."));
    assert_eq!(refusals(&made), [""; 0]);
    // M/(4 r) with r = √½, along (1, −1)/√2 at the corner (0, 0): components of 2.
    assert!(made.deck.contains("at = \"mesh.1\"\nforce = [2.0, -2.0, 0.0]\n"), "{}", made.deck);
    let held = coupled("9, 3, 8.").replace("*STEP\n", "*BOUNDARY\n9, 3\n*STEP\n");
    assert!(refusals(&imported(&held))[0].contains("holds a mean motion"));
}

/// A number that no node of an instance has is none of the next instance.
#[test]
fn numbers_beyond_an_instance() {
    let text = "*PART, NAME=p\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n*NSET, NSET=ends\n1, 11\n*END PART\n\
                *ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n*END INSTANCE\n*INSTANCE, NAME=j, PART=p\n0., 1., 0.\n*END INSTANCE\n*END ASSEMBLY\n";
    let made = imported(&format!("{text}*STEP\n*STATIC\n*BOUNDARY\ni.ends, 1, 6\n*END STEP\n"));
    let held = made.deck.lines().skip_while(|line| *line != "[[supports]]").find(|line| line.starts_with("at"));
    // Without a section no node is used, and none held; node 11 would be node 1 of the second instance.
    assert_eq!(held, None, "{}", made.deck);
    let with = format!(
        "{text}*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*BEAM SECTION, ELSET=i.rod, MATERIAL=m, SECTION=RECT\n0.1, 0.1\n"
    );
    let with = format!(
        "{with}*BEAM SECTION, ELSET=j.rod, MATERIAL=m, SECTION=RECT\n0.1, 0.1\n*STEP\n*STATIC\n*BOUNDARY\ni.ends, 1, 6\n*END STEP\n"
    );
    let made = imported(&with);
    assert!(made.mesh.contains("*NSET, NSET=i.ends\n1\n"), "{}", made.mesh);
    let lost = imported(&with.replace("\n1, 1, 2\n", "\n1, 1, 12\n"));
    assert!(refusals(&lost)[0].contains("element 1 has node 12, which does not exist"), "{:?}", refusals(&lost));
}

/// Thickness that varies over nodes goes with the nodes.
#[test]
fn thickness_of_nodes() {
    let nodal = [
        ("MATERIAL=m\n0.01", "MATERIAL=m, NODAL THICKNESS\n0.01"),
        ("*STEP", "*NODAL THICKNESS\n1, 0.03\n2, 0.03\n3, 0.01\n4, 0.01\n*STEP"),
    ];
    let thick = "thickness = 0.02\nmaterial = \"m\"\nnodal_thickness = { \"mesh.1\" = 0.03, \"mesh.2\" = 0.03, \"mesh.3\" = 0.01, \"mesh.4\" = 0.01 }\n";
    has(SHELL, &nodal, None, thick);
    refuses(SHELL, &[nodal[0], ("*STEP", "*NODAL THICKNESS\n1, 0.03\n2, 0.04\n*STEP")], "have no thickness");
    let made = imported(&edited(SHELL, &nodal[1..]));
    assert!(reasons(&made, KeywordVerdict::Ignored)[0].contains("no section asks for it"), "{}", made.deck);
}

/// The change from the temperature at the start strains a part, with gradients along its axes.
#[test]
fn temperatures_of_parts() {
    let heated = [
        ("*DENSITY", "*EXPANSION\n1.2e-5\n*DENSITY"),
        ("*STEP", "*NSET, NSET=all\n1, 2\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nall, 20.\n*STEP"),
        ("*CLOAD", "*TEMPERATURE\nall, 60., 5., 7.\n*CLOAD"),
    ];
    let made = imported(&edited(BEAM, &heated));
    assert_eq!(refusals(&made), [""; 0]);
    let wanted = "part = \"rod\"\ntemperature = 40.0\ntemperature_gradient = [7.0, 5.0]\n";
    assert!(made.deck.contains(wanted) && made.deck.contains("expansion = 1.2e-5\n"), "{}", made.deck);
    let cold = imported(&edited(BEAM, &heated[..2]));
    assert!(!cold.deck.contains("expansion"), "{}", cold.deck);
    assert!(reasons(&cold, KeywordVerdict::Ignored).iter().any(|said| said.contains("no temperature changes")));
    let made = imported(&edited(BEAM, &[heated[0], heated[1], ("*CLOAD", "*TEMPERATURE\n1, 60.\n2, 35.\n*CLOAD")]));
    assert_eq!(refusals(&made), [""; 0]);
    let wanted = "part = \"rod\"\nnodal_temperature = { \"mesh.1\" = 40.0, \"mesh.2\" = 15.0 }\n";
    assert!(made.deck.contains(wanted), "{}", made.deck);
    let bent = ("*CLOAD", "*TEMPERATURE\n1, 60., 5.\n2, 35.\n*CLOAD");
    refuses(BEAM, &[heated[0], bent], "gradients of temperature do not go with temperatures that differ");
    let kind = ("*DENSITY", "*EXPANSION, TYPE=ORTHO\n1e-5, 2e-5, 3e-5\n*DENSITY");
    refuses(BEAM, &[kind, heated[2]], "isotropic expansion alone");
}

/// Two strips side by side in one part, two elements beside three; the second is tied to the first.
fn strips(surfaces: &str, tie: &str) -> String {
    format!(
        "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n11, 1., 0., 0.\n12, 2., 0., 0.\n13, 2., 1., 0.\n\
         14, 1., 1., 0.\n15, 1., 0.5, 0.\n16, 2., 0.5, 0.\n*ELEMENT, TYPE=S4, ELSET=ALL\n1, 1, 2, 3, 4\n2, 11, 12, 16, 15\n\
         3, 15, 16, 13, 14\n*ELSET, ELSET=FIRST\n1\n*ELSET, ELSET=SECOND\n2, 3\n*NSET, NSET=ROOT\n1, 4\n*NSET, NSET=SEAM\n11, 14, 15\n*NSET, NSET=TIP\n12, 13, 16\n\
         {surfaces}*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SHELL SECTION, ELSET=ALL, MATERIAL=M\n0.1\n{tie}\n*BOUNDARY\nROOT, 1, 6\n\
         *STEP\n*STATIC\n*BOUNDARY\nTIP, 1, 1, 0.2\nTIP, 2, 6\n*END STEP\n"
    )
}

/// Pulled by 0.2 over a length of 2, both strips strain evenly: the seam goes half the way.
#[test]
fn ties_of_surfaces() {
    let first = "*SURFACE, NAME=S1\nFIRST, SPOS\n";
    let seams = [
        "*SURFACE, NAME=S2\n2, E4\n3, E4\n",
        "*SURFACE, NAME=S2\n2, S6\n3, S6\n",
        "*SURFACE, NAME=S2, TYPE=NODE\nSEAM\n",
        "*SURFACE, NAME=S2\nSECOND, SNEG\n",
    ];
    for seam in seams {
        let text = strips(&format!("{first}{seam}"), "*TIE, NAME=join, POSITION TOLERANCE=0.01\nS2, S1");
        let made = imported(&text);
        assert_eq!(refusals(&made), [""; 0], "{seam}");
        assert!(made.deck.contains(
            "[[ties]]\nname = \"join\"\nnodes = [\"mesh.11\", \"mesh.14\", \"mesh.15\"]\nto = \"join_faces\"\n"
        ));
        let is_changed = reasons(&made, KeywordVerdict::Changed).iter().any(|how| how.contains("stay free: 3"));
        assert_eq!(is_changed, seam.contains("SNEG"), "{seam}");
        for node in ["mesh.2", "mesh.11", "mesh.15"] {
            near(moves(&text, node).0[0], 0.1, 1e-9);
        }
    }
    // A seam beside the faces: both programs move tied nodes onto them, unless ADJUST=NO tells otherwise.
    for (adjust, wanted) in [("", true), (", ADJUST=YES", true), (", ADJUST=NO", false)] {
        let text = strips(&format!("{first}{}", seams[0]), &format!("*TIE, NAME=join{adjust}\nS2, S1"));
        let made = imported(&text.replace("11, 1., 0., 0.", "11, 1., 0., 0.02"));
        let is_told =
            reasons(&made, KeywordVerdict::Changed).iter().any(|how| how.contains("2.000e-2 beside the faces"));
        assert_eq!(is_told, wanted, "{adjust}");
    }
    let with = |seam: &str, tie: &str| strips(&format!("{first}{seam}"), tie);
    let hinged = imported(&with(seams[0], "*TIE, NAME=join, NO ROTATION\nS2, S1"));
    assert!(hinged.deck.contains("dofs = \"translations\"\n"), "{}", hinged.deck);
    for (seam, tie, why) in [
        ("*SURFACE, NAME=S2, TYPE=NODE\n12\n", "*TIE, NAME=join\nS2, S1", "no node of `S2` lies within"),
        (seams[0], "*TIE, NAME=join\nS2, S9", "no surface is named `S9`"),
        (seams[0], "*TIE, NAME=join\nS1, S2\n*TIE, NAME=more\nS2, S1", ""),
        (seams[2], "*TIE, NAME=join\nS1, S2", "holds no elements of shells"),
        (seams[0], "*TIE, NAME=a\nS2, S1\n*TIE, NAME=b\nS2, S1", "each is tied once"),
        (seams[0], "*TIE, NAME=a, POSITION TOLERANCE=x\nS2, S1", "POSITION TOLERANCE must be a number"),
        (seams[0], "*TIE, NAME=a, CYCLIC SYMMETRY\nS2, S1", "no cyclic symmetry"),
    ] {
        let told = refusals(&imported(&with(seam, tie)));
        match why.is_empty() {
            true => assert_eq!(told, [""; 0], "{tie}"),
            false => assert!(told.iter().any(|told| told.contains(why)), "{tie}: {told:?}"),
        }
    }
}

/// A pendulum in a plane whose links an equation joins: reactions are written for its supports, none of which lies across the plane.
#[test]
fn reactions_of_a_plane_with_equations() {
    let text = "*NODE, NSET=ALL\n1, 0., 0., 0.\n2, 0., 0., -1.\n3, 0., 0., -1.\n4, 0., 0., -2.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n2, 3, 4\n\
                *BEAM SECTION, MATERIAL=m, ELSET=rod, SECTION=RECT\n0.1, 0.1\n0., 1., 0.\n*MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.3\n\
                *DENSITY\n7800.\n*EQUATION\n2\n2, 1, -1., 3, 1, 1.\n2\n2, 3, -1., 3, 3, 1.\n*BOUNDARY\nALL, 2, 2\nALL, 4, 4\nALL, 6, 6\n1, 1, 3\n\
                *STEP, NLGEOM\n*DYNAMIC\n0.001, 0.01\n*DLOAD\nrod, GRAV, 9.81, 1., 0., 0.\n*NODE PRINT, NSET=ALL\nU, RF\n*END STEP\n";
    let folder = super::command::folder(&[("a.inp", text)]);
    let (code, said, problems) = super::command::rdsolve(folder.path(), &["a.inp"]);
    assert_eq!(code, 0, "{said}{problems}");
    let reactions = std::fs::read_to_string(folder.path().join("a.out/reactions.csv")).unwrap();
    assert!(reactions.contains(",mesh.1,ux,"), "{reactions}");
}
