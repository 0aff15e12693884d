//! Accelerations from the residual with the mass alone, for all explicit schemes. If every independent node is a separate rigid body, only
//! the small system of the joints is factorized. A coupled mass matrix is formed and factorized at every evaluation.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::joints::constraints_violated;
use crate::step::projection::ConstraintProjection;
use crate::system::TangentWeights;
use crate::system::constraint_schur::ConstraintSchur;
use crate::system::masses::{Masses, NodeRates};
use crate::workspace::Workspace;
use base::math::rotation::vector_rates;
use base::math::{Vec6, angular, linear, stack};
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::elements::Moduli;
use mechanics::integrators::Coefficients;
use mechanics::state::{Configuration, Increment, State};

/// The masses of a scene and the accelerations that forces cause. It is allocated once.
pub struct Accelerations {
    /// The block-diagonal masses, if every independent node is a separate rigid body.
    pub masses: Option<Masses>,
    /// The constraint equations of joints between such bodies.
    pub schur: Option<ConstraintSchur>,
    /// The difference between the computed accelerations and the accelerations of the trial motion, by node.
    pub missing: Vec<Vec6>,
    /// Small motions by node that a coupled mass matrix is applied to.
    pub operand: Vec<Vec6>,
    /// Projection onto the constraints with a coupled mass matrix.
    projection: Option<ConstraintProjection>,
}

keep!(Accelerations { schur, missing, operand, projection } without { masses });

impl Accelerations {
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context) -> Result<Accelerations, TooLarge> {
        let nodes = cx.model.nodes.len();
        let (masses, schur) = match cx.plan.masses(cx.system) {
            Some(masses) if cx.system.joints.is_empty() => (Some(masses), None),
            Some(masses) => match ConstraintSchur::new(cx.system, &masses, cx.plan.has_redundant_constraints()) {
                Some(schur) => (Some(masses), Some(schur)),
                None => (None, None),
            },
            None => (None, None),
        };
        let coupled = masses.is_none();
        Ok(Accelerations {
            masses,
            schur,
            missing: vec![Vec6::zeros(); nodes],
            operand: vec![Vec6::zeros(); if coupled { nodes } else { 0 }],
            projection: if coupled { ConstraintProjection::for_analysis(cx)? } else { None },
        })
    }

    /// True where the mass matrix couples several nodes.
    pub fn are_coupled(&self) -> bool {
        self.masses.is_none()
    }

    /// The masses of separate rigid bodies without joints, and the differences of their accelerations; `None` in other models.
    pub fn free(&mut self) -> Option<(&Masses, &mut [Vec6])> {
        match self {
            Accelerations { masses: Some(masses), schur: None, missing, .. } => Some((masses, missing)),
            _ => None,
        }
    }

    /// The projection onto the constraints with a coupled mass matrix.
    pub fn projection(&mut self) -> Option<&mut ConstraintProjection> {
        self.projection.as_mut()
    }

    /// Projects the trial motion onto the constraints with the matrix of masses and joints, where the masses are
    /// coupled.
    ///
    /// # Errors
    /// [`Failure::ConstraintsViolated`] where they cannot be closed from there.
    pub fn project(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        scheme: &Coefficients,
        dt: f64,
    ) -> Result<(), Failure> {
        self.projection
            .as_mut()
            .map_or(Ok(()), |projection| projection.project(cx, (&mut ws.trial, ws.reach), state, (scheme, dt)))
    }

    /// Solves for the accelerations under the current forces of the trial motion, and writes their difference to the accelerations that it
    /// already has. With `joints`, accelerations satisfy the constraints and the multipliers are written; without, only the part that opens
    /// no joint is found.
    ///
    /// # Errors
    /// [`Failure::Singular`] or [`Failure::ConstraintsViolated`] if the system of masses or joints is singular.
    pub fn solve(&mut self, cx: &Context, ws: &mut Workspace, state: &State, joints: bool) -> Result<(), Failure> {
        ws.solves += 1;
        let Accelerations { masses: Some(masses), schur, missing, .. } = self else {
            return self.solve_coupled(cx, ws, state, joints);
        };
        masses.accelerate(&ws.trial.nodes, &ws.forces.on_nodes, missing);
        if let Some(schur) = schur {
            if joints {
                cx.system.gaps(&ws.trial.nodes, 2, &mut schur.x);
            } else {
                schur.x.fill(0.0);
            }
            if !schur.form(cx.system, masses, &ws.trial.nodes) {
                return Err(constraints_violated(cx, &ws.forces.multipliers.gaps));
            }
            schur.add_rates(missing);
            schur.solve();
            schur.subtract_response(missing);
            if joints {
                ws.forces.multipliers.values.copy_from_slice(&schur.x);
            }
        }
        Ok(())
    }

    /// Solves with the coupled matrix of masses and joints.
    fn solve_coupled(&mut self, cx: &Context, ws: &mut Workspace, state: &State, joints: bool) -> Result<(), Failure> {
        factor_mass(cx, ws, state)?;
        ws.residual.write(cx, &ws.forces, 1.0);
        for &node in &cx.independent_nodes {
            self.missing[node] = Vec6::zeros();
        }
        // Redundant equations leave a fraction of the gaps: a second solution is enough.
        for _ in 0..if cx.system.joints.is_empty() { 1 } else { 2 } {
            self.add_solution(cx, ws, joints);
        }
        // Degrees of freedom of a partly dependent node move with its master.
        self.visit_dependent_dofs(cx, ws, |missing, now| *missing = now);
        // The trial motion is restored.
        for &node in &cx.independent_nodes {
            ws.trial.nodes[node].a -= linear(&self.missing[node]);
            ws.trial.nodes[node].alpha -= angular(&self.missing[node]);
        }
        update_dependent_accelerations(cx, ws);
        self.visit_dependent_dofs(cx, ws, |missing, given| *missing -= given);
        Ok(())
    }

    /// Solves with the residual and the gaps of the joints, and adds the solution to the trial motion and to the
    /// difference.
    fn add_solution(&mut self, cx: &Context, ws: &mut Workspace, joints: bool) {
        let multipliers = &mut ws.forces.multipliers;
        if joints {
            cx.system.gaps(&ws.trial.nodes, 2, &mut multipliers.gaps);
        } else {
            multipliers.gaps.fill(0.0);
        }
        ws.matrix.solve(multipliers, &ws.residual, &mut ws.correction);
        if joints {
            multipliers.add(ws.correction.of_multipliers(cx));
        }
        for &node in &cx.independent_nodes {
            let found = ws.correction.of(cx.plan.dofs.of(node));
            self.missing[node] += found;
            ws.trial.nodes[node].a += linear(&found);
            ws.trial.nodes[node].alpha += angular(&found);
        }
        ws.residual.of_nodes_mut(cx).fill(0.0);
        update_dependent_accelerations(cx, ws);
    }

    /// Visits the dependent degrees of freedom of partly dependent nodes: the difference there, and the acceleration of
    /// the trial motion.
    fn visit_dependent_dofs(&mut self, cx: &Context, ws: &Workspace, visit: impl Fn(&mut f64, f64)) {
        for dependent in &cx.system.rigid_links {
            let (missing, node) = (&mut self.missing[dependent.node], &ws.trial.nodes[dependent.node]);
            let now = stack(&node.a, &node.alpha);
            (0..6).filter(|&i| dependent.dofs[i]).for_each(|i| visit(&mut missing[i], now[i]));
        }
    }

    /// Writes the residual on prescribed degrees of freedom at the accelerations found, whose negative is the reaction.
    pub fn update_reactions(&self, cx: &Context, ws: &mut Workspace, state: &State, ahead: f64) {
        if let (Some(masses), None) = (&self.masses, &self.schur) {
            for block in &masses.blocks {
                let (node, F) = (&ws.trial.nodes[block.node], &mut ws.forces.on_nodes[block.node]);
                block.subtract_inertia(node, &self.missing[block.node], F);
            }
            return;
        }
        for &node in &cx.independent_nodes {
            ws.trial.nodes[node].a += linear(&self.missing[node]);
            ws.trial.nodes[node].alpha += angular(&self.missing[node]);
        }
        update_dependent_accelerations(cx, ws);
        let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: ahead, previous: None };
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
    }

    /// True where the accelerations and positions found are numbers.
    pub fn are_finite(&self, cx: &Context, ws: &Workspace) -> bool {
        let sum = |&node: &usize| self.missing[node].sum() + ws.trial.nodes[node].x.sum();
        cx.independent_nodes.iter().map(sum).sum::<f64>().is_finite()
    }
}

