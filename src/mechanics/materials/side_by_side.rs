//! Eight points side by side: the return of [`super::return_mapping`] for a plastic law without viscosity, failure and kinematic hardening
//! and with linear hardening. Each lane has the bits that [`super::MaterialLaw::advance`] gives it; a lane in which Newton's steps do not
//! suffice is left to that.

use super::return_mapping::{STEEP, TOLERANCE};
use super::stress_state::StressState;
use base::math::lanes::Lanes;
use std::array::from_fn;

/// The law of a plastic material in one stress state.
#[derive(Debug, Clone, Copy)]
pub struct PlainPlasticity<const N: usize> {
    /// Elastic moduli by modes.
    pub moduli: [f64; N],
    /// c of the first mode and of the others.
    pub(super) c: [f64; 2],
    /// Yield stress before any plastic strain.
    pub(super) initial: f64,
    /// Hardening modulus.
    pub(super) modulus: f64,
}

/// What eight points come to at the end of a step.
pub struct PointsAdvanced<const N: usize> {
    /// Stress.
    pub stress: [Lanes; N],
    /// Plastic strain.
    pub plastic: [Lanes; N],
    /// Accumulated plastic strain.
    pub accumulated: Lanes,
    /// Energy dissipated by yielding, per volume.
    pub spent: Lanes,
    /// A bit for each lane that is left to be computed by itself.
    pub left: u32,
}

/// The derivative of the stress of eight points.
pub struct PointsTangent<const N: usize> {
    /// Derivative of the stress by the strain, in the lanes that yield.
    pub stiffness: [[Lanes; N]; N],
    /// All bits set in the lanes that yield.
    pub yields: Lanes,
    /// A bit for each lane that is left to be computed by itself.
    pub left: u32,
}

/// The return of eight points.
struct Answer<const N: usize> {
    /// ξ*, by modes.
    relative: [Lanes; N],
    /// R at the beginning of the step.
    radius: Lanes,
    /// All bits set in the lanes that yield.
    yields: Lanes,
    /// The multipliers and the points of the return, where one yields.
    end: Option<(Lanes, Return)>,
    /// A bit for each lane that is left to be computed by itself.
    left: u32,
}

impl<const N: usize> Answer<N> {
    /// Stress in components, of the lanes that yield as well as of the others.
    #[inline(always)]
    fn stress<S: StressState<N>>(&self) -> [Lanes; N] {
        let trial = S::modes_side_by_side(self.relative);
        let Some((_, at)) = &self.end else { return trial };
        let stress = S::modes_side_by_side(from_fn(|i| self.relative[i] * (at.S / at.T(i))));
        from_fn(|i| self.yields.select(stress[i], trial[i]))
    }
}

/// A point of the return, see [`super::return_mapping`].
struct Return {
    T: [Lanes; 2],
    S: Lanes,
    sum: Lanes,
    slope: Lanes,
}

impl Return {
    /// T of a mode.
    #[inline(always)]
    fn T(&self, mode: usize) -> Lanes {
        self.T[usize::from(mode > 0)]
    }
}

/// The number of iterations after which a lane is left.
const MOST: usize = 12;

impl<const N: usize> PlainPlasticity<N> {
    #[inline(always)]
    fn radius(&self, accumulated: Lanes) -> Lanes {
        Lanes::splat(self.initial) + Lanes::splat(self.modulus) * accumulated
    }

    #[inline(always)]
    fn point(&self, accumulated: Lanes, rho: Lanes, share: &[Lanes; 2], multiplier: Lanes) -> Return {
        let S = self.radius(accumulated + multiplier);
        let dS = Lanes::splat(self.modulus) * multiplier;
        let c = self.c.map(Lanes::splat);
        let T = c.map(|c| S + c * multiplier);
        let inverse = T.map(|T| Lanes::ONE / T);
        let part: [Lanes; 2] = from_fn(|j| {
            let ratio = rho * inverse[j];
            share[j] * (ratio * ratio)
        });
        let slope: [Lanes; 2] = from_fn(|j| part[j] * ((dS + c[j] * multiplier) * inverse[j]));
        Return { T, S, sum: part[0] + part[1], slope: slope[0] + slope[1] }
    }

    /// The return at `strain`, from the plastic strains and their accumulated value before.
    #[inline(always)]
    fn answer<S: StressState<N>>(&self, strain: &[Lanes; N], plastic: &[Lanes; N], accumulated: Lanes) -> Answer<N> {
        let elastic = S::modes_side_by_side(from_fn(|i| strain[i] - plastic[i]));
        // The sum with a back stress of zero, as a law that may have one takes it.
        let relative: [Lanes; N] = from_fn(|i| Lanes::splat(self.moduli[i]) * elastic[i]);
        let parts: [Lanes; N] = from_fn(|i| Lanes::splat(S::P[i]) * relative[i] * relative[i]);
        let mut square = parts[0];
        parts[1..].iter().for_each(|part| square += *part);
        let radius = self.radius(accumulated);
        let yields = square.simd_gt(radius * radius);
        let yielding = yields.to_bitmask();
        let mut out = Answer { relative, radius, yields, end: None, left: 0 };
        if yielding == 0 {
            return out;
        }
        // Lanes that do not yield go along with numbers that do no harm.
        let square = yields.select(square, Lanes::ONE);
        out.left = yielding & !square.simd_lt(Lanes::splat(f64::INFINITY)).to_bitmask();
        let (rho, first) = (square.sqrt(), parts[0] / square);
        let share = [first, Lanes::ONE - first];
        let (multiplier, at, hard) = self.root(accumulated, rho, &share, (radius, yielding & !out.left));
        out.left |= hard;
        out.end = Some((multiplier, at));
        out
    }

