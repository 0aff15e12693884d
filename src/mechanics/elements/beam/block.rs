//! Forces, energies and results of beams.

use super::heated::less;
use super::kinematics::{Beam, BeamMotion, Beams, GaussPoint, Pack};
use super::lane_section::SectionStiffness;
use super::quaternion::{left, right, times_conjugate};
use super::section::{BeamSection, BeamStiffness};
use super::tangent::{PackSections, tangent};
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::results::IntegrationPoint;
use crate::materials::Dissipation;
use crate::state::{Configuration, Node};
use base::math::lanes::{LANES, Lanes};
use base::math::number::{LaneVec3, Number};
use base::math::{Mat3, Vec3};
use std::array::from_fn;

/// Least number of elements for computing eight side by side; the results are bitwise the same.
const WORTH_A_PACK: usize = 6;

/// Stress resultants of one element.
#[inline(always)]
fn single((n, m): (Vec3, Vec3)) -> [LaneVec3<f64>; 2] {
    [LaneVec3(n.into()), LaneVec3(m.into())]
}

/// The damping of some elements: β, and the stiffness C of their sections at an integration point; none where they have failed.
struct Damping<'a, T> {
    factor: T,
    elastic: &'a dyn Fn(usize) -> SectionStiffness<T>,
}

/// The stress resultants at an integration point.
type Stress<'a, T> = dyn FnMut(usize, &GaussPoint<T>) -> [LaneVec3<T>; 2] + 'a;

