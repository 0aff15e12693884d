//! Forces, energies and results of shells.

use super::interpolation::Interpolation;
use super::kinematics::{Shells, Strains};
use super::results;
use super::section::ShellSection;
use super::tangent::tangent;
use crate::elements::block::{ElementBlock, Force, Moduli, subtract};
use crate::elements::results::ShellResultants;
use crate::materials::{Dissipation, FAILED_STIFFNESS};
use crate::math::Vec3;
use crate::state::{Configuration, Node};

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> ElementBlock for Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSection<P, E>,
{
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
        for element in self.elements.iter().filter(|element| !element.section.has_failed(now.history)) {
            let motion = element.gather(now.nodes);
            let strains = element.strains::<K>(&motion);
            let shear = element.shear_stress(&strains.shear);
            let stress = Strains { plane: element.section.stress(&strains.plane, now), shear };
            let mut gradient = element.gradient::<K, true>(&stress, &motion);
            if self.damping > 0.0 {
                let viscous = self.viscous_stress(element, &motion, now.nodes);
                gradient = gradient.plus(1.0, &element.gradient::<K, false>(&viscous, &motion));
            }
            for a in 0..N {
                let f = &mut F[element.nodes[a]];
                subtract(f, 0, &gradient.x[a]);
                let mut moment = Vec3::zeros();
                for k in 0..3 {
                    moment += motion.turning[k][a].cross(&gradient.turning[k][a]);
                }
                subtract(f, 3, &moment);
            }
        }
    }

    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        let motion = self.elements[e].gather(now);
        // The normal at a corner opposes the director there.
        (0..N).any(|a| {
            let side = |b: usize| motion.x[b % N] - motion.x[a];
            side(a + 1).cross(&side(a + N - 1)).dot(&motion.turning[0][a]) <= 0.0
        })
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        if self.damping > 0.0 {
            tangent::<_, N, V, P, E, _, true>(self, e, (now, None), rate_weight, moduli, K);
        } else {
            tangent::<_, N, V, P, E, _, false>(self, e, (now, None), rate_weight, moduli, K);
        }
        if self.elements[e].section.has_failed(now.history) {
            K.iter_mut().for_each(|k| *k *= FAILED_STIFFNESS);
        }
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        tangent::<_, N, V, P, E, _, false>(self, e, (now, Some(stressed)), 0.0, Moduli::Elastic, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut dissipation = Dissipation::default();
        for element in &self.elements {
            let strains = element.strains::<K>(&element.gather(now.nodes));
            dissipation += element.section.update_history(&strains.plane, now, part, new);
            if element.section.has_failed(new) && !element.section.has_failed(now.history) {
                // What the layers had stored is booked by then.
                let left = element.elastic_energy(&strains, &Configuration { history: new, ..*now });
                dissipation.eroded += left.into_iter().sum::<f64>();
            }
        }
        dissipation
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for element in self.elements.iter().filter(|element| !element.section.has_failed(now.history)) {
            let strains = element.strains::<K>(&element.gather(now.nodes));
            element.elastic_energy(&strains, now).into_iter().for_each(|energy| sum += energy);
        }
        sum
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for element in self.elements.iter().filter(|element| !element.section.has_failed(now.history)) {
            let motion = element.gather(now.nodes);
            let rates = element.strain_rates::<K>(&motion, &element.rates(&motion, now.nodes));
            let stress = element.elastic_stress(&rates);
            sum += stress.plane.dot(&rates.plane);
            sum += stress.shear.iter().zip(&rates.shear).map(|(a, b)| a * b).sum::<f64>();
        }
        self.damping * sum
    }

    fn resultants(&self, e: usize, axis: &Vec3, start: &[Vec3], now: &Configuration) -> Option<ShellResultants> {
        results::resultants(self, e, axis, start, now)
    }

    fn plastic_strain(&self, e: usize, history: &[f64]) -> f64 {
        self.elements[e].section.plastic_strain(history)
    }

    fn can_fail(&self) -> bool {
        self.elements.first().is_some_and(|element| element.section.can_fail())
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        self.elements[e].section.has_failed(history)
    }
}
