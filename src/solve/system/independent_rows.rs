//! The independent constraint equations in the current configuration, and the loads of redundant ones.
//!
//! Redundancy is a matter of geometry. Orthogonalization with pivoting finds it in the gradients (G. Golub & C. Van Loan, Matrix
//! Computations, 5.4). The entries of G M⁻¹ Gᵀ are unsuitable, because they scale with different inertias.

use super::masses::Masses;
use super::schur_factor::SchurFactor;
use crate::tolerances::independent_rows::NEW;
use base::math::{Vec6, angular, linear};

/// Which equations are solved for, and loads of the others. It is allocated once.
pub struct IndependentRows {
    /// Number of columns: six for each node that moves ends of joints.
    width: usize,
    /// The first column of each node.
    first: Vec<usize>,
    /// The remainders of the scaled gradients, row-major, and their squared norms.
    left: Vec<f64>,
    norms: Vec<f64>,
    /// True for each equation that is not solved for: inert or redundant.
    pub idle: Vec<bool>,
    /// Self-equilibrated loads of the equations, orthonormal in the weights; one row for each redundant equation.
    shares: Vec<f64>,
    count: usize,
    /// Room for a residual.
    scratch: Vec<f64>,
}

impl IndependentRows {
    /// Room for equations that move these nodes.
    pub fn new(rows: &[[Option<usize>; 2]]) -> IndependentRows {
        let nodes = rows.iter().flatten().flatten().max().map_or(0, |last| last + 1);
        let mut first = vec![usize::MAX; nodes];
        let mut width = 0;
        for &node in rows.iter().flatten().flatten() {
            if first[node] == usize::MAX {
                first[node] = width;
                width += 6;
            }
        }
        let count = rows.len();
        IndependentRows {
            width,
            first,
            left: vec![0.0; count * width],
            norms: vec![0.0; count],
            idle: vec![false; count],
            shares: vec![0.0; count * count],
            count: 0,
            scratch: vec![0.0; count],
        }
    }

    /// Finds the equations with these gradients that are to be solved for; `inert` ones are not.
    pub fn find(&mut self, rows: &[[Option<usize>; 2]], G: &[[Vec6; 2]], inert: &[bool], masses: &Masses) {
        self.write_gradients(rows, G, masses);
        let IndependentRows { width, left, norms, idle, .. } = self;
        let row = |k: usize| k * *width..(k + 1) * *width;
        for (k, norm) in norms.iter_mut().enumerate() {
            let whole = left[row(k)].iter().map(|g| g * g).sum::<f64>();
            idle[k] = true;
            *norm = if inert[k] || whole == 0.0 { 0.0 } else { 1.0 };
            left[row(k)].iter_mut().for_each(|g| *g /= whole.sqrt());
        }
        loop {
            let larger = |most: usize, k: usize| if norms[k] > norms[most] { k } else { most };
            let pivot = (1..norms.len()).fold(0, larger);
            if norms.is_empty() || norms[pivot] <= NEW * NEW {
                return;
            }
            let length = norms[pivot].sqrt();
            (idle[pivot], norms[pivot]) = (false, 0.0);
            left[row(pivot)].iter_mut().for_each(|g| *g /= length);
            for k in 0..norms.len() {
                if norms[k] == 0.0 {
                    continue;
                }
                let part: f64 = left[row(pivot)].iter().zip(&left[row(k)]).map(|(a, b)| a * b).sum();
                let (from, of) = (pivot * *width, k * *width);
                (0..*width).for_each(|i| left[of + i] -= part * left[from + i]);
                norms[k] = left[row(k)].iter().map(|g| g * g).sum();
            }
        }
    }

    /// Writes the gradients in the unknowns, rotations over the length of the arms.
    fn write_gradients(&mut self, rows: &[[Option<usize>; 2]], G: &[[Vec6; 2]], masses: &Masses) {
        let ratio = |G: &Vec6| if linear(G).amax() > 0.0 { angular(G).amax() / linear(G).amax() } else { 0.0 };
        let arms = G.iter().flatten().map(ratio).fold(0.0, f64::max);
        let length = if arms > 0.0 { arms } else { 1.0 };
        self.left.fill(0.0);
        for (k, (ends, G)) in rows.iter().zip(G).enumerate() {
            for (node, G) in ends.iter().zip(G) {
                let Some(node) = *node else { continue };
                let free = masses.of(node).map_or([false; 6], |block| block.free);
                let at = k * self.width + self.first[node];
                for dof in (0..6).filter(|&dof| free[dof]) {
                    self.left[at + dof] += if dof < 3 { G[dof] } else { G[dof] / length };
                }
            }
        }
    }

    /// Finds the self-equilibrated loads of the equations: one set for each redundant equation.
    pub fn find_shares(
        &mut self,
        factor: &mut SchurFactor,
        inert: &[bool],
        weights: &[f64],
        entry: impl Fn(usize, usize) -> f64,
    ) {
        let IndependentRows { idle, shares, count, scratch, .. } = self;
        let n = idle.len();
        *count = 0;
        for redundant in (0..n).filter(|&k| idle[k] && !inert[k]) {
            let (found, rest) = shares.split_at_mut(*count * n);
            let share = &mut rest[..n];
            for k in 0..n {
                scratch[k] = if idle[k] { 0.0 } else { -entry(k, redundant) };
            }
            share.copy_from_slice(scratch);
            factor.refine(share, scratch);
            share[redundant] = 1.0;
            for other in found.chunks_exact(n) {
                let part = product(other, share, weights);
                share.iter_mut().zip(other).for_each(|(share, other)| *share -= part * other);
            }
            let norm = product(share, share, weights).sqrt();
            if norm > 0.0 {
                share.iter_mut().for_each(|share| *share /= norm);
                *count += 1;
            }
        }
    }

    /// Shares the loads `x` among all equations: the least ones in the weights with the same forces.
    pub fn share(&self, x: &mut [f64], weights: &[f64]) {
        for share in self.shares.chunks_exact(x.len()).take(self.count) {
            let part = product(share, x, weights);
            x.iter_mut().zip(share).for_each(|(x, share)| *x -= part * share);
        }
    }
}

/// Σ wᵢ aᵢ bᵢ.
fn product(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    a.iter().zip(b).zip(weights).map(|((a, b), w)| w * a * b).sum()
}
