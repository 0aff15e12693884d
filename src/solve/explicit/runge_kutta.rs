//! A step by an explicit Runge-Kutta scheme: its stages and its error estimate.

use super::accelerations::{Accelerations, set_rates};
use super::dense_projection::project_onto_constraints;
use super::inside_step::InsideStep;
use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::Taken;
use crate::guards::list::Guards;
use crate::guards::{contacts, joints, links};
use crate::report::StepReport;
use crate::step::commit::{Account, commit_trial};
use crate::step::predict::excite;
use crate::step::residual;
use crate::step::size::Size;
use crate::step::trial::{rates_of, reach};
use crate::step::work::{Power, WorkQuadrature, weight_of};
use crate::system::Side;
use crate::system::kinks::has_kinks;
use crate::system::masses::NodeRates;
use crate::tolerances::explicit_runge_kutta::FARTHEST;
use crate::workspace::Workspace;
use base::math::rotation::{exp, inverse_tangent, renormalise};
use base::math::{Vec6, angular, linear, stack};
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::integrators::tableau::{StageWeights, Tableau};
use mechanics::state::{Configuration, Increment, Node, State};
use model::{Restraint, StepLength};

/// A Runge-Kutta scheme, with its data besides the workspace. It is allocated once.
pub struct RungeKuttaStepper {
    tableau: &'static Tableau,
    accelerations: Accelerations,
    /// The guards that run at the ends of steps.
    guards: Guards,
    /// Rates of (q, v) of each independent node, by stage.
    stages: Vec<[Vec6; 2]>,
    /// True where loads change with time.
    varying: bool,
    /// True where prescribed degrees of freedom move.
    driven: bool,
    work: WorkQuadrature,
    /// The motion inside the last step, where output times lie there.
    inside: Option<InsideStep>,
}

keep!(RungeKuttaStepper { accelerations, stages, work } without { guards, tableau, varying, driven, inside });

/// A stage of a step, or a time inside it: its place in the list of stages, and its time within the step.
#[derive(Clone, Copy)]
struct At {
    stage: usize,
    c: f64,
}

/// A step that is being taken, or looked into: its start and its end.
struct ExplicitStep<'s> {
    cx: &'s Context<'s>,
    ws: &'s mut Workspace,
    start: &'s State,
    to: f64,
}

