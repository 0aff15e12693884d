//! A guard, and the points of a step where it acts.

use crate::context::Context;
use crate::failure::Failure;
use crate::step::trial::Step;
use crate::workspace::Workspace;
use base::snapshot::Snapshot;
use mechanics::materials::Dissipation;
use mechanics::state::State;

/// Refuses steps, or warns of them. A model has only the guards listed in its plan.
pub trait Guard {
    /// Before anything of a step is computed.
    ///
    /// # Errors
    /// Why the step is not to be begun.
    fn before_step(&mut self, _cx: &Context, _step: &Step) -> Result<(), Failure> {
        Ok(())
    }

    /// After a correction has been added and judged.
    ///
    /// # Errors
    /// Why the iteration ends without an equilibrium.
    fn at_iterate(&mut self, _cx: &Context, _ws: &Workspace, _step: &Step, _iterate: &Iterate) -> Result<(), Failure> {
        Ok(())
    }

    /// After each equilibrium, including those of stages of the step.
    ///
    /// # Errors
    /// Why it is not taken.
    fn at_equilibrium(&mut self, _cx: &Context, _ws: &Workspace, _step: &Step) -> Result<(), Failure> {
        Ok(())
    }

    /// After the last equilibrium of the step, before the motion is extrapolated to the end of the step.
    ///
    /// # Errors
    /// Why the step is not taken.
    fn before_end(&mut self, _cx: &Context, _ws: &mut Workspace, _step: &Step) -> Result<(), Failure> {
        Ok(())
    }

    /// With the motion at the end of the step and the dissipation of materials and contacts, before it becomes the state.
    ///
    /// # Errors
    /// Why the step is not taken.
    fn at_end(
        &mut self,
        _cx: &Context,
        _ws: &mut Workspace,
        _step: &Step,
        _dissipated: &Dissipation,
    ) -> Result<(), Failure> {
        Ok(())
    }

    /// After a step was taken.
    fn after_step(&mut self, _cx: &Context, _ws: &mut Workspace, _taken: &Taken) {}

    /// Forgets earlier runs of the same scene.
    fn begin_run(&mut self) {}

    /// Saves the variables that change from step to step.
    fn keep(&mut self, _snapshot: &mut Snapshot) {}
}

/// An iterate: a correction that was added.
pub struct Iterate {
    /// Its number, from 1.
    pub number: usize,
    /// True where its matrix was formed for it.
    pub new_matrix: bool,
    /// True where the iteration ends with it.
    pub converged: bool,
}

/// A step that was taken.
pub struct Taken<'s> {
    /// The state at its end.
    pub state: &'s State,
    /// The time at its start.
    pub from: f64,
    /// True where loads grow along the path; a path of given arc length may go back.
    pub grows: bool,
}
