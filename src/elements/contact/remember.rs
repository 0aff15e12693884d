//! A step of what a point remembers, and what was spent on the way.

use super::action::Action;
use super::{Contacts, Meeting, Point, past};
use crate::materials::Dissipation;
use crate::math::Vec3;
use crate::math::rotation::{self, renormalise};
use crate::state::Configuration;

impl Contacts {
    /// `part` of the way from the last state to `now`.
    pub(super) fn remember_point(
        &self,
        point: &Point,
        now: &Configuration,
        part: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Dissipation {
        let (law, mut spent) = (&self.law, Dissipation::default());
        let dt = part * now.dt;
        let (d, w) = self.relative(point, now.nodes);
        let speed = w.norm();
        // How soon it could come here at twice its speed.
        let safe = |gap: f64| if law.dynamic && gap > law.near { 0.5 * gap / speed } else { 0.0 };
        let far = safe(d.norm() - self.reach() - point.radius);
        if far > 4.0 * now.dt && now.dt > 0.0 && old[past::SPEED] == 0.0 {
            new.fill(0.0);
            new[past::SAFE] = far;
            let pull = if law.friction > 0.0 { old[past::PULL] } else { 0.0 };
            spent.friction = 0.5 * pull * pull / law.stiffness;
            return spent;
        }
        let known = old[past::KNOWN] > 0.0;
        // What is not known has no past to come from.
        let beyond = (part - 1.0) * now.dt;
        let part = if known { part } else { 1.0 };
        let toward = |old: f64, now: f64| old + part * (now - old);
        let meeting = self.meet(point, now.nodes);
        let (gap, rate) = (meeting.gap, meeting.rate());
        let action = (gap <= 0.0).then(|| self.act(point, &meeting, old, now.nodes));
        let force = action.as_ref().map_or(0.0, |action| action.push.force);
        new[past::KNOWN] = 1.0;
        new[past::GAP] = if known { toward(old[past::GAP], gap) } else { gap - rate * beyond };
        new[past::RATE] = toward(old[past::RATE], rate);
        new[past::SAFE] = safe(new[past::GAP]);
        (new[past::SPEED], new[past::AGE]) = self.landing(gap, rate, dt, old, new);
        let power = if gap < 0.0 { (force + law.stiffness * gap) * rate } else { 0.0 };
        new[past::POWER] = toward(old[past::POWER], power);
        spent.impact = 0.5 * dt * (old[past::POWER] + new[past::POWER]);
        if law.friction > 0.0 {
            spent.friction = self.remember_friction(point, (&meeting, action.as_ref()), now, part, old, new);
        }
        spent
    }

    /// [`past::SPEED`] and [`past::AGE`] to come. `gap` and `rate` are those at the instant of equilibrium; `new` has those at
    /// the end of the step.
    fn landing(&self, gap: f64, rate: f64, dt: f64, old: &[f64], new: &[f64]) -> (f64, f64) {
        let known = old[past::KNOWN] > 0.0;
        let touches = new[past::GAP] <= 0.0;
        let touched = known && old[past::GAP] <= 0.0;
        match (touches, touched) {
            // The approach speed where the gap closed, on a straight line.
            (true, false) if known => {
                let closed = old[past::GAP] / (old[past::GAP] - gap);
                ((old[past::RATE] + closed * (rate - old[past::RATE])).max(0.0), 0.0)
            }
            (true, false) => (rate.max(0.0), 0.0),
            // Faster than at the landing where something presses.
            (true, true) => (old[past::SPEED].max(new[past::RATE]), old[past::AGE] + dt),
            (false, true) => (old[past::SPEED], 0.0),
            // It touched at the instant: the acceleration of that is carried on.
            (false, false) if gap <= 0.0 => (old[past::RATE].max(rate).max(0.0), 0.0),
            // The impact is over for good once the acceleration it leaves to the scheme is gone.
            (false, false) if old[past::AGE] + dt < self.law.duration => (old[past::SPEED], old[past::AGE] + dt),
            (false, false) => (0.0, 0.0),
        }
    }

    /// Sets the anchor, the pull on it and the rotations from which is rolled; returns what slip took.
    fn remember_friction(
        &self,
        point: &Point,
        (meeting, action): (&Meeting, Option<&Action>),
        now: &Configuration,
        part: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> f64 {
        let law = &self.law;
        let known = old[past::KNOWN] > 0.0;
        let force = action.map_or(0.0, |action| action.push.force);
        let drag = action.and_then(|action| action.drag.as_ref());
        let (p, n) = (&meeting.p, &meeting.near.n);
        let (pull, held) = (old[past::PULL], past::anchor(old));
        // What slides at t = 0 has been sliding: its spring is stretched.
        let begun =
            if known || now.dt > 0.0 || force == 0.0 { Vec3::zeros() } else { self.sliding(point, meeting, now) };
        let stretch = law.friction * force;
        let (shift, spent) = match drag {
            Some(drag) => {
                new[past::PULL] = pull + part * (drag.T.norm() - pull);
                (drag.slip, 0.5 * part * drag.slip.norm() * (pull + new[past::PULL]))
            }
            // Free: the anchor goes along, and what was stretched lets go.
            None => {
                new[past::PULL] = stretch * begun.norm();
                (p - held, 0.5 * pull * (pull / law.stiffness))
            }
        };
        let mut anchor = held + part * shift - stretch / law.stiffness * begun;
        if drag.is_some() {
            anchor += part * n.dot(&(p - held)) * n;
        }
        if self.rolls {
            for k in 0..self.count {
                let turn = self.turn(point.nodes[k], now.nodes);
                let q = if known {
                    let phi = self.phi(point, k, old, now.nodes);
                    if drag.is_some() {
                        // The way rolled so far moves from the rotation to the anchor.
                        anchor += part * point.weights[k] * point.lever * phi.cross(n);
                    }
                    renormalise(&(rotation::exp(&(part * phi)) * past::kept(old, k)))
                } else {
                    turn
                };
                new[past::TURN + 4 * k..past::TURN + 4 * k + 4].copy_from_slice(&[q.w, q.i, q.j, q.k]);
            }
        }
        new[past::ANCHOR..past::TURN].copy_from_slice(anchor.as_slice());
        spent
    }

    /// Unit vector along the slip, in the frame of the surface; zero for what does not slip faster than its weight makes it.
    fn sliding(&self, point: &Point, meeting: &Meeting, now: &Configuration) -> Vec3 {
        let n = &meeting.near.n;
        let spin: Vec3 = point.parts().map(|(node, weight)| weight * now.nodes[node].omega).sum();
        let spin = meeting.R.tr_mul(&(spin - now.nodes[self.carrier].omega));
        let w = meeting.R.tr_mul(&meeting.w);
        let slip = w - n.dot(&w) * n - point.lever * spin.cross(n);
        let speed = slip.norm();
        if speed > self.law.floor { slip / speed } else { Vec3::zeros() }
    }
}
