//! Forces, energies and results of beams.

use super::kinematics::{Beam, Beams, GaussPoint};
use super::quaternion::{Quat, left, right, times_conjugate};
use super::section::BeamSection;
use super::tangent::tangent;
use crate::elements::block::{ElementBlock, Force, Moduli, subtract};
use crate::elements::results::IntegrationPoint;
use crate::materials::Dissipation;
use crate::math::{Mat3, Vec3};
use crate::state::{Configuration, Node};

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// Internal forces and moments on the nodes of an element, global components.
    #[inline(always)]
    fn nodal_forces(&self, element: &Beam<N, S>, now: &Configuration) -> ([Vec3; N], [Vec3; N]) {
        let motion = self.gather(element, now.nodes);
        self.forces_of(element, &motion, now, |g, point| element.section.stress(g, &point.gamma, &point.kappa, now))
    }

    /// The same where the nodes move by `motion` and the sections have the stress resultants `stress`.
    #[inline(always)]
    fn forces_of(
        &self,
        element: &Beam<N, S>,
        motion: &([Quat; N], [Vec3; N]),
        now: &Configuration,
        mut stress: impl FnMut(usize, &GaussPoint) -> (Vec3, Vec3),
    ) -> ([Vec3; N], [Vec3; N]) {
        let (nodes, q) = (now.nodes, &motion.0);
        let mut gradient = [[0.0; 4]; N]; // ∂U/∂q_a
        let mut force = [Vec3::zeros(); N];
        for g in 0..self.integration_points() {
            let point = self.interpolate(element, g, motion);
            let (mut n, mut m) = stress(g, &point);
            if self.damping > 0.0 && !element.section.has_failed(now.history) {
                let (gamma_rate, kappa_rate, _) = self.rates(element, g, &point, q, nodes);
                let (nd, md) = element.section.elastic().stress(&gamma_rate, &kappa_rate);
                n += self.damping * nd;
                m += self.damping * md;
            }
            // σ·∂ε/∂p = −2 (r′ p n + p′ m + (σ·e) p)/|p|², σ·∂ε/∂p′ = 2 p m/|p|².
            let sigma_e = n.dot(&(point.gamma + element.tangent)) + m.dot(&point.kappa);
            let rpn = right(&left(&point.dr, &point.p), &n);
            let dpm = right(&point.dp, &m);
            let pm = right(&point.p, &m);
            let w = self.shape.weight[g] * element.jacobian;
            let w2 = 2.0 * point.inv * w;
            let n_global = point.R * n;
            for a in 0..N {
                let value = -w2 * self.shape.value[g][a];
                let slope = w2 * self.shape.slope[g][a] / element.jacobian;
                for k in 0..4 {
                    gradient[a][k] += value * (rpn[k] + dpm[k] + sigma_e * point.p[k]) + slope * pm[k];
                }
                force[a] += (self.shape.weight[g] * self.shape.slope[g][a]) * n_global;
            }
        }
        (force, std::array::from_fn(|a| 0.5 * times_conjugate(&gradient[a], &q[a]).1))
    }
}

impl<const N: usize, S> Beam<N, S> {
    /// Subtracts forces and moments on the nodes from `F`.
    #[inline(always)]
    fn subtract_from_nodes(&self, (force, moment): &([Vec3; N], [Vec3; N]), F: &mut [Force]) {
        for a in 0..N {
            let f = &mut F[self.nodes[a]];
            subtract(f, 0, &force[a]);
            subtract(f, 3, &moment[a]);
        }
    }
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// The elastic energy that is left in an element that fails, in the sections that have not.
    fn left_in(&self, element: &Beam<N, S>, now: &Configuration) -> f64 {
        let motion = self.gather(element, now.nodes);
        let at = |g: usize| {
            let point = self.interpolate(element, g, &motion);
            let energy = element.section.stored(g, (&point.gamma, &point.kappa), now);
            self.shape.weight[g] * element.jacobian * energy
        };
        (0..self.integration_points()).map(at).sum()
    }
}

