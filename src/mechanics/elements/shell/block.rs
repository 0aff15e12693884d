//! Forces, energies and results of shells.

use super::interpolation::Interpolation;
use super::kinematics::{NodalVectors, Shell, Shells, Strains};
use super::packed::PackedSections;
use super::packing::{pack, shell_pack};
use super::results;
use super::section::{InPlane, ShellSection};
use super::tangent::tangent;
use crate::elements::block::{ElementBlock, Force, Moduli, subtract};
use crate::elements::results::ShellResultants;
use crate::materials::{Dissipation, FAILED_STIFFNESS};
use crate::state::{Configuration, Node};
use base::math::Vec3;
use base::math::lanes::LANES;
use std::array::from_fn;

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSection<P, E>,
{
    /// Subtracts from `F` the forces and moments on the nodes of an element with this stress in its plane and these shear strains.
    #[inline(always)]
    fn subtract_from_nodes(
        &self,
        element: &Shell<N, V, P, E, S>,
        motion: &NodalVectors<N>,
        (plane, shear): (InPlane<P, E>, &[f64; N]),
        nodes: &[Node],
        F: &mut [Force],
    ) {
        let stress = Strains { plane, shear: element.edge_stress::<K>(shear, &plane) };
        let mut gradient = element.gradient::<K, true>(&stress, motion);
        if self.damping > 0.0 {
            let viscous = self.viscous_stress(element, motion, nodes);
            gradient = gradient.plus(1.0, &element.gradient::<K, false>(&viscous, motion));
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

/// The sections of eight elements; lanes beyond the last repeat it.
#[inline(always)]
fn eight<const N: usize, const V: usize, const P: usize, const E: usize, S>(
    elements: &[Shell<N, V, P, E, S>],
) -> [&S; LANES] {
    from_fn(|lane| &elements[lane.min(elements.len() - 1)].section)
}

/// The elastic energy that is left in an element that fails; what its layers had stored is booked by then.
fn left_in<const N: usize, const V: usize, const P: usize, const E: usize, S: ShellSection<P, E>>(
    element: &Shell<N, V, P, E, S>,
    strains: &Strains<N, P, E>,
    now: &Configuration,
    new: &[f64],
) -> f64 {
    element.elastic_energy(strains, &Configuration { history: new, ..*now }).into_iter().sum()
}

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

    fn pack(&mut self) {
        // Damping needs the rates of the strains too.
        if self.damping == 0.0 {
            self.packs = pack::<K, N, V, P, E, S>(&self.elements);
        }
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for pack in &self.packs {
            pack.subtract_forces::<K>(now.nodes, F, |sections, strain, count| {
                sections.advance(strain, now, None, count)
            });
        }
        if !self.packs.is_empty() {
            return;
        }
        if S::FORCES_SIDE_BY_SIDE && self.damping == 0.0 && !self.can_fail() {
            for elements in self.elements.chunks(LANES) {
                let sections = eight(elements);
                let stress = |(): &(), strain: &_, _| S::stress_eight(sections, strain, now);
                shell_pack::<K, N, V, P, E, S, ()>(elements, ()).subtract_forces::<K>(now.nodes, F, stress);
            }
            return;
        }
        for element in self.elements.iter().filter(|element| !element.section.has_failed(now.history)) {
            let motion = element.gather(now.nodes);
            let strains = element.strains::<K>(&motion);
            let plane = element.section.stress(&strains.plane, now);
            self.subtract_from_nodes(element, &motion, (plane, &strains.shear), now.nodes, F);
        }
    }

    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        let mut dissipation = Dissipation::default();
        for pack in &self.packs {
            let advance = |sections: &S::Packed, strain: &_, count| {
                sections.advance(strain, now, Some((&mut *new, &mut dissipation)), count)
            };
            pack.subtract_forces::<K>(now.nodes, F, advance);
        }
        if !self.packs.is_empty() {
            return dissipation;
        }
        for element in &self.elements {
            let motion = element.gather(now.nodes);
            let strains = element.strains::<K>(&motion);
            let (plane, spent) = element.section.advance(&strains.plane, now, new);
            dissipation += spent;
            if element.section.has_failed(now.history) {
                continue;
            }
            if element.section.has_failed(new) {
                dissipation.eroded += left_in(element, &strains, now, new);
            }
            self.subtract_from_nodes(element, &motion, (plane, &strains.shear), now.nodes, F);
        }
        dissipation
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

    fn tangents(&self, first: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, out: &mut [f64]) {
        let length = 36 * N * N;
        if self.damping > 0.0 {
            let each = out.chunks_mut(length).enumerate();
            each.for_each(|(k, out)| self.tangent(first + k, now, rate_weight, moduli, out));
            return;
        }
        for (elements, out) in self.elements[first..].chunks(LANES).zip(out.chunks_mut(LANES * length)) {
            let elements = &elements[..out.len() / length];
            let pack = shell_pack::<K, N, V, P, E, S, ()>(elements, ());
            let sections = eight(elements);
            let linearise = |strain: &_| S::linearise_eight(sections, strain, now, moduli);
            pack.tangents::<K>(&pack.gather(now.nodes), linearise, out);
            for (element, out) in elements.iter().zip(out.chunks_mut(length)) {
                if element.section.has_failed(now.history) {
                    out.iter_mut().for_each(|k| *k *= FAILED_STIFFNESS);
                }
            }
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
                dissipation.eroded += left_in(element, &strains, now, new);
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

    fn surface_strain(&self, e: usize, now: &Configuration) -> (f64, bool) {
        let element = &self.elements[e];
        // What has failed carries nothing, however far it is stretched.
        if element.section.has_failed(now.history) {
            return (0.0, false);
        }
        element.section.surface_strain(&element.strains::<K>(&element.gather(now.nodes)).plane)
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        self.elements[e].section.has_failed(history)
    }
}
