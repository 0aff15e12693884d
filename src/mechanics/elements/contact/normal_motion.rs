//! The motion of a point, or of a pair of convex solids, along the normal: how its history goes on from the last state.

use super::history::{PairMemory, PairMemoryMut};
use super::law::ContactLaw;
use super::restitution::{NormalForce, normal_force, taken_over};
use crate::materials::Dissipation;
use crate::state::Configuration;

impl ContactLaw {
    /// The normal force of a spring that begins at a depth `inset` and is pressed in by a `depth`, of a pair with this memory.
    #[inline]
    pub(super) fn press(&self, depth: f64, inset: f64, rate: f64, old: PairMemory) -> NormalForce {
        let speed = match old.is_known() {
            true if old.gap() <= 0.0 => old.impact_speed().max(rate),
            // A body pressed from rest is faster now than in the last state.
            true => old.rate().max(rate),
            false => rate,
        };
        normal_force(self.stiffness, &self.loss, depth, inset, rate, speed)
    }

    /// True where a pair apart at the last state lands in a step of length `dt`, too long for the impact: see [`ContactLaw::resolution`].
    pub(super) fn lands_unresolved(&self, old: PairMemory, depth: f64, dt: f64) -> bool {
        let fast = 3.0 * self.floor;
        dt > self.resolution && (!old.is_known() || old.rate() > fast || depth > fast * 2.0 * self.resolution)
    }
}

/// The motion along the normal at the instant of equilibrium.
pub(super) struct NormalMotion {
    /// The gap, negative where the spring is pressed in.
    pub gap: f64,
    /// The starting depth of the spring.
    pub inset: f64,
    /// The approach speed δ̇.
    pub rate: f64,
    /// The power of damping, by [`damping_power`].
    pub power: f64,
    /// An upper bound of the approach speed in any direction.
    pub speed: f64,
}

/// The power of damping under a normal force.
pub(super) fn damping_power(law: &ContactLaw, gap: f64, rate: f64, force: f64) -> f64 {
    if gap < 0.0 { (force + law.stiffness * gap) * rate } else { 0.0 }
}

/// A time too short for the gap to close at twice the speed; 0 in statics and for small gaps.
pub(super) fn safe_time(law: &ContactLaw, gap: f64, speed: f64) -> f64 {
    if law.dynamic && gap > law.near { 0.5 * gap / speed } else { 0.0 }
}

/// Skips a pair that cannot touch for some steps; `distance` is a lower bound of its gap. Its memory then holds only the time until the
/// next test. Returns the dissipation; `None` if the pair must be computed.
pub(super) fn pass_over(
    law: &ContactLaw,
    (distance, speed): (f64, f64),
    now: &Configuration,
    old: PairMemory,
    new: &mut PairMemoryMut,
) -> Option<Dissipation> {
    let far = safe_time(law, distance, speed);
    if !(far > 4.0 * now.dt && now.dt > 0.0 && old.impact_speed() == 0.0) {
        return None;
    }
    new.set_far(far);
    Some(Dissipation { friction: let_go(law, old), ..Dissipation::default() })
}

/// The energy of the spring of friction, which lets go. Multipliers store none.
pub(super) fn let_go(law: &ContactLaw, old: PairMemory) -> f64 {
    if law.friction == 0.0 || law.tolerance.is_some() {
        return 0.0;
    }
    let pull = old.friction_force();
    0.5 * pull * (pull / law.stiffness)
}

/// Energy lost by a forgotten pair: the friction spring is released, and damping ends.
pub(super) fn lost(law: &ContactLaw, old: PairMemory, way: f64) -> Dissipation {
    let impact = 0.5 * way * old.damping_power();
    Dissipation { friction: let_go(law, old), impact, ..Dissipation::default() }
}

/// Writes the friction force and the slip speed after `part` of the way from the last state; its end has the force `pull` and the slip
/// `slip`, a time `dt` later. Returns the dissipation of slip that began under the force `begin`.
pub(super) fn update_slip(
    [pull, slip, begin]: [f64; 3],
    (dt, part): (f64, f64),
    old: PairMemory,
    new: &mut PairMemoryMut,
) -> f64 {
    let end = old.friction_force() + part * (pull - old.friction_force());
    new.set_friction_force(end);
    new.set_slip_speed(if dt > 0.0 { slip / dt } else { old.slip_speed() });
    0.5 * part * slip * (begin + end)
}

/// The fraction of the way from the last state to the instant of equilibrium at the end of the step. An unknown pair has no last state: its
/// fraction is 1.
pub(super) fn way(old: PairMemory, part: f64) -> f64 {
    if old.is_known() { part } else { 1.0 }
}

/// The friction force at the start of slip: the limit at the last state, or the force there if that was larger.
pub(super) fn slip_begin(law: &ContactLaw, old: PairMemory) -> f64 {
    let depth = old.lift(law) - old.gap();
    // A pair apart has no normal force, though its damping alone would give one.
    if depth <= 0.0 {
        return old.friction_force();
    }
    let inset = old.inset(law).max(0.0);
    let pressed = normal_force(law.stiffness, &law.loss, depth, inset, old.rate(), old.impact_speed()).force;
    old.friction_force().max(law.friction_at(old.slip_speed()) * pressed)
}

