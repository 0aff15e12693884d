//! The material law: stress and history variables from the strain at a point, for all stress states.
//!
//! Backward Euler over the step, with the tangent of exactly that (13)-(18); any increment converges.

use super::constants::ElasticConstants;
use super::failure::FailureCriterion;
use super::hardening::Hardening;
use super::overstress::Viscosity;
use super::response::{Ask, MaterialHistory, PointResponse, Spent};
use super::return_mapping::{ReturnPoint, Trial, Yielding};
use super::stress_state::StressState;
use base::math::number::{Mask, Number};
use std::array::from_fn;

/// An elastic-plastic or elastic-viscoplastic material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialLaw {
    elastic: ElasticConstants,
    yielding: Yielding,
    /// When a point carries nothing more; `None` for a material that does not fail.
    failure: Option<FailureCriterion>,
}

/// Ratio of the tangent of a failed point to its elastic stiffness. The stress of a failed point is zero. The trace of stiffness keeps the
/// matrix regular at nodes without other elements, and is too small to change other results.
pub const FAILED_STIFFNESS: f64 = 1e-8;

/// The number of components of the stress states that have most.
const MOST: usize = 3;

/// Stress at the end of a step by modes: the trial, and the return if it yields.
struct Answer<T: Number, const N: usize> {
    /// ξ*.
    relative: [T; N],
    /// X at the beginning of the step, of a law that has one.
    back: Option<[T; N]>,
    /// i there.
    radius: T,
    /// The points that yield.
    yields: T::Mask,
    /// The return, where one yields.
    end: Option<ReturnPoint<T>>,
}

impl<T: Number, const N: usize> Answer<T, N> {
    /// σᵢ = Xᵢ + ξᵢ* (R + k)/Tᵢ.
    #[inline(always)]
    fn stress(&self) -> [T; N] {
        let mut stress = self.relative;
        if let Some(end) = &self.end {
            stress = from_fn(|i| T::select(self.yields, stress[i] * (end.S / end.T(i)), stress[i]));
        }
        self.back.map_or(stress, |back| from_fn(|i| back[i] + stress[i]))
    }
}

impl MaterialLaw {
    /// The caller has checked that E > 0, −1 < ν ≤ ½, 0 ≤ kinematic share ≤ 1, yield stress and exponent > 0, modulus and fluidity ≥ 0.
    /// Only plane stress and shear depend on ν.
    pub fn new(
        E: f64,
        nu: f64,
        hardening: Hardening,
        kinematic_share: f64,
        viscosity: Option<Viscosity>,
    ) -> MaterialLaw {
        MaterialLaw {
            elastic: ElasticConstants::new(E, nu),
            yielding: Yielding { hardening, kinematic_share, viscosity },
            failure: None,
        }
    }

    /// Adds a failure criterion to the material.
    pub fn failing_at(self, failure: FailureCriterion) -> MaterialLaw {
        MaterialLaw { failure: Some(failure), ..self }
    }

    /// A copy of a law that hardens linearly and isotropically, without viscosity and failure; `None` for all others. It names what the law
    /// has not, so that the compiler leaves that out of a kernel.
    #[inline(always)]
    pub fn plain(&self) -> Option<MaterialLaw> {
        let Hardening::Linear { yield_stress, modulus } = self.yielding.hardening else { return None };
        let is_plain = !self.is_kinematic() && self.yielding.viscosity.is_none() && self.failure.is_none();
        let hardening = Hardening::Linear { yield_stress, modulus };
        let yielding = Yielding { hardening, kinematic_share: 0.0, viscosity: None };
        is_plain.then_some(MaterialLaw { elastic: self.elastic, yielding, failure: None })
    }

    /// True for a material whose points may fail.
    pub fn can_fail(&self) -> bool {
        self.failure.is_some()
    }

    /// True where a point has failed by its history: its stress is zero from then on.
    #[inline(always)]
    pub fn has_failed<const N: usize, S: StressState<N>>(&self, state: S, history: &[f64]) -> bool {
        self.failure.as_ref().is_some_and(|failure| failed(failure, &self.recall::<f64, N, S>(state, history, |_| 0)))
    }

    /// The elastic constants.
    pub fn elastic(&self) -> &ElasticConstants {
        &self.elastic
    }

