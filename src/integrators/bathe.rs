//! Bathe's composite scheme: the trapezoidal rule to t + γΔt, from there backward differences through three points. What the step
//! does not resolve is gone after a step, the low modes are damped less than by any scheme of one stage that does that; second
//! order, unconditionally stable, twice the work a step. With γ = 2 − √2 one matrix serves both stages (TR-BDF2).
//! K. J. Bathe, M. M. I. Baig, Comput. Struct. 83 (2005); R. E. Bank et al., IEEE Trans. CAD 4 (1985).

use super::{Coefficients, RotationUpdate, newmark};

#[derive(Debug, Clone, PartialEq)]
pub struct Bathe {
    /// γ: the part of the step that the trapezoidal rule covers.
    pub split: f64,
    pub rotation: RotationUpdate,
}

/// Derivative at the end of the second stage from values at the start of the step, between the stages, and at the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backward {
    pub start: f64,
    pub between: f64,
    pub end: f64,
}

impl Bathe {
    pub fn first(&self, dt: f64) -> Coefficients {
        newmark(0.5, 0.25, self.rotation).coefficients(self.split * dt)
    }

    pub fn backward(&self, dt: f64) -> Backward {
        let (h1, h2) = (self.split * dt, (1.0 - self.split) * dt);
        Backward { start: h2 / (h1 * dt), between: -dt / (h1 * h2), end: (h1 + 2.0 * h2) / (h2 * dt) }
    }

    /// The second stage, from the motion between the stages. In place of v and a it takes b₀ q₀ and b₀ v₀ + b₁ v, with q₀ the
    /// increment of the first stage, v₀ the velocity it began with, v the one it ended with, b of [`Bathe::backward`].
    pub fn second(&self, dt: f64) -> Coefficients {
        let b = self.backward(dt).end;
        let h2 = (1.0 - self.split) * dt;
        // q̇ = b q − b₀ q₀ (q is counted from between the stages), q̈ = b q̇ + b₀ v₀ + b₁ v
        Coefficients {
            instant: 1.0,
            rate: [b, -1.0, 0.0],
            acceleration: [b * b, -b, 1.0, 0.0],
            prediction: [h2, 0.5 * h2 * h2, h2 * h2 * h2 / 6.0],
            end: [[1.0, 0.0, 0.0, 0.0], [b, -1.0, 0.0, 0.0], [b * b, -b, 1.0, 0.0]],
            rotation: self.rotation,
        }
    }
}
