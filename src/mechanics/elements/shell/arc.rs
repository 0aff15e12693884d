//! Bending measured by the angle between directors instead of the chord.
//!
//! Interpolated directors lie on the chord: over an angle φ they differ by 2 sin ½φ. The error is φ²/24 in curvature and φ²/6 in the moment
//! of a given rotation. Slopes w of the director are therefore lengthened: w′ = w (1 + S wᵀw). S wᵀw is the squared angle over the element
//! in the bending direction, divided by 24; the remaining error is of order φ⁴. Where positions also lie on chords of arcs (see
//! [`super::camber`]), the divisor is 12.

use base::math::lanes::Lanes;
use base::math::number::LaneVec3;
use std::array::from_fn;

/// The slopes of positions and of directors, of eight elements, and the products that w′ and its derivatives need.
pub(super) struct Slopes<const V: usize> {
    /// v, of positions.
    pub v: [LaneVec3; V],
    /// w, of directors.
    pub w: [LaneVec3; V],
    /// w′.
    pub long: [LaneVec3; V],
    /// S w.
    pub y: [LaneVec3; 2],
    /// H_kb = Σ S_kd w_d·w_b.
    pub H: [[Lanes; 2]; 2],
    /// S, zero where bending is measured by chords.
    pub S: [[Lanes; 2]; 2],
    /// Bending is measured by angles, and stretch along arcs.
    pub by_arcs: bool,
}

impl<const V: usize> Slopes<V> {
    /// With bending and stretch by chords.
    #[inline(always)]
    pub fn chords(v: [LaneVec3; V], w: [LaneVec3; V]) -> Self {
        let none = [[Lanes::ZERO; 2]; 2];
        Slopes { v, w, long: w, y: [LaneVec3::ZERO; 2], H: none, S: none, by_arcs: false }
    }

    /// With the slopes of the directors lengthened.
    #[inline(always)]
    pub fn lengthened(self, S: &[[Lanes; 2]; 2]) -> Self {
        let Slopes { w, mut long, .. } = self;
        let y = [S[0][0] * w[0] + S[0][1] * w[1], S[1][0] * w[0] + S[1][1] * w[1]];
        let H = [[y[0].dot(&w[0]), y[0].dot(&w[1])], [y[1].dot(&w[0]), y[1].dot(&w[1])]];
        for b in 0..2 {
            long[b] += H[0][b] * w[0] + H[1][b] * w[1];
        }
        Slopes { long, y, H, S: *S, by_arcs: true, ..self }
    }

    /// The first three numbers of bending.
    #[inline(always)]
    pub fn first_bending(&self) -> [Lanes; 3] {
        let Slopes { v, long, .. } = self;
        [v[0].dot(&long[0]), v[1].dot(&long[1]), v[0].dot(&long[1]) + v[1].dot(&long[0])]
    }

    /// ∂(p·w′)/∂w.
    #[inline(always)]
    pub fn gradient(&self, p: &[LaneVec3; V]) -> [LaneVec3; V] {
        let P: [[Lanes; 2]; 2] = from_fn(|k| from_fn(|b| p[b].dot(&self.y[k])));
        let mut g = *p;
        for k in 0..2 {
            for b in 0..2 {
                g[k] += self.H[k][b] * p[b] + (P[k][b] + P[b][k]) * self.w[b];
            }
        }
        g
    }
}
