//! The numbers of a one-stage scheme. Within a step a node moves by the increment q = (Δu, Θ) from its start with known q̇ = v and q̈ = a.
//! The scheme defines the instant of equilibrium, the rates q̇ and q̈ there as functions of q, and the state at the end of the step. All of
//! these are linear.

use crate::state::Increment;
use base::math::Vec6;
use base::math::rotation::RotationUpdate;

/// A one-stage scheme for a step of length Δt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// Equilibrium is written at t + `instant` Δt; loads and prescribed motions are taken on a straight line to there.
    pub instant: f64,
    /// Weights of (q, v, a) in q̇ there.
    pub rate: [f64; 3],
    /// Weights of (q, v, a, q̈ at the start of the step, if that is not a) in q̈ there.
    pub acceleration: [f64; 4],
    /// Weights of (v, a, ȧ) in the predicted q.
    pub prediction: [f64; 3],
    /// Weights of (q, v, a, q̈ at the instant) in (q, q̇, q̈) at t + Δt.
    pub end: [[f64; 4]; 3],
    /// Time κ: the factor of the change of a free body's angular acceleration over the step in its q̇, which is then exact to third order.
    /// `None` integrates bodies like all other nodes.
    pub turning: Option<f64>,
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl Coefficients {
    /// Central differences as velocity Verlet: q is as predicted; at the instant of equilibrium q̇ is predicted too, and q̈ the unknown.
    pub fn verlet(dt: f64, rotation: RotationUpdate) -> Coefficients {
        Coefficients {
            instant: 1.0,
            rate: [0.0, 1.0, dt],
            acceleration: [0.0; 4],
            prediction: [dt, 0.5 * dt * dt, 0.0],
            end: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.5 * dt, 0.5 * dt], [0.0, 0.0, 0.0, 1.0]],
            turning: None,
            rotation,
        }
    }

    /// ∂q̇/∂q and ∂q̈/∂q, the factors of C and M in the matrix of the step.
    pub fn weights(&self) -> (f64, f64) {
        (self.rate[0], self.acceleration[0])
    }

    /// Weights of (q̇ there, v, a, q̈ at the start of the step, if that is not a) in q̈ there, with q eliminated.
    pub fn of_velocities(&self) -> [f64; 4] {
        let ([r1, r2, r3], [a1, a2, a3, a4]) = (self.rate, self.acceleration);
        let of_new = a1 / r1;
        [of_new, a2 - of_new * r2, a3 - of_new * r3, a4]
    }

    /// The predicted q from (v, a, ȧ).
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
