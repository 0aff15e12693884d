//! Logarithmic strain of the reference surface of a shell that yields: its stress is force per current area.
//!
//! With E the strain of Green, H = ½ ln(I + 2E) is taken as
//!   H = Y + ⅓ Y³,    Y = E (I + E)⁻¹,
//! the first terms of the series of the inverse hyperbolic tangent. The error ⅕ Y⁵ is 1e-5 of the strain at 10 % stretch and 1e-3 at 35 %.
//! The small-strain material law relates H to its conjugate stress T (Miehe, Apel & Lambrecht, Comput. Methods Appl. Mech. Engrg 191,
//! 2002). T is Kirchhoff's stress in axes turning with the surface: force per current area times the volume ratio, which is 1 in plastic
//! flow. A sheet that is stretched carries less by as much as it becomes thinner and narrower. The stress conjugate to E is S = T : ∂H/∂E;
//! as T·dH = S·dE, energy and dissipation equal those of small strains. H is a function of E alone: rigid motion changes nothing.
//!
//! Limit: the heights of layers are constant, so a stretched sheet bends with its initial thickness.

use base::math::number::Number;
use std::array::from_fn;

const THIRD: f64 = 1.0 / 3.0;

/// Logarithmic strain at a point; symmetric matrices as [11, 22, 12].
pub(super) struct Stretch<T> {
    /// H as ε₁, ε₂, γ₁₂.
    pub strain: [T; 3],
    Y: [T; 3],
    /// (I + E)⁻¹.
    G: [T; 3],
}

/// A B A.
#[inline(always)]
fn sandwich<T: Number>(A: &[T; 3], B: &[T; 3]) -> [T; 3] {
    let (first, second) = (
        [A[0] * B[0] + A[2] * B[2], A[0] * B[2] + A[2] * B[1]],
        [A[2] * B[0] + A[1] * B[2], A[2] * B[2] + A[1] * B[1]],
    );
    [first[0] * A[0] + first[1] * A[2], second[0] * A[2] + second[1] * A[1], first[0] * A[2] + first[1] * A[1]]
}

impl<T: Number> Stretch<T> {
    /// `strain`: that of Green, ε₁, ε₂, γ₁₂.
    #[inline(always)]
    pub fn new(&[a, b, shear]: &[T; 3]) -> Stretch<T> {
        let (one, two, third) = (T::splat(1.0), T::splat(2.0), T::splat(THIRD));
        let c = T::splat(0.5) * shear;
        let det = a * b - c * c;
        let r = one / (one + a + b + det);
        let Y = [(a + det) * r, (b + det) * r, c * r];
        let G = [(one + b) * r, (one + a) * r, T::splat(0.0) - c * r];
        // Y³ = (t² − d) Y − t d I, with t and d the trace and the determinant of Y.
        let (t, d) = (Y[0] + Y[1], Y[0] * Y[1] - Y[2] * Y[2]);
        let (s, p) = (one + third * (t * t - d), third * (t * d));
        Stretch { strain: [Y[0] * s - p, Y[1] * s - p, two * (Y[2] * s)], Y, G }
    }

    /// A + ⅓ (Y² A + Y A Y + A Y²): dH for A = dY.
    #[inline(always)]
    fn rate(&self, A: &[T; 3]) -> [T; 3] {
        let (two, third, Y) = (T::splat(2.0), T::splat(THIRD), &self.Y);
        let Z = [Y[0] * Y[0] + Y[2] * Y[2], Y[1] * Y[1] + Y[2] * Y[2], Y[2] * (Y[0] + Y[1])];
        let between = sandwich(Y, A);
        [
            A[0] + third * (two * (Z[0] * A[0] + Z[2] * A[2]) + between[0]),
            A[1] + third * (two * (Z[1] * A[1] + Z[2] * A[2]) + between[1]),
            A[2] + third * ((Z[0] + Z[1]) * A[2] + Z[2] * (A[0] + A[1]) + between[2]),
        ]
    }

    /// The stress conjugate to E, from the stress N conjugate to H.
    #[inline(always)]
    pub fn conjugate(&self, N: &[T; 3]) -> [T; 3] {
        sandwich(&self.G, &self.rate(N))
    }
}

/// Changes of E by ε₁, ε₂, γ₁₂.
const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]];

/// A matrix of two rows.
type Matrix<T> = [[T; 2]; 2];

fn matrix<T: Copy>([a, b, c]: [T; 3]) -> Matrix<T> {
    [[a, c], [c, b]]
}

/// A B.
#[inline(always)]
fn times<T: Number>(A: &Matrix<T>, B: &Matrix<T>) -> Matrix<T> {
    A.map(|row| [0, 1].map(|j| row[0] * B[0][j] + row[1] * B[1][j]))
}

