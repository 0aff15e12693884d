//! The tolerance of the equilibrium iteration, and the contraction seen in earlier steps.
//!
//! If the deck gives no tolerance, steps of equal length are iterated to a part of the error that each step makes (E. Hairer & G. Wanner,
//! Solving Ordinary Differential Equations II, IV.8). The prediction extrapolates accelerations linearly, so the first correction is the
//! second difference of the accelerations, Δt² times their second derivative. Schemes of second order err by at least a twelfth of it.
//! Errors are compared as accelerations, because a residual force acts on in all later steps. A tolerance from the deck is an upper bound:
//! errors of one sign add up over the steps, and a fixed tolerance does not account for their number.

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
    /// The least and the largest tolerance; the largest is the tolerance of the deck.
    bounds: [f64; 2],
    /// The contraction seen last; none is carried from step to step where every step is iterated to the digits of the deck.
    contraction: Option<f64>,
    /// True if steps are iterated to a part of the error that the controller allows.
    pub carries: bool,
    /// True if steps are iterated to a part of the error that they make.
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

    /// Iterates to a part of the allowed `error` of a step, and starts the next step with the contraction of the last one.
    pub fn follow(&mut self, error: f64) {
        (self.tolerance, self.carries) = (self.bounded(PART * error), true);
        self.residual = self.bounded(PART_OF_FORCES * error);
        self.contraction = None;
    }

    /// The contraction assumed for the first correction of a step.
    pub fn usual(&self) -> f64 {
        self.contraction.map_or(UNKNOWN, |seen| seen.min(UNKNOWN))
    }

    /// The tolerances of correction and residual for a step whose first correction has this relative size and residual; `None` if all steps
    /// have the same tolerances. Contractions are not carried over here: without a second correction the remaining errors keep one sign and
    /// add up to a sixth of the error of the steps.
    pub fn of_step(&self, size: f64, residual: f64) -> Option<[f64; 2]> {
        self.of_own_error
            .then(|| [size, residual].map(|first| self.bounded((PART_OF_FIRST * first).min(MOST_OF_FIRST))))
    }

    /// This tolerance within the bounds of the scene; the deck's goes before.
    fn bounded(&self, tolerance: f64) -> f64 {
        let [least, most] = self.bounds;
        tolerance.max(least).min(most)
    }

    /// Records the contraction of a correction.
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

/// True where energy need not be kept to the digits of the default. Iterating to the error of the steps conserves energy only to it, which
/// is enough for dissipative schemes. Models of rigid bodies only are excluded: their rotations have an error of higher order.
fn may_keep_less(cx: &Context) -> bool {
    let scheme = &*cx.model.solution.scheme;
    matches!(scheme.stepping(), Stepping::OneStage)
        && cx.system.groups.iter().any(|group| group.kind.is_deformable())
        && spectrum(scheme, DISSIPATION_TURN).damping > NO_DISSIPATION
}