impl RungeKuttaStepper {
    /// A stepper for this scheme.
    ///
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context, tableau: &'static Tableau) -> Result<Self, TooLarge> {
        let model = cx.model;
        let changes = |amplitude: Option<usize>| amplitude.is_some();
        let varying = model.loading.nodal.iter().any(|load| changes(load.amplitude))
            || model.loading.pressures.iter().any(|load| changes(load.amplitude))
            || changes(model.loading.gravity_amplitude)
            || !model.loading.base_accelerations.is_empty();
        // No polynomial has the kinks of impacts and stops.
        let is_automatic = matches!(model.analysis.step_length, StepLength::ErrorControlled { .. });
        let looks_inside = is_automatic && !has_kinks(cx.system);
        let stages = if looks_inside { tableau.all_stages() + 1 } else { tableau.stages() };
        Ok(RungeKuttaStepper {
            accelerations: Accelerations::new(cx)?,
            guards: Guards::of(cx)?,
            stages: vec![[Vec6::zeros(); 2]; stages * cx.independent_nodes.len()],
            inside: looks_inside.then(|| InsideStep::new(cx, tableau)),
            tableau,
            varying,
            driven: model.constraints.restraints.iter().any(|restraint| restraint.motion.is_some()),
            work: WorkQuadrature::default(),
        })
    }

    /// The order of the error estimate in the time step, used to choose the length of steps.
    pub fn error_order(&self) -> f64 {
        self.tableau.error_order
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
        self.evaluate_stages(cx, ws, state, to)?;
        self.accept(cx, ws, state, to)
    }

    /// Evaluates all stages; the trial motion is then the motion at the end of the step, not yet accepted.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn evaluate_stages(&mut self, cx: &Context, ws: &mut Workspace, state: &State, to: f64) -> Result<(), Failure> {
        let dt = to - state.time;
        contacts::check_length(cx, state, dt)?;
        excite(cx, ws, state.time, to, 1.0);
        if !cx.system.joints.is_empty() {
            ws.reach = reach(cx, state);
            ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
        }
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            self.stages[k] = rates_of(&state.nodes[node]);
        }
        if cx.wants_energy {
            self.work = WorkQuadrature::default();
            self.add_power(0, Power::at_start(cx, ws, state, true), dt);
        }
        let (tableau, step) = (self.tableau, &mut ExplicitStep { cx, ws, start: state, to });
        for (k, (weights, c)) in tableau.a.iter().zip(tableau.c).enumerate() {
            let at = At { stage: k + 1, c: *c };
            self.sum_stages(step, weights);
            self.evaluate(step, at)?;
            if cx.wants_energy && weight_of(tableau.b, at.stage) != 0.0 {
                let power = self.power(step, at.c);
                self.add_power(at.stage, power, dt);
            }
        }
        self.sum_stages(step, tableau.b);
        self.evaluate_projected(step, At { stage: tableau.stages() - 1, c: 1.0 })?;
        if self.accelerations.are_finite(cx, step.ws) { Ok(()) } else { Err(residual::not_finite(cx, &step.ws.forces)) }
    }

    /// True where the motion inside steps is known.
    pub fn looks_inside(&self) -> bool {
        self.inside.is_some()
    }

    /// Accepts the motion that [`RungeKuttaStepper::evaluate_stages`] has found. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn accept(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let end = self.tableau.stages() - 1;
        let dt = to - state.time;
        self.settle(cx, ws, state, (end, to), self.work)?;
        if let Some(inside) = &mut self.inside {
            let rates = &mut self.stages[end * cx.independent_nodes.len()..];
            inside.begin(cx, &ws.trial.increments, state, (rates, self.work));
        }
        let taken = Taken { state, from: to - dt, grows: true };
        self.guards.tell(|guard| guard.after_step(cx, ws, &taken));
        Ok(StepReport { iterations: end, ..StepReport::begin(to) })
    }

    /// Makes the trial motion, whose rates are those of a stage, the state at the time `to`, with the work up to there. On failure `state` is
    /// untouched.
    fn settle(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        (stage, to): (usize, f64),
        work: WorkQuadrature,
    ) -> Result<(), Failure> {
        let dt = to - state.time;
        if cx.wants_forces {
            self.accelerations.update_reactions(cx, ws, state, dt);
        }
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let [_, rate] = self.stages[stage * cx.independent_nodes.len() + k];
            let trial = &mut ws.trial.nodes[node];
            (trial.a, trial.alpha) = (linear(&rate), angular(&rate));
            let motion = NodeRates { v: trial.v, omega: trial.omega, a: trial.a, alpha: trial.alpha };
            set_rates(&mut ws.trial.increments[node], &motion);
        }
        ws.trial.update_dependent_nodes(cx, &state.nodes);
        let scheme = cx.model.solution.scheme.coefficients(dt);
        self.accelerations.project(cx, ws, state, &scheme, dt)?;
        let mut account = Account::default();
        if cx.system.history > 0 {
            let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
            account.dissipated = cx.system.update_history(&now, 1.0, &mut ws.history, cx.plan.threads);
        }
        contacts::check_passage(cx, &ws.trial.nodes, state, dt)?;
        joints::note(cx, ws)?;
        links::check(cx, &ws.trial.nodes, state, dt)?;
        commit_trial(cx, ws, self.accelerations.projection(), state, (&scheme, to), account);
        if cx.wants_forces {
            for (reaction, restraint) in state.reactions.iter_mut().zip(&cx.model.constraints.restraints) {
                *reaction = -ws.forces.on_nodes[restraint.node][restraint.dof];
            }
            work.add_to(&mut state.work);
        }
        Ok(())
    }

    /// Writes the state at a time inside the last step, which has led from `start` to `end`, with the forces there. The report counts its
    /// evaluations.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn look_inside(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        (start, end): (&State, &State),
        (state, time): (&mut State, f64),
    ) -> Result<Option<StepReport>, Failure> {
        let Some(mut inside) = self.inside.take() else { return Ok(None) };
        let step = &mut ExplicitStep { cx, ws, start, to: end.time };
        let part = (time - start.time) / step.dt();
        let found = self.find_inside(step, &mut inside, end, part);
        let work = inside.work(step.dt());
        self.inside = Some(inside);
        let iterations = found?;
        state.copy_from(start);
        self.settle(cx, step.ws, state, (self.tableau.all_stages(), time), work)?;
        Ok(Some(StepReport { iterations, ..StepReport::begin(time) }))
    }

    /// Finds the trial motion at the fraction `part` of a step that has led to `end`. Returns the number of evaluations.
    fn find_inside(
        &mut self,
        step: &mut ExplicitStep,
        inside: &mut InsideStep,
        end: &State,
        part: f64,
    ) -> Result<usize, Failure> {
        let mut evaluations = 0;
        if !std::mem::replace(&mut inside.is_complete, true) {
            evaluations += self.complete(step, inside, end)?;
        }
        let of_step = (step.start, part, step.dt());
        inside.move_to(step.cx, &mut step.ws.trial.increments, of_step, (self.tableau, &self.stages));
        let at = At { stage: self.tableau.all_stages(), c: part };
        // Forces need an evaluation there; accelerations alone are those of the polynomial.
        if step.cx.wants_forces || !step.cx.system.joints.is_empty() {
            self.evaluate_projected(step, at)?;
            evaluations += 1;
        } else {
            self.move_to(step, at)?;
            self.keep_accelerations(step, at.stage);
        }
        Ok(evaluations)
    }

    /// Evaluates the further stages of a step that has led to `end`. Returns their number.
    fn complete(&mut self, step: &mut ExplicitStep, inside: &mut InsideStep, end: &State) -> Result<usize, Failure> {
        let tableau = self.tableau;
        if step.cx.wants_energy {
            let Workspace { loads, prescribed, forces, .. } = &mut *step.ws;
            let power = Power::of_state(step.cx, forces, end, (&loads.end, Some(&prescribed.end)));
            inside.powers[tableau.stages() - 1] = power;
        }
        for (k, (weights, c)) in tableau.inside.a.iter().zip(tableau.inside.c).enumerate() {
            let at = At { stage: tableau.stages() + k, c: *c };
            self.sum_stages(step, weights);
            self.evaluate(step, at)?;
            if step.cx.wants_energy {
                inside.powers[at.stage] = self.power(step, at.c);
            }
        }
        Ok(tableau.inside.c.len())
    }

    /// The largest estimated errors of translations and rotations of a step of `dt` whose stages have been evaluated.
    pub fn error(&self, cx: &Context, dt: f64) -> Size {
        let (tableau, nodes) = (self.tableau, cx.independent_nodes.len());
        let mut largest = [Size::default(); 2];
        // Coordinates of joints are no lengths, so errors skip them; the bodies show the same motion.
        for k in (0..nodes).filter(|&k| !cx.numbers.contains(&cx.independent_nodes[k])) {
            for (largest, weights) in largest.iter_mut().zip(tableau.errors) {
                let sum = |sum: Vec6, &(of, weight): &(usize, f64)| sum + self.stages[of * nodes + k][0] * weight;
                let error = weights.iter().fold(Vec6::zeros(), sum);
                largest.translation = largest.translation.max(linear(&error).norm());
                largest.rotation = largest.rotation.max(angular(&error).norm());
            }
        }
        let [first, second] = largest;
        let mixed = |e: f64, other: f64| {
            if tableau.errors.len() == 1 || e == 0.0 {
                dt * e
            } else {
                dt * e * e / (e * e + 0.01 * other * other).sqrt()
            }
        };
        Size {
            translation: mixed(first.translation, second.translation),
            rotation: mixed(first.rotation, second.rotation),
        }
    }

    /// Writes the increments of a stage from the rates of earlier stages.
    fn sum_stages(&self, step: &mut ExplicitStep, weights: StageWeights) {
        let (dt, nodes) = (step.dt(), step.cx.independent_nodes.len());
        for (k, &node) in step.cx.independent_nodes.iter().enumerate() {
            let start = &step.start.nodes[node];
            let [mut q, mut v] = [Vec6::zeros(); 2];
            for &(of, weight) in weights {
                let [dq, dv] = &self.stages[of * nodes + k];
                q += dq * weight;
                v += dv * weight;
            }
            let increment = &mut step.ws.trial.increments[node];
            increment.q = q * dt;
            increment.d = stack(&start.v, &start.omega) + v * dt;
            increment.dd = Vec6::zeros();
        }
    }

    /// Writes the trial motion of increments, and its loads.
    fn move_to(&mut self, step: &mut ExplicitStep, at: At) -> Result<(), Failure> {
        if self.driven {
            step.prescribe(at.c);
        }
        let (time, dt) = (step.time(at.c), step.dt());
        let ExplicitStep { cx, ws, start: state, .. } = step;
        let nodes = cx.independent_nodes.len();
        let mut farthest = 0.0f64;
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let increment = &mut ws.trial.increments[node];
            let angle = advance(&mut ws.trial.nodes[node], &state.nodes[node], increment);
            farthest = farthest.max(angle);
            self.stages[at.stage * nodes + k][0] = increment.d;
        }
        if farthest > FARTHEST || farthest.is_nan() {
            return Err(Failure::RotationTooLarge { dt });
        }
        ws.trial.update_dependent_nodes(cx, &state.nodes);
        if self.varying {
            cx.excitation.loading(time, Side::Before, &mut ws.loads.instant);
        }
        Ok(())
    }

    /// Evaluates a stage with these increments: writes the rates of the trial motion, its accelerations included.
    fn evaluate(&mut self, step: &mut ExplicitStep, at: At) -> Result<(), Failure> {
        self.move_to(step, at)?;
        self.accelerate(step, at)
    }

    /// As [`RungeKuttaStepper::evaluate`], with the trial motion on the constraints of joints.
    fn evaluate_projected(&mut self, step: &mut ExplicitStep, at: At) -> Result<(), Failure> {
        self.move_to(step, at)?;
        let ahead = at.c * step.dt();
        project_onto_constraints(step.cx, step.ws, &mut self.accelerations, step.start, ahead)?;
        self.accelerate(step, at)
    }

    /// Writes the accelerations of the trial motion as rates of a stage.
    fn accelerate(&mut self, step: &mut ExplicitStep, at: At) -> Result<(), Failure> {
        let dt = at.c * step.dt();
        let ExplicitStep { cx, ws, start: state, .. } = step;
        if self.accelerations.schur.is_some() {
            ws.forces.multipliers.values.fill(0.0);
        }
        let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        self.accelerations.solve(cx, ws, state, true)?;
        self.keep_accelerations(step, at.stage);
        let nodes = &step.cx.independent_nodes;
        for (k, &node) in nodes.iter().enumerate() {
            self.stages[at.stage * nodes.len() + k][1] += self.accelerations.missing[node];
        }
        Ok(())
    }

    /// Writes the accelerations that the trial motion has as rates of a stage.
    fn keep_accelerations(&mut self, step: &ExplicitStep, stage: usize) {
        let nodes = &step.cx.independent_nodes;
        for (k, &node) in nodes.iter().enumerate() {
            let [_, a] = rates_of(&step.ws.trial.nodes[node]);
            self.stages[stage * nodes.len() + k][1] = a;
        }
    }

    /// The power of the stage that was evaluated last, at the fraction `c` of the step; its forces are lost.
    fn power(&self, step: &mut ExplicitStep, c: f64) -> Power {
        let ahead = c * step.dt();
        let ExplicitStep { cx, ws, start: state, .. } = step;
        if self.driven {
            self.accelerations.update_reactions(cx, ws, state, ahead);
        }
        Power::of_trial(cx, ws, state, ahead, self.driven)
    }

    /// Adds the power of a stage to the work of a step of `dt`.
    fn add_power(&mut self, stage: usize, power: Power, dt: f64) {
        self.work.add(&power, dt * weight_of(self.tableau.b, stage));
        if let Some(inside) = &mut self.inside {
            inside.powers[stage] = power;
        }
    }
}

