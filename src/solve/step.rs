//! One step: predict, then residual, matrix where it is due, solve, correct, until the error left is below the tolerance.

use super::accelerate::Anderson;
use super::arc::{Condition, Path};
use super::composite::Composite;
use super::convergence::Convergence;
use super::explicit::Explicit;
use super::failure::{self, Failure};
use super::joints::Closing;
use super::refresh::{Advice, Refresh};
use super::search::Search;
use crate::elements::Moduli;
use crate::integrators::{Coefficients, Scheme, load_steps};
use crate::linear::Solver;
use crate::materials::Spent;
use crate::math::rotation::{inverse_tangent, rates};
use crate::math::{Vec3, Vec6, bottom, join, larger, top};
use crate::model::{Kind, Model};
use crate::plan::Plan;
use crate::state::{Increment, Node, Now, State};
use crate::system::assembly::{Assembly, NONE, Weights};
use crate::system::{Drive, Forces, Loading, Prescribed, Scale, Side, System, between};

/// Everything a step writes to. Allocated once.
pub struct Stepper<'a> {
    pub model: &'a Model,
    pub plan: &'a Plan,
    pub system: &'a System,
    pub drive: Drive<'a>,
    pub solver: Solver,
    pub assembly: Assembly,
    pub refresh: Refresh,
    /// Where the matrix may be far from the derivative because material yields.
    pub anderson: Option<Anderson>,
    pub search: Option<Search>,
    /// Where the load is unknown.
    pub path: Option<Path>,
    /// See [`Scheme::follower`].
    pub follower: Option<[f64; 3]>,
    /// What a second stage takes in place of velocities and accelerations, per node.
    pub bases: Option<Vec<[Vec6; 2]>>,
    /// Room for a scheme of two stages.
    pub composite: Option<Composite>,
    /// Where a motion in time has joints.
    pub closing: Option<Closing>,
    /// Where the scheme is explicit.
    pub explicit: Option<Box<Explicit>>,
    /// Motion at the instant of equilibrium.
    pub trial: Vec<Node>,
    pub increments: Vec<Increment>,
    /// Room for what material points will remember at the end of the step.
    pub history: Vec<f64>,
    pub forces: Forces,
    /// Residual, then correction, per unknown.
    pub r: Vec<f64>,
    /// Given values at the start of the step, at its end, and at the instant of equilibrium.
    pub given: [Loading; 3],
    pub held: [Vec<Prescribed>; 3],
    /// Nodes that move by increments of their own.
    pub movers: Vec<usize>,
    /// Held directions, by their place in the model's list, whose motion joints hand on.
    pub leading: Vec<usize>,
    /// Length on which corrections are judged where hardly anything moves.
    pub length: f64,
    /// The first node at t = 0; from there the largest coordinate of a node at the start of the step: what distances are rounded
    /// against.
    pub origin: Vec3,
    pub reach: f64,
    pub wants_forces: bool,
    /// What multiplies the masses in the matrix at hand.
    pub mass_weight: f64,
    pub wants_energy: bool,
    pub factorizations: usize,
    pub solves: usize,
    /// Largest departure from orthogonality that a truncated rotation update left to be mended.
    pub drift: f64,
    /// Largest gap of a joint that the end of a step was left with, relative to the largest coordinate.
    pub violation: f64,
    /// What the joints have made of the velocities at t = 0: the largest change over the largest velocity.
    pub start_jump: f64,
}

/// A step that was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taken {
    pub iterations: usize,
    pub refactorizations: usize,
    /// Relative to the largest force or moment at a node.
    pub residual: f64,
    /// Where it ends.
    pub to: f64,
}

/// Largest translations and rotations of a set of increments.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Size {
    pub translation: f64,
    pub rotation: f64,
}

impl Size {
    /// This size, unless the other is not a number.
    fn or_not_finite(self, other: Size) -> Size {
        if other.translation.is_nan() { other } else { self }
    }
}

