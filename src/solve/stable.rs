//! The longest step that central differences bear: the fastest mode of a scene as it lies, by power iteration on M⁻¹ times
//! differences of residuals. No matrix is formed. It comes to the limit from above, by a few per cent at most; the march looks
//! at the motion itself besides.

use super::explicit::Explicit;
use super::failure::Failure;
use super::step::Stepper;
use crate::integrators::central_difference::longest_step;
use crate::math::rotation::RotationUpdate;
use crate::math::{Vec3, Vec6, bottom, join, top};
use crate::model::{Model, StepLength, may_stiffen};
use crate::plan::Plan;
use crate::state::{Configuration, Increment, Node, State};

/// Iterations at the start, and when the limit is looked at again: a residual each, two where there is damping.
const AT_FIRST: usize = 60;
const AGAIN: usize = 3;
/// Steps between two looks: they cost a hundredth of the whole.
const STEPS: usize = 400;
/// Change from one iteration to the next that ends them.
const SETTLED: f64 = 1e-4;
/// Steps of a run at least, where little or nothing resists: loads are still to be seen.
const FEWEST: f64 = 50.0;
/// Radians by which a body turns in a step at most: nothing stiff limits tops and mechanisms, and an error of θ²/24 of the angle, as
/// central differences have in a swing, is 6.5e-4 in a turn.
const TURN: f64 = 0.05;
/// A limit that is longer by so much is another mode's.
const LONGER: f64 = 1.05;
/// One that is shorter by so much has been cut.
const SHORTER: f64 = 0.95;
/// Of the model's length: the motion by which residuals are told apart. Over the length of an element it is a strain, and that must
/// not make steel yield: at a thousand elements this is one of 2e-6. Positions in two parts leave seven digits of it.
const SMALL: f64 = 1e-9;

/// Allocated once.
pub struct Stable {
    /// The longest step, when last looked at.
    pub longest: Option<f64>,
    /// The fastest mode so far, by node.
    mode: Vec<Vec6>,
    next: Vec<Vec6>,
    /// Motion in which it may be looked for, by node.
    pub hints: Vec<Vec6>,
    /// Where it is looked at.
    place: Vec<Node>,
    /// Forces there, by node.
    base: Vec<[f64; 6]>,
    /// Steps taken since.
    steps: usize,
    /// Steps since the limit was last cut, and those after which it may rise again: twice as many from cut to cut, since each change
    /// of the step makes or takes energy.
    calm: usize,
    patience: usize,
    /// Of the longest step.
    part: f64,
    /// Something may be struck; and the largest aᵀMa since the last look.
    stiffens: bool,
    loudest: f64,
    /// Of all bodies so far, their |ω|.
    quickest: f64,
    /// The fastest mode has been looked for, with dampers if there are any.
    met: bool,
}

impl Stable {
    /// With a mode of all frequencies to begin with: the same in every run.
    pub fn new(model: &Model, plan: &Plan) -> Self {
        let nodes = model.nodes.len();
        let place = vec![Node::at_rest(Vec3::zeros()); nodes];
        let zeros = vec![Vec6::zeros(); nodes];
        let mut stable = Stable {
            longest: None,
            mode: zeros.clone(),
            next: zeros.clone(),
            hints: zeros,
            place,
            base: vec![[0.0; 6]; nodes],
            steps: 0,
            calm: 0,
            patience: STEPS,
            part: match model.analysis.step_length {
                StepLength::StabilityLimited { fraction } => fraction,
                _ => 1.0,
            },
            stiffens: may_stiffen(model),
            loudest: 0.0,
            quickest: 0.0,
            met: false,
        };
        stable.add_all(plan);
        stable.hints.copy_from_slice(&stable.mode);
        stable
    }

