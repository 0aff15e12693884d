//! The motion of a step: the relation of its rates, prescribed motion, and a trial of it.

use crate::context::{self, Context};
use crate::system::{Prescribed, TurningBody, TurningStart};
use base::math::{Vec3, Vec6, angular, stack};
use base::snapshot::keep;
use mechanics::integrators::{Coefficients, RotationUpdate};
use mechanics::state::{Configuration, Increment, Node, State};

/// The relation between displacements, velocities and accelerations in a stage of a step.
#[derive(Clone, Copy)]
pub struct Stage<'s> {
    /// Coefficients of the scheme.
    pub scheme: &'s Coefficients,
    /// Velocities and accelerations by node that replace the values at the start of the step; a second stage combines values of the whole
    /// step in them.
    pub start_rates: Option<&'s [[Vec6; 2]]>,
    /// Replacements for the accelerations of turning bodies there: rate of angular momentum, and angular acceleration in body axes.
    pub turning: Option<&'s [[Vec3; 2]]>,
    /// Predicted increments by node that replace the predictions of the scheme.
    pub prediction: Option<&'s [Vec6]>,
}

impl<'s> From<&'s Coefficients> for Stage<'s> {
    /// A stage with the rates of the state alone.
    fn from(scheme: &'s Coefficients) -> Stage<'s> {
        Stage { scheme, start_rates: None, turning: None, prediction: None }
    }
}

impl Stage<'_> {
    /// The velocity and the acceleration of a node at the start of the step as used by the scheme; `own` are the values of the state.
    #[inline]
    pub fn start_rates(&self, cx: &Context, state: &State, node: usize, own: [Vec6; 2]) -> [Vec6; 2] {
        if let Some(rates) = self.start_rates {
            rates[node]
        } else if cx.algorithmic_acceleration.is_some() {
            [own[0], state.algorithmic_accelerations[node]]
        } else {
            own
        }
    }
}

/// A step, or one of its stages: its start, its scheme and its end.
#[derive(Clone, Copy)]
pub struct Step<'s> {
    /// The state at its start.
    pub state: &'s State,
    /// The relation between displacements and their rates.
    pub stage: Stage<'s>,
    /// The time at its end.
    pub to: f64,
}

impl<'s> Step<'s> {
    /// Its length.
    pub fn dt(&self) -> f64 {
        self.to - self.state.time
    }

    /// The time from its start to the instant where equilibrium is written.
    pub fn ahead(&self) -> f64 {
        self.stage.scheme.instant * self.dt()
    }

    /// The configuration of these nodes at the instant of equilibrium, with the history at the start.
    pub fn at_instant<'n>(&self, nodes: &'n [Node]) -> Configuration<'n>
    where
        's: 'n,
    {
        Configuration { nodes, history: &self.state.history, dt: self.ahead(), previous: None }
    }
}

/// The velocity and the acceleration of a node, translations first.
#[inline]
pub fn rates_of(node: &Node) -> [Vec6; 2] {
    [stack(&node.v, &node.omega), stack(&node.a, &node.alpha)]
}

/// A motion from the state at the start of a step: at the instant of equilibrium, or at the end of the step.
pub struct TrialMotion {
    /// The nodes where the motion leads.
    pub nodes: Vec<Node>,
    /// Increments of the nodes from the start of the step, with their rates.
    pub increments: Vec<Increment>,
    /// Start values of the rotations of bodies in the current stage, in the order of the system's turning bodies.
    turning: Vec<TurningStart>,
}

keep!(TrialMotion { nodes, increments, turning });

impl TrialMotion {
    /// The nodes of the model at rest.
    pub fn new(cx: &Context) -> TrialMotion {
        TrialMotion {
            nodes: context::at_rest(cx.model),
            increments: vec![Increment::ZERO; cx.model.nodes.len()],
            turning: Vec::with_capacity(cx.system.turning_bodies().len()),
        }
    }

    /// Forgets the motion of earlier runs.
    pub fn begin_run(&mut self, cx: &Context) {
        self.nodes.clone_from(&context::at_rest(cx.model));
        self.increments.fill(Increment::ZERO);
        self.turning.clear();
    }