impl<'a> Stepper<'a> {
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        match (self.model.analysis.kind, &self.model.scheme) {
            (Kind::Static, _) => load_steps::coefficients(),
            (Kind::Dynamic, scheme) => scheme.coefficients(dt),
        }
    }

    /// Takes `state` from its time to `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn step(&mut self, state: &mut State, to: f64) -> Result<Taken, Failure> {
        match (self.model.analysis.kind, &self.model.scheme) {
            (Kind::Dynamic, Scheme::Bathe(bathe)) => return self.composite(state, to, bathe),
            (Kind::Dynamic, Scheme::CentralDifference(scheme)) => return self.central_difference(state, to, scheme),
            (Kind::Dynamic, Scheme::RungeKutta(scheme)) => return self.runge_kutta(state, to, scheme),
            _ => {}
        }
        let scheme = self.coefficients(to - state.time);
        self.stage(state, &scheme, to)
    }

    pub(super) fn stage(&mut self, state: &mut State, scheme: &Coefficients, to: f64) -> Result<Taken, Failure> {
        let touches = self.system.has_contacts();
        let since = scheme.instant * (to - state.time);
        if touches {
            self.check_length(state, since)?;
        }
        self.predict(state, scheme);
        let taken = self.equilibrate(state, scheme, to, None)?;
        if touches {
            self.check_contacts(state, since)?;
        }
        self.accept(state, scheme, to)?;
        Ok(taken)
    }

    /// Finds the motion from `state` to its equilibrium at `to`, from the increments at hand; or, with a condition in place
    /// of the time, to where that holds, from the time `to` on.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn equilibrate(
        &mut self,
        state: &State,
        scheme: &Coefficients,
        to: f64,
        condition: Option<Condition>,
    ) -> Result<Taken, Failure> {
        self.give(state.time, to, scheme.instant);
        let mut taken = Taken { iterations: 0, refactorizations: 0, residual: 0.0, to };
        let exact = self.plan.linear && condition.is_none();
        let mut convergence = Convergence::new(self.model.iteration.tolerance, exact);
        let mut limit = self.model.iteration.limit;
        loop {
            let dt = taken.to - state.time;
            let since = scheme.instant * dt;
            self.move_trial(state, scheme);
            let now = Now { nodes: &self.trial, past: &state.history, since };
            let scale = self.system.residual(&now, &self.given[2], &mut self.forces);
            taken.residual = self.gather(&scale);
            if !taken.residual.is_finite() {
                if !self.once_more(state, scheme) {
                    return Err(self.not_finite());
                }
                convergence.forget();
                continue;
            }
            if let Some(search) = &mut self.search
                && search.shorten(
                    &self.r[..self.plan.directions.len()],
                    taken.residual,
                    &mut self.increments,
                    &mut self.forces.multipliers.values,
                )
            {
                // What was mixed into it no longer tells what it did.
                if let Some(anderson) = &mut self.anderson {
                    anderson.forget();
                }
                continue;
            }
            let key = self.key(scheme, dt);
            if self.refresh.due(taken.iterations, key) {
                self.form_matrix(state, scheme, since)?;
                self.refresh.done(key);
                self.forget_corrections();
                taken.refactorizations += 1;
            }
            self.forces.multipliers.ask(&mut self.r[self.plan.directions.len()..]);
            if let Some(search) = &mut self.search {
                search.keep_residual(&self.r[..self.plan.directions.len()], taken.residual);
            }
            self.solver.solve(&mut self.r);
            self.solves += 1;
            self.forces.multipliers.shift(&mut self.r[self.plan.directions.len()..]);
            // Loads are curves over the time: a correction δt leaves them wrong by its square, whatever the motion.
            let mut curved = 0.0;
            if let Some(condition) = condition {
                let to = self.close(state, taken.to, condition)?;
                curved = ((to - taken.to) / self.model.analysis.end_time).powi(2);
                taken.to = to;
            }
            // A mixed correction may be small by chance; what the residual asks for tells how far there is to go.
            let plain = self.search.is_some().then(|| self.prepare());
            let (mut correction, motion) = self.correct();
            if let Some(plain) = plain {
                correction = plain.or_not_finite(correction);
            }
            taken.iterations += 1;
            let size = self.relative(correction, motion);
            if !size.is_finite() {
                return Err(self.not_finite());
            }
            let fresh = taken.refactorizations > 0;
            let judgement = convergence.judge(size, taken.residual);
            // Between elastic and plastic one contraction says little of the next, and what is small against positions may be
            // large against elastic strains: the residual must have come down as well, or nothing but rounding be left.
            let tolerance = self.model.iteration.tolerance;
            let sure = self.system.history == 0 || taken.residual <= 1e3 * tolerance;
            let rounding = judgement.stalled() && self.is_rounding(correction, fresh && sure);
            if curved <= tolerance && (rounding || sure && judgement.converged()) {
                break;
            }
            if taken.iterations >= limit {
                if !self.once_more(state, scheme) {
                    return Err(self.not_converged(&taken));
                }
                convergence.forget();
                limit += self.model.iteration.limit;
            } else if judgement.seen && self.refresh.watch(fresh, &judgement) == Advice::Restart {
                self.predict(state, scheme);
                convergence.forget();
            }
        }
        self.refresh.accepted(taken.iterations);
        Ok(taken)
    }

    /// What stands in place of a node's velocity and acceleration at the start of a step.
    #[inline]
    fn bases(&self, state: &State, node: usize, own: [Vec6; 2]) -> [Vec6; 2] {
        if let Some(bases) = &self.bases {
            bases[node]
        } else if self.follower.is_some() {
            [own[0], state.followers[node]]
        } else {
            own
        }
    }

    /// What the matrix of a step depends on besides the motion: a time, the length of the step or what its rates are taken over.
    fn key(&self, scheme: &Coefficients, dt: f64) -> f64 {
        if scheme.rate[0] > 0.0 { 1.0 / scheme.rate[0] } else { dt }
    }

    /// Loads and held motion at the ends of the step and, extrapolated from them, at the instant of equilibrium.
    pub(super) fn give(&mut self, from: f64, to: f64, instant: f64) {
        let [start, end, at] = &mut self.given;
        self.drive.loading(from, Side::After, start);
        self.drive.loading(to, Side::Before, end);
        between(start, end, instant, at);
        let [start, end, at] = &mut self.held;
        self.drive.held(from, start);
        self.drive.held(to, end);
        at.clear();
        at.extend(start.iter().zip(end.iter()).map(|(a, b)| Prescribed {
            u: instant * (b.u - a.u),
            v: a.v + instant * (b.v - a.v),
            a: a.a + instant * (b.a - a.a),
        }));
        if instant > 1.0 {
            // What joints tie to a given motion takes its acceleration from positions: they must belong to one another. Past the
            // end of the step a straight line of positions would leave six sevenths of it out.
            let tau = instant * (to - from);
            for &i in &self.leading {
                let (start, now) = (&start[i], &mut at[i]);
                now.u = tau * start.v + tau * tau / 6.0 * (2.0 * start.a + now.a);
            }
        }
    }

    /// Before a step is cut: back to its prediction, to go on with a matrix for every iteration; false if that was done.
    fn once_more(&mut self, state: &State, scheme: &Coefficients) -> bool {
        let again = self.refresh.insist();
        if again {
            self.predict(state, scheme);
        }
        again
    }

    fn forget_corrections(&mut self) {
        if let Some(anderson) = &mut self.anderson {
            anderson.forget();
        }
        if let Some(search) = &mut self.search {
            search.forget();
        }
    }

    pub(super) fn predict(&mut self, state: &State, scheme: &Coefficients) {
        self.forget_corrections();
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            self.increments[node].q = scheme.predict(&v, &a, &state.jerk[node]);
        }
        self.measure_reach(state);
        self.forces.multipliers.values.copy_from_slice(&state.multipliers);
    }

    pub(super) fn measure_reach(&mut self, state: &State) {
        let farthest = |reach: f64, &node: &usize| reach.max((state.nodes[node].x - self.origin).amax());
        self.reach = self.movers.iter().fold(self.length, farthest);
    }

    /// The trial motion from the increments: rates by the scheme, held directions as given, riders after their masters.
    pub(super) fn move_trial(&mut self, state: &State, scheme: &Coefficients) {
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            let start_a = a;
            let [v, a] = self.bases(state, node, [v, a]);
            scheme.differentiate(&mut self.increments[node], &v, &a, &start_a);
        }
        for (held, given) in self.model.held.iter().zip(&self.held[2]) {
            set(&mut self.increments[held.node], held.dof, given);
        }
        for &node in &self.movers {
            let drift = self.trial[node].advance(&state.nodes[node], &self.increments[node], scheme.rotation);
            self.drift = self.drift.max(drift);
        }
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &state.nodes[rider.node]);
        }
    }

    /// Residual per unknown; returns its largest entry relative to the forces (moments) it is made of.
    pub(super) fn gather(&mut self, scale: &Scale) -> f64 {
        let (mut force, mut moment) = (0.0, 0.0);
        for (r, &(node, dof)) in self.r.iter_mut().zip(&self.plan.directions) {
            *r = self.forces.on_nodes[node][dof];
            // NaN must not vanish in a comparison.
            let size = if r.is_nan() { f64::INFINITY } else { r.abs() };
            if dof < 3 {
                force = larger(force, size);
            } else {
                moment = larger(moment, size);
            }
        }
        // Forces and moments apart; one counts against the other over the model's length where its own scale is nil.
        let forces = scale.force.max(1e-3 * scale.moment / self.length);
        let moments = scale.moment.max(1e-3 * scale.force * self.length);
        let ratio = |size: f64, of: f64| if size == 0.0 { 0.0 } else { size / of.max(f64::MIN_POSITIVE) };
        ratio(force, forces).max(ratio(moment, moments))
    }

    /// Where all that resists has yielded its derivative may be singular; the elastic matrix then leads on.
    fn form_matrix(&mut self, state: &State, scheme: &Coefficients, since: f64) -> Result<(), Failure> {
        let (rate, acceleration) = scheme.weights();
        self.mass_weight = acceleration;
        let now = Now { nodes: &self.trial, past: &state.history, since };
        let mut moduli = self.refresh.moduli();
        loop {
            let weights = Weights { stiffness: true, rate, acceleration, moduli };
            self.assembly.tangent(self.system, &now, &self.given[2], &mut self.forces, weights, &mut self.solver);
            self.factorizations += 1;
            match self.solver.factor() {
                Ok(()) => return Ok(()),
                Err(_) if moduli == Moduli::Algorithmic && self.system.history > 0 => moduli = Moduli::Elastic,
                Err(singular) => {
                    self.refresh.rejected();
                    return Err(Failure::singular(self.model, self.plan, self.system, singular.row));
                }
            }
        }
    }

    /// Mixes the correction in `r`, where material yields, and keeps it. Returns its size before that.
    #[inline(never)]
    fn prepare(&mut self) -> Size {
        let plain = self.largest_correction();
        if let Some(anderson) = &mut self.anderson {
            anderson.mix(&mut self.r);
        }
        if let Some(search) = &mut self.search {
            let correction = &self.r[..self.plan.directions.len()];
            search.keep_correction(correction, &self.increments, &self.forces.multipliers.values);
        }
        plain
    }

    /// Of the correction in `r`.
    fn largest_correction(&self) -> Size {
        let mut size = Size::default();
        for (r, &(_, dof)) in self.r.iter().zip(&self.plan.directions) {
            let largest = if dof < 3 { &mut size.translation } else { &mut size.rotation };
            *largest = largest.max(r.abs());
        }
        size
    }

    /// Adds the correction in `r` to the increments. Returns its size and that of the increments.
    fn correct(&mut self) -> (Size, Size) {
        let (mut correction, mut motion) = (Size::default(), Size::default());
        for &node in &self.movers {
            let rows = &self.plan.rows[node];
            let entry = |i: usize| if rows[i] == NONE { 0.0 } else { self.r[rows[i] as usize] };
            let increment = &mut self.increments[node].q;
            let dq = Vec6::from_fn(|i, _| entry(i));
            let theta = bottom(increment);
            // δΘ = T⁻¹ δθ
            let dtheta = inverse_tangent(&theta, &bottom(&dq));
            for i in 0..3 {
                increment[i] += dq[i];
                if rows[3 + i] != NONE {
                    increment[3 + i] += dtheta[i];
                }
                correction.translation = larger(correction.translation, dq[i].abs());
                correction.rotation = larger(correction.rotation, dq[3 + i].abs());
                motion.translation = larger(motion.translation, increment[i].abs());
                motion.rotation = larger(motion.rotation, increment[3 + i].abs());
            }
            if dq.iter().any(|c| !c.is_finite()) {
                correction.translation = f64::NAN;
            }
        }
        self.forces.multipliers.add(&self.r[self.plan.directions.len()..]);
        (correction, motion)
    }

    /// Correction relative to the motion of the step, translations and rotations apart, with floors for scenes at rest.
    fn relative(&self, correction: Size, motion: Size) -> f64 {
        const STILL: f64 = 1e-6; // of the model's length, or radians: a step that moves less is judged on this
        if correction.translation.is_nan() {
            return f64::NAN;
        }
        let translation = correction.translation / motion.translation.max(STILL * self.length);
        translation.max(correction.rotation / motion.rotation.max(STILL))
    }

    /// True for a correction that only stirs the last digits of the positions. (It must have stopped to contract as well:
    /// increments, and the accelerations that follow from them, have more digits than positions.) The axial stiffness
    /// turns these digits into forces, and bending answers them with corrections that are larger by the slenderness
    /// squared: where even a `fresh` matrix does not help, four digits more are given for that, and rotations follow the
    /// positions over the model's length.
    fn is_rounding(&self, correction: Size, fresh: bool) -> bool {
        const ROUNDING: f64 = 4.0 * f64::EPSILON;
        let (translation, rotation) = if fresh {
            (1e4 * ROUNDING * self.reach, 1e4 * ROUNDING * (self.reach / self.length).max(1.0))
        } else {
            (ROUNDING * self.reach, ROUNDING)
        };
        correction.translation <= translation && correction.rotation <= rotation
    }

    /// State at the end of the step, written once.
    ///
    /// # Errors
    /// As for [`Stepper::close_joints`]; `state` is untouched.
    pub(super) fn accept(&mut self, state: &mut State, scheme: &Coefficients, to: f64) -> Result<(), Failure> {
        let dt = to - state.time;
        let (mut damping_power, mut spent) = (0.0, Spent::default());
        let remembers = self.system.history > 0;
        let dynamic = self.model.analysis.kind == Kind::Dynamic;
        if self.wants_forces || remembers {
            self.move_trial(state, scheme);
        } else {
            for &node in &self.movers {
                let start = &state.nodes[node];
                let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
                let start_a = a;
                let [v, a] = self.bases(state, node, [v, a]);
                scheme.differentiate(&mut self.increments[node], &v, &a, &start_a);
            }
        }
        let now = Now { nodes: &self.trial, past: &state.history, since: scheme.instant * dt };
        if self.wants_forces {
            self.system.residual(&now, &self.given[2], &mut self.forces);
            if self.system.is_damped() && dynamic {
                damping_power = self.system.damping_power(&now, self.plan.threads);
            }
        }
        if remembers {
            // Like reactions, plastic strains are taken where equilibrium is written and carried to the end of the step on a
            // straight line: at the end itself stiff parts are not at rest, and would yield from step to step.
            spent = self.system.remember(&now, 1.0 / scheme.instant, &mut self.history, self.plan.threads);
        }
        for &node in &self.movers {
            let start = &state.nodes[node];
            let (v, a) = (join(&start.v, &start.omega), join(&start.a, &start.alpha));
            let [v, a] = self.bases(state, node, [v, a]);
            self.increments[node] = scheme.finish(&self.increments[node], &v, &a);
        }
        self.arrive(state, scheme);
        self.close_joints(state, scheme, dt)?;
        if scheme.instant != 1.0 && self.system.has_contacts() {
            self.check_contacts(state, dt)?;
        }
        self.check_joints()?;
        self.commit(state, scheme, to, spent, Some(damping_power));
        Ok(())
    }

    /// The trial motion from the increments at the end of the step: held directions as given, riders after their masters.
    pub(super) fn arrive(&mut self, state: &State, scheme: &Coefficients) {
        for (i, held) in self.model.held.iter().enumerate() {
            let (from, to) = (&self.held[0][i], &self.held[1][i]);
            set(&mut self.increments[held.node], held.dof, &Prescribed { u: to.u - from.u, ..*to });
        }
        for &node in &self.movers {
            let start = &state.nodes[node];
            let end = &mut self.trial[node];
            end.advance(start, &self.increments[node], scheme.rotation);
        }
        self.carry_riders(&state.nodes);
    }

    pub(super) fn carry_riders(&mut self, start: &[Node]) {
        for rider in &self.system.attachments {
            rider.follow(&mut self.trial, &mut self.increments, &start[rider.node]);
        }
    }

    /// The trial motion becomes the state; `spent` by material points; `damping_power` there, where work is accounted for here.
    pub(super) fn commit(
        &mut self,
        state: &mut State,
        scheme: &Coefficients,
        to: f64,
        spent: Spent,
        damping_power: Option<f64>,
    ) {
        let dt = to - state.time;
        let dynamic = self.model.analysis.kind == Kind::Dynamic;
        if dynamic {
            for &node in &self.movers {
                let (start, end) = (&state.nodes[node], &self.trial[node]);
                state.jerk[node] = join(&(end.a - start.a), &(end.alpha - start.alpha)) / dt;
            }
        }
        if let Some([of_a, of_start, of_end]) = self.follower {
            for &node in &self.movers {
                let (start, increment) = (&state.nodes[node], &self.increments[node]);
                let before = join(&start.a, &start.alpha);
                // In the rotation vector of the step, then as a spatial vector like every other.
                let a = state.followers[node] * of_a + before * of_start + increment.dd * of_end;
                let (_, turn) = rates(&bottom(&increment.q), &bottom(&increment.d), &bottom(&a));
                state.followers[node] = join(&top(&a), &turn);
            }
        }
        state.work.material += spent;
        for (old, value) in state.multipliers.iter_mut().zip(&self.forces.multipliers.values) {
            *old += (value - *old) / scheme.instant;
        }
        self.share_out(state);
        if let Some(damping_power) = damping_power.filter(|_| self.wants_forces) {
            self.account(state, scheme, dt, damping_power);
        }
        if self.system.history > 0 {
            std::mem::swap(&mut state.history, &mut self.history);
        }
        std::mem::swap(&mut state.nodes, &mut self.trial);
        state.time = to;
    }

    /// Reactions and dissipation, taken where equilibrium is written and carried to the end of the step on a straight line
    /// (at the end itself stiff parts are not at rest), and the work done.
    pub(super) fn account(&mut self, state: &mut State, scheme: &Coefficients, dt: f64, damping_power: f64) {
        let carry = |old: f64, at_instant: f64| old + (at_instant - old) / scheme.instant;
        for (i, held) in self.model.held.iter().enumerate() {
            let old = state.reactions[i];
            let new = carry(old, -self.forces.on_nodes[held.node][held.dof]);
            let moved = self.held[1][i].u - self.held[0][i].u;
            state.work.external += 0.5 * (old + new) * moved;
            state.reactions[i] = new;
        }
        state.work.external += self.system.external_work((&state.nodes, &self.given[0]), (&self.trial, &self.given[1]));
        let old = state.work.damping_power;
        let new = carry(old, damping_power);
        state.work.damping += 0.5 * dt * (old + new);
        state.work.damping_power = new;
    }

    /// Before any work is done on a step that reaches `since` ahead: an impact goes on in steps that resolve it.
    pub(super) fn check_length(&self, state: &State, since: f64) -> Result<(), Failure> {
        self.system.hurried_contact(state, since).map_or(Ok(()), |contact| Err(self.too_long(contact)))
    }

    /// Of the motion found, before it is taken: nothing has gone through a surface.
    pub(super) fn check_contacts(&self, state: &State, since: f64) -> Result<(), Failure> {
        let now = Now { nodes: &self.trial, past: &state.history, since };
        self.system.missed_contact(&state.nodes, &now).map_or(Ok(()), |contact| Err(self.too_long(contact)))
    }

    fn too_long(&self, contact: usize) -> Failure {
        Failure::Contact { name: self.model.contacts[contact].name.clone() }
    }

    fn not_converged(&mut self, taken: &Taken) -> Failure {
        self.refresh.rejected();
        // Forces balance, but not with closed joints: they contradict each other.
        if taken.residual < 1e-3
            && let Err(apart) = self.check_joints()
        {
            return apart;
        }
        self.gather(&Scale::default());
        let largest = failure::largest(self.model, self.plan, &self.r);
        Failure::NotConverged { iterations: taken.iterations, largest }
    }

    pub(super) fn not_finite(&mut self) -> Failure {
        self.refresh.rejected();
        self.gather(&Scale::default());
        Failure::NotFinite { largest: failure::largest(self.model, self.plan, &self.r) }
    }
}

#[inline]
fn set(increment: &mut Increment, dof: usize, given: &Prescribed) {
    increment.q[dof] = given.u;
    increment.d[dof] = given.v;
    increment.dd[dof] = given.a;
}

/// Largest distance of a node from the first, or 1 for a single point.
pub fn extent(nodes: &[Node]) -> f64 {
    let first = nodes.first().map_or(Vec3::zeros(), |n| n.x);
    let extent = nodes.iter().map(|n| (n.x - first).norm()).fold(0.0, f64::max);
    if extent > 0.0 { extent } else { 1.0 }
}