    /// Adds a motion of all frequencies to the mode.
    fn add_all(&mut self, plan: &Plan) {
        let mut seed = 1u64;
        for &(node, dof) in &plan.directions {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            self.mode[node][dof] += (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        }
    }

    /// Accelerations have doubled at once, aᵀMa: something may have been struck, though the motion of the whole hides it.
    pub fn is_struck(&self, accelerations: f64) -> bool {
        self.stiffens && accelerations > 4.0 * self.loudest
    }

    /// A step with these accelerations, aᵀMa, was taken.
    pub fn took(&mut self, accelerations: f64) {
        self.loudest = self.loudest.max(accelerations);
    }

    /// What counts steps.
    pub fn counts(&self) -> [usize; 2] {
        [self.steps, self.calm]
    }

    /// A step was refused, and was none, but for the look that it may have taken.
    pub fn refused(&mut self, [steps, calm]: [usize; 2]) {
        self.steps = self.steps.min(steps);
        self.calm = self.calm.min(calm);
    }

    /// ω² that the fastest mode is known to have at most: power iteration comes to it from below.
    pub fn known(&self) -> f64 {
        const BELOW: f64 = 1.1;
        BELOW * self.longest.map_or(0.0, |longest| (2.0 / longest).powi(2))
    }
}

impl Stepper<'_> {
    /// # Errors
    /// [`Failure::Unstable`] where a step of `dt` is too long.
    pub(super) fn check_stable(&mut self, explicit: &mut Explicit, state: &State, dt: f64) -> Result<(), Failure> {
        explicit.stable.steps += 1;
        explicit.stable.calm += 1;
        if explicit.stable.longest.is_none() || explicit.stable.steps >= STEPS {
            self.look_at_limit(explicit, state, dt, false)?;
        }
        match explicit.stable.longest {
            Some(longest) if dt > longest => {
                Err(Failure::Unstable { dt, longest, automatic: explicit.control.is_some() })
            }
            _ => Ok(()),
        }
    }

    /// Of central differences: a safe part of the longest that is stable, little longer than what went well last, no body turning
    /// by more than [`TURN`], and no longer than a fiftieth of the run.
    ///
    /// # Errors
    /// As for [`Stepper::answer`].
    pub(super) fn stable_step(&mut self, explicit: &mut Explicit, state: &State, left: f64) -> Result<f64, Failure> {
        if explicit.stable.longest.is_none() {
            // What dampers add depends on the step: from the one found without them to that with them.
            self.look_at_limit(explicit, state, 0.0, false)?;
            if self.system.is_damped() {
                let first = explicit.stable.longest.unwrap_or(left).min(left);
                // The fastest mode without dampers may know nothing of them: what the search began with does.
                let Stable { mode, hints, .. } = &mut explicit.stable;
                mode.iter_mut().zip(hints).for_each(|(mode, first)| *mode += *first);
                self.look_at_limit(explicit, state, first, false)?;
            }
        }
        let cut = explicit.control.as_ref().map_or(f64::INFINITY, |control| control.next);
        let most = self.model.analysis.end_time / FEWEST;
        let turning = self.turning_step(&mut explicit.stable, state);
        Ok((explicit.stable.part * explicit.stable.longest.unwrap_or(left)).min(cut).min(most).min(turning))
    }

    /// In which no body turns by more than [`TURN`]: as fast as the fastest has ever been, since each change of the step makes or
    /// takes energy, and with the accelerations there are.
    fn turning_step(&self, stable: &mut Stable, state: &State) -> f64 {
        let nodes = || self.model.bodies.iter().map(|body| &state.nodes[body.node]);
        stable.quickest = nodes().map(|node| node.omega.norm()).fold(stable.quickest, f64::max);
        let (rate, acceleration) = (stable.quickest, nodes().map(|node| node.alpha.norm()).fold(0.0, f64::max));
        // ω Δt + ½ α Δt², without a difference of like numbers.
        2.0 * TURN / (rate + (rate * rate + 2.0 * acceleration * TURN).sqrt())
    }

