//! The loops over nodes in a step by central differences. They move all nodes to the end of the step; for separate bodies without joints
//! they also compute accelerations, stability sums and end rates.

use super::node_sums::StepSums;
use crate::context::Context;
use crate::node_chunks::{Largest, NodeChunk, Nothing};
use crate::step::trial::{prescribe, rates_of};
use crate::system::masses::{Masses, NodeRates};
use crate::workspace::Workspace;
use base::math::rotation::Chart;
use base::math::{Vec6, angular, linear, stack};
use mechanics::integrators::Coefficients;
use mechanics::state::{Increment, Node, State};

/// Moves the trial motion to the end of the step of length `dt`, with predicted velocities; bodies that turn freely by their angular
/// momentum.
pub fn move_ahead(
    cx: &Context,
    ws: &mut Workspace,
    masses: Option<&Masses>,
    state: &State,
    (scheme, dt): (&Coefficients, f64),
) {
    let (trial, increments, given) = (&mut ws.trial.nodes[..], &mut ws.trial.increments[..], &ws.prescribed.instant);
    let restraints = &cx.model.constraints.restraints;
    let drift = cx.chunks.run((trial, increments), &|chunk: &NodeChunk, (trial, increments): Moving| {
        let first = chunk.nodes.start;
        let independent = &cx.independent_nodes[chunk.independent.clone()];
        for &node in independent {
            let (start, increment) = (&state.nodes[node], &mut increments[node - first]);
            let [v, a] = rates_of(start);
            let free_drift = masses.and_then(|masses| masses.of(node)?.drift(start, dt));
            increment.q = free_drift.unwrap_or_else(|| scheme.predict(&v, &a, &state.jerk[node]));
            scheme.differentiate(increment, &v, &a, &a);
        }
        for &i in &cx.chunks.restraints[chunk.restraints.clone()] {
            prescribe(&mut increments[restraints[i].node - first], restraints[i].dof, &given[i]);
        }
        let mut drift = Largest(0.0);
        for &node in independent {
            let increment = &increments[node - first];
            drift += Largest(trial[node - first].advance(&state.nodes[node], increment, scheme.rotation));
        }
        drift
    });
    ws.rotation_drift = ws.rotation_drift.max(drift.0);
    ws.trial.update_dependent_nodes(cx, &state.nodes);
}

/// Positions and increments of the nodes of a chunk.
type Moving<'a> = (&'a mut [Node], &'a mut [Increment]);

/// Writes the differences of the accelerations of separate bodies, and returns the sums for the stability checks.
pub fn accelerate(
    cx: &Context,
    ws: &mut Workspace,
    (masses, missing): (&Masses, &mut [Vec6]),
    state: &State,
    dt: f64,
) -> StepSums {
    ws.solves += 1;
    let (trial, increments, F) = (&ws.trial.nodes, &ws.trial.increments, &ws.forces.on_nodes);
    cx.chunks.run(missing, &|chunk: &NodeChunk, missing: &mut [Vec6]| {
        let mut sums = StepSums::default();
        for &node in &cx.independent_nodes[chunk.independent.clone()] {
            let (now, found) = (&trial[node], &mut missing[node - chunk.nodes.start]);
            if let Some(block) = masses.of(node) {
                *found = block.accelerate(now, &F[node]);
                let jerk_dt = state.jerk[node] * dt;
                sums.add(block, [&state.nodes[node], now], &increments[node].q, found, &jerk_dt);
            }
            sums.all += found.sum() + now.x.sum();
        }
        sums
    })
}

/// Writes the motion of separate bodies at the end of the step, with the rates of the increments. If forces are wanted, it also writes the
/// residual on prescribed degrees of freedom.
pub fn end_step(cx: &Context, ws: &mut Workspace, (masses, missing): (&Masses, &[Vec6]), state: &State, dt: f64) {
    let given = &ws.prescribed.moved;
    let restraints = &cx.model.constraints.restraints;
    let data = ((&mut ws.trial.nodes[..], &mut ws.trial.increments[..]), &mut ws.forces.on_nodes[..]);
    cx.chunks.run(data, &|chunk: &NodeChunk, ((trial, increments), F): (Moving, &mut [[f64; 6]])| {
        let first = chunk.nodes.start;
        let mut held = cx.chunks.restraints[chunk.restraints.clone()].iter().peekable();
        for &node in &cx.independent_nodes[chunk.independent.clone()] {
            let (start, now, found) = (&state.nodes[node], &mut trial[node - first], &missing[node]);
            let (increment, F) = (&mut increments[node - first], &mut F[node - first]);
            let motion = match masses.of(node) {
                Some(block) => {
                    let motion = block.verlet(start, now, F, found, dt);
                    if cx.wants_forces {
                        block.subtract_inertia(now, found, F);
                    }
                    motion
                }
                None => NodeRates::mean(start, now, found, dt),
            };
            let chart = Chart::new(&angular(&increment.q));
            let (d, dd) = chart.vector_rates(&motion.omega, &motion.alpha);
            (increment.d, increment.dd) = (stack(&motion.v, &d), stack(&motion.a, &dd));
            // Positions and rotations already have their trial values, including prescribed ones.
            while let Some(&i) = held.next_if(|&&i| restraints[i].node <= node) {
                if restraints[i].node == node {
                    prescribe(increment, restraints[i].dof, &given[i]);
                }
            }
            (now.v, now.a) = (linear(&increment.d), linear(&increment.dd));
            (now.omega, now.alpha) = chart.spatial_rates(&angular(&increment.d), &angular(&increment.dd));
        }
        Nothing
    });
    ws.trial.update_dependent_nodes(cx, &state.nodes);
}
