//! The equilibrium iteration: residual, matrix where it is due, solution, correction, until the remaining error is
//! below the tolerance.

use super::accept::accept;
use super::anderson::Anderson;
use super::arc_length::{ArcLengthConstraint, Condition};
use super::augmentation::Augmentation;
use super::convergence::{Convergence, Judgement};
use super::correction::{correct, is_rounding, relative, size_of_correction};
use super::ending::Ending;
use super::jump;
use super::lead::Lead;
use super::line_search::LineSearch;
use super::massless::MasslessNodes;
use super::mechanism;
use super::refresh::{Advice, Refresh};
use super::stability::Stability;
use super::turning::Turning;
use crate::elements::Moduli;
use crate::integrators::Coefficients;
use crate::linear::TooLarge;
use crate::model::{AnalysisKind, Method, Update};
use crate::snapshot::keep;
use crate::solve::context::Context;
use crate::solve::failure::Failure;
use crate::solve::motion::{self, Stage};
use crate::solve::projection::ConstraintProjection;
use crate::solve::report::StepReport;
use crate::solve::size::Size;
use crate::solve::warning::Warning;
use crate::solve::work::WorkQuadrature;
use crate::solve::workspace::Workspace;
use crate::solve::{contacts, joints, residual};
use crate::state::{Configuration, Node, State};
use crate::system::{Prescribed, TangentWeights};

/// Newton's method, modified where a matrix is worth keeping, with what it needs besides the workspace.
pub struct Newton {
    refresh: Refresh,
    /// Acceleration where the matrix is not the derivative because material yields.
    anderson: Option<Anderson>,
    line_search: Option<LineSearch>,
    /// What carries the matrix along with a scene that turns.
    turning: Option<Turning>,
    /// Projection onto the constraints in a dynamic analysis with joints.
    pub projection: Option<ConstraintProjection>,
    /// The factor of the mass in the matrix at hand.
    pub mass_weight: f64,
    /// When the iteration ends.
    pub ending: Ending,
    /// The iterate from which stresses are extrapolated.
    lead: Lead,
    /// The number of elements that were open when a matrix was last searched for mechanisms; none before the first of the run.
    searched: Option<usize>,
    /// The part that has opened or gone slack last.
    opened: Option<String>,
    /// The residual a little ahead of a prediction, where it is differentiated.
    ahead: Vec<f64>,
    /// The nodes without mass in a dynamic analysis.
    massless: MasslessNodes,
    /// The watch over the stability of equilibria in statics.
    stability: Option<Stability>,
    /// What closes contacts without depth in load steps.
    augmentation: Option<Box<Augmentation>>,
    /// True where loads grow along the path at the equilibrium at hand; a path of given arc length may go back.
    pub grows: bool,
}

keep!(Newton {
    refresh,
    anderson,
    line_search,
    turning,
    projection,
    mass_weight,
    ending,
    lead,
    searched,
    opened,
    massless,
    stability,
    grows,
} without { ahead, augmentation });

/// The progress of the iteration of a step.
struct Progress {
    report: StepReport,
    convergence: Convergence,
    /// True where the matrix was formed for the iterate at hand.
    new_matrix: bool,
    /// Number of iterations after which the step is given up.
    limit: usize,
    /// True where the increments at hand are the prediction.
    predicted: bool,
    /// Relative error of the time where it is unknown; loads are curves over it.
    time_error: f64,
}

/// The verdict on a correction.
enum Verdict {
    Converged,
    GoOn,
    /// An old matrix, or extrapolated stresses, have misled: the iteration goes back to the prediction.
    Restart,
    /// The step has used up its iterations.
    Exhausted,
}

impl Progress {
    fn begin(cx: &Context, to: f64, exact: bool, ending: &Ending) -> Progress {
        Progress {
            report: StepReport::begin(to),
            convergence: Convergence::new([ending.tolerance, ending.residual], exact, ending.usual()),
            new_matrix: false,
            limit: cx.model.solution.iteration.limit,
            predicted: true,
            time_error: 0.0,
        }
    }

