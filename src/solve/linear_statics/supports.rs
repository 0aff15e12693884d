//! The rows and columns of K around supports: the forces of prescribed motions, and reactions.

use crate::context::Context;
use crate::plan::Plan;
use crate::system::assembly::Assembly;
use crate::system::connectivity::connectivity;
use crate::system::{Forces, Loading, TangentWeights};
use base::math::Vec6;
use linear::{Factorization, Solver, Sparse, TooLarge};
use mechanics::state::Configuration;

/// K with the restrained degrees of freedom among its unknowns, for the nodes that elements connect with a support.
pub struct SupportMatrix {
    plan: Plan,
    K: Sparse,
    motions: Vec<f64>,
    forces: Vec<f64>,
}

impl SupportMatrix {
    /// The matrix of a scene at rest.
    ///
    /// # Errors
    /// There is no memory for it.
    pub fn new(
        cx: &Context,
        now: &Configuration,
        (loading, forces): (&Loading, &mut Forces),
        weights: TangentWeights,
    ) -> Result<SupportMatrix, TooLarge> {
        let restraints = &cx.model.constraints.restraints;
        let mut unknown = vec![[false; 6]; cx.model.nodes.len()];
        restraints.iter().for_each(|held| unknown[held.node][held.dof] = true);
        let supported: Vec<bool> = unknown.iter().map(|dofs| dofs.contains(&true)).collect();
        let all = cx.plan.dofs.each().len();
        for coupled in connectivity(cx.system, all, &[]) {
            let nodes = || coupled.iter().copied().filter(|&node| node < supported.len());
            if nodes().any(|node| supported[node]) {
                for node in nodes() {
                    (0..6).for_each(|dof| unknown[node][dof] |= cx.plan.dofs.of(node).has(dof));
                }
            }
        }
        let plan = cx.plan.with_unknowns(cx.system, unknown);
        let mut solver = Solver::new(&plan.structure, Factorization::Cholesky, 1)?;
        let mut assembly = Assembly::new(cx.system, &plan.dofs, &solver, cx.plan.threads);
        assembly.unconstrained(cx.system, now, loading, forces, weights, &mut solver);
        let rows = plan.dofs.nodal_dofs().len();
        Ok(SupportMatrix { K: solver.matrix(rows), motions: vec![0.0; rows], forces: vec![0.0; rows], plan })
    }

    /// Writes the elastic forces of the motions of all nodes into `out`, by node; they are complete at restrained degrees of freedom, and
    /// elsewhere as far as motions of restrained nodes cause them.
    pub fn forces(&mut self, motions: &[Vec6], out: &mut [Vec6]) {
        let SupportMatrix { plan, K, motions: u, forces: f } = self;
        let nodes = plan.dofs.each_node();
        nodes.iter().zip(motions).for_each(|(rows, motion)| rows.scatter(motion, u));
        K.multiply(u, f);
        nodes.iter().zip(out).for_each(|(rows, out)| *out = rows.gather(f));
    }
}
