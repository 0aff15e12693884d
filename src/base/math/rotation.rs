//! Finite rotations: unit quaternions, the exponential map and the rates that go with a rotation vector.
//!
//! The rotation vector Θ represents R = exp(Θ~). For a motion Θ(t) the spatial angular velocity and acceleration are ω = TΘ̇ and α = TΘ̈ +
//! ṪΘ̇, with T = I + c₁Θ~ + c₂Θ~Θ~.

use super::{Mat3, Vec3, fma};
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::Deserialize;

/// How a node's rotation follows from the rotation vector of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RotationUpdate {
    /// R ← exp(Θ~) R, which is exact.
    #[default]
    Exponential,
    /// R ← (I + Θ~) R, made orthogonal again (61).
    FirstOrder,
    /// R ← (I + Θ~ + ½ Θ~Θ~) R, made orthogonal again (62).
    SecondOrder,
}

impl RotationUpdate {
    /// The deck's word for it.
    pub fn word(self) -> &'static str {
        match self {
            RotationUpdate::Exponential => "exponential",
            RotationUpdate::FirstOrder => "first-order",
            RotationUpdate::SecondOrder => "second-order",
        }
    }

    /// The unit quaternion of the step, and the deviation of the unprojected matrix from orthogonality. The truncated maps leave the axis
    /// alone and turn by the angle of their 2×2 block, which projection keeps.
    #[inline]
    pub fn quaternion(self, theta: &Vec3) -> (Quaternion<f64>, f64) {
        if self == RotationUpdate::Exponential {
            return (exp(theta), 0.0);
        }
        let t = theta.norm();
        let (sine, cosine) = (t, if self == RotationUpdate::FirstOrder { 1.0 } else { 1.0 - 0.5 * t * t });
        let scale = if t > 0.0 { sine.atan2(cosine) / t } else { 1.0 };
        (exp(&(scale * theta)), sine.hypot(cosine) - 1.0)
    }
}

/// Below this squared angle the coefficients come from their series in θ². Every step of a resolved motion lies there.
const SERIES: f64 = 0.25;

/// Number of terms of the series: the first omitted one is below 1e-16 of the sum.
const TERMS: usize = 7;

/// Coefficients of Σ (−x)^k/(2k + m)!.
const fn alternating(m: usize) -> [f64; TERMS] {
    let mut c = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        let mut factorial = 1.0;
        let mut i = 2;
        while i <= 2 * k + m {
            factorial *= i as f64;
            i += 1;
        }
        c[k] = if k % 2 == 0 { 1.0 / factorial } else { -1.0 / factorial };
        k += 1;
    }
    c
}

/// Coefficients of twice the derivative of Σ (−x)^k/(2k + m)!: its terms from the second on are those of m + 2, negative.
const fn twice_derivative(m: usize) -> [f64; TERMS] {
    let next = alternating(m + 2);
    let mut c = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        c[k] = -2.0 * (k + 1) as f64 * next[k];
        k += 1;
    }
    c
}

const COSINE: [f64; TERMS] = alternating(0);
const SINE: [f64; TERMS] = alternating(1);
const C1: [f64; TERMS] = alternating(2);
const C2: [f64; TERMS] = alternating(3);
const D1: [f64; TERMS] = twice_derivative(2);
const D2: [f64; TERMS] = twice_derivative(3);

#[inline]
fn polynomial<const N: usize>(c: &[f64; N], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &c| fma(sum, x, c))
}

/// sin(θ/2)/θ and cos(θ/2) as functions of θ².
#[inline]
fn half_angle(t2: f64) -> (f64, f64) {
    if t2 < SERIES {
        let h = 0.25 * t2; // (θ/2)²
        (0.5 * polynomial(&SINE, h), polynomial(&COSINE, h))
    } else {
        let t = t2.sqrt();
        let (s, c) = (0.5 * t).sin_cos();
        (s / t, c)
    }
}

/// The unit quaternion of a rotation vector.
#[inline]
pub fn exp(theta: &Vec3) -> Quaternion<f64> {
    let (s, c) = half_angle(theta.norm_squared());
    Quaternion::new(c, s * theta.x, s * theta.y, s * theta.z)
}

