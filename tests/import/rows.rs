//! Rows of the mapping, each with a file of some lines and the words of the deck that come out.

use super::values::model_of;
use super::{imported, imported_from, reasons, refusals, tables};
use import::{Dialect, KeywordVerdict};

/// A cantilever of one beam; `edits` replace parts of it.
pub const BEAM: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0.5, 0., 0.\n9, 0., 0., 1.\n*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 2\n*NSET, NSET=tip\n2\n\
                    *MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.\n\
                    *BOUNDARY\n1, 1, 6\n*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CLOAD\n2, 3, 5.\n*END STEP\n";
/// A square of shell.
pub const SHELL: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n*ELEMENT, TYPE=S4, ELSET=skin\n1, 1, 2, 3, 4\n\
                     *MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n7.\n*SHELL SECTION, ELSET=skin, MATERIAL=m\n0.01\n\
                     *BOUNDARY\n1, 1, 6\n*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CLOAD\n3, 3, 5.\n*END STEP\n";

pub fn edited(text: &str, edits: &[(&str, &str)]) -> String {
    edits.iter().fold(text.to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "`{old}` must stand in the file");
        text.replace(old, new)
    })
}

/// The deck has these lines one after the other, nothing is refused, and the deck can be read.
pub fn has(text: &str, edits: &[(&str, &str)], dialect: Option<Dialect>, wanted: &str) {
    let made = imported_from(&edited(text, edits), dialect);
    assert_eq!(refusals(&made), [""; 0], "{edits:?}");
    assert!(tables(&made.deck).contains(wanted), "{wanted} is not in\n{}", made.deck);
    model_of(&made);
}

/// A reason for which it is refused.
pub fn refuses(text: &str, edits: &[(&str, &str)], wanted: &str) {
    let said = refusals(&imported(&edited(text, edits)));
    assert!(said.iter().any(|said| said.contains(wanted)), "{wanted} is not in {said:?}");
}

/// The numbers in the first line of a deck that begins with a key.
fn row_of(deck: &str, key: &str) -> Vec<f64> {
    let line = deck.lines().find(|line| line.starts_with(key)).unwrap();
    line.split(['[', ' ', ',', ']']).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn sections_of_beams() {
    let with = |section: &'static str, sizes: &'static str| [("SECTION=RECT", section), ("0.1, 0.2", sizes)];
    let calculix = Some(Dialect::Calculix);
    let abaqus = Some(Dialect::Abaqus);
    has(BEAM, &[], None, "[sections.rod]\nshape = \"rectangle\"\nwidth = 0.1\nheight = 0.2\n");
    has(BEAM, &with("SECTION=RECT", "0.1"), calculix, "shape = \"rectangle\"\nwidth = 0.1\nheight = 0.1\n");
    // CalculiX 2.20 bends U1 by I11 along the first axis.
    has(BEAM, &with("SECTION=GENERAL", "0.02, 3e-5, 0., 4e-5"), calculix, "moments = [4e-5, 3e-5]\n");
    has(BEAM, &with("SECTION=GENERAL", "0.02, 3e-5, 0., 4e-5"), abaqus, "moments = [3e-5, 4e-5]\n");
    refuses(BEAM, &with("SECTION=RECT", "0.1"), "SECTION=RECT needs 2 numbers");
    has(BEAM, &with("SECTION=CIRC", "0.1"), abaqus, "shape = \"circle\"\nradius = 0.1\n");
    has(BEAM, &with("SECTION=CIRC", "0.1, 0.1"), calculix, "shape = \"circle\"\nradius = 0.05\n");
    has(BEAM, &with("SECTION=PIPE", "0.1, 0.01"), None, "shape = \"tube\"\nradius = 0.1\nthickness = 0.01\n");
    let walls = "shape = \"box\"\nwidth = 0.1\nheight = 0.2\nthickness = [0.01, 0.02]\n";
    has(BEAM, &with("SECTION=BOX", "0.1, 0.2, 0.01, 0.02, 0.01, 0.02"), None, walls);
    refuses(BEAM, &with("SECTION=BOX", "0.1, 0.2, 0.05, 0.02, 0.06, 0.02"), "leave a hollow");
    let flanges = "height = 0.2\nbottom_width = 0.1\ntop_width = 0.1\nbottom_flange_thickness = 0.01\ntop_flange_thickness = 0.01\n\
                   web_thickness = 0.005\n";
    has(BEAM, &with("SECTION=I", "0.1, 0.2, 0.1, 0.1, 0.01, 0.01, 0.005"), None, flanges);
    has(
        BEAM,
        &with("SECTION=L", "0.1, 0.2, 0.01, 0.02"),
        None,
        "shape = \"l\"\nwidth = 0.1\nheight = 0.2\nthickness = [0.02, 0.01]\n",
    );
    refuses(BEAM, &with("SECTION=CIRC", "0.1"), "--from abaqus or --from calculix");
    refuses(BEAM, &with("SECTION=CHANNEL", "0.1, 0.1, 0.2, 0."), "SECTION=CHANNEL needs 8 numbers");
    refuses(BEAM, &with("SECTION=HAT", "0.1, 0.1, 0.2, 0."), "SECTION=HAT needs 8 numbers");
    refuses(BEAM, &with("SECTION=MESHED", "0.1"), "SECTION=MESHED is not translated");
    refuses(BEAM, &with("SECTION=TRAPEZOID", "0., 0.1, 0., 0."), "must be above zero");
    // Equal widths are a rectangle of 0.1 by 0.2, whose node lies at the base.
    let made = imported(&edited(BEAM, &with("SECTION=TRAPEZOID", "0.1, 0.2, 0.1, 0.")));
    let row = |key: &str| row_of(&made.deck, key);
    let wanted = [0.1 * 0.2_f64.powi(3) / 12.0, 0.2 * 0.1_f64.powi(3) / 12.0, 0.0, 0.0, 0.1];
    for (found, wanted) in row("moments").into_iter().chain(row("offset_start")).zip(wanted) {
        assert!((found - wanted).abs() < 1e-15, "{}", made.deck); // rounding
    }
    // A box whose wall towards +1 is thick: the sums over its four walls, which do not overlap.
    let made = imported(&edited(BEAM, &with("SECTION=BOX", "0.1, 0.16, 0.02, 0.01, 0.005, 0.008")));
    let walls = [
        (0.02, 0.16, 0.04, 0.0),
        (0.005, 0.16, -0.0475, 0.0),
        (0.075, 0.01, -0.0075, 0.075),
        (0.075, 0.008, -0.0075, -0.076),
    ];
    let area: f64 = walls.iter().map(|(a, b, ..)| a * b).sum();
    let [y, z] = [0, 1].map(|i| walls.iter().map(|(a, b, y, z)| a * b * [y, z][i]).sum::<f64>() / area);
    let moments = walls.iter().map(|(a, b, u, v)| {
        let (u, v) = (u - y, v - z);
        [a * b * (b * b / 12.0 + v * v), a * b * (a * a / 12.0 + u * u), a * b * u * v]
    });
    let [about_y, about_z, product] =
        moments.fold([0.0; 3], |sum, of_wall| std::array::from_fn(|i| sum[i] + of_wall[i]));
    for (key, wanted) in [("area", vec![area]), ("moments", vec![about_y, about_z]), ("product_moment", vec![product])]
    {
        for (found, wanted) in row_of(&made.deck, key).into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-12, "{key}: {found} for {wanted}"); // rounding
        }
    }
    let yields = [
        ("SECTION=RECT\n0.1, 0.2", "SECTION=BOX\n0.1, 0.16, 0.02, 0.01, 0.005, 0.008"),
        ("1e9, 0.3", "1e9, 0.3\n*PLASTIC\n1e6"),
    ];
    refuses(BEAM, &yields, "stays elastic: leave *PLASTIC out, or give RECT, CIRC, PIPE, BOX of like walls");
    // The first axis of this section is global y, the second global z.
    for (found, wanted) in row_of(&made.deck, "offset_start").into_iter().zip([0.0, y, z]) {
        assert!((found - wanted).abs() < 1e-15, "{}", made.deck);
    }
    // An ellipse: A = π a b, I = A a²/4, J = π a³ b³/(a² + b²).
    let made = imported_from(&edited(BEAM, &with("SECTION=CIRC", "0.2, 0.4")), calculix);
    let area = std::f64::consts::PI * 0.02;
    assert!(
        made.deck.contains(&format!("moments = [{:?}, {:?}]", 0.25 * area * 0.2 * 0.2, 0.25 * area * 0.1 * 0.1)),
        "{}",
        made.deck
    );
}

