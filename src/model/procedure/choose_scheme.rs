//! The default scheme of automatic steps: an explicit one of high order for models without stiff parts, central differences for sheets that
//! are struck, otherwise an implicit one.

use crate::data::{LinearSpring, Model};
use base::math::rotation::RotationUpdate;
use mechanics::integrators::{CentralDifference, Scheme, automatic_scheme};
use std::sync::Arc;

/// Least number of elements of sheets for central differences: factorizations of fewer are cheap.
const SHEET: usize = 200;
/// Largest number of elements that a wave crosses in a run by central differences, each in some two steps. The falling box of 432 elements, where
/// a wave crosses 4300, takes 0.4 of the time of implicit steps.
const CROSSED: f64 = 20_000.0;

/// Largest phase ω T of the fastest vibration over a run for explicit steps; they need about two evaluations per radian.
const PHASE: f64 = 3000.0;
/// Largest number of constraint equations of joints, which explicit schemes solve by a dense matrix.
const EQUATIONS: usize = 60;

/// The scheme for automatic steps of this model.
pub fn choose_scheme(model: &Model) -> Arc<dyn Scheme> {
    automatic_scheme(!is_soft(model))
}

/// Central differences for a model of thin shells with contacts. Impacts ring through the shells, so implicit steps that resolve the contacts are
/// hardly longer than explicit ones.
pub fn scheme_of_struck_sheets(model: &Model) -> Option<Arc<dyn Scheme>> {
    let equations: usize = model.constraints.joints.iter().map(|joint| joint.equations.len()).sum();
    let (mut elements, mut shortest, mut touches) = (0, f64::INFINITY, false);
    for part in &model.parts {
        match part.crossing_time(&model.nodes) {
            Some(time) => (elements, shortest) = (elements + part.elements(), time.min(shortest)),
            None if !part.touched_nodes().is_empty() => touches = true,
            None => return None,
        }
    }
    let crossed = model.analysis.duration() / shortest;
    let fits = touches && elements >= SHEET && crossed <= CROSSED && equations <= EQUATIONS;
    fits.then(|| Arc::new(CentralDifference { rotation: RotationUpdate::Exponential, mass_scaling_step: None }) as _)
}

/// True for rigid bodies alone, on joints and soft linear links.
fn is_soft(model: &Model) -> bool {
    let equations: usize = model.constraints.joints.iter().map(|joint| joint.equations.len()).sum();
    if model.bodies.is_empty() || !model.masses.is_empty() || equations > EQUATIONS || !all_move_as_bodies(model) {
        return false;
    }
    let mut fastest = vec![0.0; model.nodes.len()];
    for part in &model.parts {
        let Some(LinearSpring { ends, stiffness, damping }) = part.linear_spring() else { return false };
        let damping = damping + model.damping.beta(&part.own_damping()) * stiffness;
        for end in ends {
            let master = master(model, end);
            let Some(body) = model.bodies.iter().find(|body| body.node == master) else { continue };
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
    let held = |node: usize| model.constraints.restraints.iter().filter(|held| held.node == node).count();
    let follows = |node: usize| {
        let of_node = model.constraints.dependents.iter().find(|dependent| dependent.node == node);
        of_node.is_some_and(|dependent| dependent.dofs[..3].iter().all(|follows| *follows))
    };
    let is_body = |node: usize| model.bodies.iter().any(|body| body.node == node);
    let is_place = |node: &usize| !model.nodes[*node].is_number;
    (0..model.nodes.len()).filter(is_place).all(|node| is_body(node) || follows(node) || held(node) >= 3)
}

/// The node that this one is fixed on, or the node itself.
fn master(model: &Model, node: usize) -> usize {
    model.constraints.dependents.iter().find(|dependent| dependent.node == node).map_or(node, |of| of.master)
}
