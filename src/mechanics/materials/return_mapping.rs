//! The return to the yield surface: one equation for all stress states, with and without viscosity.
//!
//! With ξ = σ − X the stress relative to the back stress, backward Euler gives in the modes of [`super::stress_state`]
//!
//! ```text
//!  ξᵢ = ξᵢ* R/Tᵢ,   Tᵢ = R + k + cᵢ Δλ,   Σ pᵢ (ξᵢ*/Tᵢ)² = 1,
//! ```
//!
//! ξ* the trial, R = i (1 + v) the radius to return to, i its part without overstress, k the growth of the back stress
//! (Xᵢ += k ξᵢ/R). R, k and T follow from the multiplier Δλ, and viscosity ties Δλ to v: Δλ = γΔt φ(v). Without it v = 0.
//! After Simo & Hughes, Computational Inelasticity (1998), 3.3 and 3.4.

use super::hardening::Hardening;
use super::overstress::Viscosity;

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

/// The numbers of a yielding trial stress on which the multiplier depends.
pub(super) struct Trial {
    /// ρ*.
    pub rho: f64,
    /// Shares of ρ*² in the first mode and in the others.
    pub share: [f64; 2],
    /// c of the first mode and of the others.
    pub c: [f64; 2],
    /// Accumulated plastic strain ε̄ᵖ at the beginning of the step.
    pub accumulated: f64,
    /// Rise of the yield stress at the beginning of the step.
    pub rise: f64,
    /// Radius i of the yield surface at the beginning of the step.
    pub radius: f64,
}

/// A point of the return.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReturnPoint {
    /// Δλ.
    pub multiplier: f64,
    /// Overstress v.
    pub overstress: f64,
    /// T of the first mode and of the others.
    pub T: [f64; 2],
    /// R + k.
    pub S: f64,
    /// ∂Δλ − Δλ ∂S/S, where ∂ is the change per relative change of the unknown, which stays in range where Δλ, v and γ are
    /// hundreds of decades apart.
    pub turn: f64,
    /// Σ pᵢ (ξᵢ*/Tᵢ)².
    pub sum: f64,
    /// Σ pᵢ (ξᵢ*/Tᵢ)² ∂Tᵢ/Tᵢ.
    pub slope: f64,
}

/// A number and its change per relative change of the unknown.
type Varied = [f64; 2];

impl ReturnPoint {
    /// T of a mode.
    #[inline(always)]
    pub fn T(&self, mode: usize) -> f64 {
        self.T[usize::from(mode > 0)]
    }
}

impl Yielding {
    /// Finds the point where the yield condition holds at the end of the step; `last` is the overstress at its
    /// beginning.
    pub(super) fn solve(&self, trial: &Trial, dt: f64, last: f64) -> ReturnPoint {
        // Newton's first step, from Δλ = 0. A single mode with linear hardening has arrived there.
        let slope = self.hardening.rise(trial.accumulated).1;
        let first = (trial.rho - trial.radius).max(0.0)
            / (trial.share[0] * (trial.c[0] + slope) + trial.share[1] * (trial.c[1] + slope));
        let plastic = || root(first, |dl| self.point(trial, [dl, dl], [0.0; 2]));
        match self.viscosity {
            None => plastic(),
            Some(Viscosity { fluidity, overstress }) => {
                // Beyond 1e300 nothing but rounding is left of v.
                let rate = (fluidity * dt).min(1e300);
                let elastic = (trial.rho / trial.radius - 1.0).max(0.0);
                // Where it flows on as before, the last overstress is near. Otherwise the search starts from the larger side, where
                // the equation is steep: φ grows no further than the rate-independent return and v no further than the elastic
                // stress.
                let bound = (trial.rho - trial.radius).max(0.0) / trial.c[0].min(trial.c[1]);
                let flow = rate * overstress.phi(last).0;
                let (most, start) = if last < elastic && flow > 1e-3 * bound && flow < bound {
                    (2.0 * bound, last)
                } else {
                    let most = plastic().multiplier;
                    (most, elastic.min(overstress.inverse(most / rate)))
                };
                root(start, |v| {
                    let (phi, change) = overstress.phi(v);
                    // The bounds cost rounding where φ is in range and answer where it is not.
                    let multiplier =
                        if rate > 0.0 { [(rate * phi).min(most), (rate * change).min(f64::MAX)] } else { [0.0; 2] };
                    self.point(trial, multiplier, [v, v])
                })
            }
        }
    }

    #[inline]
    fn point(&self, trial: &Trial, [multiplier, dmultiplier]: Varied, [v, dv]: Varied) -> ReturnPoint {
        let (rise, slope) = self.hardening.rise(trial.accumulated + multiplier);
        let (back_share, drise) = (self.kinematic_share, slope * dmultiplier);
        let radius = self.hardening.initial() + (1.0 - back_share) * rise;
        let back = back_share * (rise - trial.rise);
        let S = radius * (1.0 + v) + back;
        let dS = (1.0 - back_share) * drise * (1.0 + v) + radius * dv + back_share * drise;
        let T = trial.c.map(|c| S + c * multiplier);
        // Ratios to T, never powers of stresses: nothing overflows before the trial stress does.
        let inverse = T.map(f64::recip);
        let part = [0, 1].map(|j| trial.share[j] * (trial.rho * inverse[j]).powi(2));
        let slope = [0, 1].map(|j| part[j] * ((dS + trial.c[j] * dmultiplier) * inverse[j]));
        ReturnPoint {
            multiplier,
            overstress: v,
            T,
            S,
            turn: dmultiplier - multiplier * (dS / S),
            sum: part[0] + part[1],
            slope: slope[0] + slope[1],
        }
    }
}

/// Residual of the yield condition that ends the iteration, relative to the stress; rounding leaves some 1e-15.
pub(super) const TOLERANCE: f64 = 1e-14;

/// Residual that rounding of the unknown may leave instead, where the stress follows it steeply.
pub(super) const STEEP: f64 = 1e-6;

/// Newton for g = sum^(-1/2) − 1 = 0, rising in the unknown x > 0: concave in Δλ, mostly convex in v. Bisection takes over
/// where a step leaves the bracket or has not halved the misfit.
#[inline]
fn root(mut x: f64, at: impl Fn(f64) -> ReturnPoint) -> ReturnPoint {
    let (mut low, mut high, mut last) = (0.0, f64::INFINITY, f64::INFINITY);
    let mut point = at(x);
    // Bisection from the greatest number to the least takes 2100 steps; Newton takes 3 to 7.
    for _ in 0..2100 {
        let misfit = 1.0 - point.sum.sqrt();
        let step = point.sum * misfit / point.slope;
        // A step of less than a few units in the last place is none.
        let moves = step.abs() > 2.0 * f64::EPSILON;
        if misfit.abs() <= if moves { TOLERANCE } else { STEEP } {
            return point;
        }
        if misfit > 0.0 {
            high = x
        } else {
            low = x
        }
        let newton = x * (1.0 - step);
        let next = if moves && misfit.abs() <= 0.5 * last && low < newton && newton < high {
            newton
        } else if high < f64::INFINITY {
            0.5 * (low + high)
        } else {
            2.0 * x
        };
        // Neighbours in a bracket, or no numbers: nothing is left to find.
        if (next - x).abs() <= f64::EPSILON * x || next.is_nan() {
            return point;
        }
        (x, last) = (next, misfit.abs());
        point = at(x);
    }
    point
}