/// A channel and a hat by sums over plates that do not overlap. Middle lines err at each corner by the square of thickness over size.
#[test]
fn channels_and_hats() {
    let with = |section: &'static str, sizes: &'static str| [("SECTION=RECT", section), ("0.1, 0.2", sizes)];
    let of_plates = |plates: &[[f64; 4]]| {
        let area: f64 = plates.iter().map(|[a, b, ..]| a * b).sum();
        let [y, z] = [2, 3].map(|i| plates.iter().map(|plate| plate[0] * plate[1] * plate[i]).sum::<f64>() / area);
        let about = |i: usize, center: f64| -> f64 {
            let own = |plate: &[f64; 4]| plate[i].powi(2) / 12.0 + (plate[2 + i] - center).powi(2);
            plates.iter().map(|plate| plate[0] * plate[1] * own(plate)).sum()
        };
        (area, [about(1, z), about(0, y)], [y, z])
    };
    let near = |deck: &str, key: &str, wanted: &[f64], tolerance: f64| {
        for (found, wanted) in row_of(deck, key).iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < tolerance, "{key}: {found} for {wanted}");
        }
    };
    // Like flanges: the node lies 0.01 from the back of the web and 0.04 over the lower side. Axis 1 is global y.
    let channel = edited(BEAM, &with("SECTION=CHANNEL", "0.04, 0.2, 0.08, 0.08, 0.01, 0.01, 0.006, 0.01"));
    let keys = "shape = \"c\"\nheight = 0.2\nwidth = 0.08\nweb_thickness = 0.006\nflange_thickness = 0.01\n";
    has(&channel, &[], None, keys);
    let (_, _, [y, z]) =
        of_plates(&[[0.006, 0.2, 0.003, 0.1], [0.074, 0.01, 0.043, 0.005], [0.074, 0.01, 0.043, 0.195]]);
    let offset = row_of(&imported(&channel).deck, "offset_start");
    assert!((offset[1] / (y - 0.01) - 1.0).abs() < 1e-12 && (offset[2] / (z - 0.04) - 1.0).abs() < 1e-12, "{offset:?}");
    let of_calculix = imported_from(&channel, Some(Dialect::Calculix));
    assert!(!refusals(&of_calculix).is_empty(), "CalculiX has no such section");
    // Unlike flanges. (t/b)² is 0.02, and corners are a part of the area.
    let made = imported(&edited(BEAM, &with("SECTION=CHANNEL", "0., 0.2, 0.08, 0.06, 0.012, 0.008, 0.006, 0.")));
    let (area, moments, center) =
        of_plates(&[[0.006, 0.2, 0.003, 0.1], [0.074, 0.012, 0.043, 0.006], [0.054, 0.008, 0.033, 0.196]]);
    near(&made.deck, "area", &[area], 1e-12);
    near(&made.deck, "moments", &moments, 0.01);
    let offset = row_of(&made.deck, "offset_start");
    assert!((0..2).all(|i| (offset[1 + i] / center[i] - 1.0).abs() < 0.02), "{offset:?} for {center:?}");
    // A hat with upright webs.
    let made = imported(&edited(BEAM, &with("SECTION=HAT", "0.03, 0.1, 0.2, 0.1, 0.05, 0.004, 0.004, 0.004")));
    let (area, moments, [_, z]) = of_plates(&[
        [0.104, 0.004, 0.0, 0.098],
        [0.004, 0.092, 0.05, 0.05],
        [0.004, 0.092, -0.05, 0.05],
        [0.052, 0.004, 0.074, 0.002],
        [0.052, 0.004, -0.074, 0.002],
    ]);
    near(&made.deck, "area", &[area], 1e-12);
    near(&made.deck, "moments", &moments, 0.01);
    let offset = row_of(&made.deck, "offset_start");
    assert!(offset[1].abs() < 1e-15 && (offset[2] / (z - 0.03) - 1.0).abs() < 0.01, "{offset:?}");
}

#[test]
fn elements_of_beams() {
    has(BEAM, &[("TYPE=B31", "TYPE=B32"), ("1, 1, 2\n*NSET", "1, 1, 3, 2\n*NSET")], None, "order = 2\n");
    has(BEAM, &[("\n1, 1, 2\n", "\n1, 1, 2, 9\n")], None, "orientation = [0.0, 0.0, 1.0]\n");
    refuses(BEAM, &[("0., 1., 0.\n*BOUNDARY", "1., 0., 0.\n*BOUNDARY")], "is parallel to element 1");
    // A curved beam is two straight ones.
    let curved = edited(
        BEAM,
        &[("TYPE=B31", "TYPE=B32"), ("1, 1, 2\n*NSET", "1, 1, 3, 2\n*NSET"), ("3, 0.5, 0.", "3, 0.5, 0.1")],
    );
    let made = imported(&curved);
    assert!(made.mesh.contains("*ELEMENT, TYPE=B31, ELSET=rod\n1, 1, 3\n2, 3, 2\n"), "{}", made.mesh);
    assert!(reasons(&made, KeywordVerdict::Changed)[0].contains("two straight ones"));
    for (kind, why) in [
        ("C3D8", "no solid elements"),
        ("CPS4", "no plane elements"),
        ("CAX4", "no axisymmetric elements"),
        ("M3D4", "no membranes"),
        ("ELBOW31", "no elements of this type"),
    ] {
        let nodes = "1, ".repeat(kind.chars().filter_map(|c| c.to_digit(10)).next_back().unwrap_or(2) as usize);
        let nodes = if kind == "ELBOW31" { "1, 2".to_owned() } else { nodes.trim_end_matches(", ").to_owned() };
        refuses(
            BEAM,
            &[("*NSET, NSET=tip", &format!("*ELEMENT, TYPE={kind}, ELSET=x\n7, {nodes}\n*NSET, NSET=tip"))],
            why,
        );
    }
}

#[test]
fn bars_without_compression() {
    let slack = [("*DENSITY", "*NO COMPRESSION\n*DENSITY")];
    refuses(BEAM, &slack, "bars alone take tension alone");
    let truss = [
        slack[0],
        ("TYPE=B31", "TYPE=T3D2"),
        (
            "*BEAM SECTION, ELSET=rod, MATERIAL=m, SECTION=RECT\n0.1, 0.2\n0., 1., 0.",
            "*SOLID SECTION, ELSET=rod, MATERIAL=m\n0.02",
        ),
    ];
    has(BEAM, &truss, None, "area = 0.02\ntension_only = true\n");
}

