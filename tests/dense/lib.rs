//! Dense linear algebra that tests hold other methods against. It is a crate of its own because the tests themselves are not optimised.

use nalgebra::{DMatrix, DVector};

/// The rows and columns `of` a matrix.
pub fn part(K: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(of.len(), of.len(), |i, j| K[(of[i], of[j])])
}

/// Every unknown in units that make its own stiffness one.
pub fn scaled(K: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(K.nrows(), K.ncols(), |i, j| K[(i, j)] / (K[(i, i)] * K[(j, j)]).sqrt())
}

/// Eigenvalues of a symmetric matrix, ascending.
pub fn eigenvalues(K: &DMatrix<f64>) -> Vec<f64> {
    let mut values: Vec<f64> = K.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The symmetric part of L⁻¹ K L⁻ᵀ with M = L Lᵀ: its eigenvalues are the squares of angular frequencies.
pub fn by_masses(K: &DMatrix<f64>, M: DMatrix<f64>) -> DMatrix<f64> {
    let L = M.cholesky().expect("every direction has mass").l();
    let half = L.solve_lower_triangular(K).expect("positive pivots");
    let whole = L.solve_lower_triangular(&half.transpose()).expect("positive pivots");
    0.5 * (&whole + whole.transpose())
}

/// The highest eigenvalue of a positive matrix, from below, within a hundredth: by powers.
pub fn highest(S: &DMatrix<f64>) -> f64 {
    let mut x = DVector::from_fn(S.nrows(), |i, _| 1.0 + (i as f64).sin());
    let mut size = 0.0;
    for _ in 0..200 {
        x = S * x;
        size = x.norm();
        x /= size;
    }
    size
}

/// Moves the unknowns `free` to where K u vanishes in their rows; the others are given.
pub fn balance(K: &DMatrix<f64>, free: &[usize], u: &mut DVector<f64>) {
    free.iter().for_each(|&i| u[i] = 0.0);
    let r = -(K * &*u);
    let found = part(K, free).lu().solve(&r.select_rows(free)).expect("a regular matrix");
    free.iter().zip(found.iter()).for_each(|(&i, found)| u[i] = *found);
}