/// The rotation vector of a unit quaternion, of length at most π.
#[inline]
pub fn log(q: &Quaternion<f64>) -> Vec3 {
    let q = if q.w < 0.0 { -q } else { *q };
    let v = Vec3::new(q.i, q.j, q.k);
    let square = v.norm_squared() / (q.w * q.w);
    if square < SMALL_SQUARE {
        return (2.0 / q.w * arctangent_over(square)) * v;
    }
    let s = v.norm();
    (2.0 * s.atan2(q.w) / s) * v
}

/// The square of the tangent of half an angle, below which five terms of its series have all digits.
const SMALL_SQUARE: f64 = 4e-4;

/// arctan(t)/t, from t².
#[inline]
fn arctangent_over(square: f64) -> f64 {
    1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0 - square * (1.0 / 7.0 - square * (1.0 / 9.0 - square / 11.0))))
}

/// The change R v − v of a vector under the rotation of a unit quaternion, exact to its own digits for small rotations.
#[inline]
pub fn change(q: &Quaternion<f64>, v: &Vec3) -> Vec3 {
    let axis = Vec3::new(q.i, q.j, q.k);
    let across = axis.cross(v);
    2.0 * (q.w * across + axis.cross(&across))
}

/// The rotation matrix of a unit quaternion.
#[inline]
pub fn matrix(q: &Quaternion<f64>) -> Mat3 {
    let (w, x, y, z) = (q.w, q.i, q.j, q.k);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    Mat3::new(
        1.0 - 2.0 * (yy + zz),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (xx + zz),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (xx + yy),
    )
}

/// Scales a quaternion to unit length by one Newton step of 1/√: exact to round-off for the drift of a product of unit
/// quaternions.
#[inline]
pub fn renormalise(q: &Quaternion<f64>) -> Quaternion<f64> {
    q * (1.5 - 0.5 * q.norm_squared())
}

/// The coefficients c₁ = (1 − cos θ)/θ², c₂ = (θ − sin θ)/θ³ and their derivatives dc₁/d(½θ²), dc₂/d(½θ²).
#[inline]
fn coefficients(t2: f64) -> (f64, f64, f64, f64) {
    if t2 < SERIES {
        (polynomial(&C1, t2), polynomial(&C2, t2), polynomial(&D1, t2), polynomial(&D2, t2))
    } else {
        let t = t2.sqrt();
        let (s, c) = t.sin_cos();
        let c1 = (1.0 - c) / t2;
        let c2 = (t - s) / (t2 * t);
        (c1, c2, (s / t - 2.0 * c1) / t2, (c1 - 3.0 * c2) / t2)
    }
}

/// Spatial angular velocity and acceleration of the motion R = exp(Θ(t)~) R_n, from Θ, Θ̇ and Θ̈.
#[inline(always)]
pub fn rates(theta: &Vec3, d: &Vec3, dd: &Vec3) -> (Vec3, Vec3) {
    let t2 = theta.norm_squared();
    if t2 == 0.0 {
        return (*d, *dd);
    }
    let (c1, c2, d1, d2) = coefficients(t2);
    let half_t2_rate = theta.dot(d);
    let txd = theta.cross(d);
    let ttd = theta.cross(&txd);
    let omega = d + c1 * txd + c2 * ttd;
    let txa = theta.cross(dd);
    // Ṫ Θ̇ = ċ₁ Θ×Θ̇ + ċ₂ Θ×(Θ×Θ̇) + c₂ Θ̇×(Θ×Θ̇); the terms with Θ̇×Θ̇ vanish.
    let alpha = dd + c1 * txa + c2 * theta.cross(&txa) + half_t2_rate * (d1 * txd + d2 * ttd) + c2 * d.cross(&txd);
    (omega, alpha)
}