/// Springs and dampers of a joint, along axes that turn with its first node.
#[test]
fn joints_of_springs() {
    let joint = "*ELEMENT, TYPE=JOINTC, ELSET=j\n7, 2, 9\n*ORIENTATION, NAME=o\n0., 1., 0., 0., 0., 1.\n*JOINT, ELSET=j, ORIENTATION=O\n\
                 *SPRING\n1\n200.\n*DASHPOT\n3,\n4.\n*SPRING\n6\n50.\n*BOUNDARY\n9, 1, 6";
    let with = |old: &str, new: &str| [("*BOUNDARY", joint.replace(old, new))];
    let refused = |old: &str, new: &str, why: &str| {
        let [(at, joint)] = with(old, new);
        refuses(BEAM, &[(at, &joint)], why);
    };
    let wanted = "from = { node = \"mesh.2\" }\nto = { node = \"mesh.9\" }\nbushing = [200.0, 0.0, 0.0, 0.0, 0.0, 50.0]\n\
                  bushing_damping = [0.0, 0.0, 4.0, 0.0, 0.0, 0.0]\naxes = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n";
    has(BEAM, &[("*BOUNDARY", joint)], None, wanted);
    refused("*SPRING\n1\n", "*SPRING\n7\n", "its axis, from 1 to 6");
    refused("*SPRING\n1\n200.\n", "*SPRING\n1\n", "its axis, from 1 to 6");
    refused("*SPRING\n1\n", "*SPRING, NONLINEAR\n1\n", "are linear in rdsolve");
    refused("JOINT, ELSET=j, ", "JOINT, ", "*JOINT needs ELSET=");
    refused("ORIENTATION=O", "ORIENTATION=P", "no system of axes is named `P`");
    refused("*SPRING\n1\n200.\n*DASHPOT\n3,\n4.\n*SPRING\n6\n50.\n", "", "joins nothing");
}

#[test]
fn shells() {
    let general = [("*SHELL SECTION", "*SHELL GENERAL SECTION")];
    has(SHELL, &general, None, "[[shells]]\ngroup = \"skin\"\nthickness = 0.01\nmaterial = \"m\"\n");
    refuses(SHELL, &[general[0], (", MATERIAL=m\n0.01", "\n1., 2., 3.")], "a material and a thickness in rdsolve");
    has(SHELL, &[], None, "[[shells]]\ngroup = \"skin\"\nthickness = 0.01\nmaterial = \"m\"\n");
    has(SHELL, &[("*BOUNDARY\n", "*NSET, NSET=skin\n1\n*BOUNDARY\n")], None, "[[shells]]\ngroup = \"skin_elements\"\n");
    let nodal = [
        ("MATERIAL=m\n0.01", "MATERIAL=m, NODAL THICKNESS\n0.01"),
        ("*STEP", "*NSET, NSET=all, GENERATE\n1, 4\n*NODAL THICKNESS\nall, 0.03\n*STEP"),
    ];
    has(SHELL, &nodal, None, "thickness = 0.03\n");
    refuses(SHELL, &[nodal[0], ("*STEP", "*NODAL THICKNESS\n1, 0.03\n2, 0.04\n*STEP")], "have no thickness");
    let axis = [
        ("MATERIAL=m\n0.01", "MATERIAL=m, ORIENTATION=o\n0.01"),
        ("*STEP", "*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.\n*STEP"),
    ];
    has(SHELL, &axis, None, "axis = [0.0, 1.0, 0.0]\n");
    let yields = [("*DENSITY", "*PLASTIC\n200., 0.\n300., 0.1\n*DENSITY"), ("MATERIAL=m\n0.01", "MATERIAL=m\n0.01, 5")];
    has(SHELL, &yields, None, "layers = 5\nstrain = \"logarithmic\"\n");
    has(
        SHELL,
        &yields,
        None,
        "model = \"elastic-plastic\"\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\ndensity = 7.0\nhardening = [[0.0, 200.0], [0.1, 300.0]]\n",
    );
    let rate = [yields[0], ("*PLASTIC", "*RATE DEPENDENT, TYPE=POWER LAW\n40., 5.\n*PLASTIC, HARDENING=KINEMATIC")];
    has(SHELL, &rate, None, "kinematic_share = 1.0\nviscosity = { law = \"power\", rate = 40.0, exponent = 5.0 }\n");
}

#[test]
fn loads_on_parts() {
    let load = |line: &'static str| [("*CLOAD\n3, 3, 5.", line)];
    has(SHELL, &load("*DLOAD\nskin, P, 5."), None, "[[loads]]\npart = \"skin\"\npressure = -5.0\nfollower = true\n");
    has(
        SHELL,
        &[("*CLOAD\n3, 3, 5.", "*DSLOAD\ntop, P, 5."), ("*STEP", "*SURFACE, NAME=top\nskin, SPOS\n*STEP")],
        None,
        "pressure = 5.0\n",
    );
    has(SHELL, &load("*DLOAD\n, GRAV, 9.81, 0., 0., -2."), None, "[environment]\ngravity = [0.0, 0.0, -9.81]\n");
    let spun = "*DLOAD\nskin, CENTRIF, 25., 1., 0., 0., 0., 0., 2.";
    let wanted = "centrifugal = { axis = [0.0, 0.0, 1.0], speed = 5.0, about = [1.0, 0.0, 0.0] }\n";
    has(SHELL, &load(spun), None, &format!("[[loads]]\n{wanted}"));
    refuses(SHELL, &load("*DLOAD\nskin, CENTRIF, -5., 0., 0., 0., 0., 0., 1."), "the square of an angular velocity");
    refuses(SHELL, &load("*DLOAD\nskin, CENTRIF, 5."), "CENTRIF needs a point");
    refuses(SHELL, &load("*DLOAD\nskin, CENT, 5., 0., 0., 0., 0., 0., 1."), "give CENTRIF, without the density");
    refuses(
        SHELL,
        &[("*STATIC\n0.5, 1.\n*CLOAD\n3, 3, 5.", &format!("*DYNAMIC\n0.5, 1.\n{spun}"))],
        "static steps and modes",
    );
    let named = ("*STEP", "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP");
    refuses(SHELL, &[named, ("*CLOAD\n3, 3, 5.", &spun.replace("*DLOAD", "*DLOAD, AMPLITUDE=A"))], "without AMPLITUDE");
    // Squares of 25 and 100 in two linear steps are speeds of 5 and 10.
    let second = format!("*END STEP\n*STEP\n*STATIC\n1., 1.\n{}\n*END STEP\n", spun.replace("25.", "100."));
    let first = format!("*STEP\n*STATIC\n1., 1.\n{spun}");
    let linear: [(&str, &str); 2] =
        [("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*CLOAD\n3, 3, 5.", &first), ("*END STEP\n", &second)];
    has(SHELL, &linear, None, "points = [[0.0, 0.0], [1.0, 0.5], [2.0, 1.0]]\n");
    has(SHELL, &linear, None, "speed = 10.0");
    let beside = "*ELEMENT, TYPE=MASS, ELSET=w\n5, 3\n*MASS, ELSET=w\n3.\n*BOUNDARY";
    let part = format!("[[loads]]\npart = \"skin\"\n{wanted}");
    has(SHELL, &[("*CLOAD\n3, 3, 5.", spun), ("*BOUNDARY", beside)], None, &part);
    let load = |line: &'static str| [("*CLOAD\n2, 3, 5.", line)];
    has(BEAM, &load("*DLOAD\nrod, PZ, 5."), None, "part = \"rod\"\nforce_per_length = [0.0, 0.0, 5.0]\n");
    refuses(BEAM, &load("*DLOAD\nrod, P2, 5."), "say --from abaqus or --from calculix");
    has(BEAM, &load("*DLOAD\nrod, P2, 5."), Some(Dialect::Abaqus), "local = [0.0, 0.0, 5.0]\n");
    has(BEAM, &load("*DLOAD\nrod, P2, 5."), Some(Dialect::Calculix), "local = [0.0, 0.0, 0.5]\n");
}

