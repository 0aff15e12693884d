//! When the iteration ends: its tolerance, and what earlier steps tell of its contraction.

use super::convergence::Judgement;
use crate::snapshot::keep;

/// Contraction assumed where none was seen.
const UNKNOWN: f64 = 0.5;
/// A contraction that was not seen again is trusted less by this factor with every step.
const TRUST: f64 = 1.5;

/// The end of the iteration.
#[derive(Clone, Copy)]
pub struct Ending {
    /// Relative tolerance of the correction.
    pub tolerance: f64,
    /// Relative tolerance of the residual.
    pub residual: f64,
    /// The tolerance of the deck, below which none goes.
    least: f64,
    /// The contraction seen last; none is carried from step to step where every step is iterated to the digits of the deck.
    contraction: Option<f64>,
    /// True where steps are iterated to a part of their error.
    pub carries: bool,
}

keep!(Ending { tolerance, residual, least, contraction, carries });

impl Ending {
    /// Every step is iterated to this tolerance.
    pub fn new(tolerance: f64) -> Ending {
        Ending { tolerance, residual: tolerance, least: tolerance, contraction: None, carries: false }
    }

    /// Iterates to a part of the error that steps may leave, and takes the contraction of one step for that of the next.
    pub fn follow(&mut self, error: f64) {
        /// The iteration adds little to the error of the step, for its own is of one sign where matrices are kept.
        const PART: f64 = 0.01;
        /// Forces follow the motion: those of stiff parts are far from it long before the motion is, and no step builds on them.
        const PART_OF_FORCES: f64 = 0.1;
        (self.tolerance, self.carries) = (self.least.max(PART * error), true);
        self.residual = self.least.max(PART_OF_FORCES * error);
        self.contraction = None;
    }

    /// The contraction by which the first correction of a step is judged.
    pub fn usual(&self) -> f64 {
        self.contraction.map_or(UNKNOWN, |seen| seen.min(UNKNOWN))
    }

    /// Takes account of a correction.
    pub fn note(&mut self, judgement: &Judgement) {
        if !self.carries {
            return;
        }
        self.contraction = match self.contraction {
            _ if judgement.seen => Some(judgement.contraction.max(1e-3)),
            Some(before) => Some(TRUST * before),
            None => None,
        };
    }
}
