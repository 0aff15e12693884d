//! LU factorisation on dense B×B blocks, one per group: the pattern is symmetric, the values need not be.
//!
//! Blocks are eliminated in a fixed order without exchange between them; within a diagonal block rows are exchanged, so
//! that indefinite tangents pass. A = L U with L_ik = A_ik D_k⁻¹ and U_ki = A_ki, where D_k is the diagonal block when
//! its turn comes. Its inverse is kept: to multiply by it is faster than a substitution, whose operations wait for each
//! other. A group of fewer than B unknowns is padded with rows of the identity.

use super::elimination::Elimination;
use super::graph::Graph;
use super::kernel::{
    DenseBlock, DenseColumn, gemm, gemv, invert, is_determinant_negative, multiply, negative_eigenvalues, product,
    row_scale,
};
use super::memory::{self, TooLarge};
use super::pivot::Singular;
use super::stats::Stats;
use super::stops::StopQuery;
use base::snapshot::{Keep, Snapshot};

/// Smallest size for the check of available memory.
const WORTH_A_LOOK: usize = 1_000_000;
/// Blocks after which it is asked whether the factorisation is to end: a hundredth of their time.
const BETWEEN_LOOKS: usize = 64;
/// Relative difference, to the geometric mean of the diagonal entries, from which two entries count as different. Rounding and an
/// incomplete equilibrium stay below it.
const DIFFERENT: f64 = 1e-6;

/// A matrix of B×B blocks and its LU factorisation.
pub struct BlockLu<const B: usize> {
    graph: Graph,
    elimination: Elimination,
    /// The first block of each position k in `blocks`: D_k, then L_ik and then U_ki for each i of `below(k)`. The last entry
    /// is that of the spare block.
    start: Vec<usize>,
    /// The place of j in `below(i)`, for each k and each pair i < j of `below(k)`.
    places: Vec<u32>,
    /// The places in `values` of the diagonal entries that pad groups of fewer than B unknowns.
    padding: Vec<usize>,
    /// Written by assembly, overwritten by `factor`.
    blocks: Vec<DenseBlock<B>>,
    /// The largest magnitude in each row of the diagonal blocks as assembled, by position. Written by `factor`.
    scales: Vec<DenseColumn<B>>,
    /// Right-hand side and solution by position; zero in padded rows. Written by `solve`.
    x: Vec<DenseColumn<B>>,
}

impl<const B: usize> Keep for BlockLu<B> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let BlockLu { blocks, scales, graph: _, elimination: _, start: _, places: _, padding: _, x: _ } = self;
        blocks.keep(snapshot);
        scales.keep(snapshot);
    }
}

impl<const B: usize> BlockLu<B> {
    /// The factorisation of a pattern, without numbers.
    ///
    /// # Errors
    /// The memory does not hold it.
    pub(super) fn new(graph: Graph) -> Result<Self, TooLarge> {
        let elimination = Elimination::new(&graph);
        let n = elimination.groups();
        let mut start = vec![0];
        let (mut places, mut padding) = (Vec::new(), Vec::new());
        for k in 0..n {
            let below = elimination.below(k);
            for (t, &i) in below.iter().enumerate() {
                // Fill couples all groups that couple with k, so the search always finds one.
                let row = elimination.below(i as usize);
                places.extend(below[t + 1..].iter().map(|j| row.partition_point(|other| other < j) as u32));
            }
            let diagonal = start[k] * B * B;
            padding.extend((graph.sizes[elimination.order[k]]..B).map(|i| diagonal + i * B + i));
            start.push(start[k] + 1 + 2 * below.len());
        }
        let numbers = (start[n] + 1) * B * B;
        if numbers > WORTH_A_LOOK {
            memory::require(graph.unknowns(), numbers)?;
        }
        let blocks = vec![[[0.0; B]; B]; start[n] + 1];
        let zeros = vec![[0.0; B]; n];
        Ok(BlockLu { graph, elimination, start, places, padding, blocks, scales: zeros.clone(), x: zeros })
    }

