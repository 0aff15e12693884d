//! How far the iteration of a step has come.

use crate::context::Context;
use crate::report::StepReport;
use crate::step::convergence::{Convergence, Judgement};
use crate::step::convergence_tolerance::Ending;
use crate::step::correct::is_rounding;
use crate::step::size::Size;
use crate::tolerances::progress::{SURE, UNBALANCED};
use crate::warning::Warning;
use crate::workspace::Workspace;

/// The progress of the iteration of a step.
pub struct StepProgress {
    pub report: StepReport,
    pub convergence: Convergence,
    /// True where the matrix was formed for the iterate at hand.
    pub new_matrix: bool,
    /// Number of iterations after which the step is given up.
    pub limit: usize,
    /// True where the increments at hand are the prediction.
    pub predicted: bool,
    /// True where the correction at hand tells nothing of convergence: it was shortened, or answers a linearized residual.
    pub unjudged: bool,
    /// Number of corrections still needed at the contraction seen last.
    pub remaining: f64,
    /// Relative error of the time where it is unknown; loads are curves over it.
    time_error: f64,
}

impl StepProgress {
    /// Begins the iteration of a step to the time `to`, with a matrix that is `exact` or not, from the prediction.
    pub fn begin(cx: &Context, to: f64, exact: bool, ending: &Ending) -> StepProgress {
        StepProgress {
            report: StepReport::begin(to),
            convergence: Convergence::new([ending.tolerance, ending.residual], exact, ending.usual()),
            new_matrix: false,
            limit: cx.model.solution.iteration.limit,
            predicted: true,
            unjudged: false,
            remaining: f64::INFINITY,
            time_error: 0.0,
        }
    }

    /// The same where the increments at hand are those of an equilibrium under other forces.
    pub fn at_equilibrium(self) -> StepProgress {
        StepProgress { predicted: false, ..self }
    }

    /// Moves the end of the step. A correction δt of the time leaves an error of the loads of order δt², whatever the
    /// motion.
    pub fn move_time(&mut self, cx: &Context, to: f64) {
        self.time_error = ((to - self.report.to) / cx.model.analysis.duration()).powi(2);
        self.report.to = to;
    }

    /// True where the matrix at hand was formed in this step.
    pub fn has_own_matrix(&self) -> bool {
        self.report.factorizations > 0
    }

    /// True where the step has used up its iterations.
    pub fn is_exhausted(&self) -> bool {
        self.report.iterations >= self.limit
    }

    /// The number of iterations that would do, with half as many to spare, where corrections still shrink and ten times the limit is enough.
    pub fn enough(&self) -> Option<usize> {
        let needed = 1.5 * (self.report.iterations as f64 + self.remaining);
        (needed <= 10.0 * self.limit as f64).then(|| needed.ceil() as usize)
    }

    /// Judges convergence to this relative `tolerance`. Where material yields, one contraction says little of the next, and what is small
    /// against positions may be large against elastic strains: the residual must have decreased as well, or nothing but rounding be left.
    pub fn has_converged(
        &self,
        cx: &Context,
        ws: &mut Workspace,
        correction: Size,
        tolerance: f64,
        judgement: &Judgement,
    ) -> bool {
        if self.time_error > tolerance {
            return false;
        }
        let residual = self.report.residual;
        let sure = cx.system.history == 0 || residual <= (SURE[0] * judgement.tolerance).min(SURE[1]);
        let small = is_rounding(cx, ws, correction, self.has_own_matrix() && sure);
        let rounding = judgement.stalled() && small;
        if sure && judgement.converged() {
            return true;
        }
        // Corrections below the digits of positions still matter to a motion that is small itself: a load step waits for its forces.
        let precise =
            cx.is_dynamic() || residual <= UNBALANCED * tolerance || ws.load_steps.peak.is_unstressed(residual);
        if small && !precise && (self.is_exhausted() || rounding && judgement.is_stagnant()) {
            ws.warnings.add(Warning::Unbalanced { residual });
            return true;
        }
        rounding && precise
    }
}