/// A part is cut where a load ends.
#[test]
fn parts_are_cut_where_loads_end() {
    let two = [
        ("3, 0.5, 0., 0.", "3, 2., 0., 0."),
        ("\n1, 1, 2\n", "\n1, 1, 2\n2, 2, 3\n"),
        ("*CLOAD\n2, 3, 5.", "*DLOAD\n2, PZ, 5."),
    ];
    let made = imported(&edited(BEAM, &two));
    assert_eq!(refusals(&made), [""; 0]);
    assert!(
        made.mesh.contains("ELSET=rod\n1, 1, 2\n") && made.mesh.contains("ELSET=rod_2\n2, 2, 3\n"),
        "{}",
        made.mesh
    );
    assert!(made.deck.contains("part = \"rod_2\"\nforce_per_length"), "{}", made.deck);
}

#[test]
fn supports() {
    let with = |lines: &'static str| [("*BOUNDARY\n1, 1, 6", lines)];
    has(BEAM, &[], None, "[[supports]]\nat = \"mesh.1\"\nfix = \"all\"\n");
    has(
        BEAM,
        &with("*BOUNDARY\n1, PINNED\ntip, 2\ntip, 5, 6"),
        None,
        "[[supports]]\nat = \"tip\"\nfix = [\"uy\", \"ry\", \"rz\"]\n",
    );
    has(BEAM, &with("*BOUNDARY\n1, XSYMM"), None, "fix = [\"ux\", \"ry\", \"rz\"]\n");
    has(
        BEAM,
        &with("*BOUNDARY\n1, 1, 6\n2, 3, 3, 0.1"),
        None,
        "motion = { uz = { scale = 0.1, amplitude = \"history\" } }\n",
    );
    refuses(BEAM, &with("*BOUNDARY\n1, 1, 6\n77, 3"), "node 77 does not exist");
    refuses(BEAM, &with("*BOUNDARY\n1, 1, 6\n2, 11, 11, 0.1"), "the degrees of freedom 1 to 6 alone");
    let amplitude = [
        ("*BOUNDARY\n1, 1, 6", "*BOUNDARY\n1, 1, 6\n*BOUNDARY, AMPLITUDE=a\n2, 3, 3, 0.1"),
        ("*STEP", "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*STEP"),
    ];
    has(BEAM, &amplitude, None, "motion = { uz = { scale = 0.1, amplitude = \"A\" } }\n");
    has(BEAM, &amplitude, None, "[amplitudes.A]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 2.0]]\n");
}

/// The ground accelerates; displacements are relative to it in both.
#[test]
fn base_motions() {
    let with = |motion: &str| {
        let step = "*AMPLITUDE, NAME=quake\n0., 0., 1., 2.\n*STEP\n*MODAL DYNAMIC\n0.01, 1.\n";
        edited(BEAM, &[("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n", &format!("{step}*BASE MOTION, {motion}\n"))])
    };
    let wanted =
        "[environment]\nbase_acceleration = [{ direction = [0.0, 1.0, 0.0], amplitude = \"quake\", scale = 3.0 }]\n";
    has(&with("DOF=2, AMPLITUDE=QUAKE, SCALE=3."), &[], None, wanted);
    let both =
        edited(&with("DOF=2, AMPLITUDE=quake, SCALE=3."), &[("*CLOAD", "*DLOAD\n, GRAV, 9., 0., 0., -1.\n*CLOAD")]);
    has(&both, &[], None, &format!("{}gravity = [0.0, 0.0, -9.0]\n", wanted));
    for (motion, why) in [
        ("DOF=4, AMPLITUDE=quake", "along DOF=1, 2 or 3"),
        ("DOF=2", "needs AMPLITUDE="),
        ("DOF=2, AMPLITUDE=none", "no amplitude is named `none`"),
        ("DOF=2, AMPLITUDE=quake, TYPE=DISPLACEMENT", "give TYPE=ACCELERATION"),
        ("DOF=2, AMPLITUDE=quake, BASE NAME=b", "the ground is one base"),
        ("DOF=2, AMPLITUDE=quake, SCALE=x", "SCALE must be a number"),
    ] {
        refuses(&with(motion), &[], why);
    }
    refuses(
        BEAM,
        &[("*CLOAD", "*BASE MOTION, DOF=1, AMPLITUDE=a\n*CLOAD")],
        "in steps of *MODAL DYNAMIC and *STEADY STATE DYNAMICS alone",
    );
    let two = edited(
        &with("DOF=1, AMPLITUDE=quake"),
        &[("*END STEP", "*END STEP\n*STEP\n*MODAL DYNAMIC\n0.01, 1.\n*END STEP")],
    );
    refuses(&two, &[], "in all stages of a deck");
}

/// Static steps without NLGEOM are one linear analysis, with all that acts in a step at its end.
#[test]
fn linear_steps() {
    let linear = |text: &str| text.replace("STEP, NLGEOM", "STEP");
    let one = "[analysis]\nkind = \"static\"\ngeometry = \"linear\"\nend_time = 1.0\ntime_step = 1.0\n";
    has(&linear(BEAM), &[], None, one);
    let two = linear(&edited(BEAM, &[("*END STEP\n", SECOND)]));
    has(&two, &[], None, "geometry = \"linear\"\nend_time = 3.0\ntime_step = 1.0\n");
    has(&two, &[], None, "points = [[0.0, 0.0], [1.0, 0.5], [3.0, 1.0]]\n");
    // A load of the first step alone goes on.
    let other =
        linear(&edited(BEAM, &[("*END STEP\n", "*END STEP\n*STEP\n*STATIC\n1., 2.\n*CLOAD\n2, 2, 1.\n*END STEP\n")]));
    has(&other, &[], None, "points = [[0.0, 0.0], [1.0, 1.0], [3.0, 1.0]]\n");
    has(&other, &[], None, "points = [[0.0, 0.0], [1.0, 0.0], [3.0, 1.0]]\n");
    // An amplitude is followed in the increments of the file.
    let amplitude = [("*CLOAD", "*CLOAD, AMPLITUDE=A"), ("*STEP", "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*STEP")];
    has(
        &linear(&edited(BEAM, &amplitude[..1])),
        &[("*STEP\n*STATIC", "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*STEP\n*STATIC")],
        None,
        "time_step = 0.5\n",
    );
    // Supports named again are the same; others make stages at large displacements.
    let again =
        linear(&edited(BEAM, &[("*END STEP\n", "*END STEP\n*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n1, 1, 6\n*END STEP\n")]));
    has(&again, &[], None, "geometry = \"linear\"\nend_time = 2.0\n");
    let freed = imported(&again.replace("OP=NEW\n1, 1, 6", "OP=NEW\n1, 1, 3"));
    assert!(!freed.deck.contains("geometry") && reasons(&freed, KeywordVerdict::Changed).len() == 2, "{}", freed.deck);
    // So do modes beside it, and yielding.
    let modes = imported(&linear(&edited(BEAM, &[("*END STEP\n", "*END STEP\n*STEP\n*FREQUENCY\n4\n*END STEP\n")])));
    assert!(!modes.deck.contains("geometry") && reasons(&modes, KeywordVerdict::Changed)[0].contains("without NLGEOM"));
    let yields = imported(&linear(&edited(BEAM, &[("*DENSITY", "*PLASTIC\n1e6, 0.\n2e6, 0.1\n*DENSITY")])));
    assert!(!yields.deck.contains("geometry"), "{}", yields.deck);
}

