//! The history of a pair at the end of a step, and what was dissipated on the way.

use super::memory::Memory;
use super::pair::{ConvexPair, PairForce, PairKinematics};
use super::touch::approaching;
use crate::elements::contact::history::{PointHistory, PointHistoryMut};
use crate::elements::contact::normal_motion::{NormalMotion, damping_power, pass_over, update_normal, way};
use crate::materials::Dissipation;
use crate::state::Configuration;
use base::math::rotation::{exp, matrix};
use base::math::{Vec3, angular, linear};

/// Writes the history of a pair after `part` of the way from the last state to `now`; returns what was dissipated.
pub(super) fn update_pair(
    pair: &ConvexPair,
    old: PointHistory,
    now: &Configuration,
    part: f64,
    numbers: &mut [f64],
) -> Dissipation {
    let law = pair.law;
    let at = pair.kinematics(now.nodes);
    let speed = linear(&at.rates).norm() + angular(&at.rates).norm() * at.pose.own.reach();
    let mut new = PointHistoryMut::new(numbers);
    if let Some(spent) = pass_over(law, (at.pose.apart(), speed), now, old, &mut new) {
        return spent;
    }
    let acting = pair.force(&at, old);
    let (gap, rate) =
        acting.as_ref().map_or_else(|| approach(&at), |acting| (acting.inset - acting.depth.D, acting.rate));
    let force = acting.as_ref().map_or(0.0, |acting| acting.normal.force);
    let inset = acting.as_ref().map_or(0.0, |acting| acting.inset);
    let motion = NormalMotion { gap, inset, rate, power: damping_power(law, gap, rate, force), speed };
    let (impact, inset) = update_normal(law, &motion, now, part, old, &mut new);
    let mut spent = Dissipation { impact, ..Dissipation::default() };
    new.set_inset(law.keeps_inset(), inset);
    if law.friction > 0.0 {
        spent.friction =
            update_friction((&at, acting.as_ref()), (law.stiffness, now.dt), way(old, part), old, &mut new);
    }
    spent
}

/// Gap and approach speed of what is apart, in the measure of the depth that it will have: where an edge or a corner comes first, a depth is
/// less than the way along the axis, and so is its rate, by which an impact is judged.
fn approach(at: &PairKinematics) -> (f64, f64) {
    let ahead = approaching(&at.pose);
    (-ahead.D, ahead.g.dot(&at.rates))
}

/// Writes what friction remembers; returns what slip dissipated.
fn update_friction(
    (at, acting): (&PairKinematics, Option<&PairForce>),
    (stiffness, dt): (f64, f64),
    part: f64,
    old: PointHistory,
    new: &mut PointHistoryMut,
) -> f64 {
    let last = Memory::read(old);
    let pull = old.friction_force();
    let rubbing = acting.and_then(|acting| acting.rubbing.as_ref());
    let mut slip_speed = 0.0;
    let (stretch, twist, spent) = match rubbing {
        Some(rubbing) => {
            let end = pull + part * (rubbing.pull - pull);
            new.set_friction_force(end);
            slip_speed = if dt > 0.0 { rubbing.slip / dt } else { last.slip_speed };
            (rubbing.stretch, rubbing.twist, 0.5 * part * rubbing.slip * (pull + end))
        }
        // The two are apart: what was stretched lets go.
        None => {
            new.set_friction_force(0.0);
            (Vec3::zeros(), 0.0, 0.5 * pull * pull / stiffness)
        }
    };
    let mut kept = Memory { stretch, twist, slip_speed, y: at.pose.y, Q: at.pose.Q };
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
