//! Products of motions in the norm of the masses, used by the stability checks of explicit schemes.

use super::accelerations::Accelerations;
use crate::context::Context;
use crate::system::Forces;
use crate::system::masses::MassBlock;
use crate::workspace::Workspace;
use base::math::{Vec6, stack};
use mechanics::state::Node;

/// Writes M times small motions of the independent nodes over the forces on nodes, for unknown degrees of freedom of a coupled mass matrix.
pub fn apply_mass(
    cx: &Context,
    nodes: &[Node],
    operand: &mut [Vec6],
    forces: &mut Forces,
    motion: impl Fn(usize) -> Vec6,
) {
    for &node in &cx.independent_nodes {
        operand[node] = cx.plan.dofs.of(node).mask(&motion(node));
    }
    cx.system.apply_mass(nodes, operand, forces);
}

/// The product of a motion with the result of the last [`apply_mass`].
pub fn times_applied(cx: &Context, forces: &Forces, motion: impl Fn(usize) -> Vec6) -> f64 {
    let times = |&node: &usize| cx.plan.dofs.of(node).mask(&motion(node)).dot(&Vec6::from(forces.on_nodes[node]));
    cx.independent_nodes.iter().map(times).sum()
}

/// The product aᵀ M a of the accelerations of the trial motion over the unknowns, without the gyroscopic accelerations of freely turning
/// bodies.
pub fn aMa_of_trial(cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations) -> f64 {
    let Accelerations { masses, operand, missing, .. } = accelerations;
    let trial = &ws.trial.nodes;
    let a = |node: usize| stack(&trial[node].a, &trial[node].alpha) + missing[node];
    let Some(masses) = masses else {
        apply_mass(cx, trial, operand, &mut ws.forces, a);
        return times_applied(cx, &ws.forces, a);
    };
    let product = |block: &MassBlock| aMa_of_block(cx, block, &trial[block.node], &a(block.node));
    masses.blocks.iter().map(product).sum()
}

/// The product aᵀ M a of the accelerations of `nodes`.
pub fn aMa_of_nodes(cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations, nodes: &[Node]) -> f64 {
    let a = |node: usize| stack(&nodes[node].a, &nodes[node].alpha);
    let Some(masses) = &accelerations.masses else {
        apply_mass(cx, nodes, &mut accelerations.operand, &mut ws.forces, a);
        return times_applied(cx, &ws.forces, a);
    };
    let product = |block: &MassBlock| aMa_of_block(cx, block, &nodes[block.node], &a(block.node));
    masses.blocks.iter().map(product).sum()
}

fn aMa_of_block(cx: &Context, block: &MassBlock, node: &Node, a: &Vec6) -> f64 {
    block.push_product(node, &cx.plan.dofs.of(block.node).mask(a))
}
