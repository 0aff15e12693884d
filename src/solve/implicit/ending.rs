//! When the iteration ends: its tolerance, and what earlier steps tell of its contraction.
//!
//! Where the deck gives no tolerance, equal steps are iterated to a part of their own error (E. Hairer & G. Wanner, Solving Ordinary
//! Differential Equations II, IV.8). Predictions let accelerations go on in a straight line, so the first correction is what the second
//! difference of the accelerations moves, Δt² times their second derivative; schemes of second order err by a twelfth of that and more.
//! Errors are compared as accelerations, for what is left unbalanced acts on in all steps to come. A tolerance of the deck is a ceiling over
//! that: errors of one sign add up over the steps, so a tolerance that does not know their number may not end an iteration.

use super::convergence::Judgement;
use crate::context::Context;
use base::snapshot::keep;
use mechanics::integrators::Stepping;
use mechanics::integrators::spectrum::spectrum;
use model::StepLength;

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
    /// The least and the largest tolerance; the largest is that of the deck.
    bounds: [f64; 2],
    /// The contraction seen last; none is carried from step to step where every step is iterated to the digits of the deck.
    contraction: Option<f64>,
    /// True where steps are iterated to a part of the error that they may leave.
    pub carries: bool,
    /// True where steps are iterated to a part of the error that they make.
    of_own_error: bool,
}

keep!(Ending { tolerance, residual, bounds, contraction, carries } without { of_own_error });

impl Ending {
    /// The end of the iteration of a scene.
    pub fn new(cx: &Context) -> Ending {
        /// The tolerance of steps whose own error is not known.
        const DIGITS: f64 = 1e-8;
        let given = &cx.model.solution.iteration;
        let of_own_error = follows_own_error(cx);
        let bounds = [given.tolerance.min(DIGITS), if given.follows_step { f64::INFINITY } else { given.tolerance }];
        let tolerance = if of_own_error { bounds[0] } else { given.tolerance };
        Ending { tolerance, residual: tolerance, bounds, contraction: None, carries: false, of_own_error }
    }

    /// Iterates to a part of the error that steps may leave, and takes the contraction of one step for that of the next.
    pub fn follow(&mut self, error: f64) {
        /// The iteration adds little to the error of the step, for its own is of one sign where matrices are kept.
        const PART: f64 = 0.01;
        /// Forces follow the motion: those of stiff parts are far from it long before the motion is, and no step builds on them.
        const PART_OF_FORCES: f64 = 0.1;
        (self.tolerance, self.carries) = (self.bounded(PART * error), true);
        self.residual = self.bounded(PART_OF_FORCES * error);
        self.contraction = None;
    }

    /// The contraction by which the first correction of a step is judged.
    pub fn usual(&self) -> f64 {
        self.contraction.map_or(UNKNOWN, |seen| seen.min(UNKNOWN))
    }

    /// The tolerances of correction and residual in a step that begins with a correction of this relative size, which answers this
    /// relative residual; none where all steps have the same. Contractions are not carried over here: without a second correction that
    /// confirms, what is left has one sign for many steps and adds up to a sixth of their error.
    pub fn of_step(&self, size: f64, residual: f64) -> Option<[f64; 2]> {
        /// A thousandth of a twelfth, rounded: errors of one sign add up.
        const PART: f64 = 1e-4;
        /// Whatever the error of the step: an impact, a load that jumps, or stiff parts that turn far in steps which do not resolve them, where
        /// what is left would drive them.
        const MOST: f64 = 1e-5;
        self.of_own_error.then(|| [size, residual].map(|first| self.bounded((PART * first).min(MOST))))
    }

    /// This tolerance within the bounds of the scene; the deck's goes before.
    fn bounded(&self, tolerance: f64) -> f64 {
        let [least, most] = self.bounds;
        tolerance.max(least).min(most)
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

/// True where the error of a step ends its iteration, beside the tolerance of the deck.
fn follows_own_error(cx: &Context) -> bool {
    cx.is_dynamic()
        && !matches!(cx.model.analysis.step_length, StepLength::ErrorControlled { .. })
        && (!cx.model.solution.iteration.follows_step || may_keep_less(cx))
}

/// True where energy need not be kept to the digits of the default. Steps that end with their own error keep it to that and no better,
/// which schemes that dissipate do not promise; bodies alone turn with an error of higher order.
fn may_keep_less(cx: &Context) -> bool {
    /// The step, in radians of an oscillator, for which dissipation is looked at.
    const TURN: f64 = 1.0;
    /// Above the rounding of eigenvalues.
    const NONE: f64 = 1e-9;
    let scheme = &*cx.model.solution.scheme;
    matches!(scheme.stepping(), Stepping::OneStage)
        && cx.system.groups.iter().any(|group| group.kind.is_deformable())
        && spectrum(scheme, TURN).damping > NONE
}
