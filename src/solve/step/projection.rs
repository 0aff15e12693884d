//! Projection onto the constraints at the end of a step and at the start of a run. Where a scheme writes equilibrium past the end of the
//! step, the joints are not closed at the end itself. Position, velocity and acceleration there are projected onto the constraints, one
//! after the other, by the least change in the norm of the masses (E. Eich, SIAM J. Numer. Anal. 30 (1993)), as if the joints had exerted
//! slightly different forces within the step. Joints therefore do not drift, and accelerations of one step cause no oscillation in the
//! next. The result does not depend on the path of the iteration.

use crate::context::Context;
use crate::failure::Failure;
use crate::guards::joints;
use crate::linear_system::LinearSystem;
use crate::plan::Plan;
use crate::step::trial::TrialMotion;
use crate::system::TangentWeights;
use crate::system::{Forces, Loading, System};
use crate::tolerances::joints::{MOST_CORRECTIONS, ROUNDING};
use crate::tolerances::projection::TRACE;
use base::math::rotation::inverse_tangent;
use base::math::{Vec3, angular};
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::elements::Moduli;
use mechanics::integrators::{Coefficients, Stepping};
use mechanics::state::{Configuration, Node, State};

/// The masses and joints of a scene alone, with their own factorization. It is allocated once.
pub struct ConstraintProjection {
    /// The system without stiffness, loads and damping.
    bare: System,
    matrix: LinearSystem,
    loading: Loading,
    forces: Forces,
    /// Right-hand side, then correction, by unknown.
    r: Vec<f64>,
    diagonal: Vec<DiagonalSlot>,
    /// The slots of degrees of freedom without mass.
    massless: Vec<DiagonalSlot>,
    change: ForceChange,
    /// Forces of inertia by nodal unknown, at the velocities before their projection; empty unless stages inside steps are projected too.
    inertia: Vec<f64>,
    /// Room for multipliers that are shared out.
    shares: Vec<f64>,
}

keep!(ConstraintProjection { matrix, loading, forces, r, change } without { bare, diagonal, massless, inertia, shares });

/// The change of the joint forces due to the last projection of accelerations. With `M a + Gᵀλ = f` before and `M δa + Gᵀδλ = 0`, forces
/// and accelerations at the end of a step have the order of the scheme. If equilibrium is written past the end of the step, linear
/// interpolation of the forces to the end already has that order.
#[derive(Default)]
struct ForceChange {
    /// δλ, per constraint equation.
    multipliers: Vec<f64>,
    /// Change of the reactions −M δa − Gᵀδλ, in the order of the model's restraints; empty where forces are not wanted.
    reactions: Vec<f64>,
}

keep!(ForceChange { multipliers, reactions });

impl ForceChange {
    /// Clears the change: it belongs only to the step that recorded it.
    fn forget(&mut self) {
        self.multipliers.fill(0.0);
        self.reactions.clear();
    }
}

/// A motion at the end of a step that is being projected.
struct End<'e> {
    motion: &'e mut TrialMotion,
    /// The largest coordinate of a node.
    reach: f64,
    state: &'e State,
    scheme: &'e Coefficients,
    dt: f64,
}

/// A slot on the diagonal of the matrix.
struct DiagonalSlot {
    slot: usize,
    is_rotation: bool,
}

