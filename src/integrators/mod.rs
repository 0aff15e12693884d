//! Time integration schemes. Within a step a node moves by an increment q = (Δu, Θ) from its start, where q̇ = v and q̈ = a
//! are known; a one-step scheme says at which instant equilibrium is written, how q̇ and q̈ follow there from the unknown
//! q, and what they are at the end of the step. All of these are linear, so a scheme is a handful of numbers.

pub mod bathe;
pub mod generalized_alpha;
pub mod hht_alpha;
pub mod load_steps;
pub mod newmark;
pub mod wilson_theta;

use crate::math::Vec6;
pub use crate::math::rotation::RotationUpdate;
use crate::state::Increment;
pub use bathe::Bathe;
pub use generalized_alpha::GeneralizedAlpha;
pub use hht_alpha::hht_alpha;
pub use newmark::newmark;
pub use wilson_theta::WilsonTheta;

/// A scheme the deck can name.
#[derive(Debug, Clone, PartialEq)]
pub enum Scheme {
    WilsonTheta(WilsonTheta),
    Newmark(GeneralizedAlpha),
    HhtAlpha(GeneralizedAlpha),
    GeneralizedAlpha(GeneralizedAlpha),
    Bathe(Bathe),
}

impl Scheme {
    /// As the deck writes it.
    pub fn word(&self) -> &'static str {
        match self {
            Scheme::WilsonTheta(_) => "wilson-theta",
            Scheme::Newmark(_) => "newmark",
            Scheme::HhtAlpha(_) => "hht-alpha",
            Scheme::GeneralizedAlpha(_) => "generalized-alpha",
            Scheme::Bathe(_) => "bathe",
        }
    }

    /// Where a scheme's formulas run on another acceleration than that of equilibrium: how it follows (a, q̈ before, q̈ now).
    pub fn follower(&self) -> Option<[f64; 3]> {
        match self {
            Scheme::Newmark(scheme) | Scheme::HhtAlpha(scheme) | Scheme::GeneralizedAlpha(scheme) => scheme.follower(),
            Scheme::WilsonTheta(_) | Scheme::Bathe(_) => None,
        }
    }

    /// For a step of length Δt; of a scheme of two stages the first.
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        match self {
            Scheme::WilsonTheta(scheme) => scheme.coefficients(dt),
            Scheme::Newmark(scheme) | Scheme::HhtAlpha(scheme) | Scheme::GeneralizedAlpha(scheme) => {
                scheme.coefficients(dt)
            }
            Scheme::Bathe(scheme) => scheme.first(dt),
        }
    }
}

/// A scheme for a step of length Δt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Equilibrium is written at t + `instant` Δt; loads and prescribed motions are taken on a straight line to there.
    pub instant: f64,
    /// q̇ there from (q, v, a).
    pub rate: [f64; 3],
    /// q̈ there from (q, v, a, q̈ at the start of the step, where that is not a).
    pub acceleration: [f64; 4],
    /// First guess of q from (v, a, ȧ).
    pub prediction: [f64; 3],
    /// (q, q̇, q̈) at t + Δt from (q, v, a, q̈ at the instant).
    pub end: [[f64; 4]; 3],
    pub rotation: RotationUpdate,
}

impl Coefficients {
    /// ∂q̇/∂q and ∂q̈/∂q: what multiplies C and M in the matrix of the step.
    pub fn weights(&self) -> (f64, f64) {
        (self.rate[0], self.acceleration[0])
    }

    #[inline]
    pub fn predict(&self, v: &Vec6, a: &Vec6, jerk: &Vec6) -> Vec6 {
        let [c1, c2, c3] = self.prediction;
        v * c1 + a * c2 + jerk * c3
    }

    /// Fills q̇ and q̈ of `increment` from its q.
    #[inline]
    pub fn differentiate(&self, increment: &mut Increment, v: &Vec6, a: &Vec6, start: &Vec6) {
        let ([r1, r2, r3], [a1, a2, a3, a4]) = (self.rate, self.acceleration);
        increment.d = increment.q * r1 + v * r2 + a * r3;
        increment.dd = increment.q * a1 + v * a2 + a * a3;
        if a4 != 0.0 {
            increment.dd += start * a4;
        }
    }

