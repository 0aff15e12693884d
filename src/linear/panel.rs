//! Substitution in one panel of L: a triangle on the diagonal and the rows below it, by columns.
//!
//! A large panel is taken in blocks of columns. Forward, the rows below a block are halved recursively, and backward its columns, so
//! that the halves can run side by side. The cut depends on the sizes alone, so the bits do not depend on the number of threads.

use super::dense::join;
use super::tree::Front;
use base::math::fma;

/// Columns eliminated together: the rows below are then read and written once for all of them.
const COLUMNS: usize = 4;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;
/// Panels of this size are processed in blocks; a smaller panel is read faster than a thread wakes.
const LARGE: usize = 1 << 16;
/// Columns of a block, a multiple of `COLUMNS`.
const BLOCK: usize = 128;
/// Pieces of a block have at least so many numbers, for the same reason.
const SMALLEST: usize = 1 << 14;

/// A panel of columns of `height` rows.
#[derive(Clone, Copy)]
pub(super) struct Panel<'a> {
    values: &'a [f64],
    columns: usize,
    pub height: usize,
    /// L of L D Lᵀ: ones in place of its diagonal, which holds D.
    unit: bool,
}

impl<'a> Panel<'a> {
    pub fn new(front: &Front, values: &'a [f64], unit: bool) -> Self {
        Panel { values, columns: front.columns, height: front.height(), unit }
    }

    /// Columns of a block.
    fn block(&self) -> usize {
        if self.values.len() < LARGE { self.columns } else { BLOCK }
    }

