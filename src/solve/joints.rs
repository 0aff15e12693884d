//! Joints at the end of a step and at the start of a run. Where a scheme writes equilibrium past the end of the step, the end
//! itself lies off the joints by its error; there position, velocity and acceleration are put back, one after the other, by the
//! least change in the norm of the masses (E. Eich, SIAM J. Numer. Anal. 30 (1993)), as if the joints had pushed a little more or
//! less within the step: they do not drift, and the accelerations of one step bring no oscillation into the next. How the
//! iteration came there does not matter.

use super::failure::{self, Failure};
use super::step::Stepper;
use crate::elements::Moduli;
use crate::integrators::Coefficients;
use crate::linear::{Solver, TooLarge};
use crate::math::rotation::inverse_tangent;
use crate::math::{Vec3, bottom};
use crate::model::{Held, Model};
use crate::plan::Plan;
use crate::state::{Configuration, Node, State};
use crate::system::assembly::{Assembly, Weights};
use crate::system::{Forces, Loading, System};

/// Corrections of a position before the step is given up.
pub(super) const MOST: usize = 12;

/// Gaps, relative to positions, that rounding may leave.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Wider ones are no joints: what iteration and closing leave is far below.
const APART: f64 = 1e-9;

/// Of the largest mass: what a direction without mass is given, so that it is the one that gives way.
const TRACE: f64 = 1e-9;

/// The masses and joints of a scene by themselves, with their own factorisation. Allocated once.
pub struct Closing {
    bare: System,
    solver: Solver,
    assembly: Assembly,
    loading: Loading,
    /// Gaps and right-hand side, then correction, per unknown.
    forces: Forces,
    r: Vec<f64>,
    /// On the diagonal: places and whether they are those of rotations.
    diagonal: Vec<(usize, bool)>,
    /// Those of directions that nothing gives a mass.
    massless: Vec<(usize, bool)>,
}

impl Closing {
    /// # Errors
    /// As for [`Plan::build`].
    pub fn new(plan: &Plan, system: &System, nodes: usize) -> Result<Self, TooLarge> {
        let bare = system.bare();
        let (solver, assembly) = plan.build_bare(&bare)?;
        let heavy = bare.massive(nodes);
        let slots = |massless: bool| {
            let directions = plan.directions.iter().enumerate();
            let kept = directions.filter(|(_, (node, dof))| !massless || !heavy[*node][usize::from(*dof > 2)]);
            kept.filter_map(|(row, &(_, dof))| solver.slot(row, row).map(|slot| (slot, dof > 2))).collect()
        };
        Ok(Closing {
            diagonal: slots(false),
            massless: slots(true),
            forces: Forces::new(&bare, nodes),
            loading: Loading::default(),
            r: vec![0.0; plan.unknowns],
            bare,
            solver,
            assembly,
        })
    }

    /// Factorises masses and joints as they lie; false where the joints leave no way to close them.
    fn factor(&mut self, nodes: &[Node]) -> bool {
        let weights = Weights { stiffness: false, rate: 0.0, acceleration: 1.0, moduli: Moduli::Elastic };
        let Closing { bare, solver, assembly, forces, loading, .. } = self;
        assembly.tangent(bare, &Configuration::of(nodes), loading, forces, weights, solver);
        let values = self.solver.values();
        let mut largest = [0.0f64; 2];
        for &(slot, turns) in &self.diagonal {
            let largest = &mut largest[usize::from(turns)];
            *largest = largest.max(values[slot].abs());
        }
        for &(slot, turns) in &self.massless {
            let mass = largest[usize::from(turns)];
            values[slot] += TRACE * if mass > 0.0 { mass } else { 1.0 };
        }
        self.solver.factor().is_ok()
    }

    /// The least motion, velocity or acceleration that closes the gaps at hand, into `r`.
    fn solve(&mut self, directions: usize) {
        self.r[..directions].fill(0.0);
        self.forces.multipliers.ask(&mut self.r[directions..]);
        self.solver.solve(&mut self.r);
    }
}