    /// The place of an entry in [`BlockLu::values`]; `None` where it is not in the pattern.
    pub(super) fn slot(&self, row: usize, col: usize) -> Option<usize> {
        let (g, h) = (*self.graph.group.get(row)? as usize, *self.graph.group.get(col)? as usize);
        if !self.graph.coupled(g, h) {
            return None;
        }
        let (i, j) = (self.elimination.position[g], self.elimination.position[h]);
        let k = i.min(j);
        let below = self.elimination.below(k);
        let place = |other: usize| below.binary_search(&(other as u32)).ok();
        let block = match i.cmp(&j) {
            std::cmp::Ordering::Equal => 0,
            std::cmp::Ordering::Greater => 1 + place(i)?,
            std::cmp::Ordering::Less => 1 + below.len() + place(j)?,
        };
        Some(((self.start[k] + block) * B + col - self.graph.first[h]) * B + row - self.graph.first[g])
    }

    /// The entries of the matrix, to be filled before each factorisation, which overwrites them.
    pub(super) fn values(&mut self) -> &mut [f64] {
        self.blocks.as_flattened_mut().as_flattened_mut()
    }

    /// Hands each entry of the matrix as assembled, before `factor`, to `visit`: external row, external column, value.
    pub(super) fn each_entry(&self, visit: &mut dyn FnMut(usize, usize, f64)) {
        let (order, graph) = (&self.elimination.order, &self.graph);
        let mut block = |place: usize, g: usize, h: usize| {
            for j in 0..graph.sizes[h] {
                for i in 0..graph.sizes[g] {
                    visit(graph.first[g] + i, graph.first[h] + j, self.blocks[place][j][i]);
                }
            }
        };
        for k in 0..self.elimination.groups() {
            let below = self.elimination.below(k);
            block(self.start[k], order[k], order[k]);
            for (t, &i) in below.iter().enumerate() {
                block(self.start[k] + 1 + t, order[i as usize], order[k]);
                block(self.start[k] + 1 + below.len() + t, order[k], order[i as usize]);
            }
        }
    }

    /// True where entries as assembled, before `factor`, differ from those across the diagonal.
    pub(super) fn has_unsymmetric_values(&self) -> bool {
        let blocks = &self.blocks;
        let differ = |(a, b): (f64, f64), (p, q): (f64, f64)| {
            (a - b).powi(2) > DIFFERENT * DIFFERENT * (p * q).abs().max(a * a).max(b * b)
        };
        let sizes = |k: usize| self.graph.sizes[self.elimination.order[k]];
        (0..self.elimination.groups()).any(|k| {
            let (D, below) = (&blocks[self.start[k]], self.elimination.below(k));
            let own = (0..sizes(k)).any(|j| (0..j).any(|i| differ((D[j][i], D[i][j]), (D[i][i], D[j][j]))));
            own || below.iter().enumerate().any(|(t, &i)| {
                let i = i as usize;
                let other = &blocks[self.start[i]];
                let (L, U) = (&blocks[self.start[k] + 1 + t], &blocks[self.start[k] + 1 + below.len() + t]);
                (0..sizes(k)).any(|c| (0..sizes(i)).any(|r| differ((L[c][r], U[r][c]), (other[r][r], D[c][c]))))
            })
        })
    }

    /// A place in [`BlockLu::values`] for entries that are not wanted.
    pub(super) fn spare(&self) -> usize {
        (self.blocks.len() - 1) * B * B
    }

