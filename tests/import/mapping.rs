//! The mapping: every keyword has a row here, with a file of some lines, and a snapshot of its verdict and of the deck that comes out.

use super::rows::{BEAM, SHELL, edited};
use super::values::model_of;
use super::{imported_from, refusals, tables};
use import::keywords::{KEYWORDS, Treatment};
use import::{Dialect, Imported};
use std::collections::BTreeSet;
use std::fmt::Write;

/// The step of [`BEAM`] from its procedure on.
const STEP: &str = "*STATIC\n0.5, 1.\n*CLOAD\n2, 3, 5.\n";
const SECTION: &str = "*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n";

/// A beam with further lines before its supports.
fn model(lines: &str) -> String {
    edited(BEAM, &[("*BOUNDARY", &format!("{lines}*BOUNDARY"))])
}

/// A beam with further lines in its material.
fn material(lines: &str) -> String {
    edited(BEAM, &[("*DENSITY", &format!("{lines}*DENSITY"))])
}

/// A beam with further lines in its step, before its load.
fn in_step(lines: &str) -> String {
    edited(BEAM, &[("*CLOAD", &format!("{lines}*CLOAD"))])
}

/// A beam with another procedure and other loads.
fn procedure(lines: &str) -> String {
    edited(BEAM, &[(STEP, lines)])
}

/// A beam and a node above its end that something joins to it and holds.
fn above(lines: &str) -> String {
    edited(&model(lines), &[("9, 0., 0., 1.", "9, 1., 0., 1."), ("1, 1, 6", "1, 1, 6\n9, 1, 6")])
}

/// Two coincident nodes and a second beam between them and a free end.
fn beside(lines: &str) -> String {
    edited(&model(lines), &[("9, 0., 0., 1.", "9, 1., 0., 0.\n8, 2., 0., 0."), ("\n1, 1, 2\n", "\n1, 1, 2\n2, 9, 8\n")])
}

/// A shell, with lines before its step, and other loads.
fn shell(lines: &str, loads: &str) -> String {
    edited(SHELL, &[("*STEP", &format!("{lines}*STEP")), ("*CLOAD\n3, 3, 5.\n", loads)])
}

/// A shell, and a second one above it, with lines before its step.
fn shells(lines: &str) -> String {
    let upper = "*NODE\n11, 0., 0., 0.1\n12, 1., 0., 0.1\n13, 1., 1., 0.1\n14, 0., 1., 0.1\n*ELEMENT, TYPE=S4, ELSET=lid\n2, 11, 12, 13, 14\n\
                 *SHELL SECTION, ELSET=lid, MATERIAL=m\n0.01\n*SURFACE, NAME=low\nskin, SPOS\n*SURFACE, NAME=high\nlid, SNEG\n";
    shell(&format!("{upper}{lines}"), "*CLOAD\n13, 3, -5.\n")
}

/// A connector of a hinge, with further lines before the supports and in the step.
fn hinge(behavior: &str, step: &str) -> String {
    let section = "*ELEMENT, TYPE=CONN3D2, ELSET=c\n7, 2, 9\n*ORIENTATION, NAME=o\n0., 1., 0., 0., 0., 1.\n\
                   *CONNECTOR SECTION, ELSET=c, BEHAVIOR=b\nHINGE\no\n*CONNECTOR BEHAVIOR, NAME=b\n";
    let text = above(&format!("{section}{behavior}"));
    edited(&text, &[("9, 1., 0., 1.", "9, 1., 0., 0."), ("*STATIC", "*DYNAMIC"), ("*CLOAD", &format!("{step}*CLOAD"))])
}

