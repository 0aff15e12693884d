//! Points against a surface as a block of elements.

use super::force::touch;
use super::friction::slips;
use super::history::{PairMemory, PairMemoryMut};
use super::kinematics::Contacts;
use super::law::ContactLaw;
use super::multipliers::augment;
use super::pair_block::{PairAction, PairBlock, PairSide, energy, subtract_forces};
use super::steps::misses;
use super::tangent::tangent;
use super::update::update_point;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::slip::Sliding;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};
use base::math::Vec3;

impl Elements for Contacts {
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

    fn sliding(&self) -> Option<&dyn Sliding> {
        Some(self)
    }
}

impl Mechanics for Contacts {
    fn history(&self) -> usize {
        self.width() * self.points.len()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        subtract_forces(self, now, F);
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, _: Moduli, K: &mut [f64]) {
        K.fill(0.0);
        if !now.history.is_empty() {
            tangent(self, e, now, rate_weight, K);
        }
    }

    fn update_history(&self, now: &Configuration, part: f64, history: &mut [f64]) -> Dissipation {
        let mut spent = Dissipation::default();
        for (e, new) in history.chunks_exact_mut(self.width()).enumerate() {
            spent += update_point(self, e, now, part, &mut PairMemoryMut(new));
        }
        spent
    }
}

impl Results for Contacts {
    fn energy(&self, now: &Configuration) -> f64 {
        energy(self, now)
    }
}

impl Branches for Contacts {
    fn is_inactive(&self, e: usize, now: &Configuration) -> bool {
        if now.history.is_empty() {
            return true;
        }
        let old = self.memory(e, now.history);
        let gap = || self.kinematics(&self.points[e], now.nodes).gap + self.inset(old);
        now.dt < old.safe_time() || self.is_idle(old) || gap() - old.lift(&self.law) > self.law.touching
    }
}

impl PairBlock for Contacts {
    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn carrier(&self) -> Option<usize> {
        Some(self.carrier)
    }

    fn each_action(&self, now: &Configuration, act: &mut dyn FnMut(&PairAction)) {
        if now.history.is_empty() {
            return;
        }
        let k = self.law.stiffness;
        for (e, point) in self.points.iter().enumerate() {
            let Some((at, acting)) = touch(self, e, now) else { continue };
            let (f, m) = (at.R * acting.F, at.R * acting.M);
            let [T, limit] = acting.friction.map_or([0.0; 2], |friction| [friction.T.norm_squared(), friction.limit]);
            act(&PairAction {
                sides: [point.side(), PairSide::of_node(&self.carrier)],
                F: f,
                M: [m, -(at.d.cross(&f) + m)],
                arm: Vec3::zeros(),
                less: None,
                // Multipliers do no work.
                stored: if self.has_multipliers() { 0.0 } else { 0.5 * k * at.gap * at.gap + 0.5 * T / k },
                slips: slips(T.sqrt(), limit),
            });
        }
    }

    fn any_memory(&self, history: &[f64], is: &mut dyn FnMut(PairMemory) -> bool) -> bool {
        history.chunks_exact(self.width()).map(PairMemory).any(|old| old.is_known() && is(old))
    }

    fn misses(&self, start: &[Node], now: &Configuration) -> bool {
        misses(self, start, now)
    }

    fn has_multipliers(&self) -> bool {
        self.law.tolerance.is_some()
    }

    fn augment(&self, start: &[Node], now: &Configuration, new: &mut [f64]) -> f64 {
        augment(self, start, now, new)
    }
}
