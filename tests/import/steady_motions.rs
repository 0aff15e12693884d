//! `*STEADY STATE DYNAMICS` and `*MODAL DAMPING`: amplitudes and phases known otherwise, and rows of the mapping.

use super::command::{folder, rdsolve};
use super::rows::{BEAM, edited, has, refuses};
use super::{deck, imported_from, reasons, refusals, tables};
use import::{Dialect, KeywordVerdict};
use std::f64::consts::TAU;

/// Frequency, amplitude and phase in radians of node 2 along x.
fn response(text: &str) -> Vec<[f64; 3]> {
    let folder = folder(&[("a.inp", text)]);
    let (code, _, problems) = rdsolve(folder.path(), &["a.inp", "--quiet", "--from", "calculix"]);
    assert_eq!(code, 0, "{problems}");
    let mut table = csv::Reader::from_path(folder.path().join("a.out/response.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|known| known == name).unwrap();
    let [node, frequency, size, phase] = ["node", "frequency", "ux", "ux_phase"].map(column);
    let rows = table.records().map(Result::unwrap).filter(|row| &row[node] == "mesh.2");
    let number = |text: &str| text.parse::<f64>().unwrap();
    rows.map(|row| [number(&row[frequency]), number(&row[size]), number(&row[phase]).to_radians()]).collect()
}

/// A mass on a spring: u = (a + i b)/(k − m w² + i w c). One mode is all there is, so that modes and equations agree.
#[test]
fn a_mass_on_a_spring() {
    let plain = deck("steady");
    let ratio = 0.1;
    let by_ratio = edited(&plain, &[("*MODAL DAMPING, RAYLEIGH\n, , 4., 0.", "*MODAL DAMPING\n1, 1, 0.1")]);
    let direct = edited(
        &plain,
        &[("*FREQUENCY\n1\n*END STEP\n*STEP\n*STEADY STATE DYNAMICS", "*STEADY STATE DYNAMICS, DIRECT")],
    );
    for (text, damping) in [(&plain, 4.0), (&by_ratio, 2.0 * ratio * 20.0), (&direct, 4.0)] {
        let found = response(text);
        assert!(found.len() >= 3, "{found:?}");
        for [frequency, size, phase] in found {
            let w = TAU * frequency;
            let (real, imaginary) = (400.0 - w * w, w * damping);
            let wanted = 34.0_f64.sqrt() / real.hypot(imaginary);
            let angle = 5.0_f64.atan2(3.0) - imaginary.atan2(real);
            // Both are solutions of one equation, up to rounding of the mode.
            assert!((size / wanted - 1.0).abs() < 1e-9 && (phase - angle).abs() < 1e-9, "{frequency}: {size} {phase}");
        }
    }
}

/// The ground moves by its acceleration: u = −a/(w0² − w² + i w c), relative to it. A support moves by its displacement.
#[test]
fn moved_supports() {
    let loads = "*CLOAD\n2, 1, 3.\n*CLOAD, LOAD CASE=2\n2, 1, 5.\n";
    let base = "*AMPLITUDE, NAME=A\n0., 7., 9., 7.\n*PHYSICAL";
    let moved = [("*PHYSICAL", base), (loads, "*BASE MOTION, DOF=1, AMPLITUDE=a\n")];
    for [frequency, size, _] in response(&edited(&deck("steady"), &moved)) {
        let w = TAU * frequency;
        let wanted = 7.0 / (400.0 - w * w).hypot(4.0 * w);
        assert!((size / wanted - 1.0).abs() < 1e-9, "{frequency}: {size}"); // rounding of the mode
    }
    let text = edited(&deck("steady"), &[("*PHYSICAL", base), (loads, "*BASE MOTION, DOF=1, AMPLITUDE=A\n")]);
    assert!(
        reasons(&imported_from(&text, None), KeywordVerdict::Changed)
            .iter()
            .any(|how| how.contains("CalculiX adds its motion"))
    );
    let varies = edited(&text, &[("0., 7., 9., 7.", "0., 7., 9., 8.")]);
    refuses(&varies, &[], "one value at all frequencies");
    // Damping of masses acts on velocities relative to the support: u − s = w² s/(w0² − w² + i w c).
    for [frequency, size, _] in response(&edited(&deck("steady"), &[(loads, "*BOUNDARY\n1, 1, 1, 0.1\n")])) {
        let w = TAU * frequency;
        let (real, imaginary) = (400.0 - w * w, 4.0 * w);
        let wanted = 0.1 * (400.0_f64.hypot(imaginary)) / real.hypot(imaginary);
        assert!((size / wanted - 1.0).abs() < 1e-9, "{frequency}: {size}");
    }
}

/// What becomes of each form.
#[test]
fn rows_of_steady_motions() {
    let step = |keyword: &str, data: &str| {
        edited(BEAM, &[("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n", &format!("*STEP\n{keyword}\n{data}\n"))])
    };
    let calculix = Some(Dialect::Calculix);
    let range = "frequencies = { from = 1.0, to = 2.0, steps = 20, around_resonances = 10 }\nmethod = \"modal\"\n";
    has(&step("*STEADY STATE DYNAMICS", "1., 2."), &[], calculix, range);
    has(&step("*STEADY STATE DYNAMICS", "1., 1."), &[], calculix, "frequencies = 1.0\nmethod = \"modal\"\n");
    let direct = "frequencies = { from = 1.0, to = 2.0, steps = 5, spacing = \"logarithmic\" }\n";
    has(&step("*STEADY STATE DYNAMICS, DIRECT", "1., 2., 5"), &[], Some(Dialect::Abaqus), direct);
    let linear = "*STEADY STATE DYNAMICS, DIRECT, FREQUENCY SCALE=LINEAR";
    has(&step(linear, "1., 2., 5"), &[], Some(Dialect::Abaqus), "{ from = 1.0, to = 2.0, steps = 5 }\n");
    has(&step(linear, "1., 2., 5"), &[], calculix, "[amplitudes.real]\nkind = \"harmonic\"\n");
    let phased = edited(&step(linear, "1., 2., 5"), &[("*CLOAD", "*CLOAD, IMAGINARY")]);
    has(&phased, &[], calculix, "force = [0.0, 0.0, 5.0]\namplitude = \"imaginary\"\n");
    has(&phased, &[], calculix, "[amplitudes.imaginary]\nkind = \"harmonic\"\nphase_degrees = 90.0\n");
    for (keyword, data, why) in [
        ("*STEADY STATE DYNAMICS, HARMONIC=NO", "1., 2.", "loads are harmonic in rdsolve"),
        ("*STEADY STATE DYNAMICS", "2., 1.", "must not be below the lowest"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n3., 4.", "one line with its lowest"),
        (linear, "1., 2.\n*MODAL DAMPING\n1, 2, 0.1", "give *MODAL DAMPING, RAYLEIGH"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*MODAL DAMPING\n1, 2, 0.1\n3, 4, 0.2", "all modes have the same damping"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*MODAL DAMPING, STRUCTURAL\n1, 2, 0.1", "no structural damping"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*MODAL DAMPING", "needs values on the line below"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*DLOAD\n, GRAV, 9., 0., 0., -1.", "give *BASE MOTION"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*CLOAD, AMPLITUDE=a\n2, 1, 1.", "depends on the frequency"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*MODAL DAMPING\n1, 2", "needs a damping ratio"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*MODAL DAMPING, VISCOUS=COMPOSITE\n1, 2, 0.1", "composite damping"),
        ("*STEADY STATE DYNAMICS, INTERVAL=SPREAD", "1., 2.", "INTERVAL=SPREAD is not translated"),
        ("*STEADY STATE DYNAMICS", "1., 2., 1e12", "too many frequencies"),
        ("*STEADY STATE DYNAMICS", "1., 2.\n*END STEP\n*STEP\n*STATIC", "nothing excites this step"),
        ("*BUCKLE", "1\n*BOUNDARY, LOAD CASE=2\n2, 2", "modes of buckling have the supports of the loads"),
        ("*STATIC", "1., 1.\n*CLOAD, LOAD CASE=2\n2, 2, 1.", "acts in *STEADY STATE DYNAMICS alone"),
        ("*MODAL DYNAMIC", "1., 1.\n*MODAL DAMPING\n1, 2, 0.1", "computes this step without modes"),
    ] {
        let said = refusals(&imported_from(&step(keyword, data), calculix));
        assert!(said.iter().any(|said| said.contains(why)), "{why} is not in {said:?}");
    }
    for (keyword, data) in [
        ("*STEADY STATE DYNAMICS", "1., 2."),
        ("*STEADY STATE DYNAMICS, FREQUENCY SCALE=LINEAR", "1."),
        ("*STEADY STATE DYNAMICS, FREQUENCY SCALE=LINEAR", "1., 2., 1"),
    ] {
        refuses(&step(keyword, data), &[], "say --from abaqus or --from calculix");
    }
    has(&step(linear, "1., 2., 1"), &[], Some(Dialect::Abaqus), "to = 2.0, steps = 20 }\n");
    has(&step("*STEADY STATE DYNAMICS", "5."), &[], Some(Dialect::Abaqus), "frequencies = 5.0\n");
    let text = |made: &import::Imported| reasons(made, KeywordVerdict::Changed).join(" ");
    let made = imported_from(&step("*STEADY STATE DYNAMICS", "1., 2., 5, 4."), Some(Dialect::Abaqus));
    assert!(text(&made).contains("bias and scale") && text(&made).contains("by equal factors"), "{}", text(&made));
    // Damping of all modes, or of some; that of the material does not act on modes.
    let modes = |data: &str, more: &str| {
        let steps =
            format!("*STEP\n*FREQUENCY\n5\n*END STEP\n*STEP\n*STEADY STATE DYNAMICS\n1., 2.\n*MODAL DAMPING{data}\n");
        let edits = [("*STEP, NLGEOM\n*STATIC\n0.5, 1.\n", &*steps), ("*DENSITY", more)];
        imported_from(&edited(BEAM, &edits), calculix)
    };
    for (data, all) in [
        ("\n1, 5, 0.1", true),
        ("\n1, 2, 0.1\n3, 9, 0.1", true),
        ("\n1, 2, 0.1\n4, 5, 0.1", false),
        ("\n2, 5, 0.1", false),
    ] {
        let made = modes(data, "*DENSITY");
        assert!(tables(&made.deck).contains("damping_ratio = 0.1\n"), "{}", made.deck);
        assert_eq!(!text(&made).contains("not those alone"), all, "{data}");
    }
    let made = modes(", VISCOUS=RAYLEIGH\n1, 5, 0.5, 1e-4", "*DAMPING, ALPHA=3.\n*DENSITY");
    assert!(tables(&made.deck).contains("[damping]\nmass_factor = 0.5\nstiffness_factor = 0.0001\n"), "{}", made.deck);
    assert!(reasons(&made, KeywordVerdict::Ignored).iter().any(|said| said.contains("MODAL DAMPING alone")));
    assert!(!tables(&modes("\n1, 5, 0.1", "*DAMPING, ALPHA=3.\n*DENSITY").deck).contains("[damping]"));
    let rayleigh = step("*MODAL DYNAMIC", "0.1, 1.\n*MODAL DAMPING, RAYLEIGH\n1, 9, 0.3, 0.2");
    has(&rayleigh, &[], None, "[damping]\nmass_factor = 0.3\nstiffness_factor = 0.2\n");
    let both = edited(&rayleigh, &[("*END STEP\n", "*END STEP\n*STEP\n*DYNAMIC\n1., 1.\n*END STEP\n")]);
    refuses(&both, &[], "[damping] holds for all steps");
}

/// After a preload the motion is a stage, with loads of its own.
#[test]
fn about_a_preload() {
    let second = "*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n4\n*END STEP\n*STEP\n*STEADY STATE DYNAMICS\n1., 2.\n*CLOAD\n2, 2, 7.\n*END STEP\n";
    let made = imported_from(&edited(BEAM, &[("*END STEP\n", second)]), Some(Dialect::Calculix));
    assert_eq!(refusals(&made), [""; 0]);
    let found = tables(&made.deck);
    assert!(found.contains("kind = \"frequency-response\"") && found.contains("modes = 4\n"), "{found}");
    assert!(!found.contains("kind = \"modal\""), "{found}");
    assert!(found.contains("force = [0.0, 7.0, 0.0]\namplitude = \"real\"\nstages = \"step_3\"\n"), "{found}");
    super::values::model_of(&made);
}