impl<const N: usize, S: BeamSection> ElementBlock for Beams<N, S> {
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        &self.elements[e].nodes
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.elements.iter().map(|e| e.section.history()).sum()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for element in &self.elements {
            element.subtract_from_nodes(&self.nodal_forces(element, now), F);
        }
    }

    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for element in &self.elements {
            let motion = self.gather(element, now.nodes);
            let forces = self.forces_of(element, &motion, now, |g, point| {
                let (n, m, spent) = element.section.advance(g, (&point.gamma, &point.kappa), now, new);
                sum += spent * (self.shape.weight[g] * element.jacobian);
                (n, m)
            });
            element.subtract_from_nodes(&forces, F);
            if element.section.has_failed(new) && !element.section.has_failed(now.history) {
                sum.eroded += self.left_in(element, &Configuration { history: new, ..*now });
            }
        }
        sum
    }

    fn end_forces(&self, e: usize, now: &Configuration) -> Option<[Force; 2]> {
        let (force, moment) = self.nodal_forces(&self.elements[e], now);
        Some([0, N - 1].map(|a| {
            let (f, m) = (force[a], moment[a]);
            [f.x, f.y, f.z, m.x, m.y, m.z]
        }))
    }

    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        let element = &self.elements[e];
        let motion = self.gather(element, now);
        // The axis opposes the normals of its sections: Rᵀr′·t ≤ 0.
        let along = |g| self.interpolate(element, g, &motion).gamma.dot(&element.tangent) + 1.0;
        (0..self.integration_points()).any(|g| along(g) <= 0.0)
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        // Where material yields, its state counts more than what a correction stretches.
        let lead = now.lead.filter(|_| self.elements[e].section.history() == 0);
        if self.damping > 0.0 {
            tangent::<N, S, true>(self, e, (now, lead), rate_weight, moduli, K);
        } else {
            tangent::<N, S, false>(self, e, (now, lead), rate_weight, moduli, K);
        }
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        tangent::<N, S, false>(self, e, (now, Some(stressed)), 0.0, Moduli::Elastic, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for element in &self.elements {
            let motion = self.gather(element, now.nodes);
            for g in 0..self.integration_points() {
                let point = self.interpolate(element, g, &motion);
                let dissipation = element.section.update_history(g, (&point.gamma, &point.kappa), now, part, new);
                sum += dissipation * (self.shape.weight[g] * element.jacobian);
            }
            if element.section.has_failed(new) && !element.section.has_failed(now.history) {
                sum.eroded += self.left_in(element, &Configuration { history: new, ..*now });
            }
        }
        sum
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            let motion = self.gather(element, now.nodes);
            for g in 0..self.integration_points() {
                let point = self.interpolate(element, g, &motion);
                let energy = element.section.energy(g, &point.gamma, &point.kappa, now);
                sum += self.shape.weight[g] * element.jacobian * energy;
            }
        }
        sum
    }

    #[inline(always)]
    fn points(&self) -> usize {
        self.integration_points()
    }

    fn point(&self, e: usize, g: usize, frame: &Mat3, now: &Configuration) -> Option<IntegrationPoint> {
        let element = &self.elements[e];
        let point = self.interpolate(element, g, &self.gather(element, now.nodes));
        let (n, m) = element.section.stress(g, &point.gamma, &point.kappa, now);
        let (n, m) = (frame.tr_mul(&n), frame.tr_mul(&m));
        Some(IntegrationPoint {
            s: element.jacobian * (1.0 + self.shape.xi[g]),
            forces: [n.x, n.y, n.z, m.x, m.y, m.z],
            plastic_strain: element.section.plastic_strain(g, now.history),
        })
    }

    fn plastic_strain(&self, e: usize, history: &[f64]) -> f64 {
        (0..self.integration_points()).map(|g| self.elements[e].section.plastic_strain(g, history)).fold(0.0, f64::max)
    }

    fn can_fail(&self) -> bool {
        self.elements.first().is_some_and(|element| element.section.can_fail())
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        self.elements[e].section.has_failed(history)
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        let nodes = now.nodes;
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for element in self.elements.iter().filter(|element| !element.section.has_failed(now.history)) {
            let motion = self.gather(element, nodes);
            for g in 0..self.integration_points() {
                let point = self.interpolate(element, g, &motion);
                let (gamma, kappa, _) = self.rates(element, g, &point, &motion.0, nodes);
                let (n, m) = element.section.elastic().stress(&gamma, &kappa);
                sum += self.damping * self.shape.weight[g] * element.jacobian * (n.dot(&gamma) + m.dot(&kappa));
            }
        }
        sum
    }
}
