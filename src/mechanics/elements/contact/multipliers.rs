//! Multipliers in the place of springs, for load steps: an augmented Lagrangian.
//!
//! A spring under a force is pressed in. The normal force is therefore N = max(0, λ + k δ), with a multiplier λ per point. After each
//! equilibrium λ becomes N, and a new equilibrium is computed. δ falls by the compliance of the spring over that of the bodies, and
//! vanishes in the limit for any k (Uzawa's method; J. C. Simo, T. A. Laursen, Computers & Structures 42 (1992) 97-116). Friction is
//! treated alike: its anchor p₀ − T/k holds the point at the start of the step with the force T so far; the next equilibrium slips by μN or
//! not at all.

use super::force::touch;
use super::history::PairMemoryMut;
use super::kinematics::Contacts;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// Writes the multipliers from the equilibrium `now` into `new`, a copy of the block's history at the start of a step; `start` are the
/// nodes there. Returns the largest error of a depth or displacement over the tolerance.
pub(super) fn augment(contacts: &Contacts, start: &[Node], now: &Configuration, new: &mut [f64]) -> f64 {
    let law = &contacts.law;
    let Some(tolerance) = law.tolerance else { return 0.0 };
    let mut most = 0.0f64;
    for (e, numbers) in new.chunks_exact_mut(contacts.width()).enumerate() {
        let old = contacts.memory(e, now.history);
        let mut new = PairMemoryMut(numbers);
        let touching = touch(contacts, e, now);
        let lift = touching.as_ref().map_or(0.0, |(_, acting)| acting.normal.force / law.stiffness);
        most = most.max((lift - old.lift(law)).abs());
        new.set_lift(law, lift);
        let friction = touching.and_then(|(at, acting)| Some((at.closest.n, acting.friction?)));
        if let Some((n, friction)) = friction {
            let anchor = contacts.kinematics(&contacts.points[e], start).p - friction.T / law.stiffness;
            let moved: Vec3 = anchor - old.anchor();
            most = most.max((moved - n.dot(&moved) * n).norm());
            new.set_anchor(&anchor);
        }
    }
    most / tolerance
}
