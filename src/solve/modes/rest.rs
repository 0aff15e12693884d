//! Tests whether a scene is at rest in a state, with supports and joints carrying all loads, and its resistance to motion there.

use super::linearized::Linearized;
use super::pencil::{Pencil, weights};
use crate::system::assembly::Assembly;
use crate::tolerances::rest::{STILL, UNBALANCED};
use linear::Solver;
use mechanics::state::Configuration;

/// Multipliers of the scene at rest in the state; `None` if it would move. Mass stands in for the stiffness that a mechanism does not have.
pub fn multipliers_at_rest(at: &Linearized, linear: (&mut Solver, &mut Assembly)) -> Option<Vec<f64>> {
    let mut pencil = Pencil::new(*at, linear);
    let rest = |pencil: &mut Pencil| -> (Vec<f64>, f64) {
        let Pencil { at, nodes, forces, .. } = pencil;
        let now = Configuration { nodes, history: &at.state.history, dt: 0.0, previous: None };
        let scale = at.system.residual(&now, at.loading, forces);
        let dofs = at.plan.dofs.nodal_dofs().iter();
        let r: Vec<f64> = dofs.map(|&(node, dof)| forces.on_nodes[node][dof]).collect();
        let largest = |moment: bool| {
            let dofs = at.plan.dofs.nodal_dofs().iter().zip(&r).filter(|((_, dof), _)| (*dof > 2) == moment);
            dofs.fold(0.0, |largest: f64, (_, r)| largest.max(r.abs()))
        };
        let (force, moment) = (largest(false), largest(true));
        let part = |left: f64, of: f64| if left == 0.0 { 0.0 } else { left / of };
        let left = part(force, scale.force).max(part(moment, scale.moment + scale.force));
        (r, left)
    };
    let (mut r, left) = rest(&mut pencil);
    if left <= UNBALANCED {
        return Some(pencil.forces.multipliers.values.clone());
    }
    if at.system.joints.is_empty() {
        return None;
    }
    let shift = -1e-3 * pencil.least_ratio();
    pencil.factor(shift).ok()?;
    let x: Vec<_> = pencil.nodes.iter().map(|node| node.x).collect();
    let length = x.iter().map(|at| (at - x[0]).norm()).fold(0.0, f64::max);
    // Regularized equations need a further solution for a small part of the joint forces.
    let mut moved = Vec::new();
    for _ in 0..4 {
        moved = pencil.balance(&r);
        r = rest(&mut pencil).0;
    }
    let dofs = at.plan.dofs.nodal_dofs().iter().zip(&moved);
    let largest = dofs.map(|((_, dof), moved)| if *dof < 3 { moved.abs() } else { moved.abs() * length });
    (largest.fold(0.0, f64::max) <= STILL * length).then(|| pencil.forces.multipliers.values.clone())
}

/// The stiffness of each unknown of nodes against its motion with the others restrained: the magnitudes of the diagonal of K.
pub fn own_stiffnesses(at: &Linearized, linear: (&mut Solver, &mut Assembly)) -> Vec<f64> {
    let K = Pencil::new(*at, linear).matrix(weights(0.0, 0.0));
    let own = |row: usize| K.row(row).filter(|(column, _)| *column == row).map(|(_, value)| value).sum::<f64>().abs();
    (0..K.rows()).map(own).collect()
}
