//! Stretch of the membrane of triangles measured along arcs instead of chords.
//!
//! A bent surface is curved between its nodes: in bending without stretching, chords shorten by b²/24 of a side, with b the turn of the
//! directors along it. Facets whose sides keep their lengths are all but rigid, and with chords a coarse mesh of a curved surface cannot
//! bend unless it stretches. The lengths are those of arcs therefore: a square of a side is e·e + b²/12, the same for both triangles of the
//! side. Membrane forces then have a moment, N b/12. A compressed side buckles between its nodes at 12 D/ℓ²; the exact value is π² D/ℓ².
//! Uniaxial tension compresses some sides of irregular triangles. To keep thin sheets stable, only elements curved at t = 0 and not very
//! slender use arcs. Quadrilaterals have other means, see [`super::hybrid`].

use super::interpolation::Interpolation;
use std::array::from_fn;
use std::ops::{Add, Mul};

/// ½ bᵀ Q_m b is added to the first three products of slopes; b holds the first three numbers of bending (two axes and twice the mixed
/// one). `T` is a number, or eight of them side by side.
#[derive(Clone, Copy)]
pub struct Camber<T>(pub [[[T; 3]; 3]; 3]);

impl Camber<f64> {
    /// Stretch along chords.
    pub const NONE: Self = Camber([[[0.0; 3]; 3]; 3]);

    /// `J`: x,ξ and x,η at the centre by the axes of the slopes; `inverse`: its inverse.
    pub fn new<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(
        J: &[[f64; 2]; 2],
        inverse: &[[f64; 2]; 2],
    ) -> Self {
        // A symmetric tensor by rows of other coordinates.
        let turned = |by: &[[f64; 2]; 2], [xx, yy, xy]: [f64; 3]| {
            let part = |i: usize, j: usize| {
                let ([a, b], [c, d]) = (by[i], by[j]);
                a * c * xx + b * d * yy + (a * d + b * c) * xy
            };
            [part(0, 0), part(1, 1), part(0, 1)]
        };
        let stretch = |b: [f64; 3]| {
            let [e1, e2, half] = turned(inverse, K::camber(turned(J, [b[0], b[1], 0.5 * b[2]])));
            [e1, e2, 2.0 * half]
        };
        let unit = |n: usize| -> [f64; 3] { from_fn(|i| if i == n { 1.0 } else { 0.0 }) };
        let alone: [[f64; 3]; 3] = from_fn(|n| stretch(unit(n)));
        let both = |n: usize, k: usize| stretch(from_fn(|i| unit(n)[i] + unit(k)[i]));
        Camber(from_fn(|m| {
            from_fn(|n| from_fn(|k| both(n.min(k), n.max(k))[m] - alone[n.min(k)][m] - alone[n.max(k)][m]))
        }))
    }
}

impl<T: Copy + Add<Output = T> + Mul<Output = T>> Camber<T> {
    /// Q_m b, the derivatives of the stretch by b.
    #[inline(always)]
    pub fn slopes(&self, b: &[T; 3]) -> [[T; 3]; 3] {
        self.0.map(|Q| Q.map(|row| row[0] * b[0] + row[1] * b[1] + row[2] * b[2]))
    }

    /// ½ bᵀ Q_m b.
    #[inline(always)]
    pub fn stretch(&self, half: T, b: &[T; 3]) -> [T; 3] {
        self.slopes(b).map(|row| half * (row[0] * b[0] + row[1] * b[1] + row[2] * b[2]))
    }

    /// The part Σ N_m Q_m b of the bending stress, from the membrane stress N.
    #[inline(always)]
    pub fn moments(&self, N: &[T], b: &[T; 3]) -> [T; 3] {
        let slopes = self.slopes(b);
        from_fn(|n| N[0] * slopes[0][n] + N[1] * slopes[1][n] + N[2] * slopes[2][n])
    }
}
