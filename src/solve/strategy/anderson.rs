//! Anderson acceleration of an iteration whose matrix is not the derivative: it combines the correction with earlier ones for the least
//! remaining residual. For a linear problem it is GMRES on the preconditioned residual. D. G. Anderson, J. ACM 12 (1965); H. F. Walker & P.
//! Ni, SIAM J. Numer. Anal. 49 (2011), the form used here.

use crate::tolerances::anderson::{DEPTH, NEW};
use base::snapshot::keep;

/// The corrections of a step, and the change that each made to the next. It is allocated once.
pub struct Anderson {
    /// Changes from each earlier iteration to the next, oldest first: of the correction, and of the increments that it
    /// leads to.
    differences: Vec<[Vec<f64>; 2]>,
    used: usize,
    /// The last correction as solved and as applied.
    last: [Vec<f64>; 2],
    seen: bool,
    /// Orthonormal basis of the differences.
    basis: Vec<Vec<f64>>,
    /// Squared weights of the unknowns.
    weights: Vec<f64>,
}

keep!(Anderson { differences, used, last, seen, basis } without { weights });

impl Anderson {
    /// Room for the corrections of a step; `weights` make the unknowns comparable, a length for rotations.
    pub fn new(weights: impl Iterator<Item = f64>) -> Self {
        let weights: Vec<f64> = weights.map(|w| w * w).collect();
        let zeros = || vec![0.0; weights.len()];
        Anderson {
            differences: (0..DEPTH).map(|_| [zeros(), zeros()]).collect(),
            used: 0,
            last: [zeros(), zeros()],
            seen: false,
            basis: (0..DEPTH).map(|_| zeros()).collect(),
            weights,
        }
    }

    /// Forgets earlier corrections, at a new step or a new matrix.
    pub fn forget(&mut self) {
        self.used = 0;
        self.seen = false;
    }

    /// Replaces a correction by its combination with earlier ones.
    #[inline(never)]
    pub fn mix(&mut self, correction: &mut [f64]) {
        if self.seen {
            if self.used == DEPTH {
                self.differences.rotate_left(1);
                self.used -= 1;
            }
            let [last, made] = &self.last;
            let [change, move_] = &mut self.differences[self.used];
            for (i, f) in correction.iter().enumerate() {
                change[i] = f - last[i];
                move_[i] = made[i] + change[i];
            }
            self.used += 1;
        }
        self.last[0].copy_from_slice(correction);
        self.subtract_explained(correction);
        self.last[1].copy_from_slice(correction);
        self.seen = true;
    }

    /// Subtracts Σ γ_j (Δx_j + Δf_j) from f, with γ the least squares solution of f ≈ Σ γ_j Δf_j. Gram-Schmidt orthogonalization starts
    /// with the newest difference, so an older one contributes only its independent part.
    fn subtract_explained(&mut self, correction: &mut [f64]) {
        let Anderson { differences, basis, used, weights, .. } = self;
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&*weights).map(|((a, b), w)| w * a * b).sum::<f64>();
        let mut triangle = [[0.0; DEPTH]; DEPTH];
        let mut target = [0.0; DEPTH];
        let mut rank = 0;
        let mut source = [0; DEPTH];
        for j in (0..*used).rev() {
            let (done, rest) = basis.split_at_mut(rank);
            let q = &mut rest[0];
            q.copy_from_slice(&differences[j][0]);
            let before = dot(q, q);
            for (i, earlier) in done.iter().enumerate() {
                let along = dot(earlier, q);
                triangle[i][rank] = along;
                q.iter_mut().zip(earlier).for_each(|(q, e)| *q -= along * e);
            }
            let size = dot(q, q).sqrt();
            if size.is_nan() || size <= NEW * before.sqrt() {
                continue;
            }
            q.iter_mut().for_each(|q| *q /= size);
            triangle[rank][rank] = size;
            target[rank] = dot(q, correction);
            source[rank] = j;
            rank += 1;
        }
        let mut gamma = [0.0; DEPTH];
        for i in (0..rank).rev() {
            let known: f64 = (i + 1..rank).map(|k| triangle[i][k] * gamma[k]).sum();
            gamma[i] = (target[i] - known) / triangle[i][i];
        }
        for (gamma, &j) in gamma.iter().zip(&source).take(rank) {
            correction.iter_mut().zip(&differences[j][1]).for_each(|(c, d)| *c -= gamma * d);
        }
    }
}