    /// Writes the predicted increments, and the start values for the rotations of bodies.
    pub fn predict(&mut self, cx: &Context, state: &State, stage: &Stage) {
        for &node in &cx.independent_nodes {
            self.increments[node].q = match stage.prediction {
                Some(prediction) => prediction[node],
                None => {
                    let [v, a] = rates_of(&state.nodes[node]);
                    stage.scheme.predict(&v, &a, &state.jerk[node])
                }
            };
        }
        if stage.scheme.turning.is_some() {
            self.start_turning(cx, state, stage);
        }
    }

    /// Writes the start values of the rotations of bodies in a stage, in the form used by the scheme.
    fn start_turning(&mut self, cx: &Context, state: &State, stage: &Stage) {
        self.turning.clear();
        self.turning.extend(cx.system.turning_bodies().iter().enumerate().map(|(index, body)| {
            let node = &state.nodes[body.node];
            let [v, a] = stage.start_rates(cx, state, body.node, rates_of(node)).map(|rates| angular(&rates));
            match stage.turning {
                Some(rates) => body.start_of_stage(node, &v, rates[index], stage.scheme),
                None => body.start(node, &a, stage.scheme),
            }
        }));
    }

    /// Writes the rates of the increments by the scheme.
    pub fn differentiate(&mut self, cx: &Context, state: &State, stage: &Stage) {
        for &node in &cx.independent_nodes {
            let [own_v, own_a] = rates_of(&state.nodes[node]);
            let [v, a] = stage.start_rates(cx, state, node, [own_v, own_a]);
            stage.scheme.differentiate(&mut self.increments[node], &v, &a, &own_a);
        }
        if stage.scheme.turning.is_some() {
            for (body, start) in cx.system.turning_bodies().iter().zip(&self.turning) {
                body.differentiate(start, &mut self.increments[body.node], stage.scheme);
            }
        }
    }

    /// Writes the increments at the end of a step from `at_instant`, the increments at the instant of equilibrium.
    pub fn finish(&mut self, cx: &Context, at_instant: &TrialMotion, state: &State, stage: &Stage) {
        let bodies: &[TurningBody] = if stage.scheme.turning.is_some() { cx.system.turning_bodies() } else { &[] };
        let mut bodies = bodies.iter().peekable();
        for &node in &cx.independent_nodes {
            let (start, at_instant) = (&state.nodes[node], &at_instant.increments[node]);
            let [v, a] = stage.start_rates(cx, state, node, rates_of(start));
            let end = &mut self.increments[node];
            *end = stage.scheme.finish(at_instant, &v, &a);
            if let Some(body) = TurningBody::next_at(&mut bodies, node) {
                body.finish(start, at_instant, end, stage.scheme);
            }
        }
    }

    /// Moves the nodes by the increments, after the prescribed ones are written. Returns the largest departure of a truncated rotation from
    /// orthogonality before it was corrected.
    pub fn advance(&mut self, cx: &Context, state: &State, given: &[Prescribed], rotation: RotationUpdate) -> f64 {
        for (restraint, given) in cx.model.constraints.restraints.iter().zip(given) {
            prescribe(&mut self.increments[restraint.node], restraint.dof, given);
        }
        let mut drift = 0.0f64;
        for &node in &cx.independent_nodes {
            drift = drift.max(self.nodes[node].advance(&state.nodes[node], &self.increments[node], rotation));
        }
        self.update_dependent_nodes(cx, &state.nodes);
        drift
    }

    /// Moves dependent nodes with their masters; `start` are the nodes at the start of the step.
    pub fn update_dependent_nodes(&mut self, cx: &Context, start: &[Node]) {
        for dependent in &cx.system.rigid_links {
            dependent.move_with_master(&mut self.nodes, &mut self.increments, &start[dependent.node]);
        }
    }
}

/// Writes a prescribed degree of freedom of an increment.
#[inline]
pub fn prescribe(increment: &mut Increment, dof: usize, given: &Prescribed) {
    increment.q[dof] = given.u;
    increment.d[dof] = given.v;
    increment.dd[dof] = given.a;
}

/// The largest coordinate of a node, the reference for rounding errors.
pub fn reach(cx: &Context, state: &State) -> f64 {
    let farthest = |reach: f64, &node: &usize| reach.max((state.nodes[node].x - cx.origin).amax());
    let placed = cx.independent_nodes.iter().filter(|node| !cx.numbers.contains(node));
    placed.fold(cx.length, farthest)
}