    /// The initial yield stress in tension.
    pub fn initial_yield(&self) -> f64 {
        self.yielding.hardening.initial()
    }

    /// Number of history variables per point: plastic strains, accumulated plastic strain, back stresses (kinematic share), damage (failure
    /// by stress or rate), last overstress (viscosity).
    pub fn history<const N: usize, S: StressState<N>>(&self, _: S) -> usize {
        self.damage_place::<N>() + usize::from(self.sums_damage()) + usize::from(self.yielding.viscosity.is_some())
    }

    /// The place of damage in the history of a point, where there is such a number.
    #[inline(always)]
    fn damage_place<const N: usize>(&self) -> usize {
        N + 1 + if self.is_kinematic() { N } else { 0 }
    }

    /// The history variables of one point or of eight, each with the place among `history` where its own start.
    #[inline(always)]
    pub fn recall<T: Number, const N: usize, S: StressState<N>>(
        &self,
        state: S,
        history: &[f64],
        at: impl Fn(usize) -> usize,
    ) -> MaterialHistory<T, N> {
        let further = |k: usize| T::gather(|lane| history[at(lane) + k]);
        let mut first = [T::ZERO; MOST + 1];
        T::read(&mut first[..N + 1], history, &at);
        let mut plastic = [T::ZERO; N];
        plastic.copy_from_slice(&first[..N]);
        let back = self.is_kinematic().then(|| {
            let mut back = [T::ZERO; N];
            T::read(&mut back, history, |lane| at(lane) + N + 1);
            back
        });
        MaterialHistory {
            plastic,
            accumulated: first[N],
            back,
            damage: self.sums_damage().then(|| further(self.damage_place::<N>())),
            overstress: self.yielding.viscosity.map(|_| further(self.history(state) - 1)),
        }
    }

    /// Writes the history variables of one point or of eight, which are the old ones where none are `new`. Points that share a place share
    /// their variables too.
    #[inline(always)]
    pub fn remember<T: Number, const N: usize, S: StressState<N>>(
        &self,
        state: S,
        new: &Option<MaterialHistory<T, N>>,
        (old, to): (&[f64], &mut [f64]),
        at: impl Fn(usize) -> usize,
    ) {
        let variables = self.history(state);
        let Some(new) = new else {
            for lane in 0..T::COUNT {
                let at = at(lane);
                to[at..][..variables].copy_from_slice(&old[at..][..variables]);
            }
            return;
        };
        let mut first = [new.accumulated; MOST + 1];
        first[..N].copy_from_slice(&new.plastic);
        T::write(&first[..N + 1], T::COUNT, to, &at);
        if let Some(back) = &new.back {
            T::write(back, T::COUNT, to, |lane| at(lane) + N + 1);
        }
        if let Some(damage) = new.damage {
            T::write(&[damage], T::COUNT, to, |lane| at(lane) + self.damage_place::<N>());
        }
        if let Some(overstress) = new.overstress {
            T::write(&[overstress], T::COUNT, to, |lane| at(lane) + variables - 1);
        }
    }

