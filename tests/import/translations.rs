//! Files that once lost or moved something on their way into a deck.

use super::{imported, imported_from, refusals, tables};
use import::Dialect;
use rdsolve::diagnostic::Source;
use rdsolve::model;

/// A cantilever of two beams, without supports and steps.
const HEAD: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n2, 2, 3\n\
                    *MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n\
                    0.1, 0.2\n0., 1., 0.\n";
const ROOT: &str = "*BOUNDARY\n1, 1, 6\n";
const MODES: &str = "*STEP\n*FREQUENCY\n4\n*END STEP\n";

/// A step of statics with some lines.
fn load_step(lines: &str) -> String {
    format!("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n{lines}\n*END STEP\n")
}

/// The deck without comments; it is one that the program takes.
fn taken(text: &str) -> String {
    let made = imported_from(text, Some(Dialect::Abaqus));
    assert_eq!(refusals(&made), [""; 0], "{text}");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.mesh.inp"), &made.mesh).unwrap();
    let source = Source::new(folder.path().join("a.toml").display().to_string(), made.deck.as_str(), &[]);
    let (model, said) = model::read(&source);
    assert!(model.is_some(), "{}\n{}", said[0].draw(&source, false), made.deck);
    tables(&made.deck)
}

/// The deck has this text.
fn has(text: &str, wanted: &str) {
    let deck = taken(text);
    assert!(deck.contains(wanted), "{wanted} is not in\n{deck}");
}

/// A reason for which it is refused.
fn refuses(text: &str, wanted: &str) {
    let said = refusals(&imported(text));
    assert!(said.iter().any(|said| said.contains(wanted)), "{wanted} is not in {said:?}");
}

#[test]
fn masses_at_nodes_of_couplings() {
    let mass = "*NODE\n9, 2., 0., 1.\n*ELEMENT, TYPE=MASS, ELSET=w\n7, 9\n*MASS, ELSET=w\n3.\n";
    let coupling = "*SURFACE, TYPE=NODE, NAME=s\n3\n*COUPLING, REF NODE=9, SURFACE=s, CONSTRAINT NAME=c\n*KINEMATIC\n";
    let wanted = "[[masses]]\nat = \"mesh.9\"\nmass = 3.0\n";
    has(&format!("{HEAD}{mass}{coupling}{ROOT}{MODES}"), wanted);
    // A rigid body has its masses itself.
    let body = "*RIGID BODY, TIE NSET=t, REF NODE=9\n";
    let deck = taken(&format!("{HEAD}{mass}*NSET, NSET=t\n3\n{body}{ROOT}{MODES}"));
    assert!(deck.contains("mass = 3.0\ninertia") && !deck.contains("[[masses]]"), "{deck}");
}

#[test]
fn surfaces_of_parts() {
    let part = HEAD.replace("B31", "S4").replace("1, 1, 2\n2, 2, 3\n", "1, 1, 2, 3, 4\n");
    let part = part.replace("3, 2., 0., 0.", "3, 1., 1., 0.\n4, 0., 1., 0.");
    let part = part.replace(
        "*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n",
        "*SHELL SECTION, ELSET=rod, MATERIAL=m\n0.01\n",
    );
    let (part, material) = (
        part.replace("*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n", ""),
        "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n",
    );
    let text = format!(
        "*PART, NAME=P\n{part}*SURFACE, NAME=top\nrod, SPOS\n*END PART\n*ASSEMBLY, NAME=X\n*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n\
         *INSTANCE, NAME=B, PART=P\n0., 0., 5.\n*END INSTANCE\n*END ASSEMBLY\n{material}*BOUNDARY\nA.1, 1, 6\nB.1, 1, 6\n{}",
        load_step("*DSLOAD\nA.top, P, 7.")
    );
    let deck = taken(&text);
    assert_eq!(deck.matches("pressure = 7.0").count(), 1, "{deck}");
}

