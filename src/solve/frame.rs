//! What a run shows of itself: each accepted step, to an observer that can only read it.

use crate::model::Model;
use crate::state::State;
use crate::system::energy::{Energy, PartEnergy};
use crate::system::results::{LinkState, SectionPoint, ShellState};
use crate::system::{ContactState, JointState};

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
    /// Relative residual at the last evaluation.
    pub residual: f64,
    /// Times the step was cut before it was accepted.
    pub cuts: usize,
    /// True when the output cadence asks for this step; t = 0 and the last step always are.
    pub due: bool,
    /// The run ends with it.
    pub last: bool,
    /// Present when `due` and wanted.
    pub energy: Option<&'a Energy>,
    /// In the order of [`Model::held`]; force or moment on the structure, global components. Empty unless `due` and wanted.
    pub reactions: &'a [f64],
    /// In the order of [`Model::joints`]. Empty unless `due` and wanted.
    pub joints: &'a [JointState],
    /// In the order of the links in [`Model::parts`]. Empty unless `due` and wanted.
    pub links: &'a [LinkState],
    /// In the order of the contacts in [`Model::parts`]. Empty unless `due` and wanted.
    pub contacts: &'a [ContactState],
    /// Largest accumulated plastic strain of each element of all beams, then of all bars and shells, in deck order. Empty
    /// unless `due` or drawn, and wanted.
    pub plastic_strains: &'a [f64],
    /// Of all elements of all shells in deck order. Empty unless `due` or drawn, and wanted.
    pub shells: &'a [ShellState],
    /// Empty unless `due` and wanted.
    pub sections: &'a [SectionPoint],
    /// Of all beams, bars and shells in deck order. Empty unless `due` and wanted.
    pub parts: &'a [PartEnergy],
    /// Indices into [`Model::expects`] of those whose passage this step lands on.
    pub passed: &'a [usize],
    /// Of the last matrix of a step by arc length.
    pub negative_pivots: Option<usize>,
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
