//! Bending measured by the angle between directors instead of the chord.
//!
//! Interpolated directors lie on the chord: over an angle φ they differ by 2 sin ½φ, an error of φ²/24 in curvature and of
//! φ²/6 in the moment of a given rotation. Slopes w of the director are therefore lengthened, w′ = w (1 + S wᵀw), where S wᵀw
//! is the squared angle over the element in the direction in which it bends, over 24: the remaining error is of order φ⁴. Where
//! the positions too stand on chords of arcs, see [`super::camber`], it is that over 12.

use base::math::{Mat3, Vec3};

/// The slopes w of the directors and the products that w′ and its derivatives need.
pub(super) struct Arc<const V: usize> {
    w: [Vec3; V],
    /// w′.
    pub long: [Vec3; V],
    /// S w.
    y: [Vec3; 2],
    /// H_kb = Σ S_kd w_d·w_b.
    H: [[f64; 2]; 2],
    S: [[f64; 2]; 2],
}

impl<const V: usize> Arc<V> {
    /// Lengthens the slopes `w`.
    #[inline(always)]
    pub fn new(S: &[[f64; 2]; 2], w: [Vec3; V]) -> Self {
        let y = [S[0][0] * w[0] + S[0][1] * w[1], S[1][0] * w[0] + S[1][1] * w[1]];
        let H = [[y[0].dot(&w[0]), y[0].dot(&w[1])], [y[1].dot(&w[0]), y[1].dot(&w[1])]];
        let mut long = w;
        for b in 0..2 {
            long[b] += H[0][b] * w[0] + H[1][b] * w[1];
        }
        Arc { w, long, y, H, S: *S }
    }

    /// P_kb = Σ S_kc p_b·w_c.
    #[inline(always)]
    fn P(&self, p: &[Vec3; V]) -> [[f64; 2]; 2] {
        [0, 1].map(|k| [0, 1].map(|b| p[b].dot(&self.y[k])))
    }

    /// ∂(p·w′)/∂w.
    #[inline(always)]
    pub fn gradient(&self, p: &[Vec3; V]) -> [Vec3; V] {
        let P = self.P(p);
        let mut g = *p;
        for k in 0..2 {
            for b in 0..2 {
                g[k] += self.H[k][b] * p[b] + (P[k][b] + P[b][k]) * self.w[b];
            }
        }
        g
    }

    /// ∂w′_b/∂w_k.
    #[inline(always)]
    pub fn slope(&self, b: usize, k: usize) -> Mat3 {
        if b > 1 || k > 1 {
            return if b == k { Mat3::identity() } else { Mat3::zeros() };
        }
        let mut J = self.y[k] * self.w[b].transpose();
        if b == k {
            J += self.w[0] * self.y[0].transpose() + self.w[1] * self.y[1].transpose();
        }
        let diagonal = self.H[k][b] + if b == k { 1.0 } else { 0.0 };
        J + diagonal * Mat3::identity()
    }

    /// ∂²(p·w′)/∂w_k∂w_l, k and l below 2.
    #[inline(always)]
    pub fn hessian(&self, p: &[Vec3; V]) -> [[Mat3; 2]; 2] {
        let P = self.P(p);
        let pw = p[0] * self.w[0].transpose() + p[1] * self.w[1].transpose();
        let pw = pw + pw.transpose();
        [0, 1].map(|k| {
            [0, 1].map(|l| {
                let outer = p[l] * self.y[k].transpose() + self.y[l] * p[k].transpose();
                self.S[k][l] * pw + outer + (P[k][l] + P[l][k]) * Mat3::identity()
            })
        })
    }
}