impl Stepper<'_> {
    /// Puts the trial motion, at the end of a step from `state`, onto the joints; the increments lead there.
    ///
    /// # Errors
    /// [`Failure::Apart`] where the joints cannot be closed from there.
    pub(super) fn close_joints(&mut self, state: &State, scheme: &Coefficients, dt: f64) -> Result<(), Failure> {
        let Some(mut closing) = self.closing.take() else { return Ok(()) };
        let closed = closing.factor(&self.trial) && self.close_with(&mut closing, state, scheme, dt);
        self.system.gaps(&self.trial, 0, &mut self.forces.multipliers.gaps);
        self.closing = Some(closing);
        if closed { Ok(()) } else { Err(self.apart()) }
    }

    /// Of the trial motion at the end of a step, and what it leaves of the gaps.
    ///
    /// # Errors
    /// [`Failure::Apart`] where joints have not closed, however well forces balance: they contradict each other.
    pub(super) fn check_joints(&mut self) -> Result<(), Failure> {
        if self.system.joints.is_empty() {
            return Ok(());
        }
        let gaps = &mut self.forces.multipliers.gaps;
        self.system.gaps(&self.trial, 0, gaps);
        let gap = self.system.largest_gap(gaps, self.reach);
        if gap > APART || gap.is_nan() {
            return Err(self.apart());
        }
        self.violation = self.violation.max(gap);
        Ok(())
    }

    pub(super) fn apart(&mut self) -> Failure {
        self.refresh.rejected();
        Failure::Apart { largest: failure::gaps(self.model, self.system, &self.forces.multipliers.gaps) }
    }

    /// Rows that say the same may carry anything against each other: they are left with the least that does what they do
    /// together.
    pub(super) fn share_out(&mut self, state: &mut State) {
        if !self.plan.shares() {
            return;
        }
        let Some(mut closing) = self.closing.take() else { return };
        let Closing { bare, forces, r, solver, .. } = &mut closing;
        forces.multipliers.values.copy_from_slice(&state.multipliers);
        bare.joint_forces(&self.trial, forces);
        for (r, &(node, dof)) in r.iter_mut().zip(&self.plan.directions) {
            *r = -forces.on_nodes[node][dof];
        }
        // M δ + Gᵀμ = Gᵀλ, G δ = 0
        let tail = &mut r[self.plan.directions.len()..];
        tail.fill(0.0);
        solver.solve(r);
        forces.multipliers.values.fill(0.0);
        forces.multipliers.add(&r[self.plan.directions.len()..]);
        state.multipliers.copy_from_slice(&forces.multipliers.values);
        self.closing = Some(closing);
    }

    fn close_with(&mut self, closing: &mut Closing, state: &State, scheme: &Coefficients, dt: f64) -> bool {
        let mut last = f64::INFINITY;
        for _ in 0..MOST {
            let gap = self.gap(closing, 0);
            // At rounding, or no longer falling next to it.
            if gap <= ROUNDING || (gap >= 0.5 * last && gap <= 1e3 * ROUNDING) {
                // Rates are linear in themselves: one correction is exact but for what the positions have changed since.
                for derivative in [1, 2] {
                    let mut last = f64::INFINITY;
                    loop {
                        let gap = self.gap(closing, derivative);
                        if gap * dt.powi(derivative as i32) <= ROUNDING || gap >= 0.1 * last || gap.is_nan() {
                            break;
                        }
                        last = gap;
                        self.close_gap(closing, state, scheme, derivative);
                    }
                }
                return true;
            }
            if gap.is_nan() {
                return false;
            }
            last = gap;
            self.close_gap(closing, state, scheme, 0);
        }
        false
    }

    /// The largest gap of the trial motion, or of its derivative, relative.
    fn gap(&self, closing: &mut Closing, derivative: usize) -> f64 {
        let gaps = &mut closing.forces.multipliers.gaps;
        self.system.gaps(&self.trial, derivative, gaps);
        self.system.largest_gap(gaps, self.reach)
    }

    /// One correction of the motion, its velocity or its acceleration.
    fn close_gap(&mut self, closing: &mut Closing, state: &State, scheme: &Coefficients, derivative: usize) {
        closing.solve(self.plan.directions.len());
        for &node in &self.movers {
            let rows = self.plan.dofs.of(node);
            let theta = bottom(&self.increments[node].q);
            let entry = |i: usize| rows.get(i).map_or(0.0, |row| closing.r[row]);
            let turn = inverse_tangent(&theta, &Vec3::new(entry(3), entry(4), entry(5)));
            let increment = &mut self.increments[node];
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
            self.trial[node].advance(&state.nodes[node], &self.increments[node], scheme.rotation);
        }
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &state.nodes[rider.node]);
        }
    }

    /// At the start, with a factorised mass matrix: velocities that the joints allow, the nearest in kinetic energy.
    pub(super) fn start_on_joints(&mut self, nodes: &mut [Node]) {
        // Translations and rotations together: where one of them is nil, rounding of the other is no jump.
        let speed = |v: &Vec3, omega: &Vec3, length: f64| v.amax().max(omega.amax() * length);
        let (mut jump, mut fastest) = (0.0f64, 0.0f64);
        // Rows that share what they carry leave a part of it to the next time: three leave nothing.
        for _ in 0..3 {
            self.system.gaps(nodes, 1, &mut self.forces.multipliers.gaps);
            if self.forces.multipliers.gaps.iter().all(|&gap| gap == 0.0) {
                break;
            }
            let directions = self.plan.directions.len();
            self.r[..directions].fill(0.0);
            self.forces.multipliers.ask(&mut self.r[directions..]);
            self.solver.solve(&mut self.r);
            self.solves += 1;
            for (node, rows) in nodes.iter_mut().zip(self.plan.dofs.each_node()) {
                let entry = |i: usize| rows.get(i).map_or(0.0, |row| self.r[row]);
                let (dv, domega) = (Vec3::new(entry(0), entry(1), entry(2)), Vec3::new(entry(3), entry(4), entry(5)));
                fastest = fastest.max(speed(&node.v, &node.omega, self.length));
                node.v += dv;
                node.omega += domega;
                jump = jump.max(speed(&dv, &domega, self.length));
                fastest = fastest.max(speed(&node.v, &node.omega, self.length));
            }
            self.ride(nodes);
        }
        self.start_jump = if jump > 0.0 { jump / fastest } else { 0.0 };
    }
}

/// Held directions whose given motion joints hand on: those of nodes that a joint's end is, or rides on.
pub fn leading(model: &Model, system: &System) -> Vec<usize> {
    let mut leads = vec![false; model.nodes.len()];
    system.joints.iter().flat_map(|joint| joint.nodes).for_each(|node| leads[node] = true);
    // Riders come after their masters.
    for rider in system.attachments.iter().rev() {
        leads[rider.master] |= leads[rider.node];
    }
    let moves = |(_, held): &(usize, &Held)| held.motion.is_some() && leads[held.node];
    model.held.iter().enumerate().filter(moves).map(|(i, _)| i).collect()
}
