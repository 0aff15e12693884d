//! Dense blocks of fixed size, column by column, written so that the compiler keeps them in vector registers.

use crate::math::fma;

use super::VANISHED;

/// `block[col][row]`.
pub(super) type Block<const B: usize> = [[f64; B]; B];
pub(super) type Column<const B: usize> = [f64; B];

/// y −= A x
#[inline(always)]
pub(super) fn subtract_times<const B: usize>(y: &mut Column<B>, A: &Block<B>, x: &Column<B>) {
    for k in 0..B {
        for i in 0..B {
            y[i] = fma(A[k][i], -x[k], y[i]);
        }
    }
}

/// A x
#[inline(always)]
pub(super) fn times<const B: usize>(A: &Block<B>, x: &Column<B>) -> Column<B> {
    let mut y = [0.0; B];
    for k in 0..B {
        for i in 0..B {
            y[i] = fma(A[k][i], x[k], y[i]);
        }
    }
    y
}

/// A X
#[inline(always)]
pub(super) fn product<const B: usize>(A: &Block<B>, X: &Block<B>) -> Block<B> {
    let mut Y = [[0.0; B]; B];
    for k in 0..B {
        for j in 0..B {
            for i in 0..B {
                Y[j][i] = fma(A[k][i], X[j][k], Y[j][i]);
            }
        }
    }
    Y
}

/// Y −= A X. On its own the loop is vectorised well; inlined beside others it is not.
#[inline(never)]
pub(super) fn subtract_product<const B: usize>(Y: &mut Block<B>, A: &Block<B>, X: &Block<B>) {
    let AX = product(A, X);
    for j in 0..B {
        for i in 0..B {
            Y[j][i] -= AX[j][i];
        }
    }
}

/// Largest magnitude of each row: what a pivot of the row is measured against.
#[inline(always)]
pub(super) fn row_scale<const B: usize>(A: &Block<B>) -> Column<B> {
    let mut scale = [0.0_f64; B];
    for column in A {
        for i in 0..B {
            scale[i] = scale[i].max(column[i].abs());
        }
    }
    scale
}

/// A row is fetched from below only if the pivot at hand is ten times smaller: the search then stays off the chain of
/// dependent operations, and a positive definite block mostly keeps its diagonal.
const ACCEPTED: f64 = 0.1;

/// Rows of the working copy of a block: whole vector registers, whatever B.
const LANES: usize = 8;

/// A ← A⁻¹ by Gauss–Jordan with row pivoting. `scale` is that of the rows before any elimination.
/// Fails with the row (before exchange) and value of the pivot that vanished.
#[inline(always)]
pub(super) fn invert<const B: usize>(A: &mut Block<B>, scale: &Column<B>) -> Result<(), (usize, f64)> {
    let mut M = [[0.0; LANES]; B];
    let mut row = [0; B]; // the original row that now stands at each place
    for k in 0..B {
        M[k][..B].copy_from_slice(&A[k]);
        row[k] = k;
    }
    for k in 0..B {
        let largest = M[k][k + 1..B].iter().fold(0.0, |largest, a| if a.abs() > largest { a.abs() } else { largest });
        if M[k][k].abs() < ACCEPTED * largest {
            exchange(&mut M, &mut row, k);
        }
        let pivot = M[k][k];
        let vanished = (VANISHED * scale[row[k]]).max(f64::MIN_POSITIVE);
        if !(pivot.abs() > vanished && pivot.is_finite()) {
            return Err((row[k], pivot));
        }
        eliminate(&mut M, k, 1.0 / pivot);
    }
    for k in 0..B {
        // What was done to the rows of the matrix is undone on the columns of the inverse.
        A[row[k]].copy_from_slice(&M[k][..B]);
    }
    Ok(())
}

/// One step of Gauss–Jordan. The row of the pivot is written like the others, its old values masked out, so that no
/// lane is treated alone; not inlined, or the compiler unrolls the step into single numbers and takes twice as long.
#[inline(never)]
fn eliminate<const B: usize>(M: &mut [[f64; LANES]; B], k: usize, inverse: f64) {
    let others: [f64; LANES] = std::array::from_fn(|i| if i == k { 0.0 } else { 1.0 });
    let mut factor = [0.0; LANES];
    for i in 0..LANES {
        factor[i] = (1.0 - others[i]) - M[k][i] * others[i];
    }
    for column in M.iter_mut() {
        let t = column[k] * inverse;
        for i in 0..LANES {
            column[i] = fma(factor[i], t, column[i] * others[i]);
        }
    }
    M[k] = factor.map(|a| a * inverse);
}

/// Brings the largest entry of column `k` at or below the diagonal to the diagonal.
#[cold]
#[inline(never)]
fn exchange<const B: usize>(M: &mut [[f64; LANES]; B], row: &mut [usize; B], k: usize) {
    let largest = (k..B).max_by(|&i, &j| M[k][i].abs().total_cmp(&M[k][j].abs())).unwrap_or(k);
    row.swap(k, largest);
    for column in M.iter_mut() {
        column.swap(k, largest);
    }
}
