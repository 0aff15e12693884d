//! The work of loads and dampers over a step, by quadrature with the weights of a Runge-Kutta scheme.

use crate::context::Context;
use crate::system::{Forces, Loading, Prescribed};
use crate::workspace::Workspace;
use base::snapshot::keep;
use mechanics::integrators::tableau::StageWeights;
use mechanics::state::{Configuration, Node, State, Work};
use model::Restraint;

/// The power at an instant of a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Power {
    /// Power of loads and prescribed motion.
    pub external: f64,
    /// Power of viscous damping.
    pub damping: f64,
}

keep!(Power { external, damping });

impl Power {
    /// The power at the start of a step; with `driven`, that on prescribed motion is included.
    pub fn at_start(cx: &Context, ws: &mut Workspace, state: &State, driven: bool) -> Power {
        let Workspace { loads, prescribed, forces, .. } = ws;
        Power::of_state(cx, forces, state, (&loads.start, driven.then_some(&prescribed.start)))
    }

    /// The power of a state under these loads, and that on `prescribed` motion. The current forces are lost.
    pub fn of_state(
        cx: &Context,
        forces: &mut Forces,
        state: &State,
        (loading, prescribed): (&Loading, Option<&Vec<Prescribed>>),
    ) -> Power {
        cx.system.external(&state.nodes, loading, forces);
        let driving = prescribed.map_or(0.0, |prescribed| driving_power(&state.reactions, prescribed));
        let carrying = cx.system.carrying_power(&state.nodes);
        let external = external_power(forces, &state.nodes) + driving + carrying;
        Power { external, damping: damping_power(cx, &state.configuration()) }
    }

    /// The power of the trial motion, `ahead` of the start of the step. With `driven`, the current forces are in equilibrium, and their
    /// power on prescribed motion is included. They are lost.
    pub fn of_trial(cx: &Context, ws: &mut Workspace, state: &State, ahead: f64, driven: bool) -> Power {
        let mut external = 0.0;
        if driven {
            let restraints = cx.model.constraints.restraints.iter().enumerate().zip(&ws.prescribed.instant);
            let power = |((i, restraint), given): ((usize, &Restraint), &Prescribed)| {
                let &Restraint { node, dof, .. } = restraint;
                // The power of a moment uses the angular velocity, but the rates of increments are rates of a rotation vector.
                let rate = if cx.excitation.is_turned(i) { ws.trial.nodes[node].omega[dof - 3] } else { given.v };
                -ws.forces.on_nodes[node][dof] * rate
            };
            external = restraints.map(power).sum();
        }
        let damping = damping_power(
            cx,
            &Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: ahead, previous: None },
        );
        cx.system.external(&ws.trial.nodes, &ws.loads.instant, &mut ws.forces);
        let carrying = cx.system.carrying_power(&ws.trial.nodes);
        Power { external: external + external_power(&ws.forces, &ws.trial.nodes) + carrying, damping }
    }
}

fn damping_power(cx: &Context, now: &Configuration) -> f64 {
    if cx.system.is_damped() { cx.system.damping_power(now, cx.plan.threads) } else { 0.0 }
}

/// The work of a step so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct WorkQuadrature {
    external: f64,
    damping: f64,
}

keep!(WorkQuadrature { external, damping });

impl WorkQuadrature {
    /// Adds the power at an instant with its weight.
    pub fn add(&mut self, power: &Power, weight: f64) {
        self.external += weight * power.external;
        self.damping += weight * power.damping;
    }

    /// The work up to the fraction `s` of a step of length `dt` whose whole work this is: the cubic with the powers at its ends for slopes.
    /// Damping gives nothing back, however little the step resolves its power.
    pub fn up_to(&self, s: f64, dt: f64, [start, end]: &[Power; 2]) -> WorkQuadrature {
        let (s2, s3) = (s * s, s * s * s);
        let part = |whole: f64, start: f64, end: f64| {
            (3.0 * s2 - 2.0 * s3) * whole + dt * ((s - 2.0 * s2 + s3) * start + (s3 - s2) * end)
        };
        let (external, damping) =
            (part(self.external, start.external, end.external), part(self.damping, start.damping, end.damping));
        WorkQuadrature { external, damping }.within(self)
    }

    /// This part of the work.
    pub fn part(&self, part: f64) -> WorkQuadrature {
        WorkQuadrature { external: part * self.external, damping: part * self.damping }
    }

    /// The work within a step whose whole work is given: damping gives nothing back.
    pub fn within(self, whole: &WorkQuadrature) -> WorkQuadrature {
        WorkQuadrature { damping: self.damping.max(0.0).min(whole.damping.max(0.0)), ..self }
    }

    /// Adds the work of the step to the work of the run.
    pub fn add_to(&self, work: &mut Work) {
        work.external += self.external;
        work.damping += self.damping;
    }
}

/// Power of the current forces at the velocities of the nodes.
fn external_power(forces: &Forces, nodes: &[Node]) -> f64 {
    let power = |(F, node): (&[f64; 6], &Node)| -> f64 {
        F.iter().zip(node.v.iter().chain(&node.omega)).map(|(f, v)| f * v).sum()
    };
    forces.on_nodes.iter().zip(nodes).map(power).sum()
}

fn driving_power(reactions: &[f64], prescribed: &[Prescribed]) -> f64 {
    reactions.iter().zip(prescribed).map(|(reaction, given)| reaction * given.v).sum()
}

/// The weight of a stage in a sum.
pub fn weight_of(weights: StageWeights, stage: usize) -> f64 {
    weights.iter().find(|(of, _)| *of == stage).map_or(0.0, |(_, weight)| *weight)
}