    /// Measures the limit anew, for steps of about `dt`, without dampers where that is zero: in the state, or where the trial
    /// motion has come to, of which nothing is left then.
    ///
    /// # Errors
    /// As for [`Stepper::answer`].
    pub(super) fn look_at_limit(
        &mut self,
        explicit: &mut Explicit,
        state: &State,
        dt: f64,
        ahead: bool,
    ) -> Result<(), Failure> {
        let at = if ahead { &self.trial } else { &state.nodes };
        explicit.stable.place.copy_from_slice(at);
        if ahead {
            // What has just met more resistance tells where that is.
            let Stable { mode, hints, .. } = &mut explicit.stable;
            let [of_mode, of_hints] = [&*mode, &*hints].map(|motion| self.largest(motion));
            if of_mode > 0.0 && of_hints > 0.0 && of_hints.is_finite() {
                // One must not undo the other.
                let dot: f64 = mode.iter().zip(&*hints).map(|(mode, hint)| mode.dot(hint)).sum();
                let sign = if dot < 0.0 { -1.0 } else { 1.0 };
                mode.iter_mut().zip(hints).for_each(|(mode, hint)| *mode = *mode / of_mode + sign * *hint / of_hints);
            }
        }
        self.give(state.time, state.time, 1.0);
        self.forces.multipliers.values.copy_from_slice(&state.multipliers);
        self.shift(&explicit.stable, state, [0.0; 2], dt);
        explicit.stable.base.copy_from_slice(&self.forces.on_nodes);
        let before = explicit.stable.longest;
        // What yields now is as stiff as ever when it turns back.
        let rises = !self.system.yields() && explicit.stable.calm >= explicit.stable.patience;
        let iterations = if explicit.stable.met { AGAIN } else { AT_FIRST };
        let mut longest = self.fastest(explicit, state, dt, (iterations, f64::INFINITY))?;
        if rises && before.is_some_and(|before| longest > LONGER * before) {
            // What was stiff has let go, and its mode knows little of the others.
            explicit.stable.add_all(self.plan);
            longest = self.fastest(explicit, state, dt, (AT_FIRST, longest))?;
        }
        let met = dt > 0.0 || !self.system.is_damped();
        let stable = &mut explicit.stable;
        if let Some(before) = before {
            if longest < SHORTER * before && stable.met {
                (stable.calm, stable.patience) = (0, 2 * stable.patience);
            } else if !rises {
                longest = longest.min(before);
            }
        }
        (stable.longest, stable.steps, stable.met) = (Some(longest), 0, met);
        stable.loudest = state.work.accelerations;
        Ok(())
    }

    /// The longest step by the modes that power iteration comes to, if that is shorter than `longest`.
    ///
    /// # Errors
    /// As for [`Stepper::answer`].
    fn fastest(
        &mut self,
        explicit: &mut Explicit,
        state: &State,
        dt: f64,
        (iterations, mut longest): (usize, f64),
    ) -> Result<f64, Failure> {
        let damped = dt > 0.0 && self.system.is_damped();
        let mut last = 0.0;
        for _ in 0..iterations {
            let size = self.largest(&explicit.stable.mode);
            if !(size > 0.0 && size.is_finite()) {
                break;
            }
            let small = SMALL * self.length / size;
            self.shift(&explicit.stable, state, [small, 0.0], dt);
            self.answer_difference(explicit, state, small)?;
            let [own, cross, square] = self.mass_products(explicit);
            // |ψ|/|φ| is never below ψ·φ/φ·φ, and both come from below.
            let stiffness = (square / own).sqrt().max(cross / own);
            let mut damping = 0.0;
            explicit.stable.next.copy_from_slice(&explicit.push);
            if damped {
                explicit.stable.next.iter_mut().for_each(|next| *next *= 0.25 * dt);
                self.shift(&explicit.stable, state, [0.0, small], dt);
                self.answer_difference(explicit, state, small)?;
                let [own, cross, _] = self.mass_products(explicit);
                damping = (cross / own).max(0.0);
                explicit.stable.next.iter_mut().zip(&explicit.push).for_each(|(next, push)| *next += push);
            }
            let found = longest_step(stiffness, damping);
            if !found.is_finite() {
                break;
            }
            longest = longest.min(found);
            let size = self.largest(&explicit.stable.next);
            if !(size > 0.0 && size.is_finite()) {
                break;
            }
            let stable = &mut explicit.stable;
            stable.mode.iter_mut().zip(&stable.next).for_each(|(mode, next)| *mode = next / size);
            if (found - last).abs() <= SETTLED * found {
                break;
            }
            last = found;
        }
        Ok(longest)
    }

