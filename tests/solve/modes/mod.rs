//! Modes about a state: against closed forms, against dense eigenvalues of the same matrices, and against motion in time.

mod buckling;
mod closed_forms;
mod critical_speeds;
mod damped;
mod exact;
mod files;
mod joints;
mod motion;
mod response;
mod unbalance;

use crate::support::read_deck;
use rdsolve::model::Model;
use rdsolve::modes::Modes;
use rdsolve::output::wanted;
use rdsolve::plan::Plan;
use rdsolve::solve::{Frame, Observer, Outcome, Run};
use rdsolve::system::System;
use std::io;
use std::sync::atomic::AtomicBool;

#[derive(Default)]
struct Keeper(Option<Modes>);

impl Observer for Keeper {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        self.0 = frame.modes.cloned();
        Ok(())
    }
}

/// How an analysis of modes ends, and the modes.
pub fn outcome(model: &Model) -> (Outcome, Option<Modes>) {
    let system = System::new(model).expect("a system");
    let plan = Plan::new(model, &system, 1);
    let stop = AtomicBool::new(false);
    let mut keeper = Keeper::default();
    let (outcome, _) = Run::new(model, &system, &plan, wanted(model), &stop).unwrap().run(&mut keeper);
    (outcome, keeper.0)
}

/// The modes of a deck.
pub fn modes_of(model: &Model) -> Modes {
    let (outcome, modes) = outcome(model);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    modes.expect("modes")
}

/// The modes of a deck's text.
pub fn modes(text: &str) -> Modes {
    modes_of(&read_deck(text))
}

/// Angular frequencies.
pub fn omegas(modes: &Modes) -> Vec<f64> {
    modes.list.iter().map(|mode| mode.angular_frequency()).collect()
}

/// The largest relative difference of two lists.
pub fn off(found: &[f64], wanted: &[f64]) -> f64 {
    assert!(found.len() >= wanted.len(), "{found:?} {wanted:?}");
    found.iter().zip(wanted).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

/// `[analysis]` of so many modes, steel, and a rectangle of width along y and height along z.
pub fn head(analysis: &str, width: f64, height: f64) -> String {
    let kind = if analysis.contains("kind") { "" } else { "kind = \"modal\"\n" };
    format!(
        "[analysis]\n{kind}{analysis}\n[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\n\
         poisson_ratio = 0.3\ndensity = 7850.0\n[sections.s]\nshape = \"rectangle\"\nwidth = {width:?}\nheight = {height:?}\n"
    )
}
