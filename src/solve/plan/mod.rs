//! The plan of a run, decided once: unknowns, reasons for omissions, structure of the matrix, its factorization, and when it is formed
//! again.

mod choose;
mod dof_status;
pub mod explain;
pub mod explicit;
mod guards;
mod redundant_constraints;
mod savings;
mod sideways;
mod unreachable_targets;

use crate::system::assembly::Assembly;
use crate::system::connectivity::connectivity;
use crate::system::{DofMap, NodeRows, System};
use crate::tolerances::threads::NODES_WORTH_THREADS;
use dof_status::DofStatus;
pub use guards::GuardKind;
use linear::{self, Solver, Structure, TooLarge};
use mechanics::elements::Partners;
use model::{AnalysisKind, Model};
pub use sideways::Sideways;
pub use unreachable_targets::unreachable_targets;

/// The decisions about a model. They are constant over a run.
pub struct Plan {
    /// Numbering of the unknowns.
    pub dofs: DofMap,
    /// Groups of unknowns and their couplings.
    pub structure: Structure,
    /// The factorization of the matrix.
    pub kind: linear::Factorization,
    /// True for explicit schemes: steps solve for accelerations, and the matrix is that of masses and joints.
    pub explicit: bool,
    /// True where the matrix never changes: it is factorized once for each length of step.
    pub linear: bool,
    /// Guards, in the order of their calls.
    pub guards: Vec<GuardKind>,
    /// Cost of forming and factorizing the matrix, in units of one residual and one solve.
    pub refresh_cost: f64,
    /// Number of threads.
    pub threads: usize,
    /// Numbers of the multipliers of redundant constraint equations; `None` where there are too many equations to
    /// search.
    pub redundant_constraints: Option<Vec<usize>>,
    nodes: Vec<dof_status::NodeStatus>,
    /// Positions of the nodes at the start.
    places: Vec<[f64; 3]>,
}

impl Plan {
    /// Decides on everything from the model and its system.
    pub fn new(model: &Model, system: &System, threads: usize) -> Plan {
        let nodes = dof_status::classify(model, system);
        let unknown = nodes.iter().map(|node| node.map(|status| status == DofStatus::Unknown));
        let dofs = DofMap::new(unknown, &system.joints);
        let explicit = model.analysis.kind == AnalysisKind::Dynamic && model.solution.scheme.is_explicit();
        let mut structure = if explicit { structure(&system.bare(), &dofs) } else { structure(system, &dofs) };
        let places: Vec<[f64; 3]> = model.nodes.iter().map(|node| node.x.into()).collect();
        structure.positions = positions(&dofs, &places);
        let kind = match model.analysis.is_linear() {
            // Without loads the stiffness at t = 0 is symmetric.
            true => linear::Factorization::Cholesky,
            false => {
                let slips = model.analysis.is_static() && system.rubs();
                choose::kind(&structure, model.solution.iteration.gyroscopic, slips)
            }
        };
        // A body that rotates in space has J = R J₀ Rᵀ and a gyroscopic moment; about one fixed axis neither changes.
        let mut driven = vec![[false; 6]; nodes.len()];
        model
            .constraints
            .restraints
            .iter()
            .filter(|restraint| restraint.motion.is_some())
            .for_each(|restraint| driven[restraint.node][restraint.dof] = true);
        let count = |of: &dyn Fn(usize) -> bool| (3..6).filter(|&dof| of(dof)).count();
        let turns = |node: usize| {
            let unknown = count(&|dof| nodes[node][dof] == DofStatus::Unknown);
            unknown > 0 && unknown + count(&|dof| driven[node][dof]) > 1
        };
        let linear = system.is_linear() && !system.inertias.iter().any(|i| i.rotary && turns(i.node));
        let mut plan = Plan {
            refresh_cost: choose::refresh_cost(kind),
            guards: guards::choose(model, system, linear, explicit),
            explicit,
            linear,
            dofs,
            structure,
            kind,
            threads,
            redundant_constraints: Some(Vec::new()),
            nodes,
            places,
        };
        if !system.joints.is_empty() {
            plan.redundant_constraints = redundant_constraints::find(model, system, &plan.dofs);
        }
        plan
    }

    /// The solver and the assembly of masses and joints alone.
    ///
    /// # Errors
    /// As for [`Plan::build`].
    pub fn build_bare(&self, bare: &System) -> Result<(Solver, Assembly), TooLarge> {
        let structure = structure(bare, &self.dofs);
        let solver = Solver::new(&structure, linear::Factorization::choose(&structure), 1)?;
        let assembly = Assembly::new(bare, &self.dofs, &solver, 1);
        Ok((solver, assembly))
    }

    /// True where the nodes are many enough for several threads to pay in the loops over them.
    pub fn has_many_nodes(&self) -> bool {
        self.nodes.len() >= NODES_WORTH_THREADS
    }