/// The rates Θ̇ and Θ̈ of the rotation vector of a motion with the spatial angular velocity and acceleration ω and α: the inverse of
/// [`rates`].
#[inline]
pub fn vector_rates(theta: &Vec3, omega: &Vec3, alpha: &Vec3) -> (Vec3, Vec3) {
    let d = inverse_tangent(theta, omega);
    // The part Ṫ Θ̇ of the acceleration is that of the rotation vector itself.
    let (_, own) = rates(theta, &d, &Vec3::zeros());
    (d, inverse_tangent(theta, &(alpha - own)))
}

/// The change T⁻¹(Θ) δθ of the rotation vector when a small spatial rotation δθ follows exp(Θ~).
#[inline]
pub fn inverse_tangent(theta: &Vec3, dtheta: &Vec3) -> Vec3 {
    let txd = theta.cross(dtheta);
    dtheta - 0.5 * txd + inverse_coefficient(theta.norm_squared()) * theta.cross(&txd)
}

/// Coefficients of (1 − (θ/2) cot(θ/2))/θ² = Σ |B₂ₙ|/(2n)! θ²ⁿ⁻², B the Bernoulli numbers.
const INVERSE: [f64; TERMS] = [
    1.0 / 12.0,
    1.0 / 720.0,
    1.0 / 30_240.0,
    1.0 / 1_209_600.0,
    1.0 / 47_900_160.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 74_724_249_600.0,
];

/// (1 − (θ/2) cot(θ/2))/θ².
#[inline]
fn inverse_coefficient(t2: f64) -> f64 {
    if t2 < SERIES {
        polynomial(&INVERSE, t2)
    } else {
        let h = 0.5 * t2.sqrt();
        (1.0 - h / h.tan()) / t2
    }
}

/// The derivative of T⁻¹(Θ) a along a change `dtheta` of Θ, at constant `a`.
#[inline]
pub fn inverse_tangent_change(theta: &Vec3, dtheta: &Vec3, a: &Vec3) -> Vec3 {
    let t2 = theta.norm_squared();
    let (c, txa) = (inverse_coefficient(t2), theta.cross(a));
    let dtxa = dtheta.cross(a);
    let rate = 2.0 * theta.dot(dtheta) * inverse_coefficient_slope(t2);
    -0.5 * dtxa + c * (dtheta.cross(&txa) + theta.cross(&dtxa)) + rate * theta.cross(&txa)
}

/// The derivative of [`inverse_coefficient`] by θ².
#[inline]
fn inverse_coefficient_slope(t2: f64) -> f64 {
    if t2 < SERIES {
        (1..TERMS).rev().fold(0.0, |sum, k| fma(sum, t2, k as f64 * INVERSE[k]))
    } else {
        let h = 0.5 * t2.sqrt();
        let (sine, cotangent) = (h.sin(), 1.0 / h.tan());
        // (θ/2) cot(θ/2) changes by (cot h − h/sin² h) with h, and h by 1/(8h) with θ².
        let slope = (cotangent - h / (sine * sine)) / (8.0 * h);
        -(slope + (1.0 - h * cotangent) / t2) / t2
    }
}

/// A rotation vector with its coefficients, for several rates at one place.
#[derive(Debug, Clone, Copy)]
pub struct Chart {
    theta: Vec3,
    coefficients: (f64, f64, f64, f64),
    inverse: f64,
}

impl Chart {
    /// The coefficients at a rotation vector.
    #[inline]
    pub fn new(theta: &Vec3) -> Self {
        let t2 = theta.norm_squared();
        Chart { theta: *theta, coefficients: coefficients(t2), inverse: inverse_coefficient(t2) }
    }

    /// ω = T Θ̇ and the part Ṫ Θ̇ of α.
    #[inline]
    pub fn rates(&self, d: &Vec3) -> (Vec3, Vec3) {
        let (theta, (c1, c2, d1, d2)) = (&self.theta, self.coefficients);
        let txd = theta.cross(d);
        let ttd = theta.cross(&txd);
        (d + c1 * txd + c2 * ttd, theta.dot(d) * (d1 * txd + d2 * ttd) + c2 * d.cross(&txd))
    }

