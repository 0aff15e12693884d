//! Matrices of the equation of motion for other programs, in the geometry of the deck: M q̈ + C q̇ + K q + Gᵀλ = f with G q = 0. K includes
//! K(σ) of prestressed parts; no loads act, and nodes are at rest.

use super::pencil::weights;
use crate::plan::Plan;
use crate::system::assembly::Assembly;
use crate::system::{Forces, Loading, System, TangentWeights};
use base::math::Vec6;
use linear::{Factorization, Solver, Sparse, TooLarge};
use mechanics::state::{Configuration, Node};
use model::{DIRECTIONS, Model};

/// Weight of C in the assembly beside K, a large power of two, so that C keeps its digits.
const RATE: f64 = 1_048_576.0;

/// SceneMatrices by the unknowns of nodes.
pub struct SceneMatrices {
    /// K.
    pub stiffness: Sparse,
    /// M.
    pub mass: Sparse,
    /// C, of dampers, nodal and Rayleigh damping; without entries where nothing damps.
    pub damping: Sparse,
    /// G: number of the equation of a joint, number of the unknown, and coefficient.
    pub constraints: Vec<(usize, usize, f64)>,
    /// The number of equations of joints.
    pub equations: usize,
    /// The node and direction of each unknown.
    pub unknowns: Vec<(String, &'static str)>,
}

impl SceneMatrices {
    /// The matrices of a scene.
    ///
    /// # Errors
    /// There is no memory for them.
    pub fn of(model: &Model, system: &System, plan: &Plan) -> Result<SceneMatrices, TooLarge> {
        let nodes: Vec<Node> = model.nodes.iter().map(|node| Node::at_rest(node.x)).collect();
        let history = vec![0.0; system.history];
        let now = Configuration { history: &history, ..Configuration::of(&nodes) };
        let loading = Loading { factors: vec![0.0; model.loading.nodal.len()], ..Loading::default() };
        let mut forces = Forces::new(system, nodes.len());
        system.residual(&now, &loading, &mut forces);
        let mut solver = Solver::new(&plan.structure, Factorization::BlockLu, plan.threads)?;
        let mut assembly = Assembly::new(system, &plan.dofs, &solver, plan.threads);
        let rows = plan.dofs.nodal_dofs();
        let mut matrix = |weights: TangentWeights| {
            assembly.unconstrained(system, &now, &loading, &mut forces, weights, &mut solver);
            solver.matrix(rows.len())
        };
        let stiffness = matrix(weights(0.0, 0.0));
        let with_rates = matrix(weights(RATE, 0.0));
        let mass = matrix(TangentWeights { stiffness: false, ..weights(0.0, 1.0) });
        let damping = Sparse::sum(&[(1.0 / RATE, &with_rates), (-1.0 / RATE, &stiffness)]);
        let unknowns = rows.iter().map(|&(node, dof)| (model.nodes[node].label.clone(), DIRECTIONS[dof])).collect();
        let constraints = constraints(system, plan, &nodes);
        Ok(SceneMatrices { stiffness, mass, damping, constraints, equations: system.multipliers(), unknowns })
    }
}

/// G, from the gaps of joints under unit values of each unknown.
fn constraints(system: &System, plan: &Plan, nodes: &[Node]) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let mut gaps = vec![0.0; system.multipliers()];
    if gaps.is_empty() {
        return found;
    }
    let mut motions = vec![Vec6::zeros(); nodes.len()];
    for (unknown, &(node, dof)) in plan.dofs.nodal_dofs().iter().enumerate() {
        motions.fill(Vec6::zeros());
        motions[node][dof] = 1.0;
        system.project(nodes, &mut motions);
        system.gaps_of_motion(nodes, &motions, &mut gaps);
        let entries = gaps.iter().enumerate().filter(|(_, gap)| **gap != 0.0);
        found.extend(entries.map(|(equation, gap)| (equation, unknown, *gap)));
    }
    found
}
