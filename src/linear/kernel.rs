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

/// Negative eigenvalues of the symmetric part of A: the signs of the pivots of elimination with diagonal pivoting. Where no
/// diagonal entry will do, a pair of rows is eliminated at once, of which one eigenvalue is negative.
/// J. R. Bunch & B. N. Parlett, SIAM J. Numer. Anal. 8 (1971).
pub(super) fn negatives<const B: usize>(A: &Block<B>) -> usize {
    // Above this part of the largest entry a diagonal entry is a pivot: least growth.
    const SINGLE: f64 = 0.64;
    let mut M: Block<B> = std::array::from_fn(|j| std::array::from_fn(|i| 0.5 * (A[j][i] + A[i][j])));
    let mut left = [true; B];
    let mut count = 0;
    loop {
        let (mut diagonal, mut pair) = ((0.0, 0), (0.0, 0, 0));
        for i in (0..B).filter(|&i| left[i]) {
            if M[i][i].abs() >= diagonal.0 {
                diagonal = (M[i][i].abs(), i);
            }
            for j in (0..i).filter(|&j| left[j]) {
                if M[j][i].abs() > pair.0 {
                    pair = (M[j][i].abs(), i, j);
                }
            }
        }
        if !left.contains(&true) {
            return count;
        }
        if diagonal.0 >= SINGLE * pair.0 {
            let k = diagonal.1;
            left[k] = false;
            count += usize::from(M[k][k] < 0.0);
            if M[k][k] != 0.0 {
                let column = M[k];
                for j in (0..B).filter(|&j| left[j]) {
                    for i in (0..B).filter(|&i| left[i]) {
                        M[j][i] -= column[i] * column[j] / column[k];
                    }
                }
            }
            continue;
        }
        let (_, k, l) = pair;
        (left[k], left[l]) = (false, false);
        count += 1;
        let (K, L) = (M[k], M[l]);
        let det = K[k] * L[l] - K[l] * K[l];
        for j in (0..B).filter(|&j| left[j]) {
            for i in (0..B).filter(|&i| left[i]) {
                let (x, y) = (L[l] * K[j] - K[l] * L[j], K[k] * L[j] - K[l] * K[j]);
                M[j][i] -= (K[i] * x + L[i] * y) / det;
            }
        }
    }
}