const SECOND: &str = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 2.\n*CLOAD\n2, 3, 10.\n*END STEP\n";

/// Amplitudes by formula are tables of its values, in one step and in several; a single sine stays one.
#[test]
fn amplitudes_by_formula() {
    type Formula = (&'static str, fn(f64) -> f64);
    let formulas: [Formula; 3] = [
        ("PERIODIC\n2, 6., 0.1, 0.5\n1., 2., 3., 4.\n", |t| match 6.0 * (t - 0.1) {
            w if w < 0.0 => 0.5,
            w => 0.5 + w.cos() + 2.0 * w.sin() + 3.0 * (2.0 * w).cos() + 4.0 * (2.0 * w).sin(),
        }),
        ("DECAY\n0.5, 2., 0.1, 0.2\n", |t| if t < 0.1 { 0.5 } else { 0.5 + 2.0 * (-(t - 0.1) / 0.2).exp() }),
        ("MODULATED\n0.5, 2., 0.1, 3., 20.\n", |t| match t - 0.1 {
            s if s < 0.0 => 0.5,
            s => 0.5 + 2.0 * (3.0 * s).sin() * (20.0 * s).sin(),
        }),
    ];
    let second = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    for (lines, wanted) in formulas {
        let with = format!("*AMPLITUDE, NAME=A, DEFINITION={lines}*BOUNDARY");
        let text = edited(BEAM, &[("*BOUNDARY", with.as_str()), ("*CLOAD", "*CLOAD, AMPLITUDE=A")]);
        for text in [text.clone(), edited(&text, &[("*END STEP\n", second)])] {
            let made = imported(&text);
            assert_eq!(refusals(&made), [""; 0]);
            model_of(&made);
            let forces = made.deck.lines().filter(|line| line.starts_with("force"));
            let force: f64 = forces.map(|line| row_of(line, "force")[2]).sum();
            let points = row_of(&made.deck, "points");
            assert!(points.len() > 400, "{lines}");
            for point in points.chunks(2).filter(|point| point[0] > 0.0 && point[0] < 1.0) {
                // The amplitude acts on 5, and numbers of the deck have all digits.
                let value = 5.0 * wanted(point[0]);
                assert!((force * point[1] - value).abs() < 1e-12, "{lines}: {point:?} for {value}");
            }
        }
    }
    let with = |lines: &'static str| [("*BOUNDARY", lines), ("*CLOAD", "*CLOAD, AMPLITUDE=A")];
    // 157 periods in a step.
    let many = "*AMPLITUDE, NAME=A, DEFINITION=PERIODIC\n1, 986.4601, 0., 1.\n0., 1.\n*BOUNDARY";
    refuses(BEAM, &with(many), "more than 40 periods");
    refuses(&edited(BEAM, &[("*END STEP\n", second)]), &with(many), "more than 40 periods");
    refuses(BEAM, &with("*AMPLITUDE, NAME=A, DEFINITION=DECAY\n0., 1., 0.\n*BOUNDARY"), "the numbers of its formula");
    let shifted = "*AMPLITUDE, NAME=A, DEFINITION=DECAY, SHIFTX=1.\n0., 1., 0., 1.\n*BOUNDARY";
    refuses(BEAM, &with(shifted), "an amplitude by formula is not shifted");
}

/// Between its points a table misses a formula by the square of their distance: a sine by (2π/100)²/8, 5e-4. It falls at its start in a part
/// 1e-9 of the step. Its integral is that of the formula, also of a decay in a thousandth of the step.
#[test]
fn tables_of_formulas_between_their_points() {
    let second = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    let of = |lines: &str, is_staged: bool| -> Vec<[f64; 2]> {
        let with = format!("*AMPLITUDE, NAME=A, DEFINITION={lines}*BOUNDARY");
        let text = edited(BEAM, &[("*BOUNDARY", with.as_str()), ("*CLOAD", "*CLOAD, AMPLITUDE=A")]);
        let text = if is_staged { edited(&text, &[("*END STEP\n", second)]) } else { text };
        let made = imported(&text);
        assert_eq!(refusals(&made), [""; 0]);
        let forces = made.deck.lines().filter(|line| line.starts_with("force"));
        let force: f64 = forces.map(|line| row_of(line, "force")[2]).sum();
        let points = row_of(&made.deck, "points");
        points.chunks(2).map(|point| [point[0], force * point[1] / 5.0]).filter(|point| point[0] <= 1.0).collect()
    };
    for is_staged in [false, true] {
        let sines = of("PERIODIC\n2, 157., 0.3001, 0.5\n0., 2., 0., 1.\n", is_staged);
        let decay = of("DECAY\n0., 2., 0.3001, 0.001\n", is_staged);
        let shape = |t: f64| {
            if t < 0.3001 { 0.5 } else { 0.5 + 2.0 * (157.0 * (t - 0.3001)).sin() + (314.0 * (t - 0.3001)).sin() }
        };
        let fall = |t: f64| if t < 0.3001 { 0.0 } else { 2.0 * (-(t - 0.3001) / 0.001).exp() };
        type Curve<'f> = (Vec<[f64; 2]>, &'f dyn Fn(f64) -> f64, f64);
        let formulas: [Curve; 2] = [(sines, &shape, 3.0), (decay.clone(), &fall, 2.0)];
        for (points, formula, size) in formulas {
            for pair in points.windows(2).filter(|pair| pair[1][0] < 1.0 && pair[1][0] - pair[0][0] > 1e-8) {
                for part in [0.25, 0.5, 0.75] {
                    let [t, value] = [0, 1].map(|i| pair[0][i] + part * (pair[1][i] - pair[0][i]));
                    assert!((value - formula(t)).abs() < 5e-4 * size, "{t}: {value} for {}", formula(t));
                }
            }
        }
        let sum: f64 = decay.windows(2).map(|pair| 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][0] - pair[0][0])).sum();
        // Its last chord adds 2.4e-4.
        assert!((sum / 0.002 - 1.0).abs() < 4e-4, "{sum}");
    }
}

