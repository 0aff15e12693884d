//! Arnoldi's method for unsymmetric operators: the space grows until the eigenvalues of largest magnitude have converged (Y. Saad,
//! Numerical Methods for Large Eigenvalue Problems (1992), chapter VI). There are no restarts.

use super::basis::{Basis, Noise, dot};
use super::dense::{self, Complex};

/// A vector counts as zero after orthogonalization below this part of its length.
const NEGLIGIBLE: f64 = 1e-13;

/// A linear operator.
pub trait Operator {
    /// Length of its vectors.
    fn dimension(&self) -> usize;
    /// y ← A x.
    fn apply(&mut self, x: &[f64], y: &mut [f64]);
    /// y ← D x with a positive diagonal matrix, the metric of vectors.
    fn weigh(&self, x: &[f64], y: &mut [f64]);
    /// True where the search is to end at once.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// A complex eigenvalue with its vector.
#[derive(Debug, Clone)]
pub struct ComplexPair {
    /// The eigenvalue.
    pub theta: Complex,
    /// Real part of the vector.
    pub real: Vec<f64>,
    /// Imaginary part of the vector.
    pub imaginary: Vec<f64>,
}

/// A Krylov space of an operator.
pub struct Arnoldi {
    basis: Basis,
    H: Vec<Vec<f64>>,
    noise: Noise,
}

impl Arnoldi {
    /// The space of `width` starting vectors, the same in every run.
    pub fn new(operator: &mut dyn Operator, width: usize, threads: bool) -> Arnoldi {
        let mut arnoldi = Arnoldi { basis: Basis::new(operator.dimension(), threads), H: Vec::new(), noise: Noise(1) };
        for _ in 0..width {
            arnoldi.start(operator);
        }
        arnoldi
    }

    /// Adds one starting vector in the range of the operator; false where there is none.
    fn start(&mut self, operator: &mut dyn Operator) -> bool {
        let random: Vec<f64> = (0..operator.dimension()).map(|_| self.noise.next()).collect();
        let mut w = vec![0.0; random.len()];
        operator.apply(&random, &mut w);
        let before = self.basis.len();
        self.add(operator, w);
        self.basis.len() > before
    }

    fn add(&mut self, operator: &mut dyn Operator, mut w: Vec<f64>) -> Vec<f64> {
        let mut Dw = vec![0.0; w.len()];
        operator.weigh(&w, &mut Dw);
        let before = dot(&w, &Dw).sqrt();
        let mut column = vec![0.0; self.basis.len()];
        for _ in 0..2 {
            let products = self.basis.products(&Dw);
            self.basis.subtract(&products, &mut w);
            column.iter_mut().zip(&products).for_each(|(sum, product)| *sum += product);
            operator.weigh(&w, &mut Dw);
        }
        let length = dot(&w, &Dw).sqrt();
        if length > NEGLIGIBLE * before && length.is_normal() {
            self.basis.push(w, 1.0 / length);
            column.push(length);
        }
        column
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.H[column].get(row).copied().unwrap_or(0.0)
    }

    /// Expands the space until as many eigenvalues have converged as `enough` requires. `enough` receives the number of converged
    /// eigenvalues of largest magnitude; `None` after `most` expansions.
    pub fn converge(
        &mut self,
        operator: &mut dyn Operator,
        tolerance: f64,
        most: usize,
        enough: impl Fn(&[Complex]) -> Option<usize>,
    ) -> Option<Vec<ComplexPair>> {
        let most = most.min(operator.dimension());
        let mut look = 8;
        loop {
            if operator.is_stopped() {
                return None;
            }
            let next = self.H.len();
            let whole = next == self.basis.len() && !self.start(operator);
            if !whole {
                let mut w = vec![0.0; operator.dimension()];
                operator.apply(self.basis.vector(next), &mut w);
                let column = self.add(operator, w);
                self.H.push(column);
            }
            let q = self.H.len();
            let whole = whole || q == operator.dimension();
            if !whole && q < look && q < most {
                continue;
            }
            look = q + (q / 8).max(8);
            let (values, vectors) = dense::general(q, |i, j| self.entry(i, j))?;
            let mut order: Vec<usize> = (0..q).collect();
            let size = |k: usize| values[k][0].hypot(values[k][1]);
            order.sort_by(|&a, &b| size(b).total_cmp(&size(a)));
            let residual = |k: usize| {
                let s = &vectors[k];
                let part = |i: usize, c: usize| (0..q).map(|j| self.entry(i, j) * s[j][c]).sum::<f64>();
                (q..self.basis.len()).map(|i| part(i, 0).powi(2) + part(i, 1).powi(2)).sum::<f64>().sqrt()
            };
            let largest = order.first().map_or(0.0, |&k| size(k));
            let settled = |k: &usize| whole || residual(*k) <= tolerance * size(*k) + 1e-15 * largest;
            let converged: Vec<usize> = order.iter().copied().take_while(settled).collect();
            let ordered: Vec<Complex> = converged.iter().map(|&k| values[k]).collect();
            let count = enough(&ordered).or(whole.then_some(ordered.len()));
            if let Some(count) = count {
                let pair = |&k: &usize| {
                    let part = |c: usize| self.basis.combine(&vectors[k].iter().map(|s| s[c]).collect::<Vec<_>>());
                    ComplexPair { theta: values[k], real: part(0), imaginary: part(1) }
                };
                return Some(converged.iter().take(count).map(pair).collect());
            }
            if q >= most {
                return None;
            }
        }
    }
}