/// Internal forces and moments on the nodes of a pack, global components, from the motion `motion` of the nodes and the stress resultants
/// `stress`.
///
/// The function is compiled once for all sections; `stress` hides their type at the cost of a call.
#[inline(never)]
fn forces_of<T: Number, const N: usize>(
    pack: &Pack<T, N>,
    points: usize,
    (motion, nodes): (&BeamMotion<T, N>, &[Node]),
    damping: Option<Damping<'_, T>>,
    stress: &mut Stress<T>,
) -> [[T; 6]; N] {
    let q = &motion.q;
    let mut gradient = [[T::ZERO; 4]; N]; // ∂U/∂q_a
    let mut force = [LaneVec3::ZERO; N];
    for g in 0..points {
        let point = pack.interpolate(g, motion);
        let [mut n, mut m] = stress(g, &point);
        if let Some(Damping { factor, elastic }) = &damping {
            let (rates, _) = pack.rates(g, &point, q, nodes);
            let [nd, md] = elastic(g).stress(&rates);
            n += *factor * nd;
            m += *factor * md;
        }
        // σ·∂ε/∂p = −2 (r′ p n + p′ m + (σ·e) p)/|p|², σ·∂ε/∂p′ = 2 p m/|p|².
        let sigma_e = n.dot(&(point.strain[0] + pack.tangent)) + m.dot(&point.strain[1]);
        let rpn = right(&left(&point.dr, &point.p), &n);
        let dpm = right(&point.dp, &m);
        let pm = right(&point.p, &m);
        let w = pack.weight(g);
        let w2 = T::splat(2.0) * point.inv * w;
        let LaneVec3([x, y, z]) = n;
        let n_global = x * point.R[0] + y * point.R[1] + z * point.R[2];
        for a in 0..N {
            let (value, slope) = pack.at_node(g, a);
            let (of_value, of_slope) = (-w2 * value, w2 * slope);
            for k in 0..4 {
                gradient[a][k] += of_value * (rpn[k] + dpm[k] + sigma_e * point.p[k]) + of_slope * pm[k];
            }
            force[a] += (w * slope) * n_global;
        }
    }
    let mut out = [[T::ZERO; 6]; N];
    for a in 0..N {
        let LaneVec3([x, y, z]) = force[a];
        let LaneVec3([u, v, w]) = T::splat(0.5) * times_conjugate(&gradient[a], &q[a]).1;
        out[a] = [x, y, z, u, v, w];
    }
    out
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// The damping of an element whose sections have the stiffness `elastic`.
    #[inline(always)]
    fn damping_of<'a>(
        &self,
        e: usize,
        now: &Configuration,
        elastic: &'a dyn Fn(usize) -> SectionStiffness<f64>,
    ) -> Option<Damping<'a, f64>> {
        let acts = self.damping > 0.0 && !self.elements[e].section.has_failed(now.history);
        acts.then_some(Damping { factor: self.damping, elastic })
    }

    /// Internal forces and moments on the nodes of an element, and the integrals of n and m over its length where something heats it.
    #[inline(never)]
    fn nodal_forces(&self, e: usize, now: &Configuration) -> ([Force; N], [Vec3; 2]) {
        let (pack, motion) = self.one(e, now.nodes);
        let section = &self.elements[e].section;
        let elastic = |g| BeamStiffness::side_by_side(|_| section.elastic(g));
        let (damping, free) = (self.damping_of(e, now, &elastic), self.free_strain(e, now.nodes));
        let mut sums = [Vec3::zeros(); 2];
        let forces = forces_of(&pack, self.integration_points(), (&motion, now.nodes), damping, &mut |g, point| {
            let (gamma, kappa) = less(point.strains(), free.as_ref());
            let (n, m) = section.stress(g, &gamma, &kappa, now);
            self.sum(e, g, (&n, &m), free.as_ref(), &mut sums);
            single((n, m))
        });
        (forces, sums)
    }

    /// Adds the stress at point `g` to the integrals over the length, where something heats the element.
    #[inline]
    fn sum(&self, e: usize, g: usize, (n, m): (&Vec3, &Vec3), free: Option<&[Vec3; 2]>, sums: &mut [Vec3; 2]) {
        if free.is_some() {
            let weight = self.shape.weight[g] * self.elements[e].jacobian;
            sums[0] += weight * n;
            sums[1] += weight * m;
        }
    }

    /// Internal forces and moments on the nodes of some elements that stay elastic, side by side.
    #[inline(always)]
    fn forces_side_by_side(&self, elements: &[Beam<N, S>], now: &Configuration) -> [[Lanes; 6]; N] {
        let pack = Pack::<Lanes, N>::new(elements, &self.shape);
        let motion = pack.gather(now.nodes);
        let at = |g| BeamStiffness::side_by_side(|lane| elements[lane.min(elements.len() - 1)].section.elastic(g));
        let first = at(0);
        let elastic = |g| if S::VARIES { at(g) } else { first };
        let damping = (self.damping > 0.0).then(|| Damping { factor: Lanes::splat(self.damping), elastic: &elastic });
        let mut stress = |g, point: &GaussPoint<Lanes>| elastic(g).stress(&point.strain);
        forces_of(&pack, self.integration_points(), (&motion, now.nodes), damping, &mut stress)
    }

    /// Subtracts forces on the nodes of element `e` from `F`.
    #[inline(always)]
    fn subtract_from_nodes(&self, e: usize, (f, sums): (&[Force; N], &[Vec3; 2]), F: &mut [Force]) {
        for a in 0..N {
            let F = &mut F[self.elements[e].nodes[a]];
            (0..6).for_each(|i| F[i] -= f[a][i]);
        }
        if let Some(heat) = &self.heat {
            heat.nodes.subtract_forces(&heat.work(e, &self.elements[e].tangent, sums), F);
        }
    }

    /// The part of the memory of a matrix for the nodes of the element itself.
    fn own_matrix<'k>(&self, K: &'k mut [f64]) -> &'k mut [f64] {
        if self.heat.is_some() { &mut K[..36 * N * N] } else { K }
    }

    /// Tangents of elements into `K`, one after the other, see [`Mechanics::tangent`]: as many as `T` has lanes, or fewer. The stresses are
    /// those at the nodes `previous`, where there are such. A single element may have strains `free` of stress.
    fn tangents_of<T: Number>(
        &self,
        (elements, free): (&[Beam<N, S>], Option<[Vec3; 2]>),
        (now, previous): (&Configuration, Option<&[Node]>),
        rate_weight: Option<f64>,
        moduli: Moduli,
        K: &mut [f64],
    ) {
        let pack = Pack::<T, N>::new(elements, &self.shape);
        let section = |lane: usize| &elements[lane.min(elements.len() - 1)].section;
        let at = |g| BeamStiffness::side_by_side(|lane| section(lane).elastic(g));
        let first = at(0);
        let elastic = |g| if S::VARIES { at(g) } else { first };
        let sections = PackSections {
            points: self.integration_points(),
            linearise: &|g, strain| {
                let strain = match &free {
                    None => *strain,
                    Some(free) => from_fn(|k| strain[k] - LaneVec3::gather(|_| free[k])),
                };
                S::linearise(section, g, &strain, (now, moduli), &elastic(g))
            },
            viscous: &|g| elastic(g).scaled(T::splat(self.damping)),
            has_failed: self.damping > 0.0 && section(0).has_failed(now.history),
        };
        tangent(&pack, &sections, (now.nodes, previous), rate_weight.filter(|_| self.damping > 0.0), K);
    }
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// Γ and κ that an element has without stress; `None` where nothing heats it.
    #[inline]
    fn free_strain(&self, e: usize, nodes: &[Node]) -> Option<[Vec3; 2]> {
        let heat = self.heat.as_ref()?;
        Some(heat.strain(e, &self.elements[e].tangent, nodes))
    }

    /// Widens the matrix of an element by the rows and columns of its temperatures, with its stiffness before it yields.
    fn widen(&self, e: usize, now: &Configuration, K: &mut [f64]) {
        let Some(heat) = &self.heat else { return };
        let (element, (pack, motion)) = (&self.elements[e], self.one(e, now.nodes));
        let points = self.integration_points();
        let length: f64 = (0..points).map(|g| self.shape.weight[g] * element.jacobian).sum();
        heat.nodes.widen(6, K, |of, column| {
            if element.section.has_failed(now.history) {
                column.fill(0.0);
                return [0.0; 3];
            }
            let [gamma, kappa] = heat.unit(e, &element.tangent, of);
            let at = |g: usize| element.section.elastic(g).stress(&-gamma, &-kappa);
            let forces = forces_of(&pack, points, (&motion, now.nodes), None, &mut |g, _| single(at(g)));
            column.copy_from_slice(forces.as_flattened());
            if !S::VARIES {
                let (n, m) = at(0);
                return heat.work(e, &element.tangent, &[length * n, length * m]);
            }
            let mut sums = [Vec3::zeros(); 2];
            for g in 0..points {
                let weight = self.shape.weight[g] * element.jacobian;
                let (n, m) = at(g);
                sums[0] += weight * n;
                sums[1] += weight * m;
            }
            heat.work(e, &element.tangent, &sums)
        });
    }
}