/// Values at the temperature of the start: between rows, beyond the last one, and of the first one where the file does not give one temperature
/// to all nodes of the material. All tables of a material take values at this temperature.
#[test]
fn materials_at_the_first_temperature() {
    let rows = (
        "1e9, 0.3",
        "1e9, 0.3, 20.\n5e8, 0.2, 120.\n*PLASTIC\n4e6, 0., 20.\n6e6, 0.1, 20.\n2e6, 0., 120.\n4e6, 0.1, 120.",
    );
    let heat = |lines: &str| format!("*INITIAL CONDITIONS, TYPE=TEMPERATURE\n{lines}\n*BOUNDARY");
    let of = |lines: &str, modulus: &str, stress: &str| {
        let heat = heat(lines);
        let keys = format!("youngs_modulus = {modulus}\npoisson_ratio = ");
        has(BEAM, &[rows, ("*BOUNDARY", &heat)], None, &keys);
        has(BEAM, &[rows, ("*BOUNDARY", &heat)], None, &format!("hardening = [[0.0, {stress}], [0.1, "));
    };
    of("1, 45.\n2, 45.", "8.75e8", "3500000.0");
    of("1, 20.\n2, 20.", "1e9", "4000000.0");
    of("1, 300.\n2, 300.", "5e8", "2000000.0");
    // On one node of two, and unlike.
    of("tip, 45.", "1e9", "4000000.0");
    of("1, 20.\n2, 120.", "1e9", "4000000.0");
    has(BEAM, &[rows], None, "youngs_modulus = 1e9\npoisson_ratio = 0.3\n");
    let text = |lines: &str| edited(BEAM, &[rows, ("*BOUNDARY", &heat(lines))]);
    let changed = |lines: &str| reasons(&imported(&text(lines)), KeywordVerdict::Changed).join("; ");
    assert!(changed("1, 45.\n2, 45.").contains("it chooses values of materials alone"));
    assert!(changed("tip, 45.").contains("do not all begin at one temperature"), "{}", changed("tip, 45."));
    let unlike = rows.1.replace("4e6, 0.1, 120.", "4e6, 0.2, 120.");
    refuses(BEAM, &[(rows.0, &unlike), ("*BOUNDARY", &heat("1, 45.\n2, 45."))], "no rows hold at 45");
    // A short row has zeros behind.
    let short = ("1e9, 0.3", "1e9\n5e8, 0.2, 100.");
    has(BEAM, &[short, ("*BOUNDARY", &heat("1, 50.\n2, 50."))], None, "youngs_modulus = 7.5e8\npoisson_ratio = 0.1\n");
    let expands = ("1e9, 0.3", "1e9, 0.3\n*EXPANSION\n1e-5, 20.\n3e-5, 120.");
    let warmed = ("*CLOAD", "*TEMPERATURE\n1, 90.\n2, 90.\n*CLOAD");
    let deck = imported(&edited(BEAM, &[expands, warmed, ("*BOUNDARY", &heat("1, 70.\n2, 70."))])).deck;
    assert!((row_of(&deck, "expansion = ")[0] / 2e-5 - 1.0).abs() < 1e-15, "{deck}");
}

/// A rigid motion at the start is one table with its axis, and mass scaling of all elements a key of the scheme.
#[test]
fn starts_and_scaled_masses() {
    let spun = |lines: &'static str| [("*BOUNDARY", lines), ("*STATIC", "*DYNAMIC")];
    let of = "*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\ntip, 3., 1.\n1., 0., 0., 1., 0., 2.\n*BOUNDARY";
    let wanted =
        "at = \"tip\"\nvelocity = [1.0, 0.0, 0.0]\nangular_velocity = [0.0, 0.0, 3.0]\nabout = [1.0, 0.0, 0.0]\n";
    has(BEAM, &spun(of), None, wanted);
    refuses(BEAM, &spun("*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\ntip, 3.\n*BOUNDARY"), "two points of its axis");
    refuses(
        BEAM,
        &spun("*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\ntip, 3.\n1., 0., 0., 1.\n*BOUNDARY"),
        "the two points of this axis are one",
    );
    let of = |lines: &str| {
        edited(BEAM, &spun("*BOUNDARY").map(|(old, new)| if old == new { (old, lines) } else { (old, new) }))
    };
    let turned = "*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\ntip, 3.\n1., 0., 0., 1., 0., 2.\n";
    let also = format!("{turned}*INITIAL CONDITIONS, TYPE=VELOCITY\ntip, 1, 1.\n*BOUNDARY");
    refuses(&of(&also), &[], "has a rotating velocity by another line");
    refuses(&of(&format!("{turned}{turned}*BOUNDARY")), &[], "has a rotating velocity by another line");
    // Node 3 has no element.
    refuses(&of(&format!("{}*BOUNDARY", turned.replace("tip", "3"))), &[], "has an element that could move");
    let still = imported(&of(&format!("{}*BOUNDARY", turned.replace("tip, 3.", "tip, 0."))));
    assert!(reasons(&still, KeywordVerdict::Ignored).iter().any(|said| said.contains("all begins at rest")));
    let scaled = |line: &'static str| [("*STATIC\n0.5, 1.\n", line)];
    let explicit = "*DYNAMIC, EXPLICIT\n, 1.\n*FIXED MASS SCALING, TYPE=BELOW MIN, DT=2e-6\n";
    has(BEAM, &scaled(explicit), None, "scheme = \"central-difference\"\nmass_scaling_step = 2e-6\n");
    for (line, why) in [
        ("*DYNAMIC, EXPLICIT\n, 1.\n*FIXED MASS SCALING, FACTOR=4.\n", "with DT and TYPE=BELOW MIN"),
        ("*DYNAMIC, EXPLICIT\n, 1.\n*FIXED MASS SCALING, DT=1e-6, ELSET=rod\n", "of all elements"),
        ("*DYNAMIC\n0.1, 1.\n*FIXED MASS SCALING, DT=1e-6\n", "belongs to a step of *DYNAMIC, EXPLICIT"),
    ] {
        refuses(BEAM, &scaled(line), why);
    }
    // Scaled masses stay in later steps, and cannot come there.
    let second = "*END STEP\n*STEP\n*DYNAMIC, EXPLICIT\n, 1.\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    let text = edited(&edited(BEAM, &[("*END STEP\n", second)]), &scaled(explicit));
    has(&text, &[], None, "mass_scaling_step = 2e-6 }");
    // Explicit steps of Abaqus are at large displacements without a word.
    let is_linear = |text: &str, dialect| {
        let said = reasons(&imported_from(text, Some(dialect)), KeywordVerdict::Changed);
        said.iter().any(|said| said.contains("is linear"))
    };
    let [unsaid, refused] = ["", ", NLGEOM=NO"].map(|word| text.replace(", NLGEOM", word));
    assert!(!is_linear(&unsaid, Dialect::Abaqus) && is_linear(&refused, Dialect::Abaqus));
    assert!(is_linear(&unsaid, Dialect::Calculix));
    let late = second.replace(", 1.\n*CLOAD", ", 1.\n*FIXED MASS SCALING, DT=2e-6\n*CLOAD");
    refuses(
        &edited(BEAM, &[("*END STEP\n", &late)]),
        &scaled("*DYNAMIC, EXPLICIT\n, 1.\n"),
        "masses are scaled from the first step",
    );
}

