//! A state about which the motion is linearized.

use super::fault::ModesFault;
use crate::plan::Plan;
use crate::system::assembly::Assembly;
use crate::system::{Loading, System};
use crate::tolerances::linearized::ROUNDING;
use base::math::{Vec3, Vec6};
use linear::{Factorization, Solver, TooLarge};
use mechanics::state::{Node, State};
use model::{DIRECTIONS, Model};
use std::sync::atomic::{AtomicBool, Ordering};

/// A state, with the scene in it.
#[derive(Clone, Copy)]
pub struct Linearized<'a> {
    /// The model.
    pub model: &'a Model,
    /// The system of equations.
    pub system: &'a System,
    /// The plan, with the numbering of the unknowns.
    pub plan: &'a Plan,
    /// The state.
    pub state: &'a State,
    /// The loads that act in it.
    pub loading: &'a Loading,
    /// Loads of the buckling factor; none for other modes.
    pub factored: &'a Loading,
    /// The flag that ends a search when it is raised.
    pub stop: &'a AtomicBool,
}

impl Linearized<'_> {
    /// A separate solver with the symmetric part of matrices.
    ///
    /// # Errors
    /// There is no memory for it.
    pub fn symmetric_solver(&self) -> Result<(Solver, Assembly), TooLarge> {
        self.plan.build_symmetric(self.system)
    }

    /// A separate solver with whole matrices.
    ///
    /// # Errors
    /// There is no memory for it.
    pub fn unsymmetric_solver(&self) -> Result<(Solver, Assembly), TooLarge> {
        let solver = Solver::new(&self.plan.structure, Factorization::BlockLu, self.plan.threads)?;
        let assembly = Assembly::new(self.system, &self.plan.dofs, &solver, self.plan.threads);
        Ok((solver, assembly))
    }

    /// Ends a search where the stop flag is raised.
    ///
    /// # Errors
    /// [`ModesFault::Stopped`].
    pub fn check_stop(&self) -> Result<(), ModesFault> {
        if self.is_stopped() { Err(ModesFault::Stopped) } else { Ok(()) }
    }

    /// True where the stop flag is raised.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// True if links and the active loads have a potential, as in [`System::has_potential`].
    pub fn has_potential(&self) -> bool {
        let factors = self.loading.factors.iter().zip(&self.factored.factors);
        let acts = factors.map(|(loading, factored)| *loading != 0.0 || *factored != 0.0);
        let mut acting = self.model.loading.nodal.iter().zip(acts).filter(|(_, acts)| *acts);
        self.system.links_have_potential() && acting.all(|(load, _)| load.has_potential(self.system.plane))
    }

    /// True for an angular velocity above rounding: it turns by more than that over the analysis.
    pub fn spins(&self, omega: &Vec3) -> bool {
        omega.norm() * self.model.analysis.end_time > ROUNDING
    }

    /// The state with all spins multiplied by a factor.
    pub fn spun(&self, factor: f64) -> State {
        let mut state = self.state.clone();
        state.nodes.iter_mut().for_each(|node| node.omega *= factor);
        state
    }

    /// The node that carries another by rigid links, and whether these have arms.
    pub fn root(&self, node: usize) -> (usize, bool) {
        let (mut root, mut arm) = (node, false);
        while let Some(link) = self.system.rigid_links.iter().find(|link| link.node == root && link.rigid) {
            arm |= link.S0.norm() > 0.0;
            root = link.master;
        }
        (root, arm)
    }

    /// The nodes of the state, at rest.
    pub fn nodes_at_rest(&self) -> Vec<Node> {
        let zero = Vec3::zeros();
        self.state.nodes.iter().map(|node| Node { v: zero, omega: zero, a: zero, alpha: zero, ..*node }).collect()
    }

    /// Number of unknowns that are degrees of freedom of nodes.
    pub fn unknowns(&self) -> usize {
        self.plan.dofs.nodal_dofs().len()
    }

    /// The small motions of all nodes, dependent ones included, from the motions `x` of the unknowns.
    pub fn motions(&self, nodes: &[Node], x: &[f64]) -> Vec<Vec6> {
        let mut motions: Vec<Vec6> = self.plan.dofs.each_node().iter().map(|rows| rows.gather(x)).collect();
        self.system.carry_all(nodes, &mut motions);
        motions
    }

    /// The name of a row.
    pub fn name(&self, row: usize) -> (String, &'static str) {
        match self.plan.dofs.nodal_dofs().get(row) {
            Some(&(node, dof)) => (self.model.nodes[node].label.clone(), DIRECTIONS[dof]),
            None => self.system.row(row - self.unknowns()).map_or((String::new(), ""), |(joint, equation)| {
                (self.model.constraints.joints[joint].name.clone(), equation.word())
            }),
        }
    }
}
