//! The implicit stepper that controllers use.

use super::composite::Composite;
use super::newton::Newton;
use crate::integrators::{Coefficients, Stepping, load_steps};
use crate::linear::TooLarge;
use crate::solve::context::Context;
use crate::solve::failure::Failure;
use crate::solve::motion::Stage;
use crate::solve::report::StepReport;
use crate::solve::workspace::Workspace;
use crate::state::State;

/// Takes load steps of a static analysis, and time steps of one stage or two.
pub struct Implicit<'a> {
    /// The equilibrium iteration.
    pub newton: Newton,
    /// The second stage of a scheme that has two.
    composite: Option<Composite<'a>>,
}

impl<'a> Implicit<'a> {
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context<'a>) -> Result<Self, TooLarge> {
        let composite = match cx.model.solution.scheme.stepping() {
            Stepping::Composite(stages) if cx.is_dynamic() => Some(Composite::new(stages, cx.model.nodes.len())),
            _ => None,
        };
        Ok(Implicit { newton: Newton::new(cx)?, composite })
    }

    /// Prepares for a run from this state, or for going on from it after a jump of the loads.
    pub fn restart(&mut self, state: &State) {
        self.newton.discard_matrix();
        if let Some(composite) = &mut self.composite {
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
        match &mut self.composite {
            Some(composite) => composite.step(&mut self.newton, cx, ws, state, to),
            None => {
                let scheme = coefficients(cx, to - state.time);
                self.newton.stage(cx, ws, state, &Stage::from(&scheme), to)
            }
        }
    }
}

fn coefficients(cx: &Context, dt: f64) -> Coefficients {
    if cx.is_dynamic() { cx.model.solution.scheme.coefficients(dt) } else { load_steps::coefficients() }
}
