//! What the motion itself tells of the stability of central differences: whether the scene has stiffened in a step, and whether a
//! mode grows.

use super::accelerations::Accelerations;
use super::inner_product::{apply_mass, times_applied};
use crate::math::{Vec6, angular, linear, stack};
use crate::solve::context::Context;
use crate::solve::workspace::Workspace;
use crate::state::{Node, State};

/// The change of a node's acceleration over the step, with what is missing of it in the trial motion.
pub fn change(missing: &[Vec6], trial: &[Node], state: &State, node: usize) -> Vec6 {
    let (start, now) = (&state.nodes[node], &trial[node]);
    stack(&(now.a - start.a), &(now.alpha - start.alpha)) + missing[node]
}

/// ω² of the mode as which the scene has resisted over the step, −Δaᵀ M q/qᵀ M q: of its modes a mean. More than that of the fastest
/// there was tells that it has stiffened, as where something is struck. Zero where the step is short for it anyway.
pub fn resistance(cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations, state: &State, dt: f64) -> f64 {
    // Below this part of the limit, by approximate inertias, nothing is looked at closer.
    const QUICK: f64 = 0.05;
    let Accelerations { masses, missing, operand, .. } = accelerations;
    let (trial, increments) = (&ws.trial, &ws.increments);
    let change = |node: usize| change(missing, trial, state, node);
    let Some(masses) = masses else {
        apply_mass(cx, trial, operand, &mut ws.forces, |node| increments[node].q);
        let size = times_applied(cx, &ws.forces, |node| increments[node].q);
        let force = -times_applied(cx, &ws.forces, change);
        return if size > 0.0 { force / size } else { 0.0 };
    };
    let (mut force, mut size) = (0.0, 0.0);
    for block in &masses.blocks {
        let [mass, inertia] = block.mean_mass();
        let (da, q) = (change(block.node), &increments[block.node].q);
        force -= mass * linear(&da).dot(&linear(q)) + inertia * angular(&da).dot(&angular(q));
        size += mass * linear(q).norm_squared() + inertia * angular(q).norm_squared();
    }
    if force <= QUICK * 4.0 / (dt * dt) * size {
        return 0.0;
    }
    (force, size) = (0.0, 0.0);
    for block in &masses.blocks {
        let (da, q) = (change(block.node), &increments[block.node].q);
        let node = &trial[block.node];
        force -= block.inner_product(node, &da, q);
        size += block.inner_product(node, q, q);
    }
    force / size
}

/// A quick look at whether a mode grows: without loads and dampers, −(a₁ − 2 a₀ + a₋₁)ᵀM a₀/a₀ᵀM a₀ is (ω Δt)², of all modes a mean,
/// which the motion of the whole does not hide; what dies out is no matter.
pub fn is_growing(cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations, state: &State, dt: f64) -> bool {
    // A little beyond what a mode at the limit shows.
    const LIMIT: f64 = 4.1;
    let Accelerations { masses, missing, operand, .. } = accelerations;
    let trial = &ws.trial;
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
