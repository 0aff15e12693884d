//! The numerical damping and period elongation of a scheme: the eigenvalues of its step of a free oscillator.

use super::coefficients::Coefficients;
use super::scheme::{Scheme, Stepping};
use super::stage_tableau::StageTableau;
use nalgebra::{Complex, Matrix4};

/// The numerical properties of a scheme at one ratio of step to period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Relative elongation of the period.
    pub elongation: f64,
    /// Damping ratio.
    pub damping: f64,
}

/// The spectrum for a free oscillator with ω Δt = `turn`, below the limit of stability.
pub fn spectrum(scheme: &dyn Scheme, turn: f64) -> Spectrum {
    let principal = principal(scheme, turn);
    let phase = principal.arg();
    let log = -principal.norm().ln();
    Spectrum { elongation: turn / phase - 1.0, damping: log / phase.hypot(log) }
}

/// The ω Δt for error constants: small, and far above the rounding of eigenvalues.
const TURN: f64 = 0.1;

/// The error constant c of a scheme of order p: a step of smooth motion makes an error c Δtᵖ⁺¹ |q⁽ᵖ⁺¹⁾| of a displacement.
pub fn error_constant(scheme: &dyn Scheme) -> f64 {
    (principal(scheme, TURN) - Complex::from_polar(1.0, TURN)).norm() / TURN.powi(scheme.order() as i32 + 1)
}

/// The constant d of the error of phase d (ω Δt)⁵ that a step of a scheme of third order makes besides its damping.
pub fn phase_constant(scheme: &dyn Scheme) -> f64 {
    (principal(scheme, TURN).arg() - TURN).abs() / TURN.powi(5)
}

/// The eigenvalue that approximates e^{iωΔt}.
fn principal(scheme: &dyn Scheme, turn: f64) -> Complex<f64> {
    let unit = |j: usize| std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
    let columns = [0, 1, 2, 3].map(|j| step(scheme, turn, unit(j)));
    let A = Matrix4::from_fn(|i, j| columns[j][i]);
    A.complex_eigenvalues().iter().copied().fold(Complex::new(0.0, f64::MIN), |x, y| if y.im > x.im { y } else { x })
}

/// A step of length 1 from (u, v, a, q̈), with a the acceleration of the scheme.
fn step(scheme: &dyn Scheme, turn: f64, start: [f64; 4]) -> [f64; 4] {
    let omega2 = turn * turn;
    if scheme.is_explicit() {
        return explicit(&scheme.coefficients(1.0), omega2, start);
    }
    if let Stepping::DiagonallyImplicit(tableau) = scheme.stepping() {
        return implicit_stages(tableau, omega2, start);
    }
    let (mut end, q0) = stage(&scheme.coefficients(1.0), omega2, start, [start[1], start[2]]);
    if let Some([of_a, of_start, of_end]) = scheme.algorithmic_acceleration() {
        end[2] = of_a * start[2] + of_start * start[3] + of_end * end[3];
    }
    let Stepping::Composite(stages) = scheme.stepping() else { return end };
    let b = stages.backward(1.0);
    stage(&stages.second(1.0), omega2, end, [b.start * q0, b.start * start[1] + b.between * end[1]]).0
}

/// One stage for q̈ = −ω² u from (u, v, a, q̈) with `slots` in place of (v, a); returns the increment too.
fn stage(c: &Coefficients, omega2: f64, [u, _, _, b]: [f64; 4], slots: [f64; 2]) -> ([f64; 4], f64) {
    let ([k, cv, ca, cb], [w1, w2]) = (c.acceleration, slots);
    let q = -(omega2 * u + cv * w1 + ca * w2 + cb * b) / (k + omega2);
    let at = k * q + cv * w1 + ca * w2 + cb * b;
    let end = |[c1, c2, c3, c4]: [f64; 4]| c1 * q + c2 * w1 + c3 * w2 + c4 * at;
    let a = end(c.end[2]);
    ([u + end(c.end[0]), end(c.end[1]), a, a], end(c.end[0]))
}

/// A step of length 1 in implicit stages, from (u, v, a, q̈).
fn implicit_stages(tableau: &StageTableau, omega2: f64, [u, v, a, b]: [f64; 4]) -> [f64; 4] {
    let (gamma, mut rates) = (tableau.gamma, vec![[v, a]]);
    let mut end = [u, v, a, b];
    for weights in tableau.a {
        let sum = |of: usize| weights.iter().map(|&(stage, weight)| weight * rates[stage][of]).sum::<f64>();
        let (from, rate_from) = (u + sum(0), v + sum(1));
        // u = from + γ v, v = rate_from − γ ω² u
        let u = (from + gamma * rate_from) / (1.0 + gamma * gamma * omega2);
        let (v, a) = (rate_from - gamma * omega2 * u, -omega2 * u);
        rates.push([v, a]);
        end = [u, v, a, a];
    }
    end
}

