//! The progress of the iteration of a step.

use crate::context::Context;
use crate::guards::guard::Iterate;
use crate::report::StepReport;
use crate::step::convergence::{Convergence, Judgement};
use crate::step::convergence_tolerance::ConvergenceTolerance;
use crate::step::correct::is_rounding;
use crate::step::regime::Regime;
use crate::step::size::Size;
use crate::tolerances::iteration::INITIAL_LOADS;
use crate::tolerances::progress::SURE;
use crate::warning::Warning;
use crate::workspace::Workspace;
use model::Iteration;

/// The progress of the iteration of a step.
pub struct StepProgress {
    pub report: StepReport,
    pub convergence: Convergence,
    /// True if the matrix was formed for the current iterate.
    pub new_matrix: bool,
    /// Number of iterations after which the step fails.
    pub limit: usize,
    /// True if the current increments are the prediction.
    pub predicted: bool,
    /// True where the time of the step is given, not found.
    pub has_given_time: bool,
    /// True if the current correction says nothing about convergence: it was shortened, or belongs to a linearized residual.
    pub unjudged: bool,
    /// Number of corrections still needed at the contraction seen last.
    pub remaining: f64,
    /// True where a tangent of a load step behind the first had negative eigenvalues.
    pub passes_unstable: bool,
    /// Relative error of the time if the time is unknown; loads are curves over it.
    time_error: f64,
}

impl StepProgress {
    /// Begins the iteration of a step to the time `to`, which is given or not, from the prediction.
    pub fn begin(cx: &Context, to: f64, has_given_time: bool, of: &ConvergenceTolerance) -> StepProgress {
        let exact = cx.plan.linear && has_given_time;
        StepProgress {
            report: StepReport::begin(to),
            convergence: Convergence::new([of.tolerance, of.residual], exact, of.usual()),
            new_matrix: false,
            limit: cx.model.solution.iteration.limit,
            predicted: true,
            has_given_time,
            unjudged: false,
            passes_unstable: false,
            remaining: f64::INFINITY,
            time_error: 0.0,
        }
    }

    /// This progress for a start from an equilibrium under other forces.
    pub fn at_equilibrium(self) -> StepProgress {
        StepProgress { predicted: false, ..self }
    }

    /// This progress with the limit for an elastic matrix, which contracts slowly; a smaller limit of the deck stays.
    pub fn for_elastic_matrix(self) -> StepProgress {
        let limit = if self.limit < Iteration::LIMIT { self.limit } else { self.limit.max(INITIAL_LOADS) };
        StepProgress { limit, ..self }
    }

    /// Moves the end of the step. A correction δt of the time causes an error of the loads of order δt², for every motion.
    pub fn move_time(&mut self, cx: &Context, to: f64) {
        self.time_error = ((to - self.report.to) / cx.model.analysis.duration()).powi(2);
        self.report.to = to;
    }

    /// The iterate that has been judged.
    pub fn iterate(&self, converged: bool) -> Iterate {
        Iterate { number: self.report.iterations, new_matrix: self.new_matrix, converged }
    }

    /// True if the current matrix was formed in this step.
    pub fn has_own_matrix(&self) -> bool {
        self.report.factorizations > 0
    }

    /// True where the step has used up its iterations.
    pub fn is_exhausted(&self) -> bool {
        self.report.iterations >= self.limit
    }

    /// The number of iterations that would suffice, with a reserve of one half; `None` if it exceeds twice the limit.
    pub fn enough(&self) -> Option<usize> {
        let needed = 1.5 * (self.report.iterations as f64 + self.remaining);
        (needed <= 2.0 * self.limit as f64).then(|| needed.ceil() as usize)
    }

    /// Judges convergence to this relative `tolerance`. If material yields, one contraction says little about the next, and corrections
    /// small against positions may be large against elastic strains. The residual must then also have decreased, or be rounding.
    pub fn has_converged(
        &self,
        cx: &Context,
        ws: &mut Workspace,
        correction: Size,
        (tolerance, regime): (f64, &dyn Regime),
        judgement: &Judgement,
    ) -> bool {
        if self.time_error > tolerance {
            return false;
        }
        let residual = self.report.residual;
        let sure = cx.system.history == 0 || residual <= (SURE[0] * judgement.tolerance).min(SURE[1]);
        let small = is_rounding(cx, ws.reach, correction, self.has_own_matrix() && sure);
        let rounding = judgement.stalled() && small;
        if sure && judgement.converged() {
            return true;
        }
        let precise = regime.is_precise(ws, residual, tolerance);
        if small && !precise && (self.is_exhausted() || rounding && judgement.is_stagnant()) {
            ws.warnings.add(Warning::Unbalanced { residual });
            return true;
        }
        rounding && precise
    }
}
