//! The time steppers, one variant for each kind of step.

use super::context::Context;
use super::explicit::{CentralDifferenceStepper, RungeKuttaStepper};
use super::failure::Failure;
use super::jumps;
use super::report::StepReport;
use super::workspace::Workspace;
use crate::step::implicit::Implicit;
use base::snapshot::{Keep, Snapshot};
use linear::TooLarge;
use mechanics::integrators::Stepping;
use mechanics::state::State;

/// A stepper for steps of given length.
pub enum TimeStepper<'a> {
    /// Steps with equilibrium iterations, statics included.
    Implicit(Box<Implicit<'a>>),
    /// Velocity Verlet steps.
    CentralDifference(Box<CentralDifferenceStepper>),
    /// Steps of an explicit Runge-Kutta scheme.
    RungeKutta(Box<RungeKuttaStepper>),
}

impl Keep for TimeStepper<'_> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        match self {
            TimeStepper::Implicit(stepper) => stepper.keep(snapshot),
            TimeStepper::CentralDifference(stepper) => stepper.keep(snapshot),
            TimeStepper::RungeKutta(stepper) => stepper.keep(snapshot),
        }
    }
}

impl<'a> TimeStepper<'a> {
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(cx: &Context<'a>) -> Result<Self, TooLarge> {
        Ok(match cx.model.solution.scheme.stepping() {
            Stepping::Verlet if cx.is_dynamic() => {
                TimeStepper::CentralDifference(Box::new(CentralDifferenceStepper::new(cx)?))
            }
            Stepping::RungeKutta(tableau) if cx.is_dynamic() => {
                TimeStepper::RungeKutta(Box::new(RungeKuttaStepper::new(cx, tableau)?))
            }
            _ => TimeStepper::Implicit(Box::new(Implicit::new(cx)?)),
        })
    }

    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    pub fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        match self {
            TimeStepper::Implicit(stepper) => stepper.restart(state),
            TimeStepper::CentralDifference(stepper) => stepper.restart(cx, ws, state),
            TimeStepper::RungeKutta(_) => {}
        }
    }

    /// Takes the state over a failure of material or of a link in the step of length `dt` that was taken last, as [`jumps::release`] does.
    /// Central differences compute new accelerations in every step, and their steps are so short that an error over half a step is
    /// negligible.
    ///
    /// # Errors
    /// [`Failure::Singular`] where a mass matrix cannot be inverted.
    pub fn release(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State, dt: f64) -> Result<(), Failure> {
        if let TimeStepper::CentralDifference(_) = self {
            return Ok(());
        }
        jumps::release(cx, ws, state, dt)?;
        if let TimeStepper::Implicit(stepper) = self {
            stepper.restart(state);
        }
        Ok(())
    }

    /// Discards the iterates of the last step, which is undone.
    pub fn forget_iterates(&mut self) {
        if let TimeStepper::Implicit(stepper) = self {
            stepper.solver.newton.forget_iterates();
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
        match self {
            TimeStepper::Implicit(stepper) => stepper.step(cx, ws, state, to),
            TimeStepper::CentralDifference(stepper) => stepper.step(cx, ws, state, to),
            TimeStepper::RungeKutta(stepper) => stepper.step(cx, ws, state, to),
        }
    }
}
