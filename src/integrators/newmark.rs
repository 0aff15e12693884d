//! Newmark: equilibrium at t + Δt; q = Δt v + Δt² ((½ − β) a + β a₁), v₁ = v + Δt ((1 − γ) a + γ a₁). With γ = ½ and β = ¼ the
//! trapezoidal rule: second order, no damping at all. With γ > ½ it damps, and is of first order. Unconditionally stable for
//! 2β ≥ γ ≥ ½. N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959).

use super::{GeneralizedAlpha, RotationUpdate};

pub fn newmark(gamma: f64, beta: f64, rotation: RotationUpdate) -> GeneralizedAlpha {
    GeneralizedAlpha { alpha_m: 0.0, alpha_f: 0.0, gamma, beta, rotation }
}
