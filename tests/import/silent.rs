//! What once changed or vanished without a word: it is translated, or refused with its reason.

use super::rows::{BEAM, SHELL, edited, has, refuses};
use super::{imported, imported_from, reasons, refusals, tables};
use import::{Dialect, KeywordVerdict};

/// A further static step with these lines.
fn step(lines: &str) -> String {
    format!("*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 1.\n{lines}*END STEP\n")
}

/// OP=NEW ends what earlier steps gave; blocks of one step add up.
#[test]
fn new_entries_of_one_step_add_up() {
    has(BEAM, &[("*CLOAD\n2, 3, 5.", "*CLOAD, OP=NEW\n2, 3, 5.\n*CLOAD, OP=NEW\n2, 2, 7.")], None, "[0.0, 7.0, 5.0]\n");
    let spread = "*DLOAD, OP=NEW\nrod, PZ, 5.\n*DLOAD, OP=NEW\nrod, PY, 7.";
    let made = imported(&edited(BEAM, &[("*CLOAD\n2, 3, 5.", spread)]));
    assert!(made.deck.contains("[0.0, 0.0, 5.0]") && made.deck.contains("[0.0, 7.0, 0.0]"), "{}", made.deck);
    let held = "*BOUNDARY, OP=NEW\n1, 1, 3\n*BOUNDARY, OP=NEW\n1, 4, 6\n*CLOAD";
    has(BEAM, &[("*CLOAD", held)], None, "at = \"mesh.1\"\nfix = \"all\"\n");
    let second = step("*CLOAD, OP=NEW\n2, 2, 7.\n*CLOAD, OP=NEW\n2, 1, 1.\n");
    has(BEAM, &[("*END STEP\n", &second)], None, "points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]\n");
}

/// Output keywords are known to both programs.
#[test]
fn keywords_of_both_programs_are_no_signs() {
    for output in ["NODE PRINT", "EL PRINT", "NODE FILE", "EL FILE", "CONTACT FILE"] {
        let edits = [("SECTION=RECT\n0.1, 0.2", "SECTION=CIRC\n0.1"), ("*CLOAD", &format!("*{output}\nU\n*CLOAD"))];
        refuses(BEAM, &edits, "--from abaqus or --from calculix");
    }
}

/// Loads of a step of modes do not act, and modes are about the last step with time before them.
#[test]
fn steps_of_modes() {
    let modes = [("*STATIC\n0.5, 1.\n*CLOAD\n2, 3, 5.", "*FREQUENCY\n4\n*CLOAD\n2, 1, -1e6\n*DLOAD\nrod, PZ, 5.")];
    let made = imported(&edited(BEAM, &modes));
    assert_eq!(refusals(&made), [""; 0]);
    assert!(!made.deck.contains("[[loads]]"), "{}", made.deck);
    let said = reasons(&made, KeywordVerdict::Ignored);
    assert_eq!(said.iter().filter(|said| said.contains("natural modes")).count(), 2, "{said:?}");
    let two = "*END STEP\n*STEP\n*FREQUENCY\n4\n*END STEP\n*STEP\n*BUCKLE\n2\n*CLOAD\n2, 1, -1.\n*END STEP\n";
    let made = imported_from(&edited(BEAM, &[("*END STEP\n", two)]), Some(Dialect::Abaqus));
    assert_eq!(refusals(&made), [""; 0]);
    let at = |kind: &str| tables(&made.deck).find(&format!("kind = \"{kind}\"")).unwrap();
    assert!(at("static") < at("modal") && at("static") < at("buckling"), "{}", made.deck);
    let perturbed = "*END STEP\n*STEP, PERTURBATION\n*STATIC\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    refuses(BEAM, &[("*END STEP\n", perturbed)], "is about the loaded state in CalculiX: say --from");
}

