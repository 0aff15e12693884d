//! The critical time step of central differences: the fastest mode of a scene at its current configuration, by power
//! iteration on M⁻¹ times differences of residuals. No matrix is formed. The estimate approaches the limit from above,
//! by a few per cent at most; the stepper checks the motion itself besides.

use super::accelerations::Accelerations;
use super::inner_product::{apply_mass, times_applied};
use super::scaled_step::check_scaled_step;
use crate::context::Context;
use crate::failure::Failure;
use crate::plan::Plan;
use crate::step::predict::excite;
use crate::tolerances::critical_step::{AGAIN, AT_FIRST, BELOW, LONGER, SETTLED, SHORTER, SMALL, TURN};
use crate::workspace::Workspace;
use base::math::rotation::RotationUpdate;
use base::math::{Vec3, Vec6, angular, linear, stack};
use base::snapshot::keep;
use mechanics::integrators::stability_limit::longest_step;
use mechanics::state::{Configuration, Increment, Node, State};
use model::{FEWEST_STEPS, Model};

/// Number of steps between two measurements: they cost a hundredth of the whole.
const STEPS: usize = 400;

/// The critical time step of the last measurement. It is allocated once.
pub struct CriticalStep {
    /// The longest stable step at the last measurement.
    pub longest: Option<f64>,
    /// The fastest mode so far, by node.
    mode: Vec<Vec6>,
    next: Vec<Vec6>,
    /// Motions by node that the search starts with after the model has stiffened.
    pub hints: Vec<Vec6>,
    /// The configuration of the measurement, by node.
    place: Vec<Node>,
    /// Forces in this configuration, by node.
    base: Vec<[f64; 6]>,
    /// Steps since the last measurement.
    steps: usize,
    /// Steps since the last cutback of the limit, and the number after which it may rise again. The number doubles with each cutback, since
    /// each change of the step generates or dissipates energy.
    steps_since_cutback: usize,
    holdoff: usize,
    /// True where the scene may stiffen suddenly, as by contact; and the largest aᵀMa since the last measurement.
    stiffens: bool,
    max_aMa: f64,
    /// Largest |ω| of all bodies so far.
    max_spin: f64,
    /// True once the fastest mode has been searched for, with dampers if there are any.
    met: bool,
}

keep!(CriticalStep { 
    longest, mode, next, hints, place, base, steps, steps_since_cutback, holdoff, max_aMa, max_spin, met,
 } without { stiffens });

impl CriticalStep {
    /// A search that begins with a mode of all frequencies, the same in every run.
    pub fn new(model: &Model, plan: &Plan) -> Self {
        let nodes = model.nodes.len();
        let zeros = vec![Vec6::zeros(); nodes];
        let mut critical = CriticalStep {
            longest: None,
            mode: zeros.clone(),
            next: zeros.clone(),
            hints: zeros,
            place: vec![Node::at_rest(Vec3::zeros()); nodes],
            base: vec![[0.0; 6]; nodes],
            steps: 0,
            steps_since_cutback: 0,
            holdoff: STEPS,
            stiffens: model.may_stiffen(),
            max_aMa: 0.0,
            max_spin: 0.0,
            met: false,
        };
        critical.add_all_frequencies(plan);
        critical.hints.copy_from_slice(&critical.mode);
        critical
    }

