//! The state at t = 0: positions and velocities as given, accelerations from equilibrium.

use super::failure::Failure;
use super::step::Stepper;
use crate::elements::Moduli;
use crate::math::{Vec3, Vec6, rotation};
use crate::model::AnalysisKind;
use crate::state::{Configuration, Increment, Node, State, Work};
use crate::system::Side;
use crate::system::assembly::Weights;

impl Stepper<'_> {
    /// # Errors
    /// [`Failure::Singular`] where a mass matrix cannot be inverted.
    pub fn start(&mut self) -> Result<State, Failure> {
        let dynamic = self.model.analysis.kind == AnalysisKind::Dynamic;
        let nodes: Vec<Node> = self
            .model
            .nodes
            .iter()
            .enumerate()
            .map(|(i, spec)| {
                let mut node = Node::at_rest(spec.x);
                for dof in 0..3 {
                    // Directions left out have no motion at all.
                    if dynamic && self.plan.is_unknown(i, dof) {
                        node.v[dof] = spec.v[dof];
                    }
                    if dynamic && self.plan.is_unknown(i, 3 + dof) {
                        node.omega[dof] = spec.omega[dof];
                    }
                }
                node
            })
            .collect();
        let n = nodes.len();
        let mut state = State {
            time: 0.0,
            nodes,
            history: vec![0.0; self.system.history],
            jerk: vec![Vec6::zeros(); n],
            reactions: vec![0.0; self.model.held.len()],
            multipliers: vec![0.0; self.system.multipliers()],
            followers: vec![Vec6::zeros(); if self.follower.is_some() { n } else { 0 }],
            work: Work::default(),
        };
        self.drive.loading(0.0, Side::After, &mut self.given[2]);
        self.drive.held(0.0, &mut self.held[0]);
        for (held, given) in self.model.held.iter().zip(&self.held[0]) {
            let node = &mut state.nodes[held.node];
            if held.dof < 3 {
                node.x[held.dof] += given.u;
                node.v[held.dof] = given.v;
                node.a[held.dof] = given.a;
            } else {
                let mut turn = Vec3::zeros();
                turn[held.dof - 3] = given.u;
                node.q = rotation::exp(&turn) * node.q;
                node.omega[held.dof - 3] = given.v;
                node.alpha[held.dof - 3] = given.a;
            }
        }
        // Where a given motion starts turned, riders start turned in the directions that ride.
        for rider in &self.system.attachments {
            let turn = rotation::log(&state.nodes[rider.master].q);
            let riding = Vec3::from_fn(|i, _| if rider.dofs[3 + i] { turn[i] } else { 0.0 });
            let node = &mut state.nodes[rider.node];
            node.q = rotation::exp(&riding) * node.q;
        }
        self.ride(&mut state.nodes);
        if self.system.has_contacts() {
            // What touches at t = 0 rubs from then on.
            self.system.update_history(&state.configuration(), 1.0, &mut self.history, self.plan.threads);
            std::mem::swap(&mut state.history, &mut self.history);
        }
        self.system.residual(&state.configuration(), &self.given[2], &mut self.forces);
        if dynamic {
            let massless = self.factor_mass(&state.configuration())?;
            if !self.system.joints.is_empty() {
                self.trial.clone_from(&state.nodes);
                self.check_joints()?;
                self.start_on_joints(&mut state.nodes);
                self.system.residual(&state.configuration(), &self.given[2], &mut self.forces);
            }
            self.accelerate(&mut state, &massless);
            self.system.residual(&state.configuration(), &self.given[2], &mut self.forces);
        }
        for (reaction, held) in state.reactions.iter_mut().zip(&self.model.held) {
            *reaction = -self.forces.on_nodes[held.node][held.dof];
        }
        if self.system.history > 0 {
            // What has yielded before the start is no one's work.
            self.system.update_history(&state.configuration(), 1.0, &mut self.history, self.plan.threads);
            std::mem::swap(&mut state.history, &mut self.history);
        }
        state.work.damping_power =
            if dynamic { self.system.damping_power(&state.configuration(), self.plan.threads) } else { 0.0 };
        self.trial.clone_from(&state.nodes);
        self.start_swing(&mut state);
        Ok(state)
    }

    /// Rates of what rides, from those of the masters; nothing is displaced.
    pub(super) fn ride(&mut self, nodes: &mut [Node]) {
        for (increment, node) in self.increments.iter_mut().zip(&*nodes) {
            *increment = Increment {
                q: Vec6::zeros(),
                d: crate::math::join(&node.v, &node.omega),
                dd: crate::math::join(&node.a, &node.alpha),
            };
        }
        for rider in &self.system.attachments {
            let start = nodes[rider.node];
            rider.follow(nodes, &mut self.increments, &start);
        }
    }

    /// At a jump of the loads velocities go on, accelerations jump by M Δa = Δf and reactions with them; without this the scheme would carry
    /// the old acceleration into the next step and lose an order.
    ///
    /// # Errors
    /// As for [`Stepper::start`].
    pub fn jump(&mut self, state: &mut State) -> Result<(), Failure> {
        if self.model.analysis.kind == AnalysisKind::Static {
            return Ok(());
        }
        self.forces.multipliers.values.copy_from_slice(&state.multipliers);
        let mut force = |side: Side| {
            self.drive.loading(state.time, side, &mut self.given[2]);
            self.system.residual(&state.configuration(), &self.given[2], &mut self.forces);
            self.forces.on_nodes.clone()
        };
        let (before, after) = (force(Side::Before), force(Side::After));
        for (after, (f, before)) in self.forces.on_nodes.iter_mut().zip(after.iter().zip(&before)) {
            *after = std::array::from_fn(|i| f[i] - before[i]);
        }
        let massless = self.factor_mass(&state.configuration())?;
        self.accelerate(state, &massless);
        self.refresh.rejected();
        if self.wants_forces {
            // Reactions jump too, by what the new accelerations leave of the new loads.
            self.system.residual(&state.configuration(), &self.given[2], &mut self.forces);
            for (reaction, held) in state.reactions.iter_mut().zip(&self.model.held) {
                *reaction -= self.forces.on_nodes[held.node][held.dof] - before[held.node][held.dof];
            }
        }
        self.start_swing(state);
        Ok(())
    }

    /// a ← a + M⁻¹ f with the mass matrix factorised. Directions without mass have no equation for their acceleration: it stays.
    fn accelerate(&mut self, state: &mut State, massless: &[usize]) {
        let directions = self.plan.directions.len();
        for (r, &(node, dof)) in self.r.iter_mut().zip(&self.plan.directions) {
            *r = self.forces.on_nodes[node][dof];
        }
        massless.iter().for_each(|&row| self.r[row] = 0.0);
        self.push(state);
        // Rows that share what they carry leave a part of it to be found: once more is enough.
        if !self.system.joints.is_empty() {
            self.r[..directions].fill(0.0);
            self.push(state);
        }
        self.start_followers(state);
    }

    /// After a start or a jump accelerations follow from nowhere else.
    fn start_followers(&self, state: &mut State) {
        for (follower, node) in state.followers.iter_mut().zip(&state.nodes) {
            *follower = crate::math::join(&node.a, &node.alpha);
        }
    }

    /// Solves for accelerations with the forces in `r`, and with what the joints still ask for.
    fn push(&mut self, state: &mut State) {
        let directions = self.plan.directions.len();
        let multipliers = &mut self.forces.multipliers;
        multipliers.values.copy_from_slice(&state.multipliers);
        self.system.gaps(&state.nodes, 2, &mut multipliers.gaps);
        multipliers.ask(&mut self.r[directions..]);
        self.solver.solve(&mut self.r);
        self.solves += 1;
        multipliers.shift(&mut self.r[directions..]);
        multipliers.add(&self.r[directions..]);
        state.multipliers.copy_from_slice(&multipliers.values);
        for (node, rows) in state.nodes.iter_mut().zip(self.plan.dofs.each_node()) {
            for dof in 0..3 {
                if let Some(row) = rows.get(dof) {
                    node.a[dof] += self.r[row];
                }
                if let Some(row) = rows.get(3 + dof) {
                    node.alpha[dof] += self.r[row];
                }
            }
        }
        self.ride(&mut state.nodes);
    }

    /// Forms and factorises M; returns the rows without mass, whose accelerations stay.
    ///
    /// # Errors
    /// [`Failure::Singular`] where a mass matrix cannot be inverted.
    fn factor_mass(&mut self, now: &Configuration) -> Result<Vec<usize>, Failure> {
        const HELD: f64 = 1e20; // times the mass: what is left of its acceleration is below rounding
        // A direction without mass may lie aslant: a thin rod's axis, or that of an arm with a point mass at its end. It shows
        // as a pivot that vanishes.
        let mut aslant: Vec<usize> = Vec::new();
        loop {
            let weights = Weights { stiffness: false, rate: 0.0, acceleration: 1.0, moduli: Moduli::Elastic };
            self.assembly.tangent(self.system, now, &self.given[2], &mut self.forces, weights, &mut self.solver);
            let mut massless = aslant.clone();
            for row in 0..self.plan.directions.len() {
                let Some(slot) = self.solver.slot(row, row) else { continue };
                let diagonal = &mut self.solver.values()[slot];
                if *diagonal == 0.0 {
                    *diagonal = 1.0;
                    massless.push(row);
                }
            }
            for &row in &aslant {
                if let Some(slot) = self.solver.slot(row, row) {
                    self.solver.values()[slot] *= HELD;
                }
            }
            self.factorizations += 1;
            match self.solver.factor() {
                Ok(()) => return Ok(massless),
                Err(singular) if aslant.contains(&singular.row) => {
                    return Err(Failure::singular(self.model, self.plan, self.system, singular.row));
                }
                Err(singular) => aslant.push(singular.row),
            }
        }
    }
}