/// Static perturbations of Abaqus are load cases: each has its own loads alone, and a force of the step before ends. One alone with modes
/// is a static step. CalculiX 2.20 bends this beam 2.5 times as far in a second perturbation that follows a compression of 20.
#[test]
fn static_perturbations() {
    let abaqus = Some(Dialect::Abaqus);
    let perturbed = "*END STEP\n*STEP, PERTURBATION\n*STATIC\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    let linear = [("*STEP, NLGEOM", "*STEP"), ("*END STEP\n", perturbed)];
    has(BEAM, &linear, abaqus, "points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]\n");
    let text = edited(BEAM, &linear);
    let said = |text: &str, dialect| refusals(&imported_from(text, Some(dialect))).join("; ");
    assert!(said(&text, Dialect::Calculix).contains("about the loaded state"));
    assert!(said(&edited(BEAM, &linear[1..]), Dialect::Abaqus).contains("perturbations follow linear static steps"));
    assert!(
        said(&text.replace("2, 2, 1.", "2, 2, 1.\n*BOUNDARY\n1, 1, 1, 0.1"), Dialect::Abaqus)
            .contains("moved supports")
    );
    assert!(
        said(&text.replace("2, 2, 1.", "2, 2, 1.\n*TEMPERATURE\n1, 50."), Dialect::Abaqus)
            .contains("temperatures of their own")
    );
    let modes = "*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n4\n*END STEP\n";
    let alone = [("*STEP, NLGEOM", "*STEP, PERTURBATION"), ("*END STEP\n", modes)];
    for (dialect, first) in [(Dialect::Abaqus, "modal"), (Dialect::Calculix, "static")] {
        has(BEAM, &alone, Some(dialect), "kind = \"modal\"\nmodes = 4\n");
        let deck = imported_from(&edited(BEAM, &alone), Some(dialect)).deck;
        let kinds: Vec<&str> = deck.lines().filter(|line| line.starts_with("kind = ")).collect();
        assert_eq!(kinds[0], format!("kind = \"{first}\""), "{deck}");
    }
}

/// Sets may be made before their nodes; one without any is refused.
#[test]
fn sets_before_their_nodes_and_empty_ones() {
    let early = |set: &'static str| [("*NODE\n1, 0.", set), ("*CLOAD\n2, 3", "*CLOAD\nearly, 3")];
    has(BEAM, &early("*NSET, NSET=early, GENERATE\n2, 2\n*NODE\n1, 0."), None, "force = [0.0, 0.0, 5.0]\n");
    for empty in ["*NSET, NSET=early\n99\n*NODE\n1, 0.", "*NSET, NSET=early, GENERATE\n99, 99\n*NODE\n1, 0."] {
        refuses(BEAM, &early(empty), "none of the nodes of `early` exists");
    }
    let cells = [("*NSET", "*ELSET, ELSET=none\n99\n*NSET"), ("*CLOAD\n2, 3, 5.", "*DLOAD\nnone, PZ, 5.")];
    refuses(BEAM, &cells, "none of the elements of `none` exists");
}

/// Supports that end.
#[test]
fn supports_that_end() {
    let moved = ("*CLOAD\n2, 3, 5.", "*BOUNDARY\n2, 3, 3, 0.1");
    let freed = step("*BOUNDARY, OP=NEW\n1, 1, 6\n");
    refuses(BEAM, &[moved, ("*END STEP\n", &freed)], "a moved support that is freed later");
    let again = format!("{freed}*STEP, NLGEOM\n*STATIC\n*BOUNDARY, FIXED\n2, 3\n*END STEP\n");
    let held = ("*CLOAD\n2, 3, 5.", "*BOUNDARY\n2, 3");
    refuses(BEAM, &[held, ("*END STEP\n", &again)], "a support that ends and comes again");
    has(BEAM, &[held, ("*END STEP\n", &freed)], None, "fix = [\"uz\"]\nstages = \"step_1\"\n");
    for kind in ["VELOCITY", "ACCELERATION"] {
        let lines = format!("*BOUNDARY, TYPE={kind}\n2, 3, 3, 0.1");
        refuses(BEAM, &[("*CLOAD\n2, 3, 5.", &lines)], "in a static step is not translated");
    }
}

