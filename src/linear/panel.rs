//! Substitution in one panel of L: a triangle on the diagonal and the rows below it, by columns.
//!
//! A large panel is taken in blocks of columns. Forward, the rows below a block are halved recursively, and backward its columns, so
//! that the halves can run side by side. The cut depends on the sizes alone, so the bits do not depend on the number of threads.

use super::dense::join;
use super::tree::Front;
use crate::math::fma;

/// Columns eliminated together: the rows below are then read and written once for all of them.
const COLUMNS: usize = 4;
/// Width of the partial sums of a scalar product.
const LANES: usize = 8;
/// Panels of so many numbers are taken in blocks: to read a smaller one takes less time than to wake a thread.
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

    /// Solves for the columns in `f`, and subtracts from its rows below what they contribute there.
    pub fn forward(&self, f: &mut [f64], threads: bool) {
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

    /// Solves for the columns `begin..end`, and subtracts what they contribute to the rows of `f` below.
    fn forward_triangle(&self, begin: usize, end: usize, f: &mut [f64]) {
        for j in (begin..end).step_by(COLUMNS) {
            let next = (j + COLUMNS).min(end);
            for k in j..next {
                let column = self.column(k, 0, next);
                if !self.unit {
                    f[k] /= column[k];
                }
                for i in k + 1..next {
                    f[i] -= column[i] * f[k];
                }
            }
            let (y, rest) = f.split_at_mut(next);
            self.subtract_columns(j, &y[j..], next, rest);
        }
    }

    /// rest ← rest − Σ y_k column k, over the rows from `from` on and the columns from `first` on, the rows in halves.
    fn subtract(&self, first: usize, y: &[f64], from: usize, rest: &mut [f64], threads: bool) {
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
    fn subtract_columns(&self, first: usize, y: &[f64], from: usize, rest: &mut [f64]) {
        let end = from + rest.len();
        if let Ok(y) = <[f64; COLUMNS]>::try_from(y) {
            let [a, b, c, d] = std::array::from_fn(|k| self.column(first + k, from, end));
            for ((((r, a), b), c), d) in rest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                *r = fma(*d, -y[3], fma(*c, -y[2], fma(*b, -y[1], fma(*a, -y[0], *r))));
            }
        } else {
            for (k, y) in y.iter().enumerate() {
                let column = self.column(first + k, from, end);
                rest.iter_mut().zip(column).for_each(|(r, l)| *r = fma(*l, -y, *r));
            }
        }
    }

    /// Solves for the columns in `f`, whose rows below hold the solution; divides by D before, where there is one.
    pub fn backward(&self, f: &mut [f64], threads: bool) {
        if self.unit {
            for (k, y) in f[..self.columns].iter_mut().enumerate() {
                *y /= self.values[k * self.height + k];
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
    fn take(&self, first: usize, y: &mut [f64], from: usize, rest: &[f64], threads: bool) {
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
                y.iter_mut().zip(taken).for_each(|(y, taken)| *y -= taken);
            }
        }
    }

    /// Scalar products of `rest` with up to `COLUMNS` columns.
    #[inline]
    fn taken(&self, first: usize, count: usize, from: usize, rest: &[f64]) -> [f64; COLUMNS] {
        let column = |k: usize| self.column(first + k, from, from + rest.len());
        if count == COLUMNS {
            products(std::array::from_fn(column), rest)
        } else {
            std::array::from_fn(|k| if k < count { products([column(k)], rest)[0] } else { 0.0 })
        }
    }

    /// Solves for the columns `begin..end` where the rows of `f` below hold the solution.
    fn backward_triangle(&self, begin: usize, end: usize, f: &mut [f64]) {
        for j in (begin..end).step_by(COLUMNS).rev() {
            let next = (j + COLUMNS).min(end);
            let (y, rest) = f.split_at_mut(next);
            let taken = self.taken(j, next - j, next, rest);
            for k in (j..next).rev() {
                let column = self.column(k, 0, next);
                let mut sum = y[k] - taken[k - j];
                for i in k + 1..next {
                    sum -= column[i] * y[i];
                }
                y[k] = if self.unit { sum } else { sum / column[k] };
            }
        }
    }
}

/// Scalar products of columns with `x`, each summed in lanes of fixed width.
#[inline(always)]
fn products<const C: usize>(columns: [&[f64]; C], x: &[f64]) -> [f64; C] {
    let mut sums = [[0.0; LANES]; C];
    let (whole, rest) = x.as_chunks::<LANES>();
    for (n, x) in whole.iter().enumerate() {
        for c in 0..C {
            let column = &columns[c][n * LANES..(n + 1) * LANES];
            for i in 0..LANES {
                sums[c][i] = fma(column[i], x[i], sums[c][i]);
            }
        }
    }
    let from = whole.len() * LANES;
    std::array::from_fn(|c| {
        let tail: f64 = columns[c][from..].iter().zip(rest).map(|(l, x)| l * x).sum();
        sums[c].iter().sum::<f64>() + tail
    })
}
