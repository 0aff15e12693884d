//! Springs, dampers, stops and friction along the coordinates of joints, in the equation of motion. The coordinate q is the gap of the
//! equation that would lock the joint. Its gradient G distributes the effort f to the nodes: force Gᵀ f, stiffness Gᵀ (∂f/∂q) G + f ∂²q,
//! and action equals reaction.
//!
//! Angles are counted over full turns: the nearest to the angle extrapolated from the end of the last step with the mean of the rates. The
//! extrapolation may err by half a turn. The angle of a drive is nearest to its prescribed value.

use base::math::{Mat3, Vec3, Vec6, angular, linear, stack};
use mechanics::constraints::joint::{ConstraintEquation, Drive};
use mechanics::elements::contact::restitution::Loss;
use mechanics::elements::coordinate_law::{
    ANCHOR, CoordinateLaw, CoordinateState, IMPACT_POWER, IMPACT_SPEED, MEMORY, RATE,
};
use mechanics::elements::memories::places;
use mechanics::elements::slip::{Sliding, Slip};
use mechanics::elements::{Branches, Elements, Force, Mechanics, Moduli, Results, subtract};
use mechanics::materials::Dissipation;
use mechanics::state::{Configuration, Node};
use std::ops::Range;

/// The laws along the coordinate of one joint.
#[derive(Debug, Clone)]
pub struct CoordinateSpring {
    /// The two nodes.
    pub nodes: [usize; 2],
    /// The equation that would lock the joint.
    pub lock: ConstraintEquation,
    /// Its laws.
    pub law: CoordinateLaw,
    /// The drive of the joint.
    pub drive: Option<Drive>,
}

impl CoordinateSpring {
    /// Coordinate and effort; `memory` is the history of the last step, `dt` the time since then.
    pub fn state(&self, nodes: &[Node], memory: &[f64], dt: f64) -> CoordinateState {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        let [q, rate, _] = self.lock.gap(a, b);
        let expected = match &self.drive {
            Some(drive) => drive.coordinate(nodes),
            None => memory[0] + 0.5 * dt * (memory[RATE] + rate),
        };
        let off = q - expected;
        // Nothing is lost where there are no turns to count.
        self.law.at(q + (self.lock.nearest(off) - off), rate, memory, dt)
    }

    fn gradient(&self, nodes: &[Node]) -> [Vec6; 2] {
        let [a, b] = self.nodes.map(|n| &nodes[n]);
        self.lock.gradient(a, b)
    }
}

/// A group of them.
pub struct CoordinateSprings {
    springs: Vec<CoordinateSpring>,
    /// The history variables of each.
    memories: Vec<Range<usize>>,
}

impl CoordinateSprings {
    /// A group of these.
    pub fn new(springs: Vec<CoordinateSpring>) -> CoordinateSprings {
        let memories = places(springs.iter().map(|spring| spring.law.memory()));
        CoordinateSprings { springs, memories }
    }

    fn states<'a>(
        &'a self,
        now: &'a Configuration,
    ) -> impl Iterator<Item = (&'a CoordinateSpring, CoordinateState)> + 'a {
        let memories = self.memories.iter().filter_map(|memory| now.history.get(memory.clone()));
        self.springs.iter().zip(memories).map(|(spring, memory)| (spring, spring.state(now.nodes, memory, now.dt)))
    }
}

impl Sliding for CoordinateSprings {
    fn has_friction(&self, e: usize) -> bool {
        self.springs[e].law.friction.is_some()
    }

    fn slip(&self, e: usize, histories: [&[f64]; 2], _dt: f64) -> Slip {
        let [old, new] = histories.map(|history| &history[self.memories[e].clone()]);
        let friction = self.springs[e].law.friction_after(0.0, new);
        let pull = friction.map_or(0.0, |friction| friction.stiffness * friction.stretch(new[0], new[ANCHOR]).0.abs());
        let way = Vec3::new(new[ANCHOR] - old[ANCHOR], 0.0, 0.0);
        Slip {
            way,
            pull,
            stiffness: friction.map_or(0.0, |friction| friction.stiffness),
            touches: true,
            ..Slip::default()
        }
    }
}

impl Elements for CoordinateSprings {
    fn len(&self) -> usize {
        self.springs.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.springs[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, e: usize, node: usize) -> bool {
        self.springs[e].lock.reach()[node][3..].contains(&true)
    }

    fn sliding(&self) -> Option<&dyn Sliding> {
        Some(self)
    }
}

impl Mechanics for CoordinateSprings {
    fn is_damped(&self) -> bool {
        // An impact dissipates energy through the rate.
        let loses = |law: &CoordinateLaw| law.stops.as_ref().is_some_and(|stops| stops.loss != Loss::None);
        self.springs.iter().any(|spring| spring.law.damping > 0.0 || loses(&spring.law))
    }