    /// Adds a motion of all frequencies to the mode.
    fn add_all_frequencies(&mut self, plan: &Plan) {
        let mut seed = 1u64;
        for &(node, dof) in plan.dofs.nodal_dofs() {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            self.mode[node][dof] += (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        }
    }

    /// True if aᵀMa has quadrupled since the last measurement, so accelerations have doubled: an impact may have begun, hidden by the gross
    /// motion.
    pub fn is_struck(&self, aMa: f64) -> bool {
        self.stiffens && aMa > 4.0 * self.max_aMa
    }

    /// Counts a step taken with these accelerations.
    pub fn count(&mut self, aMa: f64) {
        self.max_aMa = self.max_aMa.max(aMa);
    }

    /// The counters of steps.
    pub fn counts(&self) -> [usize; 2] {
        [self.steps, self.steps_since_cutback]
    }

    /// Restores the counters after a refused step, except for a measurement within it.
    pub fn refused(&mut self, [steps, since_cutback]: [usize; 2]) {
        self.steps = self.steps.min(steps);
        self.steps_since_cutback = self.steps_since_cutback.min(since_cutback);
    }

    /// Upper bound of ω² of the fastest mode; power iteration approaches it from below.
    pub fn known(&self) -> f64 {
        BELOW * self.longest.map_or(0.0, |longest| (2.0 / longest).powi(2))
    }

    /// Counts a step of `dt`, and measures the limit in the state when due.
    ///
    /// # Errors
    /// As for [`Accelerations::solve`].
    pub fn update_if_due(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
    ) -> Result<(), Failure> {
        self.steps += 1;
        self.steps_since_cutback += 1;
        if self.longest.is_none() || self.steps >= STEPS {
            self.measure_here(cx, ws, accelerations, state, dt)?;
        }
        Ok(())
    }

    /// The length of the next step: at most `fraction` of the critical step, a turn of [`TURN`] of any body, and a fiftieth of the run.
    /// `left` is the time to the next event.
    ///
    /// # Errors
    /// As for [`Accelerations::solve`].
    pub fn propose(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        left: f64,
        fraction: f64,
    ) -> Result<f64, Failure> {
        if self.longest.is_none() {
            // The effect of dampers depends on the step: the limit with them starts from the one found without.
            self.measure_here(cx, ws, accelerations, state, 0.0)?;
            if cx.system.is_damped() {
                let first = self.longest.unwrap_or(left).min(left);
                // The fastest mode without dampers may not contain the mode of the dampers; the start vector of the search does.
                self.mode.iter_mut().zip(&self.hints).for_each(|(mode, first)| *mode += *first);
                self.measure_here(cx, ws, accelerations, state, first)?;
            }
        }
        let most = cx.model.analysis.duration() / FEWEST_STEPS;
        let rotation = self.rotation_step(cx.model, state);
        Ok((fraction * self.longest.unwrap_or(left)).min(most).min(rotation))
    }

    /// The step length that limits the turn of every body to [`TURN`]. It uses the largest angular velocity of the run, since each change
    /// of the step generates or dissipates energy, and the current angular accelerations.
    fn rotation_step(&mut self, model: &Model, state: &State) -> f64 {
        let nodes = || model.bodies.iter().map(|body| &state.nodes[body.node]);
        self.max_spin = nodes().map(|node| node.omega.norm()).fold(self.max_spin, f64::max);
        let (rate, acceleration) = (self.max_spin, nodes().map(|node| node.alpha.norm()).fold(0.0, f64::max));
        // The step is the root of ω Δt + ½ α Δt² = TURN, written without cancellation.
        2.0 * TURN / (rate + (rate * rate + 2.0 * acceleration * TURN).sqrt())
    }

    /// Measures the limit in the state itself.
    fn measure_here(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
    ) -> Result<(), Failure> {
        self.place.copy_from_slice(&state.nodes);
        self.measure(cx, ws, accelerations, state, dt)
    }

    /// Measures the limit in the trial motion, which is lost.
    ///
    /// # Errors
    /// As for [`Accelerations::solve`].
    pub fn measure_ahead(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
    ) -> Result<(), Failure> {
        self.place.copy_from_slice(&ws.trial.nodes);
        // The motion of the last step contains the mode that has stiffened.
        let [of_mode, of_hints] = [&self.mode, &self.hints].map(|motion| largest(cx, motion));
        if of_mode > 0.0 && of_hints > 0.0 && of_hints.is_finite() {
            // The two must not cancel.
            let (mode, hints) = (&mut self.mode, &self.hints);
            let dot: f64 = mode.iter().zip(hints).map(|(mode, hint)| mode.dot(hint)).sum();
            let sign = if dot < 0.0 { -1.0 } else { 1.0 };
            mode.iter_mut().zip(hints).for_each(|(mode, hint)| *mode = *mode / of_mode + sign * *hint / of_hints);
        }
        self.measure(cx, ws, accelerations, state, dt)
    }

    /// Measures the limit in the configuration kept, for steps of about `dt`, without dampers where `dt` is zero.
    fn measure(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
    ) -> Result<(), Failure> {
        if cx.system.damps_most_at_rest() {
            self.place.iter_mut().for_each(|node| (node.v, node.omega) = (Vec3::zeros(), Vec3::zeros()));
        }
        excite(cx, ws, state.time, state.time, 1.0);
        ws.forces.multipliers.values.copy_from_slice(&state.multipliers);
        self.evaluate(cx, ws, state, [0.0; 2], dt);
        self.base.copy_from_slice(&ws.forces.on_nodes);
        let before = self.longest;
        // Yielding material is as stiff as ever when it unloads.
        let rises = !cx.system.yields() && self.steps_since_cutback >= self.holdoff;
        let iterations = if self.met { AGAIN } else { AT_FIRST };
        let mut longest = self.power_iteration(cx, ws, accelerations, state, dt, (iterations, f64::INFINITY))?;
        if rises && before.is_some_and(|before| longest > LONGER * before) {
            // The stiff part has let go, and its mode contains little of the others.
            self.add_all_frequencies(cx.plan);
            longest = self.power_iteration(cx, ws, accelerations, state, dt, (AT_FIRST, longest))?;
        }
        if let Some(before) = before {
            if longest < SHORTER * before && self.met {
                (self.steps_since_cutback, self.holdoff) = (0, 2 * self.holdoff);
            } else if !rises {
                longest = longest.min(before);
            }
        }
        let met = dt > 0.0 || !cx.system.is_damped();
        (self.longest, self.steps, self.met) = (Some(longest), 0, met);
        check_scaled_step(cx, ws, accelerations, state, (longest, &self.mode));
        self.max_aMa = state.work.accelerations;
        Ok(())
    }

    /// The longest stable step by power iteration, if shorter than `longest`.
    fn power_iteration(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
        (iterations, mut longest): (usize, f64),
    ) -> Result<f64, Failure> {
        let damped = dt > 0.0 && cx.system.is_damped();
        let mut last = 0.0;
        for _ in 0..iterations {
            let size = largest(cx, &self.mode);
            if !(size > 0.0 && size.is_finite()) {
                break;
            }
            let small = SMALL * cx.length / size;
            self.evaluate(cx, ws, state, [small, 0.0], dt);
            self.solve_difference(cx, ws, accelerations, state, small)?;
            let [own, cross, square] = self.mass_products(cx, ws, accelerations);
            // The ratio |ψ|/|φ| is never below ψ·φ/φ·φ, and both approach the eigenvalue from below.
            let stiffness = (square / own).sqrt().max(cross / own);
            self.next.copy_from_slice(&accelerations.missing);
            let mut damping = 0.0;
            if damped {
                self.evaluate(cx, ws, state, [0.0, small], dt);
                damping = self.add_damping(cx, ws, accelerations, state, dt, small)?;
            }
            let found = longest_step(stiffness, damping);
            if !found.is_finite() {
                break;
            }
            longest = longest.min(found);
            let size = largest(cx, &self.next);
            if !(size > 0.0 && size.is_finite()) {
                break;
            }
            self.mode.iter_mut().zip(&self.next).for_each(|(mode, next)| *mode = next / size);
            if (found - last).abs() <= SETTLED * found {
                break;
            }
            last = found;
        }
        Ok(longest)
    }

    /// Adds the residual due to velocities along the current mode to the next mode and to the limit.
    fn add_damping(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        dt: f64,
        small: f64,
    ) -> Result<f64, Failure> {
        self.next.iter_mut().for_each(|next| *next *= 0.25 * dt);
        self.solve_difference(cx, ws, accelerations, state, small)?;
        let [own, cross, _] = self.mass_products(cx, ws, accelerations);
        self.next.iter_mut().zip(&accelerations.missing).for_each(|(next, answer)| *next += answer);
        Ok((cross / own).max(0.0))
    }

    /// Writes the residual where the configuration is moved along the mode, or its velocities are.
    fn evaluate(&self, cx: &Context, ws: &mut Workspace, state: &State, [of_place, of_rate]: [f64; 2], dt: f64) {
        for &node in &cx.independent_nodes {
            let (start, mode) = (&self.place[node], &self.mode[node]);
            let d = stack(&start.v, &start.omega) + mode * of_rate;
            ws.trial.increments[node] = Increment { q: mode * of_place, d, dd: Vec6::zeros() };
            ws.trial.nodes[node].advance(start, &ws.trial.increments[node], RotationUpdate::Exponential);
        }
        ws.trial.update_dependent_nodes(cx, &self.place);
        let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
        cx.system.residual(&now, &ws.loads.instant, &mut ws.forces);
    }

    /// Solves for accelerations with the loss of the forces since they were kept, over `small`.
    fn solve_difference(
        &self,
        cx: &Context,
        ws: &mut Workspace,
        accelerations: &mut Accelerations,
        state: &State,
        small: f64,
    ) -> Result<(), Failure> {
        for (F, base) in ws.forces.on_nodes.iter_mut().zip(&self.base) {
            F.iter_mut().zip(base).for_each(|(f, base)| *f = (base - *f) / small);
        }
        accelerations.solve(cx, ws, state, false)
    }

    /// The products φ·φ, φ·ψ and ψ·ψ in the norm of the masses, with φ the mode and ψ the accelerations that it causes.
    fn mass_products(&self, cx: &Context, ws: &mut Workspace, accelerations: &mut Accelerations) -> [f64; 3] {
        let Accelerations { masses, missing, operand, .. } = accelerations;
        let (mode, answer) = (&self.mode, &*missing);
        let Some(masses) = masses else {
            apply_mass(cx, &ws.trial.nodes, operand, &mut ws.forces, |node| mode[node]);
            let [own, cross] = [mode, answer].map(|other| times_applied(cx, &ws.forces, |node| other[node]));
            apply_mass(cx, &ws.trial.nodes, operand, &mut ws.forces, |node| answer[node]);
            return [own, cross, times_applied(cx, &ws.forces, |node| answer[node])];
        };
        let mut sums = [0.0; 3];
        for block in &masses.blocks {
            let (a, b) = (&mode[block.node], &answer[block.node]);
            for (sum, (a, b)) in sums.iter_mut().zip([(a, a), (a, b), (b, b)]) {
                *sum += block.inner_product(&ws.trial.nodes[block.node], a, b);
            }
        }
        sums
    }
}

/// The largest motion, rotations over the model's length.
fn largest(cx: &Context, mode: &[Vec6]) -> f64 {
    let size = |&node: &usize| linear(&mode[node]).amax().max(cx.length * angular(&mode[node]).amax());
    cx.independent_nodes.iter().map(size).fold(0.0, f64::max)
}