    /// Stress, and on demand tangent or history, at `strain`, a time `dt` after the state `old`. A point has bitwise the same result alone
    /// and among eight. Not finite where the strain or its elastic stress is not.
    #[inline(always)]
    pub fn respond<T: Number, const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[T; N],
        (dt, old): (f64, &MaterialHistory<T, N>),
        ask: Ask,
    ) -> PointResponse<T, N> {
        let failed = self.failure.as_ref().map(|failure| failed(failure, old));
        let answer = self.answer::<T, N, S>(strain, dt, old, failed);
        let mut out = PointResponse { stress: S::modes(answer.stress()), tangent: None, new: None, dissipation: None };
        match ask {
            Ask::Stress => {}
            Ask::Tangent => out.tangent = self.tangent(state, &answer),
            Ask::History(part) => self.advance(state, (strain, old), &answer, (dt, part), &mut out),
        }
        if let Some(failed) = failed.filter(|failed| failed.any()) {
            let elastic = self.stiffness(state);
            out.stress = out.stress.map(|stress| T::select(failed, T::ZERO, stress));
            if ask == Ask::Tangent {
                let C = out.tangent.unwrap_or_else(|| elastic.map(|row| row.map(T::splat)));
                let left = |i: usize, j: usize| T::splat(FAILED_STIFFNESS * elastic[i][j]);
                out.tangent = Some(from_fn(|i| from_fn(|j| T::select(failed, left(i, j), C[i][j]))));
            }
            out.new = out.new.map(|new| new.unless(failed, old));
        }
        out
    }

    /// The answer at one point, whose history variables are `old`. The function is inlined, so that callers compute only the parts of the
    /// response they need.
    #[inline(always)]
    pub fn at_point<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        (dt, old): (f64, &[f64]),
        ask: Ask,
    ) -> PointResponse<f64, N> {
        self.respond(state, strain, (dt, &self.recall(state, old, |_| 0)), ask)
    }

    /// The derivative of the stress by the strain at the end of the step; `None` where nothing yields.
    #[inline(always)]
    fn tangent<T: Number, const N: usize, S: StressState<N>>(
        &self,
        state: S,
        answer: &Answer<T, N>,
    ) -> Option<[[T; N]; N]> {
        let end = answer.end.as_ref()?;
        // With bᵢ = pᵢ eᵢ ξᵢ*/Tᵢ² the yield condition gives Σ bᵢ dεᵢ = slope ∂ and dσᵢ = eᵢ S/Tᵢ dεᵢ − bᵢ (S ∂Δλ − Δλ ∂S).
        let e = S::moduli(&self.elastic).map(T::splat);
        let ratio: [T; N] = from_fn(|i| end.S / end.T(i));
        let Sb: [T; N] = from_fn(|i| T::splat(S::P[i]) * e[i] * (answer.relative[i] / end.T(i)) * ratio[i]);
        // Nothing changes with the unknown at the very onset.
        let turn = T::select(T::ZERO.lt(end.slope), end.turn() / (end.slope * end.S), T::ZERO);
        let mut C = [[T::ZERO; N]; N];
        for i in 0..N {
            for j in 0..N {
                C[i][j] = -turn * Sb[i] * Sb[j];
            }
            C[i][i] += e[i] * ratio[i];
        }
        let (C, elastic) = (from_modes::<T, N, S>(C), self.stiffness(state));
        Some(from_fn(|i| from_fn(|j| T::select(answer.yields, C[i][j], T::splat(elastic[i][j])))))
    }

    /// Computes history variables and dissipation after the fraction `part` of the time `dt`; `strain` is the strain after all of `dt`.
    /// Schemes with equilibrium beyond the end of the step accept only the fraction of the increment within the step.
    #[inline(always)]
    fn advance<T: Number, const N: usize, S: StressState<N>>(
        &self,
        _: S,
        (strain, old): (&[T; N], &MaterialHistory<T, N>),
        answer: &Answer<T, N>,
        (dt, part): (f64, f64),
        out: &mut PointResponse<T, N>,
    ) {
        let (part, half) = (T::splat(part), T::splat(0.5));
        let mut new = *old;
        if let Some(from) = old.overstress {
            let end = answer.end.map_or(T::ZERO, |end| T::select(answer.yields, end.overstress, T::ZERO));
            new.overstress = Some(from + part * (end - from));
            out.new = Some(new);
        }
        let Some(end) = &answer.end else { return };
        let only = |change: T| T::select(answer.yields, change, T::ZERO);
        // That part of the return is taken on a straight line.
        let multiplier = part * end.multiplier;
        let start = self.yielding.hardening.rise(old.accumulated).0;
        let rise = self.yielding.hardening.rise(old.accumulated + multiplier).0;
        let radius = self.yielding.radius(rise);
        let mut spent = Spent { plastic: only(half * (answer.radius + radius) * multiplier), ..Spent::ZERO };
        if let Some((from, to)) = old.overstress.zip(new.overstress) {
            spent.viscous = Some(only(half * (from * answer.radius + to * radius) * multiplier));
        }
        // ξ/R = ξ*/T: plastic strain grows by p Δλ of it, the back stress by k.
        let direction: [T; N] = from_fn(|i| answer.relative[i] / end.T(i));
        let plastic: [T; N] = from_fn(|i| T::splat(S::P[i]) * multiplier * direction[i]);
        let more = S::modes(plastic);
        let kept = |new: T, old: T| T::select(answer.yields, new, old);
        new.plastic = from_fn(|i| kept(old.plastic[i] + more[i], old.plastic[i]));
        new.accumulated = kept(old.accumulated + multiplier, old.accumulated);
        if let Some((from, old)) = answer.back.zip(old.back) {
            let back = T::splat(self.yielding.kinematic_share) * (rise - start);
            let more = S::modes(direction.map(|n| back * n));
            new.back = Some(from_fn(|i| kept(old[i] + more[i], old[i])));
            let mut stored = T::ZERO;
            (0..N).for_each(|i| stored += (from[i] + half * back * direction[i]) * plastic[i]);
            spent.stored = Some(only(stored));
        }
        if let Some(failure) = &self.failure {
            if let Some(old) = old.damage {
                // A step of no length has no rate.
                let rate = if dt > 0.0 { end.multiplier / T::splat(dt) } else { T::ZERO };
                let triaxiality = triaxiality::<T, N, S>(&out.stress);
                let damage =
                    T::gather(|lane| failure.damage(multiplier.lane(lane), triaxiality.lane(lane), rate.lane(lane)));
                new.damage = Some(kept(old + damage, old));
            }
            let gone = answer.yields & failed(failure, &new);
            if gone.any() {
                self.give_up::<T, N, S>(strain, &new, gone, &mut spent);
            }
        }
        (out.new, out.dissipation) = (Some(new), Some(spent));
    }

    /// Adds the energy of failing points to the eroded energy: elastic energy and ½ X·εᵖ of kinematic hardening (exact if linear).
    #[inline(always)]
    fn give_up<T: Number, const N: usize, S: StressState<N>>(
        &self,
        strain: &[T; N],
        new: &MaterialHistory<T, N>,
        gone: T::Mask,
        spent: &mut Spent<T>,
    ) {
        let mut kept = T::ZERO;
        if let Some(back) = &new.back {
            (0..N).for_each(|i| kept += back[i] * new.plastic[i]);
            kept = T::select(gone, T::splat(0.5) * kept, T::ZERO);
            spent.stored = spent.stored.map(|stored| stored - kept);
        }
        spent.eroded = Some(kept + T::select(gone, self.stored::<T, N, S>(strain, new), T::ZERO));
    }

    /// Derivative of the stress while nothing yields.
    pub fn stiffness<const N: usize, S: StressState<N>>(&self, _: S) -> [[f64; N]; N] {
        let e = S::moduli(&self.elastic);
        from_modes::<f64, N, S>(from_fn(|i| from_fn(|j| if i == j { e[i] } else { 0.0 })))
    }

    /// Energy per volume stored by kinematic hardening in a point of a lost element; zero for a failed point, whose energy
    /// [`MaterialLaw::respond`] has counted.
    pub fn lost<const N: usize, S: StressState<N>>(&self, state: S, history: &[f64]) -> f64 {
        if !self.is_kinematic() || self.has_failed(state, history) {
            return 0.0;
        }
        0.5 * (0..N).map(|i| history[N + 1 + i] * history[i]).sum::<f64>()
    }

    /// Accumulated plastic strain ε̄ᵖ.
    pub fn accumulated<const N: usize, S: StressState<N>>(&self, _: S, history: &[f64]) -> f64 {
        history[N]
    }

    /// ½ (ε − εᵖ)·C (ε − εᵖ), per volume.
    pub fn elastic_energy<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        history: &[f64],
    ) -> f64 {
        if self.has_failed(state, history) {
            return 0.0;
        }
        self.stored::<f64, N, S>(strain, &self.recall(state, history, |_| 0))
    }

    /// The elastic energy of a point, per volume, whether it has failed or not.
    #[inline(always)]
    fn stored<T: Number, const N: usize, S: StressState<N>>(
        &self,
        strain: &[T; N],
        history: &MaterialHistory<T, N>,
    ) -> T {
        let e = S::moduli(&self.elastic);
        let elastic = S::modes(from_fn(|i| strain[i] - history.plastic[i]));
        let mut sum = T::ZERO;
        (0..N).for_each(|i| sum += T::splat(e[i]) * elastic[i] * elastic[i]);
        T::splat(0.5) * sum
    }

    #[inline(always)]
    fn is_kinematic(&self) -> bool {
        self.yielding.kinematic_share > 0.0
    }

    /// True where failure depends on more than plastic strain.
    #[inline(always)]
    fn sums_damage(&self) -> bool {
        self.failure.as_ref().is_some_and(FailureCriterion::sums_damage)
    }

    /// The return at `strain` of the points that have not `failed`.
    #[inline(always)]
    fn answer<T: Number, const N: usize, S: StressState<N>>(
        &self,
        strain: &[T; N],
        dt: f64,
        old: &MaterialHistory<T, N>,
        failed: Option<T::Mask>,
    ) -> Answer<T, N> {
        let e = S::moduli(&self.elastic);
        let elastic = S::modes(from_fn(|i| strain[i] - old.plastic[i]));
        let mut relative: [T; N] = from_fn(|i| T::splat(e[i]) * elastic[i]);
        let back = old.back.map(S::modes);
        if let Some(back) = &back {
            (0..N).for_each(|i| relative[i] -= back[i]);
        }
        let (first, square) = squares::<T, N, S>(&relative);
        let rise = self.yielding.hardening.rise(old.accumulated).0;
        let radius = self.yielding.radius(rise);
        let mut yields = (radius * radius).lt(square);
        if let Some(failed) = failed {
            yields = yields & !failed;
        }
        let mut out = Answer { relative, back, radius, yields, end: None };
        if !yields.any() {
            return out;
        }
        let square = T::select(yields, square, T::ONE);
        let (mut rho, mut first) = (square.sqrt(), first / square);
        if (!square.lt(T::splat(f64::INFINITY))).any() {
            (out.yields, rho, first) = far_out::<T, N, S>(&relative, (yields, rho, first));
            if !out.yields.any() {
                return out;
            }
        }
        let trial = Trial {
            yields: out.yields,
            rho,
            share: [first, T::ONE - first],
            c: [S::P[0] * e[0], 3.0 * self.elastic.G],
            accumulated: old.accumulated,
            rise,
            radius,
        };
        out.end = Some(self.yielding.solve(&trial, dt, old.overstress.unwrap_or(T::ZERO)));
        out
    }
}

