//! The march through time. `solve` shows each accepted step to an [`Observer`]; it knows nothing of files.

use crate::math::Vec3;
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
    /// In the order of [`Model::links`]. Present when `due` and wanted, and at every step when an expectation watches the
    /// peak of a link.
    pub links: &'a [LinkState],
    /// In deck order, point by point along each beam. Present when `due` and wanted.
    pub sections: &'a [SectionPoint],
}

/// What a link does at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkState {
    /// Of the line, and its rate; 0 for a bushing.
    pub elongation: f64,
    pub rate: f64,
    /// Along the line, tension positive; 0 for a bushing.
    pub force: f64,
    /// On the first end, global components.
    pub f: Vec3,
    pub m: Vec3,
}

/// Section forces at an integration point, in its section axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionPoint {
    /// Index into [`Model::beams`], element of the beam, point of the element.
    pub beam: usize,
    pub element: usize,
    pub point: usize,
    /// Undeformed arc length from the beam's start.
    pub s: f64,
    /// N, Qy, Qz, T, My, Mz.
    pub forces: [f64; 6],
}

/// Whoever watches a run. Errors are input/output errors; they end the run with exit code 6.
pub trait Observer {
    fn see(&mut self, frame: &Frame) -> std::io::Result<()>;
}
