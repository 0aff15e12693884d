//! The equilibrium iteration: residual, matrix where it is due, solution, correction, until the remaining error is
//! below the tolerance.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::{joints, jump};
use crate::no_convergence::NoConvergence;
use crate::report::StepReport;
use crate::step::convergence_tolerance::Ending;
use crate::step::correct::{correct, relative, shorten, size_of_correction};
use crate::step::progress::StepProgress;
use crate::step::residual;
use crate::step::size::Size;
use crate::step::tangent::IterationMatrix;
use crate::step::trial::{self, Stage};
use crate::strategy::anderson::Anderson;
use crate::strategy::arc_length::{ArcLengthConstraint, Condition};
use crate::strategy::extrapolation::Lead;
use crate::strategy::line_search::LineSearch;
use crate::strategy::refresh::{Advice, Refresh};
use crate::system::Prescribed;
use crate::tolerances::iteration::{BALANCED, LONGER, PART};
use crate::workspace::Workspace;
use base::math::{Vec6, angular, linear};
use base::snapshot::keep;
use mechanics::state::{Configuration, State};
use model::Method;

/// Newton's method, modified where a matrix is worth keeping, with what it needs besides the workspace.
pub struct Newton {
    /// The matrix that it solves with.
    pub matrix: IterationMatrix,
    /// When the iteration ends.
    pub ending: Ending,
    /// Acceleration where the matrix is not the derivative because material yields.
    anderson: Option<Anderson>,
    line_search: Option<LineSearch>,
    /// The iterate from which stresses are extrapolated.
    lead: Lead,
    /// The residual a little ahead of a prediction, where it is differentiated.
    ahead: Vec<f64>,
    /// What has led to the last equilibrium of a load step.
    way: Way,
}

/// The way of an iteration to an equilibrium of a load step.
#[derive(Default)]
struct Way {
    /// The increments after the first correction, by node; none where equilibria have no branches.
    first: Vec<Vec6>,
    /// True where a tangent behind the first correction had negative eigenvalues.
    passes_unstable: bool,
}

keep!(Newton { matrix, ending, anderson, line_search, lead } without { ahead, way });

/// The verdict on a correction.
enum Verdict {
    Converged,
    GoOn,
    /// An old matrix, or extrapolated stresses, have misled: the iteration goes back to the prediction.
    Restart,
    /// The step has used up its iterations.
    Exhausted,
}

impl Newton {
    /// The iteration that the deck asks for.
    pub fn new(cx: &Context) -> Newton {
        let Context { model, plan, system, length, .. } = *cx;
        let (method, _) = Refresh::rule(cx);
        let weights = plan.dofs.nodal_dofs().iter().map(|&(_, dof)| if dof < 3 { 1.0 } else { length });
        // Gaps stand in place of multipliers.
        let gaps = system
            .joints
            .iter()
            .flat_map(|joint| &joint.equations)
            .map(|row| if row.is_rotational() { length } else { 1.0 });
        let mixes = system.yields() && method != Method::TangentStiffness;
        let searches = system.history > 0 && !model.analysis.step_length.is_arc_length();
        let line_search = || LineSearch::new(plan.dofs.nodal_dofs().len(), model.nodes.len(), system.multipliers());
        let differentiates = system.yields() && !cx.is_dynamic();
        let branches = !cx.is_dynamic() && !plan.linear && !model.analysis.step_length.is_arc_length();
        Newton {
            matrix: IterationMatrix::new(cx),
            ending: Ending::new(cx),
            anderson: mixes.then(|| Anderson::new(weights.chain(gaps))),
            line_search: searches.then(line_search),
            lead: Lead::new(cx),
            ahead: vec![0.0; if differentiates { plan.dofs.unknowns() } else { 0 }],
            way: Way {
                first: vec![Vec6::zeros(); if branches { model.nodes.len() } else { 0 }],
                passes_unstable: false,
            },
        }
    }

    /// Writes the prediction of a step and forgets earlier corrections.
    pub fn predict(&mut self, cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
        self.forget_corrections();
        trial::predict(cx, ws, state, stage);
    }

