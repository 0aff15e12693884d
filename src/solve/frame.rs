//! What a run shows of itself: each accepted step, to an observer that can only read it.

use super::derived::Derived;
use crate::model::Model;
use crate::state::State;

/// One accepted step, read-only.
pub struct Frame<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    /// Accepted steps so far; 0 at t = 0.
    pub step: usize,
    /// Length of the step that led here; 0 at t = 0.
    pub dt: f64,
    pub iterations: usize,
    pub refactorizations: usize,
    /// Relative residual at the last evaluation.
    pub residual: f64,
    /// Cutbacks before the step was accepted.
    pub cuts: usize,
    /// Of the last matrix of a step by arc length.
    pub negative_pivots: Option<usize>,
    /// True when the output cadence asks for this step; t = 0 and the last step always are.
    pub due: bool,
    /// The run ends with it.
    pub last: bool,
    /// Indices into [`Model::expects`] of those at whose displacement this step ends.
    pub passed: &'a [usize],
    /// In the order of [`Model::held`]; force or moment on the structure, global components. Empty unless `due` and wanted.
    pub reactions: &'a [f64],
    pub derived: &'a Derived,
}

/// Whoever watches a run. Errors are input/output errors; they end the run with exit code 6.
pub trait Observer {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()>;
}

impl Observer for () {
    fn on_step(&mut self, _: &Frame) -> std::io::Result<()> {
        Ok(())
    }
}
