//! Steps of central differences at a fraction of the critical time step.

use super::adaptive::StepController;
use crate::context::Context;
use crate::explicit::CentralDifferenceStepper;
use crate::failure::Failure;
use crate::report::StepReport;
use crate::tolerances::stability_limited::GROWTH;
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::state::State;

/// Leads central differences by the critical time step.
pub struct StabilityController {
    stepper: Box<CentralDifferenceStepper>,
    /// Fraction of the critical time step that is taken.
    fraction: f64,
    /// Longest step after the last one: a little longer than a success, half of a failure.
    longest: f64,
}

keep!(StabilityController { stepper, longest } without { fraction });

impl StabilityController {
    /// A controller at this fraction of the critical time step.
    pub fn new(stepper: Box<CentralDifferenceStepper>, fraction: f64) -> StabilityController {
        StabilityController { stepper, fraction, longest: f64::INFINITY }
    }
}

impl StepController for StabilityController {
    fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        self.stepper.restart(cx, ws, state);
    }

    fn propose(&mut self, cx: &Context, ws: &mut Workspace, state: &State, left: f64) -> Result<f64, Failure> {
        let stable = self.stepper.propose(cx, ws, state, left, self.fraction)?;
        // The length does not fall below the least step: if that fails too, its failure says why.
        Ok(stable.min(self.longest).max(cx.model.analysis.least_step))
    }

    fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
        length: f64,
    ) -> Result<Option<StepReport>, Failure> {
        let report = self.stepper.step(cx, ws, state, to)?;
        self.longest = GROWTH * length;
        Ok(Some(report))
    }

    fn cut_back(&mut self, dt: f64) {
        self.longest = 0.5 * dt;
    }
}
