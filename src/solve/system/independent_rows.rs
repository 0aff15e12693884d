//! The independent constraint equations in the current configuration, and the loads of redundant ones.
//!
//! Redundancy is a matter of geometry. Orthogonalization with pivoting finds it in the gradients (G. Golub & C. Van Loan, Matrix
//! Computations, 5.4). The entries of G M⁻¹ Gᵀ are unsuitable, because they scale with different inertias.

use super::gradients::Gradients;
use super::masses::Masses;
use super::schur_factor::SchurFactor;
use crate::tolerances::independent_rows::NEW;
use base::math::{Vec6, angular, linear};
use std::ops::Range;

/// Which equations are solved for, and loads of the others. It is allocated once.
pub struct IndependentRows {
    /// Number of columns: six for each node that moves ends of joints.
    width: usize,
    /// The first column of each node.
    first: Vec<usize>,
    /// The remainders of the scaled gradients, row-major, the columns of each that may be nonzero, and their squared norms.
    left: Vec<f64>,
    spans: Vec<Range<usize>>,
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
    pub fn new(rows: &[&[Option<usize>]]) -> IndependentRows {
        let ends = || rows.iter().copied().flatten().flatten();
        let nodes = ends().max().map_or(0, |last| last + 1);
        let mut first = vec![usize::MAX; nodes];
        let mut width = 0;
        for &node in ends() {
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
            spans: vec![0..0; count],
            norms: vec![0.0; count],
            idle: vec![false; count],
            shares: vec![0.0; count * count],
            count: 0,
            scratch: vec![0.0; count],
        }
    }

    /// Finds which of these equations, by their numbers among all, are to be solved for; `inert` ones are not.
    pub fn find(&mut self, equations: &[usize], gradients: &Gradients, inert: &[bool], masses: &Masses) {
        self.write_gradients(equations, gradients, masses);
        let IndependentRows { width, left, spans, norms, idle, .. } = self;
        let part = |k: usize, span: &Range<usize>| k * *width + span.start..k * *width + span.end;
        for (k, norm) in norms.iter_mut().enumerate() {
            let row = &mut left[part(k, &spans[k])];
            let whole = row.iter().map(|g| g * g).sum::<f64>();
            idle[k] = true;
            *norm = if inert[k] || whole == 0.0 { 0.0 } else { 1.0 };
            row.iter_mut().for_each(|g| *g /= whole.sqrt());
        }
        loop {
            let larger = |most: usize, k: usize| if norms[k] > norms[most] { k } else { most };
            let pivot = (1..norms.len()).fold(0, larger);
            if norms.is_empty() || norms[pivot] <= NEW * NEW {
                return;
            }
            let length = norms[pivot].sqrt();
            (idle[pivot], norms[pivot]) = (false, 0.0);
            let of_pivot = spans[pivot].clone();
            left[part(pivot, &of_pivot)].iter_mut().for_each(|g| *g /= length);
            for k in 0..norms.len() {
                let both = of_pivot.start.max(spans[k].start)..of_pivot.end.min(spans[k].end);
                if norms[k] == 0.0 || both.is_empty() {
                    continue;
                }
                let along: f64 = left[part(pivot, &both)].iter().zip(&left[part(k, &both)]).map(|(a, b)| a * b).sum();
                if along == 0.0 {
                    continue;
                }
                spans[k] = of_pivot.start.min(spans[k].start)..of_pivot.end.max(spans[k].end);
                let (from, of) = (pivot * *width, k * *width);
                of_pivot.clone().for_each(|i| left[of + i] -= along * left[from + i]);
                norms[k] = left[part(k, &spans[k])].iter().map(|g| g * g).sum();
            }
        }
    }

    /// Writes the gradients in the unknowns, rotations over the length of the arms.
    fn write_gradients(&mut self, equations: &[usize], gradients: &Gradients, masses: &Masses) {
        let ratio = |G: &Vec6| if linear(G).amax() > 0.0 { angular(G).amax() / linear(G).amax() } else { 0.0 };
        let arms = equations.iter().flat_map(|&k| gradients.of(k)).map(ratio).fold(0.0, f64::max);
        let length = if arms > 0.0 { arms } else { 1.0 };
        self.left.fill(0.0);
        for (k, &equation) in equations.iter().enumerate() {
            let (mut begin, mut end) = (usize::MAX, 0);
            for (node, G) in gradients.nodes(equation).iter().zip(gradients.of(equation)) {
                let Some(node) = *node else { continue };
                let free = masses.of(node).map_or([false; 6], |block| block.free);
                let first = self.first[node];
                (begin, end) = (begin.min(first), end.max(first + 6));
                let at = k * self.width + first;
                for dof in (0..6).filter(|&dof| free[dof]) {
                    self.left[at + dof] += if dof < 3 { G[dof] } else { G[dof] / length };
                }
            }
            self.spans[k] = begin.min(end)..end;
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
