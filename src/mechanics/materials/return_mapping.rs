//! The return to the yield surface: one equation for all stress states, with and without viscosity.
//!
//! With ξ = σ − X the stress relative to the back stress, backward Euler gives in the modes of [`super::stress_state`]
//!
//! ```text
//!  ξᵢ = ξᵢ* R/Tᵢ,   Tᵢ = R + k + cᵢ Δλ,   Σ pᵢ (ξᵢ*/Tᵢ)² = 1,
//! ```
//!
//! ξ* is the trial, R = i (1 + v) the radius of the return, i its part without overstress and k the growth of the back stress (Xᵢ += k
//! ξᵢ/R). R, k and T follow from the multiplier Δλ, and viscosity ties Δλ to v: Δλ = γΔt φ(v). Without it v = 0. One equation is solved per
//! point. A point has bitwise the same result alone and among eight. After Simo & Hughes, Computational Inelasticity (1998), 3.3 and 3.4.

use super::hardening::Hardening;
use super::overstress::{Overstress, Viscosity};
use base::math::number::{Mask, Number};

/// The yield condition of a material: hardening and viscosity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Yielding {
    /// Hardening by the accumulated plastic strain.
    pub hardening: Hardening,
    /// β, the kinematic share of the hardening: it shifts the yield surface (Prager) instead of widening it.
    pub kinematic_share: f64,
    /// Viscosity; `None` for a rate-independent material.
    pub viscosity: Option<Viscosity>,
}

/// The numbers of a trial stress on which the multiplier depends.
pub(super) struct Trial<T: Number> {
    /// The points that yield; results for the others are discarded.
    pub yields: T::Mask,
    /// ρ*.
    pub rho: T,
    /// Shares of ρ*² in the first mode and in the others.
    pub share: [T; 2],
    /// c of the first mode and of the others.
    pub c: [f64; 2],
    /// Accumulated plastic strain ε̄ᵖ at the beginning of the step.
    pub accumulated: T,
    /// Rise of the yield stress at the beginning of the step.
    pub rise: T,
    /// Radius i of the yield surface at the beginning of the step.
    pub radius: T,
}

/// A point of the return.
#[derive(Clone, Copy)]
pub(super) struct ReturnPoint<T> {
    /// Δλ.
    pub multiplier: T,
    /// Overstress v.
    pub overstress: T,
    /// T of the first mode and of the others.
    pub T: [T; 2],
    /// R + k.
    pub S: T,
    /// Σ pᵢ (ξᵢ*/Tᵢ)².
    pub sum: T,
    /// Σ pᵢ (ξᵢ*/Tᵢ)² ∂Tᵢ/Tᵢ; ∂ is the change per relative change of the unknown, finite even if Δλ, v and γ differ by hundreds of decades.
    pub slope: T,
    /// ∂Δλ and ∂S.
    change: [T; 2],
}

/// A number and its change per relative change of the unknown.
type Varied<T> = [T; 2];

/// What ties the multiplier to the overstress.
struct Flow<T> {
    overstress: Overstress,
    /// γΔt.
    rate: T,
    /// The largest multiplier.
    most: T,
    /// False where the step has no length, or the fluidity is zero: nothing flows.
    flows: bool,
}

impl<T: Number> ReturnPoint<T> {
    /// T of a mode.
    #[inline(always)]
    pub fn T(&self, mode: usize) -> T {
        self.T[usize::from(mode > 0)]
    }

    /// ∂Δλ − Δλ ∂S/S.
    #[inline(always)]
    pub fn turn(&self) -> T {
        self.change[0] - self.multiplier * (self.change[1] / self.S)
    }
}

/// Residual of the yield condition, relative to the stress, at convergence; its rounding error is about 1e-15.
const TOLERANCE: f64 = 1e-14;

/// Residual accepted where the unknown changes by rounding only and the stress is steep in it.
const STEEP: f64 = 1e-6;

impl Yielding {
    /// Radius i of the yield surface, from the rise of the yield stress.
    #[inline(always)]
    pub fn radius<T: Number>(&self, rise: T) -> T {
        let initial = T::splat(self.hardening.initial());
        match self.kinematic_share > 0.0 {
            true => initial + T::splat(1.0 - self.kinematic_share) * rise,
            false => initial + rise,
        }
    }

    /// Finds the point where the yield condition holds at the end of the step; `last` is the overstress at its
    /// beginning.
    #[inline(always)]
    pub fn solve<T: Number>(&self, trial: &Trial<T>, dt: f64, last: T) -> ReturnPoint<T> {
        match self.viscosity {
            None => self.plastic(trial, trial.yields),
            Some(viscosity) => self.viscous(trial, viscosity, dt, last),
        }
    }

    /// The return without viscosity of the points `wanted`.
    #[inline(always)]
    fn plastic<T: Number>(&self, trial: &Trial<T>, wanted: T::Mask) -> ReturnPoint<T> {
        // Newton's first step, from Δλ = 0. A single mode with linear hardening has arrived there.
        let slope = self.hardening.rise(trial.accumulated).1;
        let c = trial.c.map(|c| T::splat(c) + slope);
        let first = (trial.rho - trial.radius).max(T::ZERO) / (trial.share[0] * c[0] + trial.share[1] * c[1]);
        self.root(trial, (first, wanted), None)
    }