    /// The rows `from..end` of column `k`.
    fn column(&self, k: usize, from: usize, end: usize) -> &'a [f64] {
        &self.values[k * self.height + from..k * self.height + end]
    }

    /// Solves for the columns in `f`, and subtracts their contribution from the rows below.
    pub fn forward<const R: usize>(&self, f: &mut [[f64; R]], threads: bool) {
        let mut begin = 0;
        while begin < self.columns {
            let end = (begin + self.block()).min(self.columns);
            // A panel of one block goes on through all its rows at once.
            let last = if end - begin == self.columns { self.height } else { end };
            self.forward_triangle(begin, end, &mut f[..last]);
            let (y, rest) = f.split_at_mut(end);
            if last < self.height {
                self.subtract(begin, &y[begin..], end, rest, threads);
            }
            begin = end;
        }
    }

    /// Solves for the columns `begin..end`, and subtracts their contribution from the rows of `f` below.
    fn forward_triangle<const R: usize>(&self, begin: usize, end: usize, f: &mut [[f64; R]]) {
        for j in (begin..end).step_by(COLUMNS) {
            let next = (j + COLUMNS).min(end);
            for k in j..next {
                let column = self.column(k, 0, next);
                if !self.unit {
                    f[k] = f[k].map(|f| f / column[k]);
                }
                for i in k + 1..next {
                    for r in 0..R {
                        f[i][r] -= column[i] * f[k][r];
                    }
                }
            }
            let (y, rest) = f.split_at_mut(next);
            self.subtract_columns(j, &y[j..], next, rest);
        }
    }

    /// rest ← rest − Σ y_k column k, over the rows from `from` on and the columns from `first` on, the rows in halves.
    fn subtract<const R: usize>(
        &self,
        first: usize,
        y: &[[f64; R]],
        from: usize,
        rest: &mut [[f64; R]],
        threads: bool,
    ) {
        let half = rest.len() / 2;
        if half * y.len() >= SMALLEST {
            let (upper, lower) = rest.split_at_mut(half);
            join(
                threads,
                || self.subtract(first, y, from, upper, threads),
                || self.subtract(first, y, from + half, lower, threads),
            );
        } else {
            for (n, y) in y.chunks(COLUMNS).enumerate() {
                self.subtract_columns(first + n * COLUMNS, y, from, rest);
            }
        }
    }

    /// rest ← rest − Σ y_k column k for up to `COLUMNS` columns.
    #[inline]
    fn subtract_columns<const R: usize>(&self, first: usize, y: &[[f64; R]], from: usize, rest: &mut [[f64; R]]) {
        let end = from + rest.len();
        if let Ok(y) = <[[f64; R]; COLUMNS]>::try_from(y) {
            let [a, b, c, d] = std::array::from_fn(|k| self.column(first + k, from, end));
            for ((((row, a), b), c), d) in rest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                for (r, row) in row.iter_mut().enumerate() {
                    *row = fma(*d, -y[3][r], fma(*c, -y[2][r], fma(*b, -y[1][r], fma(*a, -y[0][r], *row))));
                }
            }
        } else {
            for (k, y) in y.iter().enumerate() {
                let column = self.column(first + k, from, end);
                for (row, l) in rest.iter_mut().zip(column) {
                    row.iter_mut().zip(y).for_each(|(row, y)| *row = fma(*l, -y, *row));
                }
            }
        }
    }

    /// Solves for the columns in `f`, whose rows below hold the solution; divides by D first, if there is one.
    pub fn backward<const R: usize>(&self, f: &mut [[f64; R]], threads: bool) {
        if self.unit {
            for (k, y) in f[..self.columns].iter_mut().enumerate() {
                *y = y.map(|y| y / self.values[k * self.height + k]);
            }
        }
        let mut end = self.columns;
        while end > 0 {
            let begin = (end - 1) / self.block() * self.block();
            let last = if end - begin == self.columns { self.height } else { end };
            let (y, rest) = f.split_at_mut(end);
            if last < self.height {
                self.take(begin, &mut y[begin..], end, rest, threads);
            }
            self.backward_triangle(begin, end, &mut f[..last]);
            end = begin;
        }
    }

    /// y_k ← y_k − column k · rest for the columns from `first` on, in halves, and the rows from `from` on.
    fn take<const R: usize>(&self, first: usize, y: &mut [[f64; R]], from: usize, rest: &[[f64; R]], threads: bool) {
        let half = y.len() / (2 * COLUMNS) * COLUMNS;
        if half * rest.len() >= SMALLEST {
            let (left, right) = y.split_at_mut(half);
            join(
                threads,
                || self.take(first, left, from, rest, threads),
                || self.take(first + half, right, from, rest, threads),
            );
        } else {
            for (n, y) in y.chunks_mut(COLUMNS).enumerate() {
                let taken = self.taken(first + n * COLUMNS, y.len(), from, rest);
                y.iter_mut().flatten().zip(taken.iter().flatten()).for_each(|(y, taken)| *y -= taken);
            }
        }
    }

    /// Scalar products of `rest` with up to `COLUMNS` columns.
    #[inline]
    fn taken<const R: usize>(&self, first: usize, count: usize, from: usize, rest: &[[f64; R]]) -> [[f64; R]; COLUMNS] {
        let column = |k: usize| self.column(first + k, from, from + rest.len());
        if count == COLUMNS {
            products(std::array::from_fn(column), rest)
        } else {
            std::array::from_fn(|k| if k < count { products([column(k)], rest)[0] } else { [0.0; R] })
        }
    }

    /// Solves for the columns `begin..end` where the rows of `f` below hold the solution.
    fn backward_triangle<const R: usize>(&self, begin: usize, end: usize, f: &mut [[f64; R]]) {
        for j in (begin..end).step_by(COLUMNS).rev() {
            let next = (j + COLUMNS).min(end);
            let (y, rest) = f.split_at_mut(next);
            let taken = self.taken(j, next - j, next, rest);
            for k in (j..next).rev() {
                let column = self.column(k, 0, next);
                for r in 0..R {
                    let mut sum = y[k][r] - taken[k - j][r];
                    for i in k + 1..next {
                        sum -= column[i] * y[i][r];
                    }
                    y[k][r] = if self.unit { sum } else { sum / column[k] };
                }
            }
        }
    }
}

/// Scalar products of columns with `x`, each summed in lanes of fixed width.
#[inline(always)]
fn products<const C: usize, const R: usize>(columns: [&[f64]; C], x: &[[f64; R]]) -> [[f64; R]; C] {
    let mut sums = [[[0.0; R]; LANES]; C];
    let (whole, rest) = x.as_chunks::<LANES>();
    for (n, x) in whole.iter().enumerate() {
        for c in 0..C {
            let column = &columns[c][n * LANES..(n + 1) * LANES];
            for i in 0..LANES {
                for r in 0..R {
                    sums[c][i][r] = fma(column[i], x[i][r], sums[c][i][r]);
                }
            }
        }
    }
    let from = whole.len() * LANES;
    std::array::from_fn(|c| {
        std::array::from_fn(|r| {
            let tail: f64 = columns[c][from..].iter().zip(rest).map(|(l, x)| l * x[r]).sum();
            sums[c].iter().map(|sum| sum[r]).sum::<f64>() + tail
        })
    })
}
