//! The dense operations of a front, named as in BLAS and LAPACK: large ones are halved recursively, so that the halves can
//! run side by side. The cut depends on the sizes alone, so the bits do not depend on the number of threads.

use faer::dyn_stack::MemStack;
use faer::linalg::cholesky::llt::factor::cholesky_in_place;
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};

/// The halves of a dense operation have at least so many rows.
const SMALLEST: usize = 192;

/// Runs two tasks, side by side where there are threads.
pub(super) fn join<A: Send, B: Send>(
    threads: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if threads { rayon::join(a, b) } else { (a(), b()) }
}

/// A ← L with A = L Lᵀ, lower triangles. False if a pivot is not positive.
pub(super) fn potrf(A: MatMut<f64>, scratch: &mut MemStack, threads: bool) -> bool {
    let n = A.nrows();
    if n < 2 * SMALLEST {
        return cholesky_in_place(A, Default::default(), Par::Seq, scratch, Default::default()).is_ok();
    }
    let (mut first, _, mut below, mut rest) = A.split_at_mut(n / 2, n / 2);
    if !potrf(first.rb_mut(), scratch, threads) {
        return false;
    }
    trsm(first.rb(), below.rb_mut(), false, threads);
    syrk(Accum::Add, below.rb(), below.rb(), rest.rb_mut(), threads);
    potrf(rest, scratch, threads)
}

/// B ← B L⁻ᵀ, with ones for the diagonal of L where `unit`.
pub(super) fn trsm(L: MatRef<f64>, B: MatMut<f64>, unit: bool, threads: bool) {
    let n = B.nrows();
    if n < 2 * SMALLEST {
        let solve = if unit { solve_unit_lower_triangular_in_place } else { solve_lower_triangular_in_place };
        return solve(L, B.transpose_mut(), Par::Seq);
    }
    let (upper, lower) = B.split_at_row_mut(n / 2);
    join(threads, || trsm(L, upper, unit, threads), || trsm(L, lower, unit, threads));
}

/// U ← U − A Bᵀ or −A Bᵀ, for the lower triangle of a symmetric matrix.
pub(super) fn syrk(accum: Accum, A: MatRef<f64>, B: MatRef<f64>, U: MatMut<f64>, threads: bool) {
    use triangular::BlockStructure::{Rectangular, TriangularLower};
    let n = B.nrows();
    if n < 2 * SMALLEST {
        let (lhs, rhs) = ((A, Rectangular), (B.transpose(), Rectangular));
        return triangular::matmul(U, TriangularLower, accum, lhs.0, lhs.1, rhs.0, rhs.1, -1.0, Par::Seq);
    }
    let ((A_upper, A_lower), (B_upper, B_lower)) = (A.split_at_row(n / 2), B.split_at_row(n / 2));
    let (first, _, beside, rest) = U.split_at_mut(n / 2, n / 2);
    join(
        threads,
        || gemm(accum, A_lower, B_upper, beside, threads),
        || {
            let first = || syrk(accum, A_upper, B_upper, first, threads);
            join(threads, first, || syrk(accum, A_lower, B_lower, rest, threads))
        },
    );
}

/// U ← U − A Bᵀ or −A Bᵀ.
pub(super) fn gemm(accum: Accum, A: MatRef<f64>, B: MatRef<f64>, U: MatMut<f64>, threads: bool) {
    let n = B.nrows();
    if n < 2 * SMALLEST {
        return matmul(U, accum, A, B.transpose(), -1.0, Par::Seq);
    }
    let (upper, lower) = B.split_at_row(n / 2);
    let (left, right) = U.split_at_col_mut(n / 2);
    join(threads, || gemm(accum, A, upper, left, threads), || gemm(accum, A, lower, right, threads));
}
