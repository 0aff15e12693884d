//! Operations on dense blocks of fixed size, column by column, written so that the compiler keeps them in vector registers.

use super::pivot::PIVOT_TOLERANCE;
use base::math::fma;

/// A square matrix: `block[column][row]`.
pub(super) type DenseBlock<const B: usize> = [[f64; B]; B];
/// A vector of the same height.
pub(super) type DenseColumn<const B: usize> = [f64; B];

/// y ← y − A x.
#[inline(always)]
pub(super) fn gemv<const B: usize>(y: &mut DenseColumn<B>, A: &DenseBlock<B>, x: &DenseColumn<B>) {
    for k in 0..B {
        for i in 0..B {
            y[i] = fma(A[k][i], -x[k], y[i]);
        }
    }
}

/// A x.
#[inline(always)]
pub(super) fn multiply<const B: usize>(A: &DenseBlock<B>, x: &DenseColumn<B>) -> DenseColumn<B> {
    let mut y = [0.0; B];
    for k in 0..B {
        for i in 0..B {
            y[i] = fma(A[k][i], x[k], y[i]);
        }
    }
    y
}

/// A X.
#[inline(always)]
pub(super) fn product<const B: usize>(A: &DenseBlock<B>, X: &DenseBlock<B>) -> DenseBlock<B> {
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

/// Y ← Y − A X. It is not inlined: alone the loop is vectorised well, beside others it is not.
#[inline(never)]
pub(super) fn gemm<const B: usize>(Y: &mut DenseBlock<B>, A: &DenseBlock<B>, X: &DenseBlock<B>) {
    let AX = product(A, X);
    for j in 0..B {
        for i in 0..B {
            Y[j][i] -= AX[j][i];
        }
    }
}

/// The largest magnitude in each row, which pivots of the row are compared with.
#[inline(always)]
pub(super) fn row_scale<const B: usize>(A: &DenseBlock<B>) -> DenseColumn<B> {
    let mut scale = [0.0_f64; B];
    for column in A {
        for i in 0..B {
            scale[i] = scale[i].max(column[i].abs());
        }
    }
    scale
}

/// Rows are exchanged only if the pivot is below this part of the largest entry below it. The search then stays off the critical path, and
/// a positive definite block usually keeps its diagonal.
const PIVOT_THRESHOLD: f64 = 0.1;

/// Rows of the working copy of a block: it fills whole vector registers, whatever B.
const LANES: usize = 8;

/// A ← A⁻¹ by Gauss–Jordan elimination with row pivoting. `scale` holds the largest magnitudes of the rows before any
/// elimination.
///
/// # Errors
/// A pivot is zero or not finite: its row before exchanges, and its value.
#[inline(always)]
pub(super) fn invert<const B: usize>(A: &mut DenseBlock<B>, scale: &DenseColumn<B>) -> Result<(), (usize, f64)> {
    let mut M = [[0.0; LANES]; B];
    let mut row = [0; B]; // the original row at each place
    for k in 0..B {
        M[k][..B].copy_from_slice(&A[k]);
        row[k] = k;
    }
    for k in 0..B {
        let largest = M[k][k + 1..B].iter().fold(0.0, |largest, a| if a.abs() > largest { a.abs() } else { largest });
        if M[k][k].abs() < PIVOT_THRESHOLD * largest {
            exchange(&mut M, &mut row, k);
        }
        let pivot = M[k][k];
        let tolerance = (PIVOT_TOLERANCE * scale[row[k]]).max(f64::MIN_POSITIVE);
        if !(pivot.abs() > tolerance && pivot.is_finite()) {
            return Err((row[k], pivot));
        }
        eliminate(&mut M, k, 1.0 / pivot);
    }
    for k in 0..B {
        // Exchanged rows of the matrix are exchanged columns of its inverse.
        A[row[k]].copy_from_slice(&M[k][..B]);
    }
    Ok(())
}

/// One step of Gauss–Jordan elimination. The row of the pivot is written like the others, its old values masked out, so that no lane is
/// treated alone. Without inlining the compiler keeps the vector form, which is twice as fast.
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

/// Exchanges rows to bring the largest entry of column `k` at or below the diagonal to the diagonal.
#[cold]
#[inline(never)]
fn exchange<const B: usize>(M: &mut [[f64; LANES]; B], row: &mut [usize; B], k: usize) {
    let largest = (k..B).max_by(|&i, &j| M[k][i].abs().total_cmp(&M[k][j].abs())).unwrap_or(k);
    row.swap(k, largest);
    for column in M.iter_mut() {
        column.swap(k, largest);
    }
}

/// True if the determinant of A, symmetric or not, is negative; by elimination with row exchange.
pub(super) fn is_determinant_negative<const B: usize>(A: &DenseBlock<B>) -> bool {
    let mut M = *A;
    let mut negative = false;
    for k in 0..B {
        let largest = (k..B).max_by(|&i, &j| M[i][k].abs().total_cmp(&M[j][k].abs())).unwrap_or(k);
        if largest != k {
            M.swap(k, largest);
            negative = !negative;
        }
        let pivot = M[k];
        negative ^= pivot[k] < 0.0;
        for row in M.iter_mut().skip(k + 1).filter(|_| pivot[k] != 0.0) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).skip(k).for_each(|(of, p)| *of -= factor * p);
        }
    }
    negative
}

