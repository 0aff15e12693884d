//! Lanczos' method with several starting vectors and thick restarts, all vectors kept orthogonal to each other.
//!
//! Band form: the method expands the vectors V one by one, and the new part of w = S v becomes one more vector. After q expansions S V_q =
//! V H. The first q rows of H are symmetric, and one row for each starting vector holds the residuals of Ritz pairs. A restart keeps the
//! Ritz vectors wanted and the vectors not yet expanded, for which the relation still holds (K. Wu & H. Simon, SIAM J. Matrix Anal. Appl.
//! 22 (2000); A. Ruhe, Math. Comp. 33 (1979)).
//!
//! The metric may be semi-definite: vectors start in the range of S, and eigenvectors are S y / θ, which removes the null space (B.
//! Nour-Omid, B. N. Parlett, T. Ericsson & P. S. Jensen, Math. Comp. 48 (1987)).

use super::basis::{Basis, Noise, dot};
use super::dense;
use std::collections::VecDeque;

/// A vector counts as zero after orthogonalization below this part of its length.
const NEGLIGIBLE: f64 = 1e-11;
/// Above [`NEGLIGIBLE`] and below this part, the rest counts only if it lies in the range of the operator.
const DOUBTFUL: f64 = 1e-5;
/// Vectors beyond those wanted, used by restarts.
const ROOM: usize = 24;

/// An operator that is symmetric in a metric: (S x)·B y = x·B (S y).
pub trait SymmetricOperator {
    /// Length of its vectors.
    fn dimension(&self) -> usize;
    /// The images S x of several vectors.
    fn apply(&mut self, x: &[&[f64]]) -> Vec<Vec<f64>>;
    /// y ← B x.
    fn metric(&mut self, x: &[f64], y: &mut [f64]);
    /// False for rounding outside the range of S, on which S may act arbitrarily.
    fn may_move(&mut self, _: &[f64]) -> bool {
        true
    }
    /// True where the search is to end at once.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// An eigenvalue of S with its vector, of length 1 in the metric.
#[derive(Debug, Clone)]
pub struct EigenPair {
    /// The eigenvalue θ.
    pub theta: f64,
    /// The eigenvector.
    pub vector: Vec<f64>,
}

/// The values of the pairs that have converged.
#[derive(Debug, Clone)]
pub struct Converged {
    /// Their eigenvalues θ, the largest magnitude first.
    pub thetas: Vec<f64>,
    /// An estimate of the one that follows them, if there is one.
    pub next: Option<f64>,
}

/// A Krylov space of an operator.
pub struct Lanczos {
    basis: Basis,
    /// Entries of H by columns; each of an expanded vector has a row for every vector there was then.
    H: Vec<Vec<f64>>,
    /// The images of the vectors that are to be expanded next: those of all there are have been found together.
    images: VecDeque<Vec<f64>>,
    /// The converged Ritz pairs without vectors yet, and their number.
    converged: Option<(Ritz, usize)>,
    noise: Noise,
    /// Applications of the operator so far.
    pub applications: usize,
    /// Restarts so far.
    pub restarts: usize,
}

/// The Ritz pairs of a space.
struct Ritz {
    /// Their values, the largest magnitude first.
    theta: Vec<f64>,
    /// Their vectors by the expanded vectors of the basis.
    s: Vec<Vec<f64>>,
    /// The lengths of their residuals.
    residual: Vec<f64>,
}

impl Lanczos {
    /// The space of `width` starting vectors of all frequencies, the same in every run.
    pub fn new(operator: &mut dyn SymmetricOperator, width: usize, threads: bool) -> Lanczos {
        let mut lanczos = Lanczos {
            basis: Basis::new(operator.dimension(), threads),
            H: Vec::new(),
            images: VecDeque::new(),
            converged: None,
            noise: Noise(1),
            applications: 0,
            restarts: 0,
        };
        lanczos.start(operator, width);
        lanczos
    }

    /// Adds vectors of all frequencies, to find modes orthogonal to the others. False if the space is the whole range of the operator.
    pub fn start(&mut self, operator: &mut dyn SymmetricOperator, width: usize) -> bool {
        let before = self.basis.len();
        let mut random = || (0..operator.dimension()).map(|_| self.noise.next()).collect::<Vec<f64>>();
        let random: Vec<_> = (0..width).map(|_| random()).collect();
        let images = operator.apply(&random.iter().map(Vec::as_slice).collect::<Vec<_>>());
        self.applications += width;
        drop(random);
        for w in images {
            self.add(operator, w);
        }
        self.basis.len() > before
    }

    /// True where every vector of the space has been expanded.
    pub fn is_expanded(&self) -> bool {
        self.H.len() == self.basis.len()
    }

    /// Orthogonalizes a vector against all others and adds it; returns the products with the others, and its length last.
    fn add(&mut self, operator: &mut dyn SymmetricOperator, mut w: Vec<f64>) -> Vec<f64> {
        let mut Bw = vec![0.0; w.len()];
        operator.metric(&w, &mut Bw);
        let before = dot(&w, &Bw).max(0.0).sqrt();
        let mut column = vec![0.0; self.basis.len()];
        for _ in 0..2 {
            let products = self.basis.products(&Bw);
            self.basis.subtract(&products, &mut w);
            column.iter_mut().zip(&products).for_each(|(sum, product)| *sum += product);
            operator.metric(&w, &mut Bw);
        }
        let length = dot(&w, &Bw).max(0.0).sqrt();
        let is_new = length > NEGLIGIBLE * before && length.is_normal();
        // Without a new direction, the part outside the range is rounding.
        if is_new && (length > DOUBTFUL * before || operator.may_move(&w)) {
            self.basis.push(w, 1.0 / length);
            column.push(length);
        }
        column
    }

