//! The equilibrium iteration: residual, matrix when due, solution and correction, until the remaining error is below the tolerance.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::joints;
use crate::guards::list::Guards;
use crate::no_convergence::NoConvergence;
use crate::report::StepReport;
use crate::step::convergence_tolerance::ConvergenceTolerance;
use crate::step::correct::relative;
use crate::step::evaluate::evaluate;
use crate::step::predict::{excite, predict};
use crate::step::progress::StepProgress;
use crate::step::regime::{Regime, regime};
use crate::step::residual;
use crate::step::size::Size;
use crate::step::tangent::IterationMatrix;
use crate::step::trial::Step;
use crate::strategy::arc_length::PathCondition;
use crate::strategy::extrapolation::StressExtrapolation;
use crate::strategy::linearized_prediction::LinearizedPrediction;
use crate::strategy::refresh::{Advice, Refresh};
use crate::strategy::relaxation::Relaxation;
use crate::system::{law_of, open_gap};
use crate::tolerances::iteration::{BALANCED, LONGER, NEAR_LIMIT};
use crate::workspace::Workspace;
use base::names::short;
use base::snapshot::keep;

/// Newton's method, modified where reusing a matrix pays, with its data besides the workspace. Parts that a model does not need are `None`.
pub struct Newton {
    /// The matrix that it solves with.
    pub matrix: IterationMatrix,
    /// When the iteration ends.
    pub tolerance: ConvergenceTolerance,
    relaxation: Option<Relaxation>,
    extrapolation: StressExtrapolation,
    linearized: Option<LinearizedPrediction>,
    /// Steps of load, or steps of time.
    pub regime: &'static dyn Regime,
}

keep!(Newton { matrix, tolerance, relaxation, extrapolation } without { linearized, regime });

/// The verdict on a correction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Converged,
    GoOn,
    /// An old matrix, or extrapolated stresses, have misled: the iteration goes back to the prediction.
    Restart,
    /// The step has used up its iterations.
    Exhausted,
}

impl Newton {
    /// The iteration chosen in the deck.
    pub fn new(cx: &Context) -> Newton {
        let (method, _) = Refresh::rule(cx);
        Newton {
            matrix: IterationMatrix::new(cx),
            tolerance: ConvergenceTolerance::new(cx),
            relaxation: Relaxation::new(cx, method),
            extrapolation: StressExtrapolation::new(cx),
            linearized: LinearizedPrediction::new(cx),
            regime: regime(cx),
        }
    }

    /// Writes the prediction of a step and forgets earlier corrections.
    pub fn predict(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) {
        self.forget_corrections();
        predict(cx, ws, step);
    }

