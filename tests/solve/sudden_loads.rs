//! Loads of a static analysis that act in full at t = 0, or jump: they are brought on in the step that follows, which closes the balance
//! of work and lets the step be cut.

use crate::solve::statics::{GRAVITY, beam, head};
use crate::support::{node, position, read_deck, run, run_with_warnings};
use rdsolve::model::Model;
use rdsolve::solve::Outcome;

/// A cantilever of 1 m with this load at its end, by this amplitude.
fn cantilever(step: f64, material: &str, load: &str, amplitude: &str) -> String {
    let head = head(step, "").replace("model = \"elastic\"", material);
    format!(
        "{head}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n{}[[supports]]\nat = \"a\"\nfix = \"all\"\n\
         [[loads]]\nat = \"b\"\n{load}\namplitude = \"on\"\n[amplitudes.on]\n{amplitude}\n",
        beam("c", ["a", "b"], 8).replace("[0.0, 1.0, 0.0]", "[0.0, 0.0, 1.0]")
    )
}

/// External work, what is stored and dissipated, and `numerical` at the end; the end of the beam; cuts.
fn end(text: &str) -> ([f64; 3], [f64; 3], usize) {
    let model: Model = read_deck(text);
    let tip = node(&model, "b");
    let done = run(&model, &mut |frame| {
        let energy = frame.derived.energy.as_ref().expect("energies");
        let taken = energy.mechanical + energy.plastic;
        [&[energy.external, taken, energy.numerical][..], &position(&frame.state.nodes[tip])].concat()
    });
    assert!(matches!(done.outcome, Outcome::Done), "{:?}\n{text}", done.outcome);
    let row = done.rows.last().expect("a row");
    ([row[0], row[1], row[2]], [row[3], row[4], row[5]], done.counts.cuts)
}

const ELASTIC: &str = "model = \"elastic\"";
const CONSTANT: &str = "kind = \"constant\"";
const RAMP: &str = "kind = \"ramp\"\nstart = 0.0\nend = 1.0";

/// What a load does that grows with what it moves is stored: ½ F u of a small motion, where F u was counted, half of it as missing.
#[test]
fn the_work_of_a_load_that_acts_at_once_is_stored() {
    for (load, amplitude) in [
        ("force = [0.0, 0.0, -5.0]", CONSTANT),
        ("moment = [0.0, 5.0, 0.0]", CONSTANT),
        ("force = [3.0, 0.0, -5.0]", "kind = \"table\"\npoints = [[0.0, 0.3], [0.4, 0.3], [0.8, 1.0], [1.0, 0.5]]"),
        ("force = [0.0, 0.0, -60.0]", "kind = \"step\"\nstart = 0.5\nend = 2.0"),
    ] {
        for step in [1.0, 0.1] {
            let ([work, taken, missed], ..) = end(&cantilever(step, ELASTIC, load, amplitude));
            // The deflection is cubic in the load by a part of (u/L)² ~ 1e-4, which the mean of two forces misses.
            assert!(
                work > 0.0 && missed.abs() < 1e-3 * work && (work - taken).abs() < 1e-3 * work,
                "{load}: {work} {taken}"
            );
        }
    }
    let weight = format!("{}{GRAVITY}", cantilever(0.5, ELASTIC, "force = [0.0, 0.0, 0.0]", CONSTANT));
    let ([work, _, missed], tip, _) = end(&weight);
    // ρ A g L⁴ / (8 E I), about the strong axis; shear adds 1e-3 of it.
    let (area, inertia) = (0.03 * 0.005, 0.005 * 0.03f64.powi(3) / 12.0);
    let exact = 7850.0 * area * 9.81 / (8.0 * 2.1e11 * inertia);
    assert!(missed.abs() < 1e-3 * work, "{missed} of {work}");
    assert!((tip[2] + exact).abs() < 2e-3 * exact, "{tip:?} {exact}");
}

/// A slender beam far beyond its yield load, 300 N where 176 N begin to yield it: at once and in a hundred steps it ends in one place.
#[test]
fn what_yields_under_its_full_load_is_found_by_cutting_the_step() {
    let steel = "model = \"elastic-plastic\"\nyield_stress = 235e6\nhardening_modulus = 1e9";
    for load in [200.0, 250.0, 300.0] {
        let load = format!("force = [0.0, 0.0, -{load:?}]");
        let (_, slowly, _) = end(&cantilever(0.02, steel, &load, RAMP));
        for step in [1.0, 0.5] {
            let deck = cantilever(step, steel, &load, CONSTANT);
            let ([work, _, missed], at_once, _) = end(&deck);
            let apart = (0..3).map(|i| (slowly[i] - at_once[i]).abs()).fold(0.0, f64::max);
            // Load grows in one sense only, so the path counts for what the strains of a step turn: 1e-4 of the deflection.
            assert!(apart < 1e-4, "{load}: {at_once:?} {slowly:?}");
            // Few steps over a curve of load against deflection that bends miss some of its work, and say so.
            let said = run_with_warnings(&deck).1.iter().any(|warning| warning.contains("work"));
            assert!(missed.abs() < 0.04 * work || said, "{load}: {missed} of {work}");
        }
    }
}

/// The loads at the end of the first step are those of the deck to the last bit, so a step that is not cut ends as it always did.
#[test]
fn a_step_that_is_not_cut_ends_under_the_loads_of_the_deck() {
    let load = "force = [0.0, 0.0, -7.3]";
    let (_, constant, cuts) = end(&cantilever(1.0, ELASTIC, load, CONSTANT));
    let (_, ramp, _) = end(&cantilever(1.0, ELASTIC, load, RAMP));
    assert_eq!((constant, cuts), (ramp, 0));
}