    /// The rates Θ̇ and Θ̈ of the rotation vector, as [`vector_rates`] has them.
    #[inline]
    pub fn vector_rates(&self, omega: &Vec3, alpha: &Vec3) -> (Vec3, Vec3) {
        let d = self.inverse(omega);
        let (_, own) = self.rates(&d);
        (d, self.inverse(&(alpha - own)))
    }

    /// The angular velocity and acceleration, as [`rates`] has them.
    #[inline]
    pub fn spatial_rates(&self, d: &Vec3, dd: &Vec3) -> (Vec3, Vec3) {
        let (theta, (c1, c2, d1, d2)) = (&self.theta, self.coefficients);
        let txd = theta.cross(d);
        let ttd = theta.cross(&txd);
        let txa = theta.cross(dd);
        let alpha = dd + c1 * txa + c2 * theta.cross(&txa) + theta.dot(d) * (d1 * txd + d2 * ttd) + c2 * d.cross(&txd);
        (d + c1 * txd + c2 * ttd, alpha)
    }

    /// T⁻¹ v.
    #[inline]
    pub fn inverse(&self, v: &Vec3) -> Vec3 {
        let txv = self.theta.cross(v);
        v - 0.5 * txv + self.inverse * self.theta.cross(&txv)
    }
}

/// The matrix T⁻¹(Θ) = I − ½ Θ~ + c Θ~Θ~.
pub fn inverse_tangent_matrix(theta: &Vec3) -> Mat3 {
    let s = super::skew(theta);
    Mat3::identity() - 0.5 * s + inverse_coefficient(theta.norm_squared()) * s * s
}

