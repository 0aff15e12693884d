//! Multipliers in the place of springs, for load steps: an augmented Lagrangian.
//!
//! A spring under a force is pressed in. The normal force is therefore N = max(0, λ + k δ), with a number λ of the point's own, and
//! after each equilibrium λ becomes N and a new equilibrium is looked for: δ falls by the ratio of the compliance of the spring to that
//! of all that is pressed, and vanishes in the limit, whatever k is (Uzawa's method; J. C. Simo, T. A. Laursen, Computers & Structures
//! 42 (1992) 97-116). Friction likewise: its spring is anchored where the force T found so far holds the point where the step began,
//! p₀ − T/k, and the next equilibrium slips as far as μN demands, or not at all.

use super::force::touch;
use super::history::PairMemoryMut;
use super::kinematics::Contacts;
use crate::state::{Configuration, Node};
use base::math::Vec3;

/// Writes into `new`, a copy of the block's history at the start of a step, multipliers by the forces in the equilibrium `now`; `start`
/// are the nodes at the start of the step. Returns the largest length by which one was out, over the tolerance.
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
