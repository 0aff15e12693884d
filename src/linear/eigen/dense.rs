//! Eigenpairs of small dense projected matrices.

use faer::{Mat, Side};

/// A complex number as its real and its imaginary part.
pub type Complex = [f64; 2];

/// Eigenvalues, ascending, and orthonormal eigenvectors (columns) of a symmetric matrix, whose lower triangle is read.
pub(super) fn symmetric(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    if n == 0 {
        return Some((Vec::new(), Vec::new()));
    }
    let matrix = Mat::<f64>::from_fn(n, n, &entry);
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let values = (0..n).map(|k| eigen.S()[k]).collect();
    let vectors = (0..n).map(|k| (0..n).map(|i| eigen.U()[(i, k)]).collect()).collect();
    Some((values, vectors))
}

/// Eigenvalues and eigenvectors, by columns, of a matrix that need not be symmetric.
pub(super) fn general(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<(Vec<Complex>, Vec<Vec<Complex>>)> {
    if n == 0 {
        return Some((Vec::new(), Vec::new()));
    }
    let matrix = Mat::<f64>::from_fn(n, n, &entry);
    let eigen = matrix.eigen().ok()?;
    let values = (0..n).map(|k| [eigen.S()[k].re, eigen.S()[k].im]).collect();
    let vectors = (0..n).map(|k| (0..n).map(|i| [eigen.U()[(i, k)].re, eigen.U()[(i, k)].im]).collect()).collect();
    Some((values, vectors))
}
