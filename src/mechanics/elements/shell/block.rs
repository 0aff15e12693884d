//! Forces, energies and results of shells.

use super::in_plane::InPlane;
use super::interpolation::Interpolation;
use super::pack::{ShellPack, Shells, Strains};
use super::results;
use super::section::{NewHistory, ShellSections};
use super::tangent::RateTerms;
use crate::elements::block::{Branches, Elements, Force, Mechanics, Moduli, Results};
use crate::elements::results::ShellResultants;
use crate::materials::{Dissipation, FAILED_STIFFNESS, Spent};
use crate::state::{Configuration, Node};
use base::math::Vec3;
use base::math::lanes::{LANES, Lanes};
use base::math::number::Number;

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    /// The pack of element `e`, and its place there.
    pub(super) fn place(&self, e: usize) -> (&ShellPack<N, V, P, E, S>, usize) {
        (&self.packs[e / LANES], e % LANES)
    }

    /// The elements of each pack that have not failed.
    fn intact<'a>(
        &'a self,
        history: &'a [f64],
    ) -> impl Iterator<Item = (&'a ShellPack<N, V, P, E, S>, impl Iterator<Item = usize> + 'a)> {
        self.packs.iter().map(|pack| (pack, (0..pack.count).filter(|e| !pack.sections.has_failed(*e, history))))
    }

    /// Tangents of the elements of `pack` from its place `first` on, as many as `out` holds.
    fn tangents_of(
        &self,
        (pack, first): (&ShellPack<N, V, P, E, S>, usize),
        (now, stressed): (&Configuration, Option<&[Node]>),
        moduli: Moduli,
        rate_weight: Option<f64>,
        out: &mut [f64],
    ) {
        let mut H = [[[[Lanes::ZERO; 6]; N]; 6]; N];
        let damping = rate_weight.filter(|_| self.damping > 0.0);
        let damping = damping.map(|rate_weight| RateTerms { factor: self.damping, rate_weight });
        pack.tangents::<K>((now, stressed), moduli, damping, &mut H);
        let (H, length) = (H.as_flattened().as_flattened().as_flattened(), 36 * N * N);
        if first == 0 {
            Number::write(H, out.len() / length, out, |lane| lane * length);
        } else {
            for (lane, out) in (first..).zip(out.chunks_mut(length)) {
                out.iter_mut().zip(H).for_each(|(k, of)| *k = of.as_array()[lane]);
            }
        }
    }

    /// Like [`Shells::tangents_of`], but scaled by [`FAILED_STIFFNESS`] for failed elements.
    fn own_tangents(
        &self,
        of: (&ShellPack<N, V, P, E, S>, usize),
        now: &Configuration,
        moduli: Moduli,
        rate_weight: f64,
        out: &mut [f64],
    ) {
        self.tangents_of(of, (now, None), moduli, Some(rate_weight), out);
        let (pack, first) = of;
        for (lane, out) in (first..).zip(out.chunks_mut(36 * N * N)) {
            if pack.sections.has_failed(lane, now.history) {
                out.iter_mut().for_each(|k| *k *= FAILED_STIFFNESS);
            }
        }
    }

    /// The part of the memory of a matrix for the nodes of the element itself.
    fn own_matrix<'k>(&self, K: &'k mut [f64]) -> &'k mut [f64] {
        if self.heat.is_some() { &mut K[..36 * N * N] } else { K }
    }

    /// Widens the matrix of an element by the rows and columns of its temperatures, with its stiffness before it yields.
    fn widen(&self, e: usize, now: &Configuration, K: &mut [f64]) {
        let (pack, lane) = self.place(e);
        let (Some(nodes), Some(heat)) = (&self.heat, &pack.heat) else { return };
        let units = [0, 1].map(|of| heat.derivative(of, now.nodes));
        let failed = pack.sections.has_failed(lane, now.history);
        nodes.widen(6, K, |of, column| {
            if failed {
                column.fill(0.0);
                return [0.0; 3];
            }
            let stress = pack.elastic_stress(&units[of.min(1)]).less(&Strains::ZERO, -1.0);
            let forces = pack.forces_of::<K>(now.nodes, stress);
            let all = forces.as_flattened();
            column.iter_mut().zip(all).for_each(|(k, force)| *k = force.as_array()[lane]);
            let mut work = [stress.dot(&units[0], lane), stress.dot(&units[1], lane), 0.0];
            if of == 0 {
                work[0] += heat.second(&pack.elastic_stress(&pack.strains_at::<K>(now.nodes)), lane);
            }
            work
        });
    }

    /// Subtracts the forces of the temperatures of a pack whose stress in the plane is given.
    fn subtract_heat(
        &self,
        pack: &ShellPack<N, V, P, E, S>,
        plane: &InPlane<P, E, Lanes>,
        now: &Configuration,
        F: &mut [Force],
    ) {
        let (Some(nodes), Some(heat)) = (&self.heat, &pack.heat) else { return };
        let shear = pack.shear_stress(&pack.strains_at::<K>(now.nodes).shear);
        let stress = Strains { plane: *plane, shear };
        let units = [0, 1].map(|of| heat.derivative(of, now.nodes));
        let mut work = [0.0; 3];
        for lane in (0..pack.count).filter(|lane| !pack.sections.has_failed(*lane, now.history)) {
            work[0] += stress.dot(&units[0], lane);
            work[1] += stress.dot(&units[1], lane);
        }
        nodes.subtract_forces(&work, F);
    }

    /// Adds the dissipation of the layers of a pack, and the remaining energy of elements that fail as a whole; the layers have counted
    /// their own.
    fn dissipated(
        &self,
        pack: &ShellPack<N, V, P, E, S>,
        spent: &Spent<Lanes>,
        now: &Configuration,
        new: &[f64],
        sum: &mut Dissipation,
    ) {
        let fails = pack.sections.can_fail();
        for lane in 0..pack.count {
            *sum += spent.lane(lane);
            let failed = |history: &[f64]| pack.sections.has_failed(lane, history);
            if fails && failed(new) && !failed(now.history) {
                let strains = pack.strains_at::<K>(now.nodes);
                let energy = pack.energy(lane, &strains, &Configuration { history: new, ..*now });
                sum.eroded += energy.into_iter().sum::<f64>();
            }
        }
    }
}

