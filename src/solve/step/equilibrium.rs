//! A stage of a step: the equilibrium is found from a prediction, its contacts are closed, it is judged and accepted.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::contacts;
use crate::guards::massless::MasslessNodes;
use crate::guards::stability::Stability;
use crate::report::StepReport;
use crate::step::accept::accept;
use crate::step::newton::Newton;
use crate::step::projection::ConstraintProjection;
use crate::step::trial::Stage;
use crate::step::work::WorkQuadrature;
use crate::strategy::augmentation::Augmentation;
use crate::strategy::refresh::Refresh;
use crate::workspace::Workspace;
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::state::{Configuration, State};
use model::{Method, Update};

/// Takes the stages of implicit steps. What a scene does not need is `None`.
pub struct EquilibriumSolver {
    /// The equilibrium iteration.
    pub newton: Newton,
    /// Projection onto the constraints in a dynamic analysis with joints.
    projection: Option<ConstraintProjection>,
    /// The nodes without mass in a dynamic analysis.
    massless: MasslessNodes,
    /// The watch over the stability of equilibria in statics.
    stability: Option<Stability>,
    /// What closes contacts without depth in load steps.
    augmentation: Option<Box<Augmentation>>,
    /// True where loads grow along the path at the equilibrium at hand; a path of given arc length may go back.
    pub grows: bool,
}

keep!(EquilibriumSolver { newton, projection, massless, stability, grows } without { augmentation });

impl EquilibriumSolver {
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context) -> Result<EquilibriumSolver, TooLarge> {
        let (method, update) = Refresh::rule(cx);
        Ok(EquilibriumSolver {
            newton: Newton::new(cx),
            projection: ConstraintProjection::for_analysis(cx)?,
            massless: MasslessNodes::new(cx),
            stability: Stability::for_statics(cx, update != Update::Iteration || method == Method::InitialLoad)?,
            augmentation: Augmentation::of(cx).map(Box::new),
            grows: true,
        })
    }

    /// Forgets what earlier runs of the same scene have taught the iteration.
    pub fn begin_run(&mut self, cx: &Context) {
        (self.newton, self.massless, self.grows) = (Newton::new(cx), MasslessNodes::new(cx), true);
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
            report = report.then(self.newton.equilibrate_again(cx, ws, state, stage, to)?);
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
        self.newton.predict(cx, ws, state, stage);
        let report = self.newton.equilibrate(cx, ws, state, stage, to, None)?;
        contacts::check_passage(cx, ws, state, ahead)?;
        Ok(report)
    }

    /// Finds an equilibrium inside a step that was taken, as [`EquilibriumSolver::find`]: what is learnt there of matrices and contraction
    /// does not count for the steps.
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
        let steps = self.newton.turn_inside();
        let found = self.find(cx, ws, state, stage, to);
        self.newton.turn_back(steps);
        match &found {
            Ok(report) if report.factorizations == 0 => {}
            Ok(report) => self.newton.matrix.note_formed(stage.scheme, report.to - state.time),
            Err(_) => self.newton.discard_matrix(),
        }
        found
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
        let turned_back = self.newton.has_turned_back(cx, ws);
        let judge = |stability: &mut Stability| stability.judge(cx, ws, state, (to, turned_back));
        let judged = self.stability.as_mut().map_or(Ok(()), judge);
        let accepted = judged.and_then(|()| accept(cx, ws, self.projection.as_mut(), state, stage, to, work));
        if let (Ok(()), Some(stability)) = (&accepted, &mut self.stability)
            && stability.check(cx, ws, state, from, self.grows)
        {
            self.newton.discard_matrix();
        }
        match &accepted {
            Ok(()) => {}
            Err(Failure::ConstraintsViolated { .. } | Failure::UnstableStep | Failure::Buckles(_)) => {
                self.newton.discard_matrix();
            }
            Err(_) if self.stability.as_ref().is_some_and(Stability::has_overwritten) => self.newton.discard_matrix(),
            Err(_) => self.newton.forget_iterates(),
        }
        accepted
    }
}
