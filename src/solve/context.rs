//! The constants of a run: the model, its plan, its system, and data computed from them once.

use super::node_chunks::NodeChunks;
use super::step::size::ModelSize;
use super::stop_request::StopRequest;
use crate::plan::Plan;
use crate::system::{Excitation, System};
use crate::tolerances::context::{FORCES, POSITIONS};
use base::math::Vec3;
use mechanics::constraints::joint::Joint;
use mechanics::state::Node;
use model::{AnalysisKind, Model, Restraint};
use std::sync::atomic::AtomicBool;

/// Everything about a run that no step changes. It is built once and borrowed by all that computes.
pub struct Context<'a> {
    /// The model.
    pub model: &'a Model,
    /// The plan of the run.
    pub plan: &'a Plan,
    /// The system of equations.
    pub system: &'a System,
    /// Loads and prescribed motion as functions of time.
    pub excitation: Excitation<'a>,
    /// Nodes with independent increments, in ascending order; other nodes do not move or follow a master.
    pub independent_nodes: Vec<usize>,
    /// All nodes in chunks, for loops over nodes.
    pub chunks: NodeChunks,
    /// Prescribed degrees of freedom, by index in the model's list, whose motion joints transmit to other nodes.
    pub driving: Vec<usize>,
    /// Nodes whose displacement along x is a number: no place in space.
    pub numbers: Vec<usize>,
    /// Coefficients of [`mechanics::integrators::Scheme::algorithmic_acceleration`]; `None` in statics too.
    pub algorithmic_acceleration: Option<[f64; 3]>,
    /// The largest distance of a node from the first: the reference length for corrections if the motion is negligible.
    pub length: f64,
    /// Position of the first node at t = 0, the origin of coordinates for estimates of rounding.
    pub origin: Vec3,
    /// Motions below this length are rounding.
    pub rounding: f64,
    /// True where reactions or the work of forces are wanted.
    pub wants_forces: bool,
    /// True where energies are wanted.
    pub wants_energy: bool,
    /// The request to end the run.
    pub stop: StopRequest<'a>,
}

impl<'a> Context<'a> {
    /// Computes the constants of a run.
    pub fn new(
        model: &'a Model,
        plan: &'a Plan,
        system: &'a System,
        [wants_forces, wants_energy]: [bool; 2],
        stop: &'a AtomicBool,
    ) -> Context<'a> {
        let dynamic = model.analysis.kind == AnalysisKind::Dynamic;
        let independent_nodes = independent_nodes(model, plan, system);
        let restraints = &model.constraints.restraints;
        let length = extent(model);
        let farthest = model.nodes.iter().map(|node| node.x.amax()).fold(0.0, f64::max);
        // Forces that stand against each other leave a rest, which alone moves a scene at rest.
        let stands = model.loading.gravity != Vec3::zeros() || model.analysis.stage.is_some();
        let shares_nodes = plan.threads > 1 && plan.has_many_nodes();
        Context {
            model,
            plan,
            system,
            excitation: Excitation::new(model),
            chunks: NodeChunks::new(model.nodes.len(), &independent_nodes, restraints, shares_nodes),
            independent_nodes,
            driving: driving(model, system),
            numbers: model.number_nodes().collect(),
            algorithmic_acceleration: if dynamic { model.solution.scheme.algorithmic_acceleration() } else { None },
            length,
            rounding: if stands { FORCES * length } else { 0.0 }.max(POSITIONS * farthest),
            origin: model.nodes.first().map_or(Vec3::zeros(), |node| node.x),
            wants_forces,
            wants_energy,
            stop: StopRequest::of(stop),
        }
    }

    /// The lengths that motions are measured by.
    pub fn size(&self) -> ModelSize {
        ModelSize { length: self.length, rounding: self.rounding }
    }

    /// True for a dynamic analysis.
    pub fn is_dynamic(&self) -> bool {
        self.model.analysis.kind == AnalysisKind::Dynamic
    }

    /// Number of unknowns that are degrees of freedom of nodes; the multipliers of joints come after them.
    pub fn nodal_unknowns(&self) -> usize {
        self.plan.dofs.nodal_dofs().len()
    }
}

/// The nodes of the model at rest at their initial positions.
pub fn at_rest(model: &Model) -> Vec<Node> {
    model.nodes.iter().map(|node| Node::at_rest(node.x)).collect()
}

/// The nodes with independent increments. Nodes that nothing moves are omitted and cost nothing.
fn independent_nodes(model: &Model, plan: &Plan, system: &System) -> Vec<usize> {
    let n = model.nodes.len();
    let mut follows = vec![false; n];
    system.rigid_links.iter().filter(|dependent| dependent.rigid).for_each(|dependent| follows[dependent.node] = true);
    let mut driven = vec![false; n];
    model.constraints.restraints.iter().for_each(|restraint| driven[restraint.node] |= restraint.motion.is_some());
    let moves = |i: &usize| !follows[*i] && (driven[*i] || (0..6).any(|dof| plan.is_unknown(*i, dof)));
    (0..n).filter(moves).collect()
}

/// The prescribed degrees of freedom of nodes at the end of a joint, and of the masters of such nodes.
fn driving(model: &Model, system: &System) -> Vec<usize> {
    let mut at_joints = vec![false; model.nodes.len()];
    system.joints.iter().flat_map(Joint::ends).for_each(|node| at_joints[node] = true);
    system.joints.iter().filter_map(|joint| joint.drive).for_each(|drive| at_joints[drive.node] = true);
    // The order is reversed, for dependent nodes come after their masters.
    for dependent in system.rigid_links.iter().rev() {
        at_joints[dependent.master] |= at_joints[dependent.node];
    }
    let is_turned = |i: usize| model.constraints.turns.iter().any(|turn| turn.restraints.contains(&i));
    let moves = |(i, restraint): &(usize, &Restraint)| {
        at_joints[restraint.node] && (restraint.motion.is_some() || is_turned(*i))
    };
    model.constraints.restraints.iter().enumerate().filter(moves).map(|(i, _)| i).collect()
}

/// The largest distance of a node from the first, or 1 for a single point.
fn extent(model: &Model) -> f64 {
    let first = model.nodes.first().map_or(Vec3::zeros(), |node| node.x);
    let extent = model.nodes.iter().map(|node| (node.x - first).norm()).fold(0.0, f64::max);
    if extent > 0.0 { extent } else { 1.0 }
}