#[test]
fn gravity_beside_masses() {
    let mass = "*ELEMENT, TYPE=MASS, ELSET=w\n7, 3\n*MASS, ELSET=w\n3.\n";
    let gravity =
        |set: &str| format!("{HEAD}{mass}{ROOT}{}", load_step(&format!("*DLOAD\n{set}, GRAV, 9.81, 0., 0., -1.")));
    refuses(&gravity("rod"), "does not hold all that has mass");
    has(&gravity(""), "gravity = [0.0, 0.0, -9.81]\n");
    // Two sets that hold all that has mass, and no element twice.
    has(&gravity("rod, GRAV, 9.81, 0., 0., -1.\nw"), "gravity = [0.0, 0.0, -9.81]\n");
    refuses(&gravity("rod, GRAV, 9.81, 0., 0., -1.\nrod"), "does not hold all that has mass");
    refuses(&gravity("rod, GRAV, 9., 0., 0., -1.\nw"), "does not hold all that has mass");
}

#[test]
fn connections_that_are_springs() {
    let text = |kind: &str, behavior: &str, step: &str| {
        format!(
            "{HEAD}*NODE\n9, 3., 0., 0.\n*ELEMENT, TYPE=CONN3D2, ELSET=c\n7, 3, 9\n*CONNECTOR SECTION, ELSET=c, BEHAVIOR=b\n{kind}\n\
             *CONNECTOR BEHAVIOR, NAME=b\n*CONNECTOR ELASTICITY, COMPONENT=1\n7.\n{behavior}*BOUNDARY\n1, 1, 6\n9, 1, 6\n{}",
            load_step(step)
        )
    };
    let stop = "*CONNECTOR STOP, COMPONENT=1\n-1., 1.\n";
    for kind in ["AXIAL", "CARTESIAN", "BUSHING"] {
        refuses(&text(kind, "", "*CONNECTOR LOAD\nc, 1, 3."), "loads and motions of a connection that is a spring");
        refuses(&text(kind, "", "*CONNECTOR MOTION\nc, 1, 3."), "loads and motions of a connection that is a spring");
        refuses(&text(kind, stop, "*CLOAD\n3, 1, 1."), "stops of springs");
        taken(&text(kind, "", "*CLOAD\n3, 1, 1."));
    }
    refuses(&text("AXIAL", "*CONNECTOR DAMPING, COMPONENT=2\n7.\n", ""), "AXIAL acts along component 1 alone");
    refuses(&text("AXIAL", "", "*CONNECTOR LOAD\nrod, 1, 3."), "`rod` is no connector with a section");
}

#[test]
fn springs_about_axes_turn() {
    let text = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*ELEMENT, TYPE=MASS, ELSET=w\n7, 2\n*MASS, ELSET=w\n3.\n*ELEMENT, TYPE=ROTARYI, ELSET=j\n\
                8, 2\n*ROTARY INERTIA, ELSET=j\n1., 1., 1.\n*ELEMENT, TYPE=SPRING2, ELSET=k\n9, 1, 2\n*SPRING, ELSET=k\n4, 4\n100.\n\
                *BOUNDARY\n1, 1, 6\n2, 1, 3\n2, 5, 6\n*STEP\n*FREQUENCY\n1\n*END STEP\n";
    has(text, "at = \"mesh.2\"\nfix = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n");
    // What no spring and no inertia resists stays held.
    let (first, rest) = text.split_once("*ELEMENT, TYPE=ROTARYI").unwrap();
    let rest = rest.split_once("1., 1., 1.\n").unwrap().1.replace("2, 5, 6\n", "");
    has(&format!("{first}{rest}"), "at = \"mesh.2\"\nfix = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n");
    refuses(&text.replace("1., 1., 1.", "1."), "about two axes or more");
}

#[test]
fn lines_of_commas() {
    let spring = |kind: &str, nodes: &str, lines: &str| {
        format!("{HEAD}*ELEMENT, TYPE={kind}, ELSET=k\n7, {nodes}\n*SPRING, ELSET=k\n{lines}\n{ROOT}{MODES}")
    };
    refuses(&spring("SPRING1", "3", ",\n100."), "needs its degree of freedom");
    has(&spring("SPRINGA", "1, 3", ",\n100."), "stiffness = 100.0\n");
    refuses(&spring("SPRINGA", "1, 3", ","), "*SPRING needs values on the line below");
    taken(&format!("{HEAD}*MPC\n,\n{ROOT}{MODES}"));
}