    fn history(&self) -> usize {
        self.memories.last().map_or(0, |last| last.end)
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut lost = Dissipation::default();
        for ((spring, at), memory) in self.states(now).zip(&self.memories) {
            let (old, new) = (&now.history[memory.clone()], &mut new[memory.clone()]);
            let toward = |old: f64, now: f64| old + part * (now - old);
            new[0] = toward(old[0], at.q);
            new[RATE] = toward(old[RATE], at.rate);
            new[IMPACT_SPEED] = at.impact_speed;
            new[IMPACT_POWER] = toward(old[IMPACT_POWER], at.impact_power);
            new[ANCHOR] = old[ANCHOR] + part * at.slip;
            lost.impact += 0.5 * part * now.dt * (old[IMPACT_POWER] + new[IMPACT_POWER]);
            if let (Some(before), Some(friction)) =
                (spring.law.friction_after(0.0, old), spring.law.friction_after(now.dt, old))
            {
                lost.friction += part * 0.5 * (before.limit + friction.limit) * at.slip.abs();
                // A sticking spring changes its stiffness with the load at constant stretch.
                let stretch = friction.stretch(old[0], old[ANCHOR]).0;
                lost.friction += 0.5 * part * (before.stiffness - friction.stiffness) * stretch * stretch;
            }
            new[MEMORY..].copy_from_slice(&old[MEMORY..]);
            if let Some(hysteresis) = &spring.law.hysteresis {
                lost.plastic += hysteresis.follow(at.q, part, &mut new[MEMORY..]);
            }
        }
        lost
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for (spring, at) in self.states(now).filter(|(_, at)| at.effort != 0.0) {
            for (node, G) in spring.nodes.into_iter().zip(spring.gradient(now.nodes)) {
                subtract(&mut F[node], 0, &(at.effort * linear(&G)));
                subtract(&mut F[node], 3, &(at.effort * angular(&G)));
            }
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        let spring = &self.springs[e];
        let at = spring.state(now.nodes, &now.history[self.memories[e].clone()], now.dt);
        let [a, b] = spring.nodes.map(|n| &now.nodes[n]);
        let ([Ga, Gb], w) = (spring.gradient(now.nodes), [stack(&a.v, &a.omega), stack(&b.v, &b.omega)]);
        let G = |i: usize| if i < 6 { Ga[i] } else { Gb[i - 6] };
        let w = |i: usize| if i < 6 { w[0][i] } else { w[1][i - 6] };
        for i in 0..12 {
            for j in 0..12 {
                K[12 * i + j] = (at.by_q + rate_weight * at.by_rate) * G(i) * G(j);
            }
        }
        // ∂q̇/∂(x, θ) = wᵀ ∂²q, w the velocities.
        let mut rate_by = [0.0; 12];
        spring.lock.stiffness(a, b, 1.0, |row, column, block: Mat3| {
            for i in 0..3 {
                for j in 0..3 {
                    K[12 * (3 * row + i) + 3 * column + j] += at.effort * block[(i, j)];
                    rate_by[3 * column + j] += w(3 * row + i) * block[(i, j)];
                }
            }
        });
        if at.by_rate != 0.0 {
            for i in 0..12 {
                for (j, by) in rate_by.iter().enumerate() {
                    K[12 * i + j] += at.by_rate * G(i) * by;
                }
            }
        }
    }
}

impl Results for CoordinateSprings {
    fn energy(&self, now: &Configuration) -> f64 {
        self.states(now).map(|(_, at)| at.energy).sum()
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        self.states(now).map(|(spring, at)| spring.law.damping * at.rate * at.rate).sum()
    }
}

impl Branches for CoordinateSprings {
    fn has_kinks(&self) -> bool {
        let has = |law: &CoordinateLaw| law.stops.is_some() || law.friction.is_some() || law.hysteresis.is_some();
        self.springs.iter().any(|spring| has(&spring.law))
    }

    fn branches(&self, now: &Configuration) -> usize {
        let memories = self.memories.iter().filter_map(|memory| now.history.get(memory.clone()));
        let states = self.states(now).zip(memories);
        states.fold(0, |sum, ((spring, at), memory)| sum.wrapping_add(spring.law.branch(at.q, at.rate, memory)))
    }
}
