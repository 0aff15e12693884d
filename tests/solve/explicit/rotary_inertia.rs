//! Central differences by default: rotary inertia of thin parts is raised without mass, so that thickness does not govern the step.

use super::mass_scaling::spectrum;
use super::scenes::{AUTO, dynamic};
use super::{balance_of, scene};
use crate::support::{node, run_to_the_end};
use rdsolve::model::Model;
use rdsolve::system::{System, added_at, governing};
use std::f64::consts::PI;

const STEEL: &str =
    "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 200e9\npoisson_ratio = 0.3\ndensity = 8000.0\n";
const DENSITY: f64 = 8000.0;
const OFF: &str = "integrator.mass_scaling=\"off\"";
const ELEMENTS: usize = 24;

fn head(end_time: f64) -> String {
    dynamic(end_time, AUTO, "central-difference") + STEEL
}

/// A beam of length 1 in 24 elements on two pins, which bends in the plane of x and z.
fn beam(end_time: f64) -> String {
    head(end_time)
        + &format!(
            "[sections.s]\nshape = \"rectangle\"\nwidth = 0.01\nheight = 0.01\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n\
             [[beams]]\nname = \"part\"\npath = [\"a\", \"b\"]\nelements = {ELEMENTS}\norder = 1\nmaterial = \"steel\"\nsection = \"s\"\n\
             orientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = [\"a\", \"b\"]\nfix = \"translations\"\n\
             [[supports]]\nat = \"part\"\nfix = [\"ux\", \"uy\", \"rx\", \"rz\"]\n"
        )
}

/// A plate that bends into a cylinder, likewise.
fn plate(end_time: f64) -> String {
    let width = 1.0 / ELEMENTS as f64;
    head(end_time)
        + &format!(
            "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, {width}, 0.0]\nd = [0.0, {width}, 0.0]\n[[shells]]\n\
             name = \"part\"\nmaterial = \"steel\"\nthickness = 0.002\ncorners = [\"a\", \"b\", \"c\", \"d\"]\n\
             elements = [{ELEMENTS}, 1]\n[[supports]]\nat = [\"part.edge2\", \"part.edge4\"]\nfix = \"translations\"\n\
             [[supports]]\nat = \"part\"\nfix = [\"ux\", \"uy\", \"rx\", \"rz\"]\n"
        )
}

/// The first three frequencies of a beam and of a plate on pins, (k π)² √(EI/m): waves of 48, 24 and 16 elements. The steps are those that
/// membranes and bars have.
#[test]
fn first_frequencies_change_by_less_than_a_hundredth() {
    let slender = (200e9 * 0.01f64.powi(2) / 12.0 / DENSITY).sqrt();
    let thin = (200e9 / (1.0 - 0.09) * 0.002f64.powi(2) / 12.0 / DENSITY).sqrt();
    for (text, stiffness, gain) in [(beam(1e-3), slender, 3.0), (plate(1e-3), thin, 20.0)] {
        let [raised, own] = [scene(&text, &[]), scene(&text, &[OFF])];
        let step = |model: &Model| governing(model, &System::new(model).unwrap()).unwrap().step;
        let found = [&raised, &own].map(spectrum);
        let ratio = step(&raised) / step(&own);
        println!("step {ratio:.1} times as long");
        assert!(ratio > gain, "{ratio}");
        for k in 1..=3 {
            let exact = (k as f64 * PI).powi(2) * stiffness;
            let [with, without] = [0, 1].map(|i| found[i][k - 1].sqrt());
            println!("mode {k}: {:.5} of the closed form, without {:.5}", with / exact, without / exact);
            assert!(
                (with / exact - 1.0).abs() < 0.01 && (with / without - 1.0).abs() < 0.01,
                "{k}: {with} {without} {exact}"
            );
        }
    }
}

/// The beam starts in each of its modes: after a period of the closed form it is back, within the phase that a hundredth of the frequency
/// makes, and energy is closed.
#[test]
fn a_beam_swings_in_its_modes_in_the_time_of_the_closed_form() {
    for k in 1..=3 {
        let omega = (k as f64 * PI).powi(2) * (200e9 * 0.01f64.powi(2) / 12.0 / DENSITY).sqrt();
        let bare = scene(&beam(2.0 * PI / omega), &["output.every=1"]);
        let mut text = beam(2.0 * PI / omega);
        let labels: Vec<(String, f64)> = bare.nodes.iter().map(|node| (node.label.clone(), node.x.x)).collect();
        for (label, x) in labels.iter().filter(|(_, x)| *x > 0.01 && *x < 0.99) {
            let v = 1e-3 * omega * (k as f64 * PI * x).sin();
            text += &format!("[[initial]]\nat = \"{label}\"\nvelocity = [0.0, 0.0, {v:e}]\n");
        }
        let model = scene(&text, &["output.every=1"]);
        let (label, x) = labels.iter().find(|(_, x)| (x - 1.0 / (2 * k) as f64).abs() < 0.5 / ELEMENTS as f64).unwrap();
        let (at, shape) = (node(&model, label), (k as f64 * PI * x).sin());
        let rows = run_to_the_end(&model, &mut |frame| vec![frame.state.time, frame.state.nodes[at].x.z]).rows;
        let off = |row: &Vec<f64>| (row[1] / (1e-3 * shape) - (omega * row[0]).sin()).abs();
        let worst = rows.iter().map(off).fold(0.0, f64::max);
        println!("mode {k}: {worst:.4}");
        // A phase of 2 π times 0.9 % at the end of the period, and the shear that the start leaves out.
        assert!(worst < 2.0 * PI * 0.01, "{k}: {worst}");
        let balance = balance_of(&model);
        assert!(balance.generated.max(balance.dissipated) < 1e-3 * balance.available, "{balance:?}");
    }
}