impl ConstraintProjection {
    /// Factors and buffers for the projection.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn new(plan: &Plan, system: &System, nodes: usize) -> Result<Self, TooLarge> {
        let bare = system.bare();
        let (solver, assembly) = plan.build_bare(&bare)?;
        let has_mass = bare.has_mass(nodes);
        let slots = |massless: bool| {
            let directions = plan.dofs.nodal_dofs().iter().enumerate();
            let kept = directions.filter(|(_, (node, dof))| !massless || !has_mass[*node][usize::from(*dof > 2)]);
            let slot = |row: usize| solver.slot(row, row);
            kept.filter_map(|(row, &(_, dof))| slot(row).map(|slot| DiagonalSlot { slot, is_rotation: dof > 2 }))
                .collect()
        };
        Ok(ConstraintProjection {
            diagonal: slots(false),
            massless: slots(true),
            forces: Forces::new(&bare, nodes),
            loading: Loading::default(),
            r: vec![0.0; plan.dofs.unknowns()],
            change: ForceChange { multipliers: vec![0.0; bare.multipliers()], reactions: Vec::new() },
            inertia: Vec::new(),
            shares: vec![0.0; bare.multipliers()],
            bare,
            matrix: LinearSystem::new(solver, assembly),
        })
    }

    /// The projection for a dynamic analysis with joints, and for a static one where joints share forces; `None` for others.
    ///
    /// # Errors
    /// There is no memory for the solver.
    pub fn for_analysis(cx: &Context) -> Result<Option<Self>, TooLarge> {
        let needed = !cx.system.joints.is_empty() && (cx.is_dynamic() || cx.plan.has_redundant_constraints());
        let projection =
            needed.then(|| ConstraintProjection::new(cx.plan, cx.system, cx.model.nodes.len())).transpose()?;
        let stages = matches!(cx.model.solution.scheme.stepping(), Stepping::DiagonallyImplicit(_));
        let inertia = vec![0.0; if cx.is_dynamic() && stages { cx.nodal_unknowns() } else { 0 }];
        Ok(projection.map(|projection| ConstraintProjection { inertia, ..projection }))
    }

    /// Projects the motion at the end of a step of length `dt` from `state` onto the constraints and writes its increments; `reach` is the
    /// largest coordinate of a node.
    ///
    /// # Errors
    /// [`Failure::ConstraintsViolated`] where the joints cannot be closed from there.
    pub fn project(
        &mut self,
        cx: &Context,
        (motion, reach): (&mut TrialMotion, f64),
        state: &State,
        (scheme, dt): (&Coefficients, f64),
    ) -> Result<(), Failure> {
        let mut end = End { motion, reach, state, scheme, dt };
        if self.factor(&end.motion.nodes) && self.close(cx, &mut end) {
            return Ok(());
        }
        Err(self.violated(cx, &end.motion.nodes))
    }

    /// Projects the velocities of a stage inside a step of length `dt` from `state`.
    ///
    /// # Errors
    /// [`Failure::ConstraintsViolated`] if the matrix of masses and joints is singular.
    pub fn project_velocities(
        &mut self,
        cx: &Context,
        (motion, reach): (&mut TrialMotion, f64),
        state: &State,
        (scheme, dt): (&Coefficients, f64),
    ) -> Result<(), Failure> {
        let mut end = End { motion, reach, state, scheme, dt };
        if self.factor(&end.motion.nodes) {
            self.close_velocity(cx, &mut end);
            return Ok(());
        }
        Err(self.violated(cx, &end.motion.nodes))
    }

    /// The failure with the gaps of these nodes.
    fn violated(&mut self, cx: &Context, nodes: &[Node]) -> Failure {
        let gaps = &mut self.forces.multipliers.gaps;
        cx.system.gaps(nodes, 0, gaps);
        joints::constraints_violated(cx, gaps)
    }

    /// Factorizes masses and joints at the given configuration; false where the matrix is singular and the joints
    /// cannot be closed.
    fn factor(&mut self, nodes: &[Node]) -> bool {
        let weights =
            TangentWeights { stiffness: false, rate: 0.0, acceleration: 1.0, turning: None, moduli: Moduli::Elastic };
        let ConstraintProjection { bare, matrix: LinearSystem { solver, assembly, .. }, forces, loading, .. } = self;
        assembly.tangent(bare, &Configuration::of(nodes), loading, forces, weights, solver);
        let values = solver.values();
        let mut largest = [0.0f64; 2];
        for &DiagonalSlot { slot, is_rotation } in &self.diagonal {
            let largest = &mut largest[usize::from(is_rotation)];
            *largest = largest.max(values[slot].abs());
        }
        for &DiagonalSlot { slot, is_rotation } in &self.massless {
            let mass = largest[usize::from(is_rotation)];
            values[slot] += TRACE * if mass > 0.0 { mass } else { 1.0 };
        }
        solver.factor().is_ok()
    }

    /// Corrects positions until the gaps are at rounding, then their rates; false where the gaps do not close.
    fn close(&mut self, cx: &Context, end: &mut End) -> bool {
        let mut last = f64::INFINITY;
        for _ in 0..MOST_CORRECTIONS {
            let gap = self.gap(cx, end, 0);
            // The gap is at rounding, or near it and no longer decreasing.
            if gap <= ROUNDING || (gap >= 0.5 * last && gap <= 1e3 * ROUNDING) {
                self.close_rates(cx, end);
                return true;
            }
            if gap.is_nan() {
                return false;
            }
            last = gap;
            self.correct(cx, end, 0);
        }
        false
    }

    /// Projects velocities, then accelerations, and records the change of the joint forces due to the latter.
    fn close_rates(&mut self, cx: &Context, end: &mut End) {
        // Trial steps may have another scheme.
        self.change.forget();
        let belongs = end.scheme.instant == 1.0;
        let wants_reactions = belongs && cx.wants_forces && !cx.model.constraints.restraints.is_empty();
        self.forces.multipliers.values.fill(0.0);
        if wants_reactions && !self.inertia.is_empty() {
            self.on_restraints(cx, &end.motion.nodes);
        }
        self.close_velocity(cx, end);
        if wants_reactions && self.inertia.is_empty() {
            self.on_restraints(cx, &end.motion.nodes);
        }
        if belongs && !self.inertia.is_empty() {
            self.answer_inertia(cx, end, 2);
        }
        self.close_rate(cx, end, 2);
        if !belongs {
            return;
        }
        self.change.multipliers.copy_from_slice(&self.forces.multipliers.values);
        if wants_reactions {
            self.on_restraints(cx, &end.motion.nodes);
        }
    }

    /// Projects velocities. The gyroscopic forces of bodies change with them, so a scheme with projected stages corrects the accelerations too,
    /// and the part that these have in the velocities of a stage.
    fn close_velocity(&mut self, cx: &Context, end: &mut End) {
        if self.inertia.is_empty() || end.scheme.instant != 1.0 {
            return self.close_rate(cx, end, 1);
        }
        self.forces.multipliers.values.fill(0.0);
        self.bare.residual(&Configuration::of(&end.motion.nodes), &self.loading, &mut self.forces);
        for (inertia, &(node, dof)) in self.inertia.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
            *inertia = self.forces.on_nodes[node][dof];
        }
        self.close_rate(cx, end, 1);
        self.answer_inertia(cx, end, 1);
    }

    /// Corrects velocities (1) or accelerations (2) by the change of the forces of inertia due to the projection of velocities. Joints stay
    /// closed.
    fn answer_inertia(&mut self, cx: &Context, end: &mut End, derivative: usize) {
        self.bare.residual(&Configuration::of(&end.motion.nodes), &self.loading, &mut self.forces);
        let before = self.inertia.iter().zip(cx.plan.dofs.nodal_dofs());
        for (r, (before, &(node, dof))) in self.r.iter_mut().zip(before) {
            *r = self.forces.on_nodes[node][dof] - before;
        }
        self.r[cx.nodal_unknowns()..].fill(0.0);
        self.matrix.solver.solve(&mut self.r);
        if derivative == 1 {
            // The velocity of a stage contains its acceleration times γΔt.
            let ahead = 1.0 / end.scheme.rate[0];
            self.r.iter_mut().for_each(|r| *r *= ahead);
        }
        self.add(cx, end, derivative);
    }

    /// Corrects velocities (1) or accelerations (2). The constraints are linear in them, so one correction is exact at given
    /// positions.
    fn close_rate(&mut self, cx: &Context, end: &mut End, derivative: usize) {
        let mut last = f64::INFINITY;
        loop {
            let gap = self.gap(cx, end, derivative);
            if gap * end.dt.powi(derivative as i32) <= ROUNDING || gap >= 0.1 * last || gap.is_nan() {
                break;
            }
            last = gap;
            self.correct(cx, end, derivative);
        }
    }

    /// Reactions to inertia and joints alone. The second call subtracts the reactions of the first.
    fn on_restraints(&mut self, cx: &Context, nodes: &[Node]) {
        self.bare.residual(&Configuration::of(nodes), &self.loading, &mut self.forces);
        let restraints = &cx.model.constraints.restraints;
        let reactions = restraints.iter().map(|held| -self.forces.on_nodes[held.node][held.dof]);
        let change = &mut self.change.reactions;
        if change.is_empty() {
            change.extend(reactions);
        } else {
            change.iter_mut().zip(reactions).for_each(|(change, after)| *change = after - *change);
        }
    }

    /// Adds the change of the joint forces due to the last projection of accelerations to the multipliers.
    pub fn carry_multipliers(&self, multipliers: &mut [f64]) {
        multipliers.iter_mut().zip(&self.change.multipliers).for_each(|(value, change)| *value += change);
    }

    /// The change of the reactions due to the last projection of accelerations, in the order of the model's restraints.
    pub fn reaction_changes(&self) -> &[f64] {
        &self.change.reactions
    }

    /// The largest gap of the motion, or of its first or second derivative, relative to the reach.
    fn gap(&mut self, cx: &Context, end: &End, derivative: usize) -> f64 {
        let gaps = &mut self.forces.multipliers.gaps;
        cx.system.gaps(&end.motion.nodes, derivative, gaps);
        cx.system.largest_gap(gaps, end.reach)
    }

    /// Corrects the motion, its velocity or its acceleration once, by the least change that closes the current gaps.
    fn correct(&mut self, cx: &Context, end: &mut End, derivative: usize) {
        self.r[..cx.nodal_unknowns()].fill(0.0);
        self.matrix.solve_augmented(&self.forces.multipliers, &mut self.r);
        self.add(cx, end, derivative);
    }

    /// Adds the current solution to the motion, its velocity or its acceleration. Multipliers follow accelerations.
    fn add(&mut self, cx: &Context, end: &mut End, derivative: usize) {
        let End { motion, state, scheme, .. } = end;
        if derivative == 2 {
            self.forces.multipliers.add(&self.r[cx.nodal_unknowns()..]);
        }
        for &node in &cx.independent_nodes {
            let rows = cx.plan.dofs.of(node);
            let increment = &mut motion.increments[node];
            let theta = angular(&increment.q);
            let entry = |i: usize| rows.get(i).map_or(0.0, |row| self.r[row]);
            let turn = inverse_tangent(&theta, &Vec3::new(entry(3), entry(4), entry(5)));
            let change = match derivative {
                0 => &mut increment.q,
                1 => &mut increment.d,
                _ => &mut increment.dd,
            };
            for i in 0..3 {
                change[i] += entry(i);
                if rows.has(3 + i) {
                    change[3 + i] += turn[i];
                }
            }
            motion.nodes[node].advance(&state.nodes[node], increment, scheme.rotation);
        }
        motion.update_dependent_nodes(cx, &state.nodes);
    }

    /// Replaces the multipliers of redundant constraint equations, which equilibrium does not determine, by the least ones with the same
    /// forces. In a load step the regularization is not enough: second-order gaps, divided by ε, remain as self-equilibrated forces of
    /// redundant joints and grow.
    pub fn distribute_multipliers(&mut self, cx: &Context, nodes: &[Node], state: &mut State) {
        if !cx.plan.has_redundant_constraints() {
            return;
        }
        // A step in time has factorized for its projection.
        if !cx.is_dynamic() && !self.factor(nodes) {
            return;
        }
        let ConstraintProjection { bare, forces, r, matrix, .. } = self;
        let mut left = std::mem::take(&mut state.multipliers);
        state.multipliers = std::mem::take(&mut self.shares);
        state.multipliers.fill(0.0);
        // M δ + Gᵀμ = Gᵀλ, G δ = 0. One solution misses the fraction ε of the forces; a second one distributes it.
        for _ in 0..2 {
            forces.multipliers.values.copy_from_slice(&left);
            bare.joint_forces(nodes, forces);
            for (r, &(node, dof)) in r.iter_mut().zip(cx.plan.dofs.nodal_dofs()) {
                *r = -forces.on_nodes[node][dof];
            }
            r[cx.nodal_unknowns()..].fill(0.0);
            matrix.solver.solve(r);
            forces.multipliers.values.fill(0.0);
            forces.multipliers.add(&r[cx.nodal_unknowns()..]);
            let found = &forces.multipliers.values;
            for ((share, left), found) in state.multipliers.iter_mut().zip(&mut left).zip(found) {
                *share += found;
                *left -= found;
            }
        }
        self.shares = left;
    }
}
