//! Shear areas of sections: deflections of a short cantilever across both axes, elastic and of fibres.

use crate::support::{read_deck, run};
use rdsolve::solve::Outcome;

const E: f64 = 210e9;
const NU: f64 = 0.3;
const LENGTH: f64 = 0.4;
const FORCE: f64 = 100.0;

/// Whether a cantilever of a section bends across y and z as P L³/3EI + P L/(k G A) says; `section`: its shape and keys, `model`: of the
/// material, `shear`: both areas.
fn bends(section: &str, model: &str, shear: [f64; 2], moments: [f64; 2]) {
    let [Iy, Iz] = moments;
    let value = |I: f64, area: f64| FORCE * LENGTH * (LENGTH * LENGTH / (3.0 * E * I) + 2.0 * (1.0 + NU) / (E * area));
    let expect = |quantity: &str, value: f64| {
        format!("[[expect]]\nat = \"b\"\nquantity = \"{quantity}\"\ntime = 1.0\nvalue = {value}\ntolerance = 1e-6\n")
    };
    let deck = format!(
        "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 1.0 }}\n\
         points = {{ a = [0.0, 0.0, 0.0], b = [{LENGTH}, 0.0, 0.0] }}\nsupports = [{{ at = \"a\", fix = \"all\" }}]\n\
         [materials.m]\n{model}\nyoungs_modulus = {E}\npoisson_ratio = {NU}\n[sections.s]\n{section}\n\
         [[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nelements = 2\nmaterial = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n\
         [[loads]]\nat = \"b\"\nforce = [0.0, {FORCE}, {FORCE}]\n{}{}",
        expect("uy", value(Iz, shear[0])),
        expect("uz", value(Iy, shear[1])),
    );
    let done = run(&read_deck(&deck), &mut |_| Vec::new());
    assert!(matches!(done.outcome, Outcome::Done));
    for verdict in &done.verdicts {
        assert!(verdict.passed, "{section} {model} {}: {:?}", verdict.label, verdict.reason);
    }
}

/// Deflections of 1e-5 of the length are linear to 1e-9; C = 9.636961 of 4 : 1 and 1e-3 of 1 : 4 come from the series in the unit tests.
#[test]
fn flat_rectangles_deflect_by_saint_venant() {
    let (b, h): (f64, f64) = (0.2, 0.05);
    let (A, moments) = (b * h, [b * h.powi(3) / 12.0, h * b.powi(3) / 12.0]);
    let share = (NU / (1.0 + NU)).powi(2);
    let flat = A / (1.2 + share * 9.636_961);
    // r⁴ (1/5 − 18 r/π⁵ ζ(5)) at r = 1/4, where tanh is 1 to 1e-11.
    let upright =
        A / (1.2 + share * 0.25_f64.powi(4) * (0.2 - 4.5 / std::f64::consts::PI.powi(5) * 1.036_927_755_143_37));
    let shape = format!("shape = \"rectangle\"\nwidth = {b}\nheight = {h}");
    for model in ["model = \"elastic\"", "model = \"elastic-plastic\"\nyield_stress = 1e12"] {
        bends(&shape, model, [upright, flat], moments);
        bends(&format!("{shape}\nshear_factor = 0.8"), model, [0.8 * A; 2], moments);
        bends(&format!("{shape}\nshear_factor = [0.9, 0.3]"), model, [0.9 * A, 0.3 * A], moments);
    }
}

/// The full circle of ν = 0.3, and a factor for a box of which the shear flow would say another.
#[test]
fn tubes_and_boxes_too() {
    let share = (NU / (1.0 + NU)).powi(2);
    let (R, PI): (f64, f64) = (0.05, std::f64::consts::PI);
    let (A, I) = (PI * R * R, PI / 4.0 * R.powi(4));
    let round = format!("shape = \"tube\"\nradius = {R}\nthickness = {R}");
    let cell = "shape = \"box\"\nwidth = 0.1\nheight = 0.1\nthickness = 0.01\nshear_factor = 0.4";
    let (A_cell, I_cell) = (0.01 - 0.08 * 0.08, (0.1_f64.powi(4) - 0.08_f64.powi(4)) / 12.0);
    for model in ["model = \"elastic\"", "model = \"elastic-plastic\"\nyield_stress = 1e12"] {
        bends(&round, model, [6.0 * A / (7.0 + share); 2], [I; 2]);
        bends(cell, model, [0.4 * A_cell; 2], [I_cell; 2]);
    }
}
