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
use crate::integrators::{Coefficients, Stepping, load_steps};
use crate::linear::Solver;
use crate::math::{Vec3, Vec6};
use crate::model::{AnalysisKind, Model};
use crate::plan::Plan;
use crate::state::{Configuration, Increment, Node, State};
use crate::system::assembly::{Assembly, Weights};
use crate::system::{Drive, Forces, Loading, Prescribed, Scale, System};

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
    /// See [`crate::integrators::Scheme::follower`].
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

impl<'a> Stepper<'a> {
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        match self.model.analysis.kind {
            AnalysisKind::Static => load_steps::coefficients(),
            AnalysisKind::Dynamic => self.model.scheme.coefficients(dt),
        }
    }

    /// Takes `state` from its time to `to`. On failure `state` is untouched.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn step(&mut self, state: &mut State, to: f64) -> Result<Taken, Failure> {
        match (self.model.analysis.kind, self.model.scheme.stepping()) {
            (AnalysisKind::Dynamic, Stepping::Composite(stages)) => return self.composite(state, to, stages),
            (AnalysisKind::Dynamic, Stepping::Verlet) => return self.central_difference(state, to),
            (AnalysisKind::Dynamic, Stepping::RungeKutta(tableau)) => return self.runge_kutta(state, to, tableau),
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
            let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
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

    /// What the matrix of a step depends on besides the motion: a time, the length of the step or what its rates are taken over.
    fn key(&self, scheme: &Coefficients, dt: f64) -> f64 {
        if scheme.rate[0] > 0.0 { 1.0 / scheme.rate[0] } else { dt }
    }

    /// Before a step is cut: back to its prediction, to go on with a matrix for every iteration; false if that was done.
    fn once_more(&mut self, state: &State, scheme: &Coefficients) -> bool {
        let again = self.refresh.insist();
        if again {
            self.predict(state, scheme);
        }
        again
    }

    pub(super) fn forget_corrections(&mut self) {
        if let Some(anderson) = &mut self.anderson {
            anderson.forget();
        }
        if let Some(search) = &mut self.search {
            search.forget();
        }
    }

    /// Where all that resists has yielded its derivative may be singular; the elastic matrix then leads on.
    fn form_matrix(&mut self, state: &State, scheme: &Coefficients, since: f64) -> Result<(), Failure> {
        let (rate, acceleration) = scheme.weights();
        self.mass_weight = acceleration;
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
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

    /// Before any work is done on a step that reaches `since` ahead: an impact goes on in steps that resolve it.
    pub(super) fn check_length(&self, state: &State, since: f64) -> Result<(), Failure> {
        self.system.hurried_contact(state, since).map_or(Ok(()), |contact| Err(self.too_long(contact)))
    }

    /// Of the motion found, before it is taken: nothing has gone through a surface.
    pub(super) fn check_contacts(&self, state: &State, since: f64) -> Result<(), Failure> {
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: since };
        self.system.missed_contact(&state.nodes, &now).map_or(Ok(()), |contact| Err(self.too_long(contact)))
    }

    fn too_long(&self, contact: usize) -> Failure {
        Failure::Contact { name: self.model.parts[contact].name().to_owned() }
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
