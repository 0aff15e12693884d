//! Lower triangles as consecutive block columns, each a rectangle from its first diagonal row down. This takes nearly half the memory of
//! the square, and dense operations work by blocks.

use super::dense::{gemm, join, syrk};
use faer::{Accum, MatMut, MatRef};
use std::ops::Range;

/// Block columns are at least so wide: narrower ones cost more calls than they save.
const NARROWEST: usize = 64;
/// The most block columns.
const MOST: usize = 8;

/// The shape of a packed triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packed {
    rows: usize,
    /// Columns of each block but the last.
    width: usize,
}

impl Packed {
    pub fn new(rows: usize) -> Packed {
        Packed { rows, width: rows.div_ceil(MOST).max(NARROWEST) }
    }

    /// Number of entries, those above the diagonal in the blocks included.
    pub fn len(&self) -> usize {
        self.start(self.blocks())
    }

    fn blocks(&self) -> usize {
        self.rows.div_ceil(self.width)
    }

    /// The first entry of a block.
    fn start(&self, block: usize) -> usize {
        let whole = block.min(self.rows / self.width);
        let of_whole = whole * self.width * self.rows - self.width * self.width * (whole * whole.saturating_sub(1)) / 2;
        let left = self.rows - whole * self.width;
        if block > whole { of_whole + left * left } else { of_whole }
    }

    /// The place of the entry (j, j), which those below it follow.
    pub fn diagonal(&self, j: usize) -> usize {
        let block = j / self.width;
        let before = block * self.width;
        self.start(block) + (j - before) * (self.rows - before) + (j - before)
    }

    /// U ← U − A Bᵀ or −A Bᵀ for the packed triangle U of a symmetric matrix.
    pub fn subtract(&self, accum: Accum, (A, B): (MatRef<f64>, MatRef<f64>), U: &mut [f64], threads: bool) {
        self.subtract_blocks(accum, (A, B), U, 0..self.blocks(), threads);
    }

    fn subtract_blocks(
        &self,
        accum: Accum,
        (A, B): (MatRef<f64>, MatRef<f64>),
        U: &mut [f64],
        blocks: Range<usize>,
        threads: bool,
    ) {
        match blocks.len() {
            0 => {}
            1 => {
                let from = blocks.start * self.width;
                let height = self.rows - from;
                let width = self.width.min(height);
                let (A_upper, A_lower) = A.subrows(from, height).split_at_row(width);
                let B_upper = B.subrows(from, width);
                let block = MatMut::from_column_major_slice_mut(U, height, width);
                let (square, below) = block.split_at_row_mut(width);
                join(
                    threads,
                    || syrk(accum, A_upper, B_upper, square, threads),
                    || gemm(accum, A_lower, B_upper, below, threads),
                );
            }
            count => {
                // The first blocks are the longest.
                let middle = blocks.start + (3 * count / 8).max(1);
                let (left, right) = U.split_at_mut(self.start(middle) - self.start(blocks.start));
                join(
                    threads,
                    || self.subtract_blocks(accum, (A, B), left, blocks.start..middle, threads),
                    || self.subtract_blocks(accum, (A, B), right, middle..blocks.end, threads),
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_follow_each_other_and_hold_the_triangle() {
        for rows in [0, 1, 63, 64, 65, 128, 200, 600, 1000] {
            let shape = Packed::new(rows);
            let mut end = 0;
            for j in 0..rows {
                let at = shape.diagonal(j);
                assert!(at >= end && at - end < shape.width + 1, "{rows}, {j}: {at} after {end}");
                end = at + rows - j;
            }
            assert_eq!(end, shape.len(), "{rows}");
        }
    }

    #[test]
    fn the_packed_product_is_that_of_the_square() {
        for (rows, columns) in [(5, 3), (70, 7), (130, 64), (900, 20)] {
            let b: Vec<f64> = (0..rows * columns).map(|k| ((k * 37 % 101) as f64 - 50.0) / 50.0).collect();
            let B = MatRef::from_column_major_slice(&b, rows, columns);
            let shape = Packed::new(rows);
            let mut U = vec![f64::NAN; shape.len()];
            shape.subtract(Accum::Replace, (B, B), &mut U, false);
            let mut threaded = vec![f64::NAN; shape.len()];
            shape.subtract(Accum::Replace, (B, B), &mut threaded, true);
            for j in 0..rows {
                for i in j..rows {
                    let exact: f64 = (0..columns).map(|k| -B[(i, k)] * B[(j, k)]).sum();
                    let at = shape.diagonal(j) + i - j;
                    // Sums of up to 64 products below 1.
                    assert!((U[at] - exact).abs() < 1e-13, "{rows} {i} {j}: {} {exact}", U[at]);
                    assert_eq!(U[at].to_bits(), threaded[at].to_bits());
                }
            }
        }
    }
}
