//! Effort along a joint coordinate q: spring, damper, stops and dry friction as a function of q, q̇ and history.
//!
//! Stops push back as contacts do, with the damping of a set restitution ([`super::contact::restitution`]). Friction is a spring that slips
//! at its limit (return mapping), so sticking does not creep. A yielding hinge is one of the laws of [`super::path_law`]. Efforts are
//! forces, or moments for an angle; a positive effort pulls the second part back.

use super::contact::restitution::{Loss, normal_force};
use super::path_law::PathLaw;
pub use super::slider::CoordinateState;
use super::slider::DryFriction;

/// The effort over a coordinate, its rate and its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoordinateLaw {
    /// Effort per coordinate.
    pub stiffness: f64,
    /// Coordinate of the unloaded spring.
    pub rest: f64,
    /// Effort per rate.
    pub damping: f64,
    /// The stops.
    pub stops: Option<Stops>,
    /// Dry friction.
    pub friction: Option<JointFriction>,
    /// Hysteresis of a plastic hinge or yielding damper.
    pub hysteresis: Option<PathLaw>,
}

/// Dry friction, whose limit may grow with the load of the joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFriction {
    /// Slip limit without load.
    pub limit: f64,
    /// Increase of the limit per transverse force of the joint.
    pub per_load: f64,
    /// Displacement at the slip limit.
    pub stick: f64,
}

impl JointFriction {
    /// The spring that slips, under a load.
    pub fn under(&self, load: f64) -> DryFriction {
        let limit = self.limit + self.per_load * load;
        DryFriction { limit, stiffness: limit / self.stick }
    }
}

/// Stops at either end of the way of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stops {
    /// The least and the largest coordinate; infinite where there is no stop.
    pub limits: [f64; 2],
    /// Effort per coordinate beyond.
    pub stiffness: f64,
    /// Energy loss of an impact.
    pub loss: Loss,
}

/// Memory of every joint: coordinate and rate at the end of the last step, speed of the last landing on a stop, impact power, and anchor of
/// friction. The anchors of the hysteresis follow.
pub const MEMORY: usize = 5;
/// Place of the rate.
pub const RATE: usize = 1;
/// Place of the speed of the last landing.
pub const IMPACT_SPEED: usize = 2;
/// Place of the power of its impact.
pub const IMPACT_POWER: usize = 3;
/// Place of the anchor of friction.
pub const ANCHOR: usize = 4;
/// Further memory of joints with load-dependent friction: load and its rate at the end of the last step.
pub const LOAD_MEMORY: usize = 2;

impl CoordinateLaw {
    /// A joint on whose coordinate nothing acts: it counts turns.
    pub const FREE: CoordinateLaw =
        CoordinateLaw { stiffness: 0.0, rest: 0.0, damping: 0.0, stops: None, friction: None, hysteresis: None };

    /// Returns the law with a factor β (time) on its elastic stiffness. Stops and friction are unchanged, because their stiffness only
    /// holds parts.
    pub fn damped_by(self, beta: f64) -> CoordinateLaw {
        let yields = self.hysteresis.as_ref().map_or(0.0, PathLaw::stiffness);
        CoordinateLaw { damping: self.damping + beta * (self.stiffness + yields), ..self }
    }

    /// The number of history variables.
    pub fn memory(&self) -> usize {
        self.end_of_hysteresis() + if self.load_memory().is_some() { LOAD_MEMORY } else { 0 }
    }

    /// Place of the load and its rate among the history variables, where the load counts.
    pub fn load_memory(&self) -> Option<usize> {
        self.friction.filter(|friction| friction.per_load > 0.0).map(|_| self.end_of_hysteresis())
    }

    fn end_of_hysteresis(&self) -> usize {
        MEMORY + self.hysteresis.as_ref().map_or(0, PathLaw::memory)
    }

    /// The spring of friction a time `dt` after the last step, the load going on as it has changed, but not below zero or to more than
    /// twice.
    pub fn friction_after(&self, dt: f64, memory: &[f64]) -> Option<DryFriction> {
        let load = self.load_memory().map_or(0.0, |place| {
            let [load, rate] = [memory[place], memory[place + 1]];
            (load + dt * rate).clamp(0.0, 2.0 * load)
        });
        self.friction.map(|friction| friction.under(load))
    }

    /// Effort, derivatives and energy at a coordinate and its rate, a time `dt` after the last step; `memory` is that of the last step,
    /// [`CoordinateLaw::memory`] numbers.
    pub fn at(&self, q: f64, rate: f64, memory: &[f64], dt: f64) -> CoordinateState {
        let stretch = q - self.rest;
        let mut state = CoordinateState {
            effort: self.stiffness * stretch + self.damping * rate,
            by_q: self.stiffness,
            by_rate: self.damping,
            energy: 0.5 * self.stiffness * stretch * stretch,
            ..CoordinateState::at(q, rate)
        };
        if let Some(stops) = &self.stops {
            stops.add(memory, &mut state);
        }
        if let Some(friction) = self.friction_after(dt, memory) {
            state.slip = friction.add(memory[ANCHOR], &mut state);
        }
        if let Some(hysteresis) = &self.hysteresis {
            hysteresis.add(&memory[MEMORY..], &mut state);
        }
        state
    }

    /// Index of the branch between kinks: the active stop, and the springs that continue to slip at this rate.
    pub fn branch(&self, q: f64, rate: f64, memory: &[f64]) -> usize {
        /// Test distance for slip, as a part of the coordinate or of the sticking distance of friction.
        const AHEAD: f64 = 1e-7;
        let size = q.abs().max(self.friction.map_or(0.0, |friction| friction.stick));
        let ahead = q + AHEAD * size * rate.signum();
        let by_q = CoordinateLaw { stops: None, ..*self }.at(ahead, rate, memory, 0.0).by_q;
        self.stops.map_or(0, |stops| stops.branch(q)).wrapping_add(by_q.to_bits() as usize)
    }
}

impl Stops {
    /// Depth behind the nearer stop, negative before it, and the sign of the way into it.
    fn depth(&self, q: f64) -> (f64, f64) {
        let [low, high] = self.limits;
        if q - high >= low - q { (q - high, 1.0) } else { (low - q, -1.0) }
    }

    /// 1 between the stops, 0 and 2 at them.
    pub fn branch(&self, q: f64) -> usize {
        let [low, high] = self.limits;
        usize::from(q > low) + usize::from(q >= high)
    }

    fn add(&self, memory: &[f64], state: &mut CoordinateState) {
        let (depth, sign) = self.depth(state.q);
        if depth < 0.0 {
            return;
        }
        let (before, approach) = (self.depth(memory[0]).0, sign * state.rate);
        let landed = if before >= 0.0 { memory[IMPACT_SPEED] } else { sign * memory[RATE] };
        state.impact_speed = landed.max(approach).max(0.0);
        let push = normal_force(self.stiffness, &self.loss, depth, 0.0, approach, state.impact_speed);
        state.effort += sign * push.force;
        state.by_q += push.by_depth;
        state.by_rate += push.by_rate;
        state.energy += 0.5 * self.stiffness * depth * depth;
        state.impact_power = (push.force - self.stiffness * depth) * approach;
    }
}
