//! The dense operations of a front, named as in BLAS and LAPACK: large ones are halved recursively, so that the halves can
//! run side by side. The cut depends on the sizes alone, so the bits do not depend on the number of threads.

use faer::dyn_stack::MemStack;
use faer::linalg::cholesky::llt::factor::cholesky_in_place;
use faer::linalg::matmul::{matmul, triangular};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
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
    trsm(first.rb(), below.rb_mut(), threads);
    syrk(Accum::Add, below.rb(), rest.rb_mut(), threads);
    potrf(rest, scratch, threads)
}

/// B ← B L⁻ᵀ.
pub(super) fn trsm(L: MatRef<f64>, B: MatMut<f64>, threads: bool) {
    let n = B.nrows();
    if n < 2 * SMALLEST {
        return solve_lower_triangular_in_place(L, B.transpose_mut(), Par::Seq);
    }
    let (upper, lower) = B.split_at_row_mut(n / 2);
    join(threads, || trsm(L, upper, threads), || trsm(L, lower, threads));
}

/// U ← U − B Bᵀ or −B Bᵀ, lower triangles.
pub(super) fn syrk(accum: Accum, B: MatRef<f64>, U: MatMut<f64>, threads: bool) {
    use triangular::BlockStructure::{Rectangular, TriangularLower};
    let n = B.nrows();
    if n < 2 * SMALLEST {
        let (lhs, rhs) = ((B, Rectangular), (B.transpose(), Rectangular));
        return triangular::matmul(U, TriangularLower, accum, lhs.0, lhs.1, rhs.0, rhs.1, -1.0, Par::Seq);
    }
    let (upper, lower) = B.split_at_row(n / 2);
    let (first, _, beside, rest) = U.split_at_mut(n / 2, n / 2);
    join(
        threads,
        || gemm(accum, lower, upper, beside, threads),
        || join(threads, || syrk(accum, upper, first, threads), || syrk(accum, lower, rest, threads)),
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