/// Loads go on from step to step, and run from value to value over a step.
#[test]
fn several_steps() {
    let two = |lines: &'static str| -> [(&str, &str); 1] { [("*END STEP\n", lines)] };
    let stages = "[[stages]]\nname = \"step_1\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.5\n[[stages]]\nname = \"step_2\"\nkind = \"static\"\n\
                  duration = 2.0\ntime_step = 1.0\n";
    has(BEAM, &two(SECOND), None, stages);
    has(BEAM, &two(SECOND), None, "force = [0.0, 0.0, 10.0]\namplitude = \"history\"\n");
    has(
        BEAM,
        &two(SECOND),
        None,
        "[amplitudes.history]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 0.5], [3.0, 1.0]]\n",
    );
    // What begins in a later step acts from there on, and what is not named again goes on.
    let other = "*END STEP\n*STEP, NLGEOM, NAME=push\n*STATIC\n1., 2.\n*CLOAD\n2, 2, 1.\n*END STEP\n";
    has(BEAM, &two(other), None, "at = \"mesh.2\"\nforce = [0.0, 1.0, 0.0]\nstages = \"push\"\n");
    has(BEAM, &two(other), None, "at = \"mesh.2\"\nforce = [0.0, 0.0, 5.0]\n[");
    // OP=NEW takes away what is not named again.
    let new = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 2.\n*CLOAD, OP=NEW\n2, 2, 1.\n*END STEP\n";
    has(BEAM, &two(new), None, "points = [[0.0, 0.0], [1.0, 1.0], [3.0, 0.0]]\n");
    let freed = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 2.\n*BOUNDARY, OP=NEW\n1, 1, 3\n*END STEP\n";
    has(BEAM, &two(freed), None, "at = \"mesh.1\"\nfix = \"rotations\"\nstages = \"step_1\"\n");
    let late = "*END STEP\n*STEP, NLGEOM\n*STATIC\n1., 2.\n*BOUNDARY\n2, 3\n*END STEP\n";
    // From where it is found at t = 1 back to its place, as the file has it.
    has(BEAM, &two(late), None, "at = \"mesh.2\"\nmotion = { uz = { to = 0.0 } }\nstages = \"step_2\"\n");
    refuses(BEAM, &[("*END STEP\n", &late.replace("2, 3\n", "2, 5\n"))], "say FIXED");
    refuses(BEAM, &[("*END STEP\n", &late.replace("*STATIC", "*DYNAMIC"))], "say FIXED");
    has(
        BEAM,
        &[("*END STEP\n", &late.replace("*BOUNDARY", "*BOUNDARY, FIXED"))],
        None,
        "at = \"mesh.2\"\nfix = [\"uz\"]\nstages = \"step_2\"\n",
    );
    // A force in a dynamic step acts at once.
    let motion = "*END STEP\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 2.\n*CLOAD\n2, 3, 10.\n*END STEP\n";
    let made = imported(&edited(BEAM, &two(motion)));
    assert!(made.deck.contains("integrator = { scheme = \"hht-alpha\", alpha = -0.05 }"), "{}", made.deck);
    assert!(made.deck.contains("points = [[0.0, 0.0], [1.0, 0.5], [1.000000002, 1.0], [3.0, 1.0]]"), "{}", made.deck);
}

/// Loads with two amplitudes in one place are not one load.
#[test]
fn loads_with_two_amplitudes() {
    let amplitude = ("*STEP", "*AMPLITUDE, NAME=A\n0., 0., 1., 2.\n*STEP");
    let forces = ("*CLOAD\n2, 3, 5.", "*CLOAD\n2, 3, 5.\n*CLOAD, AMPLITUDE=A\n2, 3, 1.");
    refuses(BEAM, &[amplitude, forces], "has another amplitude in this step");
    let spread = ("*CLOAD\n2, 3, 5.", "*DLOAD\nrod, PZ, 5.\n*DLOAD, AMPLITUDE=A\nrod, PZ, 1.");
    refuses(BEAM, &[amplitude, spread], "has another amplitude in this step");
    let sum = ("*CLOAD\n2, 3, 5.", "*CLOAD\n2, 3, 5.\ntip, 3, 1.");
    has(BEAM, &[sum], None, "force = [0.0, 0.0, 6.0]\n");
}

/// Modes count a load before them with NLGEOM in Abaqus, and with PERTURBATION in CalculiX.
#[test]
fn modes_and_what_they_see() {
    let modes = |step: &str| format!("*END STEP\n*STEP{step}\n*FREQUENCY\n4\n*END STEP\n");
    let first = |text: &str, dialect| {
        let made = imported_from(text, Some(dialect));
        assert_eq!(refusals(&made), [""; 0]);
        tables(&made.deck).find("kind = \"modal\"").unwrap() < tables(&made.deck).find("kind = \"static\"").unwrap()
    };
    let (plain, perturbed) =
        (edited(BEAM, &[("*END STEP\n", &modes(""))]), edited(BEAM, &[("*END STEP\n", &modes(", PERTURBATION"))]));
    assert!(
        !first(&plain, Dialect::Abaqus) && first(&plain, Dialect::Calculix) && !first(&perturbed, Dialect::Calculix)
    );
    assert!(first(&plain.replace("*STEP, NLGEOM", "*STEP"), Dialect::Abaqus));
    refuses(&plain, &[], "modes see the load before them");
    has(
        BEAM,
        &[("*STATIC\n0.5, 1.\n*CLOAD\n2, 3, 5.", "*FREQUENCY\n4")],
        None,
        "[analysis]\nkind = \"modal\"\nmodes = 4\n",
    );
    has(BEAM, &[("*STATIC\n0.5, 1.", "*BUCKLE\n3")], None, "[analysis]\nkind = \"buckling\"\nmodes = 3\n");
}

#[test]
fn springs_of_other_kinds() {
    let with = |lines: &'static str| [("*BOUNDARY", lines)];
    let curve = "*ELEMENT, TYPE=SPRINGA, ELSET=k\n5, 2, 9\n*SPRING, ELSET=k, NONLINEAR\n\n-4., -1.\n0., 0.\n8., 1.\n*BOUNDARY\n9, 1, 3";
    has(
        BEAM,
        &with(curve),
        None,
        "law = \"table\"\npoints = [[-2001.0, -4.0], [-1.0, -4.0], [0.0, 0.0], [1.0, 8.0], [2001.0, 8.0]]\n",
    );
    let ground = "*ELEMENT, TYPE=SPRING1, ELSET=k\n5, 2\n*SPRING, ELSET=k\n3\n7.\n*BOUNDARY";
    has(
        BEAM,
        &with(ground),
        None,
        "from = { ground = [1.0, 0.0, 0.0] }\nto = { node = \"mesh.2\" }\nbushing = [0.0, 0.0, 7.0, 0.0, 0.0, 0.0]\n",
    );
}

#[test]
fn bodies_and_couplings() {
    let with = |lines: &'static str| [("*BOUNDARY", lines), ("*CLOAD\n2,", "*CLOAD\n9,")];
    has(
        BEAM,
        &with("*RIGID BODY, PIN NSET=tip, REF NODE=9\n*BOUNDARY"),
        None,
        "nodes = \"tip\"\ndofs = \"translations\"\n",
    );
    // The mass of two points: at their centre, with their arms.
    let masses = "*NSET, NSET=both\n2, 3\n*ELEMENT, TYPE=MASS, ELSET=w\n5, 2\n6, 9\n*MASS, ELSET=w\n3.\n*RIGID BODY, NSET=tip, REF NODE=9\n*BOUNDARY";
    let wanted = "center = [0.5, 0.0, 0.5]\nmass = 6.0\ninertia = [1.5, 3.0, 1.5, 0.0, 0.0, 1.5]\n";
    has(BEAM, &with(masses), None, wanted);
    // In CalculiX the rotations are displacements of a node of their own.
    let turned = [
        ("*BOUNDARY", "*NODE\n8, 0., 0., 1.\n*RIGID BODY, NSET=tip, REF NODE=9, ROT NODE=8\n*BOUNDARY"),
        ("*CLOAD\n2, 3, 5.", "*CLOAD\n8, 2, 5."),
    ];
    has(BEAM, &turned, None, "at = \"mesh.9\"\nmoment = [0.0, 5.0, 0.0]\n");
}