    /// Moves the end of the step. A correction δt of the time leaves an error of the loads of order δt², whatever the
    /// motion.
    fn move_time(&mut self, cx: &Context, to: f64) {
        self.time_error = ((to - self.report.to) / cx.model.analysis.duration()).powi(2);
        self.report.to = to;
    }
}

impl Newton {
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context) -> Result<Newton, TooLarge> {
        let Context { model, plan, system, length, .. } = *cx;
        // Load steps are long and few, and no mass steadies an old matrix; along a path an old one misleads.
        let along = model.analysis.step_length.is_arc_length();
        let method = if along { Method::TangentStiffness } else { model.solution.iteration.method };
        let mixes = system.yields() && method != Method::TangentStiffness;
        let update = match (model.analysis.kind, model.solution.iteration.update) {
            _ if along => Update::Iteration,
            (AnalysisKind::Static, Update::Auto) if !mixes => Update::Iteration,
            (_, update) => update,
        };
        let weights = plan.dofs.nodal_dofs().iter().map(|&(_, dof)| if dof < 3 { 1.0 } else { length });
        // Gaps stand in place of multipliers.
        let gaps = system
            .joints
            .iter()
            .flat_map(|joint| &joint.equations)
            .map(|row| if row.is_rotational() { length } else { 1.0 });
        let searches = system.history > 0 && !along;
        let line_search = || LineSearch::new(plan.dofs.nodal_dofs().len(), model.nodes.len(), system.multipliers());
        Ok(Newton {
            refresh: Refresh::new(method, update, plan.linear, plan.refresh_cost),
            anderson: mixes.then(|| Anderson::new(weights.chain(gaps))),
            line_search: searches.then(line_search),
            turning: Turning::new(cx).filter(|_| update != Update::Iteration),
            projection: ConstraintProjection::for_motion(cx)?,
            mass_weight: 0.0,
            lead: Lead::new(cx),
            ending: Ending::new(cx),
            searched: None,
            opened: None,
            ahead: if cx.system.yields() && !cx.is_dynamic() { vec![0.0; cx.plan.dofs.unknowns()] } else { Vec::new() },
            massless: MasslessNodes::new(cx),
            stability: Stability::for_statics(cx, update != Update::Iteration || method == Method::InitialLoad)?,
            augmentation: Augmentation::of(cx).map(Box::new),
            grows: true,
        })
    }

    /// Takes `state` from its time to the time `to` in one stage. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn stage(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        stage: &Stage,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let report = self.find(cx, ws, state, stage, to)?;
        let Some(mut augmentation) = self.augmentation.take() else {
            self.accept(cx, ws, state, stage, to)?;
            return Ok(report);
        };
        augmentation.begin(state);
        let found = self.close_contacts(&mut augmentation, cx, ws, state, stage, report);
        let accepted = found.and_then(|report| self.accept(cx, ws, state, stage, to).map(|()| report));
        if accepted.is_err() {
            augmentation.take_back(state);
        }
        self.augmentation = Some(augmentation);
        accepted
    }

    /// Finds the equilibrium without depth from the one at hand; the history of `state` then has its multipliers.
    ///
    /// # Errors
    /// See [`Failure`].
    fn close_contacts(
        &mut self,
        augmentation: &mut Augmentation,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        stage: &Stage,
        mut report: StepReport,
    ) -> Result<StepReport, Failure> {
        let (to, mut count) = (report.to, 1);
        while augmentation.augment(cx, ws, state, to, count)? {
            report = report.then(self.equilibrate_again(cx, ws, state, stage, to)?);
            count += 1;
        }
        if count > 1 {
            contacts::check_passage(cx, ws, state, to - state.time)?;
        }
        Ok(report)
    }

    /// Finds the equilibrium of a stage, from its prediction; `state` is only read.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn find(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let ahead = stage.scheme.instant * (to - state.time);
        contacts::check_length(cx, state, ahead)?;
        self.massless.check_start(cx, state, stage, ahead)?;
        self.predict(cx, ws, state, stage);
        let report = self.equilibrate(cx, ws, state, stage, to, None)?;
        contacts::check_passage(cx, ws, state, ahead)?;
        Ok(report)
    }

    /// Finds an equilibrium inside a step that was taken, as [`Newton::find`]: what is learnt there of matrices and contraction does not
    /// count for the steps.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn find_inside(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let inside = self.refresh.inside();
        let (refresh, ending) = (std::mem::replace(&mut self.refresh, inside), self.ending);
        let found = self.find(cx, ws, state, stage, to);
        (self.refresh, self.ending) = (refresh, ending);
        match &found {
            Ok(report) if report.factorizations == 0 => {}
            Ok(report) => self.refresh.done(matrix_key(stage.scheme, report.to - state.time)),
            Err(_) => self.discard_matrix(),
        }
        found
    }

    /// Writes the prediction of a step and forgets earlier corrections.
    pub fn predict(&mut self, cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage) {
        self.forget_corrections();
        motion::predict(cx, ws, state, stage);
    }

    /// Accepts the equilibrium that was found.
    ///
    /// # Errors
    /// As for [`accept`]; `state` is untouched.
    pub fn accept(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        stage: &Stage,
        to: f64,
    ) -> Result<(), Failure> {
        self.accept_with(cx, ws, state, stage, to, None)
    }

    /// Accepts the equilibrium that was found at the end of a step whose stages tell the work of loads and damping.
    ///
    /// # Errors
    /// As for [`accept`]; `state` is untouched.
    pub fn accept_with(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        stage: &Stage,
        to: f64,
        work: Option<WorkQuadrature>,
    ) -> Result<(), Failure> {
        let from = state.time;
        let now = Configuration {
            nodes: &ws.trial,
            history: &state.history,
            dt: stage.scheme.instant * (to - from),
            lead: None,
        };
        self.massless.check(cx, &now, stage)?;
        let accepted = accept(cx, ws, self.projection.as_mut(), state, stage, to, work);
        if let (Ok(()), Some(stability)) = (&accepted, &mut self.stability)
            && stability.check(cx, ws, state, from, self.grows)
        {
            self.discard_matrix();
        }
        match &accepted {
            Ok(()) => {}
            Err(Failure::ConstraintsViolated { .. }) => self.discard_matrix(),
            Err(_) => self.forget_iterates(),
        }
        accepted
    }

    /// Forgets the iterates of a step that is not taken after all.
    pub fn forget_iterates(&mut self) {
        self.lead.forget();
    }

    /// Discards the matrix at hand, which belongs to a motion that was not taken or to other loads.
    pub fn discard_matrix(&mut self) {
        self.refresh.rejected();
        self.lead.forget();
        if let Some(turning) = &mut self.turning {
            turning.rest();
        }
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
        let found = self.iterate(cx, ws, state, stage, (to, true), constraint);
        self.arrive(cx, ws, state, found)
    }

    /// Finds the equilibrium anew from the one at hand, under contact forces that have been changed.
    ///
    /// # Errors
    /// See [`Failure`].
    fn equilibrate_again(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> Result<StepReport, Failure> {
        self.forget_corrections();
        let found = self.iterate(cx, ws, state, stage, (to, false), None);
        self.arrive(cx, ws, state, found)
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
        match &found {
            Ok(report) => {
                ws.load_steps.peak.keep(report.residual);
                self.refresh.accepted(report.iterations);
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
        (to, predicted): (f64, bool),
        mut constraint: Option<(&mut ArcLengthConstraint, Condition)>,
    ) -> Result<StepReport, Failure> {
        motion::excite(cx, ws, state.time, to, stage.scheme.instant);
        if !cx.is_dynamic() {
            ws.load_steps.peak.begin_step(&ws.loads.instant, &ws.prescribed.end, cx.length);
        }
        let mut progress = Progress::begin(cx, to, cx.plan.linear && constraint.is_none(), &self.ending);
        progress.predicted = predicted;
        loop {
            let to = progress.report.to;
            progress.report.residual = match std::mem::take(&mut progress.predicted) {
                true if constraint.is_none() => self.residual_of_prediction(cx, ws, state, stage, to),
                _ => evaluate_residual(cx, ws, state, stage, to),
            };
            if !progress.report.residual.is_finite() {
                if !self.require_fresh_matrix(cx, ws, state, stage, &mut progress) {
                    return Err(residual::not_finite(cx, ws));
                }
                continue;
            }
            if self.shorten_correction(cx, ws, progress.report.residual) {
                continue;
            }
            let formed = progress.report.factorizations;
            self.refresh_matrix(cx, ws, state, stage, &mut progress.report)?;
            progress.new_matrix = progress.report.factorizations > formed;
            self.solve(cx, ws, progress.report.residual);
            if let Some((constraint, condition)) = &mut constraint {
                let to = constraint.close(cx, ws, state, progress.report.to, *condition)?;
                progress.move_time(cx, to);
            }
            let (correction, motion) = self.correct(cx, ws);
            match self.judge(cx, ws, correction, motion, &mut progress)? {
                Verdict::Converged => return Ok(progress.report),
                Verdict::GoOn => {}
                Verdict::Restart => self.restart(cx, ws, state, stage, &mut progress),
                Verdict::Exhausted => {
                    if !self.require_fresh_matrix(cx, ws, state, stage, &mut progress) {
                        return Err(not_converged(cx, ws, &progress.report, self.opened.clone()));
                    }
                    progress.limit += cx.model.solution.iteration.limit;
                }
            }
        }
    }

    /// The residual of a prediction, relative to the largest forces. Where material yields and supports move in statics, it is linearized in
    /// their motion: they alone would strain the elements beside them beyond yield, and the matrix of such a state leads nowhere.
    fn residual_of_prediction(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        to: f64,
    ) -> f64 {
        /// Part of the motion by which the residual is differentiated; a power of two, so that it is taken back exactly.
        const PART: f64 = 1.0 / (1 << 20) as f64;
        let moves = |given: &Prescribed| given.u != 0.0;
        if cx.is_dynamic() || !cx.system.yields() || !ws.prescribed.instant.iter().any(moves) {
            return evaluate_residual(cx, ws, state, stage, to);
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
        size
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

    /// Forms and factorizes the matrix where that is due.
    ///
    /// # Errors
    /// [`Failure::Singular`] where it cannot be factorised.
    fn refresh_matrix(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: &Stage,
        report: &mut StepReport,
    ) -> Result<(), Failure> {
        let dt = report.to - state.time;
        let key = matrix_key(stage.scheme, dt);
        if self.refresh.due(report.iterations, key) {
            self.form_matrix(cx, ws, state, stage.scheme, stage.scheme.instant * dt)?;
            if let Some(turning) = &mut self.turning {
                turning.note(&ws.trial);
            }
            self.refresh.done(key);
            self.forget_corrections();
            report.factorizations += 1;
        }
        Ok(())
    }

    /// Forms and factorizes the matrix. It may be singular where everything that resists has yielded; the elastic
    /// matrix then leads on.
    fn form_matrix(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        scheme: &Coefficients,
        ahead: f64,
    ) -> Result<(), Failure> {
        let (rate, acceleration) = scheme.weights();
        self.mass_weight = acceleration;
        let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead, lead: self.lead.nodes() };
        ws.matrix.make_room(cx, &now);
        let mut moduli = self.refresh.moduli();
        // What lifts off, or goes slack, may leave a mechanism behind.
        let open = if cx.is_dynamic() { 0 } else { mechanism::open_elements(cx.system, &now) };
        match self.searched {
            Some(known) if open > known => {
                // Where nothing was open before, it may have opened as the last step ended.
                let before = (known > 0).then(|| state.configuration());
                self.opened = mechanism::opened_part(cx.model, cx.system, before.as_ref(), &now).or(self.opened.take());
            }
            Some(known) if open < known => self.opened = None,
            _ => {}
        }
        let search = !cx.is_dynamic() && self.searched.is_none_or(|known| open > known);
        // Shorter steps do not change what holds the scene before it moves.
        let at_start =
            self.searched.is_none() && state.time == 0.0 && ws.prescribed.instant.iter().all(|given| given.u == 0.0);
        loop {
            let weights = TangentWeights { stiffness: true, rate, acceleration, turning: scheme.turning, moduli };
            let (matrix, loads) = (&mut ws.matrix, &ws.loads.instant);
            matrix.assembly.tangent(cx.system, &now, loads, &mut ws.forces, weights, &mut matrix.solver);
            ws.factorizations += 1;
            match matrix.factor(cx) {
                Ok(false) => return Err(Failure::Stopped),
                Ok(true) if !search => {
                    self.searched = self.searched.map(|_| open);
                    return Ok(());
                }
                Ok(true) => {
                    let (solver, dofs) = (&mut matrix.solver, &cx.plan.dofs);
                    let mechanism = mechanism::find(cx.system, dofs, solver, &now, weights, cx.length);
                    let Some(place) = mechanism else {
                        self.searched = Some(open);
                        return Ok(());
                    };
                    let open = mechanism::open_part(cx.model, cx.system, &now, place.0).or_else(|| self.opened.clone());
                    return Err(Failure::mechanism(cx.model, place, open, at_start));
                }
                Err(_) if moduli == Moduli::Algorithmic && cx.system.history > 0 => moduli = Moduli::Elastic,
                Err(singular) => {
                    let place = cx.plan.dofs.nodal_dofs().get(singular.row);
                    let open = place.and_then(|&(node, _)| mechanism::open_part(cx.model, cx.system, &now, node));
                    let open = open.or_else(|| self.opened.clone());
                    return Err(Failure::singular(cx.model, cx.plan, cx.system, singular.row, (open, at_start)));
                }
            }
        }
    }

    /// Solves for the correction, which takes the place of the residual in `ws.r`.
    fn solve(&mut self, cx: &Context, ws: &mut Workspace, residual: f64) {
        if let Some(line_search) = &mut self.line_search {
            line_search.keep_residual(&ws.r[..cx.nodal_unknowns()], residual);
        }
        let Workspace { matrix, forces, r, trial, .. } = ws;
        turned(&mut self.turning, trial, r, |r| matrix.solve_augmented(&forces.multipliers, r));
        ws.solves += 1;
    }

    /// Solves with the matrix at hand, carried along to the configuration `nodes`, for right-hand sides without gaps in `ws.r`.
    pub fn solve_at(&mut self, ws: &mut Workspace, nodes: &[Node]) {
        let Workspace { matrix, r, .. } = ws;
        turned(&mut self.turning, nodes, r, |r| matrix.solver.solve(r));
        ws.solves += 1;
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
        progress: &mut Progress,
    ) -> Result<Verdict, Failure> {
        let Progress { report, convergence, new_matrix, limit, time_error, .. } = progress;
        report.iterations += 1;
        let size = relative(cx, correction, motion);
        if !size.is_finite() {
            return Err(residual::not_finite(cx, ws));
        }
        let fresh = report.factorizations > 0;
        let quadratic = *new_matrix && self.ending.carries && cx.system.history == 0;
        if report.iterations == 1
            && let Some(tolerances) = self.ending.of_step(size, report.residual)
        {
            convergence.adopt(tolerances);
        }
        let judgement = convergence.judge(size, report.residual, quadratic);
        self.ending.note(&judgement);
        if self.ending.carries {
            self.refresh.note(report.iterations, fresh, size, &judgement);
        }
        if *time_error <= self.ending.tolerance
            && self.has_converged(cx, ws, correction, (fresh, report.iterations >= *limit), report.residual, &judgement)
        {
            return Ok(Verdict::Converged);
        }
        if report.iterations >= *limit {
            return Ok(Verdict::Exhausted);
        }
        // The second correction may well be longer than the first, which begins from what was predicted.
        if judgement.grows && report.iterations > 2 && *new_matrix && self.lead.mistrust() {
            return Ok(Verdict::Restart);
        }
        let misled = judgement.seen && self.refresh.advise(fresh, &judgement) == Advice::Restart;
        Ok(if misled { Verdict::Restart } else { Verdict::GoOn })
    }

    /// Judges convergence. Where material yields, one contraction says little of the next, and what is small against
    /// positions may be large against elastic strains: the residual must have decreased as well, or nothing but rounding be
    /// left.
    fn has_converged(
        &self,
        cx: &Context,
        ws: &mut Workspace,
        correction: Size,
        (fresh, last): (bool, bool),
        residual: f64,
        judgement: &Judgement,
    ) -> bool {
        let sure = cx.system.history == 0 || residual <= (1e3 * judgement.tolerance).min(1e-3);
        let small = is_rounding(cx, ws, correction, fresh && sure);
        let rounding = judgement.stalled() && small;
        if sure && judgement.converged() {
            return true;
        }
        // Corrections below the digits of positions still matter to a motion that is small itself: a load step waits for its forces.
        let precise = cx.is_dynamic()
            || residual <= UNBALANCED * self.ending.tolerance
            || ws.load_steps.peak.is_unstressed(residual);
        if small && !precise && (last || rounding && judgement.is_stagnant()) {
            ws.warnings.add(Warning::Unbalanced { residual });
            return true;
        }
        rounding && precise
    }

    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage, progress: &mut Progress) {
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
        progress: &mut Progress,
    ) -> bool {
        let again = self.refresh.require_fresh_matrix();
        if again {
            self.restart(cx, ws, state, stage, progress);
        }
        again
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

/// Solves in the configuration of the matrix at hand for right-hand sides in that of `nodes`.
fn turned(turning: &mut Option<Turning>, nodes: &[Node], r: &mut [f64], solve: impl FnOnce(&mut [f64])) {
    let Some(turning) = turning else { return solve(r) };
    let turns = turning.take_back(nodes, r);
    solve(r);
    if turns {
        turning.carry_along(nodes, r);
    }
}

/// Moves the trial motion to the increments at hand and writes its residual. Returns the relative size of the residual.
fn evaluate_residual(cx: &Context, ws: &mut Workspace, state: &State, stage: &Stage, to: f64) -> f64 {
    motion::move_trial(cx, ws, state, stage);
    let ahead = stage.scheme.instant * (to - state.time);
    let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead, lead: None };
    let scale = cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
    let scale = if cx.is_dynamic() { scale } else { ws.load_steps.peak.scale(scale) };
    residual::gather(cx, ws, &scale)
}

/// The quantity on which the matrix of a step depends besides the motion: the length of the step, or the time over
/// which its rates are taken.
fn matrix_key(scheme: &Coefficients, dt: f64) -> f64 {
    if scheme.rate[0] > 0.0 { 1.0 / scheme.rate[0] } else { dt }
}

/// A load step that ends at rounding with a residual larger than the tolerance by this factor is not what was asked for.
const UNBALANCED: f64 = 1e3;

fn not_converged(cx: &Context, ws: &mut Workspace, report: &StepReport, open: Option<String>) -> Failure {
    // Forces balance while the joints are open: the constraints contradict each other.
    if report.residual < 1e-3
        && let Err(violated) = joints::check(cx, ws)
    {
        return violated;
    }
    let load_control = !cx.is_dynamic() && !cx.model.analysis.step_length.is_arc_length();
    Failure::NotConverged { iterations: report.iterations, load_control, open, largest: residual::largest(cx, ws) }
}