    /// Stress and history variables at `strain`, from the plastic strains and their accumulated value before.
    #[inline(always)]
    pub fn advance<S: StressState<N>>(
        &self,
        strain: &[Lanes; N],
        plastic: &[Lanes; N],
        accumulated: Lanes,
    ) -> PointsAdvanced<N> {
        let answer = self.answer::<S>(strain, plastic, accumulated);
        let (stress, left) = (answer.stress::<S>(), answer.left);
        let mut out = PointsAdvanced { stress, plastic: *plastic, accumulated, spent: Lanes::ZERO, left };
        let Answer { relative, radius, yields, end: Some((multiplier, at)), .. } = answer else { return out };
        let end = self.radius(accumulated + multiplier);
        let half = Lanes::splat(0.5);
        out.spent = yields.select(half * (radius + end) * multiplier, Lanes::ZERO);
        let more = S::modes_side_by_side(from_fn(|i| Lanes::splat(S::P[i]) * multiplier * (relative[i] / at.T(i))));
        out.plastic = from_fn(|i| yields.select(plastic[i] + more[i], plastic[i]));
        out.accumulated = yields.select(accumulated + multiplier, accumulated);
        out
    }

    /// Stress at `strain` and its derivative, as [`super::MaterialLaw::linearise`] has them; `None` where no lane yields.
    #[inline(always)]
    pub fn linearise<S: StressState<N>>(
        &self,
        strain: &[Lanes; N],
        plastic: &[Lanes; N],
        accumulated: Lanes,
    ) -> ([Lanes; N], Option<PointsTangent<N>>) {
        let answer = self.answer::<S>(strain, plastic, accumulated);
        let stress = answer.stress::<S>();
        let Some((multiplier, at)) = &answer.end else { return (stress, None) };
        let e = self.moduli.map(Lanes::splat);
        let ratio: [Lanes; N] = from_fn(|i| at.S / at.T(i));
        let Sb: [Lanes; N] = from_fn(|i| Lanes::splat(S::P[i]) * e[i] * (answer.relative[i] / at.T(i)) * ratio[i]);
        let change = *multiplier - *multiplier * (Lanes::splat(self.modulus) * *multiplier / at.S);
        // Nothing changes with the unknown at the very onset.
        let turn = at.slope.simd_gt(Lanes::ZERO).select(change / (at.slope * at.S), Lanes::ZERO);
        let modes: [[Lanes; N]; N] = from_fn(|i| {
            from_fn(|j| {
                let across = Lanes::ZERO - turn * Sb[i] * Sb[j];
                if i == j { across + e[i] * ratio[i] } else { across }
            })
        });
        let transposed = |C: [[Lanes; N]; N]| -> [[Lanes; N]; N] { from_fn(|i| from_fn(|j| C[j][i])) };
        let once = transposed(modes.map(S::modes_side_by_side));
        let stiffness = transposed(once.map(S::modes_side_by_side));
        (stress, Some(PointsTangent { stiffness, yields: answer.yields, left: answer.left }))
    }

    /// The multipliers at which the yield condition holds, with the point there, and the lanes of `wanted` in which they are not found.
    #[inline(always)]
    fn root(
        &self,
        accumulated: Lanes,
        rho: Lanes,
        share: &[Lanes; 2],
        (radius, wanted): (Lanes, u32),
    ) -> (Lanes, Return, u32) {
        let (infinity, modulus) = (Lanes::splat(f64::INFINITY), Lanes::splat(self.modulus));
        let c = self.c.map(|c| Lanes::splat(c) + modulus);
        let mut x = (rho - radius).fast_max(Lanes::ZERO) / (share[0] * c[0] + share[1] * c[1]);
        let (mut low, mut high, mut last) = (Lanes::ZERO, infinity, infinity);
        let mut point = self.point(accumulated, rho, share, x);
        let (mut active, mut hard) = (wanted, 0);
        for _ in 0..MOST {
            let misfit = Lanes::ONE - point.sum.sqrt();
            let step = point.sum * misfit / point.slope;
            let moves = step.abs().simd_gt(Lanes::splat(2.0 * f64::EPSILON));
            let bound = moves.select(Lanes::splat(TOLERANCE), Lanes::splat(STEEP));
            active &= !misfit.abs().simd_le(bound).to_bitmask();
            if active == 0 {
                return (x, point, hard);
            }
            let above = misfit.simd_gt(Lanes::ZERO);
            (high, low) = (above.select(x, high), above.select(low, x));
            let next = x * (Lanes::ONE - step);
            let newton =
                moves & misfit.abs().simd_le(Lanes::splat(0.5) * last) & low.simd_lt(next) & next.simd_lt(high);
            hard |= active & !newton.to_bitmask();
            active &= !hard & !(next - x).abs().simd_le(Lanes::splat(f64::EPSILON) * x).to_bitmask();
            if active == 0 {
                return (x, point, hard);
            }
            let goes: Lanes = base::math::lanes::mask(active);
            x = goes.select(next, x);
            last = misfit.abs();
            point = self.point(accumulated, rho, share, x);
        }
        (x, point, hard | active)
    }
}
