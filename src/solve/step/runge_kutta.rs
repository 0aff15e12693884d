//! Steps of diagonally implicit Runge-Kutta schemes.
//!
//! The unknowns are y = (q, q̇) with q the increment of the step including its rotation vector. In these coordinates the motion is an
//! ordinary differential equation, so a scheme keeps its order p for rotations too. Every stage finds its equilibrium from the start of the
//! step; the last is the end of the step.
//!
//! Inside a step the motion is the polynomial of fifth degree through positions, velocities and accelerations at both ends. One more stage
//! equilibrates it, so forces and energies are as accurate as at the ends, even with stiff parts.

use crate::context::Context;
use crate::failure::Failure;
use crate::report::StepReport;
use crate::step::equilibrium::EquilibriumSolver;
use crate::step::predict::{excite, move_trial};
use crate::step::trial::{Stage, Step, rates_of};
use crate::step::work::{Power, WorkQuadrature};
use crate::workspace::Workspace;
use base::math::Vec6;
use base::math::quintic;
use base::snapshot::keep;
use mechanics::integrators::{Coefficients, StageTableau};
use mechanics::state::{Configuration, State};

/// The stages of a step. It is allocated once.
pub struct StageStepper {
    tableau: &'static StageTableau,
    /// Rates (q̇, q̈) of all stages of the last step, stage by stage, of the independent nodes.
    rates: Vec<[Vec6; 2]>,
    /// Start values of the current stage, (q*, q̇*)/(γΔt), by node.
    start_rates: Vec<[Vec6; 2]>,
    /// The predicted increments of the current stage, by node.
    prediction: Vec<Vec6>,
    /// Weights of the accelerations of earlier stages in the predicted ones, by stage.
    extrapolation: Vec<Vec<f64>>,
    /// Weights of the accelerations of the stages in their second derivative.
    curvature: Vec<f64>,
    /// Motion (q, q̇, q̈) at both ends of the last step, of the independent nodes.
    ends: [Vec<[Vec6; 3]>; 2],
    /// Power at both ends of it, and its work.
    powers: [Power; 2],
    work: WorkQuadrature,
    /// True if the stages integrate the work on prescribed motion; the work of joint drives follows from the ends of steps.
    driven: bool,
}