    /// Expands one more vector; false where all are: the space is invariant.
    fn expand(&mut self, operator: &mut dyn SymmetricOperator) -> bool {
        let next = self.H.len();
        if next == self.basis.len() {
            return false;
        }
        if self.images.is_empty() {
            let open: Vec<&[f64]> = (next..self.basis.len()).map(|k| self.basis.vector(k)).collect();
            self.images = operator.apply(&open).into();
            self.applications += self.images.len();
        }
        let Some(image) = self.images.pop_front() else { return false };
        let column = self.add(operator, image);
        self.H.push(column);
        true
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.H[column].get(row).copied().unwrap_or(0.0)
    }

    fn ritz(&self) -> Option<Ritz> {
        let q = self.H.len();
        let (values, vectors) = dense::symmetric(q, |i, j| 0.5 * (self.entry(i, j) + self.entry(j, i)))?;
        let mut order: Vec<usize> = (0..q).collect();
        order.sort_by(|&a, &b| values[b].abs().total_cmp(&values[a].abs()));
        let residual = |s: &[f64]| {
            let row = |i: usize| -> f64 { (0..q).map(|j| self.entry(i, j) * s[j]).sum() };
            (q..self.basis.len()).map(|i| row(i).powi(2)).sum::<f64>().sqrt()
        };
        Some(Ritz {
            theta: order.iter().map(|&k| values[k]).collect(),
            residual: order.iter().map(|&k| residual(&vectors[k])).collect(),
            s: order.iter().map(|&k| vectors[k].clone()).collect(),
        })
    }

    /// Ritz values after so many expansions in all, or those there are when the search is stopped, the largest magnitude first: first estimates.
    pub fn probe(&mut self, operator: &mut dyn SymmetricOperator, expansions: usize) -> Vec<f64> {
        while self.H.len() < expansions && !operator.is_stopped() && self.expand(operator) {}
        self.ritz().map_or_else(Vec::new, |ritz| ritz.theta)
    }

    /// Iterates until the `wanted` pairs of largest magnitude have residuals below `tolerance` times their values, and returns the values.
    /// Fewer are returned if the operator has no more, none after `limit` applications or a stop.
    pub fn converge(
        &mut self,
        operator: &mut dyn SymmetricOperator,
        wanted: usize,
        tolerance: f64,
        limit: usize,
    ) -> Option<Converged> {
        let most = most(wanted);
        let mut look = wanted + 2;
        loop {
            let goes_on = self.H.len() < most && self.expand(operator);
            let q = self.H.len();
            if goes_on && q < look && q < most && !operator.is_stopped() {
                continue;
            }
            look = q + 4.max(q / 16);
            let ritz = self.ritz()?;
            let there = wanted.min(ritz.theta.len());
            // Values far below the others are rounding, and cannot converge.
            let floor = 1e-14 * ritz.theta.first().map_or(0.0, |theta| theta.abs());
            let open = (0..there).filter(|&k| ritz.residual[k] > tolerance * ritz.theta[k].abs() + floor).count();
            let whole = q == self.basis.len();
            if open == 0 && (there == wanted || whole) {
                if there < wanted && self.start(operator, 1) {
                    continue;
                }
                let (thetas, next) = (ritz.theta[..there].to_vec(), ritz.theta.get(there).copied());
                self.converged = Some((ritz, there));
                return Some(Converged { thetas, next });
            }
            if self.applications > limit || operator.is_stopped() {
                return None;
            }
            if q >= most {
                self.restart(&ritz, wanted, most);
                look = 0;
            }
        }
    }

    /// Keeps the Ritz vectors wanted, and half of the others.
    fn restart(&mut self, ritz: &Ritz, wanted: usize, most: usize) {
        let (q, p) = (self.H.len(), self.basis.len());
        let keep = (wanted + (most - wanted) / 3).min(q);
        let mut H = Vec::with_capacity(keep);
        for k in 0..keep {
            let mut column = vec![0.0; keep + p - q];
            column[k] = ritz.theta[k];
            for i in q..p {
                column[keep + i - q] = (0..q).map(|j| self.entry(i, j) * ritz.s[k][j]).sum();
            }
            H.push(column);
        }
        self.basis.replace(&ritz.s[..keep], q);
        self.H = H;
        self.restarts += 1;
    }

    /// Keeps only the converged pairs of the space; a continued search starts anew beside them.
    pub fn narrow(&mut self) {
        let Some((ritz, count)) = self.converged.take() else { return };
        let (q, p) = (self.H.len(), self.basis.len());
        // S y / θ = y + V r / θ, with the coefficients r of the residual.
        let factors = |k: usize| {
            let rest = |i: usize| (0..q).map(|j| self.entry(i, j) * ritz.s[k][j]).sum::<f64>() / ritz.theta[k];
            ritz.s[k].iter().copied().chain((q..p).map(rest)).collect()
        };
        let factors: Vec<Vec<f64>> = (0..count).map(factors).collect();
        self.images.clear();
        self.basis.replace(&factors, p);
        let column = |k: usize| (0..count).map(|i| if i == k { ritz.theta[k] } else { 0.0 }).collect();
        self.H = (0..count).map(column).collect();
    }

    /// The pairs that have converged, with the space given up.
    pub fn into_pairs(mut self) -> Vec<EigenPair> {
        self.narrow();
        let thetas = (0..self.H.len()).map(|k| self.entry(k, k)).collect::<Vec<_>>();
        let vectors = self.basis.take(thetas.len());
        thetas.into_iter().zip(vectors).map(|(theta, vector)| EigenPair { theta, vector }).collect()
    }
}

/// Most vectors that are expanded before a restart.
fn most(wanted: usize) -> usize {
    2 * wanted + ROOM
}