    /// The increment at the end of the step from that at the instant of equilibrium.
    #[inline]
    pub fn finish(&self, at_instant: &Increment, v: &Vec6, a: &Vec6) -> Increment {
        let of = |[c1, c2, c3, c4]: [f64; 4]| at_instant.q * c1 + v * c2 + a * c3 + at_instant.dd * c4;
        Increment { q: of(self.end[0]), d: of(self.end[1]), dd: of(self.end[2]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix4;
    use std::f64::consts::TAU;

    /// One stage for q̈ = −ω² u from (u, v, a, q̈) with `slots` in place of (v, a); returns the increment too.
    fn stage(c: &Coefficients, omega2: f64, [u, _, _, b]: [f64; 4], slots: [f64; 2]) -> ([f64; 4], f64) {
        let ([k, cv, ca, cb], [w1, w2]) = (c.acceleration, slots);
        let q = -(omega2 * u + cv * w1 + ca * w2 + cb * b) / (k + omega2);
        let at = k * q + cv * w1 + ca * w2 + cb * b;
        let end = |[c1, c2, c3, c4]: [f64; 4]| c1 * q + c2 * w1 + c3 * w2 + c4 * at;
        let a = end(c.end[2]);
        ([u + end(c.end[0]), end(c.end[1]), a, a], end(c.end[0]))
    }

    fn step(scheme: &Scheme, dt: f64, omega2: f64, start: [f64; 4]) -> [f64; 4] {
        let (mut end, q0) = stage(&scheme.coefficients(dt), omega2, start, [start[1], start[2]]);
        if let Some([of_a, of_start, of_end]) = scheme.follower() {
            end[2] = of_a * start[2] + of_start * start[3] + of_end * end[3];
        }
        let Scheme::Bathe(bathe) = scheme else { return end };
        let b = bathe.backward(dt);
        stage(&bathe.second(dt), omega2, end, [b.start * q0, b.start * start[1] + b.between * end[1]]).0
    }

    /// Period elongation in per cent and damping of the free oscillator of period 1.
    fn spectrum(scheme: &Scheme, dt: f64) -> (f64, f64) {
        let omega2 = TAU * TAU;
        let unit = |j: usize| std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
        let columns = [0, 1, 2, 3].map(|j| step(scheme, dt, omega2, unit(j)));
        let A = Matrix4::from_fn(|i, j| columns[j][i]);
        let values = A.complex_eigenvalues();
        let principal = values.iter().copied().max_by(|x, y| x.im.total_cmp(&y.im)).expect("four eigenvalues");
        let phase = principal.im.atan2(principal.re);
        let log = -principal.norm().ln();
        (100.0 * (TAU * dt / phase - 1.0), log / phase.hypot(log))
    }

    /// The schemes are what their names say: eigenvalues of the amplification matrix by their definitions, for Δt/T = 0.05, 0.1
    /// and 0.2, to the digits given.
    #[test]
    fn spectra_of_the_free_oscillator() {
        let exact = RotationUpdate::Exponential;
        let radius = |radius| Scheme::GeneralizedAlpha(GeneralizedAlpha::new(radius, exact));
        let hht = |alpha| Scheme::HhtAlpha(hht_alpha(alpha, exact));
        let wilson = |theta| Scheme::WilsonTheta(WilsonTheta { theta, rotation: exact });
        let newmark = |gamma, beta| Scheme::Newmark(newmark(gamma, beta, exact));
        let cases = [
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
                Scheme::Bathe(Bathe { split: 0.5, rotation: exact }),
                [(0.40950, 0.0001063), (1.61794, 0.0008187), (6.18705, 0.0057035)],
            ),
        ];
        for (scheme, rows) in cases {
            for (dt, (elongation, damping)) in [0.05, 0.1, 0.2].into_iter().zip(rows) {
                let (got, xi) = spectrum(&scheme, dt);
                assert!((got - elongation).abs() < 1e-5, "{scheme:?} at {dt}: elongation {got}");
                // The table rounds damping to four digits or to 1e-7, whichever is coarser.
                assert!((xi - damping).abs() < 1e-7_f64.max(6e-4 * damping), "{scheme:?} at {dt}: damping {xi}");
            }
        }
    }

    /// Newmark's formulas hold between the ends of a step with the acceleration that follows.
    #[test]
    fn the_follower_is_newmarks_acceleration() {
        let scheme = GeneralizedAlpha::new(0.6, RotationUpdate::Exponential);
        let (dt, v, a, b, q) = (0.1, 0.7, -2.0, -1.5, 0.05);
        let c = scheme.coefficients(dt);
        let rate = c.rate[0] * q + c.rate[1] * v + c.rate[2] * a;
        let [c1, c2, c3, c4] = c.acceleration;
        let acceleration = c1 * q + c2 * v + c3 * a + c4 * b;
        let [of_a, of_start, of_end] = scheme.follower().expect("it is not equilibrium's");
        let a1 = of_a * a + of_start * b + of_end * acceleration;
        let (beta, gamma) = (scheme.beta, scheme.gamma);
        assert!((dt * v + dt * dt * ((0.5 - beta) * a + beta * a1) - q).abs() < 1e-15);
        assert!((v + dt * ((1.0 - gamma) * a + gamma * a1) - rate).abs() < 1e-14);
    }
}
