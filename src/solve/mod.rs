//! The march through time. `solve` shows each accepted step to an [`Observer`]; it knows nothing of files.

use crate::model::Model;
use crate::state::State;
use crate::system::energy::Energy;

/// One accepted step, read-only.
pub struct Frame<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    /// 0 at t = 0.
    pub step: usize,
    /// Length of the step that led here; 0 at t = 0.
    pub dt: f64,
    pub iterations: usize,
    pub refactorizations: usize,
    /// Relative residual at acceptance.
    pub residual: f64,
    /// Times the step was cut before it was accepted.
    pub cuts: usize,
    /// True when the output cadence asks for this step; t = 0 and the last step always are.
    pub due: bool,
    /// Present when `due` and energies are wanted.
    pub energy: Option<&'a Energy>,
    /// In the order of [`Model::held`]; force or moment on the structure, global components. Present when wanted.
    pub reactions: &'a [f64],
}

/// Whoever watches a run. Errors are input/output errors; they end the run with exit code 6.
pub trait Observer {
    fn see(&mut self, frame: &Frame) -> std::io::Result<()>;
}