/// A + Aᵀ as [11, 22, 12].
#[inline(always)]
fn with_transpose<T: Number>(A: &Matrix<T>) -> [T; 3] {
    [A[0][0] + A[0][0], A[1][1] + A[1][1], A[0][1] + A[1][0]]
}

impl<T: Number> Stretch<T> {
    /// ∂H/∂E by columns: the change of H with each component of E.
    #[inline(always)]
    pub fn slopes(&self) -> [[T; 3]; 3] {
        UNITS.map(|unit| {
            let [a, b, c] = self.rate(&sandwich(&self.G, &unit.map(T::splat)));
            [a, b, T::splat(2.0) * c]
        })
    }

    /// N : ∂²H/∂E∂E.
    #[inline(always)]
    pub fn curvature(&self, N: &[T; 3]) -> [[T; 3]; 3] {
        let (Y, N, third) = (matrix(self.Y), matrix(*N), T::splat(THIRD));
        let (NY, MG) = (times(&N, &Y), times(&matrix(self.rate(&[N[0][0], N[1][1], N[0][1]])), &matrix(self.G)));
        UNITS.map(|unit| {
            let dY = matrix(sandwich(&self.G, &unit.map(T::splat)));
            let dZ = matrix(with_transpose(&times(&dY, &Y)));
            let (first, second) = (times(&dZ, &N), times(&dY, &NY));
            let dM = with_transpose(&[0, 1].map(|i| [0, 1].map(|j| first[i][j] + second[i][j])));
            let (along, turned) = (sandwich(&self.G, &dM.map(|m| third * m)), with_transpose(&times(&dY, &MG)));
            from_fn(|i| along[i] - turned[i])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::lanes::Lanes;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn strain_is_logarithmic() {
        for stretch in [0.7_f64, 0.9, 0.99, 1.01, 1.1, 1.3] {
            let (E, H) = (0.5 * (stretch * stretch - 1.0), stretch.ln());
            // One strain along an axis and at 45 degrees to the axes.
            let along = Stretch::new(&[E, 0.0, 0.0]).strain;
            let across = Stretch::new(&[0.5 * E, 0.5 * E, E]).strain;
            let bound = 0.3 * (H.abs()).powi(5) + 1e-15;
            assert!((along[0] - H).abs() < bound && along[1].abs() < 1e-15, "{along:?} {H}");
            assert!((across[0] - 0.5 * H).abs() < bound && (across[2] - H).abs() < bound, "{across:?} {H}");
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let mut rng = StdRng::seed_from_u64(5);
        for _ in 0..100 {
            let E: [f64; 3] = from_fn(|_| rng.random_range(-0.2..0.3));
            let N: [f64; 3] = from_fn(|_| rng.random_range(-1.0..1.0));
            let at = Stretch::new(&E);
            let (slopes, curvature, S) = (at.slopes(), at.curvature(&N), at.conjugate(&N));
            for j in 0..3 {
                let moved = |s: f64| Stretch::new(&from_fn(|i| E[i] + if i == j { s } else { 0.0 }));
                let (ahead, behind) = (moved(1e-6), moved(-1e-6));
                let work: f64 = (0..3).map(|i| N[i] * slopes[j][i]).sum();
                assert!((work - S[j]).abs() < 1e-14);
                for i in 0..3 {
                    let slope = (ahead.strain[i] - behind.strain[i]) / 2e-6;
                    assert!((slope - slopes[j][i]).abs() < 1e-9, "{slope} {}", slopes[j][i]);
                    let second = (ahead.conjugate(&N)[i] - behind.conjugate(&N)[i]) / 2e-6;
                    assert!((second - curvature[j][i]).abs() < 1e-8, "{second} {}", curvature[j][i]);
                    assert!((curvature[i][j] - curvature[j][i]).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn eight_are_one_eight_times() {
        let mut rng = StdRng::seed_from_u64(6);
        let E: [[f64; 8]; 3] = from_fn(|_| from_fn(|_| rng.random_range(-0.2..0.3)));
        let N: [[f64; 8]; 3] = from_fn(|_| from_fn(|_| rng.random_range(-1.0..1.0)));
        let eight = Stretch::new(&E.map(Lanes::new));
        let (H, S) = (eight.strain.map(Lanes::to_array), eight.conjugate(&N.map(Lanes::new)).map(Lanes::to_array));
        for lane in 0..8 {
            let one = Stretch::new(&from_fn(|i| E[i][lane]));
            assert_eq!(one.strain, from_fn::<f64, 3, _>(|i| H[i][lane]));
            assert_eq!(one.conjugate(&from_fn(|i| N[i][lane])), from_fn::<f64, 3, _>(|i| S[i][lane]));
        }
    }
}
