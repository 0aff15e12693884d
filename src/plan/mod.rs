//! What will be computed, decided once: which directions are unknowns and why the others are not, the structure of the
//! matrix, the factorisation, when it is refreshed.

mod choose;
pub mod explain;
pub mod explicit;
mod place;
mod redundant_constraints;
mod savings;
mod unreachable_targets;

use crate::linear::{self, Solver, Structure, TooLarge};
use crate::model::{AnalysisKind, Model};
use crate::system::assembly::{self, Assembly};
use crate::system::{DofMap, NodeRows, System};

/// Decisions about a model. Constant over a run.
pub struct Plan {
    /// Rows of directions and multipliers.
    pub dofs: DofMap,
    pub structure: Structure,
    pub kind: linear::Factorization,
    /// Steps solve for accelerations with the masses alone: the matrix is that of masses and joints.
    pub explicit: bool,
    /// The matrix never changes: it is factorised once per length of step.
    pub linear: bool,
    /// Iterations that a fresh matrix may cost: forming and factorising it against one residual and one solve.
    pub refresh_cost: f64,
    pub threads: usize,
    /// Multipliers of joints that say what others say already; `None`: too many to tell.
    pub redundant_constraints: Option<Vec<usize>>,
    nodes: Vec<place::Place>,
}

impl Plan {
    pub fn new(model: &Model, system: &System, threads: usize) -> Plan {
        let nodes = place::place(model, system);
        let unknown = nodes.iter().map(|place| place.map(|why| why == place::DofStatus::Unknown));
        let dofs = DofMap::new(unknown, &system.joints);
        let explicit = model.analysis.kind == AnalysisKind::Dynamic && model.solution.scheme.is_explicit();
        let structure = if explicit { structure(&system.bare(), &dofs) } else { structure(system, &dofs) };
        let kind = choose::kind(&structure, model.solution.iteration.gyroscopic);
        // A body that turns in space has J = R J₀ Rᵀ and a gyroscopic moment; about one axis neither changes.
        let mut driven = vec![[false; 6]; nodes.len()];
        model
            .constraints
            .restraints
            .iter()
            .filter(|held| held.motion.is_some())
            .for_each(|held| driven[held.node][held.dof] = true);
        let count = |of: &dyn Fn(usize) -> bool| (3..6).filter(|&dof| of(dof)).count();
        let turns = |node: usize| {
            let unknown = count(&|dof| nodes[node][dof] == place::DofStatus::Unknown);
            unknown > 0 && unknown + count(&|dof| driven[node][dof]) > 1
        };
        let linear = system.is_linear() && !system.inertias.iter().any(|i| i.rotary && turns(i.node));
        let mut plan = Plan {
            refresh_cost: choose::refresh_cost(kind),
            explicit,
            linear,
            dofs,
            structure,
            kind,
            threads,
            redundant_constraints: Some(Vec::new()),
            nodes,
        };
        if !system.joints.is_empty() {
            plan.redundant_constraints = redundant_constraints::find(model, system, &plan.dofs);
        }
        plan
    }

    /// The solver and the assembly of the masses and joints alone.
    ///
    /// # Errors
    /// As for [`Plan::build`].
    pub fn build_bare(&self, bare: &System) -> Result<(Solver, Assembly), TooLarge> {
        let structure = structure(bare, &self.dofs);
        let solver = Solver::new(&structure, linear::Factorization::choose(&structure), 1)?;
        let assembly = Assembly::new(bare, &self.dofs, &solver, 1);
        Ok((solver, assembly))
    }

    /// True where joints may share what they carry.
    pub fn shares(&self) -> bool {
        self.redundant_constraints.as_ref().is_none_or(|redundant_constraints| !redundant_constraints.is_empty())
    }

    /// The solver and the assembly of this plan.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn build(&self, system: &System) -> Result<(Solver, Assembly), TooLarge> {
        if self.explicit {
            return self.build_bare(&system.bare());
        }
        let solver = Solver::new(&self.structure, self.kind, self.threads)?;
        let assembly = Assembly::new(system, &self.dofs, &solver, self.threads);
        Ok((solver, assembly))
    }

    /// How many of these degrees of freedom of all nodes are what they are for this reason.
    fn count(&self, why: place::DofStatus, dofs: std::ops::Range<usize>) -> usize {
        self.nodes.iter().map(|node| node[dofs.clone()].iter().filter(|&&of| of == why).count()).sum()
    }

    /// True for directions that ride, are held or are left out: their increments do not come from the solution.
    pub fn is_unknown(&self, node: usize, dof: usize) -> bool {
        self.nodes[node][dof] == place::DofStatus::Unknown
    }
}

/// Groups of unknowns, one for each node and each joint that has any, and who couples with whom.
fn structure(system: &System, dofs: &DofMap) -> Structure {
    let sizes: Vec<usize> = dofs.each().iter().map(NodeRows::count).collect();
    grouped(&sizes, assembly::connectivity(system, sizes.len()), system.joints.len())
}

/// The same from the numbers of unknowns of nodes, of which the last `multipliers` hold multipliers, and from their couplings.
fn grouped(unknowns: &[usize], connectivity: Vec<Vec<usize>>, multipliers: usize) -> Structure {
    let mut sizes = Vec::new();
    let mut last = 0;
    let mut group = vec![None; unknowns.len()];
    for (node, &size) in unknowns.iter().enumerate() {
        if size > 0 {
            group[node] = Some(sizes.len());
            sizes.push(size);
            last += usize::from(node >= group.len() - multipliers);
        }
    }
    let known = |coupled: Vec<usize>| -> Vec<usize> { coupled.into_iter().filter_map(|node| group[node]).collect() };
    let connectivity = connectivity.into_iter().map(known).filter(|coupled| coupled.len() > 1);
    Structure { sizes, connectivity: connectivity.collect(), multipliers: last }
}
