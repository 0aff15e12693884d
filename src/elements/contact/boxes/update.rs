//! The history of a pair at the end of a step, and what was dissipated on the way.

use super::memory::Memory;
use super::pair::{BoxPairs, PairForce, PairKinematics};
use crate::elements::contact::history::{PointHistory, PointHistoryMut};
use crate::elements::contact::update::impact;
use crate::materials::Dissipation;
use crate::math::rotation::{exp, matrix};
use crate::math::{Vec3, angular, linear};
use crate::state::Configuration;

/// Writes the history of pair `e` after `part` of the way from the last state to `now`; returns what was dissipated.
pub(super) fn update_pair(
    pairs: &BoxPairs,
    e: usize,
    now: &Configuration,
    part: f64,
    numbers: &mut [f64],
) -> Dissipation {
    let (law, old) = (&pairs.law, pairs.history(e, now.history));
    let rubs = law.friction > 0.0;
    let mut spent = Dissipation::default();
    let at = pairs.kinematics(e, now.nodes);
    let dt = part * now.dt;
    let speed = linear(&at.rates).norm() + angular(&at.rates).norm() * at.pose.own.norm();
    // The boxes could meet in this time at twice their speed.
    let safe = |gap: f64| if law.dynamic && gap > law.near { 0.5 * gap / speed } else { 0.0 };
    let far = safe(at.pose.y.norm() - at.pose.size());
    let mut new = PointHistoryMut::new(numbers);
    if far > 4.0 * now.dt && now.dt > 0.0 && old.impact_speed() == 0.0 {
        new.set_far(far);
        let pull = if rubs { old.friction_force() } else { 0.0 };
        spent.friction = 0.5 * pull * pull / law.stiffness;
        return spent;
    }
    let known = old.is_known();
    // A pair that is not known has no last state to come from.
    let beyond = (part - 1.0) * now.dt;
    let part = if known { part } else { 1.0 };
    let toward = |old: f64, now: f64| old + part * (now - old);
    let acting = pairs.force(&at, old);
    let (gap, rate) = acting.as_ref().map_or_else(|| approach(&at), |acting| (-acting.depth.D, acting.rate));
    let end_gap = if known { toward(old.gap(), gap) } else { gap - rate * beyond };
    new.set_motion(end_gap, toward(old.rate(), rate), safe(end_gap));
    new.set_impact(impact(law.duration, (gap, rate), dt, old, new.read()));
    let force = acting.as_ref().map_or(0.0, |acting| acting.normal.force);
    let power = if gap < 0.0 { (force + law.stiffness * gap) * rate } else { 0.0 };
    new.set_damping_power(toward(old.damping_power(), power));
    spent.impact = 0.5 * dt * (old.damping_power() + new.read().damping_power());
    if rubs {
        spent.friction = update_friction((&at, acting.as_ref()), law.stiffness, part, old, &mut new);
    }
    spent
}

/// Gap and approach speed of boxes that are apart.
fn approach(at: &PairKinematics) -> (f64, f64) {
    let least = at.pose.least_axis();
    let arm = at.pose.deepest(&least.axis) - at.pose.y;
    (least.gap, -least.axis.dot(&(linear(&at.rates) + angular(&at.rates).cross(&arm))))
}

/// Writes what friction remembers; returns what slip dissipated.
fn update_friction(
    (at, acting): (&PairKinematics, Option<&PairForce>),
    stiffness: f64,
    part: f64,
    old: PointHistory,
    new: &mut PointHistoryMut,
) -> f64 {
    let last = Memory::read(old);
    let pull = old.friction_force();
    let rubbing = acting.and_then(|acting| acting.rubbing.as_ref());
    let (stretch, twist, spent) = match rubbing {
        Some(rubbing) => {
            let end = pull + part * (rubbing.pull - pull);
            new.set_friction_force(end);
            (rubbing.stretch, rubbing.twist, 0.5 * part * rubbing.slip * (pull + end))
        }
        // The boxes are apart: what was stretched lets go.
        None => (Vec3::zeros(), 0.0, 0.5 * pull * pull / stiffness),
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
    kept.write(new.numbers());
    spent
}
