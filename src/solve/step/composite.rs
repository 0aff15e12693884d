//! A step in two stages; the second stage also uses the start of the step (Bathe's scheme).

use crate::context::Context;
use crate::failure::Failure;
use crate::report::StepReport;
use crate::step::equilibrium::EquilibriumSolver;
use crate::step::trial::{Stage, rates_of};
use crate::workspace::Workspace;
use base::math::rotation::inverse_tangent;
use base::math::{Vec3, Vec6, angular, stack};
use base::snapshot::keep;
use mechanics::integrators::TwoStages;
use mechanics::state::State;

/// The scheme, with the data of the first stage that its second needs. It is allocated once.
pub struct Composite<'a> {
    scheme: &'a dyn TwoStages,
    /// The state at the start of the step.
    start: State,
    /// Velocities and accelerations that the second stage uses at its start, by node.
    start_rates: Vec<[Vec6; 2]>,
    /// For each turning body, the substitutes for its accelerations at the start of the second stage.
    turning: Vec<[Vec3; 2]>,
}

keep!(Composite<'_> { start, start_rates, turning } without { scheme });

impl<'a> Composite<'a> {
    /// Room for the start of a step of this many nodes.
    pub fn new(scheme: &'a dyn TwoStages, nodes: usize) -> Self {
        Composite { scheme, start: State::default(), start_rates: vec![[Vec6::zeros(); 2]; nodes], turning: Vec::new() }
    }

    /// Prepares for a run from this state.
    pub fn begin(&mut self, state: &State) {
        self.start.clone_from(state);
    }

    /// Takes `state` from its time to the time `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// As for [`EquilibriumSolver::stage`].
    pub fn step(
        &mut self,
        solver: &mut EquilibriumSolver,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        self.start.copy_from(state);
        let result = self.stages(solver, cx, ws, state, to);
        if result.is_err() {
            state.copy_from(&self.start);
        }
        result
    }

    fn stages(
        &mut self,
        solver: &mut EquilibriumSolver,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let dt = to - state.time;
        let between = state.time + self.scheme.split() * dt;
        let first = solver.stage(cx, ws, state, &Stage::from(&cx.model.solution.scheme.coefficients(dt)), between)?;
        self.look_back(cx, ws, state, dt);
        let scheme = self.scheme.second(dt);
        let stage = Stage {
            scheme: &scheme,
            start_rates: Some(&self.start_rates),
            turning: Some(&self.turning),
            prediction: None,
        };
        let second = solver.stage(cx, ws, state, &stage, to)?;
        Ok(first.then(second))
    }

    /// Writes the motion of the first stage and the velocities at both of its ends in the form that the second stage
    /// uses.
    fn look_back(&mut self, cx: &Context, ws: &Workspace, between: &State, dt: f64) {
        let b = self.scheme.backward(dt);
        for &node in &cx.independent_nodes {
            let start = &self.start.nodes[node];
            // The velocity at the start of the step belongs to the rotation vector counted from between the stages.
            let q0 = ws.end.increments[node].q;
            let v0 = stack(&start.v, &inverse_tangent(&-angular(&q0), &start.omega));
            let [v, _] = rates_of(&between.nodes[node]);
            self.start_rates[node] = [q0 * b.start, v0 * b.start + v * b.between];
        }
        self.turning.clear();
        self.turning.extend(cx.system.turning_bodies().iter().map(|body| {
            let nodes = [&self.start.nodes[body.node], &between.nodes[body.node]];
            let combined = |of: [Vec3; 2]| of[0] * b.start + of[1] * b.between;
            [combined(nodes.map(|node| body.momentum(node))), combined(nodes.map(|node| node.R().tr_mul(&node.omega)))]
        }));
    }
}
