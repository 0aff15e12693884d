//! A stage of a step: the equilibrium is found from a prediction, its contacts are closed, it is judged and accepted.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::Taken;
use crate::guards::list::Guards;
use crate::report::StepReport;
use crate::step::accept::accept;
use crate::step::newton::Newton;
use crate::step::projection::ConstraintProjection;
use crate::step::trial::{Stage, Step, TrialMotion};
use crate::step::work::WorkQuadrature;
use crate::strategy::arc_length::PathCondition;
use crate::strategy::augmentation::Augmentation;
use crate::workspace::Workspace;
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::state::State;

/// Takes the stages of implicit steps. Parts that a model does not need are `None`.
pub struct EquilibriumSolver {
    /// The equilibrium iteration.
    pub newton: Newton,
    /// The guards that refuse steps or warn of them.
    guards: Guards,
    /// Projection onto the constraints in a dynamic analysis with joints.
    projection: Option<ConstraintProjection>,
    /// The augmentation that closes contacts without penetration in load steps.
    augmentation: Option<Box<Augmentation>>,
    /// True if loads grow along the path at the current equilibrium; with arc-length control they may fall.
    pub grows: bool,
}

keep!(EquilibriumSolver { newton, guards, projection, grows } without { augmentation });

impl EquilibriumSolver {
    /// # Errors
    /// There is no memory for the projection onto joints, or for the matrices of a guard.
    pub fn new(cx: &Context) -> Result<EquilibriumSolver, TooLarge> {
        Ok(EquilibriumSolver {
            newton: Newton::new(cx),
            projection: ConstraintProjection::for_analysis(cx)?,
            guards: Guards::of(cx)?,
            augmentation: Augmentation::of(cx).map(Box::new),
            grows: true,
        })
    }

    /// Discards the statistics of earlier runs of the same model.
    pub fn begin_run(&mut self, cx: &Context) {
        (self.newton, self.grows) = (Newton::new(cx), true);
        self.guards.tell(|guard| guard.begin_run());
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
        let report = self.find(cx, ws, &Step { state, stage: *stage, to })?;
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

    /// Finds the equilibrium without penetration from the current one and writes its contact multipliers to the history of `state`.
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
            let step = Step { state, stage: *stage, to };
            report = report.then(self.newton.equilibrate_again(cx, ws, &mut self.guards, step)?);
            count += 1;
        }
        if count > 1 {
            let step = Step { state, stage: *stage, to };
            self.guards.ask(|guard| guard.at_equilibrium(cx, ws, &step))?;
        }
        Ok(report)
    }

    /// Finds the equilibrium of a stage, from its prediction.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn find(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) -> Result<StepReport, Failure> {
        self.guards.ask(|guard| guard.before_step(cx, step))?;
        self.newton.predict(cx, ws, step);
        let report = self.equilibrate(cx, ws, *step, None)?;
        self.guards.ask(|guard| guard.at_equilibrium(cx, ws, step))?;
        Ok(report)
    }

    /// As [`Newton::equilibrate`], with the guards of the scene.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: Step,
        path: Option<PathCondition>,
    ) -> Result<StepReport, Failure> {
        self.newton.equilibrate(cx, ws, &mut self.guards, step, path)
    }

    /// Finds an equilibrium inside a completed step, like [`EquilibriumSolver::find`]. The statistics of matrices and contraction are not
    /// changed.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn find_inside(&mut self, cx: &Context, ws: &mut Workspace, step: &Step) -> Result<StepReport, Failure> {
        let steps = self.newton.begin_inside();
        let found = self.find(cx, ws, step);
        self.newton.end_inside(steps);
        match &found {
            Ok(report) if report.factorizations == 0 => {}
            Ok(_) => self.newton.matrix.note_formed(step.stage.scheme, step.dt()),
            Err(_) => self.newton.discard_matrix(),
        }
        found
    }

    /// True if motion is projected onto the constraints of joints.
    pub fn projects(&self) -> bool {
        self.projection.is_some()
    }

    /// Projects the velocities of the trial motion, at a stage inside a step, onto the constraints; `reach` is the largest coordinate of a node.
    ///
    /// # Errors
    /// As for [`ConstraintProjection::project`].
    pub fn project_velocities(
        &mut self,
        cx: &Context,
        (trial, reach): (&mut TrialMotion, f64),
        step: &Step,
    ) -> Result<(), Failure> {
        let Some(projection) = &mut self.projection else { return Ok(()) };
        projection.project_velocities(cx, (trial, reach), step.state, (step.stage.scheme, step.dt()))
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
        self.accept_with(cx, ws, state, (stage, to), None)
    }

    /// Accepts the equilibrium at the end of a step with stages; `work` is the work of loads and damping by quadrature over the stages.
    ///
    /// # Errors
    /// As for [`accept`]; `state` is untouched.
    pub fn accept_with(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        (stage, to): (&Stage, f64),
        work: Option<WorkQuadrature>,
    ) -> Result<(), Failure> {
        let from = state.time;
        let EquilibriumSolver { guards, projection, grows, .. } = self;
        let step = Step { state, stage: *stage, to };
        let judged = guards.ask(|guard| guard.before_end(cx, ws, &step));
        let accepted =
            judged.and_then(|()| accept(cx, ws, (&mut *guards, projection.as_mut()), state, (stage, to), work));
        if accepted.is_ok() {
            let taken = Taken { state, from, grows: *grows };
            guards.tell(|guard| guard.after_step(cx, ws, &taken));
        }
        self.newton.matrix.refresh.end_step();
        let overwritten = std::mem::take(&mut ws.matrix.overwritten);
        match &accepted {
            Ok(()) if !overwritten => {}
            Err(failure) if !overwritten && !failure.blames_matrix() => self.newton.forget_iterates(),
            _ => self.newton.discard_matrix(),
        }
        accepted
    }
}