/// Amplitudes that a deck does not have as they are.
#[test]
fn amplitudes() {
    let with = |card: &str| {
        edited(BEAM, &[("*STEP", &format!("*AMPLITUDE, NAME=A{card}\n*STEP")), ("*CLOAD", "*CLOAD, AMPLITUDE=A")])
    };
    let sine = with(", DEFINITION=PERIODIC\n1, 314.1592653589793, 0., 0.\n0., 2.");
    has(&sine, &[], None, "kind = \"sine\"\nfrequency = 50.0\nphase = 0.0\n");
    has(&sine, &[], None, "force = [0.0, 0.0, 10.0]\n");
    let second = step("*CLOAD\n2, 2, 7.\n");
    refuses(&sine, &[("*END STEP\n", &second)], "more than 40 periods");
    let slow = imported(&edited(&sine, &[("314.1592653589793", "3.14"), ("*END STEP\n", &second)]));
    assert_eq!(refusals(&slow), [""; 0]);
    assert!(reasons(&slow, KeywordVerdict::Changed)[0].contains("a table of 200 points a step"));
    refuses(&with(", VALUE=ABSOLUTE\n0., 0., 1., 2."), &[], "VALUE=ABSOLUTE is not translated");
    has(&with(", VALUE=RELATIVE, TIME=STEP TIME\n0., 0., 1., 2."), &[], None, "points = [[0.0, 0.0], [1.0, 2.0]]\n");
    let total = with(", TIME=TOTAL TIME\n0., 0., 1., 2.");
    has(&total, &[], None, "points = [[0.0, 0.0], [1.0, 2.0]]\n");
    // In a second step, to t = 2, the load goes on along the amplitude: from 10 to 20.
    let longer = with(", TIME=TOTAL TIME\n0., 0., 2., 4.");
    has(&longer, &[("*END STEP\n", &second)], None, "points = [[0.0, 0.0], [2.0, 4.0]]\n");
    // So does a sine, however many its periods are.
    let sine = with(", DEFINITION=PERIODIC, TIME=TOTAL TIME\n1, 314.1592653589793, 0., 0.\n0., 2.");
    has(&sine, &[("*END STEP\n", &second)], None, "kind = \"sine\"\nfrequency = 50.0\nphase = 0.0\n");
    has(&with(", TIME DELAY=1.\n0., 0., 1., 2."), &[], None, "points = [[1.0, 0.0], [2.0, 2.0]]\n");
    let unknown = [("*CLOAD", "*CLOAD, AMPLITUDE=B"), ("*END STEP\n", &second)];
    refuses(BEAM, &unknown, "no amplitude is named `B`");
}

/// Axes by two points and an origin; axes of parts.
#[test]
fn systems_of_axes() {
    let axis = |lines: &'static str| [("MATERIAL=m\n0.01", "MATERIAL=m, ORIENTATION=o\n0.01"), ("*STEP", lines)];
    let from_c = axis("*ORIENTATION, NAME=o\n1., 3., 0., 0., 2., 0., 1., 2., 0.\n*STEP");
    has(SHELL, &from_c, None, "axis = [0.0, 1.0, 0.0]\n");
    let two = "*ORIENTATION, NAME=o\n1., 0., 0., 0., 1., 0.\n*ORIENTATION, NAME=O\n0., 1., 0., 0., 0., 1.\n*STEP";
    refuses(SHELL, &axis(two), "another system of axes has this name");
    let part = "*PART, NAME=p\n*NODE\n1, 0., 0., 0.\n*ORIENTATION, NAME=o\n1., 0., 0., 0., 1., 0.\n*END PART\n*ASSEMBLY, NAME=a\n\
                *INSTANCE, NAME=i, PART=p\n0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n*END ASSEMBLY\n";
    refuses(part, &[], "the axes of a part do not turn with its instance");
    let straight = imported(&edited(part, &[("0., 0., 0., 0., 0., 1., 90.\n", "")]));
    assert!(!refusals(&straight).iter().any(|said| said.contains("axes of a part")));
}

