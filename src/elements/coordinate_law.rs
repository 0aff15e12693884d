//! What acts along the coordinate q of a joint: a spring, a damper, stops and dry friction, as an effort over q, q̇ and the past.
//!
//! Stops push back as contacts do, with the damping of a set restitution ([`super::contact::restitution`]). Friction is a spring that
//! slips at its limit (return mapping), so what sticks does not creep; a hinge that yields is several of them ([`super::hysteresis`]). Efforts are forces, or moments where the coordinate is an angle;
//! they are positive where they pull the second part back.

use super::contact::restitution::{Loss, normal_force};
use super::hysteresis::Hysteresis;
pub use super::slider::{CoordinateState, DryFriction};

/// The effort over a coordinate, its rate and its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoordinateLaw {
    /// Effort per coordinate.
    pub stiffness: f64,
    /// Coordinate at which the spring is without effort.
    pub rest: f64,
    /// Effort per rate.
    pub damping: f64,
    /// The stops.
    pub stops: Option<Stops>,
    /// Dry friction.
    pub friction: Option<DryFriction>,
    /// What yields.
    pub hysteresis: Option<Hysteresis>,
}

/// Stops at either end of the way of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stops {
    /// The least and the largest coordinate; infinite where there is no stop.
    pub limits: [f64; 2],
    /// Effort per coordinate beyond.
    pub stiffness: f64,
    /// What an impact loses.
    pub loss: Loss,
}

/// Numbers that every joint remembers: coordinate and rate at the end of the last step, the speed of the last landing on a stop, the
/// power that the impact took, and the anchor of friction. Anchors of what yields come after them.
pub const MEMORY: usize = 5;
/// Place of the rate.
pub const RATE: usize = 1;
/// Place of the speed of the last landing.
pub const IMPACT_SPEED: usize = 2;
/// Place of the power of its impact.
pub const IMPACT_POWER: usize = 3;
/// Place of the anchor of friction.
pub const ANCHOR: usize = 4;

impl CoordinateLaw {
    /// A joint on whose coordinate nothing acts: it counts turns.
    pub const FREE: CoordinateLaw =
        CoordinateLaw { stiffness: 0.0, rest: 0.0, damping: 0.0, stops: None, friction: None, hysteresis: None };

    /// The number of history variables.
    pub fn memory(&self) -> usize {
        MEMORY + self.hysteresis.as_ref().map_or(0, Hysteresis::memory)
    }

    /// Effort, derivatives and energy at a coordinate and its rate; `memory` is that of the last step, [`CoordinateLaw::memory`] numbers.
    pub fn at(&self, q: f64, rate: f64, memory: &[f64]) -> CoordinateState {
        let stretch = q - self.rest;
        let mut state = CoordinateState {
            q,
            rate,
            effort: self.stiffness * stretch + self.damping * rate,
            by_q: self.stiffness,
            by_rate: self.damping,
            energy: 0.5 * self.stiffness * stretch * stretch,
            slip: 0.0,
            impact_power: 0.0,
            impact_speed: 0.0,
        };
        if let Some(stops) = &self.stops {
            stops.add(memory, &mut state);
        }
        if let Some(friction) = &self.friction {
            state.slip = friction.add(memory[ANCHOR], &mut state);
        }
        if let Some(hysteresis) = &self.hysteresis {
            hysteresis.add(&memory[MEMORY..], &mut state);
        }
        state
    }
}

impl Stops {
    /// Depth behind the nearer stop, negative before it, and the sign of the way into it.
    fn depth(&self, q: f64) -> (f64, f64) {
        let [low, high] = self.limits;
        if q - high >= low - q { (q - high, 1.0) } else { (low - q, -1.0) }
    }

    fn add(&self, memory: &[f64], state: &mut CoordinateState) {
        let (depth, sign) = self.depth(state.q);
        if depth < 0.0 {
            return;
        }
        let (before, approach) = (self.depth(memory[0]).0, sign * state.rate);
        let landed = if before >= 0.0 { memory[IMPACT_SPEED] } else { sign * memory[RATE] };
        state.impact_speed = landed.max(approach).max(0.0);
        let push = normal_force(self.stiffness, &self.loss, depth, approach, state.impact_speed);
        state.effort += sign * push.force;
        state.by_q += push.by_depth;
        state.by_rate += push.by_rate;
        state.energy += 0.5 * self.stiffness * depth * depth;
        state.impact_power = (push.force - self.stiffness * depth) * approach;
    }
}