impl<const N: usize, S: BeamSection> Beams<N, S> {
    /// The energy in the intact fibres of a failing element, removed with it.
    fn lost_with(&self, e: usize, now: &Configuration) -> Dissipation {
        let (element, (pack, motion)) = (&self.elements[e], self.one(e, now.nodes));
        let free = self.free_strain(e, now.nodes);
        let mut sum = Dissipation::default();
        for g in 0..self.integration_points() {
            let (gamma, kappa) = less(pack.point(g, &motion).strains(), free.as_ref());
            sum += element.section.lost(g, (&gamma, &kappa), now) * (self.shape.weight[g] * element.jacobian);
        }
        sum
    }
}

impl<const N: usize, S: BeamSection> Elements for Beams<N, S> {
    fn len(&self) -> usize {
        self.elements.len()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        self.heat.as_ref().map_or(&self.elements[e].nodes, |heat| heat.nodes.nodes(e))
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, _: usize, node: usize) -> bool {
        node < N
    }
}

impl<const N: usize, S: BeamSection> Mechanics for Beams<N, S> {
    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.elements.iter().map(|e| e.section.history()).sum()
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        if S::IS_ELASTIC && self.heat.is_none() && self.len() >= WORTH_A_PACK {
            for elements in self.elements.chunks(LANES) {
                let f = self.forces_side_by_side(elements, now);
                // A node gets the forces of its elements in their order.
                for (lane, element) in elements.iter().enumerate() {
                    for a in 0..N {
                        let F = &mut F[element.nodes[a]];
                        (0..6).for_each(|i| F[i] -= f[a][i].as_array()[lane]);
                    }
                }
            }
            return;
        }
        for e in 0..self.len() {
            let (forces, sums) = self.nodal_forces(e, now);
            self.subtract_from_nodes(e, (&forces, &sums), F);
        }
    }

    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for (e, element) in self.elements.iter().enumerate() {
            let (pack, motion) = self.one(e, now.nodes);
            let elastic = |g| BeamStiffness::side_by_side(|_| element.section.elastic(g));
            let (damping, free) = (self.damping_of(e, now, &elastic), self.free_strain(e, now.nodes));
            let mut sums = [Vec3::zeros(); 2];
            let forces = forces_of(&pack, self.integration_points(), (&motion, now.nodes), damping, &mut |g, point| {
                let (gamma, kappa) = less(point.strains(), free.as_ref());
                let (n, m, spent) = element.section.advance(g, (&gamma, &kappa), now, new);
                sum += spent * (self.shape.weight[g] * element.jacobian);
                self.sum(e, g, (&n, &m), free.as_ref(), &mut sums);
                single((n, m))
            });
            self.subtract_from_nodes(e, (&forces, &sums), F);
            if element.section.has_failed(new) && !element.section.has_failed(now.history) {
                sum += self.lost_with(e, &Configuration { history: new, ..*now });
            }
        }
        sum
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        // In yielding material the current state matters more than the stretching by a correction.
        let previous = now.previous.filter(|_| S::IS_ELASTIC);
        let of = (&self.elements[e..=e], self.free_strain(e, now.nodes));
        self.tangents_of::<f64>(of, (now, previous), Some(rate_weight), moduli, self.own_matrix(K));
        self.widen(e, now, K);
    }

    fn tangents(&self, first: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        let length = 36 * N * N;
        if let Some(heat) = &self.heat {
            let each = K.chunks_mut(heat.nodes.width(6).pow(2)).enumerate();
            return each.for_each(|(k, K)| self.tangent(first + k, now, rate_weight, moduli, K));
        }
        let elements = &self.elements[first..first + K.len() / length];
        let previous = now.previous.filter(|_| S::IS_ELASTIC);
        for (elements, K) in elements.chunks(LANES).zip(K.chunks_mut(LANES * length)) {
            // Damping ends where an element fails.
            let fails = self.damping > 0.0 && elements.iter().any(|e| e.section.has_failed(now.history));
            if !fails && elements.len() >= WORTH_A_PACK {
                self.tangents_of::<Lanes>((elements, None), (now, previous), Some(rate_weight), moduli, K);
                continue;
            }
            for (one, K) in elements.chunks(1).zip(K.chunks_mut(length)) {
                self.tangents_of::<f64>((one, None), (now, previous), Some(rate_weight), moduli, K);
            }
        }
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        let of = (&self.elements[e..=e], self.free_strain(e, stressed));
        self.tangents_of::<f64>(of, (now, Some(stressed)), None, Moduli::Elastic, self.own_matrix(K));
        self.widen(e, now, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for (e, element) in self.elements.iter().enumerate() {
            let (pack, motion) = self.one(e, now.nodes);
            let free = self.free_strain(e, now.nodes);
            for g in 0..self.integration_points() {
                let (gamma, kappa) = less(pack.point(g, &motion).strains(), free.as_ref());
                let dissipation = element.section.update_history(g, (&gamma, &kappa), now, part, new);
                sum += dissipation * (self.shape.weight[g] * element.jacobian);
            }
            if element.section.has_failed(new) && !element.section.has_failed(now.history) {
                sum += self.lost_with(e, &Configuration { history: new, ..*now });
            }
        }
        sum
    }
}

