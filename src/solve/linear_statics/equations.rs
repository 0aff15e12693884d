//! The linear equations, factorized once, and their solution for a set of loads and prescribed motions.

use super::supports::SupportMatrix;
use crate::context::{Context, at_rest};
use crate::failure::Failure;
use crate::guards::mechanism_watch::MechanismWatch;
use crate::modes::ModesFault;
use crate::system::{Loading, Prescribed, TangentWeights};
use crate::workspace::Workspace;
use base::math::Vec6;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node, State};

/// The weights of K alone.
const STIFFNESS: TangentWeights =
    TangentWeights { stiffness: true, rate: 0.0, acceleration: 0.0, turning: None, moduli: Moduli::Elastic };

/// Solutions by which redundant constraint equations of joints are met: their regularization leaves a small part of each gap.
const CLOSINGS: usize = 3;

/// The equations of a scene at rest; the factors are in the workspace.
pub struct LinearEquations {
    /// The nodes at t = 0.
    pub nodes: Vec<Node>,
    supports: SupportMatrix,
    rhs: Vec<f64>,
    sum: Vec<f64>,
    at_supports: Vec<Vec6>,
    moved: Vec<Vec6>,
}

/// The solution for one set of loads.
#[derive(Default)]
pub struct LinearSolution {
    /// Displacements and rotations of all nodes, dependent ones included.
    pub motions: Vec<Vec6>,
    /// Reactions at the restrained degrees of freedom, in the order of the model's list.
    pub reactions: Vec<f64>,
    /// Multipliers of joints.
    pub multipliers: Vec<f64>,
    /// Work of loads, of prescribed motions too: the strain energy.
    pub work: f64,
}

impl LinearEquations {
    /// Forms and factorizes K.
    ///
    /// # Errors
    /// [`Failure::Singular`] where nothing holds the scene; [`Failure::Stopped`] after a signal; no memory.
    pub fn new(cx: &Context, ws: &mut Workspace, state: &State) -> Result<LinearEquations, Failure> {
        let nodes = at_rest(cx.model);
        let now = Configuration { nodes: &nodes, history: &state.history, dt: 0.0, previous: None };
        let nothing = no_loads(cx);
        cx.system.residual(&now, &nothing, &mut ws.forces);
        ws.forces.multipliers.values.fill(0.0);
        let supports = SupportMatrix::new(cx, &now, (&nothing, &mut ws.forces), STIFFNESS);
        let supports = supports.map_err(|error| Failure::Modes(ModesFault::from(error)))?;
        let mut mechanisms = MechanismWatch::new(cx);
        let openings = mechanisms.look(cx, state, &[], &now);
        let matrix = &mut ws.matrix;
        matrix.assembly.tangent(cx.system, &now, &nothing, &mut ws.forces, STIFFNESS, &mut matrix.solver);
        ws.factorizations += 1;
        match matrix.factor(cx) {
            Ok(true) => mechanisms.search(cx, &mut matrix.solver, &now, (STIFFNESS, None), openings)?,
            Ok(false) => return Err(Failure::Stopped),
            Err(singular) => return Err(mechanisms.singular(cx, &now, singular.row, openings)),
        }
        // No factorization follows, only solutions.
        matrix.solver.rest();
        let n = nodes.len();
        let (rhs, sum) = (vec![0.0; cx.plan.dofs.unknowns()], vec![0.0; cx.nodal_unknowns()]);
        Ok(LinearEquations {
            nodes,
            supports,
            rhs,
            sum,
            at_supports: vec![Vec6::zeros(); n],
            moved: vec![Vec6::zeros(); n],
        })
    }

    /// Solves for loads and prescribed motions, in the order of the model's restraints.
    pub fn solve(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        (loading, prescribed): (&Loading, &[Prescribed]),
        out: &mut LinearSolution,
    ) {
        let LinearEquations { nodes, supports, rhs, sum, at_supports, moved } = self;
        let (restraints, unknowns) = (&cx.model.constraints.restraints, cx.nodal_unknowns());
        moved.fill(Vec6::zeros());
        for (held, given) in restraints.iter().zip(prescribed) {
            moved[held.node][held.dof] = given.u;
        }
        cx.system.project(nodes, moved);
        supports.forces(moved, at_supports);
        cx.system.external(nodes, loading, &mut ws.forces);
        let loads: Vec<Vec6> = ws.forces.on_nodes.iter().map(|force| Vec6::from(*force)).collect();
        for (row, &(node, dof)) in cx.plan.dofs.nodal_dofs().iter().enumerate() {
            rhs[row] = loads[node][dof] - at_supports[node][dof];
        }
        ws.forces.multipliers.values.fill(0.0);
        cx.system.gaps_of_motion(nodes, moved, &mut ws.forces.multipliers.gaps);
        sum.fill(0.0);
        out.motions.clone_from(moved);
        let closings = if ws.forces.multipliers.gaps.is_empty() { 1 } else { CLOSINGS };
        for closing in 0..closings {
            let multipliers = &mut ws.forces.multipliers;
            multipliers.write_rhs(&mut rhs[unknowns..]);
            ws.matrix.solver.solve(rhs);
            if closing == 0 {
                // The penalty acts on what the solution moves, and not on the gaps before it.
                multipliers.subtract_gaps(&mut rhs[unknowns..]);
            }
            multipliers.add(&rhs[unknowns..]);
            sum.iter_mut().zip(&*rhs).for_each(|(sum, more)| *sum += more);
            rhs[..unknowns].fill(0.0);
            let each = cx.plan.dofs.each_node().iter().zip(&*moved).zip(&mut out.motions);
            each.for_each(|((rows, moved), motion)| *motion = moved + rows.gather(sum));
            cx.system.carry_all(nodes, &mut out.motions);
            cx.system.gaps_of_motion(nodes, &out.motions, &mut multipliers.gaps);
        }
        ws.solves += closings;
        ws.forces.multipliers.add_gaps();
        out.multipliers.clone_from(&ws.forces.multipliers.values);
        self.balance(cx, ws, (&loads, prescribed), out);
    }

    /// Writes the reactions of a motion, and its work.
    fn balance(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        (loads, prescribed): (&[Vec6], &[Prescribed]),
        out: &mut LinearSolution,
    ) {
        let LinearEquations { nodes, supports, at_supports, .. } = self;
        let restraints = &cx.model.constraints.restraints;
        supports.forces(&out.motions, at_supports);
        cx.system.joint_forces(nodes, &mut ws.forces);
        out.reactions.clear();
        out.reactions.extend(restraints.iter().map(|held| {
            let of = |forces: &Vec6| forces[held.dof];
            of(&at_supports[held.node]) - of(&loads[held.node]) - ws.forces.on_nodes[held.node][held.dof]
        }));
        let of_loads: f64 = loads.iter().zip(&out.motions).map(|(f, u)| f.dot(u)).sum();
        let of_supports: f64 = out.reactions.iter().zip(prescribed).map(|(force, given)| force * given.u).sum();
        out.work = 0.5 * (of_loads + of_supports);
    }
}

/// No loads.
fn no_loads(cx: &Context) -> Loading {
    let loading = &cx.model.loading;
    Loading {
        factors: vec![0.0; loading.nodal.len()],
        pressures: vec![0.0; loading.pressures.len()],
        squares: vec![0.0; loading.centrifugal.len()],
        ..Loading::default()
    }
}
