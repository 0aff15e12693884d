//! Steps of diagonally implicit Runge-Kutta schemes.
//!
//! What moves is y = (q, q̇), q the increment of the step with its rotation vector: in these coordinates the motion is an ordinary
//! differential equation, and a scheme of order p is of order p for it, rotations included. Every stage finds its equilibrium
//! from the start of the step; the last is the end of the step.

use super::newton::Newton;
use crate::integrators::StageTableau;
use crate::math::Vec6;
use crate::solve::context::Context;
use crate::solve::failure::Failure;
use crate::solve::motion::{Stage, differentiate, excite, move_trial, rates_of};
use crate::solve::report::StepReport;
use crate::solve::work::WorkQuadrature;
use crate::solve::workspace::Workspace;
use crate::state::{Configuration, State};

/// The stages of a step. It is allocated once.
pub struct StageStepper {
    tableau: &'static StageTableau,
    /// Rates (q̇, q̈) of all stages of the last step, stage by stage, of the independent nodes.
    rates: Vec<[Vec6; 2]>,
    /// What the stage at hand starts from, (q*, q̇*)/(γΔt), by node.
    start_rates: Vec<[Vec6; 2]>,
    /// The predicted increments of the stage at hand, by node.
    prediction: Vec<Vec6>,
    /// Weights of the accelerations of earlier stages in the predicted ones, by stage.
    extrapolation: Vec<Vec<f64>>,
    /// Weights of the accelerations of the stages in their second derivative.
    curvature: Vec<f64>,
    work: WorkQuadrature,
    /// True where motion is prescribed, which does work.
    driven: bool,
}

impl StageStepper {
    /// Room for the stages of this scheme.
    pub fn new(cx: &Context, tableau: &'static StageTableau) -> Self {
        let (nodes, moving) = (cx.model.nodes.len(), cx.independent_nodes.len());
        StageStepper {
            tableau,
            rates: vec![[Vec6::zeros(); 2]; tableau.stages() * moving],
            start_rates: vec![[Vec6::zeros(); 2]; nodes],
            prediction: vec![Vec6::zeros(); nodes],
            extrapolation: (0..tableau.stages()).map(|stage| tableau.extrapolation(stage)).collect(),
            curvature: tableau.second_derivative(),
            work: WorkQuadrature::default(),
            driven: cx.model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some()),
        }
    }

    /// Takes `state` from its time to the time `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// As for [`Newton::stage`].
    pub fn step(
        &mut self,
        newton: &mut Newton,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let dt = to - state.time;
        let last = self.tableau.stages() - 1;
        let scheme = cx.model.solution.scheme.coefficients(dt);
        let mut report = StepReport::begin(to);
        self.begin(cx, ws, state, to);
        for stage in 1..=last {
            let time = if stage == last { to } else { state.time + self.tableau.c[stage - 1] * dt };
            self.start_stage(cx, state, stage, dt);
            let relation =
                Stage { scheme: &scheme, start_rates: Some(&self.start_rates), prediction: Some(&self.prediction) };
            report = report.then(newton.find(cx, ws, state, &relation, time)?);
            differentiate(cx, ws, state, &relation);
            if cx.wants_energy {
                move_trial(cx, ws, state, &relation);
                self.account(cx, ws, state, stage, time - state.time, dt);
            }
            self.keep_rates(cx, ws, stage);
        }
        let relation = Stage { scheme: &scheme, start_rates: Some(&self.start_rates), prediction: None };
        newton.accept_with(cx, ws, state, &relation, to, cx.wants_energy.then_some(self.work))?;
        Ok(report)
    }

    /// The fourth derivative of the increments of a node, times Δt², in the step that was taken; `index` counts independent nodes.
    pub fn fourth_derivative(&self, cx: &Context, index: usize) -> Vec6 {
        let moving = cx.independent_nodes.len();
        let terms = self.curvature.iter().enumerate();
        terms.fold(Vec6::zeros(), |sum, (stage, weight)| sum + self.rates[stage * moving + index][1] * *weight)
    }

    /// Notes the motion at the start of the step, and its share of the work.
    fn begin(&mut self, cx: &Context, ws: &mut Workspace, state: &State, to: f64) {
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            self.rates[k] = rates_of(&state.nodes[node]);
        }
        if cx.wants_energy {
            excite(cx, ws, state.time, to, 1.0);
            let weight = self.tableau.weight_at_end(0) * (to - state.time);
            self.work.begin(cx, ws, state, weight);
        }
    }

    /// Writes what a stage starts from, and its prediction.
    fn start_stage(&mut self, cx: &Context, state: &State, stage: usize, dt: f64) {
        let moving = cx.independent_nodes.len();
        let ahead = self.tableau.gamma * dt;
        let (weights, extrapolation) = (self.tableau.a[stage - 1], &self.extrapolation[stage]);
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let [v, _] = self.rates[k];
            let [mut q, mut d] = [Vec6::zeros(), Vec6::zeros()];
            for &(of, weight) in weights {
                let [rate, acceleration] = self.rates[of * moving + k];
                q += rate * weight;
                d += acceleration * weight;
            }
            let (q, d) = (q * dt, v + d * dt);
            let mut dd = Vec6::zeros();
            for (of, weight) in extrapolation.iter().enumerate() {
                dd += self.rates[of * moving + k][1] * *weight;
            }
            if stage == 1 {
                dd += state.jerk[node] * (self.tableau.c[0] * dt);
            }
            self.start_rates[node] = [q / ahead, d / ahead];
            self.prediction[node] = q + (d + dd * ahead) * ahead;
        }
    }

    /// Adds the share of a stage to the work; the forces at hand are lost.
    fn account(&mut self, cx: &Context, ws: &mut Workspace, state: &State, stage: usize, ahead: f64, dt: f64) {
        let weight = self.tableau.weight_at_end(stage) * dt;
        if self.driven {
            let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead };
            cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
            self.work.add_reactions(cx, ws, weight);
        }
        self.work.add(cx, ws, state, weight, ahead);
    }

    fn keep_rates(&mut self, cx: &Context, ws: &Workspace, stage: usize) {
        let moving = cx.independent_nodes.len();
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let increment = &ws.increments[node];
            self.rates[stage * moving + k] = [increment.d, increment.dd];
        }
    }
}