    /// True where constraint equations are redundant, or may be.
    pub fn has_redundant_constraints(&self) -> bool {
        self.redundant_constraints.as_ref().is_none_or(|redundant_constraints| !redundant_constraints.is_empty())
    }

    /// The solver and the assembly of the matrix of a step.
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

    /// Like the above with the symmetric part of the matrix, by a Cholesky factorization.
    ///
    /// # Errors
    /// As for [`Plan::build`].
    pub fn build_symmetric(&self, system: &System) -> Result<(Solver, Assembly), TooLarge> {
        let solver = Solver::new(&self.structure, linear::Factorization::Cholesky, self.threads)?;
        let assembly = Assembly::new(system, &self.dofs, &solver, self.threads);
        Ok((solver, assembly))
    }

    /// Like the above, with room for pairs of elements with changing partners.
    ///
    /// # Errors
    /// As for [`Plan::build`].
    pub fn build_with(&self, system: &System, partners: &[(usize, Partners)]) -> Result<(Solver, Assembly), TooLarge> {
        self.build_of(self.kind, system, partners)
    }

    /// Like the above for a matrix stored in full, which may be unsymmetric.
    ///
    /// # Errors
    /// As for [`Plan::build`].
    pub fn build_unsymmetric(
        &self,
        system: &System,
        partners: &[(usize, Partners)],
    ) -> Result<(Solver, Assembly), TooLarge> {
        self.build_of(linear::Factorization::BlockLu, system, partners)
    }

    fn build_of(
        &self,
        kind: linear::Factorization,
        system: &System,
        partners: &[(usize, Partners)],
    ) -> Result<(Solver, Assembly), TooLarge> {
        let mut structure = structure_with(system, &self.dofs, partners);
        structure.positions.clone_from(&self.structure.positions);
        let solver = Solver::new(&structure, kind, self.threads)?;
        let assembly = Assembly::with_room(system, &self.dofs, &solver, self.threads, partners);
        Ok((solver, assembly))
    }

    /// The plan with some prescribed degrees of freedom, by node and direction, among the unknowns: their columns in its matrices are the
    /// forces of their motion.
    pub fn with_prescribed(&self, system: &System, prescribed: &[(usize, usize)]) -> Plan {
        let mut unknown: Vec<[bool; 6]> = self.dofs.each_node().iter().map(NodeRows::unknown).collect();
        prescribed.iter().for_each(|&(node, dof)| unknown[node][dof] = true);
        self.with_unknowns(system, unknown)
    }

    /// The plan with these unknowns, by node and direction.
    pub fn with_unknowns(&self, system: &System, unknown: Vec<[bool; 6]>) -> Plan {
        let dofs = DofMap::new(unknown.into_iter(), &system.joints);
        let mut structure = structure(system, &dofs);
        structure.positions = positions(&dofs, &self.places);
        let nodes = self.nodes.clone();
        Plan {
            dofs,
            structure,
            nodes,
            places: self.places.clone(),
            guards: self.guards.clone(),
            redundant_constraints: self.redundant_constraints.clone(),
            ..*self
        }
    }

    /// Number of these degrees of freedom, over all nodes, with this status.
    fn count(&self, status: DofStatus, dofs: std::ops::Range<usize>) -> usize {
        self.nodes.iter().map(|node| node[dofs.clone()].iter().filter(|&&of| of == status).count()).sum()
    }

    /// True for an unknown; increments of other degrees of freedom do not come from the solution.
    pub fn is_unknown(&self, node: usize, dof: usize) -> bool {
        self.nodes[node][dof] == DofStatus::Unknown
    }
}

/// The places of the nodes that have unknowns, in the order of their groups.
fn positions(dofs: &DofMap, places: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let unknowns = dofs.each().iter().map(NodeRows::count);
    places.iter().zip(unknowns).filter(|(_, count)| *count > 0).map(|(place, _)| *place).collect()
}

/// The structure of the matrix: groups of unknowns, one for each node and each joint that has any, and their couplings.
fn structure(system: &System, dofs: &DofMap) -> Structure {
    structure_with(system, dofs, &[])
}

/// Like the above, with room for pairs of elements with changing partners.
fn structure_with(system: &System, dofs: &DofMap, partners: &[(usize, Partners)]) -> Structure {
    let sizes: Vec<usize> = dofs.each().iter().map(NodeRows::count).collect();
    grouped(&sizes, connectivity(system, sizes.len(), partners), system.joints.len())
}

/// Structure from the number of unknowns of each node and the connectivity of the nodes. The last `multipliers` groups are those of joints.
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
    Structure { sizes, connectivity: connectivity.collect(), multipliers: last, positions: Vec::new() }
}