    /// Finds the equilibrium of a step from the current increments. Under a condition in place of the time it finds the equilibrium where
    /// the condition holds, from the end of the step on.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        guards: &mut Guards,
        step: Step,
        path: Option<PathCondition>,
    ) -> Result<StepReport, Failure> {
        let progress = self.begin_progress(cx, ws, &step, path.is_none());
        // The work of sudden loads needs shorter steps.
        let is_load_step = path.is_none() && self.regime.has_load_control(cx) && ws.load_steps.sudden.is_none();
        let mut found = self.iterate(cx, ws, guards, step, progress, path);
        // Where whole sections yield, in shear too, tangents lead far away; the initial load method then contracts, and shorter steps do not.
        if matches!(found, Err(Failure::NotConverged { .. } | Failure::NotFinite { .. }))
            && is_load_step
            && cx.system.yields()
            && self.matrix.refresh.require_elastic_matrix()
        {
            self.predict(cx, ws, &step);
            let progress = StepProgress::begin(cx, step.to, true, &self.tolerance).for_elastic_matrix();
            let again = self.iterate(cx, ws, guards, step, progress, None);
            if matches!(again, Ok(_) | Err(Failure::Stopped | Failure::Singular { .. })) {
                found = again;
            }
        }
        self.arrive(ws, found)
    }

    /// Finds the equilibrium again from the current one, under changed contact forces.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate_again(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        guards: &mut Guards,
        step: Step,
    ) -> Result<StepReport, Failure> {
        self.forget_corrections();
        let progress = self.begin_progress(cx, ws, &step, true).at_equilibrium();
        let found = self.iterate(cx, ws, guards, step, progress, None);
        self.arrive(ws, found)
    }

    /// Begins an equilibrium inside a step that was taken. Returns the refresh rule and tolerance of the steps, which resume with them
    /// unchanged.
    pub fn begin_inside(&mut self) -> (Refresh, ConvergenceTolerance) {
        let inside = self.matrix.refresh.inside();
        (std::mem::replace(&mut self.matrix.refresh, inside), self.tolerance)
    }

    /// Goes back to the steps, with what [`Newton::begin_inside`] has returned.
    pub fn end_inside(&mut self, (refresh, tolerance): (Refresh, ConvergenceTolerance)) {
        (self.matrix.refresh, self.tolerance) = (refresh, tolerance);
    }

    /// Forgets the iterates of a step that is not taken after all.
    pub fn forget_iterates(&mut self) {
        self.extrapolation.forget();
    }

    /// Discards the current matrix, which belongs to a rejected motion or to other loads.
    pub fn discard_matrix(&mut self) {
        self.matrix.discard();
        self.extrapolation.forget();
    }

    /// The iteration itself. Each line is a stage of it, or a named point where strategies and guards act.
    fn iterate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        guards: &mut Guards,
        mut step: Step,
        mut progress: StepProgress,
        mut path: Option<PathCondition>,
    ) -> Result<StepReport, Failure> {
        self.begin(cx, ws, &step);
        loop {
            ws.matrix.check_stop(cx)?;
            self.residual(cx, ws, &step, &mut progress);
            if !progress.report.residual.is_finite() {
                self.require_fresh_matrix(cx, ws, &step, &mut progress)
                    .map_err(|()| residual::not_finite(cx, &ws.forces))?;
                continue;
            }
            if self.shorten_last(cx, ws, progress.report.residual) {
                continue;
            }
            progress.new_matrix =
                self.matrix.refresh(cx, ws, &step, self.extrapolation.nodes(), &mut progress.report)?;
            self.solve(cx, ws, &mut progress)?;
            if let Some(path) = &mut path {
                path.close(cx, ws, &mut step, &mut progress)?;
            }
            let sizes = self.correct(cx, ws, &mut progress);
            let verdict = self.judge(cx, ws, sizes, &mut progress)?;
            let iterate = progress.iterate(verdict == Verdict::Converged);
            guards.ask(|guard| guard.at_iterate(cx, ws, &step, &iterate))?;
            match verdict {
                Verdict::Converged => return Ok(progress.report),
                Verdict::GoOn => {}
                Verdict::Restart => self.restart(cx, ws, &step, &mut progress),
                Verdict::Exhausted => self.prolong(cx, ws, &step, &mut progress)?,
            }
        }
    }

    /// Begins the iteration of a step, longer for careful ones.
    fn begin_progress(&self, cx: &Context, ws: &Workspace, step: &Step, has_given_time: bool) -> StepProgress {
        let mut progress = StepProgress::begin(cx, step.to, has_given_time, &self.tolerance);
        progress.limit *= if ws.load_steps.careful { LONGER } else { 1 };
        progress
    }

    /// Evaluates loads and prescribed motion of a step.
    fn begin(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) {
        excite(cx, ws, step.state.time, step.to, step.stage.scheme.instant);
        self.regime.begin(cx, ws);
    }

    /// Evaluates the residual of the iterate; at the prediction of a step to a given time it may be linearized.
    fn residual(&mut self, cx: &Context, ws: &mut Workspace, step: &Step, progress: &mut StepProgress) {
        let linearized = match std::mem::take(&mut progress.predicted) && progress.has_given_time {
            true => self.linearized.as_mut().and_then(|linearized| linearized.evaluate(cx, ws, step)),
            false => None,
        };
        // It does not tell whether multipliers balance the forces at the end of the step.
        progress.unjudged |= linearized.is_some() && cx.system.multipliers() > 0;
        progress.report.residual = linearized.unwrap_or_else(|| evaluate(cx, ws, step));
    }

    /// Shortens the last correction where it went too far; returns whether it did.
    fn shorten_last(&mut self, cx: &Context, ws: &mut Workspace, size: f64) -> bool {
        let Some(relaxation) = &mut self.relaxation else { return false };
        let Workspace { residual, trial, forces, .. } = ws;
        let shortened = relaxation.shorten(cx, residual, size, trial, &mut forces.multipliers);
        if shortened {
            // The extrapolation used the full correction, which no longer is the applied one.
            self.extrapolation.restart();
        }
        shortened
    }

    /// Solves for the correction.
    ///
    /// # Errors
    /// [`Failure::Singular`] where nothing holds the scene.
    fn solve(&mut self, cx: &Context, ws: &mut Workspace, progress: &mut StepProgress) -> Result<(), Failure> {
        if progress.new_matrix {
            self.forget_corrections();
            let judged = progress.report.iterations > 0 && self.regime.has_load_control(cx);
            progress.passes_unstable |= judged && ws.matrix.solver.negative_eigenvalues() > cx.system.multipliers();
        }
        if let Some(relaxation) = &mut self.relaxation {
            relaxation.keep_residual(cx, &ws.residual, progress.report.residual, &ws.forces.multipliers);
        }
        self.matrix.solve(cx, ws)
    }

    /// Adds the correction, relaxed where material yields, to the increments. Returns its size and the size of the increments.
    fn correct(&mut self, cx: &Context, ws: &mut Workspace, progress: &mut StepProgress) -> (Size, Size) {
        let Workspace { correction, trial, forces, load_steps, .. } = ws;
        progress.unjudged |= load_steps.careful && correction.shorten(cx);
        let relaxation = self.relaxation.as_mut();
        let plain = relaxation.map(|relaxation| relaxation.combine(cx, correction, trial, &forces.multipliers));
        self.extrapolation.keep(cx, trial, correction);
        let (size, motion) = correction.add_to(cx, trial, &mut forces.multipliers);
        (plain.map_or(size, |plain| plain.or_not_finite(size)), motion)
    }

    /// Judges a correction by its size, the motion of the step and the residual before it.
    ///
    /// # Errors
    /// [`Failure::NotFinite`] where the correction is not a number.
    fn judge(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        (correction, motion): (Size, Size),
        progress: &mut StepProgress,
    ) -> Result<Verdict, Failure> {
        progress.report.iterations += 1;
        let size = relative(cx, correction, motion);
        if !size.is_finite() {
            return Err(residual::not_finite(cx, &ws.forces));
        }
        if self.matrix.is_stabilized() || std::mem::take(&mut progress.unjudged) {
            return Ok(if progress.is_exhausted() { Verdict::Exhausted } else { Verdict::GoOn });
        }
        let (iterations, residual, fresh) =
            (progress.report.iterations, progress.report.residual, progress.has_own_matrix());
        let quadratic = progress.new_matrix && self.tolerance.carries && cx.system.history == 0;
        if iterations == 1
            && let Some(tolerances) = self.tolerance.of_step(size, residual)
        {
            progress.convergence.adopt(tolerances);
        }
        let judgement = progress.convergence.judge(size, residual, quadratic);
        self.tolerance.note(&judgement);
        progress.remaining = judgement.remaining(false);
        let refresh = &mut self.matrix.refresh;
        // Where material yields, one contraction says little about the next.
        if self.tolerance.carries || refresh.learns && cx.system.history == 0 {
            refresh.note(iterations, fresh, size, &judgement);
        }
        if progress.has_converged(cx, ws, correction, (self.tolerance.tolerance, self.regime), &judgement) {
            return Ok(Verdict::Converged);
        }
        if progress.is_exhausted() {
            return Ok(Verdict::Exhausted);
        }
        // The first correction starts from the prediction, so the second may well be longer.
        if judgement.grows && iterations > 2 && progress.new_matrix && self.extrapolation.mistrust() {
            return Ok(Verdict::Restart);
        }
        let misled = judgement.seen && refresh.advise(fresh, &judgement) == Advice::Restart;
        Ok(if misled { Verdict::Restart } else { Verdict::GoOn })
    }

    fn restart(&mut self, cx: &Context, ws: &mut Workspace, step: &Step, progress: &mut StepProgress) {
        self.extrapolation.restart();
        self.predict(cx, ws, step);
        progress.convergence.forget();
        progress.predicted = true;
        progress.unjudged = false;
    }

    /// Returns to the prediction before a step is cut, and uses a fresh matrix in every iteration from then on.
    ///
    /// # Errors
    /// It was required already.
    fn require_fresh_matrix(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        progress: &mut StepProgress,
    ) -> Result<(), ()> {
        if !self.matrix.refresh.require_fresh_matrix() {
            return Err(());
        }
        self.restart(cx, ws, step, progress);
        Ok(())
    }

    /// Gives a step that has used up its iterations once more as many, with fresh matrices.
    ///
    /// # Errors
    /// Why the step has no equilibrium, where it had them already.
    fn prolong(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: &Step,
        progress: &mut StepProgress,
    ) -> Result<(), Failure> {
        if self.require_fresh_matrix(cx, ws, step, progress).is_err() {
            return Err(self.not_converged(cx, ws, step, progress));
        }
        progress.limit += cx.model.solution.iteration.limit;
        Ok(())
    }

    fn forget_corrections(&mut self) {
        self.relaxation.iter_mut().for_each(Relaxation::forget);
    }

    /// Passes the outcome of an iteration, an equilibrium or a failure, to later ones.
    fn arrive(&mut self, ws: &mut Workspace, found: Result<StepReport, Failure>) -> Result<StepReport, Failure> {
        let unheld = self.matrix.unheld();
        let found = found.map_err(|failure| match failure {
            // The matrix with joint forces identifies unrestrained parts best.
            Failure::Stopped | Failure::Singular { .. } => failure,
            _ => unheld.unwrap_or(failure),
        });
        match &found {
            Ok(report) => {
                ws.load_steps.peak.keep(report.residual);
                self.matrix.refresh.accepted(report.iterations);
                self.extrapolation.arrive();
            }
            Err(_) => self.discard_matrix(),
        }
        found
    }

    /// The failure of an iteration that has used up its corrections, with the evidence of its last iterate.
    fn not_converged(&self, cx: &Context, ws: &mut Workspace, step: &Step, progress: &StepProgress) -> Failure {
        let report = &progress.report;
        // Forces balance while the joints are open: the constraints contradict each other.
        if report.residual < BALANCED
            && let Err(violated) = joints::note(cx, ws)
        {
            return violated;
        }
        let yields = self.regime.has_load_control(cx) && self.matrix.has_yielded();
        let least = cx.model.analysis.least_step;
        let cause = NoConvergence {
            at_limit: (progress.passes_unstable || yields) && report.residual < NEAR_LIMIT,
            least_step: (0.5 * (report.to - step.state.time) < least).then_some(least),
            enough: progress.enough(),
            moves: cx.is_dynamic(),
        };
        let never_closed = || contact_never_closed(cx, step).filter(|_| !cause.at_limit);
        let open = self.matrix.opened_part().or_else(never_closed);
        let lacks_slip = cx.system.rubs() && ws.matrix.solver.is_symmetric();
        let largest = residual::largest(cx, &ws.forces);
        Failure::NotConverged {
            iterations: report.iterations,
            cause: Box::new(cause),
            open,
            lacks_slip,
            yielded: None,
            largest,
        }
    }
}

/// A contact, in quotes and with its gap, that is open as a load step begins, where supports alone do not hold all parts.
fn contact_never_closed(cx: &Context, step: &Step) -> Option<String> {
    let needs_contact = !cx.is_dynamic() && !model::holds_all(cx.model);
    cx.system.groups.iter().filter(|_| needs_contact).find_map(|group| {
        let (name, _) = law_of(cx.model, group)?;
        let gap = open_gap(group, &step.state.history[group.history.clone()])?;
        Some(format!("contact `{name}` (its gap is {})", short(gap)))
    })
}
