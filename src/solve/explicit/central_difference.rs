//! A step by central differences (velocity Verlet).

use super::accelerations::{Accelerations, set_rates};
use super::critical_step::CriticalStep;
use super::dense_projection::project_onto_constraints;
use super::inner_product::{aMa_of_nodes, aMa_of_trial};
use super::node_loops::{accelerate, end_step, move_ahead};
use super::node_sums::StepSums;
use super::stiffening::{change, is_growing, is_growing_by, resistance, resistance_of_nodes};
use crate::context::Context;
use crate::failure::Failure;
use crate::guards::guard::Taken;
use crate::guards::list::Guards;
use crate::guards::{contacts, joints, links};
use crate::report::StepReport;
use crate::step::commit::{Account, commit_trial};
use crate::step::predict::excite;
use crate::step::residual;
use crate::step::trial::reach;
use crate::system::masses::NodeRates;
use crate::tolerances::masses::CORRECTIONS;
use crate::workspace::Workspace;
use base::math::Vec6;
use base::snapshot::keep;
use linear::TooLarge;
use mechanics::integrators::Coefficients;
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, State, Work};

/// Central differences, with their data besides the workspace. It is allocated once.
pub struct CentralDifferenceStepper {
    accelerations: Accelerations,
    /// Guards of explicit steps.
    guards: Guards,
    /// The limit of the step.
    pub critical: CriticalStep,
    /// True where steps find their own length; the advice of a failure depends on it.
    automatic: bool,
    /// Energy dissipated by materials and contacts on the way to the motion that was evaluated last.
    dissipated: Dissipation,
}

keep!(CentralDifferenceStepper { accelerations, critical } without { guards, automatic, dissipated });

impl CentralDifferenceStepper {
    /// A stepper for central differences.
    ///
    /// # Errors
    /// There is no memory for the projection onto joints.
    pub fn new(cx: &Context) -> Result<Self, TooLarge> {
        Ok(CentralDifferenceStepper {
            accelerations: Accelerations::new(cx)?,
            guards: Guards::of(cx)?,
            critical: CriticalStep::new(cx.model, cx.plan),
            automatic: cx.model.analysis.step_length.is_automatic(),
            dissipated: Dissipation::default(),
        })
    }

    /// Prepares for a run from this state, or for going on from it after a jump of the loads: the offset of energies
    /// starts here.
    pub fn restart(&mut self, cx: &Context, ws: &mut Workspace, state: &mut State) {
        state.work.accelerations = aMa_of_nodes(cx, ws, &mut self.accelerations, &state.nodes);
        state.work.step = 0.0;
        // Earlier accelerations say nothing of a growing mode.
        state.jerk.fill(Vec6::zeros());
    }

    /// The step limited by the critical time step of the state and by the rotation of bodies; see
    /// [`CriticalStep::propose`].
    ///
    /// # Errors
    /// [`Failure::Singular`] or [`Failure::ConstraintsViolated`] where masses or joints leave no accelerations.
    pub fn propose(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        left: f64,
        fraction: f64,
    ) -> Result<f64, Failure> {
        self.critical.propose(cx, ws, &mut self.accelerations, state, left, fraction)
    }

