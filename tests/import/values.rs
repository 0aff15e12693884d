//! Decks that were imported give values known otherwise.

use super::{deck, imported, refusals};
use crate::support;
use import::Imported;
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::{Frame, Outcome};
use std::path::Path;

/// Displacement and rotation vector of a node at the end of a deck that has been imported; and the largest displacement along x.
pub fn moves(text: &str, node: &str) -> ([f64; 3], f64) {
    let made = imported(text);
    assert_eq!(refusals(&made), [""; 0]);
    let folder = tempfile::tempdir().unwrap();
    let models = support::read_stages(&source_of(&made, folder.path()));
    let at = support::node(&models[0], node);
    let start = models[0].nodes[at].x;
    let from_start = &mut |frame: &Frame| (frame.state.nodes[at].x - start).as_slice().to_vec();
    let done = support::run_source(&source_of(&made, folder.path()), from_start);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    let last = done.rows.last().unwrap();
    let most = done.rows.iter().map(|row| row[0]).fold(0.0, f64::max);
    ([last[0], last[1], last[2]], most)
}

/// The model of a deck that has been made.
pub fn model_of(made: &Imported) -> Model {
    let folder = tempfile::tempdir().unwrap();
    let source = source_of(made, folder.path());
    let (model, said) = model::read(&source);
    model.unwrap_or_else(|| panic!("{}\n{}", said[0].draw(&source, false), made.deck))
}

/// A deck that has been made, with its mesh in a folder.
fn source_of(made: &Imported, folder: &Path) -> Source {
    std::fs::write(folder.join("a.mesh.inp"), &made.mesh).unwrap();
    Source::new(folder.join("a.toml").display().to_string(), made.deck.as_str(), &[])
}

pub fn near(value: f64, wanted: f64, tolerance: f64) {
    assert!((value / wanted - 1.0).abs() < tolerance, "{value} for {wanted}");
}

/// P L³/(3 E I) and shear of a tube as a pre-processor writes it, with the shear area that Saint-Venant's theory gives; at large
/// displacements the tip sinks less by the square of its slope, 2e-3 times 3/5.
#[test]
fn tube_of_a_pre_processor() {
    near(moves(&deck("beam_pipe"), "mesh.2").0[2], -258.56, 2e-3);
}

/// M L²/(2 E I) at the free edge, and beyond it M L/(E I) times the arm; Poisson's ratio is zero. At large rotations of 6e-3 both sink
/// less by the square of it over 12.
#[test]
fn a_rigid_edge_turned_by_a_moment() {
    near(moves(&deck("rigid_edge"), "mesh.32").0[2], -2.857135e-3, 1e-5);
    near(moves(&deck("rigid_edge"), "mesh.100").0[2], -3.999986e-3, 1e-5);
}

/// Two strips with stiff ends, as PrePoMax writes them. The first is pulled beside its mid-surface: F L/(E A) and the constant curvature
/// F e/(E I), which elements have exactly. The second is a cantilever with shear; rows of nodes 10 apart hold its end, and the strip between
/// them bends under the moment there. Its elements have constant curvature, which misses h²/12 over the square of the arm.
#[test]
fn brackets_of_a_pre_processor() {
    let (bending, length, arm) = (210_000.0 * 20.0 * 8.0 / 12.0, 200.0, 50.0);
    let slope = 100.0 * 1.0 * length / bending;
    let moved = moves(&deck("two_brackets"), "mesh.201").0;
    near(moved[2], -slope * (0.5 * length + arm), 1e-8);
    near(moved[0], 100.0 * length / (210_000.0 * 40.0) + slope * 1.0, 1e-8);
    let (shear, rows) = (5.0 / 6.0 * 105_000.0 * 40.0, 10.0);
    let sunk = (0.5 * length * length * (length + arm) - length.powi(3) / 6.0) / bending + length / shear;
    let slope = (length * (length + arm) - 0.5 * length * length) / bending;
    let end = arm * rows / (3.0 * bending) + arm / rows / shear;
    near(moves(&deck("two_brackets"), "mesh.203").0[2], sunk + (slope + end) * arm, 1e-3);
}

/// Two beams at a right angle, one an instance that is turned: bending of both and torsion of the first.
#[test]
fn instances_that_are_joined() {
    near(moves(&deck("two_instances"), "mesh.15").0[2], 2.021035e-3, 1e-3);
}

/// A mass on a spring and a damper, pulled at once: F/k (1 − exp(−d t) (cos w t + d/w sin w t)) with k = 200, m = 2, c = 4.
#[test]
fn an_oscillator() {
    let (decay, rate) = (1.0, (100.0_f64 - 1.0).sqrt());
    let at = |t: f64| 1.0 / 200.0 * (1.0 - (-decay * t).exp() * ((rate * t).cos() + decay / rate * (rate * t).sin()));
    let (end, most) = moves(&deck("oscillator"), "mesh.2");
    // Trapezoidal steps of a hundredth of the angle err by its square over 12.
    near(end[0], at(0.5), 1e-4);
    near(most, at(std::f64::consts::PI / rate), 1e-4);
}

/// A rod of two elements, one of them an instance to which the other is tied: P L³/(3 E I) and the shear of a rectangle.
#[test]
fn unusual_lines() {
    near(moves(&deck("syntax"), "mesh.3").0[2], -7.9390e-4, 1e-3);
}