#[test]
fn constraints_of_points() {
    let with = |lines: &'static str| {
        [
            ("*BOUNDARY", lines),
            ("9, 0., 0., 1.", "9, 1., 0., 0.\n8, 2., 0., 0."),
            ("\n1, 1, 2\n", "\n1, 1, 2\n2, 9, 8\n"),
        ]
    };
    let made = imported(&edited(BEAM, &with("*MPC\nTIE, 9, 2\n*BOUNDARY")));
    assert_eq!(refusals(&made), [""; 0]);
    assert!(made.mesh.contains("1, 1, 2\n2, 2, 8\n") && !made.mesh.contains("\n9, "), "{}", made.mesh);
    let pinned = "[[joints]]\nname = \"pin_9_2\"\nkind = \"spherical\"\nfrom = { node = \"mesh.9\" }\nto = { node = \"mesh.2\" }\n";
    has(BEAM, &with("*MPC\nPIN, 9, 2\n*BOUNDARY"), None, pinned);
    // Nodes apart have the same displacements, in each direction.
    for dof in ["ux", "uy", "uz"] {
        let alike = format!(
            "terms = [{{ node = \"mesh.2\", dof = \"{dof}\", factor = -1.0 }}, {{ node = \"mesh.8\", dof = \"{dof}\", factor = 1.0 }}]\n"
        );
        has(BEAM, &with("*MPC\nPIN, 8, 2\n*BOUNDARY"), None, &alike);
    }
    has(BEAM, &with("*MPC\nLINK, 9, 8\n*BOUNDARY"), Some(Dialect::Abaqus), "kind = \"distance\"\n");
    refuses(BEAM, &with("*MPC\nBEAM, 9, 8\n*BOUNDARY"), "say --from abaqus or --from calculix");
    refuses(BEAM, &with("*MPC\nTIE, 8, 2\n*BOUNDARY"), "lie apart");
    refuses(BEAM, &with("*MPC\nSLIDER, 8, 2, 1\n*BOUNDARY"), "constraints of type SLIDER are not translated");
    let equations = |dofs: &str| {
        let lines = dofs.split(' ').map(|dof| format!("2\n9, {dof}, 1., 2, {dof}, -1.\n"));
        format!("*EQUATION\n{}*BOUNDARY", lines.collect::<String>())
    };
    let merged = imported(&edited(BEAM, &[("*BOUNDARY", &equations("1 2 3 4 5 6")), with("")[1], with("")[2]]));
    assert!(merged.mesh.contains("1, 1, 2\n2, 2, 8\n"), "{}", merged.mesh);
    let hinge =
        "kind = \"revolute\"\nfrom = { node = \"mesh.2\" }\nto = { node = \"mesh.9\" }\naxis = [0.0, 1.0, 0.0]\n";
    has(BEAM, &[("*BOUNDARY", &equations("1 2 3 4 6")), with("")[1], with("")[2]], None, hinge);
}

#[test]
fn connectors() {
    let with = |kind: &str, more: &str| {
        let orientation = "*ORIENTATION, NAME=o\n0., 1., 0., 0., 0., 1.\n";
        let section = format!(
            "*ELEMENT, TYPE=CONN3D2, ELSET=c\n7, 2, 9\n{orientation}*CONNECTOR SECTION, ELSET=c, BEHAVIOR=b\n{kind}\no\n"
        );
        edited(
            BEAM,
            &[
                ("*BOUNDARY", &format!("{section}*CONNECTOR BEHAVIOR, NAME=B\n{more}*BOUNDARY\n9, 1, 6")),
                ("9, 0., 0., 1.", "9, 1., 0., 0."),
            ],
        )
    };
    let plain = [
        ("JOIN", "spherical", ""),
        ("HINGE", "revolute", "axis = [0.0, 1.0, 0.0]\n"),
        ("JOIN, REVOLUTE", "revolute", "axis = [0.0, 1.0, 0.0]\n"),
        ("UJOINT", "universal", "axis = [0.0, 1.0, 0.0]\ncross_axis = [1.0, 0.0, 0.0]\n"),
        ("TRANSLATOR", "prismatic", "axis = [0.0, 1.0, 0.0]\n"),
        ("CYLINDRICAL", "cylindrical", "axis = [0.0, 1.0, 0.0]\n"),
        ("PLANAR", "planar", "axis = [0.0, 1.0, 0.0]\n"),
        ("WELD", "fixed", ""),
    ];
    refuses(&with("LINK", ""), &[], "lie at one place");
    refuses(&with("AXIAL", ""), &[], "lie at one place");
    let apart = [("9, 1., 0., 0.", "9, 1., 0., 0.5")];
    let link = "kind = \"distance\"\nfrom = { node = \"mesh.2\" }\nto = { node = \"mesh.9\" }\n";
    has(&with("LINK", ""), &apart, None, link);
    for (kind, word, axis) in plain {
        let joint = format!("kind = \"{word}\"\nfrom = {{ node = \"mesh.2\" }}\nto = {{ node = \"mesh.9\" }}\n{axis}");
        has(&with(kind, ""), &[], None, &joint);
    }
    // The first node carries the slot, and here that is `to`.
    has(&with("SLOT", ""), &[], None, "kind = \"in-line\"\nfrom = { node = \"mesh.9\" }\nto = { node = \"mesh.2\" }\n");
    has(
        &with("HINGE", "*CONNECTOR ELASTICITY, COMPONENT=4\n7.\n*CONNECTOR DAMPING, COMPONENT=4\n8.\n"),
        &[],
        None,
        "stiffness = 7.0\ndamping = 8.0\n",
    );
    // The axis of a slot points the other way.
    let stop = "*CONNECTOR STOP, COMPONENT=1\n-0.2, 0.5\n";
    has(&with("TRANSLATOR", stop), &[], None, "limits = [-0.2, 0.5]\n");
    has(&with("SLOT", stop), &[], None, "limits = [-0.5, 0.2]\n");
    refuses(&with("TRANSLATOR", &stop.replace("-0.2", "0.2")), &[], "begins beyond its stops");
    refuses(&with("TRANSLATOR", stop), &[("9, 1., 0., 0.", "9, 1., 0.3, 0.")], "nodes 2 and 9 lie apart");
    refuses(&with("PLANAR", stop), &[], "along component 1");
    let both = "*CONNECTOR ELASTICITY, COMPONENT=1\n7.\n*CONNECTOR ELASTICITY, COMPONENT=4\n7.\n";
    refuses(&with("CYLINDRICAL", both), &[], "two components have a behaviour");
    refuses(&with("HINGE", "*CONNECTOR ELASTICITY, COMPONENT=1\n7.\n"), &[], "along component 1");
    refuses(&with("FLEXION-TORSION", ""), &[], "FLEXION-TORSION are not translated");
    let bushing = "bushing = [7.0, 0.0, 0.0, 0.0, 0.0, 0.0]\nbushing_damping = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]\naxes = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n";
    has(&with("CARTESIAN, CARDAN", "*CONNECTOR ELASTICITY, COMPONENT=1\n7.\n"), &[], None, bushing);
    let driven = with("HINGE", "").replace("*CLOAD", "*CONNECTOR MOTION, TYPE=VELOCITY\nc, 4, 3.\n*CLOAD");
    refuses(&driven, &[], "in a static step is not translated");
    has(&driven, &[("*STATIC", "*DYNAMIC")], None, "motion = { velocity = 3.0 }\n");
}

#[test]
fn damping_and_starts() {
    // Materials with and without damping stand side by side.
    let second = "*MATERIAL, NAME=n\n*ELASTIC\n1e9, 0.3\n*MATERIAL, NAME=m\n*DAMPING, BETA=0.2\n";
    has(BEAM, &[("*MATERIAL, NAME=m\n", second)], None, "damping = { alpha = 0.0, beta = 0.2 }\n");
    let start = |value: &str| format!("*INITIAL CONDITIONS, TYPE=DISPLACEMENT\ntip, 3, {value}\n*STEP");
    has(BEAM, &[("*STEP", &start("0."))], None, "[[loads]]");
    refuses(BEAM, &[("*STEP", &start("0.1"))], "move the nodes of the mesh");
}
