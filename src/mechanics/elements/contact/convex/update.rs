//! The history of a pair at the end of a step, and the energy dissipated in it.

use super::memory::Memory;
use super::pair::{ConvexPair, PairForce, PairKinematics};
use super::pose::LeastAxis;
use super::touch::{approaching, gap_along};
use crate::elements::contact::history::{PairMemory, PairMemoryMut};
use crate::elements::contact::law::ContactLaw;
use crate::elements::contact::normal_motion::{
    NormalMotion, damping_power, let_go, pass_over, update_normal, update_slip, way,
};
use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::rotation::{exp, matrix};
use base::math::{Vec3, angular, linear};

/// Pairs that cannot land within this number of steps approach along the axis.
const STEPS_AHEAD: f64 = 8.0;

/// Writes the history of a pair, at `at` in `now`, after `part` of the way from the last state; returns the dissipation.
pub(super) fn update_pair(
    pair: &ConvexPair,
    at: &PairKinematics,
    old: PairMemory,
    now: &Configuration,
    part: f64,
    numbers: &mut [f64],
) -> Dissipation {
    if let Some(spent) = pass_over(pair.law, (at.pose.apart(), speed(at)), now, old, &mut PairMemoryMut(numbers)) {
        return spent;
    }
    let least = at.pose.least_axis();
    let acting = pair.force_along(&least, at, old);
    update_near((pair.law, at, &least), acting.as_ref(), old, now, part, numbers)
}

/// As [`update_pair`] for a pair that is near, by the axis of the largest gap and the force at `at`.
pub(super) fn update_near(
    (law, at, least): (&ContactLaw, &PairKinematics, &LeastAxis),
    acting: Option<&PairForce>,
    old: PairMemory,
    now: &Configuration,
    part: f64,
    numbers: &mut [f64],
) -> Dissipation {
    let (mut new, speed) = (PairMemoryMut(numbers), speed(at));
    // The last state before a landing counts. Where a state is a part of the way, states before leave traces in it.
    let ahead = STEPS_AHEAD * speed * now.dt;
    let is_far = law.dynamic && part == 1.0 && ahead > 0.0 && least.gap > ahead;
    let (gap, rate) = match acting {
        Some(acting) => (acting.inset - acting.depth.D, acting.rate),
        None => approach(at, least, is_far),
    };
    let force = acting.map_or(0.0, |acting| acting.normal.force);
    let inset = acting.map_or(0.0, |acting| acting.inset);
    let motion = NormalMotion { gap, inset, rate, power: damping_power(law, gap, rate, force), speed };
    let (impact, inset) = update_normal(law, &motion, now, part, old, &mut new);
    let mut spent = Dissipation { impact, ..Dissipation::default() };
    new.set_inset(law, inset);
    if law.friction > 0.0 {
        spent.friction = update_friction((at, acting), (law, now.dt), way(old, part), old, &mut new);
    }
    spent
}

/// Gap and approach speed of solids apart, on the scale of their depth unless they are far. Where an edge or a corner touches first, the
/// depth and its rate are less than the motion along the axis.
fn approach(at: &PairKinematics, least: &LeastAxis, is_far: bool) -> (f64, f64) {
    let ahead = if is_far { gap_along(&at.pose, least) } else { approaching(&at.pose, least) };
    (-ahead.D, ahead.g.dot(&at.rates))
}

/// An upper bound of the speed of approach.
fn speed(at: &PairKinematics) -> f64 {
    linear(&at.rates).norm() + angular(&at.rates).norm() * at.pose.own.reach()
}

/// Writes the memory of friction; returns the dissipation of slip.
fn update_friction(
    (at, acting): (&PairKinematics, Option<&PairForce>),
    (law, dt): (&ContactLaw, f64),
    part: f64,
    old: PairMemory,
    new: &mut PairMemoryMut,
) -> f64 {
    let last = Memory::read(old);
    let rubbing = acting.and_then(|acting| acting.rubbing.as_ref());
    let (stretch, twist, spent) = match rubbing {
        Some(rubbing) => {
            let slipped = [rubbing.pull, rubbing.slip, old.friction_force()];
            (rubbing.stretch, rubbing.twist, update_slip(slipped, (dt, part), old, new))
        }
        // The two are apart: the friction spring is released.
        None => {
            new.set_friction_force(0.0);
            new.set_slip_speed(0.0);
            (Vec3::zeros(), 0.0, let_go(law, old))
        }
    };
    let mut kept = Memory { stretch, twist, y: at.pose.y, Q: at.pose.Q };
    if old.is_known() && rubbing.is_some() {
        kept.stretch = last.stretch + part * (stretch - last.stretch);
        kept.twist = last.twist + part * (twist - last.twist);
    }
    if old.is_known() {
        kept.y = last.y + part * (at.pose.y - last.y);
        kept.Q = matrix(&exp(&(part * last.turned(&at.pose.Q)))) * last.Q;
    }
    kept.write(new.0);
    spent
}
