//! Unilateral contact against closed forms.

mod edges;
mod element;
mod impact;
mod rubbing;

use crate::support::{Done, run_to_the_end};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::Frame;

/// The model of a deck.
pub fn read(text: &str) -> Model {
    let source = Source::new("deck.toml", text, &[]);
    let (model, problems) = model::read(&source);
    model
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

/// Runs it to its end.
pub fn go(text: &str, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Done {
    run_to_the_end(&read(text), probe)
}