    /// Finds the motion from `state` to its equilibrium at the time `to`, from the increments at hand. Under a
    /// constraint in place of the time it finds the equilibrium where the condition holds, from the time `to` on.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
        constraint: Option<(&mut ArcLengthConstraint, Condition)>,
    ) -> Result<StepReport, Failure> {
        let progress = StepProgress::begin(cx, to, cx.plan.linear && constraint.is_none(), &self.ending);
        let found = self.iterate(cx, ws, state, stage, progress, constraint);
        self.arrive(cx, ws, state, found)
    }

    /// Finds the equilibrium anew from the one at hand, under contact forces that have been changed.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate_again(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> Result<StepReport, Failure> {
        self.forget_corrections();
        let progress = StepProgress::begin(cx, to, cx.plan.linear, &self.ending).at_equilibrium();
        let found = self.iterate(cx, ws, state, stage, progress, None);
        self.arrive(cx, ws, state, found)
    }

    /// Turns to an equilibrium inside a step that was taken. Returns what the steps go on with: what is learnt meanwhile of matrices and
    /// contraction does not count for them.
    pub fn turn_inside(&mut self) -> (Refresh, Ending) {
        let inside = self.matrix.refresh.inside();
        (std::mem::replace(&mut self.matrix.refresh, inside), self.ending)
    }

    /// Turns back to the steps, with what [`Newton::turn_inside`] has returned.
    pub fn turn_back(&mut self, (refresh, ending): (Refresh, Ending)) {
        (self.matrix.refresh, self.ending) = (refresh, ending);
    }

    /// Forgets the iterates of a step that is not taken after all.
    pub fn forget_iterates(&mut self) {
        self.lead.forget();
    }

    /// Discards the matrix at hand, which belongs to a motion that was not taken or to other loads.
    pub fn discard_matrix(&mut self) {
        self.matrix.discard();
        self.lead.forget();
    }

    /// What an equilibrium, or that there is none, tells those to come.
    fn arrive(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        found: Result<StepReport, Failure>,
    ) -> Result<StepReport, Failure> {
        let found = found.and_then(|report| jump::check_motion(cx, ws, state, report.to).map(|()| report));
        let unheld = self.matrix.unheld();
        let found = found.map_err(|failure| match failure {
            // The matrix with the forces of joints in it says best what these do not hold.
            Failure::Stopped | Failure::Singular { .. } => failure,
            _ => unheld.unwrap_or(failure),
        });
        match &found {
            Ok(report) => {
                ws.load_steps.peak.keep(report.residual);
                self.matrix.refresh.accepted(report.iterations);
                self.lead.arrive();
            }
            Err(_) => self.discard_matrix(),
        }
        found
    }

    fn iterate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        mut progress: StepProgress,
        mut constraint: Option<(&mut ArcLengthConstraint, Condition)>,
    ) -> Result<StepReport, Failure> {
        if ws.load_steps.careful {
            progress.limit *= LONGER;
        }
        trial::excite(cx, ws, state.time, progress.report.to, stage.scheme.instant);
        self.way.passes_unstable = false;
        if !cx.is_dynamic() {
            ws.load_steps.peak.begin_step(&ws.loads.instant, &ws.prescribed.end, cx.length);
        }
        loop {
            if ws.matrix.is_given_up(cx) {
                return Err(Failure::Stopped);
            }
            progress.report.residual = self.residual(cx, ws, state, stage, (&mut progress, constraint.is_none()));
            if !progress.report.residual.is_finite() {
                if !self.require_fresh_matrix(cx, ws, state, stage, &mut progress) {
                    return Err(residual::not_finite(cx, ws));
                }
                continue;
            }
            if self.shorten_correction(cx, ws, progress.report.residual) {
                continue;
            }
            progress.new_matrix = self.matrix.refresh(cx, ws, state, stage, self.lead.nodes(), &mut progress.report)?;
            self.look_for_branches(cx, ws, &progress);
            self.solve(cx, ws, &progress)?;
            if let Some((constraint, condition)) = &mut constraint {
                let to = constraint.close(cx, ws, state, progress.report.to, *condition)?;
                progress.move_time(cx, to);
            }
            progress.unjudged |= ws.load_steps.careful && shorten(cx, ws);
            let (correction, motion) = self.correct(cx, ws);
            if progress.report.iterations == 0 {
                self.way.first.iter_mut().zip(&ws.increments).for_each(|(first, increment)| *first = increment.q);
            }
            match self.judge(cx, ws, correction, motion, &mut progress)? {
                Verdict::Converged => return Ok(progress.report),
                Verdict::GoOn => {}
                Verdict::Restart => self.restart(cx, ws, state, stage, &mut progress),
                Verdict::Exhausted => {
                    if !self.require_fresh_matrix(cx, ws, state, stage, &mut progress) {
                        return Err(self.not_converged(cx, ws, state, &progress));
                    }
                    progress.limit += cx.model.solution.iteration.limit;
                }
            }
        }
    }

    /// The size of the residual forces of the iterate; of a prediction, which only steps to a `given` time have, it may be linearized.
    fn residual(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        (progress, given): (&mut StepProgress, bool),
    ) -> f64 {
        let to = progress.report.to;
        if !std::mem::take(&mut progress.predicted) || !given {
            return evaluate_residual(cx, ws, state, stage, to);
        }
        let (size, linearized) = self.residual_of_prediction(cx, ws, state, stage, to);
        // It does not tell whether multipliers balance the forces at the end of the step.
        progress.unjudged = linearized && cx.system.multipliers() > 0;
        size
    }

    /// Counts the negative eigenvalues of a new tangent of a load step. The first is left out: prescribed motion strains the elements beside it
    /// alone until it is answered.
    fn look_for_branches(&mut self, cx: &Context, ws: &Workspace, progress: &StepProgress) {
        if progress.new_matrix && progress.report.iterations > 0 && !self.way.first.is_empty() {
            self.way.passes_unstable |= ws.matrix.solver.negative_eigenvalues() > cx.system.multipliers();
        }
    }

    /// True where the last equilibrium of a load step lies beyond an unstable branch, on the other side of the state than the loads push it:
    /// it may be the mirror image of the one that they lead to.
    pub fn has_turned_back(&self, cx: &Context, ws: &Workspace) -> bool {
        let way = self.way.first.iter().zip(&ws.increments).map(|(first, increment)| {
            let turns = angular(first).dot(&angular(&increment.q));
            linear(first).dot(&linear(&increment.q)) + cx.length * cx.length * turns
        });
        self.way.passes_unstable && way.sum::<f64>() < 0.0
    }

    /// The residual of a prediction, relative to the largest forces. Where material yields and supports move in statics, it is linearized in
    /// their motion: they alone would strain the elements beside them beyond yield, and the matrix of such a state leads nowhere. Tells whether it was.
    fn residual_of_prediction(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> (f64, bool) {
        let moves = |given: &Prescribed| given.u != 0.0;
        if cx.is_dynamic() || !cx.system.yields() || !ws.prescribed.instant.iter().any(moves) {
            return (evaluate_residual(cx, ws, state, stage, to), false);
        }
        let scale =
            |ws: &mut Workspace, factor: f64| ws.prescribed.instant.iter_mut().for_each(|given| given.u *= factor);
        scale(ws, PART);
        let size = evaluate_residual(cx, ws, state, stage, to);
        self.ahead.clone_from(&ws.r);
        scale(ws, -1.0);
        evaluate_residual(cx, ws, state, stage, to);
        scale(ws, -1.0 / PART);
        for (r, ahead) in ws.r.iter_mut().zip(&self.ahead) {
            *r = 0.5 * (*r + ahead) + 0.5 / PART * (ahead - *r);
        }
        (size, true)
    }

    /// Shortens the last correction where it went too far; returns whether it did.
    fn shorten_correction(&mut self, cx: &Context, ws: &mut Workspace, size: f64) -> bool {
        let Some(line_search) = &mut self.line_search else { return false };
        let residual = &ws.r[..cx.nodal_unknowns()];
        let values = &mut ws.forces.multipliers.values;
        let shortened = line_search.shorten(residual, size, &mut ws.increments, values);
        if shortened {
            // The correction that was combined, or extrapolated with, is no longer the one that was applied.
            self.lead.restart();
            if let Some(anderson) = &mut self.anderson {
                anderson.forget();
            }
        }
        shortened
    }
    /// Solves for the correction, which takes the place of the residual in `ws.r`.
    ///
    /// # Errors
    /// [`Failure::Singular`] where nothing holds the scene.
    fn solve(&mut self, cx: &Context, ws: &mut Workspace, progress: &StepProgress) -> Result<(), Failure> {
        if progress.new_matrix {
            self.forget_corrections();
        }
        if let Some(line_search) = &mut self.line_search {
            let gaps = &ws.forces.multipliers.gaps;
            line_search.keep_residual(&ws.r[..cx.nodal_unknowns()], gaps, progress.report.residual);
        }
        self.matrix.solve(cx, ws)
    }

    /// Adds the correction to the increments. Returns its size and that of the increments.
    fn correct(&mut self, cx: &Context, ws: &mut Workspace) -> (Size, Size) {
        // A combined correction may be small by chance; the plain one tells how far there is to go.
        let plain = self.line_search.is_some().then(|| self.mix_corrections(cx, ws));
        self.lead.keep(cx, ws);
        let (correction, motion) = correct(cx, ws);
        (plain.map_or(correction, |plain| plain.or_not_finite(correction)), motion)
    }

    /// Combines the correction with earlier ones where material yields, and keeps it. Returns its plain size.
    #[inline(never)]
    fn mix_corrections(&mut self, cx: &Context, ws: &mut Workspace) -> Size {
        let plain = size_of_correction(cx, ws);
        if let Some(anderson) = &mut self.anderson {
            anderson.mix(&mut ws.r);
        }
        if let Some(line_search) = &mut self.line_search {
            let correction = &ws.r[..cx.nodal_unknowns()];
            line_search.keep_correction(correction, &ws.increments, &ws.forces.multipliers.values);
        }
        plain
    }

    /// # Errors
    /// [`Failure::NotFinite`] where the correction is not a number.
    fn judge(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        correction: Size,
        motion: Size,
        progress: &mut StepProgress,
    ) -> Result<Verdict, Failure> {
        progress.report.iterations += 1;
        let size = relative(cx, correction, motion);
        if !size.is_finite() {
            return Err(residual::not_finite(cx, ws));
        }
        if self.matrix.is_stabilized() || std::mem::take(&mut progress.unjudged) {
            return Ok(if progress.is_exhausted() { Verdict::Exhausted } else { Verdict::GoOn });
        }
        let (iterations, residual, fresh) =
            (progress.report.iterations, progress.report.residual, progress.has_own_matrix());
        let quadratic = progress.new_matrix && self.ending.carries && cx.system.history == 0;
        if iterations == 1
            && let Some(tolerances) = self.ending.of_step(size, residual)
        {
            progress.convergence.adopt(tolerances);
        }
        let judgement = progress.convergence.judge(size, residual, quadratic);
        self.ending.note(&judgement);
        progress.remaining = judgement.remaining();
        let refresh = &mut self.matrix.refresh;
        if self.ending.carries {
            refresh.note(iterations, fresh, size, &judgement);
        }
        if progress.has_converged(cx, ws, correction, self.ending.tolerance, &judgement) {
            return Ok(Verdict::Converged);
        }
        if progress.is_exhausted() {
            return Ok(Verdict::Exhausted);
        }
        // The second correction may well be longer than the first, which begins from what was predicted.
        if judgement.grows && iterations > 2 && progress.new_matrix && self.lead.mistrust() {
            return Ok(Verdict::Restart);
        }
        let misled = judgement.seen && refresh.advise(fresh, &judgement) == Advice::Restart;
        Ok(if misled { Verdict::Restart } else { Verdict::GoOn })
    }

    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage, progress: &mut StepProgress) {
        self.lead.restart();
        self.predict(cx, ws, state, stage);
        progress.convergence.forget();
        progress.predicted = true;
    }

    /// Goes back to the prediction before a step is cut, to go on with a fresh matrix in every iteration; returns false
    /// if that was done already.
    fn require_fresh_matrix(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        progress: &mut StepProgress,
    ) -> bool {
        let again = self.matrix.refresh.require_fresh_matrix();
        if again {
            self.restart(cx, ws, state, stage, progress);
        }
        again
    }

    /// The failure of an iteration that has used up its corrections, with what its last step shows of the cause.
    fn not_converged(&self, cx: &Context, ws: &mut Workspace, state: &State, progress: &StepProgress) -> Failure {
        let report = &progress.report;
        // Forces balance while the joints are open: the constraints contradict each other.
        if report.residual < BALANCED
            && let Err(violated) = joints::check(cx, ws)
        {
            return violated;
        }
        /// Beyond a limit load forces miss balance by what is above it; a larger part of the forces shows iterates that are lost.
        const NEAR: f64 = 0.1;
        let softens = self.way.passes_unstable || !self.way.first.is_empty() && self.matrix.has_yielded();
        let least = cx.model.analysis.least_step;
        let cause = NoConvergence {
            at_limit: softens && report.residual < NEAR,
            least_step: (0.5 * (report.to - state.time) < least).then_some(least),
            enough: progress.enough(),
        };
        let (open, lacks_slip) = (self.matrix.opened_part(), cx.system.rubs() && ws.matrix.solver.is_symmetric());
        let largest = residual::largest(cx, ws);
        Failure::NotConverged { iterations: report.iterations, cause, open, lacks_slip, largest }
    }

    fn forget_corrections(&mut self) {
        if let Some(anderson) = &mut self.anderson {
            anderson.forget();
        }
        if let Some(line_search) = &mut self.line_search {
            line_search.forget();
        }
    }
}

/// Moves the trial motion to the increments at hand and writes its residual. Returns the relative size of the residual.
fn evaluate_residual(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage, to: f64) -> f64 {
    trial::move_trial(cx, ws, state, stage);
    let ahead = stage.scheme.instant * (to - state.time);
    let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead, lead: None };
    let scale = cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
    let scale = if cx.is_dynamic() { scale } else { ws.load_steps.peak.scale(scale) };
    residual::gather(cx, ws, &scale)
}