keep!(StageStepper { rates, start_rates, prediction, ends, powers, work } without { tableau, extrapolation, curvature, driven });

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
            ends: [vec![[Vec6::zeros(); 3]; moving], vec![[Vec6::zeros(); 3]; moving]],
            powers: [Power::default(); 2],
            work: WorkQuadrature::default(),
            driven: cx.numbers.is_empty()
                && cx.model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some()),
        }
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
        let dt = to - state.time;
        let last = self.tableau.stages() - 1;
        let scheme = cx.model.solution.scheme.coefficients(dt);
        let mut report = StepReport::begin(to);
        let mut work = WorkQuadrature::default();
        self.begin(cx, ws, state, to);
        work.add(&self.powers[0], self.tableau.weight_at_end(0) * dt);
        for stage in 1..=last {
            let time = if stage == last { to } else { state.time + self.tableau.c[stage - 1] * dt };
            self.start_stage(cx, state, stage, dt);
            let found = Step { state, stage: self.relation(&scheme), to: time };
            report = report.then(solver.find(cx, ws, &found)?);
            ws.trial.differentiate(cx, state, &found.stage);
            if cx.wants_energy {
                self.powers[1] = self.power(cx, ws, &found);
                work.add(&self.powers[1], self.tableau.weight_at_end(stage) * dt);
            }
            self.keep_rates(cx, ws, stage);
            // The last stage is the end of the step, which is projected when it is accepted.
            if stage < last && solver.projects() {
                let found = Step { state, stage: self.relation(&scheme), to: time };
                move_trial(cx, ws, &found);
                solver.project_velocities(cx, (&mut ws.trial, ws.reach), &found)?;
                self.keep_projected(cx, ws, stage, scheme.rate[0]);
            }
        }
        self.keep_end(cx, ws);
        self.work = work;
        solver.accept_with(cx, ws, state, (&self.relation(&scheme), to), cx.wants_energy.then_some(work))?;
        Ok(report)
    }

    /// Writes the state at a time inside the last step, which has led from `start` to the time `end`.
    ///
    /// # Errors
    /// As for [`EquilibriumSolver::stage`].
    pub fn look_inside(
        &mut self,
        solver: &mut EquilibriumSolver,
        cx: &Context,
        ws: &mut Workspace,
        (start, end): (&State, f64),
        (state, time): (&mut State, f64),
    ) -> Result<StepReport, Failure> {
        let dt = end - start.time;
        let part = (time - start.time) / dt;
        let scheme = cx.model.solution.scheme.coefficients(dt);
        state.copy_from(start);
        self.start_inside(cx, part, dt);
        let report = solver.find_inside(cx, ws, &Step { state, stage: self.relation(&scheme), to: time })?;
        let work = cx.wants_energy.then(|| self.work.up_to(part, dt, &self.powers));
        solver.accept_with(cx, ws, state, (&self.relation(&scheme), time), work)?;
        Ok(report)
    }

    fn relation<'s>(&'s self, scheme: &'s Coefficients) -> Stage<'s> {
        Stage { scheme, start_rates: Some(&self.start_rates), turning: None, prediction: Some(&self.prediction) }
    }

    /// The fourth derivative of the increments of a node, times Δt², in the step that was taken; `index` counts independent nodes.
    pub fn fourth_derivative(&self, cx: &Context, index: usize) -> Vec6 {
        let moving = cx.independent_nodes.len();
        let terms = self.curvature.iter().enumerate();
        terms.fold(Vec6::zeros(), |sum, (stage, weight)| sum + self.rates[stage * moving + index][1] * *weight)
    }

    /// Records the motion at the start of the step, and its power.
    fn begin(&mut self, cx: &Context, ws: &mut Workspace, state: &State, to: f64) {
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let [v, a] = rates_of(&state.nodes[node]);
            self.rates[k] = [v, a];
            self.ends[0][k] = [Vec6::zeros(), v, a];
        }
        if cx.wants_energy {
            excite(cx, ws, state.time, to, 1.0);
            self.powers[0] = Power::at_start(cx, ws, state, cx.numbers.is_empty());
        }
    }

    /// Writes the start values of a stage, and its prediction.
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

    /// Writes the start values of the stage inside the last step such that its prediction is the polynomial through both ends. No
    /// correction is needed if the polynomial is in equilibrium.
    fn start_inside(&mut self, cx: &Context, part: f64, dt: f64) {
        let ahead = self.tableau.gamma * dt;
        let weights = quintic::weights(part, dt);
        let [starts, ends] = &self.ends;
        for ((&node, start), end) in cx.independent_nodes.iter().zip(starts).zip(ends) {
            let [q, d, dd] = quintic::motion(&weights, start, end);
            self.start_rates[node] = [(q - d * ahead) / ahead, (d - dd * ahead) / ahead];
            self.prediction[node] = q;
        }
    }

    fn keep_end(&mut self, cx: &Context, ws: &Workspace) {
        for (end, &node) in self.ends[1].iter_mut().zip(&cx.independent_nodes) {
            let increment = &ws.trial.increments[node];
            *end = [increment.q, increment.d, increment.dd];
        }
    }

    /// The power at the equilibrium that was found; the current forces are overwritten.
    fn power(&self, cx: &Context, ws: &mut Workspace, found: &Step) -> Power {
        move_trial(cx, ws, found);
        if self.driven {
            let now = Configuration { dt: found.dt(), ..found.at_instant(&ws.trial.nodes) };
            cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        }
        Power::of_trial(cx, ws, found.state, found.dt(), self.driven)
    }

    fn keep_rates(&mut self, cx: &Context, ws: &Workspace, stage: usize) {
        let moving = cx.independent_nodes.len();
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let increment = &ws.trial.increments[node];
            self.rates[stage * moving + k] = [increment.d, increment.dd];
        }
    }

    /// Takes the accelerations of a stage from its projected velocities. The rates of positions stay as they are, for the positions of a stage
    /// satisfy the constraints.
    fn keep_projected(&mut self, cx: &Context, ws: &Workspace, stage: usize, rate: f64) {
        let moving = cx.independent_nodes.len();
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let [d, dd] = &mut self.rates[stage * moving + k];
            *dd += cx.plan.dofs.of(node).mask(&(ws.trial.increments[node].d - *d)) * rate;
        }
    }
}
