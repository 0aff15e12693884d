//! The polynomial of fifth degree through position, velocity and acceleration at both ends of a step (Hermite).

use super::Vec6;

/// Weights of (q, q̇, q̈) at the start and at the end in the motion inside, and in its first and second derivative.
pub type Weights = [[f64; 6]; 3];

/// The weights at the fraction `s` of a step of length `h`.
pub fn weights(s: f64, h: f64) -> Weights {
    let (s2, s3, s4) = (s * s, s * s * s, s * s * s * s);
    let s5 = s4 * s;
    let end = [10.0 * s3 - 15.0 * s4 + 6.0 * s5, 30.0 * s2 - 60.0 * s3 + 30.0 * s4, 60.0 * s - 180.0 * s2 + 120.0 * s3];
    let velocities = [
        [s - 6.0 * s3 + 8.0 * s4 - 3.0 * s5, -4.0 * s3 + 7.0 * s4 - 3.0 * s5],
        [1.0 - 18.0 * s2 + 32.0 * s3 - 15.0 * s4, -12.0 * s2 + 28.0 * s3 - 15.0 * s4],
        [-36.0 * s + 96.0 * s2 - 60.0 * s3, -24.0 * s + 84.0 * s2 - 60.0 * s3],
    ];
    let accelerations = [
        [0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5, 0.5 * s3 - s4 + 0.5 * s5],
        [s - 4.5 * s2 + 6.0 * s3 - 2.5 * s4, 1.5 * s2 - 4.0 * s3 + 2.5 * s4],
        [1.0 - 9.0 * s + 18.0 * s2 - 10.0 * s3, 3.0 * s - 12.0 * s2 + 10.0 * s3],
    ];
    std::array::from_fn(|order| {
        let per = h.powi(-(order as i32));
        let start = if order == 0 { 1.0 - end[0] } else { -end[order] };
        let [[v0, v1], [a0, a1]] = [velocities[order], accelerations[order]];
        [start, v0 * h, a0 * h * h, end[order], v1 * h, a1 * h * h].map(|weight| weight * per)
    })
}

/// The motion (q, q̇, q̈) inside, from that at both ends.
#[inline]
pub fn motion(weights: &Weights, start: &[Vec6; 3], end: &[Vec6; 3]) -> [Vec6; 3] {
    let of = |w: &[f64; 6]| {
        start[0] * w[0] + start[1] * w[1] + start[2] * w[2] + end[0] * w[3] + end[1] * w[4] + end[2] * w[5]
    };
    [of(&weights[0]), of(&weights[1]), of(&weights[2])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of fifth degree is met, with its derivatives.
    #[test]
    fn meets_a_polynomial_of_fifth_degree() {
        let at = |t: f64| {
            let q = 0.3 - 1.2 * t + 0.7 * t.powi(2) + 2.0 * t.powi(3) - 0.4 * t.powi(4) + 0.11 * t.powi(5);
            let d = -1.2 + 1.4 * t + 6.0 * t.powi(2) - 1.6 * t.powi(3) + 0.55 * t.powi(4);
            let dd = 1.4 + 12.0 * t - 4.8 * t.powi(2) + 2.2 * t.powi(3);
            [q, d, dd].map(Vec6::repeat)
        };
        let h = 0.37;
        let (start, end) = (at(0.0), at(h));
        for part in [0.0, 0.2, 0.5, 0.83, 1.0] {
            let got = motion(&weights(part, h), &start, &end);
            for (got, exact) in got.iter().zip(at(part * h)) {
                // Sums of six terms of order ten over h².
                assert!((got - exact).amax() < 1e-13 * 100.0 / (h * h), "{part}: {got} {exact}");
            }
        }
    }
}
