//! What explicit schemes share: accelerations from the residual with the mass alone, and joints closed at the end of a step.
//! Where every moving node is a rigid body of its own nothing is factorised but the small system of the joints; masses that
//! belong together are formed and factorised at every evaluation.

use super::failure::Failure;
use super::joints::{MOST, ROUNDING};
use super::runge_kutta::Control;
use super::stable::Stable;
use super::step::Stepper;
use crate::elements::Moduli;
use crate::integrators::Stepping;
use crate::math::rotation::{exp, inverse_tangent, rates, renormalise};
use crate::math::{Vec3, Vec6, bottom, join, top};
use crate::model::{Model, StepLength};
use crate::plan::Plan;
use crate::state::{Configuration, Node, State};
use crate::system::System;
use crate::system::assembly::Weights;
use crate::system::masses::{MassBlock, Masses};
use crate::system::ties::Ties;

/// Allocated once.
pub struct Explicit {
    pub masses: Option<Masses>,
    /// Where there are masses and joints.
    pub ties: Option<Ties>,
    /// Accelerations beyond those of the trial motion, by node.
    pub push: Vec<Vec6>,
    /// Where masses belong together: motions that are weighed, by node.
    pub room: Vec<Vec6>,
    /// Rates of (q, v) of Runge-Kutta's stages, by stage, of each node that moves.
    pub stages: Vec<[Vec6; 2]>,
    /// Loads change with time.
    pub varying: bool,
    /// Held directions are moved.
    pub driven: bool,
    pub stable: Stable,
    /// Work of loads and of dampers over a step of Runge-Kutta.
    pub work: [f64; 2],
    /// Where steps find their own length.
    pub control: Option<Control>,
}

impl Explicit {
    pub fn new(model: &Model, plan: &Plan, system: &System, movers: usize) -> Self {
        let nodes = model.nodes.len();
        let masses = plan.masses(system);
        let (masses, ties) = match masses {
            Some(masses) if system.joints.is_empty() => (Some(masses), None),
            Some(masses) => match Ties::new(system, &masses, plan.shares()) {
                Some(ties) => (Some(masses), Some(ties)),
                None => (None, None),
            },
            None => (None, None),
        };
        let alone = masses.is_some();
        let stages = match model.scheme.stepping() {
            Stepping::RungeKutta(tableau) => tableau.stages(),
            _ => 0,
        };
        let changes = |amplitude: Option<usize>| amplitude.is_some();
        let varying = model.loads.iter().any(|load| changes(load.amplitude))
            || model.pressures.iter().any(|load| changes(load.amplitude))
            || !model.base_accelerations.is_empty();
        Explicit {
            masses,
            ties,
            push: vec![Vec6::zeros(); nodes],
            room: vec![Vec6::zeros(); if alone { 0 } else { nodes }],
            stages: vec![[Vec6::zeros(); 2]; stages * movers],
            varying,
            driven: model.held.iter().any(|held| held.motion.is_some()),
            stable: Stable::new(model, plan),
            work: [0.0; 2],
            control: match model.analysis.step_length {
                StepLength::ErrorControlled { tolerance, .. } => Some(Control::new(tolerance, model)),
                StepLength::StabilityLimited { .. } => Some(Control::new(f64::INFINITY, model)),
                StepLength::Fixed { .. } | StepLength::ArcLength(_) => None,
            },
        }
    }

    /// The joints are closed with a factorisation of their own.
    pub fn closes(&self) -> bool {
        self.masses.is_none()
    }
}

