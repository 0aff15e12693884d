//! HHT-α: inertia at t + Δt, all other forces at t + (1 + α)Δt where the system is linear, −1/3 ≤ α ≤ 0: generalized-α with α_m = 0.
//! H. M. Hilber, T. J. R. Hughes, R. L. Taylor, Earthquake Eng. Struct. Dyn. 5 (1977).

use super::{GeneralizedAlpha, RotationUpdate};

/// Second order and unconditionally stable for α from −1/3 to 0.
pub fn hht_alpha(alpha: f64, rotation: RotationUpdate) -> GeneralizedAlpha {
    let (gamma, beta) = (0.5 - alpha, 0.25 * (1.0 - alpha).powi(2));
    GeneralizedAlpha { alpha_m: 0.0, alpha_f: -alpha, gamma, beta, rotation }
}
