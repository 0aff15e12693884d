//! When the iteration ends: its tolerance, and what earlier steps tell of its contraction.
//!
//! Where the deck gives no tolerance, equal steps are iterated to a part of their own error (E. Hairer & G. Wanner, Solving Ordinary
//! Differential Equations II, IV.8). Predictions let accelerations go on in a straight line, so the first correction is what the second
//! difference of the accelerations moves, Δt² times their second derivative; schemes of second order err by a twelfth of that and more.
//! Errors are compared as accelerations, for what is left unbalanced acts on in all steps to come. A tolerance of the deck is a ceiling over
//! that: errors of one sign add up over the steps, so a tolerance that does not know their number may not end an iteration.

use crate::context::Context;
use crate::step::convergence::Judgement;
use crate::tolerances::convergence_tolerance::{
    DIGITS, DISSIPATION_TURN, LEAST, MOST_OF_FIRST, NO_DISSIPATION, PART, PART_OF_FIRST, PART_OF_FORCES, TRUST, UNKNOWN,
};
use base::snapshot::keep;
use mechanics::integrators::Stepping;
use mechanics::integrators::spectrum::spectrum;
use model::StepLength;

/// The end of the iteration.
#[derive(Clone, Copy)]
pub struct ConvergenceTolerance {
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

keep!(ConvergenceTolerance { tolerance, residual, bounds, contraction, carries } without { of_own_error });

impl ConvergenceTolerance {
    /// The end of the iteration of a scene.
    pub fn new(cx: &Context) -> ConvergenceTolerance {
        let given = &cx.model.solution.iteration;
        let of_own_error = follows_own_error(cx);
        let bounds = [given.tolerance.min(DIGITS), if given.follows_step { f64::INFINITY } else { given.tolerance }];
        let tolerance = if of_own_error { bounds[0] } else { given.tolerance };
        ConvergenceTolerance { tolerance, residual: tolerance, bounds, contraction: None, carries: false, of_own_error }
    }

    /// Iterates to a part of the error that steps may leave, and takes the contraction of one step for that of the next.
    pub fn follow(&mut self, error: f64) {
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
        self.of_own_error
            .then(|| [size, residual].map(|first| self.bounded((PART_OF_FIRST * first).min(MOST_OF_FIRST))))
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
            _ if judgement.seen => Some(judgement.contraction.max(LEAST)),
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
    let scheme = &*cx.model.solution.scheme;
    matches!(scheme.stepping(), Stepping::OneStage)
        && cx.system.groups.iter().any(|group| group.kind.is_deformable())
        && spectrum(scheme, DISSIPATION_TURN).damping > NO_DISSIPATION
}