impl Stepper<'_> {
    /// From the forces on the trial motion at hand, which includes some accelerations: what is missing of them, into `push`. With
    /// `joints`, the accelerations that these allow, and what they carry; without, the part that does not open them.
    ///
    /// # Errors
    /// [`Failure::Singular`] where masses or joints leave no answer.
    pub(super) fn answer(&mut self, explicit: &mut Explicit, state: &State, joints: bool) -> Result<(), Failure> {
        self.solves += 1;
        let Explicit { masses: Some(masses), ties, push, .. } = explicit else {
            return self.answer_together(explicit, state, joints);
        };
        masses.accelerate(&self.trial, &self.forces.on_nodes, push);
        if let Some(ties) = ties {
            if joints {
                self.system.gaps(&self.trial, 2, &mut ties.x);
            } else {
                ties.x.fill(0.0);
            }
            if !ties.form(self.system, masses, &self.trial) {
                return Err(self.apart());
            }
            ties.add_rates(push);
            ties.solve();
            ties.push(push);
            if joints {
                self.forces.multipliers.values.copy_from_slice(&ties.x);
            }
        }
        Ok(())
    }

    /// The same with the matrix of masses and joints.
    fn answer_together(&mut self, explicit: &mut Explicit, state: &State, joints: bool) -> Result<(), Failure> {
        let weights = Weights { stiffness: false, rate: 0.0, acceleration: 1.0, moduli: Moduli::Elastic };
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: 0.0 };
        self.assembly.tangent(self.system, &now, &self.given[2], &mut self.forces, weights, &mut self.solver);
        self.factorizations += 1;
        if let Err(singular) = self.solver.factor() {
            return Err(Failure::singular(self.model, self.plan, self.system, singular.row));
        }
        let directions = self.plan.directions.len();
        for (r, &(node, dof)) in self.r.iter_mut().zip(&self.plan.directions) {
            *r = self.forces.on_nodes[node][dof];
        }
        for &node in &self.movers {
            explicit.push[node] = Vec6::zeros();
        }
        // Rows that share what they carry leave a part of it to be found: once more is enough.
        for _ in 0..if self.system.joints.is_empty() { 1 } else { 2 } {
            let multipliers = &mut self.forces.multipliers;
            if joints {
                self.system.gaps(&self.trial, 2, &mut multipliers.gaps);
            } else {
                multipliers.gaps.fill(0.0);
            }
            multipliers.ask(&mut self.r[directions..]);
            self.solver.solve(&mut self.r);
            multipliers.shift(&mut self.r[directions..]);
            if joints {
                multipliers.add(&self.r[directions..]);
            }
            for &node in &self.movers {
                let rows = self.plan.dofs.of(node);
                let r = &self.r;
                let found = rows.gather(r);
                explicit.push[node] += found;
                self.trial[node].a += top(&found);
                self.trial[node].alpha += bottom(&found);
            }
            self.r[..directions].fill(0.0);
            self.hand_on_accelerations();
        }
        // Where a node has some directions of its own, the others go with its master.
        self.note_ridden(|push, now| *push = now, explicit);
        // As it was given.
        for &node in &self.movers {
            self.trial[node].a -= top(&explicit.push[node]);
            self.trial[node].alpha -= bottom(&explicit.push[node]);
        }
        self.hand_on_accelerations();
        self.note_ridden(|push, given| *push -= given, explicit);
        Ok(())
    }

    /// Goes through accelerations of the trial motion in directions that ride, beside what is missing of them.
    fn note_ridden(&self, note: impl Fn(&mut f64, f64), explicit: &mut Explicit) {
        for rider in &self.system.attachments {
            let (push, node) = (&mut explicit.push[rider.node], &self.trial[rider.node]);
            let now = join(&node.a, &node.alpha);
            (0..6).filter(|&i| rider.dofs[i]).for_each(|i| note(&mut push[i], now[i]));
        }
    }

    /// Accelerations of what rides, from those of the masters.
    fn hand_on_accelerations(&mut self) {
        for rider in &self.system.attachments {
            let master = self.trial[rider.master];
            let S = rider.arm(&master);
            let a = master.a + master.alpha.cross(&S) + master.omega.cross(&master.omega.cross(&S));
            let node = &mut self.trial[rider.node];
            for i in 0..3 {
                if rider.dofs[i] {
                    node.a[i] = a[i];
                }
                if rider.dofs[3 + i] {
                    node.alpha[i] = master.alpha[i];
                }
            }
        }
    }

    /// Forces on held directions once the accelerations at hand are taken: what is left of the residual.
    pub(super) fn settle_forces(&mut self, explicit: &Explicit, state: &State, since: f64) {
        if let (Some(masses), None) = (&explicit.masses, &explicit.ties) {
            for block in &masses.blocks {
                let (node, F) = (&self.trial[block.node], &mut self.forces.on_nodes[block.node]);
                block.settle(node, &explicit.push[block.node], F);
            }
            return;
        }
        for &node in &self.movers {
            self.trial[node].a += top(&explicit.push[node]);
            self.trial[node].alpha += bottom(&explicit.push[node]);
        }
        self.hand_on_accelerations();
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
        self.system.residual(&now, &self.given[2], &mut self.forces);
    }

    /// Puts positions and velocities of the trial motion onto the joints by the least change in the norm of the masses; the
    /// increments follow, their q̇ as rates of the rotation vector.
    ///
    /// # Errors
    /// [`Failure::Apart`] where they cannot be closed from there.
    pub(super) fn close_ties(&mut self, explicit: &mut Explicit, state: &State, dt: f64) -> Result<(), Failure> {
        let Explicit { masses: Some(masses), ties: Some(ties), push, .. } = explicit else { return Ok(()) };
        let mut last = f64::INFINITY;
        for round in 0.. {
            self.system.gaps(&self.trial, 0, &mut ties.x);
            let gap = self.system.largest_gap(&ties.x, self.reach);
            if gap <= ROUNDING || (gap >= 0.5 * last && gap <= 1e3 * ROUNDING) {
                break;
            }
            if round == MOST || !ties.form(self.system, masses, &self.trial) || gap.is_nan() {
                self.system.gaps(&self.trial, 0, &mut self.forces.multipliers.gaps);
                return Err(self.apart());
            }
            last = gap;
            ties.solve();
            self.push_from_ties(ties, masses, push);
            for block in &masses.blocks {
                let (change, increment) = (push[block.node], &mut self.increments[block.node]);
                let node = &mut self.trial[block.node];
                let Node { x, low, .. } = *node;
                node.place(&x, &low, &top(&change));
                node.q = renormalise(&(exp(&bottom(&change)) * node.q));
                let turn = inverse_tangent(&bottom(&increment.q), &bottom(&change));
                increment.q += join(&top(&change), &turn);
                increment.d = join(&node.v, &inverse_tangent(&bottom(&increment.q), &node.omega));
            }
            self.carry_riders(&state.nodes);
        }
        let mut last = f64::INFINITY;
        loop {
            self.system.gaps(&self.trial, 1, &mut ties.x);
            let gap = self.system.largest_gap(&ties.x, self.reach);
            if gap * dt <= ROUNDING || gap >= 0.1 * last || gap.is_nan() {
                return Ok(());
            }
            if last == f64::INFINITY && !ties.form(self.system, masses, &self.trial) {
                return Err(self.apart());
            }
            last = gap;
            ties.solve();
            self.push_from_ties(ties, masses, push);
            for block in &masses.blocks {
                let (change, increment) = (push[block.node], &mut self.increments[block.node]);
                let node = &mut self.trial[block.node];
                node.v += top(&change);
                node.omega += bottom(&change);
                increment.d = join(&node.v, &inverse_tangent(&bottom(&increment.q), &node.omega));
            }
            self.carry_riders(&state.nodes);
        }
    }

    fn push_from_ties(&self, ties: &Ties, masses: &Masses, push: &mut [Vec6]) {
        masses.blocks.iter().for_each(|block| push[block.node] = Vec6::zeros());
        ties.push(push);
    }

    /// M times small motions of nodes that move, where masses belong together, in unknown directions alone; into the forces on
    /// nodes, of which nothing is left. As nodes lie, or else as in the trial motion.
    pub(super) fn weigh_together(
        &mut self,
        room: &mut [Vec6],
        nodes: Option<&[Node]>,
        of: impl Fn(&Self, usize) -> Vec6,
    ) {
        for k in 0..self.movers.len() {
            let node = self.movers[k];
            room[node] = self.plan.dofs.of(node).mask(&of(self, node));
        }
        self.system.weigh(nodes.unwrap_or(&self.trial), room, &mut self.forces);
    }

    /// A motion times what was weighed last.
    pub(super) fn times_weighed(&self, of: impl Fn(usize) -> Vec6) -> f64 {
        let times =
            |&node: &usize| self.plan.dofs.of(node).mask(&of(node)).dot(&Vec6::from(self.forces.on_nodes[node]));
        self.movers.iter().map(times).sum()
    }

    /// aᵀ M a of accelerations in unknown directions, as nodes lie, or else as in the trial motion with what is missing there.
    pub(super) fn weigh_accelerations(&mut self, explicit: &mut Explicit, nodes: Option<&[Node]>) -> f64 {
        let Explicit { masses, room, push, .. } = explicit;
        let a = |stepper: &Self, node: usize| match nodes {
            Some(nodes) => join(&nodes[node].a, &nodes[node].alpha),
            None => join(&stepper.trial[node].a, &stepper.trial[node].alpha) + push[node],
        };
        let Some(masses) = masses else {
            self.weigh_together(room, nodes, a);
            return self.times_weighed(|node| a(self, node));
        };
        let weight = |block: &MassBlock| {
            let a = self.plan.dofs.of(block.node).mask(&a(self, block.node));
            block.weigh(&nodes.unwrap_or(&self.trial)[block.node], &a, &a)
        };
        masses.blocks.iter().map(weight).sum()
    }

    /// At the start and after a jump: energies swing from here.
    pub(super) fn start_swing(&mut self, state: &mut State) {
        if !matches!(self.model.scheme.stepping(), Stepping::Verlet) {
            return;
        }
        let Some(mut explicit) = self.explicit.take() else { return };
        state.work.accelerations = self.weigh_accelerations(&mut explicit, Some(&state.nodes));
        state.work.step = 0.0;
        // What they were before tells nothing of a mode.
        state.jerk.fill(Vec6::zeros());
        self.explicit = Some(explicit);
    }

    /// The increments at the end of a step that leads to given velocities and accelerations of the movers.
    pub(super) fn set_rates(&mut self, node: usize, [v, omega, a, alpha]: [Vec3; 4]) {
        let increment = &mut self.increments[node];
        let theta = bottom(&increment.q);
        let d = inverse_tangent(&theta, &omega);
        // What Ṫ Θ̇ makes of it.
        let (_, own) = rates(&theta, &d, &Vec3::zeros());
        increment.d = join(&v, &d);
        increment.dd = join(&a, &inverse_tangent(&theta, &(alpha - own)));
    }

    /// How long the next step may be, of a scheme that finds it by itself.
    ///
    /// # Errors
    /// As for [`Stepper::answer`].
    pub(super) fn proposed(&mut self, state: &State, left: f64) -> Result<f64, Failure> {
        let Some(mut explicit) = self.explicit.take() else { return Ok(left) };
        let length = match (self.model.scheme.stepping(), &explicit.control) {
            (Stepping::Verlet, Some(_)) => self.stable_step(&mut explicit, state, left),
            (_, Some(control)) => Ok(control.next),
            _ => Ok(left),
        };
        self.explicit = Some(explicit);
        length
    }

    /// After a step that was given up: half of it.
    pub(super) fn went_wrong(&mut self, dt: f64) {
        if let Some(control) = self.explicit.as_mut().and_then(|explicit| explicit.control.as_mut()) {
            control.next = 0.5 * dt;
        }
    }

    /// Central differences grow back to what is stable: little by little, since each change of the step makes or takes energy.
    pub(super) fn went_well(&mut self, proposed: f64) {
        const GROWTH: f64 = 1.2;
        if let (Stepping::Verlet, Some(explicit)) = (self.model.scheme.stepping(), &mut self.explicit)
            && let Some(control) = &mut explicit.control
        {
            control.next = GROWTH * proposed;
        }
    }

    /// True when what was found is made of numbers.
    pub(super) fn is_finite(&self, explicit: &Explicit) -> bool {
        let sum: f64 = self.movers.iter().map(|&node| explicit.push[node].sum() + self.trial[node].x.sum()).sum();
        sum.is_finite()
    }
}