/// Writes the normal motion, the impact and its damping power after `part` of the way from the last state to `now`. Returns the dissipation
/// of the impact and the new starting depth of the spring.
pub(super) fn update_normal(
    law: &ContactLaw,
    at: &NormalMotion,
    now: &Configuration,
    part: f64,
    old: PairMemory,
    new: &mut PairMemoryMut,
) -> (f64, f64) {
    let &NormalMotion { gap, inset, rate, power, speed } = at;
    let dt = part * now.dt;
    let beyond = (part - 1.0) * now.dt;
    let way = way(old, part);
    let toward = |old: f64, now: f64| old + way * (now - old);
    let end_gap = if old.is_known() { toward(old.gap(), gap) } else { gap - rate * beyond };
    new.set_motion(end_gap, toward(old.rate(), rate), safe_time(law, end_gap, speed));
    let (impact_speed, age) = impact(law.duration, (gap, rate), dt, old, new.read());
    new.set_impact_speed(impact_speed);
    new.set_age(age);
    new.set_damping_power(toward(old.damping_power(), power));
    let damped = 0.5 * dt * (old.damping_power() + new.read().damping_power());
    if !law.keeps_inset() {
        return (damped, inset);
    }
    let before = if old.is_known() { -old.gap() } else { 0.0 };
    let depth = -new.read().gap();
    if depth <= 0.0 {
        // A point on its way out can turn round and touch before the old start of the spring, so the gap is to the turning point.
        let left = (inset + depth).max(0.0);
        new.set_safe_time(safe_time(law, end_gap - (inset - left), speed));
        return (damped, left);
    }
    let kept = taken_over(&law.loss, (before, depth), inset, new.read().impact_speed(), dt);
    new.set_gap(-kept);
    // The acceleration found with the whole spring acts on in the next step: the reduction of the spring force counts as damping power.
    let left = law.stiffness * (depth - kept) * new.read().rate();
    new.set_damping_power(new.read().damping_power() + left);
    (damped + 0.5 * dt * left, inset + depth - kept)
}

/// The impact speed and the age to come. `gap` and `rate` are those at the instant of equilibrium; `new` has those at the end
/// of the step.
fn impact(duration: f64, (gap, rate): (f64, f64), dt: f64, old: PairMemory, new: PairMemory) -> (f64, f64) {
    let known = old.is_known();
    let touches = new.gap() <= 0.0;
    let touched = known && old.gap() <= 0.0;
    match (touches, touched) {
        // The impact speed is the approach speed at zero gap, interpolated linearly.
        (true, false) if known => {
            let closed = old.gap() / (old.gap() - gap);
            ((old.rate() + closed * (rate - old.rate())).max(0.0), 0.0)
        }
        (true, false) => (rate.max(0.0), 0.0),
        // A point pressed by a force may be faster than at its landing.
        (true, true) => (old.impact_speed().max(new.rate()), old.age() + dt),
        (false, true) => (old.impact_speed(), 0.0),
        // The point touched at the instant of equilibrium: the acceleration of that is carried on.
        (false, false) if gap <= 0.0 => (old.rate().max(rate).max(0.0), 0.0),
        // The impact ends once its acceleration no longer affects the integration scheme.
        (false, false) if old.age() + dt < duration => (old.impact_speed(), old.age() + dt),
        (false, false) => (0.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::contact::history::FRICTION_FORCE;
    use crate::elements::contact::restitution::Loss;

    /// A point leaving a surface with restitution 0 touches again at the new start of its spring. At twice its speed it stays short of that
    /// point within the safe time.
    #[test]
    fn what_comes_out_is_safe_no_longer_than_on_the_way_to_where_it_turns_round() {
        let loss = Loss::Whole { floor: 1e-3 };
        let law = ContactLaw {
            stiffness: 1e4,
            loss,
            friction: 0.0,
            kinetic: 0.0,
            decay: f64::INFINITY,
            floor: 1e-3,
            resolution: f64::INFINITY,
            duration: 0.1,
            near: 0.01,
            touching: 0.0,
            tolerance: None,
            dynamic: true,
        };
        let (dt, before) = (1e-3, [0.0, 1.0, -0.02, 1.0, 1.0, 0.0, 0.0, 0.05, 0.0]);
        assert_eq!(before.len(), FRICTION_FORCE);
        // The inset before, and the gap to where the spring began: inside still, out by a trace, by the near distance, and far.
        for (inset, gap) in [(0.05, 0.03), (0.05, 0.0505), (0.02, 0.028), (0.02, 0.045), (1e-6, 0.5), (0.0, 0.03)] {
            let (speed, mut numbers) = (0.25, before);
            let mut new = PairMemoryMut(&mut numbers);
            let motion = NormalMotion { gap, inset, rate: -speed, power: 0.0, speed };
            let now = Configuration { nodes: &[], history: &[], dt, previous: None };
            let (_, left) = update_normal(&law, &motion, &now, 1.0, PairMemory(&before), &mut new);
            // Outside the surface by this: the spring begins a depth `left` inside.
            let (outside, safe) = (gap - inset, new.read().safe_time());
            // Rounding of sums of this size alone.
            assert!((left - (-outside).max(0.0)).abs() < 1e-15, "{inset} {gap}: {left}");
            assert!(2.0 * speed * safe <= outside + left + 1e-15, "{inset} {gap}: {safe}");
            // Far points are still passed over.
            assert_eq!(safe > 0.0, outside > law.near, "{inset} {gap}: {safe}");
        }
    }
}