/// A free plate of n × n elements that spins. Its moment of inertia about the normal is M a²/6; nodes with the masses of elements around have
/// 1 + 2/n² times it, and the raised rotary inertia adds M h²/8 = 0.75/n² of it: less than the mesh. Angular momentum is conserved.
#[test]
fn a_free_plate_keeps_its_angular_momentum() {
    let n = 8;
    let text = head(2e-3)
        + &format!(
            "[output]\nevery = 50\nenergy = true\n[points]\na = [0.0, 0.0, 0.0]\nb = [0.4, 0.0, 0.0]\nc = [0.4, 0.4, 0.0]\nd = [0.0, 0.4, 0.0]\n\
             [[shells]]\nname = \"plate\"\nmaterial = \"steel\"\nthickness = 0.004\ncorners = [\"a\", \"b\", \"c\", \"d\"]\n\
             elements = [{n}, {n}]\n[[initial]]\nat = \"plate\"\nangular_velocity = [0.0, 0.0, 500.0]\n"
        );
    let momenta = |sets: &[&str]| {
        let model = scene(&text, sets);
        run_to_the_end(&model, &mut |frame| {
            frame.derived.energy.map(|energy| energy.l.iter().copied().collect()).unwrap()
        })
        .rows
    };
    let (raised, own) = (momenta(&[]), momenta(&[OFF, "analysis.end_time=1e-5"]));
    let more = raised[0][2] / own[0][2] - 1.0;
    // M h²/8 over M a²/6 (1 + 2/n²); the deck's ρ t³/12 is less than a hundredth of it.
    let predicted = 0.75 / (n * n) as f64 / (1.0 + 2.0 / (n * n) as f64);
    println!("angular momentum larger by {:.4} %, predicted {:.4} %", 100.0 * more, 100.0 * predicted);
    assert!((more / predicted - 1.0).abs() < 0.01, "{more} {predicted}");
    let size = raised[0][2].abs();
    let drift = raised.iter().flat_map(|row| (0..3).map(|i| (row[i] - raised[0][i]).abs())).fold(0.0, f64::max);
    println!("drift {:.1e}", drift / size);
    // Central differences of shells keep angular momentum but for rounding of a thousand steps.
    assert!(drift < 1e-9 * size, "{drift} {size}");
}

/// What turns with a body keeps its rotary inertia, and so does the body.
#[test]
fn bodies_and_what_is_attached_to_them_keep_their_inertia() {
    let text = plate(1e-3).split("[[supports]]").next().unwrap().to_owned()
        + "[[bodies]]\nname = \"hub\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1e-4, 1e-4, 1e-4]\n[[attachments]]\n\
           body = \"hub\"\nnodes = [\"part.edge4\"]\n";
    let text = text.replace("thickness = 0.002", "thickness = 0.002\nmass = \"lumped\"");
    let [raised, own] = [scene(&text, &[]), scene(&text, &[OFF])];
    let [of_raised, of_own] = [&raised, &own].map(|model| System::new(model).unwrap().inertias);
    let held = ["hub", "a", "d"].map(|label| node(&raised, label));
    for (with, without) in of_raised.iter().zip(&of_own) {
        let is_held = held.contains(&with.node);
        assert_eq!((with.node, with.mass), (without.node, without.mass));
        assert_eq!(with.J0 == without.J0, is_held, "{}", raised.nodes[with.node].label);
    }
}

/// `mass_scaling_step` at twice the step: each element needs four times its mass.
#[test]
fn mass_that_longer_steps_would_add() {
    let model = scene(&plate(1e-3), &[]);
    let system = System::new(&model).unwrap();
    let found = governing(&model, &system).unwrap();
    let mass = DENSITY * 0.002 / ELEMENTS as f64;
    let added = added_at(&model, &system, 2.0 * found.step);
    println!("{added} of {mass}");
    // Equal elements; rounding of eigenvalues.
    assert!((added / (3.0 * mass) - 1.0).abs() < 1e-9, "{added} {mass}");
    assert_eq!(added_at(&model, &system, 0.999 * found.step), 0.0);
}
