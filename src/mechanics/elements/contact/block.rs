//! Points against a surface as a block of elements.

use super::force::{ContactForce, touch};
use super::history::{self, PointHistoryMut};
use super::kinematics::{ContactKinematics, Contacts};
use super::tangent::tangent;
use super::update::update_point;
use crate::elements::block::{ElementBlock, Force, Moduli, subtract};
use crate::materials::Dissipation;
use crate::state::Configuration;

impl ElementBlock for Contacts {
    fn len(&self) -> usize {
        self.points.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.nodes[e][..=self.count]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, e: usize, node: usize) -> bool {
        node == self.count || self.law.friction > 0.0 && self.points[e].rolling_radius > 0.0
    }

    fn history(&self) -> usize {
        history::width(self) * self.points.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        if now.history.is_empty() {
            return;
        }
        for (e, point) in self.points.iter().enumerate() {
            let Some((at, acting)) = touch(self, e, now) else { continue };
            let (f, m) = (at.R * acting.F, at.R * acting.M);
            for (node, weight) in point.parts() {
                subtract(&mut F[node], 0, &(-weight * f));
                if point.rolling_radius > 0.0 {
                    subtract(&mut F[node], 3, &(-weight * m));
                }
            }
            let carrier = &mut F[self.carrier];
            subtract(carrier, 0, &f);
            subtract(carrier, 3, &(at.d.cross(&f) + m));
        }
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if !now.history.is_empty() {
            tangent(self, e, now, rate_weight, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(history::width(self)).enumerate() {
            spent += update_point(self, e, now, part, &mut PointHistoryMut::new(new));
        }
        spent
    }

    fn energy(&self, now: &Configuration) -> f64 {
        // Multipliers do no work.
        if now.history.is_empty() || self.law.tolerance.is_some() {
            return 0.0;
        }
        let k = self.law.stiffness;
        let stored = |(at, acting): (ContactKinematics, ContactForce)| {
            let T = acting.friction.map_or(0.0, |friction| friction.T.norm_squared());
            0.5 * k * at.gap * at.gap + 0.5 * T / k
        };
        (0..self.points.len()).filter_map(|e| touch(self, e, now)).map(stored).sum()
    }

    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        if now.history.is_empty() {
            return true;
        }
        let old = history::of(self, e, now.history);
        let gap = || self.kinematics(&self.points[e], now.nodes).gap + self.inset(old);
        now.dt < old.safe_time() || self.is_idle(old) || gap() - old.lift(&self.law) > self.law.touching
    }

    fn rubs(&self) -> bool {
        self.law.friction > 0.0
    }

    fn as_any(&self) -> Option<&dyn std::any::Any> {
        Some(self)
    }
}
