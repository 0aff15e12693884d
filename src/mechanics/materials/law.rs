//! Stress from strain at a point, and what a point remembers: the law that serves all stress states.
//!
//! Backward Euler over the step, with the tangent of exactly that (13)-(18); any increment converges.

use super::constants::ElasticConstants;
use super::dissipation::Dissipation;
use super::failure::FailureCriterion;
use super::hardening::Hardening;
use super::overstress::Viscosity;
use super::return_mapping::{ReturnPoint, Trial, Yielding};
use super::side_by_side::PlainPlasticity;
use super::stress_state::StressState;

/// An elastic-plastic or elastic-viscoplastic material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialLaw {
    elastic: ElasticConstants,
    yielding: Yielding,
    /// When a point carries nothing more; `None` for a material that does not fail.
    failure: Option<FailureCriterion>,
}

/// Part of the elastic stiffness that the tangent keeps where a material has failed. Its stress is zero; a node that nothing else holds
/// then still has a place in the equations, and the matrix of a structure that stands without it is not felt to change.
pub const FAILED_STIFFNESS: f64 = 1e-8;

/// Stress at the end of a step by modes: the trial, and the return if it yields.
struct Answer<const N: usize> {
    /// ξ*.
    relative: [f64; N],
    /// X at the beginning of the step.
    back: [f64; N],
    /// i there.
    radius: f64,
    yielding: Option<ReturnPoint>,
}

impl<const N: usize> Answer<N> {
    /// σᵢ = Xᵢ + ξᵢ* (R + k)/Tᵢ.
    #[inline(always)]
    fn stress(&self) -> [f64; N] {
        let ratio = |i| self.yielding.as_ref().map_or(1.0, |y| y.S / y.T(i));
        std::array::from_fn(|i| self.back[i] + self.relative[i] * ratio(i))
    }
}

impl MaterialLaw {
    /// The caller has checked that E > 0, −1 < ν ≤ ½, 0 ≤ kinematic share ≤ 1, yield stress, exponent > 0 and modulus,
    /// fluidity ≥ 0. ν counts in plane stress and shear only.
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

    /// The same material, which fails.
    pub fn failing_at(self, failure: FailureCriterion) -> MaterialLaw {
        MaterialLaw { failure: Some(failure), ..self }
    }

    /// True for a material whose points may fail.
    pub fn can_fail(&self) -> bool {
        self.failure.is_some()
    }

    /// True where a point has failed by its history: its stress is zero from then on.
    #[inline(always)]
    pub fn has_failed<const N: usize, S: StressState<N>>(&self, _: S, history: &[f64]) -> bool {
        match &self.failure {
            None => false,
            Some(failure) if failure.sums_damage() => history[self.damage_place::<N>()] >= 1.0,
            Some(failure) => history[N] >= failure.strain,
        }
    }

    /// The elastic constants.
    pub fn elastic(&self) -> &ElasticConstants {
        &self.elastic
    }

    /// Numbers of history per point: plastic strains, accumulated plastic strain, back stresses if there is a kinematic
    /// share, damage if failure depends on stress or rate, overstress of the last state if viscous.
    pub fn history<const N: usize, S: StressState<N>>(&self, _: S) -> usize {
        let damage = self.failure.as_ref().is_some_and(FailureCriterion::sums_damage);
        self.damage_place::<N>() + usize::from(damage) + usize::from(self.yielding.viscosity.is_some())
    }

    /// The place of damage in the history of a point, where there is such a number.
    #[inline(always)]
    fn damage_place<const N: usize>(&self) -> usize {
        N + 1 + if self.is_kinematic() { N } else { 0 }
    }