/// Keywords, and a file that has them.
fn rows() -> Vec<(&'static str, String)> {
    let coupling =
        "*SURFACE, TYPE=NODE, NAME=s\ntip\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=s\n*KINEMATIC\n1, 3\n";
    let loaded = |lines: &str| edited(&model(lines), &[("*CLOAD\n2,", "*CLOAD\n9,")]);
    let above_shell = "*NODE\n9, 0.5, 0.5, 1.\n*NSET, NSET=a\n1, 2, 3, 4\n";
    let spread = |lines: &str| shell(&format!("{above_shell}{lines}"), "*CLOAD\n9, 3, 5.\n");
    let part = edited(
        BEAM,
        &[
            ("*NODE", "*PART, NAME=P\n*NODE"),
            ("*NSET", &format!("{SECTION}*NSET")),
            (
                "*MATERIAL",
                "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0., 0., 2.\n*END INSTANCE\n*END ASSEMBLY\n*MATERIAL",
            ),
            (&format!("7.\n{SECTION}"), "7.\n"),
            ("*BOUNDARY\n1", "*BOUNDARY\nI.1"),
            ("*CLOAD\n2", "*CLOAD\nI.tip"),
        ],
    );
    let general = "*BEAM GENERAL SECTION, ELSET=rod, SECTION=GENERAL, DENSITY=9.\n0.02, 3e-3, 1e-3, 4e-3, 5e-3\n0., 1., 0.\n2e9, 1e9\n";
    let truss = [("TYPE=B31", "TYPE=T3D2"), (SECTION, "*SOLID SECTION, ELSET=rod, MATERIAL=m\n0.02\n")];
    let modes = "*FREQUENCY\n4\n*END STEP\n*STEP\n";
    let contact = "*SURFACE INTERACTION, NAME=i\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n*FRICTION\n0.2\n*CONTACT PAIR, INTERACTION=i\n\
                   high, low\n";
    let spring = "*ELEMENT, TYPE=SPRINGA, ELSET=k\n7, 2, 9\n*SPRING, ELSET=k\n\n3.\n";
    let change = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*MODEL CHANGE, REMOVE\nk\n*CLOAD";
    vec![
        (
            "NODE; ELEMENT; NSET; MATERIAL; ELASTIC; DENSITY; BEAM SECTION; BOUNDARY; STEP; STATIC; CLOAD; END STEP",
            BEAM.to_owned(),
        ),
        ("HEADING", model("*HEADING\nA rod\n")),
        ("PART; END PART; ASSEMBLY; END ASSEMBLY; INSTANCE; END INSTANCE", part),
        (
            "NGEN; ELGEN",
            model(
                "*NODE\n14, 4., 0., 0.\n*NGEN\n2, 14, 4\n*ELEMENT, TYPE=B31, ELSET=rod\n2, 2, 6\n*ELGEN, ELSET=rod\n2, 3, 4\n",
            ),
        ),
        (
            "NFILL",
            model("*NSET, NSET=a\n1\n*NSET, NSET=b\n9\n*NFILL\na, b, 2, 4\n*ELEMENT, TYPE=B31, ELSET=rod\n2, 2, 5\n"),
        ),
        (
            "NCOPY; ELCOPY",
            model(
                "*NSET, NSET=n\n1, 2\n*NCOPY, OLD SET=n, NEW SET=f, CHANGE NUMBER=10, SHIFT\n1., 0., 0.\n0., 0., 0., 0., 0., 1., 0.\n\
                   *ELCOPY, OLD SET=rod, NEW SET=r, ELEMENT SHIFT=10, SHIFT NODES=10\n*ELSET, ELSET=rod\nr\n",
            ),
        ),
        ("BEAM GENERAL SECTION", edited(BEAM, &[(SECTION, general)])),
        (
            "USER ELEMENT",
            edited(
                &model("*USER ELEMENT, TYPE=U1, NODES=2, INTEGRATION POINTS=2, MAXDOF=6\n"),
                &[("TYPE=B31", "TYPE=U1")],
            ),
        ),
        ("SOLID SECTION; NO COMPRESSION", edited(&material("*NO COMPRESSION\n"), &truss)),
        (
            "SHELL SECTION; ELSET; SURFACE; DSLOAD",
            shell("*ELSET, ELSET=e\n1\n*SURFACE, NAME=s\ne, SNEG\n", "*DSLOAD\ns, P, 5.\n"),
        ),
        ("SHELL GENERAL SECTION", edited(SHELL, &[("*SHELL SECTION", "*SHELL GENERAL SECTION")])),
        (
            "NODAL THICKNESS",
            edited(
                &shell("*NODAL THICKNESS\n1, 0.03\n2, 0.03\n3, 0.04\n4, 0.04\n", ""),
                &[("MATERIAL=m\n", "MATERIAL=m, NODAL THICKNESS\n")],
            ),
        ),
        (
            "ORIENTATION",
            edited(
                &shell("*ORIENTATION, NAME=o\n0., 1., 0., -1., 0., 0.\n", ""),
                &[("MATERIAL=m\n", "MATERIAL=m, ORIENTATION=o\n")],
            ),
        ),
        (
            "TRANSFORM",
            edited(&model("*TRANSFORM, NSET=tip\n1., 1., 0., -1., 1., 0.\n"), &[("1, 1, 6", "1, 1, 6\ntip, 2")]),
        ),
        (
            "PLASTIC; RATE DEPENDENT",
            material("*PLASTIC\n200., 0.\n300., 0.1\n*RATE DEPENDENT, TYPE=POWER LAW\n40., 5.\n"),
        ),
        ("DAMPING", material("*DAMPING, ALPHA=0.1, BETA=0.2\n")),
        (
            "EXPANSION; TEMPERATURE",
            edited(&material("*EXPANSION\n1e-5\n"), &[("*CLOAD", "*TEMPERATURE\n1, 30.\n2, 50.\n*CLOAD")]),
        ),
        (
            "MASS; ROTARY INERTIA",
            model(
                "*ELEMENT, TYPE=MASS, ELSET=w\n5, 2\n*MASS, ELSET=w\n3.\n*ELEMENT, TYPE=ROTARYI, ELSET=j\n6, 2\n*ROTARY INERTIA, ELSET=j\n1., 2., 2.\n",
            ),
        ),
        ("SPRING", above(spring)),
        ("DASHPOT", above("*ELEMENT, TYPE=DASHPOTA, ELSET=k\n7, 2, 9\n*DASHPOT, ELSET=k\n\n3.\n")),
        ("JOINT", above("*ELEMENT, TYPE=JOINTC, ELSET=k\n7, 2, 9\n*JOINT, ELSET=k\n*SPRING\n1\n200.\n")),
        ("GAP", above("*ELEMENT, TYPE=GAPUNI, ELSET=k\n7, 2, 9\n*GAP, ELSET=k\n0.1, 0., 0., 1.\n")),
        ("RIGID BODY", loaded("*RIGID BODY, NSET=tip, REF NODE=9\n")),
        ("COUPLING; KINEMATIC", loaded(coupling)),
        (
            "COUPLING; DISTRIBUTING",
            spread(
                "*SURFACE, TYPE=NODE, NAME=s\na\n*COUPLING, CONSTRAINT NAME=c, REF NODE=9, SURFACE=s\n*DISTRIBUTING\n",
            ),
        ),
        ("KINEMATIC COUPLING", loaded("*KINEMATIC COUPLING, REF NODE=9\ntip, 1, 3\n")),
        (
            "DISTRIBUTING COUPLING",
            spread("*ELEMENT, TYPE=DCOUP3D, ELSET=d\n7, 9\n*DISTRIBUTING COUPLING, ELSET=d\na, 1.\n"),
        ),
        ("MPC", beside("*MPC\nPIN, 9, 2\n")),
        ("EQUATION", model("*EQUATION\n2\n2, 2, 1., 2, 3, -2.\n")),
        (
            "PRE-TENSION SECTION",
            edited(
                &model("*NODE\n8, 0., 0., 5.\n*PRE-TENSION SECTION, ELEMENT=1, NODE=8\n"),
                &[("2, 3, 5.", "8, 1, 5.")],
            ),
        ),
        ("TIE", shells("*TIE, NAME=t, POSITION TOLERANCE=0.2\nhigh, low\n")),
        ("CONTACT PAIR; SURFACE INTERACTION; SURFACE BEHAVIOR; FRICTION", shells(contact)),
        ("MODEL CHANGE", edited(&above(spring), &[("*CLOAD", change)])),
        (
            "CONNECTOR SECTION; CONNECTOR BEHAVIOR; CONNECTOR ELASTICITY; CONNECTOR DAMPING; CONNECTOR STOP",
            hinge(
                "*CONNECTOR ELASTICITY, COMPONENT=4\n7.\n*CONNECTOR DAMPING, COMPONENT=4\n8.\n*CONNECTOR STOP, COMPONENT=4\n-1., 1.\n",
                "",
            ),
        ),
        ("CONNECTOR MOTION", hinge("", "*CONNECTOR MOTION, TYPE=VELOCITY\nc, 4, 3.\n")),
        ("CONNECTOR LOAD", hinge("", "*CONNECTOR LOAD\nc, 4, 3.\n")),
        ("AMPLITUDE", edited(&model("*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n"), &[("*CLOAD", "*CLOAD, AMPLITUDE=A")])),
        (
            "INITIAL CONDITIONS",
            model("*INITIAL CONDITIONS, TYPE=VELOCITY\ntip, 3, -2.\n").replace("*STATIC", "*DYNAMIC"),
        ),
        ("DYNAMIC", procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n")),
        ("FIXED MASS SCALING", procedure("*DYNAMIC, EXPLICIT\n, 0.1\n*FIXED MASS SCALING, TYPE=BELOW MIN, DT=2e-6\n")),
        ("FREQUENCY", procedure("*FREQUENCY\n4\n")),
        ("COMPLEX FREQUENCY", procedure("*COMPLEX FREQUENCY\n4\n")),
        ("BUCKLE", procedure("*BUCKLE\n2\n*CLOAD\n2, 1, -5.\n")),
        (
            "MODAL DYNAMIC; MODAL DAMPING; BASE MOTION",
            procedure(&format!(
                "{modes}*MODAL DYNAMIC\n0.01, 0.1\n*MODAL DAMPING, RAYLEIGH\n1, 4, 0.1, 0.2\n*BASE MOTION, DOF=1, AMPLITUDE=A\n"
            )) + "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n",
        ),
        (
            "STEADY STATE DYNAMICS",
            procedure(&format!("{modes}*STEADY STATE DYNAMICS\n1., 100., 10\n*CLOAD\n2, 3, 5.\n")),
        ),
        ("DLOAD", in_step("*DLOAD\nrod, PZ, 5.\n")),
        ("NODE PRINT; EL PRINT", in_step("*NODE PRINT, NSET=tip\nU, RF\n*EL PRINT\nS\n")),
        ("NODE FILE; EL FILE", in_step("*NODE FILE\nU\n*EL FILE\nS\n")),
        ("OUTPUT; NODE OUTPUT; ELEMENT OUTPUT", in_step("*OUTPUT, FIELD\n*NODE OUTPUT\nU\n*ELEMENT OUTPUT\nSF\n")),
    ]
}

/// Verdicts on keywords of a file, and the lines of its deck and mesh that the plain file has not.
fn outcome(keywords: &[&str], made: &Imported, plain: &Imported) -> String {
    let mut out = String::new();
    for row in made.verdicts.rows.iter().filter(|row| keywords.contains(&row.keyword.trim_start_matches('*'))) {
        let _ = writeln!(out, "{} {}: {}", row.keyword, row.verdict.word(), row.text);
    }
    for (new, old) in [(tables(&made.deck), tables(&plain.deck)), (made.mesh.clone(), plain.mesh.clone())] {
        let old: BTreeSet<&str> = old.lines().collect();
        for line in new.lines().filter(|line| !old.contains(line)) {
            let _ = writeln!(out, "    {line}");
        }
    }
    out + "\n"
}

#[test]
fn every_keyword_has_its_row() {
    let nothing = imported_from("", None);
    let mut done = BTreeSet::new();
    let (mut table, mut refused) = (String::new(), Vec::new());
    for (words, text) in rows() {
        let words: Vec<&str> = words.split("; ").collect();
        let made = imported_from(&text, Some(Dialect::Abaqus));
        let said = refusals(&made);
        if !said.is_empty() {
            refused.push(format!("{words:?}: {said:?}"));
            continue;
        }
        model_of(&made);
        let base = if text.contains("TYPE=S4") { SHELL } else { BEAM };
        let plain = if text == base { &nothing } else { &imported_from(base, None) };
        table += &outcome(&words, &made, plain);
        for word in words {
            let is_told = made.verdicts.rows.iter().any(|row| row.keyword.strip_prefix('*') == Some(word));
            assert!(is_told, "*{word} is not in the report of its row");
            done.insert(word);
        }
    }
    assert_eq!(refused, [""; 0]);
    let plain = imported_from(BEAM, None);
    for row in KEYWORDS {
        let text = format!("{BEAM}*{}\n1, 2, 3\n", row.word);
        match row.treatment {
            Treatment::Read(_) => assert!(done.contains(row.word), "*{} has no row", row.word),
            _ => table += outcome(&[row.word], &imported_from(&text, None), &plain).trim_end_matches('\n'),
        }
        table += if done.contains(row.word) { "" } else { "\n" };
    }
    insta::assert_snapshot!("mapping", table);
}