    /// Takes `state` from its time to the time `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let counts = self.critical.counts();
        let result = self.try_step(cx, ws, state, to);
        if result.is_err() {
            self.critical.refused(counts);
        }
        result
    }

    fn try_step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &mut State,
        to: f64,
    ) -> Result<StepReport, Failure> {
        let dt = to - state.time;
        let scheme = cx.model.solution.scheme.coefficients(dt);
        contacts::check_length(cx, state, dt)?;
        self.critical.update_if_due(cx, ws, &mut self.accelerations, state, dt)?;
        self.check_stability(dt)?;
        let (mut evaluations, sums) = self.find_accelerations(cx, ws, state, to, &scheme)?;
        let (mut aMa, suspicious) = self.check_stiffening(cx, ws, state, (sums.as_ref(), dt));
        if suspicious {
            self.measure_critical_step(cx, ws, state, dt)?;
            // The model has not stiffened, and the measurement has overwritten the accelerations.
            evaluations += self.find_accelerations(cx, ws, state, to, &scheme)?.0;
            aMa = aMa_of_trial(cx, ws, &mut self.accelerations);
        }
        let account = self.end_step(cx, ws, state, (&scheme, dt));
        if self.accelerations.are_coupled() {
            self.accelerations.project(cx, ws, state, &scheme, dt)?;
        } else {
            project_onto_constraints(cx, ws, &mut self.accelerations, state, dt)?;
        }
        contacts::check_passage(cx, &ws.trial.nodes, state, dt)?;
        joints::note(cx, ws)?;
        links::check(cx, &ws.trial.nodes, state, dt)?;
        commit_trial(cx, ws, self.accelerations.projection(), state, (&scheme, to), account);
        let taken = Taken { state, from: to - dt, grows: true };
        self.guards.tell(|guard| guard.after_step(cx, ws, &taken));
        self.critical.count(aMa);
        offset_energy(&mut state.work, aMa, dt);
        Ok(StepReport { iterations: evaluations, ..StepReport::begin(to) })
    }

    /// # Errors
    /// [`Failure::Unstable`] if a step of `dt` exceeds the last measured limit.
    fn check_stability(&self, dt: f64) -> Result<(), Failure> {
        match self.critical.longest {
            Some(longest) if dt > longest => Err(Failure::Unstable { dt, longest, automatic: self.automatic }),
            _ => Ok(()),
        }
    }

    /// Finds the trial motion at the end of the step, with predicted velocities, and the difference of its accelerations. Returns the
    /// number of residuals evaluated, and the sums over separate rigid bodies.
    fn find_accelerations(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        to: f64,
        scheme: &Coefficients,
    ) -> Result<(usize, Option<StepSums>), Failure> {
        let dt = to - state.time;
        excite(cx, ws, state.time, to, 1.0);
        self.predict_multipliers(cx, ws, state);
        move_ahead(cx, ws, self.accelerations.masses.as_ref(), state, (scheme, dt));
        let mut evaluations = 0;
        // Gyroscopic moments of bodies at predicted velocities would feed energy into the motion where masses are
        // coupled.
        let corrections = if self.accelerations.are_coupled() { CORRECTIONS } else { 0 };
        loop {
            let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
            // The last evaluation belongs to the motion at the end of the step, unless the step is refused.
            self.dissipated = cx.system.advance(&now, &ws.loads.instant, &mut ws.forces, &mut ws.history);
            evaluations += 1;
            if let Some(free) = self.accelerations.free() {
                let sums = accelerate(cx, ws, free, state, dt);
                return if sums.all.is_finite() {
                    Ok((evaluations, Some(sums)))
                } else {
                    Err(residual::not_finite(cx, &ws.forces))
                };
            }
            self.accelerations.solve(cx, ws, state, true)?;
            if evaluations > corrections {
                break;
            }
            for &node in &cx.independent_nodes {
                let trial = &ws.trial.nodes[node];
                let NodeRates { v, omega, .. } =
                    NodeRates::mean(&state.nodes[node], trial, &self.accelerations.missing[node], dt);
                let (a, alpha) = (trial.a, trial.alpha);
                set_rates(&mut ws.trial.increments[node], &NodeRates { v, omega, a, alpha });
            }
            ws.trial.advance(cx, state, &ws.prescribed.moved, scheme.rotation);
        }
        if self.accelerations.are_finite(cx, ws) {
            Ok((evaluations, None))
        } else {
            Err(residual::not_finite(cx, &ws.forces))
        }
    }

    /// Writes the multipliers that the search for accelerations begins with.
    fn predict_multipliers(&self, cx: &Context, ws: &mut Workspace, state: &State) {
        if cx.system.joints.is_empty() {
            return;
        }
        ws.reach = reach(cx, state);
        let values = &mut ws.forces.multipliers.values;
        match self.accelerations.schur {
            Some(_) => values.fill(0.0),
            None => values.copy_from_slice(&state.multipliers),
        }
    }

    /// The product aᵀMa of the accelerations found, and whether these or the motion suggest that the scene has
    /// stiffened.
    fn check_stiffening(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        (sums, dt): (Option<&StepSums>, f64),
    ) -> (f64, bool) {
        let (accelerations, critical) = (&mut self.accelerations, &self.critical);
        if let (Some(sums), Some((masses, missing))) = (sums, accelerations.free()) {
            let resists = resistance_of_nodes(ws, (masses, missing), state, (sums, dt));
            note_resistance(ws, sums.resistance, dt);
            let suspicious = resists > critical.known() || critical.is_struck(sums.aMa) || is_growing_by(sums);
            return (sums.aMa, suspicious);
        }
        let (resists, sums) = resistance(cx, ws, accelerations, state, dt);
        note_resistance(ws, sums, dt);
        let stiffened = resists > critical.known();
        let aMa = aMa_of_trial(cx, ws, accelerations);
        let suspicious = stiffened || critical.is_struck(aMa) || is_growing(cx, ws, accelerations, state, dt);
        (aMa, suspicious)
    }

    /// Takes the trial motion to the end of the step, with the velocities and accelerations there, and accounts for reactions, damping
    /// and dissipation.
    fn end_step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        (scheme, dt): (&Coefficients, f64),
    ) -> Account {
        let account = self.account(cx, ws, state, dt);
        if let Some((masses, missing)) = self.accelerations.free() {
            end_step(cx, ws, (masses, missing), state, dt);
            return account;
        }
        self.set_end_rates(cx, ws, state, dt);
        if cx.wants_forces {
            self.accelerations.update_reactions(cx, ws, state, dt);
        }
        ws.trial.advance(cx, state, &ws.prescribed.moved, scheme.rotation);
        account
    }

    /// Measures the critical time step in the trial motion, from the change of the accelerations.
    ///
    /// # Errors
    /// [`Failure::Unstable`] where the step is too long for it.
    fn measure_critical_step(
        &mut self,
        cx: &Context,
        ws: &mut Workspace,
        state: &State,
        dt: f64,
    ) -> Result<(), Failure> {
        for &node in &cx.independent_nodes {
            self.critical.hints[node] = change(&self.accelerations.missing, &ws.trial.nodes, state, node);
        }
        self.critical.measure_ahead(cx, ws, &mut self.accelerations, state, dt)?;
        self.check_stability(dt)
    }

    /// Writes the velocities and accelerations at the end of the step; for freely turning bodies from their angular momentum.
    fn set_end_rates(&mut self, cx: &Context, ws: &mut Workspace, state: &State, dt: f64) {
        let Accelerations { masses, schur, missing, .. } = &self.accelerations;
        if let Some(schur) = schur {
            schur.subtract_forces(&mut ws.forces.on_nodes);
        }
        for &node in &cx.independent_nodes {
            let (start, now) = (&state.nodes[node], &ws.trial.nodes[node]);
            let motion = match masses.as_ref().and_then(|masses| masses.of(node)) {
                Some(block) => {
                    let F = &ws.forces.on_nodes[node];
                    block.verlet(start, now, F, &block.accelerate(now, F), dt)
                }
                None => NodeRates::mean(start, now, &missing[node], dt),
            };
            set_rates(&mut ws.trial.increments[node], &motion);
        }
    }

    /// Evaluates the power of damping in the trial motion.
    fn account(&self, cx: &Context, ws: &Workspace, state: &State, dt: f64) -> Account {
        let mut account = Account { damping_power: Some(0.0), dissipated: self.dissipated, ..Account::default() };
        if cx.wants_forces && cx.system.is_damped() {
            let now = Configuration { nodes: &ws.trial.nodes, history: &state.history, dt, previous: None };
            account.damping_power = Some(cx.system.damping_power(&now, cx.plan.threads));
        }
        account
    }
}

/// Adds the resistance of a step, −Δaᵀ M q, and qᵀ M q to sums over all steps, divided by the square of the step.
fn note_resistance(ws: &mut Workspace, [force, size]: [f64; 2], dt: f64) {
    let sums = &mut ws.warnings.resisted;
    sums[0] += force;
    sums[1] += size / (dt * dt);
}

/// Updates the offset of the energy. Central differences conserve an energy that is ⅛ Δt² aᵀMa below the energy at the steps, with Δt of
/// the step before. A change of the step generates or dissipates energy, which the offset excludes.
fn offset_energy(work: &mut Work, aMa: f64, dt: f64) {
    let Work { verlet_energy_offset, accelerations: before, step, .. } = work;
    let last = if *step > 0.0 { *step } else { dt };
    *verlet_energy_offset += 0.125 * (dt * dt * aMa - last * last * *before);
    (*before, *step) = (aMa, dt);
}