impl<const N: usize, S: BeamSection> Results for Beams<N, S> {
    fn end_forces(&self, e: usize, now: &Configuration) -> Option<[Force; 2]> {
        let (forces, _) = self.nodal_forces(e, now);
        Some([forces[0], forces[N - 1]])
    }

    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for (e, element) in self.elements.iter().enumerate() {
            let (pack, motion) = self.one(e, now.nodes);
            let free = self.free_strain(e, now.nodes);
            for g in 0..self.integration_points() {
                let (gamma, kappa) = less(pack.point(g, &motion).strains(), free.as_ref());
                let energy = element.section.energy(g, &gamma, &kappa, now);
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
        let (element, (pack, motion)) = (&self.elements[e], self.one(e, now.nodes));
        let free = self.free_strain(e, now.nodes);
        let (gamma, kappa) = less(pack.point(g, &motion).strains(), free.as_ref());
        let (n, m) = element.section.stress(g, &gamma, &kappa, now);
        let (n, m) = (frame.tr_mul(&n), frame.tr_mul(&m));
        Some(IntegrationPoint {
            s: element.jacobian * (1.0 + self.shape.xi[g]),
            forces: [n.x, n.y, n.z, m.x, m.y, m.z],
            plastic_strain: element.section.plastic_strain(g, now.history),
            stresses: element.section.stresses(g, (&gamma, &kappa), now),
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
        let intact = |(_, element): &(usize, &Beam<N, S>)| !element.section.has_failed(now.history);
        for (e, element) in self.elements.iter().enumerate().filter(intact) {
            let (pack, motion) = self.one(e, nodes);
            for g in 0..self.integration_points() {
                let (gamma, kappa) = pack.strain_rates(g, &motion, nodes);
                let (n, m) = element.section.elastic(g).stress(&gamma, &kappa);
                sum += self.damping * self.shape.weight[g] * element.jacobian * (n.dot(&gamma) + m.dot(&kappa));
            }
        }
        sum
    }
}

impl<const N: usize, S: BeamSection> Branches for Beams<N, S> {
    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        let (pack, motion) = self.one(e, now);
        // The axis opposes the normals of its sections: Rᵀr′·t ≤ 0.
        let along = |g| pack.point(g, &motion).strain[0].dot(&pack.tangent) + 1.0;
        (0..self.integration_points()).any(|g| along(g) <= 0.0)
    }
}
