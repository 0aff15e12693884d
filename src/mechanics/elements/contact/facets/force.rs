//! The forces between a point and a facet in contact: normal force and friction.

use super::crossing;
use super::line_friction;
use super::pair::{FacetPair, PairForceOnPoint, PairPlace, Rub, rotation_of};
use crate::elements::contact::friction::friction_force;
use crate::elements::contact::history::PairMemory;
use crate::elements::contact::surfaces::kind::ClosestPoint;
use crate::state::Node;
use base::math::rotation::matrix;
use base::math::{Mat3, Vec3};

impl FacetPair<'_> {
    /// The forces at the contact.
    pub fn force(&self, place: &PairPlace, nodes: &[Node]) -> PairForceOnPoint {
        let law = self.law;
        if place.inset > 0.0 && place.gap() > 0.0 {
            return PairForceOnPoint::NONE;
        }
        let old = self.memory.unwrap_or(PairMemory::NOTHING);
        let normal = law.press((-place.gap()).max(0.0), place.inset, place.rate(), old);
        let n = &place.n;
        let less = if self.is_of_edges() { crossing::end_force(self, old, nodes) } else { None };
        let (M, C) = (Vec3::zeros(), Vec3::zeros());
        let free = PairForceOnPoint { normal, less, friction: None, F: normal.force * n, M, C };
        let Some(memory) = self.memory.filter(|_| law.friction > 0.0) else { return free };
        let pressed = if self.sticks { f64::INFINITY } else { free.pressed().max(0.0) };
        if self.is_of_lines() {
            let rub = line_friction::rub(self, place, memory, pressed, nodes);
            let ([a, b], moment) = (line_friction::arms(self, place), n.cross(&rub.T));
            return PairForceOnPoint { F: free.F - rub.T, M: a * moment, C: b * moment, friction: Some(rub), ..free };
        }
        let r = self.point.rolling_radius;
        let q = rotation_of(self.kept, nodes);
        let R = matrix(&q);
        let mut phi = Vec3::zeros();
        if r > 0.0 {
            for k in 0..self.point.count {
                phi += self.point.weights[k] * self.turned(k, memory, (&q, &R), nodes);
            }
        }
        let from_anchor = self.seen_from(self.kept, &place.x, nodes) - self.kept.base(nodes) * memory.anchor();
        let closest = ClosestPoint { distance: place.gap(), n: *n, H: Mat3::zeros() };
        let mu = law.friction_at(memory.slip_speed());
        let friction = friction_force(law.stiffness, mu, pressed, &closest, &from_anchor, r, &phi);
        let M = r * n.cross(&friction.T);
        PairForceOnPoint {
            F: normal.force * n - friction.T,
            M,
            C: place.d * n.cross(&friction.T) - M,
            friction: Some(Rub { T: friction.T, limit: friction.limit, slip: friction.slip }),
            ..free
        }
    }
}