/// True where a point has failed by its history.
#[inline(always)]
fn failed<T: Number, const N: usize>(failure: &FailureCriterion, history: &MaterialHistory<T, N>) -> T::Mask {
    match history.damage {
        Some(damage) => T::ONE.le(damage),
        None => T::splat(failure.strain).le(history.accumulated),
    }
}

/// σ_m/σ_eq; 0 without stress.
fn triaxiality<T: Number, const N: usize, S: StressState<N>>(stress: &[T; N]) -> T {
    let equivalent = squares::<T, N, S>(&S::modes(*stress)).1.sqrt();
    let mean = T::gather(|lane| S::mean(&stress.map(|stress| stress.lane(lane))));
    T::select(T::ZERO.lt(equivalent), mean / equivalent, T::ZERO)
}

/// p₀ ξ₀², and Σ pᵢ ξᵢ².
#[inline(always)]
fn squares<T: Number, const N: usize, S: StressState<N>>(relative: &[T; N]) -> (T, T) {
    let part = |i: usize| T::splat(S::P[i]) * relative[i] * relative[i];
    let (first, mut sum) = (part(0), part(0));
    (1..N).for_each(|i| sum += part(i));
    (first, sum)
}

/// ρ and the share of ρ² in the first mode where squared stresses overflow. Where ρ overflows too, the point keeps the trial stress and
/// does not yield.
#[cold]
fn far_out<T: Number, const N: usize, S: StressState<N>>(
    relative: &[T; N],
    (yields, rho, share): (T::Mask, T, T),
) -> (T::Mask, T, T) {
    let (large, mut largest) = (!rho.lt(T::splat(f64::INFINITY)), T::ZERO);
    relative.iter().for_each(|xi| largest = largest.max(xi.abs()));
    let (first, sum) = squares::<T, N, S>(&relative.map(|xi| xi / largest));
    let scaled = largest * sum.sqrt();
    let yields = yields & (!large | scaled.lt(T::splat(f64::INFINITY)));
    (yields, T::select(large, scaled, rho), T::select(large, first / sum, share))
}

/// A stiffness from modes to components: rows, then columns.
#[inline(always)]
fn from_modes<T: Number, const N: usize, S: StressState<N>>(C: [[T; N]; N]) -> [[T; N]; N] {
    let transposed = |C: [[T; N]; N]| -> [[T; N]; N] { from_fn(|i| from_fn(|j| C[j][i])) };
    transposed(transposed(C.map(S::modes)).map(S::modes))
}