/// Forms and factorizes the matrix of masses and joints in the trial motion.
fn factor_mass(cx: &Context, ws: &mut Workspace, state: &State) -> Result<(), Failure> {
    let weights =
        TangentWeights { stiffness: false, rate: 0.0, acceleration: 1.0, turning: None, moduli: Moduli::Elastic };
    let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt: 0.0, previous: None };
    let (matrix, loads) = (&mut ws.matrix, &ws.loads.instant);
    matrix.assembly.tangent(cx.system, &now, loads, &mut ws.forces, weights, &mut matrix.solver);
    ws.factorizations += 1;
    let factored = matrix.solver.factor();
    factored.map_err(|singular| Failure::singular(cx.model, cx.plan, cx.system, singular.row, (None, true)))
}

/// Writes the accelerations of dependent nodes from those of their masters.
fn update_dependent_accelerations(cx: &Context, ws: &mut Workspace) {
    for dependent in &cx.system.rigid_links {
        let master = ws.trial.nodes[dependent.master];
        let S = dependent.arm(&master);
        let a = master.a + master.alpha.cross(&S) + master.omega.cross(&master.omega.cross(&S));
        let node = &mut ws.trial.nodes[dependent.node];
        for i in 0..3 {
            if dependent.dofs[i] {
                node.a[i] = a[i];
            }
            if dependent.dofs[3 + i] {
                node.alpha[i] = master.alpha[i];
            }
        }
    }
}

/// Writes the rates of the increment at the end of a step that give these velocities and accelerations.
pub fn set_rates(increment: &mut Increment, motion: &NodeRates) {
    let (d, dd) = vector_rates(&angular(&increment.q), &motion.omega, &motion.alpha);
    increment.d = stack(&motion.v, &d);
    increment.dd = stack(&motion.a, &dd);
}