    /// Right-looking elimination: inverts each D_k in turn and updates all blocks below and right of it. False where `stops` is true before
    /// it is done.
    pub(super) fn factor(&mut self, stops: StopQuery) -> Result<bool, Singular> {
        let values = self.blocks.as_flattened_mut().as_flattened_mut();
        for &slot in &self.padding {
            values[slot] = 1.0;
        }
        for (scale, &start) in self.scales.iter_mut().zip(&self.start) {
            *scale = row_scale(&self.blocks[start]);
        }

        let mut places = self.places.iter();
        for k in 0..self.elimination.groups() {
            if k % BETWEEN_LOOKS == BETWEEN_LOOKS - 1 && stops() {
                return Ok(false);
            }
            let (done, rest) = self.blocks.split_at_mut(self.start[k + 1]);
            let (D, beside) = done[self.start[k]..].split_first_mut().expect("each position has its diagonal block");
            invert(D, &self.scales[k])
                .map_err(|(i, pivot)| Singular { row: self.graph.first[self.elimination.order[k]] + i, pivot })?;

            let below = self.elimination.below(k);
            let (L, U) = beside.split_at_mut(below.len());
            for L_ik in L.iter_mut() {
                *L_ik = product(L_ik, D);
            }
            for (t, &i) in below.iter().enumerate() {
                let i = i as usize;
                let (at, m) = (self.start[i] - self.start[k + 1], self.elimination.below(i).len());
                gemm(&mut rest[at], &L[t], &U[t]);
                for (s, &place) in (t + 1..below.len()).zip(&mut places) {
                    let lower = at + 1 + place as usize;
                    gemm(&mut rest[lower], &L[s], &U[t]);
                    gemm(&mut rest[lower + m], &L[t], &U[s]);
                }
            }
        }
        Ok(true)
    }

    /// Replaces the right-hand side `b` by the solution.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        self.gather(b);
        let n = self.elimination.groups();
        for k in 0..n {
            let x = self.x[k];
            let below = self.elimination.below(k);
            for (L, &i) in self.blocks[self.start[k] + 1..].iter().zip(below) {
                gemv(&mut self.x[i as usize], L, &x);
            }
        }
        for k in (0..n).rev() {
            let mut x = self.x[k];
            let below = self.elimination.below(k);
            for (U, &i) in self.blocks[self.start[k] + 1 + below.len()..].iter().zip(below) {
                gemv(&mut x, U, &self.x[i as usize]);
            }
            self.x[k] = multiply(&self.blocks[self.start[k]], &x);
        }
        self.scatter(b);
    }

    /// Copies `b`, by external rows, to `x`, by position.
    fn gather(&mut self, b: &[f64]) {
        for (x, &g) in self.x.iter_mut().zip(&self.elimination.order) {
            let b = &b[self.graph.first[g]..self.graph.first[g + 1]];
            match <&DenseColumn<B>>::try_from(b) {
                Ok(whole) => *x = *whole,
                Err(_) => x.iter_mut().zip(b).for_each(|(x, b)| *x = *b),
            }
        }
    }

    /// Copies `x`, by position, to `b`, by external rows.
    fn scatter(&self, b: &mut [f64]) {
        for (x, &g) in self.x.iter().zip(&self.elimination.order) {
            let b = &mut b[self.graph.first[g]..self.graph.first[g + 1]];
            match <&mut DenseColumn<B>>::try_from(&mut *b) {
                Ok(whole) => *whole = *x,
                Err(_) => b.iter_mut().zip(x).for_each(|(b, x)| *b = *x),
            }
        }
    }

    /// The negative eigenvalues of the diagonal blocks D_k, as A = L D Lᵀ; a block and its inverse have equally many.
    pub(super) fn negative_eigenvalues(&self) -> usize {
        (0..self.elimination.groups()).map(|k| negative_eigenvalues(&self.blocks[self.start[k]])).sum()
    }

    /// The determinant of A is the product of those of the blocks D_k.
    pub(super) fn is_determinant_negative(&self) -> bool {
        let negative = |k: &usize| is_determinant_negative(&self.blocks[self.start[*k]]);
        (0..self.elimination.groups()).filter(negative).count() % 2 == 1
    }

    /// The size of the factorisation, for `check`.
    pub(super) fn stats(&self) -> Stats {
        Stats {
            unknowns: self.graph.unknowns(),
            nonzeros: self.start[self.elimination.groups()] * B * B,
            in_file: false,
            numbers: self.blocks.len() * B * B,
            flops: self.elimination.block_flops * (B * B * B) as f64,
            ordering: self.elimination.name,
        }
    }
}