#[test]
fn spread_loads_named_again() {
    let two = |first: &str, second: &str| format!("{HEAD}{ROOT}{}{}", load_step(first), load_step(second));
    let deck = taken(&two("*DLOAD\nrod, PZ, 5.", "*DLOAD\nROD, PZ, 10."));
    assert_eq!(deck.matches("[[loads]]").count(), 1, "{deck}");
    refuses(&two("*DLOAD\nrod, PZ, 5.", "*DLOAD\n2, PZ, 10."), "name the same set in both");
    taken(&two("*DLOAD\nrod, PZ, 5.\n2, PZ, 1.", "*DLOAD\n2, PZ, 10."));
    taken(&two("*DLOAD\nrod, PZ, 5.", "*DLOAD, OP=NEW\n2, PZ, 10."));
}

#[test]
fn equations_and_couplings() {
    // An equation holds also where supports end.
    let equation = "*EQUATION\n1\n3, 3, 1.\n";
    let ends = "*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*BOUNDARY, OP=NEW\n1, 1, 6\n*CLOAD\n3, 2, 1.\n*END STEP\n";
    has(&format!("{HEAD}{equation}{ROOT}{ends}"), "at = \"mesh.3\"\nfix = [\"uz\"]\n");
    let coupling = |lines: &str| {
        format!(
            "{HEAD}*NODE\n9, 2., 0., 1.\n*KINEMATIC COUPLING, REF NODE=9\n{lines}\n{ROOT}{}",
            load_step("*CLOAD\n9, 3, 1.")
        )
    };
    refuses(&coupling("2, 1, 3\n3, 1, 6"), "give all sets the same");
    has(&coupling("3, 1, 1\n3, 2, 3"), "dofs = [\"ux\", \"uy\", \"uz\"]\n");
    has(&coupling("2\n3, 1, 6"), "nodes = [\"mesh.2\", \"mesh.3\", \"mesh.9\"]\n");
}

#[test]
fn rigid_bodies_of_beams() {
    let both = "*NODE\n9, 3., 0., 0.\n*ELEMENT, TYPE=B31, ELSET=stiff\n7, 3, 9\n*BEAM SECTION, ELSET=stiff, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n";
    let far = "*NODE\n8, 3., 0., 1.\n";
    for step in [load_step("*CLOAD\n9, 3, 1."), MODES.to_owned()] {
        for reference in [3, 8, 9] {
            let body = format!("*RIGID BODY, ELSET=stiff, REF NODE={reference}\n");
            has(
                &format!("{HEAD}{both}{far}{body}{ROOT}{step}"),
                "[[bodies]]\nname = \"stiff_body\"\nparts = \"stiff\"\n",
            );
        }
    }
    let twice = "*RIGID BODY, ELSET=stiff, REF NODE=8\n*RIGID BODY, ELSET=stiff, REF NODE=9\n";
    refuses(&format!("{HEAD}{both}{far}{twice}{ROOT}{MODES}"), "in another rigid body");
}

#[test]
fn sections_of_one_name() {
    let part = |name: &str, section: &str| {
        format!(
            "*PART, NAME={name}\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n{section}*END PART\n"
        )
    };
    let whole = |first: &str, second: &str| {
        format!(
            "{}{}*ASSEMBLY, NAME=X\n*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*INSTANCE, NAME=B, PART=Q\n0., 0., 5.\n*END INSTANCE\n*END ASSEMBLY\n\
             *MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n*BOUNDARY\nA.1, 1, 6\nB.1, 1, 6\n{MODES}",
            part("P", first),
            part("Q", second)
        )
    };
    let plain = |sizes: &str| format!("*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n{sizes}\n0., 1., 0.\n");
    let deck = taken(&whole(&plain("0.1, 0.2"), &plain("0.3, 0.4")));
    assert!(
        deck.contains("[sections.rod]\n") && deck.contains("[sections.rod_2]\nshape = \"rectangle\"\nwidth = 0.3\n"),
        "{deck}"
    );
    let general = |modulus: &str| {
        format!(
            "*BEAM GENERAL SECTION, ELSET=rod, SECTION=GENERAL, DENSITY=9.\n0.02, 3e-3, 0., 4e-3, 5e-3\n0., 1., 0.\n{modulus}, 1e9\n"
        )
    };
    let deck = taken(&whole(&general("2e9"), &general("2.5e9")));
    assert!(deck.contains("youngs_modulus = 2e9") && deck.contains("youngs_modulus = 2.5e9"), "{deck}");
}

#[test]
fn modes_alone_in_two_steps() {
    refuses(&format!("{HEAD}{ROOT}{MODES}{MODES}"), "modes in several steps need a step of statics before them");
}