/// A step with predicted positions.
fn explicit(c: &Coefficients, omega2: f64, [u, v, a, _]: [f64; 4]) -> [f64; 4] {
    let q = c.prediction[0] * v + c.prediction[1] * a;
    let at = -omega2 * (u + q);
    let end = |[c1, c2, c3, c4]: [f64; 4]| c1 * q + c2 * v + c3 * a + c4 * at;
    let dd = end(c.end[2]);
    [u + end(c.end[0]), end(c.end[1]), dd, dd]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::{
        Bathe, CentralDifference, Esdirk3, GeneralizedAlpha, HhtAlpha, Newmark, RotationUpdate, WilsonTheta,
    };
    use std::f64::consts::TAU;
    use std::sync::Arc;

    /// The schemes are what their names say: eigenvalues of the amplification matrix by their definitions, for Δt/T = 0.05, 0.1
    /// and 0.2, to the digits given.
    #[test]
    fn spectra_of_the_free_oscillator() {
        let exact = RotationUpdate::Exponential;
        let radius = |radius| -> Arc<dyn Scheme> { Arc::new(GeneralizedAlpha::new(radius, exact)) };
        let hht = |alpha| Arc::new(HhtAlpha { alpha, rotation: exact });
        let wilson = |theta| Arc::new(WilsonTheta { theta, rotation: exact });
        let newmark = |gamma, beta| Arc::new(Newmark { gamma, beta, rotation: exact });
        let cases: [(Arc<dyn Scheme>, _); 10] = [
            (wilson(1.4), [(1.71063, 0.0023165), (6.14622, 0.0139794), (19.36534, 0.0558601)]),
            (wilson(1.37), [(1.59122, 0.0020432), (5.75237, 0.0125216), (18.25189, 0.0512614)]),
            (newmark(0.5, 0.25), [(0.81712, 0.0), (3.20749, 0.0), (12.00331, 0.0)]),
            (newmark(0.6, 0.3025), [(0.84101, 0.0154532), (3.29459, 0.0294997), (12.25814, 0.0504165)]),
            (hht(-0.05), [(0.92761, 0.0001674), (3.61110, 0.0011838), (13.20335, 0.0063142)]),
            (hht(-0.3), [(1.21167, 0.0005409), (4.65667, 0.0037522), (16.48758, 0.0193766)]),
            (radius(0.8), [(0.86233, 2.08e-5), (3.38284, 0.0001573), (12.63509, 0.0010290)]),
            (radius(0.5), [(1.21566, 0.000545), (4.67153, 0.00378), (16.53643, 0.0195094)]),
            (radius(0.0), [(3.90844, 0.0116254), (12.32057, 0.054905), (34.36675, 0.166553)]),
            (
                Arc::new(Bathe { split: 0.5, rotation: exact }),
                [(0.40950, 0.0001063), (1.61794, 0.0008187), (6.18705, 0.0057035)],
            ),
        ];
        // cos Ω = 1 − (ω Δt)²/2 at Ω = ω' Δt: periods come out short, and nothing is damped.
        let exactly = |dt: f64| (100.0 * (TAU * dt / (1.0 - 0.5 * (TAU * dt).powi(2)).acos() - 1.0), 0.0);
        let central: Arc<dyn Scheme> = Arc::new(CentralDifference { rotation: exact, mass_scaling_step: None });
        let cases = cases.into_iter().chain([(central, [0.05, 0.1, 0.2].map(exactly))]);
        for (scheme, rows) in cases {
            for (dt, (elongation, damping)) in [0.05, 0.1, 0.2].into_iter().zip(rows) {
                let got = spectrum(&*scheme, TAU * dt);
                assert!((100.0 * got.elongation - elongation).abs() < 1e-5, "{scheme:?} at {dt}: {got:?}");
                // The table rounds damping to four digits or to 1e-7, whichever is coarser.
                assert!((got.damping - damping).abs() < 1e-7_f64.max(6e-4 * damping), "{scheme:?} at {dt}: {got:?}");
            }
        }
    }

    /// By the textbook: 1/12 for the trapezoidal rule, whose only error is one of phase.
    #[test]
    fn error_of_the_trapezoidal_rule() {
        let c = error_constant(&Newmark { gamma: 0.5, beta: 0.25, rotation: RotationUpdate::Exponential });
        // The next term of the series is (ωΔt)² = 1e-2 times as large.
        assert!((c - 1.0 / 12.0).abs() < 1e-2 / 12.0, "{c}");
    }

    /// By R = P₃(z)/(1 − γz)⁴ with γ = 9/40: d = C₅ + (4γ − 1)C₄ = 1.1858e-3, with the coefficients C of eᶻ(1 − γz)⁴.
    #[test]
    fn phase_of_esdirk3() {
        let d = phase_constant(&Esdirk3 { rotation: RotationUpdate::Exponential });
        // The next term of the series is (ωΔt)² = 1e-2 times as large.
        assert!((d / 1.1858e-3 - 1.0).abs() < 1e-2, "{d}");
    }
}