/// Subtracts the forces on the nodes of the elements of a pack that have not failed from `F`: a node gets those of its elements in their
/// order.
#[inline(always)]
fn subtract<const N: usize, const V: usize, const P: usize, const E: usize, S: ShellSections<P, E, Lanes>>(
    pack: &ShellPack<N, V, P, E, S>,
    f: [[Lanes; 6]; N],
    history: &[f64],
    F: &mut [Force],
) {
    let f = f.map(|f| f.map(Lanes::to_array));
    let fails = pack.sections.can_fail();
    for lane in (0..pack.count).filter(|lane| !fails || !pack.sections.has_failed(*lane, history)) {
        for a in 0..N {
            let F = &mut F[pack.nodes[lane][a]];
            (0..6).for_each(|i| F[i] -= f[a][i][lane]);
        }
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Elements for Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    fn len(&self) -> usize {
        self.packs.iter().map(|pack| pack.count).sum()
    }

    fn nodes(&self, e: usize) -> &[usize] {
        if let Some(heat) = &self.heat {
            return heat.nodes(e);
        }
        let (pack, lane) = self.place(e);
        &pack.nodes[lane]
    }

    fn dofs(&self) -> usize {
        6
    }

    fn is_rotational(&self, _: usize, node: usize) -> bool {
        node < N
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Mechanics for Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    fn is_damped(&self) -> bool {
        self.damping > 0.0
    }

    fn history(&self) -> usize {
        self.history
    }

    fn subtract_forces(&self, now: &Configuration, F: &mut [Force]) {
        for pack in &self.packs {
            let mut plane = InPlane::ZERO;
            let stress = |sections: &S, strain: &_| {
                plane = sections.stress(strain, now);
                plane
            };
            subtract(pack, pack.forces::<K>(now.nodes, self.damping, stress), now.history, F);
            self.subtract_heat(pack, &plane, now, F);
        }
    }

    fn advance(&self, now: &Configuration, F: &mut [Force], new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        for pack in &self.packs {
            let mut spent = Spent::ZERO;
            let to = NewHistory { part: 1.0, new: &mut *new, spent: &mut spent };
            let mut plane = InPlane::ZERO;
            let f = pack.forces::<K>(now.nodes, self.damping, |sections, strain| {
                plane = sections.advance(strain, now, to);
                plane
            });
            subtract(pack, f, now.history, F);
            self.subtract_heat(pack, &plane, now, F);
            self.dissipated(pack, &spent, now, new, &mut sum);
        }
        sum
    }

    fn tangent(&self, e: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, K: &mut [f64]) {
        self.own_tangents(self.place(e), now, moduli, rate_weight, self.own_matrix(K));
        self.widen(e, now, K);
    }

    fn tangents(&self, first: usize, now: &Configuration, rate_weight: f64, moduli: Moduli, out: &mut [f64]) {
        if let Some(heat) = &self.heat {
            let each = out.chunks_mut(heat.width(6).pow(2)).enumerate();
            return each.for_each(|(k, K)| self.tangent(first + k, now, rate_weight, moduli, K));
        }
        let (length, mut e, mut rest) = (36 * N * N, first, out);
        while !rest.is_empty() {
            let (pack, lane) = self.place(e);
            let count = (pack.count - lane).min(rest.len() / length);
            let (own, further) = rest.split_at_mut(count * length);
            self.own_tangents((pack, lane), now, moduli, rate_weight, own);
            (e, rest) = (e + count, further);
        }
    }

    fn stressed_tangent(&self, e: usize, now: &Configuration, stressed: &[Node], K: &mut [f64]) {
        self.tangents_of(self.place(e), (now, Some(stressed)), Moduli::Elastic, None, self.own_matrix(K));
        self.widen(e, now, K);
    }

    fn update_history(&self, now: &Configuration, part: f64, new: &mut [f64]) -> Dissipation {
        let mut sum = Dissipation::default();
        if self.history == 0 {
            return sum;
        }
        for pack in &self.packs {
            let Strains { plane, .. } = pack.strains_at::<K>(now.nodes);
            let mut spent = Spent::ZERO;
            let to = NewHistory { part, new: &mut *new, spent: &mut spent };
            pack.sections.advance(&plane, now, to);
            self.dissipated(pack, &spent, now, new, &mut sum);
        }
        sum
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Results for Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    fn energy(&self, now: &Configuration) -> f64 {
        let mut sum = 0.0;
        for (pack, intact) in self.intact(now.history) {
            let strains = pack.strains_at::<K>(now.nodes);
            intact.for_each(|lane| pack.energy(lane, &strains, now).into_iter().for_each(|energy| sum += energy));
        }
        sum
    }

    fn damping_power(&self, now: &Configuration) -> f64 {
        if self.damping == 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for (pack, intact) in self.intact(now.history) {
            let motion = pack.gather(now.nodes);
            let rates = pack.strain_rates::<K>(&motion, &pack.rates(&motion, now.nodes));
            let stress = pack.sections.elastic().stress(&rates.plane);
            let stress = Strains { plane: stress, shear: pack.shear_stress(&rates.shear) };
            intact.for_each(|lane| sum += stress.dot(&rates, lane));
        }
        self.damping * sum
    }

    fn resultants(
        &self,
        axis: &Vec3,
        start: &dyn Fn(usize) -> Vec3,
        now: &Configuration,
        write: &mut dyn FnMut(usize, ShellResultants),
    ) {
        for (p, pack) in self.packs.iter().enumerate() {
            results::resultants::<K, N, V, P, E, S>(pack, axis, start, now, &mut |lane, at| {
                write(p * LANES + lane, at)
            });
        }
    }

    fn plastic_strain(&self, e: usize, history: &[f64]) -> f64 {
        let (pack, lane) = self.place(e);
        pack.sections.plastic_strain(lane, history)
    }

    fn can_fail(&self) -> bool {
        self.packs.first().is_some_and(|pack| pack.sections.can_fail())
    }

    fn surface_strains(&self, now: &Configuration, of: &mut dyn FnMut(usize, f64, bool)) {
        if self.history == 0 {
            return;
        }
        // A failed element has no strain to report.
        for (p, (pack, intact)) in self.intact(now.history).enumerate() {
            let strain = pack.sections.surface_strain(&pack.strains_at::<K>(now.nodes).plane);
            let Some((strain, is_logarithmic)) = strain else { continue };
            intact.for_each(|lane| of(p * LANES + lane, strain.lane(lane), is_logarithmic));
        }
    }

    fn has_failed(&self, e: usize, history: &[f64]) -> bool {
        let (pack, lane) = self.place(e);
        pack.sections.has_failed(lane, history)
    }
}

impl<K, const N: usize, const V: usize, const P: usize, const E: usize, S> Branches for Shells<K, N, V, P, E, S>
where
    K: Interpolation<N, V, P>,
    S: ShellSections<P, E, Lanes>,
{
    fn is_turned_over(&self, e: usize, _: &[Node], now: &[Node]) -> bool {
        let (pack, lane) = self.place(e);
        let motion = pack.gather(now);
        // The normal at a corner opposes the director there.
        (0..N).any(|a| {
            let side = |b: usize| motion.x[b % N] - motion.x[a];
            side(a + 1).cross(&side(a + N - 1)).dot(&motion.triads[0][a]).as_array()[lane] <= 0.0
        })
    }
}
