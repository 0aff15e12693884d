//! A step in two stages, of which the second looks back to the start of the step.

use super::failure::Failure;
use super::step::{Stepper, Taken};
use crate::integrators::TwoStages;
use crate::math::rotation::inverse_tangent;
use crate::math::{Vec6, bottom, join};
use crate::state::State;

/// Allocated once.
pub struct Composite {
    /// The state at the start of the step.
    start: State,
    /// See [`Stepper::bases`]; there while the second stage is under way.
    bases: Vec<[Vec6; 2]>,
}

impl Composite {
    pub fn new(start: State) -> Self {
        let bases = vec![[Vec6::zeros(); 2]; start.nodes.len()];
        Composite { start, bases }
    }
}

impl Stepper<'_> {
    /// Takes `state` from its time to `to`. On failure `state` is untouched.
    pub(super) fn composite(&mut self, state: &mut State, to: f64, scheme: &dyn TwoStages) -> Result<Taken, Failure> {
        let mut room = self.composite.take().unwrap_or_else(|| Composite::new(state.clone()));
        room.start.copy_from(state);
        let dt = to - state.time;
        let result = self.stages(state, to, dt, scheme, &mut room);
        if result.is_err() {
            state.copy_from(&room.start);
        }
        self.composite = Some(room);
        result
    }

    fn stages(
        &mut self,
        state: &mut State,
        to: f64,
        dt: f64,
        scheme: &dyn TwoStages,
        room: &mut Composite,
    ) -> Result<Taken, Failure> {
        let first = self.stage(state, &self.model.scheme.coefficients(dt), state.time + scheme.split() * dt)?;
        let b = scheme.backward(dt);
        for &node in &self.movers {
            let (start, between) = (&room.start.nodes[node], &state.nodes[node]);
            // The motion so far, and the velocity at its start in the rotation vector counted from between the stages.
            let q0 = self.increments[node].q;
            let v0 = join(&start.v, &inverse_tangent(&-bottom(&q0), &start.omega));
            let v = join(&between.v, &between.omega);
            room.bases[node] = [q0 * b.start, v0 * b.start + v * b.between];
        }
        self.bases = Some(std::mem::take(&mut room.bases));
        let second = self.stage(state, &scheme.second(dt), to);
        room.bases = self.bases.take().unwrap_or_default();
        let second = second?;
        Ok(Taken {
            iterations: first.iterations + second.iterations,
            refactorizations: first.refactorizations + second.refactorizations,
            ..second
        })
    }
}