/// The number of negative eigenvalues of the symmetric part of A, by the signs of the pivots of an elimination with diagonal
/// pivoting. Where no diagonal entry is large enough, two rows are eliminated at once: one of their eigenvalues is negative.
/// J. R. Bunch & B. N. Parlett, SIAM J. Numer. Anal. 8 (1971).
pub(super) fn negative_eigenvalues<const B: usize>(A: &DenseBlock<B>) -> usize {
    // A diagonal entry above this part of the largest off-diagonal one is a pivot: this bounds the growth of entries best.
    const SINGLE: f64 = 0.64;
    let mut M: DenseBlock<B> = std::array::from_fn(|j| std::array::from_fn(|i| 0.5 * (A[j][i] + A[i][j])));
    let mut remaining = [true; B];
    let mut count = 0;
    loop {
        let (mut diagonal, mut pair) = (None, (0.0, 0, 0));
        for i in (0..B).filter(|&i| remaining[i]) {
            if diagonal.is_none_or(|(most, _)| M[i][i].abs() >= most) {
                diagonal = Some((M[i][i].abs(), i));
            }
            for j in (0..i).filter(|&j| remaining[j]) {
                if M[j][i].abs() > pair.0 {
                    pair = (M[j][i].abs(), i, j);
                }
            }
        }
        let Some((largest, k)) = diagonal else { return count };
        // NaN counts as a separate pivot, so the loop ends.
        if largest >= SINGLE * pair.0 || largest.is_nan() {
            remaining[k] = false;
            count += usize::from(M[k][k] < 0.0);
            if M[k][k] != 0.0 {
                let column = M[k];
                for j in (0..B).filter(|&j| remaining[j]) {
                    for i in (0..B).filter(|&i| remaining[i]) {
                        M[j][i] -= column[i] * column[j] / column[k];
                    }
                }
            }
            continue;
        }
        let (_, k, l) = pair;
        (remaining[k], remaining[l]) = (false, false);
        count += 1;
        let (K, L) = (M[k], M[l]);
        let det = K[k] * L[l] - K[l] * K[l];
        for j in (0..B).filter(|&j| remaining[j]) {
            for i in (0..B).filter(|&i| remaining[i]) {
                let (x, y) = (L[l] * K[j] - K[l] * L[j], K[k] * L[j] - K[l] * K[j]);
                M[j][i] -= (K[i] * x + L[i] * y) / det;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_does_not_hold_up_the_count() {
        assert_eq!(negative_eigenvalues::<3>(&[[-2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, -1.0]]), 2);
        negative_eigenvalues::<3>(&[[f64::NAN; 3]; 3]);
        negative_eigenvalues::<3>(&[[1.0, f64::INFINITY, 0.0], [f64::INFINITY, 1.0, f64::NAN], [0.0, f64::NAN, 0.0]]);
    }
}