    /// The residual where the place is moved along the mode, or its velocities are.
    fn shift(&mut self, Stable { place, mode, .. }: &Stable, state: &State, [of_place, of_rate]: [f64; 2], dt: f64) {
        for &node in &self.movers {
            let start = &place[node];
            let d = join(&start.v, &start.omega) + mode[node] * of_rate;
            self.increments[node] = Increment { q: mode[node] * of_place, d, dd: Vec6::zeros() };
            self.trial[node].advance(start, &self.increments[node], RotationUpdate::Exponential);
        }
        self.carry_riders(place);
        let now = Configuration { nodes: &self.trial, history: &state.history, dt: dt };
        self.system.residual(&now, &self.given[2], &mut self.forces);
    }

    /// Accelerations by what the forces have lost since they were noted, over `small`.
    fn answer_difference(&mut self, explicit: &mut Explicit, state: &State, small: f64) -> Result<(), Failure> {
        for (F, base) in self.forces.on_nodes.iter_mut().zip(&explicit.stable.base) {
            F.iter_mut().zip(base).for_each(|(f, base)| *f = (base - *f) / small);
        }
        self.answer(explicit, state, false)
    }

    /// φ·φ, φ·ψ and ψ·ψ in the norm of the masses, φ the mode and ψ what answers it.
    fn mass_products(&mut self, explicit: &mut Explicit) -> [f64; 3] {
        let Explicit { masses, stable, push, room, .. } = explicit;
        let mode = &stable.mode;
        let Some(masses) = masses else {
            self.weigh_together(room, None, |_, node| mode[node]);
            let [own, cross] = [mode, &*push].map(|other| self.times_weighed(|node| other[node]));
            self.weigh_together(room, None, |_, node| push[node]);
            return [own, cross, self.times_weighed(|node| push[node])];
        };
        let mut sums = [0.0; 3];
        for block in &masses.blocks {
            let (a, b) = (&mode[block.node], &push[block.node]);
            for (sum, (a, b)) in sums.iter_mut().zip([(a, a), (a, b), (b, b)]) {
                *sum += block.weigh(&self.trial[block.node], a, b);
            }
        }
        sums
    }

    /// The largest motion, rotations over the model's length.
    fn largest(&self, mode: &[Vec6]) -> f64 {
        let size = |&node: &usize| top(&mode[node]).amax().max(self.length * bottom(&mode[node]).amax());
        self.movers.iter().map(size).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnostic::Source;
    use crate::model;
    use crate::plan::Plan;
    use crate::solve::{Failure, Run, Wanted};
    use crate::system::System;
    use std::sync::atomic::AtomicBool;

    /// Steps that are refused, here by the limit, are not counted.
    #[test]
    fn refused_steps_are_not_counted() {
        let dt = 0.1;
        let text = format!(
            r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = {dt}
[integrator]
scheme = "central-difference"
[[bodies]]
name = "bob"
center = [1.0, 0.0, 0.0]
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[[joints]]
name = "pivot"
kind = "ball"
from = {{ body = "bob", point = [0.0, 0.0, 0.0] }}
to = {{ ground = [0.0, 0.0, 0.0] }}
[[links]]
name = "spring"
from = {{ ground = [1.0, 1.0, 0.0] }}
to = {{ body = "bob" }}
stiffness = 1e4
[output]
interval = 1.0
"#
        );
        let source = Source::new("deck.toml", &text, &[]);
        let (model, problems) = model::read(&source);
        let drawn: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
        let model = model.unwrap_or_else(|| panic!("{}", drawn.join("\n")));
        let system = System::new(&model).unwrap();
        let plan = Plan::new(&model, &system, 1);
        let stop = AtomicBool::new(false);
        let mut run = Run::new(&model, &system, &plan, Wanted::default(), &stop).unwrap();
        let mut state = run.stepper.start().unwrap();
        for _ in 0..2 {
            let failure = run.stepper.step(&mut state, dt).unwrap_err();
            assert!(matches!(failure, Failure::Unstable { .. }), "{failure}");
        }
        let stable = &run.stepper.explicit.as_ref().unwrap().stable;
        assert_eq!((stable.steps, stable.calm, stable.loudest), (0, 0, state.work.accelerations));
    }
}