    /// Stress at `strain`, `dt` after the state in `old`. Not finite where the strain or its elastic stress is not.
    #[inline]
    pub fn stress<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        dt: f64,
        old: &[f64],
    ) -> [f64; N] {
        if self.has_failed(state, old) {
            return [0.0; N];
        }
        S::modes(self.answer::<N, S>(strain, dt, old).stress())
    }

    /// Stress, and its symmetric derivative with respect to the strain at the end of the step.
    #[inline]
    pub fn stress_and_tangent<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        dt: f64,
        old: &[f64],
    ) -> ([f64; N], [[f64; N]; N]) {
        let (stress, C) = self.linearise(state, strain, dt, old);
        (stress, C.unwrap_or_else(|| self.stiffness(state)))
    }

    /// The stress and the tangent of [`MaterialLaw::stress_and_tangent`], with `None` for the elastic stiffness.
    #[inline]
    pub fn linearise<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        dt: f64,
        old: &[f64],
    ) -> ([f64; N], Option<[[f64; N]; N]>) {
        if self.has_failed(state, old) {
            return ([0.0; N], Some(self.stiffness(state).map(|row| row.map(|c| FAILED_STIFFNESS * c))));
        }
        let answer = self.answer::<N, S>(strain, dt, old);
        let C = answer.yielding.as_ref().map(|y| {
            // With bᵢ = pᵢ eᵢ ξᵢ*/Tᵢ² the yield condition keeps Σ bᵢ dεᵢ = slope ∂, and
            // dσᵢ = eᵢ S/Tᵢ dεᵢ − bᵢ (S ∂Δλ − Δλ ∂S).
            let e = S::moduli(&self.elastic);
            let ratio: [f64; N] = std::array::from_fn(|i| y.S / y.T(i));
            let Sb: [f64; N] = std::array::from_fn(|i| S::P[i] * e[i] * (answer.relative[i] / y.T(i)) * ratio[i]);
            // Nothing changes with the unknown at the very onset.
            let turn = if y.slope > 0.0 { y.turn / (y.slope * y.S) } else { 0.0 };
            let mut C = [[0.0; N]; N];
            for i in 0..N {
                for j in 0..N {
                    C[i][j] = -turn * Sb[i] * Sb[j];
                }
                C[i][i] += e[i] * ratio[i];
            }
            from_modes::<N, S>(C)
        });
        (S::modes(answer.stress()), C)
    }

    /// Derivative of the stress while nothing yields.
    pub fn stiffness<const N: usize, S: StressState<N>>(&self, _: S) -> [[f64; N]; N] {
        let e = S::moduli(&self.elastic);
        from_modes::<N, S>(std::array::from_fn(|i| std::array::from_fn(|j| if i == j { e[i] } else { 0.0 })))
    }

    /// Writes the history after `part` of the time `dt` since the state in `old`, at whose end `strain` is; answers with the
    /// stress at the end and what became of the plastic work in the part. A scheme that writes equilibrium beyond the end of
    /// its step keeps that part of what equilibrium asked for.
    #[inline]
    pub fn advance<const N: usize, S: StressState<N>>(
        &self,
        state: S,
        strain: &[f64; N],
        (dt, part): (f64, f64),
        old: &[f64],
        new: &mut [f64],
    ) -> ([f64; N], Dissipation) {
        if self.has_failed(state, old) {
            new.copy_from_slice(old);
            return ([0.0; N], Dissipation::default());
        }
        let answer = self.answer::<N, S>(strain, dt, old);
        let stress = S::modes(answer.stress());
        new.copy_from_slice(old);
        let overstress = answer.yielding.as_ref().map_or(0.0, |y| y.overstress);
        let from = self.yielding.viscosity.and_then(|_| new.last_mut()).map_or(0.0, |v| {
            let from = *v;
            *v += part * (overstress - from);
            from
        });
        let Some(y) = answer.yielding else { return (stress, Dissipation::default()) };
        // That part of the return is taken on a straight line.
        let (multiplier, to) = (part * y.multiplier, from + part * (overstress - from));
        let rise = self.yielding.hardening.rise(old[N] + multiplier).0;
        let back = self.yielding.kinematic_share * (rise - self.yielding.hardening.rise(old[N]).0);
        let radius = self.yielding.hardening.initial() + (1.0 - self.yielding.kinematic_share) * rise;
        let mut spent = Dissipation {
            plastic: 0.5 * (answer.radius + radius) * multiplier,
            viscous: 0.5 * (from * answer.radius + to * radius) * multiplier,
            ..Dissipation::default()
        };
        // ξ/R = ξ*/T: plastic strain grows by p Δλ of it, the back stress by k.
        let direction: [f64; N] = std::array::from_fn(|i| answer.relative[i] / y.T(i));
        let plastic: [f64; N] = std::array::from_fn(|i| S::P[i] * multiplier * direction[i]);
        add(&mut new[..N], &S::modes(plastic));
        new[N] += multiplier;
        if self.is_kinematic() {
            add(&mut new[N + 1..], &S::modes(direction.map(|n| back * n)));
            let mean = |i: usize| answer.back[i] + 0.5 * back * direction[i];
            spent.stored = (0..N).map(|i| mean(i) * plastic[i]).sum();
        }
        if let Some(failure) = self.failure.as_ref().filter(|failure| failure.sums_damage()) {
            // A step of no length has no rate.
            let rate = if dt > 0.0 { y.multiplier / dt } else { 0.0 };
            new[self.damage_place::<N>()] += failure.damage(multiplier, triaxiality::<N, S>(&stress), rate);
        }
        if self.has_failed(state, new) {
            self.give_up(state, strain, new, &mut spent);
        }
        (stress, spent)
    }

    /// Books what a point that fails has stored: its elastic energy, and what kinematic hardening has kept, ½ X·εᵖ, which is exact where
    /// that is linear.
    #[cold]
    fn give_up<const N: usize, S: StressState<N>>(
        &self,
        _: S,
        strain: &[f64; N],
        new: &[f64],
        spent: &mut Dissipation,
    ) {
        let kept = self.kept::<N>(new);
        spent.stored -= kept;
        spent.eroded += kept + self.stored::<N, S>(strain, new);
    }

    /// What kinematic hardening has kept, per volume.
    fn kept<const N: usize>(&self, history: &[f64]) -> f64 {
        if !self.is_kinematic() {
            return 0.0;
        }
        0.5 * (0..N).map(|i| history[N + 1 + i] * history[i]).sum::<f64>()
    }

    /// What kinematic hardening has kept in a point that is lost, per volume: nothing where it has failed, which [`MaterialLaw::advance`]
    /// has booked.
    pub fn lost<const N: usize, S: StressState<N>>(&self, state: S, history: &[f64]) -> f64 {
        if self.has_failed(state, history) { 0.0 } else { self.kept::<N>(history) }
    }

    /// The law for eight points at once; `None` where it has more than linear isotropic hardening.
    pub fn plain<const N: usize, S: StressState<N>>(&self, _: S) -> Option<PlainPlasticity<N>> {
        let Hardening::Linear { yield_stress, modulus } = self.yielding.hardening else { return None };
        if self.can_fail() || self.is_kinematic() || self.yielding.viscosity.is_some() {
            return None;
        }
        let moduli = S::moduli(&self.elastic);
        let c = [S::P[0] * moduli[0], 3.0 * self.elastic.G];
        Some(PlainPlasticity { moduli, c, initial: yield_stress, modulus })
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
        if self.has_failed(state, history) { 0.0 } else { self.stored::<N, S>(strain, history) }
    }

    /// The elastic energy of a point, per volume, whether it has failed or not.
    fn stored<const N: usize, S: StressState<N>>(&self, strain: &[f64; N], history: &[f64]) -> f64 {
        let e = S::moduli(&self.elastic);
        let elastic: [f64; N] = elastic_strain::<N, S>(strain, history);
        0.5 * (0..N).map(|i| e[i] * elastic[i] * elastic[i]).sum::<f64>()
    }

    fn is_kinematic(&self) -> bool {
        self.yielding.kinematic_share > 0.0
    }

    #[inline(always)]
    fn answer<const N: usize, S: StressState<N>>(&self, strain: &[f64; N], dt: f64, old: &[f64]) -> Answer<N> {
        let e = S::moduli(&self.elastic);
        let elastic = elastic_strain::<N, S>(strain, old);
        let back = if self.is_kinematic() { S::modes(std::array::from_fn(|i| old[N + 1 + i])) } else { [0.0; N] };
        let relative: [f64; N] = std::array::from_fn(|i| e[i] * elastic[i] - back[i]);
        let square = squares::<N, S>(&relative).iter().sum::<f64>();
        let rise = self.yielding.hardening.rise(old[N]).0;
        let radius = self.yielding.hardening.initial() + (1.0 - self.yielding.kinematic_share) * rise;
        let yielding = if square > radius * radius {
            trial_stress::<N, S>(&relative).map(|(rho, share)| {
                let c = [S::P[0] * e[0], 3.0 * self.elastic.G];
                let last = if self.yielding.viscosity.is_some() { old[old.len() - 1] } else { 0.0 };
                self.yielding.solve(&Trial { rho, share, c, accumulated: old[N], rise, radius }, dt, last)
            })
        } else {
            None
        };
        Answer { relative, back, radius, yielding }
    }
}

