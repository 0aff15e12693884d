//! The work of loads and dampers over a step, by quadrature with the weights of a Runge-Kutta scheme.

use crate::integrators::tableau::StageWeights;
use crate::solve::context::Context;
use crate::solve::workspace::Workspace;
use crate::state::{Configuration, Node, State, Work};
use crate::system::{Forces, Prescribed};

/// The work of a step so far.
#[derive(Debug, Clone, Copy, Default)]
pub struct WorkQuadrature {
    external: f64,
    damping: f64,
}

impl WorkQuadrature {
    /// Begins with the contribution of the start of the step.
    pub fn begin(&mut self, cx: &Context, ws: &mut Workspace, state: &State, weight: f64) {
        *self = WorkQuadrature::default();
        cx.system.external(&state.nodes, &ws.loads.start, &mut ws.forces);
        let driving = driving_power(&state.reactions, &ws.prescribed.start);
        self.external += weight * (external_power(&ws.forces, &state.nodes) + driving);
        if cx.system.is_damped() {
            self.damping += weight * cx.system.damping_power(&state.configuration(), cx.plan.threads);
        }
    }

    /// Adds the contribution of an evaluated stage; the forces at hand are lost.
    pub fn add(&mut self, cx: &Context, ws: &mut Workspace, state: &State, weight: f64, ahead: f64) {
        if cx.system.is_damped() {
            let now = Configuration { nodes: &ws.trial, history: &state.history, dt: ahead };
            self.damping += weight * cx.system.damping_power(&now, cx.plan.threads);
        }
        cx.system.external(&ws.trial, &ws.loads.instant, &mut ws.forces);
        self.external += weight * external_power(&ws.forces, &ws.trial);
    }

    /// Adds the contribution of the reactions at hand on prescribed degrees of freedom.
    pub fn add_reactions(&mut self, cx: &Context, ws: &Workspace, weight: f64) {
        let restraints = cx.model.constraints.restraints.iter().zip(&ws.prescribed.instant);
        let power = restraints
            .map(|(restraint, given)| -ws.forces.on_nodes[restraint.node][restraint.dof] * given.v)
            .sum::<f64>();
        self.external += weight * power;
    }

    /// Adds the work of the step to that of the run.
    pub fn add_to(&self, work: &mut Work) {
        work.external += self.external;
        work.damping += self.damping;
    }
}

/// Power of the forces at hand at the velocities of the nodes.
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