impl ExplicitStep<'_> {
    fn dt(&self) -> f64 {
        self.to - self.start.time
    }

    /// The time at the fraction `c` of the step.
    fn time(&self, c: f64) -> f64 {
        if c < 1.0 { self.start.time + c * self.dt() } else { self.to }
    }

    /// Writes the prescribed motion at the fraction `c` of the step.
    fn prescribe(&mut self, c: f64) {
        let time = self.time(c);
        let ExplicitStep { cx, ws, .. } = self;
        // The prescribed motion at the end of the step is already known.
        if c < 1.0 {
            let side = if c == 0.0 { Side::After } else { Side::Before };
            cx.excitation.prescribed(time, side, &mut ws.prescribed.instant);
        } else {
            ws.prescribed.instant.copy_from_slice(&ws.prescribed.end);
        }
        let given = &mut ws.prescribed;
        cx.excitation.moved(&given.start, &given.instant, &mut given.moved);
        let moves = |(i, restraint): &(usize, &Restraint)| restraint.motion.is_some() || cx.excitation.is_turned(*i);
        for (i, restraint) in cx.model.constraints.restraints.iter().enumerate().filter(moves) {
            let (moved, now) = (&ws.prescribed.moved[i], &ws.prescribed.instant[i]);
            let increment = &mut ws.trial.increments[restraint.node];
            // A prescribed rotation beside free ones is integrated from its rate alone.
            let alone = restraint.dof < 3 || (3..6).all(|dof| !cx.plan.is_unknown(restraint.node, dof));
            if alone {
                increment.q[restraint.dof] = moved.u;
            }
            increment.d[restraint.dof] = now.v;
            increment.dd[restraint.dof] = now.a;
        }
    }
}

/// Moves a node to the increment of a stage whose rates are v and ω; ω becomes the rate of the rotation vector. Returns
/// the square of the angle.
#[inline]
fn advance(trial: &mut Node, start: &Node, increment: &mut Increment) -> f64 {
    let (theta, omega) = (angular(&increment.q), angular(&increment.d));
    trial.place(&start.x, &start.low, &linear(&increment.q));
    trial.v = linear(&increment.d);
    trial.omega = omega;
    (trial.a, trial.alpha) = (linear(&increment.dd), angular(&increment.dd));
    let angle = theta.norm_squared();
    if angle > 0.0 {
        trial.rotation = renormalise(&(exp(&theta) * start.rotation));
        increment.d = stack(&trial.v, &inverse_tangent(&theta, &omega));
    } else {
        trial.rotation = start.rotation;
    }
    angle
}
