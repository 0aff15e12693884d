//! Operations avoided by the omissions of a plan: the matrix without each of them, compared with the matrix of the plan.

use super::dof_status::DofStatus;
use super::{Plan, grouped};
use crate::system::connectivity::{connectivity, connectivity_with_multipliers};
use crate::system::{NodeRows, System};
use crate::tolerances::savings::WORTH;
use linear::{Factorization, Structure, operations};
use model::{AnalysisKind, Model};

impl Plan {
    /// A line for each omission whose saving can be counted: operations of a factorization of the matrix of a step.
    /// Nothing is run.
    pub fn savings(&self, model: &Model, system: &System) -> Vec<String> {
        if self.explicit || self.dofs.nodal_dofs().is_empty() {
            return Vec::new();
        }
        let own = operations(&self.structure);
        let mut out = Vec::new();
        let mut compare = |what: &str, with: &Structure| {
            let unknowns: usize = with.sizes.iter().sum();
            let times = operations(with) / own;
            if times >= WORTH {
                out.push(format!(
                    "{what}: with them {unknowns} unknowns and {times:.1} times the operations of a factorization"
                ));
            }
        };
        let kept = [
            (DofStatus::Plane, "degrees of freedom out of the plane"),
            (DofStatus::Inactive, "inactive degrees of freedom"),
            (DofStatus::Restrained, "restrained degrees of freedom"),
        ];
        for (why, what) in kept {
            let sizes = self.sizes_with(why);
            compare(what, &grouped(&sizes, connectivity(system, sizes.len(), &[]), system.joints.len()));
        }
        if !system.rigid_links.is_empty() {
            compare("Lagrange multipliers of dependent nodes", &self.with_multipliers(system));
        }
        if self.kind == Factorization::Cholesky && !self.linear {
            out.push("unsymmetric part of the tangent: with it 2 times the operations of a factorization".to_string());
        }
        if self.linear && model.analysis.kind == AnalysisKind::Dynamic {
            out.push("equilibrium iterations: the scene is linear, one solve per step is exact".to_string());
        }
        out
    }

    /// Number of unknowns of each node and joint, with the degrees of freedom of this status kept.
    fn sizes_with(&self, why: DofStatus) -> Vec<usize> {
        let mut sizes: Vec<usize> = self.dofs.each().iter().map(NodeRows::count).collect();
        for (size, place) in sizes.iter_mut().zip(&self.nodes) {
            *size += place.iter().filter(|reason| **reason == why).count();
        }
        sizes
    }

    /// The structure with multipliers in place of elimination: dependent nodes get unknowns, and each of their dependent degrees of freedom
    /// a multiplier.
    fn with_multipliers(&self, system: &System) -> Structure {
        let mut sizes = self.sizes_with(DofStatus::Dependent);
        let nodes = sizes.len();
        sizes.extend(system.rigid_links.iter().map(|dependent| dependent.dofs.iter().filter(|&&taken| taken).count()));
        grouped(&sizes, connectivity_with_multipliers(system, nodes), system.joints.len() + system.rigid_links.len())
    }
}