/// Numbers and parameters that once passed without a word.
#[test]
fn parameters_that_count() {
    refuses(BEAM, &[("*DENSITY", "*DAMPING, STRUCTURAL=0.1\n*DENSITY")], "no structural damping");
    let mass = "*ELEMENT, TYPE=MASS, ELSET=w\n5, 2\n*MASS, ELSET=w, ALPHA=0.1\n3.\n*BOUNDARY";
    refuses(BEAM, &[("*BOUNDARY", mass)], "ALPHA of single masses is not translated");
    let riks = |data: &'static str| [("*STATIC\n0.5, 1.", data)];
    refuses(BEAM, &riks("*STATIC, RIKS\n0.5, 1., , , 2.5"), "multiply them by this factor");
    refuses(BEAM, &riks("*STATIC, RIKS\n0.5, 1., , , , 2, 3, 0.1"), "an end at a displacement");
    has(BEAM, &riks("*STATIC, RIKS\n0.5, 1., , , 1."), None, "control = \"arc-length\"\n");
    for load in ["*CLOAD\n2, 3, 5.\n", "*DLOAD\nrod, PZ, 5.\n"] {
        refuses(BEAM, &[("*STEP", &format!("{load}*STEP"))], "no *STEP is open at this line");
    }
    let keyword = "*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n";
    let general = |density: &str| {
        let head = format!("*BEAM GENERAL SECTION, ELSET=rod, SECTION=GENERAL, DENSITY={density}\n");
        edited(BEAM, &[(keyword, &format!("{head}0.02, 3e-3, 1e-3, 4e-3, 5e-3\n0., 1., 0.\n2e9, 1e9\n"))])
    };
    has(&general("7.8D3"), &[], Some(Dialect::Abaqus), "density = 7800.0\n");
    refuses(&general("heavy"), &[], "DENSITY must be a number");
}

/// Velocities of zero at the start are no initial motion.
#[test]
fn a_start_at_rest() {
    let text = edited(BEAM, &[("*STEP", "*INITIAL CONDITIONS, TYPE=VELOCITY\n2, 3, 0.\n*STEP")]);
    let made = imported(&text);
    assert_eq!(refusals(&made), [""; 0]);
    assert!(!made.deck.contains("[[initial]]"), "{}", made.deck);
    assert!(reasons(&made, KeywordVerdict::Ignored).iter().any(|said| said.contains("all begins at rest")));
}

/// Gravity of a later step is not there in the modes before it, and then acts at once: z = −g t²/2.
#[test]
fn gravity_after_modes() {
    let text = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*ELEMENT, TYPE=SPRING1, ELSET=ES\n1, 2\n*SPRING, ELSET=ES\n1\n400.\n\
                *ELEMENT, TYPE=MASS, ELSET=EM\n2, 2\n*MASS, ELSET=EM\n1.\n*BOUNDARY\n2, 2\n*STEP\n*FREQUENCY\n1\n*END STEP\n\
                *STEP, NLGEOM\n*DYNAMIC, DIRECT, ALPHA=0.\n0.01, 0.1\n*DLOAD\n, GRAV, 9.81, 0., 0., -1.\n*NODE PRINT\nU\n*END STEP\n";
    let made = imported(text);
    assert!(made.deck.contains("gravity = [0.0, 0.0, -9.81]\ngravity_stages = \"step_2\"\n"), "{}", made.deck);
    let folder = super::command::folder(&[("a.inp", text)]);
    let (code, said, problems) = super::command::rdsolve(folder.path(), &["a.inp"]);
    assert_eq!((code, problems.contains("equilibrium")), (0, false), "{said}{problems}");
    let nodes = std::fs::read_to_string(folder.path().join("a.out/nodes.csv")).unwrap();
    let numbers = nodes
        .lines()
        .rfind(|line| line.contains("mesh.2"))
        .unwrap()
        .split(',')
        .filter_map(|word| word.parse::<f64>().ok());
    // The trapezoidal rule has parabolas to rounding.
    assert!(numbers.into_iter().any(|x| (x + 9.81 * 0.01 / 2.0).abs() < 1e-12), "{nodes}");
}
