//! The implicit stepper that controllers use.

use crate::context::Context;
use crate::failure::Failure;
use crate::report::StepReport;
use crate::step::composite::Composite;
use crate::step::equilibrium::EquilibriumSolver;
use crate::step::runge_kutta::StageStepper;
use crate::step::trial::Stage;
use crate::workspace::Workspace;
use base::snapshot::{Keep, Snapshot, keep};
use linear::TooLarge;
use mechanics::integrators::Stepping;
use mechanics::state::State;

/// Takes load steps of a static analysis, and time steps of one stage or several.
pub struct Implicit<'a> {
    /// The solver of their stages.
    pub solver: EquilibriumSolver,
    stages: Stages<'a>,
}

keep!(Implicit<'_> { solver, stages });

/// The stages of a step, with their data besides the iteration.
enum Stages<'a> {
    One,
    Composite(Composite<'a>),
    RungeKutta(StageStepper),
}

impl Keep for Stages<'_> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        match self {
            Stages::One => {}
            Stages::Composite(composite) => composite.keep(snapshot),
            Stages::RungeKutta(stages) => stages.keep(snapshot),
        }
    }
}

impl<'a> Implicit<'a> {
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context<'a>) -> Result<Self, TooLarge> {
        let stages = match cx.model.solution.scheme.stepping() {
            Stepping::Composite(scheme) if cx.is_dynamic() => {
                Stages::Composite(Composite::new(scheme, cx.model.nodes.len()))
            }
            Stepping::DiagonallyImplicit(tableau) if cx.is_dynamic() => {
                Stages::RungeKutta(StageStepper::new(cx, tableau))
            }
            _ => Stages::One,
        };
        Ok(Implicit { solver: EquilibriumSolver::new(cx)?, stages })
    }

    /// The stages of a Runge-Kutta scheme; `None` for others.
    pub fn stages(&self) -> Option<&StageStepper> {
        match &self.stages {
            Stages::RungeKutta(stages) => Some(stages),
            Stages::One | Stages::Composite(_) => None,
        }
    }

    /// Writes the state at a time inside the last step, given by its start state and end time; `None` if the scheme interpolates no motion.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn look_inside(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        step: (&State, f64),
        (state, time): (&mut State, f64),
    ) -> Result<Option<StepReport>, Failure> {
        match &mut self.stages {
            Stages::RungeKutta(stages) => stages.look_inside(&mut self.solver, cx, ws, step, (state, time)).map(Some),
            // Steps of other schemes end at every time of evaluation.
            Stages::One | Stages::Composite(_) => Ok(None),
        }
    }

    /// Forgets earlier runs of the same scene.
    pub fn begin_run(&mut self, cx: &Context) {
        self.solver.begin_run(cx);
    }

    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    pub fn restart(&mut self, state: &State) {
        self.solver.newton.discard_matrix();
        if let Stages::Composite(composite) = &mut self.stages {
            composite.begin(state);
        }
    }

    /// Takes `state` from its time to the time `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        match &mut self.stages {
            Stages::Composite(composite) => composite.step(&mut self.solver, cx, ws, state, to),
            Stages::RungeKutta(stages) => stages.step(&mut self.solver, cx, ws, state, to),
            Stages::One => {
                let scheme = self.solver.newton.regime.coefficients(cx, to - state.time);
                self.solver.stage(cx, ws, state, &Stage::from(&scheme), to)
            }
        }
    }
}
