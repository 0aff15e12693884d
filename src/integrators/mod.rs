//! Time integration schemes. Within a step a node moves by an increment q = (Δu, Θ) from its start, where q̇ = v and q̈ = a
//! are known; a one-step scheme says at which instant equilibrium is written, how q̇ and q̈ follow there from the unknown
//! q, and what they are at the end of the step. All of these are linear, so a scheme is a handful of numbers.

pub mod bathe;
pub mod central_difference;
pub mod generalized_alpha;
pub mod hht_alpha;
pub mod load_steps;
pub mod newmark;
pub mod runge_kutta;
pub mod spectrum;
pub mod wilson_theta;

use crate::math::Vec6;
pub use crate::math::rotation::RotationUpdate;
use crate::state::Increment;
pub use bathe::Bathe;
pub use central_difference::CentralDifference;
pub use generalized_alpha::GeneralizedAlpha;
pub use hht_alpha::hht_alpha;
pub use newmark::newmark;
pub use runge_kutta::RungeKutta;
pub use wilson_theta::WilsonTheta;

/// A scheme the deck can name.
#[derive(Debug, Clone, PartialEq)]
pub enum Scheme {
    WilsonTheta(WilsonTheta),
    Newmark(GeneralizedAlpha),
    HhtAlpha(GeneralizedAlpha),
    GeneralizedAlpha(GeneralizedAlpha),
    Bathe(Bathe),
    CentralDifference(CentralDifference),
    RungeKutta(RungeKutta),
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
            Scheme::CentralDifference(_) => "central-difference",
            Scheme::RungeKutta(_) => "runge-kutta",
        }
    }

    /// Of its error in the time step.
    pub fn order(&self) -> usize {
        match self {
            Scheme::Newmark(scheme) if scheme.gamma != 0.5 => 1,
            Scheme::RungeKutta(scheme) => scheme.tableau.order,
            _ => 2,
        }
    }

    /// Where a scheme's formulas run on another acceleration than that of equilibrium: how it follows (a, q̈ before, q̈ now).
    pub fn follower(&self) -> Option<[f64; 3]> {
        match self {
            Scheme::Newmark(scheme) | Scheme::HhtAlpha(scheme) | Scheme::GeneralizedAlpha(scheme) => scheme.follower(),
            Scheme::WilsonTheta(_) | Scheme::Bathe(_) | Scheme::CentralDifference(_) | Scheme::RungeKutta(_) => None,
        }
    }

    /// True where a step solves for nothing but M a = r: there is no stiffness matrix.
    pub fn is_explicit(&self) -> bool {
        matches!(self, Scheme::CentralDifference(_) | Scheme::RungeKutta(_))
    }

    /// For a step of length Δt; of a scheme of two stages the first, of Runge-Kutta's the prediction of the motion.
    pub fn coefficients(&self, dt: f64) -> Coefficients {
        match self {
            Scheme::WilsonTheta(scheme) => scheme.coefficients(dt),
            Scheme::Newmark(scheme) | Scheme::HhtAlpha(scheme) | Scheme::GeneralizedAlpha(scheme) => {
                scheme.coefficients(dt)
            }
            Scheme::Bathe(scheme) => scheme.first(dt),
            Scheme::CentralDifference(scheme) => scheme.coefficients(dt),
            Scheme::RungeKutta(_) => CentralDifference { rotation: RotationUpdate::Exponential }.coefficients(dt),
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
