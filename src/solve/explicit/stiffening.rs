//! Checks of the stability of central differences by the motion itself: whether the scene has stiffened in a step, and
//! whether a mode grows.

use super::accelerations::Accelerations;
use super::inner_product::{apply_mass, times_applied};
use super::node_sums::StepSums;
use crate::context::Context;
use crate::system::masses::Masses;
use crate::tolerances::stiffening::{LIMIT, QUICK};
use crate::workspace::Workspace;
use base::math::{Vec6, angular, linear, stack};
use mechanics::state::{Node, State};

/// The change of a node's acceleration over the step; `missing` is the difference of those of the trial motion.
pub fn change(missing: &[Vec6], trial: &[Node], state: &State, node: usize) -> Vec6 {
    let (start, now) = (&state.nodes[node], &trial[node]);
    stack(&(now.a - start.a), &(now.alpha - start.alpha)) + missing[node]
}

/// The Rayleigh quotient −Δaᵀ M q/qᵀ M q of the step's motion, a mean of ω² over its modes. More than ω² of the fastest
/// known mode shows that the scene has stiffened, as in an impact. It is zero where the step is short enough in any
/// case. With it come numerator and denominator, by approximate inertias.
pub fn resistance(
    cx: &Context,
    ws: &mut Workspace,
    accelerations: &mut Accelerations,
    state: &State,
    dt: f64,
) -> (f64, [f64; 2]) {
    let Accelerations { masses, missing, operand, .. } = accelerations;
    let (trial, increments) = (&ws.trial.nodes, &ws.trial.increments);
    let change = |node: usize| change(missing, trial, state, node);
    let Some(masses) = masses else {
        apply_mass(cx, trial, operand, &mut ws.forces, |node| increments[node].q);
        let size = times_applied(cx, &ws.forces, |node| increments[node].q);
        let force = -times_applied(cx, &ws.forces, change);
        return (if size > 0.0 { force / size } else { 0.0 }, [force, size]);
    };
    let (mut force, mut size) = (0.0, 0.0);
    for block in &masses.blocks {
        let [mass, inertia] = block.mean_mass();
        let (da, q) = (change(block.node), &increments[block.node].q);
        force -= mass * linear(&da).dot(&linear(q)) + inertia * angular(&da).dot(&angular(q));
        size += mass * linear(q).norm_squared() + inertia * angular(q).norm_squared();
    }
    let is_slow = force <= QUICK * 4.0 / (dt * dt) * size;
    (if is_slow { 0.0 } else { quotient(ws, (masses, missing), state) }, [force, size])
}

/// Like [`resistance`], for separate bodies whose sums are known.
pub fn resistance_of_nodes(
    ws: &Workspace,
    of_nodes: (&Masses, &[Vec6]),
    state: &State,
    (sums, dt): (&StepSums, f64),
) -> f64 {
    let [force, size] = sums.resistance;
    if force <= QUICK * 4.0 / (dt * dt) * size { 0.0 } else { quotient(ws, of_nodes, state) }
}

/// The Rayleigh quotient with the exact inertias.
fn quotient(ws: &Workspace, (masses, missing): (&Masses, &[Vec6]), state: &State) -> f64 {
    let (mut force, mut size) = (0.0, 0.0);
    for block in &masses.blocks {
        let (da, q) = (change(missing, &ws.trial.nodes, state, block.node), &ws.trial.increments[block.node].q);
        let node = &ws.trial.nodes[block.node];
        force -= block.inner_product(node, &da, q);
        size += block.inner_product(node, q, q);
    }
    force / size
}

/// A quick check whether a mode grows. Without loads and dampers, −(a₁ − 2 a₀ + a₋₁)ᵀM a₀/a₀ᵀM a₀ is a mean of (ω Δt)² over the modes.
/// Weighting by accelerations shows fast modes despite the gross motion, and decaying modes do not disturb it.
pub fn is_growing(cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations, state: &State, dt: f64) -> bool {
    let Accelerations { masses, missing, operand, .. } = accelerations;
    let trial = &ws.trial.nodes;
    let before = |node: usize| stack(&state.nodes[node].a, &state.nodes[node].alpha);
    let change = |node: usize| change(missing, trial, state, node);
    let Some(masses) = masses else {
        apply_mass(cx, trial, operand, &mut ws.forces, before);
        let size = times_applied(cx, &ws.forces, before);
        let second = |node: usize| change(node) - state.jerk[node] * dt;
        if -times_applied(cx, &ws.forces, second) <= LIMIT * size {
            return false;
        }
        let now = |node: usize| before(node) + change(node);
        apply_mass(cx, trial, operand, &mut ws.forces, now);
        return times_applied(cx, &ws.forces, now) > size;
    };
    let (mut increase, mut size, mut next) = (0.0, 0.0, 0.0);
    for block in &masses.blocks {
        let start = &state.nodes[block.node];
        let [mass, inertia] = block.mean_mass();
        let first = change(block.node);
        let second = first - state.jerk[block.node] * dt;
        let now = first + stack(&start.a, &start.alpha);
        next += mass * linear(&now).norm_squared() + inertia * angular(&now).norm_squared();
        increase -= mass * linear(&second).dot(&start.a) + inertia * angular(&second).dot(&start.alpha);
        size += mass * start.a.norm_squared() + inertia * start.alpha.norm_squared();
    }
    increase > LIMIT * size && next > size
}

/// Like [`is_growing`], for separate bodies whose sums are known.
pub fn is_growing_by(sums: &StepSums) -> bool {
    let [increase, size, next] = sums.growth;
    increase > LIMIT * size && next > size
}