/// The derivative ∂(T⁻ᵀ(Θ) m)/∂Θ for fixed m.
pub fn inverse_tangent_transpose_derivative(theta: &Vec3, m: &Vec3) -> Mat3 {
    let t2 = theta.norm_squared();
    let c = inverse_coefficient(t2);
    // dc/d(½θ²), by its series or from c = (1 − h cot h)/θ², h = θ/2.
    let dc = if t2 < SERIES {
        let terms: [f64; TERMS - 1] = std::array::from_fn(|k| 2.0 * (k + 1) as f64 * INVERSE[k + 1]);
        polynomial(&terms, t2)
    } else {
        let h = 0.5 * t2.sqrt();
        let (s, cos) = h.sin_cos();
        let dh_cot = (cos * s - h) / (s * s); // d(h cot h)/dh
        (-dh_cot / (4.0 * h) - 2.0 * c) / t2
    };
    let txm = theta.cross(m);
    let ttm = theta.cross(&txm);
    // δ[½ Θ×m + c Θ×(Θ×m)] = −½ m×δΘ + c [δΘ×(Θ×m) + Θ×(δΘ×m)] + dc (Θ·δΘ) Θ×(Θ×m)
    -0.5 * super::skew(m) - c * (super::skew(&txm) + super::skew(theta) * super::skew(m)) + dc * ttm * theta.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn vectors() -> impl Iterator<Item = (Vec3, Vec3, Vec3)> {
        let mut rng = rand::rngs::StdRng::seed_from_u64(1);
        (0..400).map(move |i| {
            let size = [1e-6, 1e-2, 0.4, 0.6, 2.5][i % 5];
            let mut v = || Vec3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            (v() * size, v(), v())
        })
    }

    /// The next term of the series, t¹²/13, is below 1e-21.
    #[test]
    fn the_series_of_small_angles_meets_the_arctangent() {
        for t in [1e-300, 1e-9, 1e-4, 0.01, 0.0199999] {
            let exact = f64::atan(t) / t;
            assert!((super::arctangent_over(t * t) - exact).abs() < 3e-16, "{t}");
            let q = Quaternion::new(1.0, t, 0.0, 0.0) / f64::hypot(1.0, t);
            assert!((log(&q).x / (2.0 * t) - exact).abs() < 4e-16, "{t}");
        }
    }

    /// R of the quaternion is the matrix exponential; nalgebra's is an independent code path.
    #[test]
    fn exponential_and_logarithm() {
        for (t, ..) in vectors() {
            let R = matrix(&exp(&t));
            let reference = nalgebra::Rotation3::new(t).into_inner();
            assert!((R - reference).amax() < 4e-16 * 4.0, "{t}"); // a few roundings per entry
            if t.norm() < std::f64::consts::PI {
                assert!((log(&exp(&t)) - t).norm() < 1e-15 * (1.0 + t.norm()) * 4.0, "{t}");
            }
        }
    }

    /// ω and α against central differences of R along a cubic Θ(t): truncation h²·|d³| ≈ 1e-8 for h = 1e-4.
    #[test]
    fn rates_differentiate_the_rotation() {
        let h = 1e-4;
        for (t, d, dd) in vectors() {
            let at = |s: f64| t + s * d + 0.5 * s * s * dd;
            let omega = |s: f64| rates(&at(s), &(d + s * dd), &dd).0;
            let (w, alpha) = rates(&t, &d, &dd);
            let dR = (matrix(&exp(&at(h))) - matrix(&exp(&at(-h)))) / (2.0 * h);
            let spin = dR * matrix(&exp(&t)).transpose();
            assert!((spin - crate::math::skew(&w)).amax() < 3e-7, "{t}");
            assert!(((omega(h) - omega(-h)) / (2.0 * h) - alpha).amax() < 3e-7, "{t}");
            // Other order of summation, and the inverse: a few roundings of numbers up to ten, more near 2π.
            let (chart, (_, own)) = (Chart::new(&t), rates(&t, &d, &Vec3::zeros()));
            let (w_chart, own_chart) = chart.rates(&d);
            assert!((w_chart - w).amax() < 1e-14 && (own_chart - own).amax() < 1e-13, "{t}");
            assert!((chart.inverse(&w) - d).amax() < 1e-12, "{t}");
            let (d_back, dd_back) = vector_rates(&t, &w, &alpha);
            // Identical order of summation.
            assert_eq!((chart.vector_rates(&w, &alpha), chart.spatial_rates(&d, &dd)), ((d_back, dd_back), (w, alpha)));
            assert!((d_back - d).amax() < 1e-12 && (dd_back - dd).amax() < 1e-11, "{t}");
        }
    }

    #[test]
    fn series_meet_the_closed_forms() {
        // Arguments 5e-13 apart change the functions by up to 1e-13; a missing term of a series would show as 1e-9 or more.
        let (a, b) = (SERIES * (1.0 - 1e-12), SERIES * (1.0 + 1e-12));
        let (l, r) = (coefficients(a), coefficients(b));
        for (x, y) in [(l.0, r.0), (l.1, r.1), (l.2, r.2), (l.3, r.3)] {
            assert!((x - y).abs() < 5e-13, "{x} {y}"); // the closed forms of the derivatives lose digits
        }
        assert!((inverse_coefficient(a) - inverse_coefficient(b)).abs() < 1e-13);
        let (l, r) = (half_angle(a), half_angle(b));
        assert!((l.0 - r.0).abs() < 1e-13 && (l.1 - r.1).abs() < 1e-13);
    }

    /// exp(Θ + δΘ) = exp(δθ) exp(Θ) to first order, δΘ = T⁻¹ δθ; second-order remainder of |δθ| = 1e-5 is 1e-10.
    #[test]
    fn inverse_tangent_maps_increments() {
        for (t, d, m) in vectors() {
            let dtheta = 1e-5 * d;
            let left = exp(&(t + inverse_tangent(&t, &dtheta)));
            let right = exp(&dtheta) * exp(&t);
            assert!((left - right).norm() < 1e-9, "{t}");
            assert!((inverse_tangent_matrix(&t) * d - inverse_tangent(&t, &d)).norm() < 1e-14 * 10.0);
            let h = 1e-5;
            let value = |t: &Vec3| inverse_tangent_matrix(t).transpose() * m;
            let numeric = (value(&(t + h * d)) - value(&(t - h * d))) / (2.0 * h);
            // Cancellation 1e-16/h plus truncation h².
            assert!((inverse_tangent_transpose_derivative(&t, &m) * d - numeric).norm() < 1e-9, "{t}");
        }
    }
}
