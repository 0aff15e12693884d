//! A step by an explicit Runge-Kutta scheme: its stages and its error estimate.

use super::accelerations::{Accelerations, set_rates};
use super::dense_projection::project_onto_constraints;
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
use crate::system::masses::NodeRates;
use crate::tolerances::explicit_runge_kutta::FARTHEST;
use crate::workspace::Workspace;
use base::math::rotation::{exp, inverse_tangent, renormalise};
use base::math::{Vec6, angular, linear, stack};
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::integrators::tableau::{StageWeights, Tableau};
use mechanics::state::{Configuration, Increment, Node, State};
use model::Restraint;

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
}

keep!(RungeKuttaStepper { accelerations, stages, work } without { guards, tableau, varying, driven });

/// A stage of a step: its number, its weights of earlier rates, and its time within the step.
#[derive(Clone, Copy)]
struct At {
    stage: usize,
    weights: StageWeights,
    c: f64,
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
        Ok(RungeKuttaStepper {
            accelerations: Accelerations::new(cx)?,
            guards: Guards::of(cx)?,
            stages: vec![[Vec6::zeros(); 2]; tableau.stages() * cx.independent_nodes.len()],
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
        let tableau = self.tableau;
        if cx.wants_energy {
            self.work = WorkQuadrature::default();
            self.work.add(&Power::at_start(cx, ws, state, true), dt * weight_of(tableau.b, 0));
        }
        let inner = tableau.a.iter().zip(tableau.c).enumerate();
        for (stage, (weights, c)) in inner.map(|(i, of)| (i + 1, of)) {
            self.move_to(cx, ws, state, At { stage, weights, c: *c }, to)?;
            self.evaluate(cx, ws, state, stage, c * dt)?;
            let weight = dt * weight_of(tableau.b, stage);
            if cx.wants_energy && weight != 0.0 {
                if self.driven {
                    self.accelerations.update_reactions(cx, ws, state, c * dt);
                }
                self.work.add(&Power::of_trial(cx, ws, state, c * dt, self.driven), weight);
            }
        }
        let end = tableau.stages() - 1;
        self.move_to(cx, ws, state, At { stage: end, weights: tableau.b, c: 1.0 }, to)?;
        project_onto_constraints(cx, ws, &mut self.accelerations, state, dt)?;
        self.evaluate(cx, ws, state, end, dt)?;
        if self.accelerations.are_finite(cx, ws) { Ok(()) } else { Err(residual::not_finite(cx, &ws.forces)) }
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
        let dt = to - state.time;
        let end = self.tableau.stages() - 1;
        if cx.wants_forces {
            self.accelerations.update_reactions(cx, ws, state, dt);
        }
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let [_, rate] = self.stages[end * cx.independent_nodes.len() + k];
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
        let taken = Taken { state, from: to - dt, grows: true };
        self.guards.tell(|guard| guard.after_step(cx, ws, &taken));
        if cx.wants_forces {
            for (reaction, restraint) in state.reactions.iter_mut().zip(&cx.model.constraints.restraints) {
                *reaction = -ws.forces.on_nodes[restraint.node][restraint.dof];
            }
            self.work.add_to(&mut state.work);
        }
        Ok(StepReport { iterations: end, ..StepReport::begin(to) })
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

    /// Writes the trial motion of a stage from the rates of earlier stages, and its loads.
    fn move_to(&mut self, cx: &Context, ws: &mut Workspace, state: &State, at: At, to: f64) -> Result<(), Failure> {
        let (dt, nodes) = (to - state.time, cx.independent_nodes.len());
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let start = &state.nodes[node];
            let [mut q, mut v] = [Vec6::zeros(); 2];
            for &(of, weight) in at.weights {
                let [dq, dv] = &self.stages[of * nodes + k];
                q += dq * weight;
                v += dv * weight;
            }
            let increment = &mut ws.trial.increments[node];
            increment.q = q * dt;
            increment.d = stack(&start.v, &start.omega) + v * dt;
            increment.dd = Vec6::zeros();
        }
        if self.driven {
            prescribe(cx, ws, state.time + at.c * dt, at.c);
        }
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
            let time = if at.c < 1.0 { state.time + at.c * dt } else { to };
            cx.excitation.loading(time, Side::Before, &mut ws.loads.instant);
        }
        Ok(())
    }

    /// Evaluates a stage: writes the accelerations of the trial motion as its rates.
    fn evaluate(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        stage: usize,
        ahead: f64,
    ) -> Result<(), Failure> {
        if self.accelerations.schur.is_some() {
            ws.forces.multipliers.values.fill(0.0);
        }
        let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: ahead, previous: None };
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
        self.accelerations.solve(cx, ws, state, true)?;
        let nodes = cx.independent_nodes.len();
        for (k, &node) in cx.independent_nodes.iter().enumerate() {
            let trial = &ws.trial.nodes[node];
            self.stages[stage * nodes + k][1] = stack(&trial.a, &trial.alpha) + self.accelerations.missing[node];
        }
        Ok(())
    }
}

/// Writes the prescribed motion at a time within the step.
fn prescribe(cx: &Context, ws: &mut Workspace, time: f64, c: f64) {
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