/// σ_m/σ_eq; 0 without stress.
fn triaxiality<const N: usize, S: StressState<N>>(stress: &[f64; N]) -> f64 {
    let equivalent = squares::<N, S>(&S::modes(*stress)).iter().sum::<f64>().sqrt();
    if equivalent > 0.0 { S::mean(stress) / equivalent } else { 0.0 }
}

/// pᵢ ξᵢ².
#[inline(always)]
fn squares<const N: usize, S: StressState<N>>(relative: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| S::P[i] * relative[i] * relative[i])
}

/// ρ, and the shares of ρ² in the first mode and the others. None where ρ is not finite: then the trial is the answer.
#[inline(always)]
fn trial_stress<const N: usize, S: StressState<N>>(relative: &[f64; N]) -> Option<(f64, [f64; 2])> {
    let parts = squares::<N, S>(relative);
    let sum = parts.iter().sum::<f64>();
    if sum < f64::INFINITY {
        return Some((sum.sqrt(), [parts[0] / sum, 1.0 - parts[0] / sum]));
    }
    // Only squares are out of range, or the stresses too.
    let largest = relative.iter().fold(0.0, |m: f64, xi| m.max(xi.abs()));
    let parts = squares::<N, S>(&relative.map(|xi| xi / largest));
    let sum = parts.iter().sum::<f64>();
    let rho = largest * sum.sqrt();
    rho.is_finite().then(|| (rho, [parts[0] / sum, 1.0 - parts[0] / sum]))
}

/// ε − εᵖ by modes.
#[inline(always)]
fn elastic_strain<const N: usize, S: StressState<N>>(strain: &[f64; N], history: &[f64]) -> [f64; N] {
    S::modes(std::array::from_fn(|i| strain[i] - history[i]))
}

/// A stiffness from modes to components: rows, then columns.
#[inline(always)]
fn from_modes<const N: usize, S: StressState<N>>(C: [[f64; N]; N]) -> [[f64; N]; N] {
    let transposed = |C: [[f64; N]; N]| std::array::from_fn(|i| std::array::from_fn(|j| C[j][i]));
    transposed(transposed(C.map(S::modes)).map(S::modes))
}

#[inline(always)]
fn add(sum: &mut [f64], v: &[f64]) {
    sum.iter_mut().zip(v).for_each(|(s, v)| *s += v);
}
