//! Stability limit of central differences in a mode with stiffness κ = φᵀKφ/φᵀMφ and damping γ = φᵀCφ/φᵀMφ: ¼ κ Δt² + γ Δt ≤ 1. Forces of
//! velocity use the predicted velocity.

/// The longest stable step of such a mode.
pub fn longest_step(stiffness: f64, damping: f64) -> f64 {
    2.0 / (damping + (damping * damping + stiffness).sqrt())
}

/// The largest stable stiffness of a mode at the step, with damping γ = α + β κ. It is not positive if mass-proportional damping alone
/// requires a shorter step.
pub fn largest_stiffness(dt: f64, alpha: f64, beta: f64) -> f64 {
    (1.0 - alpha * dt) / (dt * (0.25 * dt + beta))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::Coefficients;
    use base::math::rotation::RotationUpdate;
    use nalgebra::Matrix3;

    /// The largest eigenvalue of the step of ẍ + γ ẋ + κ x = 0 with Δt = 1, on (x, v, a).
    fn largest_eigenvalue(stiffness: f64, damping: f64) -> f64 {
        let unit = |j: usize| std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
        let columns = [0, 1, 2].map(|j| {
            let [x, v, a]: [f64; 3] = unit(j);
            let c = Coefficients::verlet(1.0, RotationUpdate::Exponential);
            let of = |[q, v1, a1, dd]: [f64; 4], at: [f64; 4]| q * at[0] + v1 * at[1] + a1 * at[2] + dd * at[3];
            let q = c.prediction[0] * v + c.prediction[1] * a;
            let rate = c.rate[0] * q + c.rate[1] * v + c.rate[2] * a;
            let dd = -stiffness * (x + q) - damping * rate;
            [x + of(c.end[0], [q, v, a, dd]), of(c.end[1], [q, v, a, dd]), of(c.end[2], [q, v, a, dd])]
        });
        let A = Matrix3::from_fn(|i, j| columns[j][i]);
        A.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max)
    }

    #[test]
    fn the_largest_stiffness_is_that_of_the_longest_step() {
        for (alpha, beta) in [(0.0, 0.0), (0.3, 0.0), (0.0, 0.2), (0.3, 0.2)] {
            let stiffness = largest_stiffness(0.7, alpha, beta);
            // Rounding.
            assert!((longest_step(stiffness, alpha + beta * stiffness) - 0.7).abs() < 1e-15, "{alpha} {beta}");
        }
        assert!(largest_stiffness(0.7, 1.5, 0.0) < 0.0);
    }

    /// Just below the limit nothing grows, just above it does, for any damping; without, the limit is ω Δt = 2.
    #[test]
    fn the_limit_is_where_motion_begins_to_grow() {
        assert_eq!(longest_step(4.0, 0.0), 1.0);
        for ratio in [0.0, 0.01, 0.1, 0.5, 1.0, 5.0] {
            // κ = ω², γ = 2 ξ ω at Δt = 1 and ω such that the limit is met.
            let omega = longest_step(1.0, 2.0 * ratio);
            for (part, grows) in [(0.1, false), (0.999, false), (1.001, true)] {
                let omega = part * omega;
                let radius = largest_eigenvalue(omega * omega, 2.0 * ratio * omega);
                // An undamped mode neither grows nor dies: rounding of its eigenvalues, which are nearly double at the limit.
                assert_eq!(radius > 1.0 + 1e-7, grows, "ξ = {ratio}, {part} of the limit: {radius}");
                assert_eq!(0.25 * omega * omega + 2.0 * ratio * omega > 1.0, grows, "the condition as it stands above");
            }
        }
    }
}
