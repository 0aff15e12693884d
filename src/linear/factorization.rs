//! The choice of the factorization that suits a structure.

use super::elimination::Elimination;
use super::graph::Graph;
use super::structure::Structure;

/// The factorisations there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factorization {
    /// LU on small dense blocks, one per node: for symmetric and unsymmetric values, definite or not.
    BlockLu,
    /// Supernodal Cholesky: for symmetric values only.
    Cholesky,
}

/// Operations per second of the block LU, on 3×3 and on 6×6 blocks.
const BLOCK_RATE: [f64; 2] = [8e9, 15e9];

/// Operations per second of the dense kernels of a Cholesky factorisation with two substitutions.
const CHOLESKY_RATE: f64 = 30e9;
/// Seconds that it spends beside them for each number of the factor.
const CHOLESKY_PER_NONZERO: f64 = 5e-9;
/// Seconds that it spends beside them for each unknown.
const CHOLESKY_PER_UNKNOWN: f64 = 100e-9;

impl Factorization {
    /// The faster one where values are symmetric.
    ///
    /// LU does twice the work of Cholesky, but at a rate that does not fall on small blocks, and substitutes twice as
    /// fast. Chains of any length stay with it; sheets and space frames change over near 5·10⁶ operations of the
    /// Cholesky factorisation, that is near 1000 unknowns. The constants fit `benches/linear.rs` within a fifth where
    /// the two are close; only their ratios matter.
    pub fn choose(structure: &Structure) -> Self {
        let elimination = Elimination::new(&Graph::new(structure));
        let plane = structure.sizes.iter().all(|&size| size <= 3);
        let (cube, rate) = if plane { (27.0, BLOCK_RATE[0]) } else { (216.0, BLOCK_RATE[1]) };
        let block = elimination.block_flops * cube / rate;
        let unknowns: usize = structure.sizes.iter().sum();
        let cholesky = elimination.flops / CHOLESKY_RATE
            + elimination.nonzeros as f64 * CHOLESKY_PER_NONZERO
            + unknowns as f64 * CHOLESKY_PER_UNKNOWN;
        if block <= cholesky { Factorization::BlockLu } else { Factorization::Cholesky }
    }
}