    fn viscous<T: Number>(
        &self,
        trial: &Trial<T>,
        Viscosity { fluidity, overstress }: Viscosity,
        dt: f64,
        last: T,
    ) -> ReturnPoint<T> {
        // Beyond 1e300 nothing but rounding is left of v.
        let flows = fluidity * dt > 0.0;
        let rate = T::splat((fluidity * dt).min(1e300));
        let elastic = (trial.rho / trial.radius - T::ONE).max(T::ZERO);
        // Where it flows on as before, the last overstress is near. Otherwise the search starts from the upper bound, where the equation is
        // steep: the rate-independent return bounds φ, the elastic stress bounds v.
        let bound = (trial.rho - trial.radius).max(T::ZERO) / T::splat(trial.c[0].min(trial.c[1]));
        let flow = rate * overstress.phi(last).0;
        let near = last.lt(elastic) & (T::splat(1e-3) * bound).lt(flow) & flow.lt(bound);
        let (mut most, mut start) = (T::splat(2.0) * bound, last);
        let far = trial.yields & !near;
        if far.any() {
            let plastic = self.plastic(trial, far).multiplier;
            most = T::select(near, most, plastic);
            start = T::select(near, start, elastic.min(overstress.inverse(plastic / rate)));
        }
        self.root(trial, (start, trial.yields), Some(&Flow { overstress, rate, most, flows }))
    }

    /// The point of the return at the unknown `x`: Δλ, or v where it `flow`s.
    #[inline(always)]
    fn at<T: Number>(&self, trial: &Trial<T>, x: T, flow: Option<&Flow<T>>) -> ReturnPoint<T> {
        let Some(Flow { overstress, rate, most, flows }) = flow else { return self.point(trial, [x, x], None) };
        let (phi, change) = overstress.phi(x);
        // The bounds add only rounding where φ is finite, and keep the result finite elsewhere.
        let bounded = [(*rate * phi).min(*most), (*rate * change).min(T::splat(f64::MAX))];
        self.point(trial, if *flows { bounded } else { [T::ZERO; 2] }, Some([x, x]))
    }

    /// The point of the return with a multiplier and an overstress.
    #[inline(always)]
    fn point<T: Number>(
        &self,
        trial: &Trial<T>,
        [multiplier, dmultiplier]: Varied<T>,
        overstress: Option<Varied<T>>,
    ) -> ReturnPoint<T> {
        let (rise, slope) = self.hardening.rise(trial.accumulated + multiplier);
        let (radius, drise) = (self.radius(rise), slope * dmultiplier);
        let (mut S, mut dS) = (radius, drise);
        if self.kinematic_share > 0.0 {
            dS = T::splat(1.0 - self.kinematic_share) * drise;
        }
        if let Some([v, dv]) = overstress {
            (S, dS) = (S * (T::ONE + v), dS * (T::ONE + v) + radius * dv);
        }
        if self.kinematic_share > 0.0 {
            let share = T::splat(self.kinematic_share);
            (S, dS) = (S + share * (rise - trial.rise), dS + share * drise);
        }
        let c = trial.c.map(T::splat);
        let all = c.map(|c| S + c * multiplier);
        // Ratios to T, never powers of stresses: nothing overflows before the trial stress does.
        let inverse = all.map(|T| T::ONE / T);
        let part = [0, 1].map(|j| {
            let ratio = trial.rho * inverse[j];
            trial.share[j] * (ratio * ratio)
        });
        let slope = [0, 1].map(|j| part[j] * ((dS + c[j] * dmultiplier) * inverse[j]));
        ReturnPoint {
            multiplier,
            overstress: overstress.map_or(T::ZERO, |[v, _]| v),
            T: all,
            S,
            sum: part[0] + part[1],
            slope: slope[0] + slope[1],
            change: [dmultiplier, dS],
        }
    }

    /// Newton for g = sum^(-1/2) − 1 = 0, rising in the unknown x > 0: concave in Δλ, mostly convex in v. Bisection replaces a step outside
    /// the bracket and a step that has not halved the misfit. `x`: the first guess. `active`: the points to be found.
    #[inline(always)]
    fn root<T: Number>(
        &self,
        trial: &Trial<T>,
        (mut x, mut active): (T, T::Mask),
        flow: Option<&Flow<T>>,
    ) -> ReturnPoint<T> {
        let (half, infinity) = (T::splat(0.5), T::splat(f64::INFINITY));
        let (mut low, mut high, mut last) = (T::ZERO, infinity, infinity);
        // Bisection from the largest to the least number needs 2100 iterations; Newton's method needs 3 to 7.
        let mut left = 2100;
        loop {
            let point = self.at(trial, x, flow);
            let misfit = T::ONE - point.sum.sqrt();
            let step = point.sum * misfit / point.slope;
            // A step of less than a few units in the last place is none.
            let moves = T::splat(2.0 * f64::EPSILON).lt(step.abs());
            active = active & !misfit.abs().le(T::select(moves, T::splat(TOLERANCE), T::splat(STEEP)));
            if left == 0 || !active.any() {
                return point;
            }
            left -= 1;
            let above = T::ZERO.lt(misfit);
            (high, low) = (T::select(above, x, high), T::select(above, low, x));
            let newton = x * (T::ONE - step);
            let close = moves & misfit.abs().le(half * last) & low.lt(newton) & newton.lt(high);
            let mut next = newton;
            if (active & !close).any() {
                let between = T::select(high.lt(infinity), half * (low + high), T::splat(2.0) * x);
                next = T::select(close, newton, between);
            }
            // Neighbours in a bracket, or no numbers: nothing is left to find.
            active = active & (T::splat(f64::EPSILON) * x).lt((next - x).abs());
            if !active.any() {
                return point;
            }
            (x, last) = (T::select(active, next, x), misfit.abs());
        }
    }
}
