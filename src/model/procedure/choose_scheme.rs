//! The default scheme of automatic steps: an explicit one of high order for models without stiff parts, otherwise an implicit one.

use crate::data::{Body, LinearSpring, Model};
use mechanics::integrators::{Scheme, automatic_scheme};
use std::collections::HashMap;
use std::sync::Arc;

/// Largest phase ω T of the fastest vibration over a run for explicit steps; they need about two evaluations per radian.
const PHASE: f64 = 3000.0;

/// The scheme for automatic steps of this model.
pub fn choose_scheme(model: &Model) -> Arc<dyn Scheme> {
    automatic_scheme(!is_soft(model))
}

/// True for rigid bodies alone, on joints and soft linear links.
fn is_soft(model: &Model) -> bool {
    if model.bodies.is_empty()
        || !model.masses.is_empty()
        || !model.has_few_joint_equations()
        || !all_move_as_bodies(model)
    {
        return false;
    }
    let mut fastest = vec![0.0; model.nodes.len()];
    let masters: HashMap<usize, usize> =
        model.constraints.dependents.iter().map(|dependent| (dependent.node, dependent.master)).collect();
    for part in &model.parts {
        let Some(LinearSpring { ends, stiffness, damping }) = part.linear_spring() else { return false };
        let damping = damping + model.damping.beta(&part.own_damping()) * stiffness;
        for end in ends {
            let master = masters.get(&end).copied().unwrap_or(end);
            let Some(body) = Body::at(&model.bodies, master).map(|at| &model.bodies[at]) else { continue };
            let arm = (model.nodes[end].x - model.nodes[master].x).norm();
            let least = body.inertia.symmetric_eigenvalues().min();
            let flexibility = 1.0 / body.mass + if arm > 0.0 { arm * arm / least } else { 0.0 };
            // Both ends may move against each other; damping alone leads to rates of c/m.
            fastest[master] += 2.0 * stiffness * flexibility + (2.0 * damping * flexibility).powi(2);
        }
    }
    let square = fastest.into_iter().fold(0.0, f64::max);
    square.sqrt() * model.analysis.duration() < PHASE
}

/// True where every node is a body, fixed on one, or held: others may have no mass.
fn all_move_as_bodies(model: &Model) -> bool {
    let (mut held, mut follows) = (vec![0; model.nodes.len()], vec![false; model.nodes.len()]);
    model.constraints.restraints.iter().for_each(|restraint| held[restraint.node] += 1);
    for dependent in &model.constraints.dependents {
        follows[dependent.node] = dependent.dofs[..3] == [true; 3];
    }
    let is_place = |node: &usize| !model.nodes[*node].is_number;
    let is_body = |node: usize| Body::at(&model.bodies, node).is_some();
    (0..model.nodes.len()).filter(is_place).all(|node| is_body(node) || follows[node] || held[node] >= 3)
}
